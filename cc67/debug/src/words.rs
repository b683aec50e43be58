//! The vocabulary of the debugger: its commands, and the parsing of their lines.

use kmotiondef::ThreadId;

/// A command.
#[derive(Debug)]
struct Command {
    name: &'static str,
    short: &'static [&'static str],
    help: &'static str,
}

const fn row(name: &'static str, short: &'static [&'static str], help: &'static str) -> Command {
    Command { name, short, help }
}

/// Every command with its short forms, the boards for which it exists, and its description.
const COMMANDS: &[Command] = &[
    row("break", &["b", "br"], "break [FILE:]LINE|FUNCTION|*ADDRESS [thread N] [if CONDITION]: stop there"),
    row("tbreak", &["tb"], "tbreak …: as break, but deleted when it stops"),
    row(
        "watch",
        &["wa"],
        "watch EXPRESSION [if CONDITION]: stop when its value changes, and show what changed it",
    ),
    row("rwatch", &["rw"], "rwatch EXPRESSION [if CONDITION]: stop when a program reads its memory"),
    row("awatch", &["aw"], "awatch EXPRESSION [if CONDITION]: stop when a program reads it or writes to it"),
    row("dprintf", &[], "dprintf PLACE,TEXT: print a text there, {expression} is its value"),
    row("catch", &[], "catch trap|remark|start|end|console TEXT|bit N|when EXPRESSION: stop on it"),
    row("commands", &[], "commands [N]: the lines up to `end` are executed when breakpoint N stops"),
    row("condition", &["cond"], "condition N [EXPRESSION]: stop at breakpoint N only where it is not 0"),
    row("ignore", &[], "ignore N COUNT: do not stop at the next COUNT crossings of breakpoint N"),
    row("enable", &["en"], "enable [N]"),
    row("disable", &["dis"], "disable [N]"),
    row("delete", &["d"], "delete [N]: delete a breakpoint, or all"),
    row("run", &["r"], "begin, or begin again; run N: start the program of thread N, and go on"),
    row("kill", &["k"], "kill [N]: stop a thread"),
    row("pause", &[], "pause [N]: pause a thread of a connected controller while the others run"),
    row("resume", &[], "resume [N]: let it continue"),
    row("continue", &["c"], "continue [COUNT]: go on to the next stop"),
    row("step", &["s"], "step [COUNT]: to the next line, into functions"),
    row("next", &["n"], "next [COUNT]: to the next line, over functions"),
    row("finish", &["fin"], "until the function returns"),
    row("stepi", &["si"], "stepi [COUNT]: one instruction"),
    row("until", &["u"], "until [PLACE]: go on to it, or to a later line of the function"),
    row("advance", &[], "advance PLACE: go on to it"),
    row("tick", &[], "tick [COUNT]: to the end of the servo tick"),
    row("slice", &[], "to the end of the thread's next slice"),
    row("goto", &[], "goto SECONDS: to that board time, back or forward"),
    row("reverse-continue", &["rc"], "back to the last stop"),
    row("reverse-step", &["rs"], "reverse-step [COUNT]: back to the last line"),
    row("reverse-next", &["rn"], "reverse-next [COUNT]: back to the last line, over functions"),
    row("reverse-stepi", &["rsi"], "reverse-stepi [COUNT]: back by one instruction"),
    row("reverse-finish", &[], "back to the call of the function"),
    row(
        "print",
        &["p", "inspect"],
        "print[/F] EXPRESSION: its value; F is x z d u o t a c f or s, `PLACE@COUNT` are objects in a row, `$3`, `$`, `$$` \
         earlier values, `$name` own variables; functions that it calls are executed while the board's time stands",
    ),
    row("call", &[], "call EXPRESSION: as print, but shows nothing for void"),
    row("display", &[], "display[/x] [EXPRESSION]: show its value at every stop, or all of them now"),
    row("undisplay", &[], "undisplay [N]: no longer show it, or any"),
    row("output", &[], "output[/x] EXPRESSION: its value alone"),
    row("echo", &[], "echo TEXT: prints it; `\\n` ends a line"),
    row("ptype", &[], "ptype EXPRESSION|TYPE: the type, with the members of a structure"),
    row("whatis", &[], "whatis EXPRESSION: its type"),
    row("x", &[], "x/NFU [ADDRESS]: memory, or what follows; F is x z d u o t a c f s or i, U is b h w or g"),
    row(
        "set",
        &[],
        "set var NAME = EXPRESSION: another value, which begins a new line of history in the past",
    ),
    row(
        "info",
        &["i"],
        "info threads|breakpoints|locals|args|variables|registers|display|line|frame|history",
    ),
    row(
        "backtrace",
        &["bt", "where"],
        "backtrace [N]: the calls that led here, the innermost N, or with -N the outermost",
    ),
    row("frame", &["f"], "frame [N]: select a stack frame, or show the selected one"),
    row("up", &[], "up [N]: select the frame of the caller"),
    row("down", &[], "down [N]: select the frame of the called function"),
    row(
        "thread",
        &["t"],
        "thread [N]: select a thread, or show the selected one; thread apply all|N COMMAND: a command for each",
    ),
    row("list", &["l"], "list [LINE|FUNCTION|FIRST,LAST|-]: the source, further on, or before"),
    row("disassemble", &["disas"], "the instructions of the function"),
    row("help", &["h"], "this list"),
    row("quit", &["q", "exit"], "end"),
];

/// The commands that let time pass, or go back in it.
const MOVES: &[&str] = &[
    "run",
    "continue",
    "step",
    "next",
    "finish",
    "stepi",
    "until",
    "advance",
    "tick",
    "slice",
    "goto",
    "reverse-continue",
    "reverse-step",
    "reverse-next",
    "reverse-stepi",
    "reverse-finish",
];

pub(crate) fn is_move(name: &str) -> bool {
    MOVES.contains(&name)
}

/// The full name of the command with which a line begins; a line that begins with none may be an expression.
pub(crate) fn command_of(line: &str) -> Option<&'static str> {
    let end = line.find(|c: char| c.is_whitespace() || c == '/').unwrap_or(line.len());
    LineReader::names().find(|name| *name == &line[..end])
}

impl Command {
    fn is_called(&self, word: &str) -> bool {
        self.name == word || self.short.contains(&word)
    }
}

/// Reads the lines of a debugger.
#[derive(Clone, Debug, Default)]
pub struct LineReader {
    /// The last line, which an empty line repeats.
    last: String,
}

impl LineReader {
    /// The command of a line, by its full name, and the rest of the line; an empty line repeats the last one. `None`
    /// for a comment, and for an empty line at the beginning.
    ///
    /// # Errors
    /// The word is not a command, or is the beginning of several.
    pub fn read(&mut self, line: &str) -> Result<Option<(&'static str, String)>, String> {
        let line = line.trim();
        let line = if line.is_empty() { self.last.clone() } else { line.to_owned() };
        if line.is_empty() || line.starts_with('#') {
            return Ok(None);
        }
        self.last.clone_from(&line);
        let end = line.find(|c: char| c.is_whitespace() || c == '/').unwrap_or(line.len());
        let (word, rest) = line.split_at(end);
        Ok(Some((Self::command(word)?, rest.trim().to_owned())))
    }

    /// The names of the commands.
    pub fn names() -> impl Iterator<Item = &'static str> {
        COMMANDS.iter().map(|command| command.name)
    }

    /// The list of commands, one per line.
    #[must_use]
    pub fn help() -> String {
        let lines = COMMANDS.iter().map(|Command { name, short, help }| {
            let names = std::iter::once(name).chain(*short).copied().collect::<Vec<_>>().join(", ");
            format!("{names:<24} {help}\n")
        });
        lines.collect()
    }

    /// The full name of the command for a word: a name, a short form, or the unambiguous beginning of a name.
    fn command(word: &str) -> Result<&'static str, String> {
        if let Some(command) = COMMANDS.iter().find(|command| command.is_called(word)) {
            return Ok(command.name);
        }
        let starts: Vec<_> = Self::names().filter(|name| name.starts_with(word)).collect();
        match starts.as_slice() {
            [one] => Ok(one),
            [] => Err(format!("Undefined command: \"{word}\".  Try \"help\".")),
            many => Err(format!("Ambiguous command \"{word}\": {}.", many.join(", "))),
        }
    }
}

/// The arguments of `break`: `[PLACE] [thread N] [if CONDITION]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BreakArguments<'a> {
    /// The place; empty for the present one.
    pub place: &'a str,
    /// The thread for which it is set; `None` for all.
    pub thread: Option<ThreadId>,
    /// The condition.
    pub condition: Option<&'a str>,
}

impl<'a> BreakArguments<'a> {
    /// Parses the arguments.
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
        let mut lines = LineReader::default();
        assert_eq!(lines.read("rc"), Ok(Some(("reverse-continue", String::new()))));
        assert_eq!(lines.read(" print/x  a + 1 "), Ok(Some(("print", "/x  a + 1".to_owned()))));
        assert_eq!(lines.read(""), Ok(Some(("print", "/x  a + 1".to_owned()))), "the last line again");
        assert_eq!(lines.read("# nothing"), Ok(None));
        assert!(lines.read("reverse").is_err_and(|text| text.starts_with("Ambiguous command")));
        assert!(lines.read("jump").is_err_and(|text| text.starts_with("Undefined command")));
    }

    #[test]
    fn a_breakpoint_has_a_place_a_thread_and_a_condition() {
        let parts = |text| {
            let BreakArguments { place, thread, condition } = BreakArguments::of(text);
            (place.to_owned(), thread.map(ThreadId::get), condition.map(str::to_owned))
        };
        assert_eq!(parts("a.c:3 thread 2 if n > 1"), ("a.c:3".to_owned(), Some(2), Some("n > 1".to_owned())));
        assert_eq!(parts("if n > 1"), (String::new(), None, Some("n > 1".to_owned())));
        assert_eq!(parts("thread 2"), (String::new(), Some(2), None));
    }
}
