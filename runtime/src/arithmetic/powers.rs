//! Powers, by the algorithm of Cody and Waite: the logarithm to base 2 in sixteenths and a rest, multiplied part by part.

#![expect(clippy::approx_constant, reason = "constants of the board have digits of their own")]

use super::division::{divide, divide_singles};
use super::{doubles, singles};

/// log₂ e − 1.
const LOG2_E_LESS_1: f64 = 0.442_695_040_888_963_4;
/// 2^(−k/16).
const ROOTS: [f64; 17] = [
    1.0,
    0.957_603_280_698_573_7,
    0.917_004_043_204_671_2,
    0.878_126_080_186_649_7,
    0.840_896_415_253_714_5,
    0.805_245_165_974_627_1,
    0.771_105_412_703_970_4,
    0.738_413_072_969_749_7,
    0.707_106_781_186_547_6,
    0.677_127_773_468_446_3,
    0.648_419_777_325_504_8,
    0.620_928_906_036_742,
    0.594_603_557_501_360_5,
    0.569_394_317_378_345_8,
    0.545_253_866_332_628_8,
    0.522_136_891_213_706_9,
    0.5,
];

/// The functions of powers of a type: the rests of its odd roots, and the coefficients of logarithm and power.
macro_rules! powers {
    ($(#[$doc:meta])* $name:ident, $positive:ident, $reduced:ident of $float:ident:
        $flushed:path, $divide:ident, $rint:path, $trunc:path, $fmod:path, $frexp:path, $ldexp:path,
        $rests:expr, $logarithm:expr, $power:expr) => {
        $(#[$doc])*
        pub(crate) fn $name(base: $float, exponent: $float) -> $float {
            let exponent = $flushed(exponent);
            if exponent > 0.0 && $flushed(base) == 0.0 {
                return base;
            }
            let base = $flushed(base);
            if base > 0.0 {
                return $positive(base, exponent);
            }
            if base < 0.0 {
                // Board quirk: for a negative base, the exponent is rounded to the nearest integer.
                let exponent = $rint(exponent);
                let power = $positive(-base, exponent);
                return if $fmod(exponent, 2.0) == 0.0 { power } else { -power };
            }
            if exponent < 0.0 { -$float::MAX } else { 1.0 }
        }

        /// The part of a number in whole sixteenths.
        fn $reduced(x: $float) -> $float {
            0.0625 * $rint(16.0 * x)
        }

        fn $positive(base: $float, exponent: $float) -> $float {
            const RESTS: [$float; 8] = $rests;
            let root = |index: usize| ROOTS[index] as $float;
            let in_range = |result: $float| {
                if result.is_infinite() { $float::MAX } else if result.is_normal() { result } else { 0.0 }
            };
            if base == 1.0 || exponent == 1.0 {
                return base;
            }
            let (fraction, octave) = $frexp(base);
            if fraction == 0.5 && $trunc(exponent) == exponent {
                return in_range($ldexp(1.0, ((octave - 1) as $float * exponent) as i32));
            }
            let mut index = if fraction <= root(8) { 9 } else { 1 };
            for step in [4, 2] {
                if fraction <= root(index + step - 1) {
                    index += step;
                }
            }
            let z = $divide((fraction - root(index)) - RESTS[index / 2], fraction + root(index));
            let z = z + z;
            let square = z * z;
            let change = $logarithm.iter().rev().copied().reduce(|sum, next| sum * square + next);
            let change = z * (square * change.unwrap_or(0.0));
            let factor = LOG2_E_LESS_1 as $float;
            let small = (z * factor + (change * factor + change)) + z;
            let large = 0.0625 * (octave * 16 - index as i32) as $float;

            let whole = $reduced(exponent);
            let sum = small * exponent + large * (exponent - whole);
            let first = $reduced(sum);
            let total = whole * large + first;
            let second = $reduced(total);
            let rest = (total - second) + (sum - first);
            let third = $reduced(rest);
            let (mut steps, mut rest) = ((16.0 * (second + third)) as i32, rest - third);
            if rest > 0.0 {
                steps = steps.saturating_add(1);
                rest -= 0.0625;
            }
            let octave = steps / 16 + i32::from(steps >= 0);
            let index = (octave * 16).saturating_sub(steps).clamp(0, 16) as usize;
            let power = $power.iter().rev().copied().reduce(|sum, next| sum * rest + next);
            let power = power.unwrap_or(0.0) * rest;
            in_range($ldexp(root(index) + root(index) * power, octave))
        }
    };
}

powers! {
    /// A power.
    pow, positive, reduced of f64:
    doubles::flushed, divide, libm::rint, libm::trunc, libm::fmod, libm::frexp, libm::ldexp,
    [
        -5.309_973_028_091_58e-17,
        1.480_070_347_718_688_8e-17,
        1.235_359_628_470_222_5e-17,
        -1.741_997_278_434_313_8e-17,
        3.850_474_189_890_186e-17,
        2.329_013_795_905_946_5e-17,
        4.456_406_338_052_234e-17,
        4.275_944_852_753_672e-17,
    ],
    [
        0.083_333_333_333_333_22,
        0.012_500_000_000_503_799,
        0.002_232_142_128_592_426,
        0.000_434_457_756_721_631_2,
    ],
    [
        0.693_147_180_559_945_3,
        0.240_226_506_959_095_37,
        0.055_504_108_664_085_595,
        0.009_618_129_059_517_241,
        0.001_333_354_131_358_578_4,
        0.000_154_002_904_409_897_65,
        1.492_885_268_059_560_9e-5,
    ]
}

powers! {
    /// A power of a single.
    powf, positive_single, reduced_single of f32:
    singles::flushed, divide_singles, libm::rintf, libm::truncf, libm::fmodf, libm::frexpf, libm::ldexpf,
    [
        4.922_664e-9,
        -4.617_885e-9,
        4.918_108_6e-9,
        -2.250_449_4e-8,
        -5.061_674_6e-9,
        2.248_419e-8,
        2.693_111_2e-8,
        2.416_735e-8,
    ],
    [0.083_357_54_f32],
    [0.693_146_77, 0.240_185_1, 0.054_360_382]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_near_those_of_c() {
        for base in [0.003, 0.5, 0.7, 1.0, 1.3, 2.0, 9.0, 1e4] {
            for exponent in [-7.3, -1.0, -0.1, 0.0, 0.2, 1.0, 2.0, 8.8] {
                let expect = libm::pow(base, exponent);
                assert!((pow(base, exponent) / expect - 1.0).abs() < 1e-14, "{base} {exponent}");
                let single = f64::from(powf(base as f32, exponent as f32));
                assert!((single / expect - 1.0).abs() < 1e-5, "{base} {exponent}");
            }
        }
    }

    #[test]
    fn what_has_no_result_has_that_of_the_board() {
        assert_eq!([pow(-8.0, 1.0 / 3.0), pow(-8.0, 3.0), pow(0.0, -1.0)], [1.0, -512.0, -f64::MAX]);
        assert_eq!([pow(0.0, 2.0), pow(0.0, 0.0), pow(10.0, 500.0)], [0.0, 1.0, f64::MAX]);
        assert_eq!([pow(2.0, -1080.0), pow(1e300, -2.0)], [0.0; 2]);
        assert_eq!([powf(-8.0, 2.0), powf(1e30, 2.0), powf(1e-30, 2.0)], [64.0, f32::MAX, 0.0]);
    }
}
