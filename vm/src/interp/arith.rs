//! Constants, copies, arithmetic, comparisons and conversions.

use std::convert::identity;
use std::ops::{BitAnd, BitOr, BitXor, Neg};

use super::activation::Activation;
use crate::arith::{self, WordDivision};
use crate::operand::{Bits32, Imm, Imm16, Pool, RegF32, RegF64, RegI32, RegI64};
use crate::slot::Slot;
use crate::trap::TrapKind;

/// `name: operand classes -> class = function of the operands`, total or `None` for division by zero. A 32-bit division
/// also names the operation, for the result that the firmware yields for a zero divisor.
macro_rules! operations {
    (unary { $($un:ident: $un_src:ident -> $un_dst:ident = $un_fn:expr;)* }
     binary { $($bin:ident: $bin_a:ident, $bin_b:ident -> $bin_dst:ident = $bin_fn:expr;)* }
     divide { $($div:ident = $div_fn:expr, by zero $op:ident;)* }
     divide_long { $($long:ident = $long_fn:expr;)* }) => {
        impl Activation<'_, '_> {
            $(#[inline(always)]
            pub(super) fn $un(&mut self, dst: $un_dst, src: $un_src) {
                self.set(dst, $un_fn(self.get(src)));
            })*

            $(#[inline(always)]
            pub(super) fn $bin(&mut self, dst: $bin_dst, a: $bin_a, b: $bin_b) {
                self.set(dst, $bin_fn(self.get(a), self.get(b)));
            })*

            $(#[inline(always)]
            pub(super) fn $div(&mut self, dst: RegI32, a: RegI32, b: RegI32) -> Result<(), TrapKind> {
                let result = match $div_fn(self.get(a), self.get(b)) {
                    Some(result) => result,
                    None => self.state.ram.divided_by_zero(WordDivision::$op, self.get(a))?,
                };
                self.set(dst, result);
                Ok(())
            })*

            $(#[inline(always)]
            pub(super) fn $long(&mut self, dst: RegI64, a: RegI64, b: RegI64) -> Result<(), TrapKind> {
                let result = $long_fn(self.get(a), self.get(b)).ok_or(TrapKind::DivisionByZero)?;
                self.set(dst, result);
                Ok(())
            })*
        }
    };
}
operations! {
    unary {
        mov_i32: RegI32 -> RegI32 = identity;
        mov_i64: RegI64 -> RegI64 = identity;
        mov_f32: RegF32 -> RegF32 = identity;
        mov_f64: RegF64 -> RegF64 = identity;
        ext8_s: RegI32 -> RegI32 = |v: i32| i32::from(v as i8);
        ext8_u: RegI32 -> RegI32 = |v: i32| i32::from(v as u8);
        ext16_s: RegI32 -> RegI32 = |v: i32| i32::from(v as i16);
        ext16_u: RegI32 -> RegI32 = |v: i32| i32::from(v as u16);
        neg_f32: RegF32 -> RegF32 = f32::neg;
        neg_f64: RegF64 -> RegF64 = f64::neg;
        i64_from_i32_s: RegI32 -> RegI64 = i64::from;
        i64_from_i32_u: RegI32 -> RegI64 = |v: i32| i64::from(v.cast_unsigned());
        i32_from_i64: RegI64 -> RegI32 = |v: i64| v as i32;
        f32_from_i32_s: RegI32 -> RegF32 = |v: i32| v as f32;
        f32_from_i32_u: RegI32 -> RegF32 = |v: i32| v.cast_unsigned() as f32;
        f32_from_i64_s: RegI64 -> RegF32 = |v: i64| v as f32;
        f32_from_i64_u: RegI64 -> RegF32 = |v: i64| v.cast_unsigned() as f32;
        f64_from_i32_s: RegI32 -> RegF64 = f64::from;
        f64_from_i32_u: RegI32 -> RegF64 = |v: i32| f64::from(v.cast_unsigned());
        f64_from_i64_s: RegI64 -> RegF64 = |v: i64| v as f64;
        f64_from_i64_u: RegI64 -> RegF64 = |v: i64| v.cast_unsigned() as f64;
        f64_from_f32: RegF32 -> RegF64 = arith::f64_from_f32;
        f32_from_f64: RegF64 -> RegF32 = arith::f32_from_f64;
        i32_from_f32_s: RegF32 -> RegI32 = |v: f32| arith::i32_from_f64_s(f64::from(v));
        i32_from_f32_u: RegF32 -> RegI32 = |v: f32| arith::i32_from_f64_u(f64::from(v));
        i32_from_f64_s: RegF64 -> RegI32 = arith::i32_from_f64_s;
        i32_from_f64_u: RegF64 -> RegI32 = arith::i32_from_f64_u;
        i64_from_f64_s: RegF64 -> RegI64 = arith::i64_from_f64_s;
        i64_from_f64_u: RegF64 -> RegI64 = arith::i64_from_f64_u;
    }
    binary {
        add_i32: RegI32, RegI32 -> RegI32 = i32::wrapping_add;
        sub_i32: RegI32, RegI32 -> RegI32 = i32::wrapping_sub;
        mul_i32: RegI32, RegI32 -> RegI32 = i32::wrapping_mul;
        and_i32: RegI32, RegI32 -> RegI32 = i32::bitand;
        or_i32: RegI32, RegI32 -> RegI32 = i32::bitor;
        xor_i32: RegI32, RegI32 -> RegI32 = i32::bitxor;
        shl_i32: RegI32, RegI32 -> RegI32 = arith::shl_i32;
        shr_i32_s: RegI32, RegI32 -> RegI32 = arith::shr_i32_s;
        shr_i32_u: RegI32, RegI32 -> RegI32 = arith::shr_i32_u;
        eq_i32: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a == b);
        ne_i32: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a != b);
        lt_i32_s: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a < b);
        le_i32_s: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a <= b);
        lt_i32_u: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a.cast_unsigned() < b.cast_unsigned());
        le_i32_u: RegI32, RegI32 -> RegI32 = |a: i32, b: i32| i32::from(a.cast_unsigned() <= b.cast_unsigned());
        add_i64: RegI64, RegI64 -> RegI64 = i64::wrapping_add;
        sub_i64: RegI64, RegI64 -> RegI64 = i64::wrapping_sub;
        mul_i64: RegI64, RegI64 -> RegI64 = i64::wrapping_mul;
        and_i64: RegI64, RegI64 -> RegI64 = i64::bitand;
        or_i64: RegI64, RegI64 -> RegI64 = i64::bitor;
        xor_i64: RegI64, RegI64 -> RegI64 = i64::bitxor;
        shl_i64: RegI64, RegI32 -> RegI64 = arith::shl_i64;
        shr_i64_s: RegI64, RegI32 -> RegI64 = arith::shr_i64_s;
        shr_i64_u: RegI64, RegI32 -> RegI64 = arith::shr_i64_u;
        eq_i64: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a == b);
        ne_i64: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a != b);
        lt_i64_s: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a < b);
        le_i64_s: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a <= b);
        lt_i64_u: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a.cast_unsigned() < b.cast_unsigned());
        le_i64_u: RegI64, RegI64 -> RegI32 = |a: i64, b: i64| i32::from(a.cast_unsigned() <= b.cast_unsigned());
        add_f32: RegF32, RegF32 -> RegF32 = arith::add_f32;
        sub_f32: RegF32, RegF32 -> RegF32 = arith::sub_f32;
        mul_f32: RegF32, RegF32 -> RegF32 = arith::mul_f32;
        div_f32: RegF32, RegF32 -> RegF32 = arith::div_f32;
        eq_f32: RegF32, RegF32 -> RegI32 = |a: f32, b: f32| i32::from(a == b);
        ne_f32: RegF32, RegF32 -> RegI32 = |a: f32, b: f32| i32::from(a != b);
        lt_f32: RegF32, RegF32 -> RegI32 = |a: f32, b: f32| i32::from(a < b);
        le_f32: RegF32, RegF32 -> RegI32 = |a: f32, b: f32| i32::from(a <= b);
        add_f64: RegF64, RegF64 -> RegF64 = arith::add_f64;
        sub_f64: RegF64, RegF64 -> RegF64 = arith::sub_f64;
        mul_f64: RegF64, RegF64 -> RegF64 = arith::mul_f64;
        div_f64: RegF64, RegF64 -> RegF64 = arith::div_f64;
        eq_f64: RegF64, RegF64 -> RegI32 = |a: f64, b: f64| i32::from(a == b);
        ne_f64: RegF64, RegF64 -> RegI32 = |a: f64, b: f64| i32::from(a != b);
        lt_f64: RegF64, RegF64 -> RegI32 = |a: f64, b: f64| i32::from(a < b);
        le_f64: RegF64, RegF64 -> RegI32 = |a: f64, b: f64| i32::from(a <= b);
    }
    divide {
        div_i32_s = arith::div_i32_s, by zero Quotient;
        div_i32_u = arith::div_i32_u, by zero UnsignedQuotient;
        rem_i32_s = arith::rem_i32_s, by zero Remainder;
        rem_i32_u = arith::rem_i32_u, by zero UnsignedRemainder;
    }
    divide_long {
        div_i64_s = arith::div_i64_s;
        div_i64_u = arith::div_i64_u;
        rem_i64_s = arith::rem_i64_s;
        rem_i64_u = arith::rem_i64_u;
    }
}

/// Operations of 32 bits with an immediate.
macro_rules! immediates {
    ($($name:ident = $function:expr;)*) => {
        impl Activation<'_, '_> {
            $(#[inline(always)]
            pub(super) fn $name(&mut self, dst: RegI32, a: RegI32, imm: Imm16) {
                self.set(dst, $function(self.get(a), i32::from(imm.0)));
            })*
        }
    };
}
immediates! {
    add_i32_imm = i32::wrapping_add;
    mul_i32_imm = i32::wrapping_mul;
    and_i32_imm = i32::bitand;
    shl_i32_imm = arith::shl_i32;
    shr_i32_s_imm = arith::shr_i32_s;
    shr_i32_u_imm = arith::shr_i32_u;
}

impl Activation<'_, '_> {
    #[inline(always)]
    pub(super) fn const_i32(&mut self, dst: RegI32, imm: Imm) {
        self.set(dst, imm.0);
    }

    #[inline(always)]
    pub(super) fn const_i64(&mut self, dst: RegI64, pool: Pool) {
        let slot = self.state.program.pool[pool.0 as usize];
        self.set(dst, i64::from_slot(slot));
    }

    #[inline(always)]
    pub(super) fn const_f32(&mut self, dst: RegF32, bits: Bits32) {
        self.set(dst, f32::from_bits(bits.0));
    }

    #[inline(always)]
    pub(super) fn const_f64(&mut self, dst: RegF64, pool: Pool) {
        let slot = self.state.program.pool[pool.0 as usize];
        self.set(dst, f64::from_slot(slot));
    }
}
