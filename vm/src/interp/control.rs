//! Instructions that determine the next instruction: charges, branches, calls, returns.

use kmotiondef::GuestAddr;

use super::activation::{Activation, Exit, Flow, Register, State};
use super::code::Word;
use super::context::Window;
use crate::operand::{Addr, Classes, Count, Count32, FuncRef, Label, RegF32, RegF64, RegI32, RegI64, SigRef};
use crate::slot::Slot;
use crate::trap::TrapKind;

/// Words that are never executed in a verified program.
macro_rules! structure {
    ($($name:ident($($operand:ty),*);)*) => {
        impl Activation<'_, '_> {
            $(#[inline(always)]
            pub(super) fn $name(&mut self, $(_: $operand),*) -> Exit {
                Exit::Trap(TrapKind::Unreachable)
            })*
        }
    };
}
structure! {
    program(Count, Count32);
    sig(Count, Count);
    types(Classes);
    func(SigRef, Count, Count);
    unreachable();
}

/// The four classes of the instructions that move a slot into a call or out of it.
macro_rules! for_each_class {
    ($($arg:ident, $result:ident, $ret:ident: $register:ident;)*) => {
        impl Activation<'_, '_> {$(
            #[inline(always)]
            pub(super) fn $arg(&mut self, src: $register, index: Count) {
                let first = self.state.calls.arguments_at();
                self.window[usize::from(first.wrapping_add(index.0))].set(self.get(src).into_slot());
            }

            #[inline(always)]
            pub(super) fn $result(&mut self, dst: $register) {
                let result = <$register as Register>::Value::from_slot(self.state.calls.result);
                self.set(dst, result);
            }

            #[inline(always)]
            pub(super) fn $ret(&mut self, src: $register) -> Flow {
                self.state.calls.result = self.get(src).into_slot();
                self.leave_call()
            }
        )*}
    };
}
for_each_class! {
    arg_i32, result_i32, ret_i32: RegI32;
    arg_i64, result_i64, ret_i64: RegI64;
    arg_f32, result_f32, ret_f32: RegF32;
    arg_f64, result_f64, ret_f64: RegF64;
}

impl<'m> Activation<'_, 'm> {
    #[inline(always)]
    pub(super) fn charge(&mut self, cycles: Count32) -> Flow {
        self.state.budget -= i64::from(cycles.0);
        if self.state.budget < 0 { Flow::Leave(Exit::Preempted) } else { Flow::Next }
    }

    #[inline(always)]
    pub(super) fn br(&mut self, to: Label) -> Flow {
        Flow::Jump(to)
    }

    #[inline(always)]
    pub(super) fn br_if(&mut self, cond: RegI32, to: Label) -> Flow {
        if self.get(cond) != 0 { Flow::Jump(to) } else { Flow::Next }
    }

    #[inline(always)]
    pub(super) fn br_unless(&mut self, cond: RegI32, to: Label) -> Flow {
        if self.get(cond) == 0 { Flow::Jump(to) } else { Flow::Next }
    }

    #[inline(always)]
    pub(super) fn br_table(&mut self, index: RegI32, n: Count) -> Flow {
        let index = self.get(index).cast_unsigned().min(u32::from(n.0));
        Flow::Skip(index as usize)
    }

    #[inline(always)]
    pub(super) fn call(&mut self, func: FuncRef) -> Flow {
        let pc = self.pc();
        let State { words, registers, calls, .. } = &mut *self.state;
        let head = words.get(func.0 as usize).map(Word::head);
        match head.and_then(|head| calls.call(func, head, pc, registers)) {
            Some(window) => self.go_to_call(window),
            None => Flow::Leave(Exit::Call(func)),
        }
    }

    #[inline(always)]
    pub(super) fn call_ptr(&mut self, target: RegI32, sig: SigRef) -> Exit {
        Exit::CallPointer(GuestAddr::new(self.get(target).cast_unsigned()), sig)
    }

    #[inline(always)]
    pub(super) fn call_fw(&mut self, sig: SigRef, addr: Addr) -> Exit {
        Exit::CallFirmware(GuestAddr::new(addr.0), sig)
    }

    #[inline(always)]
    pub(super) fn ret(&mut self) -> Flow {
        self.state.calls.result = 0;
        self.leave_call()
    }

    #[inline(always)]
    fn leave_call(&mut self) -> Flow {
        match self.state.calls.pop_call(self.state.registers) {
            Some(window) => self.go_to_call(window),
            None => Flow::Leave(Exit::Ended),
        }
    }

    /// Continues at the position of the current call, whose registers are in `window`.
    #[inline(always)]
    fn go_to_call(&mut self, window: &'m Window) -> Flow {
        self.window = window;
        Flow::Jump(Label(self.state.calls.pc as u32))
    }
}
