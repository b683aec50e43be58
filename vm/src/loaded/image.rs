//! A program of the real processor, as a thread is loaded with it.

use std::ops::Range;
use std::sync::Arc;

use kmotiondef::GuestAddr;
use kmotiondef::map::{KOGNA_PROGRAMS, MemoryMap};

/// Code of the real processor; its words are in guest memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    code: Range<GuestAddr>,
    is_protected: bool,
    returns_to: GuestAddr,
    /// The start addresses of functions, from the symbols, in ascending order.
    functions: Arc<[u32]>,
}

impl Image {
    /// Code at `text`, whose outermost function returns to the firmware function at `returns_to`.
    #[must_use]
    pub fn new(text: Range<GuestAddr>, returns_to: GuestAddr) -> Self {
        Self::among(text, true, returns_to)
    }

    /// Code within `code`, a range that may also contain data.
    #[must_use]
    pub fn unprotected(code: Range<GuestAddr>, returns_to: GuestAddr) -> Self {
        Self::among(code, false, returns_to)
    }

    fn among(code: Range<GuestAddr>, is_protected: bool, returns_to: GuestAddr) -> Self {
        Self { code, is_protected, returns_to, functions: Arc::default() }
    }

    /// Sets the addresses at which its functions begin.
    #[must_use]
    pub fn with_functions(mut self, mut addresses: Vec<u32>) -> Self {
        addresses.sort_unstable();
        self.functions = addresses.into();
        self
    }

    /// Reports whether one of the known functions begins at an address.
    #[must_use]
    pub fn begins_function(&self, address: u32) -> bool {
        self.functions.binary_search(&address).is_ok()
    }

    /// Reports whether it is code for a Kogna, judging by its address.
    #[must_use]
    pub const fn is_for_kogna(&self) -> bool {
        KOGNA_PROGRAMS.holds(self.code.start.get())
    }

    /// The range of addresses that contains its code.
    #[must_use]
    pub fn code(&self) -> Range<GuestAddr> {
        self.code.clone()
    }

    /// The addresses that hold only its code.
    #[must_use]
    pub fn text(&self) -> Range<GuestAddr> {
        if self.is_protected { self.code.clone() } else { self.code.start..self.code.start }
    }

    /// The return address of its outermost function, in B3 at the start of a thread.
    #[must_use]
    pub const fn returns_to(&self) -> GuestAddr {
        self.returns_to
    }

    /// Reports whether a function may begin at an address: a word of its code.
    #[must_use]
    pub fn has_function(&self, address: GuestAddr) -> bool {
        address.get().is_multiple_of(4) && self.code.contains(&address)
    }

    /// Reports whether code at an address is executed, and not called as a firmware function.
    #[must_use]
    pub const fn is_code(address: u32) -> bool {
        MemoryMap::KFLOP.programs.holds(address) || KOGNA_PROGRAMS.holds(address)
    }
}
