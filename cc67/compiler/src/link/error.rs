//! Errors and warnings of the linker.

use kmotiondef::boards::TargetBoard;

use crate::diag::Diagnostic;
use crate::source::Span;
use crate::words::foreign;

/// The reason why the program cannot be linked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind}")]
pub struct LinkError {
    /// The index of the object that it concerns, if any.
    pub object: Option<usize>,
    /// The range in that object's source.
    pub span: Option<Span>,
    /// The kind of error.
    pub kind: LinkErrorKind,
    /// The users of the symbol: "`main` (a.c:5)".
    pub users: Vec<String>,
}

/// A kind of link error.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkErrorKind {
    /// There is no entry point.
    #[error("no `main`")]
    NoMain,
    /// An undefined name.
    #[error("undefined symbol `{name}`")]
    Undefined {
        /// The name.
        name: String,
        /// A similar name that may be meant.
        suggestion: Option<String>,
        /// Another board whose firmware has the symbol.
        other: Option<&'static TargetBoard>,
    },
    /// Two units define one name.
    #[error("`{name}` is defined twice, in {first} and in {second}")]
    DefinedTwice {
        /// The name.
        name: String,
        /// File and line of the first definition.
        first: String,
        /// File and line of the second.
        second: String,
    },
    /// A call of something that is not a function.
    #[error("`{name}` is called, but is not a function")]
    NotAFunction {
        /// The name.
        name: String,
    },
    /// The arguments or the result of a call do not match the function.
    #[error("`{name}` is called as `{called}`, but is `{defined}`")]
    CallMismatch {
        /// The name.
        name: String,
        /// The signature of the call.
        called: String,
        /// The signature of the function.
        defined: String,
    },
    /// The program does not fit the program area.
    #[error("the program is {excess} bytes too large for the {space} bytes after its address")]
    TooLarge {
        /// Bytes beyond the limit.
        excess: u32,
        /// Bytes from the program's address to the limit.
        space: u32,
        /// The largest symbols, `name (bytes)`.
        largest: Vec<String>,
    },
    /// Objects for the simulated board and for the controller's processor.
    #[error("its code is for a different target than the first file")]
    OtherTarget,
    /// More signatures than the bytecode can number.
    #[error("the program uses too many different function types")]
    TooManySignatures,
}

impl LinkError {
    /// An error that concerns the whole program.
    pub(super) const fn global(kind: LinkErrorKind) -> Self {
        Self { object: None, span: None, kind, users: Vec::new() }
    }

    /// The error as a diagnostic; its span belongs to the sources of the object it concerns.
    pub fn to_diagnostic(&self) -> Diagnostic {
        let message = self.kind.to_string();
        let diagnostic = match self.span {
            Some(span) => Diagnostic::error(span, message),
            None => Diagnostic::global_error(message),
        };
        // A use that is shown as source text is not listed.
        let shown = usize::from(self.span.is_some());
        let diagnostic = match self.users.get(shown..) {
            None | Some([]) => diagnostic,
            Some(users) => diagnostic.note(format!("used by {}", enumerate(users))),
        };
        match &self.kind {
            LinkErrorKind::Undefined { name, suggestion, other } => {
                let diagnostic = diagnostic.undefined(name);
                if let Some(other) = other {
                    let help = format!("`{name}` is of {}: `--board {}`", other.title(), other.name);
                    return diagnostic.help(help);
                }
                match (foreign::word(name), suggestion) {
                    (Some(word), _) => diagnostic.help(word.advice),
                    (None, Some(near)) => diagnostic.help(format!("did you mean `{near}`?")),
                    (None, None) => diagnostic.at("neither the program nor the firmware defines it"),
                }
            }
            LinkErrorKind::TooLarge { largest, .. } => diagnostic
                .note(format!("the largest parts in bytes: {}", largest.join(", ")))
                .help("make tables smaller, or keep large ones in `gather_buffer`"),
            LinkErrorKind::NoMain => {
                diagnostic.linker_words("main not defined").note("a program begins at `main`")
            }
            LinkErrorKind::DefinedTwice { .. } => {
                diagnostic.help("make one of them `static`, rename it, or leave its file out")
            }
            LinkErrorKind::NotAFunction { .. }
            | LinkErrorKind::CallMismatch { .. }
            | LinkErrorKind::OtherTarget
            | LinkErrorKind::TooManySignatures => diagnostic,
        }
    }
}

/// The most users that are named.
const NAMED_USERS: usize = 6;

/// "a, b and 3 others".
fn enumerate(users: &[String]) -> String {
    let named = users[..users.len().min(NAMED_USERS)].join(", ");
    match users.len().saturating_sub(NAMED_USERS) {
        0 => named,
        1 => format!("{named} and one other"),
        others => format!("{named} and {others} others"),
    }
}

/// A warning about a program that was linked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkWarning {
    /// The program is larger than its thread's space.
    #[error(
        "the program is {excess} bytes larger than its space; it enters the space of thread {}",
        list(entered)
    )]
    EntersOtherThreads {
        /// Bytes after the end of the thread's own space.
        excess: u32,
        /// The threads whose spaces are overlapped.
        entered: Vec<u8>,
        /// The largest symbols, `name (bytes)`.
        largest: Vec<String>,
    },
}

impl LinkWarning {
    /// The warning as a diagnostic.
    pub(crate) fn to_diagnostic(&self) -> Diagnostic {
        let Self::EntersOtherThreads { largest, .. } = self;
        Diagnostic::global_warning(self.to_string())
            .note(format!("the largest parts in bytes: {}", largest.join(", ")))
    }
}

fn list(threads: &[u8]) -> String {
    let numbers: Vec<String> = threads.iter().map(u8::to_string).collect();
    numbers.join(", ")
}
