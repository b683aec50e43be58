//! The arguments of a firmware call, as every engine hands them over.
//!
//! Each engine passes arguments in its own way: bytecode in the registers after those of the caller, machine code in
//! the state that it shares with the engine, the real processor in A4, B4, A6, B6 and so on and then on its stack. The
//! firmware sees none of that. It takes arguments by position, and the variable part of a variadic call by its address
//! ([`VarArgs`]). Its result is a [`Value`](crate::firmware::Value), which the engine puts where its programs look for
//! it.

use kmotiondef::GuestAddr;

use crate::operand::Class;
use crate::slot::Slot;
use crate::varargs::VarArgs;

/// The arguments of one firmware call, by position, each as the slot of its class.
#[derive(Clone, Copy, Debug)]
pub struct CallArguments<'a>(&'a [u64]);

impl<'a> CallArguments<'a> {
    /// No arguments.
    pub const NONE: Self = Self(&[]);

    /// Call arguments in consecutive slots.
    #[must_use]
    pub const fn from_slots(slots: &'a [u64]) -> Self {
        Self(slots)
    }

    /// The argument at `position`, counted from 0; 0 after the last one.
    #[must_use]
    #[inline]
    pub fn get<T: Slot>(self, position: usize) -> T {
        T::from_slot(self.0.get(position).copied().unwrap_or_default())
    }

    /// The variable part of a variadic call, whose address is the argument at `position`.
    #[must_use]
    pub fn varargs(self, position: usize) -> VarArgs {
        VarArgs::new(self.get::<GuestAddr>(position))
    }
}

/// A buffer in which an engine gathers the arguments of a call if its programs do not keep them in slots.
#[derive(Clone, Debug, Default)]
pub struct ArgumentList(Vec<u64>);

impl ArgumentList {
    /// The arguments of a call with `parameters`: `argument` yields each as a slot, by its position and class.
    ///
    /// The last parameter of a variadic function is the address of its variable part.
    pub fn gather(
        &mut self,
        parameters: &[Class],
        mut argument: impl FnMut(usize, Class) -> u64,
    ) -> CallArguments<'_> {
        self.0.clear();
        self.0.extend(parameters.iter().enumerate().map(|(position, class)| argument(position, *class)));
        CallArguments(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::map::SDRAM;

    use super::*;
    use crate::memory::GuestMemory;

    #[test]
    fn arguments_are_found_by_position_wherever_an_engine_keeps_them() {
        // As on the real processor: a single in A4, a double in B5:B4, the variable part on the stack.
        let (a4, b4, b5) = (1.5_f32.to_bits(), 0_u32, 0x4004_0000_u32);
        let mut memory = GuestMemory::new();
        memory.poke(SDRAM.base.offset(8), -7_i32);
        memory.poke(SDRAM.base.offset(16), 0.25_f64);
        let mut list = ArgumentList::default();
        let arguments =
            list.gather(&[Class::F32, Class::F64, Class::I32], |position, class| match (position, class) {
                (0, Class::F32) => u64::from(a4),
                (1, Class::F64) => u64::from(b5) << 32 | u64::from(b4),
                _ => SDRAM.base.offset(8).into_slot(),
            });
        assert_eq!(arguments.get::<f32>(0).to_bits(), a4);
        assert_eq!(arguments.get::<f64>(1).to_bits(), 2.5_f64.to_bits());
        let mut rest = arguments.varargs(2);
        assert_eq!(rest.take(&memory), Ok(-7_i32));
        assert_eq!(rest.take(&memory), Ok(0.25_f64));
        assert_eq!(arguments.get::<i32>(3), 0);
    }
}
