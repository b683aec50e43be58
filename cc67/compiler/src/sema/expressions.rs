//! Expressions: the dispatcher, and the forms without a separate file.

use super::Sema;
use super::conversions::AssignmentTarget;
use super::literals::character_type;
use super::operands::Operand;
use super::places::TypedPlace;
use super::scope::Entity;
use super::undeclared::is_sensible;
use crate::ast::{Expression, ExpressionKind, TypeName, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::lints::{octal, sizeof_pointer};
use crate::names::Name;
use crate::source::Span;
use crate::ty::{QualifiedType, RecordId, TypeId, Types};
use crate::typed::{Callee, ExprId, ExprKind, PlaceKind, UnaryOp};
use crate::words::suggest;

impl Sema<'_> {
    /// Analyses an expression; `None` if it has an error.
    pub(super) fn operand(&mut self, expression: &Expression) -> Option<Operand> {
        let span = expression.span;
        match &expression.kind {
            ExpressionKind::Identifier(name) => self.identifier(*name, span),
            ExpressionKind::Integer(literal) => {
                self.report_finding(octal::finding(self.sources, *literal, span));
                Some(self.integer_literal(*literal, span))
            }
            ExpressionKind::Floating(literal) => Some(self.floating_literal(*literal, span)),
            ExpressionKind::Character(value, encoding) => {
                let ty = character_type(*encoding);
                Some(Operand::Value(self.body.int(i64::from(*value), ty, span)))
            }
            ExpressionKind::String(literal) => Some(self.string_literal(literal, span)),
            ExpressionKind::FunctionName => Some(self.function_name(span)),
            ExpressionKind::Index(base, index) => self.index(base, index, span),
            ExpressionKind::Call(callee, arguments) => self.call(callee, arguments, span),
            ExpressionKind::Member { base, arrow, member, member_span } => {
                self.member_access(base, *arrow, *member, *member_span, span)
            }
            ExpressionKind::Unary(operator, operand) => self.unary_expression(*operator, operand, span),
            ExpressionKind::Increment { operand, is_increment, is_prefix } => {
                self.increment(operand, *is_increment, *is_prefix, span).map(Operand::Value)
            }
            ExpressionKind::Cast(name, operand) => self.cast(name, operand, span),
            ExpressionKind::CompoundLiteral(name, items) => self.compound_literal(name, items, span),
            ExpressionKind::SizeofExpression(operand) => {
                self.sizeof_expression(operand, span).map(Operand::Value)
            }
            ExpressionKind::SizeofType(name) => {
                let ty = self.type_name(name)?;
                self.sizeof(ty.ty, span).map(Operand::Value)
            }
            ExpressionKind::AlignofType(name) => {
                let ty = self.type_name(name)?;
                let align = self.types.align_of(ty.ty);
                Some(Operand::Value(self.body.int(i64::from(align), Types::INT, span)))
            }
            ExpressionKind::AlignofExpression(operand) => {
                self.alignof_expression(operand, span).map(Operand::Value)
            }
            ExpressionKind::Binary(..) => self.binary_expression(expression).map(Operand::Value),
            ExpressionKind::Assign(to, from) => self.assignment(to, from, span),
            ExpressionKind::AssignWith(operator, to, from) => {
                self.compound_assignment(*operator, to, from, span).map(Operand::Value)
            }
            ExpressionKind::Conditional { condition, then, otherwise } => {
                self.conditional(condition, then.as_deref(), otherwise, span)
            }
            ExpressionKind::Comma(first, second) => self.comma_expression(first, second, span),
            ExpressionKind::VaStart(list, last) => self.va_start(list, last, span),
            ExpressionKind::VaArg(list, name) => self.va_arg(list, name, span),
            ExpressionKind::VaEnd(list) => self.va_end(list, span),
            ExpressionKind::VaCopy(to, from) => self.va_copy(to, from, span),
            ExpressionKind::Offsetof(name, path) => self.offset_of(name, path, span),
            ExpressionKind::Generic { value, choices } => self.generic_selection(value, choices, span),
            ExpressionKind::StatementExpression(statements) => self.statement_expression(statements, span),
            ExpressionKind::LabelAddress(name, name_span) => {
                self.label_address(*name, *name_span, span).map(Operand::Value)
            }
            ExpressionKind::Error => None,
        }
    }

    /// The value of an expression: a scalar.
    pub(super) fn value(&mut self, expression: &Expression) -> Option<ExprId> {
        let operand = self.operand(expression)?;
        self.read(operand, expression.span)
    }

    fn identifier(&mut self, name: Name, span: Span) -> Option<Operand> {
        let Some(binding) = self.scopes.lookup(name) else {
            self.undeclared(name, span);
            return None;
        };
        match binding.entity {
            Entity::Local(local, ty) => Some(Operand::Place(self.local_place(local, ty, span))),
            Entity::Object(symbol, ty) => Some(Operand::Place(self.symbol_place(symbol, ty, span))),
            Entity::Function(symbol, ty) => Some(Operand::Function(Callee::Symbol(symbol), ty)),
            Entity::Enumerator(value) => {
                Some(Operand::Value(self.body.int(i64::from(value), Types::INT, span)))
            }
            Entity::Typedef(_) => {
                let message = format!("`{}` is a type, not a value", self.spelling(name));
                let first = binding.span;
                self.report(Diagnostic::error(span, message).label(first, "declared here"));
                None
            }
            Entity::Poisoned => None,
        }
    }

    /// `a[b]`, also with the index first.
    fn index(&mut self, base: &Expression, index: &Expression, span: Span) -> Option<Operand> {
        let left = self.operand(base);
        let right = self.value(index);
        let (left, mut position) = (left?, right?);
        let mut pointer = self.read(left, base.span)?;
        if !self.types.is_pointer(self.body.ty(pointer)) {
            std::mem::swap(&mut pointer, &mut position);
        }
        let Some(element) = self.types.pointee(self.body.ty(pointer)) else {
            return self.not_indexable(base, self.body.ty(position), span);
        };
        let position = self.index_value(position, index.span)?;
        let bytes = self.scale_to_bytes(position, element, span)?;
        let moved = self.step(pointer, bytes, span);
        self.lint_user_data(pointer, moved, self.types.size_of(element.ty), index.span);
        Some(self.pointee_operand(moved, element, span))
    }

    fn not_indexable(&mut self, base: &Expression, ty: TypeId, span: Span) -> Option<Operand> {
        let spelled = self.spell(ty);
        self.report(
            Diagnostic::error(span, format!("`{spelled}` cannot be indexed"))
                .at("neither an array nor a pointer")
                .label(base.span, format!("this is `{spelled}`")),
        );
        None
    }

    /// An index as an integer; a floating one is cut, with a warning.
    fn index_value(&mut self, index: ExprId, span: Span) -> Option<ExprId> {
        let ty = self.body.ty(index);
        if ty.is_integer() {
            return Some(self.promote(index, span));
        }
        let spelled = self.spell(ty);
        if !ty.is_floating() {
            self.report(Diagnostic::error(span, format!("an index must be an integer, not `{spelled}`")));
            return None;
        }
        self.report(
            Diagnostic::warning(Lint::Extension, span, format!("an index of type `{spelled}`"))
                .at("cut to an `int`")
                .help("write `(int)` if this is meant"),
        );
        Some(self.body.convert(index, Types::INT, span))
    }

    /// Returns the operand `*pointer`.
    pub(super) fn pointee_operand(&mut self, pointer: ExprId, to: QualifiedType, span: Span) -> Operand {
        if self.types.is_function(to.ty) {
            return Operand::Function(self.callee_of(pointer), to.ty);
        }
        Operand::Place(self.pointee_place(pointer, to, span))
    }

    /// A function by its address; if the address is a symbol's, by its name.
    pub(super) fn callee_of(&self, pointer: ExprId) -> Callee {
        if let ExprKind::Address(place) = self.body.exprs[pointer].kind
            && let PlaceKind::Symbol(symbol, 0) = self.body.places[place].kind
            && self.types.is_function(self.symbols.get(symbol).ty)
        {
            return Callee::Symbol(symbol);
        }
        Callee::Pointer(pointer)
    }

    /// `a.b`, `a->b`
    fn member_access(
        &mut self,
        base: &Expression,
        arrow: bool,
        member: Name,
        member_span: Span,
        span: Span,
    ) -> Option<Operand> {
        let operand = self.operand(base)?;
        let whole = if arrow {
            self.arrow_base(operand, base, member)?
        } else {
            self.dot_base(operand, base, member)?
        };
        let record = self.types.record_of(whole.ty.ty)?;
        match self.types.find_member(record, member) {
            Some(found) => Some(Operand::Place(self.member_of(whole, &found, span))),
            None => {
                self.no_member(record, whole.ty.ty, member, member_span);
                None
            }
        }
    }

    fn arrow_base(&mut self, operand: Operand, base: &Expression, member: Name) -> Option<TypedPlace> {
        if self.is_record(operand) {
            let (spelled, member) = (self.spell(self.operand_type(operand).ty), self.spelling(member));
            let message = format!("`->` needs a pointer, but this is a `{spelled}`");
            let help = format!("use `.{member}`");
            self.report(Diagnostic::error(base.span, message).help(help));
            return None;
        }
        let pointer = self.read(operand, base.span)?;
        let ty = self.body.ty(pointer);
        let Some(to) = self.types.pointee(ty).filter(|to| self.types.record_of(to.ty).is_some()) else {
            let (spelled, member) = (self.spell(ty), self.spelling(member));
            let message = format!("`->{member}` needs a pointer to a structure, but this is `{spelled}`");
            self.report(Diagnostic::error(base.span, message));
            return None;
        };
        Some(self.pointee_place(pointer, to, base.span))
    }

    fn dot_base(&mut self, operand: Operand, base: &Expression, member: Name) -> Option<TypedPlace> {
        if let Operand::Place(located) = operand
            && self.types.record_of(located.ty.ty).is_some()
        {
            return Some(located);
        }
        let ty = self.operand_type(operand).ty;
        let (spelled, member) = (self.spell(ty), self.spelling(member));
        let mut diagnostic =
            Diagnostic::error(base.span, format!("`.{member}` needs a structure, but this is `{spelled}`"));
        if self.types.pointee(ty).is_some_and(|to| self.types.record_of(to.ty).is_some()) {
            diagnostic = diagnostic.help(format!("use `->{member}`"));
        }
        self.report(diagnostic);
        None
    }

    pub(super) fn no_member(&mut self, record: RecordId, ty: TypeId, member: Name, span: Span) {
        if self.noted.broken.contains(&record) {
            return;
        }
        let spelled = self.spell(ty);
        let spelling = self.spelling(member);
        let Some(layout) = &self.types.record(record).layout else {
            let message = format!("`{spelled}` is declared but not defined: its members are unknown");
            self.report(Diagnostic::error(span, message));
            return;
        };
        let members = layout.members.iter().filter_map(|member| member.name).map(|name| self.names.get(name));
        let near = suggest(spelling, members.filter(|name| is_sensible(spelling, name)));
        let mut diagnostic = Diagnostic::error(span, format!("`{spelled}` has no member `{spelling}`"));
        if let Some(near) = near {
            diagnostic = diagnostic.help(format!("did you mean `{near}`?"));
        }
        self.report(diagnostic);
    }

    fn unary_expression(
        &mut self,
        operator: UnaryOperator,
        operand: &Expression,
        span: Span,
    ) -> Option<Operand> {
        match operator {
            UnaryOperator::AddressOf => {
                let operand = self.operand(operand)?;
                self.address_of(operand, span).map(Operand::Value)
            }
            UnaryOperator::Dereference => {
                let pointer = self.value(operand)?;
                if is_sum(operand) {
                    self.lint_user_data_end(pointer, span);
                }
                self.dereference(pointer, span)
            }
            UnaryOperator::Plus => self.arithmetic_operand(operand, "+").map(Operand::Value),
            UnaryOperator::Minus => {
                let value = self.arithmetic_operand(operand, "-")?;
                Some(Operand::Value(self.body.unary(UnaryOp::Negate, value, span)))
            }
            UnaryOperator::Complement => {
                let value = self.arithmetic_operand(operand, "~")?;
                if self.body.ty(value).is_floating() {
                    self.report(
                        Diagnostic::error(span, "`~` needs an integer")
                            .label(operand.span, format!("this is `{}`", self.spell(self.body.ty(value)))),
                    );
                    return None;
                }
                Some(Operand::Value(self.body.unary(UnaryOp::Complement, value, span)))
            }
            UnaryOperator::Not => {
                let value = self.value(operand)?;
                Some(Operand::Value(self.body.unary(UnaryOp::Not, value, span)))
            }
        }
    }

    /// A promoted number.
    fn arithmetic_operand(&mut self, operand: &Expression, operator: &str) -> Option<ExprId> {
        let value = self.value(operand)?;
        let ty = self.body.ty(value);
        if ty.is_arithmetic() {
            return Some(self.promote(value, operand.span));
        }
        let message = format!("`{operator}` needs a number, but this is `{}`", self.spell(ty));
        self.report(Diagnostic::error(operand.span, message));
        None
    }

    fn dereference(&mut self, pointer: ExprId, span: Span) -> Option<Operand> {
        let ty = self.body.ty(pointer);
        let Some(to) = self.types.pointee(ty) else {
            let message = format!("`*` needs a pointer, but this is `{}`", self.spell(ty));
            self.report(Diagnostic::error(span, message));
            return None;
        };
        if to.ty.is_void() {
            self.report(
                Diagnostic::error(span, "a `void *` cannot be dereferenced")
                    .help("cast it, as in `*(int *)p`"),
            );
            return None;
        }
        Some(self.pointee_operand(pointer, to, span))
    }

    /// `&a`
    fn address_of(&mut self, operand: Operand, span: Span) -> Option<ExprId> {
        match operand {
            Operand::Function(..) => self.read(operand, span),
            Operand::Place(located)
                if matches!(self.body.places[located.place].kind, PlaceKind::Bits(..)) =>
            {
                self.report(Diagnostic::error(span, "a bit-field has no address"));
                None
            }
            Operand::Place(located) if located.is_lvalue => {
                let pointer = self.types.pointer_to_qualified(located.ty);
                Some(self.address(located.place, pointer, span))
            }
            Operand::Place(_) | Operand::Value(_) => {
                self.report(Diagnostic::error(span, "`&` needs a variable: a value has no address"));
                None
            }
        }
    }

    fn cast(&mut self, name: &TypeName, operand: &Expression, span: Span) -> Option<Operand> {
        let to = self.type_name(name);
        let operand_value = self.operand(operand);
        let (to, value) = (to?.ty, operand_value?);
        if to.is_void() {
            let effect = self.evaluate_effect(value, operand.span);
            return Some(Operand::Value(self.discard_value(effect, span)));
        }
        if self.is_record(value) && self.operand_type(value).ty == to {
            return Some(value);
        }
        let value = self.read(value, operand.span)?;
        if let Some(whole) = self.union_of(value, to, span) {
            return Some(whole);
        }
        let from = self.body.ty(value);
        let is_possible = self.types.is_scalar(to)
            && !(from.is_floating() && self.types.is_pointer(to))
            && !(to.is_floating() && self.types.is_pointer(from));
        if !is_possible {
            let (from, to) = (self.spell(from), self.spell(to));
            self.report(Diagnostic::error(span, format!("cannot cast `{from}` to `{to}`")));
            return None;
        }
        if to == from && self.is_narrow_field(value) {
            // The cast is kept: its value is no longer a bit-field, which would become an `int`.
            return Some(Operand::Value(self.body.expr(ExprKind::Convert(value), to, span)));
        }
        Some(Operand::Value(self.convert_unchecked(value, to, span)))
    }

    /// A value that is evaluated for its effect, as an expression of type `void`.
    pub(super) fn discard_value(&mut self, effect: ExprId, span: Span) -> ExprId {
        if self.body.ty(effect).is_void() {
            return effect;
        }
        self.body.expr(ExprKind::Convert(effect), Types::VOID, span)
    }

    fn sizeof_expression(&mut self, operand: &Expression, span: Span) -> Option<ExprId> {
        self.unevaluated += 1;
        let meaning = self.operand(operand);
        self.unevaluated -= 1;
        let meaning = meaning?;
        if let Operand::Place(located) = meaning
            && matches!(self.body.places[located.place].kind, PlaceKind::Bits(..))
        {
            self.report(Diagnostic::error(span, "a bit-field has no size in bytes"));
            return None;
        }
        let ty = self.operand_type(meaning).ty;
        if let ExpressionKind::Identifier(name) = operand.kind
            && self.types.pointee(ty).is_some_and(|to| !self.types.is_function(to.ty))
        {
            self.report(sizeof_pointer::finding(self.spelling(name), &self.spell(ty), span));
        }
        self.sizeof(ty, span)
    }

    /// The size of a type as `int`: signed, as the vendor's compiler has it (`dialect.md` 1.1).
    fn sizeof(&mut self, ty: TypeId, span: Span) -> Option<ExprId> {
        let Some(size) = self.types.size_of(ty) else {
            let message = format!("the size of `{}` is unknown", self.spell(ty));
            self.report(Diagnostic::error(span, message));
            return None;
        };
        Some(self.body.int(i64::from(size), Types::INT, span))
    }

    fn comma_expression(&mut self, first: &Expression, second: &Expression, span: Span) -> Option<Operand> {
        // A long list leans to the left; go down without recursion.
        let (mut list, mut left) = (vec![second], first);
        while let ExpressionKind::Comma(first, second) = &left.kind {
            list.push(second);
            left = first;
        }
        let mut effect = self.comma_effect(left);
        while let Some(next) = list.pop() {
            if list.is_empty() {
                let operand = self.operand(next);
                return self.after(effect?, operand?, span);
            }
            let following = self.comma_effect(next);
            effect = effect.zip(following).map(|(first, second)| self.body.comma(first, second, next.span));
        }
        None
    }

    fn comma_effect(&mut self, expression: &Expression) -> Option<ExprId> {
        let operand = self.operand(expression)?;
        self.lint_unused(expression, operand);
        Some(self.evaluate_effect(operand, expression.span))
    }

    /// An operand that is evaluated after an effect.
    pub(super) fn after(&mut self, effect: ExprId, operand: Operand, span: Span) -> Option<Operand> {
        if let Operand::Place(located) = operand
            && self.is_record(operand)
        {
            return Some(self.structure_result(effect, located.place, span));
        }
        let value = match operand {
            Operand::Value(value) => value,
            _ => self.read(operand, span)?,
        };
        Some(Operand::Value(self.body.comma(effect, value, span)))
    }

    /// The place of a structure value that is copied somewhere of type `ty`.
    pub(super) fn record_source(
        &mut self,
        operand: Operand,
        ty: TypeId,
        target: AssignmentTarget,
        span: Span,
    ) -> Option<crate::typed::PlaceId> {
        match operand {
            Operand::Place(located) if located.ty.ty == ty => Some(located.place),
            _ => {
                let from = self.operand_type(operand).ty;
                self.refuse_conversion(from, ty, target, span);
                None
            }
        }
    }

    /// `_Generic`: selects the association whose type is that of the value.
    fn generic_selection(
        &mut self,
        value: &Expression,
        choices: &[(Option<TypeName>, Expression)],
        span: Span,
    ) -> Option<Operand> {
        let ty = self.type_of(value)?;
        let ty = self.types.decayed(ty).ty;
        let mut default = None;
        for (name, choice) in choices {
            match name {
                None => default = Some(choice),
                Some(name) if self.type_name(name)?.ty == ty => return self.operand(choice),
                Some(_) => {}
            }
        }
        let Some(choice) = default else {
            let message = format!("no association of `_Generic` has the type `{}`", self.spell(ty));
            self.report(Diagnostic::error(span, message).help("add `default:`"));
            return None;
        };
        self.operand(choice)
    }
}

/// Reports whether a pointer is written as a sum, as in `*(p + 1)`.
fn is_sum(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Cast(_, inner) => is_sum(inner),
        ExpressionKind::Binary(..) => true,
        _ => false,
    }
}
