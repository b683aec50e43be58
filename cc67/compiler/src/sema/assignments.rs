//! Assignments: `=`, `op=`, `++`, `--`.

use super::Sema;
use super::constants::Constant;
use super::conversions::AssignmentTarget;
use super::operands::Operand;
use super::places::TypedPlace;
use crate::ast::{Expression, ExpressionKind};
use crate::diag::{Diagnostic, Lint};
use crate::lints::{reversed_operator, value_range};
use crate::operators::{BinaryOp, BinaryOperator, OperatorMeaning};
use crate::source::Span;
use crate::ty::{TypeId, Types, convert};
use crate::typed::{ExprId, ExprKind, PlaceId, PlaceKind, Update, UpdateResult};

impl Sema<'_> {
    /// `to = from`
    pub(super) fn assignment(&mut self, to: &Expression, from: &Expression, span: Span) -> Option<Operand> {
        self.report_finding(reversed_operator::finding(self.sources, from));
        let target = self.operand(to);
        let source = self.operand(from);
        let target = self.modifiable_place(target?, to.span);
        let (target, source) = (target?, source?);
        if self.types.record_of(target.ty.ty).is_some() {
            return self.assign_record(target, source, from.span, span);
        }
        let value = self.read(source, from.span)?;
        if let Some(word) = self.body.dac_words.remove(&value)
            && self.is_symbol(target.place, value_range::DAC_WORDS)
        {
            self.report_finding(word.finding(span));
        }
        let value =
            self.convert_as_assignment(value, target.ty.ty, AssignmentTarget::Assignment, from.span)?;
        Some(Operand::Value(self.body.expr(ExprKind::Assign(target.place, value), target.ty.ty, span)))
    }

    /// Reports whether a place is a variable of this name, or a part of it.
    fn is_symbol(&self, place: PlaceId, name: &str) -> bool {
        match self.body.places[place].kind {
            PlaceKind::Symbol(symbol, _) => self.symbols.get(symbol).name == name,
            PlaceKind::Pointer(pointer, _) => match self.body.exprs[pointer].kind {
                ExprKind::Address(place) => self.is_symbol(place, name),
                ExprKind::Binary(BinaryOp::Add, base, _) => match self.body.exprs[base].kind {
                    ExprKind::Address(place) => self.is_symbol(place, name),
                    _ => false,
                },
                _ => false,
            },
            PlaceKind::Local(..) | PlaceKind::Bits(..) => false,
        }
    }

    /// Reports `if (f() = 1)`, which cannot be intended.
    pub(super) fn refuse_assigned_call(&mut self, condition: &Expression) -> bool {
        let ExpressionKind::Assign(to, _) = &condition.kind else { return false };
        let is_call = matches!(to.kind, ExpressionKind::Call(..));
        if is_call {
            self.report(
                Diagnostic::error(to.span, "the result of a function cannot be assigned to")
                    .help("write `==` to compare"),
            );
        }
        is_call
    }

    /// The place that an assignment changes.
    fn modifiable_place(&mut self, operand: Operand, span: Span) -> Option<TypedPlace> {
        let Operand::Place(located) = operand else {
            let what = match operand {
                Operand::Function(..) => "a function",
                _ => "a value",
            };
            self.report(
                Diagnostic::error(span, format!("{what} cannot be assigned to"))
                    .at("a variable is needed here"),
            );
            return None;
        };
        if !located.is_lvalue || self.types.array(located.ty.ty).is_some() {
            let spelled = self.spell(located.ty.ty);
            let diagnostic = match self.types.array(located.ty.ty).filter(|_| located.is_lvalue) {
                Some((element, _)) => {
                    let is_text = element.ty.is_character();
                    Diagnostic::error(span, "a whole array cannot be assigned to")
                        .at(format!("this is `{spelled}`"))
                        .help(if is_text {
                            "`sprintf(array, \"%s\", text)` copies text"
                        } else {
                            "assign its elements one by one"
                        })
                }
                None => Diagnostic::error(span, format!("`{spelled}` cannot be assigned to here")),
            };
            self.report(diagnostic);
            return None;
        }
        if located.ty.is_const {
            self.report(
                Diagnostic::warning(Lint::ConstWrite, span, "a `const` object is modified")
                    .at("declared `const`")
                    .note("the vendor's compiler ignores `const`, and so does this one"),
            );
        }
        Some(located)
    }

    fn assign_record(
        &mut self,
        target: TypedPlace,
        source: Operand,
        source_span: Span,
        span: Span,
    ) -> Option<Operand> {
        let ty = target.ty.ty;
        let from = self.record_source(source, ty, AssignmentTarget::Assignment, source_span)?;
        if matches!(self.body.places[target.place].kind, PlaceKind::Local(..) | PlaceKind::Symbol(..)) {
            let copy = self.body.expr(ExprKind::Copy { to: target.place, from }, Types::VOID, span);
            return Some(self.structure_result(copy, target.place, span));
        }
        // The address of the target is computed once, also if the value is used.
        let pointer_type = self.types.pointer_to(ty);
        let address = self.address(target.place, pointer_type, span);
        let kept = self.body.temporary(pointer_type, false, span);
        let store = self.body.store_local(kept, address, span);
        let pointer = self.body.load_local(kept, span);
        let to = self.body.place(PlaceKind::Pointer(pointer, 0), ty, span);
        let copy = self.body.expr(ExprKind::Copy { to, from }, Types::VOID, span);
        let effect = self.body.comma(store, copy, span);
        let pointer = self.body.load_local(kept, span);
        let value = self.body.place(PlaceKind::Pointer(pointer, 0), ty, span);
        Some(self.structure_result(effect, value, span))
    }

    /// `to op= from`
    pub(super) fn compound_assignment(
        &mut self,
        operator: BinaryOperator,
        to: &Expression,
        from: &Expression,
        span: Span,
    ) -> Option<ExprId> {
        let target = self.operand(to);
        let value = self.value(from);
        let target = self.modifiable_place(target?, to.span)?;
        self.update(operator, target, value?, UpdateResult::New, span)
    }

    /// `++a`, `a--`
    pub(super) fn increment(
        &mut self,
        operand: &Expression,
        is_increment: bool,
        is_prefix: bool,
        span: Span,
    ) -> Option<ExprId> {
        let target = self.operand(operand)?;
        let target = self.modifiable_place(target, operand.span)?;
        let operator = if is_increment { BinaryOperator::Add } else { BinaryOperator::Subtract };
        let one = self.body.int(1, Types::INT, span);
        let result = if is_prefix { UpdateResult::New } else { UpdateResult::Old };
        self.update(operator, target, one, result, span)
    }

    fn update(
        &mut self,
        operator: BinaryOperator,
        target: TypedPlace,
        value: ExprId,
        result: UpdateResult,
        span: Span,
    ) -> Option<ExprId> {
        let (op, ty) = (update_op(operator)?, target.ty.ty);
        let from = self.body.ty(value);
        let (computed, operand) = if let Some(element) = self.types.pointee(ty) {
            if !from.is_integer() || !matches!(op, BinaryOp::Add | BinaryOp::Subtract) {
                return self.refuse_update(operator, ty, from, span);
            }
            (ty, self.scale_to_bytes(value, element, span)?)
        } else {
            let is_integers = ty.is_integer() && from.is_integer();
            let is_arithmetic = ty.is_arithmetic() && from.is_arithmetic();
            match operator.meaning() {
                OperatorMeaning::Shift(_) if is_integers => {
                    (convert::promoted(ty), self.shift_count(value, ty, span))
                }
                OperatorMeaning::Arithmetic(_) if is_arithmetic => self.in_common_type(ty, value, span),
                OperatorMeaning::Bitwise(_) if is_integers => self.in_common_type(ty, value, span),
                OperatorMeaning::Arithmetic(_)
                | OperatorMeaning::Bitwise(_)
                | OperatorMeaning::Shift(_)
                | OperatorMeaning::Compare(_)
                | OperatorMeaning::Logical(_) => return self.refuse_update(operator, ty, from, span),
            }
        };
        let update = Update { place: target.place, op, operand, computed, result };
        Some(self.body.expr(ExprKind::Update(update), ty, span))
    }

    fn in_common_type(&mut self, ty: TypeId, value: ExprId, span: Span) -> (TypeId, ExprId) {
        let value = self.promote(value, span);
        let computed = convert::common(ty, self.body.ty(value));
        (computed, self.body.convert(value, computed, span))
    }

    fn refuse_update(
        &mut self,
        operator: BinaryOperator,
        to: TypeId,
        from: TypeId,
        span: Span,
    ) -> Option<ExprId> {
        let (to, from) = (self.spell(to), self.spell(from));
        let message = format!("`{}=` cannot be used on `{to}` and `{from}`", operator.spelling());
        self.report(Diagnostic::error(span, message));
        None
    }

    /// The zero of a scalar type.
    pub(super) fn zero_value(&mut self, ty: TypeId, span: Span) -> ExprId {
        let zero = if ty.is_floating() { Constant::Float(0.0) } else { Constant::Int(0) };
        self.body.constant(zero, ty, span)
    }
}

/// The operator of a compound assignment; `None` for operators without one.
const fn update_op(operator: BinaryOperator) -> Option<BinaryOp> {
    match operator.meaning() {
        OperatorMeaning::Arithmetic(op) | OperatorMeaning::Bitwise(op) | OperatorMeaning::Shift(op) => {
            Some(op)
        }
        OperatorMeaning::Compare(_) | OperatorMeaning::Logical(_) => None,
    }
}
