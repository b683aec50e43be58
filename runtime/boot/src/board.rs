//! The board on a common time base: processor, timer, link, programs.

mod followed;
mod power;

pub use followed::{ProgramCall, ProgramPacket, RunOutcome, StopPosition};
pub use power::FlashError;

use std::sync::Arc;

use c67x::Control;
use chips::changes::BitChange;
use coff::{Contents, Image};
use kmotiondef::map::ROM_SIZE;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, GuestAddr, ThreadId};
use vm::dsp::{Core, Halt};
use vm::memory::GuestMemory;
use vm::memory::snapshot::MemorySnapshot;

use super::bus::Hardware;
use super::crash::Crash;
use super::external::{ExternalHardware, TimerMatch};
use super::file::{FirmwareError, FirmwareFile};
use super::loads::Loads;
use super::rom::RomFunction;
use super::sent::{SentLine, SentLines};
use super::window::{Window, bit, instant};

/// Cycles per second.
const SECOND: u64 = 200_000_000;
/// Cycles from taking an interrupt to the first packet of its vector.
const OVERHEAD: u64 = 11;
/// The duration of the longest interrupt on a board without motion, with a margin.
const INTERRUPT: u64 = 8000;
/// The longest time for which the timer's interrupt may be pending.
const LONGEST_SHADOW: u64 = SECOND / 5;
/// The bit of CSR that enables interrupts.
const GIE: u32 = 1;
/// The byte before a console line; followed by any byte, it starts a command without echo.
const ESCAPE: u8 = 0x1B;
const NO_ECHO: u8 = 1;

/// The state of the processor before its next packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ProcessorState {
    /// The address of the next packet.
    pub pc: u32,
    /// The number of the thread that has the processor, 0 for the firmware's own; `None` if the firmware does not
    /// provide it.
    pub thread: Option<u32>,
    /// True if interrupts are disabled, as they are during an interrupt.
    pub is_masked: bool,
}

/// The reason why the board does not run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HaltError {
    /// The firmware crashed.
    #[error("{0}")]
    Crashed(Box<Crash>),
}

/// A board that runs a real firmware.
#[derive(Clone, Debug)]
pub struct BootedBoard<A = ()> {
    file: Arc<FirmwareFile>,
    core: Core,
    hardware: Hardware<A>,
    /// The lines that the board has sent.
    sent: SentLines,
    /// The cycle since which the timer's interrupt has been pending.
    waits_since: u64,
    /// The loads of the axes.
    loads: Loads,
    /// True if busy-waiting loops are skipped.
    skips: bool,
    /// The packets executed by programs, if they are recorded.
    packets: Option<Vec<ProgramPacket>>,
    /// The crash, if there was one.
    crash: Option<Box<Crash>>,
}

/// A snapshot of a [`BootedBoard`].
#[derive(Clone, Debug)]
pub struct BootedSnapshot<A = ()> {
    board: BootedBoard<A>,
    memory: MemorySnapshot,
}

impl<A: ExternalHardware> BootedSnapshot<A> {
    /// The cycle in which it was taken.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.board.cycle()
    }

    /// The bytes of guest memory in this snapshot that it does not share with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        self.memory.bytes_beyond(&other.memory)
    }

    /// Creates an independent board that continues from here.
    #[must_use]
    pub fn board(&self) -> BootedBoard<A> {
        let mut board = self.board.clone();
        board.restore(self);
        board
    }
}

impl<A: ExternalHardware> BootedBoard<A> {
    /// Sets whether busy-waiting loops are skipped in one step, which is the default; nothing observable changes.
    pub const fn skip_waits(&mut self, whether: bool) {
        self.core.skip_waits(whether);
        self.skips = whether;
    }

    /// Sets whether an unmapped address reads as 0 and ignores writes, as on a board; otherwise an access ends the run.
    pub const fn tolerate_unmapped(&mut self, whether: bool) {
        self.hardware.forgives = whether;
    }

    /// Sets the number of cycles for which the processor waits at a register or at flash; 0 by default. The firmware
    /// programs the bus of the FPGA and the flash so that a board waits for 44 (`dsp-board.md` 11); recordings with
    /// waits include the timer.
    pub const fn set_register_waits(&mut self, cycles: u32) {
        self.hardware.register_waits = cycles;
    }

    /// The cycles of busy-waiting loops that were skipped.
    #[must_use]
    pub const fn skipped(&self) -> u64 {
        self.core.skipped()
    }

    /// The firmware file.
    #[must_use]
    pub fn file(&self) -> &FirmwareFile {
        &self.file
    }

    /// The firmware file, for another board.
    #[must_use]
    pub fn shared_file(&self) -> Arc<FirmwareFile> {
        self.file.clone()
    }

    /// Cycles of 5 ns since power-up.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.core.state.cycle()
    }

    /// The cycle in which the firmware first polled the link to the PC.
    #[must_use]
    pub const fn ready_at(&self) -> Option<u64> {
        self.hardware.first_look
    }

    /// Returns whether the firmware is starting or restarting, and does not poll the link to the PC yet.
    #[must_use]
    pub const fn is_starting(&self) -> bool {
        self.hardware.first_look.is_none()
    }

    /// Packets executed since power-up.
    #[must_use]
    pub const fn packets(&self) -> u64 {
        self.core.packets()
    }

    /// The registers by name.
    #[must_use]
    pub fn registers(&self) -> Vec<(String, u32)> {
        self.core.registers()
    }

    /// Returns the state of the processor before its next packet.
    #[must_use]
    pub fn processor_state(&self) -> ProcessorState {
        let thread = self.file.address("CurrentThread").map(|at| self.hardware.memory.peek::<u32>(at));
        let is_masked = self.core.state.control(Control::Csr) & GIE == 0;
        ProcessorState { pc: self.core.state.pc(), thread, is_masked }
    }

    /// The memory.
    #[must_use]
    pub const fn memory(&self) -> &GuestMemory {
        &self.hardware.memory
    }

    /// The memory, for changes from outside, which may include code.
    pub fn memory_mut(&mut self) -> &mut GuestMemory {
        self.core.forget_code();
        &mut self.hardware.memory
    }

    /// Runs to the first packet at or after this cycle.
    ///
    /// # Errors
    /// The firmware crashed; the board no longer runs.
    pub fn run_to(&mut self, cycle: u64) -> Result<(), HaltError> {
        while self.run_to_stop(cycle)? == RunOutcome::ToStop {}
        Ok(())
    }

    /// Runs to `cycle`, to a stop, or until a device requests a stop.
    fn run_events(&mut self, cycle: u64) -> Result<RunOutcome, HaltError> {
        if let Some(crash) = &self.crash {
            return Err(HaltError::Crashed(crash.clone()));
        }
        let next = self.hardware.timer.next_match();
        if next <= self.cycle() {
            self.tick();
            return Ok(RunOutcome::Through);
        }
        if self.core.state.has_timer_flag() {
            if self.core.state.is_interruptible() {
                self.core.state.take_timer_interrupt(OVERHEAD);
                return Ok(RunOutcome::Through);
            }
            if self.cycle() - self.waits_since > LONGEST_SHADOW {
                return Err(self.crash("it has not taken an interrupt for 0.2 s".to_owned()));
            }
        }
        match self.execute_to(cycle.min(next)) {
            Halt::Preempted => Ok(RunOutcome::Through),
            Halt::Stopped => Ok(RunOutcome::ToStop),
            Halt::Left(0) => {
                self.restart();
                Ok(RunOutcome::Through)
            }
            Halt::Left(address) => match self.file.rom_function(address) {
                Some(function) => {
                    self.call_rom(function);
                    Ok(RunOutcome::Through)
                }
                None if address < ROM_SIZE => Err(self.crash(format!(
                    "it went to 0x{address:08X} in the processor's ROM, where the firmware file names no function"
                ))),
                None => Err(self
                    .crash(format!("it went to 0x{address:08X}, where this board has no memory for code"))),
            },
            Halt::Faulted(kind) => Err(self.crash(kind.to_string())),
        }
    }

    /// Calls a function of the ROM. If an interrupt would occur during the call, the call is repeated after it, so that
    /// the interrupt is on time.
    fn call_rom(&mut self, function: &RomFunction) {
        let Self { core, hardware, .. } = self;
        let left = hardware.timer.next_match().saturating_sub(core.state.cycle());
        if left < function.cycles && core.state.is_interruptible() {
            core.state.wait(left);
            return;
        }
        function.call(&mut core.state);
        core.state.wait(function.cycles);
    }

    /// Handles a match of the timer: connected hardware is updated, then the interrupt is requested.
    fn tick(&mut self) {
        let now = self.hardware.timer.next_match();
        let Hardware { memory, window, .. } = &mut self.hardware;
        let steps = std::array::from_fn(|number| window.steps(number, now).0);
        let Window { external, chips, kstep, .. } = window;
        if let Some(external) = external {
            let mut encoders = std::array::from_fn(|channel| chips.encoders.counter(channel));
            external.tick(&mut TimerMatch { memory, now, steps, encoders: &mut encoders, kstep });
            encoders.iter().enumerate().for_each(|(channel, count)| chips.encoders.set(channel, *count));
        } else if let Some(chan) = self.file.address("chan") {
            self.loads.tick(chan, memory, window, now);
        }
        if self.hardware.timer.take_match() {
            if !self.core.state.has_timer_flag() {
                self.waits_since = now;
            }
            self.core.state.raise_timer();
        }
    }

    /// Records a crash: the board no longer runs.
    fn crash(&mut self, reason: String) -> HaltError {
        let pc = self.core.state.pc();
        let thread = self.file.address("CurrentThread").map(|at| self.hardware.memory.peek::<u32>(at));
        let crash = Box::new(Crash {
            reason,
            cycle: self.cycle(),
            pc,
            function: self.file.function_at(pc),
            thread,
            scene: self.core.scene(pc, |at| self.hardware.word(at)),
        });
        self.crash = Some(crash.clone());
        HaltError::Crashed(crash)
    }

    /// Sends bytes from the PC.
    pub fn send(&mut self, bytes: &[u8]) {
        self.hardware.window.link.send(bytes);
    }

    /// Sends a command from the PC, which is not echoed.
    pub fn send_line(&mut self, command: &[u8]) {
        self.send(&[&[ESCAPE, NO_ECHO], command, b"\r"].concat());
    }

    /// Returns whether the firmware has read everything that was sent.
    #[must_use]
    pub fn has_read_all(&self) -> bool {
        self.hardware.window.link.is_read()
    }

    /// Returns the number of times the firmware has polled for a byte from the PC; it does not poll while it executes a
    /// command.
    #[must_use]
    pub const fn poll_count(&self) -> u64 {
        self.hardware.window.link.poll_count()
    }

    /// The bytes sent by the firmware since the last call of this or of [`take_lines`](Self::take_lines), with their
    /// cycles.
    pub fn take_bytes(&mut self) -> Vec<(u64, u8)> {
        self.hardware.window.link.take_sent()
    }

    /// From now on also keeps the bytes from which [`take_lines`](Self::take_lines) makes lines, for a PC outside this
    /// process.
    pub fn tap_wire(&mut self) {
        self.sent.keep_bytes();
    }

    /// Takes the bytes of the link since the last call.
    pub fn take_wire(&mut self) -> Vec<u8> {
        self.sent.take_wire()
    }

    /// The lines completed by the firmware since the last call.
    pub fn take_lines(&mut self) -> Vec<SentLine> {
        self.sent.take(self.hardware.window.link.take_sent())
    }

    /// Copies the sections of a linked program to memory, as a download does, and sends the firmware its start address.
    ///
    /// # Errors
    /// The bytes are not an image for this processor.
    pub fn load_program(&mut self, thread: ThreadId, image: &[u8]) -> Result<(), FirmwareError> {
        let image = Image::read(image).map_err(FirmwareError::NotAnImage)?;
        if image.target != coff::Target::C6000 {
            return Err(FirmwareError::OtherTarget(image.target));
        }
        let entry = image.program.ok_or(FirmwareError::NoEntry)?.entry;
        for section in &image.sections {
            if let Contents::Data(bytes) = &section.contents
                && self.hardware.memory.poke_bytes(GuestAddr::new(section.address), bytes).is_err()
            {
                let name = section.name.to_str().into_owned();
                return Err(FirmwareError::OtherBoard { name, address: section.address });
            }
        }
        self.core.forget_code();
        self.send_line(format!("EntryPoint{thread} {entry:X}").as_bytes());
        Ok(())
    }

    /// Starts a thread.
    pub fn execute(&mut self, thread: ThreadId) {
        self.send_line(format!("Execute{thread}").as_bytes());
    }

    /// Starts several threads together: all of them are ready before the first one runs in the rotation after this
    /// tick.
    ///
    /// # Errors
    /// The firmware crashed.
    pub fn execute_together(&mut self, threads: &[ThreadId]) -> Result<(), HaltError> {
        let Some(at) = self.file.address("ThreadActive") else {
            threads.iter().for_each(|thread| self.execute(*thread));
            return Ok(());
        };
        let mut started = 0;
        for thread in threads {
            self.execute(*thread);
            let end = self.cycle() + LONGEST_SHADOW;
            let is_begun = |board: &Self| board.is_active(*thread).unwrap_or(true);
            while !is_begun(self) && self.cycle() < end {
                self.run_to(self.cycle() + 20)?;
            }
            // The threads are held back until all are ready.
            let active: u32 = self.hardware.memory.peek(at);
            self.hardware.memory.poke(at, active & !(1 << thread.get()));
            started |= 1 << thread.get();
        }
        // After the interrupt of a tick, so that the next tick begins with the first of them.
        self.run_to(self.next_tick())?;
        self.run_to(self.cycle() + INTERRUPT)?;
        let active: u32 = self.hardware.memory.peek(at);
        self.hardware.memory.poke(at, active | started);
        Ok(())
    }

    /// Returns whether a user thread is active; `None` if the firmware has no such variable.
    #[must_use]
    pub fn is_active(&self, thread: ThreadId) -> Option<bool> {
        let active: u32 = self.memory().peek(self.file.address("ThreadActive")?);
        Some(active >> thread.get() & 1 != 0)
    }

    /// Returns the commanded and the measured position of an axis; `None` if the firmware has no such variables.
    #[must_use]
    pub fn axis(&self, axis: AxisId) -> Option<(f64, f64)> {
        let base = self.file.address("chan")?.offset(axis.get() as u32 * Chan::STRUCTURE.size);
        let at = |offset: u32| self.memory().peek::<f64>(base.offset(offset));
        Some((at(Chan::DEST.offset()), at(Chan::POSITION.offset())))
    }

    /// The number of steps made by a generator, and its rate in steps per second.
    pub fn steps(&mut self, generator: usize) -> (f64, f64) {
        let now = self.cycle();
        self.hardware.window.steps(generator, now)
    }

    /// Returns whether a pin is high: as an output, or as it is driven from outside.
    #[must_use]
    pub fn is_high(&self, pin: usize) -> bool {
        bit(pin).is_some_and(|bit| self.hardware.window.chips.pins.level(bit))
    }

    /// Returns whether a pin is an output.
    #[must_use]
    pub fn is_output(&self, pin: usize) -> bool {
        let group = u32::try_from(pin / 8).unwrap_or(u32::MAX).min(7);
        self.hardware.window.chips.pins.direction_group(group) >> (pin % 8) & 1 != 0
    }

    /// Drives an input pin from outside.
    pub fn drive_pin(&mut self, pin: usize, level: bool) {
        let now = instant(self.cycle());
        if let Some(bit) = bit(pin) {
            self.hardware.window.chips.pins.drive(bit, level, now);
        }
    }

    /// Records changes of pins from now on.
    pub fn keep_pin_changes(&mut self) {
        self.hardware.window.chips.pins.changes.switch_on(Vec::new());
    }

    /// The changes of pins since the last call, if they are recorded; their times are cycles since power-up.
    pub fn take_pin_changes(&mut self) -> Vec<BitChange> {
        self.hardware.window.chips.pins.changes.take()
    }

    /// Connects external hardware, which is informed of the present state of the registers.
    #[must_use]
    pub fn connect<B: ExternalHardware>(self, external: Option<B>) -> BootedBoard<B> {
        let Self { file, core, hardware, sent, waits_since, loads, skips, packets, crash } = self;
        let hardware = hardware.connect(external, core.state.cycle());
        BootedBoard { file, core, hardware, sent, waits_since, loads, skips, packets, crash }
    }

    /// Returns the external hardware that [was connected](Self::connect).
    #[must_use]
    pub const fn external(&self) -> Option<&A> {
        self.hardware.window.external.as_ref()
    }

    /// Returns the external hardware and the data memory, for changes.
    pub const fn external_and_memory(&mut self) -> (Option<&mut A>, &mut GuestMemory) {
        let Hardware { memory, window, .. } = &mut self.hardware;
        (window.external.as_mut(), memory)
    }

    /// The cycle of the next match of the timer.
    #[must_use]
    pub const fn next_tick(&self) -> u64 {
        self.hardware.timer.next_match()
    }

    /// Sets the count byte of a channel's encoder: the low eight bits of its count.
    pub fn show_encoder(&mut self, channel: usize, counts: u8) {
        self.hardware.window.chips.encoders.set(channel, counts);
    }

    /// Takes a snapshot of the whole board.
    pub fn snapshot(&mut self) -> BootedSnapshot<A> {
        let memory = self.hardware.memory.snapshot();
        let kept = std::mem::take(&mut self.hardware.memory);
        let board = self.clone();
        self.hardware.memory = kept;
        BootedSnapshot { board, memory }
    }

    /// Returns to a snapshot, and continues from there as before.
    pub fn restore(&mut self, snapshot: &BootedSnapshot<A>) {
        let mut memory = std::mem::take(&mut self.hardware.memory);
        memory.restore(&snapshot.memory);
        memory.set_places(snapshot.board.file.places());
        *self = snapshot.board.clone();
        self.hardware.memory = memory;
    }
}
