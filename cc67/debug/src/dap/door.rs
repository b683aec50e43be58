//! Editors that connect to a port: each is handed over when its first words have come.
//!
//! A connection that says nothing keeps nobody waiting: it is closed after a time, or for a new one.

use std::io;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use cc67_host::seats::{Closer, FIRST_WORDS, Seat, Seats};

/// The most connections that wait to be served.
const WAITING: usize = 64;

/// An editor that has begun to speak.
#[derive(Debug)]
pub struct Editor {
    stream: TcpStream,
    _seat: Seat,
}

impl Editor {
    /// Takes its connection, which is not closed for a new one any more.
    #[must_use]
    pub fn into_stream(self) -> TcpStream {
        self.stream
    }
}

/// Takes connections in the background, and hands over those that speak.
///
/// # Errors
/// The system starts no thread.
pub fn editors(listener: TcpListener) -> io::Result<Receiver<Editor>> {
    let (sender, editors) = channel();
    let seats = Seats::new(WAITING);
    thread::Builder::new().spawn(move || {
        for stream in listener.incoming().filter_map(Result::ok) {
            let close = stream.try_clone().map(|stream| {
                // One that is closed already needs no closing.
                Box::new(move || drop(stream.shutdown(Shutdown::Both))) as Closer
            });
            let Some(admission) = seats.take(close.ok()) else { continue };
            let sender = sender.clone();
            // Without a thread the connection is closed.
            let _ = thread::Builder::new().spawn(move || hear(stream, admission.seat, &sender));
        }
    })?;
    Ok(editors)
}

/// Waits for the first words of a connection, and hands it over.
fn hear(stream: TcpStream, seat: Seat, sender: &Sender<Editor>) {
    let has_spoken = stream
        .set_read_timeout(Some(FIRST_WORDS))
        .and_then(|()| stream.peek(&mut [0]))
        .is_ok_and(|bytes| bytes > 0);
    if has_spoken && stream.set_read_timeout(None).is_ok() {
        seat.hear();
        // Nobody serves editors any more.
        let _ = sender.send(Editor { stream, _seat: seat });
    }
}
