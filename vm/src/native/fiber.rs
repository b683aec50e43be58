//! A fiber: the native stack on which one context's compiled code runs.
//!
//! A fiber is never unwound. It runs until it returns, or it is discarded where it is suspended; the only Rust frames
//! on it are the body below and `leave` in `entry.rs`, and neither owns anything. So a suspended fiber can
//! also be copied: the bytes on its stack and the state, which are restored to the same addresses before the copy
//! continues.
#![expect(unsafe_code, reason = "runs compiled code and discards fibers without unwinding them")]

use std::cell::Cell;
use std::mem::{ManuallyDrop, MaybeUninit};
use std::sync::Arc;
use std::{fmt, ptr};

use corosensei::stack::{DefaultStack, Stack as _, StackPointer};
use corosensei::{Coroutine, CoroutineResult};

use super::code::{Entry, MachineCode};
use super::entry::{self, SUSPENSION};
use super::protected::ProtectedBlocks;
use super::request::{Reason, Request, Yielder};
use super::state::{Restore, State};
use crate::engine::Stack;
use crate::memory::GuestMemory;
use crate::polling::PollingLoop;

/// The answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// A register slot; 0 if no value is expected.
    Slot(u64),
    /// The function to call, as its index in the program; only for a pointer that should have been resolved.
    Function(usize),
}

/// The home of a fiber: a native stack, and the state of the context that runs on it. Compiled code holds the addresses
/// of both, so a fiber and its copies always use the same home, one at a time.
struct Home {
    stack: DefaultStack,
    /// Bytes of the stack.
    size: usize,
    state: State,
    is_taken: Cell<bool>,
    #[cfg(windows)]
    fields: Cell<corosensei::stack::StackTebFields>,
}

impl Home {
    /// A place with a stack of this many bytes.
    #[expect(clippy::arc_with_non_send_sync, reason = "fibers and their copies are `Send`, which count it")]
    fn new(size: usize, guest: Stack) -> Arc<Self> {
        let stack = DefaultStack::new(size).expect("the host has address space for a stack");
        Arc::new(Self {
            #[cfg(windows)]
            fields: Cell::new(corosensei::stack::Stack::teb_fields(&stack)),
            stack,
            size,
            state: State::new(guest, entry::WAYS_OUT),
            is_taken: Cell::new(false),
        })
    }

    /// Takes the place for a fiber.
    fn take(&self) {
        assert!(!self.is_taken.replace(true), "there is one fiber at a time in a place");
    }
}

/// The stack of a home as a coroutine sees it. It owns nothing: the fiber holds the home.
struct View(*const Home);

impl View {
    fn place(&self) -> &Home {
        // SAFETY: views are in coroutines, coroutines in fibers and their copies, and each of those holds the home.
        unsafe { &*self.0 }
    }
}

// SAFETY: the stack is one of corosensei's own.
unsafe impl corosensei::stack::Stack for View {
    fn base(&self) -> StackPointer {
        self.place().stack.base()
    }

    fn limit(&self) -> StackPointer {
        self.place().stack.limit()
    }

    #[cfg(windows)]
    fn teb_fields(&self) -> corosensei::stack::StackTebFields {
        self.place().fields.get()
    }

    #[cfg(windows)]
    fn update_teb_fields(&mut self, stack_limit: usize, guaranteed_stack_bytes: usize) {
        let fields = &self.place().fields;
        fields.set(corosensei::stack::StackTebFields {
            StackLimit: stack_limit,
            GuaranteedStackBytes: guaranteed_stack_bytes,
            ..fields.get()
        });
    }
}

/// The coroutine on the stack. It is never dropped but discarded, and may be copied bit by bit: like everything on the
/// stack, it owns nothing.
type Running = ManuallyDrop<Coroutine<u64, Request, (), View>>;

/// A native stack with one call of a program's function on it.
pub(super) struct Fiber {
    coroutine: Running,
    place: Arc<Home>,
    rest: FiberState,
}

// SAFETY: a fiber may be continued by another thread than the one that began it. Nothing on its stack belongs to a
// thread: the frames are those of compiled code, which holds addresses of guest memory and the state, and of the body,
// `enter` and `leave`, none of which uses thread-locals. It is used only through `&mut`, by one thread at a time. It
// shares its home with its copies, which access the home only in `SavedFiber::fiber`, for the engine of the fiber;
// their reference count is atomic.
unsafe impl Send for Fiber {}

/// The parts of a fiber besides its coroutine.
#[derive(Clone)]
struct FiberState {
    code: Arc<MachineCode>,
    /// The addresses of guest memory and of the map of protected blocks, once the fiber has begun.
    ram: Option<(*mut u8, *mut u8, *const u8)>,
    /// True if the last request was for the target of a call.
    resolving: bool,
}

impl fmt::Debug for Fiber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fiber").field("state", self.state()).finish_non_exhaustive()
    }
}

impl Fiber {
    /// A fiber that will call `function` of `code` on the guest stack `stack`; it has not begun.
    ///
    /// `old` is discarded, and its home is reused if it is large enough.
    pub(super) fn new(code: Arc<MachineCode>, function: usize, stack: Stack, old: Option<Self>) -> Self {
        let size = code.stack_size(stack.size());
        let kept = old.map(|old| Arc::clone(&old.place)).filter(|place| place.size >= size);
        let place = kept.unwrap_or_else(|| Home::new(size, stack));
        place.take();
        let state = &place.state;
        state.reset(stack);
        let Entry { thunk, pointer } = code.entry(function);
        state.exchange.callee.set(pointer);
        let begin = code.begin();
        let shared: *const State = state;
        let body = move |yielder: &Yielder, _: u64| {
            // SAFETY: the fiber, of which this is the body, holds the place, and with it the state.
            let state = unsafe { &*shared };
            state.yielder.set(yielder);
            // SAFETY: the entry belongs to the code that the fiber holds, as does the state; `resume` sets the state's
            // pointers each time before this runs.
            unsafe { entry::enter(begin, thunk, shared) };
        };
        let coroutine = ManuallyDrop::new(Coroutine::with_stack(View(Arc::as_ptr(&place)), body));
        Self { coroutine, place, rest: FiberState { code, ram: None, resolving: false } }
    }

    /// A copy of the fiber, which can later continue from this point.
    pub(super) fn save(&self) -> SavedFiber {
        let base = self.place.stack.base().get();
        let lowest = if self.coroutine.done() {
            base
        } else if self.coroutine.started() {
            self.state().suspended_at.get() - SUSPENSION
        } else {
            base - SUSPENSION
        };
        assert!(self.place.stack.limit().get() < lowest, "the stack has room for what suspends it");
        let mut bytes = vec![MaybeUninit::uninit(); base - lowest].into_boxed_slice();
        let top = ptr::with_exposed_provenance::<MaybeUninit<u8>>(lowest);
        // SAFETY: these are the upper bytes of the stack, which is mapped, and nothing runs on it now.
        unsafe { ptr::copy_nonoverlapping(top, bytes.as_mut_ptr(), bytes.len()) };
        // SAFETY: the copy is never dropped; it is only used once it has become a fiber, after this one is gone.
        let coroutine = unsafe { ptr::read(&raw const self.coroutine) };
        let (place, rest) = (Arc::clone(&self.place), self.rest.clone());
        SavedFiber { coroutine, bytes, state: Box::new(self.state().clone()), place, rest }
    }

    /// Runs the fiber until its next request; `None` when the function has returned.
    ///
    /// `answer` is the answer to the last request. A fiber that has returned does nothing.
    pub(super) fn resume(
        &mut self,
        memory: &mut GuestMemory,
        protected: &ProtectedBlocks,
        answer: Answer,
    ) -> Option<Request> {
        let answer = self.encode(answer);
        if self.coroutine.done() {
            return None;
        }
        // The borrows last until the fiber is suspended again, so the pointers are valid while it runs.
        let (sdram, iram) = memory.ram_mut();
        let ram = (sdram.as_mut_ptr(), iram.as_mut_ptr(), protected.marks().as_ptr());
        // Compiled code may keep the pointers across a request.
        assert!(*self.rest.ram.get_or_insert(ram) == ram, "a context stays in the memory that it began in");
        let own = &self.place.state.ram;
        own.sdram.set(ram.0);
        own.iram.set(ram.1);
        own.protected.set(ram.2);
        match self.coroutine.resume(answer) {
            CoroutineResult::Yield(request) => {
                self.rest.resolving = request.reason() == Some(Reason::CallPointer);
                Some(request)
            }
            CoroutineResult::Return(()) => None,
        }
    }

    /// Encodes the answer for compiled code.
    ///
    /// A call through a pointer takes the address of a thunk, and finds the function in the state; or it takes 0. This
    /// method guarantees it.
    fn encode(&self, answer: Answer) -> u64 {
        match (self.rest.resolving, answer) {
            (false, Answer::Slot(slot)) => slot,
            (true, Answer::Function(function)) => {
                let Entry { thunk, pointer } = self.rest.code.entry(function);
                self.state().exchange.callee.set(pointer);
                thunk.expose_provenance() as u64
            }
            (true, _) | (false, Answer::Function(_)) => 0,
        }
    }

    /// The loops of the program that may only wait.
    pub(super) fn loops(&self) -> &[PollingLoop] {
        self.rest.code.loops()
    }

    /// The state that the engine and compiled code share.
    pub(super) fn state(&self) -> &State {
        &self.place.state
    }
}

impl Drop for Fiber {
    fn drop(&mut self) {
        // SAFETY: the coroutine is not used again.
        let mut coroutine = unsafe { ManuallyDrop::take(&mut self.coroutine) };
        // SAFETY: nothing on the fiber needs `Drop`: the body, `enter` and `leave` own nothing, and compiled code has
        // no destructors.
        unsafe { coroutine.force_reset() };
        coroutine.into_stack();
        self.place.is_taken.set(false);
    }
}

/// A fiber as it was at an instant: all bytes that were on its stack, to be put back to the same place.
pub(super) struct SavedFiber {
    coroutine: Running,
    bytes: Box<[MaybeUninit<u8>]>,
    state: Box<State>,
    place: Arc<Home>,
    rest: FiberState,
}

// SAFETY: as for `Fiber`. A copy owns its bytes and its state; it only keeps the home alive until its engine, used by
// one thread at a time, restores it there.
unsafe impl Send for SavedFiber {}

impl SavedFiber {
    /// The fiber. The fiber that occupies its home must be gone.
    pub(super) fn fiber(&self) -> Fiber {
        self.place.take();
        let lowest = self.place.stack.base().get() - self.bytes.len();
        let top = ptr::with_exposed_provenance_mut::<MaybeUninit<u8>>(lowest);
        // SAFETY: as many bytes were copied from there, and only this fiber uses the home.
        unsafe { ptr::copy_nonoverlapping(self.bytes.as_ptr(), top, self.bytes.len()) };
        self.place.state.restore(&self.state);
        // SAFETY: the coroutine refers only to its stack, which is as it was when the copy was made.
        let coroutine = unsafe { ptr::read(&raw const self.coroutine) };
        Fiber { coroutine, place: Arc::clone(&self.place), rest: self.rest.clone() }
    }
}

impl fmt::Debug for SavedFiber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SavedFiber").field("bytes", &self.bytes.len()).finish_non_exhaustive()
    }
}
