//! Common unknown words in command lines: explanations and alternatives.
//!
//! The board answers them like every unknown word; the simulation adds a remark. The words are commands of the other
//! firmware, commands in the manual's references that no modelled firmware has (some are misprints), and G code.

use kmotiondef::boards::TargetBoard;

use super::boards_with;
use crate::out::Message;

/// The reason for which the board does not know a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AbsenceReason {
    /// The board has it under this name.
    Named(&'static str),
    /// Later firmware than any that is modelled has it.
    Later,
    /// Another board has it.
    OtherBoard,
}

use AbsenceReason::{Later, Named, OtherBoard};

/// Words in upper case without their numbers, as the manual writes them.
const WORDS: &[(&str, AbsenceReason)] = &[
    ("ARCEX", Later),
    ("ARCZX", Named("ArcXZ")),
    ("ARCHEXXZ", Named("ArcHexZX")),
    ("CONFIGURESPINDLE", Named("ConfigSpindle")),
    ("ENABLE", Named("EnableAxis")),
    ("LINHEX", Named("LHex1 or LHex2")),
    ("LINHEXEX", Named("LHexEx1")),
    ("SETINPUTMODE", Named("InputMode")),
    ("SETOUTPUTMODE", Named("OutputMode")),
    ("ARCXZEX", Later),
    ("ARCYZEX", Later),
    ("GETALLDESTHEX", Later),
    ("MOVERELATVELACCELSOFT", Later),
    ("ARCHEXP", OtherBoard),
    ("ARCHEXYZP", OtherBoard),
    ("ARCHEXZXP", OtherBoard),
    ("ARCP", OtherBoard),
    ("ARCXZP", OtherBoard),
    ("ARCYZP", OtherBoard),
    ("DEFINECSP", OtherBoard),
    ("GETIPADDR", OtherBoard),
    ("GETKOGNAPWMEN", OtherBoard),
    ("GETKOGNAPWMLENGTH", OtherBoard),
    ("GETSERIALNUMBER", OtherBoard),
    ("HRPWMSETMODE", OtherBoard),
    ("LHEXP", OtherBoard),
    ("LINEARHEXP", OtherBoard),
    ("LINEARP", OtherBoard),
    ("LINHEXP", OtherBoard),
    ("SETIPADDR", OtherBoard),
    ("SETKOGNAPWMEN", OtherBoard),
    ("SETKOGNAPWMLENGTH", OtherBoard),
    ("SETSERIALNUMBER", OtherBoard),
    ("SPISETMODE", OtherBoard),
];

/// Letters with which a block of G code begins, followed by a number.
const G_CODE: &[u8] = b"GMTSFN";

/// Returns the message about a part, in upper case, that begins with no command of a board.
pub(super) fn explain(part: &[u8], board: &TargetBoard) -> Option<Message> {
    let letters = part.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    let word = std::str::from_utf8(&part[..letters]).ok()?;
    let is_number = part.get(letters).is_some_and(u8::is_ascii_digit);
    if letters == 1 && is_number && G_CODE.contains(&part[0]) {
        return Some(Message::GCode {});
    }
    let title = board.title();
    let is_other = |other: &TargetBoard| other.name != board.name && other.kind() == board.kind();
    if let Some((command, other)) = boards_with(word).find(|(_, other)| is_other(other)) {
        let other_title = other.title();
        return Some(Message::CommandOfFirmware {
            command,
            other: other_title,
            board: title,
            name: other.name,
        });
    }
    let (_, why) = WORDS.iter().find(|(known, _)| *known == word)?;
    let word = word.to_owned();
    Some(match why {
        Named(name) => Message::CommandNamed { word, name, board: title },
        Later => Message::CommandLater { word, board: title },
        OtherBoard if board.kind() == TargetBoard::default_board().kind() => {
            Message::CommandOtherBoard { word }
        }
        OtherBoard => Message::CommandNotSimulated { word },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::command_named;

    #[test]
    fn no_absent_word_is_a_command_of_the_board() {
        for (word, why) in WORDS {
            assert!(command_named(word).is_none(), "{word}");
            if let Named(names) = why {
                assert!(names.split(" or ").all(|name| command_named(name).is_some()), "{names}");
            }
        }
    }

    #[test]
    fn words_are_explained_without_their_numbers() {
        for (part, expect) in [
            ("ENABLE0", Some("EnableAxis")),
            ("LINHEX1 3F800000", Some("LHex1")),
            ("JOGATACCEL0=1 2", Some("`JogAtAccel` is a command of KFLOP firmware 5.3.2")),
            ("GETALLDESTHEX", Some("later firmware than KFLOP firmware 4.34")),
            ("G1 X5", Some("G code")),
            ("M3", Some("G code")),
            ("GET", None),
            ("G", None),
            ("", None),
            ("BOGUS", None),
        ] {
            let found = explain(part.as_bytes(), TargetBoard::default_board());
            assert_eq!(found.is_some(), expect.is_some(), "{part}: {found:?}");
            assert!(
                found.is_none_or(|message| message.to_string().contains(expect.unwrap_or_default())),
                "{part}"
            );
        }
    }
}
