//! Results of operators on constants, and cheaper operators with the same result.
//!
//! Constants are computed by [`vm::arith`], as on the machine; operations that would trap are left unchanged.

use vm::arith;

use crate::ir::inst::{Class, Constant, Operand};
use crate::ir::operators::{BinaryOp, CompareOp, ConvertOp, UnaryOp};

/// The replacement of an instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Simplification {
    /// Nothing better.
    No,
    /// A copy.
    Operand(Operand),
    /// Another operator.
    Binary(BinaryOp, Operand, Operand),
    /// Another comparison.
    Compare(CompareOp, Operand, Operand),
}

impl From<Option<Constant>> for Simplification {
    fn from(constant: Option<Constant>) -> Self {
        constant.map_or(Self::No, |constant| Self::Operand(constant.into()))
    }
}

pub(super) fn unary(op: UnaryOp, src: Operand) -> Simplification {
    let Operand::Constant(constant) = src else { return Simplification::No };
    Simplification::from(match (op, constant) {
        (UnaryOp::Negate, Constant::I32(value)) => Some(Constant::I32(value.wrapping_neg())),
        (UnaryOp::Negate, Constant::I64(value)) => Some(Constant::I64(value.wrapping_neg())),
        (UnaryOp::Negate, Constant::F32(bits)) => Some(Constant::F32(bits ^ (1 << 31))),
        (UnaryOp::Negate, Constant::F64(bits)) => Some(Constant::F64(bits ^ (1 << 63))),
        (UnaryOp::Complement, Constant::I32(value)) => Some(Constant::I32(!value)),
        (UnaryOp::Complement, Constant::I64(value)) => Some(Constant::I64(!value)),
        (UnaryOp::Complement, Constant::F32(_) | Constant::F64(_)) | (_, Constant::Symbol(..)) => None,
    })
}

pub(super) fn binary(op: BinaryOp, a: Operand, b: Operand, class: Class) -> Simplification {
    match (a, b) {
        (Operand::Constant(x), Operand::Constant(y)) => Simplification::from(binary_constant(op, x, y)),
        (Operand::Constant(_), Operand::Value(_)) if op.is_commutative() => match right_constant(op, b, a) {
            Simplification::No => Simplification::Binary(op, b, a),
            better @ (Simplification::Operand(_)
            | Simplification::Binary(..)
            | Simplification::Compare(..)) => better,
        },
        (Operand::Value(_), Operand::Constant(_)) => right_constant(op, a, b),
        (Operand::Value(x), Operand::Value(y)) if x == y && class.is_integer() => {
            simplify_equal_operands(op, a, class)
        }
        _ => Simplification::No,
    }
}

/// `a op a`
fn simplify_equal_operands(op: BinaryOp, a: Operand, class: Class) -> Simplification {
    match op {
        BinaryOp::Subtract | BinaryOp::Xor => Simplification::Operand(class.zero().into()),
        BinaryOp::And | BinaryOp::Or => Simplification::Operand(a),
        BinaryOp::Add
        | BinaryOp::Multiply
        | BinaryOp::Divide
        | BinaryOp::DivideUnsigned
        | BinaryOp::Remainder
        | BinaryOp::RemainderUnsigned
        | BinaryOp::ShiftLeft
        | BinaryOp::ShiftRight
        | BinaryOp::ShiftRightUnsigned => Simplification::No,
    }
}

/// `a op constant`
fn right_constant(op: BinaryOp, a: Operand, b: Operand) -> Simplification {
    let Operand::Constant(constant) = b else { return Simplification::No };
    let (number, is_long) = match constant {
        Constant::I32(value) => (i64::from(value), false),
        Constant::I64(value) => (value, true),
        Constant::F32(_) | Constant::F64(_) => return floating(op, a, constant),
        Constant::Symbol(..) => return Simplification::No,
    };
    if is_identity(op, number) {
        return Simplification::Operand(a);
    }
    if is_zero(op, number) {
        return Simplification::Operand(constant.class().zero().into());
    }
    if op == BinaryOp::Or && number == -1 {
        return Simplification::Operand(b);
    }
    if op == BinaryOp::Subtract && !is_long {
        return Simplification::Binary(BinaryOp::Add, a, Operand::int((number as i32).wrapping_neg()));
    }
    power_of_two(op, a, constant)
}

/// Reports whether `a op number` is 0.
const fn is_zero(op: BinaryOp, number: i64) -> bool {
    match op {
        BinaryOp::Multiply | BinaryOp::And => number == 0,
        BinaryOp::Remainder | BinaryOp::RemainderUnsigned => number == 1,
        BinaryOp::Add
        | BinaryOp::Subtract
        | BinaryOp::Divide
        | BinaryOp::DivideUnsigned
        | BinaryOp::Or
        | BinaryOp::Xor
        | BinaryOp::ShiftLeft
        | BinaryOp::ShiftRight
        | BinaryOp::ShiftRightUnsigned => false,
    }
}

/// Reports whether `a op number` is `a`.
const fn is_identity(op: BinaryOp, number: i64) -> bool {
    match op {
        BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Or | BinaryOp::Xor => number == 0,
        BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::DivideUnsigned => number == 1,
        BinaryOp::And => number == -1,
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight | BinaryOp::ShiftRightUnsigned => number == 0,
        BinaryOp::Remainder | BinaryOp::RemainderUnsigned => false,
    }
}

/// Multiplication and unsigned division by a power of two.
fn power_of_two(op: BinaryOp, a: Operand, constant: Constant) -> Simplification {
    let (bits, is_long) = match constant {
        Constant::I32(value) => (u64::from(value.cast_unsigned()), false),
        Constant::I64(value) => (value.cast_unsigned(), true),
        Constant::F32(_) | Constant::F64(_) | Constant::Symbol(..) => return Simplification::No,
    };
    if !bits.is_power_of_two() {
        return Simplification::No;
    }
    let shift = Operand::int(bits.trailing_zeros().cast_signed());
    let mask = bits - 1;
    let mask = if is_long { Constant::I64(mask.cast_signed()) } else { Constant::I32(mask as u32 as i32) };
    match op {
        BinaryOp::Multiply => Simplification::Binary(BinaryOp::ShiftLeft, a, shift),
        BinaryOp::DivideUnsigned => Simplification::Binary(BinaryOp::ShiftRightUnsigned, a, shift),
        BinaryOp::RemainderUnsigned => Simplification::Binary(BinaryOp::And, a, mask.into()),
        BinaryOp::Add
        | BinaryOp::Subtract
        | BinaryOp::Divide
        | BinaryOp::Remainder
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Xor
        | BinaryOp::ShiftLeft
        | BinaryOp::ShiftRight
        | BinaryOp::ShiftRightUnsigned => Simplification::No,
    }
}

/// Division by a floating power of two is a multiplication by its inverse, which is exact.
fn floating(op: BinaryOp, a: Operand, b: Constant) -> Simplification {
    let inverse = match b {
        Constant::F32(bits) => {
            let inverse = 1.0 / f32::from_bits(bits);
            let is_exact = bits & 0x007f_ffff == 0 && f32::from_bits(bits).is_normal() && inverse.is_normal();
            is_exact.then(|| Constant::F32(inverse.to_bits()))
        }
        Constant::F64(bits) => {
            let inverse = 1.0 / f64::from_bits(bits);
            let is_exact =
                bits & 0x000f_ffff_ffff_ffff == 0 && f64::from_bits(bits).is_normal() && inverse.is_normal();
            is_exact.then(|| Constant::F64(inverse.to_bits()))
        }
        Constant::I32(_) | Constant::I64(_) | Constant::Symbol(..) => None,
    };
    match inverse {
        Some(inverse) if op == BinaryOp::Divide => {
            Simplification::Binary(BinaryOp::Multiply, a, inverse.into())
        }
        Some(_) | None => Simplification::No,
    }
}

fn binary_constant(op: BinaryOp, a: Constant, b: Constant) -> Option<Constant> {
    match (a, b) {
        (Constant::I32(a), Constant::I32(b)) => op.on_i32(a, b).map(Constant::I32),
        (Constant::Symbol(symbol, offset), Constant::I32(bytes))
        | (Constant::I32(bytes), Constant::Symbol(symbol, offset))
            if op == BinaryOp::Add =>
        {
            Some(Constant::Symbol(symbol, offset.wrapping_add(bytes)))
        }
        (Constant::Symbol(symbol, offset), Constant::I32(bytes)) if op == BinaryOp::Subtract => {
            Some(Constant::Symbol(symbol, offset.wrapping_sub(bytes)))
        }
        (Constant::I64(a), Constant::I64(b)) => op.on_i64(a, b).map(Constant::I64),
        (Constant::I64(a), Constant::I32(count)) => op.shifted_i64(a, count).map(Constant::I64),
        (Constant::F32(a), Constant::F32(b)) => {
            let value = op.on_floats(f32::from_bits(a), f32::from_bits(b))?;
            // The bits of a NaN are the machine's business.
            (!value.is_nan()).then(|| Constant::F32(value.to_bits()))
        }
        (Constant::F64(a), Constant::F64(b)) => {
            let value = op.on_floats(f64::from_bits(a), f64::from_bits(b))?;
            (!value.is_nan()).then(|| Constant::F64(value.to_bits()))
        }
        _ => None,
    }
}

pub(super) fn compare(op: CompareOp, a: Operand, b: Operand) -> Simplification {
    let (Operand::Constant(a), Operand::Constant(b)) = (a, b) else {
        return match (a, b) {
            (Operand::Constant(_), Operand::Value(_)) if op.is_symmetric() => {
                Simplification::Compare(op, b, a)
            }
            _ => Simplification::No,
        };
    };
    let truth = match (a, b) {
        (Constant::I32(a), Constant::I32(b)) => {
            compare_integers(op, a.cmp(&b), a.cast_unsigned().cmp(&b.cast_unsigned()))
        }
        (Constant::I64(a), Constant::I64(b)) => {
            compare_integers(op, a.cmp(&b), a.cast_unsigned().cmp(&b.cast_unsigned()))
        }
        (Constant::F32(a), Constant::F32(b)) => {
            compare_floats(op, f64::from(f32::from_bits(a)), f64::from(f32::from_bits(b)))
        }
        (Constant::F64(a), Constant::F64(b)) => compare_floats(op, f64::from_bits(a), f64::from_bits(b)),
        _ => return Simplification::No,
    };
    Simplification::Operand(Operand::int(i32::from(truth)))
}

fn compare_integers(op: CompareOp, signed: std::cmp::Ordering, unsigned: std::cmp::Ordering) -> bool {
    match op {
        CompareOp::Equal => signed.is_eq(),
        CompareOp::NotEqual => signed.is_ne(),
        CompareOp::Less => signed.is_lt(),
        CompareOp::LessEqual => signed.is_le(),
        CompareOp::LessUnsigned => unsigned.is_lt(),
        CompareOp::LessEqualUnsigned => unsigned.is_le(),
    }
}

fn compare_floats(op: CompareOp, a: f64, b: f64) -> bool {
    match op {
        CompareOp::Equal => a == b,
        CompareOp::NotEqual => a != b,
        CompareOp::Less | CompareOp::LessUnsigned => a < b,
        CompareOp::LessEqual | CompareOp::LessEqualUnsigned => a <= b,
    }
}

pub(super) fn convert(op: ConvertOp, src: Operand) -> Simplification {
    let Operand::Constant(constant) = src else { return Simplification::No };
    Simplification::from(convert_constant(op, constant))
}

/// The result of converting a constant; `None` for the address of a symbol, and for a NaN.
fn convert_constant(op: ConvertOp, constant: Constant) -> Option<Constant> {
    let int = || if let Constant::I32(value) = constant { Some(value) } else { None };
    let unsigned = || int().map(i32::cast_unsigned);
    let long = || if let Constant::I64(value) = constant { Some(value) } else { None };
    let unsigned_long = || long().map(i64::cast_unsigned);
    let single = || if let Constant::F32(bits) = constant { Some(f32::from_bits(bits)) } else { None };
    let double = || if let Constant::F64(bits) = constant { Some(f64::from_bits(bits)) } else { None };
    let f32 = |value: f32| Constant::F32(value.to_bits());
    let f64 = |value: f64| Constant::F64(value.to_bits());
    match op {
        ConvertOp::SignExtend8 => int().map(|value| Constant::I32(i32::from(value as i8))),
        ConvertOp::ZeroExtend8 => int().map(|value| Constant::I32(i32::from(value as u8))),
        ConvertOp::SignExtend16 => int().map(|value| Constant::I32(i32::from(value as i16))),
        ConvertOp::ZeroExtend16 => int().map(|value| Constant::I32(i32::from(value as u16))),
        ConvertOp::I64FromI32 => int().map(|value| Constant::I64(i64::from(value))),
        ConvertOp::I64FromU32 => unsigned().map(|value| Constant::I64(i64::from(value))),
        ConvertOp::I32FromI64 => long().map(|value| Constant::I32(value as i32)),
        ConvertOp::F32FromI32 => int().map(|value| f32(value as f32)),
        ConvertOp::F32FromU32 => unsigned().map(|value| f32(value as f32)),
        ConvertOp::F32FromI64 => long().map(|value| f32(value as f32)),
        ConvertOp::F32FromU64 => unsigned_long().map(|value| f32(value as f32)),
        ConvertOp::F64FromI32 => int().map(|value| f64(f64::from(value))),
        ConvertOp::F64FromU32 => unsigned().map(|value| f64(f64::from(value))),
        ConvertOp::F64FromI64 => long().map(|value| f64(value as f64)),
        ConvertOp::F64FromU64 => unsigned_long().map(|value| f64(value as f64)),
        ConvertOp::F64FromF32 => single().filter(|value| !value.is_nan()).map(|value| f64(f64::from(value))),
        ConvertOp::F32FromF64 => double().filter(|value| !value.is_nan()).map(|value| f32(value as f32)),
        ConvertOp::I32FromF32 => single().map(|value| Constant::I32(arith::i32_from_f64_s(f64::from(value)))),
        ConvertOp::U32FromF32 => single().map(|value| Constant::I32(arith::i32_from_f64_u(f64::from(value)))),
        ConvertOp::I32FromF64 => double().map(|value| Constant::I32(arith::i32_from_f64_s(value))),
        ConvertOp::U32FromF64 => double().map(|value| Constant::I32(arith::i32_from_f64_u(value))),
        ConvertOp::I64FromF64 => double().map(|value| Constant::I64(arith::i64_from_f64_s(value))),
        ConvertOp::U64FromF64 => double().map(|value| Constant::I64(arith::i64_from_f64_u(value))),
    }
}
