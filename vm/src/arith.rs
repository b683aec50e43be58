//! Arithmetic of the target, in one place.
//!
//! The interpreter executes with it, the compiler folds constants with it, the native engine's slow paths call it: so
//! the three agree by construction. Rules: `dialect.md` 1.4 of the specification.
//!
//! The bits of a NaN produced by an operation differ between processors, so every operation here yields the same NaN.

use std::hint::cold_path;

/// `value`, with every NaN replaced by the canonical NaN.
#[must_use]
#[inline]
pub const fn canonical_f32(value: f32) -> f32 {
    if value.is_nan() {
        cold_path();
        return f32::from_bits(0x7fc0_0000);
    }
    value
}

/// `value`, with every NaN replaced by the canonical NaN.
#[must_use]
#[inline]
pub const fn canonical_f64(value: f64) -> f64 {
    if value.is_nan() {
        cold_path();
        return f64::from_bits(0x7ff8_0000_0000_0000);
    }
    value
}

macro_rules! float_operations {
    ($($name:ident($ty:ty) = $operator:tt, $canonical:ident;)*) => {$(
        #[doc = concat!("`a ", stringify!($operator), " b`, rounded to nearest.")]
        #[must_use]
        #[inline]
        pub const fn $name(a: $ty, b: $ty) -> $ty {
            $canonical(a $operator b)
        }
    )*};
}
float_operations! {
    add_f32(f32) = +, canonical_f32;
    sub_f32(f32) = -, canonical_f32;
    mul_f32(f32) = *, canonical_f32;
    div_f32(f32) = /, canonical_f32;
    add_f64(f64) = +, canonical_f64;
    sub_f64(f64) = -, canonical_f64;
    mul_f64(f64) = *, canonical_f64;
    div_f64(f64) = /, canonical_f64;
}

/// Rounds to nearest.
#[must_use]
#[inline]
pub const fn f32_from_f64(value: f64) -> f32 {
    canonical_f32(value as f32)
}

/// Exactly.
#[must_use]
#[inline]
pub const fn f64_from_f32(value: f32) -> f64 {
    canonical_f64(value as f64)
}

/// Signed quotient toward zero; `None` for a zero divisor; `MIN / -1 == MIN`.
#[must_use]
#[inline]
pub const fn div_i32_s(a: i32, b: i32) -> Option<i32> {
    if b == 0 { None } else { Some(a.wrapping_div(b)) }
}

/// Unsigned quotient; `None` for a zero divisor.
#[must_use]
#[inline]
pub const fn div_i32_u(a: i32, b: i32) -> Option<i32> {
    if b == 0 { None } else { Some((a.cast_unsigned() / b.cast_unsigned()).cast_signed()) }
}

/// Remainder with the sign of `a`; `None` for a zero divisor; `MIN % -1 == 0`.
#[must_use]
#[inline]
pub const fn rem_i32_s(a: i32, b: i32) -> Option<i32> {
    if b == 0 { None } else { Some(a.wrapping_rem(b)) }
}

/// Unsigned remainder; `None` for a zero divisor.
#[must_use]
#[inline]
pub const fn rem_i32_u(a: i32, b: i32) -> Option<i32> {
    if b == 0 { None } else { Some((a.cast_unsigned() % b.cast_unsigned()).cast_signed()) }
}

/// A division of 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordDivision {
    /// [`div_i32_s`]
    Quotient,
    /// [`div_i32_u`]
    UnsignedQuotient,
    /// [`rem_i32_s`]
    Remainder,
    /// [`rem_i32_u`]
    UnsignedRemainder,
}

impl WordDivision {
    /// All divisions.
    pub const ALL: [Self; 4] =
        [Self::Quotient, Self::UnsignedQuotient, Self::Remainder, Self::UnsignedRemainder];

    /// The result of the firmware's routine for a division of `a` by zero.
    ///
    /// It subtracts and shifts once more than the dividend has bits, and zero can always be subtracted (`c67-subset.md`
    /// section 7; measured for what that section does not list).
    #[must_use]
    pub const fn by_zero(self, a: i32) -> i32 {
        let (quotient, remainder) = ones(a.unsigned_abs());
        let (quotient_u, remainder_u) = ones(a.cast_unsigned());
        match self {
            Self::Quotient | Self::Remainder if a == i32::MIN => 0,
            Self::Quotient if a < 0 => quotient.wrapping_neg().cast_signed(),
            Self::Quotient => quotient.cast_signed(),
            Self::UnsignedQuotient => quotient_u.cast_signed(),
            Self::Remainder if a < 0 => remainder.wrapping_neg().cast_signed(),
            Self::Remainder => remainder.cast_signed(),
            Self::UnsignedRemainder => remainder_u.cast_signed(),
        }
    }
}

/// Quotient and remainder after as many steps as `a` has bits, and one.
const fn ones(a: u32) -> (u32, u32) {
    let steps = u32::BITS - a.leading_zeros() + 1;
    if steps >= u32::BITS {
        return (u32::MAX, 0);
    }
    ((1 << steps) - 1, a << steps >> steps)
}

/// The shift count that the processor sees: modulo 64, and whether it reaches the width of 32.
const fn shift_count(count: i32) -> (u32, bool) {
    let count = count.cast_unsigned() & 63;
    (count & 31, count >= 32)
}

/// Left shift by `count` modulo 64; 0 from 32 on.
#[must_use]
#[inline]
pub const fn shl_i32(a: i32, count: i32) -> i32 {
    let (count, all) = shift_count(count);
    if all { 0 } else { a.wrapping_shl(count) }
}

/// Arithmetic right shift by `count` modulo 64; only sign bits remain from 32 on.
#[must_use]
#[inline]
pub const fn shr_i32_s(a: i32, count: i32) -> i32 {
    let (count, all) = shift_count(count);
    if all { a >> 31 } else { a >> count }
}

/// Logical right shift by `count` modulo 64; 0 from 32 on.
#[must_use]
#[inline]
pub const fn shr_i32_u(a: i32, count: i32) -> i32 {
    let (count, all) = shift_count(count);
    if all { 0 } else { (a.cast_unsigned() >> count).cast_signed() }
}

/// Signed quotient toward zero; `None` for a zero divisor; `MIN / -1 == MIN`.
#[must_use]
#[inline]
pub const fn div_i64_s(a: i64, b: i64) -> Option<i64> {
    if b == 0 { None } else { Some(a.wrapping_div(b)) }
}

/// Unsigned quotient; `None` for a zero divisor.
#[must_use]
#[inline]
pub const fn div_i64_u(a: i64, b: i64) -> Option<i64> {
    if b == 0 { None } else { Some((a.cast_unsigned() / b.cast_unsigned()).cast_signed()) }
}

/// Remainder with the sign of `a`; `None` for a zero divisor; `MIN % -1 == 0`.
#[must_use]
#[inline]
pub const fn rem_i64_s(a: i64, b: i64) -> Option<i64> {
    if b == 0 { None } else { Some(a.wrapping_rem(b)) }
}

/// Unsigned remainder; `None` for a zero divisor.
#[must_use]
#[inline]
pub const fn rem_i64_u(a: i64, b: i64) -> Option<i64> {
    if b == 0 { None } else { Some((a.cast_unsigned() % b.cast_unsigned()).cast_signed()) }
}

/// Left shift by `count` modulo 64.
#[must_use]
#[inline]
pub const fn shl_i64(a: i64, count: i32) -> i64 {
    a.wrapping_shl(count.cast_unsigned() & 63)
}

/// Arithmetic right shift by `count` modulo 64.
#[must_use]
#[inline]
pub const fn shr_i64_s(a: i64, count: i32) -> i64 {
    a.wrapping_shr(count.cast_unsigned() & 63)
}

/// Logical right shift by `count` modulo 64.
#[must_use]
#[inline]
pub const fn shr_i64_u(a: i64, count: i32) -> i64 {
    a.cast_unsigned().wrapping_shr(count.cast_unsigned() & 63).cast_signed()
}

/// Toward zero, saturating; NaN gives `i32::MAX`.
#[must_use]
#[inline]
pub const fn i32_from_f64_s(value: f64) -> i32 {
    if value.is_nan() { i32::MAX } else { value as i32 }
}

/// Toward zero, modulo 2³²; NaN and infinities give 0.
#[must_use]
#[inline]
pub fn i32_from_f64_u(value: f64) -> i32 {
    i64_from_f64_u(value) as i32
}

/// Toward zero, saturating; NaN gives `i64::MAX`.
#[must_use]
#[inline]
pub const fn i64_from_f64_s(value: f64) -> i64 {
    if value.is_nan() { i64::MAX } else { value as i64 }
}

/// Toward zero, modulo 2⁶⁴; NaN and infinities give 0.
#[must_use]
#[inline]
pub fn i64_from_f64_u(value: f64) -> i64 {
    if !value.is_finite() {
        return 0;
    }
    const TWO_64: f64 = 18_446_744_073_709_551_616.0;
    // The remainder of a division by a power of two is exact.
    let wrapped = libm::fmod(libm::trunc(value), TWO_64);
    if wrapped < 0.0 {
        ((-wrapped) as u64).wrapping_neg().cast_signed()
    } else {
        (wrapped as u64).cast_signed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_division_by_zero_yields_what_the_released_firmware_yields() {
        // Each by zero: dividend, quotient, remainder, unsigned quotient, unsigned remainder.
        const MEASURED: [[u32; 5]; 16] = [
            [0, 1, 0, 1, 0],
            [1, 3, 1, 3, 1],
            [5, 0xF, 5, 0xF, 5],
            [8, 0x1F, 8, 0x1F, 8],
            [0x64, 0xFF, 0x64, 0xFF, 0x64],
            [0xFFFF_FFFF, 0xFFFF_FFFD, 0xFFFF_FFFF, 0xFFFF_FFFF, 0],
            [0xFFFF_FFFB, 0xFFFF_FFF1, 0xFFFF_FFFB, 0xFFFF_FFFF, 0],
            [0xFFFF_FF9C, 0xFFFF_FF01, 0xFFFF_FF9C, 0xFFFF_FFFF, 0],
            [0xFFFF, 0x1_FFFF, 0x7FFF, 0x1_FFFF, 0x7FFF],
            [0x1_0000, 0x3_FFFF, 0, 0x3_FFFF, 0],
            [0x3FFF_FFFF, 0x7FFF_FFFF, 1, 0x7FFF_FFFF, 1],
            [0x4000_0000, 0xFFFF_FFFF, 0, 0xFFFF_FFFF, 0],
            [0x7FFF_FFFF, 0xFFFF_FFFF, 0, 0xFFFF_FFFF, 0],
            [0x8000_0000, 0, 0, 0xFFFF_FFFF, 0],
            [0x8000_0001, 1, 0, 0xFFFF_FFFF, 0],
            [0xC000_0000, 1, 0, 0xFFFF_FFFF, 0],
        ];
        use WordDivision::{Quotient, Remainder, UnsignedQuotient, UnsignedRemainder};
        for [a, quotient, remainder, unsigned, rest] in MEASURED {
            let of = |op: WordDivision| op.by_zero(a.cast_signed()).cast_unsigned();
            let found = [Quotient, Remainder, UnsignedQuotient, UnsignedRemainder].map(of);
            assert_eq!(found, [quotient, remainder, unsigned, rest], "{a:#x}");
        }
    }

    #[test]
    fn division_is_toward_zero_and_never_overflows() {
        assert_eq!((div_i32_s(-7, 2), rem_i32_s(-7, 2)), (Some(-3), Some(-1)));
        assert_eq!((div_i32_s(7, -2), rem_i32_s(7, -2)), (Some(-3), Some(1)));
        assert_eq!((div_i32_s(i32::MIN, -1), rem_i32_s(i32::MIN, -1)), (Some(i32::MIN), Some(0)));
        assert_eq!((div_i32_s(5, 0), rem_i32_u(5, 0)), (None, None));
        assert_eq!(div_i32_u(-1, 2), Some(0x7fff_ffff));
    }

    #[test]
    fn every_nan_is_the_same() {
        let negative = f64::from_bits(0xfff8_0000_0000_0001);
        for value in [div_f64(0.0, 0.0), sub_f64(f64::INFINITY, f64::INFINITY), add_f64(negative, 1.0)] {
            assert_eq!(value.to_bits(), 0x7ff8_0000_0000_0000);
        }
        assert_eq!(f32_from_f64(negative).to_bits(), 0x7fc0_0000);
        assert_eq!(f64_from_f32(mul_f32(f32::INFINITY, 0.0)).to_bits(), 0x7ff8_0000_0000_0000);
    }

    #[test]
    fn shift_counts_are_modulo_64() {
        assert_eq!((shl_i32(1, 33), shl_i32(1, 65), shl_i32(1, -1)), (0, 2, 0));
        assert_eq!((shr_i32_s(-8, 40), shr_i32_s(-8, 64), shr_i32_u(-8, 40)), (-1, -8, 0));
    }

    #[test]
    fn float_to_int_saturates_and_to_unsigned_wraps() {
        assert_eq!(i32_from_f64_s(1e10), i32::MAX);
        assert_eq!(i32_from_f64_s(-1e10), i32::MIN);
        assert_eq!(i32_from_f64_s(f64::NAN), i32::MAX);
        assert_eq!(i32_from_f64_u(4_294_967_295.0), -1);
        assert_eq!(i32_from_f64_u(-1.0), -1);
        assert_eq!(i32_from_f64_u(4_294_967_298.5), 2);
        assert_eq!(i64_from_f64_u(-2.5), -2);
    }
}
