//! C compiler and linker for KFLOP user programs.
//!
//! ```text
//! source ─ pp ─► tokens ─ parse ─► tree ─ sema ─► typed tree ─ lower, passes ─► IR ─ bytecode ─► object ─ link ─► image
//! ```
//!
//! [`compile`] goes all the way; each stage is a module that can be used by itself.
//!
//! Invariants:
//! - No board is known here: the image is the interface to the machine.
//! - Nothing outside [`bytecode`] knows the instructions of the machine, nothing outside
//!   [`parse`] the grammar of C.
//! - Analysis continues after a diagnostic; nothing is written for a program with errors.
//! - No input makes the compiler panic: source text, options and images are checked.
//! - No crate of terminals, pictures, web or command lines is needed to compile.
//!
//! The parser is our own, not `lang-c` as first planned: measured, lang-c alone reads 107,000
//! lines a second where the whole compiler must do 150,000, and it stops at the first error. So
//! is the preprocessor: `rucc-pp` has no hooks for includes with backslashes or in the wrong
//! case, nor for bytes that are not UTF-8.

#![forbid(unsafe_code)]

pub mod ast;
pub mod bytecode;
pub mod diag;
pub mod driver;
pub mod files;
pub mod firmware;
pub mod image;
pub mod inspect;
pub mod ir;
pub mod link;
pub mod lints;
pub mod lower;
pub mod names;
pub mod object;
pub mod parse;
pub mod passes;
pub mod pp;
pub mod render;
pub mod sema;
pub mod source;
pub mod ty;
pub mod typed;
pub mod watch;
pub mod words;

pub use driver::{Compilation, Options, compile, link_units};
