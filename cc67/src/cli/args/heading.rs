//! The headings of option lists in help.

/// Programs in addition to those named on the command line.
pub(crate) const PROGRAMS: &str = "Programs";
/// The board and its surroundings.
pub(crate) const BOARD: &str = "Board";
/// A connected controller.
pub(crate) const CONTROLLER: &str = "Connected controller";
/// The board's connections to a PC and to other computers.
pub(crate) const PC: &str = "PC, files and serial port";
/// Recordings of a run.
pub(crate) const TRACES: &str = "Traces and plots";
/// The compiler.
pub(crate) const COMPILER: &str = "Compiler";
/// Options that few users need.
pub(crate) const EXPERTS: &str = "For experts";

/// The order of the headings, after the options of the command itself.
pub(crate) const ORDER: &[&str] = &[PROGRAMS, BOARD, CONTROLLER, TRACES, PC, COMPILER, EXPERTS];
