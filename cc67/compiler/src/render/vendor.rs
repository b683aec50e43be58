//! Diagnostics for the controller's own PC software, in the form of its compiler.
//!
//! `file:line: message`, warnings `file:line: warning: message`, before text of an included file `In file included from
//! main.c:3:` (specification, `dialect.md` section 4). The software waits for the compiler before it reads the output,
//! so [`LIMIT`] bytes must not be reached; it shows the first 499 characters, so errors come first; and one of its
//! libraries takes any output for a failure, so a program without errors gets none.

use crate::diag::{Diagnostic, Severity};
use crate::source::SourceMap;

use super::marks::includes;

/// All output stays below this many bytes.
pub const LIMIT: usize = 4000;

/// Levels of inclusion that are shown.
const SHOWN_INCLUDES: usize = 4;

/// Renders the diagnostics of a compilation; empty without an error.
#[must_use]
pub fn render(diagnostics: &[Diagnostic], sources: &SourceMap) -> String {
    if diagnostics.iter().all(|diagnostic| diagnostic.severity != Severity::Error) {
        return String::new();
    }
    let of = |severity| diagnostics.iter().filter(move |diagnostic| diagnostic.severity == severity);
    // The vendor's compiler links units that compile, so undefined symbols are found last.
    let is_linked = |diagnostic: &&Diagnostic| diagnostic.linker_words.is_some();
    let compiled = of(Severity::Error).filter(|error| !is_linked(error));
    let linked = of(Severity::Error).filter(is_linked);
    let mut text = String::new();
    for diagnostic in compiled.chain(linked).chain(of(Severity::Warning)) {
        let entry = entry(diagnostic, sources);
        if text.len() + entry.len() >= LIMIT {
            // A first message of that length is cut, not lost.
            if text.is_empty() {
                text.push_str(truncate(&entry));
                text.push('\n');
            }
            break;
        }
        text.push_str(&entry);
    }
    text
}

/// A diagnostic with all of its parts, in whole lines.
fn entry(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let mut text = String::new();
    // Its own words first, because other programs search for them.
    if let Some(words) = &diagnostic.linker_words {
        text.push_str(&format!("tcc: {words}\n"));
    }
    match diagnostic.span.and_then(|span| Some((span, sources.place(span)?))) {
        Some((span, place)) => {
            let mut levels: Vec<_> = includes(span, sources).take(SHOWN_INCLUDES).collect();
            levels.reverse();
            for include in levels.into_iter().filter_map(|include| sources.place(include)) {
                let file = &sources.file(include.file).name;
                text.push_str(&format!("In file included from {file}:{}:\n", include.line));
            }
            text.push_str(&format!("{}:{}: ", sources.file(place.file).name, place.line));
        }
        None if diagnostic.linker_words.is_some() => {}
        None => text.push_str("tcc: "),
    }
    if diagnostic.severity == Severity::Warning {
        text.push_str("warning: ");
    }
    text.push_str(&diagnostic.message);
    if let Some(help) = &diagnostic.help {
        text.push_str(&format!(" ({help})"));
    }
    text.push('\n');
    text
}

/// The beginning of a text that is too long, in whole characters.
fn truncate(text: &str) -> &str {
    let end = (0..LIMIT - 1).rev().find(|end| text.is_char_boundary(*end));
    end.and_then(|end| text.get(..end)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Lint;
    use crate::source::Span;

    fn check(diagnostics: &[Diagnostic], expect: &str) {
        let mut sources = SourceMap::new();
        sources.add_file("a.c", None, b"\n#include \"b.h\"\nint a;\n".to_vec(), None);
        sources.add_file("b.h", None, b"int b;\n".to_vec(), Some(Span::new(10, 15)));
        assert_eq!(render(diagnostics, &sources), expect);
    }

    #[test]
    fn warnings_alone_are_not_printed() {
        check(&[], "");
        check(&[Diagnostic::warning(Lint::ImplicitInt, Span::new(17, 18), "hm")], "");
    }

    #[test]
    fn errors_come_before_warnings_and_undefined_symbols_come_last() {
        let undefined = Diagnostic::error(Span::new(17, 18), "undefined function `f`").help("write it");
        let diagnostics = [
            Diagnostic::warning(Lint::ImplicitInt, Span::new(0, 1), "hm"),
            undefined.undefined("f"),
            Diagnostic::global_error("a.c: no `main`").linker_words("main not defined"),
            Diagnostic::error(Span::new(28, 29), "no"),
            Diagnostic::global_error("nothing fits"),
        ];
        let expect = "In file included from a.c:2:\nb.h:1: no\ntcc: nothing fits\n\
            tcc: undefined symbol 'f'\na.c:3: undefined function `f` (write it)\n\
            tcc: main not defined\na.c: no `main`\na.c:1: warning: hm\n";
        check(&diagnostics, expect);
    }

    #[test]
    fn the_pipe_is_never_filled() {
        let long = Diagnostic::error(Span::new(0, 1), "\u{E9}".repeat(3000));
        let mut sources = SourceMap::new();
        sources.add_file("a.c", None, b"x".to_vec(), None);
        let text = render(&[long.clone(), long], &sources);
        assert!(text.len() < LIMIT && text.len() > LIMIT - 4 && text.starts_with("a.c:1: \u{E9}"));
        let short: Vec<_> = (0..200).map(|n| Diagnostic::error(Span::new(0, 1), format!("no {n}"))).collect();
        let text = render(&short, &sources);
        assert!(text.len() < LIMIT && text.ends_with('\n') && text.starts_with("a.c:1: no 0\n"));
    }
}
