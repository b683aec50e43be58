//! Loop counters: a counter that is tested needs no second register.
//!
//! Instruction selection copies a value with other readers to one of the six registers that can be tested. At the end
//! of a single-block loop, that copy costs a step in every iteration, between the counter and the branch. If the
//! counter is not read after the loop, the counter itself is tested.

use cranelift_entity::SecondaryMap;

use super::code::{Arg, Code, Terminator, VReg};
use super::forms::Kind;
use super::predicate::UserBlocks;

/// The most registers that are tested inside an iteration.
const TESTED: usize = 2;

/// Rewrites the loops of one block.
pub(super) fn run(code: &mut Code) {
    // Even after a copy is removed, its block reads the counter.
    let readers = Readers::new(code);
    for number in 0..code.blocks.len() {
        let Some((at, count)) = copied_counter(code, &readers, number) else { continue };
        code.regs[count].is_condition = true;
        let block = &mut code.blocks[number];
        block.insts.remove(at);
        if let Some(tested) = block.terminator.read_mut() {
            *tested = count;
        }
    }
}

/// The copy that is tested by the branch back to a block, and its source, if the source can be tested instead.
fn copied_counter(code: &Code, readers: &Readers, number: usize) -> Option<(usize, VReg)> {
    let block = &code.blocks[number];
    let Terminator::Branch { condition, then, otherwise, .. } = block.terminator else { return None };
    if then != number as u32 && otherwise != number as u32 {
        return None;
    }
    let at = block
        .insts
        .iter()
        .rposition(|inst| inst.written_register().is_some_and(|(reg, _)| reg == condition))?;
    let inst = &block.insts[at];
    let Arg::Reg(count) = inst.src2 else { return None };
    let is_copy = inst.kind == Kind::Move && inst.condition.is_none() && !code.regs[count].is_pair;
    let changes = |inst: &super::code::Inst| inst.written_register().is_some_and(|(reg, _)| reg == count);
    let before = block.insts[..at].iter().filter(|inst| changes(inst)).count();
    let is_last = before == 1 && !block.insts[at + 1..].iter().any(changes);
    let mut tested: Vec<VReg> = Vec::new();
    for (reg, _) in block.insts.iter().filter_map(|inst| inst.condition) {
        if !tested.contains(&reg) {
            tested.push(reg);
        }
    }
    let is_own = is_copy && is_last && tested.len() <= TESTED && !tested.contains(&condition);
    (is_own && !readers.is_read_elsewhere(code, number, at, [count, condition])).then_some((at, count))
}

/// The blocks that read each register, and the registers that are arguments of calls.
struct Readers {
    blocks: SecondaryMap<VReg, UserBlocks>,
    is_argument: SecondaryMap<VReg, bool>,
}

impl Readers {
    fn new(code: &Code) -> Self {
        let mut blocks: SecondaryMap<VReg, UserBlocks> = SecondaryMap::with_capacity(code.regs.len());
        blocks.resize(code.regs.len());
        let mut is_argument = SecondaryMap::with_capacity(code.regs.len());
        is_argument.resize(code.regs.len());
        for (number, block) in (0..).zip(&code.blocks) {
            block.insts.iter().for_each(|inst| inst.visit_reads(|reg| blocks[reg].add(number)));
            if let Some(reg) = block.terminator.read() {
                blocks[reg].add(number);
            }
        }
        for (reg, _) in code.calls.iter().flat_map(|call| &call.arguments) {
            is_argument[*reg] = true;
        }
        Self { blocks, is_argument }
    }

    /// Reports whether the count is read outside the block, or its copy anywhere but by the branch.
    fn is_read_elsewhere(
        &self,
        code: &Code,
        number: usize,
        copy: usize,
        [count, condition]: [VReg; 2],
    ) -> bool {
        let is_outside = |reg: VReg| self.is_argument[reg] || self.blocks[reg].is_outside(number as u32);
        let mut is_read = is_outside(count) || is_outside(condition);
        let own = code.blocks[number].insts.iter().enumerate().filter(|(at, _)| *at != copy);
        own.for_each(|(_, inst)| inst.visit_reads(|reg| is_read |= reg == condition));
        is_read
    }
}
