//! The board's own bytes for one client: at a pseudo-terminal, or over TCP.
//!
//! A single client uses the link, as at the board's USB port, and the PC that serves programs is at the client's end.
//! The client's data wait here until the board takes them, and the board's data until the client reads them: a client
//! that does not read makes programs that print wait, as on the board.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

/// The number of unread bytes from which programs that print have to wait.
pub(in crate::cli::commands) const UNREAD_BYTES: usize = 1 << 16;
/// The number of unread bytes beyond which further ones are lost: a firmware file answers even a client that does not
/// read.
pub(in crate::cli::commands) const LOST_BYTES: usize = 1 << 20;
/// The time after the last byte during which a client is served without delay.
const LIVELY: Duration = Duration::from_secs(2);

/// A connected client.
#[derive(Debug)]
pub(super) struct WireClient {
    pub(super) number: u64,
    pub(super) outgoing: Sender<Vec<u8>>,
    /// The number of bytes on their way to the client.
    pub(super) unread: Arc<AtomicUsize>,
    /// The number of its bytes that the board has not taken.
    pub(super) untaken: Arc<AtomicUsize>,
}

/// The board's end of the wire, and the client at the other end.
#[derive(Debug, Default)]
pub(super) struct WireEnd {
    client: Option<WireClient>,
    /// Bytes for the board.
    incoming: VecDeque<u8>,
    /// The time of the client's last transfer in either direction.
    last: Option<Instant>,
    is_held_back: bool,
}

impl WireEnd {
    /// Connects a client.
    pub(super) fn plug(&mut self, client: WireClient) {
        self.incoming.clear();
        self.client = Some(client);
    }

    /// Disconnects a client: bytes that the board has not taken are lost.
    pub(super) fn unplug(&mut self, number: u64) {
        if self.client.take_if(|client| client.number == number).is_some() {
            self.incoming.clear();
        }
    }

    /// Returns whether there is no client.
    pub(super) const fn is_unplugged(&self) -> bool {
        self.client.is_none()
    }

    /// Takes bytes of a client.
    pub(super) fn take(&mut self, number: u64, bytes: &[u8], time: Instant) {
        if self.client.as_ref().is_some_and(|client| client.number == number) {
            self.incoming.extend(bytes);
            self.last = Some(time);
        }
    }

    /// Returns whether there are bytes for the board.
    pub(super) fn has_incoming(&self) -> bool {
        !self.incoming.is_empty()
    }

    /// The next bytes for the board.
    pub(super) fn next(&mut self) -> Vec<u8> {
        let bytes: Vec<u8> = self.incoming.drain(..).collect();
        if let Some(client) = &self.client {
            client.untaken.fetch_sub(bytes.len(), Ordering::Relaxed);
        }
        bytes
    }

    /// Sends bytes of the board to the client; returns whether they are lost although a client is connected.
    pub(super) fn send(&mut self, bytes: Vec<u8>, time: Instant) -> bool {
        let Some(client) = self.client.as_ref().filter(|_| !bytes.is_empty()) else { return false };
        if client.unread.load(Ordering::Relaxed) > LOST_BYTES {
            return true;
        }
        client.unread.fetch_add(bytes.len(), Ordering::Relaxed);
        self.last = Some(time);
        // A disconnected client is removed when its connection reports it.
        let _ = client.outgoing.send(bytes);
        false
    }

    /// Returns whether the client may be waiting for the board.
    pub(super) fn is_lively(&self, time: Instant) -> bool {
        self.last.is_some_and(|last| time < last + LIVELY)
    }

    /// Returns whether programs that print have to wait from now on, or no longer have to; `None` if this has not
    /// changed.
    pub(super) fn hold_back(&mut self) -> Option<bool> {
        let unread = self.client.as_ref().map(|client| client.unread.load(Ordering::Relaxed));
        let limit = if self.is_held_back { UNREAD_BYTES / 2 } else { UNREAD_BYTES };
        let is_too_much = unread.is_none_or(|unread| unread >= limit);
        (is_too_much != self.is_held_back).then(|| {
            self.is_held_back = is_too_much;
            is_too_much
        })
    }
}

/// The console lines in the bytes of the board: the rest are replies to others.
pub(super) fn console_lines(bytes: &[u8]) -> Vec<u8> {
    bytes
        .split_inclusive(|byte| *byte == b'\n')
        .filter(|line| line.first() == Some(&0x1B))
        .flatten()
        .copied()
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;
    use crate::cli::io::pace::now;

    #[test]
    fn answers_to_a_page_are_not_for_the_client() {
        let bytes = b"\x1bone\r\n1.5\r\n\x1btwo\r\n";
        assert_eq!(console_lines(bytes), b"\x1bone\r\n\x1btwo\r\n");
    }

    #[test]
    fn programs_wait_while_nobody_is_connected_or_reads() {
        let mut wire = WireEnd::default();
        assert_eq!(wire.hold_back(), Some(true));
        let (outgoing, _inbox) = channel();
        wire.plug(WireClient { number: 1, outgoing, unread: Arc::default(), untaken: Arc::default() });
        assert_eq!(wire.hold_back(), Some(false));
        assert_eq!(wire.hold_back(), None);
        assert!(!wire.send(vec![0; LOST_BYTES], now()));
        assert_eq!(wire.hold_back(), Some(true));
        assert!(!wire.send(vec![0; 10], now()));
        assert!(wire.send(vec![0; 10], now()), "nobody has read them");
        wire.take(2, b"of somebody else", now());
        wire.take(1, b"\x03", now());
        assert_eq!(wire.next(), b"\x03");
        wire.unplug(2);
        assert!(!wire.is_unplugged());
    }
}
