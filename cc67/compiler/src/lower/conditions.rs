//! Conditions to branches.

use super::{Lowering, cost_table, types};
use crate::ir::inst::{BlockId, Class, Operand};
use crate::ir::operators::{CompareOp, Width};
use crate::operators;
use crate::ty::Types;
use crate::typed::{self, ExprId, ExprKind, UnaryOp};

/// The outcome of a condition on which the vendor's code jumps; on the other it continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    /// As in `if`, loops and `&&`.
    JumpIfFalse,
    /// As in `||`, `!` and at the end of `do`.
    JumpIfTrue,
}

impl Sense {
    /// The sense of whether false jumps.
    pub(super) const fn of(jumps_if_false: bool) -> Self {
        if jumps_if_false { Self::JumpIfFalse } else { Self::JumpIfTrue }
    }
}

impl Lowering<'_> {
    /// Branches to `then` if the expression is not zero, otherwise to `otherwise`; `sense` is the direction of the
    /// vendor's branch, which determines the costs of the paths.
    pub(super) fn branch(&mut self, condition: ExprId, sense: Sense, then: BlockId, otherwise: BlockId) {
        let expr = &self.function.exprs[condition];
        match expr.kind {
            ExprKind::Int(value) => {
                if (value == 0) == (sense == Sense::JumpIfFalse) {
                    self.cost(cost_table::BRANCH);
                }
                self.builder.jump(if value == 0 { otherwise } else { then });
            }
            ExprKind::Unary(UnaryOp::Not, inner) if self.is_comparison(inner) => {
                self.branch(inner, Sense::JumpIfFalse, otherwise, then);
            }
            ExprKind::Unary(UnaryOp::Not, inner) => {
                let (then, otherwise) = self.oriented_paths(Sense::JumpIfTrue, sense, then, otherwise);
                self.branch(inner, Sense::JumpIfFalse, otherwise, then);
            }
            ExprKind::And(..) => {
                let (then, otherwise) = self.oriented_paths(Sense::JumpIfFalse, sense, then, otherwise);
                let test = |this: &mut Self, term, next| {
                    this.branch(term, Sense::JumpIfFalse, next, otherwise);
                };
                self.lower_chain(condition, Sense::JumpIfFalse, test, then, otherwise);
            }
            ExprKind::Or(..) => {
                let (then, otherwise) = self.oriented_paths(Sense::JumpIfTrue, sense, then, otherwise);
                let test = |this: &mut Self, term, next| this.branch(term, Sense::JumpIfTrue, then, next);
                self.lower_chain(condition, Sense::JumpIfTrue, test, then, otherwise);
            }
            ExprKind::Comma(first, second) => {
                self.lower_effect(first);
                self.branch(second, sense, then, otherwise);
            }
            ExprKind::Compare(operators::CompareOp::Equal, a, b) if self.is_word_zero(b) => {
                self.charge_zero_test();
                self.branch(a, sense, otherwise, then);
            }
            ExprKind::Compare(operators::CompareOp::NotEqual, a, b) if self.is_word_zero(b) => {
                self.charge_zero_test();
                self.branch(a, sense, then, otherwise);
            }
            ExprKind::Convert(inner) if self.keeps_truth(inner, condition) => {
                self.branch(inner, sense, then, otherwise);
            }
            _ => {
                let value = self.value(condition);
                self.charge_test(condition);
                let value = self.word_truth(value);
                self.builder.branch(value, then, otherwise);
            }
        }
    }

    fn is_comparison(&self, id: ExprId) -> bool {
        matches!(self.function.exprs[id].kind, ExprKind::Compare(..))
    }

    /// The paths of a condition that branches in the opposite sense: falling through becomes a jump.
    fn oriented_paths(
        &mut self,
        natural: Sense,
        wanted: Sense,
        then: BlockId,
        otherwise: BlockId,
    ) -> (BlockId, BlockId) {
        match (natural, wanted) {
            (Sense::JumpIfTrue, Sense::JumpIfFalse) => {
                (then, self.costly_way(otherwise, cost_table::BRANCH as u32).unwrap_or(otherwise))
            }
            (Sense::JumpIfFalse, Sense::JumpIfTrue) => {
                (self.costly_way(then, cost_table::BRANCH as u32).unwrap_or(then), otherwise)
            }
            (Sense::JumpIfFalse, Sense::JumpIfFalse) | (Sense::JumpIfTrue, Sense::JumpIfTrue) => {
                (then, otherwise)
            }
        }
    }

    /// Tests the terms of a chain of one operator, `a && b && c …`: each but the last continues at the next through
    /// `test`. Such chains are nested on the left; they are walked iteratively.
    fn lower_chain(
        &mut self,
        id: ExprId,
        sense: Sense,
        test: impl Fn(&mut Self, ExprId, BlockId),
        then: BlockId,
        otherwise: BlockId,
    ) {
        let bottom = self.spine.len();
        let is_and = matches!(self.function.exprs[id].kind, ExprKind::And(..));
        let mut first = id;
        loop {
            match self.function.exprs[first].kind {
                ExprKind::And(a, b) if is_and => {
                    self.spine.push(b);
                    first = a;
                }
                ExprKind::Or(a, b) if !is_and => {
                    self.spine.push(b);
                    first = a;
                }
                _ => break,
            }
        }
        let mut term = first;
        while self.spine.len() > bottom {
            let next = self.builder.block();
            test(self, term, next);
            self.builder.open(next);
            let Some(following) = self.spine.pop() else { break };
            term = following;
        }
        self.branch(term, sense, then, otherwise);
    }

    /// A word that is zero exactly if the value is.
    fn word_truth(&mut self, value: Operand) -> Operand {
        let class = self.builder.function.class(value);
        if class == Class::I32 {
            return value;
        }
        let truth = self.builder.value(Class::I32);
        self.builder.compare(CompareOp::NotEqual, truth, value, class.zero().into());
        truth.into()
    }

    /// Reports whether the expression is the constant 0 of a type held in a 32-bit word.
    fn is_word_zero(&self, id: ExprId) -> bool {
        let expr = &self.function.exprs[id];
        matches!(expr.kind, ExprKind::Int(0)) && types::class(&self.unit.types, expr.ty) == Some(Class::I32)
    }

    /// Reports whether a conversion gives zero exactly for zero: to `_Bool`, and from word to word.
    fn keeps_truth(&self, inner: ExprId, converted: ExprId) -> bool {
        let (from, to) = (self.function.exprs[inner].ty, self.function.exprs[converted].ty);
        let types = &self.unit.types;
        let is_word = types::class(types, from) == Some(Class::I32);
        to == Types::BOOL || (is_word && types::width(types, to) == Some(Width::I32))
    }

    /// Reports whether the condition is small enough to be duplicated, before and after the body.
    pub(super) fn is_small(&self, condition: ExprId) -> bool {
        let mut budget = 12;
        self.count(condition, &mut budget);
        budget > 0
    }

    /// Subtracts the nodes of an expression from `budget`; anything that needs more than a few instructions exhausts
    /// it.
    fn count(&self, id: ExprId, budget: &mut u32) {
        *budget = budget.saturating_sub(1);
        if *budget == 0 {
            return;
        }
        match self.function.exprs[id].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => {}
            ExprKind::Load(place) | ExprKind::Address(place) => match self.function.places[place].kind {
                typed::PlaceKind::Pointer(pointer, _) => self.count(pointer, budget),
                typed::PlaceKind::Local(..) | typed::PlaceKind::Symbol(..) => {}
                typed::PlaceKind::Bits(..) => *budget = 0,
            },
            ExprKind::Unary(_, a) | ExprKind::Convert(a) => self.count(a, budget),
            ExprKind::Binary(_, a, b)
            | ExprKind::Compare(_, a, b)
            | ExprKind::And(a, b)
            | ExprKind::Or(a, b) => {
                self.count(a, budget);
                self.count(b, budget);
            }
            _ => *budget = 0,
        }
    }
}
