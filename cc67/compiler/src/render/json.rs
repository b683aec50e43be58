//! Diagnostics as JSON, one object a line, for programs.
//!
//! The members, in this order; the names are those of the Rust compiler's output where there is one:
//!
//! | member | value |
//! |---|---|
//! | `level` | `"error"`, `"warning"` or `"note"` |
//! | `code` | the name of the warning's `-W` switch; `null` for what no switch controls |
//! | `message` | the finding in one line |
//! | `spans` | the places, that of the mistake first; empty for findings about the whole program |
//! | `notes` | explanations, one line each |
//! | `suggestion` | what to do, or `null` |
//! | `rendered` | all of it as `--message-format human` shows it, without colours |
//!
//! A span:
//!
//! | member | value |
//! |---|---|
//! | `file` | the file as the command line or the include search names it |
//! | `byte_start`, `byte_end` | the range of bytes in the file, from 0, the end not included |
//! | `line_start`, `column_start` | where it begins, from 1; columns count bytes |
//! | `line_end`, `column_end` | where it ends, the column after the last byte |
//! | `is_primary` | whether this is the place of the mistake; the others explain it |
//! | `label` | what is there, or `null` |
//!
//! Members may be added; these keep their meaning. Lines of standard error that do not begin
//! with `{` are not diagnostics: they are about the command line, its files or the board.

use serde::Serialize;

use crate::diag::Diagnostic;
use crate::source::{SourceFile, SourceMap};

use super::human::{self, Color};
use super::marks::{Mark, marks, notes};
use super::severity_name;

/// Renders the diagnostics of one compilation.
#[derive(Debug)]
pub struct Renderer<'a> {
    sources: &'a SourceMap,
    human: human::Renderer<'a>,
}

#[derive(Serialize)]
struct Message<'a> {
    level: &'a str,
    code: Option<&'a str>,
    message: &'a str,
    spans: Vec<JsonSpan<'a>>,
    notes: Vec<String>,
    suggestion: Option<&'a str>,
    rendered: String,
}

#[derive(Serialize)]
struct JsonSpan<'a> {
    file: &'a str,
    byte_start: usize,
    byte_end: usize,
    line_start: usize,
    line_end: usize,
    column_start: usize,
    column_end: usize,
    is_primary: bool,
    label: Option<String>,
}

impl<'a> Renderer<'a> {
    /// A renderer for diagnostics about `sources`.
    #[must_use]
    pub fn new(sources: &'a SourceMap) -> Self {
        Self { sources, human: human::Renderer::new(sources, Color::Never) }
    }

    /// The diagnostic as one JSON object without line ends.
    #[must_use]
    pub fn render(&mut self, diagnostic: &Diagnostic) -> String {
        let message = Message {
            level: severity_name(diagnostic.severity),
            code: diagnostic.lint.map(|lint| lint.name()),
            message: &diagnostic.message,
            spans: marks(diagnostic, self.sources).into_iter().map(|mark| self.place(mark)).collect(),
            notes: notes(diagnostic, self.sources),
            suggestion: diagnostic.help.as_deref(),
            rendered: self.human.render(diagnostic),
        };
        serde_json::to_string(&message).expect("text, numbers and lists of them have a JSON form")
    }

    fn place(&self, mark: Mark) -> JsonSpan<'a> {
        let file = self.sources.file(mark.file);
        let (line_start, column_start) = line_and_column(file, mark.range.start);
        let (line_end, column_end) = line_and_column(file, mark.range.end);
        JsonSpan {
            file: &file.name,
            byte_start: mark.range.start,
            byte_end: mark.range.end,
            line_start,
            line_end,
            column_start,
            column_end,
            is_primary: mark.is_primary,
            label: Some(mark.message).filter(|message| !message.is_empty()),
        }
    }
}

/// Line and column of an offset, from 1.
fn line_and_column(file: &SourceFile, offset: usize) -> (usize, usize) {
    let lines = file.lines();
    let line = lines.partition_point(|start| *start as usize <= offset);
    let start = line.checked_sub(1).and_then(|line| lines.get(line)).map_or(0, |start| *start as usize);
    (line, offset - start + 1)
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::diag::Lint;
    use crate::source::Span;

    #[test]
    fn an_object_has_every_member() {
        let mut sources = SourceMap::new();
        sources.add_file("a.c", None, b"int a;\nint b;\n".to_vec(), None);
        let diagnostic = Diagnostic::warning(Lint::ImplicitInt, Span::new(11, 12), "say \"no\"")
            .at("here")
            .label(Span::new(4, 7), "")
            .note("why")
            .help("what");
        let line = Renderer::new(&sources).render(&diagnostic);
        assert!(!line.contains('\n'), "{line}");
        let mut value: Value = serde_json::from_str(&line).expect("it is JSON");
        let rendered = value["rendered"].take();
        assert!(
            rendered.as_str().is_some_and(|text| text.contains("a.c:2:5") && text.contains("help: what"))
        );
        let place = |start, end, lines: [u32; 2], columns: [u32; 2], is_primary, label: Option<&str>| {
            json!({
                "file": "a.c", "byte_start": start, "byte_end": end, "line_start": lines[0],
                "line_end": lines[1], "column_start": columns[0], "column_end": columns[1],
                "is_primary": is_primary, "label": label,
            })
        };
        let expect = json!({
            "level": "warning",
            "code": "implicit-int",
            "message": "say \"no\"",
            "spans": [
                place(11, 12, [2, 2], [5, 6], true, Some("here")),
                place(4, 7, [1, 2], [5, 1], false, None),
            ],
            "notes": ["why"],
            "suggestion": "what",
            "rendered": null,
        });
        assert_eq!(value, expect);
    }
}
