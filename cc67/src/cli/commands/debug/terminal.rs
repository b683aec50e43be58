//! Interactive input: lines with history and completion.

use std::borrow::Cow;
use std::cell::RefCell;
use std::io::{self, IsTerminal};
use std::rc::Rc;
use std::sync::Arc;

use anyhow::{Context as _, Result};
use cc67_debug::{CommandOutput, Shell};
use cc67_host::Target;
use rustyline::completion::{Completer, Pair};
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::DefaultHistory;
use rustyline::validate::Validator;
use rustyline::{Context, Editor, Helper};

use super::show;
use crate::cli::io::exit::Exit;
use crate::cli::io::{interrupt, output};

const PROMPT: &str = "(cc67) ";

/// Takes commands until the end of the input.
pub(super) fn run_interactive<T: Target + 'static>(shell: &Rc<RefCell<Shell<T>>>) -> Result<Exit> {
    if !io::stdin().is_terminal() {
        for line in io::stdin().lines() {
            if !execute_line(&mut shell.borrow_mut(), &line?)? {
                break;
            }
        }
        return Ok(Exit::Success);
    }
    let flag = Arc::default();
    interrupt::sets(&flag)?;
    shell.borrow_mut().interrupted_by(flag);
    let mut editor: Editor<Guide<T>, DefaultHistory> =
        Editor::new().context("no terminal to edit lines on")?;
    editor.set_helper(Some(Guide(Rc::clone(shell))));
    loop {
        match editor.readline(PROMPT) {
            Ok(line) => {
                // If a line cannot be added to the history, it only has to be typed again.
                let _ = editor.add_history_entry(&line);
                if !execute_line(&mut shell.borrow_mut(), &line)? {
                    return Ok(Exit::Success);
                }
            }
            Err(ReadlineError::Interrupted) => {}
            Err(_) => return Ok(Exit::Success),
        }
    }
}

/// Executes a line; returns whether to continue.
fn execute_line<T: Target>(shell: &mut Shell<T>, line: &str) -> Result<bool> {
    match shell.command(line, &mut |text| show(text)) {
        Ok(CommandOutput::Text(text)) => output::print(&text)?,
        Ok(CommandOutput::Quit) => return Ok(false),
        Err(error) => output::print(&format!("{error}\n"))?,
    }
    Ok(true)
}

/// Completes commands and names in programs.
struct Guide<T: Target>(Rc<RefCell<Shell<T>>>);

impl<T: Target> Completer for Guide<T> {
    type Candidate = Pair;

    fn complete(&self, line: &str, at: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Pair>)> {
        let before = line.get(..at).unwrap_or(line);
        let start =
            before.rfind(|c: char| !(c.is_ascii_alphanumeric() || "_-".contains(c))).map_or(0, |at| at + 1);
        let names = self.0.try_borrow().map(|shell| shell.complete(before)).unwrap_or_default();
        Ok((start, names.into_iter().map(|name| Pair { display: name.clone(), replacement: name }).collect()))
    }
}

impl<T: Target> Hinter for Guide<T> {
    type Hint = String;
}

impl<T: Target> Highlighter for Guide<T> {
    fn highlight_prompt<'b, 's: 'b, 'p: 'b>(&'s self, prompt: &'p str, _: bool) -> Cow<'b, str> {
        Cow::Borrowed(prompt)
    }
}

impl<T: Target> Validator for Guide<T> {}

impl<T: Target> Helper for Guide<T> {}
