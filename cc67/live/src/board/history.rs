//! The history of a shown board: going back and continuing from there, restarting, and saving manual actions as a test.

use std::sync::Arc;

use cc67_host::session::Input;
use cc67_host::{History, Session, Target, Timeline};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;
use serde_json::json;

use super::ViewState;
use super::keep::{Run, TestFiles};
use crate::hub::PageId;

impl<T: Target> ViewState<T> {
    /// Adds the inputs to the timeline; in the past, the run continues from there.
    pub(super) fn keep(&mut self, session: &mut Session<T>) {
        let history = self.timeline.as_mut().map(|timeline| timeline.keep(session));
        if let Some(History::New(_)) = history {
            self.discard_future(session);
        }
    }

    /// Returns whether the board is shown at an earlier time from which it would continue.
    pub(super) fn is_past(&self, session: &Session<T>) -> bool {
        session.tick() < self.end(session)
    }

    /// The last tick of the run.
    pub(super) fn end(&self, session: &Session<T>) -> Ticks {
        self.timeline.as_ref().map_or(session.tick(), Timeline::end)
    }

    /// Shows the board as it was at a tick.
    pub(super) fn go_to(&mut self, session: &mut Session<T>, tick: Ticks) -> Result<(), String> {
        let tick = tick.min(self.end(session));
        let Some(timeline) = &mut self.timeline else { return Ok(()) };
        timeline.go_to(session, tick).map_err(|error| error.to_string())
    }

    /// Continues the run from the time that is shown.
    pub(super) fn go_on(&mut self, session: &mut Session<T>) {
        if self.is_past(session)
            && let Some(timeline) = &mut self.timeline
            && let History::New(_) = timeline.branch(session)
        {
            self.discard_future(session);
        }
    }

    /// Discards everything after the present time.
    fn discard_future(&mut self, session: &Session<T>) {
        self.note_branches();
        let tick = session.tick();
        self.log.truncate(tick);
        let rows = self.samples.truncate(tick);
        self.pages.values_mut().for_each(|page| page.next_row = page.next_row.min(rows));
        self.broadcast(&json!({ "kind": "cut", "tick": tick.get() }));
    }

    /// Restarts the board with the present programs.
    pub(super) fn restart(&mut self, session: &mut Session<T>) -> Result<(), String> {
        if self.wants_new_machine()? {
            return Ok(());
        }
        let Some(timeline) = &mut self.timeline else { return Ok(()) };
        timeline.restore(session, 0).map_err(|error| error.to_string())?;
        self.go_on(session);
        for program in self.programs.loaded() {
            session.load(program).map_err(|error| error.to_string())?;
        }
        self.keep(session);
        self.clock.run(session.tick(), None);
        Ok(())
    }

    /// Returns the reason why a run with only the manual actions would differ; `None` if it would not.
    fn obstacle(&self, session: &Session<T>) -> Option<String> {
        let loads = session.journal().iter().filter_map(|(tick, input)| match input {
            Input::Load(program) => Some((tick.get(), program.name())),
            _ => None,
        });
        let loads: Vec<_> = loads.collect();
        if let Some((tick, name)) = loads.iter().find(|(tick, _)| *tick > 0) {
            let seconds = *tick as f64 * TIMEBASE;
            return Some(format!("{name} was loaded at {seconds:.3} s: begin again with Restart"));
        }
        let is_whole = session.recording().is_complete() || !loads.is_empty();
        (!is_whole).then(|| "a variable was written, which no stimulus does".to_owned())
    }

    /// Saves the manual actions as a test.
    pub(super) fn save(&mut self, session: &Session<T>, id: PageId, name: &str) -> Result<(), String> {
        if let Some(obstacle) = self.obstacle(session) {
            return Err(obstacle);
        }
        let tick = session.tick();
        let seconds = tick.get() as f64 * TIMEBASE;
        let console = self.log.console(tick);
        let run = Run { stimulus: session.recording().text(), seconds, console };
        let kept = TestFiles::new(name, &self.show, run)?;
        if let Some(page) = self.pages.get(&id) {
            kept.write(Arc::clone(&page.mailbox));
        }
        Ok(())
    }
}
