//! The start of the real firmware, compared with its recording (`boot.jsonl`); without the file, the test reports that
//! it is skipped.

use std::sync::{Arc, Mutex, OnceLock};
use std::{env, fs};

use serde_json::Value;

use super::exchanges::exchange;
use crate::{BootedBoard, FirmwareFile, SentKind};

/// All rows of a recording.
pub(super) fn all_rows(name: &str) -> Vec<Value> {
    let path = format!("{}/../../tests/data/vectors/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("a recording");
    text.lines().map(|line| serde_json::from_str::<Value>(line).expect("a line of JSON")).collect()
}

/// The rows of one kind in the recorded start.
fn rows(kind: &str) -> Vec<Value> {
    all_rows("boot.jsonl").into_iter().filter(|row| row["kind"] == kind).collect()
}

fn row(kind: &str) -> Value {
    rows(kind).into_iter().next().expect("a row of that kind")
}

/// The firmware named by `CC67_FIRMWARE`.
fn firmware() -> Option<Arc<FirmwareFile>> {
    let Some(path) = env::var_os("CC67_FIRMWARE") else {
        println!("not run: CC67_FIRMWARE names no firmware file");
        return None;
    };
    let bytes = fs::read(path).expect("CC67_FIRMWARE names a file");
    Some(Arc::new(FirmwareFile::read(&bytes).expect("a firmware file")))
}

/// A board that has just booted.
pub(super) fn booted() -> Option<BootedBoard> {
    static BOARD: OnceLock<Option<Mutex<BootedBoard>>> = OnceLock::new();
    let boot =
        || Some(Mutex::new(BootedBoard::booted(firmware()?).unwrap_or_else(|crash| panic!("{crash}"))));
    let board = BOARD.get_or_init(boot).as_ref()?;
    Some(board.lock().expect("no test holds it while it fails").clone())
}

/// The bytes of a row of `TripCoeffs`: twenty states of 48.
const STATES: u32 = 20 * 48;
/// The session whose replies depend on the tick, and the distance of three ticks at its speed, rounded up.
const MOVING: &str = "GetAllDestVelHex at rest and moving";
const THREE_TICKS: f64 = 0.2701;

/// The number of ticks for which a recorded session of firmware 5.3.2 ran after a command.
fn pause(session: &str, line: &str) -> u64 {
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

/// The destination in a reply, and the words after it.
fn destination(answer: &str) -> (f64, Vec<&str>) {
    let words: Vec<&str> = answer.split_whitespace().collect();
    if let [low, high, rest @ ..] = &words[..] {
        let word = |text: &str| u64::from_str_radix(text, 16).expect("a word");
        return (f64::from_bits(word(low) | word(high) << 32), rest.to_vec());
    }
    (answer.trim().parse().unwrap_or_default(), Vec::new())
}

/// Returns whether a reply equals the recorded one, except for values that depend on the tick of the request.
fn agrees(session: &str, found: &str, expect: &str) -> bool {
    match session {
        "GetStatus" => status(found) == status(expect),
        MOVING => {
            let ((dest, rest), (recorded, recorded_rest)) = (destination(found), destination(expect));
            (dest - recorded).abs() < THREE_TICKS && rest == recorded_rest
        }
        _ => found == expect,
    }
}

/// A status without its time words.
fn status(text: &str) -> Vec<&str> {
    let words = text.split_whitespace().enumerate();
    words.filter(|(at, _)| !(162..164).contains(at)).map(|(_, word)| word).collect()
}

#[test]
fn firmware_5_boots_and_answers_what_was_recorded_of_it() {
    let Some(path) = env::var_os("CC67_FIRMWARE_5") else {
        println!("not run: CC67_FIRMWARE_5 names no firmware file of version 5.3.2");
        return;
    };
    let bytes = fs::read(path).expect("CC67_FIRMWARE_5 names a file");
    let file = FirmwareFile::read(&bytes).unwrap_or_else(|error| panic!("{error}"));
    let mut fresh = BootedBoard::booted(Arc::new(file)).unwrap_or_else(|crash| panic!("{crash}"));
    println!("ready after {:.4} s", fresh.cycle() as f64 * 5e-9);
    // The first jog after power-up uses the initial contents of RAM; the recorded board had these.
    let states = fresh.file().address("TripCoeffs").expect("it moves axes");
    (0..8).for_each(|axis| fresh.memory_mut().poke(states.offset(axis * STATES), 1));
    let sessions: Vec<_> = all_rows("fw5.jsonl").into_iter().filter(|row| row["kind"] == "session").collect();
    let mut wrong = Vec::new();
    for row in &sessions {
        let mut board = fresh.clone();
        let name = row["name"].as_str().expect("a name");
        for pair in row["exchange"].as_array().expect("exchanges") {
            let (send, expect) = (pair[0].as_str().expect("text"), pair[1].as_str().expect("text"));
            let found = exchange(&mut board, send);
            board.run_to(board.cycle() + 18_000 * pause(name, send)).expect("it runs");
            if !agrees(name, &found, expect) {
                wrong.push(format!("{name}: {send:?}\n  found  {found:?}\n  expect {expect:?}"));
            }
        }
    }
    println!("{} sessions, {} differences", sessions.len(), wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn hex(value: &Value) -> u32 {
    u32::from_str_radix(value.as_str().expect("a string"), 16).expect("a word")
}

fn hash(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3))
}

#[test]
fn registers_match_the_recording_at_the_first_poll_of_the_pc() {
    let Some(board) = booted() else { return };
    let recorded = row("registers at the first read of the host status byte");
    assert_eq!(board.ready_at(), recorded["cycle"].as_u64());
    let registers = board.registers();
    let named = |name: &str| registers.iter().find(|one| one.0.eq_ignore_ascii_case(name)).expect(name).1;
    for (name, value) in recorded["registers"].as_object().expect("registers") {
        assert_eq!(named(name), hex(value), "{name}");
    }
    for name in ["CSR", "IER", "ISTP"] {
        assert_eq!(named(name), hex(&recorded[name]), "{name}");
    }
}

#[test]
fn memory_after_the_start_is_as_recorded() {
    let Some(board) = booted() else { return };
    for one in row("memory after boot")["rows"].as_array().expect("rows") {
        let name = one[0].as_str().expect("a name");
        let at = board.file().address(name).expect(name);
        let bytes = board.memory().read_bytes(at, one[1].as_u64().expect("a size") as u32).expect("mapped");
        assert_eq!(format!("{:016x}", hash(bytes)), one[2].as_str().expect("a hash"), "{name}");
    }
    for one in row("values after boot")["rows"].as_array().expect("rows") {
        let (name, kind) = (one[0].as_str().expect("a name"), one[1].as_str().expect("a type"));
        let at = board.file().address(name).expect(name);
        match kind {
            "i" => assert_eq!(i64::from(board.memory().peek::<i32>(at)), one[2].as_i64().expect("a number")),
            "d" => assert_eq!(Some(board.memory().peek::<f64>(at)), one[2].as_f64(), "{name}"),
            _ => assert_eq!(board.memory().peek::<u32>(at), hex(&one[2]), "{name}"),
        }
    }
}

#[test]
fn commands_are_answered_as_recorded() {
    let Some(mut board) = booted() else { return };
    board.run_to(board.cycle() + 200_000).expect("it runs");
    for exchange in row("host exchanges")["exchanges"].as_array().expect("exchanges") {
        let send = exchange["send"].as_str().expect("text").as_bytes();
        let sent_at = board.cycle();
        board.send(send);
        board.run_to(sent_at + 400_000).expect("it runs");
        let mut lines = board.take_lines();
        // The answer to an abort is recognised only when nothing follows it.
        lines.append(&mut board.take_lines());
        let recorded = exchange["lines"].as_array().expect("lines");
        let texts: Vec<String> = lines.iter().map(text).collect();
        let expected: Vec<String> = recorded.iter().map(|line| expected(&line[1])).collect();
        assert_eq!(texts, expected, "{exchange}");
        for (line, recorded) in lines.iter().zip(recorded) {
            let late = (line.cycle - sent_at) as f64 * 5e-9 - recorded[0].as_f64().expect("seconds");
            assert!(late.abs() < INTERRUPT, "{late} s: {exchange}");
        }
    }
}

/// The duration of a servo interrupt that occurs during a reply, in seconds: its position was not recorded.
const INTERRUPT: f64 = 11e-6;
/// The words of the status that contain the time.
const TIME: std::ops::Range<usize> = 8..10;
/// The line of the status with these words.
const TIME_LINE: &str = "00000001 00000000 00000000";

/// A line as it was recorded; the time in the status depends on the time of the request.
fn text(line: &crate::SentLine) -> String {
    let escape = match line.kind {
        SentKind::Reply => "",
        SentKind::Console | SentKind::Request => "\u{1b}",
        SentKind::Aborted => "\u{1b}C",
    };
    without_time(&format!("{escape}{}", String::from_utf8_lossy(&line.text)))
}

fn expected(line: &Value) -> String {
    without_time(line.as_str().expect("text").trim_end_matches(['\r', '\n']))
}

fn without_time(line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    if words.len() != 16 || words[5..8].join(" ") != TIME_LINE {
        return line.to_owned();
    }
    let untimed =
        |(at, word): (usize, &&str)| if TIME.contains(&at) { "time".to_owned() } else { (*word).to_owned() };
    words.iter().enumerate().map(untimed).collect::<Vec<_>>().join(" ")
}
