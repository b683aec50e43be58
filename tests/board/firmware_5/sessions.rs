//! Sessions: lines from the PC and the board's replies.

use std::ops::Range;

use serde_json::Value as Json;

use super::{Model, compare, list, text};

/// The session whose replies depend on the tick.
const MOVING: &str = "GetAllDestVelHex at rest and moving";
/// Words of the status that depend on the time, or, for the converters' readings, on the initial contents of RAM.
const TIME: Range<usize> = 162..164;
const CONVERTERS: Range<usize> = 1..9;

/// The number of ticks for which a session ran after a command.
fn pause(session: &str, line: &str) -> u32 {
    match (session, line) {
        (MOVING, "Jog0=1000") => 1017,
        (MOVING, "GetAllDestVelHex") => 21,
        (MOVING, "Jog0=0") => 1000,
        (_, "MoveAtVelAccel0=100 500 5000" | "MoveRelAtVelAccel0=-50 500 5000" | "JogAtAccel0=0 5000") => {
            6000
        }
        _ => 0,
    }
}

/// The words of a reply without those that cannot be compared.
fn words<'a>(session: &str, line: &str, answer: &'a str) -> Vec<&'a str> {
    let words = answer.split_whitespace().enumerate();
    let is_compared = |at: usize| match (session, line) {
        ("GetStatus", _) => !TIME.contains(&at) && !CONVERTERS.contains(&at),
        // Destinations while the axis moves; speeds are compared.
        (MOVING, "Dest0") => false,
        (MOVING, _) => at > 1,
        _ => true,
    };
    words.filter(|(at, _)| is_compared(*at)).map(|(_, word)| word).collect()
}

fn session(row: &Json) -> Vec<String> {
    let (mut board, name) = (Model::new(), text(&row["name"]));
    let mut found = Vec::new();
    for exchange in list(&row["exchange"]) {
        let (line, expect) = (text(&exchange[0]), text(&exchange[1]));
        let answer = board.command(line);
        board.ticks(pause(name, line));
        let is_same = match name {
            "GetStatus" | MOVING => words(name, line, &answer) == words(name, line, expect),
            _ => answer == expect,
        };
        if !is_same {
            found.push(format!("{line}: {answer:?}, recorded {expect:?}"));
        }
    }
    found
}

#[test]
fn sessions_of_the_model_are_as_recorded_of_firmware_5() {
    compare(&["session"], session);
}
