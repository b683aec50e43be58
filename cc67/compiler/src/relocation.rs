//! Words of code that the linker completes, for both back ends.

use crate::ir::inst::SignatureId;
use crate::typed::SymbolId;

/// A word of the text that the linker completes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Relocation {
    /// Index of the word.
    pub word: u32,
    /// The kind of relocation.
    pub kind: RelocationKind,
    /// The symbol whose address is inserted.
    pub symbol: SymbolId,
}

/// The kind of a relocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelocationKind {
    /// The symbol's address is added to the last four bytes of the word.
    Address,
    /// The word calls the firmware; it calls a function of the program if the symbol is one.
    Call(SignatureId),
    /// A word of a real processor.
    Processor(FixupKind),
}

/// The kind of a relocation of a real processor's word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixupKind {
    /// The low half of an address, plus an offset, as the constant of the instruction.
    Low(i32),
    /// The high half, for another instruction.
    High(i32),
    /// The displacement of a branch.
    Near,
    /// A whole word: the function's own address plus an offset.
    Own(i32),
}
