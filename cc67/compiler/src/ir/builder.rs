//! Appends instructions to the open block.
//!
//! No block is open after a terminator: instructions appended there are unreachable and dropped, until the next block
//! is opened. A block enters the layout when it is opened, so the code is in the order in which it was built.

use cranelift_entity::packed_option::PackedOption;

use super::function::{Block, FrameSlot, Function};
use super::inst::{
    Address, ArgumentRange, BlockId, Callee, Class, CodeOrigin, Inst, InstKind, Operand, SignatureId, SlotId,
    Terminator, ValueId,
};
use super::operators::{BinaryOp, CompareOp, ConvertOp, UnaryOp, Width};
use crate::source::Span;

/// A position between two instructions, where another can be inserted later.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    block: PackedOption<BlockId>,
    index: u32,
}

/// Builds one function.
#[derive(Debug)]
pub struct Builder {
    /// The function so far.
    pub function: Function,
    open: Option<BlockId>,
    /// Index of the cost instruction of the open block, which grows as instructions follow.
    cost: Option<usize>,
    /// Blocks that are placed before other blocks, each with that block.
    ways: Vec<(BlockId, BlockId)>,
    origin: CodeOrigin,
}

impl Builder {
    /// Starts with the function's entry block open.
    #[must_use]
    pub fn new(function: Function) -> Self {
        let origin = CodeOrigin::of(function.span);
        let mut builder = Self { function, open: None, cost: None, ways: Vec::new(), origin };
        let entry = builder.block();
        builder.open(entry);
        builder
    }

    /// Sets the statement of the following instructions.
    pub fn set_span(&mut self, span: Span) {
        self.origin = CodeOrigin::of(span);
    }

    /// The statement of the current instructions.
    #[must_use]
    pub const fn span(&self) -> Span {
        self.origin.span
    }

    /// Reports whether instructions appended now can be reached.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// A new value.
    pub fn value(&mut self, class: Class) -> ValueId {
        self.function.values.push(class)
    }

    /// A new object in the frame.
    pub fn slot(&mut self, size: u32, align: u32) -> SlotId {
        self.function.slots.push(FrameSlot { size, align })
    }

    /// A new block, to be opened later.
    pub fn block(&mut self) -> BlockId {
        let origin = self.origin;
        self.function.blocks.push(Block { insts: Vec::new(), terminator: Terminator::Unreachable, origin })
    }

    /// Opens a block; the previous one, if still open, jumps to it.
    pub fn open(&mut self, block: BlockId) {
        self.terminate(Terminator::Jump(block));
        self.place_ways(block);
        self.function.layout.push(block);
        self.open = Some(block);
        self.cost = None;
    }

    /// Places the blocks that only charge a cost before the block at which they continue; such blocks may have further
    /// ones before them.
    fn place_ways(&mut self, to: BlockId) {
        let ways: Vec<_> = self.ways.extract_if(.., |(leads_to, _)| *leads_to == to).collect();
        for (_, way) in ways {
            self.place_ways(way);
            self.function.layout.push(way);
        }
    }

    /// A block that only charges a cost and continues at `to`; it is placed before `to`, if that is yet to be opened.
    pub fn charge_block(&mut self, to: BlockId, cycles: u32) -> BlockId {
        let origin = self.origin;
        let insts = vec![Inst { kind: InstKind::Cost { cycles }, origin }];
        let way = self.function.blocks.push(Block { insts, terminator: Terminator::Jump(to), origin });
        if self.function.layout.contains(&to) {
            self.function.layout.push(way);
        } else {
            self.ways.push((to, way));
        }
        way
    }

    /// Ends the open block.
    pub fn terminate(&mut self, terminator: Terminator) {
        if let Some(block) = self.open.take() {
            let origin = self.origin;
            let block = &mut self.function.blocks[block];
            block.terminator = terminator;
            block.origin = origin;
        }
    }

    /// Ends the block with a jump to `to`.
    pub fn jump(&mut self, to: BlockId) {
        self.terminate(Terminator::Jump(to));
    }

    /// Ends the block with a branch to `then` if `condition` is not 0.
    pub fn branch(&mut self, condition: Operand, then: BlockId, otherwise: BlockId) {
        self.terminate(Terminator::Branch { condition, then, otherwise });
    }

    /// The position after the last appended instruction.
    #[must_use]
    pub fn point(&self) -> Point {
        let index = self.open.map_or(0, |block| self.function.blocks[block].insts.len() as u32);
        Point { block: self.open.into(), index }
    }

    /// Inserts `dst = src` at an earlier position.
    pub fn insert_copy(&mut self, point: Point, dst: ValueId, src: Operand) {
        if let Some(block) = point.block.expand() {
            let inst = Inst { kind: InstKind::Copy { dst, src }, origin: self.origin };
            let index = point.index as usize;
            self.function.blocks[block].insts.insert(index, inst);
            if let Some(cost) = self.cost.as_mut().filter(|cost| self.open == Some(block) && index <= **cost)
            {
                *cost += 1;
            }
        }
    }

    /// Adds to the cost of the open block after its last call; a negative number takes back cost.
    pub fn cost(&mut self, cycles: i32) {
        let Some(block) = self.open.filter(|_| cycles != 0) else { return };
        let insts = &mut self.function.blocks[block].insts;
        let known = self.cost.and_then(|at| insts.get_mut(at));
        if let Some(Inst { kind: InstKind::Cost { cycles: sum }, .. }) = known {
            *sum = sum.saturating_add_signed(cycles);
            return;
        }
        self.cost = Some(insts.len());
        let kind = InstKind::Cost { cycles: 0_u32.saturating_add_signed(cycles) };
        insts.push(Inst { kind, origin: self.origin });
    }

    /// Appends an instruction.
    pub fn push(&mut self, kind: InstKind) {
        if let InstKind::Call { .. } = kind {
            self.cost = None;
        }
        if let Some(block) = self.open {
            self.function.blocks[block].insts.push(Inst { kind, origin: self.origin });
        }
    }

    /// `dst = src`
    pub fn copy(&mut self, dst: ValueId, src: Operand) {
        if src != Operand::Value(dst) {
            self.push(InstKind::Copy { dst, src });
        }
    }

    /// `dst = op src`
    pub fn unary(&mut self, op: UnaryOp, dst: ValueId, src: Operand) {
        self.push(InstKind::Unary { op, dst, src });
    }

    /// `dst = a op b`
    pub fn binary(&mut self, op: BinaryOp, dst: ValueId, a: Operand, b: Operand) {
        self.push(InstKind::Binary { op, dst, a, b });
    }

    /// `dst = a op b`, 0 or 1
    pub fn compare(&mut self, op: CompareOp, dst: ValueId, a: Operand, b: Operand) {
        self.push(InstKind::Compare { op, dst, a, b });
    }

    /// `dst = op(src)`
    pub fn convert(&mut self, op: ConvertOp, dst: ValueId, src: Operand) {
        self.push(InstKind::Convert { op, dst, src });
    }

    /// `dst = memory[address]`
    pub fn load(&mut self, dst: ValueId, width: Width, address: Address) {
        self.push(InstKind::Load { dst, width, address });
    }

    /// `memory[address] = src`
    pub fn store(&mut self, src: Operand, width: Width, address: Address) {
        self.push(InstKind::Store { src, width, address });
    }

    /// `dst = callee(arguments)`
    pub fn call(
        &mut self,
        callee: Callee,
        signature: SignatureId,
        arguments: impl IntoIterator<Item = Operand>,
        dst: Option<ValueId>,
    ) {
        let start = self.function.arguments.len();
        self.function.arguments.extend(arguments);
        let count = (self.function.arguments.len() - start) as u32;
        let arguments = ArgumentRange { start: start as u32, count };
        self.push(InstKind::Call { callee, arguments, signature, dst: dst.into() });
    }
}
