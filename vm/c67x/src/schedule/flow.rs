//! The rules for sequences of packets, checked by following every path.
//!
//! A state is a packet and the effects in flight when it issues, counted in cycles from then on. From each state the
//! packet is issued once for each possible outcome of its branches; states that have been visited are not followed
//! again. No effect is in flight for more than ten cycles, so there are few states.

use std::collections::{BTreeMap, BTreeSet};

use super::{LONGEST_SHADOW, Packet, Rule, Violation};
use crate::inst::Inst;
use crate::mnemonic::Mnemonic;
use crate::model::Branch;
use crate::register::{Pred, Reg, Side, Unit, UnitKind};
use crate::spelling::target;

/// The number of states from which code counts as too complex.
const MOST_STATES: usize = 200_000;

/// The number of cycles from a branch to its target.
const BRANCH: u32 = 6;

/// The minimum number of cycles between different long multiplies on one unit.
const LONG_MULTIPLIES: u32 = 8;

/// A result in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pending {
    reg: Reg,
    /// The number of cycles until it is visible.
    left: u32,
    /// The condition on which it depends, while that register is unchanged.
    pred: Guard,
    /// True if an interrupt could have been taken since its issue.
    exposed: bool,
}

/// A condition as a sortable value: the register, and whether it must be 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Guard(Option<(Reg, bool)>);

impl Guard {
    fn of(inst: &Inst) -> Self {
        let negated = matches!(inst.pred(), Pred::Unless(_));
        Self(inst.pred().reg().map(|reg| (reg, negated)))
    }

    fn excludes(self, other: Self) -> bool {
        matches!((self.0, other.0), (Some((a, x)), Some((b, y))) if a == b && x != y)
    }

    fn clear_if(&mut self, reg: Reg) {
        if self.0.is_some_and(|(own, _)| own == reg) {
            self.0 = None;
        }
    }
}

/// A register that is still being read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct PendingRead {
    reg: Reg,
    first: u32,
    last: u32,
}

/// A branch in flight; `None` if it leaves the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct PendingBranch {
    left: u32,
    target: Option<u32>,
    pred: Guard,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct FlowState {
    at: u32,
    pending: Vec<Pending>,
    readings: Vec<PendingRead>,
    /// Results of units, with the number of cycles until they are written.
    ports: Vec<(Unit, u32, Guard)>,
    units: Vec<(Unit, u32)>,
    crosses: Vec<(Side, u32)>,
    multiplies: Vec<(Unit, Mnemonic, u32)>,
    branches: Vec<PendingBranch>,
    /// The number of cycles in which no interrupt can be taken.
    shadow: u32,
    /// The number of cycles since an interrupt could be taken.
    since: u32,
}

/// Follows all paths from the entries.
pub(super) fn walk(base: u32, packets: &[Packet], entries: &[u32]) -> Vec<Violation> {
    let mut code = BTreeMap::new();
    let mut at = base;
    for packet in packets {
        code.insert(at, packet);
        at += packet.bytes();
    }
    let mut walk = Walk { code, range: base..at, found: BTreeSet::new() };
    let mut open: Vec<FlowState> =
        entries.iter().map(|at| FlowState { at: *at, ..FlowState::default() }).collect();
    let mut seen = BTreeSet::new();
    while let Some(state) = open.pop() {
        if seen.len() > MOST_STATES {
            walk.found.insert(Violation { at: state.at, rule: Rule::TooComplex });
            break;
        }
        if seen.insert(state.clone()) {
            open.extend(walk.issue(state));
        }
    }
    walk.found.into_iter().collect()
}

struct Walk<'a> {
    code: BTreeMap<u32, &'a Packet>,
    range: std::ops::Range<u32>,
    found: BTreeSet<Violation>,
}

impl Walk<'_> {
    /// Issues the packet of a state; returns the possible next states.
    fn issue(&mut self, mut state: FlowState) -> Vec<FlowState> {
        let at = state.at;
        let Some(packet) = self.code.get(&at).copied() else {
            let rule = if self.range.contains(&at) { Rule::IntoPacket(at) } else { Rule::RunsOut };
            self.found.insert(Violation { at, rule });
            return Vec::new();
        };
        let mut rules = Vec::new();
        state.interruptible(&mut rules);
        for inst in &packet.insts {
            state.locks(inst, &mut rules);
            state.reads(inst, &mut rules);
        }
        for inst in &packet.insts {
            state.start(inst, &mut rules);
        }
        for inst in &packet.insts {
            state.occupy(inst, at, &self.range);
        }
        self.found.extend(rules.into_iter().map(|rule| Violation { at, rule }));
        state.at = at + packet.bytes();
        self.pass(state, packet.cycles(), at)
    }

    /// Passes the cycles of a packet; they end early if a branch arrives.
    fn pass(&mut self, mut state: FlowState, cycles: u32, at: u32) -> Vec<FlowState> {
        for _ in 0..cycles {
            state.tick();
            let (arrived, coming): (Vec<_>, Vec<_>) =
                state.branches.iter().partition(|coming| coming.left == 0);
            if arrived.is_empty() {
                continue;
            }
            state.branches = coming;
            let certain = arrived.iter().any(|coming| coming.pred.0.is_none())
                || matches!(arrived[..], [a, b] if a.pred.excludes(b.pred));
            let mut next = Vec::new();
            for coming in arrived {
                match coming.target {
                    Some(target) => next.push(FlowState { at: target, ..state.clone() }),
                    None => self.leave(&state, at),
                }
            }
            if !certain {
                // Not taken: the rest of a NOP passes, which changes nothing that is checked.
                next.push(state);
            }
            return next;
        }
        vec![state]
    }

    /// Checks that all results have landed when the code is left.
    fn leave(&mut self, state: &FlowState, at: u32) {
        let late = state.pending.iter().map(|pending| Violation { at, rule: Rule::InFlight(pending.reg) });
        self.found.extend(late);
    }
}

impl FlowState {
    fn interruptible(&mut self, rules: &mut Vec<Rule>) {
        if self.shadow == 0 {
            self.since = 0;
            self.pending.iter_mut().for_each(|pending| pending.exposed = true);
        } else if self.since > LONGEST_SHADOW {
            rules.push(Rule::NotInterruptible);
        }
    }

    /// Checks for units and cross paths that are still locked by earlier instructions.
    fn locks(&self, inst: &Inst, rules: &mut Vec<Rule>) {
        let Some(unit) = inst.unit() else { return };
        if self.units.iter().any(|(held, _)| *held == unit) {
            rules.push(Rule::UnitLocked(unit));
        }
        if let Some(side) = inst.cross_path()
            && self.crosses.iter().any(|(held, _)| *held == side)
        {
            rules.push(Rule::CrossPathLocked(side));
        }
        if is_long_multiply(inst.mnemonic()) || inst.mnemonic() == Mnemonic::Mpysp {
            // The board's firmware has MPYSP 7 cycles after MPYDP.
            let early = u32::from(inst.mnemonic() == Mnemonic::Mpysp);
            let other = |(on, name, left): &(Unit, Mnemonic, u32)| {
                *on == unit && *name != inst.mnemonic() && *left > early
            };
            if self.multiplies.iter().any(other) {
                rules.push(Rule::LongMultiplies(unit));
            }
        }
    }

    /// Checks for results in flight to the registers that the instruction reads.
    fn reads(&mut self, inst: &Inst, rules: &mut Vec<Rule>) {
        let guard = Guard::of(inst);
        let condition = inst.pred().reg().map(|reg| PendingRead { reg, first: 0, last: 0 });
        let sources = inst.reads().map(|read| PendingRead {
            reg: read.reg,
            first: u32::from(read.first) - 1,
            last: u32::from(read.last) - 1,
        });
        for reading in sources.chain(condition) {
            for pending in self.pending.iter().filter(|pending| pending.reg == reading.reg) {
                if pending.left <= reading.first || pending.pred.excludes(guard) {
                    continue;
                }
                if pending.left <= reading.last {
                    rules.push(Rule::ChangesDuringRead(reading.reg));
                } else if pending.exposed {
                    rules.push(Rule::EarlyRead(reading.reg));
                }
            }
        }
        self.readings.extend(inst.reads().filter(|read| read.last > 1).map(|read| PendingRead {
            reg: read.reg,
            first: u32::from(read.first) - 1,
            last: u32::from(read.last) - 1,
        }));
    }

    /// Checks the instruction's results against each other, and against registers that are still being read.
    fn start(&mut self, inst: &Inst, rules: &mut Vec<Rule>) {
        let pred = Guard::of(inst);
        for write in inst.writes() {
            let left = u32::from(write.stage);
            let same =
                |other: &&Pending| other.reg == write.reg && other.left == left && !other.pred.excludes(pred);
            if self.pending.iter().any(|other| same(&other)) {
                rules.push(Rule::TwoResults(write.reg));
            }
            let reading = |reading: &PendingRead| {
                reading.reg == write.reg && left > reading.first && left <= reading.last
            };
            if self.readings.iter().any(reading) {
                rules.push(Rule::ChangesDuringRead(write.reg));
            }
            self.pending.push(Pending { reg: write.reg, left, pred, exposed: false });
        }
        let Some(unit) = inst.unit().filter(|unit| unit.kind != UnitKind::D) else { return };
        let mut stages: Vec<u32> = inst.writes().map(|write| u32::from(write.stage)).collect();
        stages.dedup();
        for left in stages {
            let busy = |(held, at, guard): &(Unit, u32, Guard)| {
                *held == unit && *at == left && !guard.excludes(pred)
            };
            if self.ports.iter().any(busy) {
                rules.push(Rule::WritePort(unit));
            }
            self.ports.push((unit, left, pred));
        }
    }

    /// Records the resources that the instruction occupies, and its branch.
    fn occupy(&mut self, inst: &Inst, at: u32, code: &std::ops::Range<u32>) {
        if let Some((unit, cycles)) = inst.occupies()
            && cycles > 1
        {
            self.units.push((unit, u32::from(cycles)));
            self.crosses.extend(inst.cross_path().map(|side| (side, u32::from(cycles))));
        }
        if let Some(unit) = inst.unit()
            && is_long_multiply(inst.mnemonic())
        {
            self.multiplies.push((unit, inst.mnemonic(), LONG_MULTIPLIES));
        }
        let Some(branch) = inst.branch() else { return };
        let target = match branch {
            Branch::Near { bytes } => Some(target(at, bytes)).filter(|target| code.contains(target)),
            Branch::Register(_) | Branch::Interrupt => None,
        };
        self.branches.push(PendingBranch { left: BRANCH, target, pred: Guard::of(inst) });
        self.shadow = BRANCH;
    }

    /// Advances by one cycle.
    fn tick(&mut self) {
        self.shadow = self.shadow.saturating_sub(1);
        self.since = (self.since + 1).min(LONGEST_SHADOW + 1);
        for pending in &mut self.pending {
            pending.left -= 1;
        }
        let landed: Vec<Reg> =
            self.pending.iter().filter(|pending| pending.left == 0).map(|pending| pending.reg).collect();
        self.pending.retain(|pending| pending.left > 0);
        for reg in landed {
            self.pending.iter_mut().for_each(|pending| pending.pred.clear_if(reg));
            self.ports.iter_mut().for_each(|(.., guard)| guard.clear_if(reg));
        }
        self.readings.retain(|reading| reading.last > 0);
        for reading in &mut self.readings {
            reading.first = reading.first.saturating_sub(1);
            reading.last -= 1;
        }
        self.branches.iter_mut().for_each(|coming| coming.left -= 1);
        count_down(&mut self.ports, |(_, left, _)| left);
        count_down(&mut self.units, |(_, left)| left);
        count_down(&mut self.crosses, |(_, left)| left);
        count_down(&mut self.multiplies, |(.., left)| left);
        self.pending.sort();
        self.ports.sort();
    }
}

/// Decrements the cycles of every entry, and removes those that have reached 0.
fn count_down<T>(list: &mut Vec<T>, left: impl Fn(&mut T) -> &mut u32) {
    list.iter_mut().for_each(|item| *left(item) -= 1);
    list.retain_mut(|item| *left(item) > 0);
}

const fn is_long_multiply(mnemonic: Mnemonic) -> bool {
    matches!(mnemonic, Mnemonic::Mpyi | Mnemonic::Mpyid | Mnemonic::Mpydp)
}
