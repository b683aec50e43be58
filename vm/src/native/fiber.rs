//! A fiber: the native stack on which one context's compiled code runs.
//!
//! A fiber is never unwound. It runs until it has returned, or it is discarded where it stands;
//! the only Rust frames on it are the body below and [`leave`](super::entry::leave), and neither
//! owns anything.
#![expect(unsafe_code, reason = "runs compiled code and discards fibers without unwinding them")]

use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

use corosensei::stack::DefaultStack;
use corosensei::{Coroutine, CoroutineResult};

use super::code::{Code, Entry};
use super::entry;
use super::protected::ProtectedBlocks;
use super::request::{Reason, Request};
use super::state::State;
use crate::engine::Stack;
use crate::memory::GuestMemory;

/// What suspends a fiber.
pub(super) type Yielder = corosensei::Yielder<u64, Request>;

/// The answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// A register slot; 0 where nothing is expected.
    Slot(u64),
    /// The function to call, as its index in the program; only for a pointer that was to be resolved.
    Function(usize),
}

/// A native stack with one call of a program's function on it.
pub(super) struct Fiber {
    /// Taken out only to be discarded.
    coroutine: Option<Coroutine<u64, Request, (), DefaultStack>>,
    /// Bytes of its stack.
    native_size: usize,
    state: Rc<State>,
    code: Arc<Code>,
    /// Where guest memory and the map of protected blocks are, as soon as it has begun.
    ram: Option<(*mut u8, *mut u8, *const u8)>,
    /// Whether the last request asked for the target of a call.
    resolving: bool,
}

impl fmt::Debug for Fiber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fiber").field("state", &self.state).finish_non_exhaustive()
    }
}

impl Fiber {
    /// A fiber that will call `function` of `code` on the guest stack `stack`; it has not begun.
    ///
    /// `old` is discarded, and what it is made of used again where possible.
    pub(super) fn new(code: Arc<Code>, function: usize, stack: Stack, old: Option<Self>) -> Self {
        let size = code.stack_size(stack.size());
        let (state, kept) = match old {
            Some(mut old) => (Rc::clone(&old.state), old.take_stack()),
            None => (Rc::new(State::new(stack)), None),
        };
        state.reset(stack);
        let (native_stack, native_size) =
            kept.filter(|(_, kept_size)| *kept_size >= size).unwrap_or_else(|| {
                (DefaultStack::new(size).expect("the host has address space for a stack"), size)
            });
        let Entry { thunk, pointer } = code.entry(function);
        state.callee.set(pointer);
        let begin = code.begin();
        let shared = Rc::as_ptr(&state);
        let body = move |yielder: &Yielder, _: u64| {
            // SAFETY: the fiber, of which this is the body, holds the state.
            let state = unsafe { &*shared };
            state.yielder.set(yielder);
            // SAFETY: the entry is of the code that the fiber holds, together with the state;
            // `resume` sets the state's pointers each time before this runs.
            unsafe { entry::enter(begin, thunk, shared) };
        };
        let coroutine = Some(Coroutine::with_stack(native_stack, body));
        Self { coroutine, native_size, state, code, ram: None, resolving: false }
    }

    /// Runs the fiber until its next request; `None` when the function has returned.
    ///
    /// `answer` is that to the last request. A fiber that has returned does nothing.
    pub(super) fn resume(
        &mut self,
        memory: &mut GuestMemory,
        protected: &ProtectedBlocks,
        answer: Answer,
    ) -> Option<Request> {
        let answer = self.encode(answer);
        let coroutine = self.coroutine.as_mut().filter(|coroutine| !coroutine.done())?;
        // The borrows last until the fiber is suspended again, so the pointers are valid while it runs.
        let (sdram, iram) = memory.ram_mut();
        let ram = (sdram.as_mut_ptr(), iram.as_mut_ptr(), protected.marks().as_ptr());
        // Compiled code may keep the pointers over a request.
        assert!(*self.ram.get_or_insert(ram) == ram, "a context stays in the memory that it began in");
        self.state.sdram.set(ram.0);
        self.state.iram.set(ram.1);
        self.state.protected.set(ram.2);
        match coroutine.resume(answer) {
            CoroutineResult::Yield(request) => {
                self.resolving = request.reason() == Some(Reason::CallPointer);
                Some(request)
            }
            CoroutineResult::Return(()) => None,
        }
    }

    /// The answer as compiled code takes it.
    ///
    /// A call through a pointer takes the address of a thunk, and finds the function in the state; or it
    /// takes 0: this is where it is made certain.
    fn encode(&self, answer: Answer) -> u64 {
        match (self.resolving, answer) {
            (false, Answer::Slot(slot)) => slot,
            (true, Answer::Function(function)) => {
                let Entry { thunk, pointer } = self.code.entry(function);
                self.state.callee.set(pointer);
                thunk.expose_provenance() as u64
            }
            (true, _) | (false, Answer::Function(_)) => 0,
        }
    }

    /// What the engine and compiled code share.
    pub(super) fn state(&self) -> &State {
        &self.state
    }

    /// Discards what runs and yields the native stack, with its size, to use again.
    fn take_stack(&mut self) -> Option<(DefaultStack, usize)> {
        let mut coroutine = self.coroutine.take()?;
        // SAFETY: nothing on the fiber needs `Drop`: the body, `enter` and `leave` own nothing, and
        // compiled code knows no such thing.
        unsafe { coroutine.force_reset() };
        Some((coroutine.into_stack(), self.native_size))
    }
}

impl Drop for Fiber {
    fn drop(&mut self) {
        self.take_stack();
    }
}
