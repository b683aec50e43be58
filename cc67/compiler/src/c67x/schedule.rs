//! Schedules steps into packets: steps that can issue in the same cycle do.
//!
//! Cycle by cycle, the steps whose operands have landed are issued in the order of priority. The branch issues such
//! that its five delay slots end when the last result lands; unused slots are `NOP`s. At the end of a region nothing is
//! in flight.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use c67x::Inst;

use super::expand::Region;
use super::graph::{self, BRANCH, Graph};
use super::packets::{IssuedInst, ScheduledRegion};
use super::refine::{self, Item};
use super::resources::Resources;
use super::step::{Access, Step};

/// The limit of steps considered in a cycle: more are ready only in very long blocks.
const MOST_READY: usize = 64;
/// The number of them that are kept for the next cycle, before the best of the others join them.
const KEPT_READY: usize = 48;

/// The order in which a region is scheduled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// One instruction a cycle, in the order of the source.
    Source,
    /// As early as possible.
    Early,
}

/// Schedules a region that begins at the word `at`.
pub(super) fn schedule(region: &Region, order: Order, at: u32) -> ScheduledRegion {
    let Region { steps, branches, late, .. } = region;
    let graph = graph::build(steps, branches);
    let mut list = List::new(&graph, order);
    let end = list.steps(steps);
    let cycles = match branches.first() {
        Some(branch) if !late.is_empty() => list.place_return_branch(steps.len(), branch, late, end),
        _ => list.branches(steps, branches, end),
    };
    let mut items = list.issued;
    if order == Order::Early {
        refine::run(&mut items, &graph, cycles, at);
    }
    let mut insts: Vec<IssuedInst> = items.into_iter().map(|item| item.issued).collect();
    insts.sort_by_key(|issued| issued.cycle);
    let Region { label, span, weight, .. } = *region;
    ScheduledRegion { label, insts, cycles, weight, span, is_exceeded: false }
}

/// Steps that issued before a region and may have results in flight when it begins, and the cycle when it does.
#[derive(Debug)]
pub(super) struct Tail {
    pub(super) issued: Vec<(Step, Inst, u32)>,
    pub(super) cycles: u32,
}

/// Schedules a region after packets that are fixed.
pub(super) fn schedule_after(tail: &Tail, region: Region) -> ScheduledRegion {
    let Region { label, steps: own, branches, span, weight, .. } = region;
    let steps: Vec<Step> = tail.issued.iter().map(|(step, ..)| step.clone()).chain(own).collect();
    let graph = graph::build(&steps, &branches);
    let mut list = List::new(&graph, Order::Early);
    list.first = (tail.issued.len() as u32, tail.cycles);
    let mut ready = Vec::new();
    for (index, (_, inst, cycle)) in (0..).zip(&tail.issued) {
        list.resources.reserve(inst, *cycle);
        list.release(index, *cycle, steps.len(), &mut ready);
    }
    let landing = tail.issued.iter().map(|(_, inst, cycle)| cycle + graph::landing_cycles(inst)).max();
    let end = list.steps(&steps).max(landing.unwrap_or(0)).max(tail.cycles);
    let cycles = list.branches(&steps, &branches, end) - tail.cycles;
    let mut insts: Vec<IssuedInst> = list.issued.into_iter().map(|item| item.issued).collect();
    insts.iter_mut().for_each(|issued| issued.cycle -= tail.cycles);
    insts.sort_by_key(|issued| issued.cycle);
    ScheduledRegion { label, insts, cycles, weight, span, is_exceeded: false }
}

struct List<'a> {
    graph: &'a Graph,
    earliest: Vec<u32>,
    waiting: Vec<u32>,
    resources: Resources,
    issued: Vec<Item<'a>>,
    order: Order,
    /// The last cycle with a load or store.
    last_access: u32,
    /// The first step that is not placed yet, and its first possible cycle.
    first: (u32, u32),
}

impl<'a> List<'a> {
    fn new(graph: &'a Graph, order: Order) -> Self {
        Self {
            earliest: vec![0; graph.before.len()],
            waiting: graph.before.clone(),
            resources: Resources::default(),
            issued: Vec::with_capacity(graph.before.len()),
            graph,
            order,
            last_access: 0,
            first: (0, 0),
        }
    }

    /// Issues all steps but the branches; the cycle in which the last result has landed.
    fn steps(&mut self, steps: &'a [Step]) -> u32 {
        let mut ready: Vec<u32> =
            (self.first.0..steps.len() as u32).filter(|step| self.waiting[*step as usize] == 0).collect();
        let mut crowd = BinaryHeap::new();
        let (mut cycle, mut end, mut left) = (self.first.1, 0, steps.len() - self.first.0 as usize);
        while left > 0 {
            self.limit(&mut ready, &mut crowd);
            match self.order {
                Order::Source => ready.sort_unstable(),
                Order::Early => {
                    ready.sort_unstable_by_key(|step| (Reverse(self.graph.height[*step as usize]), *step));
                }
            }
            let mut index = 0;
            let mut taken = false;
            while index < ready.len() {
                let step = ready[index];
                let own = &steps[step as usize];
                let may = self.earliest[step as usize] <= cycle && !(taken && self.order == Order::Source);
                let form = if may {
                    self.find_least_contended_form(own, &ready[index + 1..], steps, cycle)
                } else {
                    None
                };
                let Some(inst) = form else {
                    if self.order == Order::Source {
                        break;
                    }
                    index += 1;
                    continue;
                };
                ready.remove(index);
                left -= 1;
                taken = true;
                end = end.max(cycle + graph::landing_cycles(&inst));
                self.issue(own, Some(step as usize), inst, cycle);
                self.release(step, cycle, steps.len(), &mut ready);
            }
            cycle += 1;
        }
        end
    }

    /// Limits the number of steps considered in a cycle: the others wait in the crowd.
    fn limit(&self, ready: &mut Vec<u32>, crowd: &mut BinaryHeap<(u32, Reverse<u32>)>) {
        let priority = |step: u32| match self.order {
            Order::Source => (0, Reverse(step)),
            Order::Early => (self.graph.height[step as usize], Reverse(step)),
        };
        if ready.len() > MOST_READY || !crowd.is_empty() {
            ready.sort_unstable_by_key(|step| Reverse(priority(*step)));
            let kept = KEPT_READY.min(ready.len());
            crowd.extend(ready.drain(kept..).map(priority));
            let room = MOST_READY - kept;
            ready.extend((0..room).map_while(|_| crowd.pop()).map(|(_, Reverse(step))| step));
        }
    }

    /// The form that can issue in a cycle.
    fn find_form(&mut self, step: &Step, cycle: u32) -> Option<Inst> {
        step.forms.iter().copied().find(|inst| self.resources.can_issue(inst, cycle))
    }

    /// The form that can issue in a cycle; if there is a choice, not on a unit that is the only one for a step in
    /// `others`.
    fn find_least_contended_form(
        &mut self,
        step: &Step,
        others: &[u32],
        steps: &[Step],
        cycle: u32,
    ) -> Option<Inst> {
        let first = self.find_form(step, cycle)?;
        if step.forms.len() == 1 || self.order == Order::Source {
            return Some(first);
        }
        let bit = |inst: &Inst| inst.unit().map_or(0, |unit| 1_u32 << unit.index());
        let mut wanted = 0;
        for other in others.iter().filter(|other| self.earliest[**other as usize] <= cycle) {
            if let [only] = steps[*other as usize].forms.as_slice() {
                wanted |= bit(only);
            }
        }
        if bit(&first) & wanted == 0 {
            return Some(first);
        }
        let free =
            step.forms.iter().find(|inst| bit(inst) & wanted == 0 && self.resources.can_issue(inst, cycle));
        Some(free.copied().unwrap_or(first))
    }

    fn issue(&mut self, step: &'a Step, node: Option<usize>, inst: Inst, cycle: u32) {
        self.resources.reserve(&inst, cycle);
        if step.access != Access::None {
            self.last_access = self.last_access.max(cycle);
        }
        let issued = IssuedInst { cycle, inst, value: step.value, span: step.span };
        self.issued.push(Item { step, issued, node });
    }

    /// Releases the steps that wait for a step; they may be ready now.
    fn release(&mut self, step: u32, cycle: u32, steps: usize, ready: &mut Vec<u32>) {
        for edge in &self.graph.after[step as usize] {
            let to = edge.to as usize;
            self.earliest[to] = self.earliest[to].max(cycle + u32::from(edge.cycles));
            self.waiting[to] -= 1;
            if self.waiting[to] == 0 && to < steps {
                // Steps that may share the cycle are considered later in it.
                ready.push(edge.to);
            }
        }
    }

    /// Places the branches; the length of the region.
    fn branches(&mut self, steps: &[Step], branches: &'a [Step], end: u32) -> u32 {
        let mut cycles = end;
        let mut from = end.saturating_sub(BRANCH).max(self.first.1);
        for (index, branch) in branches.iter().enumerate() {
            let mut cycle = self.earliest[steps.len() + index].max(from);
            let inst = loop {
                let sides = branch.forms.iter().copied();
                if let Some(inst) =
                    sides.chain(other_side(branch)).find(|inst| self.resources.can_issue(inst, cycle))
                {
                    break inst;
                }
                cycle += 1;
            };
            self.issue(branch, Some(steps.len() + index), inst, cycle);
            from = cycle;
            cycles = cycles.max(cycle + BRANCH);
        }
        cycles
    }

    /// Places the branch that leaves the function. Its delay slots contain the load of the register that it reads and
    /// then the increment of the stack pointer, because no interrupt comes between them. Returns the length of the
    /// region.
    fn place_return_branch(
        &mut self,
        branch_index: usize,
        branch: &'a Step,
        late: &'a [Step],
        end: u32,
    ) -> u32 {
        let mut cycle = self.earliest[branch_index].max(end.saturating_sub(BRANCH));
        let last_access = self.last_access;
        loop {
            let own = self.find_form(branch, cycle);
            let mut from = cycle;
            let mut placed: Vec<(&'a Step, Inst, u32)> = Vec::with_capacity(late.len());
            for step in late {
                let is_access = step.access != Access::None;
                let first = if is_access { from } else { from.max(cycle + 1).max(last_access) };
                let landing = step.forms.first().map_or(1, graph::landing_cycles);
                let found =
                    (first..=cycle + BRANCH - landing).find_map(|at| Some((self.find_form(step, at)?, at)));
                let Some((inst, at)) = found else { break };
                from = at;
                placed.push((step, inst, at));
            }
            if let (Some(own), true) = (own, placed.len() == late.len()) {
                self.issue(branch, Some(branch_index), own, cycle);
                for (step, inst, at) in placed {
                    self.issue(step, None, inst, at);
                }
                return cycle + BRANCH;
            }
            cycle += 1;
        }
    }
}

/// A branch with a displacement on the unit of side A.
pub(super) fn other_side(branch: &Step) -> Option<Inst> {
    let inst = branch.forms.first()?;
    let operands: Vec<c67x::Operand> = inst.operands().collect();
    Inst::new(inst.op(), c67x::Side::A, inst.pred(), &operands).ok()
}
