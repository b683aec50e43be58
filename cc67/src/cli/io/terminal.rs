//! Writing to the person in front of the terminal.

use std::io::{self, IsTerminal, Write};

use compiler::render::human::Color;

/// Prints a message about the request or its inputs as one line.
pub(crate) fn error(error: &anyhow::Error) {
    note(&format!("{error:#}"));
}

/// Prints a line of our own to stderr.
pub(crate) fn note(message: &str) {
    // Nobody is left to be told when stderr is gone.
    let _ = writeln!(io::stderr(), "cc67: {message}");
}

/// Prints a text of our own to stderr, apart from the console.
pub(crate) fn aside(text: &str) {
    // Nobody is left to be told when stderr is gone.
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Whether a stream shows colours.
pub(crate) fn color(stream: &impl IsTerminal) -> Color {
    let shown = stream.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if shown { Color::Always } else { Color::Never }
}
