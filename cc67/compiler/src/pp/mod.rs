//! The preprocessor: source files in, tokens out.
//!
//! It is our own because programs for the board come from Windows editors and a lax compiler: backslashes and the wrong
//! letter case in includes, a missing quote, `//` comments that end in a path, bytes of any code page. Every token
//! keeps its position in the source, and the macros from which it comes.
//!
//! Layers, each depending only on those before it: `token`, `lexer` (bytes to tokens), `macros` (definitions), `expand`
//! (tokens to tokens), `directive` and `condition` (lines that begin with `#`), `include` (files). [`number`] and
//! [`quoted`] compute the values of literals, for `#if` here and for the parser.

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
mod prepared;
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

/// The preprocessor's options on the command line.
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
    /// The C standard of the program.
    pub standard: Standard,
}

/// The C standard of a program, as far as it makes a difference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Standard {
    /// The vendor's compiler: the rules of 1990 for constants.
    #[default]
    Vendor,
    /// C of 1999: a decimal constant without `u` is never unsigned.
    C99,
    /// C of 2011.
    C11,
    /// C of 2017.
    C17,
}

impl Standard {
    /// The standard of this name, as GCC's `-std` takes it.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "vendor" | "ansi" | "c89" | "c90" | "gnu89" | "gnu90" => Self::Vendor,
            "c99" | "c9x" | "gnu99" | "gnu9x" => Self::C99,
            "c11" | "c1x" | "gnu11" | "gnu1x" => Self::C11,
            "c17" | "c18" | "gnu17" | "gnu18" => Self::C17,
            _ => return None,
        })
    }

    /// The macros that it predefines.
    const fn macros(self) -> &'static str {
        match self {
            Self::Vendor => "",
            Self::C99 => "#define __STDC_VERSION__ 199901L\n",
            Self::C11 => "#define __STDC_VERSION__ 201112L\n",
            Self::C17 => "#define __STDC_VERSION__ 201710L\n",
        }
    }
}

/// The part of the board's headers that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Headers {
    /// All, as of any other file.
    Whole,
    /// The declarations that the program names.
    AsNeeded,
}

/// The part of the board's headers that was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeadersRead {
    /// Everything, if they are included.
    Whole,
    /// Without the declarations that the program does not name. The result is the same as long as the program has no
    /// errors.
    Partly,
    /// Less than needed: the result is not valid.
    TooLittle,
}

/// Preprocesses a file of `sources` with all of its includes; the last token is `End`.
///
/// Errors are reported to `sink`. If a limit is exceeded or there are too many errors, the tokens end there, and the
/// `End` is `BROKEN`; the same after an unterminated comment.
pub fn preprocess(
    main: FileId,
    options: &Options,
    files: &dyn Files,
    sources: &mut SourceMap,
    names: &mut Names,
    sink: &mut Sink,
) -> Vec<Token> {
    preprocess_as(Headers::Whole, main, options, files, sources, names, sink).0
}

/// Preprocesses a program; only a part of the board's headers may be read.
pub fn preprocess_as(
    headers: Headers,
    main: FileId,
    options: &Options,
    files: &dyn Files,
    sources: &mut SourceMap,
    names: &mut Names,
    sink: &mut Sink,
) -> (Vec<Token>, HeadersRead) {
    engine::Preprocessor::new(options, files, sources, names, sink, headers).run(main)
}
