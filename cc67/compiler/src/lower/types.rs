//! The machine's view of C types: class, width, signedness, size.

use crate::ir::inst::Class;
use crate::ir::operators::Width;
use crate::ty::{Type, TypeId, Types};

/// The class that holds a value of the type; `None` for `void` and structures.
pub(super) fn class(types: &Types, ty: TypeId) -> Option<Class> {
    match types.get(ty) {
        Type::Void | Type::Record(_) => None,
        Type::LongLong | Type::UnsignedLongLong => Some(Class::I64),
        Type::Float => Some(Class::F32),
        Type::Double => Some(Class::F64),
        _ => Some(Class::I32),
    }
}

/// The width with which a value of the type is loaded and stored; `None` for `void` and structures.
pub(super) fn width(types: &Types, ty: TypeId) -> Option<Width> {
    match types.get(ty) {
        Type::Void | Type::Record(_) => None,
        Type::Char | Type::SignedChar => Some(Width::I8),
        Type::Bool | Type::UnsignedChar => Some(Width::U8),
        Type::Short => Some(Width::I16),
        Type::UnsignedShort => Some(Width::U16),
        Type::LongLong | Type::UnsignedLongLong => Some(Width::I64),
        Type::Float => Some(Width::F32),
        Type::Double => Some(Width::F64),
        Type::Int | Type::Unsigned | Type::Pointer(_) | Type::Array(..) | Type::Function(_) => {
            Some(Width::I32)
        }
    }
}

/// Reports whether values of the type compare, divide, shift and widen as unsigned numbers. `char` and `short` have
/// been promoted where that matters, except in bit-fields.
pub(super) fn is_unsigned(types: &Types, ty: TypeId) -> bool {
    matches!(
        types.get(ty),
        Type::Bool
            | Type::UnsignedChar
            | Type::UnsignedShort
            | Type::Unsigned
            | Type::UnsignedLongLong
            | Type::Pointer(_)
    )
}

/// Size and alignment in bytes; 0 and 1 for types that have no objects.
pub(super) fn layout(types: &Types, ty: TypeId) -> (u32, u32) {
    (types.size_of(ty).unwrap_or(0), types.align_of(ty))
}
