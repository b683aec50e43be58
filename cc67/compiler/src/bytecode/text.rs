//! The words of a unit, and the operations that move and complete them.
//!
//! In a unit a label counts from the unit's first word, and constants and signatures have the unit's own numbers. A
//! program shares both among its units ([`Renumbering`]), and its words move. Code that links or writes objects handles
//! ranges of words and bytes, not instructions.

use std::ops::Range;

use vm::op::{Op, WORD};
use vm::operand::{Addr, Classes, Count, FuncRef, Label, Pool, SigRef};
use vm::patch::{self, Patch};

use super::head;
use super::registers::Registers;
use super::select::Code;
use crate::ir::function::Signature;
use crate::ir::inst::SignatureId;
use crate::relocation::Relocation;
use crate::source::Span;

/// The words of a unit's functions.
#[derive(Clone, Debug, Default)]
pub struct Text(Vec<Op>);

/// A function as it was added to a text.
#[derive(Debug)]
pub(crate) struct FunctionText {
    /// Its words, beginning with the `func` word.
    pub(crate) words: Range<u32>,
    /// Words that hold addresses, ascending.
    pub(crate) relocations: Vec<Relocation>,
    /// The first word of each run of words that belong to one statement.
    pub(crate) spans: Vec<(u32, Span)>,
}

/// The numbers that a unit's words have in a program.
pub(crate) struct Renumbering<'a> {
    /// By how many words the function moves.
    pub(crate) word_offset: u32,
    /// The program's number of each constant.
    pub(crate) pool: &'a [u32],
    /// The program's number of each signature.
    pub(crate) signatures: &'a [u16],
}

impl Text {
    /// Number of words.
    pub(crate) fn len(&self) -> u32 {
        self.0.len() as u32
    }

    /// The words of a range, each with its number.
    pub(super) fn numbered_words(&self, words: &Range<u32>) -> impl Iterator<Item = (u32, &Op)> {
        (words.clone()).zip(self.0.get(words.start as usize..words.end as usize).unwrap_or_default())
    }

    /// Appends a function of `frame` bytes.
    pub(super) fn append(
        &mut self,
        signature: SignatureId,
        registers: &Registers,
        frame: u32,
        code: Code,
    ) -> FunctionText {
        let first = self.len();
        let regs = Count(registers.classes.len() as u16);
        let sig = SigRef(signature.as_u32() as u16);
        self.0.push(Op::Func { sig, regs, frame: Count((frame / WORD as u32) as u16) });
        for classes in registers.classes.chunks(head::CLASSES) {
            self.0.push(Op::Types { classes: Classes(head::bits(classes)) });
        }
        let start = self.len();
        self.0.extend(code.ops.into_iter().map(|op| offset_label(op, start)));
        let moved = |relocation: Relocation| Relocation { word: relocation.word + start, ..relocation };
        // The function's own line begins at its `func` word.
        let place = |(index, (word, span)): (usize, (u32, Span))| {
            (if index == 0 { first } else { start + word }, span)
        };
        FunctionText {
            words: first..self.len(),
            relocations: code.relocations.into_iter().map(moved).collect(),
            spans: code.spans.into_iter().enumerate().map(place).collect(),
        }
    }

    /// The bytes of each of these words in a program.
    pub(crate) fn linked_bytes<'a>(
        &'a self,
        words: Range<u32>,
        numbers: &'a Renumbering<'_>,
    ) -> impl Iterator<Item = [u8; WORD]> + 'a {
        let words = self.0.get(words.start as usize..words.end as usize).unwrap_or_default();
        words.iter().map(|op| numbers.apply(*op).encode())
    }

    /// Appends the bytes of all words to `bytes`, for an object file that has `head` words before them.
    pub(crate) fn write(&self, head: u32, bytes: &mut Vec<u8>) {
        for op in &self.0 {
            bytes.extend_from_slice(&offset_label(*op, head).encode());
        }
    }

    /// Reads the words that follow `head` others in an object file; `None` if one of them is not an instruction, or
    /// names a constant or signature that the unit does not have.
    pub(crate) fn read(
        words: &[[u8; WORD]],
        head: u32,
        pool: &[u64],
        signatures: &[Signature],
    ) -> Option<Self> {
        let words = words.get(head as usize..)?;
        words.iter().map(|word| decode(*word, head, pool, signatures)).collect::<Option<_>>().map(Self)
    }

    /// Signature and bytes of the frame of the function that these words are; `None` if they are not one function.
    pub(crate) fn function(&self, words: &Range<u32>) -> Option<(SignatureId, u32)> {
        let (first, rest) = self.0.get(words.start as usize..words.end as usize)?.split_first()?;
        let Op::Func { sig, frame, .. } = first else { return None };
        if rest.iter().any(|op| matches!(op, Op::Func { .. })) {
            return None;
        }
        Some((SignatureId::from_u32(u32::from(sig.0)), u32::from(frame.0) * WORD as u32))
    }

    /// Reports whether a function begins at a word.
    pub(crate) fn begins_function(&self, word: u32) -> bool {
        matches!(self.0.get(word as usize), Some(Op::Func { .. }))
    }
}

impl Renumbering<'_> {
    fn apply(&self, mut op: Op) -> Op {
        op.patch(&mut ProgramPatch(self));
        op
    }
}

/// Gives a unit's words their numbers in the program.
struct ProgramPatch<'a>(&'a Renumbering<'a>);

impl Patch for ProgramPatch<'_> {
    fn label(&mut self, label: &mut Label) {
        label.0 = label.0.wrapping_add(self.0.word_offset);
    }

    fn constant(&mut self, pool: &mut Pool) {
        pool.0 = self.0.pool.get(pool.0 as usize).copied().unwrap_or(pool.0);
    }

    fn signature(&mut self, sig: &mut SigRef) {
        sig.0 = self.0.signatures.get(usize::from(sig.0)).copied().unwrap_or(sig.0);
    }
}

/// Converts words of an object file, whose first words are not the unit's, and resolves the names in them.
struct ObjectFilePatch<'a> {
    head: u32,
    pool: &'a [u64],
    signatures: &'a [Signature],
    /// True if an index is out of the unit's range.
    is_wrong: bool,
}

impl Patch for ObjectFilePatch<'_> {
    fn label(&mut self, label: &mut Label) {
        match label.0.checked_sub(self.head) {
            Some(word) => label.0 = word,
            None => self.is_wrong = true,
        }
    }

    fn constant(&mut self, pool: &mut Pool) {
        self.is_wrong |= self.pool.get(pool.0 as usize).is_none();
    }

    fn signature(&mut self, sig: &mut SigRef) {
        self.is_wrong |= self.signatures.get(usize::from(sig.0)).is_none();
    }
}

/// The word that calls the program's function at a byte of the text.
pub(crate) fn call(offset: u32) -> [u8; WORD] {
    Op::Call { func: FuncRef(offset / WORD as u32) }.encode()
}

/// The word that calls the firmware's function at an address; `signature` is the program's number of its signature.
pub(crate) fn call_firmware(address: u32, signature: u16) -> [u8; WORD] {
    Op::CallFw { sig: SigRef(signature), addr: Addr(address) }.encode()
}

/// The instruction with its label moved.
fn offset_label(mut op: Op, by: u32) -> Op {
    patch::labels(&mut op, |word| word + by);
    op
}

/// Decodes a word of a function; `None` if it refers to something that the unit does not have.
fn decode(word: [u8; WORD], head: u32, pool: &[u64], signatures: &[Signature]) -> Option<Op> {
    let mut op = Op::decode(word)?;
    // These only occur in the head of a file, and in linked programs.
    if matches!(op, Op::Program { .. } | Op::Sig { .. } | Op::Call { .. }) {
        return None;
    }
    let mut file = ObjectFilePatch { head, pool, signatures, is_wrong: false };
    op.patch(&mut file);
    (!file.is_wrong).then_some(op)
}
