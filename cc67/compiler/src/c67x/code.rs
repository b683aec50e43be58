//! The function while it becomes machine code: instructions over virtual registers.
//!
//! A virtual register is a word or a pair (a double, a 64-bit integer) and belongs to one of the two register files.
//! Like the IR's values it may be written many times. An instruction names its operands by the fields of the
//! instruction table, not by their order in the text; which unit executes it is decided when it is scheduled.

use c67x::{Reg, Side};
use cranelift_entity::{PrimaryMap, entity_impl};

use super::forms::Kind;
use crate::ir::inst::SlotId;
use crate::source::Span;
use crate::typed::SymbolId;

/// A virtual register.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct VReg(u32);
entity_impl!(VReg, "r");

/// The properties of a virtual register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VRegInfo {
    /// A pair of registers.
    pub(super) is_pair: bool,
    /// Its register file, once that is decided.
    pub(super) side: Option<Side>,
    /// True if it is tested as a condition, which only six registers can be.
    pub(super) is_condition: bool,
    /// The register it would best be.
    pub(super) hint: Option<Reg>,
    /// True if the allocator made it for one instruction: it is never spilled.
    pub(super) is_short: bool,
    /// Its only value, a constant that is rematerialised rather than spilled.
    pub(super) constant: Option<Value>,
}

/// A number that is known when the program is linked, or earlier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Value {
    /// A number.
    Number(i32),
    /// The address of a symbol, and an offset.
    Symbol(SymbolId, i32),
    /// The address of a block.
    Block(u32),
    /// The address of a table of addresses after the code.
    Table(u32),
}

/// An operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arg {
    /// No argument.
    None,
    /// A register, or a pair.
    Reg(VReg),
    /// The even register of a pair.
    Low(VReg),
    /// The odd register of a pair.
    High(VReg),
    /// A constant.
    Value(Value),
}

impl Arg {
    /// The number `value`.
    pub(super) const fn number(value: i32) -> Self {
        Self::Value(Value::Number(value))
    }

    /// The virtual register.
    pub(super) const fn reg(self) -> Option<VReg> {
        match self {
            Self::Reg(reg) | Self::Low(reg) | Self::High(reg) => Some(reg),
            Self::None | Self::Value(_) => None,
        }
    }
}

impl From<VReg> for Arg {
    fn from(reg: VReg) -> Self {
        Self::Reg(reg)
    }
}

/// The base of an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Base {
    /// A register.
    Reg(VReg),
    /// An object in the frame.
    Slot(SlotId),
    /// A word of the frame that the allocator took, by number.
    Spill(u32),
    /// The stack pointer.
    Stack,
}

/// An address: base plus bytes, or base plus a register times the size of the access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MemoryPlace {
    pub(super) base: Base,
    /// The offset in bytes, if there is no index.
    pub(super) offset: i32,
    /// A register that counts elements.
    pub(super) index: Option<VReg>,
    /// Elements that are added to the base after the access.
    pub(super) step: i32,
}

impl MemoryPlace {
    pub(super) const fn new(base: Base, offset: i32) -> Self {
        Self { base, offset, index: None, step: 0 }
    }
}

/// The condition of an instruction: the register, and whether it must be 0.
pub(super) type Condition = Option<(VReg, bool)>;

/// An instruction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inst {
    pub(super) kind: Kind,
    pub(super) dst: Arg,
    pub(super) src1: Arg,
    pub(super) src2: Arg,
    /// The constants of a bit field.
    pub(super) field: (u8, u8),
    /// The address of a load or store, or the place whose address is computed.
    pub(super) place: Option<MemoryPlace>,
    pub(super) condition: Condition,
    /// A number of a call or table.
    pub(super) number: u32,
    /// The statement it belongs to.
    pub(super) span: Span,
}

impl Inst {
    /// An instruction with two sources.
    pub(super) const fn new(kind: Kind, dst: Arg, src1: Arg, src2: Arg, span: Span) -> Self {
        Self { kind, dst, src1, src2, field: (0, 0), place: None, condition: None, number: 0, span }
    }

    /// Reports whether the old value of the destination is read.
    pub(super) fn keeps_destination(&self) -> bool {
        self.condition.is_some() || matches!(self.kind, Kind::Mvkh)
    }

    /// Passes every virtual register that is read to `visit`, except those of a call.
    pub(super) fn visit_reads(&self, mut visit: impl FnMut(VReg)) {
        for arg in [self.src1, self.src2] {
            if let Some(reg) = arg.reg() {
                visit(reg);
            }
        }
        if let Some(place) = self.place {
            if let Base::Reg(reg) = place.base {
                visit(reg);
            }
            if let Some(reg) = place.index {
                visit(reg);
            }
        }
        if let Some((reg, _)) = self.condition {
            visit(reg);
        }
        if self.keeps_destination()
            && let Some(reg) = self.dst.reg()
        {
            visit(reg);
        }
    }

    /// The register that is written, and whether its old contents are replaced completely.
    pub(super) fn written_register(&self) -> Option<(VReg, bool)> {
        match self.dst {
            Arg::Reg(reg) => Some((reg, !self.keeps_destination())),
            Arg::Low(reg) | Arg::High(reg) => Some((reg, false)),
            Arg::None | Arg::Value(_) => None,
        }
    }

    /// The base register that a load or store increments.
    pub(super) fn incremented_base(&self) -> Option<VReg> {
        match self.place {
            Some(MemoryPlace { base: Base::Reg(reg), step, .. }) if step != 0 => Some(reg),
            _ => None,
        }
    }

    /// Hands every operand that names a virtual register to `visit`, to be changed.
    pub(super) fn visit_all(&mut self, mut visit: impl FnMut(&mut VReg)) {
        for arg in [&mut self.dst, &mut self.src1, &mut self.src2] {
            if let Arg::Reg(reg) | Arg::Low(reg) | Arg::High(reg) = arg {
                visit(reg);
            }
        }
        if let Some(place) = &mut self.place {
            if let Base::Reg(reg) = &mut place.base {
                visit(reg);
            }
            if let Some(reg) = &mut place.index {
                visit(reg);
            }
        }
        if let Some((reg, _)) = &mut self.condition {
            visit(reg);
        }
    }
}

/// The target of a call.
#[derive(Clone, Copy, Debug)]
pub(super) enum CallTarget {
    /// A function by name.
    Symbol(SymbolId),
    /// The address in a register: the argument for [`super::abi::TARGET`].
    Register,
}

/// A call.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub(super) target: CallTarget,
    /// The registers that it takes, and where they must be (of a pair the even register).
    pub(super) arguments: Vec<(VReg, Reg)>,
    /// The registers that it changes, a bit each.
    pub(super) changes: u64,
    /// True if it may still write [`super::abi::LATE`] in the cycle after its return.
    pub(super) is_late: bool,
}

/// The terminator of a block.
#[derive(Clone, Debug)]
pub(super) enum Terminator {
    /// Continues at a block.
    Jump(u32),
    /// Continues at `then` if the register is not 0 (`negated`: if it is 0), otherwise at `otherwise`.
    Branch { condition: VReg, negated: bool, then: u32, otherwise: u32 },
    /// Continues at the address in a register, one of `targets`.
    Table { address: VReg, targets: Vec<u32> },
    /// Leaves the function with the result in its register.
    Return(Option<VReg>),
    /// Cannot be reached.
    Unreachable,
}

impl Terminator {
    /// The blocks at which it may continue.
    pub(super) fn targets(&self) -> impl Iterator<Item = u32> + '_ {
        let (two, many): ([Option<u32>; 2], &[u32]) = match self {
            Self::Jump(to) => ([Some(*to), None], &[]),
            Self::Branch { then, otherwise, .. } => ([Some(*then), Some(*otherwise)], &[]),
            Self::Table { targets, .. } => ([None, None], targets),
            Self::Return(_) | Self::Unreachable => ([None, None], &[]),
        };
        two.into_iter().flatten().chain(many.iter().copied())
    }

    /// The register that is read.
    pub(super) fn read(&self) -> Option<VReg> {
        match self {
            Self::Branch { condition: reg, .. } | Self::Table { address: reg, .. } => Some(*reg),
            Self::Return(reg) => *reg,
            Self::Jump(_) | Self::Unreachable => None,
        }
    }

    /// The register that it reads, mutable.
    pub(super) fn read_mut(&mut self) -> Option<&mut VReg> {
        match self {
            Self::Branch { condition: reg, .. } | Self::Table { address: reg, .. } => Some(reg),
            Self::Return(reg) => reg.as_mut(),
            Self::Jump(_) | Self::Unreachable => None,
        }
    }
}

/// A block.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) insts: Vec<Inst>,
    pub(super) terminator: Terminator,
    /// Number of loops around it.
    pub(super) depth: u32,
    /// Number of iterations of the source's loop that it executes.
    pub(super) unrolled: u32,
    pub(super) span: Span,
}

impl Block {
    /// The estimated frequency of its execution.
    pub(super) fn weight(&self) -> f32 {
        8_f32.powi(self.depth.min(5).cast_signed()) / self.unrolled as f32
    }
}

/// A function.
#[derive(Clone, Debug)]
pub(super) struct Code {
    /// In the order of the code; a block's number is its place.
    pub(super) blocks: Vec<Block>,
    pub(super) regs: PrimaryMap<VReg, VRegInfo>,
    pub(super) calls: Vec<Call>,
    /// The parameters and their registers at entry (for a pair, the even register).
    pub(super) params: Vec<(VReg, Reg)>,
    /// Tables of block addresses after the code.
    pub(super) tables: Vec<Vec<u32>>,
    /// Words of the frame that the allocator took.
    pub(super) spills: u32,
    /// True if the word above the stack pointer is used by calls with variable arguments.
    pub(super) has_variable_calls: bool,
}

impl Code {
    /// Creates a register with the properties `info`.
    pub(super) fn reg(&mut self, info: VRegInfo) -> VReg {
        self.regs.push(info)
    }
}
