//! The serial port of a board and the other end of its line.
//!
//! With files, a run is a function of its inputs: their characters arrive at the port's rate, beginning when the
//! program first polls for them. A terminal, a TCP peer or another program acts at any time: the run is then kept at
//! about real time, and the arrival times are no longer the same in every run. Without these options nothing is
//! connected.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, TcpListener};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use cc67_host::{End, Session, Target};
use kmotiondef::Ticks;
use runtime::{Event, EventKind};

use crate::cli::args::uart::UartArguments;
use crate::cli::io::output::{Draft, cannot_write};
use crate::cli::io::pace::Pace;
use crate::cli::io::pty::Terminal;
use crate::cli::io::terminal;

/// The number of ticks after which a run polls its peer: 9.99 ms.
const PART: u64 = 111;
/// The number of chunks that a peer may send ahead, and of characters on the line, from which it has to wait.
const AHEAD: usize = 16;
const BACKLOG: usize = 4096;
/// [`PART`] in time of the peer's clock; the run is about as fast as the board.
const PART_TIME: Duration = Duration::from_millis(10);

/// The other end, which runs in real time.
#[derive(Debug)]
struct Peer {
    name: String,
    /// The received bytes; ends when the peer disconnects.
    incoming: Receiver<Vec<u8>>,
    outgoing: Outgoing,
    /// A child process, whose end is awaited at the end of the run.
    child: Option<Child>,
}

/// The destination of characters for the peer.
struct Outgoing(Box<dyn Write>);

impl std::fmt::Debug for Outgoing {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Outgoing")
    }
}

/// Creates the peer given by the option.
fn peer(text: &str) -> Result<Peer> {
    match text.split_once(':') {
        Some(("tcp", port)) => tcp(port),
        Some(("run", command)) => program(command),
        None if text == "pty" => pty(),
        _ => bail!("`--uart {text}`: there are pty, tcp:PORT and run:COMMAND"),
    }
}

/// Waits for a client on this computer.
fn tcp(port: &str) -> Result<Peer> {
    let number: u16 = port.parse().with_context(|| format!("`--uart tcp:{port}`: not a port number"))?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, number))
        .with_context(|| format!("cannot listen on port {number}"))?;
    let address = listener.local_addr()?;
    terminal::note(&format!("serial port: waiting for a client on {address}"));
    let (stream, from) = listener.accept().context("serial port")?;
    stream.set_nodelay(true)?;
    let outgoing = Box::new(stream.try_clone()?);
    Ok(Peer::new(format!("client {from}"), stream, outgoing, None))
}

/// Starts a program whose input and output are connected to the line.
fn program(command: &str) -> Result<Peer> {
    let mut words = command.split_whitespace();
    let name = words.next().context("`--uart run:` names no program")?;
    let started = Command::new(name).args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let mut child = started.with_context(|| format!("cannot run `{name}`"))?;
    let (Some(outgoing), Some(incoming)) = (child.stdin.take(), child.stdout.take()) else {
        bail!("`{name}` has no input and output");
    };
    Ok(Peer::new(format!("program `{name}`"), incoming, Box::new(outgoing), Some(child)))
}

/// Opens a pseudo-terminal and prints its name.
fn pty() -> Result<Peer> {
    let line = Terminal::open().context("`--uart pty`")?;
    terminal::note(&format!("serial port: terminal {}", line.name()));
    let name = format!("terminal {}", line.name());
    Ok(Peer::new(name, line.controller()?, Box::new(line), None))
}

impl Peer {
    /// Reads the peer's data in the background.
    fn new(
        name: String,
        mut reader: impl Read + Send + 'static,
        outgoing: Box<dyn Write>,
        child: Option<Child>,
    ) -> Self {
        let (sender, incoming) = mpsc::sync_channel(AHEAD);
        thread::spawn(move || {
            let mut buffer = [0; 256];
            while let Ok(count) = reader.read(&mut buffer) {
                let bytes = buffer.get(..count).unwrap_or_default();
                if count == 0 || sender.send(bytes.to_vec()).is_err() {
                    break;
                }
            }
        });
        Self { name, incoming, outgoing: Outgoing(outgoing), child }
    }
}

/// Runs a session to the end of a tick.
type PartRunner<'a, T> = &'a mut dyn FnMut(&mut Session<T>, Ticks, &mut dyn FnMut(Event));

/// The line between the board and its other end; without one, nothing is connected.
#[derive(Debug, Default)]
pub(super) struct SerialLine {
    peer: Option<Peer>,
    output: Option<Draft>,
    /// The error that stopped writing.
    failed: Option<io::Error>,
    /// The characters from the board that are still to be passed to the peer.
    fresh: Vec<u8>,
    /// True if the loss of the peer has been reported.
    is_told: bool,
    /// The time for which each part of a run waits for the peer.
    patience: Duration,
}

impl SerialLine {
    /// Connects the other end of the port; waits for it if it must be present.
    pub(super) fn connect(uart: &UartArguments) -> Result<Self> {
        let peer = uart.uart.as_deref().map(peer).transpose()?;
        let output = uart.uart_output.as_deref().map(Draft::new).transpose()?;
        Ok(Self { peer, output, failed: None, fresh: Vec::new(), is_told: false, patience: PART_TIME })
    }

    /// Notes a character sent by the board.
    pub(super) fn note(&mut self, event: &Event) {
        if let EventKind::UartSent(byte) = event.kind {
            if self.peer.is_some() {
                self.fresh.push(byte);
            }
            if let Some(output) = &mut self.output
                && self.failed.is_none()
            {
                self.failed = output.write_all(&[byte]).err();
            }
        }
    }

    /// Notes that other code keeps the board at the pace of a clock, so that the line does not wait for the peer.
    pub(super) fn is_paced_elsewhere(&mut self) {
        self.patience = Duration::ZERO;
    }

    /// Runs the board to its end, or to the limit, together with the line; at the pace of a clock, if there is one.
    pub(super) fn run<T: Target>(
        &mut self,
        session: &mut Session<T>,
        limit: Ticks,
        pace: Option<&Pace>,
        sink: &mut dyn FnMut(Event),
    ) -> End {
        loop {
            let part = self.part(session.tick(), limit, pace.is_some());
            let end = session.run(part, &mut |event| {
                self.note(&event);
                sink(event);
            });
            self.exchange(session);
            if let Some(pace) = pace {
                pace.wait(session.tick());
            }
            if end != End::Limit || session.tick() >= limit {
                return end;
            }
        }
    }

    /// Runs the board to the end of a tick, even when its programs have ended, together with the line; `run` runs a
    /// part.
    pub(super) fn advance<T: Target>(
        &mut self,
        session: &mut Session<T>,
        limit: Ticks,
        sink: &mut dyn FnMut(Event),
        run: PartRunner<'_, T>,
    ) {
        loop {
            let part = self.part(session.tick(), limit, false);
            run(session, part, &mut |event| {
                self.note(&event);
                sink(event);
            });
            self.exchange(session);
            if session.tick() >= limit {
                return;
            }
        }
    }

    /// The tick at which the peer and the clock are polled next.
    fn part(&self, tick: Ticks, limit: Ticks, is_paced: bool) -> Ticks {
        let is_paced = self.peer.is_some() || is_paced;
        if is_paced { Ticks::new((tick.get() + PART).min(limit.get())) } else { limit }
    }

    /// Passes the board's characters to the peer, and the peer's to the line. While enough characters wait on the line,
    /// the peer's are not read.
    fn exchange<T: Target>(&mut self, session: &mut Session<T>) {
        let came = self.take(session.target().uart_backlog());
        if !came.is_empty() {
            session.send_to_uart(&came);
        }
    }

    /// Passes the board's characters to the peer and takes its characters, for the duration of a part of the run.
    fn take(&mut self, backlog: usize) -> Vec<u8> {
        let Some(peer) = &mut self.peer else { return Vec::new() };
        let fresh = std::mem::take(&mut self.fresh);
        let written = peer.outgoing.0.write_all(&fresh).and_then(|()| peer.outgoing.0.flush());
        if backlog >= BACKLOG {
            thread::sleep(self.patience);
            return Vec::new();
        }
        let mut came = Vec::new();
        let mut is_gone = written.is_err();
        match peer.incoming.recv_timeout(self.patience) {
            Ok(bytes) => came.extend(bytes),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                is_gone = true;
                // The run is kept at its pace: the peer may still read.
                thread::sleep(self.patience);
            }
        }
        came.extend(peer.incoming.try_iter().take(AHEAD).flatten());
        if is_gone && !self.is_told {
            self.is_told = true;
            terminal::note(&format!("serial port: {} is gone; the run continues without it", peer.name));
        }
        came
    }

    /// Ends the connection: lets the peer end, and writes the remaining characters.
    pub(super) fn finish(&mut self) -> Result<()> {
        if let Some(peer) = self.peer.take() {
            drop(peer.outgoing);
            if let Some(mut child) = peer.child {
                // It ends with its input, or is killed.
                thread::sleep(PART_TIME);
                let _ = child.kill();
                let _ = child.wait();
            }
        }
        let Some(output) = self.output.take() else { return Ok(()) };
        match self.failed.take() {
            Some(error) => Err(cannot_write(output.path(), &error)),
            None => output.commit(),
        }
    }
}
