//! Modulo scheduling: assigns cycles to the steps of a loop whose iterations begin at a fixed distance and overlap.
//!
//! The search is iterative: steps are placed one by one in the order of priority; a step that finds no room evicts
//! others, which are placed again. The dependences are those of [`graph`] on two consecutive iterations. A register may
//! be read while a result for it is in flight only if both steps are in the delay slots of the same branch, where no
//! interrupt is taken (`c67x.md` 2.5); so an interrupt changes nothing. The branch has a fixed position: six cycles
//! before the next iteration begins.

use std::ops::Range;

use c67x::Inst;

use super::graph::{self, BRANCH};
use super::resources::Resources;
use super::schedule::other_side;
use super::step::Step;

/// Iterations that may overlap.
pub(super) const MOST_STAGES: u32 = 4;
/// The number of placements per step, on average, after which the search ends.
const TRIES: usize = 8;
/// The most work for a loop: cycles tried for forms, and dependences tested.
const WORK: u32 = 600_000;

/// A modulo schedule: the cycles in which the steps of an iteration issue.
#[derive(Clone, Debug)]
pub(super) struct Overlap {
    /// Cycles from one iteration to the next.
    pub(super) period: u32,
    /// The stage of the branch: earlier steps are executed for an iteration that may not take place.
    pub(super) commit: u32,
    /// The cycle of each step and its form; the branch is last.
    pub(super) places: Vec<(u32, Inst)>,
    /// True if a step may issue before one that reads the previous value of its register.
    pub(super) is_sheltered: bool,
}

impl Overlap {
    /// The stage of a step.
    pub(super) fn stage(&self, step: usize) -> u32 {
        self.places[step].0 / self.period
    }

    /// Number of stages.
    pub(super) fn stages(&self) -> u32 {
        (0..self.places.len()).map(|step| self.stage(step) + 1).max().unwrap_or(1)
    }
}

/// A dependence: `to` issues at least `cycles` after `from` of the iteration `distance` earlier.
#[derive(Clone, Copy, Debug)]
struct Dependence {
    from: usize,
    to: usize,
    cycles: i64,
    distance: i64,
    /// The number of cycles if no interrupt can come between the two; less than `cycles` if `to` may come before
    /// `from`.
    sheltered: i64,
}

/// Finds the shortest period below `limit`. The last step is the branch; `is_certain` marks the steps that must wait
/// until it is certain that the iteration is executed.
///
/// # Errors
/// [`BudgetExceeded`] if the search takes more than [`WORK`], or more than the rest of the function's budget.
pub(super) fn search(
    steps: &[Step],
    is_certain: impl Fn(usize) -> bool,
    limit: u32,
    whole: &mut WorkBudget,
) -> Result<Option<Overlap>, BudgetExceeded> {
    let waits = Dependences::new(steps);
    let is_certain: Vec<bool> = (0..steps.len()).map(is_certain).collect();
    let least = (steps.len() as u32).div_ceil(8).max(BRANCH);
    let given = WORK.min(whole.0);
    let mut work = WorkBudget(given);
    let found = shortest_overlap(steps, &is_certain, least..limit, &waits, &mut work);
    whole.0 -= given - work.0;
    found
}

/// The overlap with the shortest of some periods.
fn shortest_overlap(
    steps: &[Step],
    is_certain: &[bool],
    periods: Range<u32>,
    waits: &Dependences,
    work: &mut WorkBudget,
) -> Result<Option<Overlap>, BudgetExceeded> {
    // Waits that count everywhere lead to a place with fewer tries.
    let exposed = waits.exposed();
    let kinds = [(&exposed, false), (waits, true)];
    let feasible = kinds.map(|(waits, _)| waits.first_feasible(steps, periods.clone()));
    for period in periods {
        for ((waits, is_sheltered), first) in kinds.into_iter().zip(feasible) {
            if period < first {
                // The budget counts the size of the problem, not the time of this implementation.
                work.spend((steps.len() + 1) * waits.all.len())?;
                continue;
            }
            let Some((heights, rounds)) = waits.heights(steps, period) else { continue };
            work.spend(rounds * waits.all.len())?;
            for commit in 0..2 {
                let search = Finder { steps, waits, is_certain, period, commit, heights: &heights };
                if let Some(places) = search.run(work)? {
                    return Ok(Some(Overlap { period, commit, places, is_sheltered }));
                }
            }
        }
    }
    Ok(None)
}

/// A search that exceeded its budget.
#[derive(Clone, Copy, Debug)]
pub(super) struct BudgetExceeded;

/// The work that is left, in forms and dependences that are tested.
#[derive(Debug)]
pub(super) struct WorkBudget(pub(super) u32);

impl WorkBudget {
    /// Takes some of it.
    ///
    /// # Errors
    /// [`BudgetExceeded`] if less is left.
    pub(super) fn spend(&mut self, amount: usize) -> Result<(), BudgetExceeded> {
        let left = u32::try_from(amount).ok().and_then(|amount| self.0.checked_sub(amount));
        self.0 = left.ok_or(BudgetExceeded)?;
        Ok(())
    }
}

/// The dependences within an iteration and from one to the next.
struct Dependences {
    /// In the order of the steps that must come first.
    all: Vec<Dependence>,
    /// For each step, the index of its first wait in `all`.
    starts: Vec<usize>,
    /// The waits of each step for others.
    before: Vec<Vec<Dependence>>,
}

impl Dependences {
    fn new(steps: &[Step]) -> Self {
        let count = steps.len();
        let two: Vec<Step> = steps.iter().chain(steps).cloned().collect();
        let graph = graph::build(&two, &[]);
        let mut all = Vec::new();
        for (from, edges) in graph.after.iter().take(count).enumerate() {
            for edge in edges {
                let to = edge.to as usize;
                let distance = i64::from(to >= count);
                let (cycles, sheltered) = (edge.cycles.into(), edge.sheltered.into());
                all.push(Dependence { from, to: to % count, cycles, distance, sheltered });
            }
        }
        Self::from_sorted(all, count)
    }

    fn from_sorted(all: Vec<Dependence>, count: usize) -> Self {
        let starts = (0..=count).map(|step| all.partition_point(|wait| wait.from < step)).collect();
        let mut before = vec![Vec::new(); count];
        for wait in all.iter().filter(|wait| wait.to != wait.from) {
            before[wait.to].push(*wait);
        }
        Self { all, starts, before }
    }

    /// Returns the dependences for a loop in which interrupts are possible everywhere.
    fn exposed(&self) -> Self {
        let all = self.all.iter().map(|wait| Dependence { sheltered: wait.cycles, ..*wait }).collect();
        Self::from_sorted(all, self.before.len())
    }

    /// The dependences on a step.
    fn after(&self, step: usize) -> &[Dependence] {
        &self.all[self.starts[step]..self.starts[step + 1]]
    }

    /// Returns the first feasible period of a range, one in which no iteration waits too long for the previous one; the
    /// end of the range if there is none. If a period is feasible, so are all longer ones.
    fn first_feasible(&self, steps: &[Step], periods: Range<u32>) -> u32 {
        let Range { start: mut low, end: mut high } = periods;
        // Most loops do not depend on the previous iteration.
        let mut middle = low;
        while low < high {
            match self.heights(steps, middle) {
                Some(_) => high = middle,
                None => low = middle + 1,
            }
            middle = low + (high - low) / 2;
        }
        low
    }

    /// The cycles from each step to the end of its iteration, and the rounds over all waits that were needed; `None` if
    /// an iteration waits too long for the previous one.
    fn heights(&self, steps: &[Step], period: u32) -> Option<(Vec<i64>, usize)> {
        let landing = |step: &Step| step.forms.first().map_or(1, graph::landing_cycles);
        let mut heights: Vec<i64> = steps.iter().map(|step| landing(step).into()).collect();
        for round in 0..=steps.len() {
            let mut is_changed = false;
            // Most waits lead forward, so one backward pass computes most heights.
            for wait in self.all.iter().rev() {
                let height = heights[wait.to] + wait.sheltered - wait.distance * i64::from(period);
                if height > heights[wait.from] {
                    heights[wait.from] = height;
                    is_changed = true;
                }
            }
            if !is_changed {
                return Some((heights, round + 1));
            }
        }
        None
    }
}

struct Finder<'a> {
    steps: &'a [Step],
    waits: &'a Dependences,
    is_certain: &'a [bool],
    period: u32,
    commit: u32,
    heights: &'a [i64],
}

/// Steps that have their places.
struct Slots {
    places: Vec<Option<(u32, Inst)>>,
    resources: Resources,
}

impl Slots {
    fn occupy(&mut self, step: usize, cycle: u32, inst: Inst) {
        self.resources.reserve(&inst, cycle);
        self.places[step] = Some((cycle, inst));
    }

    fn remove(&mut self, step: usize) {
        if let Some((cycle, inst)) = self.places[step].take() {
            self.resources.release(&inst, cycle);
        }
    }
}

impl Finder<'_> {
    /// Returns a cycle for every step, or `None` if no solution is found within the search budget.
    fn run(&self, work: &mut WorkBudget) -> Result<Option<Vec<(u32, Inst)>>, BudgetExceeded> {
        let branch = self.steps.len() - 1;
        let is_before = self.before_branch();
        let mut order: Vec<usize> = (0..branch).collect();
        order.sort_by_key(|step| (!is_before[*step], -self.heights[*step], *step));
        let mut placed =
            Slots { places: vec![None; self.steps.len()], resources: Resources::periodic(self.period) };
        let at = (self.commit + 1) * self.period - BRANCH;
        let Some(inst) = self.steps[branch].forms.first() else { return Ok(None) };
        placed.occupy(branch, at, *inst);
        let mut tried: Vec<Option<u32>> = vec![None; self.steps.len()];
        let mut budget = TRIES * self.steps.len();
        while let Some(step) = order.iter().copied().find(|step| placed.places[*step].is_none()) {
            work.spend(self.steps.len())?;
            let is_left = budget > 0;
            budget = budget.saturating_sub(1);
            if !is_left || self.place(step, &mut placed, &mut tried, work)?.is_none() {
                return Ok(None);
            }
        }
        Ok(placed.places.into_iter().collect())
    }

    /// True for each step on which the branch of an iteration depends.
    fn before_branch(&self) -> Vec<bool> {
        let mut is_before = vec![false; self.steps.len()];
        if let Some(last) = is_before.last_mut() {
            *last = true;
        }
        // Dependences within an iteration lead forward, so one pass back through them is enough.
        for wait in self.waits.all.iter().rev().filter(|wait| wait.distance == 0) {
            is_before[wait.from] |= is_before[wait.to];
        }
        is_before
    }

    /// Returns the first cycle of a step; `cycles` gives the length of each dependence.
    fn earliest_cycle(&self, step: usize, placed: &Slots, cycles: impl Fn(&Dependence) -> i64) -> u32 {
        let first = if self.is_certain[step] { self.commit * self.period } else { 0 };
        let after = self.waits.before[step].iter().filter_map(|wait| {
            let (at, _) = placed.places[wait.from]?;
            Some(i64::from(at) + cycles(wait) - wait.distance * i64::from(self.period))
        });
        after.fold(first, |first, cycle| first.max(u32::try_from(cycle).unwrap_or(0)))
    }

    /// Reports whether a dependence is satisfied.
    fn is_met(&self, wait: &Dependence, from: u32, to: u32) -> bool {
        let to = i64::from(to) + wait.distance * i64::from(self.period);
        let apart = to - i64::from(from);
        apart >= wait.cycles || apart >= wait.sheltered && self.is_sheltered(to, -apart)
    }

    /// Reports whether no interrupt is taken between a packet and the one `cycles` later: both are in the delay slots
    /// of the branch.
    fn is_sheltered(&self, packet: i64, cycles: i64) -> bool {
        let period = i64::from(self.period);
        let own = packet.rem_euclid(period);
        own >= period - i64::from(BRANCH) && own + cycles < period
    }

    /// Reports whether all dependences of a step are satisfied in this cycle.
    fn is_after(&self, step: usize, cycle: u32, placed: &Slots) -> bool {
        let mut waits = self.waits.before[step].iter();
        waits.all(|wait| placed.places[wait.from].is_none_or(|(from, _)| self.is_met(wait, from, cycle)))
    }

    fn place(
        &self,
        step: usize,
        placed: &mut Slots,
        tried: &mut [Option<u32>],
        work: &mut WorkBudget,
    ) -> Result<Option<()>, BudgetExceeded> {
        let earliest = self.earliest_cycle(step, placed, |wait| wait.sheltered);
        let exposed = self.earliest_cycle(step, placed, |wait| wait.cycles);
        let found = self.free(step, earliest..exposed + self.period, placed, work)?;
        let free =
            found.filter(|(cycle, _)| tried[step].is_none_or(|last| *cycle > last || *cycle == earliest));
        let (cycle, inst) = match free {
            Some(free) => free,
            None => {
                let cycle = tried[step].map_or(exposed, |last| exposed.max(last + 1));
                let Some(inst) = self.steps[step].forms.first() else { return Ok(None) };
                work.spend(self.steps.len())?;
                if self.make_room(inst, cycle, placed).is_none() {
                    return Ok(None);
                }
                (cycle, *inst)
            }
        };
        if cycle >= (self.commit + MOST_STAGES) * self.period {
            return Ok(None);
        }
        tried[step] = Some(cycle);
        placed.occupy(step, cycle, inst);
        Ok(self.remove_broken(step, cycle, placed))
    }

    /// The first of some cycles in which a step can issue alongside the steps that are already placed.
    fn free(
        &self,
        step: usize,
        cycles: Range<u32>,
        placed: &mut Slots,
        work: &mut WorkBudget,
    ) -> Result<Option<(u32, Inst)>, BudgetExceeded> {
        let forms = &self.steps[step].forms;
        for cycle in cycles {
            work.spend(forms.len())?;
            let Some(inst) = forms.iter().find(|inst| placed.resources.can_issue(inst, cycle)) else {
                continue;
            };
            work.spend(self.waits.before[step].len())?;
            if self.is_after(step, cycle, placed) {
                return Ok(Some((cycle, *inst)));
            }
        }
        Ok(None)
    }

    /// Evicts the steps that conflict with an instruction in its cycle; the branch stays.
    fn make_room(&self, inst: &Inst, cycle: u32, placed: &mut Slots) -> Option<()> {
        let branch = self.steps.len() - 1;
        let mut alone = Resources::periodic(self.period);
        for step in 0..branch {
            let Some((at, own)) = placed.places[step] else { continue };
            alone.reserve(&own, at);
            if !alone.can_issue(inst, cycle) {
                placed.remove(step);
            }
            alone.release(&own, at);
        }
        // A resource is still taken by several steps together: evict the last ones in the same cycle.
        for step in (0..branch).rev() {
            if placed.resources.can_issue(inst, cycle) {
                return Some(());
            }
            if placed.places[step].is_some_and(|(at, _)| at % self.period == cycle % self.period) {
                placed.remove(step);
            }
        }
        placed.resources.can_issue(inst, cycle).then_some(())
    }

    /// Evicts the steps whose dependences a new position violates.
    fn remove_broken(&self, step: usize, cycle: u32, placed: &mut Slots) -> Option<()> {
        for wait in self.waits.after(step) {
            let Some((at, _)) = placed.places[wait.to] else { continue };
            if !self.is_met(wait, cycle, at) {
                if wait.to == self.steps.len() - 1 || wait.to == step {
                    return None;
                }
                placed.remove(wait.to);
            }
        }
        Some(())
    }
}

/// A branch with every form it has.
pub(super) fn with_both_sides(branch: &Step) -> Step {
    let mut branch = branch.clone();
    let other = other_side(&branch);
    branch.forms.extend(other);
    branch
}
