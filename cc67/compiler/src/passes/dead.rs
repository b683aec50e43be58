//! Removes instructions whose value is never read.
//!
//! There are two kinds: the value is never read in the function, or before any read it is written again in the same
//! block, or the function ends.

use cranelift_entity::SecondaryMap;

use crate::ir::function::{Function, table};
use crate::ir::inst::{BlockId, Inst, InstKind, Operand, Terminator, ValueId};

/// Removes dead instructions in one walk from the end to the beginning.
pub fn run(function: &mut Function) {
    let mut remover =
        Remover { reads: count_reads(function), ahead: table(function.values.len()), region: 0 };
    for index in (0..function.layout.len()).rev() {
        let id = function.layout[index];
        remover.block(function, id);
    }
}

/// Number of reads of each value in the whole function.
fn count_reads(function: &Function) -> SecondaryMap<ValueId, u32> {
    let mut reads: SecondaryMap<ValueId, u32> = table(function.values.len());
    for &id in &function.layout {
        let block = &function.blocks[id];
        for inst in &block.insts {
            for_each_read(function, inst, |value| reads[value] += 1);
        }
        if let Some(Operand::Value(value)) = block.terminator.operand() {
            reads[value] += 1;
        }
    }
    reads
}

/// Hands every value that an instruction reads to `visit`.
fn for_each_read(function: &Function, inst: &Inst, mut visit: impl FnMut(ValueId)) {
    let mut kind = inst.kind;
    kind.visit_operands(|operand| {
        if let Operand::Value(value) = *operand {
            visit(value);
        }
    });
    if let Some(arguments) = inst.kind.arguments() {
        let arguments = &function.arguments[arguments.range()];
        arguments.iter().filter_map(|argument| argument.as_value()).for_each(visit);
    }
}

/// The next use of a value, seen from inside a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct NextUse {
    region: u32,
    is_read: bool,
}

struct Remover {
    reads: SecondaryMap<ValueId, u32>,
    ahead: SecondaryMap<ValueId, NextUse>,
    region: u32,
}

impl Remover {
    fn block(&mut self, function: &mut Function, id: BlockId) {
        self.region += 1;
        let leaves =
            matches!(function.blocks[id].terminator, Terminator::Return(_) | Terminator::Unreachable);
        if let Some(Operand::Value(value)) = function.blocks[id].terminator.operand() {
            self.ahead[value] = NextUse { region: self.region, is_read: true };
        }
        let mut insts = std::mem::take(&mut function.blocks[id].insts);
        let mut kept = insts.len();
        for index in (0..insts.len()).rev() {
            if self.must_keep(function, &mut insts[index], leaves) {
                kept -= 1;
                insts.swap(kept, index);
            }
        }
        insts.drain(..kept);
        function.blocks[id].insts = insts;
    }

    /// Reports whether an instruction must stay; the result of a call that must may still be dropped.
    fn must_keep(&mut self, function: &Function, inst: &mut Inst, leaves: bool) -> bool {
        if let Some(dst) = inst.kind.dst() {
            if self.is_dead(dst, leaves) {
                if !inst.kind.has_effect(function.values[dst]) {
                    for_each_read(function, inst, |value| self.reads[value] -= 1);
                    return false;
                }
                if let InstKind::Call { dst, .. } = &mut inst.kind {
                    *dst = None.into();
                }
            }
            self.ahead[dst] = NextUse { region: self.region, is_read: false };
        }
        let (region, ahead) = (self.region, &mut self.ahead);
        for_each_read(function, inst, |value| ahead[value] = NextUse { region, is_read: true });
        true
    }

    /// Reports whether the value written to `value` here is never read.
    fn is_dead(&self, value: ValueId, leaves: bool) -> bool {
        let ahead = self.ahead[value];
        let is_read = if ahead.region == self.region { ahead.is_read } else { !leaves };
        self.reads[value] == 0 || !is_read
    }
}
