//! The turns of a loop over each other: when each step of a turn issues, if turns begin at a fixed distance.
//!
//! Iterative modulo scheduling: steps take their cycles one by one, those first that most depends on; one that finds
//! no room takes that of others, which are placed again. What a step waits for is what [`graph`] says of two turns one
//! after another. A register is read while a result for it is in flight only where the result's step and the reading one
//! are in the slots of one branch, where no interrupt is taken (`c67x.md` 2.5); so an interrupt changes nothing. The branch
//! has its place: six cycles before the next turn begins.

use c67x::Inst;

use super::graph::{self, BRANCH};
use super::resources::Resources;
use super::schedule::other_side;
use super::step::Step;

/// Turns that may be under way at the same time.
pub(super) const MOST_STAGES: u32 = 4;
/// How often each step may be placed, on average.
const TRIES: usize = 8;

/// When the steps of a turn issue.
#[derive(Debug)]
pub(super) struct Overlap {
    /// Cycles from one turn to the next.
    pub(super) period: u32,
    /// The stage of the branch: what is before it happens for a turn that may never come.
    pub(super) commit: u32,
    /// The cycle of each step and its form; the branch is last.
    pub(super) places: Vec<(u32, Inst)>,
    /// Whether a step may issue before one that reads what its register had until then.
    pub(super) is_sheltered: bool,
}

impl Overlap {
    /// The stage of a step.
    pub(super) fn stage(&self, step: usize) -> u32 {
        self.places[step].0 / self.period
    }

    /// How many stages there are.
    pub(super) fn stages(&self) -> u32 {
        (0..self.places.len()).map(|step| self.stage(step) + 1).max().unwrap_or(1)
    }
}

/// What one step waits for: `to` issues at least `cycles` after `from` of `turns` turns before.
#[derive(Clone, Copy, Debug)]
struct Wait {
    from: usize,
    to: usize,
    cycles: i64,
    turns: i64,
    /// The cycles where no interrupt comes between the two; below `cycles` if `to` may come before `from`.
    sheltered: i64,
}

/// Finds the shortest period below `limit`. The last of the steps is the branch; `is_certain` says what must not happen
/// before it is known that the turn does.
pub(super) fn search(steps: &[Step], is_certain: impl Fn(usize) -> bool, limit: u32) -> Option<Overlap> {
    let waits = waits(steps);
    let is_certain: Vec<bool> = (0..steps.len()).map(is_certain).collect();
    let least = (steps.len() as u32).div_ceil(8).max(BRANCH);
    // Waits that count everywhere lead to a place with fewer tries.
    let exposed: Vec<Wait> = waits.iter().map(|wait| Wait { sheltered: wait.cycles, ..*wait }).collect();
    (least..limit).find_map(|period| {
        let ways = [(0, false), (1, false), (0, true), (1, true)];
        ways.into_iter().find_map(|(commit, is_sheltered)| {
            let waits = if is_sheltered { &waits } else { &exposed };
            let search = Finder { steps, waits, is_certain: &is_certain, period, commit };
            let places = search.run()?;
            Some(Overlap { period, commit, places, is_sheltered })
        })
    })
}

/// The waits within a turn and from one to the next.
fn waits(steps: &[Step]) -> Vec<Wait> {
    let count = steps.len();
    let two: Vec<Step> = steps.iter().chain(steps).cloned().collect();
    let graph = graph::build(&two, &[]);
    let mut waits = Vec::new();
    for (from, edges) in graph.after.iter().take(count).enumerate() {
        for edge in edges {
            let to = edge.to as usize;
            let turns = i64::from(to >= count);
            let (cycles, sheltered) = (edge.cycles.into(), edge.sheltered.into());
            waits.push(Wait { from, to: to % count, cycles, turns, sheltered });
        }
    }
    waits
}

struct Finder<'a> {
    steps: &'a [Step],
    waits: &'a [Wait],
    is_certain: &'a [bool],
    period: u32,
    commit: u32,
}

/// Steps that have their places.
struct Slots {
    places: Vec<Option<(u32, Inst)>>,
    resources: Resources,
    period: u32,
}

impl Slots {
    fn take(&mut self, step: usize, cycle: u32, inst: Inst) {
        self.resources.take(&inst, cycle);
        self.places[step] = Some((cycle, inst));
    }

    fn remove(&mut self, step: usize) {
        self.places[step] = None;
        self.resources = Resources::periodic(self.period);
        for (cycle, inst) in self.places.iter().flatten() {
            self.resources.take(inst, *cycle);
        }
    }
}

impl Finder<'_> {
    fn run(&self) -> Option<Vec<(u32, Inst)>> {
        let heights = self.heights()?;
        let branch = self.steps.len() - 1;
        let is_before = self.before_branch();
        let mut order: Vec<usize> = (0..branch).collect();
        order.sort_by_key(|step| (!is_before[*step], -heights[*step], *step));
        let mut placed = Slots {
            places: vec![None; self.steps.len()],
            resources: Resources::periodic(self.period),
            period: self.period,
        };
        let at = (self.commit + 1) * self.period - BRANCH;
        placed.take(branch, at, *self.steps[branch].forms.first()?);
        let mut tried: Vec<Option<u32>> = vec![None; self.steps.len()];
        let mut budget = TRIES * self.steps.len();
        while let Some(step) = order.iter().copied().find(|step| placed.places[*step].is_none()) {
            budget = budget.checked_sub(1)?;
            self.place(step, &mut placed, &mut tried)?;
        }
        placed.places.into_iter().collect()
    }

    /// Cycles from each step to the end of its turn; `None` if a turn waits too long for the one before.
    fn heights(&self) -> Option<Vec<i64>> {
        let landing = |step: &Step| step.forms.first().map_or(1, graph::landing);
        let mut heights: Vec<i64> = self.steps.iter().map(|step| landing(step).into()).collect();
        for _ in 0..=self.steps.len() {
            let mut is_changed = false;
            for wait in self.waits {
                let height = heights[wait.to] + wait.sheltered - wait.turns * i64::from(self.period);
                if height > heights[wait.from] {
                    heights[wait.from] = height;
                    is_changed = true;
                }
            }
            if !is_changed {
                return Some(heights);
            }
        }
        None
    }

    /// What the branch of a turn depends on.
    fn before_branch(&self) -> Vec<bool> {
        let mut is_before = vec![false; self.steps.len()];
        if let Some(last) = is_before.last_mut() {
            *last = true;
        }
        // Waits within a turn lead forward, so one way back through them is enough.
        for wait in self.waits.iter().rev().filter(|wait| wait.turns == 0) {
            is_before[wait.from] |= is_before[wait.to];
        }
        is_before
    }

    /// The first cycle of a step, if what it waits for counts as `cycles` says.
    fn earliest(&self, step: usize, placed: &Slots, cycles: impl Fn(&Wait) -> i64) -> u32 {
        let first = if self.is_certain[step] { self.commit * self.period } else { 0 };
        let waits = self.waits.iter().filter(|wait| wait.to == step && wait.from != step);
        let after = waits.filter_map(|wait| {
            let (at, _) = placed.places[wait.from]?;
            Some(i64::from(at) + cycles(wait) - wait.turns * i64::from(self.period))
        });
        after.fold(first, |first, cycle| first.max(u32::try_from(cycle).unwrap_or(0)))
    }

    /// Whether a step that waits comes late enough.
    fn is_met(&self, wait: &Wait, from: u32, to: u32) -> bool {
        let to = i64::from(to) + wait.turns * i64::from(self.period);
        let apart = to - i64::from(from);
        apart >= wait.cycles || apart >= wait.sheltered && self.is_sheltered(to, -apart)
    }

    /// Whether no interrupt is taken between a packet and the one `cycles` later: both are in the slots of the branch.
    fn is_sheltered(&self, packet: i64, cycles: i64) -> bool {
        let period = i64::from(self.period);
        let own = packet.rem_euclid(period);
        own >= period - i64::from(BRANCH) && own + cycles < period
    }

    /// Whether a step can have this cycle after all that it waits for.
    fn is_after(&self, step: usize, cycle: u32, placed: &Slots) -> bool {
        let mut waits = self.waits.iter().filter(|wait| wait.to == step && wait.from != step);
        waits.all(|wait| placed.places[wait.from].is_none_or(|(from, _)| self.is_met(wait, from, cycle)))
    }

    fn place(&self, step: usize, placed: &mut Slots, tried: &mut [Option<u32>]) -> Option<()> {
        let earliest = self.earliest(step, placed, |wait| wait.sheltered);
        let exposed = self.earliest(step, placed, |wait| wait.cycles);
        let forms = &self.steps[step].forms;
        let free = (earliest..exposed + self.period).find_map(|cycle| {
            let inst = forms.iter().copied().find(|inst| placed.resources.fits(inst, cycle))?;
            self.is_after(step, cycle, placed).then_some((cycle, inst))
        });
        let (cycle, inst) = match free {
            Some((cycle, inst)) if tried[step].is_none_or(|last| cycle > last || cycle == earliest) => {
                (cycle, inst)
            }
            _ => {
                let cycle = tried[step].map_or(exposed, |last| exposed.max(last + 1));
                let inst = *forms.first()?;
                self.make_room(&inst, cycle, placed)?;
                (cycle, inst)
            }
        };
        if cycle >= (self.commit + MOST_STAGES) * self.period {
            return None;
        }
        tried[step] = Some(cycle);
        placed.take(step, cycle, inst);
        self.remove_broken(step, cycle, placed)
    }

    /// Removes what an instruction meets in its cycle; the branch stays.
    fn make_room(&self, inst: &Inst, cycle: u32, placed: &mut Slots) -> Option<()> {
        let branch = self.steps.len() - 1;
        let mut alone = Resources::periodic(self.period);
        for step in 0..branch {
            let Some((at, own)) = placed.places[step] else { continue };
            alone.clear();
            alone.take(&own, at);
            if !alone.fits(inst, cycle) {
                placed.remove(step);
            }
        }
        // What several together took is still missing: the last ones in the same cycle go.
        for step in (0..branch).rev() {
            if placed.resources.fits(inst, cycle) {
                return Some(());
            }
            if placed.places[step].is_some_and(|(at, _)| at % self.period == cycle % self.period) {
                placed.remove(step);
            }
        }
        placed.resources.fits(inst, cycle).then_some(())
    }

    /// Removes what a new place comes too late for.
    fn remove_broken(&self, step: usize, cycle: u32, placed: &mut Slots) -> Option<()> {
        for wait in self.waits.iter().filter(|wait| wait.from == step) {
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
