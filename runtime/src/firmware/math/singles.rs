//! Functions of singles, with the arithmetic of the board: Cody and Waite's, like those of doubles.
//!
//! Not all of their results are those of the released firmware, but more than of any other formula known: the board's
//! tests have the shares.

use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, FRAC_PI_3, FRAC_PI_6, PI};

use crate::servo::dsp::{divide_singles, root};

/// π in two parts, of which the first has few digits.
const PI_HIGH: f32 = 3.140_625;
const PI_LOW: f32 = 9.676_536e-4;
/// Below this the sine is its angle.
const SMALL_ANGLE: f32 = 2.441_406_2e-4;

/// A polynomial by Horner's rule; its first coefficient is the constant.
fn polynomial(coefficients: &[f32], x: f32) -> f32 {
    coefficients.iter().rev().copied().reduce(|sum, coefficient| sum * x + coefficient).unwrap_or(0.0)
}

/// The sine of an angle that is not below 0, and its sign.
fn sine(angle: f32, sign: f32) -> f32 {
    const R: [f32; 4] = [-0.166_666_57, 0.833_302_5e-2, -0.198_074_2e-3, 0.260_190_3e-5];
    const LARGEST: f32 = 1_048_576.0;
    if angle > LARGEST || angle.is_nan() {
        return 0.0;
    }
    let half_turns = libm::floorf(angle * FRAC_1_PI + 0.5);
    let sign = if libm::fmodf(half_turns, 2.0) == 0.0 { sign } else { -sign };
    let rest = (angle - half_turns * PI_HIGH) - half_turns * PI_LOW;
    if rest.abs() < SMALL_ANGLE {
        return sign * rest;
    }
    let square = rest * rest;
    sign * (rest + rest * (polynomial(&R, square) * square))
}

pub(super) fn sin(x: f32) -> f32 {
    sine(x.abs(), if x < 0.0 { -1.0 } else { 1.0 })
}

pub(super) fn cos(x: f32) -> f32 {
    sine(x.abs() + FRAC_PI_2, 1.0)
}

pub(super) fn tan(x: f32) -> f32 {
    const P: [f32; 2] = [1.0, -0.958_017_7e-1];
    const Q: [f32; 3] = [1.0, -0.429_135_78, 0.971_685_8e-2];
    const HALF_PI_HIGH: f32 = 1.570_312_5;
    const HALF_PI_LOW: f32 = 4.838_268e-4;
    let quarters = libm::roundf(x * FRAC_2_PI);
    let rest = (x - quarters * HALF_PI_HIGH) - quarters * HALF_PI_LOW;
    let square = rest * rest;
    let numerator = rest * polynomial(&P, square);
    let denominator = polynomial(&Q, square);
    if libm::fmodf(quarters, 2.0) == 0.0 {
        divide_singles(numerator, denominator)
    } else {
        divide_singles(-denominator, numerator)
    }
}

/// The arc tangent of a quotient that is not negative, whose angle is counted from `angle` on.
fn arc_tangent(mut rest: f32, mut angle: usize) -> f32 {
    const P: [f32; 2] = [-0.470_832_5, -0.509_095_83e-1];
    const Q: [f32; 2] = [1.412_500_7, 1.0];
    const LIMIT: f32 = 0.267_949_2;
    const ROOT_3: f32 = 1.732_050_8;
    const ANGLES: [f32; 4] = [0.0, FRAC_PI_6, FRAC_PI_2, FRAC_PI_3];
    if rest > LIMIT {
        rest = divide_singles((((ROOT_3 - 1.0) * rest - 0.5) - 0.5) + rest, ROOT_3 + rest);
        angle += 1;
    }
    let square = rest * rest;
    let arc = rest + rest * divide_singles(polynomial(&P, square) * square, polynomial(&Q, square));
    ANGLES[angle] + if angle > 1 { -arc } else { arc }
}

pub(super) fn atan(x: f32) -> f32 {
    let magnitude = x.abs();
    let result = if magnitude > 1.0 {
        arc_tangent(divide_singles(1.0, magnitude), 2)
    } else {
        arc_tangent(magnitude, 0)
    };
    if x < 0.0 { -result } else { result }
}

pub(super) fn atan2(y: f32, x: f32) -> f32 {
    let (up, along) = (y.abs(), x.abs());
    let angle = if up > along {
        arc_tangent(divide_singles(along, up), 2)
    } else if along > 0.0 {
        arc_tangent(divide_singles(up, along), 0)
    } else {
        return 0.0;
    };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// The square root, which is that of the processor.
pub(super) fn sqrt(x: f32) -> f32 {
    root(f64::from(x)) as f32
}
