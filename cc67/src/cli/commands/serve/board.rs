//! The board that is served, with its link, its files and whatever is recorded of it.

use anyhow::Result;
use cc67_host::{End, remark};
use kmotiondef::Ticks;
use runtime::{Event, EventKind, Message};
use vm::engine::Engine;

use super::Terms;
use super::link::{CONSOLE_LINES, Unread};
use super::log::ExchangeLog;
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use crate::cli::report::seen::Seen;
use crate::cli::report::trace::{self, Trace};
use crate::cli::session::Rig;
use cc67_host::REPLY_BYTES;

/// What the board answers when flash is written.
const FLASH_COMPLETE: &[u8] = b"Program Flash Image Complete";
/// Ticks in which the board takes a line at the latest.
const TAKEN_WITHIN: u64 = 11_111;

/// A board under control, and what came over its link.
pub(super) struct ServedBoard<'a, E> {
    rig: Rig<E>,
    terms: &'a Terms<'a>,
    pub(super) link: Unread,
    /// Whether a client is the console.
    pub(super) is_heard: bool,
    log: Option<ExchangeLog>,
    seen: Seen,
    trace: Option<Trace>,
    /// Whether flash was written and is to be kept.
    is_flashed: bool,
    has_told_replies: bool,
}

impl<'a, E: Engine> ServedBoard<'a, E> {
    /// The board of a rig, recorded as the terms say.
    pub(super) fn new(mut rig: Rig<E>, terms: &'a Terms<'a>) -> Result<Self> {
        let request = trace::request(terms.trace, &rig.session)?;
        if let Some(request) = &request {
            rig.session.record(request.clone());
        }
        let trace = request.as_ref().map(|request| Trace::begin(terms.trace, request)).transpose()?;
        let log = terms.log.map(ExchangeLog::new).transpose()?;
        rig.session.stop_recording();
        rig.session.listen(true);
        rig.is_paced();
        Ok(Self {
            rig,
            terms,
            link: Unread::default(),
            is_heard: false,
            log,
            seen: Seen::default(),
            trace,
            is_flashed: false,
            has_told_replies: false,
        })
    }

    /// Number of the last tick that has passed.
    pub(super) fn tick(&self) -> Ticks {
        self.rig.session.tick()
    }

    /// Runs to the end of a tick.
    pub(super) fn advance(&mut self, limit: Ticks) {
        let mut events = Vec::new();
        self.rig.advance(limit, &mut |event| events.push(event));
        self.take(events);
    }

    /// Runs until `is_over` says so after a tick, at most a number of ticks; whether it said so.
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

    /// Sends a line and lets the board take it. One with an escape is not echoed.
    pub(super) fn send(&mut self, before: &[u8], line: &[u8]) {
        if let Some(log) = &mut self.log {
            log.line(self.rig.session.tick(), line, self.rig.session.board().is_in_command());
        }
        self.rig.session.receive(&[before, line, b"\r"].concat());
        self.until(TAKEN_WITHIN, |board| !board.rig.session.board().is_receiving());
    }

    /// Notes in the log what a client asked and was answered.
    pub(super) fn log(&mut self, text: &str) {
        if let Some(log) = &mut self.log {
            log.remark(self.rig.session.tick(), text, self.rig.session.board().is_in_command());
        }
    }

    /// Whether there is a log.
    pub(super) const fn is_logged(&self) -> bool {
        self.log.is_some()
    }

    /// Opens the link anew: what is under way is dropped on both ends.
    pub(super) fn reopen(&mut self) {
        self.rig.session.receive(b"\x03");
        self.until(TAKEN_WITHIN, |board| !board.rig.session.board().is_receiving());
        self.link.clear();
    }

    /// Takes up what happened.
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
        if self.link.take_lost_console() {
            terminal::note(&format!(
                "more than {CONSOLE_LINES} console lines wait for their client: the oldest is lost"
            ));
        }
        if std::mem::take(&mut self.is_flashed)
            && let Err(error) = self.rig.keep_flash()
        {
            terminal::error(&error);
        }
    }

    fn event(&mut self, event: Event) {
        match &event.kind {
            EventKind::Reply(line) => {
                self.is_flashed |= line == FLASH_COMPLETE;
                self.link.reply(line);
            }
            EventKind::Echo(bytes) => self.link.echo(bytes),
            EventKind::ConsoleLine(line) => self.link.console(line.clone(), self.is_heard),
            EventKind::Aborted | EventKind::UartSent(_) | EventKind::Trace(_) | EventKind::Loaded(..) => {}
            EventKind::Remark(_) | EventKind::Trap(_) | EventKind::Unmet(_) | EventKind::Host(_) => {
                let programs: Vec<_> = self.rig.session.debug().into_iter().map(|(_, debug)| debug).collect();
                if let Some(text) = remark::describe(&event, &programs) {
                    terminal::note(&text);
                }
            }
        }
    }

    /// The board is served no more: files are written, and the exit code says how its programs fared.
    pub(super) fn finish(mut self) -> Result<Exit> {
        let mut events = Vec::new();
        self.rig.finish(&mut |event| events.push(event))?;
        self.take(events);
        if let Some(trace) = self.trace.take() {
            trace.finish(self.terms.trace, self.rig.session.tick(), &self.terms.title)?;
        }
        Ok(self.seen.exit(End::AllEnded, true).0)
    }
}
