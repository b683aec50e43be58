//! Calls of the vendor's server. Source: host-protocol.md sections 7 to 9.

use std::time::{Duration, Instant};

use cc67_host::Target;
use cc67_host::session::EXCHANGE;
use cc67_host::{Lock, Readiness};

use super::desk::{AwaitedReply, Dispatcher, Token, WaitingClient};
use super::link::LinkLine;
use super::message::{Call, Reply, Request, location};
use crate::cli::io::terminal;

/// The prefix of a line that is not echoed.
pub(super) const SILENT: &[u8] = b"\x1b\x01";
/// The time limit for the answer to a line, in milliseconds.
const ANSWER_WITHIN: u32 = 3000;
/// The time limit for each line before `Ready`, in milliseconds.
const READY_WITHIN: u32 = 100;
/// The generation of the firmware.
const FIRMWARE: i32 = 2;
/// The result if a line does not come in time.
const TIMEOUT: i32 = 2;
/// The error that a client receives when it closes the link.
const FAILED: &str = "Read Failed - Auto Disconnect";

impl<T: Target> Dispatcher<'_, T> {
    /// Executes a client's request; returns the reply, if it is already known.
    pub(super) fn ask(&mut self, client: u64, request: &Request) -> Option<Reply> {
        if request.index(self.slot.boards) != Some(self.slot.index) {
            return Some(Reply::number(missing_board_result(&request.call)));
        }
        let success = Some(Reply::number(0));
        match &request.call {
            Call::WriteLineReadLine(line) => return self.exchange(client, line),
            Call::WriteLine(line) => self.write(SILENT, line),
            Call::WriteLineWithEcho(line) => self.write(b"", line),
            Call::ReadLine(_) if !self.state.is_open => return Some(Reply::text(TIMEOUT, b"")),
            Call::ReadLine(milliseconds) => return self.wait(client, AwaitedReply::Line, *milliseconds),
            Call::ListLocations => {
                let locations: Vec<_> = (0..self.slot.boards).map(location).collect();
                return Some(Reply::numbers(&locations));
            }
            Call::Failed => self.fail(),
            Call::Disconnect => self.state.is_open = false,
            Call::FirmwareVersion => return Some(Reply::number(FIRMWARE)),
            Call::CheckForReady if !self.state.is_open => {
                return Some(Reply::number(Readiness::NoData as i32));
            }
            Call::CheckForReady => {
                return self.wait(client, AwaitedReply::Ready { after_error: false }, READY_WITHIN);
            }
            Call::Lock => return Some(Reply::number(self.lock(client) as i32)),
            Call::Location => {
                let location = location(self.slot.index);
                return Some(Reply::number(if self.state.is_open { location } else { -1 }));
            }
            Call::Release => self.token = Token::default(),
            Call::ServiceConsole => self.service_console(),
            Call::SetConsole => {
                self.console.client = Some(client);
                self.board.is_heard = true;
            }
        }
        success
    }

    /// Sends a line and waits for the first line of its reply.
    fn exchange(&mut self, client: u64, line: &[u8]) -> Option<Reply> {
        let begin = self.board.tick().get();
        self.write(SILENT, line);
        let reply = self.wait(client, AwaitedReply::Answer, ANSWER_WITHIN);
        if !self.is_clocked() {
            let spent = self.board.tick().get() - begin;
            self.board.until(EXCHANGE.saturating_sub(spent), |_| false);
        }
        reply
    }

    fn write(&mut self, before: &[u8], line: &[u8]) {
        self.connect();
        self.board.send(before, line);
    }

    /// Opens the link to the board if it is not open.
    fn connect(&mut self) {
        if !std::mem::replace(&mut self.state.is_open, true) {
            self.board.reopen();
        }
    }

    fn fail(&mut self) {
        self.state.is_open = false;
        if !std::mem::replace(&mut self.state.has_told_failure, true) {
            self.error_texts.push(FAILED.to_owned());
        }
    }

    /// Requests the token once. The client that holds it does not get it a second time.
    fn lock(&mut self, client: u64) -> Lock {
        self.connect();
        match &mut self.token {
            Token { taken_by: None, .. } => {
                self.token = Token { taken_by: Some(client), has_told: false };
                Lock::Locked
            }
            Token { taken_by: Some(holder), has_told } => {
                if *holder == client && !std::mem::replace(has_told, true) {
                    terminal::note(&format!(
                        "client {client} asks for the token that it has itself; it waits until some client calls ReleaseToken"
                    ));
                }
                Lock::InUse
            }
        }
    }

    /// Reads a line for the console, if nobody holds the token.
    fn service_console(&mut self) {
        if self.token.taken_by.is_none() && self.state.is_open {
            self.board.until(EXCHANGE, |board| board.link.has_line());
            if let Some(LinkLine::Console(line) | LinkLine::Reply(line)) = self.read() {
                self.show(line);
            }
        }
    }

    /// The next line from the link.
    fn read(&mut self) -> Option<LinkLine> {
        let line = self.board.link.next()?;
        self.state.has_told_failure = false;
        Some(line)
    }

    /// Passes a line to the console; without a console it is discarded.
    fn show(&mut self, line: Vec<u8>) {
        if self.console.client.is_some() {
            self.console.lines.push_back(line);
        }
    }

    /// Checks whether a wait of a client is over: returns the reply if it has come or the time limit has passed.
    pub(super) fn look(&mut self, waiting: &mut WaitingClient, time: Instant) -> Option<Reply> {
        while let Some(line) = self.read() {
            match (&mut waiting.reply, line) {
                (AwaitedReply::Answer, LinkLine::Reply(line)) => return Some(Reply::text(0, &line)),
                (AwaitedReply::Line, LinkLine::Reply(line)) => {
                    return Some(Reply::text(0, &[&line[..], b"\r\n"].concat()));
                }
                (AwaitedReply::Ready { after_error }, LinkLine::Reply(line) | LinkLine::Console(line)) => {
                    let is_ready = line == b"Ready";
                    *after_error |= line.to_ascii_lowercase().windows(5).any(|part| part == b"error");
                    let length = Duration::from_millis(READY_WITHIN.into());
                    (waiting.deadline, waiting.left) = (time + length, self.ticks(length));
                    let result = if *after_error { Readiness::ReadyAfterError } else { Readiness::Ready };
                    self.show(line);
                    if is_ready {
                        return Some(Reply::number(result as i32));
                    }
                }
                (AwaitedReply::Answer | AwaitedReply::Line, LinkLine::Console(line)) => self.show(line),
            }
        }
        if !self.has_passed(waiting, time) {
            return None;
        }
        Some(match waiting.reply {
            AwaitedReply::Answer => {
                self.board.log(&format!("client {}: the board has not answered", waiting.client));
                Reply::text(1, b"")
            }
            AwaitedReply::Line => Reply::text(TIMEOUT, b""),
            AwaitedReply::Ready { .. } if self.board.link.has_partial_line() => {
                Reply::number(Readiness::Partial as i32)
            }
            AwaitedReply::Ready { .. } => Reply::number(Readiness::NoData as i32),
        })
    }
}

/// The result of a call for a board that does not exist.
fn missing_board_result(call: &Call) -> i32 {
    if *call == Call::Lock {
        Lock::NotConnected as i32
    } else if *call == Call::Location {
        -1
    } else {
        1
    }
}
