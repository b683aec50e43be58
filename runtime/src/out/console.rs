//! Console text on its way to the PC: one holding buffer, one queue.
//!
//! Text is held until its line ends, or until another character follows the 125th. A queue of strings then waits for
//! the primary thread, which sends one in each of its slices. All threads share the holding buffer.

use std::collections::VecDeque;

use kmotiondef::limits::MAX_NSTRINGS;

/// The limit of characters held for a line.
pub(crate) const LINE_LIMIT: usize = 125;
/// The capacity of the queue; a queue with equal indices is empty, so one entry stays free.
const QUEUE_LIMIT: usize = MAX_NSTRINGS - 1;

/// The console of the board.
#[derive(Clone, Debug, Default)]
pub(crate) struct Console {
    held: Vec<u8>,
    queue: VecDeque<Vec<u8>>,
    /// The latest report of the servo: one for all axes and all kinds of events.
    servo: Option<String>,
    /// Strings queued since power-up.
    queued: u64,
    /// True if nothing is sent any more.
    is_dead: bool,
}

impl Console {
    /// Takes as much of `text` as the queue has room for and returns the rest.
    pub(crate) fn put<'t>(&mut self, text: &'t [u8]) -> &'t [u8] {
        if self.is_dead {
            return &[];
        }
        let mut rest = text;
        while let Some((&byte, tail)) = rest.split_first() {
            if byte == b'\n' || self.held.len() == LINE_LIMIT {
                if self.queue.len() == QUEUE_LIMIT {
                    break;
                }
                self.flush();
            }
            if byte != b'\n' {
                self.held.push(byte);
            }
            rest = tail;
        }
        rest
    }

    /// A message of the board itself; a full queue loses it.
    pub(crate) fn message(&mut self, text: &str) {
        if self.queue.len() < QUEUE_LIMIT && !self.is_dead {
            self.queue.push_back(text.as_bytes().to_vec());
            self.queued += 1;
        }
    }

    /// A message of the servo, which waits for the primary thread. One that finds another waiting is lost
    /// (axes-and-motion.md section 7.4).
    pub(crate) fn servo_message(&mut self, text: &str) {
        if !self.is_dead {
            self.servo.get_or_insert_with(|| text.to_owned());
        }
    }

    /// Returns the message of the servo that the primary thread sends in its slice, bypassing the queue.
    pub(crate) fn take_servo_message(&mut self) -> Option<Vec<u8>> {
        self.servo.take().map(String::into_bytes)
    }

    /// The string that is sent next.
    pub(crate) fn send(&mut self) -> Option<Vec<u8>> {
        self.queue.pop_front()
    }

    /// Stops sending for good.
    pub(crate) fn die(&mut self) {
        *self = Self { is_dead: true, queued: self.queued, ..Self::default() };
    }

    /// Returns all text that has not been sent yet. An unfinished line is kept: the board never sends it
    /// (gather-persist-console.md section 4).
    pub(crate) fn drain(&mut self) -> Vec<Vec<u8>> {
        let servo = self.take_servo_message();
        servo.into_iter().chain(self.queue.drain(..)).collect()
    }

    /// The strings that wait to be sent, in this order.
    pub(crate) fn unsent(&self) -> impl Iterator<Item = &[u8]> {
        self.queue.iter().map(Vec::as_slice)
    }

    /// The unfinished line.
    pub(crate) fn held(&self) -> &[u8] {
        &self.held
    }

    /// Returns whether there is an unfinished line.
    pub(crate) fn is_holding(&self) -> bool {
        !self.held.is_empty()
    }

    /// Returns whether the queue is empty.
    pub(crate) fn is_idle(&self) -> bool {
        self.queue.is_empty() && self.servo.is_none()
    }

    /// The queue's write and read indices.
    pub(crate) fn indices(&self) -> (i32, i32) {
        let index = |count: u64| (count % MAX_NSTRINGS as u64) as i32;
        (index(self.queued), index(self.queued - self.queue.len() as u64))
    }

    fn flush(&mut self) {
        self.queue.push_back(std::mem::take(&mut self.held));
        self.queued += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(pieces: &[&str], expect: &[&str]) {
        let mut console = Console::default();
        for piece in pieces {
            assert!(console.put(piece.as_bytes()).is_empty());
        }
        let mut sent = Vec::new();
        while let Some(line) = console.send() {
            sent.push(String::from_utf8(line).expect("text"));
        }
        assert_eq!(sent, expect);
    }

    #[test]
    fn lines_are_sent_when_they_end() {
        check(&["abc"], &[]);
        check(&["a", "b", "c\n"], &["abc"]);
        check(&["a\nb", "c\n", "\n"], &["a", "bc", ""]);
    }

    #[test]
    fn a_126th_character_ends_the_line() {
        let (full, over) = ("x".repeat(125), "x".repeat(126));
        check(&[&format!("{full}\n")], &[&full]);
        check(&[&format!("{over}\n")], &[&full, "x"]);
    }

    #[test]
    fn the_servo_can_hold_one_message() {
        let mut console = Console::default();
        console.servo_message("first");
        console.servo_message("second");
        assert!(!console.is_idle());
        assert!(console.put(b"of a program\n").is_empty());
        assert_eq!(console.take_servo_message().as_deref(), Some(&b"first"[..]));
        console.servo_message("third");
        let sent: Vec<_> =
            console.drain().into_iter().map(|line| String::from_utf8(line).expect("text")).collect();
        assert_eq!(sent, ["third", "of a program"]);
    }

    #[test]
    fn a_full_queue_takes_no_further_line() {
        let mut console = Console::default();
        let text = "x\n".repeat(300);
        assert_eq!(console.put(text.as_bytes()).len(), 600 - 2 * 255 - 1);
        assert_eq!(console.indices(), (255, 0));
        console.send();
        assert_eq!(console.indices(), (255, 1));
        assert_eq!(console.drain().len(), 254);
        assert_eq!(console.held(), b"x");
    }
}
