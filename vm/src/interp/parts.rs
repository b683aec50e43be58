//! The words of a program as they lie in its image, and the operands in them.
//!
//! A word is four 16-bit numbers, so that a handler loads each operand directly from memory, without decoding.

use crate::op::{Op, WORD};
use crate::operand::OperandType;

/// The word of an instruction, the opcode first.
pub(super) type Parts = [u16; WORD / 2];

/// Position of the destination register in a word.
pub(super) const DST: usize = 1;

/// Position of the condition of a branch.
pub(super) const COND: usize = 1;

/// Positions of the operands of an instruction with two.
pub(super) const A: usize = 2;
pub(super) const B: usize = 3;

/// Takes the operands of a word one after another.
pub(super) struct Operands<'a> {
    parts: &'a Parts,
    at: usize,
    links: OperandLinks,
    assigned: AssignedRegisters,
}

/// The positions of two operands: the one assigned by the previous instruction, and the one assigned by the instruction
/// before it; 0 for none.
pub(super) type OperandLinks = [usize; 2];

/// The registers assigned by the previous instruction and by the one before it.
pub(super) type AssignedRegisters = [u16; 2];

impl<'a> Operands<'a> {
    /// The operands of a word; those at `links` are the registers `assigned`.
    #[inline(always)]
    pub(super) const fn of(parts: &'a Parts, links: OperandLinks, assigned: AssignedRegisters) -> Self {
        Self { parts, at: DST, links, assigned }
    }

    /// The next operand.
    ///
    /// A linked operand is replaced by the known register, so that the host's compiler knows its value.
    #[inline(always)]
    pub(super) fn take<O: OperandType>(&mut self) -> O {
        let first = self.at;
        self.at += O::SIZE / 2;
        if first == self.links[0] {
            return O::from_bits(u32::from(self.assigned[0]));
        }
        if first == self.links[1] {
            return O::from_bits(u32::from(self.assigned[1]));
        }
        let high = if O::SIZE == 4 { self.parts[first + 1] } else { 0 };
        O::from_bits(u32::from(self.parts[first]) | u32::from(high) << 16)
    }
}

/// The word of one instruction as it lies in the image.
pub(super) fn parts_of(op: &Op) -> Parts {
    let bytes = op.encode();
    std::array::from_fn(|index| u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]]))
}

/// Reports whether the operands `a` and `b` may be swapped.
pub(super) const fn is_commutative(op: &Op) -> bool {
    matches!(
        op,
        Op::AddI32 { .. }
            | Op::MulI32 { .. }
            | Op::AndI32 { .. }
            | Op::OrI32 { .. }
            | Op::XorI32 { .. }
            | Op::EqI32 { .. }
            | Op::NeI32 { .. }
            | Op::AddF32 { .. }
            | Op::MulF32 { .. }
            | Op::AddF64 { .. }
            | Op::MulF64 { .. }
    )
}
