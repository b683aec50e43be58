//! Instructions that determine the next instruction: charges, branches, calls, returns.

use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    AbiParam, BlockCall, FuncRef as IrFuncRef, InstBuilder, JumpTableData, Signature, Value, types,
};
use kmotiondef::GuestAddr;

use super::super::request::Reason;
use super::super::state::State;
use super::{Translator, thunk_signature, type_of};
use crate::engine::Preemption;
use crate::firmware::{Pure, PureFunction};
use crate::meter::branch_target;
use crate::operand::{
    Addr, Class, Classes, Count, Count32, FuncRef, Label, RegF32, RegF64, RegI32, RegI64, SigRef,
};

/// Words that are never executed in a verified program.
macro_rules! structure {
    ($($name:ident($($operand:ty),*);)*) => {
        impl Translator<'_, '_> {
            $(pub(super) fn $name(&mut self, $(_: $operand),*) {
                self.unreachable();
            })*
        }
    };
}
structure! {
    program(Count, Count32);
    sig(Count, Count);
    types(Classes);
    func(SigRef, Count, Count);
}

/// The four classes of the instructions that move a value into a call or out of it.
macro_rules! for_each_class {
    ($($arg:ident, $result:ident, $ret:ident: $register:ident, $class:ident;)*) => {
        impl Translator<'_, '_> {$(
            pub(super) fn $arg(&mut self, src: $register, _: Count) {
                let value = self.get(src);
                self.calls.arguments.push(value);
            }

            pub(super) fn $result(&mut self, dst: $register) {
                let slot = self.calls.result.unwrap_or_else(|| unreachable!("a result of a verified program"));
                let value = self.read_slot(Class::$class, slot);
                self.set(dst, value);
            }

            pub(super) fn $ret(&mut self, src: $register) {
                let value = self.get(src);
                let slot = self.slot(Class::$class, value);
                self.return_slot(slot);
            }
        )*}
    };
}
for_each_class! {
    arg_i32, result_i32, ret_i32: RegI32, I32;
    arg_i64, result_i64, ret_i64: RegI64, I64;
    arg_f32, result_f32, ret_f32: RegF32, F32;
    arg_f64, result_f64, ret_f64: RegF64, F64;
}

impl Translator<'_, '_> {
    pub(super) fn charge(&mut self, cycles: Count32) {
        if self.defer(cycles.0) {
            return;
        }
        if self.translation.preemption == Preemption::Instructions && self.calls.attempt.is_none() {
            let budget = self.builder.use_var(self.registers.budget);
            let left = self.builder.ins().iadd_imm_s(budget, -i64::from(cycles.0));
            self.split(left);
            return self.spend(cycles.0);
        }
        self.spend(cycles.0);
        if self.calls.attempt.is_some() {
            return;
        }
        let left = self.builder.use_var(self.registers.budget);
        let overdrawn = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, left, 0);
        let (stop, go_on) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(overdrawn, stop, &[], go_on, &[]);
        self.enter_cold(stop);
        let none = self.builder.ins().iconst(types::I64, 0);
        self.request(Reason::Preempted.code(), self.at + 1, none, none);
        self.builder.ins().jump(go_on, &[]);
        self.enter(go_on);
    }

    pub(super) fn br(&mut self, to: Label) {
        self.go_to(to.0 as usize);
    }

    pub(super) fn br_if(&mut self, cond: RegI32, to: Label) {
        self.branch(cond, to.0 as usize, self.at + 1);
    }

    pub(super) fn br_unless(&mut self, cond: RegI32, to: Label) {
        self.branch(cond, self.at + 1, to.0 as usize);
    }

    /// Branches to the word `then` if the register is not 0, otherwise to `otherwise`.
    fn branch(&mut self, cond: RegI32, then: usize, otherwise: usize) {
        let cond = self.get(cond);
        let (then, otherwise) = (self.edge(then), self.edge(otherwise));
        self.builder.ins().brif(cond, then, &[], otherwise, &[]);
        self.finish_edges();
        self.reachable = false;
    }

    pub(super) fn br_table(&mut self, index: RegI32, n: Count) {
        let index = self.get(index);
        let branches = &self.translation.program.ops()[self.at + 1..=self.at + 1 + usize::from(n.0)];
        let targets = branches.iter().filter_map(branch_target).map(|to| self.blocks[&(to.0 as usize)]);
        let mut calls: Vec<_> =
            targets.map(|block| BlockCall::new(block, [], &mut self.builder.func.dfg.value_lists)).collect();
        let Some(last) = calls.pop() else {
            unreachable!("a table of a verified program has a branch");
        };
        let table = self.builder.create_jump_table(JumpTableData::new(last, &calls));
        self.builder.ins().br_table(index, table);
        self.reachable = false;
    }

    /// Calls the function with the given index.
    pub(super) fn make_call(&mut self, index: usize) {
        let callee = self.callee(index);
        self.note_call();
        let arguments = self.take_call_arguments();
        let call = self.builder.ins().call(callee, &arguments);
        self.take_results(call);
    }

    pub(super) fn call_ptr(&mut self, target: RegI32, sig: SigRef) {
        let target = self.get(target);
        let address = self.builder.ins().uextend(types::I64, target);
        let signature = self.builder.ins().iconst(types::I64, i64::from(sig.0));
        self.store_arguments(sig);
        let thunk = self.usual_request(Reason::CallPointer.code(), self.at, address, signature);
        let (own, firmware, behind) =
            (self.builder.create_block(), self.builder.create_block(), self.builder.create_block());
        let result = self.builder.append_block_param(behind, types::I64);
        self.builder.ins().brif(thunk, own, &[], firmware, &[]);

        self.enter_cold(firmware);
        let slot = self.usual_request(Reason::CallFirmware.code(), self.at, address, signature);
        self.builder.ins().jump(behind, &[slot.into()]);

        self.enter(own);
        self.note_call();
        self.calls.arguments.clear();
        let arguments = self.take_call_arguments();
        let signature = self.builder.import_signature(thunk_signature());
        let call = self.builder.ins().call_indirect(signature, thunk, &arguments);
        self.take_results(call);
        let slot = self.calls.result.unwrap_or(address);
        self.builder.ins().jump(behind, &[slot.into()]);

        self.enter(behind);
        self.calls.result = Some(result);
    }

    pub(super) fn call_fw(&mut self, sig: SigRef, addr: Addr) {
        if let Some(pure) = self.pure_function(sig, addr) {
            return self.call_pure(pure);
        }
        self.store_arguments(sig);
        self.calls.arguments.clear();
        let address = self.builder.ins().iconst(types::I64, i64::from(addr.0));
        let signature = self.builder.ins().iconst(types::I64, i64::from(sig.0));
        let slot = self.usual_request(Reason::CallFirmware.code(), self.at, address, signature);
        self.note_time();
        self.calls.result = Some(slot);
    }

    /// The firmware function at `addr`, if it only computes and is called with its own signature.
    pub(super) fn pure_function(&self, sig: SigRef, addr: Addr) -> Option<Pure> {
        let pure = (self.translation.pure)(GuestAddr::new(addr.0))?;
        let called = &self.translation.program.signatures()[usize::from(sig.0)];
        let is_same =
            called.params == pure.function.parameters() && called.result == Some(pure.function.result());
        is_same.then_some(pure)
    }

    /// Computes a pure firmware function inline; it takes as long as when the firmware executes it.
    fn call_pure(&mut self, pure: Pure) {
        let cycles = u32::try_from(pure.cost.get()).expect("functions cost little");
        if !self.defer(cycles) {
            self.spend(cycles);
        }
        let arguments = std::mem::take(&mut self.calls.arguments);
        let value = self.call_host(pure.function, &arguments);
        self.calls.result = Some(value);
    }

    /// Calls the host's function.
    fn call_host(&mut self, function: PureFunction, arguments: &[Value]) -> Value {
        let mut signature = Signature::new(self.module.isa().default_call_conv());
        let parameters = function.parameters().iter().map(|class| AbiParam::new(type_of(*class)));
        signature.params.extend(parameters);
        signature.returns.push(AbiParam::new(type_of(function.result())));
        let signature = self.builder.import_signature(signature);
        let pointer = self.builder.ins().iconst(types::I64, function.pointer().expose_provenance() as i64);
        let call = self.builder.ins().call_indirect(signature, pointer, arguments);
        self.builder.inst_results(call)[0]
    }

    pub(super) fn ret(&mut self) {
        let none = self.builder.ins().iconst(types::I64, 0);
        self.return_slot(none);
    }

    pub(super) fn unreachable(&mut self) {
        let none = self.builder.ins().iconst(types::I64, 0);
        self.trap(Reason::Unreachable, none);
        self.reachable = false;
    }

    /// The index of the function `func`.
    pub(super) fn function_index(&self, func: FuncRef) -> usize {
        let functions = self.translation.program.functions();
        functions
            .binary_search_by_key(&func, |function| function.at)
            .unwrap_or_else(|_| unreachable!("a function reference of a verified program"))
    }

    /// The function with the given index, declared for calls from this function.
    fn callee(&mut self, index: usize) -> IrFuncRef {
        let id = self.translation.functions[index];
        let (module, builder) = (&mut *self.module, &mut self.builder);
        *self.calls.callees.entry(index).or_insert_with(|| module.declare_func_in_func(id, builder.func))
    }

    /// Records the position of this function while its callee runs.
    fn note_call(&mut self) {
        let at = self.builder.ins().iconst(types::I32, self.at as i64);
        let field = super::offset(offset_of!(State, calls));
        self.builder.ins().store(self.flags.state, at, self.frame.call_entry, field);
    }

    /// The arguments of a call within the program.
    fn take_call_arguments(&mut self) -> Vec<Value> {
        let budget = self.builder.use_var(self.registers.budget);
        let mut arguments = vec![self.frame.state, self.frame.stack_pointer, budget];
        arguments.append(&mut self.calls.arguments);
        arguments
    }

    /// Takes the budget and the result returned by a function of the program.
    fn take_results(&mut self, call: cranelift_codegen::ir::Inst) {
        let (budget, slot) = (self.builder.inst_results(call)[0], self.builder.inst_results(call)[1]);
        self.builder.def_var(self.registers.budget, budget);
        self.calls.result = Some(slot);
    }

    /// Puts the arguments of a call with signature `sig` into the state.
    fn store_arguments(&mut self, sig: SigRef) {
        let parameters = &self.translation.program.signatures()[usize::from(sig.0)].params;
        for (index, (class, value)) in parameters.iter().zip(self.calls.arguments.clone()).enumerate() {
            let slot = self.slot(*class, value);
            self.store_state(slot, offset_of!(State, exchange.arguments) + index * size_of::<u64>());
        }
    }

    fn return_slot(&mut self, slot: Value) {
        if let Some(attempt) = self.calls.attempt {
            return self.end_attempt(attempt, slot);
        }
        self.settle_budget();
        let at = self.builder.ins().iconst(types::I32, self.at as i64);
        self.store_state(at, offset_of!(State, returned_at));
        let budget = self.builder.use_var(self.registers.budget);
        self.builder.ins().return_(&[budget, slot]);
        self.reachable = false;
    }
}
