//! Operands: the result of an expression before its use is known.
//!
//! `a` is a place when it is assigned to, a value when it is read, and an address when it is an array that is passed
//! on. `None` instead of an operand means that it was diagnosed: expressions computed from it are not reported again.

use super::Sema;
use super::places::TypedPlace;
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;
use crate::ty::{QualifiedType, Type, TypeId, Types};
use crate::typed::{Callee, ExprId, ExprKind, PlaceId, PlaceKind};

/// The meaning of an expression.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operand {
    /// A value of scalar type, or an effect of type `void`.
    Value(ExprId),
    /// Storage: an lvalue, or a structure result of an expression.
    Place(TypedPlace),
    /// A function and its type.
    Function(Callee, TypeId),
}

impl Sema<'_> {
    /// The type of an operand, before arrays and functions become pointers.
    pub(super) fn operand_type(&self, operand: Operand) -> QualifiedType {
        match operand {
            Operand::Value(value) => QualifiedType::plain(self.body.ty(value)),
            Operand::Place(located) => located.ty,
            Operand::Function(_, ty) => QualifiedType::plain(ty),
        }
    }

    /// Reads an operand: a scalar value; arrays and functions become pointers.
    pub(super) fn read(&mut self, operand: Operand, span: Span) -> Option<ExprId> {
        match operand {
            Operand::Value(value) if self.body.ty(value).is_void() => self.read_void(value, span),
            Operand::Value(value) => {
                self.lint_void_value(value, span);
                Some(value)
            }
            Operand::Place(located) => self.read_place(located, span),
            Operand::Function(callee, ty) => {
                let pointer = self.types.pointer_to(ty);
                Some(match callee {
                    Callee::Symbol(symbol) => self.symbol_address(symbol, pointer, span),
                    Callee::Pointer(value) => self.cast_pointer(value, pointer, span),
                })
            }
        }
    }

    fn read_place(&mut self, located: TypedPlace, span: Span) -> Option<ExprId> {
        match self.types.get(located.ty.ty) {
            Type::Array(element, _) => {
                let element = *element;
                let pointer = self.types.pointer_to_qualified(element);
                Some(self.address(located.place, pointer, span))
            }
            Type::Record(_) => {
                let spelled = self.spell(located.ty.ty);
                let message = format!("`{spelled}` is used where a number or pointer is needed");
                let diagnostic = Diagnostic::error(span, message).at("this is a whole structure");
                self.report(if spelled == "PERSIST" {
                    diagnostic.help("write `persist.UserData[…]`")
                } else {
                    diagnostic.help("write a member of it, after a `.`")
                });
                None
            }
            Type::Void => {
                self.report(
                    Diagnostic::error(span, "a `void` object has no value").help("cast the pointer first"),
                );
                None
            }
            _ => Some(self.body.expr(ExprKind::Load(located.place), located.ty.ty, span)),
        }
    }

    /// A `void` call where a value is needed gives 0 (`dialect.md` 2.4).
    fn read_void(&mut self, value: ExprId, span: Span) -> Option<ExprId> {
        let mut last = value;
        while let ExprKind::Comma(_, second) = self.body.exprs[last].kind {
            last = second;
        }
        if !matches!(self.body.exprs[last].kind, ExprKind::Call(_)) {
            self.report(Diagnostic::error(span, "an expression of type `void` has no value"));
            return None;
        }
        self.report(
            Diagnostic::warning(Lint::VoidValue, span, "the value of a `void` function is used")
                .at("this call returns nothing; the value is 0"),
        );
        let zero = self.body.int(0, Types::INT, span);
        Some(self.body.comma(value, zero, span))
    }

    /// Warns if the value comes from a function that is declared `void` but returns one.
    fn lint_void_value(&mut self, value: ExprId, span: Span) {
        let ExprKind::Call(call) = &self.body.exprs[value].kind else { return };
        let Callee::Symbol(symbol) = call.callee else { return };
        let definer = self.symbols.facts(symbol).convention.as_ref();
        let Some(definition) =
            definer.filter(|definer| definer.is_void_with_value).map(|definer| definer.span)
        else {
            return;
        };
        let name = self.symbols.get(symbol).name.clone();
        self.report(
            Diagnostic::warning(
                Lint::VoidValue,
                span,
                format!("the value of the `void` function `{name}` is used"),
            )
            .at("the value is that of its `return`, as `int`")
            .label(definition, "declared `void` here")
            .help(format!("declare `{name}` as `int`")),
        );
    }

    /// Evaluates an operand only for its effect; lowering may drop the expression if it has none.
    pub(super) fn evaluate_effect(&mut self, operand: Operand, span: Span) -> ExprId {
        match operand {
            Operand::Value(value) => value,
            Operand::Place(located) => self.place_effect(located, span),
            Operand::Function(Callee::Pointer(value), _) => value,
            Operand::Function(Callee::Symbol(_), _) => self.body.int(0, Types::INT, span),
        }
    }

    /// The effect of evaluating a place: a read of a scalar, the pointer expression of anything larger.
    fn place_effect(&mut self, located: TypedPlace, span: Span) -> ExprId {
        if self.types.is_scalar(located.ty.ty) {
            return self.body.expr(ExprKind::Load(located.place), located.ty.ty, span);
        }
        match self.body.places[located.place].kind {
            PlaceKind::Pointer(pointer, _) => pointer,
            _ => self.body.int(0, Types::INT, span),
        }
    }

    /// A structure result: `effect` is evaluated, then the place holds the value.
    pub(super) fn structure_result(&mut self, effect: ExprId, place: PlaceId, span: Span) -> Operand {
        let ty = self.body.places[place].ty;
        let pointer_type = self.types.pointer_to(ty);
        let address = self.address(place, pointer_type, span);
        let pointer = self.body.comma(effect, address, span);
        let place = self.body.place(PlaceKind::Pointer(pointer, 0), ty, span);
        Operand::Place(TypedPlace { place, ty: QualifiedType::plain(ty), is_lvalue: false })
    }

    /// Reports whether an operand is a whole structure or union.
    pub(super) fn is_record(&self, operand: Operand) -> bool {
        matches!(operand, Operand::Place(located) if self.types.record_of(located.ty.ty).is_some())
    }
}
