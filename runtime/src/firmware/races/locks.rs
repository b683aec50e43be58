//! Locks of programs: their owners, and the order in which they are taken.

use std::collections::BTreeMap;

use kmotiondef::{CodeAddr, GuestAddr};

use super::{AccessMark, Actor, CONTEXTS, Races, Track, VectorClock, context, index, join};
use crate::out::{Message, OtherPlace, Out};

/// A lock.
#[derive(Clone, Debug, Default)]
pub(super) struct Lock {
    /// Its number in the order in which locks were first taken.
    number: usize,
    /// The combined knowledge of the contexts that have freed it.
    clock: VectorClock,
    /// True if `MutexLock` takes it.
    pub(super) is_mutex: bool,
}

/// A set of locks held together; all locks beyond the first 63 count as one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LockSet(u64);

impl LockSet {
    /// Returns whether a lock is in both.
    pub(super) const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// Attempts to take a lock while another is held: the held one, the other, the context.
pub(super) type Orders = BTreeMap<(u32, u32, usize), AccessMark>;

impl Races {
    /// Notes that a context takes a lock by `MutexLock`, or tries to.
    pub(crate) fn locks(&mut self, actor: Actor, lock: GuestAddr, is_taken: bool, out: &mut Out) {
        let (own, lock) = (index(actor.thread), lock.get());
        let mark = self.mark(actor);
        for place in 0..self.tracks[own].held.len() {
            let (held, _) = self.tracks[own].held[place];
            if held == lock {
                continue;
            }
            self.orders.insert((held, lock, own), mark);
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
        let known = self.lock(lock);
        known.is_mutex = true;
        if is_taken {
            let clock = known.clock;
            join(&mut self.tracks[own].clock, &clock);
            if !self.tracks[own].held.iter().any(|(known, _)| *known == lock) {
                self.hold_lock(own, lock, actor.at);
            }
        }
    }

    /// Notes that a context has taken a free cell by `TestAndSet`.
    pub(crate) fn record_lock(&mut self, actor: Actor, lock: GuestAddr) {
        let (own, lock) = (index(actor.thread), lock.get());
        let clock = self.lock(lock).clock;
        join(&mut self.tracks[own].clock, &clock);
        self.hold_lock(own, lock, actor.at);
    }

    /// The lock at an address.
    fn lock(&mut self, address: u32) -> &mut Lock {
        let number = self.locks.len();
        self.locks.entry(address).or_insert_with(|| Lock { number, ..Lock::default() })
    }

    /// A context holds one more lock.
    fn hold_lock(&mut self, own: usize, lock: u32, at: CodeAddr) {
        self.tracks[own].held.push((lock, at));
        self.note_held(own);
    }

    /// The locks that a context holds have changed.
    fn note_held(&mut self, own: usize) {
        let Track { held, locks, .. } = &mut self.tracks[own];
        let numbers = held.iter().filter_map(|(lock, _)| self.locks.get(lock)).map(|lock| lock.number);
        *locks = LockSet(numbers.fold(0, |set, number| set | 1 << number.min(63)));
        self.is_reordered = true;
    }

    /// Notes that a context frees a lock, which any context may hold.
    pub(crate) fn record_unlock(&mut self, actor: Actor, lock: GuestAddr) {
        self.free_lock(actor, lock.get());
    }

    /// Notes that a context has stored 0 in a cell that may be a lock.
    pub(super) fn free_lock(&mut self, actor: Actor, lock: u32) {
        let own = index(actor.thread);
        let Some(known) = self.locks.get_mut(&lock) else { return };
        join(&mut known.clock, &self.tracks[own].clock);
        self.tracks[own].clock[own] += 1;
        self.is_reordered = true;
        for other in 0..CONTEXTS {
            let held = &mut self.tracks[other].held;
            let before = held.len();
            held.retain(|(held, _)| *held != lock);
            if held.len() != before {
                self.note_held(other);
            }
        }
    }
}
