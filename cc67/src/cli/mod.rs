//! The command line.
//!
//! What a program prints goes to stdout byte for byte, everything else to stderr. Messages
//! about the request or its inputs are single lines that begin with `cc67: `. Where `cc67` stands
//! in for the vendor's compiler, arguments and messages are that one's.
//!
//! The rooms are layers, each of which knows those below it:
//!
//! ```text
//! commands   a file a subcommand: arguments in, work done, exit code out
//! session    arguments → configuration → a loaded board, on the engine that was asked for
//! compile    files → images, with what the compiler says of them
//! report     what is shown: the screen of a run, diagnostics, traces, plots, profiles
//! args       options that commands have in common, and what their values mean
//! io         files, the terminal, the clock, exit codes
//! ```

mod args;
mod commands;
mod compile;
mod io;
mod report;
mod session;

pub use commands::limits;
pub use commands::main;
#[cfg(feature = "native")]
pub use commands::stand_alone;
pub use io::exit::Exit;
