//! The UART: 8 data bits, no parity, 1 stop bit, a shift register and one buffered character in each direction.
//!
//! Nothing runs in the background: each access updates the state to its own time. Sent characters are recorded with the
//! time of their last bit while there is a listener; received characters are put on the line from outside. Source:
//! devices.md section 1.

use std::collections::VecDeque;

use kmotiondef::Cycles;

/// The processor cycles of a bit per unit of the divisor: 16 clocks of 16.67 MHz.
const BIT_CYCLES: i64 = 16 * 12;
/// The number of bits per character on the line.
const FRAME_BITS: i64 = 10;
/// The number of characters that can wait for the program: one in the buffer and one in the shift register.
const RECEIVED_LIMIT: usize = 2;

/// Status: a received character is available.
const DATA_READY: u8 = 0x01;
/// Status: the buffered character is still to be sent.
const TRANSMIT_FULL: u8 = 0x02;

/// The UART.
#[derive(Clone, Debug, Default)]
pub struct Uart {
    divisor: u8,
    /// Set once the program has polled for characters; those that arrive earlier wait for that.
    is_attended: bool,
    /// The time at which the transmitter's shift register is empty.
    sent: Cycles,
    /// The character in the buffer, which is sent after that.
    waiting: Option<u8>,
    /// Set while there is a listener, and the characters sent since the last call.
    is_heard: bool,
    out: VecDeque<(Cycles, u8)>,
    /// The characters on the line; the first one is complete at `arrival`.
    line: VecDeque<u8>,
    arrival: Cycles,
    received: VecDeque<u8>,
}

impl Uart {
    /// Sets the divisor; a character in transmission keeps its speed.
    pub fn set_divisor(&mut self, divisor: u8) {
        self.divisor = divisor;
    }

    /// Notes that the program polls for characters: from now on they arrive.
    fn note_poll(&mut self, now: Cycles) {
        if !std::mem::replace(&mut self.is_attended, true) {
            self.arrival = now + self.frame();
        }
    }

    /// The duration of a character.
    fn frame(&self) -> Cycles {
        Cycles::new(FRAME_BITS * BIT_CYCLES * (i64::from(self.divisor) + 1))
    }

    /// Puts characters on the line, the first one beginning at `now`.
    pub fn queue_bytes(&mut self, bytes: &[u8], now: Cycles) {
        self.advance(now);
        if self.line.is_empty() {
            self.arrival = now + self.frame();
        }
        self.line.extend(bytes);
    }

    /// The number of characters on the line.
    pub fn backlog(&self) -> usize {
        self.line.len()
    }

    /// Returns whether characters are still to arrive or to be read.
    pub fn is_receiving(&self) -> bool {
        !self.line.is_empty() || !self.received.is_empty()
    }

    /// Updates the state to `now`.
    fn advance(&mut self, now: Cycles) {
        if self.sent <= now
            && let Some(byte) = self.waiting.take()
        {
            self.sent += self.frame();
            self.note_sent(byte);
        }
        while self.is_attended && self.arrival <= now {
            let Some(byte) = self.line.pop_front() else { break };
            if self.received.len() == RECEIVED_LIMIT {
                self.received.pop_back();
            }
            self.received.push_back(byte);
            self.arrival += self.frame();
        }
    }

    /// The status register.
    pub fn status(&mut self, now: Cycles) -> u8 {
        self.note_poll(now);
        self.advance(now);
        let ready = if self.received.is_empty() { 0 } else { DATA_READY };
        ready | if self.waiting.is_some() { TRANSMIT_FULL } else { 0 }
    }

    /// Reads the data register; 0 when nothing was received.
    pub fn read(&mut self, now: Cycles) -> u8 {
        self.receive(now).unwrap_or_default()
    }

    /// The next received character.
    pub fn receive(&mut self, now: Cycles) -> Option<u8> {
        self.note_poll(now);
        self.advance(now);
        self.received.pop_front()
    }

    /// Sends a character; overwrites one that still waits in the buffer.
    pub fn send(&mut self, byte: u8, now: Cycles) {
        self.advance(now);
        if self.sent <= now {
            self.sent = now + self.frame();
            self.note_sent(byte);
        } else {
            self.waiting = Some(byte);
        }
    }

    /// Records a character whose last bit is sent at `sent`.
    fn note_sent(&mut self, byte: u8) {
        if self.is_heard {
            self.out.push_back((self.sent, byte));
        }
    }

    /// Records the characters that are sent from now on.
    pub fn listen(&mut self) {
        self.is_heard = true;
    }

    /// The next character that is completely sent by `now`.
    pub fn take_sent(&mut self, now: Cycles) -> Option<(Cycles, u8)> {
        if self.is_heard {
            self.advance(now);
        }
        self.out.pop_front_if(|(at, _)| *at <= now)
    }

    /// Returns whether characters are still on their way to a listener.
    pub fn is_sending(&self) -> bool {
        !self.out.is_empty() || self.is_heard && self.waiting.is_some()
    }

    /// Returns whether a character can be sent without losing one.
    pub fn is_free(&mut self, now: Cycles) -> bool {
        self.status(now) & TRANSMIT_FULL == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The divisor for 38400 baud, and the cycles of a character.
    const DIVISOR: u8 = 26;
    const FRAME: i64 = 51_840;

    fn at(frames: i64) -> Cycles {
        Cycles::new(1000 + frames * FRAME)
    }

    fn uart() -> Uart {
        let mut uart = Uart::default();
        uart.set_divisor(DIVISOR);
        uart.note_poll(Cycles::default());
        uart
    }

    #[test]
    fn a_character_takes_ten_bits_and_one_more_is_buffered() {
        let mut uart = uart();
        uart.send(b'x', at(0));
        assert!(uart.is_free(at(0)));
        uart.send(b'x', at(0));
        assert!(!uart.is_free(at(1) - Cycles::new(1)));
        assert!(uart.is_free(at(1)));
        uart.send(b'x', at(1));
        assert!(!uart.is_free(at(2) - Cycles::new(1)));
        assert!(uart.is_free(at(2)));
    }

    #[test]
    fn characters_wait_until_the_program_looks_for_them() {
        let mut uart = Uart::default();
        uart.queue_bytes(b"abc", at(0));
        uart.set_divisor(DIVISOR);
        assert_eq!(uart.status(at(9)), 0);
        assert_eq!(uart.status(at(10)), DATA_READY);
    }

    #[test]
    fn a_listener_gets_each_character_once_it_is_sent() {
        let mut uart = uart();
        uart.listen();
        uart.send(b'a', at(0));
        uart.send(b'b', at(0));
        assert_eq!(uart.take_sent(at(1) - Cycles::new(1)), None);
        assert_eq!(uart.take_sent(at(5)), Some((at(1), b'a')));
        assert_eq!(uart.take_sent(at(5)), Some((at(2), b'b')));
        assert!(!uart.is_sending());
    }

    #[test]
    fn characters_arrive_in_turn_and_the_third_overwrites_the_second() {
        let mut uart = uart();
        uart.queue_bytes(b"abc", at(0));
        assert_eq!(uart.status(at(1) - Cycles::new(1)), 0);
        assert_eq!(uart.status(at(1)), DATA_READY);
        assert_eq!((uart.read(at(3)), uart.read(at(3)), uart.read(at(3))), (b'a', b'c', 0));
        assert!(!uart.is_receiving());
    }
}
