//! The options shared by commands, one file for each subject, and the parsing of their values.
//!
//! An option of a board is one field in [`board`]; all commands with a board then have the option.

pub(crate) mod attach;
pub(crate) mod board;
pub(crate) mod compiler;
pub(crate) mod controller;
pub(crate) mod engine;
pub(crate) mod heading;
pub(crate) mod pc;
pub(crate) mod program;
pub(crate) mod setting;
pub(crate) mod sidecars;
pub(crate) mod stimulus;
pub(crate) mod time;
pub(crate) mod trace;
pub(crate) mod uart;
