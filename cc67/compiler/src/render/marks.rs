//! The ranges and explanations of a diagnostic, for every format.
//!
//! Text from a macro is marked at the call, together with the macro's own text; for a header the chain of `#include`s
//! follows.

use std::ops::Range;

use crate::diag::Diagnostic;
use crate::source::{FileId, SourceMap, Span};

/// Macros within macros that are shown.
const SHOWN_MACROS: usize = 4;

/// More includes than these are counted, not listed: a file that includes itself has many.
const SHOWN_INCLUDES: usize = 4;

/// A marked range of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mark {
    /// The file.
    pub(super) file: FileId,
    /// The bytes in it.
    pub(super) range: Range<usize>,
    /// True for the primary range, false for one that explains it.
    pub(super) is_primary: bool,
    /// The message, which may be empty.
    pub(super) message: String,
}

/// The marked ranges of a diagnostic, the place of the mistake first.
pub(super) fn marks(diagnostic: &Diagnostic, sources: &SourceMap) -> Vec<Mark> {
    let mut marks = Vec::new();
    if let Some(span) = diagnostic.span {
        marks.extend(mark(sources.call_site(span), &diagnostic.at, sources));
        if let Some(primary) = marks.first_mut() {
            primary.is_primary = true;
        }
        marks.extend(macro_marks(span, sources));
    }
    for label in &diagnostic.labels {
        marks.extend(mark(sources.call_site(label.span), &label.message, sources));
    }
    marks
}

/// The explanations of a diagnostic, beginning with those about its position.
pub(super) fn notes(diagnostic: &Diagnostic, sources: &SourceMap) -> Vec<String> {
    let mut notes = diagnostic.span.map_or_else(Vec::new, |span| included_from(span, sources));
    notes.extend(diagnostic.notes.iter().cloned());
    notes
}

fn mark(span: Span, message: &str, sources: &SourceMap) -> Option<Mark> {
    let file = sources.file_at(span.lo)?;
    let source = sources.file(file);
    let offset = |position: u32| (position.max(source.start) - source.start) as usize;
    let end = source.text.len();
    let range = offset(span.lo).min(end)..offset(span.hi.max(span.lo)).min(end);
    Some(Mark { file, range, is_primary: false, message: message.to_owned() })
}

/// The positions in macro bodies from which the text comes, the innermost first.
fn macro_marks(span: Span, sources: &SourceMap) -> Vec<Mark> {
    let mut marks = Vec::new();
    let mut span = span;
    while let Some(expansion) = sources.expansion(span.expansion) {
        let name = sources.macro_name(expansion);
        let message = format!("in expansion of macro `{name}`");
        let spelled = if sources.is_scratch(span) { expansion.definition } else { span };
        let is_shown = |mark: &Mark| sources.file(mark.file).path.is_some() || marks.is_empty();
        let mark = mark(spelled, &message, sources).filter(is_shown);
        marks.extend(mark);
        span = expansion.call;
        if marks.len() == SHOWN_MACROS {
            break;
        }
    }
    marks
}

/// The `#include`s that led to the file of a span, the innermost first.
fn included_from(span: Span, sources: &SourceMap) -> Vec<String> {
    let mut notes = Vec::new();
    let mut more = 0;
    for include in includes(span, sources) {
        match sources.place(include) {
            Some(place) if notes.len() < SHOWN_INCLUDES => {
                notes.push(format!("included from {}:{}", sources.file(place.file).name, place.line));
            }
            _ => more += 1,
        }
    }
    if more > 0 {
        notes.push(format!("… and {more} more"));
    }
    notes
}

/// The `#include` directives around a span, the innermost first.
pub(super) fn includes(span: Span, sources: &SourceMap) -> impl Iterator<Item = Span> {
    let include_of = move |span: Span| {
        let file = sources.file_at(sources.call_site(span).lo)?;
        sources.file(file).included_at
    };
    std::iter::successors(include_of(span), move |at| include_of(*at))
}
