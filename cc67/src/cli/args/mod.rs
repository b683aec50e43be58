//! What a person may ask for: the options that commands have in common, a file each, and what their values mean.
//!
//! An option of a board is one field in [`board`]; every command that has a board has the option.

pub(crate) mod attach;
pub(crate) mod beside;
pub(crate) mod board;
pub(crate) mod compiler;
pub(crate) mod engine;
pub(crate) mod pc;
pub(crate) mod program;
pub(crate) mod setting;
pub(crate) mod stimulus;
pub(crate) mod time;
pub(crate) mod trace;
pub(crate) mod uart;
