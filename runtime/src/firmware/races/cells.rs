//! Accesses of the same cell by several threads.

use kmotiondef::{CodeAddr, Cycles};

use super::conflicts::{Conflict, ConflictKind, Store};
use super::locks::LockSet;
use super::reports::lost_at;
use super::table::Uses;
use super::{AccessMark, Actor, Races, Suspect, VectorClock, context, index, is_of_axis, is_request, join};
use crate::out::{Message, OtherPlace, Out};

/// The accesses of threads to a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    pub(super) uses: Uses,
    pub(super) writer: Option<Writer>,
    /// The number of stores.
    stores: u32,
    /// Its last change, and the number of stores that changed it.
    change: Option<CellChange>,
    /// A load before its first store, of which the storing context had no knowledge.
    early: Option<EarlyLoad>,
}

/// The last store that changed a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellChange {
    /// The context.
    pub(super) by: usize,
    /// The instruction.
    pub(super) at: CodeAddr,
    /// The number of the change, of all changes of all cells.
    pub(super) number: u64,
}

/// A cell that was loaded before its first store.
#[derive(Clone, Copy, Debug)]
struct EarlyLoad {
    actor: Actor,
    stored: CellChange,
}

/// The accesses of a context to a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Use {
    /// Its last load, and the last loads by other instructions.
    pub(super) load: Option<Load>,
    other_loads: Vec<Load>,
    /// Its last store of a value that it had loaded from the cell before.
    pub(super) update: Option<AccessMark>,
    /// Its last store after it had found 0 there.
    pub(super) claim: Option<(AccessMark, u64)>,
    /// True if it has stored 0 after such a store, and at all.
    pub(super) releases: bool,
    pub(super) clears: bool,
    /// Its last request to the PC.
    pub(super) request: Option<AccessMark>,
    /// Its last load of eight bytes.
    pub(super) wide_load: Option<AccessMark>,
    pub(super) stores: u32,
    /// Stores of values other than 0.
    pub(super) posts: u32,
    pub(super) stored: Option<Cycles>,
    /// True if it has loaded the cell while it had no order to execute.
    pub(super) is_loaded_at_leisure: bool,
    /// The value that it had loaded before its last store of another value.
    pub(super) replaced: Option<u64>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Load {
    pub(super) at: CodeAddr,
    /// The context's knowledge before the load, without the values read from the cell since its last store.
    pub(super) before: VectorClock,
    /// Its knowledge before it began to load only this cell.
    pub(super) spun: VectorClock,
    pub(super) value: u64,
    pub(super) now: Cycles,
    /// The store whose value it read.
    pub(super) store: u32,
    /// Its number among the loads of the context, from 1.
    ordinal: u32,
}

/// The last store to a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Writer {
    pub(super) context: usize,
    pub(super) at: CodeAddr,
    pub(super) epoch: u32,
    pub(super) clock: VectorClock,
    pub(super) now: Cycles,
    pub(super) value: u64,
    /// True if it has changed both words of eight bytes.
    pub(super) tears: bool,
    pub(super) locks: LockSet,
}

/// The number of instructions whose last loads of a cell are remembered, in addition to the last load.
const MOST_LOADS: usize = 4;

impl Races {
    /// A context has loaded `size` bytes.
    pub(super) fn record_load(
        &mut self,
        actor: Actor,
        (address, size): (u32, u32),
        value: u64,
        out: &mut Out,
    ) {
        let own = index(actor.thread);
        let (clock, mark, order) = (self.tracks[own].clock, self.mark(actor), self.tracks[own].order);
        let last = self.tracks[own].last_load.replace((address, actor.now));
        let Some(cell) = self.cells.cell_mut(address) else { return };
        let before = match &cell.uses[own].load {
            Some(load) if load.store == cell.stores => load.before,
            _ => clock,
        };
        let is_spinning = last.is_some_and(|(last, _)| last == address);
        let spun = match cell.uses[own].load_before_store() {
            Some(load) if is_spinning => load.spun,
            _ => before,
        };
        let ordinal = cell.uses[own].load.as_ref().map_or(1, |load| load.ordinal.saturating_add(1));
        let load = Load { at: actor.at, before, spun, value, now: actor.now, store: cell.stores, ordinal };
        cell.uses[own].note_load(load);
        cell.early.take_if(|early| index(early.actor.thread) == own);
        cell.uses[own].is_loaded_at_leisure |= order.is_none();
        if size == 8 {
            cell.uses[own].wide_load = Some(mark);
        }
        let Some(writer) = cell.writer.filter(|writer| writer.context != own) else { return };
        let (stores, posts) = (cell.uses[writer.context].stores, cell.uses[writer.context].posts);
        let is_unordered = writer.epoch > before[writer.context];
        let shares_lock = writer.locks.intersects(mark.locks);
        join(&mut self.tracks[own].clock, &writer.clock);
        if size == 8 && writer.tears && is_unordered && !shares_lock && stores > 1 && !is_of_axis(address) {
            let other = OtherPlace { thread: context(writer.context), at: writer.at };
            if !self.reports.is_reported(actor.at, writer.at) {
                let cell = self.name_of(address, size);
                self.report(out, actor, writer.at, Message::RaceTorn { other, cell });
            }
        }
        if size < 4 {
            return;
        }
        if let Some((posted, poster, epoch)) = order.filter(|(posted, ..)| *posted != address) {
            let posts = self.cells.get(posted).map_or(0, |cell| cell.uses[poster].posts);
            let is_late = writer.context == poster && writer.epoch > epoch && is_unordered;
            if is_late && stores <= posts {
                let posted_at = self.cells.get(posted).and_then(|cell| cell.writer.as_ref());
                let posted_at = posted_at.map_or(actor.at, |writer| writer.at);
                let suspect = Suspect { cell: address, stored_at: writer.at, posted_at };
                self.tracks[own].suspects.push(suspect);
            }
        }
        // A status that is never cleared is no order.
        let clears = |address| self.cells.get(address).is_some_and(|cell| cell.uses[own].clears);
        let is_better = order.is_none_or(|(posted, ..)| !clears(posted) && clears(address));
        if size == 4 && posts > 0 && value != 0 && is_better {
            self.tracks[own].order = Some((address, writer.context, writer.epoch));
        }
    }

    /// Notes that a context has stored `size` bytes; `made_of` are the loads on which the value depends.
    pub(super) fn record_store(
        &mut self,
        actor: Actor,
        (address, size): (u32, u32),
        value: u64,
        made_of: &[CodeAddr],
        out: &mut Out,
    ) {
        self.reports.check(actor.now, out);
        let own = index(actor.thread);
        let (clock, mark) = (self.tracks[own].clock, self.mark(actor));
        self.tracks[own].last_store = Some(address);
        let Some(cell) = self.cells.cell_mut(address) else { return };
        let store = Store { own, clock, mark: &mark, value, size, address };
        let source = cell.uses[own].source(made_of);
        let claimed = cell.claiming_load(&store, source.as_ref(), actor.now);
        let conflicts = [
            cell.update_conflict(&store, source.as_ref()),
            claimed.as_ref().and_then(|load| cell.claim_conflict(&store, load)),
            cell.request_conflict(&store),
            cell.torn_conflict(&store),
        ];
        let lost = cell.lost_update(own, source.as_ref());
        let is_change = size > 8 || cell.writer.as_ref().map_or(0, |writer| writer.value) != value;
        cell.record_store(&store, actor, source.as_ref(), claimed.is_some());
        if is_change {
            self.note_change(own, address);
            let change = CellChange { by: own, at: actor.at, number: self.changes };
            if let Some(cell) = self.cells.get_mut(address) {
                cell.note_change(change, source.is_some());
            }
        }
        self.tracks[own].clock[own] += 1;
        for conflict in conflicts.into_iter().flatten() {
            self.report_conflict(actor, (address, size), conflict, out);
        }
        if let Some((conflict, thread)) = lost {
            self.report_loss(actor, (address, size), conflict, thread, out);
        }
        if value == 0 {
            self.order_done(actor, address, out);
            self.free_lock(actor, address);
        }
    }

    /// Reports a possible conflict.
    fn report_conflict(&mut self, actor: Actor, (address, size): (u32, u32), found: Conflict, out: &mut Out) {
        let Conflict { at, by, kind } = found;
        if self.reports.is_in_conflict(actor.at, at) {
            return;
        }
        if let Some((actor, other)) = with_call_back(actor, OtherPlace { thread: context(by), at }) {
            let (effect, cell) = ("an update can be lost".to_owned(), self.name_of(address, size));
            return self.report_later(actor, other.at, Message::RaceCallBack { other, cell, effect });
        }
        let other = OtherPlace { thread: context(by), at };
        let cell = self.name_of(address, size);
        match kind {
            ConflictKind::Update => {
                let effect = "an update can be lost".to_owned();
                self.report_later(actor, at, Message::RaceUpdate { other, cell, effect });
            }
            ConflictKind::Store => {
                let effect = "a store in between is wiped out".to_owned();
                self.report_later(actor, at, Message::RaceStore { other, cell, effect });
            }
            ConflictKind::Claim => self.report(out, actor, at, Message::RaceClaim { other, cell }),
            ConflictKind::Request => self.report(out, actor, at, Message::RaceRequest { other, cell }),
            ConflictKind::Torn => self.report(out, actor, at, Message::RaceTornStore { other, cell }),
        }
    }

    /// Reports that a store has wiped out another one.
    fn report_loss(
        &mut self,
        actor: Actor,
        (address, size): (u32, u32),
        Conflict { at, by, kind }: Conflict,
        when: Cycles,
        out: &mut Out,
    ) {
        if self.reports.is_reported(actor.at, at) || !self.reports.is_in_conflict(actor.at, at) {
            return;
        }
        let cell = self.name_of(address, size);
        if let Some((actor, other)) = with_call_back(actor, OtherPlace { thread: context(by), at }) {
            let effect = lost_at("an update was lost", actor.now);
            return self.report(out, actor, other.at, Message::RaceCallBack { other, cell, effect });
        }
        if kind == ConflictKind::Update {
            let (other, effect) =
                (OtherPlace { thread: context(by), at }, lost_at("an update was lost", actor.now));
            return self.report(out, actor, at, Message::RaceUpdate { other, cell, effect });
        }
        let (other, effect) =
            (OtherPlace { thread: actor.thread, at: actor.at }, lost_at("a store was wiped out", actor.now));
        let storing = Actor { thread: context(by), at, now: when };
        self.report(out, storing, actor.at, Message::RaceStore { other, cell, effect });
    }

    /// Reports cells that were loaded once, before their first store, without anything that made the load wait for the
    /// store.
    pub(super) fn read_early(&mut self, now: Cycles, out: &mut Out) {
        let early: Vec<_> =
            self.cells.iter().filter_map(|(address, cell)| Some((address, cell.early?))).collect();
        for (address, EarlyLoad { actor, stored }) in early {
            let other = OtherPlace { thread: context(stored.by), at: stored.at };
            let cell = self.name_of(address, 4);
            self.report(out, Actor { now, ..actor }, stored.at, Message::ReadEarly { other, cell });
        }
    }

    /// Notes that a context has cleared a cell; if that cell held the request it was executing, parameters that were
    /// stored too late are reported.
    fn order_done(&mut self, actor: Actor, address: u32, out: &mut Out) {
        let own = index(actor.thread);
        let Some((_, poster, _)) = self.tracks[own].order.take_if(|(posted, ..)| *posted == address) else {
            return;
        };
        for suspect in std::mem::take(&mut self.tracks[own].suspects) {
            let Suspect { cell, stored_at, posted_at } = suspect;
            let is_parameter = self.cells.get(cell).is_some_and(|cell| !cell.uses[own].is_loaded_at_leisure);
            if is_parameter {
                let poster = Actor { thread: context(poster), at: stored_at, now: actor.now };
                let (cell, order) = (self.name_of(cell, 4), self.name_of(address, 4));
                let other = OtherPlace { thread: poster.thread, at: posted_at };
                self.report(out, poster, posted_at, Message::OrderEarly { cell, order, other });
            }
        }
    }
}

/// The thread and the call-back of two places, if one is the call-back's.
fn with_call_back(actor: Actor, other: OtherPlace) -> Option<(Actor, OtherPlace)> {
    match (actor.thread, other.thread) {
        (Some(_), None) => Some((actor, other)),
        (None, Some(_)) => {
            let call_back = OtherPlace { thread: None, at: actor.at };
            Some((Actor { thread: other.thread, at: other.at, now: actor.now }, call_back))
        }
        _ => None,
    }
}

impl Cell {
    /// Its last store that changed it.
    pub(super) fn last_change(&self) -> Option<CellChange> {
        self.change
    }

    /// Returns whether another context than `own` has loaded it.
    pub(super) fn is_loaded_by_another(&self, own: usize) -> bool {
        self.uses.iter().any(|(other, used)| other != own && used.load.is_some())
    }

    /// Returns whether a context changes it by a load and a store.
    pub(super) fn is_updated_by(&self, context: usize) -> bool {
        self.uses[context].update.is_some()
    }

    /// Its last change, if it was made by another context, was not its first store, and is not ordered before the
    /// knowledge in `clock`.
    pub(super) fn unordered_writer(
        &self,
        own: usize,
        clock: &VectorClock,
        locks: LockSet,
    ) -> Option<CellChange> {
        let writer = self.writer.as_ref().filter(|writer| writer.context != own && self.stores > 1)?;
        let is_unordered = writer.epoch > clock[writer.context];
        let shares_lock = writer.locks.intersects(locks);
        self.change.filter(|_| is_unordered && !shares_lock)
    }

    /// The clock of `writer` at its last store, if it has stored often and the store is not ordered before the
    /// knowledge in `clock`.
    pub(super) fn unordered_epoch(&self, writer: usize, clock: &VectorClock, locks: LockSet) -> Option<u32> {
        let last = self.writer.as_ref().filter(|last| last.context == writer && self.stores > 2)?;
        let is_unordered = last.epoch > clock[writer];
        let shares_lock = last.locks.intersects(locks);
        (is_unordered && !shares_lock).then_some(last.epoch)
    }

    /// Takes up a store.
    fn record_store(&mut self, store: &Store<'_>, actor: Actor, source: Option<&Load>, is_claim: bool) {
        let Store { own, clock, mark, value, size, address } = *store;
        let used = &mut self.uses[own];
        used.stores += 1;
        if source.is_none() {
            used.replaced = used.load_before_store().map(|load| load.value).or(used.replaced);
        }
        used.stored = Some(actor.now);
        used.posts += u32::from(value != 0);
        if source.is_some() {
            used.update = Some(*mark);
        }
        if is_claim {
            used.claim = Some((*mark, value));
        }
        used.releases |= value == 0 && used.claim.is_some();
        used.clears |= value == 0;
        if is_request(address) && value != 0 {
            used.request = Some(*mark);
        }
        self.stores += 1;
        let old = self.writer.as_ref().map_or(0, |writer| writer.value);
        let tears = size == 8 && (old ^ value) >> 32 != 0 && (old ^ value) as u32 != 0;
        let AccessMark { at, locks, .. } = *mark;
        let epoch = clock[own];
        self.writer = Some(Writer { context: own, at, epoch, clock, now: actor.now, value, tears, locks });
    }

    /// Takes up that the last store has changed the cell.
    fn note_change(&mut self, change: CellChange, is_update: bool) {
        if self.stores == 1 && !is_update {
            let clock = self.writer.as_ref().map(|writer| writer.clock).unwrap_or_default();
            self.early = self.early_load(change, &clock);
        }
        self.change = Some(change);
    }

    /// The only load by another context, if the first store, described by `stored`, is not ordered before it.
    fn early_load(&self, stored: CellChange, clock: &VectorClock) -> Option<EarlyLoad> {
        let others = self.uses.iter().filter(|(other, _)| *other != stored.by && *other != 0);
        let mut loads = others.filter(|(_, used)| used.stores == 0).filter_map(|(other, used)| {
            let load = used.load.as_ref().filter(|load| load.ordinal == 1)?;
            (load.before[other] > clock[other]).then_some((other, load))
        });
        loads.next().map(|(other, load)| EarlyLoad {
            actor: Actor { thread: context(other), at: load.at, now: load.now },
            stored,
        })
    }
}

impl Use {
    /// No access.
    pub(super) const NONE: Self = Self {
        load: None,
        other_loads: Vec::new(),
        update: None,
        claim: None,
        releases: false,
        clears: false,
        request: None,
        wide_load: None,
        stores: 0,
        posts: 0,
        stored: None,
        is_loaded_at_leisure: false,
        replaced: None,
    };

    /// Takes up a load.
    fn note_load(&mut self, load: Load) {
        self.other_loads.retain(|other| other.at != load.at);
        let last = self.load.replace(load).filter(|last| last.at != load.at);
        if let Some(last) = last {
            self.other_loads.truncate(MOST_LOADS - 1);
            self.other_loads.insert(0, last);
        }
    }

    /// The last one of the loads on which a stored value depends.
    fn source(&self, made_of: &[CodeAddr]) -> Option<Load> {
        self.load.iter().chain(&self.other_loads).find(|load| made_of.contains(&load.at)).copied()
    }

    /// The load after which its next store comes, if it has loaded since its last store.
    pub(super) fn load_before_store(&self) -> Option<&Load> {
        self.load.as_ref().filter(|load| self.stored.is_none_or(|stored| stored < load.now))
    }
}
