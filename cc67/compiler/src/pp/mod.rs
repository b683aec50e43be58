//! The preprocessor: source files in, tokens out.
//!
//! It is our own because programs for the board come from Windows editors and a lax compiler:
//! backslashes and the wrong letter case in includes, a missing quote, `//` comments that end
//! in a path, bytes of any code page. Every token keeps the position it was written at, and
//! the macros it came through.
//!
//! Layers, each knowing only those before it: `token`, `lexer` (bytes to tokens), `macros`
//! (what is defined), `expand` (tokens to tokens), `directive` and `condition` (lines that
//! begin with `#`), `include` (files). [`number`] and [`quoted`] read what literals mean, for
//! `#if` here and for the parser.

#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::as_conversions
    )
)]

mod condition;
mod conditional;
mod define;
mod directive;
mod engine;
mod expand;
mod files;
mod guard;
mod include;
mod lexer;
pub mod limits;
mod macros;
pub mod number;
mod paste;
mod predefined;
mod print;
pub mod quoted;
mod search;
mod standard;
mod substitute;
#[cfg(test)]
mod tests;
mod token;

use std::path::PathBuf;

use crate::diag::{Lint, Sink};
use crate::names::Names;
use crate::source::{FileId, SourceMap};

pub use files::{Disk, Files, MemoryFiles};
pub use print::print;
pub use token::{Flags, Token, TokenKind, token_text};

/// The lint of text that other compilers would not take.
const LAX: Lint = Lint::LaxText;

/// What the command line says to the preprocessor.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Directories of `-I`, in order.
    pub include_dirs: Vec<PathBuf>,
    /// Macros of `-D` with their bodies.
    pub defines: Vec<(String, String)>,
    /// Macros of `-U`.
    pub undefines: Vec<String>,
    /// Headers that are there when no directory has them: name and text.
    pub embedded: &'static [(&'static str, &'static [u8])],
}

/// Preprocesses a file of `sources` with everything it includes; the last token is `End`.
///
/// What is wrong goes to `sink`. After a limit was exceeded or too many errors were found the
/// tokens are those up to that place, and the `End` is `BROKEN`.
pub fn preprocess(
    main: FileId,
    options: &Options,
    files: &dyn Files,
    sources: &mut SourceMap,
    names: &mut Names,
    sink: &mut Sink,
) -> Vec<Token> {
    engine::Preprocessor::new(options, files, sources, names, sink).run(main)
}
