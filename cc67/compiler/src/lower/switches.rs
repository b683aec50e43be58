//! Switches: tables where the cases are dense, otherwise a binary search.

use super::{Lowering, Switch, cost_table, types};
use crate::ir::inst::{BlockId, Class, Constant, Operand, Terminator};
use crate::ir::operators::{BinaryOp, CompareOp};
use crate::typed::{Case, ExprId, Stmt};

/// The limit of entries in a table.
const MAX_TABLE: i128 = 4096;
/// So few cases are compared one by one.
const FEW: usize = 3;

/// A range of values and its target.
#[derive(Clone, Copy, Debug)]
struct CaseEntry {
    first: i128,
    last: i128,
    block: BlockId,
    /// The number of values covered by this entry and those before it.
    covered: i128,
}

/// The values that all parts of one switch's search share.
#[derive(Clone, Copy)]
struct Search {
    value: Operand,
    class: Class,
    is_unsigned: bool,
    default: BlockId,
}

impl Lowering<'_> {
    pub(super) fn switch_statement(
        &mut self,
        value: ExprId,
        cases: &[Case],
        has_default: bool,
        body: &[Stmt],
    ) {
        let ty = self.function.exprs[value].ty;
        let value = self.value(value);
        let end = self.builder.block();
        let default = if has_default { self.builder.block() } else { end };
        let blocks: Vec<BlockId> = cases.iter().map(|_| self.builder.block()).collect();
        self.cost(cost_table::BRANCH);
        let targets = self.case_ways(&blocks, default);
        let (blocks_found, default_found) = targets;
        let search = Search {
            value,
            class: self.builder.function.class(value),
            is_unsigned: types::is_unsigned(&self.unit.types, ty),
            default: default_found,
        };
        let entries = entries(cases, &blocks_found, search.is_unsigned);
        self.search(search, &entries);
        self.open_case_ways(&blocks_found, &blocks, default_found, default);
        self.jumps.switches.push(Switch { cases: blocks, default });
        self.jumps.breaks.push(end);
        self.statements(body);
        self.jumps.breaks.pop();
        self.jumps.switches.pop();
        self.builder.open(end);
    }

    /// Blocks that charge the cost of finding each case in the vendor's code, which compares the cases one after
    /// another.
    fn case_ways(&mut self, blocks: &[BlockId], default: BlockId) -> (Vec<BlockId>, BlockId) {
        if self.cost_model.is_none() {
            return (blocks.to_vec(), default);
        }
        (blocks.iter().map(|_| self.builder.block()).collect(), self.builder.block())
    }

    /// Fills these blocks, if there are any.
    fn open_case_ways(
        &mut self,
        ways: &[BlockId],
        blocks: &[BlockId],
        default_way: BlockId,
        default: BlockId,
    ) {
        if default_way == default {
            return;
        }
        let all = ways.iter().zip(blocks).zip(1..);
        for ((way, block), tried) in all {
            self.builder.open(*way);
            self.cost(cost_table::CASE * tried);
            self.builder.jump(*block);
        }
        self.builder.open(default_way);
        self.cost(cost_table::CASE * blocks.len() as i32);
        self.builder.jump(default);
    }

    /// Finds the entry of the value among `entries`, which ascend.
    fn search(&mut self, search: Search, entries: &[CaseEntry]) {
        let (Some(low), Some(high)) = (entries.first(), entries.last()) else {
            self.builder.jump(search.default);
            return;
        };
        let span = high.last - low.first + 1;
        let covered = high.covered - low.covered + (low.last - low.first + 1);
        let is_dense = span <= MAX_TABLE && span <= covered * 3 && search.class == Class::I32;
        if entries.len() <= FEW {
            self.compare_each(search, entries);
        } else if is_dense {
            self.table(search, entries, low.first, span as usize);
        } else {
            let (left, right) = entries.split_at(entries.len() / 2);
            let middle = right.first().map_or(0, |entry| entry.first);
            let op = if search.is_unsigned { CompareOp::LessUnsigned } else { CompareOp::Less };
            let (below, above) = (self.builder.block(), self.builder.block());
            let is_below = self.builder.value(Class::I32);
            self.builder.compare(op, is_below, search.value, constant(search.class, middle));
            self.builder.branch(is_below.into(), below, above);
            self.builder.open(below);
            self.search(search, left);
            self.builder.open(above);
            self.search(search, right);
        }
    }

    fn compare_each(&mut self, search: Search, entries: &[CaseEntry]) {
        for (index, entry) in entries.iter().enumerate() {
            let is_last = index + 1 == entries.len();
            let next = if is_last { search.default } else { self.builder.block() };
            let hit = self.builder.value(Class::I32);
            let first = constant(search.class, entry.first);
            if entry.first == entry.last {
                self.builder.compare(CompareOp::Equal, hit, search.value, first);
            } else {
                let offset = self.binary_value(BinaryOp::Subtract, search.class, search.value, first);
                let length = constant(search.class, entry.last - entry.first);
                self.builder.compare(CompareOp::LessEqualUnsigned, hit, offset, length);
            }
            self.builder.branch(hit.into(), entry.block, next);
            if !is_last {
                self.builder.open(next);
            }
        }
    }

    fn table(&mut self, search: Search, entries: &[CaseEntry], low: i128, span: usize) {
        let mut targets = vec![search.default; span];
        for entry in entries {
            let (from, to) = ((entry.first - low) as usize, (entry.last - low) as usize);
            if let Some(part) = targets.get_mut(from..=to) {
                part.fill(entry.block);
            }
        }
        let index = match low {
            0 => search.value,
            _ => self.binary_value(BinaryOp::Subtract, Class::I32, search.value, constant(Class::I32, low)),
        };
        let targets = targets.into_boxed_slice();
        self.builder.terminate(Terminator::Table { index, targets, default: search.default });
    }
}

/// The cases in ascending order; empty ranges match nothing, overlapping ones have been refused.
fn entries(cases: &[Case], blocks: &[BlockId], is_unsigned: bool) -> Vec<CaseEntry> {
    let mut entries: Vec<CaseEntry> = (cases.iter().zip(blocks))
        .map(|(case, block)| (case.values(is_unsigned), *block))
        .filter(|((first, last), _)| first <= last)
        .map(|((first, last), block)| CaseEntry { first, last, block, covered: 0 })
        .collect();
    entries.sort_by_key(|entry| entry.first);
    let mut covered = 0;
    for entry in &mut entries {
        covered += entry.last - entry.first + 1;
        entry.covered = covered;
    }
    entries
}

fn constant(class: Class, value: i128) -> Operand {
    Constant::number(class, value as i64).into()
}
