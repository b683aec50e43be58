//! Diagnostics: errors in the source, their locations, and their remedies.
//!
//! Analysis continues after a diagnostic; the sink collects them. The caller renders them (`render` for people).

pub mod levels;
mod lint;

pub(crate) use lint::for_each_lint;
pub use lint::{Lint, Preset};

use crate::source::Span;

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The program cannot be compiled.
    Error,
    /// The program is compiled, but this is probably a mistake.
    Warning,
    /// Information for the user.
    Note,
}

/// A further location that explains the diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The range in the source.
    pub span: Span,
    /// The message about that range.
    pub message: String,
}

/// A diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use = "a diagnostic does nothing until it is reported to a sink"]
pub struct Diagnostic {
    /// Its severity.
    pub severity: Severity,
    /// The lint that found it; `None` for errors without a switch.
    pub lint: Option<Lint>,
    /// The finding in one lower-case line without a full stop.
    pub message: String,
    /// Its range in the source; `None` for findings about the whole program.
    pub span: Option<Span>,
    /// The text at the primary range, about its contents or the expected ones.
    pub at: String,
    /// Further places.
    pub labels: Vec<Label>,
    /// Explanations, one line each.
    pub notes: Vec<String>,
    /// A suggestion for the user.
    pub help: Option<String>,
    /// The message of the vendor's linker for this error, if it is a linker error; other programs search for it.
    pub linker_words: Option<String>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, None, Some(span), message)
    }

    /// An error that has no place in the source.
    pub fn global_error(message: impl Into<String>) -> Self {
        Self::new(Severity::Error, None, None, message)
    }

    /// A warning that has no place in the source and no switch.
    pub fn global_warning(message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, None, None, message)
    }

    /// A warning of `lint` at `span`.
    pub fn warning(lint: Lint, span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, Some(lint), Some(span), message)
    }

    /// A warning that the program itself requests; it has no switch.
    pub fn requested_warning(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, None, Some(span), message)
    }

    /// A note at `span`.
    pub fn remark(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, None, Some(span), message)
    }

    fn new(severity: Severity, lint: Option<Lint>, span: Option<Span>, message: impl Into<String>) -> Self {
        Self {
            severity,
            lint,
            message: message.into(),
            span,
            at: String::new(),
            labels: Vec::new(),
            notes: Vec::new(),
            help: None,
            linker_words: None,
        }
    }

    /// Adds the text shown at the primary range.
    pub fn at(mut self, text: impl Into<String>) -> Self {
        self.at = text.into();
        self
    }

    /// Adds a further location.
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Self {
        self.labels.push(Label { span, message: message.into() });
        self
    }

    /// Adds an explanation.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Adds advice for the user.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Says that the finding is a symbol which neither the program nor the firmware defines.
    pub fn undefined(self, symbol: &str) -> Self {
        self.linker_words(format!("undefined symbol '{symbol}'"))
    }

    /// Adds the message of the vendor's linker.
    pub fn linker_words(mut self, words: impl Into<String>) -> Self {
        self.linker_words = Some(words.into());
        self
    }
}

/// Bytes of a text after which the rest is not shown: no name that people write is that long.
const LONGEST_TEXT: usize = 500;

impl Diagnostic {
    /// Truncates text that is too long to read.
    fn shorten(&mut self) {
        let labels = self.labels.iter_mut().map(|label| &mut label.message);
        let texts =
            [&mut self.message, &mut self.at].into_iter().chain(&mut self.notes).chain(&mut self.help);
        for text in texts.chain(labels).filter(|text| text.len() > LONGEST_TEXT) {
            let end = (0..=LONGEST_TEXT).rev().find(|end| text.is_char_boundary(*end));
            text.truncate(end.unwrap_or(0));
            text.push('…');
        }
    }
}

/// The number of errors after which a stage of the compiler stops: later errors are seldom worth reading.
pub const MAX_ERRORS: usize = 20;

/// The message of a stage that gives up.
pub const TOO_MANY_ERRORS: &str = "more than 20 errors; the rest of the program was not checked";

/// The limit of warnings and notes that are kept; further ones are only counted, so that hostile text cannot exhaust
/// memory.
const MAX_REMARKS: usize = 2000;

/// Collects diagnostics in the order of discovery.
#[derive(Debug, Default)]
pub struct Sink {
    diagnostics: Vec<Diagnostic>,
    errors: usize,
    lacks_names: bool,
    /// The rest of a file was not read.
    lacks_text: bool,
}

impl Sink {
    /// Makes an empty sink.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a diagnostic. Errors at further locations after [`MAX_ERRORS`] are only counted.
    pub fn report(&mut self, mut diagnostic: Diagnostic) {
        let is_kept = match diagnostic.severity {
            Severity::Error => {
                self.errors += 1;
                self.errors <= MAX_ERRORS || diagnostic.span.is_none()
            }
            Severity::Warning | Severity::Note => self.diagnostics.len() < MAX_REMARKS,
        };
        if is_kept {
            diagnostic.shorten();
            self.diagnostics.push(diagnostic);
        }
    }

    /// Takes a diagnostic, if there is one.
    pub fn report_if(&mut self, diagnostic: Option<Diagnostic>) {
        diagnostic.into_iter().for_each(|diagnostic| self.report(diagnostic));
    }

    /// Takes an error after which names of the program are unknown, because a file was not included. Unknown names are
    /// then not reported as errors.
    pub fn report_lost_names(&mut self, error: Diagnostic) {
        self.lacks_names |= error.severity == Severity::Error;
        self.report(error);
    }

    /// Takes an error that hides the rest of a file: a comment without an end. Anything missing after it, such as
    /// names, is then not reported as an error.
    pub fn report_lost_text(&mut self, error: Diagnostic) {
        self.lacks_text = true;
        self.report_lost_names(error);
    }

    /// Reports whether an error that was reported hides the rest of a file.
    #[must_use]
    pub fn lacks_text(&self) -> bool {
        self.lacks_text
    }

    /// Reports whether names are unknown because of an error that was reported.
    #[must_use]
    pub fn lacks_names(&self) -> bool {
        self.lacks_names
    }

    /// Reports whether the limit of reported errors is reached, so that the search for more stops.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.errors >= MAX_ERRORS
    }

    /// Reports whether an error was reported.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Number of errors so far.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// Everything reported so far.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
}
