//! Firmware 5.3.2: `data/vectors/fw5.jsonl` and `fw5-text.jsonl`, compared with the firmware itself.
//!
//! Without a file in `CC67_FIRMWARE_5` each test reports that it is skipped. The rows of kind `session` are compared in
//! the crate for booted firmware.

mod moves;
mod programs;
mod texts;

use std::sync::{Mutex, OnceLock};

use serde_json::Value as Json;

use super::{Released, booted, report, rows, text};

/// The bytes of a row of `TripCoeffs`: twenty states of 48.
const STATES: u32 = 20 * 48;
const AXES: u32 = 8;

/// A board that has just booted firmware 5.3.2.
fn firmware_5() -> Option<Released> {
    static BOARD: OnceLock<Option<Mutex<Released>>> = OnceLock::new();
    let mut board = booted(&BOARD, "CC67_FIRMWARE_5")?;
    assert!(board.board.file().version().contains(" 5.3.2 "), "CC67_FIRMWARE_5 is not firmware 5.3.2");
    // The first jog after power-up uses the initial contents of RAM; the recorded board had these.
    let states = board.address("TripCoeffs");
    (0..AXES).for_each(|axis| board.memory().poke(states.offset(axis * STATES), 1));
    Some(board)
}

/// The rows of some kinds, with their numbers.
fn of_kinds(kinds: &[&str]) -> Vec<(usize, Json)> {
    let all = rows("fw5.jsonl").into_iter().enumerate();
    all.filter(|(_, row)| kinds.contains(&text(&row["kind"]))).collect()
}

/// Compares rows, each on a new board; fails with all differences.
fn compare(kinds: &[&str], differences: impl Fn(&Json, Released) -> Vec<String>) {
    let Some(board) = firmware_5() else { return };
    let rows = of_kinds(kinds);
    let mut wrong = Vec::new();
    for (index, row) in &rows {
        let found = differences(row, board.clone());
        if !found.is_empty() {
            let name = row["name"].as_str().unwrap_or_default();
            wrong.push(format!("row {index} ({name}):\n {}", found.join("\n ")));
        }
    }
    report(&wrong, rows.len());
}

#[test]
fn every_kind_of_row_is_compared_somewhere() {
    for row in rows("fw5.jsonl") {
        let kind = text(&row["kind"]);
        assert!(matches!(kind, "program" | "cross" | "pid" | "move" | "session"), "{kind}");
    }
}
