//! Conversions between text and numbers: `printf` and `scanf`, independent of the source or destination of the text.

mod cost;
mod decimal;
mod format;
mod number;
mod scan;
mod scanned;
mod strict;
#[cfg(test)]
pub(crate) mod vectors;

pub(crate) use decimal::{Digits, Precision, digits, place_of_point};
pub(crate) use format::{Arguments, format, format_counted};
pub(crate) use number::{float_prefix, integer_prefix, legible, magnitude};
pub(crate) use scan::{ScannedValue, Sink, scan};
pub(crate) use scanned::float_value;

/// The rules of `printf` and `sscanf` that a firmware follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Dialect {
    /// Those of firmware 4.34.
    #[default]
    Firmware4,
    /// Those of firmware 5, which are nearer to C.
    Firmware5,
}
