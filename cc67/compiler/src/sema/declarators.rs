//! Declarators: pointers, arrays and functions derived around a name.

use super::Sema;
use super::scope::Entity;
use super::specifiers::ImplicitInt;
use crate::ast::{Derived, Expression, ExpressionKind, Parameter, Parameters};
use crate::diag::Diagnostic;
use crate::names::Name;
use crate::source::Span;
use crate::ty::layout::MAX_OBJECT_SIZE;
use crate::ty::{FunctionType, ParameterTypes, QualifiedType, Type, Types};
use crate::typed::{ExprId, ExprKind};

/// The depth to which a tree is searched for constant or other parts.
pub(super) const MAX_SEARCH: u32 = 64;

/// A parameter of a prototype or definition.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeclaredParameter {
    /// Its name.
    pub(super) name: Option<Name>,
    /// Its type, with arrays and functions converted to pointers.
    pub(super) ty: QualifiedType,
    /// The position of its name, otherwise of the whole parameter.
    pub(super) span: Span,
}

impl Sema<'_> {
    /// Derives a type; `derived` is ordered from the name outwards, so the last one is applied first.
    pub(super) fn derived_type(
        &mut self,
        base: QualifiedType,
        derived: &[Derived],
        span: Span,
    ) -> Option<QualifiedType> {
        derived.iter().rev().try_fold(base, |ty, derived| match derived {
            Derived::Pointer(qualifiers) => {
                Some(QualifiedType::plain(self.types.pointer_to_qualified(ty)).with(*qualifiers))
            }
            Derived::Array(length) => self.array_type(ty, length.as_deref(), span),
            Derived::Function(parameters) => self.function_type(ty, parameters, span),
        })
    }

    fn array_type(
        &mut self,
        element: QualifiedType,
        length: Option<&Expression>,
        span: Span,
    ) -> Option<QualifiedType> {
        let Some(size) = self.types.size_of(element.ty).filter(|_| self.types.is_object(element.ty)) else {
            let spelled = self.spell(element.ty);
            self.report(Diagnostic::error(
                span,
                format!("an array cannot have elements of type `{spelled}`"),
            ));
            return None;
        };
        let length = match length {
            None => None,
            Some(length) => Some(self.array_length(length, size)?),
        };
        Some(QualifiedType::plain(self.types.intern(Type::Array(element, length))))
    }

    fn array_length(&mut self, length: &Expression, element_size: u32) -> Option<u32> {
        let value = self.constant_integer(length, "an array length")?;
        if value < 0 {
            self.report(Diagnostic::error(length.span, format!("an array cannot have {value} elements")));
            return None;
        }
        let bytes = value.saturating_mul(i64::from(element_size));
        if bytes > i64::from(MAX_OBJECT_SIZE) {
            let message = format!("an array of {bytes} bytes is too large");
            self.report(
                Diagnostic::error(length.span, message).note(format!("the limit is {MAX_OBJECT_SIZE} bytes")),
            );
            return None;
        }
        u32::try_from(value).ok()
    }

    /// The value of an expression that must be an integer constant.
    pub(super) fn constant_integer(&mut self, expression: &Expression, what: &str) -> Option<i64> {
        self.unevaluated += 1;
        let value = self.value(expression);
        self.unevaluated -= 1;
        let value = value?;
        if let Some(constant) = self.body.as_int(value).filter(|_| self.body.ty(value).is_integer()) {
            return Some(constant);
        }
        if self.divides_by_zero(value, MAX_SEARCH) {
            self.report(Diagnostic::error(expression.span, "division by zero in a constant expression"));
            return None;
        }
        let diagnostic = Diagnostic::error(expression.span, format!("{what} must be an integer constant"))
            .at("not a constant");
        self.report(match self.named_variable(expression) {
            Some(true) => diagnostic
                .note("a `const` variable is not a constant expression in C")
                .help("use `#define` or `enum { … }`"),
            Some(false) => diagnostic.note("the value of a variable is known only at run time").help(
                if what == "an array length" {
                    "write the largest length that is needed, as a number"
                } else {
                    "name the number by `#define`, or use `if`"
                },
            ),
            None => diagnostic,
        });
        None
    }

    /// Reports whether an expression is a quotient of constants that was not folded.
    pub(super) fn divides_by_zero(&self, value: ExprId, depth: u32) -> bool {
        let Some(depth) = depth.checked_sub(1) else { return false };
        match self.body.exprs[value].kind {
            ExprKind::Binary(_, a, b) => {
                (self.body.as_int(a).is_some() && self.body.as_int(b) == Some(0))
                    || self.divides_by_zero(a, depth)
                    || self.divides_by_zero(b, depth)
            }
            ExprKind::Unary(_, a) | ExprKind::Convert(a) => self.divides_by_zero(a, depth),
            _ => false,
        }
    }

    /// Reports whether the expression is a variable, or a sum with one, and whether that is `const`.
    fn named_variable(&self, expression: &Expression) -> Option<bool> {
        match &expression.kind {
            ExpressionKind::Identifier(name) => match self.scopes.lookup(*name)?.entity {
                Entity::Local(_, ty) | Entity::Object(_, ty) => Some(ty.is_const),
                _ => None,
            },
            ExpressionKind::Binary(_, a, b) => [a, b]
                .into_iter()
                .filter(|side| matches!(side.kind, ExpressionKind::Identifier(_)))
                .find_map(|side| self.named_variable(side)),
            _ => None,
        }
    }

    fn function_type(
        &mut self,
        result: QualifiedType,
        parameters: &Parameters,
        span: Span,
    ) -> Option<QualifiedType> {
        self.scopes.enter();
        let declared = self.parameters(parameters);
        self.scopes.leave();
        let parameters = parameter_types(parameters, &declared?);
        self.function_of(result, parameters, span)
    }

    /// A function type, if there can be such functions.
    pub(super) fn function_of(
        &mut self,
        result: QualifiedType,
        parameters: ParameterTypes,
        span: Span,
    ) -> Option<QualifiedType> {
        if matches!(self.types.get(result.ty), Type::Array(..) | Type::Function(_)) {
            let spelled = self.spell(result.ty);
            self.report(Diagnostic::error(span, format!("a function cannot return `{spelled}`")));
            return None;
        }
        let function = FunctionType { result: result.ty, parameters };
        Some(QualifiedType::plain(self.types.intern(Type::Function(function))))
    }

    /// The parameters of a list; old-style names are `int` until their declarations are seen. The innermost scope must
    /// be the scope of the list.
    pub(super) fn parameters(&mut self, parameters: &Parameters) -> Option<Vec<DeclaredParameter>> {
        match parameters {
            Parameters::Unspecified => Some(Vec::new()),
            Parameters::Names(names) => Some(
                names
                    .iter()
                    .map(|&(name, span)| DeclaredParameter {
                        name: Some(name),
                        ty: QualifiedType::plain(Types::INT),
                        span,
                    })
                    .collect(),
            ),
            // Every parameter is checked, so that all mistakes of a list are reported.
            Parameters::Prototype { parameters, .. } => parameters
                .iter()
                .map(|parameter| self.parameter(parameter))
                .collect::<Vec<_>>()
                .into_iter()
                .collect(),
        }
    }

    fn parameter(&mut self, parameter: &Parameter) -> Option<DeclaredParameter> {
        let base = self.specified_type(&parameter.specifiers, ImplicitInt::Warn)?;
        let ty = self.derived_type(base, &parameter.declarator.derived, parameter.span)?;
        let ty = self.types.decayed(ty);
        let (name, span) =
            parameter.declarator.name.map_or((None, parameter.span), |(name, span)| (Some(name), span));
        if ty.ty.is_void() {
            self.report(Diagnostic::error(span, "a parameter cannot have type `void`"));
            return None;
        }
        Some(DeclaredParameter { name, ty, span })
    }
}

/// The parameters of the type that a parameter list declares.
pub(super) fn parameter_types(parameters: &Parameters, declared: &[DeclaredParameter]) -> ParameterTypes {
    match parameters {
        Parameters::Unspecified | Parameters::Names(_) => ParameterTypes::Unspecified,
        Parameters::Prototype { is_variadic, .. } => ParameterTypes::Prototype {
            types: declared.iter().map(|parameter| QualifiedType::plain(parameter.ty.ty)).collect(),
            is_variadic: *is_variadic,
        },
    }
}
