//! The intermediate representation: functions of basic blocks, for any target.
//!
//! Three-address code over mutable values (virtual registers), not static single assignment:
//! a value may be written many times, anywhere, and holds its last write. The programs we
//! compile are small and re-read their memory on purpose (specification, `dialect.md` 1.5),
//! so there is little for global optimisation to win; block-local passes need no phi and run
//! in linear time, and a C local is simply one value.
//!
//! Constants are operands, not instructions. Memory is only accessed by `load`, `store`, `copy_memory`, `clear_memory`
//! and calls; no pass may drop, merge or move one of these.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

mod arithmetic;
pub mod builder;
mod classes;
pub mod function;
pub mod inst;
pub mod operators;
pub mod parse;
pub mod text;
pub mod verify;
