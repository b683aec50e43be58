//! `setjmp` and `longjmp`: functions that no firmware has.
//!
//! Code for the controller's processor contains them. Bytecode calls them at addresses where no board has anything,
//! and the engine does what they say.

use crate::GuestAddr;
use crate::ids::Cycles;

/// `setjmp` or `longjmp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JumpFunction {
    /// `int setjmp(jmp_buf place)`
    Set,
    /// `void longjmp(jmp_buf place, int value)`
    Long,
}

impl JumpFunction {
    /// Both functions.
    pub const ALL: [Self; 2] = [Self::Set, Self::Long];

    /// The function of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }

    /// The function at this address.
    #[must_use]
    pub fn at(address: GuestAddr) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.address() == address)
    }

    /// The name that programs use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Set => "setjmp",
            Self::Long => "longjmp",
        }
    }

    /// The address at which bytecode calls it.
    #[must_use]
    pub const fn address(self) -> GuestAddr {
        GuestAddr::new(match self {
            Self::Set => 0x7000_F000,
            Self::Long => 0x7000_F008,
        })
    }

    /// Number of parameters, all of them words.
    #[must_use]
    pub const fn parameters(self) -> usize {
        match self {
            Self::Set => 1,
            Self::Long => 2,
        }
    }

    /// Reports whether it returns a word.
    #[must_use]
    pub const fn has_result(self) -> bool {
        match self {
            Self::Set => true,
            Self::Long => false,
        }
    }

    /// The cycles that the processor's code for it takes.
    #[must_use]
    pub const fn cost(self) -> Cycles {
        Cycles::new(match self {
            Self::Set => 16,
            Self::Long => 18,
        })
    }
}
