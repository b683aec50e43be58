//! Conditions to branches.

use super::{Lowering, types};
use crate::ir::inst::{BlockId, Class, Operand};
use crate::ir::operators::{CompareOp, Width};
use crate::ty::Types;
use crate::typed::{self, ExprId, ExprKind, UnaryOp};

impl Lowering<'_> {
    /// Goes to `then` if the expression is not zero, else to `otherwise`.
    pub(super) fn branch(&mut self, condition: ExprId, then: BlockId, otherwise: BlockId) {
        let expr = &self.function.exprs[condition];
        match expr.kind {
            ExprKind::Int(value) => self.builder.jump(if value == 0 { otherwise } else { then }),
            ExprKind::Unary(UnaryOp::Not, inner) => self.branch(inner, otherwise, then),
            ExprKind::And(..) => {
                self.chain(condition, |this, term, next| this.branch(term, next, otherwise), then, otherwise);
            }
            ExprKind::Or(..) => {
                self.chain(condition, |this, term, next| this.branch(term, then, next), then, otherwise);
            }
            ExprKind::Comma(first, second) => {
                self.effect(first);
                self.branch(second, then, otherwise);
            }
            ExprKind::Compare(typed::CompareOp::Equal, a, b) if self.is_word_zero(b) => {
                self.branch(a, otherwise, then);
            }
            ExprKind::Compare(typed::CompareOp::NotEqual, a, b) if self.is_word_zero(b) => {
                self.branch(a, then, otherwise);
            }
            ExprKind::Convert(inner) if self.keeps_truth(inner, condition) => {
                self.branch(inner, then, otherwise);
            }
            _ => {
                let value = self.value(condition);
                let value = self.word_truth(value);
                self.builder.branch(value, then, otherwise);
            }
        }
    }

    /// Tests the terms of a chain of one operator, `a && b && c …`: each but the last goes on at the next by
    /// way of `test`. Such chains lean to the left; they are walked, not recursed into.
    fn chain(
        &mut self,
        id: ExprId,
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
        self.branch(term, then, otherwise);
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

    /// Whether the expression is the constant 0 of a type held in a 32-bit word.
    fn is_word_zero(&self, id: ExprId) -> bool {
        let expr = &self.function.exprs[id];
        matches!(expr.kind, ExprKind::Int(0)) && types::class(&self.unit.types, expr.ty) == Some(Class::I32)
    }

    /// Whether a conversion gives zero exactly for zero: to `_Bool`, and from word to word.
    fn keeps_truth(&self, inner: ExprId, converted: ExprId) -> bool {
        let (from, to) = (self.function.exprs[inner].ty, self.function.exprs[converted].ty);
        let types = &self.unit.types;
        let is_word = types::class(types, from) == Some(Class::I32);
        to == Types::BOOL || (is_word && types::width(types, to) == Some(Width::I32))
    }

    /// Whether a loop can afford to have the condition twice, in front and behind the body.
    pub(super) fn is_small(&self, condition: ExprId) -> bool {
        let mut budget = 12;
        self.count(condition, &mut budget);
        budget > 0
    }

    /// Takes the nodes of an expression from `budget`; everything that makes more code than a few instructions
    /// exhausts it.
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
