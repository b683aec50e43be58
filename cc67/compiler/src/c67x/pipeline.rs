//! Software pipelining of inner loops: the packets of the loop, its prologue and its epilogue.
//!
//! A loop of a single region without calls becomes: prologue regions that start the first iterations, the packets found
//! by [`modulo`], in which every iteration is at another stage, and an epilogue region that completes the last
//! iterations. Every prologue region ends with the branch of its iteration, which leads to a separate epilogue if there
//! is no further iteration. So the number of iterations need not be known, and no load or store is executed that the
//! source does not contain. Only steps without effect whose results are not read after the loop are executed
//! speculatively for an iteration that does not take place.
//!
//! Where an interrupt is possible, no result is in flight to a register whose earlier value is still needed; this
//! includes the first packet, so the loop can be entered with nothing in flight.

use c67x::{Inst, Pred};

use super::abi;
use super::code::Value;
use super::expand::Region;
use super::graph::BRANCH;
use super::memo::{KnownRegion, Memo, OverlapKey};
use super::modulo::{self, BudgetExceeded, Overlap, WorkBudget};
use super::packets::{IssuedInst, ScheduledRegion};
use super::refine;
use super::schedule::{self, Order, Tail};
use super::step::{Access, Step};

/// The largest iteration that is pipelined, in steps.
const LARGEST: usize = 120;
/// The trip count from which a pipelined loop must be faster.
const PROFITABLE_TRIPS: u32 = 5;
/// The estimated probability that a loop ends before all stages are active.
const RARE: f32 = 0.1;

/// Schedules all regions; loops overlap. `labels` is the first label that is free.
pub(super) fn schedule(
    regions: Vec<Region>,
    labels: u32,
    memo: &mut Memo,
    work: &mut WorkBudget,
) -> Vec<ScheduledRegion> {
    let entering = if regions.iter().any(|region| back_branch(region).is_some()) {
        compute_live_in(&regions)
    } else {
        Vec::new()
    };
    let mut done = Vec::with_capacity(regions.len());
    let mut ends = Vec::new();
    let (mut labels, mut at) = (labels, 0);
    for region in regions {
        let known = memo.entry(region);
        let mut plain = known.scheduled(Order::Early, at);
        let found = back_branch(&known.region).is_some().then(|| {
            let found = Loop::new(known, &entering, plain.cycles, work);
            plain.is_exceeded = found.is_err();
            let mut pipelined = found.ok().flatten()?;
            pipelined.label = labels;
            let (parts, after) = pipelined.parts()?;
            Some((parts, after, pipelined.label))
        });
        let found = found.flatten();
        match found {
            Some((parts, after, next)) => {
                at = parts.iter().fold(at, |at, part| refine::end_address(part, at));
                done.extend(parts);
                ends.extend(after);
                labels = next;
            }
            None => {
                at = refine::end_address(&plain, at);
                done.push(plain);
            }
        }
    }
    done.extend(ends);
    done
}

/// The branch of a region that leads back to it under a condition.
fn back_branch(region: &Region) -> Option<&Step> {
    if region.steps.is_empty() || region.steps.len() > LARGEST || !region.late.is_empty() {
        return None;
    }
    let is_back = |step: &&Step| {
        let is_conditional = step.forms.first().is_some_and(|inst| inst.pred().reg().is_some());
        step.value == Some(Value::Block(region.label)) && is_conditional
    };
    region.branches.iter().find(is_back)
}

/// The registers that are live at the beginning of each region, with its label.
fn compute_live_in(regions: &[Region]) -> Vec<(u32, u64)> {
    let mut entering: Vec<(u32, u64)> = regions.iter().map(|region| (region.label, 0)).collect();
    let mut is_changed = true;
    while is_changed {
        is_changed = false;
        for index in (0..regions.len()).rev() {
            let mut live = live_out(&regions[index], entering.get(index + 1), &entering);
            for step in regions[index].branches.iter().chain(regions[index].steps.iter().rev()) {
                let Some(inst) = step.forms.first() else { continue };
                if inst.pred() == Pred::Always {
                    inst.writes().for_each(|write| live &= !abi::bit(write.reg));
                }
                inst.reads().for_each(|read| live |= abi::bit(read.reg));
                live |= inst.pred().reg().map_or(0, abi::bit);
            }
            is_changed |= entering[index].1 != live;
            entering[index].1 = live;
        }
    }
    entering
}

/// The registers that are live after a region.
fn live_out(region: &Region, next: Option<&(u32, u64)>, entering: &[(u32, u64)]) -> u64 {
    let mut live = next.map_or(0, |(_, live)| *live) & !region.exit_registers.changes;
    for step in &region.branches {
        if let Some(Value::Block(label)) = step.value {
            live |= entering_of(label, entering);
        }
    }
    live | region.exit_registers.reads
}

fn entering_of(label: u32, entering: &[(u32, u64)]) -> u64 {
    entering.iter().find(|(own, _)| *own == label).map_or(!0, |(_, live)| *live)
}

/// A loop that overlaps.
struct Loop<'a> {
    region: &'a Region,
    /// The steps of an iteration, the branch last.
    steps: Vec<Step>,
    plan: Overlap,
    /// The label at which execution continues after the loop.
    outside: u32,
    /// The next free label.
    label: u32,
}

/// A step of one iteration; iterations count from the first, or back from the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Instance {
    /// The cycle, from the beginning of iteration 0.
    cycle: i64,
    iteration: i64,
    step: usize,
}

impl<'a> Loop<'a> {
    fn new(
        known: &'a mut KnownRegion,
        entering: &[(u32, u64)],
        cycles: u32,
        work: &mut WorkBudget,
    ) -> Result<Option<Self>, BudgetExceeded> {
        let region = &known.region;
        let Some(back) = back_branch(region) else { return Ok(None) };
        let outside = match region.branches.iter().find(|step| step.value != back.value) {
            Some(step) => match step.value {
                Some(Value::Block(label)) => label,
                _ => return Ok(None),
            },
            None => region.label + 1,
        };
        let read_after = entering_of(outside, entering);
        let mut steps = region.steps.clone();
        steps.push(modulo::with_both_sides(back));
        let is_certain = |step: usize| {
            let step: &Step = &steps[step];
            let writes = |inst: &Inst| inst.writes().any(|write| read_after & abi::bit(write.reg) != 0);
            step.access != Access::None || step.forms.first().is_none_or(writes)
        };
        let question = OverlapKey { read_after, cycles };
        let plan = match known.plan(question) {
            Some(plan) => plan.clone(),
            None => {
                let plan = modulo::search(&steps, is_certain, cycles, work);
                known.store_overlap(question, plan.clone());
                plan
            }
        };
        let Some(plan) = plan? else { return Ok(None) };
        Ok(Some(Self { region: &known.region, steps, plan, outside, label: 0 }))
    }

    /// The regions that replace the loop, and those that are moved to the end of the function.
    fn parts(&mut self) -> Option<(Vec<ScheduledRegion>, Vec<ScheduledRegion>)> {
        let (mut parts, mut ends) = (Vec::new(), Vec::new());
        let (commit, stages) = (i64::from(self.plan.commit), i64::from(self.plan.stages()));
        let depth = stages - commit;
        let mut label = self.region.label;
        let mut rest: Vec<Instance> = Vec::new();
        let mut passes = 0..stages.min(commit + i64::from(depth > 1));
        while !passes.is_empty() {
            let mut own = self.prologue_instances(passes.clone());
            let first_unknown = passes.end - commit;
            let branch = depth > 1;
            let mut now = std::mem::take(&mut rest);
            if branch {
                // Steps of the next iteration after the branch may change the register that it tests.
                let at = self.branch_cycle() + (first_unknown - 1) * self.period();
                rest = own.extract_if(.., |one| one.iteration >= first_unknown && one.cycle >= at).collect();
            }
            now.extend(own);
            self.sort(&mut now);
            let mut branches = Vec::new();
            if branch {
                let end = self.new_label();
                branches.push(self.leave_to(end)?);
                ends.push(self.end_of(first_unknown, end)?);
            }
            parts.push(self.schedule_region(label, &now, branches));
            label = self.new_label();
            passes = if passes.end < stages - 1 && branch { passes.end..passes.end + 1 } else { 0..0 };
        }
        if !rest.is_empty() {
            parts.push(self.schedule_region(label, &rest, Vec::new()));
            label = self.new_label();
        }
        parts.push(self.packets(label));
        parts.push(self.final_region()?);
        let cycles = |parts: &[ScheduledRegion]| parts.iter().map(|part| part.cycles).sum::<u32>();
        let plain = schedule::schedule(self.region, Order::Early, 0).cycles;
        let overlapped =
            cycles(&parts) + self.plan.period * (PROFITABLE_TRIPS - 1).saturating_sub(depth as u32 - 1);
        (overlapped < plain * PROFITABLE_TRIPS).then_some((parts, ends))
    }

    fn period(&self) -> i64 {
        self.plan.period.into()
    }

    fn new_label(&mut self) -> u32 {
        self.label += 1;
        self.label - 1
    }

    fn branch(&self) -> usize {
        self.steps.len() - 1
    }

    fn branch_cycle(&self) -> i64 {
        (i64::from(self.plan.commit) + 1) * self.period() - i64::from(BRANCH)
    }

    fn instance(&self, step: usize, iteration: i64) -> Instance {
        Instance { cycle: i64::from(self.plan.places[step].0) + iteration * self.period(), iteration, step }
    }

    /// Sorts steps into an order in which they could be executed one by one: by their cycles, but in source order where
    /// one may issue before another that reads the old value of its register.
    fn sort(&self, list: &mut [Instance]) {
        if self.plan.is_sheltered {
            list.sort_unstable_by_key(|one| (one.iteration, one.step));
        } else {
            list.sort_unstable();
        }
    }

    /// The step instances of the prologue passes, in which not every stage is active, without the branches.
    fn prologue_instances(&self, passes: std::ops::Range<i64>) -> Vec<Instance> {
        let mut found = Vec::new();
        for step in 0..self.branch() {
            let stage = i64::from(self.plan.stage(step));
            found.extend(
                passes.clone().filter(|pass| *pass >= stage).map(|pass| self.instance(step, pass - stage)),
            );
        }
        self.sort(&mut found);
        found
    }

    /// The instances that complete the last `count` iterations after the last pass; the last iteration is number 0.
    fn epilogue_instances(&self, count: i64) -> Vec<Instance> {
        let mut found = Vec::new();
        for step in 0..self.branch() {
            let stage = i64::from(self.plan.stage(step));
            let left = (0..count).filter(|back| stage > i64::from(self.plan.commit) + back);
            found.extend(left.map(|back| self.instance(step, -back)));
        }
        self.sort(&mut found);
        found
    }

    fn steps(&self, instances: &[Instance]) -> Vec<Step> {
        instances.iter().map(|one| self.steps[one.step].clone()).collect()
    }

    fn schedule_region(&self, label: u32, instances: &[Instance], branches: Vec<Step>) -> ScheduledRegion {
        let region = Region {
            steps: self.steps(instances),
            branches,
            ..Region::new(label, self.region.weight / 8.0, self.region.span)
        };
        schedule::schedule(&region, Order::Early, 0)
    }

    /// The branch out of the loop after the last iteration.
    fn leave_to(&self, label: u32) -> Option<Step> {
        let step = &self.steps[self.branch()];
        let inst = step.forms.first()?;
        let pred = match inst.pred() {
            Pred::If(reg) => Pred::Unless(reg),
            Pred::Unless(reg) => Pred::If(reg),
            Pred::Always => return None,
        };
        branch_to(inst, pred, label, step)
    }

    /// The epilogue of a loop that has only the first `count` iterations.
    fn end_of(&self, count: i64, label: u32) -> Option<ScheduledRegion> {
        let step = &self.steps[self.branch()];
        let out = branch_to(step.forms.first()?, Pred::Always, self.outside, step)?;
        let mut end = self.schedule_region(label, &self.epilogue_instances(count), vec![out]);
        end.weight *= RARE;
        Some(end)
    }

    /// The packets of the loop itself.
    fn packets(&self, label: u32) -> ScheduledRegion {
        let mut insts = Vec::with_capacity(self.steps.len());
        for (step, (cycle, inst)) in self.steps.iter().zip(&self.plan.places) {
            let is_branch = inst.branch().is_some();
            let value = if is_branch { Some(Value::Block(label)) } else { step.value };
            insts.push(IssuedInst { cycle: cycle % self.plan.period, inst: *inst, value, span: step.span });
        }
        insts.sort_by_key(|issued| issued.cycle);
        ScheduledRegion {
            label,
            insts,
            cycles: self.plan.period,
            weight: self.region.weight,
            span: self.region.span,
            is_exceeded: false,
        }
    }

    /// The end of the loop after its own packets, with the results that are still in flight.
    fn final_region(&mut self) -> Option<ScheduledRegion> {
        let depth = i64::from(self.plan.stages() - self.plan.commit);
        let end = (i64::from(self.plan.commit) + 1) * self.period();
        let start = end - 2 * self.period();
        let mut tail: Vec<Instance> = Vec::new();
        for step in 0..self.steps.len() {
            let iterations = -(depth + 2)..=i64::from(self.plan.commit) + 1;
            let near = iterations.map(|iteration| self.instance(step, iteration));
            tail.extend(near.filter(|one| (start..end).contains(&one.cycle)));
        }
        self.sort(&mut tail);
        let issued: Vec<(Step, Inst, u32)> = tail
            .iter()
            .filter_map(|one| {
                let cycle = u32::try_from(one.cycle - start).ok()?;
                Some((self.steps[one.step].clone(), self.plan.places[one.step].1, cycle))
            })
            .collect();
        let mut branches = Vec::new();
        if self.outside != self.region.label + 1 {
            let step = &self.steps[self.branch()];
            branches.push(branch_to(step.forms.first()?, Pred::Always, self.outside, step)?);
        }
        let label = self.new_label();
        let region = Region {
            steps: self.steps(&self.epilogue_instances(depth)),
            branches,
            ..Region::new(label, self.region.weight / 8.0, self.region.span)
        };
        Some(schedule::schedule_after(&Tail { issued, cycles: 2 * self.plan.period }, region))
    }
}

fn branch_to(like: &Inst, pred: Pred, label: u32, step: &Step) -> Option<Step> {
    let operands: Vec<c67x::Operand> = like.operands().collect();
    let inst = Inst::new(like.op(), c67x::Side::B, pred, &operands).ok()?;
    Some(Step { forms: vec![inst], value: Some(Value::Block(label)), access: Access::None, span: step.span })
}
