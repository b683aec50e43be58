//! Reports: those that were made, and those that may still get more details.
//!
//! A pair of places is reported once. A possible loss of an update is known long before an actual one, if that ever
//! happens; so the report waits a while for the loss, in order to give its time.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::{CodeAddr, Cycles};

use super::{Actor, Races};
use crate::out::{LOST_AT, Message, Out, Speaker};

/// The time that a report waits: a second.
const PATIENCE: Cycles = Cycles::PER_SECOND;

/// Two places, the lower first.
type PlacePair = (CodeAddr, CodeAddr);

/// A report that waits.
#[derive(Clone, Debug)]
struct PendingReport {
    actor: Actor,
    message: Message,
}

/// Reports by their places.
#[derive(Clone, Debug, Default)]
pub(super) struct Reports {
    made: BTreeSet<PlacePair>,
    waiting: BTreeMap<PlacePair, PendingReport>,
    /// The time at which the first waiting report is made.
    due: Option<Cycles>,
}

fn places(one: CodeAddr, other: CodeAddr) -> PlacePair {
    (one.min(other), one.max(other))
}

impl Reports {
    /// Returns whether two places were reported already.
    pub(super) fn is_reported(&self, one: CodeAddr, other: CodeAddr) -> bool {
        self.made.contains(&places(one, other))
    }

    /// Returns whether two places are known to be in conflict, reported or not.
    pub(super) fn is_in_conflict(&self, one: CodeAddr, other: CodeAddr) -> bool {
        let places = places(one, other);
        self.made.contains(&places) || self.waiting.contains_key(&places)
    }

    /// Makes a report now.
    fn make(&mut self, actor: Actor, other: CodeAddr, message: Message, out: &mut Out) {
        let places = places(actor.at, other);
        self.waiting.remove(&places);
        if self.made.insert(places) {
            out.remark_of(actor.now, Speaker::from(actor.thread), Some(actor.at), message);
        }
    }

    /// Delays a report, so that one with more details can replace it.
    fn wait(&mut self, actor: Actor, other: CodeAddr, message: Message) {
        let places = places(actor.at, other);
        if !self.is_in_conflict(actor.at, other) {
            self.waiting.insert(places, PendingReport { actor, message });
            self.due.get_or_insert(actor.now + PATIENCE);
        }
    }

    /// Makes the reports that have waited long enough.
    pub(super) fn check(&mut self, now: Cycles, out: &mut Out) {
        if self.due.is_some_and(|due| due <= now) {
            self.flush(out);
        }
    }

    /// Makes the reports that wait.
    pub(super) fn flush(&mut self, out: &mut Out) {
        self.due = None;
        for (places, PendingReport { actor, message }) in std::mem::take(&mut self.waiting) {
            self.made.insert(places);
            out.remark_of(actor.now, Speaker::from(actor.thread), Some(actor.at), message);
        }
    }
}

impl Races {
    /// Reports something about two places, once.
    pub(super) fn report(&mut self, out: &mut Out, actor: Actor, other: CodeAddr, message: Message) {
        self.reports.make(actor, other, message, out);
    }

    /// Reports a possible conflict of two places, unless it soon actually happens.
    pub(super) fn report_later(&mut self, actor: Actor, other: CodeAddr, message: Message) {
        self.reports.wait(actor, other, message);
    }
}

/// Returns the part of a report about an update that was lost at an instant.
pub(super) fn lost_at(what: &str, now: Cycles) -> String {
    format!("{what}{LOST_AT}{:.6} s", now.get() as f64 / Cycles::PER_SECOND.get() as f64)
}
