//! Operands, as named by users and code generators.

use std::fmt;

use crate::kind::{Kind, Mode, OffsetKind, Update};
use crate::register::{Control, Pair, Reg};

/// An operand of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// A register.
    Reg(Reg),
    /// A register pair: a double, a 40-bit long, or the two words of an `LDDW`.
    Pair(Pair),
    /// A constant: for `MVKH` the upper 16 bits as a number, for `NOP` the cycles 1..=9.
    Const(i32),
    /// Bytes from the address of the branch's fetch packet (its address with the low five bits 0).
    Target(i32),
    /// An address.
    Mem(Mem),
    /// A control register.
    Control(Control),
    /// The word `IRP` of a branch that returns from an interrupt.
    Irp,
    /// The word `NRP`.
    Nrp,
}

/// An address of a load or store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mem {
    /// The base register; its side is the side of the .D unit (B for a 15-bit offset).
    pub base: Reg,
    /// True if the offset is subtracted.
    pub negative: bool,
    /// The update of the base register.
    pub update: Update,
    /// The offset, in units of the access's size.
    pub offset: Offset,
}

/// The offset of an address, in units of the access's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Offset {
    /// A constant: 0..=31, or 0..=32767 with base B14 or B15 and no update.
    Const(u16),
    /// A signed register of the base's file.
    Reg(Reg),
}

impl Mem {
    /// `*+base[offset]`
    #[must_use]
    pub const fn at(base: Reg, offset: u16) -> Self {
        Self { base, negative: false, update: Update::None, offset: Offset::Const(offset) }
    }

    /// `*+base[register]`
    #[must_use]
    pub const fn indexed(base: Reg, offset: Reg) -> Self {
        Self { base, negative: false, update: Update::None, offset: Offset::Reg(offset) }
    }

    /// `*base++[offset]`
    #[must_use]
    pub const fn post_increment(base: Reg, offset: u16) -> Self {
        Self { base, negative: false, update: Update::After, offset: Offset::Const(offset) }
    }

    /// `*base--[offset]`
    #[must_use]
    pub const fn post_decrement(base: Reg, offset: u16) -> Self {
        Self { base, negative: true, update: Update::After, offset: Offset::Const(offset) }
    }

    /// `*++base[offset]`
    #[must_use]
    pub const fn pre_increment(base: Reg, offset: u16) -> Self {
        Self { base, negative: false, update: Update::Before, offset: Offset::Const(offset) }
    }

    /// Reports whether a form with addresses of `kind` can express it.
    #[must_use]
    pub fn fits(&self, kind: Kind) -> bool {
        let Some(Mode { negative, update, offset }) = kind.mode() else { return false };
        let matching = match (offset, self.offset) {
            (OffsetKind::U5, Offset::Const(offset)) => offset < 32,
            (OffsetKind::U15, Offset::Const(offset)) => {
                offset < 0x8000 && (self.base == Reg::b(14) || self.base == Reg::b(15))
            }
            (OffsetKind::Reg, Offset::Reg(reg)) => reg.side() == self.base.side(),
            (OffsetKind::U5 | OffsetKind::U15, Offset::Reg(_)) | (OffsetKind::Reg, Offset::Const(_)) => false,
        };
        matching && negative == self.negative && update == self.update
    }
}

impl fmt::Display for Mem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.negative { '-' } else { '+' };
        match self.update {
            Update::None => write!(f, "*{sign}{}", self.base)?,
            Update::Before => write!(f, "*{sign}{sign}{}", self.base)?,
            Update::After => write!(f, "*{}{sign}{sign}", self.base)?,
        }
        match self.offset {
            Offset::Const(offset) => write!(f, "[{offset}]"),
            Offset::Reg(reg) => write!(f, "[{reg}]"),
        }
    }
}

impl From<Reg> for Operand {
    fn from(reg: Reg) -> Self {
        Self::Reg(reg)
    }
}

impl From<Pair> for Operand {
    fn from(pair: Pair) -> Self {
        Self::Pair(pair)
    }
}

impl From<Mem> for Operand {
    fn from(mem: Mem) -> Self {
        Self::Mem(mem)
    }
}

impl From<i32> for Operand {
    fn from(value: i32) -> Self {
        Self::Const(value)
    }
}
