//! Running the board: to a tick, to an end, to a condition, or for one step.
//!
//! Every call takes a receiver for the events during the run. A step of the board ends at the next tick in which
//! something can happen; the ticks in between are not visible.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::target::Target;
use kmotiondef::{ThreadId, Ticks};
use runtime::EventKind;
use vm::scheduler::SliceOwner;

use super::until::StepEvents;
use super::{Session, Until};
use crate::target::EventSink;

/// The reason for which a run returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum End {
    /// No thread is active, and there is no motion, recording, output or wait for the PC.
    AllEnded,
    /// The limit was reached.
    Limit,
    /// The run was [interrupted](Interrupter::interrupt).
    Interrupted,
}

/// Ends a [run](Session::run) from another thread, or from a signal handler, after the tick in progress.
#[derive(Clone, Debug, Default)]
pub struct Interrupter(Arc<AtomicBool>);

impl Interrupter {
    /// Ends the run in progress, or otherwise the next one at once.
    pub fn interrupt(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the run was interrupted since the last call.
    #[must_use]
    pub fn take(&self) -> bool {
        self.0.load(Ordering::Relaxed) && self.0.swap(false, Ordering::Relaxed)
    }
}

impl<T: Target> Session<T> {
    /// Returns the handle that ends a [run](Self::run) from elsewhere.
    #[must_use]
    pub fn interrupter(&self) -> Interrupter {
        self.interrupter.clone()
    }

    /// Runs until everything has ended, or to the end of tick `limit`. The run may continue afterwards, or be
    /// [finished](Self::finish).
    pub fn run(&mut self, limit: Ticks, events: EventSink<'_>) -> End {
        loop {
            if self.has_ended() {
                return End::AllEnded;
            }
            if self.tick() >= limit {
                return End::Limit;
            }
            if self.interrupter.take() {
                return End::Interrupted;
            }
            self.step(limit, events);
        }
    }

    /// Runs to the end of tick `limit`, even when everything has ended.
    pub fn advance(&mut self, limit: Ticks, events: EventSink<'_>) {
        while self.tick() < limit {
            self.step(limit, events);
        }
    }

    /// Runs until a condition is met, at most to the end of tick `limit`; returns whether it is met. A condition that
    /// is already met takes no time.
    ///
    /// An [expression](Until::True) is evaluated after every tick.
    pub fn run_until(&mut self, condition: &Until, limit: Ticks, events: EventSink<'_>) -> bool {
        let mut heard = StepEvents::default();
        while !condition.is_met(self, &heard) {
            if self.tick() >= limit {
                return false;
            }
            heard = StepEvents::default();
            let next = if condition.needs_every_tick() { self.tick().next() } else { limit };
            self.step(next.min(limit), &mut |event| {
                condition.note_event(&event, &mut heard);
                events(event);
            });
        }
        true
    }

    /// Runs one tick.
    pub fn step_tick(&mut self, events: EventSink<'_>) {
        self.step(self.tick().next(), events);
    }

    /// Runs to the end of the next tick in which a user thread has the processor, at most to the end of tick `limit`;
    /// returns the thread. A thread that has the processor but waits there also counts.
    pub fn step_slice(&mut self, limit: Ticks, events: EventSink<'_>) -> Option<ThreadId> {
        while self.tick() < limit {
            self.step_tick(events);
            if let SliceOwner::User(thread) = self.target.turn() {
                return Some(thread);
            }
        }
        None
    }

    /// Runs to the end of the next slice of a thread, at most to the end of tick `limit`; returns whether it had one.
    pub fn step_thread(&mut self, thread: ThreadId, limit: Ticks, events: EventSink<'_>) -> bool {
        while let Some(other) = self.step_slice(limit, events) {
            if other == thread {
                return true;
            }
        }
        false
    }

    /// Runs to the end of the next tick in which something can happen, or of tick `limit`, whichever comes first.
    pub fn step(&mut self, limit: Ticks, events: EventSink<'_>) {
        let limit = self.signals.next_sample(self.tick(), limit);
        let mut loaded = Vec::new();
        self.target.step(limit, &mut |event| {
            if let EventKind::Loaded(thread, name) = &event.kind {
                loaded.push((*thread, name.clone()));
            }
            events(event);
        });
        for (thread, name) in loaded {
            let offered =
                self.offered.iter().find(|(known, _)| known.thread == thread && known.name() == *name);
            if let Some(program) = offered.map(|(program, _)| program.clone()) {
                self.note_program(program);
            }
        }
        self.sample();
    }

    /// Ends the run: sends the console lines that still wait, and checks the stimulus's expectations for the end.
    pub fn finish(&mut self, events: EventSink<'_>) {
        self.target.finish(events);
    }

    /// Sends a line of script commands, or a data line for which a command waits, and lets the time pass that the line
    /// and its answer take on the wire.
    pub fn exchange(&mut self, line: &[u8], events: EventSink<'_>) {
        let is_data = self.target.is_in_command();
        let begin = self.tick().get();
        self.command(line);
        while self.target.is_answering() {
            self.step_tick(events);
        }
        if !is_data && !self.target.is_in_command() {
            self.advance(Ticks::new(begin + self.target.exchange_ticks()), events);
        }
    }
}
