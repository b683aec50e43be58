//! Constants and their arithmetic: folding is execution at another time.
//!
//! Integer results are `vm::arith`'s or plain wrapping arithmetic, as in the engines. An
//! integer constant is held sign- or zero-extended from its type; pointers count as
//! unsigned.

use vm::arith;

use crate::ir::operators as machine;
use crate::operators::{BinaryOp, CompareOp};
use crate::ty::{TypeId, Types};
use crate::typed::UnaryOp;

/// The value of a constant; its type is kept separately.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Constant {
    /// An integer or pointer.
    Int(i64),
    /// A floating-point number, exact in its type.
    Float(f64),
}

impl Constant {
    /// Reports whether it counts as true.
    pub(crate) fn is_true(self) -> bool {
        match self {
            Self::Int(value) => value != 0,
            Self::Float(value) => value != 0.0,
        }
    }
}

/// An integer truncated to the width of its type and extended again.
pub(crate) const fn truncate_to_type(value: i64, ty: TypeId) -> i64 {
    match ty {
        Types::BOOL => (value != 0) as i64,
        Types::CHAR | Types::SIGNED_CHAR => value as i8 as i64,
        Types::UNSIGNED_CHAR => value as u8 as i64,
        Types::SHORT => value as i16 as i64,
        Types::UNSIGNED_SHORT => value as u16 as i64,
        Types::INT => value as i32 as i64,
        Types::LONG_LONG | Types::UNSIGNED_LONG_LONG => value,
        _ => value as u32 as i64,
    }
}

/// A floating-point number rounded to its type.
fn round(value: f64, ty: TypeId) -> f64 {
    if ty == Types::FLOAT { f64::from(value as f32) } else { value }
}

/// A constant of type `from` as one of type `to`.
pub(crate) fn convert(constant: Constant, from: TypeId, to: TypeId) -> Constant {
    match constant {
        _ if to == Types::BOOL => Constant::Int(i64::from(constant.is_true())),
        Constant::Float(value) if to.is_floating() => Constant::Float(round(value, to)),
        Constant::Float(value) => Constant::Int(integer_from(value, to)),
        Constant::Int(value) if to.is_floating() => Constant::Float(float_from(value, from, to)),
        Constant::Int(value) => Constant::Int(truncate_to_type(value, to)),
    }
}

/// Toward zero; `char` and `short` go through `int` (`dialect.md` 1.4).
fn integer_from(value: f64, to: TypeId) -> i64 {
    match to {
        Types::UNSIGNED => truncate_to_type(i64::from(arith::i32_from_f64_u(value)), to),
        Types::LONG_LONG => arith::i64_from_f64_s(value),
        Types::UNSIGNED_LONG_LONG => arith::i64_from_f64_u(value),
        _ => truncate_to_type(i64::from(arith::i32_from_f64_s(value)), to),
    }
}

/// Rounded once, from the integer to the target type.
fn float_from(value: i64, from: TypeId, to: TypeId) -> f64 {
    match (from == Types::UNSIGNED_LONG_LONG, to == Types::FLOAT) {
        (false, false) => value as f64,
        (false, true) => f64::from(value as f32),
        (true, false) => value.cast_unsigned() as f64,
        (true, true) => f64::from(value.cast_unsigned() as f32),
    }
}

/// A unary operator on a constant of type `ty`.
pub(crate) fn unary(op: UnaryOp, constant: Constant, ty: TypeId) -> Option<Constant> {
    Some(match (op, constant) {
        (UnaryOp::Not, _) => Constant::Int(i64::from(!constant.is_true())),
        (UnaryOp::Negate, Constant::Int(value)) => Constant::Int(truncate_to_type(value.wrapping_neg(), ty)),
        (UnaryOp::Negate, Constant::Float(value)) => Constant::Float(-value),
        (UnaryOp::Complement, Constant::Int(value)) => Constant::Int(truncate_to_type(!value, ty)),
        (UnaryOp::Complement, Constant::Float(_)) => return None,
    })
}

/// A binary operator on two constants of type `ty`; `None` for a division by zero, which happens at run time.
pub(crate) fn binary(op: BinaryOp, a: Constant, b: Constant, ty: TypeId) -> Option<Constant> {
    match (a, b) {
        (Constant::Int(a), Constant::Int(b)) => {
            let op = machine::BinaryOp::of(op, ty != Types::INT && ty != Types::LONG_LONG);
            let value = match ty.is_long_long() {
                true if op.is_shift() => op.shifted_i64(a, b as i32)?,
                true => op.on_i64(a, b)?,
                false => i64::from(op.on_i32(a as i32, b as i32)?),
            };
            Some(Constant::Int(truncate_to_type(value, ty)))
        }
        (Constant::Float(a), Constant::Float(b)) => {
            let op = machine::BinaryOp::of(op, false);
            Some(Constant::Float(match ty == Types::FLOAT {
                true => f64::from(op.on_floats(a as f32, b as f32)?),
                false => op.on_floats(a, b)?,
            }))
        }
        _ => None,
    }
}

/// A comparison of two constants of type `ty`.
pub(crate) fn compare(op: CompareOp, a: Constant, b: Constant, ty: TypeId) -> Option<bool> {
    let order = match (a, b) {
        (Constant::Int(a), Constant::Int(b)) if ty == Types::UNSIGNED_LONG_LONG => {
            Some(a.cast_unsigned().cmp(&b.cast_unsigned()))
        }
        (Constant::Int(a), Constant::Int(b)) => Some(a.cmp(&b)),
        (Constant::Float(a), Constant::Float(b)) => a.partial_cmp(&b),
        _ => return None,
    };
    Some(op.holds(order))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn int(op: BinaryOp, a: i64, b: i64, ty: TypeId) -> Option<i64> {
        match binary(op, Constant::Int(a), Constant::Int(b), ty)? {
            Constant::Int(value) => Some(value),
            Constant::Float(_) => None,
        }
    }

    #[test]
    fn integers_wrap_and_divide_as_on_the_board() {
        let max = i64::from(i32::MAX);
        assert_eq!(int(BinaryOp::Add, max, 1, Types::INT), Some(i64::from(i32::MIN)));
        assert_eq!(int(BinaryOp::Subtract, 0, 1, Types::UNSIGNED), Some(0xffff_ffff));
        assert_eq!(int(BinaryOp::Divide, -7, 2, Types::INT), Some(-3));
        assert_eq!(int(BinaryOp::Divide, 0xffff_fff9, 2, Types::UNSIGNED), Some(0x7fff_fffc));
        assert_eq!(int(BinaryOp::Remainder, 5, 0, Types::INT), None);
        assert_eq!(int(BinaryOp::ShiftLeft, 1, 33, Types::INT), Some(0));
        assert_eq!(int(BinaryOp::ShiftLeft, 1, 33, Types::LONG_LONG), Some(1 << 33));
    }

    #[test]
    fn floats_round_to_their_type_and_saturate_as_integers() {
        let float = |value| Constant::Float(value);
        assert_eq!(convert(float(0.1), Types::DOUBLE, Types::FLOAT), float(f64::from(0.1f32)));
        assert_eq!(convert(float(1e10), Types::DOUBLE, Types::INT), Constant::Int(i64::from(i32::MAX)));
        assert_eq!(convert(float(-1.0), Types::DOUBLE, Types::UNSIGNED), Constant::Int(0xffff_ffff));
        assert_eq!(convert(float(300.0), Types::DOUBLE, Types::CHAR), Constant::Int(44));
        assert_eq!(
            convert(Constant::Int(0xffff_ffff), Types::UNSIGNED, Types::DOUBLE),
            float(4_294_967_295.0)
        );
        assert_eq!(convert(float(0.5), Types::DOUBLE, Types::BOOL), Constant::Int(1));
        let sum = binary(BinaryOp::Add, float(f64::from(0.1f32)), float(f64::from(0.2f32)), Types::FLOAT);
        assert_eq!(sum, Some(float(f64::from(0.1f32 + 0.2f32))));
    }

    #[test]
    fn comparisons_handle_unsigned_and_nan() {
        let (nan, one) = (Constant::Float(f64::NAN), Constant::Float(1.0));
        assert_eq!(compare(CompareOp::GreaterEqual, nan, one, Types::DOUBLE), Some(false));
        assert_eq!(compare(CompareOp::NotEqual, nan, nan, Types::DOUBLE), Some(true));
        let (minus, one) = (Constant::Int(-1), Constant::Int(1));
        assert_eq!(compare(CompareOp::Less, minus, one, Types::UNSIGNED_LONG_LONG), Some(false));
        assert_eq!(compare(CompareOp::Less, minus, one, Types::INT), Some(true));
    }
}
