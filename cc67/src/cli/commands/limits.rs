//! All limits of the tool with their numbers, for `--explain limits` and the book.
//!
//! The numbers are defined where they are enforced; this is the only list of them. The limits of the compiler are far
//! above the needs of programs for the board: they prevent hostile text from exhausting memory, time or the stack. The
//! limits of the board are those of the real board.

use std::fmt::Write as _;

use kmotiondef::ThreadId;
use kmotiondef::limits::MAX_NSTRINGS;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT, PROGRAM_SIZE, STACK_SIZE};

use super::serve::{self, MOST_CLIENTS, UNHEARD_LINES};
use crate::cli::report::SHOWN_REMARKS;
use crate::cli::report::trace::SAMPLES as PICTURE_SAMPLES;
use cc67_host::{CONSOLE_LINES, REPLY_BYTES};
use compiler::bytecode::MAX_FRAME;
use compiler::diag::MAX_ERRORS;
use compiler::files::{DATA_BYTES, FILE_BYTES};
use compiler::parse;
use compiler::pp::limits as pp;
use compiler::sema::MAX_VALUES;
use compiler::ty::layout::MAX_OBJECT_SIZE;
use runtime::FILE_BYTES as PC_FILE_BYTES;
use runtime::stimulus::MOST_PLANNED as STIMULUS_PLANS;

/// A limit.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The counted items.
    pub what: &'static str,
    /// The maximum.
    pub number: u64,
    /// The behaviour beyond it.
    pub beyond: &'static str,
}

/// The consequence of most limits of the compiler.
const ERROR: &str = "an error with this number";

const fn limit(what: &'static str, number: u64, beyond: &'static str) -> Limit {
    Limit { what, number, beyond }
}

/// Limits of the compiler.
pub const COMPILER: &[Limit] = &[
    limit("nested includes", pp::INCLUDE_DEPTH as u64, ERROR),
    limit("files included by one compilation, counting each inclusion", pp::INCLUDES as u64, ERROR),
    limit("bytes of one source file", pp::FILE_BYTES as u64, ERROR),
    limit("bytes of all source files together, counting each inclusion", pp::TOTAL_BYTES as u64, ERROR),
    limit("nested `#if`", pp::CONDITIONALS as u64, ERROR),
    limit("parameters of a macro", pp::PARAMETERS as u64, ERROR),
    limit("nested macro calls, nested parentheses in an `#if` expression", pp::NESTING as u64, ERROR),
    limit("tokens expanded from macros", pp::EXPANDED_TOKENS as u64, ERROR),
    limit("bytes of a token made by `#` or `##`", pp::MADE_BYTES as u64, ERROR),
    limit("tokens after preprocessing", pp::TOKENS as u64, ERROR),
    limit("nested parentheses, blocks, declarators, prefix operators", parse::NESTING as u64, ERROR),
    limit("binary operators in a row", parse::CHAIN as u64, ERROR),
    limit("values of an initialiser", MAX_VALUES as u64, ERROR),
    limit("bytes of an object", MAX_OBJECT_SIZE as u64, ERROR),
    limit("bytes of the local variables of a function", MAX_FRAME as u64, ERROR),
    limit("errors in one stage", MAX_ERRORS as u64, "the rest of the program is not checked, with a message"),
];

/// Limits of the board for a program.
pub const BOARD: &[Limit] = &[
    limit("user threads, each with one program", ThreadId::MAX as u64, "the command line is refused"),
    limit(
        "bytes of a program and its data in its own space",
        PROGRAM_SIZE as u64,
        "a warning that names the threads whose space it takes",
    ),
    limit(
        "bytes of a program and its data, starting in thread 1",
        (PROGRAM_LIMIT - PROGRAM_BASE) as u64,
        "an error that names the largest parts",
    ),
    limit("bytes of a thread's stack", STACK_SIZE as u64, "the thread traps"),
    limit("console strings waiting for the PC", (MAX_NSTRINGS - 1) as u64, "`printf` waits, as on the board"),
    limit("files open for reading", 1, "`fopen` closes the earlier one"),
    limit("files open for writing", 1, "`fopen` closes the earlier one"),
];

/// Limits for clients of the board, see [`cc67_host`].
pub const CLIENTS: &[Limit] = &[
    limit("console lines that no client has taken", CONSOLE_LINES as u64, "the board's own queue fills"),
    limit(
        "bytes of replies that no client has read",
        REPLY_BYTES as u64,
        "further replies are lost, with a remark",
    ),
    limit(
        "clients of `cc67 serve` at a time",
        MOST_CLIENTS as u64,
        "the client that was silent the longest is disconnected",
    ),
    limit(
        "console lines of `cc67 serve` while no client is the console",
        UNHEARD_LINES as u64,
        "the oldest is discarded",
    ),
    limit(
        "console lines of `cc67 serve` that its console has not received",
        serve::CONSOLE_LINES as u64,
        "programs that print wait, as on a board whose PC does not read",
    ),
    limit(
        "bytes that the client of a wire (`--listen pty`, `tcp-raw:PORT`) has not read",
        serve::UNREAD_BYTES as u64,
        "programs that print wait, as on a board whose PC does not read",
    ),
    limit(
        "bytes of a firmware file's output that the client of a wire has not read",
        serve::LOST_BYTES as u64,
        "further ones are lost, with a message",
    ),
];

/// Limits of files and pictures.
pub const FILES: &[Limit] = &[
    limit("bytes of an image, a machine file or another input", FILE_BYTES, "the file is refused"),
    limit("bytes of saved data that `cc67 plot` draws", DATA_BYTES, "the file is refused"),
    limit(
        "bytes of a PC file that a program reads",
        PC_FILE_BYTES,
        "for the program the file does not exist; a remark says why",
    ),
    limit(
        "actions that a stimulus has planned at a time",
        STIMULUS_PLANS as u64,
        "later ones are left out, with a remark",
    ),
    limit(
        "different remarks shown in a run",
        SHOWN_REMARKS as u64,
        "further ones are counted; `--json` shows all",
    ),
    limit(
        "samples in a picture of a run",
        PICTURE_SAMPLES as u64,
        "the picture shows only some of the samples, with a message; traces show all",
    ),
];

/// All limits, under their headings.
pub const ALL: [(&str, &[Limit]); 4] = [
    ("The compiler", COMPILER),
    ("A program on the board", BOARD),
    ("A board that serves PC programs", CLIENTS),
    ("Files, stimuli, remarks and pictures", FILES),
];

/// A number with separated thousands.
#[must_use]
pub fn with_separators(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// All limits as tables.
#[must_use]
pub fn page() -> String {
    let mut text = String::new();
    for (title, limits) in ALL {
        let _ = write!(text, "{title}\n\n");
        for limit in limits {
            let _ = writeln!(text, "{:>13}  {}: {}", with_separators(limit.number), limit.what, limit.beyond);
        }
        text.push('\n');
    }
    text.push_str("Names, string constants and lines are as long as their file allows.\n");
    text
}
