//! A program of the real processor, as a thread is loaded with it.

use std::ops::Range;

use kmotiondef::GuestAddr;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT};

/// Code of the real processor; its words are in guest memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    code: Range<GuestAddr>,
    is_protected: bool,
    returns_to: GuestAddr,
}

impl Image {
    /// Code at `text`, whose outermost function returns to the firmware function at `returns_to`.
    #[must_use]
    pub const fn new(text: Range<GuestAddr>, returns_to: GuestAddr) -> Self {
        Self { code: text, is_protected: true, returns_to }
    }

    /// Code among `code` whose data may be there as well.
    #[must_use]
    pub const fn unprotected(code: Range<GuestAddr>, returns_to: GuestAddr) -> Self {
        Self { code, is_protected: false, returns_to }
    }

    /// The addresses that its code lies among.
    #[must_use]
    pub fn code(&self) -> Range<GuestAddr> {
        self.code.clone()
    }

    /// The addresses that hold nothing but its code.
    #[must_use]
    pub fn text(&self) -> Range<GuestAddr> {
        if self.is_protected { self.code.clone() } else { self.code.start..self.code.start }
    }

    /// Where its outermost function returns to, as B3 says at the start of a thread.
    #[must_use]
    pub const fn returns_to(&self) -> GuestAddr {
        self.returns_to
    }

    /// Whether a function may begin at an address: a word of its code.
    #[must_use]
    pub fn has_function(&self, address: GuestAddr) -> bool {
        address.get().is_multiple_of(4) && self.code.contains(&address)
    }

    /// Whether code at an address is executed, and not called as a firmware function.
    #[must_use]
    pub const fn is_code(address: u32) -> bool {
        address >= PROGRAM_BASE && address < PROGRAM_LIMIT
    }
}
