//! Diagnostics with their source lines, for people at a terminal.
//!
//! The position shown is the one in the program: for text from a macro that is the call, together with the macro's own
//! text; for a header the chain of `#include`s follows. Source text is shown byte for byte as far as it is UTF-8 and
//! harmless to a terminal; other bytes become question marks, so that every range keeps its position.

use std::collections::BTreeMap;
use std::ops::Range;

use codespan_reporting::diagnostic::{self as report, LabelStyle};
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term::{self, Config};

use crate::diag::{Diagnostic, Severity};
use crate::source::{FileId, SourceMap};

use super::colors::ColoredText;
use super::marks::{Mark, marks, notes};

/// The colouring of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Color {
    /// Plain text.
    Never,
    /// ANSI escapes, for terminals.
    Always,
}

/// Lines longer than this are not shown: they were not written by people.
const SHOWN_LINE: usize = 2000;

/// Renders the diagnostics of one compilation.
#[derive(Debug)]
pub struct Renderer<'a> {
    sources: &'a SourceMap,
    color: Color,
    config: Config,
    /// The files shown so far, as text that is safe to print.
    texts: BTreeMap<FileId, String>,
}

impl<'a> Renderer<'a> {
    /// A renderer for diagnostics about `sources`.
    #[must_use]
    pub fn new(sources: &'a SourceMap, color: Color) -> Self {
        Self { sources, color, config: Config::default(), texts: BTreeMap::new() }
    }

    /// The diagnostic with its source lines, notes and help; ends in an empty line.
    #[must_use]
    pub fn render(&mut self, diagnostic: &Diagnostic) -> String {
        let report = self.report(diagnostic);
        for label in &report.labels {
            let (sources, file) = (self.sources, label.file_id);
            self.texts.entry(file).or_insert_with(|| printable(&sources.file(file).text));
        }
        let is_shown = report
            .labels
            .iter()
            .all(|label| self.line_length(label.file_id, label.range.start) <= SHOWN_LINE);
        let text = if is_shown { self.emit(&report) } else { None };
        text.unwrap_or_else(|| super::short::render(diagnostic, self.sources) + "\n\n")
    }

    fn emit(&self, report: &report::Diagnostic<FileId>) -> Option<String> {
        match self.color {
            Color::Never => term::emit_into_string(&self.config, self, report).ok(),
            Color::Always => {
                let mut colored = ColoredText::default();
                term::emit_to_write_style(&mut colored, &self.config, self, report).ok()?;
                String::from_utf8(colored.into_bytes()).ok()
            }
        }
    }

    /// The diagnostic in the words of the renderer.
    fn report(&self, diagnostic: &Diagnostic) -> report::Diagnostic<FileId> {
        let mut report =
            report::Diagnostic::new(severity(diagnostic.severity)).with_message(&diagnostic.message);
        if let Some(lint) = diagnostic.lint {
            report = report.with_code(lint.name());
        }
        report.labels.extend(marks(diagnostic, self.sources).iter().map(|mark| self.label(mark)));
        report.notes.extend(notes(diagnostic, self.sources));
        report.notes.extend(diagnostic.help.iter().map(|help| format!("help: {help}")));
        report
    }

    fn label(&self, mark: &Mark) -> report::Label<FileId> {
        let style = if mark.is_primary { LabelStyle::Primary } else { LabelStyle::Secondary };
        let range = whole_characters(&self.sources.file(mark.file).text, mark.range.clone());
        report::Label { style, file_id: mark.file, range, message: mark.message.clone() }
    }

    fn line_length(&self, file: FileId, offset: usize) -> usize {
        let range = self.line_index(file, offset).and_then(|line| self.line_range(file, line));
        range.map_or(0, |range| range.len())
    }
}

impl<'a> Files<'a> for Renderer<'_> {
    type FileId = FileId;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, file: FileId) -> Result<&'a str, Error> {
        Ok(&self.sources.file(file).name)
    }

    fn source(&'a self, file: FileId) -> Result<&'a str, Error> {
        self.texts.get(&file).map(String::as_str).ok_or(Error::FileMissing)
    }

    fn line_index(&'a self, file: FileId, offset: usize) -> Result<usize, Error> {
        let lines = self.sources.file(file).lines();
        Ok(lines.partition_point(|start| *start as usize <= offset).saturating_sub(1))
    }

    fn column_number(&'a self, file: FileId, line: usize, offset: usize) -> Result<usize, Error> {
        Ok(offset - self.line_range(file, line)?.start + 1)
    }

    fn line_range(&'a self, file: FileId, line: usize) -> Result<Range<usize>, Error> {
        let source = self.sources.file(file);
        let lines = source.lines();
        let given = Error::LineTooLarge { given: line, max: lines.len() };
        let start = *lines.get(line).ok_or(given)? as usize;
        Ok(start..lines.get(line + 1).map_or(source.text.len(), |next| *next as usize))
    }
}

/// The text with the same number of bytes, all of them harmless.
fn printable(text: &[u8]) -> String {
    let mut result = String::with_capacity(text.len());
    for chunk in text.utf8_chunks() {
        for character in chunk.valid().chars() {
            match character {
                '\n' | '\t' => result.push(character),
                '\r' => result.push(' '),
                _ if character.is_control() => result.extend(std::iter::repeat_n('?', character.len_utf8())),
                _ => result.push(character),
            }
        }
        result.extend(chunk.invalid().iter().map(|_| '?'));
    }
    result
}

/// The range without halves of UTF-8 characters.
fn whole_characters(text: &[u8], range: Range<usize>) -> Range<usize> {
    let is_middle = |at: usize| text.get(at).is_some_and(|byte| byte & 0xC0 == 0x80);
    let start =
        (range.start.saturating_sub(3)..=range.start).rev().find(|at| !is_middle(*at)).unwrap_or(range.start);
    let end = (range.end..range.end + 4).find(|at| !is_middle(*at)).unwrap_or(range.end);
    start..end
}

fn severity(severity: Severity) -> report::Severity {
    match severity {
        Severity::Error => report::Severity::Error,
        Severity::Warning => report::Severity::Warning,
        Severity::Note => report::Severity::Note,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::diag::Lint;
    use crate::source::{Expansion, ExpansionId, Span};

    fn check(diagnostic: &Diagnostic, sources: &SourceMap, expect: &str) {
        let text = Renderer::new(sources, Color::Never).render(diagnostic);
        let lines: Vec<_> = text.lines().map(str::trim_end).collect();
        assert_eq!(lines.join("\n").trim_end(), expect.trim_matches('\n'), "\n{text}");
    }

    fn sources(text: &[u8]) -> SourceMap {
        let mut sources = SourceMap::new();
        sources.add_file("a.c", Some(Path::new("a.c")), text.to_vec(), None);
        sources
    }

    #[test]
    fn a_line_with_its_range_notes_and_help() {
        let sources = sources(b"int a;\r\nint bb = \tcc;\r\n");
        let diagnostic = Diagnostic::warning(Lint::ImplicitInt, Span::new(18, 20), "no")
            .at("here")
            .label(Span::new(4, 5), "there")
            .note("why")
            .help("what");
        let expect = "
warning[implicit-int]: no
  ┌─ a.c:2:11
  │
1 │ int a;
  │     - there
2 │ int bb =    cc;
  │             ^^ here
  │
  = why
  = help: what";
        check(&diagnostic, &sources, expect);
        let colored = Renderer::new(&sources, Color::Always).render(&diagnostic);
        let expect =
            "\u{1B}[0m\u{1B}[1m\u{1B}[38;5;11mwarning[implicit-int]\u{1B}[0m\u{1B}[1m: no\u{1B}[0m\n";
        assert!(colored.starts_with(expect), "{colored:?}");
    }

    #[test]
    fn bytes_of_other_code_pages_do_not_shift_the_range() {
        let sources = sources(b"/* \xE9\xE8 \x1B \xC3\xA9 */ x;");
        let expect = "
error: no
  ┌─ a.c:1:15
  │
1 │ /* ?? ? \u{E9} */ x;
  │              ^";
        check(&Diagnostic::error(Span::new(14, 15), "no"), &sources, expect);
    }

    #[test]
    fn a_macro_is_shown_with_its_call() {
        let mut sources = sources(b"#define A b+1\nint c = A;");
        let call = Span::new(22, 23);
        let expansion = sources.add_expansion(Expansion { definition: Span::new(8, 9), call });
        let span = Span { lo: 10, hi: 11, expansion };
        assert_ne!(expansion, ExpansionId::NONE);
        let expect = "
error: no
  ┌─ a.c:2:9
  │
1 │ #define A b+1
  │           - in expansion of macro `A`
2 │ int c = A;
  │         ^ here";
        check(&Diagnostic::error(span, "no").at("here"), &sources, expect);
    }

    #[test]
    fn headers_say_where_they_were_included() {
        let mut sources = sources(b"\n#include \"b.h\"\n");
        let header = sources.add_file("b.h", Some(Path::new("b.h")), b"x".to_vec(), Some(Span::new(10, 15)));
        let start = sources.file(header).start;
        let expect = "
error: no
  ┌─ b.h:1:2
  │
1 │ x
  │  ^
  │
  = included from a.c:2";
        check(&Diagnostic::error(Span::new(start + 1, start + 1), "no"), &sources, expect);
    }

    #[test]
    fn a_message_whose_source_cannot_be_shown_is_one_line() {
        let sources = sources(&[b'x'; 5000]);
        check(&Diagnostic::error(Span::new(4, 5), "no"), &sources, "a.c:1:5: error: no");
        check(&Diagnostic::global_error("no"), &sources, "error: no");
    }
}
