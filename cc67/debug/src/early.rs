//! Lines that programs have printed and the board has not sent yet: a stop shows them, and they are not shown again
//! when the board sends them.

use std::collections::VecDeque;

/// Lines that were shown early and that the board still has to send.
#[derive(Debug, Default)]
pub(crate) struct EarlyLines(VecDeque<Vec<u8>>);

impl EarlyLines {
    /// Returns whether a line that the board sends was shown before; each shown line counts once.
    pub(crate) fn take(&mut self, line: &[u8]) -> bool {
        let was_shown = self.0.front().is_some_and(|front| front == line);
        if was_shown {
            self.0.pop_front();
        }
        was_shown
    }

    /// Returns the unsent lines that were not shown yet, and notes them as shown. After going back in time, the lines
    /// of the known past are not new; lines that differ from the past belong to another history.
    pub(crate) fn show(&mut self, unsent: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
        if unsent.iter().zip(&self.0).any(|(one, other)| one != other) {
            self.0.clear();
        }
        let fresh: Vec<_> = unsent.into_iter().skip(self.0.len()).collect();
        self.0.extend(fresh.iter().cloned());
        fresh
    }

    /// Goes back in time: the lines that are unsent there were shown before.
    pub(crate) fn go_back(&mut self, unsent: Vec<Vec<u8>>) {
        let begins = |count: usize| unsent.iter().rev().take(count).rev().eq(self.0.iter().take(count));
        let common = (0..=unsent.len().min(self.0.len())).rev().find(|count| begins(*count)).unwrap_or(0);
        let earlier = unsent.len() - common;
        unsent.into_iter().take(earlier).rev().for_each(|line| self.0.push_front(line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_line_is_shown_once_also_after_a_way_back() {
        let lines = |texts: &[&str]| texts.iter().map(|text| text.as_bytes().to_vec()).collect::<Vec<_>>();
        let mut early = EarlyLines::default();
        assert_eq!(early.show(lines(&["a"])), lines(&["a"]));
        assert_eq!(early.show(lines(&["a", "b"])), lines(&["b"]));
        // Back to the time when only `a` was printed, and forward.
        early.go_back(lines(&["a"]));
        assert_eq!(early.show(lines(&["a"])), lines(&[]));
        assert_eq!(early.show(lines(&[])), lines(&[]));
        assert!(early.take(b"a") && early.take(b"b") && !early.take(b"c"));
        // Both lines are sent, then back to a time before that.
        early.go_back(lines(&["a", "b"]));
        assert!(early.take(b"a") && early.take(b"b") && !early.take(b"b"));
        assert_eq!(early.show(lines(&["d"])), lines(&["d"]));
        assert_eq!(early.show(lines(&["other"])), lines(&["other"]));
    }
}
