//! Mathematics: the firmware's own results where they are known, otherwise `libm`, so that every host computes the
//! same.

use kmotiondef::GuestAddr;
use vm::arith::{self, WordDivision, canonical_f32, canonical_f64};
use vm::firmware::{Caller, PureFunction};
use vm::trap::TrapKind;

use super::costs;
use super::parts::Parts;
use crate::arithmetic::division::{divide, divide_singles};
use crate::arithmetic::{doubles, powers, singles};
use crate::servo::sine::two_phases;

/// A floating-point number whose NaNs can be made canonical: NaNs from `libm` differ between hosts.
trait Number {
    fn canonical(self) -> Self;
}

impl Number for f32 {
    fn canonical(self) -> Self {
        canonical_f32(self)
    }
}

impl Number for f64 {
    fn canonical(self) -> Self {
        canonical_f64(self)
    }
}

macro_rules! functions {
    ($($(#[$doc:meta])+ $name:ident($($x:ident),+) -> $ty:ty = $value:expr;)*) => {
        $($(#[$doc])+
        pub(crate) fn $name(_: &mut Parts, _: &mut Caller<'_>, $($x: $ty),+) -> $ty {
            Number::canonical($value)
        })*

        /// The function of this name, if it only computes.
        pub(crate) fn pure(name: &str) -> Option<PureFunction> {
            Some(match name {
                $(stringify!($name) => {
                    extern "C" fn compute($($x: $ty),+) -> $ty {
                        Number::canonical($value)
                    }
                    PureFunction::from(compute as extern "C" fn($($x: $ty),+) -> $ty)
                })*
                _ => return None,
            })
        }
    };
}

/// Functions whose cost depends on their arguments: an engine cannot call them without a caller that pays the cost.
macro_rules! varying {
    ($($(#[$doc:meta])+ $name:ident($($x:ident),+) -> $ty:ty = $value:expr, costs $cycles:expr;)*) => {
        $($(#[$doc])+
        pub(crate) fn $name(_: &mut Parts, caller: &mut Caller<'_>, $($x: $ty),+) -> $ty {
            costs::spend(caller, $cycles);
            Number::canonical($value)
        })*
    };
}

varying! {
    /// Arc sine.
    asin(x) -> f64 = doubles::asin(x), costs costs::ASIN.cost(x);
    /// Arc sine.
    asinf(x) -> f32 = singles::asin(x), costs costs::ASINF.cost(x.into());
    /// Arc cosine.
    acos(x) -> f64 = doubles::acos(x), costs costs::ACOS.cost(x);
    /// Arc cosine.
    acosf(x) -> f32 = singles::acos(x), costs costs::ACOSF.cost(x.into());
    /// Arc tangent.
    atan(x) -> f64 = doubles::atan(x), costs costs::of_arc_tangent(x);
    /// Arc tangent of y/x in all four quadrants.
    atan2(y, x) -> f64 = doubles::atan2(y, x), costs costs::of_direction(y, x);
}

functions! {
    /// Square root.
    sqrt(x) -> f64 = doubles::sqrt(x);
    /// Square root.
    sqrtf(x) -> f32 = singles::sqrt(x);
    /// e to the power x.
    exp(x) -> f64 = doubles::exp(x);
    /// e to the power x.
    expf(x) -> f32 = singles::exp(x);
    /// Natural logarithm.
    log(x) -> f64 = doubles::log(x);
    /// Natural logarithm.
    logf(x) -> f32 = singles::log(x);
    /// Logarithm to base 10.
    log10(x) -> f64 = doubles::log10(x);
    /// Logarithm to base 10.
    log10f(x) -> f32 = singles::log10(x);
    /// x to the power y.
    pow(x, y) -> f64 = powers::pow(x, y);
    /// x to the power y.
    powf(x, y) -> f32 = powers::powf(x, y);
    /// Sine.
    sin(x) -> f64 = doubles::sin(x);
    /// Sine.
    sinf(x) -> f32 = singles::sin(x);
    /// Cosine.
    cos(x) -> f64 = doubles::cos(x);
    /// Cosine.
    cosf(x) -> f32 = singles::cos(x);
    /// Cube root.
    cube_root(x) -> f64 = libm::cbrt(x);
    /// Tangent.
    tan(x) -> f64 = doubles::tan(x);
    /// Tangent.
    tanf(x) -> f32 = singles::tan(x);
    /// Arc tangent.
    atanf(x) -> f32 = singles::atan(x);
    /// Arc tangent of y/x in all four quadrants.
    atan2f(y, x) -> f32 = singles::atan2(y, x);
    /// Absolute value.
    fast_fabs(x) -> f64 = x.abs();
    /// Absolute value.
    fast_fabsf(x) -> f32 = x.abs();
    /// Absolute value.
    fabs(x) -> f64 = x.abs();
    /// Absolute value.
    fabsf(x) -> f32 = x.abs();
    /// 2 to the power x.
    exp2(x) -> f64 = doubles::exp2(x);
    /// 2 to the power x.
    exp2f(x) -> f32 = singles::exp2(x);
    /// 10 to the power x.
    exp10(x) -> f64 = doubles::exp10(x);
    /// 10 to the power x.
    exp10f(x) -> f32 = singles::exp10(x);
    /// Logarithm to base 2.
    log2(x) -> f64 = doubles::log2(x);
    /// Logarithm to base 2.
    log2f(x) -> f32 = singles::log2(x);
    /// Largest whole number not above x.
    floor(x) -> f64 = libm::floor(x);
    /// Largest whole number not above x.
    floorf(x) -> f32 = libm::floorf(x);
    /// Smallest whole number not below x.
    ceil(x) -> f64 = libm::ceil(x);
    /// Smallest whole number not below x.
    ceilf(x) -> f32 = libm::ceilf(x);
    /// Nearest whole number, halves away from zero.
    round(x) -> f64 = libm::round(x);
    /// Nearest whole number, halves away from zero.
    roundf(x) -> f32 = libm::roundf(x);
    /// Whole part.
    trunc(x) -> f64 = libm::trunc(x);
    /// Whole part.
    truncf(x) -> f32 = libm::truncf(x);
    /// Hyperbolic sine.
    sinh(x) -> f64 = libm::sinh(x);
    /// Hyperbolic sine.
    sinhf(x) -> f32 = libm::sinhf(x);
    /// Hyperbolic cosine.
    cosh(x) -> f64 = libm::cosh(x);
    /// Hyperbolic cosine.
    coshf(x) -> f32 = libm::coshf(x);
    /// Hyperbolic tangent.
    tanh(x) -> f64 = libm::tanh(x);
    /// Hyperbolic tangent.
    tanhf(x) -> f32 = libm::tanhf(x);
    /// Remainder of x/y with the sign of x.
    fmod(x, y) -> f64 = libm::fmod(x, y);
    /// Remainder of x/y with the sign of x.
    fmodf(x, y) -> f32 = libm::fmodf(x, y);
    /// Square root of x² + y².
    hypot(x, y) -> f64 = libm::hypot(x, y);
    /// Square root of x² + y².
    hypotf(x, y) -> f32 = libm::hypotf(x, y);
    /// Reciprocal of the square root.
    rsqrt(x) -> f64 = 1.0 / libm::sqrt(x);
    /// Reciprocal of the square root.
    rsqrtf(x) -> f32 = 1.0 / libm::sqrtf(x);
}

/// sin 2πx, and sin(2πx + 2π/3) into `*second`, for commutation.
pub(crate) fn sine_3ph(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    x: f32,
    second: GuestAddr,
) -> Result<f32, TrapKind> {
    let [first, ahead] = two_phases(x);
    caller.memory.store(second, ahead)?;
    Ok(first)
}

/// The fraction of a number, with its sign.
pub(crate) fn fractionf(_: &mut Parts, _: &mut Caller<'_>, v: f64) -> f32 {
    (v - libm::trunc(v)) as f32
}

/// The fraction of a number; its whole part into `*whole`.
pub(crate) fn modf(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    x: f64,
    whole: GuestAddr,
) -> Result<f64, TrapKind> {
    let (fraction, integer) = libm::modf(x);
    caller.memory.store(whole, integer)?;
    Ok(fraction)
}

/// The fraction of a number; its whole part into `*whole`.
pub(crate) fn modff(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    x: f32,
    whole: GuestAddr,
) -> Result<f32, TrapKind> {
    let (fraction, integer) = libm::modff(x);
    caller.memory.store(whole, integer)?;
    Ok(fraction)
}

/// Mantissa in [0.5, 1); the exponent into `*exponent`.
pub(crate) fn frexp(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    x: f64,
    exponent: GuestAddr,
) -> Result<f64, TrapKind> {
    let (mantissa, power) = libm::frexp(x);
    caller.memory.store(exponent, power)?;
    Ok(mantissa)
}

/// Mantissa in [0.5, 1); the exponent into `*exponent`.
pub(crate) fn frexpf(
    _: &mut Parts,
    caller: &mut Caller<'_>,
    x: f32,
    exponent: GuestAddr,
) -> Result<f32, TrapKind> {
    let (mantissa, power) = libm::frexpf(x);
    caller.memory.store(exponent, power)?;
    Ok(mantissa)
}

/// x·2ⁿ.
pub(crate) fn ldexp(_: &mut Parts, _: &mut Caller<'_>, x: f64, n: i32) -> f64 {
    libm::ldexp(x, n)
}

/// x·2ⁿ.
pub(crate) fn ldexpf(_: &mut Parts, _: &mut Caller<'_>, x: f32, n: i32) -> f32 {
    libm::ldexpf(x, n)
}

/// Quotient of two ints.
pub(crate) fn divi(_: &mut Parts, caller: &mut Caller<'_>, a: i32, b: i32) -> Result<i32, TrapKind> {
    or_by_zero(caller, arith::div_i32_s(a, b), WordDivision::Quotient, a)
}

/// Quotient of two unsigned ints.
pub(crate) fn divu(_: &mut Parts, caller: &mut Caller<'_>, a: u32, b: u32) -> Result<u32, TrapKind> {
    let (a, b) = (a.cast_signed(), b.cast_signed());
    or_by_zero(caller, arith::div_i32_u(a, b), WordDivision::UnsignedQuotient, a).map(i32::cast_unsigned)
}

/// Remainder of two ints.
pub(crate) fn remi(_: &mut Parts, caller: &mut Caller<'_>, a: i32, b: i32) -> Result<i32, TrapKind> {
    or_by_zero(caller, arith::rem_i32_s(a, b), WordDivision::Remainder, a)
}

/// Remainder of two unsigned ints.
pub(crate) fn remu(_: &mut Parts, caller: &mut Caller<'_>, a: u32, b: u32) -> Result<u32, TrapKind> {
    let (a, b) = (a.cast_signed(), b.cast_signed());
    or_by_zero(caller, arith::rem_i32_u(a, b), WordDivision::UnsignedRemainder, a).map(i32::cast_unsigned)
}

/// The result of a division of `a`, where `None` means division by zero.
fn or_by_zero(caller: &Caller<'_>, result: Option<i32>, op: WordDivision, a: i32) -> Result<i32, TrapKind> {
    result.map_or_else(|| caller.memory.divided_by_zero(op, a), Ok)
}

/// Quotient of two floats; by zero the not-a-number with the sign of the dividend, as on the board.
pub(crate) fn divf(_: &mut Parts, _: &mut Caller<'_>, a: f32, b: f32) -> f32 {
    if b == 0.0 {
        f32::from_bits(if a < 0.0 { 0xFFFF_FFFF } else { 0x7FFF_FFFF })
    } else {
        divide_singles(a, b)
    }
}

/// Quotient of two doubles; by zero the not-a-number with the sign of the dividend, as on the board.
pub(crate) fn divd(_: &mut Parts, _: &mut Caller<'_>, a: f64, b: f64) -> f64 {
    if b == 0.0 { f64::from_bits(if a < 0.0 { u64::MAX } else { u64::MAX >> 1 }) } else { divide(a, b) }
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::PERSIST;

    use crate::testing::TestBench;

    #[test]
    fn the_fraction_keeps_its_sign() {
        let mut bench = TestBench::new();
        for (v, expect) in [(-1.25, -0.25), (2.75, 0.75), (-0.25, -0.25), (5.0, 0.0)] {
            assert_eq!(bench.call_f32("fractionf", &[f64::to_bits(v)]), expect);
        }
    }

    #[test]
    fn the_second_phase_is_a_third_of_a_cycle_ahead() {
        let mut bench = TestBench::new();
        let address = PERSIST.address();
        let first = bench.call_f32("Sine3PH", &[u64::from(0.1_f32.to_bits()), address.get().into()]);
        let second: f32 = bench.memory.peek(address);
        assert!(
            (first - 0.587_785_2).abs() < 1e-6 && (second - 0.406_736_9).abs() < 1e-6,
            "{first} {second}"
        );
    }
}
