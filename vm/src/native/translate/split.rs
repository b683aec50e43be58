//! Segments that the budget does not cover, where threads lose the processor as on the board.
//!
//! They are translated a second time, with a test of the budget before each instruction; both translations continue at
//! the same place.

use std::mem::{replace, take};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};

use super::super::request::Reason;
use super::Translator;
use crate::engine::Preemption;
use crate::kind::{Name, OpKind, Width};
use crate::meter;
use crate::op::Op;
use crate::operand::{Addr, Class, Off, RegF64, RegI32, RegI64};

impl Translator<'_, '_> {
    /// The word at which both translations continue of the segment that is charged at `at`, if no branch ends it.
    pub(super) fn after_steps(&self, at: usize) -> Option<usize> {
        let ops = self.translation.program.ops();
        if self.translation.preemption == Preemption::Segments || ops[at].kind() != OpKind::Charge {
            return None;
        }
        let last = meter::steps(ops, at).steps.last().map_or(at, |(word, _)| *word);
        let continues = !ops[last].kind().ends_path() && !matches!(ops[last].kind(), OpKind::Table);
        let next = last + 1;
        let next = next + usize::from(meter::is_call(&ops[last]) && meter::is_result(&ops[next]));
        continues.then_some(next)
    }

    /// Executes in steps the segment that is charged here, if `left`, the budget after its charge, is below zero.
    pub(super) fn split(&mut self, left: Value) {
        let (steps, go_on) = (self.builder.create_block(), self.builder.create_block());
        let overdrawn = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, left, 0);
        self.builder.ins().brif(overdrawn, steps, &[], go_on, &[]);
        self.enter_cold(steps);
        let (at, budget) = (self.at, self.builder.use_var(self.registers.budget));
        let is_rare = replace(&mut self.unroll.is_rare, true);
        let raw = take(&mut self.registers.raw);
        self.steps(at);
        self.registers.raw = raw;
        self.unroll.is_rare = is_rare;
        self.at = at;
        self.reachable = true;
        self.enter(go_on);
        self.builder.def_var(self.registers.budget, budget);
    }

    /// Translates the segment that is charged at `charge` in steps.
    fn steps(&mut self, charge: usize) {
        let ops = self.translation.program.ops();
        let steps = meter::steps(ops, charge);
        self.spend(steps.head);
        for (at, cycles) in &steps.steps {
            self.at = *at;
            self.end_slice_if_over();
            let op = ops[*at];
            if let OpKind::Store(width @ (Width::I64 | Width::F64)) = op.kind() {
                self.store_of_two_words(op, width, *cycles);
            } else {
                self.spend(*cycles);
                self.op(op);
            }
        }
        if let Some(next) = self.after_steps(charge).filter(|_| self.reachable) {
            if next > self.at + 1 {
                self.word(next - 1);
            }
            self.builder.ins().jump(self.blocks[&next], &[]);
        }
    }

    /// Ends the slice before the present word if no budget is left.
    fn end_slice_if_over(&mut self) {
        let left = self.builder.use_var(self.registers.budget);
        let over = self.builder.ins().icmp_imm_s(IntCC::SignedLessThanOrEqual, left, 0);
        let (stop, go_on) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(over, stop, &[], go_on, &[]);
        self.enter_cold(stop);
        let none = self.builder.ins().iconst(types::I64, 0);
        self.request(Reason::Preempted.code(), self.at, none, none);
        self.builder.ins().jump(go_on, &[]);
        self.enter(go_on);
    }

    /// Stores eight bytes; the slice may end between the two words.
    fn store_of_two_words(&mut self, op: Op, width: Width, cycles: u32) {
        let left = self.builder.use_var(self.registers.budget);
        let is_last = self.builder.ins().icmp_imm_s(IntCC::Equal, left, 1);
        self.spend(cycles);
        let [halves, whole, behind] = [(); 3].map(|()| self.builder.create_block());
        self.builder.ins().brif(is_last, halves, &[], whole, &[]);
        self.enter_cold(halves);
        let address = self.address_of_store(op);
        let slot = self.stored_slot(op);
        self.request(Reason::StoreLowWord.with_width(width), self.at, address, slot);
        self.builder.ins().jump(behind, &[]);
        self.enter_cold(whole);
        self.op(op);
        self.builder.ins().jump(behind, &[]);
        self.enter(behind);
    }

    fn address_of_store(&mut self, op: Op) -> Value {
        if let Some(Addr(address)) = op.operand(Name::Addr) {
            return self.builder.ins().iconst(types::I64, i64::from(address));
        }
        let base = op.operand::<RegI32>(Name::Base).unwrap_or(RegI32(0));
        let Off(off) = op.operand(Name::Off).unwrap_or(Off(0));
        let base = self.get(base);
        let address = self.builder.ins().iadd_imm_s(base, i64::from(off));
        self.builder.ins().uextend(types::I64, address)
    }

    fn stored_slot(&mut self, op: Op) -> Value {
        if let Some(register) = op.operand::<RegI64>(Name::Src) {
            return self.get(register);
        }
        let value = self.get(op.operand(Name::Src).unwrap_or(RegF64(0)));
        self.slot(Class::F64, value)
    }
}
