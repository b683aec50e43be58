//! `cc67 console --serve`: a board for programs of the PC, in place of the vendor's server process.
//!
//! The vendor's client library talks to a process that owns the board, over a socket; that process is this one. Each
//! connection is a client of the board ([`cc67_host::Board`]) with the token and the connection of its own. The board
//! keeps pace with the clock; with `--fast` its time passes only in exchanges.

mod message;

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use anyhow::{Context, Result, bail};
use cc67_host::{Board, HostError, Lock};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::{BEAT, ConsoleArguments};
use crate::cli::args::trace::TraceArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::Pace;
use crate::cli::io::terminal;
use crate::cli::session::Setup;
use message::{Call, Reply, Request};

/// Console lines that go out before one reply at most.
const LINES_AT_ONCE: usize = 10;
/// What a client answers to a console line.
const ACKNOWLEDGED: u8 = 0xAA;

/// A connection, whatever it goes over.
trait Stream: Read + Write + Send {}

impl<T: Read + Write + Send> Stream for T {}

/// What all connections share.
struct Desk {
    /// The connection that receives the console; 0 is none.
    console: AtomicU64,
    /// The clock that the board keeps pace with, if it does.
    pace: Option<Pace>,
}

/// Serves clients until the board time of `--for` has passed, or forever.
pub(super) fn serve(arguments: &ConsoleArguments, setup: Setup, address: &str) -> Result<Exit> {
    if arguments.board.uart.is_given() {
        bail!("`--serve`: the serial port of a board that is served cannot be connected yet");
    }
    let TraceArguments { trace, trace_bits, plot, .. } = &arguments.trace;
    if !trace.is_empty() || trace_bits.is_some() || !plot.is_empty() {
        bail!("`--serve`: a board that is served cannot be traced yet");
    }
    let (mut board, flash) = setup.shared()?;
    let pace = (!arguments.fast).then(|| Pace::new(tick(&mut board)));
    let desk = Arc::new(Desk { console: AtomicU64::new(0), pace });
    listen(address, &board, &desk)?;
    let limit = arguments.limit.map_or(u64::MAX, |seconds| (seconds / TIMEBASE).round() as u64);
    while tick(&mut board).get() < limit {
        thread::sleep(BEAT);
        if let Some(pace) = &desk.pace {
            let behind = pace.due().get().saturating_sub(tick(&mut board).get());
            board.run_for(behind as f64 * TIMEBASE);
        }
        while let Some(remark) = board.take_remark() {
            terminal::note(&remark);
        }
    }
    let now = board.with_session(|session| session.board().flash().to_vec());
    flash.keep(&now)?;
    Ok(Exit::Success)
}

fn tick(board: &mut Board) -> Ticks {
    board.with_session(|session| session.tick())
}

/// Takes connections in the background.
fn listen(address: &str, board: &Board, desk: &Arc<Desk>) -> Result<()> {
    let (board, desk) = (board.another_client(), Arc::clone(desk));
    if let Some(port) = address.strip_prefix("tcp:") {
        let number: u16 =
            port.parse().with_context(|| format!("`--serve {address}`: `{port}` is not a port number"))?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, number))
            .with_context(|| format!("cannot listen on port {number}"))?;
        terminal::note(&format!("a board is served on tcp:{}", listener.local_addr()?.port()));
        thread::spawn(move || {
            let streams = listener.incoming().flatten();
            accept(streams.inspect(|stream| drop(stream.set_nodelay(true))), &board, &desk);
        });
        return Ok(());
    }
    if address.contains(':') && !address.contains('/') {
        bail!("`--serve {address}`: neither tcp:PORT nor the path of a socket");
    }
    listen_on_path(address, board, desk)
}

#[cfg(unix)]
fn listen_on_path(address: &str, board: Board, desk: Arc<Desk>) -> Result<()> {
    use std::os::unix::net::{UnixListener, UnixStream};

    // What a server that was killed has left behind serves nobody.
    let is_socket = std::fs::symlink_metadata(address)
        .is_ok_and(|known| std::os::unix::fs::FileTypeExt::is_socket(&known.file_type()));
    if is_socket {
        if UnixStream::connect(address).is_ok() {
            bail!("`--serve {address}`: another server is already running");
        }
        std::fs::remove_file(address).with_context(|| format!("cannot replace {address}"))?;
    }
    let listener = UnixListener::bind(address).with_context(|| format!("cannot listen on {address}"))?;
    terminal::note(&format!("a board is served on {address}"));
    thread::spawn(move || accept(listener.incoming().flatten(), &board, &desk));
    Ok(())
}

#[cfg(not(unix))]
fn listen_on_path(address: &str, _: Board, _: Arc<Desk>) -> Result<()> {
    bail!("`--serve {address}`: this system has no such sockets; tcp:PORT works everywhere")
}

/// Serves each connection in a thread of its own.
fn accept<S: Stream + 'static>(streams: impl Iterator<Item = S>, board: &Board, desk: &Arc<Desk>) {
    for (number, stream) in (1..).zip(streams) {
        let (board, desk) = (board.another_client(), Arc::clone(desk));
        thread::spawn(move || Connection { number, stream, board, desk }.serve());
    }
}

/// One client program's connection. When it ends, the client loses the token.
struct Connection<S> {
    number: u64,
    stream: S,
    board: Board,
    desk: Arc<Desk>,
}

impl<S: Stream> Connection<S> {
    /// Answers requests until the client goes, or asks for what does not exist.
    fn serve(mut self) {
        while let Some(bytes) = message::read(&mut self.stream) {
            let Some(request) = Request::read(&bytes) else { break };
            let reply = self.answer(&request);
            if self.send_console().and_then(|()| message::write(&mut self.stream, &reply.bytes())).is_none() {
                break;
            }
            if let Some(pace) = &self.desk.pace {
                pace.wait(tick(&mut self.board));
            }
        }
        // Whoever has it next has said so.
        let _ = self.desk.console.compare_exchange(self.number, 0, Ordering::SeqCst, Ordering::SeqCst);
    }

    /// Sends console lines if they are this client's; `None` if it is gone.
    fn send_console(&mut self) -> Option<()> {
        if self.desk.console.load(Ordering::SeqCst) != self.number {
            return Some(());
        }
        for _ in 0..LINES_AT_ONCE {
            let Some(line) = self.board.service_console() else { break };
            message::write(&mut self.stream, &message::console_line(&line))?;
            let mut answer = [0];
            self.stream.read_exact(&mut answer).ok().filter(|()| answer == [ACKNOWLEDGED])?;
        }
        Some(())
    }

    fn answer(&mut self, request: &Request) -> Reply {
        let board = &mut self.board;
        let done = |result: Result<(), HostError>| Reply::number(i32::from(result.is_err()));
        let locations = board.list_locations();
        if !request.is_for(&locations) {
            return Reply::number(if request.call == Call::Lock { Lock::NotConnected as i32 } else { 1 });
        }
        match &request.call {
            Call::WriteLineReadLine(line) => match board.write_line_read_line(line) {
                Ok(line) => Reply::text(0, &line),
                Err(_) => Reply::text(1, ""),
            },
            Call::WriteLine(line) => done(board.write_line(line)),
            Call::WriteLineWithEcho(line) => done(board.write_line_with_echo(line)),
            Call::ReadLine(milliseconds) => match board.read_line_timeout(*milliseconds) {
                Ok(line) => Reply::text(0, &line),
                Err(_) => Reply::text(2, ""),
            },
            Call::ListLocations => Reply::numbers(&locations),
            Call::Failed | Call::Disconnect => {
                board.failed();
                Reply::number(0)
            }
            Call::FirmwareVersion => Reply::number(board.firmware_version()),
            Call::CheckForReady => Reply::number(board.check_for_ready().map_or(0, |state| state as i32)),
            Call::Lock => Reply::number(board.kmotion_lock() as i32),
            Call::Location => Reply::number(locations.first().copied().unwrap_or(-1)),
            Call::Release => {
                board.release_token();
                Reply::number(0)
            }
            // The console goes out before the reply.
            Call::ServiceConsole => Reply::number(0),
            Call::SetConsole => {
                self.desk.console.store(self.number, Ordering::SeqCst);
                Reply::number(0)
            }
        }
    }
}
