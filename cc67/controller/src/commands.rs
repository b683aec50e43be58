//! The actions of the PC for requests of programs, as commands to a controller.

use cc67_wire::{Client, WireError};
use runtime::RemoteBoard;

/// A controller, as seen by the PC that answers its requests.
pub(crate) struct Commands<'a>(pub(crate) &'a mut Client);

impl RemoteBoard for Commands<'_> {
    type Error = WireError;

    fn user_data(&mut self, first: usize, count: usize) -> Result<Vec<u32>, WireError> {
        let commands = (first..first + count).map(|index| format!("GetPersistHex {index}"));
        let command = commands.collect::<Vec<_>>().join(";");
        let answers = self.0.ask_lines(&command, count)?;
        let words = answers.iter().map(|answer| u32::from_str_radix(answer.trim(), 16).ok());
        let words: Option<Vec<u32>> = words.collect();
        words.ok_or_else(|| self.0.unexpected(&command, &answers.join(" / ")))
    }

    fn set_user_data(&mut self, index: usize, word: u32) -> Result<(), WireError> {
        self.0.command(&format!("SetPersistHex {index} {word:X}"))
    }

    fn gather(&mut self, offset: u32, count: u32) -> Result<Vec<u32>, WireError> {
        self.0.gather(offset, count)
    }

    fn set_gather(&mut self, offset: u32, words: &[u32]) -> Result<(), WireError> {
        self.0.set_gather(offset, words)
    }

    fn command(&mut self, line: &str) -> Result<(), WireError> {
        self.0.command(line)
    }
}
