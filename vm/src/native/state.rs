//! The state of one context that compiled code and the engine share.
//!
//! Compiled code reaches every field by its offset from the pointer that is its first parameter. The engine reads and
//! writes the same fields while the fiber is suspended. All of them are cells, so both sides may hold a shared
//! reference for as long as they like. A snapshot copies them, and restores them into the same state, because compiled
//! code holds its address.

use std::cell::Cell;
use std::ops::Range;

use kmotiondef::map::STACK_SIZE;

use super::request::{Request, Yielder};
use crate::engine::Stack;
use crate::filter::AccessFilter;
use crate::verify::MAX_PARAMETERS;

/// The minimum size of a call's frame: a stack of this many bytes holds at most one call.
pub(super) const BYTES_PER_CALL: u32 = 16;

/// Entries in the table of calls: one for each call that the largest stack can hold.
pub(super) const CALLS: usize = (STACK_SIZE / BYTES_PER_CALL) as usize;

const _: () = assert!(CALLS.is_power_of_two());

/// The function by which compiled code makes a request: state, code, instruction, stack pointer and two operands.
pub(super) type RequestFn = unsafe extern "C" fn(*const State, u32, u32, u32, u64, u64) -> u64;

/// A conversion that compiled code leaves to Rust.
pub(super) type ConvertFn = extern "C" fn(f64) -> i64;

/// The functions that compiled code calls by pointers in the state.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct HostFunctions {
    /// The function by which compiled code makes a request.
    pub(super) request: RequestFn,
    /// The conversion of a double to 64 bits modulo 2⁶⁴, for values out of range.
    pub(super) convert: ConvertFn,
}

/// Restores cells from a copy.
pub(super) trait Restore {
    /// Takes over all values of `saved`.
    fn restore(&self, saved: &Self);
}

impl<T: Copy> Restore for Cell<T> {
    fn restore(&self, saved: &Self) {
        self.set(saved.get());
    }
}

impl<T: Restore, const N: usize> Restore for [T; N] {
    fn restore(&self, saved: &Self) {
        self.iter().zip(saved).for_each(|(own, saved)| own.restore(saved));
    }
}

/// Structs of cells in the layout of C, because compiled code relies on it.
macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident { $($(#[$row:meta])* $field:ident: $ty:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Clone, Debug)]
        #[repr(C)]
        pub(super) struct $name {
            $($(#[$row])* pub(super) $field: $ty,)*
        }

        impl Restore for $name {
            fn restore(&self, saved: &Self) {
                $(self.$field.restore(&saved.$field);)*
            }
        }
    )*};
}
shared! {
    /// A segment of SDRAM.
    Window {
        /// Offset of its first byte in SDRAM.
        start: Cell<u32>,
        /// Bytes of it.
        length: Cell<u32>,
    }

    /// The addresses of guest memory, the same each time the fiber runs.
    Ram {
        /// First byte of SDRAM.
        sdram: Cell<*mut u8>,
        /// First byte of on-chip RAM.
        iram: Cell<*mut u8>,
        /// One byte for each block of SDRAM, not 0 where a store must be checked.
        protected: Cell<*const u8>,
        /// One byte for each page of SDRAM: the mark of the only context that accesses it.
        owners: Cell<*const u8>,
        /// Stretches of SDRAM without program text; the first holds the program's own data, the second all stacks.
        windows: [Window; 2],
    }

    /// The flags of the slice, from one side to the other.
    Signs {
        /// Not 0 after a store to on-chip RAM.
        touched: Cell<u32>,
        /// Not 0 in a long slice.
        is_long: Cell<u32>,
        /// The mark of the context on its pages.
        owner: Cell<u32>,
        /// The tick of the slice.
        tick: Cell<u64>,
    }

    /// The guest stack.
    Bounds {
        /// The lowest address that it may reach.
        limit: Cell<u32>,
        /// The lowest address that it has reached.
        lowest: Cell<u32>,
        /// One past its highest address.
        top: Cell<u32>,
    }

    /// The values exchanged in requests and calls.
    Exchange {
        /// The last of the requests that are rare, and the answer to it.
        request: Cell<Request>,
        answer: Cell<u64>,
        /// The destination of stores that a request has already made.
        scratch: Cell<u64>,
        /// The function that the next thunk calls.
        callee: Cell<*const u8>,
        /// Arguments of a firmware call, and of a call through a pointer.
        arguments: [Cell<u64>; MAX_PARAMETERS],
    }

    /// The state.
    State {
        /// The rest of the slice's budget, in cycles; valid whenever the fiber is suspended.
        budget: Cell<i64>,
        /// Guest memory.
        ram: Ram,
        /// The functions that compiled code calls.
        ways_out: HostFunctions,
        /// The flags of the slice.
        signs: Signs,
        /// The handle that suspends the fiber, from its first instruction on.
        yielder: Cell<*const Yielder>,
        /// The guest stack.
        stack: Bounds,
        /// The return that was executed last.
        returned_at: Cell<u32>,
        /// The position of each call in progress, in the entry of its caller's frame; see [`call_entry`].
        calls: [Cell<u32>; CALLS],
        /// Requests and calls.
        exchange: Exchange,
        /// The accesses that are not reported again.
        filter: AccessFilter,
        /// An address on the native stack near that at which the fiber is suspended.
        suspended_at: Cell<usize>,
    }
}

impl Restore for AccessFilter {
    fn restore(&self, saved: &Self) {
        Self::put_back(self, saved);
    }
}

impl Restore for HostFunctions {
    // They are the same in every state.
    fn restore(&self, _: &Self) {}
}

impl State {
    /// The state of a context that has not begun and will run on `stack`.
    pub(super) fn new(stack: Stack, ways_out: HostFunctions) -> Self {
        let window = || Window { start: Cell::new(0), length: Cell::new(0) };
        Self {
            budget: Cell::new(0),
            ram: Ram {
                sdram: Cell::new(std::ptr::null_mut()),
                iram: Cell::new(std::ptr::null_mut()),
                protected: Cell::new(std::ptr::null()),
                owners: Cell::new(std::ptr::null()),
                windows: [window(), window()],
            },
            ways_out,
            signs: Signs {
                touched: Cell::new(0),
                is_long: Cell::new(0),
                owner: Cell::new(0),
                tick: Cell::new(0),
            },
            yielder: Cell::new(std::ptr::null()),
            stack: Bounds {
                limit: Cell::new(stack.limit),
                lowest: Cell::new(stack.top),
                top: Cell::new(stack.top),
            },
            returned_at: Cell::new(0),
            calls: [const { Cell::new(0) }; CALLS],
            exchange: Exchange {
                request: Cell::new(Request { code: 0, at: 0, stack_pointer: 0, a: 0, b: 0 }),
                answer: Cell::new(0),
                scratch: Cell::new(0),
                callee: Cell::new(std::ptr::null()),
                arguments: [const { Cell::new(0) }; MAX_PARAMETERS],
            },
            filter: AccessFilter::new(),
            suspended_at: Cell::new(0),
        }
    }

    /// Resets the state to that of a context that has not begun and will run on `stack`.
    pub(super) fn reset(&self, stack: Stack) {
        self.stack.limit.set(stack.limit);
        self.stack.lowest.set(stack.top);
        self.stack.top.set(stack.top);
        self.exchange.arguments.iter().for_each(|argument| argument.set(0));
        self.filter.clear();
    }

    /// Sets where compiled code may store without asking, as offsets in SDRAM.
    pub(super) fn set_windows(&self, ranges: [Range<u32>; 2]) {
        for (window, range) in self.ram.windows.iter().zip(ranges) {
            window.start.set(range.start);
            window.length.set(range.end - range.start);
        }
    }

    /// The most bytes of the stack in use since the reset.
    pub(super) fn stack_used(&self) -> u32 {
        self.stack.top.get() - self.stack.lowest.get()
    }

    /// The call that the function with its frame at `stack_pointer` is making.
    pub(super) fn call_of(&self, stack_pointer: u32) -> usize {
        self.calls[call_entry(stack_pointer)].get() as usize
    }
}

/// The entry of [`State::calls`] that belongs to the frame at `stack_pointer`.
///
/// Two frames of one stack never have the same entry, since they are at least [`BYTES_PER_CALL`] apart and no stack is
/// larger than the table covers.
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
