//! A firmware file as a target: programs for the real processor, executed with the firmware itself.
//!
//! Board time begins in the tick in which the programs start, after the firmware has booted and read everything that
//! the PC sent. A call to [`step`](Target::step) ends at the first packet of a tick, so actions between two calls
//! happen at a time that can be reached again.
//!
//! ```text
//! firmware   a firmware that is ready
//! begin      loads programs, connects surroundings, starts
//! debug      holding programs
//! calls      the calls in progress
//! observers  profile, calls of the firmware, stops
//! attached   surroundings attached to the registers
//! ```

mod attached;
mod begin;
mod calls;
mod debug;
mod firmware;
mod observers;

pub use firmware::{BootedFirmware, FirmwareError};

use std::collections::BTreeMap;
use std::sync::Arc;

use boot::{
    BootedBoard, BootedSnapshot, FirmwareFile, HaltError, ProcessorState, ProgramPacket, RunOutcome,
    SentKind, SentLine,
};
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::stimulus::Stimulus;
use runtime::surroundings::{StimulusRequest, Surroundings};
use runtime::trace::{Item, TraceRequest};
use runtime::{Event, EventKind};
use vm::dsp::packet_text;
use vm::engine::{ContextId, FrameView, Hold};
use vm::firmware::ExecutedPacket;
use vm::scheduler::SliceOwner;
use vm::thread::{Progress, ThreadState};

use super::model::{is_mapped, read};
use super::{CONSOLE_LINES, EventSink, Target, TargetSnapshot};
use crate::capability::Capability;
use crate::error::SnapshotError;
use crate::{HostError, UserProgram};
use attached::DelayedSurroundings;
use debug::DebugState;
use observers::Observers;

/// Cycles per tick, and per second.
const TICK: u64 = Cycles::PER_TICK.get() as u64;
const SECOND: u64 = Cycles::PER_SECOND.get() as u64;
/// The number of ticks without a byte and without motion after which nothing more is expected.
const QUIET: u32 = 22;
/// The longest time to wait for the firmware.
const ANSWER: u64 = 2 * SECOND;
/// The longest duration of a command: `Flash` 6.4 s; one with many lines sends throughout.
const COMMAND: u64 = 10 * SECOND;
/// The work of the computer for a packet, relative to a bytecode instruction.
const PACKET_WORK: u64 = 8;

/// A period without events.
#[derive(Clone, Copy, Debug, Default)]
struct Silence {
    ticks: u32,
    /// The number of times the firmware had polled for the PC at the beginning of the period.
    looks: u64,
}

impl Silence {
    /// Counts one more tick.
    const fn note(&mut self, is_busy: bool, looks: u64) {
        self.ticks += 1;
        if is_busy {
            *self = Self { ticks: 0, looks };
        }
    }

    /// Returns whether nothing more is expected: there was no event for a long time, and the firmware executes no
    /// command.
    const fn is_over(&self, looks: u64) -> bool {
        self.ticks >= QUIET && looks > self.looks
    }
}

/// A program in a thread.
#[derive(Clone, Debug)]
struct LoadedProgram {
    debug: DebugInfo,
    /// The start and end addresses of its functions.
    functions: BTreeMap<u32, u32>,
}

/// The state of a target besides its board: all of it is restored with the board.
#[derive(Clone, Debug)]
struct State {
    loaded: [Option<Arc<LoadedProgram>>; ThreadId::MAX as usize],
    threads: [ThreadState; ThreadId::MAX as usize],
    /// The thread that had the last tick.
    turn: SliceOwner,
    /// Lines that programs sent before time began.
    early: Vec<SentLine>,
    /// The times without motion and output, and without an answer to a command.
    rest: Silence,
    answer: Silence,
    /// The cycle until which to wait for an answer.
    answer_until: u64,
    /// The commanded positions of the axes, as bits.
    commands: [u64; 8],
    /// Console lines are discarded.
    is_deaf: bool,
    has_told_loss: bool,
    /// The present tick, once the firmware has crashed and nothing happens any more.
    halted: Option<Ticks>,
    debugging: DebugState,
}

/// A board that runs a firmware file.
#[derive(Debug)]
pub struct BootedTarget {
    board: BootedBoard<DelayedSurroundings>,
    /// The cycle since power-up at which board time is 0.
    origin: u64,
    offered: Vec<UserProgram>,
    observers: Observers,
    state: State,
}

/// A [`BootedTarget`] as it was at an instant.
#[derive(Debug)]
pub struct BootedTargetSnapshot {
    board: BootedSnapshot<DelayedSurroundings>,
    tick: Ticks,
    state: State,
}

impl TargetSnapshot for BootedTargetSnapshot {
    fn tick(&self) -> Ticks {
        self.tick
    }

    fn is_held(&self) -> bool {
        self.state.debugging.held().is_some()
    }

    fn bytes_beyond(&self, other: &Self) -> usize {
        self.board.bytes_beyond(&other.board)
    }
}

impl BootedTarget {
    /// The firmware file.
    #[must_use]
    pub fn file(&self) -> &FirmwareFile {
        self.board.file()
    }

    /// Returns whether a pin is an output, and whether it is high.
    #[must_use]
    pub fn pin(&self, pin: usize) -> (bool, bool) {
        (self.board.is_output(pin), self.board.is_high(pin))
    }

    /// Returns the commanded and the measured positions of the axes, if this firmware has the variables.
    #[must_use]
    pub fn axes(&self) -> Vec<(f64, f64)> {
        Target::axes(self).iter().filter_map(|axis| self.board.axis(axis)).collect()
    }

    /// From now on samples the states of the processor, for a profile.
    pub(crate) fn sample_processor(&mut self) {
        self.observers.sample(self.board.cycle());
    }

    /// Returns the sampled states of the processor, each with the time that its samples represent.
    pub fn sampled(&self) -> impl Iterator<Item = (&ProcessorState, Cycles)> {
        self.observers.sampled()
    }

    fn since_begin(&self, cycle: u64) -> Cycles {
        Cycles::new(i64::try_from(cycle.saturating_sub(self.origin)).unwrap_or(i64::MAX))
    }

    fn surroundings(&mut self) -> Option<&mut Surroundings> {
        let (attached, _) = self.board.external_and_memory();
        attached.map(|attached| &mut attached.surroundings)
    }

    /// Runs to the first packet of the next tick, or until a program is held.
    fn run_tick(&mut self, events: EventSink<'_>) {
        let end = self.origin + (self.tick().get() + u64::from(self.state.debugging.held().is_none())) * TICK;
        self.state.debugging.go_on();
        match self.run_to(end) {
            Ok(RunOutcome::ToStop) => self.note_threads(),
            Ok(RunOutcome::Through) => self.complete_tick(events),
            Err(HaltError::Crashed(crash)) => {
                self.complete_tick(events);
                let at = self.now();
                self.state.halted = Some(Ticks::new((self.board.cycle() - self.origin) / TICK));
                events(Event { at, kind: EventKind::Halted(crash.to_string()) });
            }
        }
    }

    /// Ends a tick: exchanges lines and characters with the surroundings of the board.
    fn complete_tick(&mut self, events: EventSink<'_>) {
        self.note_packets();
        let mut lines = std::mem::take(&mut self.state.early);
        lines.extend(self.board.take_lines());
        let has_sent = !lines.is_empty();
        for line in lines {
            let at = self.since_begin(line.cycle);
            let is_lost = self.state.is_deaf && line.kind == SentKind::Console;
            let is_console = matches!(line.kind, SentKind::Console | SentKind::Request);
            match self.surroundings() {
                _ if is_lost => self.report_loss(at, events),
                // The simulated PC takes lines for files, and shows the others.
                Some(surroundings) if is_console => surroundings.receive_line(line.text, at),
                Some(_) | None => events(Event { at, kind: event_of(line) }),
            }
            self.deliver(events);
        }
        self.deliver(events);
        self.serve(events);
        self.note_threads();
        self.note_silence(has_sent);
    }

    /// Reports once that console lines are lost because nobody reads them. A firmware that waited for the PC would not
    /// take commands either, so nobody could read the waiting lines.
    fn report_loss(&mut self, at: Cycles, events: EventSink<'_>) {
        if !std::mem::replace(&mut self.state.has_told_loss, true) {
            let text = format!(
                "more than {CONSOLE_LINES} console lines wait for their client: further ones are lost"
            );
            events(Event { at, kind: EventKind::Host(text) });
        }
    }

    /// Passes on the events around the board.
    fn deliver(&mut self, events: EventSink<'_>) {
        self.surroundings().map(Surroundings::take_events).unwrap_or_default().into_iter().for_each(events);
    }

    /// Records the packets that programs have executed, if recording is on.
    fn note_packets(&mut self) {
        for ProgramPacket { cycle, cycles, at, thread, text } in self.board.take_packets() {
            let (start, cycles) = (self.since_begin(cycle), Cycles::new(cycles));
            if let (Some(at), Some(surroundings)) = (CodeAddr::new(at), self.surroundings()) {
                surroundings.packet_ran(ExecutedPacket { thread, at, start, cycles, text });
            }
        }
    }

    /// Executes the requests of the stimulus.
    fn serve(&mut self, events: EventSink<'_>) {
        for one in self.surroundings().map(Surroundings::take_asked).unwrap_or_default() {
            match one {
                StimulusRequest::Send(bytes) => self.board.send(&bytes),
                StimulusRequest::Run(thread, name) => {
                    let offered =
                        self.offered.iter().find(|known| known.thread == thread && *known.name() == *name);
                    if let Some(program) = offered.cloned()
                        && self.load(&program).is_ok()
                    {
                        self.board.execute(thread);
                        events(Event { at: self.now(), kind: EventKind::Loaded(thread, name.into()) });
                    }
                }
            }
        }
    }

    /// Updates the set of active threads.
    fn note_threads(&mut self) {
        for thread in ThreadId::all() {
            let is_active = self.board.is_active(thread).unwrap_or(false);
            let state = &mut self.state.threads[thread.index()];
            if is_active == state.is_active() {
                continue;
            }
            *state = if is_active { ThreadState::Active(Progress::Going) } else { ThreadState::Ready };
            if !is_active {
                self.state.debugging.end(thread);
            }
        }
        let number = self.board.processor_state().thread.and_then(|thread| i32::try_from(thread).ok());
        self.state.turn = number.and_then(ThreadId::new).map_or(SliceOwner::Primary, SliceOwner::User);
    }

    /// Updates the periods without events after a tick.
    fn note_silence(&mut self, has_sent: bool) {
        let (looks, has_read) = (self.board.poll_count(), self.board.has_read_all());
        self.state.answer.note(has_sent || !has_read, looks);
        let commands = self.commands();
        let moves = std::mem::replace(&mut self.state.commands, commands) != commands;
        let is_busy = has_sent
            || moves
            || !has_read
            || self.is_awaited()
            || self.board.is_starting()
            || self.state.threads.iter().any(ThreadState::is_active);
        self.state.rest.note(is_busy, looks);
    }

    /// Returns whether something is still expected from the surroundings of the board.
    fn is_awaited(&self) -> bool {
        let memory = self.board.memory();
        self.board.external().is_some_and(|attached| attached.surroundings.is_busy(memory))
    }

    /// Returns the commanded positions of the axes, as bits, to see whether they move.
    fn commands(&self) -> [u64; 8] {
        std::array::from_fn(|axis| {
            let place = AxisId::new(axis as i32).and_then(|axis| self.board.axis(axis));
            place.map_or(0, |(dest, _)| dest.to_bits())
        })
    }
}

/// A line of a firmware without surroundings.
fn event_of(line: SentLine) -> EventKind {
    match line.kind {
        SentKind::Console => EventKind::ConsoleLine(line.text),
        SentKind::Reply => EventKind::Reply(line.text),
        SentKind::Aborted => EventKind::Aborted,
        SentKind::Request => {
            let text = String::from_utf8_lossy(line.text.get(1..).unwrap_or_default()).into_owned();
            EventKind::Host(format!(
                "the program asks for the file `{text}`; files are not served with this firmware yet"
            ))
        }
    }
}

impl Target for BootedTarget {
    type Snapshot = BootedTargetSnapshot;

    fn name(&self) -> &'static str {
        "the firmware file"
    }

    fn can(&self, capability: Capability) -> bool {
        match capability {
            Capability::StopTime
            | Capability::Snapshots
            | Capability::Breakpoints
            | Capability::Watchpoints
            | Capability::Echoes
            | Capability::ProcessorCode => true,
            Capability::Surroundings | Capability::Recordings => self.board.external().is_some(),
            Capability::AccessWatchpoints
            | Capability::Answers
            | Capability::Calls
            | Capability::FastSamples
            | Capability::Pauses => false,
        }
    }

    fn tick(&self) -> Ticks {
        let is_held = u64::from(self.state.debugging.held().is_some());
        let passed = (self.board.cycle() - self.origin) / TICK + is_held;
        self.state.halted.unwrap_or(Ticks::new(passed))
    }

    fn now(&self) -> Cycles {
        self.since_begin(self.board.cycle())
    }

    fn step(&mut self, limit: Ticks, events: EventSink<'_>) {
        if self.state.halted.is_some() {
            self.state.halted = Some(limit.max(self.tick()));
        } else if self.tick() < limit || self.state.debugging.held().is_some() {
            self.run_tick(events);
        }
    }

    fn finish(&mut self, events: EventSink<'_>) {
        let now = self.now();
        if let (Some(attached), memory) = self.board.external_and_memory() {
            attached.surroundings.finish(memory, now);
        }
        self.deliver(events);
    }

    fn has_ended(&self) -> bool {
        self.state.halted.is_some() || self.state.rest.is_over(self.board.poll_count())
    }

    fn turn(&self) -> SliceOwner {
        self.state.turn
    }

    fn load(&mut self, program: &UserProgram) -> Result<(), HostError> {
        self.load_program(program)
    }

    fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.state.loaded[thread.index()].as_ref().map(|loaded| &loaded.debug)
    }

    fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        if self.state.loaded[thread.index()].is_none() {
            return Err(HostError::NotLoaded(thread));
        }
        self.board.execute(thread);
        Ok(())
    }

    fn stop(&mut self, thread: ThreadId) {
        self.board.send_line(format!("Kill{thread}").as_bytes());
    }

    fn thread(&self, thread: ThreadId) -> &ThreadState {
        &self.state.threads[thread.index()]
    }

    fn backtrace(&self, thread: ThreadId) -> Vec<CodeAddr> {
        self.frames(ContextId::of(thread)).into_iter().map(|frame| frame.at).collect()
    }

    /// A thread at an instruction of its own program is not in a call that waits.
    fn interrupted_at(&self, thread: ThreadId) -> Option<CodeAddr> {
        self.backtrace(thread).first().copied().filter(|at| calls::is_of_program(at.get()))
    }

    fn firmware_function(&self, address: CodeAddr) -> Option<String> {
        let is_program = calls::is_of_program(address.get());
        self.board.file().function_at(address.get()).filter(|_| !is_program).map(|(name, _)| name)
    }

    fn has_item(&self, item: Item) -> bool {
        !item.is_only_modelled()
    }

    fn runs_processor_code(&self, thread: ThreadId) -> Option<bool> {
        self.state.loaded[thread.index()].as_ref().map(|_| true)
    }

    fn place_of(&self, address: GuestAddr) -> GuestAddr {
        self.board.memory().place_of(address)
    }

    fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Result<(), HostError> {
        read(self.board.memory(), address, bytes);
        Ok(())
    }

    fn is_mapped(&self, address: GuestAddr) -> bool {
        is_mapped(self.board.memory(), address)
    }

    fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError> {
        self.board.memory_mut().poke_bytes(address, bytes).map_err(|_| HostError::Unmapped(address))
    }

    fn value(&self, item: Item) -> f64 {
        let memory = self.board.memory();
        self.board.external().map_or(0.0, |attached| attached.surroundings.value(item, memory))
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.board.send(bytes);
        self.state.answer = Silence { ticks: 0, looks: self.board.poll_count() };
        self.state.answer_until = self.board.cycle() + COMMAND;
        self.state.rest = self.state.answer;
    }

    fn is_receiving(&self) -> bool {
        self.state.halted.is_none() && !self.board.has_read_all()
    }

    fn is_answering(&self) -> bool {
        let State { halted, answer, answer_until, .. } = &self.state;
        halted.is_none() && !answer.is_over(self.board.poll_count()) && self.board.cycle() < *answer_until
    }

    fn exchange_ticks(&self) -> u64 {
        0
    }

    fn is_in_command(&self) -> bool {
        // Only the firmware knows.
        false
    }

    fn listen(&mut self, listens: bool) {
        self.state.is_deaf = !listens;
    }

    fn tap_wire(&mut self) {
        self.board.tap_wire();
    }

    fn take_wire(&mut self) -> Vec<u8> {
        self.board.take_wire()
    }

    fn flash(&self) -> Option<&[u8]> {
        Some(self.board.flash())
    }

    fn play(&mut self, stimulus: Stimulus) {
        let now = self.now();
        if let (Some(attached), memory) = self.board.external_and_memory() {
            attached.surroundings.play(stimulus, memory, now);
        }
    }

    fn drive_input(&mut self, bit: Bit, level: bool) {
        let now = self.now();
        if let Some(surroundings) = self.surroundings() {
            surroundings.drive_input(bit, level, now);
        }
    }

    fn send_to_uart(&mut self, bytes: &[u8]) {
        let now = self.now();
        if let Some(surroundings) = self.surroundings() {
            surroundings.send_to_uart(bytes, now);
        }
    }

    fn uart_backlog(&self) -> usize {
        self.board.external().map_or(0, |attached| attached.surroundings.uart_backlog())
    }

    fn record(&mut self, request: TraceRequest) {
        self.board.keep_packets(request.packets.is_some());
        if let (Some(attached), memory) = self.board.external_and_memory() {
            attached.surroundings.record(request, memory);
        }
    }

    fn snapshot(&mut self) -> Result<Self::Snapshot, SnapshotError> {
        Ok(BootedTargetSnapshot {
            tick: self.tick(),
            board: self.board.snapshot(),
            state: self.state.clone(),
        })
    }

    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), SnapshotError> {
        self.board.restore(&snapshot.board);
        self.state.clone_from(&snapshot.state);
        self.observers.arm(&mut self.board);
        Ok(())
    }

    fn work(&self) -> u64 {
        self.board.packets() * PACKET_WORK
    }

    fn prepare_to_hold(&mut self) {
        self.state.debugging.begin();
        self.arm_stops();
    }

    fn held(&self) -> Option<(ContextId, Cycles)> {
        Some((self.state.debugging.held()?, self.now()))
    }

    fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        self.state.debugging.set_breakpoints(addresses);
        self.arm_stops();
    }

    fn set_stepping(&mut self, context: Option<ContextId>) {
        self.state.debugging.set_stepping(context);
    }

    fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.state.debugging.set_watched(self.board.memory(), ranges);
    }

    fn take_change(&mut self) -> Option<usize> {
        self.state.debugging.take_change(self.board.memory())
    }

    fn take_hold(&mut self) -> Option<Hold> {
        self.state.debugging.take_hold()
    }

    fn frames(&self, context: ContextId) -> Vec<FrameView> {
        self.state.debugging.frames(context)
    }

    fn disassemble(&self, address: u32) -> Option<(String, u32)> {
        let text = packet_text(address, |at| Some(self.board.memory().peek(GuestAddr::new(at))));
        let words = text.matches(" || ").count() as u32 + 1;
        calls::is_of_program(address).then_some((text, 4 * words))
    }

    fn registers(&self) -> Vec<(String, u32)> {
        self.board.registers()
    }
}
