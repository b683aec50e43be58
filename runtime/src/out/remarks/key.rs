//! Arguments of remarks as numbers.

use kmotiondef::{AxisId, Bit, ThreadId};

/// An argument that distinguishes remarks of one kind.
pub(super) trait Key {
    /// The argument as a number.
    fn key(&self) -> u64;
}

impl Key for AxisId {
    fn key(&self) -> u64 {
        self.get().into()
    }
}

impl Key for Bit {
    fn key(&self) -> u64 {
        self.get().into()
    }
}

impl Key for ThreadId {
    fn key(&self) -> u64 {
        self.get().into()
    }
}

impl Key for i32 {
    fn key(&self) -> u64 {
        u64::from(self.cast_unsigned())
    }
}

impl Key for usize {
    fn key(&self) -> u64 {
        *self as u64
    }
}

impl Key for u32 {
    fn key(&self) -> u64 {
        (*self).into()
    }
}
