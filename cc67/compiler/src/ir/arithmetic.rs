//! Arithmetic on constants, with the results of the machine.
//!
//! `None` is the result of an operation that would trap, or of an operator that is not defined for such values.
//! Semantic analysis uses it to fold the constants of the source, and passes to fold those that they discover.

use std::ops::{Add, Div, Mul, Sub};

use vm::arith;

use super::operators::BinaryOp;

impl BinaryOp {
    /// The operators that floats have.
    pub(crate) fn on_floats<T>(self, a: T, b: T) -> Option<T>
    where
        T: Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>,
    {
        match self {
            Self::Add => Some(a + b),
            Self::Subtract => Some(a - b),
            Self::Multiply => Some(a * b),
            Self::Divide => Some(a / b),
            Self::DivideUnsigned
            | Self::Remainder
            | Self::RemainderUnsigned
            | Self::And
            | Self::Or
            | Self::Xor
            | Self::ShiftLeft
            | Self::ShiftRight
            | Self::ShiftRightUnsigned => None,
        }
    }

    /// The shifts of a 64-bit value.
    pub(crate) fn shifted_i64(self, a: i64, count: i32) -> Option<i64> {
        match self {
            Self::ShiftLeft => Some(arith::shl_i64(a, count)),
            Self::ShiftRight => Some(arith::shr_i64_s(a, count)),
            Self::ShiftRightUnsigned => Some(arith::shr_i64_u(a, count)),
            Self::Add
            | Self::Subtract
            | Self::Multiply
            | Self::Divide
            | Self::DivideUnsigned
            | Self::Remainder
            | Self::RemainderUnsigned
            | Self::And
            | Self::Or
            | Self::Xor => None,
        }
    }

    /// Every operator, on 32 bits.
    pub(crate) fn on_i32(self, a: i32, b: i32) -> Option<i32> {
        match self {
            Self::Add => Some(a.wrapping_add(b)),
            Self::Subtract => Some(a.wrapping_sub(b)),
            Self::Multiply => Some(a.wrapping_mul(b)),
            Self::Divide => arith::div_i32_s(a, b),
            Self::DivideUnsigned => arith::div_i32_u(a, b),
            Self::Remainder => arith::rem_i32_s(a, b),
            Self::RemainderUnsigned => arith::rem_i32_u(a, b),
            Self::And => Some(a & b),
            Self::Or => Some(a | b),
            Self::Xor => Some(a ^ b),
            Self::ShiftLeft => Some(arith::shl_i32(a, b)),
            Self::ShiftRight => Some(arith::shr_i32_s(a, b)),
            Self::ShiftRightUnsigned => Some(arith::shr_i32_u(a, b)),
        }
    }

    /// Every operator but the shifts, on 64 bits.
    pub(crate) fn on_i64(self, a: i64, b: i64) -> Option<i64> {
        match self {
            Self::Add => Some(a.wrapping_add(b)),
            Self::Subtract => Some(a.wrapping_sub(b)),
            Self::Multiply => Some(a.wrapping_mul(b)),
            Self::Divide => arith::div_i64_s(a, b),
            Self::DivideUnsigned => arith::div_i64_u(a, b),
            Self::Remainder => arith::rem_i64_s(a, b),
            Self::RemainderUnsigned => arith::rem_i64_u(a, b),
            Self::And => Some(a & b),
            Self::Or => Some(a | b),
            Self::Xor => Some(a ^ b),
            Self::ShiftLeft | Self::ShiftRight | Self::ShiftRightUnsigned => None,
        }
    }
}
