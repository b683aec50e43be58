//! Recorded replies of the firmware, compared with those of the firmware file: 246 replies in one session, and every
//! script command after a fresh start (2,684 exchanges). Without the file, the test reports that it is skipped.

use serde_json::Value;

use super::recorded::{all_rows, booted};
use crate::BootedBoard;

/// The cycles of a tick; the longest pause within a reply; the longest reply.
const TICK: u64 = 18_000;
const QUIET: u64 = 8;
const LONGEST: u64 = 200_000;
/// The size of the part of the gather buffer that commands show: the recorded boards had it cleared.
const GATHER: usize = 1 << 20;

/// Replies that depend on the time of a line, or on the contents of memory: the time on the link was not recorded.
const BY_TIME: &[(&str, &str)] = &[
    ("GETSTATUS", "GETSTATUS"),
    // It shows a word after its array.
    ("GETVIRTUALBITS", "GETVIRTUALBITS31 31"),
    ("move and poll", "Dest0"),
    ("buffer", "ExecTime"),
    ("buffer", "Dest0"),
];

/// A board that has just booted, with a cleared gather buffer.
fn with_empty_buffer() -> Option<BootedBoard> {
    let mut board = booted()?;
    let pointer = board.file().address("gather_buffer").expect("it gathers");
    let buffer = kmotiondef::GuestAddr::new(board.memory().peek(pointer));
    // `GetVirtualBits` and `FPGA` write to addresses outside any board, and were answered nevertheless.
    board.tolerate_unmapped(true);
    board.memory_mut().poke_bytes(buffer, &vec![0; GATHER]).expect("it is in RAM");
    Some(board)
}

fn text(json: &Value) -> &str {
    json.as_str().expect("a string")
}

/// Sends bytes and returns the reply. A firmware stopped by a command is silent: the recorded one was silent from
/// `ENABLED0=` and `GETVIRTUALBITS31 31` on.
fn ask(board: &mut BootedBoard, bytes: &[u8]) -> String {
    board.send(bytes);
    let (mut answer, mut quiet, mut ticks) = (Vec::new(), 0, 0);
    while quiet < QUIET && ticks < LONGEST {
        let has_stopped = board.run_to(board.cycle() + TICK).is_err();
        let sent = board.take_bytes();
        quiet = if sent.is_empty() && board.has_read_all() { quiet + 1 } else { 0 };
        answer.extend(sent.into_iter().map(|(_, byte)| byte));
        ticks += 1;
        if has_stopped {
            break;
        }
    }
    String::from_utf8_lossy(&answer).into_owned()
}

/// Sends a recorded line, or executes the action that it contains in parentheses.
pub(super) fn exchange(board: &mut BootedBoard, line: &str) -> String {
    let Some(action) = line.strip_prefix('(').and_then(|line| line.strip_suffix(')')) else {
        return ask(board, format!("\x1b\x01{line}\r").as_bytes());
    };
    match action.split(' ').collect::<Vec<_>>()[..] {
        ["run", seconds] => {
            let seconds: f64 = seconds.parse().expect("seconds");
            board.run_to(board.cycle() + (seconds * 2e8) as u64).expect("it runs");
        }
        ["bit", bit, level] => board.drive_pin(bit.parse().expect("a bit"), level == "1"),
        _ => panic!("{line}"),
    }
    String::new()
}

/// Returns whether a reply equals the recorded one, or only has its form where values differ between runs.
fn agrees(name: &str, send: &str, found: &str, expect: &str) -> bool {
    let by_time = BY_TIME.iter().any(|(of, line)| *of == name && send.starts_with(line));
    found == expect || by_time && found.split_whitespace().count() == expect.split_whitespace().count()
}

#[test]
fn the_recorded_session_is_answered_by_the_firmware() {
    let Some(mut board) = with_empty_buffer() else { return };
    let rows = all_rows("host-replies.jsonl");
    let mut wrong = Vec::new();
    for row in &rows {
        let (send, expect) = (text(&row["send"]), text(&row["recv"]));
        let found = ask(&mut board, send.as_bytes());
        if found != expect {
            wrong.push(format!("{send:?}\n  found  {found:?}\n  expect {expect:?}"));
        }
    }
    println!("{} of {} replies agree", rows.len() - wrong.len(), rows.len());
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

#[test]
fn every_recorded_command_is_answered_by_the_firmware() {
    let Some(fresh) = with_empty_buffer() else { return };
    let (mut wrong, mut count) = (Vec::new(), 0);
    for row in all_rows("console.jsonl") {
        let name = row.get("command").or(row.get("session")).map(text).expect("a name");
        let mut board = fresh.clone();
        for pair in row["exchange"].as_array().expect("exchanges") {
            let (send, expect) = (text(&pair[0]), text(&pair[1]));
            let found = exchange(&mut board, send);
            count += 1;
            if !agrees(name, send, &found, expect) {
                wrong.push(format!("{name}: {send:?}\n  found  {found:?}\n  expect {expect:?}"));
            }
        }
    }
    println!("{} of {count} exchanges agree", count - wrong.len());
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
}
