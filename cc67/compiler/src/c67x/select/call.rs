//! Calls.

use super::{Selector, Value, is_pair};
use crate::c67x::Externs;
use crate::c67x::abi;
use crate::c67x::code::{Arg, Base, Call, CallTarget, Inst, MemoryPlace, VReg};
use crate::c67x::forms::Kind;
use crate::ir::inst::{ArgumentRange, Callee, Class, Operand, SignatureId, ValueId};

/// Reports whether the callee ignores the last argument of a call, the address of its variable arguments.
pub(super) fn takes_stack_alone(callee: Callee, externs: &Externs) -> bool {
    matches!(callee, Callee::Symbol(symbol) if externs.takes_stack_alone(symbol))
}

impl Selector<'_> {
    pub(super) fn call(
        &mut self,
        callee: Callee,
        arguments: ArgumentRange,
        signature: SignatureId,
        dst: Option<ValueId>,
    ) {
        let operands = &self.function.arguments[arguments.range()];
        let last_named = operands.len().checked_sub(2);
        let wanted = operands.len() - usize::from(takes_stack_alone(callee, self.externs));
        let operands = &operands[..wanted];
        let mut passed: Vec<VReg> = operands.iter().map(|operand| self.operand(*operand)).collect();
        let classes: Vec<Class> = operands.iter().map(|operand| self.function.class(*operand)).collect();
        let takes_variable = match callee {
            Callee::Symbol(symbol) => self.externs.is_variadic(symbol),
            Callee::Pointer(_) => false,
        };
        if takes_variable {
            self.last_named(last_named.map(|index| (passed[index], classes[index])));
        }
        let rest = passed.split_off(passed.len().min(abi::ARGUMENTS.len()));
        let mut arguments: Vec<_> = passed.into_iter().zip(abi::ARGUMENTS).collect();
        if !rest.is_empty() {
            let area = self.store_stack_arguments(&rest, &classes[abi::ARGUMENTS.len()..]);
            arguments.push((area, abi::REST));
        }
        let target = match callee {
            Callee::Symbol(symbol) if self.externs.ends_thread(symbol) => {
                arguments.push((self.thread(), abi::THREAD));
                CallTarget::Symbol(symbol)
            }
            Callee::Symbol(symbol) => CallTarget::Symbol(symbol),
            Callee::Pointer(pointer) => {
                arguments.push((self.operand(pointer), abi::TARGET));
                CallTarget::Register
            }
        };
        // A function's result is in its registers, needed or not.
        let class = self.signatures.get(signature).result;
        let result = dst.filter(|_| class.is_some()).map(|dst| self.value(dst));
        self.emit_call(target, arguments, result);
    }

    /// The last named argument of a variadic function, which is also passed in memory (`c67x.md` 6.1).
    fn last_named(&mut self, last: Option<(VReg, Class)>) {
        self.code.has_variable_calls = true;
        if let Some((reg, class)) = last.filter(|(_, class)| !is_pair(*class)) {
            debug_assert!(!is_pair(class), "a pair has no place below the variable arguments");
            let mut inst = Inst::new(Kind::StoreWord, Arg::None, Arg::None, reg.into(), self.span);
            inst.place = Some(MemoryPlace::new(Base::Stack, 4));
            self.out.push(inst);
        }
    }

    /// The number of the thread, from the firmware, since functions keep other values in its register.
    fn thread(&mut self) -> VReg {
        let symbol = self.externs.symbol("CurrentThread");
        let base = self.constant_register(Value::Symbol(symbol, 0));
        let number = self.word();
        self.access(Kind::LoadWord, number.into(), Arg::None, MemoryPlace::new(Base::Reg(base), 0));
        number
    }

    /// Stores the arguments that have no register; returns their address.
    fn store_stack_arguments(&mut self, rest: &[VReg], classes: &[Class]) -> VReg {
        let first = self.code.spills.next_multiple_of(2);
        self.code.spills = first + 2 * rest.len() as u32;
        for (index, (reg, class)) in (0..).zip(rest.iter().zip(classes)) {
            let place = MemoryPlace::new(Base::Spill(first), 8 * index);
            if is_pair(*class) {
                self.access(Kind::StoreWord, Arg::None, Arg::Low(*reg), place);
                let next = MemoryPlace::new(Base::Spill(first), 8 * index + 4);
                self.access(Kind::StoreWord, Arg::None, Arg::High(*reg), next);
            } else {
                self.access(Kind::StoreWord, Arg::None, (*reg).into(), place);
            }
        }
        let area = self.word();
        let mut inst = Inst::new(Kind::FrameAddress, area.into(), Arg::None, Arg::None, self.span);
        inst.place = Some(MemoryPlace::new(Base::Spill(first), 0));
        self.out.push(inst);
        area
    }

    /// Calls a function of the firmware or of the library.
    pub(super) fn helper(&mut self, name: &'static str, arguments: &[VReg], result: VReg) {
        let symbol = self.externs.symbol(name);
        let arguments = arguments.iter().copied().zip(abi::ARGUMENTS).collect();
        self.emit_call(CallTarget::Symbol(symbol), arguments, Some(result));
    }

    fn emit_call(&mut self, target: CallTarget, arguments: Vec<(VReg, c67x::Reg)>, result: Option<VReg>) {
        for (reg, at) in &arguments {
            let info = &mut self.code.regs[*reg];
            info.hint = info.hint.or(Some(*at));
        }
        let dst = match result {
            Some(reg) => {
                let info = &mut self.code.regs[reg];
                info.hint = info.hint.or(Some(abi::RESULT));
                Arg::Reg(reg)
            }
            None => Arg::None,
        };
        // Arguments from the seventh on are passed in callee-saved registers.
        let written = arguments.iter().fold(0, |set, (reg, at)| {
            let high = if self.code.regs[*reg].is_pair { at.pair().high() } else { *at };
            set | abi::bit(*at) | abi::bit(high)
        });
        let changes = abi::CHANGED | written;
        let mut inst = Inst::new(Kind::Call, dst, Arg::None, Arg::None, self.span);
        inst.number = self.code.calls.len() as u32;
        let is_late = match target {
            CallTarget::Symbol(symbol) => self.externs.is_late(symbol),
            CallTarget::Register => true,
        };
        self.code.calls.push(Call { target, arguments, changes, is_late });
        self.out.push(inst);
    }

    /// The register in which an operand is returned.
    pub(super) fn returned_register(&mut self, operand: Operand) -> VReg {
        let reg = self.operand(operand);
        let info = &mut self.code.regs[reg];
        info.hint = info.hint.or(Some(abi::RESULT));
        reg
    }
}
