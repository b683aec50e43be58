//! The served board, shown on a page if requested.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Result;
use cc67_host::Target;
#[cfg(feature = "live")]
use cc67_live::LiveView;
use kmotiondef::Ticks;
use runtime::Event;
use runtime::debug::DebugInfo;

use crate::cli::report::trace::{self, Trace};
use crate::cli::session::BoardSession;

use super::ServeTerms;

/// The requests of pages to the dispatcher.
#[derive(Debug, Default)]
pub(super) struct PageRequests {
    /// The events of the ticks run by a page.
    pub(super) events: Vec<Event>,
    /// Lines of script commands.
    pub(super) commands: Vec<String>,
    /// The actions of a page on the world, as statements.
    pub(super) acts: Vec<String>,
    /// Seconds of board time per second; `None` while the clock is stopped.
    pub(super) speed: Option<f64>,
}

/// A board that clients can use.
pub(super) struct UsableBoard<T: Target> {
    board: BoardSession<T>,
    /// Set when the server should end, even if a debugger has stopped the board.
    is_ending: Arc<AtomicBool>,
    #[cfg(feature = "live")]
    view: Option<LiveView<T>>,
}

impl<T: Target> UsableBoard<T> {
    /// Creates the served board of a session, with a page if the terms require one; returns it with its trace.
    pub(super) fn new(
        mut board: BoardSession<T>,
        terms: &ServeTerms<'_>,
        is_ending: Arc<AtomicBool>,
    ) -> Result<(Self, Option<Trace>)> {
        // A page shows signals even if they are not written to a file.
        #[cfg(feature = "live")]
        let is_shown_only = terms.page.is_some() && terms.trace.is_unwritten();
        #[cfg(not(feature = "live"))]
        let is_shown_only = false;
        let request = if is_shown_only { None } else { trace::request(terms.trace, &board.session)? };
        if let Some(request) = &request {
            board.session.record(request.clone());
        }
        let trace = request.as_ref().map(|request| Trace::begin(terms.trace, request, false)).transpose()?;
        board.session.stop_recording();
        board.session.listen(true);
        board.is_paced();
        #[cfg(feature = "live")]
        let view = terms.page.as_ref().map(|page| page.open(&mut board.session)).transpose()?;
        let board = Self {
            board,
            is_ending,
            #[cfg(feature = "live")]
            view,
        };
        Ok((board, trace))
    }
}

impl<T: Target> UsableBoard<T> {
    /// The number of the last completed tick.
    pub(super) fn tick(&self) -> Ticks {
        self.board.session.tick()
    }

    /// Runs to the end of a tick.
    pub(super) fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        let is_ending = &self.is_ending;
        #[cfg(feature = "live")]
        let view = &mut self.view;
        self.board.advance_attended(limit, sink, &mut |_session| {
            #[cfg(feature = "live")]
            if let Some(view) = view {
                view.show(_session);
            }
            if is_ending.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
    }

    /// Returns whether a debugger is attached, or can attach.
    pub(super) fn is_attended(&self) -> bool {
        self.board.attendant.is_some()
    }

    /// Serves a debugger while time does not pass.
    pub(super) fn attend(&mut self, sink: &mut dyn FnMut(Event)) {
        if self.is_attended() {
            self.advance(self.tick(), sink);
        }
    }

    /// Sends bytes over the link.
    pub(super) fn receive(&mut self, bytes: &[u8]) {
        self.board.session.receive(bytes);
    }

    /// From now on keeps the bytes sent by the board, for the only client of its link.
    pub(super) fn tap_wire(&mut self) {
        self.board.session.tap_wire();
    }

    /// Returns the bytes that it has sent since the last call.
    pub(super) fn take_wire(&mut self) -> Vec<u8> {
        self.board.session.take_wire()
    }

    /// Returns whether the board still has to take bytes.
    pub(super) fn is_receiving(&self) -> bool {
        self.board.session.target().is_receiving()
    }

    /// Returns whether a command waits for data lines.
    pub(super) fn is_in_command(&self) -> bool {
        self.board.session.target().is_in_command()
    }

    /// Sets whether somebody takes console lines; if not, programs that print have to wait.
    pub(super) fn listen(&mut self, listens: bool) {
        self.board.session.listen(listens);
    }

    /// Returns the debug information of its programs.
    pub(super) fn programs(&self) -> Vec<DebugInfo> {
        self.board.session.debug().into_iter().map(|(_, debug)| debug).collect()
    }

    /// Ends serving it.
    pub(super) fn finish(&mut self, sink: &mut dyn FnMut(Event)) -> Result<()> {
        #[cfg(feature = "live")]
        self.view.iter().for_each(LiveView::close);
        self.board.finish(sink)
    }

    /// Shows an event.
    #[cfg(feature = "live")]
    pub(super) fn show(&mut self, event: &Event) {
        if let Some(view) = &mut self.view {
            view.handle_event(&self.board.session, event);
        }
    }

    /// Shows the present state and executes requests of pages; returns the requests for the dispatcher, if there is a
    /// page.
    #[cfg(feature = "live")]
    pub(super) fn update(&mut self) -> Option<PageRequests> {
        let requests = self.view.as_mut()?.update(&mut self.board.session);
        let cc67_live::OwnerRequests { events, commands, acts, speed } = requests;
        Some(PageRequests { events, commands, acts, speed })
    }

    /// Does nothing: there is no page.
    #[cfg(not(feature = "live"))]
    #[expect(clippy::unused_self, reason = "with a page, it is shown there")]
    pub(super) fn show(&mut self, _: &Event) {}

    /// Returns `None`: there is no page.
    #[cfg(not(feature = "live"))]
    #[expect(clippy::unused_self, reason = "with a page, it is shown there")]
    pub(super) fn update(&mut self) -> Option<PageRequests> {
        None
    }
}
