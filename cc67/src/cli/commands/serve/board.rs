//! The served board, with its link, its files and its recordings.

use anyhow::Result;
use cc67_host::Target;
use cc67_host::session::EXCHANGE;
use cc67_host::{End, REPLY_BYTES, remark};
use kmotiondef::Ticks;
use runtime::{Event, EventKind, Message};

use super::ServeTerms;
use super::link::{CONSOLE_LINES, UnreadLines};
use super::log::ExchangeLog;
use super::served::{PageRequests, UsableBoard};
use super::wire::{self, WireEnd};
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::now;
use crate::cli::io::terminal;
use crate::cli::report::seen::Failures;
use crate::cli::report::trace::Trace;

/// The maximum number of ticks until the board takes a line.
const TAKEN_WITHIN: u64 = 11_111;
/// The beginning of the board's message about a command that it rejects (host-protocol.md section 2).
const REFUSED: &[u8] = b"error, ";

/// A board under control, and the data received over its link.
pub(super) struct ServedBoard<'a, T: Target> {
    board: UsableBoard<T>,
    terms: &'a ServeTerms<'a>,
    pub(super) link: UnreadLines,
    /// True if a client receives the console.
    pub(super) is_heard: bool,
    log: Option<ExchangeLog>,
    seen: Failures,
    trace: Option<Trace>,
    has_told_replies: bool,
    /// True if the board's replies are for a page.
    is_for_page: bool,
    /// True if programs that print have to wait because too much output is unread.
    is_held_back: bool,
    /// The wire to the only client of the link, if the board is served in this way.
    pub(super) wire: Option<WireEnd>,
    has_told_wire: bool,
}

impl<'a, T: Target> ServedBoard<'a, T> {
    /// Creates the served board, recorded as the terms require.
    pub(super) fn new(
        mut board: UsableBoard<T>,
        trace: Option<Trace>,
        terms: &'a ServeTerms<'a>,
    ) -> Result<Self> {
        let log = terms.log.map(ExchangeLog::new).transpose()?;
        let wire = terms.is_on_wire().then(WireEnd::default);
        if wire.is_some() {
            board.tap_wire();
        }
        Ok(Self {
            board,
            terms,
            link: UnreadLines::default(),
            is_heard: false,
            log,
            seen: Failures::default(),
            trace,
            has_told_replies: false,
            is_for_page: false,
            is_held_back: false,
            wire,
            has_told_wire: false,
        })
    }

    /// The number of the last completed tick.
    pub(super) fn tick(&self) -> Ticks {
        self.board.tick()
    }

    /// Returns whether a debugger is attached, or can attach.
    pub(super) fn is_attended(&self) -> bool {
        self.board.is_attended()
    }

    /// Runs to the end of a tick.
    pub(super) fn advance(&mut self, limit: Ticks) {
        let mut events = Vec::new();
        self.board.advance(limit, &mut |event| events.push(event));
        self.take(events);
    }

    /// Runs until `is_over` returns true after a tick, at most a number of ticks; returns whether it did.
    pub(super) fn until(&mut self, ticks: u64, is_over: impl Fn(&Self) -> bool) -> bool {
        let end = self.tick().get().saturating_add(ticks);
        while !is_over(self) {
            if self.tick().get() >= end {
                return false;
            }
            self.advance(self.tick().next());
        }
        true
    }

    /// Sends a line and lets the board take it. A line with an escape is not echoed.
    pub(super) fn send(&mut self, before: &[u8], line: &[u8]) {
        if let Some(log) = &mut self.log {
            log.line(self.board.tick(), line, self.board.is_in_command());
        }
        self.board.receive(&[before, line, b"\r"].concat());
        self.until(TAKEN_WITHIN, |board| !board.is_receiving());
    }

    /// Sends a line for a page, which alone receives the board's reply.
    pub(super) fn send_for_page(&mut self, before: &[u8], line: &[u8]) {
        self.log("page:");
        self.forward();
        self.is_for_page = true;
        self.send(before, line);
        self.until(EXCHANGE, |_| false);
        self.is_for_page = false;
        let sent = self.board.take_wire();
        self.send_on_wire(wire::console_lines(&sent));
    }

    /// Sends the board the data of its client, once it has taken the previous data.
    pub(super) fn feed(&mut self) {
        if let Some(wire) = self.wire.as_mut().filter(|wire| wire.has_incoming())
            && !self.board.is_receiving()
        {
            self.board.receive(&wire.next());
        }
    }

    /// Returns whether the board still has to take bytes that were sent.
    pub(super) fn is_receiving(&self) -> bool {
        self.board.is_receiving()
    }

    /// Returns whether the board still has to take bytes of the only client of the link.
    pub(super) fn is_feeding(&self) -> bool {
        self.wire.as_ref().is_some_and(|wire| wire.has_incoming() || self.is_receiving())
    }

    /// Sends the board's data to the client, and makes programs that print wait while the client does not read.
    pub(super) fn forward(&mut self) {
        if self.wire.is_some() {
            let sent = self.board.take_wire();
            self.send_on_wire(sent);
        }
        if let Some(is_too_much) = self.wire.as_mut().and_then(WireEnd::hold_back) {
            self.board.listen(!is_too_much);
        }
    }

    fn send_on_wire(&mut self, bytes: Vec<u8>) {
        let is_lost = self.wire.as_mut().is_some_and(|wire| wire.send(bytes, now()));
        if is_lost && !std::mem::replace(&mut self.has_told_wire, true) {
            terminal::note("the client reads nothing: what the board sends is lost");
        }
    }

    /// Returns whether a command waits for data lines.
    pub(super) fn is_in_command(&self) -> bool {
        self.board.is_in_command()
    }

    /// Shows the board on its page, if it has one, and executes the page's requests; returns the requests for the
    /// dispatcher.
    pub(super) fn show(&mut self) -> Option<PageRequests> {
        let mut events = Vec::new();
        self.board.attend(&mut |event| events.push(event));
        self.take(events);
        let mut requests = self.board.update()?;
        self.take(std::mem::take(&mut requests.events));
        if let Some(log) = &mut self.log {
            requests.acts.iter().for_each(|act| log.act(self.board.tick(), act, self.board.is_in_command()));
        }
        Some(requests)
    }

    /// Makes programs that print wait while too many lines wait for the console; `waiting` is the number of lines
    /// already taken from the link.
    pub(super) fn hold_back(&mut self, waiting: usize) {
        let limit = if self.is_held_back { CONSOLE_LINES / 2 } else { CONSOLE_LINES };
        let is_too_much = self.is_heard && waiting + self.link.console_lines() >= limit;
        if is_too_much != self.is_held_back {
            self.is_held_back = is_too_much;
            self.board.listen(!is_too_much);
        }
    }

    /// Logs a client's request and its answer.
    pub(super) fn log(&mut self, text: &str) {
        if let Some(log) = &mut self.log {
            log.remark(self.board.tick(), text, self.board.is_in_command());
        }
    }

    /// Returns whether there is a log.
    pub(super) const fn is_logged(&self) -> bool {
        self.log.is_some()
    }

    /// Reopens the link: pending data are dropped on both ends.
    pub(super) fn reopen(&mut self) {
        self.board.receive(b"\x03");
        self.until(TAKEN_WITHIN, |board| !board.is_receiving());
        self.link.clear();
    }

    /// Handles events.
    fn take(&mut self, events: Vec<Event>) {
        for event in events {
            if let Some(trace) = &mut self.trace {
                trace.note(&event);
            }
            self.seen.note(&event);
            self.event(event);
        }
        if self.link.take_lost_replies() && !std::mem::replace(&mut self.has_told_replies, true) {
            terminal::note(&Message::RepliesLost { bytes: REPLY_BYTES }.to_string());
        }
    }

    fn event(&mut self, event: Event) {
        // A page shows the replies to its own requests, and not those to others.
        if self.is_for_page || !matches!(event.kind, EventKind::Reply(_)) {
            self.board.show(&event);
        }
        match &event.kind {
            // The client receives the bytes themselves.
            EventKind::Reply(_) | EventKind::Echo(_) | EventKind::ConsoleLine(_) if self.wire.is_some() => {}
            EventKind::Reply(line) => {
                if !self.is_for_page {
                    self.link.reply(line);
                }
            }
            EventKind::Echo(bytes) => self.link.echo(bytes),
            EventKind::ConsoleLine(line) => {
                if line.starts_with(REFUSED) {
                    self.log(&format!("the board: {}", String::from_utf8_lossy(line)));
                }
                self.link.console(line.clone(), self.is_heard);
            }
            EventKind::Aborted | EventKind::UartSent(_) | EventKind::Trace(_) | EventKind::Loaded(..) => {}
            EventKind::Remark(_)
            | EventKind::Trap(_)
            | EventKind::Unmet(_)
            | EventKind::Host(_)
            | EventKind::Halted(_) => {
                if let Some(text) = remark::describe(&event, &self.board.programs()) {
                    terminal::note(&text);
                    if let Some(scene) = remark::scene(&event) {
                        terminal::print_separated(&scene.to_string());
                    }
                }
            }
        }
    }

    /// Ends serving: the files are written, and the exit code is determined by the board's programs.
    pub(super) fn finish(mut self) -> Result<Exit> {
        let mut events = Vec::new();
        let finished = self.board.finish(&mut |event| events.push(event));
        self.take(events);
        if let Some(trace) = self.trace.take() {
            trace.finish(self.terms.trace, self.board.tick(), &self.terms.title)?;
        }
        finished?;
        Ok(self.seen.exit(End::AllEnded, true).0)
    }
}
