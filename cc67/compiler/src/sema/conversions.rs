//! Implicit conversions, and warnings about doubtful ones.
//!
//! The table of pairs that are silent, warned about or refused: `dialect.md` 2.4.

use super::Sema;
use super::constants::Constant;
use crate::diag::{Diagnostic, Lint};
use crate::lints::{constant_conversion, conversion, missing_address, user_data_alignment, user_data_index};
use crate::source::Span;
use crate::ty::{FunctionType, ParameterTypes, QualifiedType, TypeId, Types, convert};
use crate::typed::{ExprId, ExprKind, PlaceKind, SymbolId};

/// The destination of a value, for messages.
#[derive(Clone, Copy, Debug)]
pub(super) enum AssignmentTarget {
    /// `a = b`
    Assignment,
    /// `int a = b;`
    Initializer,
    /// `return b;`
    Return,
    /// `f(b)`: the number of the argument, counted from 1, and the function.
    Argument(usize, Option<SymbolId>),
}

/// The result of comparing two pointer types without a cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Agreement {
    Silent,
    Warn,
    Refuse,
}

impl Sema<'_> {
    /// An integer operand in its promoted type. A bit-field becomes `int` or `unsigned`, the first that holds all its
    /// values; one too wide for both keeps its declared type.
    pub(super) fn promote(&mut self, value: ExprId, span: Span) -> ExprId {
        let ty = self.body.ty(value);
        let to = match self.field_width(value) {
            Some(32) if ty.is_unsigned() => Types::UNSIGNED,
            Some(..=32) => Types::INT,
            _ => convert::promoted(ty),
        };
        self.body.convert(value, to, span)
    }

    /// Reports whether a value is read from a bit-field that promotion takes to another type than the declared one.
    pub(super) fn is_narrow_field(&self, value: ExprId) -> bool {
        let bits = if self.body.ty(value).is_long_long() { 64 } else { 32 };
        self.field_width(value).is_some_and(|width| width < bits)
    }

    /// The width of the bit-field from which a value is read.
    fn field_width(&self, value: ExprId) -> Option<u8> {
        let ExprKind::Load(place) = self.body.exprs[value].kind else { return None };
        match self.body.places[place].kind {
            PlaceKind::Bits(_, bits) => Some(bits.width),
            _ => None,
        }
    }

    /// Two arithmetic operands in their common type.
    pub(super) fn usual_conversions(&mut self, a: ExprId, b: ExprId, span: Span) -> (ExprId, ExprId) {
        let (a, b) = (self.promote(a, span), self.promote(b, span));
        let common = convert::common(self.body.ty(a), self.body.ty(b));
        self.lint_division(a, common);
        self.lint_division(b, common);
        (self.body.convert(a, common, span), self.body.convert(b, common, span))
    }

    /// Reports whether a value is the null pointer constant.
    pub(super) fn is_null(&self, value: ExprId) -> bool {
        let ty = self.body.ty(value);
        let is_void_pointer = self.types.pointee(ty).is_some_and(|to| to.ty.is_void());
        (ty.is_integer() || is_void_pointer) && self.body.as_int(value) == Some(0)
    }

    /// Converts a value as by an assignment to the destination's type.
    pub(super) fn convert_as_assignment(
        &mut self,
        value: ExprId,
        to: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) -> Option<ExprId> {
        let from = self.body.ty(value);
        if from == to || (from.is_arithmetic() && to.is_arithmetic()) {
            self.lint_narrowing(value, to, span);
            self.lint_division(value, to);
            return Some(self.body.convert(value, to, span));
        }
        match (self.types.is_pointer(from), self.types.is_pointer(to)) {
            (true, true) => self.assigned_pointer(value, to, target, span)?,
            (false, true) if from.is_integer() => {
                if self.is_pointee(value, to, target) {
                    self.report(missing_address::finding(self.sources, &self.describe(target), span));
                } else if !self.is_null(value) {
                    let message = "a pointer from an integer without a cast";
                    self.warn_conversion(Lint::IntPointer, message, value, to, target, span);
                }
            }
            (true, false) if to == Types::BOOL => {}
            (true, false) if to.is_integer() => {
                let message = "an integer from a pointer without a cast";
                self.warn_conversion(Lint::IntPointer, message, value, to, target, span);
            }
            _ if self.is_pointee(value, to, target) => {
                let refusal = self.conversion_error(from, to, target, span);
                self.report(refusal.help(missing_address::help(self.sources, span)));
                return None;
            }
            _ => {
                self.refuse_conversion(from, to, target, span);
                return None;
            }
        }
        Some(self.convert_unchecked(value, to, span))
    }

    /// Reports whether a variable is passed for a parameter that points to its type.
    fn is_pointee(&self, value: ExprId, to: TypeId, target: AssignmentTarget) -> bool {
        matches!(target, AssignmentTarget::Argument(..))
            && matches!(self.body.exprs[value].kind, ExprKind::Load(_))
            && self.types.pointee(to).is_some_and(|to| to.ty == self.body.ty(value))
    }

    /// Warns about a number that may not fit its destination; constants are known.
    fn lint_narrowing(&mut self, value: ExprId, to: TypeId, span: Span) {
        let from = self.body.ty(value);
        let Some(loss) = conversion::loss(&self.types, from, to) else { return };
        match self.body.as_constant(value) {
            None => self.report(conversion::finding(&self.spell(from), &self.spell(to), loss, span)),
            // The truncation of a computed value, such as `0.5 / TIMEBASE`, is intended.
            Some(Constant::Float(number))
                if to.is_integer() && number.fract() != 0.0 && self.is_written(value, number) =>
            {
                self.report(conversion::lost_fraction(number, &self.spell(to), span));
            }
            Some(Constant::Int(number)) if to.is_integer() => {
                let bytes = self.types.size_of(to).unwrap_or(u32::MAX);
                let name = self.spell(to);
                self.report_finding(constant_conversion::finding(
                    number,
                    &name,
                    bytes,
                    to.is_unsigned(),
                    span,
                ));
            }
            Some(_) => {}
        }
    }

    /// Reports whether a constant is in the source as a number.
    fn is_written(&self, value: ExprId, number: f64) -> bool {
        let text = String::from_utf8_lossy(self.sources.text(self.body.span(value))).into_owned();
        text.trim_end_matches(['f', 'F']).parse() == Ok(number.abs())
    }

    /// Warns about a quotient of integer constants that lost its fraction before it became a floating-point number.
    fn lint_division(&mut self, value: ExprId, to: TypeId) {
        if to.is_floating()
            && let Some((dividend, divisor)) = self.body.cut.remove(&value)
        {
            let span = self.body.span(value);
            self.report(conversion::division(dividend, divisor, span));
        }
    }

    /// Converts a value to another type, including pointers; the caller has checked that this is valid.
    pub(super) fn convert_unchecked(&mut self, value: ExprId, to: TypeId, span: Span) -> ExprId {
        self.lint_misaligned(value, to, span);
        if self.types.is_pointer(to) && self.types.is_pointer(self.body.ty(value)) {
            return self.cast_pointer(value, to, span);
        }
        self.body.convert(value, to, span)
    }

    fn assigned_pointer(
        &mut self,
        value: ExprId,
        to: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) -> Option<()> {
        let from = self.body.ty(value);
        let (Some(source), Some(aim)) = (self.types.pointee(from), self.types.pointee(to)) else {
            return Some(());
        };
        match self.agreement(source, aim) {
            Agreement::Silent => {}
            Agreement::Warn if self.is_persist_address(value) || self.is_null(value) => {}
            Agreement::Warn => {
                let message = "a pointer to another type without a cast";
                self.warn_conversion(Lint::PointerMismatch, message, value, to, target, span);
            }
            Agreement::Refuse => {
                self.refuse_conversion(from, to, target, span);
                return None;
            }
        }
        Some(())
    }

    /// Compares two pointer types; the table is `dialect.md` 2.4.
    fn agreement(&self, a: QualifiedType, b: QualifiedType) -> Agreement {
        let (a, b) = (a.ty, b.ty);
        if a.is_void() || b.is_void() || self.types.compatible(a, b) {
            return Agreement::Silent;
        }
        if let (Some(a), Some(b)) = (self.types.function(a), self.types.function(b)) {
            return self.function_agreement(a, b);
        }
        if self.types.record_of(a).is_some() || self.types.record_of(b).is_some() {
            // The bytes of a structure may be accessed through a `char *`, although this is seldom intended.
            let is_bytes = a.is_character() || b.is_character();
            return if is_bytes { Agreement::Warn } else { Agreement::Refuse };
        }
        let is_one_size = self.types.size_of(a) == self.types.size_of(b);
        let is_integers = a.is_integer() && b.is_integer();
        let is_bytes = (a.is_character() && b.is_arithmetic()) || (b.is_character() && a.is_arithmetic());
        if is_bytes || (is_integers && is_one_size) { Agreement::Silent } else { Agreement::Warn }
    }

    /// Judges two function types: different parameters are refused, as the calls would not match; `int` and `void`
    /// results may differ.
    fn function_agreement(&self, a: &FunctionType, b: &FunctionType) -> Agreement {
        let is_empty = |parameters: &ParameterTypes| match parameters {
            ParameterTypes::Unspecified => true,
            ParameterTypes::Prototype { types, is_variadic } => types.is_empty() && !is_variadic,
        };
        let is_alike = match (is_empty(&a.parameters), is_empty(&b.parameters)) {
            (true, true) => true,
            (false, false) => self.types.compatible_parameters(a, b),
            _ => false,
        };
        let is_plain = |result: TypeId| result.is_void() || result.is_integer();
        match (is_alike, self.types.compatible(a.result, b.result)) {
            (false, _) => Agreement::Refuse,
            (true, true) => Agreement::Silent,
            (true, false) if is_plain(a.result) && is_plain(b.result) => Agreement::Silent,
            (true, false) => Agreement::Warn,
        }
    }

    /// Warns if two pointers that are compared, subtracted or chosen between do not agree.
    pub(super) fn check_pointer_pair(&mut self, a: ExprId, b: ExprId, span: Span) {
        let (from, to) = (self.body.ty(a), self.body.ty(b));
        let (Some(x), Some(y)) = (self.types.pointee(from), self.types.pointee(to)) else { return };
        if self.is_null(a) || self.is_null(b) || self.agreement(x, y) == Agreement::Silent {
            return;
        }
        let message =
            format!("pointers to different types are mixed: `{}` and `{}`", self.spell(from), self.spell(to));
        self.report(Diagnostic::warning(Lint::PointerMismatch, span, message));
    }

    /// Reports whether a value is `&persist.UserData[k]`, which may be used as a pointer to any number, as programs do.
    fn is_persist_address(&self, value: ExprId) -> bool {
        self.persist_offset(value).is_some()
    }

    /// The byte offset of an address inside the firmware's `persist`.
    fn persist_offset(&self, value: ExprId) -> Option<i32> {
        let ExprKind::Address(place) = self.body.exprs[value].kind else { return None };
        let PlaceKind::Symbol(symbol, offset) = self.body.places[place].kind else { return None };
        (Some(symbol) == self.symbols.linked_symbol(self.persist)).then_some(offset)
    }

    /// Warns about `(double *)&persist.UserData[1]`: the board loads a double without the low address bits.
    fn lint_misaligned(&mut self, value: ExprId, to: TypeId, span: Span) {
        if self.types.pointee(to).is_none_or(|to| to.ty != Types::DOUBLE) {
            return;
        }
        let offset = self.persist_offset(value);
        self.report_finding(offset.and_then(|offset| user_data_alignment::finding(offset, span)));
    }

    /// Warns about a step from inside `persist.UserData` to an object that is not: `size` bytes, or only an address.
    pub(super) fn lint_user_data(&mut self, from: ExprId, to: ExprId, size: Option<u32>, span: Span) {
        let (Some(from), Some(to)) = (self.persist_offset(from), self.persist_offset(to)) else { return };
        let finding = match size {
            Some(size) => user_data_index::finding(from, to, size, span),
            None => user_data_index::finding(from, to - i32::from(to == user_data_index::range().1), 1, span),
        };
        self.report_finding(finding);
    }

    /// Warns about a use of the memory directly after `persist.UserData`; its address alone is fine.
    pub(super) fn lint_user_data_end(&mut self, pointer: ExprId, span: Span) {
        let end = user_data_index::range().1;
        if self.persist_offset(pointer) == Some(end) {
            self.report_finding(user_data_index::finding(end - 1, end, 1, span));
        }
    }

    fn describe(&self, target: AssignmentTarget) -> String {
        match target {
            AssignmentTarget::Assignment => "assignment".to_owned(),
            AssignmentTarget::Initializer => "initialiser".to_owned(),
            AssignmentTarget::Return => "`return`".to_owned(),
            AssignmentTarget::Argument(number, Some(function)) => {
                format!("argument {number} of `{}`", self.symbols.get(function).name)
            }
            AssignmentTarget::Argument(number, None) => format!("argument {number}"),
        }
    }

    fn warn_conversion(
        &mut self,
        lint: Lint,
        message: &str,
        value: ExprId,
        to: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) {
        let help = self.quotes_help(to, span);
        let (from, to) = (self.spell(self.body.ty(value)), self.spell(to));
        self.report(
            Diagnostic::warning(lint, span, format!("{} makes {message}", self.describe(target)))
                .at(format!("this is `{from}`, needed is `{to}`"))
                .help(help.unwrap_or_else(|| format!("write `({to})` if this is meant"))),
        );
    }

    /// The help for `'a'` where text is needed.
    fn quotes_help(&self, to: TypeId, span: Span) -> Option<String> {
        let text = String::from_utf8_lossy(self.sources.text(span)).into_owned();
        let inner = text.strip_prefix('\'')?.strip_suffix('\'')?;
        let is_text = self.types.pointee(to).is_some_and(|ty| self.types.size_of(ty.ty) == Some(1));
        is_text.then(|| format!("text has double quotes: `\"{inner}\"`"))
    }

    pub(super) fn refuse_conversion(
        &mut self,
        from: TypeId,
        to: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) {
        let refusal = self.conversion_error(from, to, target, span);
        self.report(refusal);
    }

    fn conversion_error(&self, from: TypeId, to: TypeId, target: AssignmentTarget, span: Span) -> Diagnostic {
        let help = self.conversion_help(from, to, target, span);
        let (from, to) = (self.spell(from), self.spell(to));
        let diagnostic =
            Diagnostic::error(span, format!("{}: cannot convert `{from}` to `{to}`", self.describe(target)))
                .at(format!("this is `{from}`, needed is `{to}`"));
        match help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    }

    /// The probable mistake when a pointer and a number meet.
    fn conversion_help(
        &self,
        from: TypeId,
        to: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) -> Option<&'static str> {
        let text = self.sources.text(span);
        if to.is_arithmetic() && text.starts_with(b"\"") {
            return Some("a number has no quotes");
        }
        if to.is_arithmetic() && text.starts_with(b"&") {
            return Some("remove the `&`: it gives the address, not the value");
        }
        let is_number = |ty: Option<QualifiedType>| ty.is_some_and(|ty| ty.ty.is_arithmetic());
        if to.is_arithmetic() && is_number(self.types.pointee(from)) {
            return Some("write `*` before it for the value it points to");
        }
        let is_text = |ty: QualifiedType| ty.is_const && self.types.size_of(ty.ty) == Some(1);
        if from.is_arithmetic() && self.types.pointee(to).is_some_and(is_text) {
            return Some("text in double quotes is needed here, such as `\"%g\\n\"` for `printf`");
        }
        if from.is_arithmetic() && is_number(self.types.pointee(to)) {
            return Some(match target {
                AssignmentTarget::Argument(..) => {
                    "write `&` before the name of a variable to pass its address"
                }
                _ => "write `*` before the pointer to store in what it points to",
            });
        }
        None
    }
}
