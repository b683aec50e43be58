//! The two ways between Rust and compiled code: in by [`enter`], out by [`leave`].
#![expect(unsafe_code, reason = "calls compiled code, and is called by it with raw pointers")]

use super::piece::{Handover, Places};
use super::request::Request;
use super::state::{HostFunctions, State};
use crate::arith;

/// The functions of this file that compiled code calls.
pub(super) const WAYS_OUT: HostFunctions = HostFunctions { request: leave, convert };

/// The function that begins the outermost call: a piece of compiled code that calls the thunk at the second pointer on
/// the stack that the state describes.
pub(super) type BeginFn = unsafe extern "C" fn(*const State, *const u8);

/// A piece of machine code; its result is the number of the exit it took.
pub(super) type RunPiece = unsafe extern "C" fn(*mut Handover, *const Places) -> u32;

/// Runs a function of a program until it returns.
///
/// # Safety
/// `begin`, `thunk` and the state's callee are compiled code of one program, the thunk is one for functions like the
/// callee, and the code is kept until this returns. `state` is valid until then, and whenever the fiber runs, its
/// pointers are those of guest memory.
pub(super) unsafe fn enter(begin: BeginFn, thunk: *const u8, state: *const State) {
    // SAFETY: the caller vouches for the code and the state.
    unsafe { begin(state, thunk) }
}

/// An upper bound on the stack bytes from the frame of `leave` to the end of the code that suspends a fiber. A fiber
/// that has not begun has fewer bytes on its stack.
pub(super) const SUSPENSION: usize = 0x1000;

/// Makes the stack reach as far as a copy of the suspended fiber: Windows adds memory to a stack only when the stack
/// itself grows, and faults if anything else reads beyond it.
#[cfg(windows)]
#[inline(never)]
fn extend_stack() {
    let mut room = [const { std::mem::MaybeUninit::<u8>::uninit() }; SUSPENSION];
    if let Some(lowest) = std::hint::black_box(&mut room).first_mut() {
        lowest.write(0);
    }
    std::hint::black_box(&room);
}

/// Suspends the fiber with a request and returns the answer.
///
/// # Safety
/// Only called by compiled code: `state` is the pointer with which the code was entered.
unsafe extern "C" fn leave(
    state: *const State,
    code: u32,
    at: u32,
    stack_pointer: u32,
    a: u64,
    b: u64,
) -> u64 {
    // SAFETY: compiled code passes the pointer from `enter`, which is valid while the code runs.
    let state = unsafe { &*state };
    // SAFETY: the fiber's body sets the yielder, which lives on this fiber, before it enters compiled code.
    let yielder = unsafe { &*state.yielder.get() };
    let here = 0_u8;
    state.suspended_at.set((&raw const here).addr());
    #[cfg(windows)]
    extend_stack();
    // Nothing here or in compiled code needs `Drop`, so the fiber may be discarded while it is suspended.
    yielder.suspend(Request { code, at, stack_pointer, a, b })
}

/// Converts numbers that compiled code cannot convert by a single instruction.
extern "C" fn convert(value: f64) -> i64 {
    arith::i64_from_f64_u(value)
}
