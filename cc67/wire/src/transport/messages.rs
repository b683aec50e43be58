//! Messages to and from the vendor's server. Source: host-protocol.md section 8; wire.md section 7.

use std::io::{self, Read, Write};

/// Acknowledges a message that is not a reply.
const ACKNOWLEDGE: &[u8] = &[0xAA];
/// The maximum size of a message to the server, and of a message from it, in bytes.
const LONGEST_REQUEST: usize = 4096;
const LONGEST_REPLY: usize = 2561;

/// A connection to the server, message by message.
pub(super) trait Messages: Send {
    /// Sends a message.
    fn send(&mut self, message: &[u8]) -> io::Result<()>;
    /// Returns the next message.
    fn receive(&mut self) -> io::Result<Vec<u8>>;
    /// Acknowledges a message that is not a reply.
    fn acknowledge(&mut self) -> io::Result<()>;
}

/// A stream on which each message is preceded by its length.
#[derive(Debug)]
pub(super) struct Framed<S>(pub(super) S);

impl<S: Read + Write + Send> Messages for Framed<S> {
    fn send(&mut self, message: &[u8]) -> io::Result<()> {
        let length = u16::try_from(check_length(message)?.len()).map_err(|_| io::ErrorKind::InvalidInput)?;
        self.0.write_all(&[&length.to_le_bytes()[..], message].concat())
    }

    fn receive(&mut self) -> io::Result<Vec<u8>> {
        let mut length = [0; 2];
        self.0.read_exact(&mut length)?;
        let mut message = vec![0; usize::from(u16::from_le_bytes(length))];
        self.0.read_exact(&mut message)?;
        Ok(message)
    }

    fn acknowledge(&mut self) -> io::Result<()> {
        self.0.write_all(ACKNOWLEDGE)
    }
}

/// A Windows pipe on which each write is a message: the server sends the next message only after an answer, so that a
/// read takes exactly one.
#[derive(Debug)]
pub(super) struct Unframed<S>(pub(super) S);

impl<S: Read + Write + Send> Messages for Unframed<S> {
    fn send(&mut self, message: &[u8]) -> io::Result<()> {
        self.0.write_all(check_length(message)?)
    }

    fn receive(&mut self) -> io::Result<Vec<u8>> {
        let mut message = vec![0; LONGEST_REPLY];
        match self.0.read(&mut message)? {
            0 => Err(io::ErrorKind::UnexpectedEof.into()),
            count => {
                message.truncate(count);
                Ok(message)
            }
        }
    }

    fn acknowledge(&mut self) -> io::Result<()> {
        self.0.write_all(ACKNOWLEDGE)
    }
}

/// Returns a message, unless it is too long for the server.
fn check_length(message: &[u8]) -> io::Result<&[u8]> {
    if message.len() <= LONGEST_REQUEST { Ok(message) } else { Err(io::ErrorKind::InvalidInput.into()) }
}
