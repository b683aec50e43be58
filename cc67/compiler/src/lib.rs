//! C compiler and linker for KFLOP user programs.
//!
//! [`pp`] turns a text and its included files into tokens, and [`parse`] turns these into a syntax tree, [`ast`].
//! [`sema`] gives every expression a type and writes out what C leaves implicit: the typed tree of [`typed`], over the
//! types of [`ty`]; [`lints`] search that tree for mistakes. Mistakes are collected as diagnostics ([`diag`]), and
//! analysis continues. [`lower`] turns the typed tree of a function into [`ir`], basic blocks of three-address code for
//! any target, which [`passes`] improve in turn. A back end, [`bytecode`] for the simulated machine or `c67x` for the
//! controller's processor, turns IR into words. [`object`] holds the words and data of a unit, [`link`] joins units,
//! the parts of the C library that they use, and the addresses of the [`firmware`] into one program, and [`image`]
//! writes it as the file that a board loads. Only [`driver`] knows the order of all this.
//!
//! ```text
//! source ─ pp ─► tokens ─ parse ─► tree ─ sema ─► typed tree ─ lower, passes ─► IR ─┬ bytecode ─┬► object ─ link ─► image
//!                                                   └ lints ─► diagnostics          └ c67x ─────┘
//! ```
//!
//! | room | holds |
//! |---|---|
//! | [`watch`], [`debug`], [`stages`] | built on the driver: watched expressions, debug information, stages as text |
//! | [`driver`] | [`compile`], [`link_units`], the C library, the programs that include a file without `main` |
//! | [`image`], [`inspect`], [`render`] | writing and showing images; diagnostics for people and tools |
//! | [`link`], [`object`], [`target`] | units to a program; a unit's code and data, also as a file; the processor |
//! | [`bytecode`], `c67x`, [`relocation`] | the two back ends; words that the linker completes |
//! | `sharing` | advice about memory that programs share |
//! | [`lower`], [`passes`] | typed tree to IR, IR to better IR |
//! | [`sema`], [`lints`], [`firmware`] | types and meaning; searches for mistakes; what the firmware declares |
//! | [`ir`], [`typed`], [`ty`] | the two middle forms, and the types of C; IR prints and parses |
//! | [`parse`], [`pp`], [`ast`], [`operators`] | the front end; the operators of C and their meanings |
//! | [`diag`], [`words`], [`names`], [`files`], [`source`], `index` | messages, spelling, names, positions, indexes |
//!
//! A room uses only rooms in its own row or in rows below it (`tests/tidy/layers.txt`).
//!
//! Invariants:
//! - This crate knows no board: the image is the interface to the machine.
//! - Only [`bytecode`] and `c67x` select instructions, only [`parse`] knows the grammar of C. [`inspect`] reads the
//!   instructions of finished code, [`link`] and [`object`] complete its words.
//! - Analysis continues after a diagnostic; nothing is written for a program with errors.
//! - No input makes the compiler panic: source text, options and images are checked.
//! - Compiling needs no crate for terminals, pictures, web or command lines.
//!
//! The parser is our own, not `lang-c` as first planned: lang-c alone reads 107,000 lines a second, but the whole
//! compiler must do 150,000, and it stops at the first error. The preprocessor is our own, too: `rucc-pp` has no hooks
//! for includes with backslashes or in the wrong case, or for bytes that are not UTF-8.

#![forbid(unsafe_code)]

pub mod ast;
pub mod bytecode;
mod c67x;
pub mod debug;
pub mod diag;
pub mod driver;
pub mod files;
pub mod firmware;
pub mod image;
mod index;
pub mod inspect;
pub mod ir;
pub mod link;
pub mod lints;
pub mod lower;
pub mod names;
pub mod object;
pub mod operators;
pub mod parse;
pub mod passes;
pub mod pp;
pub mod relocation;
pub mod render;
pub mod sema;
mod sharing;
pub mod source;
pub mod stages;
pub mod target;
pub mod ty;
pub mod typed;
pub mod watch;
pub mod words;

pub use driver::{Compilation, Division, Options, compile, link_units};
