//! Locks of programs: who holds them, in which order they are taken.

use std::collections::BTreeMap;

use kmotiondef::GuestAddr;

use super::{AccessMark, Actor, Races, VectorClock, context, index, join};
use crate::out::{Message, OtherPlace, Out};

/// A lock.
#[derive(Clone, Debug, Default)]
pub(super) struct Lock {
    /// The combined knowledge of the contexts that have freed it.
    clock: VectorClock,
    /// True if `MutexLock` takes it.
    pub(super) is_mutex: bool,
}

/// Attempts to take a lock while another is held: the held one, the other, the context.
pub(super) type Orders = BTreeMap<(u32, u32, usize), AccessMark>;

impl Races {
    /// A context takes a lock by `MutexLock`, or tries to.
    pub(crate) fn locks(&mut self, actor: Actor, lock: GuestAddr, is_taken: bool, out: &mut Out) {
        let (own, lock) = (index(actor.thread), lock.get());
        let mark = self.mark(actor);
        for held in mark.locks.iter().copied().filter(|held| *held != lock) {
            self.orders.insert((held, lock, own), mark.clone());
            let opposite = self
                .orders
                .iter()
                .find(|((first, second, other), _)| (*first, *second) == (lock, held) && *other != own);
            if let Some(((.., other), at)) = opposite.map(|(key, mark)| (*key, mark.at)) {
                let other = OtherPlace { thread: context(other), at };
                let (lock, held) = (self.name_of(lock, 4), self.name_of(held, 4));
                self.report(out, actor, at, Message::LockOrder { other, lock, held });
            }
        }
        let known = self.locks.entry(lock).or_default();
        known.is_mutex = true;
        if is_taken {
            join(&mut self.tracks[own].clock, &known.clock);
            let held = &mut self.tracks[own].held;
            if !held.iter().any(|(known, _)| *known == lock) {
                held.push((lock, actor.at));
            }
        }
    }

    /// A context has taken a free cell by `TestAndSet`.
    pub(crate) fn takes(&mut self, actor: Actor, lock: GuestAddr) {
        let (own, lock) = (index(actor.thread), lock.get());
        let known = self.locks.entry(lock).or_default();
        join(&mut self.tracks[own].clock, &known.clock);
        self.tracks[own].held.push((lock, actor.at));
    }

    /// Notes that a context frees a lock, which any context may hold.
    pub(crate) fn unlocks(&mut self, actor: Actor, lock: GuestAddr) {
        self.freed(actor, lock.get());
    }

    /// A context has stored 0 where a lock may be.
    pub(super) fn freed(&mut self, actor: Actor, lock: u32) {
        let own = index(actor.thread);
        let Some(known) = self.locks.get_mut(&lock) else { return };
        join(&mut known.clock, &self.tracks[own].clock);
        self.tracks[own].clock[own] += 1;
        for track in &mut self.tracks {
            track.held.retain(|(held, _)| *held != lock);
        }
    }
}
