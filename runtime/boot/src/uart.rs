//! The serial port of the FPGA (`dsp-board.md` 7.8).

use std::collections::VecDeque;

/// Cycles of a clock of the divisor, and clocks of a character: ten bits of sixteen.
const CLOCK: u64 = 12;
const CLOCKS: u64 = 160;
/// Status bits.
const READY: u16 = 1;
const FULL: u16 = 2;

/// The port.
#[derive(Clone, Debug, Default)]
pub(super) struct Uart {
    divisor: u64,
    received: VecDeque<u8>,
    /// The cycle in which the first received byte is there.
    ready: u64,
    /// The cycle in which the last byte has left.
    busy_until: u64,
    sent: Vec<(u64, u8)>,
}

impl Uart {
    fn character(&self) -> u64 {
        CLOCKS * CLOCK * (self.divisor + 1)
    }

    /// Sets the divisor of the clock.
    pub(super) fn set_divisor(&mut self, value: u16) {
        self.divisor = u64::from(value);
    }

    /// The firmware sends a byte.
    pub(super) fn send(&mut self, byte: u8, now: u64) {
        self.busy_until = self.busy_until.max(now) + self.character();
        self.sent.push((now, byte));
    }

    /// The byte that has come, which makes room for the next one.
    pub(super) fn receive(&mut self, now: u64) -> u16 {
        if self.ready > now {
            return 0;
        }
        let byte = self.received.pop_front();
        self.ready = now + self.character();
        byte.map_or(0, u16::from)
    }

    /// Whether a byte is there, and whether no more can be sent.
    pub(super) fn status(&self, now: u64) -> u16 {
        let is_ready = !self.received.is_empty() && self.ready <= now;
        let is_full = self.busy_until.saturating_sub(now) > self.character();
        u16::from(is_ready) * READY + u16::from(is_full) * FULL
    }

    /// Somebody sends to the board.
    pub(super) fn put(&mut self, bytes: &[u8], now: u64) {
        if self.received.is_empty() {
            self.ready = self.ready.max(now + self.character());
        }
        self.received.extend(bytes);
    }

    /// What the board has sent since the last time.
    pub(super) fn take_sent(&mut self) -> Vec<(u64, u8)> {
        std::mem::take(&mut self.sent)
    }
}
