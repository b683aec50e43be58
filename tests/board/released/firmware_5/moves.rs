//! Moves and jogs: the states that a call leaves, and the axis in ticks counted from the call's end.

use serde_json::Value as Json;

use super::super::motion::states;
use super::super::{Program, Released, list, number, text, thread};
use super::{STATES, compare};

/// The soft limit in rows about soft limits.
const SOFT_LIMIT: f64 = 60.0;
/// The maximum number of ticks for the calls of a row.
const LONGEST: u32 = 4000;
/// The relative tolerance for numbers in a state that depend on functions in the processor's ROM.
const ROM: f64 = 1e-9;
/// The notation of the rows for NaN.
const NAN: &str = "nan";

fn value(recorded: &Json) -> f64 {
    if recorded == NAN { f64::NAN } else { number(recorded) }
}

/// Returns whether a number equals the recorded one, except for the last digits of a root.
fn is_close(found: f64, recorded: f64, scale: f64) -> bool {
    found == recorded
        || found.is_nan() && recorded.is_nan()
        || (found - recorded).abs() <= ROM * scale.max(recorded.abs())
}

/// Sets up an axis as a row requires, and starts its calls.
fn begin(row: &Json, board: &mut Released) -> Program {
    for name in ["Vel", "Accel", "Jerk"] {
        board.poke(name, number(&row[name]));
    }
    board.poke("InputMode", 4.0);
    if text(&row["name"]).contains("soft limit") {
        board.poke("SoftLimitPos", SOFT_LIMIT);
    }
    for before in row["before"].as_array().into_iter().flatten() {
        let words: Vec<&str> = text(before).split(' ').collect();
        let ["poke", name, "i", word] = words[..] else { panic!("{before}") };
        let at = board.address(name);
        board.memory().poke(at, word.parse::<i32>().expect("a word"));
    }
    board.command(&format!("EnableAxisDest0 {:?}", number(&row["start_dest"])));
    let source = format!(
        "int ended;\nmain()\n{{\n  WaitNextTimeSlice();\n  {}\n  ended = 1;\n}}\n",
        text(&row["call"])
    );
    let program = board.load(thread(1), &source);
    board.board.execute_together(&[thread(1)]).unwrap_or_else(|crash| panic!("{crash}"));
    board.reach_match();
    program
}

fn check_states(row: &Json, board: &Released, found: &mut Vec<String>) {
    let field = |state: &Json| ["mode", "t", "a", "b", "c", "d"].map(|name| value(&state[name]));
    let expect: Vec<[f64; 6]> = list(&row["result"]["states"]).iter().map(field).collect();
    let is = states(board);
    let scale = |column: usize| {
        let sizes = expect.iter().map(|state| state[column].abs());
        sizes.filter(|size| *size < 1e98).fold(0.0, f64::max)
    };
    // Recordings continue to the state after one without an end.
    let is_same = is
        .iter()
        .zip(&expect)
        .all(|(is, expect)| (0..6).all(|column| is_close(is[column], expect[column], scale(column))));
    if !is_same || is.len() > expect.len() {
        found.push(format!("states\n  {is:?}\n  {expect:?}"));
    }
}

fn differences(row: &Json, mut board: Released) -> Vec<String> {
    let program = begin(row, &mut board);
    let ended = program.variable("ended");
    let mut waited = 0;
    while board.board.memory().peek::<i32>(ended) == 0 {
        board.next_match();
        waited += 1;
        assert!(waited < LONGEST, "the calls return");
    }
    let mut found = Vec::new();
    check_states(row, &board, &mut found);
    let samples = list(&row["result"]["samples"]);
    let last = samples.last().map_or(0, |sample| number(&sample[0]) as u64);
    let mut samples = samples.iter().peekable();
    let mut done = None;
    for tick in 0..=last {
        if tick > 0 {
            board.next_match();
        }
        if done.is_none() && board.peek("pcoeff") == 0.0 {
            done = Some(tick);
        }
        if let Some(sample) = samples.next_if(|sample| number(&sample[0]) as u64 == tick) {
            let is = ["Dest", "last_vel"].map(|name| board.peek(name));
            let expect = [value(&sample[1]), value(&sample[2])];
            if !(is_close(is[0], expect[0], 100.0) && is_close(is[1], expect[1], 1e6)) {
                found.push(format!("tick {tick}: {is:?}, recorded {expect:?}"));
                break;
            }
        }
    }
    if found.is_empty() {
        check_end(row, board, done, &mut found);
    }
    found
}

fn check_end(row: &Json, mut board: Released, done: Option<u64>, found: &mut Vec<String>) {
    // The recorder checks for the end from this tick on.
    let done = done.map(|tick| tick.max(2));
    if done != row["result"]["done_tick"].as_u64() {
        found.push(format!("done in {done:?}, recorded {}", row["result"]["done_tick"]));
    }
    let kind = board.peek("LastMotionType");
    if kind != number(&row["LastMotionType"]) {
        found.push(format!("LastMotionType {kind}, recorded {}", row["LastMotionType"]));
    }
    let said = board.said();
    if said != row["console"].as_str().unwrap_or_default() {
        found.push(format!("says {said:?}"));
    }
}

#[test]
fn moves_and_jogs_of_firmware_5_are_as_recorded() {
    const { assert!(STATES == 960) };
    compare(&["move"], differences);
}
