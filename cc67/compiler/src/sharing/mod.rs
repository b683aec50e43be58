//! Advice about memory that programs share, from their texts alone.
//!
//! [`ThreadProgram::new`] lists the accesses of a program to cells with known addresses in the order of the text, with
//! the locks held at each and the flags tested before it. [`advise`] compares the lists of the programs of all threads,
//! [`report_call_back_sharing`] those of a program and its call-back. They find a load and a store of one statement
//! that another program can interrupt, and a `double` that another program can read half updated. It is advice, so a
//! pair of accesses that a lock, a flag or the start of a thread may put in order is not reported.

mod accesses;
mod advice;
mod flow;
mod values;

pub(crate) use accesses::ThreadProgram;
pub(crate) use advice::{advise, report_call_back_sharing};

/// Memory that has a name in the source or an address of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cell {
    /// Memory of the board, the same for all programs.
    Board(u32),
    /// A variable of the program, and the offset in it.
    Variable(crate::typed::SymbolId, i32),
}
