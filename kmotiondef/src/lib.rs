//! The KFLOP board as its programs see it: names, addresses, types, layouts.
//!
//! This crate has only tables and plain types. The compiler links against them, the kernel implements them, the header
//! test compares them with the C headers in `include/`.
//!
//! | table | read by |
//! |---|---|
//! | [`boards`] | the linker, the preprocessor, messages: what differs on other boards than KFLOP 4.34 |
//! | [`firmware`] | the linker for names and signatures, the runtime for dispatch, the documentation |
//! | [`variables`], [`structs`] | the linker for names, the kernel for typed places |
//! | [`bits`] | the runtime, to find the device for a bit number |
//! | [`map`] | the loader and guest memory |
//! | [`limits`], [`modes`] | the servo and the devices |
//! | [`jumps`] | the linker, the interpreter |
//! | [`headers`] | the preprocessor |
//! | [`function`] | the attributes of a row of [`firmware`]: the lints, `--explain`, remarks |
//! | [`hidden`] | the warning about names that the vendor's linker refuses |
//!
//! Invariant: this crate depends on nothing and has no behaviour.

#![forbid(unsafe_code)]

pub mod bits;
pub mod boards;
pub mod ctype;
pub mod firmware;
pub mod function;
pub mod headers;
pub mod hidden;
mod ids;
pub mod jumps;
pub mod limits;
pub mod map;
pub mod modes;
mod place;
pub mod start;
pub mod structs;
pub mod timing;
pub mod variables;

#[cfg(test)]
mod tests;

pub use ctype::{CType, GuestType, Plain, Scalar, ValueClass};
pub use ids::{AccessSize, Axes, AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
pub use place::{Field, Place};
