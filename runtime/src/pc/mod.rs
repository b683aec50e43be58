//! The PC that the board is connected to: its console, its disk, and what it answers to programs.

mod answers;
pub(crate) mod console;
pub(crate) mod disk;
pub(crate) mod files;
pub(crate) mod host;
mod requests;

pub use answers::{AnswerError, Answers, HELP as ANSWERS_HELP};
