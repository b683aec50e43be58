//! Instructions, terminators and their parts.
//!
//! Which class of value an instruction works on follows from its operands.

use cranelift_entity::packed_option::PackedOption;

use super::operators::{BinaryOp, CompareOp, ConvertOp, UnaryOp, Width, named};
use crate::index::index;
use crate::source::Span;
use crate::typed::SymbolId;

index! {
    /// A value: a virtual register of one class.
    ValueId, "v";
    /// A basic block.
    BlockId, "block";
    /// An object in the function's frame in memory.
    SlotId, "slot";
    /// A signature of the unit.
    SignatureId, "sig";
    /// An inlined call.
    InlineId, "call";
}

named! {
    /// The class of a value.
    Class {
        /// 32-bit integer or address.
        I32 = "i32";
        /// 64-bit integer.
        I64 = "i64";
        /// IEEE single.
        F32 = "f32";
        /// IEEE double.
        F64 = "f64";
    }
}

impl Class {
    /// Reports whether it is one of the integer classes.
    #[must_use]
    pub const fn is_integer(self) -> bool {
        match self {
            Self::I32 | Self::I64 => true,
            Self::F32 | Self::F64 => false,
        }
    }

    /// Zero of this class.
    #[must_use]
    pub const fn zero(self) -> Constant {
        match self {
            Self::I32 => Constant::I32(0),
            Self::I64 => Constant::I64(0),
            Self::F32 => Constant::F32(0),
            Self::F64 => Constant::F64(0),
        }
    }
}

/// A constant; floating-point constants are bit patterns, so that equality is identity. The address of a symbol is also
/// a constant, known when the program is linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Constant {
    /// A 32-bit integer.
    I32(i32),
    /// A 64-bit integer.
    I64(i64),
    /// The bits of a single.
    F32(u32),
    /// The bits of a double.
    F64(u64),
    /// The address of a symbol and an offset to it, of class `I32`.
    Symbol(SymbolId, i32),
}

impl Constant {
    /// The bits of a register that holds it; `None` for an address, which only the linker knows.
    #[must_use]
    pub const fn bits(self) -> Option<u64> {
        match self {
            Self::I32(value) => Some(value.cast_unsigned() as u64),
            Self::I64(value) => Some(value.cast_unsigned()),
            Self::F32(bits) => Some(bits as u64),
            Self::F64(bits) => Some(bits),
            Self::Symbol(..) => None,
        }
    }

    /// The number `value` in a class; an integer is cut to the width of the class.
    #[must_use]
    pub const fn number(class: Class, value: i64) -> Self {
        match class {
            Class::I32 => Self::I32(value as i32),
            Class::I64 => Self::I64(value),
            Class::F32 => Self::F32((value as f32).to_bits()),
            Class::F64 => Self::F64((value as f64).to_bits()),
        }
    }

    /// The class of the constant.
    #[must_use]
    pub const fn class(self) -> Class {
        match self {
            Self::I32(_) | Self::Symbol(..) => Class::I32,
            Self::I64(_) => Class::I64,
            Self::F32(_) => Class::F32,
            Self::F64(_) => Class::F64,
        }
    }
}

/// An operand of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A value.
    Value(ValueId),
    /// A constant.
    Constant(Constant),
}

impl Operand {
    /// The integer constant `value` of class `I32`.
    #[must_use]
    pub const fn int(value: i32) -> Self {
        Self::Constant(Constant::I32(value))
    }

    /// The value, if it is a value.
    #[must_use]
    pub const fn as_value(self) -> Option<ValueId> {
        match self {
            Self::Value(value) => Some(value),
            Self::Constant(_) => None,
        }
    }

    /// The number, if it is a constant of class `I32`.
    #[must_use]
    pub const fn as_int(self) -> Option<i32> {
        match self {
            Self::Constant(Constant::I32(value)) => Some(value),
            Self::Value(_) | Self::Constant(_) => None,
        }
    }
}

impl From<ValueId> for Operand {
    fn from(value: ValueId) -> Self {
        Self::Value(value)
    }
}

impl From<Constant> for Operand {
    fn from(constant: Constant) -> Self {
        Self::Constant(constant)
    }
}

/// The base of an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Nothing: the offset is the address.
    Absolute,
    /// A value of class `I32`.
    Value(ValueId),
    /// An object in the frame.
    Slot(SlotId),
    /// The address of a symbol, known at link time.
    Symbol(SymbolId),
}

/// A place in memory: base plus offset, wrapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// The base of the offset.
    pub base: Base,
    /// Bytes.
    pub offset: i32,
}

impl Address {
    /// The start of `base`.
    #[must_use]
    pub const fn new(base: Base) -> Self {
        Self { base, offset: 0 }
    }

    /// The address that an operand of class `I32` holds.
    #[must_use]
    pub const fn of(operand: Operand) -> Self {
        match operand {
            Operand::Value(value) => Self::new(Base::Value(value)),
            Operand::Constant(Constant::I32(address)) => Self { base: Base::Absolute, offset: address },
            Operand::Constant(Constant::Symbol(symbol, offset)) => {
                Self { base: Base::Symbol(symbol), offset }
            }
            Operand::Constant(_) => Self::new(Base::Absolute),
        }
    }

    /// The address plus `bytes`.
    #[must_use]
    pub const fn plus(self, bytes: i32) -> Self {
        Self { offset: self.offset.wrapping_add(bytes), ..self }
    }
}

/// The target of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Callee {
    /// A function by name.
    Symbol(SymbolId),
    /// A function by address.
    Pointer(Operand),
}

/// The arguments of a call: a range of the function's argument list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArgumentRange {
    /// Index of the first.
    pub start: u32,
    /// Number of arguments.
    pub count: u32,
}

impl ArgumentRange {
    /// The range as indexes.
    #[must_use]
    pub const fn range(self) -> std::ops::Range<usize> {
        self.start as usize..(self.start + self.count) as usize
    }
}

/// An instruction and its statement.
#[derive(Clone, Copy, Debug)]
pub struct Inst {
    /// The kind of instruction.
    pub kind: InstKind,
    /// The source that a trap in it names.
    pub origin: CodeOrigin,
}

/// The position of code in the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeOrigin {
    /// The statement.
    pub span: Span,
    /// The inlined call that it comes from; `None` for code of the function itself.
    pub call: PackedOption<InlineId>,
}

impl CodeOrigin {
    /// Code of the function itself.
    #[must_use]
    pub fn of(span: Span) -> Self {
        Self { span, call: PackedOption::default() }
    }
}

/// The kind of an instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InstKind {
    /// `dst = src`
    Copy {
        /// Written.
        dst: ValueId,
        /// Read.
        src: Operand,
    },
    /// `dst = op src`
    Unary {
        /// The operator.
        op: UnaryOp,
        /// Written.
        dst: ValueId,
        /// Read.
        src: Operand,
    },
    /// `dst = a op b`
    Binary {
        /// The operator.
        op: BinaryOp,
        /// Written.
        dst: ValueId,
        /// First operand.
        a: Operand,
        /// Second operand.
        b: Operand,
    },
    /// `dst = a op b`, 0 or 1
    Compare {
        /// The comparison.
        op: CompareOp,
        /// Written, `I32`.
        dst: ValueId,
        /// First operand.
        a: Operand,
        /// Second operand.
        b: Operand,
    },
    /// `dst = op(src)`
    Convert {
        /// The conversion.
        op: ConvertOp,
        /// Written.
        dst: ValueId,
        /// Read.
        src: Operand,
    },
    /// `dst = memory[address]`
    Load {
        /// Written.
        dst: ValueId,
        /// The width of the access.
        width: Width,
        /// The source.
        address: Address,
    },
    /// `memory[address] = src`
    Store {
        /// Read.
        src: Operand,
        /// The width of the access.
        width: Width,
        /// The destination.
        address: Address,
    },
    /// `dst = slot + offset`: an address in the frame.
    FrameAddress {
        /// Written, `I32`.
        dst: ValueId,
        /// The object.
        slot: SlotId,
        /// Bytes from its beginning.
        offset: i32,
    },
    /// Copies `len` bytes; the ranges are either the same or do not overlap.
    CopyMemory {
        /// The destination.
        to: Address,
        /// The source.
        from: Address,
        /// Number of bytes.
        len: u32,
    },
    /// Writes `len` zero bytes.
    ClearMemory {
        /// The destination.
        to: Address,
        /// Number of bytes.
        len: u32,
    },
    /// `dst = callee(arguments)`
    Call {
        /// The function.
        callee: Callee,
        /// The arguments, of the classes that the signature names.
        arguments: ArgumentRange,
        /// The signature.
        signature: SignatureId,
        /// The result, if it is needed.
        dst: PackedOption<ValueId>,
    },
    /// Only spends board time: the time that the vendor's code takes for the source.
    ///
    /// A function with such instructions is charged only for these, whatever its other instructions cost.
    Cost {
        /// Cycles of 5 ns.
        cycles: u32,
    },
}

impl InstKind {
    /// The value that is written.
    #[must_use]
    pub fn dst(&self) -> Option<ValueId> {
        match *self {
            Self::Copy { dst, .. }
            | Self::Unary { dst, .. }
            | Self::Binary { dst, .. }
            | Self::Compare { dst, .. }
            | Self::Convert { dst, .. }
            | Self::Load { dst, .. }
            | Self::FrameAddress { dst, .. } => Some(dst),
            Self::Call { dst, .. } => dst.expand(),
            Self::Store { .. } | Self::CopyMemory { .. } | Self::ClearMemory { .. } | Self::Cost { .. } => {
                None
            }
        }
    }

    /// Passes every operand that is read to `visit`, except call arguments; an address base that becomes a constant
    /// turns into an absolute address.
    pub fn visit_operands(&mut self, mut visit: impl FnMut(&mut Operand)) {
        match self {
            Self::Copy { src, .. } | Self::Unary { src, .. } | Self::Convert { src, .. } => visit(src),
            Self::Binary { a, b, .. } | Self::Compare { a, b, .. } => {
                visit(a);
                visit(b);
            }
            Self::Load { address, .. } => visit_base(address, &mut visit),
            Self::Store { src, address, .. } => {
                visit(src);
                visit_base(address, &mut visit);
            }
            Self::CopyMemory { to, from, .. } => {
                visit_base(to, &mut visit);
                visit_base(from, &mut visit);
            }
            Self::ClearMemory { to, .. } => visit_base(to, &mut visit),
            Self::Call { callee: Callee::Pointer(target), .. } => visit(target),
            Self::FrameAddress { .. } | Self::Call { callee: Callee::Symbol(_), .. } | Self::Cost { .. } => {}
        }
    }

    /// The range of the function's argument list that is read.
    #[must_use]
    pub const fn arguments(&self) -> Option<ArgumentRange> {
        if let Self::Call { arguments, .. } = *self { Some(arguments) } else { None }
    }

    /// The signature of a call.
    #[must_use]
    pub const fn signature(&self) -> Option<SignatureId> {
        if let Self::Call { signature, .. } = *self { Some(signature) } else { None }
    }

    /// Reports whether the instruction has an effect other than its value, so that it must be kept even if the value is
    /// not read.
    #[must_use]
    pub fn has_effect(&self, class: Class) -> bool {
        match self {
            // A load may reach a device or trap, and programs poll memory; see the module's documentation.
            Self::Load { .. }
            | Self::Store { .. }
            | Self::CopyMemory { .. }
            | Self::ClearMemory { .. }
            | Self::Call { .. }
            | Self::Cost { .. } => true,
            Self::Binary { op, b, .. } => op.may_trap(class) && !is_nonzero(*b),
            Self::Copy { .. }
            | Self::Unary { .. }
            | Self::Compare { .. }
            | Self::Convert { .. }
            | Self::FrameAddress { .. } => false,
        }
    }
}

fn visit_base(address: &mut Address, visit: &mut impl FnMut(&mut Operand)) {
    if let Base::Value(value) = address.base {
        let mut operand = Operand::Value(value);
        visit(&mut operand);
        *address = Address::of(operand).plus(address.offset);
    }
}

/// Reports whether `operand` is an integer constant other than 0.
fn is_nonzero(operand: Operand) -> bool {
    matches!(operand, Operand::Constant(Constant::I32(value)) if value != 0)
        || matches!(operand, Operand::Constant(Constant::I64(value)) if value != 0)
}

/// The terminator of a block.
#[derive(Clone, Debug, PartialEq)]
pub enum Terminator {
    /// Continues at a block.
    Jump(BlockId),
    /// Continues at `then` if `condition`, of class `I32`, is not 0.
    Branch {
        /// The tested value.
        condition: Operand,
        /// Taken for any value except 0.
        then: BlockId,
        /// Taken for 0.
        otherwise: BlockId,
    },
    /// Continues at `targets[index]`, or at `default` if there are fewer; `index` is unsigned.
    Table {
        /// The index, `I32`.
        index: Operand,
        /// The blocks in order.
        targets: Box<[BlockId]>,
        /// Taken for any other index.
        default: BlockId,
    },
    /// Leaves the function.
    Return(Option<Operand>),
    /// Cannot be reached.
    Unreachable,
}

impl Terminator {
    /// Hands every block it may go to to `visit`.
    pub fn visit_targets(&mut self, mut visit: impl FnMut(&mut BlockId)) {
        match self {
            Self::Jump(to) => visit(to),
            Self::Branch { then, otherwise, .. } => {
                visit(then);
                visit(otherwise);
            }
            Self::Table { targets, default, .. } => {
                targets.iter_mut().for_each(&mut visit);
                visit(default);
            }
            Self::Return(_) | Self::Unreachable => {}
        }
    }

    /// The blocks at which it may continue.
    pub fn targets(&self) -> impl Iterator<Item = BlockId> + '_ {
        let (first, second, table): (_, _, &[BlockId]) = match self {
            Self::Jump(to) => (Some(*to), None, &[]),
            Self::Branch { then, otherwise, .. } => (Some(*then), Some(*otherwise), &[]),
            Self::Table { targets, default, .. } => (Some(*default), None, targets),
            Self::Return(_) | Self::Unreachable => (None, None, &[]),
        };
        first.into_iter().chain(second).chain(table.iter().copied())
    }

    /// The operand it reads.
    #[must_use]
    pub const fn operand(&self) -> Option<Operand> {
        match *self {
            Self::Branch { condition, .. } => Some(condition),
            Self::Table { index, .. } => Some(index),
            Self::Return(value) => value,
            Self::Jump(_) | Self::Unreachable => None,
        }
    }

    /// The operand it reads, for a change.
    #[must_use]
    pub const fn operand_mut(&mut self) -> Option<&mut Operand> {
        match self {
            Self::Branch { condition, .. } => Some(condition),
            Self::Table { index, .. } => Some(index),
            Self::Return(value) => value.as_mut(),
            Self::Jump(_) | Self::Unreachable => None,
        }
    }
}
