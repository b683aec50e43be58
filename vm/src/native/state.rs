//! What compiled code and the engine share of one context.
//!
//! Compiled code reaches every field by its offset from the pointer that is its first
//! parameter. The engine reads and writes the same fields while the fiber is suspended.
//! All of them are cells, so both sides may hold a shared reference for as long as they like.

use std::cell::Cell;
use std::ops::Range;

use kmotiondef::map::STACK_SIZE;

use super::entry::{self, Convert, Leave};
use super::fiber::Yielder;
use super::request::Request;
use crate::engine::Stack;
use crate::verify::MAX_PARAMETERS;

/// Bytes of a stack that hold at most one call: a call takes at least as many.
pub(super) const BYTES_PER_CALL: u32 = 16;

/// Entries in the table of calls: one for each call that the largest stack can hold.
pub(super) const CALLS: usize = (STACK_SIZE / BYTES_PER_CALL) as usize;

const _: () = assert!(CALLS.is_power_of_two());

/// A stretch of SDRAM.
#[derive(Debug, Default)]
#[repr(C)]
pub(super) struct Window {
    /// Offset of its first byte in SDRAM.
    pub(super) start: Cell<u32>,
    /// Bytes of it.
    pub(super) length: Cell<u32>,
}

/// The shared fields. The layout is that of C, because compiled code relies on it.
#[derive(Debug)]
#[repr(C)]
pub(super) struct State {
    /// What is left of the slice; valid whenever the fiber is suspended.
    pub(super) budget: Cell<i64>,
    /// First byte of SDRAM; the same each time the fiber runs, like the two that follow.
    pub(super) sdram: Cell<*mut u8>,
    /// First byte of on-chip RAM.
    pub(super) iram: Cell<*mut u8>,
    /// One byte for each block of SDRAM, not 0 where a store must be checked.
    pub(super) protected: Cell<*const u8>,
    /// Stretches of SDRAM without program text; the first holds the program's own data, the second all stacks.
    pub(super) windows: [Window; 2],
    /// How compiled code makes a request.
    pub(super) leave: Leave,
    /// The conversion of a double to 64 bits modulo 2⁶⁴ where it does not simply fit.
    pub(super) convert: Convert,
    /// Not 0 behind a store to on-chip RAM.
    pub(super) touched: Cell<u32>,
    /// Not 0 in a long slice.
    pub(super) is_long: Cell<u32>,
    /// What suspends the fiber, from its first instruction on.
    pub(super) yielder: Cell<*const Yielder>,
    /// The lowest address that the stack may reach.
    pub(super) limit: Cell<u32>,
    /// The lowest address that it has reached.
    pub(super) lowest: Cell<u32>,
    /// One past its highest address.
    pub(super) top: Cell<u32>,
    /// The return that was executed last.
    pub(super) returned_at: Cell<u32>,
    /// Where each call in progress stands, at the place of its caller's frame; see [`call_entry`].
    pub(super) calls: [Cell<u32>; CALLS],
    /// The last of the requests that are rare, and the answer to it.
    pub(super) request: Cell<Request>,
    pub(super) answer: Cell<u64>,
    /// Where compiled code stores what a request has stored already.
    pub(super) scratch: Cell<u64>,
    /// The function that the next thunk calls.
    pub(super) callee: Cell<*const u8>,
    /// Arguments of a firmware call, and of a call through a pointer.
    pub(super) arguments: [Cell<u64>; MAX_PARAMETERS],
}

impl State {
    /// The state of a context that has not begun and will run on `stack`.
    pub(super) fn new(stack: Stack) -> Self {
        Self {
            budget: Cell::new(0),
            sdram: Cell::new(std::ptr::null_mut()),
            iram: Cell::new(std::ptr::null_mut()),
            protected: Cell::new(std::ptr::null()),
            windows: Default::default(),
            leave: entry::leave,
            convert: entry::convert,
            touched: Cell::new(0),
            is_long: Cell::new(0),
            yielder: Cell::new(std::ptr::null()),
            limit: Cell::new(stack.limit),
            lowest: Cell::new(stack.top),
            top: Cell::new(stack.top),
            returned_at: Cell::new(0),
            calls: [const { Cell::new(0) }; CALLS],
            request: Cell::new(Request { code: 0, at: 0, stack_pointer: 0, a: 0, b: 0 }),
            answer: Cell::new(0),
            scratch: Cell::new(0),
            callee: Cell::new(std::ptr::null()),
            arguments: [const { Cell::new(0) }; MAX_PARAMETERS],
        }
    }

    /// Makes the state that of a context which has not begun and will run on `stack`.
    pub(super) fn reset(&self, stack: Stack) {
        self.limit.set(stack.limit);
        self.lowest.set(stack.top);
        self.top.set(stack.top);
        self.arguments.iter().for_each(|argument| argument.set(0));
    }

    /// Sets where compiled code may store without asking, as offsets in SDRAM.
    pub(super) fn set_windows(&self, ranges: [Range<u32>; 2]) {
        for (window, range) in self.windows.iter().zip(ranges) {
            window.start.set(range.start);
            window.length.set(range.end - range.start);
        }
    }

    /// The most bytes of the stack in use since the reset.
    pub(super) fn stack_used(&self) -> u32 {
        self.top.get() - self.lowest.get()
    }

    /// The call that the function with its frame at `stack_pointer` is making.
    pub(super) fn call_of(&self, stack_pointer: u32) -> usize {
        self.calls[call_entry(stack_pointer)].get() as usize
    }
}

/// Which entry of [`State::calls`] belongs to the frame at `stack_pointer`.
///
/// No two frames of one stack have the same, since they lie at least [`BYTES_PER_CALL`] apart
/// and no stack is larger than the table covers.
const fn call_entry(stack_pointer: u32) -> usize {
    (stack_pointer / BYTES_PER_CALL) as usize % CALLS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::ContextId;

    #[test]
    fn every_frame_of_a_stack_has_its_own_entry() {
        let Stack { limit, top } = ContextId::CALLBACK.stack(false);
        let mut entries: Vec<_> = (limit..top).step_by(BYTES_PER_CALL as usize).map(call_entry).collect();
        entries.sort_unstable();
        entries.dedup();
        assert_eq!(entries.len(), CALLS);
    }
}
