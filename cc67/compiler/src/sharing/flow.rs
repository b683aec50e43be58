//! Conditions that hold where an instruction is executed, as far as the branches of its function decide.

use std::collections::{BTreeMap, BTreeSet};

use super::Cell;
use super::values::Values;
use crate::ir::function::Function;
use crate::ir::inst::{BlockId, Constant, Inst, InstKind, Operand, Terminator};
use crate::ir::operators::CompareOp;
use crate::source::Span;

/// A cell whose value decides whether an instruction is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Guard {
    /// The cell.
    pub(super) cell: Cell,
    /// The comparison with a constant, if it is that simple.
    test: Option<Test>,
}

/// A comparison of a cell with a constant, and its outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Test {
    op: CompareOp,
    /// True if the constant is on the left.
    is_swapped: bool,
    constant: i32,
    outcome: bool,
}

impl Guard {
    /// Returns whether no value of the cell satisfies both conditions.
    pub(super) fn excludes(&self, other: &Self) -> bool {
        let constants = [self.test, other.test].map(|test| test.map(|test| test.constant));
        let [Some(one), Some(two)] = constants else { return false };
        let near = |constant: i32| [-1, 0, 1].map(|distance| constant.wrapping_add(distance));
        let mut values = near(one).into_iter().chain(near(two)).chain([i32::MIN, i32::MAX]);
        self.cell == other.cell && !values.any(|value| self.admits(Some(value)) && other.admits(Some(value)))
    }

    /// Returns whether the cell is compared with a constant.
    pub(super) const fn is_simple(&self) -> bool {
        self.test.is_some()
    }

    /// Returns whether the stored value can be the one that was waited for; an unknown value can.
    pub(super) fn admits(&self, stored: Option<i32>) -> bool {
        let (Some(Test { op, is_swapped, constant, outcome }), Some(stored)) = (self.test, stored) else {
            return true;
        };
        let (a, b) = if is_swapped { (constant, stored) } else { (stored, constant) };
        let is_met = match op {
            CompareOp::Equal => a == b,
            CompareOp::NotEqual => a != b,
            CompareOp::Less => a < b,
            CompareOp::LessEqual => a <= b,
            CompareOp::LessUnsigned => a.cast_unsigned() < b.cast_unsigned(),
            CompareOp::LessEqualUnsigned => a.cast_unsigned() <= b.cast_unsigned(),
        };
        is_met == outcome
    }
}

/// A loop that only polls a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wait {
    pub(super) cell: Cell,
    pub(super) span: Span,
}

/// The conditions of the blocks of a function.
#[derive(Debug)]
pub(super) struct Conditions {
    guards: BTreeMap<BlockId, BTreeSet<Guard>>,
    /// The blocks that can be executed more than once.
    repeated: BTreeSet<BlockId>,
}

impl Conditions {
    /// Finds them.
    pub(super) fn new(function: &Function, values: &Values<'_>) -> Self {
        let mut guards: BTreeMap<BlockId, BTreeSet<Guard>> = BTreeMap::new();
        let mut repeated = BTreeSet::new();
        for &block in &function.layout {
            let terminator = &function.blocks[block].terminator;
            if terminator.targets().any(|to| reached(function, values, to, None).contains(&block)) {
                repeated.insert(block);
            }
            let Terminator::Branch { condition, then, otherwise } = *terminator else { continue };
            let met = reached(function, values, then, Some(block));
            let unmet = reached(function, values, otherwise, Some(block));
            for (blocks, others, outcome) in [(&met, &unmet, true), (&unmet, &met, false)] {
                for only in blocks.difference(others) {
                    guards.entry(*only).or_default().extend(guards_of(values, condition, outcome));
                }
            }
        }
        Self { guards, repeated }
    }

    /// The guards of a block.
    pub(super) fn guards(&self, block: BlockId) -> impl Iterator<Item = Guard> + '_ {
        self.guards.get(&block).into_iter().flatten().copied()
    }

    /// The loops of the function without calls and stores, and the cells that they poll.
    pub(super) fn waits(&self, function: &Function, values: &Values<'_>) -> Vec<Wait> {
        let ends_idle_loop = |block: &&BlockId| {
            let loop_blocks = reached(function, values, **block, None);
            let mut loop_blocks =
                loop_blocks.iter().filter(|other| reached(function, values, **other, None).contains(*block));
            loop_blocks.all(|block| function.blocks[*block].insts.iter().all(is_idle))
        };
        let repeated = function.layout.iter().filter(|block| self.is_repeated(**block));
        let branches =
            repeated.filter(|block| matches!(function.blocks[**block].terminator, Terminator::Branch { .. }));
        let waits = branches.filter(ends_idle_loop).flat_map(|block| {
            let block = &function.blocks[*block];
            let cells =
                block.terminator.operand().map(|condition| values.loads(condition)).unwrap_or_default();
            cells.into_iter().map(|cell| Wait { cell, span: block.origin.span })
        });
        waits.collect()
    }

    /// Returns whether a block is in a loop of its function.
    pub(super) fn is_repeated(&self, block: BlockId) -> bool {
        self.repeated.contains(&block)
    }
}

/// Returns whether an instruction changes no memory and calls nothing.
const fn is_idle(inst: &Inst) -> bool {
    !matches!(
        inst.kind,
        InstKind::Store { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Call { .. }
    )
}

/// The blocks that are reachable from one, except those after `barrier` or the end of the thread.
fn reached(
    function: &Function,
    values: &Values<'_>,
    from: BlockId,
    barrier: Option<BlockId>,
) -> BTreeSet<BlockId> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(block) = open.pop() {
        if Some(block) != barrier && found.insert(block) {
            let block = &function.blocks[block];
            if !block.insts.iter().any(|inst| values.ends_thread(inst)) {
                open.extend(block.terminator.targets());
            }
        }
    }
    found
}

/// The cells that a condition tests; `outcome` is whether it holds.
fn guards_of(values: &Values<'_>, condition: Operand, outcome: bool) -> Vec<Guard> {
    match simple_test(values, condition, outcome) {
        Some(guard) => vec![guard],
        None => values.loads(condition).into_iter().map(|cell| Guard { cell, test: None }).collect(),
    }
}

/// The test of a cell against a constant that a condition is.
fn simple_test(values: &Values<'_>, condition: Operand, outcome: bool) -> Option<Guard> {
    let cell_of = |operand: Operand| {
        let InstKind::Load { address, .. } = values.only_write(operand.as_value()?)? else { return None };
        values.cell(address)
    };
    let whole = |operand| match values.constant(operand) {
        Some(Constant::I32(constant)) => Some(constant),
        _ => None,
    };
    if let Some(cell) = cell_of(condition) {
        let test = Test { op: CompareOp::NotEqual, is_swapped: false, constant: 0, outcome };
        return Some(Guard { cell, test: Some(test) });
    }
    match values.only_write(condition.as_value()?)? {
        InstKind::Copy { src, .. } => simple_test(values, src, outcome),
        InstKind::Compare { op, a, b, .. } => {
            let (cell, constant, is_swapped) = match (cell_of(a), cell_of(b)) {
                (Some(cell), _) => (cell, whole(b)?, false),
                (None, Some(cell)) => (cell, whole(a)?, true),
                (None, None) => return negated_test(values, op, [a, b], outcome),
            };
            Some(Guard { cell, test: Some(Test { op, is_swapped, constant, outcome }) })
        }
        InstKind::Unary { .. }
        | InstKind::Binary { .. }
        | InstKind::Convert { .. }
        | InstKind::Load { .. }
        | InstKind::Store { .. }
        | InstKind::FrameAddress { .. }
        | InstKind::CopyMemory { .. }
        | InstKind::ClearMemory { .. }
        | InstKind::Call { .. }
        | InstKind::Cost { .. } => None,
    }
}

/// The test that a comparison of its outcome with 0 is.
fn negated_test(values: &Values<'_>, op: CompareOp, [a, b]: [Operand; 2], outcome: bool) -> Option<Guard> {
    (b.as_int() == Some(0)).then_some(())?;
    match op {
        CompareOp::Equal => simple_test(values, a, !outcome),
        CompareOp::NotEqual => simple_test(values, a, outcome),
        CompareOp::Less | CompareOp::LessEqual | CompareOp::LessUnsigned | CompareOp::LessEqualUnsigned => {
            None
        }
    }
}
