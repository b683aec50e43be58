//! Accesses of the same cell by several threads.

use std::array;

use kmotiondef::{CodeAddr, Cycles};

use super::{
    AccessMark, Actor, CLAIM_TIME, CONTEXTS, Races, Suspect, VectorClock, conflict, context, index,
    is_of_axis, is_request, join, name_of,
};
use crate::out::{Message, OtherPlace, Out};

/// What threads have done with a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    uses: [Use; CONTEXTS],
    writer: Option<Writer>,
    /// How often it was stored to.
    stores: u32,
}

/// What a context has done with a cell.
#[derive(Clone, Debug, Default)]
struct Use {
    load: Option<Load>,
    /// Its last store of what it had loaded from the cell before.
    update: Option<AccessMark>,
    /// Its last store after it had found 0 there.
    claim: Option<(AccessMark, u64)>,
    /// Whether it has stored 0 after such a store, and at all.
    releases: bool,
    clears: bool,
    /// Its last request to the PC.
    request: Option<AccessMark>,
    /// Its last load of eight bytes.
    wide_load: Option<AccessMark>,
    stores: u32,
    /// Stores of anything but 0.
    posts: u32,
    stored: Option<Cycles>,
    /// Whether it has loaded the cell while it had no order to execute.
    is_loaded_at_leisure: bool,
}

#[derive(Clone, Debug)]
struct Load {
    at: CodeAddr,
    /// What the context knew before, without what it has read from the cell since its last store.
    before: VectorClock,
    value: u64,
    now: Cycles,
    /// The store whose value it read.
    store: u32,
}

/// The last store to a cell.
#[derive(Clone, Debug)]
struct Writer {
    context: usize,
    at: CodeAddr,
    epoch: u32,
    clock: VectorClock,
    now: Cycles,
    value: u64,
    /// Whether it has changed both words of eight bytes.
    tears: bool,
    locks: Vec<u32>,
}

impl Races {
    /// A context has loaded `size` bytes.
    pub(super) fn loaded(&mut self, actor: Actor, (address, size): (u32, u32), value: u64, out: &mut Out) {
        let own = index(actor.thread);
        let (clock, mark, order) = (self.tracks[own].clock, self.mark(actor), self.tracks[own].order);
        let cell = self.cells.entry(address).or_default();
        let before = match &cell.uses[own].load {
            Some(load) if load.store == cell.stores => load.before,
            _ => clock,
        };
        let load = Load { at: actor.at, before, value, now: actor.now, store: cell.stores };
        cell.uses[own].load = Some(load);
        cell.uses[own].is_loaded_at_leisure |= order.is_none();
        if size == 8 {
            cell.uses[own].wide_load = Some(mark.clone());
        }
        let Some(writer) = cell.writer.clone().filter(|writer| writer.context != own) else { return };
        let (stores, posts) = (cell.uses[writer.context].stores, cell.uses[writer.context].posts);
        let is_unordered = writer.epoch > before[writer.context];
        let shares_lock = writer.locks.iter().any(|lock| mark.locks.contains(lock));
        join(&mut self.tracks[own].clock, &writer.clock);
        if size == 8 && writer.tears && is_unordered && !shares_lock && stores > 1 && !is_of_axis(address) {
            let other = OtherPlace { thread: context(writer.context), at: writer.at };
            let cell = name_of(address, size);
            self.report(out, actor, writer.at, Message::RaceTorn { other, cell });
        }
        if size != 4 {
            return;
        }
        if let Some((posted, poster, epoch)) = order.filter(|(posted, ..)| *posted != address) {
            let posts = self.cells.get(&posted).map_or(0, |cell| cell.uses[poster].posts);
            let is_late = writer.context == poster && writer.epoch > epoch && is_unordered;
            if is_late && stores <= posts {
                let posted_at = self.cells.get(&posted).and_then(|cell| cell.writer.as_ref());
                let posted_at = posted_at.map_or(actor.at, |writer| writer.at);
                let suspect = Suspect { cell: address, stored_at: writer.at, posted_at };
                self.tracks[own].suspects.push(suspect);
            }
        }
        // A status that is never cleared is no order.
        let clears = |address| self.cells.get(&address).is_some_and(|cell| cell.uses[own].clears);
        let is_better = order.is_none_or(|(posted, ..)| !clears(posted) && clears(address));
        if posts > 0 && value != 0 && is_better {
            self.tracks[own].order = Some((address, writer.context, writer.epoch));
        }
    }

    /// A context has stored `size` bytes; `made_of` are the loads that the value is made of.
    pub(super) fn stored(
        &mut self,
        actor: Actor,
        (address, size): (u32, u32),
        value: u64,
        made_of: &[CodeAddr],
        out: &mut Out,
    ) {
        let own = index(actor.thread);
        let (clock, mark) = (self.tracks[own].clock, self.mark(actor));
        let cell = self.cells.entry(address).or_default();
        let used = &cell.uses[own];
        let source = used.load.clone().filter(|load| made_of.contains(&load.at));
        let claimed = used.load.clone().filter(|load| {
            let is_fresh = used.stored.is_none_or(|stored| stored < load.now);
            let is_soon = actor.now - load.now < CLAIM_TIME;
            source.is_none() && value != 0 && size == 4 && load.value == 0 && is_fresh && is_soon
        });
        let writer = cell.writer.clone();
        let found = [
            cell.update_conflict(own, source.as_ref(), &clock, &mark, actor.now, (address, size)),
            claimed.as_ref().and_then(|load| cell.claim_conflict(own, load, &mark, value, address)),
            cell.request_conflict(own, &clock, &mark, (address, value)),
            cell.torn_conflict(own, &clock, &mark, (address, size), value),
        ];
        let used = &mut cell.uses[own];
        used.stores += 1;
        used.stored = Some(actor.now);
        used.posts += u32::from(value != 0);
        if source.is_some() {
            used.update = Some(mark.clone());
        }
        if claimed.is_some() {
            used.claim = Some((mark.clone(), value));
        }
        used.releases |= value == 0 && used.claim.is_some();
        used.clears |= value == 0;
        if is_request(address) && value != 0 {
            used.request = Some(mark.clone());
        }
        cell.stores += 1;
        let old = writer.map_or(0, |writer| writer.value);
        let tears = size == 8 && (old ^ value) >> 32 != 0 && (old ^ value) as u32 != 0;
        let (context, epoch) = (own, clock[own]);
        let AccessMark { at, locks, .. } = mark;
        cell.writer = Some(Writer { context, at, epoch, clock, now: actor.now, value, tears, locks });
        self.tracks[own].clock[own] += 1;
        for (at, message) in found.into_iter().flatten() {
            self.report(out, actor, at, message);
        }
        if value == 0 {
            self.order_done(actor, address, out);
            self.freed(actor, address);
        }
    }

    /// A context has cleared a cell: if that was its order, what was stored too late for it is reported.
    fn order_done(&mut self, actor: Actor, address: u32, out: &mut Out) {
        let own = index(actor.thread);
        let Some((_, poster, _)) = self.tracks[own].order.take_if(|(posted, ..)| *posted == address) else {
            return;
        };
        for suspect in std::mem::take(&mut self.tracks[own].suspects) {
            let Suspect { cell, stored_at, posted_at } = suspect;
            let is_parameter = self.cells.get(&cell).is_some_and(|cell| !cell.uses[own].is_loaded_at_leisure);
            if is_parameter {
                let poster = Actor { thread: context(poster), at: stored_at, now: actor.now };
                let (cell, order) = (name_of(cell, 4), name_of(address, 4));
                let other = OtherPlace { thread: poster.thread, at: posted_at };
                self.report(out, poster, posted_at, Message::OrderEarly { cell, order, other });
            }
        }
    }
}

/// The other place of a conflict, and what there is to say.
type Finding = Option<(CodeAddr, Message)>;

impl Cell {
    /// A store that another context's load and store of the same cell can wipe out, or that can wipe one out.
    fn update_conflict(
        &self,
        own: usize,
        source: Option<&Load>,
        clock: &VectorClock,
        mark: &AccessMark,
        now: Cycles,
        (address, size): (u32, u32),
    ) -> Finding {
        // What the call-back does, no thread interrupts.
        let updates: [Option<AccessMark>; CONTEXTS] = array::from_fn(|other| match (other, source) {
            (0, None) => None,
            _ => self.uses[other].update.clone(),
        });
        let clock = source.map_or(clock, |load| &load.before);
        let (other, at) = conflict(updates.iter().enumerate(), own, clock, &mark.locks)?;
        let other = OtherPlace { thread: context(other), at };
        let cell = name_of(address, size);
        let Some(load) = source else { return Some((at, Message::RaceStore { other, cell })) };
        let lost = self.writer.as_ref().filter(|writer| writer.context != own && writer.now > load.now);
        let effect = match lost {
            Some(_) => format!("an update was lost at {:.6} s", now.get() as f64 / 200e6),
            None => "an update can be lost".to_owned(),
        };
        Some((at, Message::RaceUpdate { other, cell, effect }))
    }

    /// A store to a cell that was free, which another context takes in the same way.
    fn claim_conflict(
        &self,
        own: usize,
        load: &Load,
        mark: &AccessMark,
        value: u64,
        address: u32,
    ) -> Finding {
        let claims: [Option<AccessMark>; CONTEXTS] = array::from_fn(|other| {
            let used = &self.uses[other];
            let (claim, taken) = used.claim.as_ref()?;
            let differs = *taken != value || used.releases || self.uses[own].releases;
            differs.then(|| claim.clone())
        });
        let (other, at) = conflict(claims.iter().enumerate(), own, &load.before, &mark.locks)?;
        let other = OtherPlace { thread: context(other), at };
        Some((at, Message::RaceClaim { other, cell: name_of(address, 4) }))
    }

    /// A request to the PC that can overwrite that of another context.
    fn request_conflict(
        &self,
        own: usize,
        clock: &VectorClock,
        mark: &AccessMark,
        (address, value): (u32, u64),
    ) -> Finding {
        if !is_request(address) || value == 0 {
            return None;
        }
        let requests: [Option<AccessMark>; CONTEXTS] =
            array::from_fn(|other| self.uses[other].request.clone());
        let (other, at) = conflict(requests.iter().enumerate(), own, clock, &mark.locks)?;
        let other = OtherPlace { thread: context(other), at };
        Some((at, Message::RaceRequest { other, cell: name_of(address, 4) }))
    }

    /// A store of eight bytes that another context loads.
    fn torn_conflict(
        &self,
        own: usize,
        clock: &VectorClock,
        mark: &AccessMark,
        (address, size): (u32, u32),
        value: u64,
    ) -> Finding {
        let writer = self.writer.as_ref()?;
        let changed = writer.value ^ value;
        let tears = size == 8 && changed >> 32 != 0 && changed as u32 != 0;
        if !tears || self.uses[own].stores < 2 || is_of_axis(address) {
            return None;
        }
        let loads: [Option<AccessMark>; CONTEXTS] =
            array::from_fn(|other| self.uses[other].wide_load.clone());
        let (other, at) = conflict(loads.iter().enumerate(), own, clock, &mark.locks)?;
        let other = OtherPlace { thread: context(other), at };
        Some((at, Message::RaceTornStore { other, cell: name_of(address, size) }))
    }
}
