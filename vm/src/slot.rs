//! Register slots: the representation of values of each class in the 64 bits of a register.
//!
//! Values of 32 bits are kept zero-extended, floating values as their bit patterns.

use kmotiondef::GuestAddr;

use crate::operand::Class;

/// A Rust type that a register can hold.
pub trait Slot: Copy {
    /// Class of the register.
    const CLASS: Class;

    /// The value in a slot.
    fn from_slot(slot: u64) -> Self;

    /// The slot that holds the value.
    fn into_slot(self) -> u64;
}

impl Slot for i32 {
    const CLASS: Class = Class::I32;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        slot as Self
    }

    #[inline]
    fn into_slot(self) -> u64 {
        u64::from(self.cast_unsigned())
    }
}

impl Slot for u32 {
    const CLASS: Class = Class::I32;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        slot as Self
    }

    #[inline]
    fn into_slot(self) -> u64 {
        u64::from(self)
    }
}

impl Slot for GuestAddr {
    const CLASS: Class = Class::I32;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        Self::new(slot as u32)
    }

    #[inline]
    fn into_slot(self) -> u64 {
        u64::from(self.get())
    }
}

impl Slot for i64 {
    const CLASS: Class = Class::I64;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        slot.cast_signed()
    }

    #[inline]
    fn into_slot(self) -> u64 {
        self.cast_unsigned()
    }
}

impl Slot for f32 {
    const CLASS: Class = Class::F32;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        Self::from_bits(slot as u32)
    }

    #[inline]
    fn into_slot(self) -> u64 {
        u64::from(self.to_bits())
    }
}

impl Slot for f64 {
    const CLASS: Class = Class::F64;

    #[inline]
    fn from_slot(slot: u64) -> Self {
        Self::from_bits(slot)
    }

    #[inline]
    fn into_slot(self) -> u64 {
        self.to_bits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_32_bits_are_zero_extended() {
        assert_eq!((-1_i32).into_slot(), 0xffff_ffff);
        assert_eq!(i32::from_slot(0xffff_ffff), -1);
        assert_eq!((-1.0_f32).into_slot(), 0xbf80_0000);
        assert_eq!(f64::from_slot((-2.5_f64).into_slot()).to_bits(), (-2.5_f64).to_bits());
    }
}
