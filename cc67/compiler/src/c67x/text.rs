//! The words of a unit's functions, with the parts for the linker to complete.

use std::ops::Range;

use c67x::assemble;
use c67x::{Inst, Op, Operand, Pred, Side};

use super::abi;
use crate::relocation::FixupKind;
use crate::source::Span;
use crate::typed::SymbolId;

/// A word that the linker completes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixup {
    /// The word, in the function.
    pub(crate) word: u32,
    pub(crate) kind: FixupKind,
    /// The symbol whose address is used; `None` for the function's own.
    pub(crate) symbol: Option<SymbolId>,
}

/// A function in words.
#[derive(Debug)]
pub(crate) struct MachineText {
    /// Its words in the unit's text.
    pub(crate) words: Range<u32>,
    pub(crate) fixups: Vec<Fixup>,
    /// The first word, in the unit, of each run of words that belong to one statement.
    pub(crate) spans: Vec<(u32, Span)>,
    /// Bytes of its frame.
    pub(crate) frame: u32,
    /// Its loops that are scheduled without overlap because the search exceeded its budget.
    pub(crate) exceeded: Vec<Span>,
}

/// The word of an `MVK` or `MVKH` with another constant of 16 bits.
pub(crate) const fn with_half_constant(word: u32, constant: u32) -> u32 {
    word & !(0xFFFF << 7) | (constant & 0xFFFF) << 7
}

/// The constant of an `MVK` or `MVKH`.
pub(crate) const fn constant(word: u32) -> u32 {
    word >> 7 & 0xFFFF
}

/// The word of a branch at an address with another target.
pub(crate) const fn branch(word: u32, at: u32, target: u32) -> u32 {
    let bytes = target.wrapping_sub(at & !(c67x::FETCH_PACKET - 1)).cast_signed();
    word & !(0x1F_FFFF << 7) | ((bytes >> 2).cast_unsigned() & 0x1F_FFFF) << 7
}

/// The words of assembler text, an instruction a line.
pub(crate) fn assemble_words(text: &str) -> Vec<u32> {
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let lines: Vec<_> = lines.filter_map(|line| assemble(line, 0).ok()).collect();
    let joins = |next: usize| lines.get(next).is_some_and(|line| line.joins_previous);
    lines.iter().enumerate().map(|(index, line)| line.inst.encode(joins(index + 1))).collect()
}

/// The words of a jump to any address; they change only the register of indirect calls.
pub(crate) fn far_jump(address: u32) -> Vec<u32> {
    let reg = Operand::Reg(abi::TARGET);
    let low = i32::from(address.cast_signed() as i16);
    let high = (address >> 16).cast_signed();
    let insts = [
        Inst::new(Op::Mvk, Side::B, Pred::Always, &[Operand::Const(low), reg]),
        Inst::new(Op::Mvkh, Side::B, Pred::Always, &[Operand::Const(high), reg]),
        Inst::new(Op::BReg, Side::B, Pred::Always, &[reg]),
    ];
    let words = insts.into_iter().flatten().map(|inst| inst.encode(false));
    words.chain([Inst::nop(5).encode(false)]).collect()
}
