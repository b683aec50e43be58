//! An activation: one call of a function while it executes, on which instructions work.
//!
//! There is one method an instruction, in `arith.rs`, `memory.rs` and `control.rs`. Its result is the continuation
//! ([`IntoFlow`]).

use std::cell::Cell;

use kmotiondef::GuestAddr;

use super::code::Words;
use super::context::{Calls, Window};
use super::sequences::AHEAD;
use crate::filter::AccessFilter;
use crate::kind::Width;
use crate::memory::{RamRest, Sdram};
use crate::operand::{FuncRef, Label, RegF32, RegF64, RegI32, RegI64, SigRef};
use crate::program::Program;
use crate::slot::Slot;
use crate::trap::TrapKind;

/// The reason why the execution stopped.
#[derive(Debug)]
pub(super) enum Exit {
    /// The budget is used up.
    Preempted,
    /// A call within the program that needs more room.
    Call(FuncRef),
    /// A call of the firmware.
    CallFirmware(GuestAddr, SigRef),
    /// A call through a pointer.
    CallPointer(GuestAddr, SigRef),
    /// A return from the outermost call.
    Ended,
    /// A load outside RAM, into the register with the given index.
    Load(GuestAddr, Width, u16),
    /// A store of a slot outside RAM, or to a protected address.
    Store(GuestAddr, Width, u64),
    /// A copy within memory.
    Copy { to: GuestAddr, from: GuestAddr, len: u16 },
    /// Bytes to clear.
    Clear { to: GuestAddr, len: u16 },
    /// The program did the impossible.
    Trap(TrapKind),
    /// A debugger holds the context before this word.
    Held,
    /// An access to memory that threads can share, which is reported.
    Shared,
    /// A branch that ends an iteration of a loop that may only wait.
    EndsIteration,
}

/// The continuation after an instruction.
pub(super) enum Flow {
    /// Continue with the next word.
    Next,
    /// Continue `.0` words after the next.
    Skip(usize),
    /// Continue at a label.
    Jump(Label),
    /// Stop.
    Leave(Exit),
}

/// A result of an instruction's method, which can be a flow.
pub(super) trait IntoFlow {
    /// Converts it to a flow.
    fn into_flow(self) -> Flow;
}

impl IntoFlow for () {
    #[inline(always)]
    fn into_flow(self) -> Flow {
        Flow::Next
    }
}

impl IntoFlow for Flow {
    #[inline(always)]
    fn into_flow(self) -> Flow {
        self
    }
}

impl IntoFlow for Exit {
    #[inline(always)]
    fn into_flow(self) -> Flow {
        Flow::Leave(self)
    }
}

impl IntoFlow for Result<(), TrapKind> {
    #[inline(always)]
    fn into_flow(self) -> Flow {
        match self {
            Ok(()) => Flow::Next,
            Err(kind) => Flow::Leave(Exit::Trap(kind)),
        }
    }
}

/// A register operand, with the Rust type of what the register holds.
pub(super) trait Register: Copy {
    /// Type of the value.
    type Value: Slot;

    /// Index in the window.
    fn index(self) -> u16;

    /// Notes that this was assigned last.
    fn note(activation: &mut Activation<'_, '_>, value: Self::Value);
}

macro_rules! registers {
    ($($register:ident holds $value:ty $(, noted as $last:ident)?;)*) => {$(
        impl Register for $register {
            type Value = $value;

            #[inline(always)]
            fn index(self) -> u16 {
                self.0
            }

            #[inline(always)]
            fn note(_activation: &mut Activation<'_, '_>, _value: $value) {
                $(_activation.$last = _value;)?
            }
        }
    )*};
}
registers! {
    RegI32 holds i32;
    RegI64 holds i64;
    RegF32 holds f32, noted as single;
    RegF64 holds f64, noted as double;
}

/// The state of an execution besides the registers of the current call.
pub(super) struct State<'m> {
    /// The words of the program.
    pub(super) words: &'m Words,
    pub(super) program: &'m Program,
    /// Memory besides SDRAM.
    pub(super) ram: RamRest<'m>,
    /// The rest of the slice's budget, in cycles.
    pub(super) budget: i64,
    /// The registers of all calls.
    pub(super) registers: &'m [Cell<u64>],
    pub(super) calls: &'m mut Calls,
    /// The reason for which the execution ended, once it has.
    pub(super) exit: Option<Exit>,
    /// The accesses that are not reported again.
    pub(super) filter: Option<&'m AccessFilter>,
}

/// A call of a function while it executes.
pub(super) struct Activation<'a, 'm> {
    pub(super) state: &'a mut State<'m>,
    pub(super) window: &'m Window,
    pub(super) sdram: &'a mut Sdram,
    /// The words from the current instruction on.
    pub(super) code: &'a Words,
    /// The double that was assigned last.
    pub(super) double: f64,
    /// The single that was assigned last.
    pub(super) single: f32,
}

impl<'a, 'm: 'a> Activation<'a, 'm> {
    /// The instruction that is executed.
    #[inline(always)]
    pub(super) fn pc(&self) -> usize {
        self.state.words.len() - self.code.len()
    }

    /// The words from the one at a label on.
    #[inline(always)]
    pub(super) fn code_at(&self, to: Label) -> Option<&'a Words> {
        self.state.words.get(to.0 as usize..).filter(|code| code.len() >= AHEAD)
    }

    /// Stores the last assigned value into the register of the operand at `place`, which already holds it.
    ///
    /// Memory does not change; but the host's compiler now knows the value of the register and need not load it.
    #[inline(always)]
    pub(super) fn store_last_value(&self, place: usize, slot: u64) {
        if let Some(word) = self.code.first() {
            self.window[usize::from(word.register(place))].set(slot);
        }
    }

    #[inline(always)]
    pub(super) fn get<R: Register>(&self, register: R) -> R::Value {
        R::Value::from_slot(self.window[usize::from(register.index())].get())
    }

    #[inline(always)]
    pub(super) fn set<R: Register>(&mut self, register: R, value: R::Value) {
        self.window[usize::from(register.index())].set(value.into_slot());
        R::note(self, value);
    }
}
