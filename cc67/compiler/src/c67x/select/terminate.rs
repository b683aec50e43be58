//! Selection of the terminators of blocks.

use cranelift_entity::SecondaryMap;

use super::Selector;
use crate::c67x::code::{Arg, Base, MemoryPlace, Terminator, VReg, Value};
use crate::c67x::forms::Kind;
use crate::ir::function::{Block, Function};
use crate::ir::inst::{self, InstKind, Operand, ValueId};
use crate::ir::operators::CompareOp;

/// The comparison at the end of a block, if only its branch uses it.
pub(super) fn fused_compare(
    function: &Function,
    block: &Block,
    uses: &SecondaryMap<ValueId, u32>,
) -> Option<Compare> {
    let inst::Terminator::Branch { condition: Operand::Value(condition), .. } = block.terminator else {
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
    pub(super) fn terminator(&mut self, terminator: &inst::Terminator, fused: Option<Compare>) -> Terminator {
        match *terminator {
            inst::Terminator::Jump(to) => Terminator::Jump(self.numbers[to]),
            inst::Terminator::Branch { condition, then, otherwise } => {
                let (then, otherwise) = (self.numbers[then], self.numbers[otherwise]);
                if then == otherwise {
                    return Terminator::Jump(then);
                }
                let (condition, negated) = self.condition_register(condition, fused);
                Terminator::Branch { condition, negated, then, otherwise }
            }
            inst::Terminator::Table { index, ref targets, default } => {
                let targets = targets.iter().map(|to| self.numbers[*to]).collect();
                self.table(index, targets, self.numbers[default])
            }
            inst::Terminator::Return(value) => {
                Terminator::Return(value.map(|value| self.returned_register(value)))
            }
            inst::Terminator::Unreachable => Terminator::Unreachable,
        }
    }

    /// A register to test, and whether 0 means yes.
    fn condition_register(&mut self, condition: Operand, fused: Option<Compare>) -> (VReg, bool) {
        let Some(Compare { op, a, b }) = fused else {
            return (self.in_condition(condition), false);
        };
        let is_zero = |operand: Operand| operand.as_int() == Some(0);
        if matches!(op, CompareOp::Equal | CompareOp::NotEqual) && (is_zero(a) || is_zero(b)) {
            let tested = self.in_condition(if is_zero(b) { a } else { b });
            return (tested, op == CompareOp::Equal);
        }
        let tested = self.condition();
        let is_inverted = self.compare(op, tested, a, b);
        (tested, is_inverted)
    }

    /// A register with a word that can be tested: its own register if this block has just made it for no other use.
    fn in_condition(&mut self, operand: Operand) -> VReg {
        let value = operand.as_value().filter(|value| self.uses[*value] == 1);
        let own = self.operand(operand);
        let is_last =
            self.out.last().is_some_and(|inst| inst.dst == Arg::Reg(own) && inst.condition.is_none());
        if value.is_some() && is_last && self.code.regs[own].hint.is_none() {
            self.code.regs[own].is_condition = true;
            return own;
        }
        let tested = self.condition();
        self.copy_word(tested, own);
        tested
    }

    /// A jump through a table of addresses; the block is split where the index is found to be too large.
    fn table(&mut self, index: Operand, targets: Vec<u32>, default: u32) -> Terminator {
        let table = self.code.tables.len() as u32;
        let count = targets.len() as i32;
        let is_inside = self.condition();
        self.less(is_inside, index, Operand::int(count), true);
        // The address of the default is the first: where an index that is too large becomes 0.
        let (place, index) = (self.word(), self.operand(index));
        self.push(Kind::Add, place, Arg::number(1), index);
        self.push(Kind::And, place, Arg::number(0), place);
        self.only_if(Some((is_inside, true)));
        let base = self.constant_register(Value::Table(table));
        let address = self.word();
        let at = MemoryPlace { base: Base::Reg(base), offset: 0, index: Some(place), step: 0 };
        self.access(Kind::LoadWord, address.into(), Arg::None, at);
        let mut all = targets;
        all.insert(0, default);
        self.code.tables.push(all.clone());
        Terminator::Table { address, targets: all }
    }
}
