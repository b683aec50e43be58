//! The byte link to the PC (`dsp-board.md` 5).

use std::collections::VecDeque;

/// The bytes on their way to the firmware, and the bytes that it sent, each with its cycle.
#[derive(Clone, Debug, Default)]
pub(super) struct Link {
    received: VecDeque<u8>,
    sent: Vec<(u64, u8)>,
    /// The number of times the firmware has polled for a byte.
    looks: u64,
}

impl Link {
    /// Sends bytes from the PC.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        self.received.extend(bytes);
    }

    /// Returns whether everything that the PC sent was read.
    pub(super) fn is_read(&self) -> bool {
        self.received.is_empty()
    }

    /// Returns the number of times the firmware has polled for a byte.
    pub(super) const fn poll_count(&self) -> u64 {
        self.looks
    }

    /// Takes the bytes sent since the last call, with their times.
    pub(super) fn take_sent(&mut self) -> Vec<(u64, u8)> {
        std::mem::take(&mut self.sent)
    }

    /// Returns 1 if a byte is available. Any other value would be taken for the byte.
    pub(super) fn status(&mut self) -> u16 {
        self.looks += 1;
        u16::from(!self.received.is_empty())
    }

    /// The next byte.
    pub(super) fn take_byte(&mut self) -> u16 {
        self.received.pop_front().map_or(0, u16::from)
    }

    /// Records a byte sent by the firmware.
    pub(super) fn record_sent(&mut self, byte: u8, now: u64) {
        self.sent.push((now, byte));
    }
}
