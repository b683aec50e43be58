//! The process: the files that a command reads and writes, the terminal, the clock, and exit codes.

pub(crate) mod exit;
pub(crate) mod input;
pub(crate) mod interrupt;
pub(crate) mod output;
pub(crate) mod pace;
pub(crate) mod pty;
pub(crate) mod terminal;
