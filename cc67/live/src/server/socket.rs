//! The WebSocket of a page: requests come in as text; messages go out as text, and frames as bytes.
//!
//! One thread does both: it waits a few milliseconds for incoming messages, then sends the outgoing ones.

use std::io::{self, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use cc67_host::seats::Seat;
use tungstenite::error::Error;
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Bytes, Message, Utf8Bytes, WebSocket};

use crate::hub::{Hub, Incoming, Mailbox, Outgoing, PageId};
use crate::request::{LONGEST, PageRequest};

/// The time for which it waits for incoming messages before it sends the outgoing ones.
const TURN: Duration = Duration::from_millis(5);
/// The maximum number of messages read before something is sent.
const MESSAGES_AT_ONCE: usize = 32;

/// Serves a page until it disconnects.
pub(super) fn serve(mut stream: TcpStream, key: &str, seat: &Seat, hub: &Arc<Hub>) -> io::Result<()> {
    let accept = derive_accept_key(key.as_bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.set_read_timeout(Some(TURN))?;
    let config = WebSocketConfig::default().max_message_size(Some(LONGEST)).max_frame_size(Some(LONGEST));
    let socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config));
    seat.mark_active();
    let (page, mailbox) = (hub.number(), Arc::new(Mailbox::default()));
    if hub.hand_in(Incoming::Join(page, Arc::clone(&mailbox))) {
        let mut connection = Connection { socket, seat, hub, page, mailbox: &mailbox };
        if let Err(why) = connection.run() {
            connection.leave(&why);
        }
        hub.hand_in(Incoming::Leave(page));
    }
    Ok(())
}

/// A connected page.
struct Connection<'a> {
    socket: WebSocket<TcpStream>,
    seat: &'a Seat,
    hub: &'a Hub,
    page: PageId,
    mailbox: &'a Mailbox,
}

/// The reason why a connection ends.
enum ConnectionEnd {
    /// It was closed or lost.
    Closed,
    /// The client violated the protocol.
    Broken(String),
}

impl From<Error> for ConnectionEnd {
    fn from(error: Error) -> Self {
        match error {
            Error::Protocol(_) | Error::Capacity(_) | Error::Utf8(_) => Self::Broken(error.to_string()),
            _ => Self::Closed,
        }
    }
}

impl Connection<'_> {
    fn run(&mut self) -> Result<(), ConnectionEnd> {
        while !self.mailbox.is_closed() {
            self.receive()?;
            while let Some(outgoing) = self.mailbox.take() {
                let message = match outgoing {
                    Outgoing::Message(text) => Message::Text(Utf8Bytes::from(&*text)),
                    Outgoing::Frame(bytes) => Message::Binary(Bytes::from(bytes)),
                };
                self.socket.write(message)?;
            }
            self.socket.flush()?;
        }
        Ok(())
    }

    /// Handles incoming messages.
    fn receive(&mut self) -> Result<(), ConnectionEnd> {
        for _ in 0..MESSAGES_AT_ONCE {
            let message = match self.socket.read() {
                Ok(message) => message,
                Err(Error::Io(error)) if is_timeout(&error) => return Ok(()),
                Err(error) => return Err(error.into()),
            };
            match message {
                Message::Text(text) => {
                    self.seat.mark_active();
                    let request = PageRequest::parse(&text)
                        .map_err(|error| ConnectionEnd::Broken(error.to_string()))?;
                    if !self.hub.hand_in(Incoming::Ask(self.page, request)) {
                        return Err(ConnectionEnd::Closed);
                    }
                }
                Message::Binary(_) => {
                    return Err(ConnectionEnd::Broken("binary messages only go to pages".to_owned()));
                }
                Message::Ping(_) | Message::Pong(_) | Message::Close(_) | Message::Frame(_) => {}
            }
        }
        Ok(())
    }

    /// Closes a connection, and reports a violation of the protocol.
    fn leave(&mut self, why: &ConnectionEnd) {
        if let ConnectionEnd::Broken(what) = why {
            self.hub.log("a page sent what is not a request and was disconnected", what);
        }
        // An error means that the connection is already closed.
        let _ = self.socket.close(None);
        let _ = self.socket.flush();
    }
}

fn is_timeout(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}
