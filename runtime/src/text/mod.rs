//! Text in and out of numbers: `printf` and `scanf`, free of where the text comes from or goes.

mod cost;
mod decimal;
mod format;
mod number;
mod scan;
mod scanned;
#[cfg(test)]
pub(crate) mod vectors;

pub(crate) use format::{Arguments, format, format_counted};
pub(crate) use number::{float_prefix, integer_prefix};
pub(crate) use scan::{Scanned, Sink, scan};
