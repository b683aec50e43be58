//! Conversions that the board treats differently from C.
//!
//! They are right on a PC and print or store something else on the board (`gather-persist-console.md` 4.1 and 4.2).
//! Only a format that is a literal in the call is checked.

use super::format::{FormatFunction, literal_format};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};

/// Looks at every format.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            let Some((taker, format)) = literal_format(program.unit, function, call) else { continue };
            let span = function.exprs[call.arguments[taker.format]].span;
            for Finding { spelled, message, help, lint } in findings(taker, format) {
                let message = format!("the board {message}: `{spelled}`");
                sink.report(Diagnostic::warning(lint, span, message).help(help));
            }
        }
    }
}

/// A conversion that the board treats differently.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Finding {
    /// The conversion as written.
    spelled: String,
    /// The board's behaviour, to follow "the board".
    message: &'static str,
    /// The replacement.
    help: &'static str,
    /// The warning to which it belongs.
    lint: Lint,
}

/// The board's behaviour, and the replacement.
type Quirk = (&'static str, &'static str);

fn findings(function: FormatFunction, format: &[u8]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut rest = format;
    while let Some(start) = rest.iter().position(|byte| *byte == b'%') {
        if let Some(quirk) = literal_space(&rest[..start]).filter(|_| function.is_scan) {
            findings.push(finding(&rest[..start], quirk));
        }
        let (conversion, behind) = Conversion::parse(&rest[start + 1..], function.is_scan);
        let spelled = &rest[start..rest.len() - behind.len()];
        rest = behind;
        let quirk = if function.is_scan { conversion.scanned() } else { conversion.printed() };
        findings.extend(quirk.map(|quirk| Finding { lint: conversion.lint(), ..finding(spelled, quirk) }));
    }
    findings
}

fn finding(spelled: &[u8], (message, help): Quirk) -> Finding {
    Finding { spelled: String::from_utf8_lossy(spelled).into_owned(), message, help, lint: Lint::BoardFormat }
}

/// White space after an ordinary character before a conversion of `scanf`.
fn literal_space(between: &[u8]) -> Option<Quirk> {
    let written = between.trim_ascii_start();
    written.iter().any(u8::is_ascii_whitespace).then_some((
        "reads white space after another character as that very character",
        "leave the white space out: most conversions skip it",
    ))
}

/// A `%` sequence.
#[derive(Clone, Copy, Debug, Default)]
struct Conversion<'f> {
    letter: u8,
    alternate: bool,
    space: bool,
    zero: bool,
    has_width: bool,
    precision: Option<u32>,
    length: &'f [u8],
    set: &'f [u8],
}

impl<'f> Conversion<'f> {
    /// Reads a conversion after `%`; returns it with the rest of the format.
    fn parse(text: &'f [u8], is_scan: bool) -> (Self, &'f [u8]) {
        let mut conversion = Self::default();
        let mut rest = text;
        while let Some((&byte, behind)) = rest.split_first() {
            match byte {
                b'#' => conversion.alternate = true,
                b' ' => conversion.space = true,
                b'0' => conversion.zero = true,
                b'-' | b'+' => {}
                _ => break,
            }
            rest = behind;
        }
        let (width, behind) = field(rest);
        conversion.has_width = !width.is_empty() && (!is_scan || width != b"*");
        rest = behind;
        if let Some(behind) = rest.strip_prefix(b".") {
            let (precision, behind) = field(behind);
            conversion.precision = match precision {
                b"" => Some(0),
                digits => std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok()),
            };
            rest = behind;
        }
        let length = rest.iter().take_while(|byte| matches!(byte, b'h' | b'l' | b'L')).count();
        (conversion.length, rest) = rest.split_at(length);
        let Some((&letter, behind)) = rest.split_first() else { return (conversion, rest) };
        conversion.letter = letter;
        if letter != b'[' || !is_scan {
            return (conversion, behind);
        }
        // A `]` directly after `[` or `[^` belongs to the set.
        let first = 1 + usize::from(behind.first() == Some(&b'^'));
        let end =
            behind.iter().skip(first).position(|byte| *byte == b']').map_or(behind.len(), |end| end + first);
        conversion.set = &behind[..end];
        (conversion, behind.get(end + 1..).unwrap_or_default())
    }

    /// The warning for the board's behaviour: `%ld` takes two words, so that everything after it is wrong.
    fn lint(self) -> Lint {
        if self.length == b"l" && self.is_integer() { Lint::Format } else { Lint::BoardFormat }
    }

    fn is_integer(self) -> bool {
        matches!(self.letter, b'd' | b'i' | b'u' | b'x' | b'X' | b'o')
    }

    fn is_float(self) -> bool {
        matches!(self.letter, b'f' | b'e' | b'E' | b'g' | b'G')
    }

    /// The board's behaviour for a conversion of `printf` that differs from C.
    fn printed(self) -> Option<Quirk> {
        let unsigned = self.is_integer() && !matches!(self.letter, b'd' | b'i');
        match (self.letter, self.length) {
            (_, b"hh") => Some(("prints nothing and then the letter", "leave out `hh`")),
            (b'a' | b'A' | b'F' | b'n', _) => Some(("prints nothing", "use `%f` or `%g`")),
            (b'd' | b'i', b"h") => {
                Some(("prints all 32 bits", "leave out `h` and cast the value to `short`"))
            }
            (_, b"l") if self.is_integer() => Some((
                "prints 40 bits, of this argument and the next",
                "leave out `l`: a `long` is an `int` here",
            )),
            (_, b"ll") if self.is_integer() => {
                Some(("prints 32 bits", "print the two halves, or use `%.0f` with a `double`"))
            }
            (b'x' | b'X', _) if self.alternate && self.zero && self.has_width => {
                Some(("fills with zeros before the `0x`", "write `0x` before the conversion"))
            }
            (b'o', _) if self.alternate => {
                Some(("prints one zero more", "write the `0` before the conversion"))
            }
            (b'c', _) if self.zero && self.has_width => Some(("fills with zeros", "leave out the `0`")),
            (b'c', _) if self.space => Some(("prints the blank", "leave out the blank")),
            _ if unsigned && self.space => Some(("prints the blank", "leave out the blank")),
            (b'f', _) if self.precision == Some(0) => {
                Some(("prints `0.` or `0.1` for values below 0.1", "print an `int`: `%d`"))
            }
            (b'g' | b'G', _) if matches!(self.precision, Some(0..=3)) => Some((
                "prints only zeros for values with as many zeros after the point",
                "use `%f`, or `%g` without a precision",
            )),
            _ => None,
        }
    }

    /// The board's behaviour for a conversion of `scanf` that differs from C.
    fn scanned(self) -> Option<Quirk> {
        match (self.letter, self.length) {
            (_, b"hh") => Some(("stores nothing and reads the letter", "use `%d` and an `int`")),
            (b'a' | b'A' | b'F', _) => Some(("stores nothing", "use `%f`")),
            (_, b"l") if self.is_integer() => {
                Some(("stores eight bytes", "leave out `l`: a `long` is an `int` here"))
            }
            (_, b"ll") if self.is_integer() => Some(("stores four bytes", "use `%d` and an `int`")),
            (b'[', _) if has_range(self.set) => {
                Some(("knows no ranges and takes the `-` as a character", "write every character of the set"))
            }
            _ if self.is_float() && self.has_width => {
                Some(("ignores the width of a floating-point number", "leave out the width"))
            }
            _ => None,
        }
    }
}

/// Reads a width or precision, `*` or digits; returns it with the rest of the text.
fn field(text: &[u8]) -> (&[u8], &[u8]) {
    let count = if text.first() == Some(&b'*') {
        1 + text.iter().skip(1).take_while(|byte| byte.is_ascii_digit()).count()
    } else {
        text.iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    text.split_at(count)
}

/// Reports whether a set has a `-` between two characters.
fn has_range(set: &[u8]) -> bool {
    let set = set.strip_prefix(b"^").unwrap_or(set);
    set.iter().skip(1).rev().skip(1).any(|byte| *byte == b'-')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(function: &str, format: &str, expect: &[&str]) {
        let function = FormatFunction::by_name(function).expect("known");
        let found: Vec<String> =
            findings(function, format.as_bytes()).into_iter().map(|finding| finding.spelled).collect();
        assert_eq!(found, expect, "{format}");
    }

    #[test]
    fn formats_that_the_board_prints_differently_are_found() {
        check("printf", "%d %f %#x %g %s %08X %5.2f %c %% %u\n", &[]);
        check("printf", "%ld %hd %#06x %.0f %0.lf", &["%ld", "%hd", "%#06x", "%.0f", "%0.lf"]);
        check(
            "printf",
            "%05c|% u|%#o|%.2g|%F|%hhd|%lld",
            &["%05c", "% u", "%#o", "%.2g", "%F", "%hhd", "%lld"],
        );
    }

    #[test]
    fn formats_that_the_board_reads_differently_are_found() {
        check("sscanf", "%d %lf,%d ,%s %[^]-] %*d%3d%n", &[]);
        check("sscanf", "%d, %d", &[", "]);
        check("sscanf", "%[a-z]%5f%ld%lld", &["%[a-z]", "%5f", "%ld", "%lld"]);
    }
}
