//! Literals: numbers, strings, `__func__`.

use super::Sema;
use super::constants::Constant;
use super::operands::Operand;
use super::places::TypedPlace;
use crate::ast::{Encoding, FloatingLiteral, IntegerLiteral, StringLiteral};
use crate::pp::Standard;
use crate::source::Span;
use crate::ty::{QualifiedType, Type, TypeId, Types};
use crate::typed::{PlaceKind, StaticData};

impl Sema<'_> {
    pub(super) fn integer_literal(&mut self, literal: IntegerLiteral, span: Span) -> Operand {
        let ty = integer_type(literal, self.standard);
        Operand::Value(self.body.int(literal.value.cast_signed(), ty, span))
    }

    pub(super) fn floating_literal(&mut self, literal: FloatingLiteral, span: Span) -> Operand {
        let ty = if literal.is_single { Types::FLOAT } else { Types::DOUBLE };
        Operand::Value(self.body.constant(Constant::Float(literal.value), ty, span))
    }

    /// A string: an anonymous array in `.data`, writable, never merged with another.
    pub(super) fn string_literal(&mut self, literal: &StringLiteral, span: Span) -> Operand {
        let ty = self.string_type(literal);
        Operand::Place(self.string_place(ty, || string_bytes(literal), span))
    }

    /// `__func__`
    pub(super) fn function_name(&mut self, span: Span) -> Operand {
        let mut bytes = self.body.name.clone().into_bytes();
        bytes.push(0);
        let element = QualifiedType::plain(Types::CHAR);
        let ty = self.types.intern(Type::Array(element, Some(bytes.len() as u32)));
        Operand::Place(self.string_place(ty, || bytes, span))
    }

    fn string_place(&mut self, ty: TypeId, bytes: impl FnOnce() -> Vec<u8>, span: Span) -> TypedPlace {
        let qualified = QualifiedType::plain(ty);
        if self.unevaluated > 0 {
            // Only the type is needed: nothing is added to `.data`.
            let nowhere = self.body.int(0, Types::INT, span);
            let place = self.body.place(PlaceKind::Pointer(nowhere, 0), ty, span);
            return TypedPlace { place, ty: qualified, is_lvalue: true };
        }
        let symbol = self.symbols.anonymous(ty, StaticData { bytes: bytes(), addresses: Vec::new() }, span);
        self.symbol_place(symbol, qualified, span)
    }

    /// The array type of a string with its NUL.
    pub(super) fn string_type(&mut self, literal: &StringLiteral) -> TypeId {
        let element = match literal.encoding {
            Encoding::Plain | Encoding::Utf8 => Types::CHAR,
            other => character_type(other),
        };
        let length = literal.elements.len() as u32 + 1;
        self.types.intern(Type::Array(QualifiedType::plain(element), Some(length)))
    }
}

/// The bytes of a string with its NUL.
pub(super) fn string_bytes(literal: &StringLiteral) -> Vec<u8> {
    let elements = literal.elements.iter().copied().chain([0]);
    elements.flat_map(|element| element.to_le_bytes().into_iter().take(literal.encoding.size())).collect()
}

/// The type of a character constant.
pub(super) const fn character_type(encoding: Encoding) -> TypeId {
    match encoding {
        Encoding::Plain | Encoding::Utf8 | Encoding::Wide => Types::INT,
        Encoding::Utf16 => Types::UNSIGNED_SHORT,
        Encoding::Utf32 => Types::UNSIGNED,
    }
}

/// The type of an integer constant. The vendor's rule is C90 with a 32-bit `long`, then `long long` (`dialect.md` 1.1):
/// decimal 2147483648 is `unsigned`. From C99 on a decimal constant without `u` is signed.
fn integer_type(literal: IntegerLiteral, standard: Standard) -> TypeId {
    let IntegerLiteral { value, is_unsigned, is_long_long, is_decimal } = literal;
    let may_be_unsigned = is_unsigned || !is_decimal || standard == Standard::Vendor;
    match (is_long_long, is_unsigned) {
        (false, false) if i32::try_from(value).is_ok() => Types::INT,
        (false, _) if may_be_unsigned && u32::try_from(value).is_ok() => Types::UNSIGNED,
        (_, false) if i64::try_from(value).is_ok() => Types::LONG_LONG,
        _ => Types::UNSIGNED_LONG_LONG,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_take_the_first_type_that_holds_them() {
        let check = |value, is_unsigned, is_long_long, expect| {
            let literal = IntegerLiteral { value, is_decimal: true, is_unsigned, is_long_long };
            assert_eq!(integer_type(literal, Standard::Vendor), expect, "{literal:?}");
        };
        check(0x7fff_ffff, false, false, Types::INT);
        check(0x8000_0000, false, false, Types::UNSIGNED);
        check(0x1_0000_0000, false, false, Types::LONG_LONG);
        check(u64::MAX, false, false, Types::UNSIGNED_LONG_LONG);
        check(1, true, false, Types::UNSIGNED);
        check(1, false, true, Types::LONG_LONG);
        check(1, true, true, Types::UNSIGNED_LONG_LONG);
    }

    #[test]
    fn decimal_constants_of_c99_are_signed() {
        let check = |is_decimal, is_unsigned, expect| {
            let literal = IntegerLiteral { value: 0x8000_0000, is_decimal, is_unsigned, is_long_long: false };
            assert_eq!(integer_type(literal, Standard::C99), expect, "{literal:?}");
        };
        check(true, false, Types::LONG_LONG);
        check(true, true, Types::UNSIGNED);
        check(false, false, Types::UNSIGNED);
    }
}
