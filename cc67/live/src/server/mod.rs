//! Connections: checks each request, serves the files of the page, and serves a socket until it closes.

mod files;
mod gate;
mod http;
mod socket;

use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use cc67_host::{Attendant, Session, Target};

use crate::board::{self, Company, LiveView};
use crate::desk::{Desk, Incoming};
use crate::{Keeper, Show};
use gate::Gate;
use http::{Head, HttpAnswer};

/// Connections at a time.
const CONNECTIONS: usize = 64;
/// How long a client may take to say what it wants, and to take what it gets.
const PATIENCE: Duration = Duration::from_secs(5);

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ListenError {
    /// The address cannot be listened on.
    #[error("cannot listen on {address}: {error}")]
    Address {
        /// The address.
        address: SocketAddr,
        /// Why not.
        error: io::Error,
    },
    /// The computer has no random numbers for the token.
    #[error("no random numbers for the token: {0}")]
    Random(getrandom::Error),
}

/// A server that waits for pages, and will show them a board.
#[derive(Debug)]
pub struct Server {
    url: String,
    desk: Arc<Desk>,
    requests: Receiver<Incoming>,
}

impl Server {
    /// Listens on an address of this computer; port 0 is one that is free.
    ///
    /// # Errors
    /// [`ListenError`].
    pub fn listen(host: IpAddr, port: u16) -> Result<Self, ListenError> {
        let address = SocketAddr::new(host, port);
        let failed = |error| ListenError::Address { address, error };
        let listener = TcpListener::bind(address).map_err(failed)?;
        let bound = listener.local_addr().map_err(failed)?;
        let gate = Gate::new(bound).map_err(ListenError::Random)?;
        let url = gate.url();
        let (desk, requests) = Desk::new();
        let shared = Arc::clone(&desk);
        thread::spawn(move || accept(&listener, &Arc::new(gate), &shared));
        Ok(Self { url, desk, requests })
    }

    /// The address of the page, with the token.
    #[must_use]
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Runs a board and shows it, until its time has passed; an attendant may stop it, a keeper sees its events first.
    pub fn run<T: Target>(
        self,
        session: &mut Session<T>,
        show: Show,
        attendant: Option<Box<dyn Attendant<T>>>,
        keeper: Box<dyn Keeper<T>>,
    ) {
        let company = Company { attendant, keeper: Some(keeper) };
        board::run(session, show, company, (&self.desk, &self.requests));
    }

    /// Shows a board that somebody else runs.
    pub fn view<T: Target>(self, session: &mut Session<T>, show: Show) -> LiveView<T> {
        board::view(session, show, &self.desk, self.requests)
    }
}

/// Takes connections forever, each on a thread of its own.
fn accept(listener: &TcpListener, gate: &Arc<Gate>, desk: &Arc<Desk>) {
    let count = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        // A client that is gone before it is taken.
        let Ok(stream) = stream else { continue };
        if count.load(Ordering::Relaxed) >= CONNECTIONS {
            desk.log("there are too many connections", "");
            continue;
        }
        count.fetch_add(1, Ordering::Relaxed);
        let (gate, desk, count) = (Arc::clone(gate), Arc::clone(desk), Arc::clone(&count));
        thread::spawn(move || {
            // What goes wrong is that client's loss.
            let _ = serve(stream, &gate, &desk);
            count.fetch_sub(1, Ordering::Relaxed);
        });
    }
}

/// Serves one connection: one request, or a socket.
fn serve(mut stream: TcpStream, gate: &Gate, desk: &Arc<Desk>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let Some(head) = Head::read(&mut stream)? else {
        desk.log("a client sent what is not HTTP", "");
        return HttpAnswer::problem(400, "this is not HTTP").send(&mut stream);
    };
    if let Err(refusal) = gate.check(&head) {
        desk.log(refusal.why(), "");
        return HttpAnswer::problem(403, refusal.why()).send(&mut stream);
    }
    match head.path() {
        "/socket" => match head.websocket_key() {
            Some(key) => socket::serve(stream, key, desk),
            None => HttpAnswer::problem(400, "this address is for WebSocket").send(&mut stream),
        },
        path => match files::find(path) {
            Some(file) => HttpAnswer::file(file).send(&mut stream),
            None => HttpAnswer::problem(404, "there is no such page").send(&mut stream),
        },
    }
}
