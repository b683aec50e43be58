//! The beginning of a session on a booted firmware: programs are loaded, surroundings connected, threads started.

use std::sync::Arc;

use boot::{BootedBoard, HaltError, SentKind};
use kmotiondef::variables::PERSIST;
use kmotiondef::{GuestAddr, ThreadId};
use runtime::surroundings::Surroundings;
use runtime::{Config, MachineFile};
use vm::scheduler::SliceOwner;
use vm::thread::ThreadState;

use super::attached::DelayedSurroundings;
use super::debug::DebugState;
use super::observers::Observers;
use super::{ANSWER, BootedFirmware, BootedTarget, LoadedProgram, Silence, State, TICK};
use crate::setup::Setup;
use crate::{HostError, UserProgram};

/// A firmware that is ready, with the loaded programs.
struct ReadyFirmware {
    board: BootedBoard,
    loaded: [Option<Arc<LoadedProgram>>; ThreadId::MAX as usize],
}

impl BootedTarget {
    /// Connects the hardware of the setup, loads the programs, and starts those marked as started, all in one slice;
    /// board time begins there. The expressions of the stimuli are already compiled.
    ///
    /// # Errors
    /// A program is rejected, the flash belongs to another firmware, or this firmware cannot be connected to hardware.
    pub(crate) fn begin(firmware: &BootedFirmware, setup: Setup) -> Result<Self, HostError> {
        let Setup {
            mut config,
            options,
            programs,
            offered,
            values,
            stimulus,
            is_assisted,
            uart_input,
            hears_uart,
            ..
        } = setup;
        let failed = |error: &dyn std::fmt::Display| HostError::Firmware(error.to_string());
        let mut board = firmware.board(config.flash.as_deref())?;
        board.skip_waits(config.machine.shortcuts);
        board.set_register_waits(options.timing.wait_states().map_or(0, |waits| waits.register));
        let mut beginning = ReadyFirmware { board, loaded: Default::default() };
        beginning.store(&values)?;
        for program in &programs {
            beginning.load(program)?;
        }
        let starting: Vec<_> =
            programs.iter().filter(|program| program.starts).map(|program| program.thread).collect();
        beginning.settle(&starting).map_err(|error| failed(&error))?;
        let ReadyFirmware { mut board, loaded } = beginning;
        let origin = board.next_tick() - TICK;
        let early = board.take_lines().into_iter().filter(|line| line.kind == SentKind::Console).collect();
        let machine = std::mem::take(&mut config.machine_file);
        let missing = missing_variable(&board);
        let attached = if missing.is_none() {
            let mut surroundings = surroundings(&board, config, &machine);
            surroundings.begin(&machine, stimulus, board.memory_mut());
            surroundings.connect_uart(&uart_input, hears_uart);
            if is_assisted {
                surroundings.play_operator();
            }
            Some(DelayedSurroundings { surroundings, origin })
        } else if stimulus.is_empty() && machine == MachineFile::default() && !is_assisted {
            None
        } else {
            let name = missing.unwrap_or_default();
            let message = format!("nothing can be connected: this firmware has no variable `{name}`");
            return Err(HostError::Firmware(message));
        };
        let state = State {
            loaded,
            threads: std::array::from_fn(|_| ThreadState::Empty),
            turn: SliceOwner::Primary,
            early,
            rest: Silence { ticks: 0, looks: board.poll_count() },
            answer: Silence { ticks: 0, looks: board.poll_count() },
            answer_until: 0,
            commands: [0; 8],
            is_deaf: false,
            has_told_loss: false,
            halted: None,
            debugging: DebugState::default(),
        };
        let board = board.connect(attached);
        let mut target = Self { board, origin, offered, observers: Observers::default(), state };
        if is_assisted {
            target.observers.follow_calls(&mut target.board);
        }
        target.state.commands = target.commands();
        target.note_threads();
        Ok(target)
    }

    /// Loads a program into its thread, which is stopped first.
    pub(super) fn load_program(&mut self, program: &UserProgram) -> Result<(), HostError> {
        stop(&mut self.board, program.thread)?;
        self.state.loaded[program.thread.index()] = Some(load(&mut self.board, program)?);
        self.state.debugging.end(program.thread);
        self.arm_stops();
        Ok(())
    }
}

impl ReadyFirmware {
    fn load(&mut self, program: &UserProgram) -> Result<(), HostError> {
        stop(&mut self.board, program.thread)?;
        self.loaded[program.thread.index()] = Some(load(&mut self.board, program)?);
        Ok(())
    }

    /// Stores initial values of `persist.UserData`, at this firmware's address for it.
    fn store(&mut self, values: &[(GuestAddr, Vec<u8>)]) -> Result<(), HostError> {
        if values.is_empty() {
            return Ok(());
        }
        let persist = self.board.file().address("persist");
        let persist =
            persist.ok_or_else(|| HostError::Firmware("this firmware has no `persist`".to_owned()))?;
        for (address, bytes) in values {
            let place = persist.offset(address.get() - PERSIST.address().get());
            let stored = self.board.memory_mut().poke_bytes(place, bytes);
            stored.map_err(|_| HostError::Unmapped(*address))?;
        }
        Ok(())
    }

    /// Lets the firmware read the data sent, and start threads in the next tick; time 0 is one tick earlier.
    fn settle(&mut self, starting: &[ThreadId]) -> Result<(), HaltError> {
        let end = self.board.cycle() + ANSWER;
        while !self.board.has_read_all() && self.board.cycle() < end {
            self.board.run_to(self.board.cycle() + TICK)?;
        }
        self.board.execute_together(starting)
    }
}

/// Stops a thread that is active, so that another program can be loaded into it.
fn stop<A: boot::ExternalHardware>(board: &mut BootedBoard<A>, thread: ThreadId) -> Result<(), HostError> {
    let is_active = |board: &BootedBoard<A>| board.is_active(thread).unwrap_or(false);
    if is_active(board) {
        board.send_line(format!("Kill{thread}").as_bytes());
    }
    let end = board.cycle() + ANSWER;
    while is_active(board) && board.cycle() < end {
        board.run_to(board.cycle() + TICK).map_err(|error| HostError::Firmware(error.to_string()))?;
    }
    Ok(())
}

/// Puts a program into memory.
fn load<A: boot::ExternalHardware>(
    board: &mut BootedBoard<A>,
    program: &UserProgram,
) -> Result<Arc<LoadedProgram>, HostError> {
    let loaded = board.load_program(program.thread, &program.image);
    loaded.map_err(|error| HostError::Firmware(format!("{}: {error}", program.path.display())))?;
    Ok(Arc::new(LoadedProgram { debug: program.debug_info(), functions: program.functions() }))
}

/// Creates the surroundings of this board from a machine file.
fn surroundings(board: &BootedBoard, mut config: Config, machine: &MachineFile) -> Surroundings {
    config.machine_file = machine.clone();
    Surroundings::new(config, board.file().address("ThreadActive").unwrap_or_default())
}

/// The first variable that the surroundings need and this firmware lacks.
fn missing_variable(board: &BootedBoard) -> Option<&'static str> {
    const NEEDED: [&str; 12] = [
        "ThreadActive",
        "chan",
        "persist",
        "CurrentThread",
        "HostStatus",
        "KStepPresent",
        "VirtualBits",
        "VirtualBitsEx",
        "ADC_BufferIn",
        "DAC_Buffer",
        "LastPWM",
        "read_disk_buffer",
    ];
    NEEDED.into_iter().find(|name| board.file().address(name).is_none())
}
