//! The C accepted by the compiler: the statements of the dialect, the headers, the warnings, and the results of
//! programs.

mod dialect;
mod differential;
mod header;
mod ir_text;
mod lints;
mod second_reader;
