//! The modelled board as a target, on any engine.

use kmotiondef::{Axes, AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::standing::{UnfinishedThread, UsedAxis};
use runtime::stimulus::Stimulus;
use runtime::trace::{Item, TraceRequest};
use runtime::{Board, BoardSnapshot, OpenBox};
use vm::engine::{AccessRange, CallEnd, ContextId, Engine, FrameView, Hold};
use vm::loaded::LoadedCode;
use vm::memory::GuestMemory;
use vm::scheduler::{SliceOwner, ThreadSet};
use vm::thread::ThreadState;
use vm::trap::Access;

use super::{EXCHANGE, EventSink, Target, TargetSnapshot, word_of};
use crate::capability::Capability;
use crate::error::SnapshotError;
use crate::{HostError, UserProgram};

impl<E: Engine> TargetSnapshot for BoardSnapshot<E> {
    fn tick(&self) -> Ticks {
        self.tick()
    }

    fn is_held(&self) -> bool {
        self.is_held()
    }

    fn bytes_beyond(&self, other: &Self) -> usize {
        self.bytes_beyond(other)
    }
}

/// Bytes of an instruction of bytecode.
const INSTRUCTION: u32 = 8;

/// Copies guest memory; where there is none, zeros.
#[inline]
pub(super) fn read(memory: &GuestMemory, address: GuestAddr, bytes: &mut [u8]) {
    match u32::try_from(bytes.len()).ok().and_then(|length| memory.read_bytes(address, length).ok()) {
        Some(found) => bytes.copy_from_slice(found),
        // The end of a region.
        None => (0..).zip(bytes).for_each(|(offset, byte)| *byte = memory.peek(address.offset(offset))),
    }
}

/// Returns whether there is memory or a register of a device at an address.
pub(super) fn is_mapped(memory: &GuestMemory, address: GuestAddr) -> bool {
    memory.read_bytes(address, 1).is_ok() || memory.is_on_bus(address, Access::Read)
}

impl<E: Engine> Target for Board<E> {
    type Snapshot = BoardSnapshot<E>;

    fn name(&self) -> &'static str {
        "the modelled board"
    }

    fn can(&self, capability: Capability) -> bool {
        match capability {
            Capability::StopTime
            | Capability::Snapshots
            | Capability::Surroundings
            | Capability::Echoes
            | Capability::Recordings => true,
            Capability::Breakpoints
            | Capability::Calls
            | Capability::Watchpoints
            | Capability::AccessWatchpoints => E::HOLDS,
            Capability::ProcessorCode
            | Capability::Answers
            | Capability::Pauses
            | Capability::FastSamples => false,
        }
    }

    fn place_of(&self, address: GuestAddr) -> GuestAddr {
        self.memory().place_of(address)
    }

    fn tick(&self) -> Ticks {
        self.tick()
    }

    fn now(&self) -> Cycles {
        self.now()
    }

    fn step(&mut self, limit: Ticks, events: EventSink<'_>) {
        self.advance(limit, events);
    }

    fn finish(&mut self, events: EventSink<'_>) {
        self.finish(events);
    }

    fn has_ended(&self) -> bool {
        self.has_ended()
    }

    fn turn(&self) -> SliceOwner {
        self.machine().turn()
    }

    fn load(&mut self, program: &UserProgram) -> Result<(), HostError> {
        let loaded = self.load_detailed(program.thread, &program.image, program.details.clone());
        loaded.map_err(|error| program.refused(error))
    }

    fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.debug(thread)
    }

    fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.start(thread).map_err(|_| HostError::NotLoaded(thread))
    }

    fn stop(&mut self, thread: ThreadId) {
        self.stop_threads([thread]);
    }

    fn thread(&self, thread: ThreadId) -> &ThreadState {
        self.thread(thread)
    }

    fn active(&self) -> ThreadSet {
        self.machine().threads().active()
    }

    fn backtrace(&self, thread: ThreadId) -> Vec<CodeAddr> {
        self.machine().backtrace(thread)
    }

    fn interrupted_at(&self, thread: ThreadId) -> Option<CodeAddr> {
        self.machine().interrupted_at(thread)
    }

    fn stack_used(&self, thread: ThreadId) -> Option<u32> {
        Some(self.machine().stack_used(thread))
    }

    fn runs_processor_code(&self, thread: ThreadId) -> Option<bool> {
        self.machine().loaded(thread).map(|loaded| matches!(loaded, LoadedCode::Image(_)))
    }

    fn standing_threads(&self) -> Vec<UnfinishedThread> {
        self.standing_threads()
    }

    fn standing_axes(&self) -> Vec<UsedAxis> {
        self.standing_axes()
    }

    fn threads_that_ran(&self) -> Vec<ThreadId> {
        ThreadId::all().filter(|thread| self.machine().ran().contains(*thread)).collect()
    }

    fn contended_cell(&self) -> Option<(ThreadId, ThreadId, String)> {
        self.contended_cell()
    }

    fn moving(&self) -> Vec<AxisId> {
        self.moving()
    }

    #[inline]
    fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Result<(), HostError> {
        read(self.memory(), address, bytes);
        Ok(())
    }

    fn is_mapped(&self, address: GuestAddr) -> bool {
        is_mapped(self.memory(), address)
    }

    #[inline]
    fn word(&self, address: GuestAddr) -> Option<[u8; 8]> {
        let ram: Option<u64> = self.memory().peek_ram(address);
        ram.map_or_else(|| word_of(self, address), |word| Some(word.to_le_bytes()))
    }

    fn unsent_lines(&self) -> Vec<Vec<u8>> {
        self.unsent_lines()
    }

    fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError> {
        self.memory_mut().poke_bytes(address, bytes).map_err(|_| HostError::Unmapped(address))
    }

    fn axes(&self) -> Axes {
        self.memory().axes()
    }

    fn value(&self, item: Item) -> f64 {
        self.value(item)
    }

    fn bit(&self, bit: Bit) -> bool {
        self.bit(bit)
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.receive(bytes);
    }

    fn is_receiving(&self) -> bool {
        self.is_receiving()
    }

    fn exchange_ticks(&self) -> u64 {
        EXCHANGE
    }

    fn is_in_command(&self) -> bool {
        self.is_in_command()
    }

    fn listen(&mut self, listens: bool) {
        self.listen(listens);
    }

    fn tap_wire(&mut self) {
        self.tap_wire();
    }

    fn take_wire(&mut self) -> Vec<u8> {
        self.take_wire()
    }

    fn flash(&self) -> Option<&[u8]> {
        Some(self.flash())
    }

    fn play(&mut self, stimulus: Stimulus) {
        self.play(stimulus);
    }

    fn drive_input(&mut self, bit: Bit, level: bool) {
        self.drive_input(bit, level);
    }

    fn send_to_uart(&mut self, bytes: &[u8]) {
        self.send_to_uart(bytes);
    }

    fn uart_backlog(&self) -> usize {
        self.uart_backlog()
    }

    fn record(&mut self, request: TraceRequest) {
        self.record(request);
    }

    fn open_box(&self) -> Option<OpenBox> {
        self.open_box()
    }

    fn snapshot(&mut self) -> Result<Self::Snapshot, SnapshotError> {
        Ok(self.snapshot())
    }

    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), SnapshotError> {
        Ok(self.restore(snapshot)?)
    }

    fn work(&self) -> u64 {
        self.machine().work()
    }

    fn held(&self) -> Option<(ContextId, Cycles)> {
        self.machine().held()
    }

    fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        self.engine_mut().set_breakpoints(addresses);
    }

    fn set_stepping(&mut self, context: Option<ContextId>) {
        self.engine_mut().set_stepping(context);
    }

    fn set_watched(&mut self, ranges: &[(GuestAddr, u32)]) {
        self.set_watched(ranges);
    }

    fn set_accessed(&mut self, ranges: &[AccessRange]) {
        self.engine_mut().set_accessed(ranges);
    }

    fn take_change(&mut self) -> Option<usize> {
        self.take_change()
    }

    fn take_hold(&mut self) -> Option<Hold> {
        self.engine_mut().take_hold()
    }

    fn disassemble(&self, address: u32) -> Option<(String, u32)> {
        let at = CodeAddr::new(address)?;
        let programs = ThreadId::all().filter_map(|thread| self.machine().program(thread));
        let text = programs
            .into_iter()
            .find_map(|program| Some(program.ops().get(program.word_at(at)?)?.to_string()));
        Some((text?, INSTRUCTION))
    }

    fn frames(&self, context: ContextId) -> Vec<FrameView> {
        self.machine().engine().frames(context)
    }

    fn set_register(&mut self, context: ContextId, frame: usize, register: u16, slot: u64) -> bool {
        self.engine_mut().set_register(context, frame, register, slot)
    }

    fn result(&self, context: ContextId) -> Option<u64> {
        self.machine().engine().result(context)
    }

    fn call_function(&mut self, context: ContextId, function: GuestAddr, arguments: &[u64]) -> CallEnd {
        self.call_function(context, function, arguments)
    }
}
