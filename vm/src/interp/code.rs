//! What the interpreter executes: the words of a program as they lie in its image.
//!
//! A word is kept as four numbers of 16 bits, the opcode first, so that a handler takes each operand
//! from memory by itself and need not ask which instruction it is.

use std::fmt;
use std::sync::Arc;

use super::sequences::{self, BREAK};
use crate::op::{Op, WORD};
use crate::operand::OperandType;
use crate::program::{MAX_TEXT, Program};

/// One instruction.
pub(super) type Word = [u16; WORD / 2];

/// Room for the longest text, as a power of two: an index is cut to it instead of being compared.
const CAPACITY: usize = (MAX_TEXT / WORD).next_power_of_two();

/// The words of a program by index; after the last one of it there are only `program` words, which trap.
pub(super) type Words = [Word; CAPACITY];

/// The word `pc`.
#[inline(always)]
pub(super) const fn word_at(words: &Words, pc: usize) -> &Word {
    &words[pc % CAPACITY]
}

/// Takes the operands of a word one after another.
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
    pub(super) fn take<O: OperandType>(&mut self) -> O {
        let first = self.at;
        self.at += O::SIZE / 2;
        let high = if O::SIZE == 4 { self.word[first + 1] } else { 0 };
        O::from_bits(u32::from(self.word[first]) | u32::from(high) << 16)
    }
}

/// The words of one program.
#[derive(Clone)]
pub(super) struct Encoded(Box<Words>);

impl Encoded {
    /// Those of `ops`; verification refuses a text that is longer than the program area.
    pub(super) fn new(ops: &[Op]) -> Self {
        Self(encode(ops, &|_, _| false))
    }

    /// The same, where a debugger holds contexts at some words.
    pub(super) fn held(ops: &[Op], is_held: &dyn Fn(usize, &Op) -> bool) -> Self {
        Self(encode(ops, is_held))
    }

    /// The words.
    pub(super) const fn words(&self) -> &Words {
        &self.0
    }
}

impl fmt::Debug for Encoded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Encoded")
    }
}

/// A program as the interpreter has it.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// The program.
    pub(super) program: Arc<Program>,
    /// Its words.
    pub(super) words: Arc<Encoded>,
}

/// The word of one instruction, which stands for itself alone.
pub(super) fn plain_word(op: &Op) -> Word {
    let bytes = op.encode();
    std::array::from_fn(|index| u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]]))
}

/// A text in which a context is held at every word.
pub(super) fn all_held() -> Box<Words> {
    vec![[BREAK; WORD / 2]; CAPACITY].into_boxed_slice().try_into().expect("it is of that length")
}

/// The words of instructions, of which those that are held have an opcode that stops a context.
fn encode(ops: &[Op], is_held: &dyn Fn(usize, &Op) -> bool) -> Box<Words> {
    let mut words: Box<Words> =
        vec![[0; WORD / 2]; CAPACITY].into_boxed_slice().try_into().expect("it is of that length");
    for (word, op) in words.iter_mut().zip(ops) {
        *word = plain_word(op);
    }
    let held = |(pc, op): (usize, &Op)| if is_held(pc, op) { BREAK } else { words[pc][0] };
    let codes: Vec<u16> = ops.iter().enumerate().map(held).collect();
    for (pc, word) in words.iter_mut().enumerate().take(ops.len()) {
        word[0] = sequences::opcode(ops, &codes, pc);
    }
    words
}
