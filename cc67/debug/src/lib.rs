//! A debugger for programs on a simulated board: it stops anywhere, in all threads and the servo at the same instant, and goes
//! back.
//!
//! A [`Debugger`] has a session and the debug information of its programs. It runs the session to breakpoints, changes of
//! variables, traps and other events, by lines of one thread while the others continue as on the board, and back in time:
//! a step back is the last step before, found by executing the past again. [`Shell`] gives it the commands of gdb,
//! [`dap`] the protocol by which editors debug.
//!
//! ```text
//! dap        the Debug Adapter Protocol: requests in, responses and events out
//! shell      commands that people know from gdb
//! debugger   breakpoints, runs, steps, values
//!   travel     the same back in time
//! programs   what is known of the programs in the threads
//! ```
//!
//! Invariants:
//! - What a program does, and when, is the same whether it is debugged or not.
//! - The past is what it was: a state that is reached backwards is that which was there, byte for byte.
//! - Only what a person changes makes another history, and that is said.

#![forbid(unsafe_code)]

pub mod dap;
mod debugger;
mod programs;
mod shell;

pub use debugger::{
    Breakpoint, BreakpointKind, Catches, CodePlace, DebugError, Debugger, Reason, ShownVariable, StackFrame,
    Stop,
};
pub use programs::Programs;
pub use shell::{COMMANDS, Output, Said, Shell};
