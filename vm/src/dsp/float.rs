//! Floating point as the processor computes it (`c67x.md` 4).
//!
//! Rounds to nearest even; a denormal source counts as zero of its sign, a result below the smallest normal number
//! becomes zero of its sign, and every NaN result has the same bits.

const NAN_SINGLE: u32 = 0x7FFF_FFFF;
const NAN_DOUBLE: u64 = 0x7FFF_FFFF_FFFF_FFFF;
const SIGN_SINGLE: u32 = 1 << 31;
const SIGN_DOUBLE: u64 = 1 << 63;
const EXPONENT_DOUBLE: u64 = 0x7FF << 52;
/// The exponent from which on sums take the fast path: 2^-900.
pub(super) const SUM_EXPONENT: u64 = 1023 - 900;

/// A single as a source.
pub(super) fn single(bits: u32) -> f32 {
    let value = f32::from_bits(bits);
    if value.is_subnormal() { f32::from_bits(bits & SIGN_SINGLE) } else { value }
}

/// A double as a source.
pub(super) fn double(bits: u64) -> f64 {
    let value = f64::from_bits(bits);
    if value.is_subnormal() { f64::from_bits(bits & SIGN_DOUBLE) } else { value }
}

/// A single as a result.
pub(super) fn from_single(value: f32) -> u32 {
    if value.is_nan() {
        return NAN_SINGLE;
    }
    let bits = value.to_bits();
    if value.is_subnormal() { bits & SIGN_SINGLE } else { bits }
}

/// A double as a result.
pub(super) fn from_double(value: f64) -> u64 {
    if value.is_nan() {
        return NAN_DOUBLE;
    }
    let bits = value.to_bits();
    if value.is_subnormal() { bits & SIGN_DOUBLE } else { bits }
}

/// `s1 + s2`
pub(super) fn addsp(s1: u32, s2: u32) -> u32 {
    from_single(single(s1) + single(s2))
}

/// `s1 - s2`
pub(super) fn subsp(s1: u32, s2: u32) -> u32 {
    from_single(single(s1) - single(s2))
}

/// `s1 * s2`
pub(super) fn mpysp(s1: u32, s2: u32) -> u32 {
    from_single(single(s1) * single(s2))
}

/// Reports whether bits are those of a finite number whose biased exponent is at least `least`.
#[inline(always)]
const fn is_finite_from(least: u64, bits: u64) -> bool {
    (bits >> 52 & 0x7FF).wrapping_sub(least) < 0x7FF - least
}

/// `s1 + s2`
#[inline(always)]
pub(super) fn adddp(s1: u64, s2: u64) -> u64 {
    usual_sum(f64::from_bits(s1) + f64::from_bits(s2)).unwrap_or_else(|| unusual_sum(s1, s2))
}

#[cold]
fn unusual_sum(s1: u64, s2: u64) -> u64 {
    from_double(double(s1) + double(s2))
}

/// The host's sum if the processor's is the same: a denormal source changes none that is so much greater.
#[inline(always)]
fn usual_sum(sum: f64) -> Option<u64> {
    is_finite_from(SUM_EXPONENT, sum.to_bits()).then_some(sum.to_bits())
}

/// `s1 - s2`
#[inline(always)]
pub(super) fn subdp(s1: u64, s2: u64) -> u64 {
    usual_sum(f64::from_bits(s1) - f64::from_bits(s2)).unwrap_or_else(|| unusual_difference(s1, s2))
}

#[cold]
fn unusual_difference(s1: u64, s2: u64) -> u64 {
    from_double(double(s1) - double(s2))
}

/// `s1 * s2`
#[inline(always)]
pub(super) fn mpydp(s1: u64, s2: u64) -> u64 {
    let bits = (f64::from_bits(s1) * f64::from_bits(s2)).to_bits();
    let is_usual = is_finite_from(1, bits) & (s1 & EXPONENT_DOUBLE != 0) & (s2 & EXPONENT_DOUBLE != 0);
    if is_usual { bits } else { unusual_product(s1, s2) }
}

#[cold]
fn unusual_product(s1: u64, s2: u64) -> u64 {
    from_double(double(s1) * double(s2))
}

/// `double(s1) * s2`, rounded once.
pub(super) fn mpyspdp(s1: u32, s2: u64) -> u64 {
    from_double(f64::from(single(s1)) * double(s2))
}

/// `double(s1) * double(s2)`, exact.
pub(super) fn mpysp2dp(s1: u32, s2: u32) -> u64 {
    from_double(f64::from(single(s1)) * f64::from(single(s2)))
}

/// `single(signed s2)`
pub(super) fn intsp(s2: u32) -> u32 {
    (s2.cast_signed() as f32).to_bits()
}

/// `single(unsigned s2)`
pub(super) fn intspu(s2: u32) -> u32 {
    (s2 as f32).to_bits()
}

/// `double(signed s2)`
pub(super) fn intdp(s2: u32) -> u64 {
    f64::from(s2.cast_signed()).to_bits()
}

/// `double(unsigned s2)`
pub(super) fn intdpu(s2: u32) -> u64 {
    f64::from(s2).to_bits()
}

/// `double(single s2)`
pub(super) fn spdp(s2: u32) -> u64 {
    from_double(f64::from(single(s2)))
}

/// `single(s2)`
pub(super) fn dpsp(s2: u64) -> u32 {
    from_single(double(s2) as f32)
}

/// A rounded value as an integer; too large saturates, NaN by its sign bit.
fn to_integer(value: f64, is_negative: bool) -> u32 {
    if value.is_nan() {
        return if is_negative { 0x8000_0000 } else { 0x7FFF_FFFF };
    }
    (value as i32).cast_unsigned()
}

/// `round_to_int32(single s2), saturating`
pub(super) fn spint(s2: u32) -> u32 {
    to_integer(f64::from(single(s2)).round_ties_even(), s2 & SIGN_SINGLE != 0)
}

/// `trunc_to_int32(single s2), saturating`
pub(super) fn sptrunc(s2: u32) -> u32 {
    to_integer(f64::from(single(s2)), s2 & SIGN_SINGLE != 0)
}

/// `round_to_int32(s2), saturating (nearest even)`
pub(super) fn dpint(s2: u64) -> u32 {
    to_integer(double(s2).round_ties_even(), s2 & SIGN_DOUBLE != 0)
}

/// `trunc_to_int32(s2), saturating`
pub(super) fn dptrunc(s2: u64) -> u32 {
    to_integer(double(s2), s2 & SIGN_DOUBLE != 0)
}

/// The value with all but its upper 8 fraction bits cleared; NaN as the processor's emulator has it.
fn cut_single(value: f32) -> u32 {
    let bits = if value.is_nan() { NAN_SINGLE } else { from_single(value) };
    bits & 0xFFFF_8000
}

/// As [`cut_single`].
fn cut_double(value: f64) -> u64 {
    let bits = if value.is_nan() { NAN_DOUBLE } else { from_double(value) };
    bits & 0xFFFF_F000_0000_0000
}

/// Estimate of `1/s2` (`c67x.md` 4.4).
pub(super) fn rcpsp(s2: u32) -> u32 {
    cut_single(1.0 / single(s2))
}

/// Estimate of `1/s2`.
pub(super) fn rcpdp(s2: u64) -> u64 {
    cut_double(1.0 / double(s2))
}

/// Estimate of `1/sqrt(s2)`.
pub(super) fn rsqrsp(s2: u32) -> u32 {
    cut_single((1.0 / libm::sqrt(f64::from(single(s2)))) as f32)
}

/// Estimate of `1/sqrt(s2)`.
pub(super) fn rsqrdp(s2: u64) -> u64 {
    cut_double(1.0 / libm::sqrt(double(s2)))
}
