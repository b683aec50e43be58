//! A debugger for programs on a simulated board: it can stop at any instruction, with all threads and the servo, and go
//! back in time.
//!
//! A [`Debugger`] has a session and the debug information of its programs. It runs the session to breakpoints, changes
//! of variables, traps and other events, steps through lines of one thread while the others continue as on the board,
//! and goes back in time: it finds the previous step by executing the past again. [`Shell`] provides gdb's commands,
//! [`dap`] the protocol for editors.
//!
//! ```text
//! dap        the Debug Adapter Protocol: requests in, responses and events out
//! shell      gdb's commands
//! words      their names, and the parsing of their lines
//! debugger   breakpoints, runs, steps, values
//!   travel     runs and steps back in time
//! early      lines that the board has not sent yet
//! programs   debug information of the programs in the threads
//! ```
//!
//! Invariants:
//! - Debugging does not change what a program does, or when.
//! - A state reached backwards equals the earlier state, byte for byte.
//! - Only changes by the user begin another history, and this is reported.

#![forbid(unsafe_code)]

pub mod dap;
mod debugger;
mod early;
mod programs;
mod shell;
mod words;

pub use debugger::{
    Breakpoint, BreakpointKind, Catchpoints, CodePlace, DebugError, Debugger, HitCondition, Reason,
    ShownVariable, StackFrame, Stop, WatchedAccess,
};
pub use programs::Programs;
pub use shell::{CommandOutput, Output, Shell};
pub use words::{BreakArguments, LineReader};
