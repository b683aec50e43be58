//! Compile-time evaluation of loops that only compute with known numbers.
//!
//! A loop is evaluated if it is entered from a single block, all its inputs are known there, and it neither accesses
//! memory nor calls functions. Its iterations are computed as on the machine, up to a limit; they are replaced by its
//! final values. A loop with more iterations, such as a delay loop, is kept.

use std::collections::BTreeMap;

use super::loops::{self, LoopRange};
use super::strength::{self, Simplification};
use crate::ir::function::{Block, Function};
use crate::ir::inst::{BlockId, Constant, Inst, InstKind, Operand, Terminator, ValueId};

/// The most instructions that are computed for one loop, and for a function.
const MOST: u32 = 20_000;
const MOST_OF_ALL: u32 = 60_000;
/// The number of blocks before a loop in which an initial value is searched for.
const BEFORE: usize = 8;
/// The size limit of functions, in blocks.
const LARGEST: usize = 400;

/// Replaces loops by their final values; returns whether anything changed.
pub fn run(function: &mut Function) -> bool {
    let mut is_changed = false;
    let mut budget = MOST_OF_ALL;
    while budget > 0 && function.layout.len() <= LARGEST && replace_first_loop(function, &mut budget) {
        is_changed = true;
        super::jumps::run(function);
        super::fold::run(function);
        super::jumps::run(function);
    }
    is_changed
}

/// Replaces the first loop that can be, the largest first.
fn replace_first_loop(function: &mut Function, budget: &mut u32) -> bool {
    let places = loops::places(function);
    let mut found = loops::find_ranges(function, &places);
    found.sort_by_key(|range| std::cmp::Reverse(range.last - range.first));
    for range in found {
        let Some(preheader) = loops::preheader(function, &places, range) else { continue };
        let mut machine = Machine { function, preheader, values: BTreeMap::new() };
        let most = MOST.min(*budget);
        let mut steps = most;
        let outside = machine.run(function.layout[range.first], &mut steps, |id| {
            (range.first as u32..=range.last as u32).contains(&places[id])
        });
        *budget -= most - steps;
        if let Some(outside) = outside {
            let values = machine.values;
            replace(function, range, outside, &values);
            return true;
        }
    }
    false
}

/// A block with the last values takes the place of a loop.
fn replace(
    function: &mut Function,
    range: LoopRange,
    outside: BlockId,
    values: &BTreeMap<ValueId, Option<Constant>>,
) {
    let header = function.layout[range.first];
    let origin = function.blocks[header].origin;
    let known = values.iter().filter_map(|(dst, value)| Some((*dst, (*value)?)));
    let insts = known.map(|(dst, value)| Inst { kind: InstKind::Copy { dst, src: value.into() }, origin });
    let insts = insts.collect();
    let block = function.blocks.push(Block { insts, terminator: Terminator::Jump(outside), origin });
    for id in function.layout.iter().filter(|id| **id != header) {
        function.blocks[*id].terminator.visit_targets(|target| {
            if *target == header {
                *target = block;
            }
        });
    }
    function.layout.insert(range.first, block);
}

/// Computes as the program would.
struct Machine<'a> {
    function: &'a Function,
    preheader: BlockId,
    /// The constants looked up or written so far; `None` for unknown values.
    values: BTreeMap<ValueId, Option<Constant>>,
}

impl Machine<'_> {
    /// Follows a loop from its first block; the block outside where it ends.
    fn run(
        &mut self,
        header: BlockId,
        steps: &mut u32,
        is_inside: impl Fn(BlockId) -> bool,
    ) -> Option<BlockId> {
        let mut id = header;
        loop {
            let block = &self.function.blocks[id];
            *steps = steps.checked_sub(block.insts.len() as u32 + 1)?;
            for inst in &block.insts {
                self.inst(&inst.kind)?;
            }
            let next = self.next(&block.terminator)?;
            if !is_inside(next) {
                return Some(next);
            }
            id = next;
        }
    }

    fn inst(&mut self, kind: &InstKind) -> Option<()> {
        let (dst, simplified) = match *kind {
            InstKind::Copy { dst, src } => (dst, Simplification::Operand(self.constant_of(src)?)),
            InstKind::Unary { op, dst, src } => (dst, strength::unary(op, self.constant_of(src)?)),
            InstKind::Binary { op, dst, a, b } => {
                let class = self.function.values[dst];
                (dst, strength::binary(op, self.constant_of(a)?, self.constant_of(b)?, class))
            }
            InstKind::Compare { op, dst, a, b } => {
                (dst, strength::compare(op, self.constant_of(a)?, self.constant_of(b)?))
            }
            InstKind::Convert { op, dst, src } => (dst, strength::convert(op, self.constant_of(src)?)),
            InstKind::Load { .. }
            | InstKind::Store { .. }
            | InstKind::FrameAddress { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Call { .. }
            | InstKind::Cost { .. } => return None,
        };
        let Simplification::Operand(Operand::Constant(value)) = simplified else { return None };
        self.values.insert(dst, Some(value));
        Some(())
    }

    fn next(&mut self, terminator: &Terminator) -> Option<BlockId> {
        match terminator {
            Terminator::Jump(to) => Some(*to),
            Terminator::Branch { condition, then, otherwise } => {
                let condition = self.number(*condition)?;
                Some(if condition == 0 { *otherwise } else { *then })
            }
            Terminator::Table { index, targets, default } => {
                let index = self.number(*index)?;
                Some(targets.get(index.cast_unsigned() as usize).copied().unwrap_or(*default))
            }
            Terminator::Return(_) | Terminator::Unreachable => None,
        }
    }

    fn number(&mut self, operand: Operand) -> Option<i32> {
        self.constant_of(operand)?.as_int()
    }

    /// The constant that an operand is.
    fn constant_of(&mut self, operand: Operand) -> Option<Operand> {
        let value = match operand {
            Operand::Constant(Constant::Symbol(..)) => return None,
            Operand::Constant(_) => return Some(operand),
            Operand::Value(value) => value,
        };
        if let Some(known) = self.values.get(&value) {
            return known.map(Operand::from);
        }
        let first = self.initial_constant(value);
        self.values.insert(value, first);
        first.map(Operand::from)
    }

    /// The constant that a value holds at the start of the loop.
    fn initial_constant(&self, value: ValueId) -> Option<Constant> {
        let mut id = self.preheader;
        for _ in 0..BEFORE {
            let insts = &self.function.blocks[id].insts;
            if let Some(inst) = insts.iter().rev().find(|inst| inst.kind.dst() == Some(value)) {
                let InstKind::Copy { src: Operand::Constant(constant), .. } = inst.kind else { return None };
                return (!matches!(constant, Constant::Symbol(..))).then_some(constant);
            }
            id = self.single_predecessor(id)?;
        }
        None
    }

    /// The only block that leads to another.
    fn single_predecessor(&self, id: BlockId) -> Option<BlockId> {
        if self.function.layout.first() == Some(&id) {
            return None;
        }
        let leads = |other: &&BlockId| self.function.blocks[**other].terminator.targets().any(|to| to == id);
        let mut before = self.function.layout.iter().filter(leads);
        before.next().copied().filter(|_| before.next().is_none())
    }
}
