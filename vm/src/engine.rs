//! The interface of engines: an engine runs a thread from one stop to the next.
//!
//! An engine keeps a context for each thread and one for the call-back: registers, call frames, its code and the
//! position in it. Contexts are opaque to everything else, so engines that have only this trait in common can run
//! threads side by side on one machine. An engine makes no decision about time: it obeys `charge` and returns.

use std::fmt;
use std::sync::Arc;

use kmotiondef::map::{BOARD_STACK_SIZE, CALLBACK_STACK_BASE, MemoryMap, SDRAM, STACK_SIZE, stack_base};
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};

use crate::call::CallArguments;
use crate::firmware::{Caller, Firmware, Outcome, Value};
use crate::memory::GuestMemory;
#[cfg(doc)]
use crate::meter;
use crate::polling::TimeTests;
use crate::program::Program;
use crate::thread::Threads;
use crate::trap::{Trap, TrapKind};
use crate::wake::Wake;

/// The reason why an engine returned.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub enum Stop {
    /// The budget is used up.
    Preempted,
    /// In a long slice only: the next instruction involves the board, so it must run in an ordinary slice.
    NeedsBoard,
    /// A debugger holds the context before its instruction; the slice continues when the context is resumed.
    Held,
    /// A firmware call waits; it is repeated when the wake event occurs.
    Waiting(Wake),
    /// The program has returned from its entry function or called `ThreadDone`.
    Ended,
    /// The program did the impossible.
    Trapped(Trap),
}

/// The accesses to memory that threads can share which an engine reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ObservedAccesses {
    /// None.
    #[default]
    None,
    /// Each access once per slice of a thread, unless the firmware takes it for [redundant](crate::firmware::RepeatPolicy).
    Fresh,
    /// All accesses, each also before it is made ([`Firmware::switch_at`]); bytecode is always interpreted then.
    All,
}

/// The points at which a thread that runs bytecode can lose the processor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preemption {
    /// After a `charge` that overdraws the budget: a charged segment is never split.
    #[default]
    Segments,
    /// Before any instruction, in the cycle in which the slice ends, as on the board: even between the load and the
    /// store of one statement, and between the two words of an eight-byte store.
    ///
    /// A segment that the budget covers is executed as a whole. Otherwise it is executed in [`meter::steps`], in this
    /// slice and the next: an instruction takes effect if some of the budget is left at its step. A firmware function,
    /// a call within the program with its result, and the copy of a block are one step.
    Instructions,
}

/// Names one of an engine's contexts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ContextId(Option<ThreadId>);

impl ContextId {
    /// Number of contexts.
    pub const COUNT: usize = ThreadId::MAX as usize + 1;

    /// The context of the call-back.
    pub const CALLBACK: Self = Self(None);

    /// The context of a thread.
    #[must_use]
    pub const fn of(thread: ThreadId) -> Self {
        Self(Some(thread))
    }

    /// The thread; `None` for the call-back.
    #[must_use]
    pub const fn thread(self) -> Option<ThreadId> {
        self.0
    }

    /// The context as an index counted from zero.
    #[must_use]
    pub const fn index(self) -> usize {
        match self.0 {
            Some(thread) => thread.index(),
            None => Self::COUNT - 1,
        }
    }

    /// The stack of the context on a KFLOP.
    #[must_use]
    pub fn stack(self, strict: bool) -> Stack {
        self.stack_in(&MemoryMap::KFLOP, strict)
    }

    /// The stack of the context in the memory of a board.
    #[must_use]
    pub fn stack_in(self, map: &MemoryMap, strict: bool) -> Stack {
        let base = self.0.map_or(GuestAddr::new(CALLBACK_STACK_BASE), stack_base);
        // Stacks are at the beginning of SDRAM.
        let top = base.get() - SDRAM.base.get() + map.sdram.base.get() + STACK_SIZE;
        let base = GuestAddr::new(top - STACK_SIZE);
        Stack { limit: if strict { top - BOARD_STACK_SIZE } else { base.get() }, top }
    }
}

/// The stack for a call that a debugger makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CallStack {
    /// The stack of the context.
    pub whole: Stack,
    /// True if the context has calls in progress, whose part of the stack must not change.
    pub is_in_use: bool,
}

/// A stack in guest memory; it grows down from `top`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stack {
    /// The lowest address that may be used.
    pub limit: u32,
    /// One past the highest address.
    pub top: u32,
}

impl Stack {
    /// Bytes of the stack.
    #[must_use]
    pub const fn size(self) -> u32 {
        self.top - self.limit
    }
}

/// The iterations of waiting loops that are skipped in a slice.
#[derive(Clone, Copy, Debug)]
pub struct Polling {
    is_on: bool,
    /// The cycles skipped so far.
    passed: Cycles,
    /// The budget after the last access to a device register; more than any budget if there was none.
    accessed: Cycles,
}

impl Polling {
    /// Every iteration is executed.
    pub const OFF: Self = Self::new(false);

    /// Passes over iterations if `is_on`.
    #[must_use]
    pub const fn new(is_on: bool) -> Self {
        Self { is_on, passed: Cycles::new(0), accessed: Cycles::new(i64::MAX) }
    }

    /// Reports whether iterations are skipped.
    #[must_use]
    pub(crate) const fn is_on(self) -> bool {
        self.is_on
    }

    /// The cycles of the skipped iterations.
    #[must_use]
    pub(crate) const fn passed(self) -> Cycles {
        self.passed
    }
}

/// An iteration of a loop that may only wait, as an engine has executed it.
pub(crate) struct Iteration<'a> {
    /// The budget at its start.
    pub(crate) start: Cycles,
    /// The time comparisons of the iteration, if it makes any.
    pub(crate) clock: Option<&'a TimeTests>,
    /// The budget after the call that yielded the time; the budget at the start of the iteration if there was none.
    pub(crate) called: Cycles,
    /// The doubles in registers.
    pub(crate) register: &'a dyn Fn(u16) -> f64,
}

/// The context of one slice: memory, threads, firmware and budget.
#[derive(Debug)]
pub struct Slice<'a, F: ?Sized> {
    /// Guest memory.
    pub memory: &'a mut GuestMemory,
    /// The seven threads.
    pub threads: &'a mut Threads,
    /// The firmware, for its functions.
    pub firmware: &'a mut F,
    /// The current tick.
    pub tick: Ticks,
    /// Instant at which the budget was `length`.
    pub start: Cycles,
    /// The budget of the whole slice, in cycles.
    pub length: Cycles,
    /// The rest of the budget; below zero when the last block overdrew it.
    pub budget: Cycles,
    /// The wake that came true, if the context is in a waiting call.
    pub woken: Option<Wake>,
    /// True if the budget covers several slices: the thread is the only one, and the board does nothing.
    ///
    /// The context may then compute with registers and SDRAM only. Before any other action it stops with
    /// [`Stop::NeedsBoard`].
    pub is_long: bool,
    /// The waiting-loop iterations that are skipped.
    pub polling: Polling,
}

impl<F: Firmware + ?Sized> Slice<'_, F> {
    /// The present instant.
    #[must_use]
    pub fn now(&self) -> Cycles {
        self.start + (self.length - self.budget)
    }

    /// Notes an access to a device register, which may yield a different value each time.
    pub(crate) const fn note_access(&mut self) {
        self.polling.accessed = self.budget;
    }

    /// Skips iterations of a [waiting loop](crate::polling) that equal the one that has just ended.
    ///
    /// That iteration began in this slice. The last equal iteration that the slice covers is executed again, so that
    /// the firmware sees the same last calls at the same instants as without skipping.
    pub(crate) fn pass_iterations(&mut self, iteration: &Iteration<'_>) {
        let each = iteration.start - self.budget;
        if !self.polling.is_on || self.polling.accessed <= iteration.start || each <= Cycles::default() {
            return;
        }
        let mut left = self.budget;
        if !self.is_long
            && let Some(until) = self.firmware.steady_until()
        {
            left = left.min(until - self.now() - Cycles::new(1));
        }
        let mut count = (left.get() / each.get()).max(0);
        if let Some(clock) = iteration.clock {
            count = self.count_until(clock, iteration, each, count);
        }
        let passed = Cycles::new((count - 1).max(0) * each.get());
        self.budget -= passed;
        self.polling.passed += passed;
    }

    /// The number of iterations of `each` cycles, at most `most`, before a comparison with the time changes its result.
    fn count_until(&self, clock: &TimeTests, iteration: &Iteration<'_>, each: Cycles, most: i64) -> i64 {
        let called = self.start + (self.length - iteration.called);
        let time = |count: i64| self.firmware.time(self.memory, called + Cycles::new(count * each.get()));
        let first = time(0);
        // Not so for numbers that are none, and where a program has changed the variables of the time.
        let grows = first <= time(most);
        let is_same = |count: i64| clock.is_same([first, time(count)], iteration.register);
        if grows && is_same(most) {
            return most;
        }
        let (mut same, mut other) = (0, if grows { most } else { 1 });
        while same + 1 < other {
            let middle = same.midpoint(other);
            if is_same(middle) { same = middle } else { other = middle }
        }
        same
    }

    /// Makes the firmware call of `address` for the context `id`, which is at the instruction `at`.
    ///
    /// After [`Outcome::Wait`] the engine stops the context in the call. When the context is resumed, the engine
    /// repeats the call with the same arguments, and passes the wake event that has occurred.
    ///
    /// # Errors
    /// The kind of trap that stops the context.
    pub(crate) fn call_firmware(
        &mut self,
        id: ContextId,
        address: GuestAddr,
        arguments: CallArguments<'_>,
        at: CodeAddr,
    ) -> Result<Outcome<Value>, TrapKind> {
        let mut caller = Caller {
            thread: id.thread(),
            memory: self.memory,
            threads: self.threads,
            tick: self.tick,
            slice_start: self.start,
            slice: self.length,
            budget: &mut self.budget,
            woken: self.woken.take(),
            arguments,
            at: Some(at),
        };
        self.firmware.call(address, &mut caller)
    }
}

/// The snapshot was taken by another engine: threads that run as machine code can continue only in the engine that took
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the snapshot is from another board, whose native threads cannot continue here")]
pub struct ForeignSnapshot;

/// The reason why a context is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoldReason {
    /// Before an instruction with a breakpoint.
    Breakpoint,
    /// After one instruction, as was requested.
    Step,
    /// A watched range has changed.
    Changed {
        /// Its index in the list of watched ranges.
        index: usize,
        /// The instruction that changed it; `None` if it was not one of this context.
        by: Option<CodeAddr>,
    },
    /// An instruction has read a range, or written to it, whether or not the bytes changed.
    Accessed {
        /// Its index in the list of watched ranges.
        index: usize,
        /// The instruction.
        by: CodeAddr,
        /// It has written.
        is_store: bool,
    },
}

/// Bytes of memory for which accesses by programs are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccessRange {
    /// The first of them.
    pub address: GuestAddr,
    /// Number of bytes.
    pub size: u32,
    /// True if stores are watched as well as loads.
    pub has_stores: bool,
}

/// A context that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    /// The context.
    pub context: ContextId,
    /// The reason.
    pub reason: HoldReason,
}

/// The end of a call that a debugger makes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub enum CallEnd {
    /// The function has returned, with this in the slot of its result.
    Returned(u64),
    /// It has called a function of the firmware that waits.
    Waits(CodeAddr),
    /// It has ended its thread.
    EndsThread,
    /// It has not returned within a time.
    Endless(Cycles),
    /// It did the impossible.
    Trapped(Trap),
    /// No program that is loaded, and not the firmware, has such a function.
    NoFunction,
    /// The engine cannot make calls for a debugger.
    Unsupported,
}

/// A call in progress, as a debugger sees it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameView {
    /// The instruction that is executed next; in a caller, the call.
    pub at: CodeAddr,
    /// The address at which it continues: `at`, or in a caller the instruction after the call.
    pub continues_at: CodeAddr,
    /// Address of the frame in guest memory.
    pub frame: GuestAddr,
    /// The registers.
    pub registers: Vec<u64>,
}

/// An engine, as the machine uses it.
pub trait Executor: Default {
    /// The code that this engine runs.
    type Code;

    /// True if the engine generates host code; real images on the same machine are then translated, too.
    const TRANSLATES: bool = false;

    /// True if the engine keeps an account of the time spent; so do real images on the same machine then.
    const KEEPS_ACCOUNT: bool = false;

    /// All contexts as they were at an instant between two slices.
    type Snapshot: fmt::Debug;

    /// Determines where contexts that are started from now on can lose the processor.
    fn set_preemption(&mut self, preemption: Preemption);

    /// Determines which accesses to memory that threads can share are reported by contexts that are started from now on
    /// ([`Firmware::accessed`]).
    fn observe(&mut self, observed: ObservedAccesses);

    /// Gives `id` a fresh context at the beginning of the function at `entry`.
    ///
    /// The code is always run with the same firmware.
    ///
    /// # Errors
    /// [`TrapKind::BadCallTarget`] if there is no function; the context is as it was.
    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        code: &Arc<Self::Code>,
        entry: GuestAddr,
        stack: Stack,
        firmware: &F,
    ) -> Result<(), TrapKind>;

    /// Runs `id` until it stops. A context that was never started has ended.
    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop;

    /// A snapshot of all contexts.
    fn snapshot(&self) -> Self::Snapshot;

    /// Restores all contexts from `snapshot`.
    ///
    /// # Errors
    /// [`ForeignSnapshot`] if another engine took it and its contexts cannot run on this one; nothing is changed in
    /// that case.
    fn restore(&mut self, snapshot: &Self::Snapshot) -> Result<(), ForeignSnapshot>;

    /// Reports whether `id` may be resumed with a [long slice](Slice::is_long).
    ///
    /// In a long slice it must also stop before it uses more of its stack than ever before.
    fn takes_long_slices(&self, id: ContextId) -> bool {
        let _ = id;
        false
    }

    /// The most bytes of its stack that `id` has used since its start.
    fn stack_used(&self, id: ContextId) -> u32;

    /// The position of `id`: its instruction, then the calls that led there, innermost first.
    fn backtrace(&self, id: ContextId) -> Vec<CodeAddr>;

    /// True if the engine can hold contexts for a debugger; otherwise the methods below have no effect and find
    /// nothing. Holding a context changes neither the actions of a program nor their timing.
    const HOLDS: bool = false;

    /// Holds contexts before these instructions, and before no others.
    fn set_breakpoints(&mut self, addresses: &[CodeAddr]) {
        let _ = addresses;
    }

    /// Holds a context after each instruction, the next one included; `None` none.
    fn set_stepping(&mut self, context: Option<ContextId>) {
        let _ = context;
    }

    /// Holds contexts after a change of these bytes (address and length each), and after changes of no others.
    fn set_watched(&mut self, memory: &GuestMemory, ranges: &[(GuestAddr, u32)]) {
        let _ = (memory, ranges);
    }

    /// Holds contexts after instructions that access these bytes, and no others. Reads by firmware functions are not
    /// noticed.
    fn set_accessed(&mut self, ranges: &[AccessRange]) {
        let _ = ranges;
    }

    /// Returns the index of a watched range that has changed since the last call.
    fn take_change(&mut self, memory: &GuestMemory) -> Option<usize> {
        let _ = memory;
        None
    }

    /// Returns the context that was held last and the reason, once.
    fn take_hold(&mut self) -> Option<Hold> {
        None
    }

    /// The calls in progress of a context, innermost first.
    fn frames(&self, id: ContextId) -> Vec<FrameView> {
        let _ = id;
        Vec::new()
    }

    /// Sets a register of a call in progress, counted from the innermost as 0; returns whether there is such a
    /// register.
    fn set_register(&mut self, id: ContextId, frame: usize, register: u16, slot: u64) -> bool {
        let _ = (id, frame, register, slot);
        false
    }

    /// The slot of the result of the call from which `id` has returned last.
    fn result(&self, id: ContextId) -> Option<u64> {
        let _ = id;
        None
    }

    /// Calls the function at `entry` with the arguments, each as a slot, on the part of the stack that `id` does not
    /// use. The context is then as it was.
    fn call<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        code: &Arc<Self::Code>,
        entry: GuestAddr,
        arguments: &[u64],
        stack: CallStack,
        slice: &mut Slice<'_, F>,
    ) -> CallEnd {
        let _ = (id, code, entry, arguments, stack, slice);
        CallEnd::Unsupported
    }
}

/// An engine that runs [`Program`]s. All of them spend the same cycles and stop at the same instructions.
pub trait Engine: Executor<Code = Program> {}

impl<E: Executor<Code = Program>> Engine for E {}
