//! The numbers of the board, each a type of its own.
//!
//! A newtype with a checking constructor means that a thread number cannot be used as
//! an axis number, and that a value once constructed is in range for good.

use std::fmt;

/// An address that a guest program alleges: a number, not an access.
///
/// Only `GuestMemory` turns it into bytes, after checking it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct GuestAddr(u32);

impl GuestAddr {
    /// The null pointer.
    pub const NULL: Self = Self(0);

    /// Makes an address of a number; every number is a claim that may be made.
    #[must_use]
    #[inline]
    pub const fn new(address: u32) -> Self {
        Self(address)
    }

    /// The number itself.
    #[must_use]
    #[inline]
    pub const fn get(self) -> u32 {
        self.0
    }

    /// The address `bytes` further on, wrapping as guest arithmetic does.
    #[must_use]
    #[inline]
    pub const fn offset(self, bytes: u32) -> Self {
        Self(self.0.wrapping_add(bytes))
    }

    /// Reports whether this is the null pointer.
    #[must_use]
    #[inline]
    pub const fn is_null(self) -> bool {
        self.0 == 0
    }
}

impl fmt::Debug for GuestAddr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)
    }
}

impl fmt::Display for GuestAddr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)
    }
}

/// The guest address of an instruction: of bytecode a multiple of 8, of the real processor of 4.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CodeAddr(u32);

impl CodeAddr {
    /// Takes a guest address as one of code; `None` if it is not a multiple of 4.
    #[must_use]
    #[inline]
    pub const fn new(address: u32) -> Option<Self> {
        if address.is_multiple_of(4) { Some(Self(address)) } else { None }
    }

    /// The number itself.
    #[must_use]
    #[inline]
    pub const fn get(self) -> u32 {
        self.0
    }

    /// Converts it to the address of the data.
    #[must_use]
    #[inline]
    pub const fn as_guest_addr(self) -> GuestAddr {
        GuestAddr(self.0)
    }
}

impl fmt::Debug for CodeAddr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)
    }
}

impl fmt::Display for CodeAddr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#010x}", self.0)
    }
}

macro_rules! small_id {
    ($(#[$doc:meta])* $name:ident($repr:ty) = $low:literal..=$high:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name($repr);

        impl $name {
            #[doc = concat!("The largest valid number, ", stringify!($high), ".")]
            pub const MAX: $repr = $high;

            #[doc = concat!("Checks a number; `None` outside ", stringify!($low), "..=", stringify!($high), ".")]
            #[must_use]
            #[inline]
            pub fn new(number: i32) -> Option<Self> {
                ($low..=$high).contains(&number).then_some(Self(number as $repr))
            }

            /// The number itself.
            #[must_use]
            #[inline]
            pub const fn get(self) -> $repr {
                self.0
            }

            /// The number as an index counted from zero.
            #[must_use]
            #[inline]
            pub const fn index(self) -> usize {
                (self.0 - $low) as usize
            }

        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)
            }
        }
    };
}

small_id! {
    /// One of the seven user threads, 1 to 7; the primary thread is not one.
    ThreadId(u8) = 1..=7
}

impl ThreadId {
    /// All threads in ascending order.
    #[inline]
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        (1..=Self::MAX).map(Self)
    }
}

small_id! {
    /// An axis, 0 to 15. A board may have fewer: [`Axes`] are those that it has.
    AxisId(u8) = 0..=15
}

impl AxisId {
    /// The axes of the board that has most, in ascending order.
    #[inline]
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        Axes::new(Axes::MAX).iter()
    }
}

/// The axes of a board, numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes(u8);

impl Axes {
    /// The number of axes of the board that has most.
    pub const MAX: usize = AxisId::MAX as usize + 1;

    /// The first `count` axes, at most [`MAX`](Self::MAX).
    #[must_use]
    pub const fn new(count: usize) -> Self {
        Self(if count < Self::MAX { count as u8 } else { Self::MAX as u8 })
    }

    /// The number of axes.
    #[must_use]
    #[inline]
    pub const fn count(self) -> usize {
        self.0 as usize
    }

    /// The number of the last axis.
    #[must_use]
    pub const fn last(self) -> usize {
        self.count().saturating_sub(1)
    }

    /// Checks a number; `None` unless it is one of these axes.
    #[must_use]
    #[inline]
    pub fn get(self, number: i32) -> Option<AxisId> {
        (0..i32::from(self.0)).contains(&number).then_some(AxisId(number as u8))
    }

    /// The axes in ascending order.
    #[inline]
    pub fn iter(self) -> impl DoubleEndedIterator<Item = AxisId> + ExactSizeIterator + Clone {
        (0..self.0).map(AxisId)
    }
}

small_id! {
    /// A numbered digital input or output, 0 to 2047.
    Bit(u16) = 0..=2047
}

impl Bit {
    /// All bits in ascending order.
    #[inline]
    pub fn all() -> impl DoubleEndedIterator<Item = Self> {
        (0..=Self::MAX).map(Self)
    }
}

/// A count of servo samples (90 µs each) since power-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Ticks(u64);

impl Ticks {
    /// Makes a count of ticks.
    #[must_use]
    #[inline]
    pub const fn new(count: u64) -> Self {
        Self(count)
    }

    /// The count.
    #[must_use]
    #[inline]
    pub const fn get(self) -> u64 {
        self.0
    }

    /// The tick after this one.
    #[must_use]
    pub const fn next(self) -> Self {
        Self(self.0 + 1)
    }
}

/// Processor time in cycles of 5 ns (200 MHz): what code costs and what a slice may spend.
///
/// Also a point in time, counted from power-up. Signed, because a slice's budget may be
/// overdrawn by the block that exhausts it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Cycles(i64);

impl Cycles {
    /// Cycles in one tick of 90 µs.
    pub const PER_TICK: Self = Self(18_000);
    /// Cycles in one second.
    pub const PER_SECOND: Self = Self(200_000_000);

    /// Makes a number of cycles.
    #[must_use]
    #[inline]
    pub const fn new(count: i64) -> Self {
        Self(count)
    }

    /// The count.
    #[must_use]
    #[inline]
    pub const fn get(self) -> i64 {
        self.0
    }
}

impl std::ops::Add for Cycles {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl std::ops::Sub for Cycles {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl std::ops::AddAssign for Cycles {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl std::ops::SubAssign for Cycles {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Width of one access on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccessSize {
    /// 8 bits.
    Byte,
    /// 16 bits.
    Half,
    /// 32 bits.
    Word,
}

impl AccessSize {
    /// Number of bytes.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Byte => 1,
            Self::Half => 2,
            Self::Word => 4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thread_numbers_are_one_to_seven() {
        assert_eq!(ThreadId::new(0), None);
        assert_eq!(ThreadId::new(8), None);
        assert_eq!(ThreadId::new(7).map(ThreadId::index), Some(6));
        assert_eq!(ThreadId::all().count(), 7);
    }

    #[test]
    fn a_board_has_its_axes_and_no_others() {
        let numbers = |axes: Axes| [-1, 7, 8, 15, 16].map(|number| axes.get(number).map(AxisId::get));
        assert_eq!(numbers(Axes::default()), [None, Some(7), None, None, None]);
        assert_eq!(numbers(Axes::new(16)), [None, Some(7), Some(8), Some(15), None]);
        assert_eq!(Axes::new(17), Axes::new(Axes::MAX));
        assert!(Axes::default().iter().map(AxisId::index).eq(0..8));
    }

    #[test]
    fn code_addresses_are_multiples_of_four() {
        assert!(CodeAddr::new(0x8005_0002).is_none());
        assert_eq!(CodeAddr::new(0x8005_0004).map(CodeAddr::get), Some(0x8005_0004));
    }
}
