//! Accesses of the same cell that can go wrong together.

use kmotiondef::{CodeAddr, Cycles};

use super::cells::{Cell, Load};
use super::{AccessMark, CLAIM_TIME, VectorClock, find_conflict, is_of_axis, is_request};

/// A store that is being processed.
#[derive(Debug)]
pub(super) struct Store<'a> {
    pub(super) own: usize,
    pub(super) clock: VectorClock,
    pub(super) mark: &'a AccessMark,
    pub(super) value: u64,
    pub(super) size: u32,
    pub(super) address: u32,
}

/// The other place of a conflict.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conflict {
    pub(super) at: CodeAddr,
    pub(super) by: usize,
    pub(super) kind: ConflictKind,
}

/// A fault that is possible between two places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConflictKind {
    /// Both change the cell by a load and a store.
    Update,
    /// One does, the other stores.
    Store,
    /// Both take the cell when it is free.
    Claim,
    /// Both send a request to the PC.
    Request,
    /// One stores eight bytes, the other loads them.
    Torn,
}

impl Cell {
    /// The load after which a store takes the cell, which was free.
    pub(super) fn claiming_load(
        &self,
        store: &Store<'_>,
        source: Option<&Load>,
        now: Cycles,
    ) -> Option<Load> {
        let used = &self.uses[store.own];
        used.load.filter(|load| {
            let is_fresh = used.stored.is_none_or(|stored| stored < load.now);
            let is_soon = now - load.now < CLAIM_TIME;
            source.is_none() && store.value != 0 && store.size == 4 && load.value == 0 && is_fresh && is_soon
        })
    }

    /// The store by another context that came between a load and the store of a value computed from it, and its time.
    pub(super) fn lost_update(&self, own: usize, source: Option<&Load>) -> Option<(Conflict, Cycles)> {
        let load = source?;
        let writer = self.writer.as_ref().filter(|writer| writer.context != own && writer.now > load.now)?;
        let is_update =
            self.uses[writer.context].update.as_ref().is_some_and(|update| update.at == writer.at);
        let kind = if is_update { ConflictKind::Update } else { ConflictKind::Store };
        Some((Conflict { at: writer.at, by: writer.context, kind }, writer.now))
    }

    /// A store that another context's load and store of the same cell can wipe out, or that can wipe one out.
    pub(super) fn update_conflict(&self, store: &Store<'_>, source: Option<&Load>) -> Option<Conflict> {
        let used = &self.uses[store.own];
        // Threads do not interrupt the call-back.
        let counts = |other: &usize| *other != 0 || source.is_some();
        let updates = self.uses.iter().filter(|(other, _)| counts(other));
        let updates = updates.filter_map(|(other, used)| Some((other, used.update?)));
        // A store that follows a load of always the same value waits for that value.
        let replaced =
            used.load_before_store().filter(|load| used.replaced.is_some_and(|last| last != load.value));
        let clock = source.or(replaced).map_or(&store.clock, |load| &load.before);
        let (by, at) = find_conflict(updates, store.own, clock, store.mark.locks)?;
        let kind = if source.is_some() { ConflictKind::Update } else { ConflictKind::Store };
        Some(Conflict { at, by, kind })
    }

    /// A store to a free cell that another context takes in the same way.
    pub(super) fn claim_conflict(&self, store: &Store<'_>, load: &Load) -> Option<Conflict> {
        let own = store.own;
        let claims = self.uses.iter().filter_map(|(other, used)| {
            let (claim, taken) = used.claim?;
            let differs = taken != store.value || used.releases || self.uses[own].releases;
            differs.then_some((other, claim))
        });
        let (by, at) = find_conflict(claims, own, &load.spun, store.mark.locks)?;
        Some(Conflict { at, by, kind: ConflictKind::Claim })
    }

    /// A request to the PC that can overwrite another context's request.
    pub(super) fn request_conflict(&self, store: &Store<'_>) -> Option<Conflict> {
        if !is_request(store.address) || store.value == 0 {
            return None;
        }
        let requests = self.uses.iter().filter_map(|(other, used)| Some((other, used.request?)));
        let (by, at) = find_conflict(requests, store.own, &store.clock, store.mark.locks)?;
        Some(Conflict { at, by, kind: ConflictKind::Request })
    }

    /// A store of eight bytes that another context loads.
    pub(super) fn torn_conflict(&self, store: &Store<'_>) -> Option<Conflict> {
        let writer = self.writer.as_ref()?;
        let changed = writer.value ^ store.value;
        let tears = store.size == 8 && changed >> 32 != 0 && changed as u32 != 0;
        if !tears || self.uses[store.own].stores < 2 || is_of_axis(store.address) {
            return None;
        }
        let loads = self.uses.iter().filter_map(|(other, used)| Some((other, used.wide_load?)));
        let (by, at) = find_conflict(loads, store.own, &store.clock, store.mark.locks)?;
        Some(Conflict { at, by, kind: ConflictKind::Torn })
    }
}
