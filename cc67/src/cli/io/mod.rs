//! The process: the files that a command reads and writes, the terminal, the clock, and exit codes.

pub(crate) mod exit;
pub(crate) mod input;
pub(crate) mod interrupt;
mod leftovers;
pub(crate) mod output;
pub(crate) mod pace;
pub(crate) mod pty;
pub(crate) mod stack;
pub(crate) mod state;
pub(crate) mod terminal;
