//! Renamed registers of a loop: the location of each register, and its results in flight.
//!
//! A result in flight is written to a location that no instruction reads; when it lands, that location becomes the
//! register's. So between two packets, everything except the values follows from the packets executed before.

use super::super::flight::SLOTS;
use super::super::pipeline::{BRANCH, State};

/// Registers of the processor.
const REGS: usize = 64;
/// The first location that is not a register, a multiple of 2: the locations before it hold the constants.
const FIRST: u8 = 66;

/// A result in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PendingResult {
    /// Cycles until it lands.
    pub(super) due: u8,
    pub(super) reg: u8,
    /// Its location before and after the result lands.
    pub(super) place: u8,
}

/// A branch in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PendingBranch {
    /// Cycles until it arrives.
    pub(super) due: u8,
    pub(super) target: u32,
    /// The condition; `None` for a branch that is always taken.
    pub(super) decider: Option<BranchCondition>,
    /// The packet of the branch; `None` if the state has noted it already.
    pub(super) from: Option<u32>,
}

/// The condition of a branch in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct BranchCondition {
    pub(super) place: u8,
    /// True if the branch is taken when that value is 0.
    pub(super) inverted: bool,
}

impl BranchCondition {
    #[inline(always)]
    pub(super) fn holds(self, places: &[u32; 256]) -> bool {
        (places[usize::from(self.place)] == 0) == self.inverted
    }
}

/// Everything at the border before a packet, without values.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Renaming {
    /// The place of each register.
    map: [u8; REGS],
    pub(super) landings: Vec<PendingResult>,
    pub(super) jumps: Vec<PendingBranch>,
    /// Cycles until an interrupt is possible, because of branches of the loop.
    held: u8,
}

/// An effect in flight: the cycles left, the register or [`REGS`], and the target of a branch.
pub(super) type EffectShape = (u8, u8, u32);

/// Lists the effects in flight in a state; `false` if a loop cannot begin with them.
pub(super) fn list(state: &State, flying: &mut Vec<EffectShape>) -> bool {
    flying.clear();
    if state.flight.is_empty() {
        return true;
    }
    for due in 1..SLOTS as u8 {
        if state.flight.due >> due & 1 == 0 {
            continue;
        }
        let slot = state.slot(u64::from(due));
        let mut mask = state.flight.masks[slot];
        while mask != 0 {
            flying.push((due, mask.trailing_zeros() as u8, 0));
            mask &= mask - 1;
        }
        if state.flight.branches >> slot & 1 != 0 {
            flying.push((due, REGS as u8, state.flight.targets[slot]));
        }
    }
    state.flight.late.is_empty()
}

impl Renaming {
    /// All registers in their own places.
    pub(super) fn at_entry(flying: &[EffectShape], places: &mut Spares) -> Option<Self> {
        let map = std::array::from_fn(|reg| reg as u8);
        let mut renaming = Self { map, landings: Vec::new(), jumps: Vec::new(), held: 0 };
        for &(due, reg, target) in flying {
            if usize::from(reg) == REGS {
                renaming.jumps.push(PendingBranch { due, target, decider: None, from: None });
            } else {
                let place = places.find(&renaming, reg, Width::Word)?;
                renaming.landings.push(PendingResult { due, reg, place });
            }
        }
        renaming.sort();
        Some(renaming)
    }

    /// The place that an instruction reads for a register, and for a constant.
    pub(super) fn place(&self, reg: u8) -> u8 {
        self.map.get(usize::from(reg)).copied().unwrap_or(reg)
    }

    /// The location of a register in `cycles` cycles, if only the effects in flight change it.
    pub(super) fn after(&self, cycles: u8, reg: u8) -> u8 {
        let by_then = self.landings.iter().filter(|landing| landing.reg == reg && landing.due <= cycles);
        by_then.max_by_key(|landing| landing.due).map_or(self.place(reg), |landing| landing.place)
    }

    /// Reports whether a result for a register lands in `due` cycles.
    pub(super) fn has_result(&self, due: u8, reg: u8) -> bool {
        self.landings.iter().any(|landing| landing.due == due && landing.reg == reg)
    }

    /// Reports whether a branch may arrive in `due` cycles.
    pub(super) fn has_branch(&self, due: u8) -> bool {
        self.jumps.iter().any(|jump| jump.due == due)
    }

    /// Called for a packet with a branch, taken or not: interrupts are held off.
    pub(super) fn hold_interrupts(&mut self) {
        self.held = BRANCH as u8;
    }

    /// Lets a cycle pass; returns the branch that arrives at its end, if any.
    pub(super) fn pass(&mut self) -> Option<PendingBranch> {
        self.held = self.held.saturating_sub(1);
        let map = &mut self.map;
        self.landings.retain_mut(|landing| {
            landing.due -= 1;
            if landing.due == 0 {
                map[usize::from(landing.reg)] = landing.place;
            }
            landing.due > 0
        });
        self.jumps.iter_mut().for_each(|jump| jump.due -= 1);
        self.jumps.pop_if(|jump| jump.due == 0)
    }

    /// Sorts the effects in flight; a branch that arrives earlier is placed later.
    pub(super) fn sort(&mut self) {
        self.landings.sort_unstable();
        self.jumps.sort_unstable_by(|one, other| other.cmp(one));
    }

    fn uses(&self, place: u8) -> bool {
        self.map.contains(&place)
            || self.landings.iter().any(|landing| landing.place == place)
            || self.jumps.iter().any(|jump| jump.decider.is_some_and(|other| other.place == place))
    }

    /// Brings the values of a state to the places of a loop that begins.
    pub(super) fn load_state(&self, state: &mut State) {
        for landing in &self.landings {
            let slot = state.slot(u64::from(landing.due));
            state.regs[usize::from(landing.place)] = state.flight.values[slot][usize::from(landing.reg & 63)];
        }
        state.flight.due = 0;
        state.flight.masks = [0; SLOTS];
        state.flight.branches = 0;
    }

    /// Moves the values back: the state is then as if the packets had been executed one by one.
    pub(super) fn store_state(&self, state: &mut State) {
        let places = state.regs;
        for (reg, place) in self.map.iter().enumerate() {
            state.regs[reg] = places[usize::from(*place)];
        }
        for landing in &self.landings {
            state.flight.expect(1 << landing.due);
            state.push(u64::from(landing.due), landing.reg, places[usize::from(landing.place)]);
        }
        // In the order of their issue.
        for jump in self.jumps.iter().rev() {
            if jump.decider.is_none_or(|decider| decider.holds(&places)) {
                state.flight.expect(1 << jump.due);
                state.set_branch(u64::from(jump.due), jump.target);
                if let Some(from) = jump.from {
                    state.note_branch(from);
                }
            }
        }
        if self.held > 0 {
            state.shadow = state.clock.cycle + u64::from(self.held);
        }
    }
}

/// The part of a pair of locations that is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Width {
    /// The one of the register.
    Word,
    /// The words of both registers.
    Pair,
}

/// The locations used by results of each pair of registers, beginning with the pair itself.
///
/// Each pair has its own list, so that every register of a loop returns to the same location after a few iterations,
/// whatever the others do.
#[derive(Debug)]
pub(super) struct Spares {
    pairs: [Vec<u8>; REGS / 2],
    deciders: Vec<u8>,
    /// The next unused location.
    next: u8,
}

impl Spares {
    pub(super) fn new() -> Self {
        Self { pairs: std::array::from_fn(|pair| vec![2 * pair as u8]), deciders: Vec::new(), next: FIRST }
    }

    /// A location for a result, with the other word of its pair next to it; `None` if there is none left.
    pub(super) fn find(&mut self, renaming: &Renaming, reg: u8, width: Width) -> Option<u8> {
        let word = reg & 1;
        let own = self.pairs.get_mut(usize::from(reg / 2))?;
        let is_free = |low: &u8| match width {
            Width::Word => !renaming.uses(low | word),
            Width::Pair => !renaming.uses(*low) && !renaming.uses(low | 1),
        };
        let low = own.iter().copied().find(is_free).or_else(|| another(&mut self.next, own))?;
        Some(low | word)
    }

    /// A place for the condition of a branch.
    pub(super) fn find_decider(&mut self, renaming: &Renaming) -> Option<u8> {
        let known = self.deciders.iter().copied().find(|place| !renaming.uses(*place));
        known.or_else(|| another(&mut self.next, &mut self.deciders))
    }
}

/// Returns an unused pair of locations.
fn another(next: &mut u8, own: &mut Vec<u8>) -> Option<u8> {
    let low = *next;
    *next = next.checked_add(2)?;
    own.push(low);
    Some(low)
}
