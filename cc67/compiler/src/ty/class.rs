//! Queries of a type: its class, its target as a pointer.

use super::{FunctionType, QualifiedType, RecordId, Type, TypeId, Types};

impl TypeId {
    /// Reports whether it is `void`.
    #[must_use]
    pub fn is_void(self) -> bool {
        self == Types::VOID
    }

    /// Reports whether it is an integer type, `_Bool` and `char` included.
    #[must_use]
    pub fn is_integer(self) -> bool {
        (Types::BOOL..=Types::UNSIGNED_LONG_LONG).contains(&self)
    }

    /// Reports whether it is `float` or `double`.
    #[must_use]
    pub fn is_floating(self) -> bool {
        self == Types::FLOAT || self == Types::DOUBLE
    }

    /// Reports whether it is an integer or floating type.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        (Types::BOOL..=Types::DOUBLE).contains(&self)
    }

    /// Reports whether it is an integer type of 64 bits.
    #[must_use]
    pub fn is_long_long(self) -> bool {
        self == Types::LONG_LONG || self == Types::UNSIGNED_LONG_LONG
    }

    /// Reports whether it is an integer type without negative values.
    #[must_use]
    pub fn is_unsigned(self) -> bool {
        [Types::BOOL, Types::UNSIGNED_CHAR, Types::UNSIGNED_SHORT, Types::UNSIGNED, Types::UNSIGNED_LONG_LONG]
            .contains(&self)
    }

    /// Reports whether it is one of the three `char` types.
    #[must_use]
    pub fn is_character(self) -> bool {
        (Types::CHAR..=Types::UNSIGNED_CHAR).contains(&self)
    }
}

impl Types {
    /// The type that a pointer points to; `None` for other types.
    #[must_use]
    pub fn pointee(&self, ty: TypeId) -> Option<QualifiedType> {
        match self.get(ty) {
            Type::Pointer(to) => Some(*to),
            _ => None,
        }
    }

    /// The elements of an array and their number; `None` for other types.
    #[must_use]
    pub fn array(&self, ty: TypeId) -> Option<(QualifiedType, Option<u32>)> {
        match self.get(ty) {
            Type::Array(element, length) => Some((*element, *length)),
            _ => None,
        }
    }

    /// The structure or union; `None` for other types.
    #[must_use]
    pub fn record_of(&self, ty: TypeId) -> Option<RecordId> {
        match self.get(ty) {
            Type::Record(record) => Some(*record),
            _ => None,
        }
    }

    /// The function type; `None` for other types.
    #[must_use]
    pub fn function(&self, ty: TypeId) -> Option<&FunctionType> {
        match self.get(ty) {
            Type::Function(function) => Some(function),
            _ => None,
        }
    }

    /// Reports whether it is a pointer.
    #[must_use]
    pub fn is_pointer(&self, ty: TypeId) -> bool {
        matches!(self.get(ty), Type::Pointer(_))
    }

    /// Reports whether a value of it is one number: arithmetic or a pointer.
    #[must_use]
    pub fn is_scalar(&self, ty: TypeId) -> bool {
        ty.is_arithmetic() || self.is_pointer(ty)
    }

    /// Reports whether it is a structure, union or array.
    #[must_use]
    pub fn is_aggregate(&self, ty: TypeId) -> bool {
        matches!(self.get(ty), Type::Record(_) | Type::Array(..))
    }

    /// Reports whether it is a function.
    #[must_use]
    pub fn is_function(&self, ty: TypeId) -> bool {
        matches!(self.get(ty), Type::Function(_))
    }

    /// The type of a parameter or value declared with `ty`: arrays and functions become pointers.
    pub fn decayed(&mut self, ty: QualifiedType) -> QualifiedType {
        match self.get(ty.ty) {
            Type::Array(element, _) => {
                let to = *element;
                QualifiedType::plain(self.intern(Type::Pointer(to)))
            }
            Type::Function(_) => QualifiedType::plain(self.pointer_to(ty.ty)),
            _ => ty,
        }
    }
}
