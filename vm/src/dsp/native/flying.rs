//! The effects in flight between two packets, without their values: the shape for which code is translated.
//!
//! Results in flight are known when code is translated: a load lands five cycles after its issue whatever it loads. So
//! a translation begins with a list of the effects in flight, and only the values come from outside; at each exit
//! another list describes the values that it leaves.

use super::super::decode::MicroOp;
use super::super::flight::{PendingDouble, SLOTS};
use super::super::pipeline::State;
use crate::native::{Handover, VALUES};

/// An effect in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InFlightEffect {
    /// Cycles until it arrives.
    pub(super) due: u8,
    /// True if a condition decides whether it arrives at all; the condition is its first value.
    pub(super) is_conditional: bool,
    /// The effect.
    pub(super) kind: EffectKind,
}

/// An effect that can be in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EffectKind {
    /// A result for this register; its value.
    Result(u8),
    /// A branch to an address, or to one that is a value.
    Branch(Option<u32>),
    /// A double instruction that reads high words when it arrives; the low words.
    Start(MicroOp),
    /// A product of doubles that reads the last high word; the low words and the high one of the second source.
    Product(MicroOp),
}

impl EffectKind {
    /// Number of its values.
    pub(super) const fn values(self) -> usize {
        match self {
            Self::Result(_) | Self::Branch(None) => 1,
            Self::Branch(Some(_)) => 0,
            Self::Start(_) => 2,
            Self::Product(_) => 3,
        }
    }

    /// Its index among the effects that arrive in the same cycle.
    pub(super) const fn rank(self) -> u32 {
        match self {
            Self::Result(reg) => reg as u32,
            Self::Start(micro) => 0x100 | micro.dst as u32,
            Self::Product(micro) => 0x200 | micro.dst as u32,
            Self::Branch(_) => 0x300,
        }
    }
}

impl State {
    /// Lists the effects in flight; `false` if a translation cannot begin with them.
    pub(super) fn list_flying(&self, flying: &mut Vec<InFlightEffect>) -> bool {
        flying.clear();
        if self.flight.is_empty() {
            return true;
        }
        for due in 1..SLOTS as u8 {
            let slot = self.slot(u64::from(due));
            if self.flight.due >> due & 1 == 0 {
                continue;
            }
            let mut mask = self.flight.masks[slot];
            while mask != 0 {
                let what = EffectKind::Result(mask.trailing_zeros() as u8);
                flying.push(InFlightEffect { due, is_conditional: false, kind: what });
                mask &= mask - 1;
            }
            for late in self.flight.late.iter().filter(|late| late.due == self.clock.cycle + u64::from(due)) {
                if late.high2.is_none() || late.issued + 1 != self.clock.cycle || due != 1 {
                    return false;
                }
                flying.push(InFlightEffect {
                    due,
                    is_conditional: false,
                    kind: EffectKind::Product(late.micro),
                });
            }
            if self.flight.branches >> slot & 1 != 0 {
                let what = EffectKind::Branch(Some(self.flight.targets[slot]));
                flying.push(InFlightEffect { due, is_conditional: false, kind: what });
            }
        }
        true
    }

    /// Moves the values of the effects that [`list_flying`](Self::list_flying) has listed to `values`: none is in
    /// flight in the state any more.
    pub(super) fn take_flying(&mut self, flying: &[InFlightEffect], values: &mut [u32; VALUES]) {
        let mut values = values.iter_mut();
        let mut lates = self.flight.late.iter();
        for one in flying {
            let slot = self.slot(u64::from(one.due));
            let mut put = |value| {
                if let Some(place) = values.next() {
                    *place = value;
                }
            };
            match one.kind {
                EffectKind::Result(reg) => put(self.flight.values[slot][usize::from(reg & 63)]),
                EffectKind::Branch(Some(_)) => {}
                EffectKind::Branch(None) => put(self.flight.targets[slot]),
                EffectKind::Start(_) | EffectKind::Product(_) => {
                    let Some(late) = lates.next() else { continue };
                    put(late.low1);
                    put(late.low2);
                    put(late.high2.unwrap_or(0));
                }
            }
        }
        self.flight.due = 0;
        self.flight.masks = [0; SLOTS];
        self.flight.branches = 0;
        self.flight.late.clear();
    }

    /// Puts effects in flight, relative to the present cycle.
    pub(super) fn put_flying(&mut self, flying: &[InFlightEffect], values: &[u32; VALUES]) {
        let mut values = values.iter().copied();
        for one in flying {
            let arrives = !one.is_conditional || values.next().is_some_and(|condition| condition != 0);
            let mut own = [0; 3];
            own.iter_mut().zip(values.by_ref().take(one.kind.values())).for_each(|(own, value)| *own = value);
            if !arrives {
                continue;
            }
            self.flight.expect(1 << one.due);
            let due = u64::from(one.due);
            match one.kind {
                EffectKind::Result(reg) => self.push(due, reg, own[0]),
                EffectKind::Branch(target) => self.set_branch(due, target.unwrap_or(own[0])),
                EffectKind::Start(micro) => self.push_late(PendingDouble {
                    due: self.clock.cycle + due,
                    issued: self.clock.cycle,
                    micro,
                    low1: own[0],
                    low2: own[1],
                    high2: None,
                }),
                EffectKind::Product(micro) => self.push_late(PendingDouble {
                    due: self.clock.cycle + due,
                    issued: self.clock.cycle - 1,
                    micro,
                    low1: own[0],
                    low2: own[1],
                    high2: Some(own[2]),
                }),
            }
        }
    }

    /// Hands over the time and the last branches.
    pub(super) fn hand_over(&self, handover: &mut Handover) {
        handover.time.cycle = self.clock.cycle;
        handover.time.deadline = self.clock.deadline;
        handover.time.shadow = self.shadow;
        handover.branched_at = self.branched_at;
    }

    /// Takes them back.
    pub(super) fn take_back(&mut self, handover: &Handover) {
        self.clock.cycle = handover.time.cycle;
        self.shadow = handover.time.shadow;
        self.branched_at = handover.branched_at;
    }
}
