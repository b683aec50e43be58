//! The `cc67` command compiles C programs for KFLOP, runs them on a simulated board, tests and inspects them.
//!
//! A command line names files and options. The files become programs (`cc67-compiler`), the options of a board become
//! its configuration, and both together a session: a simulated board under control (`cc67-host`, above `cc67-runtime`).
//! A subcommand lets its time pass, shows the events, and returns an exit code. This crate handles arguments, files,
//! terminals and reports; the board and the compiler are in other crates.
//!
//! ```text
//! main.rs           the process
//! record.rs         the record of a compared run, shared with the vectors
//! cli/commands/     one file for each subcommand: arguments in, work done, exit code out
//! cli/session.rs    arguments → configuration → a session, on the requested engine
//! cli/compile/      files → programs, with the compiler's diagnostics
//! cli/report/       the screen of a run, diagnostics, traces, plots, profiles
//! cli/args/         options shared by commands, one file for each subject
//! cli/io/           files, the terminal, the clock, exit codes
//! ```
//!
//! Invariants:
//! - Only tests and the Python package, which contains the command, depend on this crate.
//! - Program output goes to stdout byte for byte, everything else to stderr.
//! - An output file is written completely or not at all.
//! - An option of a board is one field in `cli/args/board.rs` or a file flattened into it; every command with a board has it.
//! - A board is changed only through its session.

#![forbid(unsafe_code)]

pub mod cli;
pub mod record;

pub use cli::limits;
