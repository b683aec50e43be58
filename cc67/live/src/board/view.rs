//! A view of a session run by other code, such as a server whose clients use the same board.

use std::sync::mpsc::Receiver;
use std::time::Duration;

use cc67_host::{Session, Target};
use runtime::Event;

use super::ViewState;
use crate::hub::Incoming;

/// The page of a session run by other code.
#[derive(Debug)]
pub struct LiveView<T: Target> {
    state: ViewState<T>,
    requests: Receiver<Incoming>,
}

/// The requests of pages to the owner of the session.
#[derive(Debug, Default)]
pub struct OwnerRequests {
    /// The events of the ticks run by a page.
    pub events: Vec<Event>,
    /// Lines of script commands to be sent to the board.
    pub commands: Vec<String>,
    /// Statements of a stimulus that pages have executed.
    pub acts: Vec<String>,
    /// The requested speed, in seconds of board time per second; `None` while the clock is stopped.
    pub speed: Option<f64>,
}

impl<T: Target> LiveView<T> {
    pub(super) const fn new(state: ViewState<T>, requests: Receiver<Incoming>) -> Self {
        Self { state, requests }
    }

    /// Handles an event on the board.
    pub fn handle_event(&mut self, session: &Session<T>, event: &Event) {
        self.state.log.note(session, event);
    }

    /// Executes the requests of pages since the last call, without waiting, and sends new information to the pages.
    /// Must be called about a hundred times per second.
    pub fn update(&mut self, session: &mut Session<T>) -> OwnerRequests {
        self.state.take(session, &self.requests, Duration::ZERO);
        self.state.stop_silent_jogs(session);
        self.state.send_updates(session);
        let clock = &self.state.clock;
        let speed = clock.is_running().then(|| clock.speed());
        OwnerRequests { speed, ..std::mem::take(&mut self.state.owner_requests) }
    }

    /// Sends new information to pages at a time when requests are not allowed.
    pub fn show(&mut self, session: &Session<T>) {
        self.state.send_updates(session);
    }

    /// Informs pages that the session is over.
    pub fn close(&self) {
        self.state.close();
    }
}
