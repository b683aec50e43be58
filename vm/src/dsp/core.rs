//! One processor context: executes packet after packet.

use super::cache::Cache;
use super::decode::{MicroOp, NoPacket, STACK, places};
use super::idle::{BranchAction, IdleDetector};
use super::loops::Loops;
use super::memory::Memory;
#[cfg(feature = "native")]
use super::native::{Account, RegionTranslator, TRANSLATOR};
use super::pipeline::{CyclesEnd, State};
use super::watched::WatchedMemory;
use crate::trap::{Fault, TrapKind};

/// Cycles after which code that never allows an interrupt is taken for an endless loop: 1 ms.
///
/// The board loses ticks, and with them position, long before that.
const LONGEST_SHADOW: i64 = 200_000;

/// The reason why a core returned.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub enum Halt {
    /// The cycles are used up, and an interrupt is possible here.
    Preempted,
    /// The next packet would be at this address, where the context has no code.
    Left(u32),
    /// A packet could not be executed.
    Faulted(TrapKind),
    /// The next packet is at one of the [stops](Core::set_stops); a run from there executes it.
    Stopped,
}

/// The translator of hot code to code of the host.
#[cfg(feature = "native")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct HotCode(RegionTranslator);

/// Placeholder for the translator in builds without one.
#[cfg(not(feature = "native"))]
#[derive(Clone, Copy, Debug)]
pub(crate) enum HotCode {}

impl HotCode {
    /// The translator of this build, if it has one.
    #[cfg(feature = "native")]
    pub(crate) const HERE: Option<Self> = Some(Self(TRANSLATOR));
    #[cfg(not(feature = "native"))]
    pub(crate) const HERE: Option<Self> = None;
}

/// The points at which a core stops when its cycles are used up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum StopPoints {
    /// At points where an interrupt is possible; a long time without one is a fault.
    #[default]
    Slice,
    /// At the next packet.
    Next,
    /// At points where an interrupt is possible, or at the first packet at or after this cycle.
    Interrupt(u64),
}

/// Registers, results in flight, decoded packets.
#[derive(Clone, Debug, Default)]
pub struct Core {
    /// Registers, and the results in flight to them.
    pub state: State,
    cache: Cache,
    stack: Option<StackWatch>,
    packets: u64,
    /// The instruction of the last fault.
    faulted_at: Option<u32>,
    border: StopPoints,
    /// The stop that was reported last: the next run executes its packet.
    passed: Option<u32>,
    idle: IdleDetector,
    skips: bool,
    loops: Loops,
    /// Hot code translated to host code, if translation is on.
    #[cfg(feature = "native")]
    native: Option<Box<super::native::Native>>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct StackWatch {
    limit: u32,
    top: u32,
    /// The lowest stack pointer so far.
    lowest: Option<u32>,
}

impl Core {
    /// Is before the packet at `pc`, all registers 0, interrupts possible.
    #[must_use]
    pub fn new(pc: u32) -> Self {
        let mut core = Self::default();
        core.state.pc = pc;
        core
    }

    /// Watches B15: below `limit` is a fault; bytes are counted from `top` down.
    pub const fn watch_stack(&mut self, limit: u32, top: u32) {
        self.stack = Some(StackWatch { limit, top, lowest: self.lowest_stack() });
    }

    /// The lowest B15 while it was watched.
    #[must_use]
    pub const fn lowest_stack(&self) -> Option<u32> {
        match self.stack {
            Some(stack) => stack.lowest,
            None => None,
        }
    }

    /// The instruction that caused the last fault, if it is known to belong to the packet that the core is about to
    /// execute.
    #[must_use]
    pub const fn faulted_at(&self) -> Option<u32> {
        self.faulted_at
    }

    /// Packets executed.
    #[must_use]
    pub const fn packets(&self) -> u64 {
        self.packets
    }

    /// Forgets decoded packets: memory has changed.
    pub fn forget_code(&mut self) {
        self.cache.clear();
    }

    /// Executes packets until no cycles are left and an interrupt is possible.
    pub fn run<M: Memory>(&mut self, memory: &mut M) -> Halt {
        self.border = StopPoints::Slice;
        self.idle.clear();
        self.run_to_border(memory)
    }

    /// Acts as [`run`](Self::run), and reports the address of each packet, its cycles, and the state after it.
    pub fn run_counted<M: Memory>(
        &mut self,
        memory: &mut M,
        count: &mut dyn FnMut(u32, i64, &State),
    ) -> Halt {
        self.border = StopPoints::Slice;
        self.count_to_border(memory, &mut |_, pc, cycles, state| count(pc, cycles, state))
    }

    /// Acts as [`run_until`](Self::run_until), packet by packet, and reports the memory, the address of each packet,
    /// its cycles, and the state after it.
    pub fn count_until<M: Memory>(
        &mut self,
        memory: &mut M,
        until: u64,
        count: &mut dyn FnMut(&M, u32, i64, &State),
    ) -> Halt {
        self.border = StopPoints::Next;
        self.state.clock.set_end(until);
        self.count_to_border(memory, count)
    }

    /// Acts as [`run_to_interrupt`](Self::run_to_interrupt), packet by packet, and reports each.
    pub fn count_to_interrupt<M: Memory>(
        &mut self,
        memory: &mut M,
        until: u64,
        count: &mut dyn FnMut(&M, u32, i64, &State),
    ) -> Halt {
        self.border = StopPoints::Interrupt(until);
        self.state.clock.deadline = self.state.clock.cycle;
        self.count_to_border(memory, count)
    }

    fn count_to_border<M: Memory>(
        &mut self,
        memory: &mut M,
        count: &mut dyn FnMut(&M, u32, i64, &State),
    ) -> Halt {
        self.idle.clear();
        loop {
            if self.state.clock.is_over()
                && let Some(halt) = self.border.halt(&self.state)
            {
                return halt;
            }
            if self.stops_here() {
                return Halt::Stopped;
            }
            let (pc, left) = (self.state.pc, self.state.clock.left());
            if let Err(halt) = self.step(memory) {
                return halt;
            }
            if self.state.is_idle {
                self.wait();
            }
            count(memory, pc, left - self.state.clock.left(), &self.state);
        }
    }

    /// Stops every run before the packets at these addresses, and nowhere else; a run that starts at a reported stop
    /// executes its packet. Stops change neither the instructions that are executed nor their timing.
    pub fn set_stops(&mut self, addresses: impl IntoIterator<Item = u32>) {
        self.passed = self.passed.filter(|at| *at == self.state.pc);
        self.cache.set_stops(addresses);
    }

    /// The stops.
    #[must_use]
    pub fn stops(&self) -> &[u32] {
        self.cache.stops()
    }

    /// Reports whether the next packet is at a stop that was not just reported.
    fn stops_here(&mut self) -> bool {
        let pc = self.state.pc;
        if !self.cache.is_stop(pc) || self.passed.take() == Some(pc) {
            return false;
        }
        self.passed = Some(pc);
        true
    }

    /// Sets whether [`run_until`](Self::run_until) skips the iterations of loops that wait. The results stay the same.
    pub const fn skip_waits(&mut self, whether: bool) {
        self.skips = whether;
    }

    /// Cycles that were skipped.
    #[must_use]
    pub const fn skipped(&self) -> u64 {
        self.idle.skipped
    }

    /// Executes packets up to the first that begins in cycle `until` or later.
    pub fn run_until<M: Memory>(&mut self, memory: &mut M, until: u64) -> Halt {
        self.border = StopPoints::Next;
        self.idle.clear();
        self.state.clock.set_end(until);
        self.run_to_border(memory)
    }

    /// Acts as [`run_until`](Self::run_until), but stops at the first point at which an interrupt is possible.
    pub fn run_to_interrupt<M: Memory>(&mut self, memory: &mut M, until: u64) -> Halt {
        self.border = StopPoints::Interrupt(until);
        self.idle.clear();
        self.state.clock.deadline = self.state.clock.cycle;
        self.run_to_border(memory)
    }

    fn run_to_border<M: Memory>(&mut self, memory: &mut M) -> Halt {
        let has_stops = !self.cache.stops().is_empty();
        loop {
            if has_stops {
                let is_over = self.state.clock.is_over();
                if let Some(halt) = self.border.halt(&self.state).filter(|_| is_over) {
                    return halt;
                }
                if self.stops_here() {
                    return Halt::Stopped;
                }
            } else {
                #[cfg(feature = "native")]
                self.run_native(memory);
            }
            let index = match self.find(memory) {
                Ok(index) => index,
                Err(NoPacket::Outside) => return Halt::Left(self.state.pc),
                Err(NoPacket::Fault(fault)) => return Halt::Faulted(fault.into()),
            };
            let from = self.state.pc;
            if let Err(halt) = self.run_from::<true, M>(index, memory) {
                return halt;
            }
            if self.state.is_idle {
                self.wait();
            }
            if self.state.pc <= from {
                if self.skips {
                    self.went_back(memory);
                } else if !has_stops && let Err(halt) = self.run_loop(memory) {
                    return halt;
                }
            }
        }
    }

    /// Turns the translation of hot code to host code on or off, if this build supports it. The results stay the same.
    pub fn translate(&mut self, whether: bool) {
        self.translate_hot(if whether { HotCode::HERE } else { None });
    }

    /// Sets the translator of hot code; `None` turns translation off.
    pub(super) fn translate_hot(&mut self, hot: Option<HotCode>) {
        #[cfg(feature = "native")]
        {
            self.native = hot.map(|HotCode(translator)| Box::new(super::native::Native::new(translator)));
        }
        #[cfg(not(feature = "native"))]
        let _ = hot;
    }

    /// Packets that were executed as code of the host.
    #[must_use]
    pub fn translated(&self) -> u64 {
        #[cfg(feature = "native")]
        return self.native.as_ref().map_or(0, |native| native.packets());
        #[cfg(not(feature = "native"))]
        0
    }

    /// Called when a branch arrives: executes the translated code that begins there.
    #[cfg(feature = "native")]
    #[inline]
    fn run_native<M: Memory>(&mut self, memory: &mut M) {
        if self.native.is_none() || self.skips {
            return;
        }
        let Some(native) = &mut self.native else { return };
        let stack = self.stack.map_or((0, u32::MAX), |stack| (stack.limit, stack.top));
        let lowest = self.stack.and_then(|stack| stack.lowest).unwrap_or(u32::MAX);
        let mut account = Account { stack, lowest, packets: self.packets };
        native.run(&mut self.state, &mut self.cache, memory, &mut account);
        self.packets = account.packets;
        if account.lowest != u32::MAX
            && let Some(stack) = &mut self.stack
        {
            stack.lowest = Some(account.lowest);
        }
    }

    /// Executes one packet, with all cycles it lasts.
    ///
    /// # Errors
    /// Why it could not be executed, or where the context has no code.
    pub fn step<M: Memory>(&mut self, memory: &mut M) -> Result<(), Halt> {
        match self.find(memory) {
            Ok(index) => self.run_from::<false, M>(index, memory),
            Err(NoPacket::Outside) => Err(Halt::Left(self.state.pc)),
            Err(NoPacket::Fault(fault)) => Err(Halt::Faulted(fault.into())),
        }
    }

    /// Called after a backward branch: skips a loop that changes nothing, up to the next border.
    fn went_back<M: Memory>(&mut self, memory: &M) {
        match self.idle.record_branch(self.state.pc, self.state.cycle()) {
            BranchAction::Pass => {}
            BranchAction::TakePicture => {
                self.idle.start_iteration(self.state.picture(), self.packets, memory.touches());
            }
            BranchAction::PictureReached => self.skip_iterations(memory),
        }
    }

    #[cold]
    fn skip_iterations<M: Memory>(&mut self, memory: &M) {
        let picture = self.state.picture();
        let ended = self.idle.end(&picture, self.packets, memory.touches(), |at| memory.fetch(at));
        let (Some((period, packets)), true) = (ended, self.border == StopPoints::Next) else { return };
        let left = self.state.clock.left().max(0).cast_unsigned();
        let iterations = left / period;
        // The slot of a result is its cycle modulo 16.
        let iterations = if picture.has_flight() { iterations / 16 * 16 } else { iterations };
        self.state.skip(iterations * period);
        self.packets += iterations * packets;
        self.idle.skipped += iterations * period;
    }

    /// Called after a backward branch: executes the loop that begins here, if it is known.
    fn run_loop<M: Memory>(&mut self, memory: &mut M) -> Result<(), Halt> {
        #[cfg(feature = "native")]
        if self.native.is_some() {
            return Ok(());
        }
        let Self { state, cache, idle, loops, stack, .. } = self;
        let Some(found) = loops.find(state, cache, memory) else { return Ok(()) };
        let mut memory = WatchedMemory::new(memory, cache, idle);
        let ran = found.run(state, &mut memory, stack.as_mut(), &mut self.packets);
        let WatchedMemory { inner, hits, .. } = memory;
        if let Err((_, Some(number))) = ran {
            self.faulted_at = places(inner, state.pc).get(number).copied();
        }
        hits.into_iter().flatten().for_each(|at| cache.drop_line(at));
        ran.map_err(|(kind, _)| Halt::Faulted(kind))
    }

    fn find<M: Memory>(&mut self, memory: &M) -> Result<u32, NoPacket> {
        if self.state.pc & 3 != 0 {
            return Err(NoPacket::Fault(Fault::OddBranch { target: self.state.pc }));
        }
        self.cache.find(self.state.pc, memory)
    }

    /// Executes one packet, or all consecutive packets in memory up to the point where the next one must be searched
    /// for.
    #[inline(always)]
    fn run_from<const ALL: bool, M: Memory>(&mut self, index: u32, memory: &mut M) -> Result<(), Halt> {
        let Self { state, cache, idle, .. } = self;
        let (packets, mut micros) = cache.follow(index);
        let mut memory = WatchedMemory::new(memory, cache, idle);
        for packet in packets {
            if ALL
                && state.clock.is_over()
                && let Some(halt) = self.border.halt(state)
            {
                return Err(halt);
            }
            state.flight.expect(u32::from(packet.delays));
            if packet.has_branch {
                state.hold_interrupts();
            }
            let (own, rest) = micros.split_at(usize::from(packet.count));
            micros = rest;
            for micro in own {
                if !micro.is_executed(&state.regs) {
                    continue;
                }
                if let Err(kind) = state.execute::<false, _>(micro, &mut memory) {
                    self.faulted_at = instruction(&*memory.inner, state.pc, own, micro);
                    return Err(Halt::Faulted(kind));
                }
            }
            self.packets += 1;
            if packet.moves_stack
                && let Some(stack) = &mut self.stack
            {
                stack.check(state.regs[usize::from(STACK)]).map_err(Halt::Faulted)?;
            }
            state.refuse_undefined().map_err(|fault| Halt::Faulted(fault.into()))?;
            state.pc = packet.end;
            if state.advance(packet.cycles) == CyclesEnd::Branched
                || !ALL
                || !packet.is_linked
                || memory.hits[0].is_some()
            {
                break;
            }
        }
        let hits = memory.hits;
        hits.into_iter().flatten().for_each(|at| self.cache.drop_line(at));
        Ok(())
    }

    /// Executes loops packet by packet from now on; nothing else changes.
    #[cfg(test)]
    pub(super) const fn keep_to_packets(&mut self) {
        self.loops.turn_off();
    }

    /// The number of packets executed as part of loops.
    #[cfg(test)]
    pub(super) fn packets_in_loops(&self) -> u64 {
        self.loops.packets()
    }

    /// Waits for the interrupt.
    fn wait(&mut self) {
        self.state.is_idle = false;
        self.state.land_all();
        let left = self.state.clock.left();
        self.state.clock.cycle += left.max(0).cast_unsigned();
    }
}

impl StopPoints {
    /// The cycles are over: why the core stops here, if it does.
    fn halt(self, state: &State) -> Option<Halt> {
        let is_interruptible = state.is_interruptible();
        match self {
            Self::Slice if is_interruptible => Some(Halt::Preempted),
            Self::Slice if state.clock.left() <= -LONGEST_SHADOW => {
                let cycles = LONGEST_SHADOW.unsigned_abs();
                Some(Halt::Faulted(Fault::NoInterrupts { cycles }.into()))
            }
            Self::Slice => None,
            Self::Next => Some(Halt::Preempted),
            Self::Interrupt(until) => (is_interruptible || state.cycle() >= until).then_some(Halt::Preempted),
        }
    }
}

impl StackWatch {
    /// Notes the stack pointer, which has to be within its bounds.
    pub(super) fn check(&mut self, pointer: u32) -> Result<(), TrapKind> {
        self.lowest = Some(self.lowest.map_or(pointer, |lowest| lowest.min(pointer)));
        if pointer < self.limit || pointer > self.top {
            let used = self.top.wrapping_sub(pointer);
            return Err(TrapKind::StackOverflow { used, size: self.top - self.limit });
        }
        Ok(())
    }
}

/// The address of one of the instructions of a packet.
#[cold]
fn instruction<M: Memory>(memory: &M, packet: u32, micros: &[MicroOp], micro: &MicroOp) -> Option<u32> {
    let number = micros.iter().position(|other| std::ptr::eq(other, micro))?;
    places(memory, packet).get(number).copied()
}
