//! IR to bytecode: the one folder that knows the machine's instructions.
//!
//! A function passes four stages: [`legalize`] leaves only instructions that the machine has,
//! [`registers`] gives every value a register, [`select`] writes the words, [`meter`] inserts
//! the charges. [`mod@unit`] puts functions, data and symbols together.

pub(crate) mod head;
mod legalize;
mod meter;
mod operators;
mod pool;
mod registers;
mod select;
pub mod unit;

#[cfg(test)]
mod tests;
