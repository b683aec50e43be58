//! Message and input boxes of programs on a connected controller, answered by the user at the terminal.

use std::io::{self, BufRead, IsTerminal};
use std::sync::mpsc::{self, Receiver};
use std::thread;

use anyhow::Result;
use cc67_host::{End, Target};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;
use runtime::{Event, OpenBox};

use super::BoardSession;
use crate::cli::io::terminal;

/// The interval at which boxes and answers are checked, in seconds.
const LOOK: f64 = 0.1;

/// The user who answers.
#[derive(Debug, Default)]
struct BoxUser {
    /// The box whose question was shown.
    asked: Option<OpenBox>,
    /// The lines typed by the user; `None` before the first question.
    lines: Option<Receiver<String>>,
}

/// Runs until everything has ended, or to the limit, and asks the user at the terminal for answers to boxes.
pub(crate) fn run_with_boxes<T: Target>(
    board: &mut BoardSession<T>,
    limit: Ticks,
    sink: &mut dyn FnMut(Event),
) -> Result<End> {
    let mut person = BoxUser::default();
    loop {
        let part = Ticks::new(board.session.tick().get().saturating_add((LOOK / TIMEBASE) as u64)).min(limit);
        let end = board.run(part, None, sink);
        if end != End::Limit || board.session.tick() >= limit {
            return Ok(end);
        }
        if let Some(setting) = person.look(board.session.target().open_box()) {
            board.session.answer(&setting)?;
        }
    }
}

impl BoxUser {
    /// Shows the question of a new box; returns the answer, once there is one.
    fn look(&mut self, open: Option<OpenBox>) -> Option<String> {
        if open != self.asked {
            self.asked = open;
            self.ask();
        }
        let line = self.lines.as_ref()?.try_recv().ok()?;
        let setting = setting(self.asked.as_ref()?, line.trim());
        if setting.is_none() {
            self.ask();
        }
        setting
    }

    fn ask(&mut self) {
        let Some(open) = &self.asked else { return };
        if !io::stdin().is_terminal() {
            terminal::note(
                "nobody is here to answer: `--answer msgbox=BUTTON` or `input=NUMBER` does, one for each box",
            );
            return;
        }
        let choices = match open {
            OpenBox::Message { buttons, .. } => buttons.join(", "),
            OpenBox::Input { .. } => "a number, cancel".to_owned(),
        };
        terminal::print_separated(&format!("answer ({choices}): "));
        self.lines.get_or_insert_with(lines);
    }
}

/// Reads lines in the background, as the program on the board continues meanwhile.
fn lines() -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}

/// The answer typed by the user, in the form of `--answer`; `None` if it is not valid for the box.
fn setting(open: &OpenBox, typed: &str) -> Option<String> {
    match open {
        OpenBox::Message { buttons, .. } => {
            let button = buttons.iter().find(|button| button.eq_ignore_ascii_case(typed));
            button.map(|button| format!("msgbox={button}"))
        }
        OpenBox::Input { .. } if typed.eq_ignore_ascii_case("cancel") => Some("input=cancel".to_owned()),
        OpenBox::Input { .. } => typed.parse::<f64>().is_ok().then(|| format!("input={typed}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_one_that_the_box_has() {
        let message = OpenBox::Message { text: String::new(), buttons: &["yes", "no"] };
        let input = OpenBox::Input { text: String::new() };
        for (open, typed, expect) in [
            (&message, "Yes", Some("msgbox=yes")),
            (&message, "ok", None),
            (&input, "2.5", Some("input=2.5")),
            (&input, "cancel", Some("input=cancel")),
            (&input, "deep", None),
        ] {
            assert_eq!(setting(open, typed).as_deref(), expect, "{typed}");
        }
    }
}
