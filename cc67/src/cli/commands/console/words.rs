//! The console's own words, in addition to the board's script commands.

use anyhow::{Context, Result, anyhow, bail};
use kmotiondef::bits::{BitDirection, range_of};
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
use kmotiondef::{Bit, ThreadId};
use runtime::commands::{COMMANDS, command_named};
use runtime::stimulus::Stimulus;

use crate::cli::args::time::seconds;
use compiler::words::suggest;

/// A command of the console itself.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Word {
    /// Explain everything, or a word, command or firmware function.
    Help(Option<String>),
    /// Stop all threads but one.
    Kill { except: Option<ThreadId> },
    /// Compile and load.
    Load(String),
    /// Compile, load and start.
    Run(String),
    /// Toggle an input until it is released.
    Press(Bit),
    /// Restore the previous level of an input.
    Release(Bit),
    /// Execute a statement of a stimulus.
    Act(String),
    /// Show the board time.
    Time,
    /// Let board time pass.
    Wait(f64),
    /// Quit.
    Quit,
}

/// A word and its description.
struct Row {
    name: &'static str,
    usage: &'static str,
    help: &'static str,
}

const ROWS: &[Row] = &[
    Row {
        name: "help",
        usage: "help [NAME]",
        help: "explains a word, a script command or a firmware function",
    },
    Row { name: "load", usage: "load [N:]FILE", help: "compiles a program and loads it into a thread" },
    Row {
        name: "run",
        usage: "run [N:]FILE",
        help: "compiles a program, loads it into a thread and starts it",
    },
    Row { name: "kill", usage: "kill all [but N]", help: "stops all threads, or all but one" },
    Row { name: "press", usage: "press BIT", help: "toggles an input until `release`, like a button" },
    Row {
        name: "release",
        usage: "release BIT",
        help: "restores the level that the input had before `press`",
    },
    Row {
        name: "bit",
        usage: "bit 136 = 1",
        help: "executes a statement of a stimulus: bit, adc, pulse, encoder, persist, … (`cc67 --explain stimulus`)",
    },
    Row { name: "wait", usage: "wait SECONDS", help: "lets SECONDS of board time pass" },
    Row { name: "time", usage: "time", help: "prints the board time in seconds" },
    Row { name: "quit", usage: "quit", help: "leaves the console, like `exit` and the end of the input" },
];

/// The first words of stimulus statements.
pub(in crate::cli::commands) const ACTIONS: &[&str] =
    &["bit", "set", "clear", "toggle", "pulse", "adc", "axis", "encoder", "uart", "persist", "konnect"];

/// The words with which a line may begin.
pub(super) fn first_words() -> impl Iterator<Item = &'static str> {
    ROWS.iter().map(|row| row.name).chain(COMMANDS.iter().map(|command| command.name))
}

/// The topics of help.
pub(super) fn topics() -> impl Iterator<Item = &'static str> {
    first_words().chain(FIRMWARE_FUNCTIONS.iter().map(|function| function.name))
}

/// Parses a line that begins with one of the words; `None` if it is for the board.
pub(super) fn parse(line: &str) -> Option<Result<Word>> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let rest = rest.trim();
    let needed = |what: &str| {
        (!rest.is_empty()).then(|| rest.to_owned()).with_context(|| format!("`{word}` needs {what}"))
    };
    Some(match word {
        "help" | "?" => Ok(Word::Help((!rest.is_empty()).then(|| rest.to_owned()))),
        "load" => needed("a file").map(Word::Load),
        "run" => needed("a file").map(Word::Run),
        // `Kill 2` is a command of the board.
        "kill" if rest.starts_with("all") => parse_kill(rest),
        "wait" => needed("seconds").and_then(|text| match seconds(&text) {
            Ok(seconds) => Ok(Word::Wait(seconds)),
            Err(error) => bail!("`{text}` is {error}"),
        }),
        "press" => needed("an input").and_then(|text| bit(&text)).map(Word::Press),
        "release" => needed("an input").and_then(|text| bit(&text)).map(Word::Release),
        "time" => Ok(Word::Time),
        "quit" | "exit" => Ok(Word::Quit),
        _ if ACTIONS.contains(&word) => return statement(line, word),
        _ => return None,
    })
}

/// A statement of a stimulus; otherwise it may be a command of the board that begins with the same word.
fn statement(line: &str, word: &str) -> Option<Result<Word>> {
    match Stimulus::parse(&format!("at 0us {line}"), "the line") {
        Ok(_) => Some(Ok(Word::Act(line.to_owned()))),
        Err(_) if command_named(word).is_some() => None,
        Err(error) => Some(Err(anyhow!("`{line}`: {}", error.message))),
    }
}

/// An input that is pressed or released.
fn bit(text: &str) -> Result<Bit> {
    let number = text.parse().ok().and_then(Bit::new);
    let is_input = |bit: &Bit| {
        let direction = range_of(*bit).map(|range| range.direction);
        matches!(direction, Some(BitDirection::Input | BitDirection::Programmable))
    };
    number.filter(is_input).with_context(|| format!("`{text}` is not an input"))
}

/// `all`, or `all but N`.
fn parse_kill(text: &str) -> Result<Word> {
    let words: Vec<&str> = text.split_whitespace().collect();
    match words[..] {
        ["all"] => Ok(Word::Kill { except: None }),
        ["all", "but", number] => {
            let thread = number.parse().ok().and_then(ThreadId::new);
            let thread = thread.with_context(|| format!("`{number}`: no such thread (1-7)"))?;
            Ok(Word::Kill { except: Some(thread) })
        }
        _ => bail!("`kill {text}`: `kill all` or `kill all but 1`"),
    }
}

/// The explanation of a name, or the list of everything.
pub(super) fn help(name: Option<&str>) -> String {
    let Some(name) = name else { return overview() };
    let mut text = String::new();
    if let Some(row) = ROWS.iter().find(|row| row.name == name) {
        text += &format!("{}\n    {}\n", row.usage, row.help);
    }
    if let Some(command) = command_named(name) {
        text += &format!("{}\n    {}\n", command.usage(), command.help);
    }
    if let Some(number) = function_named(name) {
        let function = &FIRMWARE_FUNCTIONS[number];
        text += &format!("{};\n    {}\n", function.prototype(), function.doc.trim());
    }
    if text.is_empty() {
        let similar = suggest(name, topics());
        let hint = similar.map_or(String::new(), |similar| format!("; did you mean `{similar}`?"));
        text = format!("`{name}` is unknown{hint}\n");
    }
    text
}

fn overview() -> String {
    let mut text = "Words of the console:\n".to_owned();
    for row in ROWS {
        text += &format!("  {:18} {}\n", row.usage, row.help);
    }
    text +=
        "Script commands of the board, several on a line with `;` between them (`help NAME` explains one):\n";
    let mut line = String::from(" ");
    for command in COMMANDS {
        if line.len() + command.name.len() > 98 {
            text += &format!("{line}\n");
            line = String::from(" ");
        }
        line += &format!(" {}", command.name);
    }
    text + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn console_words_are_distinguished_from_board_commands() {
        let thread = ThreadId::new(1);
        for (line, expect) in [
            ("help Move", Some(Word::Help(Some("Move".to_owned())))),
            ("kill all", Some(Word::Kill { except: None })),
            ("kill all but 1", Some(Word::Kill { except: thread })),
            ("kill 2", None),
            ("Kill2", None),
            ("run 2:a b.c", Some(Word::Run("2:a b.c".to_owned()))),
            ("wait 0.5", Some(Word::Wait(0.5))),
            ("WaitBitBuf5", None),
            ("press 136", Bit::new(136).map(Word::Press)),
            ("release 136", Bit::new(136).map(Word::Release)),
            ("bit 136 = 1", Some(Word::Act("bit 136 = 1".to_owned()))),
            ("adc 0 = 300", Some(Word::Act("adc 0 = 300".to_owned()))),
            ("ADC 0", None),
            ("exit", Some(Word::Quit)),
        ] {
            assert_eq!(parse(line).map(|word| word.expect("it is right")), expect, "{line}");
        }
    }

    #[test]
    fn wrong_words_say_what_is_wrong() {
        for (line, expect) in [
            ("wait", "`wait` needs seconds"),
            ("wait x", "`x` is not a number of seconds"),
            ("kill all but 9", "`9`: no such thread (1-7)"),
            ("press 46", "`46` is not an input"),
            ("press", "`press` needs an input"),
            ("kill all now", "`kill all now`: `kill all` or `kill all but 1`"),
        ] {
            let error = parse(line).expect("an own word").expect_err("it is wrong");
            assert_eq!(error.to_string(), expect);
        }
    }

    #[test]
    fn names_are_explained() {
        assert_eq!(help(Some("jog")), "Jog <0..7>=<number>\n    moves an axis at a speed; 0 stops it\n");
        assert!(help(Some("SetBit")).contains("void SetBit(int bit)"), "{}", help(Some("SetBit")));
        assert!(help(Some("Jogg")).contains("did you mean `Jog`?"), "{}", help(Some("Jogg")));
        assert!(help(None).contains("CheckDoneXYZABC"));
    }
}
