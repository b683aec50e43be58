//! A debugger that takes commands, from a person or a file.

use cc67_debug::{Said, Shell};

/// A debugger with commands.
pub(super) trait Talker {
    /// Does what a line says; what the board says meanwhile goes to the output.
    fn command(&mut self, line: &str, output: &mut dyn FnMut(&str)) -> Result<Said, String>;

    /// The names that the text at the end of a line may become.
    fn complete(&self, line: &str) -> Vec<String>;
}

impl Talker for Shell {
    fn command(&mut self, line: &str, output: &mut dyn FnMut(&str)) -> Result<Said, String> {
        Self::command(self, line, output).map_err(|error| error.to_string())
    }

    fn complete(&self, line: &str) -> Vec<String> {
        Self::complete(self, line)
    }
}
