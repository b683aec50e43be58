//! Rewrites a function to the instructions that the machine has.
//!
//! Afterwards every operand is a value, except constants that fit the immediate field of an instruction and sources of
//! copies; every address is absolute, a symbol, or a value with a displacement of 16 bits. Objects of the frame have
//! offsets; loads and stores access them through one value, computed at the function's entry.
//!
//! A constant that no field can hold is loaded where it is first needed, and reused as long as the code cannot be
//! entered in between; a constant needed by a loop is loaded before the first block.

use cranelift_entity::{PrimaryMap, SecondaryMap};

use super::operators;
use crate::ir::function::{Function, table};
use crate::ir::inst::{
    Address, Base, BlockId, Callee, Class, CodeOrigin, Constant, Inst, InstKind, Operand, SlotId, ValueId,
};
use crate::ir::operators::{BinaryOp, UnaryOp};

/// The frame in guest memory.
#[derive(Clone, Debug)]
pub(super) struct FrameLayout {
    /// The size in bytes, a multiple of 8; `None` if the objects do not fit an address space.
    pub(super) size: Option<u32>,
    /// The offset of each object in the frame.
    pub(super) offsets: SecondaryMap<SlotId, u32>,
    /// Instructions that are executed once, before the first block.
    pub(super) prologue: Vec<Inst>,
}

/// Bytes that one instruction can copy or clear; a multiple of 8.
const MAX_BLOCK: u32 = 0xfff8;

/// Number of loaded constants that are remembered.
const REMEMBERED: usize = 16;

/// The most constants that are loaded before the first block.
const MAX_EARLY: usize = 48;

/// Rewrites the function.
pub(super) fn legalize(function: &mut Function) -> FrameLayout {
    let (offsets, size) = place_slots(function);
    let predecessors = function.predecessors();
    let base = function.values.push(Class::I32);
    let mut legalizer = Legalizer {
        offsets,
        base,
        uses_base: false,
        values: std::mem::take(&mut function.values),
        arguments: std::mem::take(&mut function.arguments),
        loaded: Vec::with_capacity(REMEMBERED),
        oldest: 0,
        is_in_loop: false,
        early: Vec::new(),
        prologue: Vec::new(),
        out: Vec::new(),
        origin: CodeOrigin::of(function.span),
    };
    let in_loop = blocks_in_loops(function);
    let mut before = None;
    for (index, is_in_loop) in in_loop.into_iter().enumerate() {
        let id = function.layout[index];
        legalizer.is_in_loop = is_in_loop;
        if !function.is_only_way(before, id, &predecessors) {
            legalizer.clear_constants();
        }
        before = Some(id);
        let insts = std::mem::take(&mut function.blocks[id].insts);
        legalizer.out = Vec::with_capacity(insts.len() + insts.len() / 2);
        for inst in &insts {
            legalizer.origin = inst.origin;
            legalizer.inst(inst.kind);
        }
        let block = &mut function.blocks[id];
        legalizer.origin = block.origin;
        if let Some(operand) = block.terminator.operand_mut() {
            *operand = legalizer.value(*operand).into();
        }
        block.insts = std::mem::take(&mut legalizer.out);
    }
    function.values = legalizer.values;
    function.arguments = legalizer.arguments;
    let mut prologue = legalizer.prologue;
    if let (true, Some(slot)) = (legalizer.uses_base, function.slots.keys().next()) {
        // The base is the address of the frame's beginning, whichever object is there.
        let offset = legalizer.offsets[slot].cast_signed().wrapping_neg();
        let kind = InstKind::FrameAddress { dst: base, slot, offset };
        prologue.push(Inst { kind, origin: CodeOrigin::of(function.span) });
    }
    FrameLayout { size, offsets: legalizer.offsets, prologue }
}

/// True for each block, by its position in the layout, that is between a backward jump and its target.
fn blocks_in_loops(function: &Function) -> Vec<bool> {
    let mut places: SecondaryMap<BlockId, u32> = table(function.blocks.len());
    for (index, id) in function.layout.iter().enumerate() {
        places[*id] = index as u32;
    }
    // The number of loops that begin at a block, minus those that end before it.
    let mut changes = vec![0_i32; function.layout.len() + 1];
    for (index, id) in function.layout.iter().enumerate() {
        for target in function.blocks[*id].terminator.targets().map(|to| places[to] as usize) {
            if target <= index {
                changes[target] += 1;
                changes[index + 1] -= 1;
            }
        }
    }
    let depths = changes.iter().scan(0, |depth, change| {
        *depth += change;
        Some(*depth > 0)
    });
    depths.take(function.layout.len()).collect()
}

/// Gives every object of the frame that is used its offset.
fn place_slots(function: &Function) -> (SecondaryMap<SlotId, u32>, Option<u32>) {
    let mut used: SecondaryMap<SlotId, bool> = table(function.slots.len());
    if !function.slots.is_empty() {
        for &id in &function.layout {
            for inst in &function.blocks[id].insts {
                for_each_slot(&inst.kind, |slot| used[slot] = true);
            }
        }
    }
    let mut offsets = table(function.slots.len());
    let mut end = Some(0_u32);
    for (id, slot) in &function.slots {
        if used[id] {
            let start = end.and_then(|end| end.checked_next_multiple_of(slot.align.max(1)));
            offsets[id] = start.unwrap_or(0);
            end = start.and_then(|start| start.checked_add(slot.size));
        }
    }
    (offsets, end.and_then(|end| end.checked_next_multiple_of(8)))
}

/// Hands every object of the frame that an instruction mentions to `visit`.
fn for_each_slot(kind: &InstKind, mut visit: impl FnMut(SlotId)) {
    let mut visit_base = |address: Address| {
        if let Base::Slot(slot) = address.base {
            visit(slot);
        }
    };
    match *kind {
        InstKind::FrameAddress { slot, .. } => visit(slot),
        InstKind::Load { address, .. }
        | InstKind::Store { address, .. }
        | InstKind::ClearMemory { to: address, .. } => visit_base(address),
        InstKind::CopyMemory { to, from, .. } => {
            visit_base(to);
            visit_base(from);
        }
        InstKind::Copy { .. }
        | InstKind::Unary { .. }
        | InstKind::Binary { .. }
        | InstKind::Compare { .. }
        | InstKind::Convert { .. }
        | InstKind::Call { .. }
        | InstKind::Cost { .. } => {}
    }
}

struct Legalizer {
    offsets: SecondaryMap<SlotId, u32>,
    /// The value that holds the frame's address.
    base: ValueId,
    uses_base: bool,
    values: PrimaryMap<ValueId, Class>,
    arguments: Vec<Operand>,
    /// Constants that are available in values.
    loaded: Vec<(Constant, ValueId)>,
    /// The index of the entry that is replaced next.
    oldest: usize,
    /// True if the current block may be executed many times.
    is_in_loop: bool,
    /// Constants that are in values everywhere.
    early: Vec<(Constant, ValueId)>,
    prologue: Vec<Inst>,
    out: Vec<Inst>,
    origin: CodeOrigin,
}

impl Legalizer {
    /// Drops the constants at the beginning of a block that may be reached from code without them.
    fn clear_constants(&mut self) {
        self.loaded.clear();
        self.oldest = 0;
    }

    fn push(&mut self, kind: InstKind) {
        self.out.push(Inst { kind, origin: self.origin });
    }

    fn inst(&mut self, kind: InstKind) {
        let legal = match kind {
            InstKind::Copy { .. } | InstKind::FrameAddress { .. } | InstKind::Cost { .. } => kind,
            InstKind::Unary { op, dst, src } => self.unary(op, dst, src),
            InstKind::Binary { op, dst, a, b } => self.binary(op, dst, a, b),
            InstKind::Compare { op, dst, a, b } => {
                InstKind::Compare { op, dst, a: self.value(a).into(), b: self.value(b).into() }
            }
            InstKind::Convert { op, dst, src } => InstKind::Convert { op, dst, src: self.value(src).into() },
            InstKind::Load { dst, width, address } => {
                InstKind::Load { dst, width, address: self.address(address) }
            }
            InstKind::Store { src, width, address } => {
                let src = self.value(src).into();
                InstKind::Store { src, width, address: self.address(address) }
            }
            InstKind::CopyMemory { to, from, len } => return self.blocks(to, Some(from), len),
            InstKind::ClearMemory { to, len } => return self.blocks(to, None, len),
            InstKind::Call { callee, arguments, signature, dst } => {
                let callee = match callee {
                    Callee::Pointer(target) => Callee::Pointer(self.value(target).into()),
                    Callee::Symbol(_) => callee,
                };
                for index in arguments.range() {
                    self.arguments[index] = self.value(self.arguments[index]).into();
                }
                InstKind::Call { callee, arguments, signature, dst }
            }
        };
        self.push(legal);
    }

    /// The machine negates only floats; integers are subtracted from 0, or combined with all ones.
    fn unary(&mut self, op: UnaryOp, dst: ValueId, src: Operand) -> InstKind {
        let class = self.values[dst];
        let src = Operand::from(self.value(src));
        match (op, class) {
            (UnaryOp::Negate, Class::F32 | Class::F64) => InstKind::Unary { op, dst, src },
            (UnaryOp::Negate, Class::I32 | Class::I64) => {
                let zero = self.value(class.zero().into());
                InstKind::Binary { op: BinaryOp::Subtract, dst, a: zero.into(), b: src }
            }
            (UnaryOp::Complement, _) => {
                let ones = if class == Class::I64 { Constant::I64(-1) } else { Constant::I32(-1) };
                let ones = self.value(ones.into());
                InstKind::Binary { op: BinaryOp::Xor, dst, a: src, b: ones.into() }
            }
        }
    }

    fn binary(&mut self, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) -> InstKind {
        let is_int = self.values[dst] == Class::I32;
        let (mut op, mut a, mut b) = (op, a, b);
        if op.is_commutative() && a.as_value().is_none() {
            std::mem::swap(&mut a, &mut b);
        }
        // `x - c` is `x + -c`, which has an immediate form.
        if let (BinaryOp::Subtract, Some(value), true) = (op, b.as_int(), is_int) {
            (op, b) = (BinaryOp::Add, Operand::int(value.wrapping_neg()));
        }
        let a = Operand::from(self.value(a));
        let has_immediate = operators::immediate(op).is_some();
        let fits = b.as_int().is_some_and(|value| i16::try_from(value).is_ok());
        let b = if is_int && has_immediate && fits { b } else { self.value(b).into() };
        InstKind::Binary { op, dst, a, b }
    }

    /// An address that a load or store can have.
    fn address(&mut self, address: Address) -> Address {
        let (base, offset) = match address.base {
            Base::Absolute | Base::Symbol(_) => return address,
            Base::Value(value) => (value, address.offset),
            Base::Slot(slot) => {
                self.uses_base = true;
                (self.base, address.offset.wrapping_add(self.offsets[slot].cast_signed()))
            }
        };
        if i16::try_from(offset).is_ok() {
            return Address { base: Base::Value(base), offset };
        }
        let sum = self.values.push(Class::I32);
        let add = self.binary(BinaryOp::Add, sum, base.into(), Operand::int(offset));
        self.push(add);
        Address::new(Base::Value(sum))
    }

    /// Copies or clears memory, in as many parts as the length field of the instruction needs.
    fn blocks(&mut self, to: Address, from: Option<Address>, len: u32) {
        let mut done = 0;
        while done < len {
            let part = (len - done).min(MAX_BLOCK);
            let offset = done.cast_signed();
            let to = self.pointer(to.plus(offset));
            let kind = match from {
                Some(from) => {
                    let from = self.pointer(from.plus(offset));
                    InstKind::CopyMemory { to, from, len: part }
                }
                None => InstKind::ClearMemory { to, len: part },
            };
            self.push(kind);
            done += part;
        }
    }

    /// The address in a value, without displacement.
    fn pointer(&mut self, address: Address) -> Address {
        let value = match address.base {
            Base::Value(value) if address.offset == 0 => value,
            Base::Absolute => self.value(Operand::int(address.offset)),
            Base::Symbol(symbol) => self.value(Constant::Symbol(symbol, address.offset).into()),
            Base::Value(base) => {
                let dst = self.values.push(Class::I32);
                let sum = self.binary(BinaryOp::Add, dst, base.into(), Operand::int(address.offset));
                self.push(sum);
                dst
            }
            Base::Slot(slot) => {
                let dst = self.values.push(Class::I32);
                self.push(InstKind::FrameAddress { dst, slot, offset: address.offset });
                dst
            }
        };
        Address::new(Base::Value(value))
    }

    /// A value that holds the operand. In a loop, a constant is loaded once for the function; elsewhere, it is loaded
    /// again when it is no longer available.
    fn value(&mut self, operand: Operand) -> ValueId {
        let constant = match operand {
            Operand::Value(value) => return value,
            Operand::Constant(constant) => constant,
        };
        let known = self.loaded.iter().chain(&self.early).find(|(known, _)| *known == constant);
        if let Some((_, value)) = known {
            return *value;
        }
        let value = self.values.push(constant.class());
        let kind = InstKind::Copy { dst: value, src: operand };
        if self.is_in_loop && self.early.len() < MAX_EARLY {
            self.early.push((constant, value));
            self.prologue.push(Inst { kind, origin: self.origin });
            return value;
        }
        self.push(kind);
        if self.loaded.len() < REMEMBERED {
            self.loaded.push((constant, value));
        } else {
            self.loaded[self.oldest] = (constant, value);
            self.oldest = (self.oldest + 1) % REMEMBERED;
        }
        value
    }
}
