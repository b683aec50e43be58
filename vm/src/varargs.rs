//! Variable arguments of a firmware call, as the compiler lays them out.
//!
//! They are consecutive in guest memory, each at a multiple of its own size (4 or 8), the first at a multiple of 8.
//! Their address is the last parameter of the function.

use kmotiondef::GuestAddr;

use crate::memory::{GuestMemory, Scalar};
use crate::trap::TrapKind;

/// Reads variable arguments one after another.
#[derive(Clone, Copy, Debug)]
pub struct VarArgs {
    next: GuestAddr,
}

impl VarArgs {
    /// The arguments that begin at `address`.
    #[must_use]
    pub const fn new(address: GuestAddr) -> Self {
        Self { next: address }
    }

    /// Takes the next argument, of four or eight bytes.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] if it is outside memory.
    pub fn take<T: Scalar>(&mut self, memory: &GuestMemory) -> Result<T, TrapKind> {
        let address = GuestAddr::new(self.next.get().wrapping_add(T::SIZE - 1) & !(T::SIZE - 1));
        self.next = address.offset(T::SIZE);
        memory.load(address)
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::map::SDRAM;

    use super::*;

    #[test]
    fn each_argument_is_aligned_to_its_own_size() {
        let mut memory = GuestMemory::new();
        memory.poke(SDRAM.base, 7_i32);
        memory.poke(SDRAM.base.offset(8), 2.5_f64);
        memory.poke(SDRAM.base.offset(16), -1_i32);
        let mut arguments = VarArgs::new(SDRAM.base);
        assert_eq!(arguments.take(&memory), Ok(7_i32));
        assert_eq!(arguments.take(&memory), Ok(2.5_f64));
        assert_eq!(arguments.take(&memory), Ok(-1_i32));
    }
}
