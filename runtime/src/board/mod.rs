//! The board as a program that embeds it sees it.

mod boot;
mod code;
pub(crate) mod connect;
pub mod debug;
pub mod loader;
pub mod machine_file;
mod outside;
pub(crate) mod power_up;
mod programs;
#[cfg(test)]
mod recorded_programs;
mod snapshot;
pub mod standing;
pub mod surroundings;

pub use snapshot::BoardSnapshot;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use kmotiondef::map::FLASH;
use kmotiondef::structs::Persist;
use kmotiondef::timing::Timing;
use kmotiondef::variables::{PERSIST, cell_name};
use kmotiondef::{Axes, Cycles, GuestAddr, ThreadId, Ticks};
use vm::engine::{CallEnd, ContextId, Engine, ObservedAccesses, Preemption};
use vm::interp::BytecodeEngine;
use vm::machine::{Config as MachineConfig, Machine};
use vm::memory::{FaultPolicy, GuestMemory};
use vm::thread::ThreadState;

use crate::board::debug::{CodeDetail, DebugInfo};
use crate::board::machine_file::{MachineFile, NS_PER_INSTRUCTION};
use crate::firmware::level::ModelledBoard;
use crate::firmware::races::switches::Switches;
use crate::io::flash::FLASH_SIZE;
use crate::kernel::Kernel;
use crate::out::{Event, EventKind, Message, Remark, Request, Speaker};
use crate::pc::Answers;
use crate::pc::files::{HostFiles, NoFiles};
use crate::views::TypedAccess;

/// Settings of a board.
#[derive(Debug)]
pub struct Config {
    /// The board and its firmware.
    pub board: ModelledBoard,
    /// Settings of the machine: servo time, shortcuts, stacks.
    pub machine: MachineConfig,
    /// True if the built-in PC polls and answers.
    pub host: bool,
    /// Its answers to programs; `None` for those of the machine file.
    pub answers: Option<Answers>,
    /// The folder in which the PC keeps its files.
    pub files: Box<dyn HostFiles>,
    /// Byte put into uninitialised data at a load.
    pub bss_fill: u8,
    /// Whose time is counted: of the servo interrupt and of registers. Programs bring theirs.
    pub timing: Timing,
    /// The equipment that is connected to the board.
    pub machine_file: MachineFile,
    /// The numbers of accesses to shared memory, from 1, before which a thread loses the processor; for a board with
    /// [observed](MachineConfig::observed) accesses.
    pub switches: BTreeSet<u64>,
    /// The contents of flash memory, [`FLASH_SIZE`] bytes; `None` for a board whose flash was never written.
    pub flash: Option<Vec<u8>>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            board: ModelledBoard::default(),
            machine: MachineConfig::default(),
            host: true,
            answers: None,
            files: Box::new(NoFiles),
            bss_fill: 0,
            timing: Timing::default(),
            machine_file: MachineFile::default(),
            switches: BTreeSet::new(),
            flash: None,
        }
    }
}

/// Cycles of a microsecond.
const CYCLES_PER_US: f64 = Cycles::PER_SECOND.get() as f64 / 1e6;

/// The reason for which a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// No thread is active, and no motion, recording, printing or request to the PC is in progress.
    AllEnded,
    /// The limit is reached.
    Limit,
}

/// Facts about a loaded image.
#[derive(Clone, Debug)]
struct LoadedImage {
    debug: DebugInfo,
    /// Addresses from its first to after its last byte.
    extent: Range<u32>,
}

/// An image that a stimulus may load, and further details about its code.
type OfferedImage = (Vec<u8>, Arc<[CodeDetail]>);

/// Facts about the programs on the board.
#[derive(Clone, Debug, Default)]
struct Programs {
    loaded: [Option<LoadedImage>; ThreadId::MAX as usize],
    /// Debug information of the programs in flash.
    flashed: [Option<DebugInfo>; ThreadId::MAX as usize],
    /// Images that a stimulus may load, by their thread and by their name in the stimulus.
    offered: BTreeMap<(ThreadId, Arc<str>), OfferedImage>,
}

/// A simulated board.
#[derive(Debug)]
pub struct Board<E = BytecodeEngine> {
    machine: Machine<Kernel, E>,
    /// Shared with snapshots.
    programs: Arc<Programs>,
    bss_fill: u8,
    /// The cost of an instruction, relative to its cost on the board.
    cost: f64,
    /// The names of the axes in the machine file, and their units; a unit is empty if none was given.
    names: [(String, String); Axes::MAX],
}

impl<E: Engine> Board<E> {
    /// A board at power-up.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self::with_engine(config, E::default())
    }

    /// A board at power-up that runs programs on `engine`.
    #[must_use]
    pub fn with_engine(config: Config, engine: E) -> Self {
        let connected = &config.machine_file;
        let mut kernel = Kernel::of_board(config.board, config.files);
        kernel.parts.pc.host.connect(config.host && connected.pc.is_connected);
        kernel.parts.pc.host.answer_with(config.answers.unwrap_or_else(|| connected.pc.answers.clone()));
        kernel.parts.timing = config.timing;
        kernel.parts.races = (config.machine.observed != ObservedAccesses::None).then(Box::default);
        kernel.parts.switches =
            (!config.switches.is_empty()).then(|| Box::new(Switches::new(config.switches)));
        kernel.parts.calls.are_split = config.machine.preemption == Preemption::Instructions;
        connect::install(&mut kernel.parts, connected);
        let servo = connected.cpu.servo_us.map(|time| Cycles::new((time * CYCLES_PER_US) as i64));
        let settings = MachineConfig {
            servo: config.machine.servo.or(servo),
            strict_stack: config.machine.strict_stack || connected.cpu.strict_stack,
            faults: if connected.cpu.board_faults { FaultPolicy::Board } else { config.machine.faults },
            ..config.machine
        };
        let machine = Machine::with_engine(kernel, settings, engine);
        let bss_fill = if config.bss_fill == 0 { connected.cpu.bss_fill } else { config.bss_fill };
        let cost = connected.cpu.ns_per_instruction / NS_PER_INSTRUCTION;
        let names = std::array::from_fn(|axis| connected.axes[axis].names());
        let mut board = Self { machine, programs: Arc::default(), bss_fill, cost, names };
        board.set_places();
        if let Some(flash) = config.flash.filter(|_| board.memory().map().flash.is_some()) {
            let stored = board.machine.memory_mut().poke_bytes(FLASH.base, &flash);
            debug_assert!(stored.is_ok() && flash.len() == FLASH_SIZE, "flash has its size");
        }
        board.power_up(connected.boards.strict_flash);
        let is_proven = board.modelled_board().board().is_proven;
        let (kernel, context) = board.machine.firmware_mut();
        if !is_proven {
            kernel.parts.out.remark(context.now, Message::KognaUnproven {});
        }
        connect::connect_surroundings(&mut kernel.parts, connected, context.memory);
        board
    }

    /// Runs to the end of tick `limit` or until everything has ended; `sink` receives the events.
    ///
    /// At the end the console lines still waiting are sent, and the expectations of the stimulus are checked.
    pub fn run(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) -> RunEnd {
        let end = self.run_part(limit, sink);
        self.finish(sink);
        end
    }

    /// Like [`run`](Self::run), for a run that continues afterwards or is [finished](Self::finish).
    pub fn run_part(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) -> RunEnd {
        loop {
            if self.has_ended() {
                return RunEnd::AllEnded;
            }
            if self.machine.tick() >= limit {
                return RunEnd::Limit;
            }
            self.step(limit);
            self.deliver(sink);
        }
    }

    /// The run is over: sends the console lines still waiting and checks the expectations of the stimulus.
    pub fn finish(&mut self, sink: &mut dyn FnMut(Event)) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.sum_up(&context);
        self.flush(sink);
        let (kernel, context) = self.machine.firmware_mut();
        kernel.finish(&context);
        self.deliver(sink);
    }

    /// Runs to the end of the next tick in which something can happen, and executes the requests made in it.
    fn step(&mut self, limit: Ticks) {
        self.machine.step(limit);
        if self.machine.held().is_some() {
            return;
        }
        for request in self.machine.firmware_mut().0.parts.out.take_requests() {
            match request {
                Request::Load(thread) => self.load_download(thread),
                Request::Flash => self.save(),
                Request::Reboot => self.reboot(),
                Request::Run(thread, name) => self.run_offered(thread, &name),
            }
        }
    }

    /// Runs to the end of the next tick in which something can happen, or of tick `limit`, whichever comes first; a tick
    /// that is held is continued in any case.
    pub fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        if self.machine.tick() < limit || self.machine.held().is_some() {
            self.step(limit);
        }
        self.deliver(sink);
    }

    /// Sends the console lines that wait; one that has not ended stays.
    pub fn flush(&mut self, sink: &mut dyn FnMut(Event)) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.parts.flush_console(context.now);
        self.deliver(sink);
    }

    /// Runs until `is_over` returns true for an event of a tick, or to the end of tick `limit`; returns whether it did.
    ///
    /// Unlike [`run`](Self::run) it continues when all threads have ended, and does not send unfinished console lines.
    pub fn run_until(&mut self, limit: Ticks, is_over: &mut dyn FnMut(Event) -> bool) -> bool {
        while self.machine.tick() < limit {
            self.step(limit);
            let mut over = false;
            self.deliver(&mut |event| over |= is_over(event));
            if over {
                return true;
            }
        }
        false
    }

    /// Returns whether no thread is active and nothing that a program has started is in progress.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        let is_active = ThreadId::all().any(|thread| self.machine.threads().state(thread).is_active());
        !is_active && !self.machine.firmware().is_busy(self.machine.memory())
    }

    /// Delivers the events since the last call, with their positions in the programs where known.
    fn deliver(&mut self, sink: &mut dyn FnMut(Event)) {
        for mut event in self.machine.firmware_mut().0.parts.out.take_events() {
            if let EventKind::Remark(Remark { speaker: Speaker::Thread(thread), place, .. }) = &mut event.kind
                && place.is_none()
            {
                *place = self.machine.backtrace(*thread).first().copied();
            }
            sink(event);
        }
    }

    /// The present time: the end of the last tick.
    #[must_use]
    pub fn now(&self) -> Cycles {
        let tick = i64::try_from(self.machine.tick().get()).unwrap_or(i64::MAX);
        Cycles::new(tick.saturating_add(1).saturating_mul(Cycles::PER_TICK.get()))
    }

    /// Number of servo interrupts since power-up.
    #[must_use]
    pub const fn tick(&self) -> Ticks {
        self.machine.tick()
    }

    /// Guest memory.
    #[must_use]
    pub const fn memory(&self) -> &GuestMemory {
        self.machine.memory()
    }

    /// Guest memory, to change it from outside.
    pub fn memory_mut(&mut self) -> &mut GuestMemory {
        self.machine.firmware_mut().0.parts.note_external_change();
        self.machine.memory_mut()
    }

    /// The machine.
    #[must_use]
    pub const fn machine(&self) -> &Machine<Kernel, E> {
        &self.machine
    }

    /// The engine of bytecode, to set where it holds. None of that disturbs the board.
    pub const fn engine_mut(&mut self) -> &mut E {
        self.machine.engine_mut()
    }

    /// The machine, to load programs and to watch it.
    pub fn machine_mut(&mut self) -> &mut Machine<Kernel, E> {
        self.machine.firmware_mut().0.parts.note_external_change();
        &mut self.machine
    }

    /// The state of a thread.
    #[must_use]
    pub fn thread(&self, thread: ThreadId) -> &ThreadState {
        self.machine.threads().state(thread)
    }

    /// Two threads that have run bytecode and update the same cell by a load and a store, and the name of the cell.
    /// Only cells whose addresses are constants in the programs are found. Programs that take locks are ignored, since
    /// they may hold one during the update.
    #[must_use]
    pub fn contended_cell(&self) -> Option<(ThreadId, ThreadId, String)> {
        let ran = ThreadId::all().filter(|thread| self.machine.ran().contains(*thread));
        let takes_lock = |address| self.machine.firmware().takes_lock(address);
        let programs = ran.filter_map(|thread| Some((thread, self.machine.program(thread)?)));
        let programs = programs.filter(|(_, program)| !program.firmware_calls().any(takes_lock));
        let programs: Vec<_> = programs.map(|(thread, program)| (thread, program.updated_cells())).collect();
        let mut pairs = programs
            .iter()
            .enumerate()
            .flat_map(|(index, one)| programs.iter().skip(index + 1).map(move |other| (one, other)));
        pairs.find_map(|((one, cells), (other, theirs))| {
            let cell = cells.intersection(theirs).next()?;
            Some((*one, *other, cell_name(*cell, 4)))
        })
    }

    /// An element of `persist.UserData`; `None` for an index out of range.
    #[must_use]
    pub fn user_data(&self, index: usize) -> Option<i32> {
        let data = PERSIST.field(Persist::USER_DATA);
        (index < kmotiondef::limits::N_USER_DATA_VARS).then(|| self.memory().get(data.element(index)))
    }

    /// Stores an element of `persist.UserData`; `false` for an index out of range.
    pub fn set_user_data(&mut self, index: usize, value: i32) -> bool {
        let is_inside = index < kmotiondef::limits::N_USER_DATA_VARS;
        if is_inside {
            self.memory_mut().set(PERSIST.field(Persist::USER_DATA).element(index), value);
        }
        is_inside
    }
}

impl<E: Engine> Board<E> {
    /// Holds programs after a change of these bytes (address and length each), and after changes of no others.
    pub fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.machine.set_watched(ranges);
    }

    /// Calls a function of a loaded program or of the firmware, for a debugger; see [`Machine::call_function`].
    pub fn call_function(&mut self, id: ContextId, function: GuestAddr, arguments: &[u64]) -> CallEnd {
        self.machine.call_function(id, function, arguments)
    }

    /// Returns the index of a watched byte that has changed since the last call, if any has.
    pub fn take_change(&mut self) -> Option<usize> {
        self.machine.take_change()
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
    use kmotiondef::map::program_base;
    use kmotiondef::structs::Chan;
    use vm::text::assemble;
    use vm::verify::verify;

    use super::*;

    /// `sig0` is `()`, `sig1` `(i32, f64)`, `sig2` `(f64)`, `sig3` `(i32) -> i32`; the pool holds 0, 100 and 0.5.
    const HEAD: &str = "program 1, 3\nword 0x0\nword 0x4059000000000000\nword 0x3fe0000000000000
sig 0, 0\nsig 2, 0\ntypes 0xc\nsig 1, 0\ntypes 3\nsig 1, 1\ntypes 0\n";
    /// First word after it.
    const MAIN: usize = 11;
    /// The address of the text to print, in the thread's own space.
    const TEXT: u32 = 0x8005_F000;

    fn call(name: &str, signature: usize, loads: &str, arguments: &str) -> String {
        let address = FIRMWARE_FUNCTIONS[function_named(name).expect(name)].address.get();
        format!("charge 20\n{loads}\n{arguments}\ncall_fw sig{signature}, {address:#x}\n")
    }

    /// Enables axis 0, moves it by 100, waits half a second, prints a line and ends.
    fn program() -> String {
        let axis_and = |pool: usize| format!("const_i32 r0, 0\nconst_f64 d1, pool[{pool}]");
        let calls = [
            call("EnableAxisDest", 1, &axis_and(0), "arg_i32 r0, 0\narg_f64 d1, 1"),
            call("Move", 1, &axis_and(1), "arg_i32 r0, 0\narg_f64 d1, 1"),
            call("Delay_sec", 2, &axis_and(2), "arg_f64 d1, 0"),
            call("Print", 3, &format!("const_i32 r0, {}", TEXT.cast_signed()), "arg_i32 r0, 0"),
        ];
        format!("{HEAD}@main: func sig0, 2, 0\ntypes 0xc\n{}charge 2\nret", calls.concat())
    }

    fn run(shortcuts: bool, limit: u64) -> (RunEnd, Vec<Event>, Board) {
        let machine = MachineConfig { shortcuts, ..MachineConfig::default() };
        let mut board: Board = Board::new(Config { machine, ..Config::default() });
        let thread = ThreadId::new(1).expect("1 is a thread");
        let text = assemble(&program()).unwrap_or_else(|error| panic!("{error}"));
        let program = verify(&text, program_base(thread)).unwrap_or_else(|error| panic!("{error}"));
        board.memory_mut().poke_bytes(program_base(thread), &text).expect("mapped");
        board.memory_mut().poke_bytes(GuestAddr::new(TEXT), b"moved\n\0").expect("mapped");
        let entry = program.address_of(MAIN).as_guest_addr();
        board.load_program(thread, program, entry);
        board.start(thread).expect("loaded");
        let mut events = Vec::new();
        let end = board.run(Ticks::new(limit), &mut |event| events.push(event));
        (end, events, board)
    }

    #[test]
    fn a_program_runs_to_its_end() {
        let (end, events, board) = run(true, 100_000);
        assert_eq!(end, RunEnd::AllEnded);
        let line = EventKind::ConsoleLine(b"moved".to_vec());
        let lines: Vec<_> = events.iter().filter(|event| event.kind == line).collect();
        let [moved] = lines[..] else { panic!("{events:?}") };
        let seconds = moved.at.get() as f64 / Cycles::PER_SECOND.get() as f64;
        assert!((0.5..0.501).contains(&seconds), "{seconds}");
        let axis = kmotiondef::AxisId::new(0).expect("0 is an axis");
        assert_eq!(board.memory().axis(axis, Chan::DEST), 100.0);
    }

    #[test]
    fn shortcuts_change_nothing() {
        let limit = 8_000;
        let (slow, fast) = (run(false, limit), run(true, limit));
        assert_eq!(slow.0, fast.0);
        assert_eq!(slow.1, fast.1);
        assert!(slow.2.memory() == fast.2.memory(), "memory differs");
    }
}
