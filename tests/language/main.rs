//! The C that the compiler takes: the statements of the dialect, the headers, the warnings, and what programs compute.

mod dialect;
mod differential;
mod header;
mod ir_text;
mod lints;
mod second_reader;
