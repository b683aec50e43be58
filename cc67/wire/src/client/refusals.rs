//! The board's messages about commands, among the console lines. Source: host-protocol.md section 2.1.

use std::collections::VecDeque;

/// The board's messages about a command.
const MESSAGES: [&str; 3] = ["error, invalid command", "Error:Expecting", "error, expecting value"];
/// The message that comes before the line and the caret instead of after them.
const EXPECTS_EQUALS: &[u8] = b"Error:Expecting \"=\"";
/// A message that consists of one line.
const INVALID_ADDRESS: &[u8] = b"invalid address";
/// The maximum number of messages kept; each rejected line of a download causes one.
const MOST_MESSAGES: usize = 16;

/// A message of the board about a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    /// The command, in upper case.
    pub(super) command: String,
    pub(super) message: String,
}

/// Finds the messages about commands among the console lines while a command is in progress.
///
/// A message consists of three console lines: the command, a caret under the error, the text.
#[derive(Clone, Debug, Default)]
pub(super) struct RefusalFinder {
    is_watching: bool,
    /// Lines that may be the beginning of a message.
    held: VecDeque<Vec<u8>>,
    found: Vec<Refusal>,
}

impl RefusalFinder {
    /// Notes that a command is sent.
    pub(super) fn watch(&mut self) {
        self.is_watching = true;
        self.found.clear();
    }

    /// Notes that the command was answered; returns the lines that are not part of a message.
    pub(super) fn unwatch(&mut self) -> Vec<Vec<u8>> {
        self.is_watching = false;
        self.held.drain(..).collect()
    }

    /// The messages since the last command was sent.
    pub(super) fn found(&self) -> &[Refusal] {
        &self.found
    }

    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes a console line; returns the lines that are not part of a message.
    pub(super) fn filter(&mut self, line: Vec<u8>) -> Vec<Vec<u8>> {
        if !self.is_watching {
            return vec![line];
        }
        if line == INVALID_ADDRESS {
            self.add(b"", &line);
            return Vec::new();
        }
        self.held.push_back(line);
        if self.held.len() < 3 {
            return Vec::new();
        }
        if let Some((command, message)) = message_in(self.held.make_contiguous()) {
            let (command, message) = (command.clone(), message.clone());
            self.held.clear();
            self.add(&command, &message);
            return Vec::new();
        }
        self.held.pop_front().into_iter().collect()
    }

    fn add(&mut self, command: &[u8], message: &[u8]) {
        if self.found.len() < MOST_MESSAGES {
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            self.found.push(Refusal { command: text(command), message: text(message) });
        }
    }
}

fn is_caret(line: &[u8]) -> bool {
    line.split_last().is_some_and(|(last, spaces)| *last == b'^' && spaces.iter().all(|byte| *byte == b' '))
}

fn is_message(line: &[u8]) -> bool {
    MESSAGES.iter().any(|message| line.starts_with(message.as_bytes()))
}

/// The command and the text in three lines that form a message.
fn message_in(lines: &[Vec<u8>]) -> Option<(&Vec<u8>, &Vec<u8>)> {
    match lines {
        [command, caret, message] if is_caret(caret) && is_message(message) => Some((command, message)),
        [message, command, caret] if is_caret(caret) && message == EXPECTS_EQUALS => Some((command, message)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(lines: &[&str]) -> (Vec<String>, Vec<Refusal>) {
        let mut errors = RefusalFinder::default();
        errors.watch();
        let mut shown: Vec<_> =
            lines.iter().flat_map(|line| errors.filter(line.as_bytes().to_vec())).collect();
        shown.extend(errors.unwatch());
        (shown.iter().map(|line| String::from_utf8_lossy(line).into_owned()).collect(), errors.found)
    }

    #[test]
    fn messages_of_three_lines_are_found_among_what_programs_print() {
        let (console, found) =
            shown(&["one", "error, invalid command", "BOGUS", "^", "error, invalid command", "^", "two"]);
        assert_eq!(console, ["one", "error, invalid command", "^", "two"]);
        let expect = Refusal { command: "BOGUS".into(), message: "error, invalid command".into() };
        assert_eq!(found, [expect]);
    }

    #[test]
    fn the_message_about_a_missing_sign_comes_first() {
        let (console, found) = shown(&["a", "Error:Expecting \"=\"", "MOVE0 5", "     ^", "b", "c"]);
        assert_eq!(console, ["a", "b", "c"]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].command, "MOVE0 5");
    }
}
