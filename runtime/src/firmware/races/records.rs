//! Values that belong together, read while another thread changes them.
//!
//! Cells belong together if a program uses their values together: in one expression, in a sum over a list, as a list
//! and its length. They are read half changed if another context changes one cell after it was read and the other cell
//! before it was read. A reader that compares a version number before and after, and reads again if it has changed,
//! detects this itself; so a finding is reported when the reader next stores something, and dropped when it compares
//! two loads of the same cell.

use std::collections::BTreeMap;

use kmotiondef::CodeAddr;

use super::cells::{Cell, CellChange};
use super::reports::lost_at;
use super::{Actor, Races, Track, VectorClock, context, index};
use crate::out::{Message, OtherPlace, Out};

/// Loads that are remembered.
const MOST: usize = 64;

/// The most stores of a writer from one to another of a record that it stores at a time.
const RECORD_STORES: u32 = 8;

/// The number of times that two cells must be stored and read together before they count as parts of a record.
const TIMES: u32 = 2;

/// A load of a cell whose value is used together with other cells.
#[derive(Clone, Copy, Debug)]
struct Part {
    at: CodeAddr,
    address: u32,
    /// The number of changes up to the load.
    changes: u64,
    /// The context that changed the cell first since.
    changed_by: Option<usize>,
    /// The knowledge of the context before it began to read the parts.
    before: VectorClock,
    /// The context's own entry in its clock at the load.
    epoch: u32,
}

/// The cells that a context reads together.
#[derive(Clone, Debug, Default)]
pub(super) struct JointReads {
    parts: Vec<Part>,
    /// The pairs that it has read half changed, or could have.
    found: Vec<TornRead>,
    /// The number of times that it has read each pair of cells that another context changes together.
    pairs: BTreeMap<[u32; 2], u32>,
}

/// Something that was read half changed, or could have been.
#[derive(Clone, Debug)]
struct TornRead {
    actor: Actor,
    cell: u32,
    size: u32,
    other: OtherPlace,
    /// True if it was.
    is_seen: bool,
}

impl Races {
    /// Notes that a context loads a cell whose value it uses together with those of the loads `with`.
    pub(super) fn reads_together(
        &mut self,
        actor: Actor,
        (address, size): (u32, u32),
        with: &[CodeAddr],
        out: &mut Out,
    ) {
        let (own, changes) = (index(actor.thread), self.changes);
        let Track { reading, clock, .. } = &mut self.tracks[own];
        let belongs = |part: &Part| with.contains(&part.at);
        if reading.parts.iter().any(|part| part.at == actor.at && part.address == address) {
            // It starts over to read all of them.
            reading.parts.retain(|part| part.at != actor.at && !belongs(part));
        } else if reading.parts.iter().any(|part| belongs(part) && part.address == address) {
            // It compares the new values with those read before.
            reading.found.clear();
        }
        let mut parts = reading.parts.iter().copied().filter(|part| belongs(part) && part.address != address);
        let first = parts.clone().next();
        let before = first.map_or(*clock, |part| part.before);
        let change = self.cells.get(address).and_then(Cell::last_change).filter(|change| change.by != own);
        let older = change.and_then(|CellChange { by, number, .. }| {
            parts.find(|part| part.changed_by == Some(by) && number > part.changes)
        });
        if reading.parts.len() < MOST {
            reading.parts.push(Part {
                at: actor.at,
                address,
                changes,
                changed_by: None,
                before,
                epoch: clock[own],
            });
        }
        let (Some(CellChange { by, at, .. }), Some(part)) = (change, older.or(first)) else { return };
        let counts = |address: &u32| self.cells.get(*address).is_some_and(|cell| cell.is_updated_by(by));
        if self.reports.is_reported(actor.at, at) || [address, part.address].iter().all(counts) {
            return;
        }
        let is_seen = older.is_some();
        if is_seen || self.is_record(own, by, [part.address, address], &before) {
            let other = OtherPlace { thread: context(by), at };
            self.found_half(own, TornRead { actor, cell: address, size, other, is_seen }, out);
        }
    }

    /// Returns whether another context changes two cells at about the same time, every time that `own` reads both,
    /// without anything that orders the changes before the knowledge in `clock`.
    fn is_record(&mut self, own: usize, writer: usize, cells: [u32; 2], clock: &VectorClock) -> bool {
        let locks = self.tracks[own].locks;
        let epoch = |cell| self.cells.get(cell)?.unordered_epoch(writer, clock, locks);
        let [Some(one), Some(other)] = cells.map(epoch) else { return false };
        let pairs = &mut self.tracks[own].reading.pairs;
        if one.abs_diff(other) > RECORD_STORES {
            pairs.remove(&cells);
            return false;
        }
        let times = pairs.entry(cells).or_default();
        *times += 1;
        *times > TIMES
    }

    /// Notes that a context copies `count` words at once, which may be a structure.
    pub(super) fn copies(&mut self, actor: Actor, (address, count): (u32, u32), out: &mut Out) {
        let own = index(actor.thread);
        let (clock, locks) = (self.tracks[own].clock, self.tracks[own].locks);
        let cells = (0..count).filter_map(|word| self.cells.get(address + 4 * word));
        let mut written = cells.filter_map(|cell| cell.unordered_writer(own, &clock, locks));
        let (Some(CellChange { by, at, .. }), Some(_)) = (written.next(), written.next()) else { return };
        if !self.reports.is_reported(actor.at, at) {
            let other = OtherPlace { thread: context(by), at };
            let is_seen = false;
            self.found_half(own, TornRead { actor, cell: address, size: 4, other, is_seen }, out);
        }
    }

    fn found_half(&mut self, own: usize, half: TornRead, out: &mut Out) {
        self.tracks[own].reading.found.push(half);
        if self.tracks[own].reading.found.len() > MOST {
            self.settle(own, out);
        }
    }

    /// Notes that a context uses a value that it has read.
    pub(super) fn settle(&mut self, own: usize, out: &mut Out) {
        for TornRead { actor, cell, size, other, is_seen } in
            std::mem::take(&mut self.tracks[own].reading.found)
        {
            let cell = self.name_of(cell, size);
            if is_seen {
                let effect = lost_at("half of what it read was old", actor.now);
                self.report(out, actor, other.at, Message::RaceRecord { other, cell, effect });
            } else {
                let effect = "half of what it reads can be old".to_owned();
                self.report_later(actor, other.at, Message::RaceRecord { other, cell, effect });
            }
        }
    }

    /// Notes that a context has changed a cell: contexts that have read it now have an old value, unless a later store
    /// of the reader allowed the change.
    pub(super) fn note_change(&mut self, own: usize, address: u32) {
        self.changes += 1;
        let known = self.tracks[own].clock;
        let others = self.tracks.iter_mut().enumerate().filter(|(other, _)| *other != own);
        for (other, track) in others {
            let parts = &mut track.reading.parts;
            parts.retain(|part| part.address != address || part.epoch > known[other]);
            for part in parts.iter_mut().filter(|part| part.address == address && part.changed_by.is_none()) {
                part.changed_by = Some(own);
            }
        }
    }
}
