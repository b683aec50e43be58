//! The command line.
//!
//! Program output goes to stdout byte for byte, everything else to stderr. Messages about the request or its inputs are
//! single lines that start with `cc67: `. When it replaces the vendor's compiler, `cc67` uses that compiler's arguments
//! and messages.
//!
//! The modules are layers, each of which uses only those below it:
//!
//! ```text
//! commands   one file for each subcommand: arguments in, work done, exit code out
//! session    arguments → configuration → a loaded board, on the requested engine
//! compile    files → images, with the compiler's messages
//! report     output: the screen of a run, diagnostics, traces, plots, profiles
//! args       options shared by commands, and the parsing of their values
//! io         files, the terminal, the clock, exit codes
//! ```

mod args;
mod commands;
mod compile;
mod io;
mod report;
mod session;

pub use commands::{description, limits, main};
pub use io::exit::Exit;
