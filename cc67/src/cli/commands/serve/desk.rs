//! The dispatcher: takes one request after another for the one board, and keeps its time.
//!
//! With a clock, the board stays close to the clock's time: it waits for the clock, and requests wait for the board.
//! Without a clock, board time passes only while a client waits for an answer, so that the same requests get the same
//! answers each time, however long a client sleeps between them.

use std::collections::{BTreeMap, VecDeque};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use anyhow::Result;
use cc67_host::Target;
use cc67_host::session::EXCHANGE;
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::ServeTerms;
use super::board::ServedBoard;
use super::calls::SILENT;
use super::message::{self, Reply, Request};
use super::wire::WireClient;
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::{Pace, now};
use crate::cli::io::terminal;

/// The interval at which a board with a clock is run while there is no request.
const BEAT: Duration = Duration::from_millis(10);
/// The interval while a client waits for the board, or for the clock.
const SHORT_BEAT: Duration = Duration::from_millis(1);
/// The number of ticks after which requests are polled again.
const TICKS_PER_POLL: u64 = 111;
/// The number of ticks by which the board may be ahead of a clock at normal speed before requests wait for the clock: 1
/// ms.
const AHEAD: f64 = 11.0;
/// The time for which the board runs before requests are polled again.
const AT_ONCE: Duration = Duration::from_millis(25);
/// The time for which the board runs while a request waits.
const BEFORE_ANSWER: Duration = Duration::from_millis(5);
/// The delay in seconds beyond which a board does not catch up.
const PATIENCE: f64 = 0.25;
/// The time for which a command from a page waits while a client holds the token.
const TOKEN_PATIENCE: Duration = Duration::from_millis(500);
/// The maximum number of console lines sent before a reply.
const LINES_AT_ONCE: usize = 10;

/// A message to the dispatcher.
#[derive(Debug)]
pub(super) enum DispatcherMessage {
    /// A client has connected; its answers go to this sender.
    Connected(u64, Sender<Vec<Vec<u8>>>),
    /// A request of a client.
    Request(u64, Request),
    /// A message of a client that is not a request: its bytes.
    Unknown(u64, Vec<u8>),
    /// A client has disconnected.
    Disconnected(u64),
    /// A client of the board's link has connected.
    Plugged(WireClient),
    /// Bytes of that client.
    Bytes(u64, Vec<u8>),
    /// That client has disconnected.
    Unplugged(u64),
    /// The server should end.
    End,
}

/// The control flow after a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
enum DispatchFlow {
    Continue,
    Leave,
}

/// The reply for which a client waits.
#[derive(Clone, Debug)]
pub(super) enum AwaitedReply {
    /// A line of a reply, without its end.
    Answer,
    /// A line of a reply, with its end.
    Line,
    /// `Ready`, and whether an error came before it.
    Ready { after_error: bool },
}

/// A client that waits for the board.
#[derive(Clone, Debug)]
pub(super) struct WaitingClient {
    pub(super) client: u64,
    pub(super) reply: AwaitedReply,
    /// The time limit of the wait.
    pub(super) deadline: Instant,
    /// Without a clock: the number of ticks that the board still runs for it.
    pub(super) left: u64,
}

/// The token of the board: a counter with no owner.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Token {
    /// The client that took it last.
    pub(super) taken_by: Option<u64>,
    /// True if it was reported that this client waits for a token that it holds itself.
    pub(super) has_told: bool,
}

/// The receiver of the console.
#[derive(Debug, Default)]
pub(super) struct ConsoleClient {
    /// The client, if one has registered.
    pub(super) client: Option<u64>,
    /// The lines that it has not received yet.
    pub(super) lines: VecDeque<Vec<u8>>,
}

/// The link to the board, as clients see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkState {
    /// True if it is open.
    pub(super) is_open: bool,
    /// True if its loss has been reported since the last read.
    pub(super) has_told_failure: bool,
}

/// The position of a board among the boards of a server.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoardSlot {
    /// Its index.
    pub(super) index: usize,
    /// The number of boards.
    pub(super) boards: usize,
}

/// The board and its clients.
pub(super) struct Dispatcher<'a, T: Target> {
    pub(super) board: ServedBoard<'a, T>,
    pub(super) slot: BoardSlot,
    terms: &'a ServeTerms<'a>,
    /// The clock and its speed, if the board follows one.
    clock: Option<(Pace, f64)>,
    inbox: Inbox,
    clients: BTreeMap<u64, Sender<Vec<Vec<u8>>>>,
    waiting: Vec<WaitingClient>,
    pub(super) token: Token,
    pub(super) console: ConsoleClient,
    pub(super) state: LinkState,
    /// Error texts to be sent before the next reply.
    pub(super) error_texts: Vec<String>,
    pub(super) page: PageState,
}

/// Messages to the dispatcher.
#[derive(Debug)]
struct Inbox {
    incoming: Receiver<DispatcherMessage>,
    /// The messages that have arrived and are still to be handled.
    notes: VecDeque<DispatcherMessage>,
}

impl Inbox {
    /// Collects the messages that have arrived.
    fn collect(&mut self) {
        self.notes.extend(self.incoming.try_iter());
    }
}

/// The actions and requests of pages.
#[derive(Debug, Default)]
pub(super) struct PageState {
    /// The time at which the clock was stopped.
    stopped: Option<Instant>,
    /// The requests of clients since then.
    held: Vec<DispatcherMessage>,
    /// The speed that was last requested, where the inner `None` stands for a stopped clock.
    requested_speed: Option<Option<f64>>,
    /// Script commands, each with the time at which it was typed.
    commands: VecDeque<(Instant, String)>,
}

impl<'a, T: Target> Dispatcher<'a, T> {
    /// Creates a dispatcher for requests from `inbox`.
    pub(super) fn new(
        board: ServedBoard<'a, T>,
        slot: BoardSlot,
        terms: &'a ServeTerms<'a>,
        inbox: Receiver<DispatcherMessage>,
    ) -> Self {
        let clock = terms.pace.map(|speed| (Pace::with_speed(board.tick(), speed), speed));
        Self {
            board,
            slot,
            terms,
            clock,
            inbox: Inbox { incoming: inbox, notes: VecDeque::new() },
            clients: BTreeMap::new(),
            waiting: Vec::new(),
            token: Token::default(),
            console: ConsoleClient::default(),
            state: LinkState { is_open: true, has_told_failure: false },
            error_texts: Vec::new(),
            page: PageState::default(),
        }
    }

    /// Serves until a request to end, until the time limit, or, if so requested, until the last client disconnects.
    pub(super) fn run(mut self) -> Result<Exit> {
        let limit = self.terms.limit.map_or(u64::MAX, |seconds| (seconds / TIMEBASE).round() as u64);
        self.look_at_page();
        while self.board.tick().get() < limit {
            if let Some(note) = self.next_note()
                && self.take(note) == DispatchFlow::Leave
            {
                break;
            }
            if self.page.stopped.is_none() {
                self.catch_up(limit, AT_ONCE);
                self.answer_waiting();
            }
            self.board.forward();
            self.look_at_page();
        }
        self.board.finish()
    }

    /// Takes the next message; `None` if it is time to run the board.
    fn next_note(&mut self) -> Option<DispatcherMessage> {
        if let Some(note) = self.inbox.notes.pop_front() {
            return Some(note);
        }
        let first = self.waiting.iter().map(|waiting| waiting.deadline).min();
        let patience = match (&self.clock, first) {
            (Some(_), None) if self.board.wire.as_ref().is_some_and(|wire| wire.is_lively(now())) => {
                SHORT_BEAT
            }
            (Some(_), None) => BEAT,
            (Some(_), Some(_)) if self.page.stopped.is_some() => BEAT,
            (Some(_), Some(_)) => SHORT_BEAT,
            (None, Some(_)) if self.ticks_wanted() > 0 => Duration::ZERO,
            (None, Some(until)) => until.saturating_duration_since(now()),
            (None, None) if self.page.requested_speed.is_some() || self.board.is_attended() => BEAT,
            // Time passes only in exchanges.
            (None, None) => return Some(self.inbox.incoming.recv().unwrap_or(DispatcherMessage::End)),
        };
        match self.inbox.incoming.recv_timeout(patience) {
            Ok(note) => Some(note),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(DispatcherMessage::End),
        }
    }

    fn take(&mut self, note: DispatcherMessage) -> DispatchFlow {
        match note {
            DispatcherMessage::End => return DispatchFlow::Leave,
            DispatcherMessage::Connected(client, answers) => {
                self.clients.insert(client, answers);
            }
            DispatcherMessage::Unknown(client, message) => {
                let text =
                    format!("client {client}: {}, its connection is closed", describe_unknown(&message));
                terminal::note(&text);
                self.board.log(&text);
            }
            DispatcherMessage::Disconnected(client) => return self.left(client),
            DispatcherMessage::Plugged(_)
            | DispatcherMessage::Bytes(..)
            | DispatcherMessage::Unplugged(_) => return self.wire(note),
            DispatcherMessage::Request(..) if self.page.stopped.is_some() => self.page.held.push(note),
            DispatcherMessage::Request(client, request) => {
                self.wait_for_clock();
                if let Some(reply) = self.ask(client, &request) {
                    self.answer(client, reply);
                }
                if self.board.is_logged() {
                    self.board.log(&format!("client {client}: {}", request.name(self.slot.boards)));
                }
            }
        }
        DispatchFlow::Continue
    }

    /// Handles a message from the board's own link, which has exactly one client.
    fn wire(&mut self, note: DispatcherMessage) -> DispatchFlow {
        let Some(wire) = &mut self.board.wire else { return DispatchFlow::Continue };
        match note {
            DispatcherMessage::Plugged(client) => wire.plug(client),
            DispatcherMessage::Bytes(client, bytes) => wire.take(client, &bytes, now()),
            DispatcherMessage::Unplugged(client) => wire.unplug(client),
            DispatcherMessage::Connected(..)
            | DispatcherMessage::Request(..)
            | DispatcherMessage::Unknown(..)
            | DispatcherMessage::Disconnected(_)
            | DispatcherMessage::End => {}
        }
        if self.terms.once && wire.is_unplugged() { DispatchFlow::Leave } else { DispatchFlow::Continue }
    }

    /// Handles the end of a client: the token and console are free again if it had them.
    fn left(&mut self, client: u64) -> DispatchFlow {
        self.clients.remove(&client);
        self.waiting.retain(|waiting| waiting.client != client);
        self.page
            .held
            .retain(|note| !matches!(note, DispatcherMessage::Request(other, _) if *other == client));
        if self.token.taken_by == Some(client) {
            self.token = Token::default();
        }
        if self.console.client == Some(client) {
            self.console = ConsoleClient::default();
            self.board.is_heard = false;
        }
        if self.terms.once && self.clients.is_empty() { DispatchFlow::Leave } else { DispatchFlow::Continue }
    }

    /// Answers a client; error texts are sent before the reply, and so are console lines if it is the console.
    pub(super) fn answer(&mut self, client: u64, reply: Reply) {
        let errors = self.error_texts.drain(..).map(|text| message::error_text(&text));
        let mut messages: Vec<_> = errors.collect();
        if self.console.client == Some(client) {
            let count = self.console.lines.len().min(LINES_AT_ONCE);
            messages.extend(self.console.lines.drain(..count).map(|line| message::console_line(&line)));
        }
        messages.push(reply.bytes());
        if let Some(answers) = self.clients.get(&client) {
            // A disconnected client is removed when its connection reports it.
            let _ = answers.send(messages);
        }
        self.board.hold_back(self.console.lines.len());
    }

    /// Shows the board on its page, if it has one, and executes the page's requests.
    fn look_at_page(&mut self) {
        self.board.hold_back(self.console.lines.len());
        let Some(requests) = self.board.show() else { return };
        let time = now();
        self.page.commands.extend(requests.commands.into_iter().map(|line| (time, line)));
        let before = self.page.requested_speed.replace(requests.speed);
        let has_changed = before.map_or(requests.speed.is_none(), |before| before != requests.speed);
        if self.is_clocked() && has_changed {
            self.set_clock(requests.speed, time);
        }
        self.send_commands(time);
    }

    /// Stops or starts the clock; the time limits of clients are extended accordingly.
    fn set_clock(&mut self, speed: Option<f64>, time: Instant) {
        let Some(speed) = speed else {
            self.page.stopped.get_or_insert(time);
            return;
        };
        if let Some(since) = self.page.stopped.take() {
            let stopped = time.saturating_duration_since(since);
            self.waiting.iter_mut().for_each(|waiting| waiting.deadline += stopped);
            self.inbox.notes.extend(self.page.held.drain(..));
        }
        self.clock = Some((Pace::with_speed(self.board.tick(), speed), speed));
    }

    /// Sends the commands typed on pages, unless a client's exchange is in progress.
    fn send_commands(&mut self, time: Instant) {
        while let Some((typed, _)) = self.page.commands.front() {
            let is_taken = self.token.taken_by.is_some() && time < *typed + TOKEN_PATIENCE;
            let is_busy = !self.waiting.is_empty() || self.board.is_in_command() || is_taken;
            if is_busy || self.page.stopped.is_some() {
                return;
            }
            if let Some((_, line)) = self.page.commands.pop_front() {
                self.board.send_for_page(SILENT, line.as_bytes());
            }
        }
    }

    /// Waits until the clock reaches a board that is ahead of it.
    fn wait_for_clock(&mut self) {
        if let Some((pace, speed)) = &self.clock {
            let ahead = self.board.tick().get().saturating_sub(pace.due().get());
            if ahead as f64 > AHEAD * speed {
                pace.wait(self.board.tick());
            }
        }
        self.catch_up(u64::MAX, BEFORE_ANSWER);
    }

    /// Runs the board up to the clock's time, unless a message should be handled first, or it takes too long: a board
    /// that cannot keep up falls behind the clock.
    fn catch_up(&mut self, limit: u64, at_once: Duration) {
        let Some((pace, speed)) = &self.clock else { return self.run_for_clients() };
        let (due, speed) = (pace.due().get().min(limit), *speed);
        let begin = now();
        loop {
            self.board.hold_back(self.console.lines.len());
            let tick = self.board.tick();
            if tick.get() >= due {
                return;
            }
            if begin.elapsed() >= at_once {
                let behind = (due - tick.get()) as f64 * TIMEBASE;
                if behind > PATIENCE * speed {
                    self.clock = Some((Pace::with_speed(tick, speed), speed));
                }
                return;
            }
            let part = TICKS_PER_POLL.min(due - tick.get());
            self.board.feed();
            if self.board.is_feeding() {
                self.board.until(part, |board| !board.is_receiving());
            } else {
                self.board.advance(Ticks::new(tick.get() + part));
            }
            self.board.forward();
            self.inbox.collect();
            if !self.inbox.notes.is_empty() {
                return;
            }
        }
    }

    /// The number of ticks still required by the longest wait of a client; 0 with a clock.
    fn ticks_wanted(&self) -> u64 {
        self.waiting.iter().map(|waiting| waiting.left).max().unwrap_or(0)
    }

    /// Runs the board a little for waiting clients, until it has a result for one of them; for the only client of the
    /// link, until the board has taken its bytes, and for the duration of an exchange after that.
    fn run_for_clients(&mut self) {
        if self.board.is_feeding() {
            while self.board.is_feeding() && self.inbox.notes.is_empty() {
                self.board.feed();
                self.board.until(TICKS_PER_POLL, |board| !board.is_receiving());
                self.board.forward();
                self.inbox.collect();
            }
            self.board.until(EXCHANGE, |_| false);
        }
        let ticks = self.ticks_wanted().min(TICKS_PER_POLL);
        let begin = self.board.tick().get();
        self.board.until(ticks, |board| board.link.has_line());
        let passed = self.board.tick().get() - begin;
        for waiting in &mut self.waiting {
            waiting.left = waiting.left.saturating_sub(passed);
        }
    }

    /// Answers the clients whose line has come, or whose time limit has passed.
    fn answer_waiting(&mut self) {
        let time = now();
        for mut waiting in std::mem::take(&mut self.waiting) {
            match self.look(&mut waiting, time) {
                Some(reply) => self.answer(waiting.client, reply),
                None => self.waiting.push(waiting),
            }
        }
    }

    /// Makes a client wait for the board, at most for some milliseconds; returns the reply if it comes within the
    /// duration of an exchange.
    pub(super) fn wait(&mut self, client: u64, wanted: AwaitedReply, milliseconds: u32) -> Option<Reply> {
        let time = now();
        let length = Duration::from_millis(milliseconds.into());
        let mut waiting =
            WaitingClient { client, reply: wanted, deadline: time + length, left: self.ticks(length) };
        let end = self.board.tick().get() + EXCHANGE;
        loop {
            let begin = self.board.tick().get();
            if let Some(reply) = self.look(&mut waiting, time) {
                return Some(reply);
            }
            let has_come = self.board.until(end.saturating_sub(begin), |board| board.link.has_line());
            waiting.left = waiting.left.saturating_sub(self.board.tick().get() - begin);
            if !has_come {
                self.waiting.push(waiting);
                return None;
            }
        }
    }

    /// The number of ticks that the board runs for a wait, if it follows no clock.
    pub(super) fn ticks(&self, length: Duration) -> u64 {
        if self.is_clocked() { 0 } else { (length.as_secs_f64() / TIMEBASE).round() as u64 }
    }

    /// Returns whether the time limit of a wait has passed. With a clock, the clock decides; without one, the board's
    /// ticks; for ReadLineTimeOut, both must have passed.
    pub(super) fn has_passed(&self, waiting: &WaitingClient, time: Instant) -> bool {
        let is_timed = self.is_clocked() || matches!(waiting.reply, AwaitedReply::Line);
        waiting.left == 0 && (!is_timed || time >= waiting.deadline)
    }

    /// Returns whether the board follows a clock.
    pub(super) const fn is_clocked(&self) -> bool {
        self.clock.is_some()
    }
}

/// Describes a message that is not a request, with the number of the call at its beginning.
fn describe_unknown(message: &[u8]) -> String {
    match message.first_chunk() {
        Some(code) => format!("there is no call {} with these arguments", i32::from_le_bytes(*code)),
        None => format!("a message of {} bytes is not a request", message.len()),
    }
}
