//! The properties of an instruction that a scheduler needs: registers, stages, units, paths.
//!
//! Everything here follows from the instruction's row: the kinds of its operands and its [`Timing`]. For an instruction
//! that issues in cycle t, stage k is cycle t + k - 1; a result written in stage k is visible to packets that issue in
//! t + k or later.

use crate::inst::Inst;
use crate::kind::{Field, Kind, Timing, Update};
use crate::mnemonic::Mnemonic;
use crate::operand::{Offset, Operand};
use crate::register::{Pair, Reg, Side, Unit};

/// A register that an instruction reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Read {
    /// The register.
    pub reg: Reg,
    /// The stage of the first read: a result that becomes visible in this very cycle is read.
    pub first: u8,
    /// The stage of the last read: the register must not change before the end of this stage.
    pub last: u8,
}

/// A register that an instruction writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Write {
    /// The register.
    pub reg: Reg,
    /// The number of cycles from the issue to the first packet that sees the result.
    pub stage: u8,
}

/// The target of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// A distance from the address of its fetch packet.
    Near {
        /// Signed distance in bytes.
        bytes: i32,
    },
    /// The address in a register.
    Register(Reg),
    /// The return from an interrupt.
    Interrupt,
}

impl Inst {
    /// Its timing.
    #[must_use]
    pub const fn timing(self) -> Timing {
        self.op().row().timing
    }

    /// The number of delay slots: cycles from the issue until the last result may be read, minus 1.
    #[must_use]
    pub const fn delay_slots(self) -> u8 {
        self.timing().delay_slots()
    }

    /// The number of cycles from the issue in which the unit, and the cross path, accept no other instruction.
    #[must_use]
    pub const fn unit_cycles(self) -> u8 {
        self.timing().stages().unit
    }

    /// The number of cycles that the instruction contributes to its packet: 1, or the count of a `NOP`.
    #[must_use]
    pub fn cycles(self) -> u32 {
        match self.field(Field::N) {
            Some(Operand::Const(cycles)) => cycles.unsigned_abs(),
            _ => 1,
        }
    }

    /// The side whose cross path it uses: A for 1X, on which side A reads from file B.
    #[must_use]
    pub fn cross_path(self) -> Option<Side> {
        self.crosses().then(|| self.side())
    }

    /// The side of the data path of a load or store: A for T1.
    #[must_use]
    pub fn data_path(self) -> Option<Side> {
        self.mem().map(|_| self.side())
    }

    /// Reports whether it is a load.
    #[must_use]
    pub fn is_load(self) -> bool {
        self.timing() == Timing::Load
    }

    /// Reports whether it is a store.
    #[must_use]
    pub fn is_store(self) -> bool {
        self.timing() == Timing::Store
    }

    /// Reports whether it reads a 40-bit source.
    #[must_use]
    pub fn reads_long(self) -> bool {
        self.has_long(|field| !field.is_written())
    }

    /// Reports whether it writes a 40-bit result.
    #[must_use]
    pub fn writes_long(self) -> bool {
        self.has_long(Field::is_written)
    }

    fn has_long(self, which: impl Fn(Field) -> bool) -> bool {
        self.op().row().operands.iter().any(|(field, kind)| *kind == Kind::L && which(*field))
    }

    /// The target, if it is a branch.
    #[must_use]
    pub fn branch(self) -> Option<Branch> {
        if self.timing() != Timing::Branch {
            return None;
        }
        self.operands().find_map(|operand| match operand {
            Operand::Target(bytes) => Some(Branch::Near { bytes }),
            Operand::Reg(reg) => Some(Branch::Register(reg)),
            Operand::Irp | Operand::Nrp => Some(Branch::Interrupt),
            Operand::Pair(_) | Operand::Const(_) | Operand::Mem(_) | Operand::Control(_) => None,
        })
    }

    /// The registers that it reads, except the condition register (which is read in stage 1).
    pub fn reads(self) -> impl Iterator<Item = Read> {
        let stages = self.timing().stages();
        let mut found = SmallList::default();
        for (field, kind) in self.op().row().operands {
            if field.is_written() && !self.reads_destination() {
                continue;
            }
            let first_high = if *field == Field::Src1 { stages.read_high1 } else { stages.read_high2 };
            let last = stages.read_last;
            match self.operand(*field, *kind) {
                Operand::Reg(reg) => found.push(Read { reg, first: stages.read_low, last }),
                Operand::Pair(pair) => {
                    found.push(Read { reg: pair.low(), first: stages.read_low, last });
                    found.push(Read { reg: pair.high(), first: first_high, last });
                }
                Operand::Mem(mem) => {
                    found.push(Read { reg: mem.base, first: 1, last: 1 });
                    if let Offset::Reg(reg) = mem.offset {
                        found.push(Read { reg, first: 1, last: 1 });
                    }
                }
                Operand::Const(_)
                | Operand::Target(_)
                | Operand::Control(_)
                | Operand::Irp
                | Operand::Nrp => {}
            }
        }
        found.into_iter()
    }

    /// The registers it writes.
    pub fn writes(self) -> impl Iterator<Item = Write> {
        let stages = self.timing().stages();
        let mut found = SmallList::default();
        for (field, kind) in self.op().row().operands {
            match self.operand(*field, *kind) {
                Operand::Reg(reg) if field.is_written() => found.push(Write { reg, stage: stages.write_low }),
                Operand::Pair(pair) if field.is_written() => {
                    found.push(Write { reg: pair.low(), stage: stages.write_low });
                    found.push(Write { reg: pair.high(), stage: stages.write_high });
                }
                Operand::Mem(mem) if mem.update != Update::None => {
                    found.push(Write { reg: mem.base, stage: 1 });
                }
                _ => {}
            }
        }
        found.into_iter()
    }

    /// Reports whether it keeps a part of its destination: `MVKH`, `ADDK`.
    #[must_use]
    pub fn reads_destination(self) -> bool {
        matches!(self.mnemonic(), Mnemonic::Mvkh | Mnemonic::Addk)
    }

    /// The unit that it occupies, and the number of cycles from the issue.
    #[must_use]
    pub fn occupies(self) -> Option<(Unit, u8)> {
        self.unit().map(|unit| (unit, self.unit_cycles()))
    }

    /// The pair it writes, if its result is one.
    #[must_use]
    pub fn result_pair(self) -> Option<Pair> {
        match self.field(Field::Dst) {
            Some(Operand::Pair(pair)) => Some(pair),
            _ => None,
        }
    }
}

/// A list of at most four items, without allocation.
#[derive(Clone, Copy)]
struct SmallList<T> {
    items: [Option<T>; 4],
    len: usize,
}

impl<T> Default for SmallList<T> {
    fn default() -> Self {
        Self { items: [const { None }; 4], len: 0 }
    }
}

impl<T> SmallList<T> {
    fn push(&mut self, item: T) {
        if let Some(slot) = self.items.get_mut(self.len) {
            *slot = Some(item);
            self.len += 1;
        }
    }

    fn into_iter(self) -> impl Iterator<Item = T> {
        self.items.into_iter().flatten()
    }
}
