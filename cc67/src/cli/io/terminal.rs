//! Messages to the user at the terminal.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;

use compiler::render::human::Color;

/// The file that replaces stderr, for a process whose stderr nobody reads.
static FILE: OnceLock<File> = OnceLock::new();

thread_local! {
    /// The name of the subject of this thread, with a colon; empty in most threads.
    static SUBJECT: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Makes all messages of this thread begin with the name of its subject.
pub(crate) fn name_subject(name: &str) {
    SUBJECT.with_borrow_mut(|subject| *subject = format!("{name}: "));
}

/// From now on writes all messages to a file instead of stderr.
pub(crate) fn write_to(path: &Path) -> io::Result<()> {
    let file = File::create(path)?;
    // A file that is already set is kept.
    let _ = FILE.set(file);
    Ok(())
}

fn write(text: &str) {
    // If stderr is closed, or the file's disk is full, nobody can be informed.
    let _ = match FILE.get() {
        Some(mut file) => file.write_all(text.as_bytes()),
        None => io::stderr().write_all(text.as_bytes()),
    };
}

/// Prints a message about the request or its inputs as one line.
pub(crate) fn error(error: &anyhow::Error) {
    note(&format!("{error:#}"));
}

/// Prints a line of cc67's own to stderr.
pub(crate) fn note(message: &str) {
    SUBJECT.with_borrow(|subject| write(&format!("cc67: {subject}{message}\n")));
}

/// Prints a text of cc67's own to stderr, separated from the console.
pub(crate) fn print_separated(text: &str) {
    write(text);
}

/// Returns whether a stream shows colours.
pub(crate) fn color(stream: &impl IsTerminal) -> Color {
    let shown = stream.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if shown { Color::Always } else { Color::Never }
}
