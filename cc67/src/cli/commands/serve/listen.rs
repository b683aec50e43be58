//! Listeners: sockets and ports, and a thread for each connection.
//!
//! The thread of a connection reads requests, passes them to the [dispatcher](super::desk) and sends its answers. It
//! alone waits for its client: a client that sends half a message, or does not read its reply, blocks nobody else. At a
//! pseudo-terminal and a raw port the board's own bytes are [passed on](super::carry).

use std::io::{self, Read};
use std::iter;
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use cc67_host::seats::{FIRST_WORDS, Seat, Seats};

use super::carry::plug_client;
use super::connection::{self, ClientConnection, Received};
use super::desk::DispatcherMessage;
use super::message::Request;
use super::pipe;
use crate::cli::io::pty::Terminal;
use crate::cli::io::terminal;

/// The maximum number of connections at a time.
pub(in crate::cli::commands) const MOST_CLIENTS: usize = 200;
/// The pause after the operating system had no file descriptor for a connection.
const PAUSE: Duration = Duration::from_millis(100);
/// The reply to a client that sends text.
const NO_TEXT: &[u8] =
    b"cc67: a board is served here to programs that use the KMotion client library (4.34), not as text; to type commands: cc67 console\r\n";
/// The address of a pseudo-terminal, and the prefix of the addresses of raw ports, which carry the board's own bytes.
const TERMINAL: &str = "pty";
const RAW_PORT: &str = "tcp-raw:";

/// Socket files, which are removed at the end.
#[derive(Debug, Default)]
pub(super) struct SocketFiles(Vec<PathBuf>);

impl Drop for SocketFiles {
    fn drop(&mut self) {
        for path in &self.0 {
            // A file that someone has already removed needs no removal.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// The path of connections to the dispatchers.
#[derive(Clone, Debug)]
pub(super) struct ConnectionRouter {
    /// The dispatcher of the first board, which also answers for boards that do not exist.
    dispatcher: Sender<DispatcherMessage>,
    /// The dispatchers of the other boards.
    others: Arc<[Sender<DispatcherMessage>]>,
    /// The number of connections so far.
    numbers: Arc<AtomicU64>,
    /// The seats of the connected clients.
    seats: Seats,
}

/// Accepts connections at these addresses in the background and passes them to the boards' dispatchers; `option` is the
/// option with the addresses.
pub(super) fn listen(
    addresses: &[String],
    option: &str,
    dispatchers: &[Sender<DispatcherMessage>],
) -> Result<SocketFiles> {
    let (dispatcher, others) = dispatchers.split_first().context("a board is served")?;
    let router = ConnectionRouter {
        dispatcher: dispatcher.clone(),
        others: others.into(),
        numbers: Arc::default(),
        seats: Seats::new(MOST_CLIENTS),
    };
    let mut places = SocketFiles::default();
    for address in addresses {
        let complaint = || format!("`{option} {address}`");
        if let Some(port) = address.strip_prefix("tcp:") {
            listen_on_port(port, &router).with_context(complaint)?;
        } else if let Some(port) = address.strip_prefix(RAW_PORT) {
            carry_on_port(port, &router).with_context(complaint)?;
        } else if let Some(name) = pipe::name(address) {
            pipe::listen(&name, &router).with_context(complaint)?;
        } else if address == TERMINAL {
            carry_on_terminal(&router).with_context(complaint)?;
        } else if address.contains(':') && !address.contains('/') {
            bail!(
                "{}: neither tcp:PORT, tcp-raw:PORT, pty, pipe[:NAME] nor the path of a socket",
                complaint()
            );
        } else {
            places.0.push(listen_on_path(address, &router).with_context(complaint)?);
        }
    }
    Ok(places)
}

/// Returns whether an address is for a single client of the board's link.
pub(super) fn is_wire(address: &str) -> bool {
    address == TERMINAL || address.starts_with(RAW_PORT)
}

/// Creates a pseudo-terminal that carries the board's own bytes.
fn carry_on_terminal(router: &ConnectionRouter) -> Result<()> {
    let terminal = Terminal::open()?;
    terminal::note(&format!("a board is served on serial:{}", terminal.name()));
    let writer = terminal.controller()?;
    let router = router.clone();
    in_background(move || {
        let number = router.numbers.fetch_add(1, Ordering::Relaxed) + 1;
        plug_client(number, &router.dispatcher, writer).carry(terminal);
    })
}

/// Accepts connections that carry the board's own bytes, one at a time.
fn carry_on_port(port: &str, router: &ConnectionRouter) -> Result<()> {
    let listener = bind(port)?;
    terminal::note(&format!("a board is served on tcp:localhost:{}", listener.local_addr()?.port()));
    let (router, link) = (router.clone(), RawLink::default());
    in_background(move || {
        // Small messages should be sent at once; without this setting they are only delayed.
        let streams = connections(listener.incoming()).inspect(|stream| drop(stream.set_nodelay(true)));
        streams.for_each(|stream| link.admit(stream, &router));
    })
}

/// The board's link at a raw port, for one client at a time: a client that has sent nothing loses it to the next one.
#[derive(Clone, Debug, Default)]
struct RawLink(Arc<Mutex<Option<Holder>>>);

/// The client that has the link.
#[derive(Debug)]
struct Holder {
    number: u64,
    stream: TcpStream,
    has_spoken: Arc<AtomicBool>,
}

impl RawLink {
    fn holder(&self) -> MutexGuard<'_, Option<Holder>> {
        // The value is consistent at all times.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Passes on the bytes of a client in a separate thread, or rejects it.
    fn admit(&self, stream: TcpStream, router: &ConnectionRouter) {
        let number = router.numbers.fetch_add(1, Ordering::Relaxed) + 1;
        if let Err(why) = self.carry(number, stream, router) {
            terminal::note(&format!("client {number}: refused, {why}"));
        }
    }

    fn carry(&self, number: u64, stream: TcpStream, router: &ConnectionRouter) -> Result<()> {
        let writer = stream.try_clone()?;
        let (has_spoken, before) = self.take(number, &stream)?;
        // The dispatcher must learn of the new client before the end of the previous one.
        let plugged = plug_client(number, &router.dispatcher, writer);
        if let Some(before) = before {
            // The previous client may already have disconnected.
            let _ = before.shutdown(Shutdown::Both);
        }
        let link = self.clone();
        let spawned = in_background(move || {
            plugged.carry(FirstBytes { stream, has_spoken });
            link.leave(number);
        });
        spawned.inspect_err(|_| self.leave(number))
    }

    /// Gives the link to a client; returns the flag for its first data, and the stream of the previous client.
    fn take(&self, number: u64, stream: &TcpStream) -> Result<(Arc<AtomicBool>, Option<TcpStream>)> {
        let stream = stream.try_clone()?;
        let mut holder = self.holder();
        if holder.as_ref().is_some_and(|holder| holder.has_spoken.load(Ordering::Relaxed)) {
            bail!("another one has the link");
        }
        let has_spoken = Arc::new(AtomicBool::new(false));
        let before = holder.replace(Holder { number, stream, has_spoken: Arc::clone(&has_spoken) });
        if let Some(before) = &before {
            let silent = before.number;
            terminal::note(&format!(
                "client {number}: has the link of client {silent}, which has sent nothing"
            ));
        }
        Ok((has_spoken, before.map(|before| before.stream)))
    }

    /// Handles the end of a client.
    fn leave(&self, number: u64) {
        self.holder().take_if(|holder| holder.number == number);
    }
}

/// The bytes of a client; sets a flag with the first of them.
#[derive(Debug)]
struct FirstBytes {
    stream: TcpStream,
    has_spoken: Arc<AtomicBool>,
}

impl Read for FirstBytes {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.has_spoken.fetch_or(count > 0, Ordering::Relaxed);
        Ok(count)
    }
}

fn bind(port: &str) -> Result<TcpListener> {
    let number: u16 = port.parse().with_context(|| format!("`{port}` is not a port number"))?;
    TcpListener::bind((Ipv4Addr::LOCALHOST, number)).context("cannot listen there")
}

fn listen_on_port(port: &str, router: &ConnectionRouter) -> Result<()> {
    let listener = bind(port)?;
    terminal::note(&format!("a board is served on tcp:{}", listener.local_addr()?.port()));
    let router = router.clone();
    in_background(move || {
        // Small messages should be sent at once; without this setting they are only delayed.
        let streams = connections(listener.incoming()).inspect(|stream| drop(stream.set_nodelay(true)));
        streams.for_each(|stream| router.enter(stream));
    })
}

/// Connections as they come, with a pause if the operating system has no file descriptor for one.
fn connections<S>(incoming: impl Iterator<Item = io::Result<S>>) -> impl Iterator<Item = S> {
    incoming.filter_map(|connection| connection.inspect_err(|_| thread::sleep(PAUSE)).ok())
}

/// Runs in a separate thread.
fn in_background(work: impl FnOnce() + Send + 'static) -> Result<()> {
    thread::Builder::new().spawn(work).context("there is no thread for it")?;
    Ok(())
}

#[cfg(unix)]
fn listen_on_path(address: &str, router: &ConnectionRouter) -> Result<PathBuf> {
    use std::os::unix::net::{UnixListener, UnixStream};

    // A socket left by a killed server serves nobody.
    let is_socket = std::fs::symlink_metadata(address)
        .is_ok_and(|known| std::os::unix::fs::FileTypeExt::is_socket(&known.file_type()));
    if is_socket {
        if UnixStream::connect(address).is_ok() {
            bail!("another server listens there");
        }
        std::fs::remove_file(address).context("cannot replace it")?;
    }
    let listener = UnixListener::bind(address).context("cannot listen there")?;
    terminal::note(&format!("a board is served on {address}"));
    let router = router.clone();
    in_background(move || connections(listener.incoming()).for_each(|stream| router.enter(stream)))?;
    Ok(std::path::absolute(address).unwrap_or_else(|_| address.into()))
}

#[cfg(not(unix))]
fn listen_on_path(_: &str, _: &ConnectionRouter) -> Result<PathBuf> {
    bail!("this system has no such sockets; tcp:PORT works everywhere")
}

impl ConnectionRouter {
    /// The dispatchers of all boards.
    fn dispatchers(&self) -> impl Iterator<Item = &Sender<DispatcherMessage>> {
        iter::once(&self.dispatcher).chain(&*self.others)
    }

    /// The dispatcher for a request.
    fn dispatcher_for(&self, request: &Request) -> &Sender<DispatcherMessage> {
        let index = request.index(1 + self.others.len()).unwrap_or(0);
        self.dispatchers().nth(index).unwrap_or(&self.dispatcher)
    }

    /// Serves a connection in a separate thread; if there are too many, closes the one that has been silent the
    /// longest.
    pub(super) fn enter(&self, connection: impl ClientConnection) {
        let number = self.numbers.fetch_add(1, Ordering::Relaxed) + 1;
        let Some(admission) = self.seats.take(connection.closer()) else {
            terminal::note(&format!("client {number}: refused, {MOST_CLIENTS} are connected"));
            return;
        };
        if admission.has_closed_another {
            terminal::note(&format!(
                "client {number}: {MOST_CLIENTS} are connected; the one that was silent the longest is disconnected"
            ));
        }
        let router = self.clone();
        let spawned =
            thread::Builder::new().spawn(move || serve(number, connection, &admission.seat, &router));
        if spawned.is_err() {
            terminal::note(&format!("client {number}: refused, there is no thread for it"));
        }
    }
}

/// Answers requests until the client disconnects, or makes an invalid request.
fn serve(number: u64, mut connection: impl ClientConnection, seat: &Seat, router: &ConnectionRouter) {
    connection.limit_wait(Some(FIRST_WORDS));
    let mut received = connection.receive_first();
    connection.limit_wait(None);
    match received {
        Received::Text => return connection.refuse(NO_TEXT),
        Received::OldLibrary => {
            terminal::note(&format!(
                "client {number}: its library is that of KMotion 4.32, whose messages have no length; it needs that of 4.34"
            ));
            return;
        }
        // A connection that only checks for a server is not a client for which `--once` waits.
        Received::Nothing => return,
        Received::Message(_) => {}
    }
    let (answers, inbox) = channel();
    for dispatcher in router.dispatchers() {
        // If the dispatcher has ended, there is no answer below.
        let _ = dispatcher.send(DispatcherMessage::Connected(number, answers.clone()));
    }
    while let Received::Message(bytes) = &received {
        seat.mark_active();
        let Some(request) = Request::read(bytes) else {
            // An error means that the dispatcher has ended.
            let _ = router.dispatcher.send(DispatcherMessage::Unknown(number, bytes.clone()));
            break;
        };
        if router.dispatcher_for(&request).send(DispatcherMessage::Request(number, request)).is_err() {
            break;
        }
        let Ok(messages) = inbox.recv() else { break };
        if connection::answer(&mut connection, &messages).is_none() {
            break;
        }
        received = connection.receive();
    }
    for dispatcher in router.dispatchers() {
        // An error means that the dispatcher has already ended.
        let _ = dispatcher.send(DispatcherMessage::Disconnected(number));
    }
}
