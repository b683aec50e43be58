//! The limits of the preprocessor.
//!
//! Every limit is far above the needs of a program for the board, and is given in its error message. The limits keep
//! hostile text from exhausting memory, time or the stack.

use crate::files;

/// Files within files.
pub const INCLUDE_DEPTH: usize = 64;

/// Files included by one compilation, each time counted.
pub const INCLUDES: usize = 20_000;

/// Bytes of one file.
pub const FILE_BYTES: u32 = files::SOURCE_BYTES;

/// The size limit of all files together, counting each inclusion.
pub const TOTAL_BYTES: u32 = 64 << 20;

/// The limit of tokens in a translation unit after preprocessing. The densest source, string constants as statements,
/// takes 350 bytes of memory per token through all stages, so this keeps the compiler below a gigabyte.
pub const TOKENS: usize = 2_000_000;

/// Tokens that macros put in place of their names, in one translation unit.
pub const EXPANDED_TOKENS: usize = 2_000_000;

/// The size limit of a token made by `#` or `##`.
pub const MADE_BYTES: usize = 1 << 20;

/// Macro calls within arguments of macro calls, and parentheses within `#if` expressions.
pub const NESTING: usize = 640;

/// `#if` within `#if`.
pub const CONDITIONALS: usize = 10_000;

/// Parameters of a macro, arguments of a call.
pub const PARAMETERS: usize = 10_000;
