//! What instructions work with: one call of a function while it executes.
//!
//! There is one method an instruction, in `arith.rs`, `memory.rs` and `control.rs`. What it returns
//! says how the execution goes on ([`Finish`]).

use std::cell::Cell;

use kmotiondef::GuestAddr;

use super::context::{Calls, Window};
use crate::kind::Width;
use crate::memory::GuestMemory;
use crate::operand::{FuncRef, Label, RegF32, RegF64, RegI32, RegI64, SigRef};
use crate::program::Program;
use crate::slot::Slot;
use crate::trap::TrapKind;

/// Why the execution stopped.
#[derive(Debug)]
pub(super) enum Exit {
    /// The budget is used up.
    Preempted,
    /// A call within the program for which there is no room yet.
    Call(FuncRef),
    /// A call of the firmware.
    CallFirmware(GuestAddr, SigRef),
    /// A call through a pointer.
    CallPointer(GuestAddr, SigRef),
    /// A return from the outermost call.
    Ended,
    /// A load that is not from RAM, into the register of the given index.
    Load(GuestAddr, Width, u16),
    /// A store of a slot that is not to RAM, or to where nothing may be written.
    Store(GuestAddr, Width, u64),
    /// A copy within memory.
    Copy { to: GuestAddr, from: GuestAddr, len: u16 },
    /// Bytes to clear.
    Clear { to: GuestAddr, len: u16 },
    /// The program did the impossible.
    Trap(TrapKind),
    /// A debugger holds the context before this word.
    Held,
}

/// How the execution continues after an instruction.
pub(super) enum Flow {
    /// With the next word.
    Next,
    /// With the word `.0` words further on than the next.
    Skip(usize),
    /// With the word at a label.
    Jump(Label),
    /// Not.
    Leave(Exit),
}

/// What the method of an instruction may return.
pub(super) trait Finish {
    /// The same as a flow.
    fn flow(self) -> Flow;
}

impl Finish for () {
    #[inline(always)]
    fn flow(self) -> Flow {
        Flow::Next
    }
}

impl Finish for Flow {
    #[inline(always)]
    fn flow(self) -> Flow {
        self
    }
}

impl Finish for Exit {
    #[inline(always)]
    fn flow(self) -> Flow {
        Flow::Leave(self)
    }
}

impl Finish for Result<(), TrapKind> {
    #[inline(always)]
    fn flow(self) -> Flow {
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
}

macro_rules! registers {
    ($($register:ident holds $value:ty;)*) => {$(
        impl Register for $register {
            type Value = $value;

            #[inline(always)]
            fn index(self) -> u16 {
                self.0
            }
        }
    )*};
}
registers! {
    RegI32 holds i32;
    RegI64 holds i64;
    RegF32 holds f32;
    RegF64 holds f64;
}

/// What an execution has besides the registers of the current call.
pub(super) struct State<'m> {
    pub(super) program: &'m Program,
    pub(super) memory: &'m mut GuestMemory,
    /// What is left of the slice, in cycles.
    pub(super) budget: i64,
    /// The registers of all calls.
    pub(super) registers: &'m [Cell<u64>],
    pub(super) calls: &'m mut Calls,
    /// Why the execution ended, once it has.
    pub(super) exit: Option<Exit>,
}

/// One call of a function while it executes.
pub(super) struct Activation<'a, 'm> {
    pub(super) state: &'a mut State<'m>,
    pub(super) window: &'m Window,
    /// The instruction that is executed.
    pub(super) pc: usize,
}

impl Activation<'_, '_> {
    #[inline(always)]
    pub(super) fn get<R: Register>(&self, register: R) -> R::Value {
        R::Value::from_slot(self.window[usize::from(register.index())].get())
    }

    #[inline(always)]
    pub(super) fn set<R: Register>(&self, register: R, value: R::Value) {
        self.window[usize::from(register.index())].set(value.into_slot());
    }
}
