//! Enumerations: constants of type `int`.
//!
//! An object of enumeration type is an `int`, too. Only a bit-field makes a difference: without negative constants it
//! is unsigned, so that `enum { OFF, ON } state : 1` holds `ON`.

use super::Sema;
use super::scope::{Entity, Tag};
use crate::ast::{EnumSpecifier, Enumerator, TypeSpecifier};
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

impl Sema<'_> {
    /// Declares an enumeration and its constants; the type is always `int`.
    pub(super) fn enumeration(&mut self, specifier: &EnumSpecifier) {
        if let Some((tag, span)) = specifier.tag {
            let known = self.scopes.lookup_tag(tag).map(|binding| (binding.entity, binding.span));
            if let Some((Tag::Record(_), first)) = known {
                let message = format!("`{}` is a structure or union, not an enumeration", self.spelling(tag));
                self.report(Diagnostic::error(span, message).label(first, "declared here"));
            } else if self.scopes.lookup_tag_here(tag).is_none()
                && (known.is_none() || specifier.enumerators.is_some())
            {
                self.scopes.bind_tag(tag, Tag::Enum, span);
            }
        }
        let mut next = 0_i32;
        let mut is_unsigned = specifier.enumerators.is_some();
        for enumerator in specifier.enumerators.iter().flatten() {
            let value = self.enumerator_value(enumerator, next);
            is_unsigned &= value.is_none_or(|value| value >= 0);
            next = value.unwrap_or(next).wrapping_add(1);
            self.declare_enumerator(enumerator, value);
        }
        if is_unsigned {
            self.noted.unsigned_enums.insert(self.enum_place(specifier));
        }
    }

    /// Reports whether specifiers name an enumeration without negative constants.
    pub(super) fn is_unsigned_enum(&self, specifier: &TypeSpecifier) -> bool {
        let place = match specifier {
            TypeSpecifier::Enum(specifier) => self.enum_place(specifier),
            TypeSpecifier::Typedef(name) => match self.scopes.lookup(*name) {
                Some(binding) => binding.span,
                None => return false,
            },
            _ => return false,
        };
        self.noted.unsigned_enums.contains(&place)
    }

    /// Records that a `typedef` names an enumeration.
    pub(super) fn note_enum_typedef(&mut self, specifier: Option<&TypeSpecifier>, name: Span) {
        if specifier.is_some_and(|specifier| self.is_unsigned_enum(specifier)) {
            self.noted.unsigned_enums.insert(name);
        }
    }

    /// The identity of an enumeration: the first declaration of its tag, otherwise itself.
    fn enum_place(&self, specifier: &EnumSpecifier) -> Span {
        let tag = specifier.tag.and_then(|(tag, _)| self.scopes.lookup_tag(tag));
        tag.map_or(specifier.span, |binding| binding.span)
    }

    fn enumerator_value(&mut self, enumerator: &Enumerator, next: i32) -> Option<i32> {
        let Some(expression) = &enumerator.value else { return Some(next) };
        let value = self.constant_integer(expression, "the value of an enumerator")?;
        // Any 32 bits are accepted: `0x80000000` is a negative `int`.
        if i32::try_from(value).is_err() && u32::try_from(value).is_err() {
            let message = format!("the value of `{}` does not fit `int`", self.spelling(enumerator.name));
            self.report(Diagnostic::error(expression.span, message));
            return None;
        }
        Some(value as i32)
    }

    /// Declares an enumerator, which may be declared again; the new value applies from there on (`dialect.md` 2.2).
    fn declare_enumerator(&mut self, enumerator: &Enumerator, value: Option<i32>) {
        let known = self.scopes.lookup_here(enumerator.name).map(|binding| (binding.entity, binding.span));
        match (known, value) {
            (Some((Entity::Enumerator(old), first)), Some(value)) => {
                if old != value {
                    let name = self.spelling(enumerator.name);
                    let message = format!("enumerator `{name}` is redeclared with a different value");
                    self.report(
                        Diagnostic::warning(Lint::Redeclared, enumerator.span, message)
                            .at(format!("{value} from here on"))
                            .label(first, format!("{old} here")),
                    );
                }
            }
            (Some((Entity::Poisoned, _)) | None, _) | (_, None) => {}
            (Some((_, first)), _) => {
                let message =
                    format!("`{}` is already declared as something else", self.spelling(enumerator.name));
                self.report(Diagnostic::error(enumerator.span, message).label(first, "declared here"));
            }
        }
        let entity = value.map_or(Entity::Poisoned, Entity::Enumerator);
        self.scopes.bind(enumerator.name, entity, enumerator.span);
    }
}
