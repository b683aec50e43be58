//! The loop: executes one call of a function until it calls, returns or stops.
//!
//! The dispatch is expanded from the instruction table, one method an instruction; the
//! methods stand in `arith.rs`, `memory.rs` and `control.rs`. What a method returns says how
//! the loop goes on ([`Finish`]).

use kmotiondef::GuestAddr;

use super::context::{Context, Window};
use crate::engine::Slice;
use crate::firmware::Firmware;
use crate::for_each_op;
use crate::op::Op;
use crate::operand::{FuncRef, Label, RegF32, RegF64, RegI32, RegI64, SigRef};
use crate::slot::Slot;
use crate::trap::TrapKind;

/// Why the loop was left.
#[derive(Debug)]
pub(super) enum Exit {
    /// The budget is used up.
    Preempted,
    /// A call within the program.
    Call(FuncRef),
    /// A call of the firmware.
    CallFirmware(GuestAddr, SigRef),
    /// A call through a pointer.
    CallPointer(GuestAddr, SigRef),
    /// A return with a result as a slot, 0 for none.
    Return(u64),
    /// The program did the impossible.
    Trap(TrapKind),
}

/// How the loop goes on behind an instruction.
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

/// One call of a function while it executes.
pub(super) struct Activation<'a, 's, F: ?Sized> {
    pub(super) window: &'a mut Window,
    /// Where the arguments of the next call begin.
    pub(super) arguments_at: u16,
    /// Address of the frame in guest memory.
    pub(super) frame_address: u32,
    /// Result of the last call.
    pub(super) result: u64,
    pub(super) slice: &'a mut Slice<'s, F>,
}

macro_rules! define_loop {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr;)*) => {
        impl<F: Firmware + ?Sized> Activation<'_, '_, F> {
            /// Executes from `pc` on; yields why it was left, and the instruction that left it.
            fn execute(&mut self, ops: &[Op], mut pc: usize) -> (Exit, usize) {
                loop {
                    let next = pc + 1;
                    pc = match ops[pc] {
                        $(Op::$variant { $($field),* } => match self.$name($($field),*).flow() {
                            Flow::Next => next,
                            Flow::Skip(words) => next + words,
                            Flow::Jump(to) => to.0 as usize,
                            Flow::Leave(exit) => return (exit, pc),
                        },)*
                    };
                }
            }
        }
    };
}
for_each_op!(define_loop);

impl<F: Firmware + ?Sized> Activation<'_, '_, F> {
    /// Executes the current call of `context`, whose `pc` is then the instruction that left the loop.
    pub(super) fn run(context: &mut Context, slice: &mut Slice<'_, F>) -> Exit {
        let (program, pc) = (slice.program, context.pc);
        let mut activation = Activation {
            arguments_at: context.arguments_at(),
            frame_address: context.frame_address(),
            result: context.result,
            window: context.window(),
            slice,
        };
        let (exit, pc) = activation.execute(&program.ops, pc);
        context.pc = pc;
        exit
    }

    #[inline(always)]
    pub(super) fn get<R: Register>(&self, register: R) -> R::Value {
        R::Value::from_slot(self.window[usize::from(register.index())])
    }

    #[inline(always)]
    pub(super) fn set<R: Register>(&mut self, register: R, value: R::Value) {
        self.window[usize::from(register.index())] = value.into_slot();
    }
}
