//! The calls in progress of the programs on a booted board.
//!
//! Code for the processor keeps no list of its callers. So each entry to a function of a program is noted, with the
//! call and the stack pointer; a function has been left when the stack is shorter, or has the same depth but the code
//! belongs to another function.

use std::ops::Range;

use boot::StopPosition;
use kmotiondef::ThreadId;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT};
use vm::engine::ContextId;

/// A function of a program that was entered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct EnteredFunction {
    /// Its code.
    pub(super) code: Range<u32>,
    /// The packet that called it, or a packet near the call; `None` if the firmware called it.
    pub(super) call: Option<u32>,
    /// The return address.
    pub(super) back: u32,
    /// The stack pointer at its first packet.
    pub(super) stack: u32,
}

/// The calls of a context.
#[derive(Clone, Debug, Default)]
struct ContextCalls {
    /// The functions entered, outermost first.
    entered: Vec<EnteredFunction>,
    /// The last known position of its program.
    last: Option<LastPosition>,
}

/// The last known position of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LastPosition {
    /// The packet.
    pub(super) at: u32,
    /// The firmware function that was called there, and its return address.
    pub(super) firmware: Option<(u32, u32)>,
    /// The stack pointer.
    pub(super) stack: u32,
}

/// The calls of all threads and of the call-back.
#[derive(Clone, Debug, Default)]
pub(super) struct OpenCalls([ContextCalls; ContextId::COUNT]);

impl OpenCalls {
    /// Notes that the processor is at a packet, which may be the first of a function with this code.
    pub(super) fn arrive(&mut self, arrival: &StopPosition, begins: Option<Range<u32>>) {
        let Some(context) = context(arrival) else { return };
        let known = &mut self.0[context.index()];
        let StopPosition { pc, call, return_address: back, stack, .. } = *arrival;
        let call = call.filter(|at| is_of_program(*at));
        if !is_of_program(pc) {
            known.last = call.map(|at| LastPosition { at, firmware: Some((pc, back)), stack }).or(known.last);
            return;
        }
        known.last = Some(LastPosition { at: pc, firmware: None, stack });
        let is_left =
            |one: &mut EnteredFunction| stack > one.stack || stack == one.stack && !one.code.contains(&pc);
        while known.entered.pop_if(is_left).is_some() {}
        let Some(code) = begins else { return };
        // A loop that jumps back to the first packet is not a call.
        if known.entered.last().is_none_or(|one| one.code != code || one.stack != stack) {
            // After an interrupt there, the previous branch is not the call.
            let call = call.or(Some(back.wrapping_sub(4))).filter(|at| is_of_program(*at));
            known.entered.push(EnteredFunction { code, call, back, stack });
        }
    }

    /// The functions entered and not yet left, innermost first.
    pub(super) fn entered(&self, context: ContextId) -> impl ExactSizeIterator<Item = &EnteredFunction> {
        self.0[context.index()].entered.iter().rev()
    }

    /// Returns the last known position of a context's program.
    pub(super) fn last(&self, context: ContextId) -> Option<LastPosition> {
        self.0[context.index()].last
    }

    /// Notes that a thread has ended.
    pub(super) fn end(&mut self, thread: ThreadId) {
        self.0[ContextId::of(thread).index()] = ContextCalls::default();
    }
}

/// The context whose code is executed: a thread or the call-back; `None` for the firmware itself and its interrupt.
pub(super) fn context(arrival: &StopPosition) -> Option<ContextId> {
    if !arrival.is_masked {
        return arrival.thread.map(ContextId::of);
    }
    let is_callback = is_of_program(arrival.pc) || arrival.call.is_some_and(is_of_program);
    is_callback.then_some(ContextId::CALLBACK)
}

/// Returns whether an address is in the part of memory for which programs are linked.
pub(super) fn is_of_program(at: u32) -> bool {
    (PROGRAM_BASE..PROGRAM_LIMIT).contains(&at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAIN: Range<u32> = 0x8005_0000..0x8005_0100;
    const INNER: Range<u32> = 0x8005_0100..0x8005_0180;
    const FIRMWARE: u32 = 0x8000_4000;

    fn at(pc: u32, call: Option<u32>, stack: u32) -> StopPosition {
        StopPosition {
            pc,
            thread: ThreadId::new(1),
            is_masked: false,
            call,
            return_address: FIRMWARE + 8,
            stack,
        }
    }

    fn depth(calls: &OpenCalls) -> usize {
        calls.entered(ContextId::of(ThreadId::new(1).expect("there is a thread 1"))).len()
    }

    #[test]
    fn calls_and_returns_are_tracked() {
        let mut calls = OpenCalls::default();
        let mut arrive = |pc, call, stack, begins| {
            calls.arrive(&at(pc, call, stack), begins);
            depth(&calls)
        };
        assert_eq!(arrive(MAIN.start, Some(FIRMWARE), 1000, Some(MAIN)), 1);
        assert_eq!(arrive(MAIN.start + 8, None, 900, None), 1);
        assert_eq!(arrive(INNER.start, Some(MAIN.start + 8), 900, Some(INNER)), 2);
        // A leaf without a frame continues, and jumps back to its first packet.
        assert_eq!(arrive(INNER.start + 8, None, 900, None), 2);
        assert_eq!(arrive(INNER.start, None, 900, Some(INNER)), 2);
        // It calls itself with a frame, and the firmware from there.
        assert_eq!(arrive(INNER.start, Some(INNER.start + 16), 850, Some(INNER)), 3);
        assert_eq!(arrive(FIRMWARE, Some(INNER.start + 8), 850, None), 3);
        assert_eq!(arrive(INNER.start + 12, None, 900, None), 2);
        assert_eq!(arrive(MAIN.start + 16, None, 900, None), 1);
        // The thread starts again, wherever it was.
        assert_eq!(arrive(MAIN.start, Some(FIRMWARE), 1000, Some(MAIN)), 1);
    }
}
