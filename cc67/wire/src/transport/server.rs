//! A board connected to the vendor's server, shared with the vendor's programs. Source: host-protocol.md section 8;
//! wire.md sections 5 and 6.
//!
//! The server forwards lines, not bytes. The client's data are split into lines and requested one by one; replies and
//! console lines are converted back to bytes, so that the client above is the same as for other links. The server
//! itself serves the files that programs open, in its own folder, while it waits for a reply.

use std::io;
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

use super::messages::{Framed, Messages};
use super::{pipe, tcp};
use crate::address::ServerAddress;
use crate::clock::now;
use crate::error::WireError;
use crate::link::{BoardLink, ClaimResult, LinkEnds, Outgoing};

/// Codes of requests.
const WRITE_LINE: i32 = 1;
const READ_LINE: i32 = 3;
const LOCK: i32 = 9;
const RELEASE: i32 = 12;
const SERVICE_CONSOLE: i32 = 13;
const SET_CONSOLE: i32 = 14;
/// The number of the server's first board.
const BOARD: i32 = 0;
/// The name under which the token is taken.
const NAME: &[u8] = b"cc67\0";
/// Results of taking the token.
const LOCKED: i32 = 0;
const IN_USE: i32 = 1;
/// The time limit for the server's answer: it may have to connect to the board, and to read a line.
const ANSWER_WITHIN: Duration = Duration::from_secs(10);
/// The time of a single wait for a reply, in milliseconds.
const READ_FOR: i32 = 10;
/// The interval between requests for the console while nothing else happens.
const CONSOLE_EACH: Duration = Duration::from_millis(20);
/// The interval between attempts to take the token.
const LOCK_EACH: Duration = Duration::from_millis(10);
/// The abort byte, and its answer, which is made up here because the server does the connecting.
const ABORT: u8 = 0x03;
const ABORTED: &[u8] = b"\x1bC\r";

pub(super) fn open(address: &ServerAddress, place: String) -> Result<BoardLink, WireError> {
    let fail = |error| WireError::Open { place: place.clone(), error };
    let messages: Box<dyn Messages> = match address {
        ServerAddress::Tcp(host, port) => {
            let stream = tcp::connect(host, *port).map_err(fail)?;
            stream.set_read_timeout(Some(ANSWER_WITHIN)).map_err(fail)?;
            Box::new(Framed(stream))
        }
        ServerAddress::Socket(path) => socket(path, &place)?,
        ServerAddress::Pipe => Box::new(pipe::open(&place)?),
    };
    let (link, ends) = BoardLink::with_ends(place, true);
    let connection = Connection { messages, line: Vec::new(), received: Vec::new(), is_claimed: false };
    std::thread::spawn(move || connection.serve(&ends));
    Ok(link)
}

#[cfg(unix)]
fn socket(path: &str, place: &str) -> Result<Box<dyn Messages>, WireError> {
    let fail = |error| WireError::Open { place: place.to_owned(), error };
    let stream = std::os::unix::net::UnixStream::connect(path).map_err(fail)?;
    stream.set_read_timeout(Some(ANSWER_WITHIN)).map_err(fail)?;
    stream.set_write_timeout(Some(ANSWER_WITHIN)).map_err(fail)?;
    Ok(Box::new(Framed(stream)))
}

#[cfg(not(unix))]
fn socket(_: &str, place: &str) -> Result<Box<dyn Messages>, WireError> {
    let reason = "this system has no such sockets; server:HOST:PORT works everywhere".into();
    Err(WireError::NotBuilt { place: place.to_owned(), reason })
}

/// A connection to the server.
struct Connection {
    messages: Box<dyn Messages>,
    /// The beginning of an incomplete line.
    line: Vec<u8>,
    /// The bytes received from the board.
    received: Vec<u8>,
    /// True if this client holds the token; only then are replies meant for it.
    is_claimed: bool,
}

/// A normal reply.
struct Reply {
    result: i32,
    data: Vec<u8>,
}

impl Connection {
    /// Serves one end of a link until the other is dropped, or the server is disconnected.
    fn serve(mut self, ends: &LinkEnds) {
        // A server that does not answer ends the link.
        let _ = self.run(ends);
        let _ = ends.received.send(std::mem::take(&mut self.received));
    }

    fn run(&mut self, ends: &LinkEnds) -> io::Result<()> {
        self.request(SET_CONSOLE, &[])?;
        while !ends.is_closed.load(Ordering::Relaxed) {
            let pause = if self.is_claimed { Duration::ZERO } else { CONSOLE_EACH };
            match ends.requests.recv_timeout(pause) {
                Ok(Outgoing::Bytes(bytes)) => {
                    for byte in &bytes {
                        self.send(*byte)?;
                    }
                    ends.unwritten.fetch_sub(bytes.len(), Ordering::Relaxed);
                }
                Ok(Outgoing::Claim(until, answer)) => {
                    let claimed = self.claim(until)?;
                    // The requester may have given up.
                    let _ = answer.send(claimed);
                }
                Ok(Outgoing::Release) => {
                    self.is_claimed = false;
                    self.request(RELEASE, &[])?;
                }
                Err(RecvTimeoutError::Timeout) if self.is_claimed => self.read_line()?,
                Err(RecvTimeoutError::Timeout) => drop(self.request(SERVICE_CONSOLE, &[])?),
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if !self.received.is_empty() && ends.received.send(std::mem::take(&mut self.received)).is_err() {
                break;
            }
        }
        if self.is_claimed {
            self.request(RELEASE, &[])?;
        }
        Ok(())
    }

    /// Takes the token, with repeated attempts until a given time.
    fn claim(&mut self, until: std::time::Instant) -> io::Result<ClaimResult> {
        loop {
            match self.request(LOCK, NAME)?.result {
                LOCKED => {
                    self.is_claimed = true;
                    return Ok(ClaimResult::Taken);
                }
                IN_USE if now() < until => std::thread::sleep(LOCK_EACH),
                IN_USE => return Ok(ClaimResult::InUse),
                _ => return Ok(ClaimResult::NotConnected),
            }
        }
    }

    /// Processes a byte for the board.
    fn send(&mut self, byte: u8) -> io::Result<()> {
        match byte {
            ABORT => {
                self.line.clear();
                self.received.extend_from_slice(ABORTED);
                // The rest of an earlier reply is not meant for this client.
                Ok(())
            }
            b'\r' => {
                let line = std::mem::take(&mut self.line);
                // The server itself prepends the two bytes that switch the echo off.
                let text = line.strip_prefix(b"\x1b\x01").unwrap_or(&line);
                self.request(WRITE_LINE, &[text, b"\0"].concat()).map(drop)
            }
            byte => {
                self.line.push(byte);
                Ok(())
            }
        }
    }

    fn read_line(&mut self) -> io::Result<()> {
        let reply = self.request(READ_LINE, &READ_FOR.to_le_bytes())?;
        if reply.result == 0 {
            let text = reply.data.split(|byte| *byte == 0).next().unwrap_or_default();
            self.received.extend_from_slice(text);
        }
        Ok(())
    }

    /// Sends a request and returns its reply; console lines that come before it are stored.
    fn request(&mut self, code: i32, arguments: &[u8]) -> io::Result<Reply> {
        let body = [&code.to_le_bytes()[..], &BOARD.to_le_bytes(), arguments].concat();
        self.messages.send(&body)?;
        loop {
            let message = self.messages.receive()?;
            let (kind, rest) = message.split_first().ok_or(io::ErrorKind::InvalidData)?;
            match kind {
                0 => {
                    let (result, data) = rest.split_first_chunk().ok_or(io::ErrorKind::InvalidData)?;
                    return Ok(Reply { result: i32::from_le_bytes(*result), data: data.to_vec() });
                }
                1 => {
                    let text = rest.split(|byte| *byte == 0).next().unwrap_or_default();
                    self.received.extend([b"\x1b", text].concat());
                    self.messages.acknowledge()?;
                }
                // The text of an error, such as a lost link.
                _ => self.messages.acknowledge()?,
            }
        }
    }
}
