//! The script commands that a PC sends: one table, one function for each row.
//!
//! A row gives the name, the arguments and the effect of a command, in one line. Reading of arguments, ranges, error
//! messages and the form of replies follow from the row. Handlers get arguments within their limits and return an
//! [`Answer`]. To add a command, add a row, its function, and a transcript in `tests/data/commands`.
//!
//! Words, ranges and replies are those of the released firmware 4.34 (host-protocol.md sections 2 and 3).

mod absent;
mod arguments;
mod axes;
mod board;
mod data;
mod gather;
mod io;
mod link;
mod memory;
mod motion;
mod numbers;
mod path;
mod persist;
mod programs;
#[cfg(test)]
mod recorded;
mod session;
mod status;
mod table;

pub use arguments::Argument;
pub use table::{COMMANDS, KOGNA_COMMANDS, LATER_COMMANDS};

use kmotiondef::boards::{TargetBoard, boards};
use vm::firmware::TickContext;

use arguments::Values;
use link::Link;
use memory::Experiment;
use session::{Answer, Session};

use crate::firmware::level::{CommandSet, ModelledBoard};
use crate::firmware::parts::Parts;

/// The state of script commands.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scripts {
    /// The command loops over USB and over the UART.
    usb: Link,
    uart: Link,
    /// The recorded motion in progress, if there is one.
    experiment: Option<Experiment>,
}

impl Scripts {
    /// Returns whether a command over USB is in progress, so that no console text may be sent.
    pub(crate) const fn is_in_command(&self) -> bool {
        self.usb.is_in_command()
    }

    /// Returns whether a recorded motion is in progress.
    pub(crate) const fn has_experiment(&self) -> bool {
        self.experiment.is_some()
    }

    /// Executes the PC's commands in the primary thread's slice.
    pub(crate) fn slice(&mut self, parts: &mut Parts, context: &mut TickContext<'_>) {
        let Self { usb, uart, experiment } = self;
        if parts.pc.usb.is_busy() {
            link::slice(usb, |pc| &mut pc.usb, experiment, parts, context);
        }
        if parts.pc.uart.is_busy() {
            link::slice(uart, |pc| &mut pc.uart, experiment, parts, context);
        }
        gather::advance(experiment, parts, context);
    }
}

/// One script command.
#[derive(Clone, Copy)]
pub struct Command {
    /// Its name as the manual spells it; the board ignores the case.
    pub name: &'static str,
    /// Its arguments.
    pub arguments: &'static [Argument],
    /// Its effect, in one line.
    pub help: &'static str,
    run: fn(&mut Session<'_, '_>, &Values) -> Answer,
}

impl std::fmt::Debug for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl Command {
    /// Returns its syntax: `Move <0..7>=<number>`.
    #[must_use]
    pub fn usage(&self) -> String {
        let mut text = self.name.to_owned();
        let mut open = 0;
        let mut rest = self.arguments;
        while let [argument, tail @ ..] = rest {
            let same = rest.iter().take_while(|other| *other == argument).count();
            match argument {
                Argument::Equals => text.push('='),
                Argument::OptionalEquals => text.push_str("[=]"),
                Argument::Assign => {
                    text.push_str("[=");
                    open += 1;
                }
                Argument::OptionalHex => text.push_str(" [<hex>]"),
                Argument::End => {}
                argument => {
                    let spaced = !text.ends_with('=');
                    text.push_str(if spaced { " " } else { "" });
                    text.push_str(&argument.placeholder());
                    if same > 2 {
                        text.push_str(&format!(" … ({same} numbers)"));
                        rest = &rest[same..];
                        continue;
                    }
                }
            }
            rest = tail;
        }
        text + &"]".repeat(open)
    }
}

impl Argument {
    /// Returns its placeholder in the description of a command.
    fn placeholder(&self) -> String {
        match self {
            Self::Integer(i32::MIN, i32::MAX) => "<integer>".to_owned(),
            Self::Integer(lo, hi) | Self::Numbered(lo, hi, _) => format!("<{lo}..{hi}>"),
            Self::Real => "<number>".to_owned(),
            Self::Limited(0.0, hi) => format!("<0..{hi:e}>"),
            Self::Limited(lo, hi) => format!("<{lo:e}..{hi:e}>"),
            Self::Hex | Self::OptionalHex => "<hex>".to_owned(),
            Self::Equals | Self::OptionalEquals | Self::Assign => "=".to_owned(),
            Self::End => String::new(),
        }
    }
}

/// The command with which a text in upper case begins, and the length of its word: the longest match.
fn find(text: &[u8], set: CommandSet) -> Option<(&'static Command, usize)> {
    let matches = |command: &&Command| {
        let length = command.name.len();
        let word = text.get(..length).is_some_and(|word| word.eq_ignore_ascii_case(command.name.as_bytes()));
        let ends = |byte: &u8| match byte {
            b' ' | b'=' | b'0'..=b'9' => true,
            // Board quirk: a sign ends this one word, and any character ends a word that ends in a digit.
            b'-' => {
                command.name == "DisableAxis" || command.name.ends_with(|last: char| last.is_ascii_digit())
            }
            _ => command.name.ends_with(|last: char| last.is_ascii_digit()),
        };
        word && text.get(length).is_none_or(ends)
    };
    let lists = [
        (COMMANDS, CommandSet::First),
        (LATER_COMMANDS, CommandSet::Later),
        (KOGNA_COMMANDS, CommandSet::Kogna),
    ];
    let known = lists.into_iter().filter(|(_, first)| set >= *first).flat_map(|(list, _)| list);
    // Of two with one name the last counts.
    let longest = known.filter(matches).max_by_key(|command| command.name.len())?;
    Some((longest, longest.name.len()))
}

/// The command with which a line begins, in upper or lower case.
#[must_use]
pub fn command_at(line: &str) -> Option<&'static Command> {
    find(line.to_ascii_uppercase().as_bytes(), CommandSet::First).map(|(command, _)| command)
}

/// The boards whose firmware has a command of this name, in upper or lower case, each with the spelling of its manual.
pub fn boards_with(name: &str) -> impl Iterator<Item = (&'static str, &'static TargetBoard)> {
    let named = move |list: &'static [Command]| {
        list.iter().find(|command| command.name.eq_ignore_ascii_case(name)).map(|command| command.name)
    };
    let names = [
        (CommandSet::First, named(COMMANDS)),
        (CommandSet::Later, named(LATER_COMMANDS)),
        (CommandSet::Kogna, named(KOGNA_COMMANDS)),
    ];
    boards().filter_map(move |board| {
        let set = ModelledBoard::of(board)?.behaviour().commands;
        Some((names.into_iter().find_map(|(first, name)| name.filter(|_| set >= first))?, board))
    })
}

/// The command of this name, in upper or lower case.
#[must_use]
pub fn command_named(name: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.name.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_word_wins() {
        for (text, expect) in [
            ("MOVEATVEL0=1 1", Some("MoveAtVel")),
            ("MOVE0=1", Some("Move")),
            ("D0", Some("D")),
            ("DEST", Some("Dest")),
            ("3PH0=1 1", Some("3PH")),
            ("LHEX11 2", Some("LHex1")),
            ("INPUTCHAN0 3=5", Some("InputChan0")),
            ("INPUTCHAN0-3", Some("InputChan0")),
            ("LHEX1X", Some("LHex1")),
            ("DISABLEAXIS-3", Some("DisableAxis")),
            ("ENABLEAXIS-3", None),
            ("VERSIO", None),
            ("VERSIONX", None),
            (" VERSION", None),
            ("CHECKTHREAD+1", None),
            ("", None),
        ] {
            assert_eq!(
                find(text.as_bytes(), CommandSet::First).map(|(command, _)| command.name),
                expect,
                "{text}"
            );
        }
    }

    #[test]
    fn every_word_is_in_the_table_once() {
        let mut words: Vec<_> = COMMANDS.iter().map(|command| command.name.to_ascii_uppercase()).collect();
        words.sort();
        let count = words.len();
        words.dedup();
        assert_eq!(words.len(), count);
        assert_eq!(count, 146, "the released firmware has 146");
    }

    #[test]
    fn usage_shows_how_a_command_is_written() {
        for (name, expect) in [
            ("Move", "Move <0..7>=<number>"),
            ("MoveAtVel", "MoveAtVel <0..7>=<number> <number>"),
            ("Vel", "Vel <0..7>[=<0..1e12>]"),
            ("GetStatus", "GetStatus [<hex>] [<hex>]"),
            ("SetBitDirection", "SetBitDirection <0..167>[=]<0..1>"),
            ("LHex1", "LHex1 <hex> … (11 numbers)"),
        ] {
            let command = command_named(name).expect("in the table");
            assert_eq!(command.usage().replace("[=] <", "[=]<"), expect);
        }
    }
}
