//! A debugger for a board run by other code: a server for PC programs, or a page.
//!
//! The owner of the session lets time pass through an [`AttachPoint`]. An editor that connects to its port holds the
//! board for as long as it stops it; meanwhile the owner's clock and clients wait. When the editor disconnects, its
//! breakpoints are removed.

use std::io::{self, BufReader};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::time::Duration;

use cc67_host::{AnyTarget, Attendant, IdleWork, Session};
use kmotiondef::Ticks;
use runtime::Event;
use serde_json::Value;

use super::door::{Editor, editors};
use super::{OutputReporter, Server, read};
use crate::debugger::{Debugger, Reason};
use crate::shell::Shell;

/// The time for which a stopped board waits for the next request.
const PATIENCE: Duration = Duration::from_millis(10);

/// The port to which editors attach, one after another.
#[derive(Debug)]
pub struct AttachPoint {
    address: SocketAddr,
    clients: Receiver<Editor>,
    visitor: Option<AttachedEditor>,
}

impl AttachPoint {
    /// Listens on a port of this computer; 0 selects a free one.
    ///
    /// # Errors
    /// The port is in use.
    pub fn listen(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let address = listener.local_addr()?;
        Ok(Self { address, clients: editors(listener)?, visitor: None })
    }

    /// Returns its address.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Attendant<AnyTarget> for AttachPoint {
    fn advance(
        &mut self,
        session: &mut Session<AnyTarget>,
        limit: Ticks,
        events: &mut dyn FnMut(Event),
        idle: IdleWork<'_, AnyTarget>,
    ) {
        if self.visitor.is_none() {
            // A connection that is lost before it is accepted is ignored.
            self.visitor = self
                .clients
                .try_recv()
                .ok()
                .and_then(|editor| AttachedEditor::new(editor.into_stream()).ok());
        }
        let Some(visitor) = &mut self.visitor else { return session.advance(limit, events) };
        visitor.swap(session);
        let stays = visitor.advance(limit, events, idle);
        visitor.swap(session);
        if stays {
            return;
        }
        self.visitor = None;
        // A held tick is completed first.
        let limit = if session.held().is_some() { limit.max(session.tick().next()) } else { limit };
        session.advance(limit, events);
    }
}

/// An attached editor.
struct AttachedEditor {
    server: Server<'static, TcpStream, AnyTarget>,
    requests: Receiver<Value>,
}

impl std::fmt::Debug for AttachedEditor {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Visitor")
    }
}

impl AttachedEditor {
    fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        let requests = read(BufReader::new(stream.try_clone()?), Arc::new(AtomicBool::new(false)));
        let mut server = Server::new(stream, None, Arc::default());
        server.shell = Some(Shell::new(Debugger::of_lent().map_err(io::Error::other)?));
        Ok(Self { server, requests })
    }

    /// Exchanges the debugger's board with the owner's: takes it, or gives it back.
    fn swap(&mut self, session: &mut Session<AnyTarget>) {
        if let Some(shell) = &mut self.server.shell {
            shell.debugger_mut().swap(session);
        }
    }

    /// Serves the editor and runs the board; returns whether the editor remains attached.
    fn advance(
        &mut self,
        limit: Ticks,
        events: &mut dyn FnMut(Event),
        idle: IdleWork<'_, AnyTarget>,
    ) -> bool {
        loop {
            match self.answer() {
                Ok(true) => {}
                Ok(false) | Err(_) => return false,
            }
            let server = &mut self.server;
            let Some(debugger) = server.shell.as_mut().map(Shell::debugger_mut) else { return false };
            let Some(goal) = server.goal.clone() else {
                if idle(debugger.session_mut()).is_break() {
                    return false;
                }
                match self.requests.recv_timeout(PATIENCE) {
                    Ok(request) if server.answer(&request).is_ok() => {}
                    Err(RecvTimeoutError::Timeout) => {}
                    Ok(_) | Err(RecvTimeoutError::Disconnected) => return false,
                }
                continue;
            };
            if debugger.session().held().is_none() && debugger.session().tick() >= limit {
                return true;
            }
            let mut herald = OutputReporter::new(&mut server.wire, &mut server.early, debugger);
            let stop = debugger.proceed(&goal, limit, &mut |event| {
                herald.report(event);
                events(event.clone());
            });
            let OutputReporter { failed, late, .. } = herald;
            if failed.is_some() || !late.is_empty() && server.wire.output("console", &late).is_err() {
                return false;
            }
            if stop.reason == Reason::Time {
                return server.tell_messages().is_ok();
            }
            server.goal = None;
            if server.tell_early(true).is_err() {
                return false;
            }
            if server.tell_stop(&stop).is_err() {
                return false;
            }
        }
    }

    /// Answers the received requests; returns whether the editor remains attached.
    fn answer(&mut self) -> io::Result<bool> {
        loop {
            if self.server.is_over {
                return Ok(false);
            }
            match self.requests.try_recv() {
                Ok(request) => self.server.answer(&request)?,
                Err(TryRecvError::Empty) => return Ok(true),
                Err(TryRecvError::Disconnected) => return Ok(false),
            }
        }
    }
}
