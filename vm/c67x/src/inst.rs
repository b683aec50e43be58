//! One instruction: a form with its operands and condition, stored as the processor's word.
//!
//! An [`Inst`] is always valid: it comes from a word that is in the table, or from operands that fit a form. So
//! operations on an [`Inst`] cannot fail.

use thiserror::Error;

use crate::kind::{Field, Kind, OffsetKind};
use crate::mnemonic::Mnemonic;
use crate::operand::{Mem, Offset, Operand};
use crate::register::{Control, Pred, Reg, Side, Unit, UnitKind};
use crate::table::Op;

/// Bit p: the next word executes in parallel.
pub const PARALLEL: u32 = 1;

/// Bit s: the side of the destination.
const SIDE: u32 = 1;
/// Bit y: the side of the base register.
const BASE_SIDE: u32 = 7;
/// Bit x: the cross path.
const CROSS: u32 = 12;

/// A valid instruction.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Inst {
    op: Op,
    /// Bit p is 0.
    word: u32,
}

/// A word that is not an instruction of this processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BadWord {
    /// No row of the table matches.
    #[error("{0:08X} is not an instruction of this processor")]
    Unknown(u32),
    /// Bits creg and z hold a pattern that is reserved.
    #[error("{0:08X} has a reserved condition")]
    Condition(u32),
}

/// Operands that do not fit a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BadOperands {
    /// The number of operands is wrong.
    #[error("{form} takes {wanted} operands, not {given}", form = .op.row().mnemonic)]
    Count {
        /// The form.
        op: Op,
        /// Number of operands of the form.
        wanted: usize,
        /// Number of operands given.
        given: usize,
    },
    /// An operand of another kind, of the wrong file, or out of range.
    #[error("operand {} of {form} does not fit: {wanted:?} is needed", .index + 1, form = .op.row().mnemonic)]
    Operand {
        /// The form.
        op: Op,
        /// Index of the operand, from 0.
        index: usize,
        /// The kind of operand that the form takes there.
        wanted: Kind,
    },
    /// The form exists only on the other side, or has no condition.
    #[error("{form} does not exist on side {side} or under a condition", form = .op.row().mnemonic)]
    Unit {
        /// The form.
        op: Op,
        /// The side requested.
        side: Side,
    },
}

impl Inst {
    /// The instruction in a word; bit p is ignored.
    ///
    /// # Errors
    /// No form of the table has this word, or its condition is reserved.
    pub fn decode(word: u32) -> Result<Self, BadWord> {
        let word = word & !PARALLEL;
        let mut forms = Op::ALL.iter().copied().filter(|op| word & op.row().mask == op.row().value);
        let op = forms.find(|op| has_valid_fields(*op, word)).ok_or(BadWord::Unknown(word))?;
        Pred::from_word(word).ok_or(BadWord::Condition(word))?;
        Ok(Self { op, word })
    }

    /// The instruction of a form on the unit of `side`, with operands in the order of the text.
    ///
    /// For loads and stores, `side` must be that of the base register (B for a 15-bit offset); for `NOP` and `IDLE` it
    /// must be A.
    ///
    /// # Errors
    /// The operands do not fit the form, or it does not exist on that side.
    pub fn new(op: Op, side: Side, pred: Pred, operands: &[Operand]) -> Result<Self, BadOperands> {
        let row = op.row();
        if operands.len() != row.operands.len() {
            return Err(BadOperands::Count { op, wanted: row.operands.len(), given: operands.len() });
        }
        let mut word = row.value | pred.bits() | side_bits(op, side);
        for (index, ((field, kind), operand)) in row.operands.iter().zip(operands).enumerate() {
            word |= field_bits(*field, *kind, *operand, side, row.mnemonic).ok_or(BadOperands::Operand {
                op,
                index,
                wanted: *kind,
            })?;
        }
        let inst = Self { op, word };
        let unit_side = inst.unit().map_or(Side::A, |unit| unit.side);
        if word & row.mask != row.value || unit_side != side {
            return Err(BadOperands::Unit { op, side });
        }
        Ok(inst)
    }

    /// The first form of a mnemonic on this unit that takes the operands, given in the order of the text.
    #[must_use]
    pub fn pick(mnemonic: Mnemonic, unit: Unit, pred: Pred, operands: &[Operand]) -> Option<Self> {
        Self::forms(mnemonic, pred, operands).find(|inst| inst.unit() == Some(unit))
    }

    /// Every form of a mnemonic, on every unit, that takes the operands in the order of the text.
    ///
    /// With this order of operands, all forms of a mnemonic compute the same, so a scheduler may use any of them. Forms
    /// that are disputed ([`Op::is_disputed`]) are left out.
    pub fn forms(mnemonic: Mnemonic, pred: Pred, operands: &[Operand]) -> impl Iterator<Item = Self> + '_ {
        Op::ALL
            .iter()
            .copied()
            .filter(move |op| op.row().mnemonic == mnemonic && !op.is_disputed())
            .flat_map(move |op| [Side::A, Side::B].map(|side| Self::new(op, side, pred, operands)))
            .filter_map(Result::ok)
    }

    /// `NOP` of 1..=9 cycles; other numbers are clamped to this range.
    #[must_use]
    pub fn nop(cycles: u32) -> Self {
        Self { op: Op::Nop, word: (cycles.clamp(1, 9) - 1) << Field::N.lowest_bit() }
    }

    /// The operation, with the form of its operands.
    #[must_use]
    pub const fn op(self) -> Op {
        self.op
    }

    /// Its mnemonic.
    #[must_use]
    pub const fn mnemonic(self) -> Mnemonic {
        self.op.row().mnemonic
    }

    /// The word, with bit p set if the next instruction executes in parallel.
    #[must_use]
    pub const fn encode(self, parallel: bool) -> u32 {
        if parallel { self.word | PARALLEL } else { self.word }
    }

    /// The condition.
    #[must_use]
    pub fn pred(self) -> Pred {
        Pred::from_word(self.word).unwrap_or(Pred::Always)
    }

    /// Returns the instruction under another condition; `None` for `NOP` and `IDLE`, which have none.
    #[must_use]
    pub fn with_pred(self, pred: Pred) -> Option<Self> {
        let word = self.word & 0x0FFF_FFFF | pred.bits();
        (word & self.op.row().mask == self.op.row().value).then_some(Self { op: self.op, word })
    }

    /// The unit that executes it; `None` for `NOP` and `IDLE`.
    #[must_use]
    pub fn unit(self) -> Option<Unit> {
        let kind = self.op.row().unit?;
        let side = match (kind, self.mem()) {
            (UnitKind::D, Some(mem)) => mem.base.side(),
            _ => self.side(),
        };
        Some(Unit { kind, side })
    }

    /// Its operands in the order of the text.
    pub fn operands(self) -> impl Iterator<Item = Operand> {
        self.op.row().operands.iter().map(move |(field, kind)| self.operand(*field, *kind))
    }

    /// The operand in a field; `None` if the form does not have the field.
    #[must_use]
    pub fn field(self, field: Field) -> Option<Operand> {
        let (field, kind) = self.op.row().operands.iter().find(|(name, _)| *name == field)?;
        Some(self.operand(*field, *kind))
    }

    /// The address of a load or store.
    #[must_use]
    pub fn mem(self) -> Option<Mem> {
        match self.field(Field::Mem) {
            Some(Operand::Mem(mem)) => Some(mem),
            _ => None,
        }
    }

    /// The side in bit s: of the destination, or of the register that is loaded or stored.
    #[must_use]
    pub const fn side(self) -> Side {
        Side::from_bit(self.word >> SIDE)
    }

    /// Reports whether bit x moves an operand to the other file.
    #[must_use]
    pub fn crosses(self) -> bool {
        let may = self.op.row().operands.iter().any(|(_, kind)| kind.may_cross());
        may && self.word >> CROSS & 1 != 0
    }

    fn bits(self, lowest: u32, width: u32) -> u32 {
        bits(self.word, lowest, width)
    }

    pub(crate) fn operand(self, field: Field, kind: Kind) -> Operand {
        let number = self.bits(field.lowest_bit(), 5) as u8;
        let side = self.side();
        let cross = if self.crosses() { side.other() } else { side };
        match kind {
            Kind::R => Operand::Reg(Reg::new(side, number)),
            Kind::Xr => Operand::Reg(Reg::new(cross, number)),
            Kind::R2 => Operand::Reg(Reg::b(number)),
            Kind::L | Kind::D | Kind::Dodd => Operand::Pair(Reg::new(side, number).pair()),
            Kind::Xd => Operand::Pair(Reg::new(cross, number).pair()),
            Kind::C5 => Operand::Const(sign_extend(self.bits(13, 5), 5)),
            Kind::U5 => Operand::Const(i32::from(number)),
            Kind::U4 => Operand::Const(i32::from(number & 15)),
            Kind::C16 => Operand::Const(sign_extend(self.bits(7, 16), 16)),
            Kind::H16 => Operand::Const(self.bits(7, 16) as i32),
            Kind::Disp => Operand::Target(sign_extend(self.bits(7, 21), 21) * 4),
            Kind::Count => Operand::Const(self.bits(13, 4) as i32 + 1),
            Kind::Cr | Kind::Crw => {
                Operand::Control(Control::from_number(u32::from(number)).unwrap_or(Control::Amr))
            }
            Kind::Irp => Operand::Irp,
            Kind::Nrp => Operand::Nrp,
            Kind::PosU15 => {
                Operand::Mem(Mem::at(Reg::b(14 + self.bits(BASE_SIDE, 1) as u8), self.bits(8, 15) as u16))
            }
            Kind::NegC | Kind::PosC | Kind::PredecC | Kind::PreincC | Kind::PostdecC | Kind::PostincC => {
                self.address(kind)
            }
            Kind::NegR | Kind::PosR | Kind::PredecR | Kind::PreincR | Kind::PostdecR | Kind::PostincR => {
                self.address(kind)
            }
        }
    }

    /// The address of a form whose offset has five bits.
    fn address(self, kind: Kind) -> Operand {
        let side = Side::from_bit(self.bits(BASE_SIDE, 1));
        let base = Reg::new(side, self.bits(18, 5) as u8);
        let offset = self.bits(13, 5) as u8;
        let mut mem = Mem::at(base, u16::from(offset));
        if let Some(mode) = kind.mode() {
            mem.negative = mode.negative;
            mem.update = mode.update;
            if mode.offset == OffsetKind::Reg {
                mem.offset = Offset::Reg(Reg::new(side, offset));
            }
        }
        Operand::Mem(mem)
    }
}

const fn bits(word: u32, lowest: u32, width: u32) -> u32 {
    word >> lowest & ((1 << width) - 1)
}

const fn sign_extend(value: u32, width: u32) -> i32 {
    (value << (32 - width)) as i32 >> (32 - width)
}

/// Reports whether the fields that the mask leaves free hold valid values.
fn has_valid_fields(op: Op, word: u32) -> bool {
    op.row().operands.iter().all(|(field, kind)| match kind {
        Kind::Count => bits(word, field.lowest_bit(), 4) <= 8,
        Kind::Cr | Kind::Crw => Control::from_number(bits(word, field.lowest_bit(), 5)).is_some(),
        _ => true,
    })
}

/// Bit s of a form that has one; for loads and stores it comes from the data register.
fn side_bits(op: Op, side: Side) -> u32 {
    let row = op.row();
    let fixed = row.mask >> SIDE & 1 != 0 || row.operands.iter().any(|(field, _)| *field == Field::Mem);
    if fixed { 0 } else { side.bit() << SIDE }
}

/// The bits of an operand in a word; `None` if it does not fit.
fn field_bits(field: Field, kind: Kind, operand: Operand, side: Side, mnemonic: Mnemonic) -> Option<u32> {
    let lowest = field.lowest_bit();
    // The data register of a load or store determines its own side: bit s.
    let is_data = mnemonic.bytes().is_some();
    match operand {
        Operand::Reg(reg) => {
            let bit = match kind {
                Kind::R if is_data => reg.side().bit() << SIDE,
                Kind::R if reg.side() == side => 0,
                Kind::Xr => u32::from(reg.side() != side) << CROSS,
                Kind::R2 if reg.side() == Side::B => 0,
                _ => return None,
            };
            Some(u32::from(reg.number()) << lowest | bit)
        }
        Operand::Pair(pair) => {
            let low = u32::from(pair.low().number());
            let bit = match kind {
                Kind::D if is_data => pair.side().bit() << SIDE,
                Kind::L | Kind::D if pair.side() == side => 0,
                Kind::Xd => u32::from(pair.side() != side) << CROSS,
                Kind::Dodd if pair.side() == side => return Some((low | 1) << lowest | low << 13),
                _ => return None,
            };
            Some(low << lowest | bit)
        }
        Operand::Const(value) if kind != Kind::Disp => constant_bits(kind, value).map(|bits| bits << lowest),
        Operand::Const(_) => None,
        Operand::Target(bytes) => {
            let is_whole = kind == Kind::Disp && bytes & 3 == 0;
            if is_whole { constant_bits(kind, bytes >> 2).map(|bits| bits << lowest) } else { None }
        }
        Operand::Mem(mem) => mem.fits(kind).then(|| address_bits(mem, kind)),
        Operand::Control(control) => matches!(kind, Kind::Cr | Kind::Crw).then(|| control.number() << lowest),
        Operand::Irp => (kind == Kind::Irp).then_some(0),
        Operand::Nrp => (kind == Kind::Nrp).then_some(0),
    }
}

/// A constant in its field, not yet shifted there.
fn constant_bits(kind: Kind, value: i32) -> Option<u32> {
    let (least, greatest) = kind.range()?;
    if !(least..=greatest).contains(&value) {
        return None;
    }
    let width = match kind {
        Kind::C5 | Kind::U5 | Kind::U4 => 5,
        Kind::C16 | Kind::H16 => 16,
        Kind::Disp => 21,
        Kind::Count => return Some(value as u32 - 1),
        _ => return None,
    };
    Some(value as u32 & ((1 << width) - 1))
}

fn address_bits(mem: Mem, kind: Kind) -> u32 {
    if kind == Kind::PosU15 {
        let Offset::Const(offset) = mem.offset else { return 0 };
        return u32::from(offset) << 8 | u32::from(mem.base.number() & 1) << BASE_SIDE;
    }
    let offset = match mem.offset {
        Offset::Const(offset) => u32::from(offset),
        Offset::Reg(reg) => u32::from(reg.number()),
    };
    u32::from(mem.base.number()) << 18 | offset << 13 | mem.base.side().bit() << BASE_SIDE
}
