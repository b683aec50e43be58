//! A connection to a client, as complete messages.
//!
//! Over a socket or a port a message is its length, as two bytes with the low one first, followed by that number of
//! bytes; over a [pipe](super::pipe) it is a single write. The contents of messages are the same. Source:
//! host-protocol.md section 8, wire.md section 7.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

use cc67_host::seats::Closer;

use super::message::REPLY;

/// The maximum size of a message from a client.
pub(super) const LONGEST: usize = 4096;
/// The client's answer to each message before the reply.
const ACKNOWLEDGED: u8 = 0xAA;
/// The beginning of the first message of the library of version 4.32, which is not preceded by a length.
const OLD_LIBRARY: [u8; 8] = [9, 0, 0, 0, 0, 0, 0, 0];
/// The number of bytes of a text that are read before its connection is closed.
const TEXT_LIMIT: u64 = 1 << 16;

/// A message of a connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Received {
    /// A message.
    Message(Vec<u8>),
    /// The beginning of a text, from a client that expects a terminal or a web server.
    Text,
    /// A message of the library of version 4.32.
    OldLibrary,
    /// Nothing: the client has disconnected, or sends data that cannot be a message.
    Nothing,
}

/// A connection that carries messages in both directions.
pub(super) trait ClientConnection: Send + 'static {
    /// Returns a function that closes it from another thread, if there is one.
    fn closer(&self) -> Option<Closer>;
    /// Limits the time for which it waits for the client, if the operating system supports that.
    fn limit_wait(&mut self, most: Option<Duration>);
    /// Receives the first message, which may be of another kind.
    fn receive_first(&mut self) -> Received;
    /// Receives a message.
    fn receive(&mut self) -> Received;
    /// Sends a message; `None` if the client has disconnected.
    fn send(&mut self, message: &[u8]) -> Option<()>;
    /// Receives the byte by which the client acknowledges a message; `None` if the client has disconnected.
    fn receive_byte(&mut self) -> Option<u8>;
    /// Answers a client that sends text with a text, and reads on a little, so that the answer is not lost when the
    /// connection is closed.
    fn refuse(&mut self, text: &[u8]);
}

/// Sends the answer to a request: the client acknowledges each message before the last. `None` if it has disconnected.
pub(super) fn answer(connection: &mut impl ClientConnection, messages: &[Vec<u8>]) -> Option<()> {
    for bytes in messages {
        connection.send(bytes)?;
        if bytes.first() != Some(&REPLY) {
            connection.receive_byte().filter(|answer| *answer == ACKNOWLEDGED)?;
        }
    }
    Some(())
}

/// A connection as a stream of bytes.
pub(super) trait Stream: Read + Write + Send + 'static {
    /// Returns a function that closes it from another thread; `None` if the operating system has no file descriptor
    /// left for that.
    fn closer(&self) -> Option<Closer>;
    /// Limits the time for which a read waits.
    fn limit_wait(&self, most: Option<Duration>);
    /// Ends sending; receiving is still possible.
    fn end(&self);
}

impl Stream for TcpStream {
    fn closer(&self) -> Option<Closer> {
        let stream = self.try_clone().ok()?;
        // A connection that is already closed needs no closing.
        Some(Box::new(move || drop(stream.shutdown(Shutdown::Both))))
    }

    fn limit_wait(&self, most: Option<Duration>) {
        // Without the limit it only waits longer.
        let _ = self.set_read_timeout(most);
    }

    fn end(&self) {
        // A disconnected client needs no end.
        let _ = self.shutdown(Shutdown::Write);
    }
}

#[cfg(unix)]
impl Stream for std::os::unix::net::UnixStream {
    fn closer(&self) -> Option<Closer> {
        let stream = self.try_clone().ok()?;
        // A connection that is already closed needs no closing.
        Some(Box::new(move || drop(stream.shutdown(Shutdown::Both))))
    }

    fn limit_wait(&self, most: Option<Duration>) {
        // Without the limit it only waits longer.
        let _ = self.set_read_timeout(most);
    }

    fn end(&self) {
        // A disconnected client needs no end.
        let _ = self.shutdown(Shutdown::Write);
    }
}

impl<S: Stream> ClientConnection for S {
    fn closer(&self) -> Option<Closer> {
        Stream::closer(self)
    }

    fn limit_wait(&mut self, most: Option<Duration>) {
        Stream::limit_wait(self, most);
    }

    fn receive_first(&mut self) -> Received {
        read_first(self)
    }

    fn receive(&mut self) -> Received {
        read(self)
    }

    fn send(&mut self, message: &[u8]) -> Option<()> {
        write(self, message)
    }

    fn receive_byte(&mut self) -> Option<u8> {
        let mut byte = [0];
        self.read_exact(&mut byte).ok()?;
        let [byte] = byte;
        Some(byte)
    }

    fn refuse(&mut self, text: &[u8]) {
        if self.write_all(text).is_ok() {
            self.end();
            // The data are read only to be discarded.
            let _ = std::io::copy(&mut self.take(TEXT_LIMIT), &mut std::io::sink());
        }
    }
}

/// Reads the first message of a stream.
fn read_first(stream: &mut impl Read) -> Received {
    let mut length = [0; 2];
    if stream.read_exact(&mut length).is_err() {
        return Received::Nothing;
    }
    if length.iter().all(|byte| matches!(byte, b'\t' | b'\r' | b'\n' | b' '..=b'~')) {
        return Received::Text;
    }
    let [low, high, rest @ ..] = OLD_LIBRARY;
    if length != [low, high] {
        return read_body(stream, length);
    }
    // The old library sends no more than this, and then waits.
    let mut begin = [0; 6];
    if stream.read_exact(&mut begin).is_err() {
        return Received::Nothing;
    }
    if begin == rest {
        return Received::OldLibrary;
    }
    let mut tail = vec![0; usize::from(low) - begin.len()];
    match stream.read_exact(&mut tail) {
        Ok(()) => Received::Message([&begin[..], &tail].concat()),
        Err(_) => Received::Nothing,
    }
}

/// Reads a message.
fn read(stream: &mut impl Read) -> Received {
    let mut length = [0; 2];
    match stream.read_exact(&mut length) {
        Ok(()) => read_body(stream, length),
        Err(_) => Received::Nothing,
    }
}

fn read_body(stream: &mut impl Read, length: [u8; 2]) -> Received {
    let mut bytes = vec![0; usize::from(u16::from_le_bytes(length))];
    if bytes.len() > LONGEST || stream.read_exact(&mut bytes).is_err() {
        return Received::Nothing;
    }
    Received::Message(bytes)
}

/// Writes a message; `None` if the client has disconnected.
fn write(stream: &mut impl Write, bytes: &[u8]) -> Option<()> {
    let length = u16::try_from(bytes.len()).ok()?;
    stream.write_all(&[&length.to_le_bytes()[..], bytes].concat()).and_then(|()| stream.flush()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_specification_is_read_and_written() {
        let version = b"\0\0\0\0\0\0\0\0Version\0";
        let mut stream = &[&[0x10, 0][..], version].concat()[..];
        assert_eq!(read(&mut stream), Received::Message(version.to_vec()));
        let mut sent = Vec::new();
        assert_eq!(write(&mut sent, b"\0\0\0\0\0KFLOP 4.34\0"), Some(()));
        assert_eq!(sent, b"\x10\0\0\0\0\0\0KFLOP 4.34\0");
    }

    #[test]
    fn messages_without_their_end_are_nothing() {
        assert_eq!(read(&mut &b"\xFF\xFF"[..]), Received::Nothing);
        assert_eq!(read(&mut &b"\x05\0abc"[..]), Received::Nothing);
    }

    #[test]
    fn other_protocols_are_recognised_by_their_first_bytes() {
        for (bytes, expect) in [
            (&b"GET / HTTP/1.1\r\n"[..], Received::Text),
            (b"\r\n", Received::Text),
            (&[9, 0, 0, 0, 0, 0, 0, 0], Received::OldLibrary),
            (b"\x09\0\x09\0\0\0\0\0\0\0\0", Received::Message(b"\x09\0\0\0\0\0\0\0\0".to_vec())),
            (b"\xFF\xFF\xFF\xFF", Received::Nothing),
            (b"\x09", Received::Nothing),
        ] {
            assert_eq!(read_first(&mut &*bytes), expect, "{bytes:?}");
        }
    }
}
