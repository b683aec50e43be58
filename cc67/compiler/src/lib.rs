//! C compiler and linker for KFLOP user programs.
//!
//! A text becomes tokens in [`pp`], which also reads what it includes, and [`parse`] makes of them a tree of the syntax,
//! [`ast`]. [`sema`] gives every expression a type and writes out what C leaves implicit: the typed tree of
//! [`typed`], over the types of [`ty`]; [`lints`] search that tree for mistakes. What is wrong is collected as
//! diagnostics ([`diag`]), and analysis continues. [`lower`] turns the typed tree of a function into [`ir`], basic blocks of
//! three-address code for any target, which [`passes`] improve one after another. A back end, [`bytecode`] for the
//! simulated machine or `c67x` for the controller's processor, turns IR into words. [`object`] holds the words and data of a unit,
//! [`link`] joins units, what they use of the C library, and the addresses of the [`firmware`] to one program, and
//! [`image`] writes that as the file that a board loads. [`driver`] is the only place that knows the order of all this.
//!
//! ```text
//! source ─ pp ─► tokens ─ parse ─► tree ─ sema ─► typed tree ─ lower, passes ─► IR ─┬ bytecode ─┬► object ─ link ─► image
//!                                                   └ lints ─► diagnostics          └ c67x ─────┘
//! ```
//!
//! | room | holds |
//! |---|---|
//! | [`watch`], [`debug`], [`stages`] | what is built on the driver: watched expressions, debug information; each stage alone, as text, for tests |
//! | [`driver`] | [`compile`], [`link_units`], the C library, who includes a file without `main` |
//! | [`image`], [`inspect`], [`render`] | images written and shown; diagnostics as people and tools read them |
//! | [`link`], [`object`], [`target`] | units to a program; a unit's code and data, as a file, too; which processor |
//! | [`bytecode`], `c67x` | the two back ends |
//! | [`lower`], [`passes`] | typed tree to IR, IR to better IR |
//! | [`sema`], [`lints`], [`firmware`] | types and meaning; searches for mistakes; what the firmware declares |
//! | [`ir`], [`typed`], [`ty`] | the two forms in the middle, and the types of C; IR prints and parses |
//! | [`parse`], [`pp`], [`ast`], [`operators`] | the front; the operators of C with what they compute |
//! | [`diag`], [`words`], [`names`], [`files`], [`source`], `index` | messages, spelling, interned names, places in texts, typed numbers |
//!
//! A room names only rooms of its own line or of lines below it (`tests/tidy/layers.rs`).
//!
//! Invariants:
//! - No board is known here: the image is the interface to the machine.
//! - Nothing outside [`bytecode`] knows the instructions of the machine, nothing outside
//!   `c67x` those of the controller's processor, nothing outside
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
pub mod render;
pub mod sema;
pub mod source;
pub mod stages;
pub mod target;
pub mod ty;
pub mod typed;
pub mod watch;
pub mod words;

pub use driver::{Compilation, Options, compile, link_units};
