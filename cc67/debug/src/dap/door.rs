//! Editors that connect to a port: each is passed on when its first data have come.
//!
//! A silent connection delays nobody: it is closed after a time limit, or for a new one.

use std::io;
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use cc67_host::seats::{Closer, FIRST_WORDS, Seat, Seats};

/// The maximum number of connections that wait to be served.
const WAITING: usize = 64;

/// An editor that has sent its first data.
#[derive(Debug)]
pub struct Editor {
    stream: TcpStream,
    _seat: Seat,
}

impl Editor {
    /// Takes its connection, which is no longer closed for a new one.
    #[must_use]
    pub fn into_stream(self) -> TcpStream {
        self.stream
    }
}

/// Accepts connections in the background, and passes on those that send data.
///
/// # Errors
/// The operating system cannot start a thread.
pub fn editors(listener: TcpListener) -> io::Result<Receiver<Editor>> {
    let (sender, editors) = channel();
    let seats = Seats::new(WAITING);
    thread::Builder::new().spawn(move || {
        for stream in listener.incoming().filter_map(Result::ok) {
            let close = stream.try_clone().map(|stream| {
                // A connection that is already closed needs no closing.
                Box::new(move || drop(stream.shutdown(Shutdown::Both))) as Closer
            });
            let Some(admission) = seats.take(close.ok()) else { continue };
            let sender = sender.clone();
            // If no thread can be started, the connection is closed.
            let _ = thread::Builder::new().spawn(move || await_first_data(stream, admission.seat, &sender));
        }
    })?;
    Ok(editors)
}

/// Waits for the first data of a connection, and passes it on.
fn await_first_data(stream: TcpStream, seat: Seat, sender: &Sender<Editor>) {
    let has_spoken = stream
        .set_read_timeout(Some(FIRST_WORDS))
        .and_then(|()| stream.peek(&mut [0]))
        .is_ok_and(|bytes| bytes > 0);
    if has_spoken && stream.set_read_timeout(None).is_ok() {
        seat.mark_active();
        // An error means that editors are no longer served.
        let _ = sender.send(Editor { stream, _seat: seat });
    }
}
