//! Moves steps that can wait to where they take no room: out of packets that would cross a fetch packet boundary, into
//! otherwise empty cycles.
//!
//! No packet crosses a 32-byte boundary; the rest before the boundary is filled with parallel `NOP`s. A cycle in which
//! nothing issues also takes a `NOP`. No step moves beyond the steps that wait for it, so the region keeps its length.

use c67x::Inst;

use super::graph::{self, BRANCH, Graph};
use super::packets::{FETCH, IssuedInst, LONGEST, ScheduledRegion};
use super::resources::Resources;
use super::step::{Access, Step};

/// The longest run of empty cycles that is filled.
const GAP: u32 = 3;
/// The farthest that a step moves out of a packet that is too long, in cycles.
const FAR: u32 = 6;
/// The farthest distance before an empty cycle that is searched for a step to fill it.
const REACH: u32 = 1024;

/// A step with its cycle.
#[derive(Debug)]
pub(super) struct Item<'a> {
    pub(super) step: &'a Step,
    pub(super) issued: IssuedInst,
    /// Its node in the graph; `None` if it is not moved.
    pub(super) node: Option<usize>,
}

/// The address of the word after a region that begins at the word `at`.
pub(super) fn end_address(region: &ScheduledRegion, mut at: u32) -> u32 {
    let mut cycle = 0;
    let mut insts = region.insts.iter().peekable();
    while cycle < region.cycles {
        let mut count = 0;
        while insts.next_if(|issued| issued.cycle == cycle).is_some() {
            count += 1;
        }
        if count > 0 {
            at = after(at, count);
            cycle += 1;
        } else {
            let next = insts.peek().map_or(region.cycles, |issued| issued.cycle);
            at = after(at, (next - cycle).div_ceil(LONGEST));
            cycle = next;
        }
    }
    at
}

/// The word after a packet.
const fn after(at: u32, count: u32) -> u32 {
    let at = if at % FETCH + count > FETCH { at.next_multiple_of(FETCH) } else { at };
    at + count
}

/// Moves steps that can wait. The region has `cycles` cycles and begins at the word `at`.
pub(super) fn run(items: &mut [Item<'_>], graph: &Graph, cycles: u32, at: u32) {
    let mut nodes = vec![usize::MAX; graph.after.len()];
    for (index, item) in items.iter().enumerate() {
        if let Some(node) = item.node {
            nodes[node] = index;
        }
    }
    let has_late = items.iter().any(|item| item.node.is_none());
    let accesses = items.iter().filter(|item| item.step.access != Access::None);
    let last_access = accesses.map(|item| item.issued.cycle).max().filter(|_| has_late);
    let mut resources = Resources::default();
    let mut cells = vec![Vec::new(); cycles as usize];
    for (index, item) in items.iter().enumerate() {
        resources.reserve(&item.issued.inst, item.issued.cycle);
        cells[item.issued.cycle as usize].push(index);
    }
    // If two branches do not share a cycle, steps after the first one may not be executed.
    let leaves = items.iter().filter(|item| item.issued.inst.branch().is_some());
    let landed = leaves.map(|item| item.issued.cycle + BRANCH).min().unwrap_or(cycles);
    let mut refiner =
        Refiner { items, graph, nodes, cycles, landed, last_access, resources, cells, before: Vec::new() };
    refiner.fill();
    refiner.shorten(at);
}

struct Refiner<'a, 'b> {
    items: &'a mut [Item<'b>],
    graph: &'a Graph,
    /// The item of each node.
    nodes: Vec<usize>,
    cycles: u32,
    /// The cycle by which all results have landed: the first branch takes effect then.
    landed: u32,
    /// The last cycle for loads and stores, if the stack pointer moves after it.
    last_access: Option<u32>,
    /// Everything that the items take.
    resources: Resources,
    /// The items of each cycle, ascending.
    cells: Vec<Vec<usize>>,
    /// The positions of the moved items before the last attempt began.
    before: Vec<(usize, u32, Inst)>,
}

impl Refiner<'_, '_> {
    fn count(&self, cycle: u32) -> usize {
        self.cells[cycle as usize].len()
    }

    /// The last cycle in which an item may issue.
    fn latest_cycle(&self, index: usize) -> u32 {
        let item = &self.items[index];
        let own = item.issued.cycle;
        let Some(node) = item.node.filter(|_| item.issued.inst.branch().is_none()) else { return own };
        let mut latest = self.landed.saturating_sub(graph::landing_cycles(&item.issued.inst));
        for edge in &self.graph.after[node] {
            let to = self.items[self.nodes[edge.to as usize]].issued.cycle;
            latest = latest.min(to.saturating_sub(edge.cycles.into()));
        }
        if let Some(last) = self.last_access.filter(|_| item.step.access != Access::None) {
            latest = latest.min(last);
        }
        latest.max(own)
    }

    /// The form in which an item can issue in a cycle.
    fn find_form(&mut self, index: usize, cycle: u32) -> Option<Inst> {
        let Item { step, issued, .. } = &self.items[index];
        self.resources.release(&issued.inst, issued.cycle);
        let form = step.forms.iter().copied().find(|inst| self.resources.can_issue(inst, cycle));
        self.resources.reserve(&issued.inst, issued.cycle);
        form
    }

    /// Moves an item.
    fn set(&mut self, index: usize, cycle: u32, inst: Inst) {
        let issued = &mut self.items[index].issued;
        let from = std::mem::replace(&mut issued.cycle, cycle);
        let old = std::mem::replace(&mut issued.inst, inst);
        self.resources.release(&old, from);
        self.resources.reserve(&inst, cycle);
        self.cells[from as usize].retain(|other| *other != index);
        let to = &mut self.cells[cycle as usize];
        to.insert(to.partition_point(|other| *other < index), index);
        self.before.push((index, from, old));
    }

    /// Undoes the moves since the last attempt began, in reverse order.
    fn undo(&mut self) {
        while let Some((index, cycle, inst)) = self.before.pop() {
            self.set(index, cycle, inst);
            self.before.pop();
        }
    }

    /// Fills short runs of empty cycles with steps from packets before them, or leaves them unchanged.
    fn fill(&mut self) {
        let mut cycle = 0;
        while cycle < self.cycles {
            let gap = (cycle..self.cycles).take_while(|cycle| self.count(*cycle) == 0).count() as u32;
            if gap > 0 && gap <= GAP {
                self.before.clear();
                if !(cycle..cycle + gap).all(|cycle| self.fill_cycle(cycle)) {
                    self.undo();
                }
            }
            cycle += gap.max(1);
        }
    }

    fn fill_cycle(&mut self, cycle: u32) -> bool {
        for from in (cycle.saturating_sub(REACH)..cycle).rev() {
            if self.count(from) < 2 {
                continue;
            }
            for index in self.cells[from as usize].clone() {
                if self.latest_cycle(index) >= cycle
                    && let Some(inst) = self.find_form(index, cycle)
                {
                    self.set(index, cycle, inst);
                    return true;
                }
            }
        }
        false
    }

    /// Moves steps out of packets that do not fit the rest of their fetch packet.
    fn shorten(&mut self, mut at: u32) {
        let mut empty = 0;
        for cycle in 0..self.cycles {
            let count = self.count(cycle) as u32;
            if count == 0 {
                if empty % LONGEST == 0 {
                    at = after(at, 1);
                }
                empty += 1;
                continue;
            }
            empty = 0;
            let room = FETCH - at % FETCH;
            if room < count && room < FETCH {
                self.move_out(cycle, count - room);
            }
            at = after(at, self.count(cycle) as u32);
        }
    }

    /// Moves some steps of a packet to later packets, or none.
    fn move_out(&mut self, cycle: u32, excess: u32) {
        self.before.clear();
        for _ in 0..excess {
            if !self.move_one(cycle) {
                self.undo();
                return;
            }
        }
    }

    fn move_one(&mut self, cycle: u32) -> bool {
        let mut found: Vec<(u32, usize)> = (self.cells[cycle as usize].iter())
            .map(|index| (self.latest_cycle(*index), *index))
            .filter(|(latest, _)| *latest > cycle)
            .collect();
        found.sort_by_key(|(latest, index)| (std::cmp::Reverse(*latest), *index));
        for (latest, index) in found {
            for to in cycle + 1..=latest.min(cycle + FAR) {
                if let Some(inst) = self.find_form(index, to) {
                    self.set(index, to, inst);
                    return true;
                }
            }
        }
        false
    }
}
