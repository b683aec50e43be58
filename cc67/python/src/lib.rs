//! The native half of the Python package `cc67`: boards and programs, without the forms that Python is used to.
//!
//! What people meet is written in Python, in `python/cc67`: classes, properties, exceptions, help texts. Here is what
//! that calls: a [session](cc67_host::Session) on either engine, wherever it has to live, and the compiler's driver.
//!
//! ```text
//! board      a board for Python: whose thread it is, signals while it runs, exceptions
//! residence  where a session lives: in the calling thread, or in one of its own
//! control    a session on any engine behind one set of calls; what it said so far
//! trace      values over time, in columns
//! setup      what a board begins with
//! program    sources to a program that can be linked for any thread
//! image      what is in an image
//! command    the `cc67` command
//! errors     the exceptions of the package
//! ```
//!
//! Invariants:
//! - No rule of the simulation is here: what a board does is what its session does.
//! - The interpreter's lock is released while a board runs or a program is compiled, and signals are looked at between
//!   portions of a run.
//! - No panic and no abort for any argument: each wrong one is an exception.

mod board;
mod command;
mod control;
mod errors;
mod image;
mod program;
mod residence;
mod setup;
mod trace;

use pyo3::prelude::*;

/// The native half of the package `cc67`.
#[pymodule]
#[pyo3(gil_used = true)]
mod _native {
    #[pymodule_export]
    use crate::board::Board;
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::image::{disassembly, inspection, parts};
    #[pymodule_export]
    use crate::program::{LinkableProgram, compile, lints};
}
