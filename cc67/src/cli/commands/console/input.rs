//! Input lines: from the keyboard, with history and completion, or from a script.

use std::borrow::Cow;
use std::io;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use anyhow::{Context as _, Result};
use runtime::commands::command_named;
use rustyline::completion::{Completer, Pair};
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::DefaultHistory;
use rustyline::validate::Validator;
use rustyline::{Context, Editor, Helper};

use super::screen::Printer;
use super::words;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Input {
    /// A line.
    Line(String),
    /// Ctrl-C.
    Interrupt,
}

/// Lines that arrive while the board continues.
pub(super) struct Lines {
    inputs: Receiver<Input>,
    /// Tells the keyboard thread to continue: it must not leave the terminal in editing mode when nobody reads lines
    /// any more.
    ready: Option<Sender<()>>,
}

impl Lines {
    /// The next line, if it comes before the timeout.
    pub(super) fn within(&self, time: Duration) -> Result<Input, RecvTimeoutError> {
        self.inputs.recv_timeout(time)
    }

    /// The next line.
    pub(super) fn next(&self) -> Result<Input, RecvTimeoutError> {
        self.inputs.recv().map_err(|_| RecvTimeoutError::Disconnected)
    }

    /// Notes that the line has been executed, and allows another one.
    pub(super) fn ready(&self) {
        if let Some(ready) = &self.ready {
            // If the keyboard thread has ended, so has the input, which the next read shows.
            let _ = ready.send(());
        }
    }
}

/// Lines typed by the user, edited in a separate thread so that the board continues meanwhile.
pub(super) fn keyboard() -> Result<(Lines, Printer)> {
    let mut editor: Editor<Guide, DefaultHistory> = Editor::new().context("no terminal to edit lines on")?;
    editor.set_helper(Some(Guide));
    let printer = editor.create_external_printer().context("no terminal to print on")?;
    let ((sender, inputs), (ready, go_on)) = (channel(), channel());
    thread::spawn(move || read(&mut editor, &sender, &go_on));
    Ok((Lines { inputs, ready: Some(ready) }, Box::new(printer)))
}

/// Passes on lines until the end of the input, or until the receiver is dropped.
fn read(editor: &mut Editor<Guide, DefaultHistory>, sender: &Sender<Input>, go_on: &Receiver<()>) {
    loop {
        let input = match editor.readline("KFLOP> ") {
            Ok(line) => {
                // If a line cannot be added to the history, it only has to be typed again.
                let _ = editor.add_history_entry(&line);
                Input::Line(line)
            }
            Err(ReadlineError::Interrupted) => Input::Interrupt,
            Err(_) => return,
        };
        if sender.send(input).is_err() || go_on.recv().is_err() {
            return;
        }
    }
}

/// Lines of a script, read in the background while the board keeps pace with the clock.
pub(super) fn script_beside() -> Lines {
    let (sender, inputs) = channel();
    thread::spawn(move || {
        for line in io::stdin().lines().map_while(Result::ok) {
            if sender.send(Input::Line(line)).is_err() {
                return;
            }
        }
    });
    Lines { inputs, ready: None }
}

/// Completes words, and shows hints about a command's arguments.
struct Guide;

/// Returns the completions of the word at the cursor: its start, and the names.
fn candidates(line: &str, cursor: usize) -> (usize, Vec<String>) {
    let before = line.get(..cursor).unwrap_or(line);
    let part = before.rfind(';').map_or(0, |at| at + 1);
    let start = before.rfind([' ', ';']).map_or(0, |at| at + 1);
    let word = &before[start..];
    let first = before[part..start].trim();
    let fits = |name: &&str| {
        name.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word)) && !word.is_empty()
    };
    let names: Vec<String> = match first {
        "" => words::first_words().filter(fits).map(str::to_owned).collect(),
        "help" | "?" => words::topics().filter(fits).map(str::to_owned).collect(),
        "load" | "run" => files(word),
        _ => Vec::new(),
    };
    (start, names)
}

/// Sources and folders whose path begins with a text after an optional thread number.
fn files(text: &str) -> Vec<String> {
    let (thread, path) = match text.split_once(':') {
        Some((thread, path)) => (&text[..=thread.len()], path),
        None => ("", text),
    };
    let (folder, name) = path.rfind('/').map_or(("", path), |at| path.split_at(at + 1));
    let entries = std::fs::read_dir(if folder.is_empty() { "." } else { folder });
    let mut found: Vec<String> = entries
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| {
            let entry_name = entry.file_name().into_string().ok()?;
            let is_folder = entry.path().is_dir();
            let is_program = [".c", ".out"].iter().any(|end| entry_name.ends_with(end));
            let slash = if is_folder { "/" } else { "" };
            (entry_name.starts_with(name) && (is_folder || is_program))
                .then(|| format!("{thread}{folder}{entry_name}{slash}"))
        })
        .collect();
    found.sort();
    found
}

impl Completer for Guide {
    type Candidate = Pair;

    fn complete(&self, line: &str, cursor: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Pair>)> {
        let (start, names) = candidates(line, cursor);
        let pairs = names.into_iter().map(|name| Pair { display: name.clone(), replacement: name });
        Ok((start, pairs.collect()))
    }
}

impl Hinter for Guide {
    type Hint = String;

    fn hint(&self, line: &str, cursor: usize, _: &Context<'_>) -> Option<String> {
        let name = line.strip_suffix(' ')?;
        let command = command_named(name.rsplit(';').next()?)?;
        let usage = command.usage();
        (cursor == line.len()).then(|| usage[command.name.len()..].trim_start().to_owned())
    }
}

impl Highlighter for Guide {
    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        Cow::Owned(format!("\x1b[2m{hint}\x1b[m"))
    }
}

impl Validator for Guide {}
impl Helper for Guide {}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(line: &str, start: usize, expect: &[&str]) {
        let (at, mut names) = candidates(line, line.len());
        names.sort();
        names.dedup();
        assert_eq!((at, names), (start, expect.iter().map(ToString::to_string).collect()), "{line}");
    }

    #[test]
    fn words_are_completed_in_any_case() {
        check("checkdoneb", 0, &["CheckDoneBuf"]);
        check("Jog0=5;movee", 7, &["MoveExp"]);
        check("help WaitNext", 5, &["WaitNextTimeSlice"]);
        check("wai", 0, &["WaitBitBuf", "WaitNotBitBuf", "wait"]);
        check("Jog ", 4, &[]);
    }
}
