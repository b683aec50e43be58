//! The function under construction: its expressions, places, locals and labels.
//!
//! The constructors here fold constants; they do not report diagnostics.

use std::collections::{BTreeMap, BTreeSet};

use cranelift_entity::PrimaryMap;

use super::constants::{self, Constant};
use crate::lints::value_range::DacWord;
use crate::names::Name;
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{
    Expr, ExprId, ExprKind, HiddenParameters, Label, LabelId, Local, LocalId, Place, PlaceId, PlaceKind,
    UnaryOp,
};

/// The parts of a function that are being built, and the state needed by its statements.
#[derive(Debug)]
pub(super) struct Body {
    /// Name of the function; empty at file scope.
    pub(super) name: String,
    /// The type of its result.
    pub(super) result: TypeId,
    /// It is declared `void`, even if it returns a value.
    pub(super) is_void: bool,
    /// Parameters that the source does not write.
    pub(super) hidden: HiddenParameters,
    /// Parameters, variables and temporaries.
    pub(super) locals: PrimaryMap<LocalId, Local>,
    /// Expressions.
    pub(super) exprs: PrimaryMap<ExprId, Expr>,
    /// Places.
    pub(super) places: PrimaryMap<PlaceId, Place>,
    pub(super) jumps: JumpTargets,
    /// Integer constants that were truncated by a division, with the first such division.
    pub(super) cut: BTreeMap<ExprId, (i64, i64)>,
    /// Integer constants that are computed as the word of an analog output is.
    pub(super) dac_words: BTreeMap<ExprId, DacWord>,
    /// Undeclared names that were reported in this function.
    pub(super) undeclared: BTreeSet<Name>,
    /// True if it calls `setjmp`, which can return again.
    pub(super) returns_twice: bool,
}

/// The jump targets of a function's statements.
#[derive(Debug, Default)]
pub(super) struct JumpTargets {
    /// Labels.
    pub(super) labels: PrimaryMap<LabelId, Label>,
    /// The labels by name.
    pub(super) label_names: BTreeMap<Name, LabelState>,
    /// Number of open loops.
    pub(super) loops: u32,
    /// The switches that are open, the innermost last.
    pub(super) switches: Vec<super::switches::Switch>,
    /// A `case` outside a `switch` was reported.
    pub(super) has_lost_case: bool,
}

/// The state of a label.
#[derive(Clone, Copy, Debug)]
pub(super) struct LabelState {
    /// The label.
    pub(super) label: LabelId,
    /// The position of its definition, once found.
    pub(super) defined: Option<Span>,
    /// The first `goto`.
    pub(super) used: Option<Span>,
}

impl Body {
    pub(super) fn new(name: String, result: TypeId) -> Self {
        Self {
            name,
            result,
            is_void: result.is_void(),
            hidden: HiddenParameters::default(),
            locals: PrimaryMap::new(),
            exprs: PrimaryMap::new(),
            places: PrimaryMap::new(),
            jumps: JumpTargets::default(),
            cut: BTreeMap::new(),
            dac_words: BTreeMap::new(),
            undeclared: BTreeSet::new(),
            returns_twice: false,
        }
    }

    /// The type of an expression.
    pub(super) fn ty(&self, expr: ExprId) -> TypeId {
        self.exprs[expr].ty
    }

    /// The source range of an expression.
    pub(super) fn span(&self, expr: ExprId) -> Span {
        self.exprs[expr].span
    }

    /// Adds an expression without changes.
    pub(super) fn expr(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        self.exprs.push(Expr { kind, ty, span })
    }

    /// Adds a place without changes.
    pub(super) fn place(&mut self, kind: PlaceKind, ty: TypeId, span: Span) -> PlaceId {
        self.places.push(Place { kind, ty, span })
    }

    /// Adds an integer or pointer constant.
    pub(super) fn int(&mut self, value: i64, ty: TypeId, span: Span) -> ExprId {
        self.expr(ExprKind::Int(constants::truncate_to_type(value, ty)), ty, span)
    }

    /// Adds a constant.
    pub(super) fn constant(&mut self, constant: Constant, ty: TypeId, span: Span) -> ExprId {
        let kind = match constant {
            Constant::Int(value) => ExprKind::Int(value),
            Constant::Float(value) => ExprKind::Float(value),
        };
        self.expr(kind, ty, span)
    }

    /// The value of an expression, if it is constant.
    pub(super) fn as_constant(&self, expr: ExprId) -> Option<Constant> {
        match self.exprs[expr].kind {
            ExprKind::Int(value) => Some(Constant::Int(value)),
            ExprKind::Float(value) => Some(Constant::Float(value)),
            _ => None,
        }
    }

    /// The value of an expression, if it is an integer constant.
    pub(super) fn as_int(&self, expr: ExprId) -> Option<i64> {
        match self.exprs[expr].kind {
            ExprKind::Int(value) => Some(value),
            _ => None,
        }
    }

    /// Keeps all locals in memory: after a second return of `setjmp` they have their last values, whatever the path. A
    /// function with objects in its frame is also not inlined.
    pub(super) fn keep_in_memory(&mut self, span: Span) {
        let hidden = [self.hidden.result_pointer, self.hidden.variable_arguments];
        for (id, local) in &mut self.locals {
            local.in_memory |= !local.by_pointer && !hidden.contains(&Some(id));
        }
        self.temporary(Types::INT, true, span);
    }

    /// Adds a temporary.
    pub(super) fn temporary(&mut self, ty: TypeId, in_memory: bool, span: Span) -> LocalId {
        self.locals.push(Local { name: String::new(), ty, align: 1, in_memory, by_pointer: false, span })
    }

    /// The value of a local of scalar type.
    pub(super) fn load_local(&mut self, local: LocalId, span: Span) -> ExprId {
        let ty = self.locals[local].ty;
        let place = self.place(PlaceKind::Local(local, 0), ty, span);
        self.expr(ExprKind::Load(place), ty, span)
    }

    /// Stores into a local of scalar type.
    pub(super) fn store_local(&mut self, local: LocalId, value: ExprId, span: Span) -> ExprId {
        let ty = self.locals[local].ty;
        let place = self.place(PlaceKind::Local(local, 0), ty, span);
        self.expr(ExprKind::Assign(place, value), ty, span)
    }

    /// `value` as one of type `to`; the value itself if it has the type.
    pub(super) fn convert(&mut self, value: ExprId, to: TypeId, span: Span) -> ExprId {
        let from = self.ty(value);
        if from == to {
            return value;
        }
        if let (Some(constant), false) = (self.as_constant(value), to.is_void()) {
            return self.constant(constants::convert(constant, from, to), to, span);
        }
        if to == Types::BOOL {
            let truth = self.truth_value(value, span);
            return self.expr(ExprKind::Convert(truth), to, span);
        }
        self.expr(ExprKind::Convert(value), to, span)
    }

    /// `value != 0` as `int`.
    pub(super) fn truth_value(&mut self, value: ExprId, span: Span) -> ExprId {
        if let Some(constant) = self.as_constant(value) {
            return self.int(i64::from(constant.is_true()), Types::INT, span);
        }
        if matches!(self.exprs[value].kind, ExprKind::Compare(..) | ExprKind::And(..) | ExprKind::Or(..)) {
            return value;
        }
        let ty = self.ty(value);
        let zero = if ty.is_floating() { Constant::Float(0.0) } else { Constant::Int(0) };
        let zero = self.constant(zero, ty, span);
        self.expr(ExprKind::Compare(CompareOp::NotEqual, value, zero), Types::INT, span)
    }

    /// A unary operator; `!` has type `int`, the others have the type of the operand.
    pub(super) fn unary(&mut self, op: UnaryOp, value: ExprId, span: Span) -> ExprId {
        let operand = self.ty(value);
        let ty = if op == UnaryOp::Not { Types::INT } else { operand };
        let folded = self.as_constant(value).and_then(|constant| constants::unary(op, constant, operand));
        match folded {
            Some(constant) => self.constant(constant, ty, span),
            None => self.expr(ExprKind::Unary(op, value), ty, span),
        }
    }

    /// A binary operator on operands of one type, which is the result's.
    pub(super) fn binary(&mut self, op: BinaryOp, a: ExprId, b: ExprId, span: Span) -> ExprId {
        let ty = self.ty(a);
        let folded =
            self.as_constant(a).zip(self.as_constant(b)).and_then(|(a, b)| constants::binary(op, a, b, ty));
        match folded {
            Some(constant) => {
                let cut = self.division_cut(op, a, b);
                let value = self.constant(constant, ty, span);
                self.cut.extend(cut.map(|cut| (value, cut)));
                let word = self.as_int(a).zip(self.as_int(b));
                let word = word.and_then(|(x, y)| DacWord::after(op, (x, self.dac_words.get(&a)), y));
                self.dac_words.extend(word.map(|word| (value, word)));
                value
            }
            None => self.expr(ExprKind::Binary(op, a, b), ty, span),
        }
    }

    /// The division of two integer constants that cuts a large part off, here or in an operand.
    fn division_cut(&self, op: BinaryOp, a: ExprId, b: ExprId) -> Option<(i64, i64)> {
        let own = match (op, self.as_int(a), self.as_int(b)) {
            // More than a twentieth of the quotient is lost.
            (BinaryOp::Divide, Some(x), Some(y)) if y != 0 => {
                let lost = x.checked_rem(y)?.unsigned_abs();
                (lost.saturating_mul(20) > x.unsigned_abs()).then_some((x, y))
            }
            _ => None,
        };
        own.or_else(|| self.cut.get(&a).or_else(|| self.cut.get(&b)).copied())
    }

    /// A comparison of operands of one type.
    pub(super) fn compare(&mut self, op: CompareOp, a: ExprId, b: ExprId, span: Span) -> ExprId {
        let ty = self.ty(a);
        let folded =
            self.as_constant(a).zip(self.as_constant(b)).and_then(|(a, b)| constants::compare(op, a, b, ty));
        match folded {
            Some(truth) => self.int(i64::from(truth), Types::INT, span),
            None => self.expr(ExprKind::Compare(op, a, b), Types::INT, span),
        }
    }

    /// Reports whether evaluating it twice has the same effect as once.
    pub(super) fn is_repeatable(&self, expr: ExprId) -> bool {
        match self.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) | ExprKind::Address(_) | ExprKind::Load(_) => true,
            ExprKind::Unary(_, inner) | ExprKind::Convert(inner) => self.is_repeatable(inner),
            ExprKind::Binary(_, a, b) => self.is_repeatable(a) && self.is_repeatable(b),
            _ => false,
        }
    }

    /// Reports whether evaluation has no effect and reads nothing.
    fn is_idle(&self, expr: ExprId) -> bool {
        match self.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => true,
            ExprKind::Convert(inner) => self.is_idle(inner),
            _ => false,
        }
    }

    /// Evaluates the first, then the second, and has the value of the second.
    pub(super) fn comma(&mut self, first: ExprId, second: ExprId, span: Span) -> ExprId {
        if self.is_idle(first) {
            return second;
        }
        let ty = self.ty(second);
        self.expr(ExprKind::Comma(first, second), ty, span)
    }
}
