//! Products of 16 bits: which halves, which signs.

/// The halves and signs that a multiply of 16 bits takes from its sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Halves(u8);

const HIGH1: u8 = 1;
const HIGH2: u8 = 2;
const SIGNED1: u8 = 4;
const SIGNED2: u8 = 8;
const SATURATING: u8 = 16;

/// A half of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Half {
    /// Signed, bits 15..0.
    SignedLow,
    /// Signed, bits 31..16.
    SignedHigh,
    /// Unsigned, bits 15..0.
    Low,
    /// Unsigned, bits 31..16.
    High,
}

impl Halves {
    /// `s1 half * s2 half`
    pub(super) const fn new(first: Half, second: Half) -> Self {
        let first = match first {
            Half::SignedLow => SIGNED1,
            Half::SignedHigh => SIGNED1 | HIGH1,
            Half::Low => 0,
            Half::High => HIGH1,
        };
        let second = match second {
            Half::SignedLow => SIGNED2,
            Half::SignedHigh => SIGNED2 | HIGH2,
            Half::Low => 0,
            Half::High => HIGH2,
        };
        Self(first | second)
    }

    /// `sat32((s1 half * s2 half) << 1)`
    pub(super) const fn saturating(first: Half, second: Half) -> Self {
        Self(Self::new(first, second).0 | SATURATING)
    }

    /// Decodes a byte of a decoded instruction.
    #[cfg(feature = "native")]
    pub(super) const fn from_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// Reports whether the first source is the high half, and whether it is signed.
    #[cfg(feature = "native")]
    pub(super) const fn first(self) -> (bool, bool) {
        (self.0 & HIGH1 != 0, self.0 & SIGNED1 != 0)
    }

    /// Reports whether the second source is the high half, and whether it is signed.
    #[cfg(feature = "native")]
    pub(super) const fn second(self) -> (bool, bool) {
        (self.0 & HIGH2 != 0, self.0 & SIGNED2 != 0)
    }

    /// Reports whether the product is doubled and clamped.
    #[cfg(feature = "native")]
    pub(super) const fn is_saturating(self) -> bool {
        self.0 & SATURATING != 0
    }

    /// Encodes it as a byte of a decoded instruction.
    pub(super) const fn bits(self) -> u8 {
        self.0
    }
}

/// The product of two sources with the halves and signs given by `halves`.
pub(super) const fn multiply(halves: u8, s1: u32, s2: u32) -> u32 {
    let a = half(s1, halves & HIGH1 != 0, halves & SIGNED1 != 0);
    let b = half(s2, halves & HIGH2 != 0, halves & SIGNED2 != 0);
    let product = a.wrapping_mul(b);
    if halves & SATURATING == 0 {
        return product as u32;
    }
    super::alu::saturate(product << 1)
}

const fn half(source: u32, is_high: bool, is_signed: bool) -> i64 {
    let half = if is_high { source >> 16 } else { source & 0xFFFF };
    if is_signed { half as u16 as i16 as i64 } else { half as i64 }
}
