//! A connected controller: pages can only watch until a user enables control; a lost link is reported.

use cc67_host::{Session, Target};
use kmotiondef::ThreadId;
use serde_json::{Value, json};

use super::jogs::Jogs;
use super::{EntrySource, ViewState};
use crate::TimeControl;
use crate::control::is_harmless;
use crate::request::PageRequest;

/// The jogs of pages, their rights over a connected controller, and their information about its link.
#[derive(Debug, Default)]
pub(super) struct PageAccess {
    /// True if pages may act.
    is_controlled: bool,
    /// The reason for the loss of the link, once it is lost.
    lost: Option<String>,
    /// The axes that pages jog.
    pub(super) jogs: Jogs,
}

impl PageAccess {
    /// The state as a message to pages.
    pub(super) fn message(&self) -> Value {
        json!({ "kind": "access", "control": self.is_controlled, "lost": self.lost })
    }
}

impl<T: Target> ViewState<T> {
    /// Returns whether the board is a controller.
    pub(super) fn is_real(&self) -> bool {
        self.show.time == TimeControl::Real
    }

    /// Returns an error if a page may not do this now.
    pub(super) fn allows(&self, request: &PageRequest) -> Result<(), String> {
        self.show.time.allows(request)?;
        if !self.is_real() {
            return match request {
                PageRequest::Control { .. } => Err("a simulated board is always under control".to_owned()),
                _ => Ok(()),
            };
        }
        if let (Some(reason), false) = (&self.access.lost, is_harmless(request)) {
            return Err(format!("the controller cannot be reached: {reason}"));
        }
        if self.access.is_controlled || is_harmless(request) {
            return Ok(());
        }
        Err("this page only looks at the controller: switch Control on".to_owned())
    }

    /// Returns whether a saved program may be loaded without a request.
    pub(super) fn may_load(&self) -> bool {
        !self.is_real() || self.access.is_controlled
    }

    /// Enables or disables control.
    pub(super) fn control(&mut self, session: &mut Session<T>, is_on: bool) {
        self.access.is_controlled = is_on;
        let said = if is_on { "control is on: pages can move the machine" } else { "control is off" };
        self.log.add_message(session.tick(), EntrySource::Remark, said.to_owned());
        self.broadcast(&self.access.message());
        self.sample_on_controller(session);
    }

    /// Makes the controller sample the scope's signals while control is enabled: this takes a free thread.
    pub(super) fn sample_on_controller(&mut self, session: &mut Session<T>) {
        if !self.is_real() || self.access.lost.is_some() {
            return;
        }
        let said = match self.samples.on_target(session, self.access.is_controlled) {
            Ok(Some(rate)) => {
                format!("the scope has {rate:.0} samples a second, by a program in a free thread")
            }
            Ok(None) => return,
            Err(error) => format!("the scope has 20 samples a second: {error}"),
        };
        self.log.add_message(session.tick(), EntrySource::Remark, said);
    }

    /// Stops all threads and disables all axes.
    pub(super) fn halt(&mut self, session: &mut Session<T>) -> Result<(), String> {
        self.access.jogs.clear();
        let active = ThreadId::all().filter(|thread| session.thread(*thread).is_active());
        let kills = active.map(|thread| format!("Kill{thread}"));
        let disables = session.target().axes().iter().map(|axis| format!("DisableAxis{axis}"));
        let line = kills.chain(disables).collect::<Vec<_>>().join(";");
        self.command(session, &line)
    }

    /// Informs pages once that the link is lost.
    pub(super) fn tell_link(&mut self, session: &Session<T>) {
        let lost = session.target().loss_reason();
        if lost.is_some() && self.access.lost.is_none() {
            self.access = PageAccess { lost: lost.map(str::to_owned), ..PageAccess::default() };
            self.broadcast(&self.access.message());
        }
    }
}
