//! The native half of the Python package `cc67`: boards and programs, without a Pythonic interface.
//!
//! The public interface is written in Python, in `python/cc67`: classes, properties, exceptions, help texts. It calls
//! this crate: a [session](cc67_host::Session) on either engine, and the compiler's driver.
//!
//! ```text
//! board      a board for Python: its owning thread, signals while it runs, exceptions
//! control    a session on any engine behind one set of calls; its messages so far
//! controller the link to a controller
//! trace      values over time, in columns
//! setup      the initial state of a board
//! program    sources compiled to a program that can be linked for any thread
//! image      the contents of an image
//! command    the `cc67` command
//! errors     the exceptions of the package
//! ```
//!
//! Invariants:
//! - This crate contains no rules of the simulation: a board does what its session does.
//! - The interpreter's lock is released while a board runs or a program is compiled, and signals are checked between
//!   portions of a run.
//! - No argument causes a panic or an abort: a wrong one raises an exception.

mod board;
mod command;
mod control;
mod controller;
mod errors;
mod image;
mod program;
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
    use crate::controller::{Controller, first_time};
    #[pymodule_export]
    use crate::image::{disassembly, inspection, parts};
    #[pymodule_export]
    use crate::program::{LinkableProgram, compile, lints};
}
