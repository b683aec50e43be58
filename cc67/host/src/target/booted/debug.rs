//! Holding programs on a booted firmware: breakpoints, steps, watched memory, and the calls in progress.
//!
//! Holding programs changes neither their execution nor their timing. Stops are set where functions begin and where the
//! firmware is called, so that the calls in progress are known, and at breakpoints. While memory is watched or a
//! context is stepped, the processor runs packet by packet.

use std::collections::BTreeSet;
use std::ops::Range;

use boot::{HaltError, RunOutcome};
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::{CodeAddr, GuestAddr, ThreadId};
use vm::engine::{ContextId, FrameView, Hold, HoldReason};
use vm::memory::GuestMemory;

use super::calls::{self, LastPosition, OpenCalls, is_of_program};
use super::{BootedTarget, LoadedProgram};

/// Bytes that are compared with their previous values.
#[derive(Clone, Debug)]
struct WatchedBytes {
    address: GuestAddr,
    bytes: Vec<u8>,
}

impl WatchedBytes {
    fn present(&self, memory: &GuestMemory) -> impl Iterator<Item = u8> {
        (0..).zip(&self.bytes).map(|(offset, _)| memory.peek::<u8>(self.address.offset(offset)))
    }
}

/// The requests of a debugger, and the positions of programs.
#[derive(Clone, Debug, Default)]
pub(super) struct DebugState {
    /// True if calls are tracked.
    is_on: bool,
    calls: OpenCalls,
    breakpoints: BTreeSet<u32>,
    stepping: Option<ContextId>,
    watched: Vec<WatchedBytes>,
    held: Option<ContextId>,
    hold: Option<Hold>,
}

impl DebugState {
    pub(super) const fn begin(&mut self) {
        self.is_on = true;
    }

    pub(super) const fn held(&self) -> Option<ContextId> {
        self.held
    }

    /// Lets the held context continue.
    pub(super) const fn go_on(&mut self) {
        self.held = None;
        self.hold = None;
    }

    pub(super) fn end(&mut self, thread: ThreadId) {
        self.calls.end(thread);
    }

    pub(super) fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        self.breakpoints = addresses.iter().map(|at| at.get()).collect();
    }

    pub(super) const fn set_stepping(&mut self, context: Option<ContextId>) {
        self.stepping = context;
    }

    pub(super) fn set_watched(&mut self, memory: &GuestMemory, ranges: &[(GuestAddr, u32)]) {
        let watched = |(address, length): &(GuestAddr, u32)| {
            let bytes = (0..*length).map(|offset| memory.peek(address.offset(offset))).collect();
            WatchedBytes { address: *address, bytes }
        };
        self.watched = ranges.iter().map(watched).collect();
    }

    /// The first watched byte that has changed; its new value is the previous value from now on.
    pub(super) fn take_change(&mut self, memory: &GuestMemory) -> Option<usize> {
        let is_changed = |watched: &WatchedBytes| !watched.present(memory).eq(watched.bytes.iter().copied());
        let index = self.watched.iter().position(is_changed)?;
        let watched = self.watched.get_mut(index)?;
        watched.bytes = watched.present(memory).collect();
        Some(index)
    }

    pub(super) const fn take_hold(&mut self) -> Option<Hold> {
        self.hold.take()
    }

    /// The calls in progress of a context, innermost first; the innermost may be a firmware function.
    pub(super) fn frames(&self, context: ContextId) -> Vec<FrameView> {
        let Some(LastPosition { at, firmware, stack }) = self.calls.last(context) else { return Vec::new() };
        let view = |(at, continues_at, stack): (u32, u32, u32)| {
            let (at, continues_at) = (CodeAddr::new(at)?, CodeAddr::new(continues_at)?);
            Some(FrameView { at, continues_at, frame: GuestAddr::new(stack), registers: Vec::new() })
        };
        let mut frames = Vec::new();
        let mut innermost = (at, at, stack);
        if let Some((function, back)) = firmware {
            frames.push((function, function, stack));
            innermost.1 = back;
        }
        frames.push(innermost);
        let callers = self.calls.entered(context);
        frames.extend(callers.filter_map(|entered| Some((entered.call?, entered.back, entered.stack))));
        frames.into_iter().filter_map(view).collect()
    }

    fn hold(&mut self, context: ContextId, reason: HoldReason) -> RunOutcome {
        self.held = Some(context);
        self.hold = Some(Hold { context, reason });
        RunOutcome::ToStop
    }
}

impl BootedTarget {
    /// Sets the stops for breakpoints and for tracking calls.
    pub(super) fn arm_stops(&mut self) {
        if !self.state.debugging.is_on {
            return;
        }
        let file = self.board.file();
        let functions = FIRMWARE_FUNCTIONS.iter().filter_map(|function| file.address(function.name));
        let mut stops: BTreeSet<u32> = functions.map(|at| at.get()).collect();
        stops.extend(self.programs().flat_map(|program| program.functions.keys()));
        stops.extend(&self.state.debugging.breakpoints);
        self.observers.set_stops(&mut self.board, stops);
    }

    fn programs(&self) -> impl Iterator<Item = &LoadedProgram> {
        self.state.loaded.iter().flatten().map(AsRef::as_ref)
    }

    /// The code of the program function that begins at an address, if there is one.
    fn begins(&self, at: u32) -> Option<Range<u32>> {
        self.programs().find_map(|program| program.functions.get(&at).map(|end| at..*end))
    }

    /// Runs to a cycle, or until a program is held.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(super) fn run_to(&mut self, end: u64) -> Result<RunOutcome, HaltError> {
        loop {
            let debugging = &self.state.debugging;
            let is_slow = debugging.stepping.is_some() || !debugging.watched.is_empty();
            let before = (self.board.processor_state().pc, self.board.packets());
            let part = if is_slow { end.min(self.board.cycle() + 1) } else { end };
            let ran = self.observers.run(&mut self.board, part)?;
            if is_slow && let Some(ran) = self.after_packet(before) {
                return Ok(ran);
            }
            match ran {
                RunOutcome::Through if self.board.cycle() >= end => return Ok(RunOutcome::Through),
                RunOutcome::Through => {}
                RunOutcome::ToStop => {
                    let context = self.arrive();
                    let pc = self.board.processor_state().pc;
                    if let Some(context) = context.filter(|_| self.state.debugging.breakpoints.contains(&pc))
                    {
                        return Ok(self.state.debugging.hold(context, HoldReason::Breakpoint));
                    }
                }
            }
        }
    }

    /// Notes the position of the processor; returns the context whose program it executes there.
    fn arrive(&mut self) -> Option<ContextId> {
        let reached = self.board.stop_position();
        let begins = self.begins(reached.pc);
        self.state.debugging.calls.arrive(&reached, begins);
        calls::context(&reached).filter(|_| is_of_program(reached.pc))
    }

    /// Holds the program that has just executed a packet, if it is stepped or has changed a watched byte.
    fn after_packet(&mut self, (pc, packets): (u32, u64)) -> Option<RunOutcome> {
        if self.board.packets() == packets {
            return None;
        }
        let context = self.arrive();
        let stepped = self.state.debugging.stepping;
        // A change by the firmware itself is found at the end of the tick.
        if is_of_program(pc)
            && let Some(context) = context
            && let Some(index) = self.state.debugging.take_change(self.board.memory())
        {
            let reason = HoldReason::Changed { index, by: CodeAddr::new(pc) };
            return Some(self.state.debugging.hold(context, reason));
        }
        let context = context.filter(|context| stepped == Some(*context))?;
        Some(self.state.debugging.hold(context, HoldReason::Step))
    }
}
