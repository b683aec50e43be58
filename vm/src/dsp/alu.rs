//! Integer arithmetic of the units, 32 and 40 bits.

/// Bits of a long.
const LONG: u32 = 40;

/// The low 40 bits of `value`, sign-extended.
pub(super) const fn to_long(value: i64) -> i64 {
    value << (64 - LONG) >> (64 - LONG)
}

/// The low 40 bits of `value`, zero-extended.
pub(super) const fn to_unsigned_long(value: i64) -> u64 {
    (value as u64) << (64 - LONG) >> (64 - LONG)
}

/// `value` clamped to 40 bits.
pub(super) const fn saturate_long(value: i64) -> i64 {
    const LIMIT: i64 = 1 << (LONG - 1);
    if value < -LIMIT {
        -LIMIT
    } else if value > LIMIT - 1 {
        LIMIT - 1
    } else {
        value
    }
}

/// `value` clamped to 32 bits.
pub(super) const fn saturate(value: i64) -> u32 {
    if value < i32::MIN as i64 {
        0x8000_0000
    } else if value > i32::MAX as i64 {
        0x7FFF_FFFF
    } else {
        value as u32
    }
}

/// The count of a shift: bits 5..0.
pub(super) const fn count(value: u32) -> u32 {
    value & 63
}

/// `n = s1[5:0]; n>31 ? 0 : s2 << n`
pub(super) const fn shl(s1: u32, s2: u32) -> u32 {
    ((s2 as u64) << count(s1)) as u32
}

/// `n = min(s1[5:0],31); signed s2 >> n`
pub(super) const fn shr(s1: u32, s2: u32) -> u32 {
    (s2.cast_signed() as i64 >> count(s1)) as u32
}

/// `n = s1[5:0]; n>31 ? 0 : unsigned s2 >> n`
pub(super) const fn shru(s1: u32, s2: u32) -> u32 {
    (s2 as u64 >> count(s1)) as u32
}

/// `sat32(signed s2 << s1[4:0])`
pub(super) const fn sshl(s1: u32, s2: u32) -> u32 {
    saturate((s2.cast_signed() as i64) << (s1 & 31))
}

/// `n = s1[5:0]; n>39 ? 0 : s2 << n mod 2^40`
pub(super) const fn shl_long(s1: i64, s2: i64) -> i64 {
    let count = count(s1 as u32);
    if count >= LONG { 0 } else { to_long(s2 << count) }
}

/// `n = min(s1[5:0],39); signed 40-bit s2 >> n`
pub(super) const fn shr_long(s1: i64, s2: i64) -> i64 {
    s2 >> count(s1 as u32)
}

/// `n = s1[5:0]; n>39 ? 0 : unsigned 40-bit s2 >> n`
pub(super) const fn shru_long(s1: i64, s2: i64) -> i64 {
    (to_unsigned_long(s2) >> count(s1 as u32)).cast_signed()
}

/// `(s1 >= s2 unsigned) ? ((s1-s2)<<1)+1 : s1<<1`
pub(super) const fn subc(s1: u32, s2: u32) -> u32 {
    if s1 >= s2 { (s1.wrapping_sub(s2) << 1) + 1 } else { s1 << 1 }
}

/// Number of bits above the leftmost bit of s2 that equals s1&1; 32 if none.
pub(super) const fn lmbd(s1: u32, s2: u32) -> u32 {
    if s1 & 1 != 0 { s2.leading_zeros() } else { s2.leading_ones() }
}

/// Number of redundant sign bits of s2, 0..=31.
pub(super) const fn norm(s2: u32) -> u32 {
    let same = if s2.cast_signed() < 0 { s2.leading_ones() } else { s2.leading_zeros() };
    same - 1
}

/// Number of redundant sign bits of the 40-bit s2, 0..=39.
pub(super) const fn norm_long(s2: i64) -> u32 {
    let same = if s2 < 0 { s2.leading_ones() } else { s2.leading_zeros() };
    same - (64 - LONG) - 1
}

/// `s2<0 ? sat32(-s2) : s2`
pub(super) const fn abs(s2: u32) -> u32 {
    if s2 == 0x8000_0000 { 0x7FFF_FFFF } else { s2.cast_signed().unsigned_abs() }
}

/// Two 16-bit sums, without a carry from one to the other.
pub(super) const fn add2(s1: u32, s2: u32) -> u32 {
    let high = (s1 & 0xFFFF_0000).wrapping_add(s2 & 0xFFFF_0000);
    high | (s1.wrapping_add(s2) & 0xFFFF)
}

/// Two differences of 16 bits.
pub(super) const fn sub2(s1: u32, s2: u32) -> u32 {
    let high = (s1 & 0xFFFF_0000).wrapping_sub(s2 & 0xFFFF_0000);
    high | (s1.wrapping_sub(s2) & 0xFFFF)
}

/// Bits `s1[9:5]..=s1[4:0]`; none if the second number is less than the first.
const fn bits(s1: u32) -> u32 {
    let (low, high) = (s1 >> 5 & 31, s1 & 31);
    if high < low { 0 } else { (u32::MAX >> (31 - high)) & (u32::MAX << low) }
}

/// `a = s1[9:5], b = s1[4:0]; s2 with bits a..b cleared (b<a: unchanged)`
pub(super) const fn clr(s1: u32, s2: u32) -> u32 {
    s2 & !bits(s1)
}

/// `a = s1[9:5], b = s1[4:0]; s2 with bits a..b set (b<a: unchanged)`
pub(super) const fn set(s1: u32, s2: u32) -> u32 {
    s2 | bits(s1)
}

/// `(s2 << s1[9:5]) >> s1[4:0], arithmetic`
pub(super) const fn ext(s1: u32, s2: u32) -> u32 {
    ((s2 << (s1 >> 5 & 31)).cast_signed() >> (s1 & 31)).cast_unsigned()
}

/// `(s2 << s1[9:5]) >> s1[4:0], logical`
pub(super) const fn extu(s1: u32, s2: u32) -> u32 {
    (s2 << (s1 >> 5 & 31)) >> (s1 & 31)
}
