//! The initial values of the board's variables.

use crate::GuestAddr;

/// The value of a variable or field at power-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartValue {
    /// Zeros.
    Zero,
    /// An integer.
    Int(i32),
    /// The same integer in every element of an array.
    Each(i32),
    /// A `float`.
    Float(f32),
    /// A `double`.
    Double(f64),
    /// A text and its terminator.
    Text(&'static str),
    /// A pointer.
    Address(GuestAddr),
    /// The words at the beginning, the rest zeros.
    Words(&'static [u32]),
    /// In the structure of axis n: `first + n * step`.
    PerAxis {
        /// The value for axis 0.
        first: u32,
        /// The difference from one axis to the next.
        step: u32,
    },
    /// The values that the fields of its structure state.
    Fields,
}

/// The power-ups at which the start value is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoreCondition {
    /// At every power-up.
    Always,
    /// Only when no user image has been flashed; otherwise what was flashed comes back.
    UnlessFlashed,
}
