//! Conversions between types: promotions, common types, compatibility.
//!
//! Rules: `dialect.md` 1.3 and 1.4. They are those of C90 with 32-bit `long`, except that
//! `float` with `float` stays `float`.

use super::{FunctionType, ParameterTypes, QualifiedType, Type, TypeId, Types};

/// The promoted type of an integer narrower than `int`.
#[must_use]
pub fn promoted(ty: TypeId) -> TypeId {
    if (Types::BOOL..=Types::UNSIGNED_SHORT).contains(&ty) { Types::INT } else { ty }
}

/// The common type of two arithmetic types.
#[must_use]
pub fn common(a: TypeId, b: TypeId) -> TypeId {
    // The basic types are numbered in the order of their rank; a `long long` holds every `unsigned`.
    promoted(a).max(promoted(b))
}

/// The type in which a value is passed without a prototype.
#[must_use]
pub fn argument_promoted(ty: TypeId) -> TypeId {
    if ty == Types::FLOAT { Types::DOUBLE } else { promoted(ty) }
}

impl Types {
    /// Reports whether two types may declare the same thing; qualifiers do not count.
    #[must_use]
    pub fn compatible(&self, a: TypeId, b: TypeId) -> bool {
        if a == b {
            return true;
        }
        match (self.get(a), self.get(b)) {
            (Type::Pointer(a), Type::Pointer(b)) => self.compatible(a.ty, b.ty),
            (Type::Array(a, n), Type::Array(b, m)) => {
                self.compatible(a.ty, b.ty) && (n == m || n.is_none() || m.is_none())
            }
            (Type::Function(a), Type::Function(b)) => {
                self.compatible(a.result, b.result) && self.compatible_parameters(a, b)
            }
            _ => false,
        }
    }

    /// Reports whether two functions can be called in the same way; `()` is compatible with every list that promotions
    /// do not change.
    #[must_use]
    pub fn compatible_parameters(&self, a: &FunctionType, b: &FunctionType) -> bool {
        match (&a.parameters, &b.parameters) {
            (ParameterTypes::Unspecified, ParameterTypes::Unspecified) => true,
            (ParameterTypes::Unspecified, ParameterTypes::Prototype { types, is_variadic })
            | (ParameterTypes::Prototype { types, is_variadic }, ParameterTypes::Unspecified) => {
                !is_variadic && types.iter().all(|ty| argument_promoted(ty.ty) == ty.ty)
            }
            (
                ParameterTypes::Prototype { types: a, is_variadic: a_variadic },
                ParameterTypes::Prototype { types: b, is_variadic: b_variadic },
            ) => {
                a_variadic == b_variadic
                    && a.len() == b.len()
                    && a.iter().zip(b).all(|(a, b)| self.compatible(a.ty, b.ty))
            }
        }
    }

    /// The composite of two compatible types: array lengths and parameters that one of them leaves out.
    #[must_use]
    pub fn composite(&self, old: TypeId, new: TypeId) -> TypeId {
        let knows_more = match (self.get(old), self.get(new)) {
            (Type::Array(_, Some(_)), Type::Array(_, None)) => true,
            (Type::Function(old), Type::Function(new)) => {
                new.parameters == ParameterTypes::Unspecified && old.parameters != ParameterTypes::Unspecified
            }
            _ => false,
        };
        if knows_more { old } else { new }
    }

    /// The type of `&` applied to a value of type `ty`.
    pub fn pointer_to_qualified(&mut self, ty: QualifiedType) -> TypeId {
        if ty == QualifiedType::plain(ty.ty) {
            self.pointer_to(ty.ty)
        } else {
            self.intern(Type::Pointer(ty))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_types_follow_rank_and_unsignedness() {
        let check = |a, b, expect| {
            assert_eq!(common(a, b), expect);
            assert_eq!(common(b, a), expect);
        };
        check(Types::CHAR, Types::UNSIGNED_SHORT, Types::INT);
        check(Types::INT, Types::UNSIGNED, Types::UNSIGNED);
        check(Types::UNSIGNED, Types::LONG_LONG, Types::LONG_LONG);
        check(Types::LONG_LONG, Types::UNSIGNED_LONG_LONG, Types::UNSIGNED_LONG_LONG);
        check(Types::UNSIGNED_LONG_LONG, Types::FLOAT, Types::FLOAT);
        check(Types::FLOAT, Types::FLOAT, Types::FLOAT);
        check(Types::FLOAT, Types::DOUBLE, Types::DOUBLE);
    }

    #[test]
    fn an_empty_parameter_list_agrees_with_promoted_parameters_only() {
        let mut types = Types::new();
        let mut function =
            |parameters| types.intern(Type::Function(FunctionType { result: Types::INT, parameters }));
        let prototype =
            |ty| ParameterTypes::Prototype { types: vec![QualifiedType::plain(ty)], is_variadic: false };
        let open = function(ParameterTypes::Unspecified);
        let int = function(prototype(Types::INT));
        let float = function(prototype(Types::FLOAT));
        assert!(types.compatible(open, int));
        assert!(!types.compatible(open, float));
        assert_eq!(types.composite(int, open), int);
    }
}
