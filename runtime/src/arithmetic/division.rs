//! The arithmetic of the board's processor where it differs from IEEE 754.
//!
//! The DSP has no division and no square root. It has tables that give a reciprocal and a reciprocal root of eight
//! good bits, which Newton's iteration refines; the last bit of the result is then not always the nearest. Profiles
//! are lists that programs see, and a length on the border of two kinds of profile falls to the side to which that
//! last bit sends it. Found by matching recorded profiles and times of overrides, which these functions reproduce bit for bit.

/// `dividend / divisor` as the board computes it.
pub(crate) fn divide(dividend: f64, divisor: f64) -> f64 {
    let mut reciprocal = eight_bits(1.0 / divisor);
    if !reciprocal.is_normal() {
        return dividend / divisor;
    }
    for _ in 0..3 {
        reciprocal *= 2.0 - divisor * reciprocal;
    }
    dividend * reciprocal
}

/// Divides singles.
pub(crate) fn divide_singles(dividend: f32, divisor: f32) -> f32 {
    let reciprocal = reciprocal_of_single(divisor, 2);
    if reciprocal.is_normal() { dividend * reciprocal } else { dividend / divisor }
}

/// The processor's reciprocal of a single, after some of Newton's iterations.
pub(super) fn reciprocal_of_single(divisor: f32, iterations: u32) -> f32 {
    let mut reciprocal = eight_bits(1.0 / f64::from(divisor)) as f32;
    if reciprocal.is_normal() {
        for _ in 0..iterations {
            reciprocal *= 2.0 - divisor * reciprocal;
        }
    }
    reciprocal
}

/// The square root of a single as the board computes it; 0 for a number without one.
pub(crate) fn square_root(square: f64) -> f64 {
    let square = square as f32;
    if !square.is_normal() || square < 0.0 {
        return if square > 0.0 { f64::from(libm::sqrtf(square)) } else { 0.0 };
    }
    let half = square * 0.5;
    let mut reciprocal = eight_bits(1.0 / libm::sqrt(f64::from(square))) as f32;
    for _ in 0..2 {
        reciprocal *= 1.5 - half * reciprocal * reciprocal;
    }
    f64::from(square * reciprocal)
}

/// A number cut to the eight binary digits after the leading one that the processor's tables hold.
fn eight_bits(number: f64) -> f64 {
    const REST: u64 = (1 << 44) - 1;
    f64::from_bits(number.to_bits() & !REST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_match_the_recorded_profiles() {
        let recorded = [
            (1e4, 1e5, 0.099_999_999_999_999_99),
            (5e3, 1e6, 0.005_000_000_000_000_001),
            (2e5, 3e6, 0.066_666_666_666_666_67),
            (1e5, 6.0, 16_666.666_666_666_664),
        ];
        for (dividend, divisor, quotient) in recorded {
            assert_eq!(divide(dividend, divisor), quotient, "{dividend} / {divisor}");
            assert_eq!(divide(-dividend, divisor), -quotient);
        }
    }

    #[test]
    fn roots_match_the_recorded_profiles() {
        // The first is exact, and the board misses it.
        for (square, root_of_it) in [(2_250_000.0, 1_500.000_122_070_312_5), (36e6, 6_000.000_488_281_25)] {
            assert_eq!(square_root(square), root_of_it);
        }
    }

    #[test]
    fn invalid_quotients_and_roots_have_defined_results() {
        assert_eq!(divide(1.0, 0.0), f64::INFINITY);
        assert!(divide(0.0, 0.0).is_nan());
        assert_eq!(divide(1.0, f64::INFINITY), 0.0);
        assert_eq!(
            [square_root(0.0), square_root(-1.0), square_root(f64::NAN), square_root(f64::INFINITY)],
            [0.0, 0.0, 0.0, f64::INFINITY]
        );
    }
}
