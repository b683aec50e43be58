//! Accesses of several threads to the same memory that can go wrong on the board.
//!
//! Not every unordered access is an error here: programs for this board commonly have words with a single writer,
//! requests that one thread sets and another clears, and values whose last writer wins. So each rule detects a loss: an
//! update that another store can overwrite, a free cell that two threads can take, an eight-byte value of which half
//! can be read before it is updated, a request that is posted before its parameter, locks that can deadlock.
//!
//! Two accesses are ordered if the first happens before the second regardless of the lengths of slices: by the start of
//! a thread, by a lock, or because the thread of the second has read a value that the thread of the first stored after
//! it. Values read from a cell do not order accesses to the same cell, since two counters in it would always seem
//! ordered. The order is kept in vector clocks; a thread's own entry grows with each of its stores.

mod cells;
mod conflicts;
mod locks;
mod records;
mod reports;
pub(crate) mod shared;
pub(crate) mod switches;
mod table;
mod wakes;

use std::collections::BTreeMap;
use std::mem;
use std::sync::Arc;

use kmotiondef::structs::Persist;
use kmotiondef::variables::{CHAN, PERSIST, USER_CALL_BACK, cell_name, variable_around};
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId};
use vm::firmware::{RepeatPolicy, SharedAccess};
use vm::memory::GuestMemory;
use vm::thread::{Progress, ThreadState, Threads};

use self::locks::{Lock, LockSet, Orders};
use self::records::JointReads;
use self::reports::Reports;
use self::table::Cells;
use self::wakes::{PausedThread, ResumeCall};
use crate::firmware::calls::NamedObject;
use crate::out::{Message, OtherPlace, Out};

/// The seven threads, and before them the call-back.
const CONTEXTS: usize = 1 + ThreadId::MAX as usize;

/// Threads that begin within this time of each other count as started together: their earlier actions are not ordered.
const TOGETHER: Cycles = Cycles::new(10_000_000);

/// The most cycles from the test of a cell to the store that takes it.
const CLAIM_TIME: Cycles = Cycles::new(18_000);

/// The latest access of each context that a context has seen.
type VectorClock = [u32; CONTEXTS];

/// Adds the knowledge of `other` to `clock`.
fn join(clock: &mut VectorClock, other: &VectorClock) {
    for (own, other) in clock.iter_mut().zip(other) {
        *own = (*own).max(*other);
    }
}

/// The place of a context in clocks.
fn index(thread: Option<ThreadId>) -> usize {
    thread.map_or(0, |thread| usize::from(thread.get()))
}

/// The context at a place in clocks.
fn context(index: usize) -> Option<ThreadId> {
    ThreadId::new(i32::try_from(index).unwrap_or(0))
}

/// The clock of a context, and its locks.
#[derive(Clone, Debug, Default)]
struct Track {
    clock: VectorClock,
    began: Cycles,
    /// The locks that it holds, and where it took them; the same as a set.
    held: Vec<(u32, CodeAddr)>,
    locks: LockSet,
    /// The knowledge of the context that started it.
    starter: VectorClock,
    /// The request that it has read and not yet cleared: the cell, the context that posted it, and that context's clock
    /// at the time.
    order: Option<(u32, usize, u32)>,
    /// Parameters that were stored after such an order.
    suspects: Vec<Suspect>,
    /// The cells that it reads together, and whether another context changes any of them.
    reading: JointReads,
    reads_records: bool,
    /// The cell that it loaded last, with the time; and the cell that it stored last.
    last_load: Option<(u32, Cycles)>,
    last_store: Option<u32>,
    /// The place where it paused itself, and the place where another resumed it, after which cell.
    paused: Option<PausedThread>,
    resumed: Option<ResumeCall>,
}

/// A resource that exists once on the board; its second user takes it from the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SharedThing {
    /// The part of the board that executes paths.
    CoordinateSystem,
    /// The part of the board that records axes.
    Gather,
    /// The word of 16 outputs of Kanalog.
    Relays(i32),
}

/// A parameter that was stored after the request to which it belongs.
#[derive(Clone, Debug)]
struct Suspect {
    cell: u32,
    stored_at: CodeAddr,
    posted_at: CodeAddr,
}

/// An access with which later ones are compared.
#[derive(Clone, Copy, Debug)]
struct AccessMark {
    at: CodeAddr,
    epoch: u32,
    locks: LockSet,
}

/// The accesses of all contexts, as far as rules need them.
#[derive(Clone, Debug)]
pub(crate) struct Races {
    tracks: [Track; CONTEXTS],
    cells: Cells,
    locks: BTreeMap<u32, Lock>,
    orders: Orders,
    /// The last uses of resources that exist once on the board.
    things: BTreeMap<SharedThing, [Option<AccessMark>; CONTEXTS]>,
    reports: Reports,
    /// The number of stores so far that changed a cell.
    changes: u64,
    /// True if the order of accesses has changed since the last query.
    is_reordered: bool,
    /// The named objects of the programs that are loaded.
    objects: [Arc<[NamedObject]>; ThreadId::MAX as usize],
}

impl Default for Races {
    fn default() -> Self {
        let mut tracks: [Track; CONTEXTS] = Default::default();
        // The call-back has no start event.
        tracks[0].clock[0] = 1;
        Self {
            tracks,
            cells: Cells::default(),
            locks: BTreeMap::new(),
            orders: Orders::new(),
            things: BTreeMap::new(),
            reports: Reports::default(),
            changes: 0,
            is_reordered: false,
            objects: std::array::from_fn(|_| Arc::from([])),
        }
    }
}

/// The context of an access, its code address and its time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Actor {
    pub(crate) thread: Option<ThreadId>,
    pub(crate) at: CodeAddr,
    pub(crate) now: Cycles,
}

impl Races {
    /// Notes the beginning of a thread: the actions of threads that have ended, or that began long before, are ordered
    /// before it.
    pub(crate) fn begin_thread(&mut self, thread: ThreadId, threads: &Threads, now: Cycles) {
        let own = index(Some(thread));
        let mut clock = self.tracks[own].clock;
        join(&mut clock, &self.tracks[own].starter);
        for (other, track) in self.tracks.iter_mut().enumerate() {
            let is_active = context(other).is_some_and(|other| threads.state(other).is_active());
            if !is_active || now - track.began > TOGETHER {
                join(&mut clock, &track.clock);
                track.clock[other] += 1;
            }
        }
        let track = &mut self.tracks[own];
        track.clock = clock;
        track.clock[own] += 1;
        track.began = now;
        track.order = None;
        track.suspects.clear();
        track.reading = JointReads::default();
    }

    /// A program with these named objects is loaded.
    pub(crate) fn load(&mut self, thread: ThreadId, objects: Arc<[NamedObject]>) {
        self.objects[thread.index()] = objects;
    }

    /// A thread starts another.
    pub(crate) fn record_start(&mut self, actor: Actor, started: ThreadId, threads: &Threads, out: &mut Out) {
        let has_begun = !matches!(threads.state(started), ThreadState::Active(Progress::Fresh));
        if actor.thread != Some(started) && threads.state(started).is_active() && has_begun {
            self.report(out, actor, actor.at, Message::ThreadRestarted { thread: started });
        }
        let own = index(actor.thread);
        let clock = self.tracks[own].clock;
        self.tracks[index(Some(started))].starter = clock;
        self.tracks[own].clock[own] += 1;
        self.is_reordered = true;
    }

    /// Processes an access by a program; rules and names use addresses of the tables.
    pub(crate) fn record_access(
        &mut self,
        access: &SharedAccess<'_>,
        memory: &GuestMemory,
        out: &mut Out,
    ) -> RepeatPolicy {
        let actor = Actor { thread: access.thread, at: access.at, now: access.now };
        let is_block = access.size > 8;
        let (size, count) = if !is_block { (access.size, 1) } else { (4, access.size / 4) };
        let address = memory.table_of(access.address).get();
        if access.is_store {
            self.settle(index(actor.thread), out);
        } else if is_block {
            self.copies(actor, (address, count), out);
        }
        for address in (0..count).map(|number| address + 4 * number) {
            let value = match is_block {
                true => memory.peek::<u32>(memory.place_of(GuestAddr::new(address))).into(),
                false => access.value,
            };
            if access.is_store {
                self.record_store(actor, (address, size), value, access.made_of, out);
                self.sets_call_back(actor, address, value);
                continue;
            }
            if !access.made_of.is_empty() {
                self.reads_together(actor, (address, size), access.made_of, out);
            }
            self.record_load(actor, (address, size), value, out);
        }
        if is_block || self.may_tell_more(access, address) {
            RepeatPolicy::Reported
        } else {
            RepeatPolicy::Redundant
        }
    }

    /// Returns whether repeating an access in the same slice can give new information: values that belong together are
    /// compared load by load, and the stores of their reader show which of them it has finished using.
    fn may_tell_more(&mut self, access: &SharedAccess<'_>, address: u32) -> bool {
        let own = index(access.thread);
        let Some(cell) = self.cells.get(address) else { return false };
        let track = &mut self.tracks[own];
        if access.is_store {
            return track.reads_records && cell.is_loaded_by_another(own);
        }
        let is_joint =
            !access.made_of.is_empty() && cell.last_change().is_some_and(|change| change.by != own);
        track.reads_records |= is_joint;
        is_joint
    }

    /// Returns whether a call or an access since the last query has changed the order of accesses.
    pub(crate) const fn take_ordering(&mut self) -> bool {
        mem::replace(&mut self.is_reordered, false)
    }

    /// Notes a store by a context: if it sets the call-back, the call-back gets the context's knowledge; if it removes
    /// the call-back, the context gets the call-back's.
    fn sets_call_back(&mut self, actor: Actor, address: u32, value: u64) {
        if address != USER_CALL_BACK.address().get() {
            return;
        }
        let own = index(actor.thread);
        let (clock, ended) = (self.tracks[own].clock, self.tracks[0].clock);
        if value == 0 {
            join(&mut self.tracks[own].clock, &ended);
        } else {
            join(&mut self.tracks[0].clock, &clock);
            self.tracks[own].clock[own] += 1;
        }
        self.tracks[0].clock[0] += 1;
        self.is_reordered = true;
    }

    /// A function of the firmware changes a word in one step.
    pub(crate) fn changed_at_once(&mut self, actor: Actor, place: GuestAddr, value: i32, out: &mut Out) {
        self.record_store(actor, (place.get(), 4), u64::from(value.cast_unsigned()), &[], out);
    }

    /// A call switches an output of Kanalog, which the firmware does by load and store of a word for 16 of them.
    pub(crate) fn record_output_switch(&mut self, actor: Actor, bit: i32, out: &mut Out) {
        if !(144..=167).contains(&bit) {
            return;
        }
        self.uses(actor, SharedThing::Relays((bit - 144) / 16), out);
    }

    /// Notes that a call uses a resource that exists once on the board.
    pub(crate) fn uses(&mut self, actor: Actor, thing: SharedThing, out: &mut Out) {
        let own = index(actor.thread);
        let (clock, mark) = (self.tracks[own].clock, self.mark(actor));
        let marks = self.things.entry(thing).or_default();
        marks[own] = Some(mark);
        let marks = marks.iter().enumerate().filter_map(|(other, mark)| Some((other, (*mark)?)));
        let conflict = find_conflict(marks, own, &clock, mark.locks);
        if let Some((other, at)) = conflict {
            let other = OtherPlace { thread: context(other), at };
            let message = match thing {
                SharedThing::CoordinateSystem => Message::RaceShared { other, what: "the coordinate system" },
                SharedThing::Gather => Message::RaceShared { other, what: "the gather buffer" },
                SharedThing::Relays(_) => Message::RaceRelays { other },
            };
            self.report(out, actor, at, message);
        }
    }

    /// The run is over.
    pub(crate) fn finish(&mut self, threads: &Threads, now: Cycles, out: &mut Out) {
        for own in 0..CONTEXTS {
            self.settle(own, out);
        }
        self.reports.flush(out);
        self.read_early(now, out);
        for thread in ThreadId::all().filter(|thread| !threads.state(*thread).is_active()) {
            for (lock, at) in self.tracks[index(Some(thread))].held.clone() {
                if self.locks.get(&lock).is_some_and(|lock| lock.is_mutex) {
                    let actor = Actor { thread: Some(thread), at, now };
                    let lock = self.name_of(lock, 4);
                    self.report(out, actor, at, Message::LockKept { lock });
                }
            }
        }
    }

    /// A mark of the context's current access, for comparison with later ones.
    fn mark(&self, actor: Actor) -> AccessMark {
        let own = index(actor.thread);
        let track = &self.tracks[own];
        AccessMark { at: actor.at, epoch: track.clock[own], locks: track.locks }
    }

    /// Returns the name in programs for the memory at an address, their own data included.
    fn name_of(&self, address: u32, size: u32) -> String {
        let mut objects = self.objects.iter().flat_map(|objects| objects.iter());
        let own = objects.find(|object| address.wrapping_sub(object.start) < object.size);
        own.map_or_else(
            || cell_name(GuestAddr::new(address), size),
            |object| match address - object.start {
                0 => object.name.clone(),
                offset => format!("{} + {offset}", object.name),
            },
        )
    }
}

/// The first mark of another context that is not ordered before the knowledge in `clock` and shares no lock with
/// `locks`.
fn find_conflict(
    mut marks: impl Iterator<Item = (usize, AccessMark)>,
    own: usize,
    clock: &VectorClock,
    locks: LockSet,
) -> Option<(usize, CodeAddr)> {
    let is_conflict = |(other, mark): &(usize, AccessMark)| {
        *other != own && mark.epoch > clock[*other] && !mark.locks.intersects(locks)
    };
    marks.find(is_conflict).map(|(other, mark)| (other, mark.at))
}

/// Returns whether an address is in an axis structure, of which the servo reads the newest values.
fn is_of_axis(address: u32) -> bool {
    variable_around(GuestAddr::new(address)).is_some_and(|variable| variable.address == CHAN.address())
}

/// The code that a program sends to the PC.
fn is_request(address: u32) -> bool {
    address == PERSIST.field(Persist::USER_DATA).element(100).address().get()
}

#[cfg(test)]
mod tests;
