//! Connections: checks each request, serves the files of the page, and serves a socket until it closes.

mod files;
mod gate;
mod http;
mod socket;

use std::io;
use std::net::{IpAddr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use cc67_host::seats::{Closer, Seat, Seats};
use cc67_host::{Session, Target};

use crate::Show;
use crate::board::{self, BoardUsers, LiveView, ShowEnd};
use crate::hub::{Hub, Incoming};
use gate::Gate;
use http::{Head, HttpAnswer};

/// The maximum number of connections at a time.
const CONNECTIONS: usize = 64;
/// The time limit for receiving a client's request, and for sending the response.
const PATIENCE: Duration = Duration::from_secs(5);
/// The pause after a connection that could not be accepted.
const PAUSE: Duration = Duration::from_millis(100);

/// The reason why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ListenError {
    /// The server cannot listen on the address.
    #[error("cannot listen on {address}: {error}")]
    Address {
        /// The address.
        address: SocketAddr,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The operating system has no random numbers for the token.
    #[error("no random numbers for the token: {0}")]
    Random(getrandom::Error),
}

/// A server that accepts connections of pages, and will show a board to them.
#[derive(Debug)]
pub struct Server {
    url: String,
    port: u16,
    token: String,
    hub: Arc<Hub>,
    requests: Receiver<Incoming>,
}

impl Server {
    /// Listens on an address of this computer; port 0 selects a free port. `token` is the token of an earlier server
    /// whose pages should be able to reconnect; without it, or if it is malformed, a new one is generated.
    ///
    /// # Errors
    /// [`ListenError`].
    pub fn listen(host: IpAddr, port: u16, token: Option<&str>) -> Result<Self, ListenError> {
        let address = SocketAddr::new(host, port);
        let failed = |error| ListenError::Address { address, error };
        let listener = TcpListener::bind(address).map_err(failed)?;
        let bound = listener.local_addr().map_err(failed)?;
        let gate = Gate::new(bound, token).map_err(ListenError::Random)?;
        let (url, token) = (gate.url(), gate.token().to_owned());
        let (hub, requests) = Hub::new();
        let shared = Arc::clone(&hub);
        thread::spawn(move || accept(&listener, &Arc::new(gate), &shared));
        Ok(Self { url, port: bound.port(), token, hub, requests })
    }

    /// The URL of the page, with the token.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// The port on which it listens.
    #[must_use]
    pub const fn port(&self) -> u16 {
        self.port
    }

    /// The token of its pages.
    #[must_use]
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Runs a board and shows it, until its time limit, or until another machine is requested; `check` reports whether
    /// a board can be made from it.
    pub fn run<T: Target>(
        &self,
        session: &mut Session<T>,
        show: Show,
        company: BoardUsers<T>,
        check: &mut dyn FnMut() -> Result<(), String>,
    ) -> ShowEnd {
        board::run(session, show, company, check, (&self.hub, &self.requests))
    }

    /// Shows a board run by other code.
    pub fn view<T: Target>(self, session: &mut Session<T>, show: Show) -> LiveView<T> {
        board::view(session, show, &self.hub, self.requests)
    }
}

/// Accepts connections forever, each on a separate thread.
fn accept(listener: &TcpListener, gate: &Arc<Gate>, hub: &Arc<Hub>) {
    let seats = Seats::new(CONNECTIONS);
    for stream in listener.incoming() {
        let Ok(stream) = stream else {
            // The client has disconnected, or the operating system has no file descriptor left.
            thread::sleep(PAUSE);
            continue;
        };
        let close = stream.try_clone().map(|stream| {
            // A connection that is already closed needs no closing.
            Box::new(move || drop(stream.shutdown(Shutdown::Both))) as Closer
        });
        let Some(admission) = seats.take(close.ok()) else {
            hub.log("there are too many connections", "");
            continue;
        };
        if admission.has_closed_another {
            hub.log("there are too many connections; the one that was silent the longest is closed", "");
        }
        let (gate, own) = (Arc::clone(gate), Arc::clone(hub));
        let spawned = thread::Builder::new().spawn(move || {
            // A failure affects only that client.
            let _ = serve(stream, &admission.seat, &gate, &own);
        });
        if spawned.is_err() {
            hub.log("there is no thread for a connection", "");
        }
    }
}

/// Serves one connection: one request, or a socket.
fn serve(mut stream: TcpStream, seat: &Seat, gate: &Gate, hub: &Arc<Hub>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let Some(head) = Head::read(&mut stream)? else {
        hub.log("a client sent what is not HTTP", "");
        return HttpAnswer::problem(400, "this is not HTTP").send(&mut stream);
    };
    if let Err(refusal) = gate.check(&head) {
        hub.log(refusal.why(), "");
        let why = format!("{}\nOpen the address that cc67 printed when it started.", refusal.why());
        return HttpAnswer::problem(403, &why).send(&mut stream);
    }
    match head.path() {
        "/socket" => match head.websocket_key() {
            Some(key) => socket::serve(stream, key, seat, hub),
            None => HttpAnswer::problem(400, "this address is for WebSocket").send(&mut stream),
        },
        path => match files::find(path) {
            Some(file) => HttpAnswer::file(file).send(&mut stream),
            None => HttpAnswer::problem(404, "there is no such page").send(&mut stream),
        },
    }
}
