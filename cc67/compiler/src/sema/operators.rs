//! Binary operators, comparisons, `&&`, `||` and `?:`.

use super::Sema;
use super::constants::Constant;
use super::operands::Operand;
use crate::ast::{Expression, ExpressionKind};
use crate::diag::{Diagnostic, Lint};
use crate::lints::{
    assignment_condition, logical_constant, macro_parentheses, overflow, power, precedence, sign_compare,
};
use crate::operators::{BinaryOp, BinaryOperator, OperatorMeaning};
use crate::source::Span;
use crate::ty::{QualifiedType, Type, TypeId, Types, convert};
use crate::typed::{ExprId, ExprKind};

impl Sema<'_> {
    /// A tree of binary operators. A long sum leans to the left; its spine is walked without recursion.
    pub(super) fn binary_expression(&mut self, expression: &Expression) -> Option<ExprId> {
        let mut spine: Vec<(BinaryOperator, &Expression, Span)> = Vec::new();
        let mut leftmost = expression;
        while let ExpressionKind::Binary(operator, left, right) = &leftmost.kind {
            if matches!(operator.meaning(), OperatorMeaning::Bitwise(BinaryOp::Xor)) {
                self.report_finding(power::finding(left, right, leftmost.span));
            }
            self.report_finding(macro_parentheses::finding(self.sources, *operator, left, right));
            if !matches!(spine.last(), Some((BinaryOperator::Add | BinaryOperator::Subtract, ..))) {
                self.report_finding(precedence::mean(leftmost));
            }
            spine.push((*operator, &**right, leftmost.span));
            leftmost = left;
        }
        let mut left = self.value(leftmost);
        for (operator, right, span) in spine.into_iter().rev() {
            let right = self.value(right);
            left = left.zip(right).and_then(|(left, right)| self.binary(operator, left, right, span));
        }
        left
    }

    /// Analyses a binary operator on two scalar values.
    pub(super) fn binary(
        &mut self,
        operator: BinaryOperator,
        a: ExprId,
        b: ExprId,
        span: Span,
    ) -> Option<ExprId> {
        let is_numbers = self.body.ty(a).is_arithmetic() && self.body.ty(b).is_arithmetic();
        match operator.meaning() {
            OperatorMeaning::Arithmetic(op) if is_numbers => {
                let (a, b) = self.usual_conversions(a, b, span);
                self.lint_overflow(op, a, b, span);
                Some(self.body.binary(op, a, b, span))
            }
            OperatorMeaning::Arithmetic(BinaryOp::Add) => self.pointer_add(a, b, span),
            OperatorMeaning::Arithmetic(BinaryOp::Subtract) => self.pointer_subtract(a, b, span),
            OperatorMeaning::Arithmetic(_) => self.refuse_operands(operator, a, b, span),
            OperatorMeaning::Bitwise(op) if self.are_integers(a, b) => {
                let (a, b) = self.usual_conversions(a, b, span);
                Some(self.body.binary(op, a, b, span))
            }
            OperatorMeaning::Shift(op) if self.are_integers(a, b) => {
                let (a, b) = (self.promote(a, span), self.shift_count(b, self.body.ty(a), span));
                Some(self.body.binary(op, a, b, span))
            }
            OperatorMeaning::Bitwise(_) | OperatorMeaning::Shift(_) => {
                self.refuse_operands(operator, a, b, span)
            }
            OperatorMeaning::Compare(op) => {
                let (a, b) = self.comparable(operator, a, b, span)?;
                Some(self.body.compare(op, a, b, span))
            }
            OperatorMeaning::Logical(decides) => Some(self.logical(decides, a, b, span)),
        }
    }

    /// Warns about a result of signed constants that has more than 32 bits.
    fn lint_overflow(&mut self, op: BinaryOp, a: ExprId, b: ExprId, span: Span) {
        let ty = self.body.ty(a);
        if ty == Types::INT
            && let Some((a, b)) = self.body.as_int(a).zip(self.body.as_int(b))
        {
            self.report_finding(overflow::finding(op, a, b, span));
        }
    }

    fn are_integers(&self, a: ExprId, b: ExprId) -> bool {
        self.body.ty(a).is_integer() && self.body.ty(b).is_integer()
    }

    /// A shift count as `int`; warns about a constant outside of the width.
    pub(super) fn shift_count(&mut self, count: ExprId, shifted: TypeId, span: Span) -> ExprId {
        let width = if shifted.is_long_long() { 64 } else { 32 };
        if let Some(value) = self.body.as_int(count).filter(|value| !(0..width).contains(value)) {
            self.report(
                Diagnostic::warning(Lint::ShiftCount, self.body.span(count), format!("a shift by {value}"))
                    .at(format!("meaningful are 0 to {}", width - 1))
                    .note("the processor takes the count modulo 64; from 32 on the result is 0 or the sign"),
            );
        }
        self.body.convert(count, Types::INT, span)
    }

    /// `pointer + integer`, in either order.
    fn pointer_add(&mut self, a: ExprId, b: ExprId, span: Span) -> Option<ExprId> {
        let (pointer, count) = if self.types.is_pointer(self.body.ty(a)) { (a, b) } else { (b, a) };
        let Some(element) =
            self.types.pointee(self.body.ty(pointer)).filter(|_| self.body.ty(count).is_integer())
        else {
            return self.refuse_operands(BinaryOperator::Add, a, b, span);
        };
        let bytes = self.scale_to_bytes(count, element, span)?;
        let moved = self.step(pointer, bytes, span);
        // The address after the last element may be computed.
        self.lint_user_data(pointer, moved, None, span);
        Some(moved)
    }

    /// `pointer - integer`, `pointer - pointer`
    fn pointer_subtract(&mut self, a: ExprId, b: ExprId, span: Span) -> Option<ExprId> {
        let Some(element) = self.types.pointee(self.body.ty(a)) else {
            return self.refuse_operands(BinaryOperator::Subtract, a, b, span);
        };
        if self.body.ty(b).is_integer() {
            let bytes = self.scale_to_bytes(b, element, span)?;
            if self.body.as_int(bytes).is_some() {
                let bytes = self.body.unary(crate::typed::UnaryOp::Negate, bytes, span);
                return Some(self.step(a, bytes, span));
            }
            let ty = self.body.ty(a);
            return Some(self.body.expr(ExprKind::Binary(BinaryOp::Subtract, a, bytes), ty, span));
        }
        if !self.types.is_pointer(self.body.ty(b)) {
            return self.refuse_operands(BinaryOperator::Subtract, a, b, span);
        }
        self.check_pointer_pair(a, b, span);
        let size = self.step_size(element, span)?;
        let (a, b) = (self.body.convert(a, Types::INT, span), self.body.convert(b, Types::INT, span));
        let bytes = self.body.binary(BinaryOp::Subtract, a, b, span);
        if size <= 1 {
            return Some(bytes);
        }
        let size = self.body.int(i64::from(size), Types::INT, span);
        Some(self.body.binary(BinaryOp::Divide, bytes, size, span))
    }

    /// The bytes that a pointer to `element` moves with `+ 1`.
    pub(super) fn step_size(&mut self, element: QualifiedType, span: Span) -> Option<u32> {
        let size = self.types.size_of(element.ty);
        if size.is_none() {
            let message = format!(
                "the size of `{}` is unknown, so pointer arithmetic is not possible",
                self.spell(element.ty)
            );
            self.report(Diagnostic::error(span, message));
        }
        size
    }

    /// A number of elements as an `int` number of bytes.
    pub(super) fn scale_to_bytes(
        &mut self,
        count: ExprId,
        element: QualifiedType,
        span: Span,
    ) -> Option<ExprId> {
        let size = self.step_size(element, span)?;
        let count = self.body.convert(count, Types::INT, span);
        if size == 1 {
            return Some(count);
        }
        let size = self.body.int(i64::from(size), Types::INT, span);
        Some(self.body.binary(BinaryOp::Multiply, count, size, span))
    }

    /// Two operands of a comparison in one type; pointers and integers mix freely, with a warning.
    fn comparable(
        &mut self,
        operator: BinaryOperator,
        a: ExprId,
        b: ExprId,
        span: Span,
    ) -> Option<(ExprId, ExprId)> {
        let (x, y) = (self.body.ty(a), self.body.ty(b));
        if x.is_arithmetic() && y.is_arithmetic() {
            self.lint_signs(a, b, span);
            return Some(self.usual_conversions(a, b, span));
        }
        if x.is_floating() || y.is_floating() {
            self.refuse_operands(operator, a, b, span);
            return None;
        }
        match (self.types.is_pointer(x), self.types.is_pointer(y)) {
            (true, true) => {
                self.check_pointer_pair(a, b, span);
                Some((a, self.cast_pointer(b, x, span)))
            }
            (true, false) => {
                self.lint_int_pointer_pair(b, span);
                Some((a, self.body.convert(b, x, span)))
            }
            (false, _) => {
                self.lint_int_pointer_pair(a, span);
                Some((self.body.convert(a, y, span), b))
            }
        }
    }

    /// Warns about a comparison of a signed and an unsigned value, unless the signed one is a constant that is not
    /// negative.
    fn lint_signs(&mut self, a: ExprId, b: ExprId, span: Span) {
        let promoted = |value| convert::promoted(self.body.ty(value));
        let (x, y) = (promoted(a), promoted(b));
        let is_mixed = x.is_integer() && y.is_integer() && x.is_unsigned() != y.is_unsigned();
        let signed = if x.is_unsigned() { b } else { a };
        if is_mixed && self.body.as_int(signed).is_none_or(|value| value < 0) {
            self.report(sign_compare::finding(span));
        }
    }

    fn lint_int_pointer_pair(&mut self, integer: ExprId, span: Span) {
        if !self.is_null(integer) {
            let message = "a pointer is mixed with an integer without a cast";
            let at = format!("this is `{}`", self.spell(self.body.ty(integer)));
            let place = self.body.span(integer);
            self.report(Diagnostic::warning(Lint::IntPointer, span, message).label(place, at));
        }
    }

    /// `a && b` (`decides` is false) or `a || b` (true); a constant side is folded where that drops no effect.
    fn logical(&mut self, decides: bool, a: ExprId, b: ExprId, span: Span) -> ExprId {
        let finding = [a, b].into_iter().find_map(|side| {
            let number = self.body.as_int(side).filter(|_| self.body.ty(side).is_integer())?;
            logical_constant::finding(decides, number, self.body.span(side))
        });
        self.report_finding(finding);
        match (
            self.body.as_constant(a).map(Constant::is_true),
            self.body.as_constant(b).map(Constant::is_true),
        ) {
            (Some(left), _) if left == decides => self.body.int(i64::from(decides), Types::INT, span),
            (Some(_), _) => self.body.truth_value(b, span),
            (None, Some(right)) if right != decides => self.body.truth_value(a, span),
            _ => {
                let kind = if decides { ExprKind::Or(a, b) } else { ExprKind::And(a, b) };
                self.body.expr(kind, Types::INT, span)
            }
        }
    }

    fn refuse_operands(
        &mut self,
        operator: BinaryOperator,
        a: ExprId,
        b: ExprId,
        span: Span,
    ) -> Option<ExprId> {
        let (left, right) = (self.spell(self.body.ty(a)), self.spell(self.body.ty(b)));
        let operator = operator.spelling();
        let message = format!("`{operator}` cannot be used on `{left}` and `{right}`");
        let mut diagnostic = Diagnostic::error(span, message)
            .label(self.body.span(a), format!("`{left}`"))
            .label(self.body.span(b), format!("`{right}`"));
        let (a, b) = (self.body.ty(a), self.body.ty(b));
        if self.types.is_pointer(a) || self.types.is_pointer(b) {
            let is_text =
                [a, b].iter().any(|ty| self.types.pointee(*ty).is_some_and(|to| to.ty.is_character()));
            let is_function = |ty: &TypeId| {
                let pointee = self.types.pointee(*ty);
                pointee.is_some_and(|to| matches!(self.types.get(to.ty), Type::Function(_)))
            };
            if is_text && operator == "+" {
                diagnostic = diagnostic
                    .help("strings cannot be added; `printf(\"%f\\n\", value)` puts numbers in text");
            } else if [a, b].iter().any(is_function) {
                diagnostic = diagnostic.help("this is the function itself: call it with `()` after its name");
            }
        } else if a.is_floating() || b.is_floating() {
            diagnostic = diagnostic.note("floating-point values support only `+ - * /` and comparisons");
            diagnostic = diagnostic.help(match operator {
                "^" => "`^` is not a power: write `x * x`, or `pow(x, y)`",
                _ => "convert the value first: `(int)(…)`",
            });
        }
        self.report(diagnostic);
        None
    }

    /// `condition ? then : otherwise`, `condition ?: otherwise`
    pub(super) fn conditional(
        &mut self,
        condition: &Expression,
        then: Option<&Expression>,
        otherwise: &Expression,
        span: Span,
    ) -> Option<Operand> {
        let Some(then) = then else { return self.elvis(condition, otherwise, span) };
        self.report_finding(assignment_condition::finding(condition));
        let test = self.value(condition);
        let (then_operand, otherwise_operand) = (self.operand(then), self.operand(otherwise));
        let (test, a, b) = (test?, then_operand?, otherwise_operand?);
        if self.is_record(a) || self.is_record(b) {
            return self.choose_record(test, (a, then.span), (b, otherwise.span), span);
        }
        if self.operand_type(a).ty.is_void() || self.operand_type(b).ty.is_void() {
            let (a, b) = (self.evaluate_effect(a, then.span), self.evaluate_effect(b, otherwise.span));
            let (a, b) = (self.discard_value(a, span), self.discard_value(b, span));
            return Some(Operand::Value(self.body.expr(
                ExprKind::Conditional(test, a, b),
                Types::VOID,
                span,
            )));
        }
        let (a, b) = (self.read(a, then.span)?, self.read(b, otherwise.span)?);
        let (a, b) = self.common_branches(a, b, span)?;
        Some(Operand::Value(self.choose(test, a, b, span)))
    }

    /// `a ?: b`: the value of `a` is kept in a temporary.
    fn elvis(&mut self, condition: &Expression, otherwise: &Expression, span: Span) -> Option<Operand> {
        let (value, otherwise) = (self.value(condition), self.value(otherwise));
        let (value, otherwise) = (value?, otherwise?);
        let ty = self.body.ty(value);
        let kept = self.body.temporary(ty, false, span);
        let store = self.body.store_local(kept, value, span);
        let (test, then) = (self.body.load_local(kept, span), self.body.load_local(kept, span));
        let (then, otherwise) = self.common_branches(then, otherwise, span)?;
        let choice = self.choose(test, then, otherwise, span);
        Some(Operand::Value(self.body.comma(store, choice, span)))
    }

    fn choose(&mut self, test: ExprId, a: ExprId, b: ExprId, span: Span) -> ExprId {
        if let Some(test) = self.body.as_constant(test) {
            return if test.is_true() { a } else { b };
        }
        let ty = self.body.ty(a);
        self.body.expr(ExprKind::Conditional(test, a, b), ty, span)
    }

    /// Converts both branches to one type.
    fn common_branches(&mut self, a: ExprId, b: ExprId, span: Span) -> Option<(ExprId, ExprId)> {
        let (x, y) = (self.body.ty(a), self.body.ty(b));
        if x.is_arithmetic() && y.is_arithmetic() {
            return Some(self.usual_conversions(a, b, span));
        }
        match (self.types.pointee(x), self.types.pointee(y)) {
            (Some(from), Some(to)) => {
                self.check_pointer_pair(a, b, span);
                let void = QualifiedType::plain(Types::VOID);
                let ty = if from == void && self.is_null(a) {
                    y
                } else if to == void && self.is_null(b) {
                    x
                } else {
                    self.common_pointer(from, to)
                };
                Some((self.cast_pointer(a, ty, span), self.cast_pointer(b, ty, span)))
            }
            (Some(_), None) if y.is_integer() => {
                self.lint_int_pointer_pair(b, span);
                Some((a, self.body.convert(b, x, span)))
            }
            (None, Some(_)) if x.is_integer() => {
                self.lint_int_pointer_pair(a, span);
                Some((self.body.convert(a, y, span), b))
            }
            _ => {
                let (left, right) = (self.spell(x), self.spell(y));
                let message = format!("the branches of `?:` have incompatible types: `{left}` and `{right}`");
                self.report(Diagnostic::error(span, message));
                None
            }
        }
    }

    /// The type of a pointer that may point to either operand's target (C11 6.5.15): with the qualifiers of both;
    /// `void` absorbs all.
    fn common_pointer(&mut self, a: QualifiedType, b: QualifiedType) -> TypeId {
        let ty = if a.ty.is_void() || b.ty.is_void() {
            Types::VOID
        } else if self.types.compatible(a.ty, b.ty) {
            self.types.composite(a.ty, b.ty)
        } else {
            a.ty
        };
        let is_const = a.is_const || b.is_const;
        let is_volatile = a.is_volatile || b.is_volatile;
        self.types.pointer_to_qualified(QualifiedType { ty, is_const, is_volatile })
    }

    /// A choice between two structures is one between their addresses.
    fn choose_record(
        &mut self,
        test: ExprId,
        (a, a_span): (Operand, Span),
        (b, b_span): (Operand, Span),
        span: Span,
    ) -> Option<Operand> {
        let (Operand::Place(x), Operand::Place(y)) = (a, b) else {
            return self.refuse_branches(a, b, span);
        };
        if x.ty.ty != y.ty.ty {
            return self.refuse_branches(a, b, span);
        }
        let pointer = self.types.pointer_to(x.ty.ty);
        let (a, b) = (self.address(x.place, pointer, a_span), self.address(y.place, pointer, b_span));
        let chosen = self.choose(test, a, b, span);
        let mut located = self.pointee_place(chosen, QualifiedType::plain(x.ty.ty), span);
        located.is_lvalue = false;
        Some(Operand::Place(located))
    }

    fn refuse_branches(&mut self, a: Operand, b: Operand, span: Span) -> Option<Operand> {
        let (left, right) = (self.spell(self.operand_type(a).ty), self.spell(self.operand_type(b).ty));
        let message = format!("the branches of `?:` have incompatible types: `{left}` and `{right}`");
        self.report(Diagnostic::error(span, message));
        None
    }
}
