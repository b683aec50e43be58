//! Declaration specifiers: the words before the declarators.

use super::Sema;
use super::scope::Entity;
use crate::ast::{BasicType, Expression, Specifiers, TypeName, TypeSpecifier};
use crate::diag::{Diagnostic, Lint};
use crate::names::{Name, word};
use crate::source::Span;
use crate::ty::{QualifiedType, TypeId, Types};

/// The treatment of a declaration without a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ImplicitInt {
    /// `main() {…}`, `static n;` in a block: programs mean it.
    Silent,
    /// `x;` at file scope, `const x` as a parameter.
    Warn,
}

impl Sema<'_> {
    /// The type that specifiers name, with their qualifiers; tags inside are declared.
    pub(super) fn specified_type(
        &mut self,
        specifiers: &Specifiers,
        implicit: ImplicitInt,
    ) -> Option<QualifiedType> {
        let Some(ty) = &specifiers.ty else {
            if implicit == ImplicitInt::Warn {
                self.report(
                    Diagnostic::warning(
                        Lint::ImplicitInt,
                        specifiers.span,
                        "declaration without a type is `int`",
                    )
                    .help("write `int`"),
                );
            }
            return Some(QualifiedType::plain(Types::INT).with(specifiers.qualifiers));
        };
        let ty = match ty {
            TypeSpecifier::Basic(basic) => QualifiedType::plain(basic_type(*basic)),
            TypeSpecifier::Typedef(name) => self.typedef(*name, specifiers.span)?,
            TypeSpecifier::Record(record) => QualifiedType::plain(self.record(record)?),
            TypeSpecifier::Enum(specifier) => {
                self.enumeration(specifier);
                QualifiedType::plain(Types::INT)
            }
            TypeSpecifier::TypeofExpression(expression) => self.type_of(expression)?,
            TypeSpecifier::TypeofType(name) => self.type_name(name)?,
        };
        Some(ty.with(specifiers.qualifiers))
    }

    /// The type of an expression that is not evaluated.
    pub(super) fn type_of(&mut self, expression: &Expression) -> Option<QualifiedType> {
        self.unevaluated += 1;
        let operand = self.operand(expression);
        self.unevaluated -= 1;
        Some(self.operand_type(operand?))
    }

    /// The type that a cast, `sizeof` or compound literal names.
    pub(super) fn type_name(&mut self, name: &TypeName) -> Option<QualifiedType> {
        let base = self.specified_type(&name.specifiers, ImplicitInt::Warn)?;
        self.derived_type(base, &name.declarator.derived, name.span)
    }

    fn typedef(&mut self, name: Name, span: Span) -> Option<QualifiedType> {
        match self.scopes.lookup(name).map(|binding| binding.entity) {
            Some(Entity::Typedef(ty)) => Some(ty),
            Some(Entity::Poisoned) => None,
            _ if [word::VA_LIST, word::BUILTIN_VA_LIST].contains(&name) => {
                Some(QualifiedType::plain(self.types.pointer_to(Types::CHAR)))
            }
            _ => {
                self.unknown_type(name, span);
                None
            }
        }
    }
}

const fn basic_type(basic: BasicType) -> TypeId {
    match basic {
        BasicType::Void => Types::VOID,
        BasicType::Bool => Types::BOOL,
        BasicType::Char => Types::CHAR,
        BasicType::SignedChar => Types::SIGNED_CHAR,
        BasicType::UnsignedChar => Types::UNSIGNED_CHAR,
        BasicType::Short => Types::SHORT,
        BasicType::UnsignedShort => Types::UNSIGNED_SHORT,
        BasicType::Int | BasicType::Long => Types::INT,
        BasicType::Unsigned | BasicType::UnsignedLong => Types::UNSIGNED,
        BasicType::LongLong => Types::LONG_LONG,
        BasicType::UnsignedLongLong => Types::UNSIGNED_LONG_LONG,
        BasicType::Float => Types::FLOAT,
        BasicType::Double | BasicType::LongDouble => Types::DOUBLE,
    }
}
