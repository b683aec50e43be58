//! Functions of singles, as the firmware's library computes them.
//!
//! Exponentials and logarithms take their last steps in doubles. Coefficients and the order of the operations are those
//! of the released firmware; the board tests measure the share of identical results.

#![expect(clippy::approx_constant, reason = "constants of the board have digits of their own")]

use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, LN_10, LOG2_E, LOG10_E, PI};

use super::division::{divide_singles, reciprocal_of_single, square_root};

/// π in two parts, of which the first has few digits.
const PI_HIGH: f32 = 3.140_625;
const PI_LOW: f32 = 9.676_536e-4;
/// Below this the sine is its angle.
const SMALL_ANGLE: f32 = 2.441_406_2e-4;

/// A polynomial by Horner's rule; its first coefficient is the constant.
fn polynomial(coefficients: &[f32], x: f32) -> f32 {
    coefficients.iter().rev().copied().reduce(|sum, coefficient| sum * x + coefficient).unwrap_or(0.0)
}

/// A number as the processor's arithmetic takes it: one that is denormal is 0.
pub(super) fn flushed(x: f32) -> f32 {
    if x.is_subnormal() { 0.0 } else { x }
}

/// The sine of an angle that is not below 0, and its sign.
fn sine(angle: f32, sign: f32) -> f32 {
    const EVEN: [f32; 2] = [-0.166_666_57, -0.198_074_18e-3];
    const ODD: [f32; 2] = [0.833_302_55e-2, 0.260_190_31e-5];
    const TOO_LARGE: f32 = 2_097_152.0;
    if angle >= TOO_LARGE || angle.is_nan() {
        return 0.0;
    }
    let half_turns = libm::rintf(angle * FRAC_1_PI);
    let sign = if libm::fmodf(half_turns, 2.0) == 0.0 { sign } else { -sign };
    let rest = (angle - PI_HIGH * half_turns) - PI_LOW * half_turns;
    if rest.abs() < SMALL_ANGLE {
        return sign * rest;
    }
    let square = rest * rest;
    let fourth = square * square;
    let change = fourth * polynomial(&ODD, fourth) + polynomial(&EVEN, fourth) * square;
    sign * (rest + rest * change)
}

pub(crate) fn sin(x: f32) -> f32 {
    sine(flushed(x.abs()), if x.is_sign_negative() { -1.0 } else { 1.0 })
}

pub(crate) fn cos(x: f32) -> f32 {
    sine(x.abs() + FRAC_PI_2, 1.0)
}

pub(crate) fn tan(x: f32) -> f32 {
    const P: f32 = -0.958_017_7e-1;
    const Q: [f32; 2] = [-0.429_135_77, 0.971_685_8e-2];
    const HALF_PI_HIGH: f32 = 1.570_312_5;
    const HALF_PI_LOW: f32 = 4.838_268e-4;
    let x = flushed(x);
    let product = FRAC_2_PI * x;
    let quarters = libm::truncf(if product < 0.0 { product - 0.5 } else { product + 0.5 });
    let whole = libm::truncf(x);
    let rest = ((x - whole) + (whole - HALF_PI_HIGH * quarters)) - HALF_PI_LOW * quarters;
    let rest = rest.clamp(-FRAC_PI_4, FRAC_PI_4);
    let square = rest * rest;
    let numerator = rest + rest * (P * square);
    let denominator = 0.5 + (0.5 + square * polynomial(&Q, square));
    if libm::fmodf(quarters, 2.0) == 0.0 {
        divide_singles(numerator, denominator)
    } else if numerator == 0.0 {
        f32::MAX
    } else {
        -divide_singles(denominator, numerator)
    }
}

/// The arc sine of a number up to one half, and twice the arc sine of a root.
fn arc(x: f32, square: f32) -> f32 {
    const COEFFICIENTS: [f32; 4] = [0.166_651_64, 0.075_464_79, 0.039_721_135, 0.050_505_362];
    x * (square * polynomial(&COEFFICIENTS, square)) + x
}

/// −2 arcsin √((1 − x)/2), which is the arc sine of `x` less a quarter of a turn.
fn beyond_half(x: f32) -> f32 {
    let square = 0.5 * (0.5 + (0.5 - x));
    arc(-2.0 * sqrt(square), square)
}

/// The arc sine; outside of its domain, the arc sine of the nearest number inside.
pub(crate) fn asin(x: f32) -> f32 {
    let x = flushed(x);
    let magnitude = x.abs().min(1.0);
    let angle = if magnitude <= 0.5 {
        arc(magnitude, magnitude * magnitude)
    } else {
        (beyond_half(magnitude) + FRAC_PI_4) + FRAC_PI_4
    };
    if x < 0.0 { -angle } else { angle }
}

/// The arc cosine; outside of its domain, the arc cosine of the nearest number inside.
pub(crate) fn acos(x: f32) -> f32 {
    let magnitude = x.abs().min(1.0);
    if magnitude <= 0.5 {
        let angle = arc(magnitude, magnitude * magnitude);
        (FRAC_PI_4 - if x < 0.0 { -angle } else { angle }) + FRAC_PI_4
    } else if x < 0.0 {
        (beyond_half(magnitude) + FRAC_PI_2) + FRAC_PI_2
    } else {
        -beyond_half(magnitude)
    }
}

/// The arc tangent of a quotient up to about 1.
fn arc_tangent(x: f32) -> f32 {
    let second = x * x;
    let fourth = second * second;
    let (sixth, eighth) = (second * fourth, fourth * fourth);
    let (tenth, twelfth) = (sixth * fourth, eighth * fourth);
    let low =
        (fourth * 0.199_893_01 + -0.333_329_3 * second) + (0.105_214_99 * eighth + -0.141_750_77 * sixth);
    let highest = 0.039_370_88 + (0.002_301_582_1 * fourth + -0.013_945_51 * second);
    (low + (highest * twelfth + -0.072_356_69 * tenth)) * x + x
}

pub(crate) fn atan(x: f32) -> f32 {
    /// The quotients below and above which the result is known, and the quotient from which the reciprocal is used.
    const SMALL: f32 = 1.220_703_1e-4;
    const LARGE: f32 = 67_108_864.0;
    const INVERTED: f32 = 1.05;
    let magnitude = x.abs();
    if magnitude < SMALL {
        x
    } else if magnitude >= LARGE {
        libm::copysignf(FRAC_PI_2, x)
    } else if magnitude > INVERTED {
        libm::copysignf(FRAC_PI_2, x) - arc_tangent(divide_singles(1.0, x))
    } else {
        arc_tangent(x)
    }
}

/// The angle of a point in all four quadrants.
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    let [y, x] = [y, x].map(flushed);
    // Board quirk: the angle of a point on the negative axis is 0.
    if y == 0.0 {
        return 0.0;
    }
    if x == 0.0 {
        return libm::copysignf(FRAC_PI_2, y);
    }
    if x.abs() < y.abs() {
        return libm::copysignf(FRAC_PI_2, y) - arc_tangent(quotient(x, y));
    }
    let start = if x < 0.0 { libm::copysignf(PI, y) } else { 0.0 };
    start + arc_tangent(quotient(y, x))
}

/// A quotient; the dividend is multiplied before the last Newton iteration.
fn quotient(dividend: f32, divisor: f32) -> f32 {
    let reciprocal = reciprocal_of_single(divisor, 1);
    (reciprocal * dividend) * (2.0 - divisor * reciprocal)
}

/// The square root of the processor; for a negative number, the root of its magnitude.
pub(crate) fn sqrt(x: f32) -> f32 {
    square_root(f64::from(flushed(x.abs()))) as f32
}

/// The numbers of an exponential function.
struct Exponential {
    /// Sixteenths of a power of two in 1.
    sixteenths: f32,
    /// The natural logarithm of the base.
    logarithm: f32,
    /// A sixteenth of a power of two, in two parts.
    high: f32,
    low: f32,
    coefficients: [f32; 3],
}

impl Exponential {
    fn evaluate(&self, x: f32) -> f32 {
        /// Powers of two, in steps of a quarter and of a sixteenth, with the board's digits.
        const QUARTERS: [f64; 4] = [1.0, 1.189_207_115, 1.414_213_562, 1.681_792_831];
        const SIXTEENTHS: [f64; 4] = [1.0, 1.044_273_782, 1.090_507_733, 1.138_788_635];
        const SMALL: f32 = 1.220_703_1e-4;
        const LARGEST: f32 = 88.722_83;
        let natural = x * self.logarithm;
        if natural.abs() < SMALL {
            return natural + 1.0;
        }
        if natural > LARGEST {
            return f32::MAX;
        }
        let steps = libm::floorf(x * self.sixteenths + 0.5);
        let rest = (x - steps * self.high) - steps * self.low;
        let square = rest * rest;
        let [first, second, third] = self.coefficients;
        let change = (third * (rest * square) + second * square) + rest * first;
        let steps = steps as i32;
        let power = QUARTERS[(steps >> 2 & 3) as usize] * SIXTEENTHS[(steps & 3) as usize];
        let result = (libm::ldexp(power, steps >> 4) * (f64::from(change) + 1.0)) as f32;
        if result.is_normal() { result } else { 0.0 }
    }
}

pub(crate) fn exp(x: f32) -> f32 {
    let numbers = Exponential {
        sixteenths: 23.083_12,
        logarithm: 1.0,
        high: 0.043_319_702,
        low: 1.996_636_5e-6,
        coefficients: [0.999_999_9, 0.499_999_97, 0.166_736_19],
    };
    numbers.evaluate(x)
}

pub(crate) fn exp2(x: f32) -> f32 {
    let numbers = Exponential {
        sixteenths: 16.0,
        logarithm: LN_2,
        high: 0.0625,
        low: 0.0,
        coefficients: [0.693_147_1, 0.240_226_49, 0.055_527_262],
    };
    numbers.evaluate(x)
}

pub(crate) fn exp10(x: f32) -> f32 {
    let numbers = Exponential {
        sixteenths: 53.150_85,
        logarithm: LN_10,
        high: 0.018_814_087,
        low: 2.878_149_4e-7,
        coefficients: [2.302_585, 2.650_948_8, 2.035_527_5],
    };
    numbers.evaluate(x)
}

/// The logarithm to a base, given as the factor of the natural logarithm in single and in double precision.
fn scaled_log(x: f32, factor: f32, exact: f64) -> f32 {
    /// −ln(1 + k/8), with the board's digits.
    const EIGHTHS: [f64; 8] = [
        0.0,
        -0.117_783_035_6,
        -0.223_143_551_3,
        -0.318_453_731_1,
        -0.405_465_108_1,
        -0.485_507_815_7,
        -0.559_615_787_9,
        -0.628_608_659_4,
    ];
    const LN_2: f64 = 0.693_147_180_559_945;
    const P: [f32; 2] = [-0.250_590_53, 0.190_816_88];
    const SMALLEST: f32 = -87.336_55;
    const LARGEST: f32 = 88.722_84;
    /// The bits of a reciprocal that do not come from the lookup table.
    const REST: u64 = (1 << 49) - 1;
    if x.is_sign_negative() || x == 0.0 {
        return -f32::MAX;
    }
    if !x.is_normal() {
        return factor * if x.is_subnormal() { SMALLEST } else { LARGEST };
    }
    let bits = (1.0 / f64::from(x)).to_bits() & !REST;
    let power = (bits >> 52) as i32 - 1023;
    let rest = f64::from(x) * f64::from_bits(bits) - 1.0;
    let table = EIGHTHS[(bits >> 49 & 7) as usize] - f64::from(power) * LN_2;
    let main = table * exact + rest * exact;
    let rest = rest as f32;
    let square = rest * rest;
    let fourth = (polynomial(&P, rest) + -0.230_289_38 * square) * (square * square);
    let change = (0.333_316_45 * (rest * square) + fourth) + -0.500_000_2 * square;
    (main + f64::from(change * factor)) as f32
}

pub(crate) fn log(x: f32) -> f32 {
    scaled_log(x, 1.0, 1.0)
}

pub(crate) fn log2(x: f32) -> f32 {
    scaled_log(x, LOG2_E, std::f64::consts::LOG2_E)
}

pub(crate) fn log10(x: f32) -> f32 {
    scaled_log(x, LOG10_E, std::f64::consts::LOG10_E)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_near_those_of_c() {
        for step in -400_i16..=400 {
            let x = f32::from(step) / 37.0;
            for (found, expect) in [
                (sin(x), libm::sinf(x)),
                (cos(x), libm::cosf(x)),
                (atan(x), libm::atanf(x)),
                (atan2(x, 2.5), libm::atan2f(x, 2.5)),
                (atan2(-2.5, x), libm::atan2f(-2.5, x)),
                (asin(x / 11.0), libm::asinf(x / 11.0)),
                (acos(x / 11.0), libm::acosf(x / 11.0)),
                (exp(x) / libm::expf(x), 1.0),
                (exp2(x) / libm::exp2f(x), 1.0),
                (exp10(x) / libm::exp10f(x), 1.0),
                (log(x.abs() + 0.1), libm::logf(x.abs() + 0.1)),
                (log2(x.abs() + 0.1), libm::log2f(x.abs() + 0.1)),
                (log10(x.abs() + 0.1), libm::log10f(x.abs() + 0.1)),
            ] {
                assert!((found - expect).abs() < 1e-5, "{x}: {found} {expect}");
            }
        }
    }

    #[test]
    fn what_has_no_result_has_that_of_the_board() {
        assert_eq!([log(0.0), log(-1.0), exp(100.0), exp(-100.0)], [-f32::MAX, -f32::MAX, f32::MAX, 0.0]);
        assert_eq!(sqrt(-2.0).to_bits(), 0x3FB5_04F3);
        assert_eq!([asin(2.0), acos(2.0), sin(1e8)], [FRAC_PI_2, 0.0, 0.0]);
        assert_eq!([atan2(0.0, -0.5), atan2(-1.0, 0.0), atan(-1e10)], [0.0, -FRAC_PI_2, -FRAC_PI_2]);
    }
}
