//! How blocks end.

use cranelift_entity::SecondaryMap;

use super::Selector;
use crate::c67x::code::{Arg, Base, End, MemoryPlace, VReg, Value};
use crate::c67x::forms::Kind;
use crate::ir::function::{Block, Function};
use crate::ir::inst::{InstKind, Operand, Terminator, ValueId};
use crate::ir::operators::CompareOp;

/// The comparison that a block ends with, if nothing but its branch wants it.
pub(super) fn fused_compare(
    function: &Function,
    block: &Block,
    uses: &SecondaryMap<ValueId, u32>,
) -> Option<Compare> {
    let Terminator::Branch { condition: Operand::Value(condition), .. } = block.terminator else {
        return None;
    };
    let InstKind::Compare { op, dst, a, b } = block.insts.last()?.kind else { return None };
    let is_own = dst == condition && uses[dst] == 1 && !function.params.contains(&dst);
    is_own.then_some(Compare { op, a, b })
}

/// A comparison.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compare {
    op: CompareOp,
    a: Operand,
    b: Operand,
}

impl Selector<'_> {
    pub(super) fn terminator(&mut self, terminator: &Terminator, fused: Option<Compare>) -> End {
        match *terminator {
            Terminator::Jump(to) => End::Jump(self.numbers[to]),
            Terminator::Branch { condition, then, otherwise } => {
                let (then, otherwise) = (self.numbers[then], self.numbers[otherwise]);
                if then == otherwise {
                    return End::Jump(then);
                }
                let (condition, negated) = self.tested(condition, fused);
                End::Branch { condition, negated, then, otherwise }
            }
            Terminator::Table { index, ref targets, default } => {
                let targets = targets.iter().map(|to| self.numbers[*to]).collect();
                self.table(index, targets, self.numbers[default])
            }
            Terminator::Return(value) => End::Return(value.map(|value| self.returned(value))),
            Terminator::Unreachable => End::Unreachable,
        }
    }

    /// A register to test, and whether 0 means yes.
    fn tested(&mut self, condition: Operand, fused: Option<Compare>) -> (VReg, bool) {
        let tested = self.condition();
        let Some(Compare { op, a, b }) = fused else {
            let condition = self.operand(condition);
            self.copy_word(tested, condition);
            return (tested, false);
        };
        let is_zero = |operand: Operand| operand.as_int() == Some(0);
        if matches!(op, CompareOp::Equal | CompareOp::NotEqual) && (is_zero(a) || is_zero(b)) {
            let value = self.operand(if is_zero(b) { a } else { b });
            self.copy_word(tested, value);
            return (tested, op == CompareOp::Equal);
        }
        let is_inverted = self.compare(op, tested, a, b);
        (tested, is_inverted)
    }

    /// A jump through a table of addresses; the block is cut where the index is found too large.
    fn table(&mut self, index: Operand, targets: Vec<u32>, default: u32) -> End {
        let index = self.operand(index);
        let table = self.code.tables.len() as u32;
        let count = targets.len() as i32;
        let is_inside = self.condition();
        let limit = self.known(Value::Number(count));
        self.push(Kind::CmpLtu, is_inside, index, limit);
        // The index that is too large becomes that of the default, which stands last.
        let place = self.word();
        self.copy_word(place, limit);
        self.copy_word(place, index);
        self.only_if(Some((is_inside, false)));
        let base = self.known(Value::Table(table));
        let address = self.word();
        let at = MemoryPlace { base: Base::Reg(base), offset: 0, index: Some(place), step: 0 };
        self.access(Kind::LoadWord, address.into(), Arg::None, at);
        let mut all = targets;
        all.push(default);
        self.code.tables.push(all.clone());
        End::Table { address, targets: all }
    }
}
