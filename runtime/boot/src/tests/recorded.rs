//! The start of the real firmware against what was recorded of it (`boot.jsonl`); without the file, the test says so.

use std::sync::{Arc, Mutex, OnceLock};
use std::{env, fs};

use serde_json::Value;

use crate::{BootedBoard, FirmwareFile, Sent};

/// All rows of a recording.
pub(super) fn all_rows(name: &str) -> Vec<Value> {
    let path = format!("{}/../../tests/data/vectors/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("a recording");
    text.lines().map(|line| serde_json::from_str::<Value>(line).expect("a line of JSON")).collect()
}

/// The rows of the recorded start of a kind.
fn rows(kind: &str) -> Vec<Value> {
    all_rows("boot.jsonl").into_iter().filter(|row| row["kind"] == kind).collect()
}

fn row(kind: &str) -> Value {
    rows(kind).into_iter().next().expect("a row of that kind")
}

/// The firmware that `CC67_FIRMWARE` names.
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
        let lines = board.take_lines();
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

/// A servo interrupt that falls into an answer, seconds: where it falls was not recorded.
const INTERRUPT: f64 = 11e-6;
/// The words of the status that are the time.
const TIME: std::ops::Range<usize> = 8..10;
/// The line of the status that has them.
const TIME_LINE: &str = "00000001 00000000 00000000";

/// A line as it was recorded; the time in the status depends on when it was asked.
fn text(line: &crate::SentLine) -> String {
    let escape = if line.kind == Sent::Reply { "" } else { "\u{1b}" };
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
