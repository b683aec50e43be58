//! Instructions as text.
//!
//! `|| [!A1] LDW .D1T2 *+A4[3],B5`: bars for an instruction that executes in parallel with the previous one, the
//! condition, the name, the unit with its cross or data path, the operands. [`crate::assemble`] reads this text back to
//! the same word: if the text alone would give another word (because of a field that the processor ignores, or a second
//! form for the same operands), the word follows in braces.

use std::fmt;

use crate::assemble::assemble;
use crate::inst::Inst;

impl Inst {
    /// The text of the instruction at an address: branches show their targets.
    #[must_use]
    pub fn text(self, at: u32) -> String {
        self.print(Some(at))
    }

    fn print(self, at: Option<u32>) -> String {
        let plain = self.plain_text(at);
        match assemble(&plain, at.unwrap_or(0)) {
            Ok(line) if line.inst == self => plain,
            _ => format!("{plain} {{{:08X}}}", self.encode(false)),
        }
    }
}

impl fmt::Display for Inst {
    /// The text without an address: a branch shows its distance from its fetch packet, `pc+16`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.print(None))
    }
}

impl fmt::Debug for Inst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} ({:08X}, {})", self.encode(false), self.op().id())
    }
}
