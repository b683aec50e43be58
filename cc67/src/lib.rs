//! The `cc67` command: C programs for KFLOP compiled, run on a simulated board, tested, looked at.
//!
//! [`cli`] has a file for each subcommand. What they do is done elsewhere: `cc67-compiler` makes images of sources,
//! `cc67-runtime` is the board, `cc67-host` a board for programs that drive one. Here are arguments, files, terminals
//! and reports.
//!
//! Invariants:
//! - Nothing depends on this crate but what is a command itself: executables of `--emit native`, and tests.
//! - What a program prints goes to stdout byte for byte, everything else to stderr.
//! - An output is written whole or not at all.

#![forbid(unsafe_code)]

pub mod cli;
pub mod limits;
