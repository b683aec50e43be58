//! The interface to the firmware: its functions, their results and waits.
//!
//! The machine sees only this trait. The kernel implements it and finds the function by its
//! guest address, as the linked program names it.

use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};

use crate::bus::Bus;
use crate::call::CallArguments;
use crate::memory::GuestMemory;
use crate::operand::Class;
use crate::scheduler::SliceOwner;
use crate::slot::Slot;
use crate::thread::Threads;
use crate::trap::{Trap, TrapKind};
// Part of the result of a firmware function.
pub use crate::wake::Wake;

/// A value that crosses between a program and the firmware.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// No value.
    Unit,
    /// An integer or address.
    I32(i32),
    /// A 64-bit integer.
    I64(i64),
    /// A single.
    F32(f32),
    /// A double.
    F64(f64),
}

impl Value {
    /// The register class; `None` for no value.
    #[must_use]
    pub const fn class(self) -> Option<Class> {
        match self {
            Self::Unit => None,
            Self::I32(_) => Some(Class::I32),
            Self::I64(_) => Some(Class::I64),
            Self::F32(_) => Some(Class::F32),
            Self::F64(_) => Some(Class::F64),
        }
    }

    /// The register slot that holds the value; 0 for none.
    #[must_use]
    pub fn into_slot(self) -> u64 {
        match self {
            Self::Unit => 0,
            Self::I32(value) => value.into_slot(),
            Self::I64(value) => value.into_slot(),
            Self::F32(value) => value.into_slot(),
            Self::F64(value) => value.into_slot(),
        }
    }
}

/// The result of a firmware call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum Outcome<T> {
    /// The call is complete; the program continues after it.
    Done(T),
    /// The thread waits. When the wake event occurs, the same call is repeated with [`Caller::woken`] set.
    Wait(Wake),
    /// The calling thread has ended (`ThreadDone`).
    End,
}

/// The signature of a firmware function, as classes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Parameters; a variadic function has one more of class `I32`, the address of the variable part.
    pub params: Vec<Class>,
    /// Result; `None` for `void`.
    pub result: Option<Class>,
}

impl Signature {
    /// Reports whether a function of this signature may be called through a pointer to `called`.
    ///
    /// The call must pass the function's parameters in order; further arguments are ignored. A result may be ignored,
    /// and a missing result reads as 0. Machine code relies on the order: in every calling convention the place of a
    /// parameter depends only on those before it, and the caller clears the stack.
    #[must_use]
    pub fn may_be_called_as(&self, called: &Self) -> bool {
        let results_agree = self.result.is_none() || called.result.is_none() || self.result == called.result;
        results_agree && called.params.starts_with(&self.params)
    }

    /// Checks [`may_be_called_as`](Self::may_be_called_as) for a call of the function at `addr`, with the trap as the
    /// error.
    pub(crate) fn check_call(&self, addr: GuestAddr, called: &Self) -> Result<(), TrapKind> {
        if self.may_be_called_as(called) { Ok(()) } else { Err(TrapKind::SignatureMismatch { addr }) }
    }
}

/// A firmware function that only computes its result from its arguments, so that an engine may call it without the
/// firmware.
#[derive(Clone, Copy, Debug)]
pub struct Pure {
    /// The cost of a call, in cycles.
    pub cost: Cycles,
    /// The computation.
    pub function: PureFunction,
}

macro_rules! pure_functions {
    ($($(#[$doc:meta])+ $variant:ident($pointer:ty) = ($($parameter:ident),+) -> $result:ident;)*) => {
        /// The computation of a [`Pure`] function.
        #[derive(Clone, Copy, Debug)]
        pub enum PureFunction {
            $($(#[$doc])+ $variant($pointer),)*
        }

        impl PureFunction {
            /// The classes of its parameters.
            #[must_use]
            pub const fn parameters(self) -> &'static [Class] {
                match self {
                    $(Self::$variant { .. } => &[$(Class::$parameter),+],)*
                }
            }

            /// The class of its result.
            #[must_use]
            pub const fn result(self) -> Class {
                match self {
                    $(Self::$variant { .. } => Class::$result,)*
                }
            }
        }

        $(impl From<$pointer> for PureFunction {
            fn from(pointer: $pointer) -> Self {
                Self::$variant(pointer)
            }
        })*
    };
}
pure_functions! {
    /// A function of a double.
    F64(extern "C" fn(f64) -> f64) = (F64) -> F64;
    /// A function of two doubles.
    F64F64(extern "C" fn(f64, f64) -> f64) = (F64, F64) -> F64;
    /// A function of a single.
    F32(extern "C" fn(f32) -> f32) = (F32) -> F32;
    /// A function of two singles.
    F32F32(extern "C" fn(f32, f32) -> f32) = (F32, F32) -> F32;
}

impl PureFunction {
    /// The function that computes it.
    #[must_use]
    pub fn pointer(self) -> *const () {
        match self {
            Self::F64(function) => function as *const (),
            Self::F64F64(function) => function as *const (),
            Self::F32(function) => function as *const (),
            Self::F32F32(function) => function as *const (),
        }
    }
}

/// A firmware call as the kernel sees it.
#[derive(Debug)]
pub struct Caller<'a> {
    /// The calling thread; `None` in the call-back, which must not wait.
    pub thread: Option<ThreadId>,
    /// Guest memory.
    pub memory: &'a mut GuestMemory,
    /// The seven threads, to start, pause and resume.
    pub threads: &'a mut Threads,
    /// The current tick.
    pub tick: Ticks,
    /// Instant at which the current slice's budget was full.
    pub slice_start: Cycles,
    /// The budget of the slice at its start, in cycles.
    pub slice: Cycles,
    /// The rest of the budget; the function spends its cost here.
    pub budget: &'a mut Cycles,
    /// The wake event after which the machine repeats the call; `None` the first time.
    pub woken: Option<Wake>,
    /// The arguments.
    pub arguments: CallArguments<'a>,
    /// The calling instruction; `None` for a call that does not come from a program.
    pub at: Option<CodeAddr>,
}

impl Caller<'_> {
    /// The present instant: power-up is 0.
    #[must_use]
    pub fn now(&self) -> Cycles {
        self.slice_start + (self.slice - *self.budget)
    }

    /// Returns whether the call ends in a later slice of the thread, because it has spent more than the rest of this
    /// slice.
    #[must_use]
    pub fn is_overdrawn(&self) -> bool {
        *self.budget < Cycles::new(0)
    }

    /// Spends processor time of the calling thread.
    pub fn spend(&mut self, cycles: Cycles) {
        *self.budget -= cycles;
    }
}

/// The context in which the kernel works outside a firmware call.
#[derive(Debug)]
pub struct TickContext<'a> {
    /// Guest memory.
    pub memory: &'a mut GuestMemory,
    /// The seven threads, to start, pause and resume.
    pub threads: &'a mut Threads,
    /// The current tick.
    pub tick: Ticks,
    /// The present instant: power-up is 0.
    pub now: Cycles,
}

/// A packet of real code that was executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExecutedPacket {
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// Its address.
    pub at: CodeAddr,
    /// The instant at which it began.
    pub start: Cycles,
    /// The cycles that it took.
    pub cycles: Cycles,
    /// Its instructions, separated by bars.
    pub text: String,
}

/// An access of a program to memory that threads can share.
#[derive(Clone, Copy, Debug)]
pub struct SharedAccess<'a> {
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// The instruction.
    pub at: CodeAddr,
    /// The first byte.
    pub address: GuestAddr,
    /// Bytes.
    pub size: u32,
    /// True for a store.
    pub is_store: bool,
    /// The value as a register slot; 0 for the copy of a block.
    pub value: u64,
    /// The loads in the same function on whose values the stored value depends; for a load, the loads whose values are
    /// used together with its own.
    pub made_of: &'a [CodeAddr],
    /// The instant.
    pub now: Cycles,
}

/// The treatment of an access that an instruction repeats in the same slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RepeatPolicy {
    /// It is reported again.
    Reported,
    /// It is redundant; the machine may omit it.
    Redundant,
}

/// A point at which a thread loses the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SwitchPoint {
    /// Before the access.
    Before,
    /// Between the two words of a store of eight bytes.
    BetweenWords,
}

/// An access to shared memory that a thread is about to make.
#[derive(Clone, Copy, Debug)]
pub struct NextAccess {
    /// The thread.
    pub thread: ThreadId,
    /// The instruction.
    pub at: CodeAddr,
    /// The place.
    pub address: GuestAddr,
    /// The number of bytes.
    pub size: u32,
    /// True for a store.
    pub is_store: bool,
    /// The instant.
    pub now: Cycles,
}

/// The kind of state yielded by a firmware function that has no other effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadState {
    /// A state that changes only with ticks, or by an action of a program.
    Steady,
    /// The time as a double, which grows from cycle to cycle.
    Time,
}

/// The firmware as the machine sees it.
///
/// In each tick the machine calls, in this order: [`callback`](Self::callback) (and runs the function that it returns),
/// [`tick`](Self::tick), [`switch_to`](Self::switch_to), and then either [`primary_slice`](Self::primary_slice) or the
/// firmware calls of a user thread.
pub trait Firmware: Bus {
    /// The signature of the function at `address`, if a firmware function starts there.
    fn signature(&self, address: GuestAddr) -> Option<&Signature>;

    /// Makes one call.
    ///
    /// # Errors
    /// The kind of trap that stops the calling thread.
    fn call(&mut self, address: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind>;

    /// The function at `address`, if it only computes; [`call`](Self::call) then gives the same result.
    fn pure(&self, address: GuestAddr) -> Option<Pure> {
        let _ = address;
        None
    }

    /// The kind of state that a call of the function at `address` yields, if it has no other effect.
    ///
    /// If it is called again in the same slice, with no store and no other call in between, it takes the same time,
    /// yields the same state or another [time](Self::time), and leaves the firmware as the previous call left it, up to
    /// the instant [`steady_until`](Self::steady_until).
    fn reads(&self, address: GuestAddr) -> Option<ReadState> {
        let _ = address;
        None
    }

    /// The number that functions which yield the time yield at `now`.
    fn time(&self, memory: &GuestMemory, now: Cycles) -> f64 {
        let _ = (memory, now);
        f64::NAN
    }

    /// The instant from which a call that only [reads](Self::reads) may have more effects than before; `None` if there
    /// is none.
    fn steady_until(&self) -> Option<Cycles> {
        None
    }

    /// Reports whether the function at `address` takes a variable number of arguments.
    fn is_variadic(&self, address: GuestAddr) -> bool {
        let _ = address;
        false
    }

    /// The registers of the real processor that a call of `address` may change, A0 in bit 0, B0 in bit 32.
    ///
    /// By the calling convention A0..=A9 and B0..=B9; of helpers that are called in the middle of an expression fewer.
    fn changed_registers(&self, address: GuestAddr) -> u64 {
        let _ = address;
        0x0000_03FF_0000_03FF
    }

    /// The function to call at the beginning of this tick; null for none.
    fn callback(&self, memory: &GuestMemory) -> GuestAddr {
        let _ = memory;
        GuestAddr::NULL
    }

    /// The call-back has returned after `spent`, which is added to the servo time of the tick.
    fn callback_returned(&mut self, context: &mut TickContext<'_>, spent: Cycles) {
        let _ = (context, spent);
    }

    /// The servo interrupt: all work of the kernel in one tick.
    fn tick(&mut self, context: &mut TickContext<'_>);

    /// The cycles that the servo interrupt takes of the present tick; called after [`tick`](Self::tick).
    fn servo_time(&self, memory: &GuestMemory) -> Cycles {
        let _ = memory;
        Cycles::new(8_000)
    }

    /// Gives the rest of this tick to `turn`.
    fn switch_to(&mut self, turn: SliceOwner, context: &mut TickContext<'_>) {
        let _ = (turn, context);
    }

    /// A slice of the primary thread.
    fn primary_slice(&mut self, context: &mut TickContext<'_>) {
        let _ = context;
    }

    /// `thread` is about to run from its entry point.
    fn begins(&mut self, thread: ThreadId, context: &mut TickContext<'_>) {
        let _ = (thread, context);
    }

    /// Reports whether slices should be reported to [`slice_ran`](Self::slice_ran).
    fn follows_slices(&self) -> bool {
        false
    }

    /// Reports that a thread has run in its slice, from `start` to `end`; where slices can end at any instruction, with
    /// the instruction before which the servo interrupt has stopped it.
    fn slice_ran(&mut self, thread: ThreadId, start: Cycles, end: Cycles, interrupted_at: Option<CodeAddr>) {
        let _ = (thread, start, end, interrupted_at);
    }

    /// Reports whether packets of real code of this thread, of the call-back for `None`, are reported one by one.
    fn follows_packets(&self, thread: Option<ThreadId>) -> bool {
        let _ = thread;
        false
    }

    /// A packet of real code was executed; reported when the thread loses the processor.
    fn packet_ran(&mut self, packet: ExecutedPacket) {
        let _ = packet;
    }

    /// Reports an access by a program, where the machine [observes](crate::machine::Config::observed) accesses.
    fn accessed(&mut self, access: &SharedAccess<'_>, memory: &GuestMemory) -> RepeatPolicy {
        let _ = (access, memory);
        RepeatPolicy::Reported
    }

    /// Returns whether a call or an access since the last query has ordered accesses of different threads: the engine must
    /// then report all accesses again.
    fn take_ordering(&mut self) -> bool {
        false
    }

    /// Returns the point at which a thread loses the processor at an access to shared memory that it is about to make,
    /// if it does. Called where the machine [observes](crate::machine::Config::observed) accesses, and again if another
    /// slice ends before the access.
    fn switch_at(&mut self, access: &NextAccess) -> Option<SwitchPoint> {
        let _ = access;
        None
    }

    /// A thread was stopped by a trap, or the call-back, which the kernel must then take out.
    fn trapped(&mut self, trap: &Trap, context: &mut TickContext<'_>);

    /// Reports that a thread's stack has exceeded the size of the board's stack; at most once for each start.
    fn stack_exceeded(&mut self, thread: ThreadId, used: u32) {
        let _ = (thread, used);
    }

    /// The number of coming ticks that do nothing except what [`skip_ticks`](Self::skip_ticks) does at once.
    fn quiet_ticks(&self, memory: &GuestMemory) -> u64 {
        let _ = memory;
        0
    }

    /// The number of coming ticks that are quiet while a program computes with SDRAM alone; at most
    /// [`quiet_ticks`](Self::quiet_ticks).
    fn quiet_slices(&self, memory: &GuestMemory) -> u64 {
        let _ = memory;
        0
    }

    /// Replaces `count` calls of `tick`, `switch_to` and `primary_slice`; `context` belongs to the last of these ticks.
    fn skip_ticks(&mut self, count: u64, context: &mut TickContext<'_>) {
        let _ = (count, context);
    }
}
