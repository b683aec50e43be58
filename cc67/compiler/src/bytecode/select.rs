//! Writes the words of a function.
//!
//! The function is legal: one instruction becomes one word, apart from calls and table jumps. Blocks are written in the
//! order of the layout; a jump to the next block is left out. Labels are numbers of words in the function until
//! [`super::text`] adds the function to the unit.

use cranelift_entity::SecondaryMap;
use cranelift_entity::packed_option::PackedOption;
use vm::op::Op;
use vm::operand::{
    Addr, Bits32, Count, Count32, Imm, Imm16, Label, Off, RegF32, RegF64, RegI32, RegI64, SigRef,
};
use vm::patch;

use super::legalize::FrameLayout;
use super::operators;
use super::pool::ConstantPool;
use super::registers::Registers;
use crate::ir::function::{Function, table};
use crate::ir::inst::{
    Address, ArgumentRange, Base, BlockId, Callee, Class, CodeOrigin, Constant, InlineId, InstKind, Operand,
    SignatureId, Terminator, ValueId,
};
use crate::ir::operators::{BinaryOp, CompareOp, ConvertOp, UnaryOp, Width};
use crate::relocation::{Relocation, RelocationKind};
use crate::source::Span;
use crate::typed::SymbolId;

/// The words of a function without `func` and `types`.
#[derive(Debug, Default)]
pub(super) struct Code {
    /// The words.
    pub(super) ops: Vec<Op>,
    /// Words that hold addresses, ascending.
    pub(super) relocations: Vec<Relocation>,
    /// The first word of each run of words that belong to one statement.
    pub(super) spans: Vec<(u32, Span)>,
    /// The first word of each run of words of one inlined call, or of none.
    pub(super) calls: Vec<(u32, PackedOption<InlineId>)>,
    /// The first word of each instruction of the function, and of the end of each block.
    pub(super) insts: Vec<u32>,
    /// A table or count is larger than an instruction can hold.
    pub(super) is_too_large: bool,
    /// True if the source gives the costs of the function: its charges are the given ones, and no others.
    pub(super) is_priced: bool,
}

/// Selects the instructions of a legal function.
pub(super) fn select(
    function: &Function,
    frame: &FrameLayout,
    registers: &Registers,
    pool: &mut ConstantPool,
) -> Code {
    let words = function.layout.iter().map(|id| function.blocks[*id].insts.len() + 2).sum();
    let mut selector = Selector {
        function,
        frame,
        registers,
        pool,
        code: Code { ops: Vec::with_capacity(words), ..Code::default() },
        starts: table(function.blocks.len()),
        branches: Vec::new(),
    };
    selector.function();
    selector.code
}

struct Selector<'a> {
    function: &'a Function,
    frame: &'a FrameLayout,
    registers: &'a Registers,
    pool: &'a mut ConstantPool,
    code: Code,
    starts: SecondaryMap<BlockId, u32>,
    /// Words with a label that is still the number of a block.
    branches: Vec<u32>,
}

impl Selector<'_> {
    fn function(&mut self) {
        let function = self.function;
        self.set_origin(CodeOrigin::of(function.span));
        for inst in &self.frame.prologue {
            self.inst(&inst.kind);
        }
        for (index, &id) in function.layout.iter().enumerate() {
            self.starts[id] = self.code.ops.len() as u32;
            let block = &function.blocks[id];
            for inst in &block.insts {
                self.code.insts.push(self.code.ops.len() as u32);
                self.set_origin(inst.origin);
                self.inst(&inst.kind);
            }
            self.code.insts.push(self.code.ops.len() as u32);
            self.set_origin(block.origin);
            self.terminator(&block.terminator, function.layout.get(index + 1).copied());
        }
        for at in &self.branches {
            if let Some(op) = self.code.ops.get_mut(*at as usize) {
                patch::labels(op, |block| self.starts[BlockId::from_u32(block)]);
            }
        }
    }

    /// Sets the source position of the words that follow.
    fn set_origin(&mut self, origin: CodeOrigin) {
        let word = self.code.ops.len() as u32;
        begin_run(&mut self.code.spans, word, origin.span);
        begin_run(&mut self.code.calls, word, origin.call);
    }

    fn push(&mut self, op: Op) {
        self.code.ops.push(op);
    }

    fn int(&self, value: ValueId) -> RegI32 {
        RegI32(self.registers.register_of(value))
    }

    fn long(&self, value: ValueId) -> RegI64 {
        RegI64(self.registers.register_of(value))
    }

    fn single(&self, value: ValueId) -> RegF32 {
        RegF32(self.registers.register_of(value))
    }

    fn double(&self, value: ValueId) -> RegF64 {
        RegF64(self.registers.register_of(value))
    }

    /// The value of a legal operand that is not an immediate.
    fn value(&self, operand: Operand) -> ValueId {
        debug_assert!(operand.as_value().is_some(), "constants are in values");
        operand.as_value().unwrap_or(ValueId::from_u32(0))
    }

    fn class(&self, value: ValueId) -> Class {
        self.function.values[value]
    }

    /// The word just about to be pushed holds the address of `symbol`.
    fn relocate(&mut self, kind: RelocationKind, symbol: SymbolId) {
        let word = self.code.ops.len() as u32;
        self.code.relocations.push(Relocation { word, kind, symbol });
    }

    fn inst(&mut self, kind: &InstKind) {
        match *kind {
            InstKind::Copy { dst, src: Operand::Constant(constant) } => self.constant(dst, constant),
            InstKind::Copy { dst, src: Operand::Value(src) } => self.copy(dst, src),
            InstKind::Unary { op, dst, src } => self.unary(op, dst, self.value(src)),
            InstKind::Binary { op, dst, a, b } => match b.as_int() {
                Some(imm) => self.binary_immediate(op, dst, self.value(a), imm),
                None => self.binary(op, dst, self.value(a), self.value(b)),
            },
            InstKind::Compare { op, dst, a, b } => self.compare(op, dst, self.value(a), self.value(b)),
            InstKind::Convert { op, dst, src } => self.convert(op, dst, self.value(src)),
            InstKind::Load { dst, width, address } => self.load(dst, width, address),
            InstKind::Store { src, width, address } => self.store(self.value(src), width, address),
            InstKind::FrameAddress { dst, slot, offset } => {
                let offset = Imm(self.frame.offsets[slot].cast_signed().wrapping_add(offset));
                self.push(Op::FrameAddr { dst: self.int(dst), offset });
            }
            InstKind::CopyMemory { to, from, len } => self.block(to, Some(from), len),
            InstKind::ClearMemory { to, len } => self.block(to, None, len),
            InstKind::Cost { cycles } => {
                self.code.is_priced = true;
                self.push(Op::Charge { cycles: Count32(cycles) });
            }
            InstKind::Call { callee, arguments, signature, dst } => {
                self.call(callee, arguments, signature, dst.expand());
            }
        }
    }

    fn constant(&mut self, dst: ValueId, constant: Constant) {
        let op = match constant {
            Constant::I32(value) => Op::ConstI32 { dst: self.int(dst), imm: Imm(value) },
            Constant::I64(value) => {
                let pool = self.pool.number(value.cast_unsigned());
                Op::ConstI64 { dst: self.long(dst), pool }
            }
            Constant::Symbol(symbol, offset) => {
                self.relocate(RelocationKind::Address, symbol);
                Op::ConstI32 { dst: self.int(dst), imm: Imm(offset) }
            }
            Constant::F32(bits) => Op::ConstF32 { dst: self.single(dst), bits: Bits32(bits) },
            Constant::F64(bits) => {
                let pool = self.pool.number(bits);
                Op::ConstF64 { dst: self.double(dst), pool }
            }
        };
        self.push(op);
    }

    fn copy(&mut self, dst: ValueId, src: ValueId) {
        if self.registers.register_of(dst) == self.registers.register_of(src) {
            return;
        }
        self.push(match self.class(dst) {
            Class::I32 => Op::MovI32 { dst: self.int(dst), src: self.int(src) },
            Class::I64 => Op::MovI64 { dst: self.long(dst), src: self.long(src) },
            Class::F32 => Op::MovF32 { dst: self.single(dst), src: self.single(src) },
            Class::F64 => Op::MovF64 { dst: self.double(dst), src: self.double(src) },
        });
    }

    /// Only floats are left to negate.
    fn unary(&mut self, op: UnaryOp, dst: ValueId, src: ValueId) {
        self.push(match (op, self.class(dst)) {
            (UnaryOp::Negate, Class::F32) => Op::NegF32 { dst: self.single(dst), src: self.single(src) },
            (UnaryOp::Negate, Class::F64) => Op::NegF64 { dst: self.double(dst), src: self.double(src) },
            (UnaryOp::Negate, Class::I32 | Class::I64) | (UnaryOp::Complement, _) => operators::illegal_op(),
        });
    }

    fn binary_immediate(&mut self, op: BinaryOp, dst: ValueId, a: ValueId, imm: i32) {
        let (dst, a, imm) = (self.int(dst), self.int(a), Imm16(imm as i16));
        self.push(operators::immediate(op).map_or_else(operators::illegal_op, |form| form(dst, a, imm)));
    }

    fn binary(&mut self, op: BinaryOp, dst: ValueId, a: ValueId, b: ValueId) {
        let selected = match self.class(dst) {
            Class::I32 => operators::binary_i32(op, self.int(dst), self.int(a), self.int(b)),
            Class::I64 if op.is_shift() => {
                operators::shift_i64(op, self.long(dst), self.long(a), self.int(b))
            }
            Class::I64 => operators::binary_i64(op, self.long(dst), self.long(a), self.long(b)),
            Class::F32 => operators::binary_f32(op, self.single(dst), self.single(a), self.single(b)),
            Class::F64 => operators::binary_f64(op, self.double(dst), self.double(a), self.double(b)),
        };
        self.push(selected);
    }

    fn compare(&mut self, op: CompareOp, dst: ValueId, a: ValueId, b: ValueId) {
        let dst = self.int(dst);
        let selected = match self.class(a) {
            Class::I32 => operators::compare_i32(op, dst, self.int(a), self.int(b)),
            Class::I64 => operators::compare_i64(op, dst, self.long(a), self.long(b)),
            Class::F32 => operators::compare_f32(op, dst, self.single(a), self.single(b)),
            Class::F64 => operators::compare_f64(op, dst, self.double(a), self.double(b)),
        };
        self.push(selected);
    }

    fn convert(&mut self, op: ConvertOp, dst: ValueId, src: ValueId) {
        macro_rules! convert {
            ($($ir:ident => $op:ident($to:ident, $from:ident);)*) => {
                match op {
                    $(ConvertOp::$ir => Op::$op { dst: self.$to(dst), src: self.$from(src) },)*
                }
            };
        }
        let selected = convert! {
            SignExtend8 => Ext8S(int, int);
            ZeroExtend8 => Ext8U(int, int);
            SignExtend16 => Ext16S(int, int);
            ZeroExtend16 => Ext16U(int, int);
            I64FromI32 => I64FromI32S(long, int);
            I64FromU32 => I64FromI32U(long, int);
            I32FromI64 => I32FromI64(int, long);
            F32FromI32 => F32FromI32S(single, int);
            F32FromU32 => F32FromI32U(single, int);
            F32FromI64 => F32FromI64S(single, long);
            F32FromU64 => F32FromI64U(single, long);
            F64FromI32 => F64FromI32S(double, int);
            F64FromU32 => F64FromI32U(double, int);
            F64FromI64 => F64FromI64S(double, long);
            F64FromU64 => F64FromI64U(double, long);
            F64FromF32 => F64FromF32(double, single);
            F32FromF64 => F32FromF64(single, double);
            I32FromF32 => I32FromF32S(int, single);
            U32FromF32 => I32FromF32U(int, single);
            I32FromF64 => I32FromF64S(int, double);
            U32FromF64 => I32FromF64U(int, double);
            I64FromF64 => I64FromF64S(long, double);
            U64FromF64 => I64FromF64U(long, double);
        };
        self.push(selected);
    }

    fn load(&mut self, dst: ValueId, width: Width, address: Address) {
        let (int, long, single, double) = (self.int(dst), self.long(dst), self.single(dst), self.double(dst));
        if let Base::Value(base) = address.base {
            let (base, off) = (self.int(base), Off(address.offset as i16));
            self.push(match width {
                Width::I8 => Op::LoadI8S { dst: int, base, off },
                Width::U8 => Op::LoadI8U { dst: int, base, off },
                Width::I16 => Op::LoadI16S { dst: int, base, off },
                Width::U16 => Op::LoadI16U { dst: int, base, off },
                Width::I32 => Op::LoadI32 { dst: int, base, off },
                Width::I64 => Op::LoadI64 { dst: long, base, off },
                Width::F32 => Op::LoadF32 { dst: single, base, off },
                Width::F64 => Op::LoadF64 { dst: double, base, off },
            });
            return;
        }
        let addr = self.absolute_address(address);
        self.push(match width {
            Width::I8 => Op::LoadI8SAt { dst: int, addr },
            Width::U8 => Op::LoadI8UAt { dst: int, addr },
            Width::I16 => Op::LoadI16SAt { dst: int, addr },
            Width::U16 => Op::LoadI16UAt { dst: int, addr },
            Width::I32 => Op::LoadI32At { dst: int, addr },
            Width::I64 => Op::LoadI64At { dst: long, addr },
            Width::F32 => Op::LoadF32At { dst: single, addr },
            Width::F64 => Op::LoadF64At { dst: double, addr },
        });
    }

    fn store(&mut self, src: ValueId, width: Width, address: Address) {
        let (int, long, single, double) = (self.int(src), self.long(src), self.single(src), self.double(src));
        if let Base::Value(base) = address.base {
            let (base, off) = (self.int(base), Off(address.offset as i16));
            self.push(match width {
                Width::I8 | Width::U8 => Op::StoreI8 { src: int, base, off },
                Width::I16 | Width::U16 => Op::StoreI16 { src: int, base, off },
                Width::I32 => Op::StoreI32 { src: int, base, off },
                Width::I64 => Op::StoreI64 { src: long, base, off },
                Width::F32 => Op::StoreF32 { src: single, base, off },
                Width::F64 => Op::StoreF64 { src: double, base, off },
            });
            return;
        }
        let addr = self.absolute_address(address);
        self.push(match width {
            Width::I8 | Width::U8 => Op::StoreI8At { src: int, addr },
            Width::I16 | Width::U16 => Op::StoreI16At { src: int, addr },
            Width::I32 => Op::StoreI32At { src: int, addr },
            Width::I64 => Op::StoreI64At { src: long, addr },
            Width::F32 => Op::StoreF32At { src: single, addr },
            Width::F64 => Op::StoreF64At { src: double, addr },
        });
    }

    /// The address in a word about to be pushed: a number, or relative to a symbol.
    fn absolute_address(&mut self, address: Address) -> Addr {
        if let Base::Symbol(symbol) = address.base {
            self.relocate(RelocationKind::Address, symbol);
        }
        Addr(address.offset.cast_unsigned())
    }

    /// Copies or clears memory.
    fn block(&mut self, to: Address, from: Option<Address>, len: u32) {
        let pointer = |address: Address| match address.base {
            Base::Value(value) => self.int(value),
            Base::Absolute | Base::Slot(_) | Base::Symbol(_) => RegI32(0),
        };
        let (to, from, len) = (pointer(to), from.map(pointer), Count(len as u16));
        self.push(match from {
            Some(src) => Op::Copy { to, src, len },
            None => Op::Clear { to, len },
        });
    }

    fn call(
        &mut self,
        callee: Callee,
        arguments: ArgumentRange,
        signature: SignatureId,
        dst: Option<ValueId>,
    ) {
        for (index, argument) in self.function.arguments[arguments.range()].iter().enumerate() {
            let (value, index) = (self.value(*argument), Count(index as u16));
            self.push(match self.class(value) {
                Class::I32 => Op::ArgI32 { src: self.int(value), index },
                Class::I64 => Op::ArgI64 { src: self.long(value), index },
                Class::F32 => Op::ArgF32 { src: self.single(value), index },
                Class::F64 => Op::ArgF64 { src: self.double(value), index },
            });
        }
        let number = u16::try_from(signature.as_u32());
        self.code.is_too_large |= number.is_err();
        let sig = SigRef(number.unwrap_or(0));
        match callee {
            Callee::Symbol(symbol) => {
                self.relocate(RelocationKind::Call(signature), symbol);
                self.push(Op::CallFw { sig, addr: Addr(0) });
            }
            Callee::Pointer(target) => {
                let target = self.int(self.value(target));
                self.push(Op::CallPtr { target, sig });
            }
        }
        if let Some(dst) = dst {
            self.push(match self.class(dst) {
                Class::I32 => Op::ResultI32 { dst: self.int(dst) },
                Class::I64 => Op::ResultI64 { dst: self.long(dst) },
                Class::F32 => Op::ResultF32 { dst: self.single(dst) },
                Class::F64 => Op::ResultF64 { dst: self.double(dst) },
            });
        }
    }

    fn terminator(&mut self, terminator: &Terminator, next: Option<BlockId>) {
        match *terminator {
            Terminator::Jump(to) => {
                if next != Some(to) {
                    self.jump(to);
                }
            }
            Terminator::Branch { condition, then, otherwise } => {
                let cond = self.int(self.value(condition));
                if next == Some(then) {
                    self.branches.push(self.code.ops.len() as u32);
                    self.push(Op::BrUnless { cond, to: Label(otherwise.as_u32()) });
                    return;
                }
                self.branches.push(self.code.ops.len() as u32);
                self.push(Op::BrIf { cond, to: Label(then.as_u32()) });
                if next != Some(otherwise) {
                    self.jump(otherwise);
                }
            }
            Terminator::Table { index, ref targets, default } => {
                let index = self.int(self.value(index));
                let n = u16::try_from(targets.len());
                self.code.is_too_large |= n.is_err();
                self.push(Op::BrTable { index, n: Count(n.unwrap_or(0)) });
                for target in targets {
                    self.jump(*target);
                }
                self.jump(default);
            }
            Terminator::Return(value) => self.ret(value),
            Terminator::Unreachable => self.push(Op::Unreachable {}),
        }
    }

    fn jump(&mut self, to: BlockId) {
        self.branches.push(self.code.ops.len() as u32);
        self.push(Op::Br { to: Label(to.as_u32()) });
    }

    fn ret(&mut self, value: Option<Operand>) {
        let Some(value) = value.map(|value| self.value(value)) else {
            self.push(Op::Ret {});
            return;
        };
        self.push(match self.class(value) {
            Class::I32 => Op::RetI32 { src: self.int(value) },
            Class::I64 => Op::RetI64 { src: self.long(value) },
            Class::F32 => Op::RetF32 { src: self.single(value) },
            Class::F64 => Op::RetF64 { src: self.double(value) },
        });
    }
}

/// Begins a run of words with the attribute `what`, unless the current run has the same.
fn begin_run<T: PartialEq>(runs: &mut Vec<(u32, T)>, word: u32, what: T) {
    match runs.last_mut() {
        Some((_, last)) if *last == what => {}
        Some((at, last)) if *at == word => *last = what,
        _ => runs.push((word, what)),
    }
}
