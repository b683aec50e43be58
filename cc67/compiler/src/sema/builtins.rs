//! Built-in forms that look like calls: variable arguments, `offsetof`, statement expressions.

use super::Sema;
use super::operands::Operand;
use super::places::TypedPlace;
use crate::ast::{Designator, Expression, Statement, StatementKind, TypeName};
use crate::diag::Diagnostic;
use crate::source::Span;
use crate::ty::{QualifiedType, TypeId, Types, convert};
use crate::typed::{ExprId, ExprKind, PlaceId, PlaceKind};

impl Sema<'_> {
    /// `va_start(list, last)`: the list is the address of the first variable argument.
    pub(super) fn va_start(&mut self, list: &Expression, last: &Expression, span: Span) -> Option<Operand> {
        let place = self.va_list(list);
        self.type_of(last)?;
        let place = place?;
        let Some(arguments) = self.body.hidden.variable_arguments else {
            self.report(
                Diagnostic::error(span, "`va_start` in a function without variable arguments")
                    .help("end the parameter list with `, ...`"),
            );
            return None;
        };
        let value = self.body.load_local(arguments, span);
        Some(self.store_list(place, value, span))
    }

    /// `va_arg(list, type)`
    pub(super) fn va_arg(&mut self, list: &Expression, name: &TypeName, span: Span) -> Option<Operand> {
        let place = self.va_list(list);
        let ty = self.type_name(name)?.ty;
        let place = place?;
        if self.types.record_of(ty).is_some() && self.types.is_object(ty) {
            return Some(self.record_argument(place, ty, span));
        }
        if !self.types.is_scalar(ty) {
            let message = format!("`va_arg` cannot fetch a `{}`", self.spell(ty));
            self.report(Diagnostic::error(span, message).help("pass a pointer to it"));
            return None;
        }
        // A `float` was passed as a `double`, a `char` as an `int`.
        let passed = convert::argument_promoted(ty);
        let value = self.body.expr(ExprKind::VaArg(place), passed, span);
        Some(Operand::Value(self.body.convert(value, ty, span)))
    }

    /// A structure among the variable arguments, which was passed by address.
    fn record_argument(&mut self, list: PlaceId, ty: TypeId, span: Span) -> Operand {
        let pointer = self.types.pointer_to(ty);
        let address = self.body.expr(ExprKind::VaArg(list), pointer, span);
        let place = self.body.place(PlaceKind::Pointer(address, 0), ty, span);
        Operand::Place(TypedPlace { place, ty: QualifiedType::plain(ty), is_lvalue: false })
    }

    /// `va_end(list)`: nothing to do.
    pub(super) fn va_end(&mut self, list: &Expression, span: Span) -> Option<Operand> {
        self.va_list(list)?;
        let nothing = self.body.int(0, Types::INT, span);
        Some(Operand::Value(self.discard_value(nothing, span)))
    }

    /// `va_copy(to, from)`
    pub(super) fn va_copy(&mut self, to: &Expression, from: &Expression, span: Span) -> Option<Operand> {
        let (to, from) = (self.va_list(to), self.va_list(from));
        let (to, from) = (to?, from?);
        let ty = self.types.pointer_to(Types::CHAR);
        let value = self.body.expr(ExprKind::Load(from), ty, span);
        Some(self.store_list(to, value, span))
    }

    fn store_list(&mut self, list: PlaceId, value: ExprId, span: Span) -> Operand {
        let ty = self.body.places[list].ty;
        let store = self.body.expr(ExprKind::Assign(list, value), ty, span);
        Operand::Value(self.discard_value(store, span))
    }

    /// A `va_list`: any variable of type `char *`.
    fn va_list(&mut self, list: &Expression) -> Option<PlaceId> {
        let operand = self.operand(list)?;
        let expected = self.types.pointer_to(Types::CHAR);
        match operand {
            Operand::Place(located) if located.is_lvalue && located.ty.ty == expected => Some(located.place),
            _ => {
                let message =
                    format!("a `va_list` is needed, not `{}`", self.spell(self.operand_type(operand).ty));
                self.report(Diagnostic::error(list.span, message));
                None
            }
        }
    }

    /// `offsetof(type, member.member[index])`
    pub(super) fn offset_of(&mut self, name: &TypeName, path: &[Designator], span: Span) -> Option<Operand> {
        let mut ty = self.type_name(name)?;
        let mut offset = 0_i64;
        for step in path {
            let (bytes, inner) = self.offset_step(ty, step, span)?;
            offset += bytes;
            ty = inner;
        }
        Some(Operand::Value(self.body.int(offset, Types::UNSIGNED, span)))
    }

    fn offset_step(
        &mut self,
        ty: QualifiedType,
        step: &Designator,
        span: Span,
    ) -> Option<(i64, QualifiedType)> {
        match step {
            Designator::Member(name, member_span) => {
                let Some(record) = self.types.record_of(ty.ty) else {
                    let message = format!("`{}` has no members", self.spell(ty.ty));
                    self.report(Diagnostic::error(*member_span, message));
                    return None;
                };
                match self.types.find_member(record, *name) {
                    Some(member) if member.bits.is_none() => Some((i64::from(member.offset), member.ty)),
                    Some(_) => {
                        self.report(Diagnostic::error(*member_span, "a bit-field has no offset in bytes"));
                        None
                    }
                    None => {
                        self.no_member(record, ty.ty, *name, *member_span);
                        None
                    }
                }
            }
            Designator::Index(index) | Designator::Range(index, _) => {
                let Some((element, _)) = self.types.array(ty.ty) else {
                    let message = format!("`{}` is not an array", self.spell(ty.ty));
                    self.report(Diagnostic::error(index.span, message));
                    return None;
                };
                let index = self.constant_integer(index, "an index in `offsetof`")?;
                let size = self.step_size(element, span)?;
                Some((index.wrapping_mul(i64::from(size)), element))
            }
        }
    }

    /// `({ … })`: the value is that of the last statement, if it is an expression.
    pub(super) fn statement_expression(&mut self, statements: &[Statement], span: Span) -> Option<Operand> {
        if self.body.name.is_empty() {
            self.report(Diagnostic::error(span, "a statement expression outside a function"));
            return None;
        }
        let mut out = Vec::new();
        self.scopes.enter();
        let value = match statements.split_last() {
            Some((Statement { kind: StatementKind::Expression(last), .. }, before)) => {
                self.statements(before, &mut out);
                let operand = self.operand(last);
                operand.map(|operand| (operand, last.span))
            }
            _ => {
                self.statements(statements, &mut out);
                let nothing = self.body.int(0, Types::INT, span);
                Some((Operand::Value(self.discard_value(nothing, span)), span))
            }
        };
        self.scopes.leave();
        let (operand, last) = value?;
        if let Operand::Place(located) = operand
            && self.is_record(operand)
        {
            return Some(self.record_behind(out, located, span));
        }
        let value = match operand {
            Operand::Value(value) => value,
            _ => self.read(operand, last)?,
        };
        let ty = self.body.ty(value);
        Some(Operand::Value(self.body.expr(ExprKind::Statements(out, Some(value)), ty, span)))
    }

    fn record_behind(
        &mut self,
        statements: Vec<crate::typed::Stmt>,
        located: TypedPlace,
        span: Span,
    ) -> Operand {
        let ty: TypeId = located.ty.ty;
        let pointer_type = self.types.pointer_to(ty);
        let address = self.address(located.place, pointer_type, span);
        let pointer = self.body.expr(ExprKind::Statements(statements, Some(address)), pointer_type, span);
        let place = self.body.place(PlaceKind::Pointer(pointer, 0), ty, span);
        Operand::Place(TypedPlace { place, ty: QualifiedType::plain(ty), is_lvalue: false })
    }
}
