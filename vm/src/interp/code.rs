//! What the interpreter executes: the words of a program as they lie in its image.
//!
//! A word is kept as four numbers of 16 bits, the opcode first, so that a handler takes each operand
//! from memory by itself and need not ask which instruction it is.

use std::fmt;
use std::sync::OnceLock;

use super::sequences;
use crate::op::{Op, WORD};
use crate::operand::Operand;
use crate::program::MAX_TEXT;

/// One instruction.
pub(super) type Word = [u16; WORD / 2];

/// Room for the longest text, as a power of two: an index is cut to it instead of being compared.
const CAPACITY: usize = (MAX_TEXT / WORD).next_power_of_two();

/// The words of a program by index; behind the last one of it there are only `program` words, which trap.
pub(super) type Words = [Word; CAPACITY];

/// The word `pc`.
#[inline(always)]
pub(super) const fn word_at(words: &Words, pc: usize) -> &Word {
    &words[pc % CAPACITY]
}

/// Takes the operands of a word one behind the other.
pub(super) struct Operands<'a> {
    word: &'a Word,
    at: usize,
}

impl<'a> Operands<'a> {
    /// Those of `word`.
    #[inline(always)]
    pub(super) const fn of(word: &'a Word) -> Self {
        Self { word, at: 1 }
    }

    /// The next operand.
    #[inline(always)]
    pub(super) fn take<O: Operand>(&mut self) -> O {
        let first = self.at;
        self.at += O::SIZE / 2;
        let high = if O::SIZE == 4 { self.word[first + 1] } else { 0 };
        O::from_bits(u32::from(self.word[first]) | u32::from(high) << 16)
    }
}

/// The words of a program, made when it is first interpreted; a copy makes its own.
///
/// They follow from the program, so two programs are equal whether or not they have them.
#[derive(Default)]
pub(crate) struct Code(OnceLock<Box<Words>>);

impl Code {
    /// The words of the program that has `ops` and holds this.
    pub(super) fn words(&self, ops: &[Op]) -> &Words {
        self.0.get_or_init(|| encode(ops))
    }
}

/// The words of `ops`; verification refuses a text that is longer than the program area.
fn encode(ops: &[Op]) -> Box<Words> {
    let mut words: Box<Words> =
        vec![[0; WORD / 2]; CAPACITY].into_boxed_slice().try_into().expect("it is of that length");
    for (word, op) in words.iter_mut().zip(ops) {
        let bytes = op.encode();
        *word = std::array::from_fn(|index| u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]]));
    }
    let codes: Vec<u16> = words[..ops.len()].iter().map(|word| word[0]).collect();
    for (pc, word) in words.iter_mut().enumerate().take(ops.len()) {
        word[0] = sequences::opcode(ops, &codes, pc);
    }
    words
}

impl Clone for Code {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Code").field(&self.0.get().is_some()).finish()
    }
}

impl PartialEq for Code {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Code {}
