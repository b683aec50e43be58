//! The elementary functions of doubles, as the firmware's library computes them.
//!
//! Most follow Cody and Waite (Software Manual for the Elementary Functions), with the firmware's divisions; its square
//! root, arc sine and arc tangent use other algorithms. Coefficients and the order of operations are those of the
//! released firmware; the board tests measure the share of identical results.

use std::f64::consts::{
    FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, LN_2, LN_10, LOG2_E, LOG10_E, PI, SQRT_2,
};

use super::division::divide;

/// π in two parts, of which the first has few digits.
const PI_HIGH: f64 = 3.141_601_562_5;
const PI_LOW: f64 = -8.908_910_206_761_537e-6;
/// From here on the number of turns exceeds an integer, and the sine is 0.
const TOO_LARGE: f64 = 2_147_483_648.0;
/// Below this the sine is its angle.
const SMALL_ANGLE: f64 = 1.490_116_119_384_765_6e-8;

/// A polynomial by Horner's rule; its first coefficient is the constant.
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().copied().reduce(|sum, coefficient| sum * x + coefficient).unwrap_or(0.0)
}

/// A number as the processor's arithmetic takes it: one that is denormal is 0.
pub(super) fn flushed(x: f64) -> f64 {
    if x.is_subnormal() { 0.0 } else { x }
}

/// The sine of an angle that is not below 0, and its sign.
fn sine(angle: f64, sign: f64) -> f64 {
    const EVEN: [f64; 4] = [
        -0.166_666_666_666_666_65,
        -0.198_412_698_412_018_4e-3,
        -0.250_521_067_982_745_85e-7,
        -0.764_291_780_689_104_7e-12,
    ];
    const ODD: [f64; 4] = [
        0.833_333_333_333_316_5e-2,
        0.275_573_192_101_527_56e-5,
        0.160_589_364_903_715_9e-9,
        0.272_047_909_578_888_46e-14,
    ];
    if angle >= TOO_LARGE || angle.is_nan() {
        return 0.0;
    }
    let half_turns = libm::floor(angle * std::f64::consts::FRAC_1_PI + 0.5);
    let sign = if libm::fmod(half_turns, 2.0) == 0.0 { sign } else { -sign };
    let rest = (angle - half_turns * PI_HIGH) - half_turns * PI_LOW;
    if rest.abs() < SMALL_ANGLE {
        return sign * rest;
    }
    let square = rest * rest;
    let fourth = square * square;
    let change = polynomial(&EVEN, fourth) * square + polynomial(&ODD, fourth) * fourth;
    sign * (rest + rest * change)
}

pub(crate) fn sin(x: f64) -> f64 {
    sine(x.abs(), if x.is_sign_negative() { -1.0 } else { 1.0 })
}

pub(crate) fn cos(x: f64) -> f64 {
    sine(x.abs() + FRAC_PI_2, 1.0)
}

/// ln 2 in two parts, of which the first has few digits.
const LN_2_HIGH: f64 = 0.693_359_375;
const LN_2_LOW: f64 = -2.121_944_400_546_905_8e-4;
/// The logarithms of the largest double and of the smallest normal one.
const LARGEST: f64 = 709.782_712_893_384;
const SMALLEST: f64 = -708.396_418_532_264_1;

/// The largest power of two by which the firmware multiplies.
const LARGEST_POWER: f64 = 1023.0;

pub(crate) fn exp(x: f64) -> f64 {
    const P: [f64; 3] = [0.25, 0.694_360_001_511_792_9e-2, 0.165_203_300_268_279_13e-4];
    const Q: [f64; 3] = [0.5, 0.555_538_666_969_001_2e-1, 0.495_862_884_905_441_3e-3];
    if x > LARGEST {
        return f64::MAX;
    }
    if x < SMALLEST {
        return 0.0;
    }
    let power = libm::copysign(libm::floor(x.abs() * LOG2_E + 0.5), x);
    if power > LARGEST_POWER {
        // Board quirk: the largest results overflow into the sign.
        return -0.0;
    }
    let rest = (x - power * LN_2_HIGH) - power * LN_2_LOW;
    let square = rest * rest;
    let product = rest * polynomial(&P, square);
    let half = 0.5 + divide(product, polynomial(&Q, square) - product);
    libm::ldexp(half, power as i32 + 1)
}

pub(crate) fn exp2(x: f64) -> f64 {
    exp(x * LN_2)
}

pub(crate) fn exp10(x: f64) -> f64 {
    exp(x * LN_10)
}

/// The natural logarithm; the lowest number where there is none.
pub(crate) fn log(x: f64) -> f64 {
    const A: [f64; 3] = [-64.124_943_423_745_58, 16.383_943_563_021_534, -0.789_561_128_874_912_6];
    const B: [f64; 4] = [-769.499_321_084_948_8, 312.032_220_919_245_3, -35.667_977_739_034_65, 1.0];
    if x < f64::MIN_POSITIVE {
        return -f64::MAX;
    }
    let (fraction, power) = libm::frexp(x);
    let (numerator, denominator, power) = if fraction > SQRT_2 / 2.0 {
        ((fraction - 0.5) - 0.5, fraction * 0.5 + 0.5, power)
    } else {
        (fraction - 0.5, (fraction - 0.5) * 0.5 + 0.5, power - 1)
    };
    let z = divide(numerator, denominator);
    let square = z * z;
    let ratio = divide(polynomial(&A, square), polynomial(&B, square));
    f64::from(power) * LN_2 + (z + z * (square * ratio))
}

/// The logarithm to base 2. Board quirk: where there is none, the product with the lowest number, which is infinite.
pub(crate) fn log2(x: f64) -> f64 {
    log(x) * LOG2_E
}

pub(crate) fn log10(x: f64) -> f64 {
    log(x) * LOG10_E
}

/// The arc sine of a number up to one half, and twice the arc sine of a root.
fn arc(x: f64, square: f64) -> f64 {
    const COEFFICIENTS: [f64; 12] = [
        0.166_666_666_666_648_4,
        0.075_000_000_004_048_58,
        0.044_642_856_791_215_726,
        0.030_381_960_271_494_88,
        0.022_371_736_603_202_38,
        0.017_359_969_965_436_58,
        0.013_883_027_830_534_857,
        0.012_181_679_081_196_953,
        0.006_480_855_383_860_01,
        0.019_642_396_610_005_285,
        -0.016_384_436_278_236_554,
        0.032_011_340_198_495_324,
    ];
    x + x * (polynomial(&COEFFICIENTS, square) * square)
}

/// The square root; 0 for a number without one.
pub(crate) fn sqrt(x: f64) -> f64 {
    let x = flushed(x);
    if x.is_nan() || x <= 0.0 || x.is_infinite() {
        return if x > 0.0 { x } else { 0.0 };
    }
    // A straight line through the reciprocal root of the fraction, then Newton's iteration.
    let (fraction, power) = libm::frexp(x);
    let mut line = 2.528_32 + fraction * -1.145_508;
    let power = power - 1;
    if power & 1 != 0 {
        line *= FRAC_1_SQRT_2;
    }
    let mut reciprocal = libm::ldexp(line, !(power >> 1));
    for _ in 0..3 {
        reciprocal += (0.5 - reciprocal * (0.5 * (x * reciprocal))) * reciprocal;
    }
    let root = x * reciprocal;
    root + root * (0.5 - reciprocal * (0.5 * root))
}

/// −2 arcsin √((1 − x)/2), which is the arc sine of `x` less a quarter of a turn.
fn beyond_half(x: f64) -> f64 {
    let square = 0.5 * ((0.5 - x) + 0.5);
    arc(-2.0 * sqrt(square), square)
}

/// The arc sine; outside of its domain, the arc sine of the nearest number inside.
pub(crate) fn asin(x: f64) -> f64 {
    let x = flushed(x);
    let magnitude = x.abs().min(1.0);
    let angle = if magnitude <= 0.5 {
        arc(magnitude, magnitude * magnitude)
    } else {
        (FRAC_PI_4 + beyond_half(magnitude)) + FRAC_PI_4
    };
    if x < 0.0 { -angle } else { angle }
}

/// The arc cosine; outside of its domain, the arc cosine of the nearest number inside.
pub(crate) fn acos(x: f64) -> f64 {
    let magnitude = x.abs().min(1.0);
    if magnitude <= 0.5 {
        let angle = arc(magnitude, magnitude * magnitude);
        (FRAC_PI_4 - if x < 0.0 { -angle } else { angle }) + FRAC_PI_4
    } else if x < 0.0 {
        (FRAC_PI_2 + beyond_half(magnitude)) + FRAC_PI_2
    } else {
        -beyond_half(magnitude)
    }
}

/// The arc tangent.
pub(crate) fn atan(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 8] = [
        -0.333_333_333_333_299_2,
        0.199_999_999_987_262_37,
        -0.142_857_141_024_675_98,
        0.111_110_978_784_541_42,
        -0.090_903_705_591_875_23,
        0.076_793_590_902_482_65,
        -0.064_831_111_420_579_68,
        0.044_386_644_545_235_51,
    ];
    /// The tangent of 15°, up to which the polynomial is good.
    const LIMIT: f64 = 0.267_949_192_431_122_7;
    /// √3, and √3 − 1.
    const ROOT_3: f64 = 1.732_050_807_568_877_2;
    const ROOT_3_LESS_1: f64 = 0.732_050_807_568_877_3;
    /// The angles of the intervals: 0°, 30°, 90°, and 60° with the last bit of the board.
    #[expect(clippy::approx_constant, reason = "the last bit is another")]
    const ANGLES: [f64; 4] = [0.0, FRAC_PI_6, FRAC_PI_2, 1.047_197_551_196_597_9];
    let x = flushed(x);
    let (mut rest, mut angle) = (x.abs(), 0);
    if rest > 1.0 {
        (rest, angle) = (divide(1.0, rest), 2);
    }
    if rest > LIMIT {
        rest = divide(rest + ((ROOT_3_LESS_1 * rest - 0.5) - 0.5), ROOT_3 + rest);
        angle += 1;
    }
    let square = rest * rest;
    let arc = rest + rest * (square * polynomial(&COEFFICIENTS, square));
    let result = ANGLES[angle] + if angle > 1 { -arc } else { arc };
    if x < 0.0 { -result } else { result }
}

/// The angle of a point in all four quadrants.
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    let [y, x] = [y, x].map(flushed);
    let quotient = if x == 0.0 { f64::INFINITY } else { divide(y, x).abs() };
    let angle = if x == 0.0 && y == 0.0 {
        0.0
    } else if quotient.is_infinite() {
        FRAC_PI_2
    } else {
        atan(quotient)
    };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// The tangent.
pub(crate) fn tan(x: f64) -> f64 {
    const P: [f64; 3] = [-0.133_383_500_064_219_62, 0.342_488_782_358_905_9e-2, -0.178_617_073_422_544_27e-4];
    const Q: [f64; 4] = [
        -0.466_716_833_397_552_94,
        0.256_638_322_894_401_13e-1,
        -0.311_815_319_070_100_27e-3,
        4.981_943_399_378_651e-7,
    ];
    /// The second part of π/2, which is not half the second part of π.
    const HALF_PI_LOW: f64 = -4.454_455_103_380_769e-6;
    let x = flushed(x);
    let product = std::f64::consts::FRAC_2_PI * x;
    let quarters = libm::trunc(if product < 0.0 { product - 0.5 } else { product + 0.5 });
    let whole = libm::trunc(x);
    let rest = ((x - whole) + (whole - PI_HIGH / 2.0 * quarters)) - HALF_PI_LOW * quarters;
    let rest = rest.clamp(-FRAC_PI_4, FRAC_PI_4);
    let square = rest * rest;
    let numerator = rest + rest * (square * polynomial(&P, square));
    let denominator = (0.5 + square * polynomial(&Q, square)) + 0.5;
    if libm::fmod(quarters, 2.0) == 0.0 {
        divide(numerator, denominator)
    } else if numerator == 0.0 {
        f64::MAX
    } else {
        -divide(denominator, numerator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_near_those_of_c() {
        for step in -400..=400 {
            let x = f64::from(step) / 37.0;
            for (found, expect) in [
                (sin(x), libm::sin(x)),
                (cos(x), libm::cos(x)),
                (atan(x), libm::atan(x)),
                (atan2(x, 2.5), libm::atan2(x, 2.5)),
                (atan2(-2.5, x), libm::atan2(-2.5, x)),
                (sqrt(x.abs()), libm::sqrt(x.abs())),
                (exp(x) / libm::exp(x), 1.0),
                (exp2(x) / libm::exp2(x), 1.0),
                (log(x.abs() + 0.1), libm::log(x.abs() + 0.1)),
                (log10(x.abs() + 0.1), libm::log10(x.abs() + 0.1)),
            ] {
                assert!((found - expect).abs() < 4e-15, "{x}: {found} {expect}");
            }
            let x = x / 11.0;
            for (found, expect) in [(asin(x), libm::asin(x)), (acos(x), libm::acos(x))] {
                assert!((found - expect).abs() < 2e-13, "{x}: {found} {expect}");
            }
        }
    }

    #[test]
    fn what_has_no_result_has_that_of_the_board() {
        assert_eq!([log(0.0), log(-1.0), exp(1000.0)], [-f64::MAX, -f64::MAX, f64::MAX]);
        assert_eq!([asin(2.0), acos(2.0), exp(-1000.0)], [FRAC_PI_2, 0.0, 0.0]);
        assert_eq!([sqrt(0.0), sqrt(-1.0), sqrt(4.0), sqrt(f64::INFINITY)], [0.0, 0.0, 2.0, f64::INFINITY]);
        assert_eq!([atan2(0.0, -1.0), atan2(0.0, 0.0), atan2(-1.0, 0.0)], [PI, 0.0, -FRAC_PI_2]);
        assert_eq!([sin(1e10), cos(f64::INFINITY), exp(709.5)], [0.0; 3]);
    }
}
