//! The `cc67` command: C programs for KFLOP compiled, run on a simulated board, tested, inspected.
//!
//! A command line names files and options. The files become programs (`cc67-compiler`), the options of a board become its
//! configuration, and both together a session: a simulated board under control (`cc67-host`, above `cc67-runtime`). A
//! subcommand decides how far its time goes, shows what happens, and says by the exit code how it went. Here are
//! arguments, files, terminals and reports; what a board or a compiler does is elsewhere.
//!
//! ```text
//! main.rs           the process
//! cli/commands/     one file for each subcommand: arguments in, work done, exit code out
//! cli/session.rs    arguments → configuration → a session, on the engine that was asked for
//! cli/compile/      files → programs, with the compiler's diagnostics
//! cli/report/       the screen of a run, diagnostics, traces, plots, profiles
//! cli/args/         options that commands share, one file for each subject
//! cli/io/           files, the terminal, the clock, exit codes
//! ```
//!
//! Invariants:
//! - Nothing depends on this crate but what is a command itself: executables of `--emit native`, and tests.
//! - What a program prints goes to stdout byte for byte, everything else to stderr.
//! - An output is written whole or not at all.
//! - An option of a board is one field in `cli/args/board.rs` or a file flattened into it; every command with a board has it.
//! - A board is changed through its session alone.

#![forbid(unsafe_code)]

pub mod cli;

pub use cli::limits;
