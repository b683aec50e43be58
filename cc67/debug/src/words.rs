//! The words of the debugger: its commands, which of them a board has, and how their lines are read.

use kmotiondef::ThreadId;

use self::Boards::{Both, Modelled};

/// The boards on which a command works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Boards {
    /// The modelled board and a firmware file.
    Both,
    /// The modelled board alone.
    Modelled,
}

/// A command.
#[derive(Debug)]
struct Command {
    name: &'static str,
    short: &'static [&'static str],
    boards: Boards,
    help: &'static str,
}

const fn row(
    name: &'static str,
    short: &'static [&'static str],
    boards: Boards,
    help: &'static str,
) -> Command {
    Command { name, short, boards, help }
}

/// Every command with its short forms, where it works, and what it does.
const COMMANDS: &[Command] = &[
    row(
        "break",
        &["b", "br"],
        Both,
        "break [FILE:]LINE|FUNCTION|*ADDRESS [thread N] [if CONDITION]: stop there",
    ),
    row("tbreak", &["tb"], Both, "the same, once"),
    row(
        "watch",
        &["wa"],
        Modelled,
        "watch EXPRESSION [if CONDITION]: stop when its value changes, and say who did it",
    ),
    row("dprintf", &[], Modelled, "dprintf PLACE,TEXT: print a text there, {expression} is its value"),
    row("catch", &[], Modelled, "catch trap|remark|start|end|console TEXT|bit N: stop on it"),
    row(
        "condition",
        &["cond"],
        Modelled,
        "condition N [EXPRESSION]: stop at breakpoint N only where it is not 0",
    ),
    row("ignore", &[], Modelled, "ignore N COUNT: pass breakpoint N so often"),
    row("enable", &["en"], Modelled, "enable [N]"),
    row("disable", &["dis"], Modelled, "disable [N]"),
    row("delete", &["d"], Both, "delete [N]: delete a breakpoint, or all"),
    row("run", &["r"], Both, "begin, or begin again"),
    row("continue", &["c"], Both, "continue [COUNT]: go on to the next stop"),
    row("step", &["s"], Both, "step [COUNT]: to the next line, into functions"),
    row("next", &["n"], Both, "next [COUNT]: to the next line, over functions"),
    row("finish", &["fin"], Both, "until the function returns"),
    row("stepi", &["si"], Both, "stepi [COUNT]: one instruction"),
    row("until", &["u"], Both, "until PLACE: go on to it"),
    row("advance", &[], Both, "advance PLACE: go on to it"),
    row("tick", &[], Both, "tick [COUNT]: to the end of the servo tick"),
    row("slice", &[], Modelled, "to the end of the thread's next slice"),
    row("goto", &[], Both, "goto SECONDS: to that board time, back or forward"),
    row("reverse-continue", &["rc"], Both, "back to the last stop"),
    row("reverse-step", &["rs"], Both, "reverse-step [COUNT]: back to the last line"),
    row("reverse-next", &["rn"], Both, "reverse-next [COUNT]: the same over functions"),
    row("reverse-stepi", &["rsi"], Modelled, "reverse-stepi [COUNT]: back by one instruction"),
    row("reverse-finish", &[], Modelled, "back to the call of the function"),
    row("print", &["p", "inspect"], Both, "print[/x] EXPRESSION"),
    row("ptype", &["whatis"], Both, "ptype EXPRESSION: its type"),
    row("x", &[], Modelled, "x/NFU ADDRESS: memory; F is x d u f s c or i, U is b h w g"),
    row(
        "set",
        &[],
        Both,
        "set var NAME = EXPRESSION: another value, which begins a new line of history in the past",
    ),
    row("info", &["i"], Both, "info threads|breakpoints|locals|variables|line|frame|history"),
    row("backtrace", &["bt", "where"], Both, "the calls that led here"),
    row("frame", &["f"], Modelled, "frame [N]: look at a call"),
    row("up", &[], Modelled, "look at the caller"),
    row("down", &[], Modelled, "look at the called function"),
    row("thread", &["t"], Both, "thread [N]: look at a thread"),
    row("list", &["l"], Both, "list [LINE|FUNCTION]: the source"),
    row("disassemble", &["disas"], Both, "the instructions of the function"),
    row("help", &["h"], Both, "this list"),
    row("quit", &["q", "exit"], Both, "end"),
];

impl Command {
    fn is_called(&self, word: &str) -> bool {
        self.name == word || self.short.contains(&word)
    }
}

/// Reads the lines of a debugger.
#[derive(Clone, Debug)]
pub struct LineReader {
    /// Whether the commands of the modelled board alone are refused.
    is_booted: bool,
    /// The last line, for an empty one.
    last: String,
}

impl LineReader {
    /// For the modelled board, which has all commands.
    #[must_use]
    pub const fn modelled() -> Self {
        Self { is_booted: false, last: String::new() }
    }

    /// For a firmware file.
    #[must_use]
    pub const fn booted() -> Self {
        Self { is_booted: true, last: String::new() }
    }

    /// The command of a line, by its full name, and the rest of the line; an empty line repeats the last. `None` for a
    /// comment, and for an empty line at the beginning.
    ///
    /// # Errors
    /// If the word is not a command of this board, or starts several.
    pub fn read(&mut self, line: &str) -> Result<Option<(&'static str, String)>, String> {
        let line = line.trim();
        let line = if line.is_empty() { self.last.clone() } else { line.to_owned() };
        if line.is_empty() || line.starts_with('#') {
            return Ok(None);
        }
        self.last.clone_from(&line);
        let end = line.find(|c: char| c.is_whitespace() || c == '/').unwrap_or(line.len());
        let (word, rest) = line.split_at(end);
        Ok(Some((self.command(word)?, rest.trim().to_owned())))
    }

    /// The commands that the board has.
    fn commands(&self) -> impl Iterator<Item = &'static Command> {
        let is_booted = self.is_booted;
        COMMANDS.iter().filter(move |command| !is_booted || command.boards == Both)
    }

    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.commands().map(|command| command.name)
    }

    /// The list of them, a line each.
    #[must_use]
    pub fn help(&self) -> String {
        let lines = self.commands().map(|Command { name, short, help, .. }| {
            let names = std::iter::once(name).chain(*short).copied().collect::<Vec<_>>().join(", ");
            format!("{names:<24} {help}\n")
        });
        lines.collect()
    }

    /// The command that a word means: its name, a short form, or the beginning of one name alone.
    fn command(&self, word: &str) -> Result<&'static str, String> {
        if let Some(command) = self.commands().find(|command| command.is_called(word)) {
            return Ok(command.name);
        }
        if COMMANDS.iter().any(|command| command.is_called(word)) {
            return Err(format!("`{word}` does not work with `--boot`; `help` lists what does"));
        }
        let starts: Vec<_> = self.names().filter(|name| name.starts_with(word)).collect();
        match starts.as_slice() {
            [one] => Ok(one),
            [] => Err(format!("Undefined command: \"{word}\".  Try \"help\".")),
            many => Err(format!("Ambiguous command \"{word}\": {}.", many.join(", "))),
        }
    }
}

/// What follows `break`: `[PLACE] [thread N] [if CONDITION]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BreakWords<'a> {
    /// The place; empty for the present one.
    pub place: &'a str,
    /// The thread that it is for, if not for all.
    pub thread: Option<ThreadId>,
    /// The condition.
    pub condition: Option<&'a str>,
}

impl<'a> BreakWords<'a> {
    /// The parts of a text.
    #[must_use]
    pub fn of(text: &'a str) -> Self {
        let (place, condition) = split_if(text);
        let (place, thread) = match place.rsplit_once("thread ") {
            Some((place, number)) if number.trim().parse::<i32>().is_ok() => {
                (place.trim(), number.trim().parse().ok().and_then(ThreadId::new))
            }
            _ => (place, None),
        };
        Self { place, thread, condition }
    }
}

/// The text before ` if `, and the condition after it.
pub(crate) fn split_if(text: &str) -> (&str, Option<&str>) {
    let text = text.trim();
    if let Some(condition) = text.strip_prefix("if ") {
        return ("", Some(condition.trim()));
    }
    text.split_once(" if ")
        .map_or((text, None), |(before, condition)| (before.trim(), Some(condition.trim())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_a_name_a_short_form_or_an_unambiguous_prefix() {
        let mut lines = LineReader::modelled();
        assert_eq!(lines.read("rc"), Ok(Some(("reverse-continue", String::new()))));
        assert_eq!(lines.read(" print/x  a + 1 "), Ok(Some(("print", "/x  a + 1".to_owned()))));
        assert_eq!(lines.read(""), Ok(Some(("print", "/x  a + 1".to_owned()))), "the last line again");
        assert_eq!(lines.read("# nothing"), Ok(None));
        assert!(lines.read("reverse").is_err_and(|text| text.starts_with("Ambiguous command")));
        assert!(lines.read("jump").is_err_and(|text| text.starts_with("Undefined command")));
    }

    #[test]
    fn commands_unavailable_with_a_firmware_file_are_refused_by_name() {
        let mut lines = LineReader::booted();
        assert_eq!(
            lines.read("watch x"),
            Err("`watch` does not work with `--boot`; `help` lists what does".to_owned())
        );
        assert_eq!(lines.read("b main"), Ok(Some(("break", "main".to_owned()))));
        assert!(lines.help().contains("break, b, br") && !lines.help().contains("watch"));
    }

    #[test]
    fn a_breakpoint_has_a_place_a_thread_and_a_condition() {
        let parts = |text| {
            let BreakWords { place, thread, condition } = BreakWords::of(text);
            (place.to_owned(), thread.map(ThreadId::get), condition.map(str::to_owned))
        };
        assert_eq!(parts("a.c:3 thread 2 if n > 1"), ("a.c:3".to_owned(), Some(2), Some("n > 1".to_owned())));
        assert_eq!(parts("if n > 1"), (String::new(), None, Some("n > 1".to_owned())));
        assert_eq!(parts("thread 2"), (String::new(), Some(2), None));
    }
}
