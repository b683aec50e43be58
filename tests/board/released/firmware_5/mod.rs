//! Firmware 5.3.2: `data/vectors/fw5.jsonl` and `fw5-text.jsonl`, asked of the firmware itself.
//!
//! Without a file in `CC67_FIRMWARE_5` each test says so. The rows of kind `session` are compared beside the model of
//! the hardware, in the crate of booted firmware.

mod moves;
mod programs;
mod texts;

use std::sync::{Mutex, OnceLock};

use serde_json::Value as Json;

use super::{Released, booted, report, rows, text};

/// Bytes of a row of `TripCoeffs`: twenty states of 48.
const STATES: u32 = 20 * 48;
const AXES: u32 = 8;

/// A board that has just booted firmware 5.3.2.
fn firmware_5() -> Option<Released> {
    static BOARD: OnceLock<Option<Mutex<Released>>> = OnceLock::new();
    let mut board = booted(&BOARD, "CC67_FIRMWARE_5")?;
    assert!(board.board.file().version().contains(" 5.3.2 "), "CC67_FIRMWARE_5 is not firmware 5.3.2");
    // The first jog after power-up finds what RAM held; the recorded board had it so.
    let states = board.address("TripCoeffs");
    (0..AXES).for_each(|axis| board.memory().poke(states.offset(axis * STATES), 1));
    Some(board)
}

/// The rows of some kinds, with their numbers.
fn of_kinds(kinds: &[&str]) -> Vec<(usize, Json)> {
    let all = rows("fw5.jsonl").into_iter().enumerate();
    all.filter(|(_, row)| kinds.contains(&text(&row["kind"]))).collect()
}

/// Compares each of some rows on a board of its own; fails with all that differ.
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
