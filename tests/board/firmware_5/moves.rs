//! Moves and jogs: the state of the axis in ticks counted from the end of the calls.

use kmotiondef::variables::TRIP_COEFFS;
use serde_json::Value as Json;

use super::{Model, compare, list, number, text, thread};

/// The soft limit in rows about soft limits.
const SOFT_LIMIT: f64 = 60.0;
/// The maximum number of ticks for the calls of a row.
const LONGEST: u32 = 4000;
/// The tolerances of a position and of a speed.
const PLACE: f64 = 1e-8;
const SPEED: f64 = 1e-3;
fn differences(row: &Json) -> Vec<String> {
    let mut board = Model::new();
    for name in ["Vel", "Accel", "Jerk"] {
        board.poke(name, number(&row[name]));
    }
    board.poke("InputMode", 4.0);
    if text(&row["name"]).contains("soft limit") {
        board.poke("SoftLimitPos", SOFT_LIMIT);
    }
    for before in row["before"].as_array().into_iter().flatten() {
        let words: Vec<&str> = text(before).split(' ').collect();
        let ["poke", "TripCoeffs", "i", word] = words[..] else { panic!("{before}") };
        board.board.memory_mut().poke(TRIP_COEFFS.address(), word.parse::<i32>().expect("a word"));
    }
    board.command(&format!("EnableAxisDest0 {:?}", number(&row["start_dest"])));
    let source = format!(
        "int ended;\nmain()\n{{\n  WaitNextTimeSlice();\n  {}\n  ended = 1;\n}}\n",
        text(&row["call"])
    );
    let program = board.load(thread(1), &source);
    board.board.start(thread(1)).expect("it is loaded");
    let mut waited = 0;
    while board.int(program.variable("ended")) == 0 {
        board.ticks(1);
        waited += 1;
        assert!(waited < LONGEST, "the calls return");
    }
    follow(row, &mut board)
}

/// Compares the state of the axis in the recorded ticks, and the time at which it was done.
fn follow(row: &Json, board: &mut Model) -> Vec<String> {
    let (mut found, mut done, mut tick) = (Vec::new(), None, 0);
    for sample in list(&row["result"]["samples"]) {
        let at = sample[0].as_u64().expect("a tick");
        while tick < at {
            board.ticks(1);
            tick += 1;
            if done.is_none() && board.peek("pcoeff") == 0.0 {
                done = Some(tick);
            }
        }
        let (dest, speed) = (board.peek("Dest"), board.peek("last_vel"));
        let (recorded, recorded_speed) = (number(&sample[1]), number(&sample[2]));
        if (dest - recorded).abs() > PLACE || (speed - recorded_speed).abs() > SPEED {
            found.push(format!("tick {tick}: {dest} {speed}, recorded {recorded} {recorded_speed}"));
            return found;
        }
    }
    // The recorder checks for the end from tick 2 on.
    let done = done.map(|tick: u64| tick.max(2));
    if done != row["result"]["done_tick"].as_u64() {
        found.push(format!("done in {done:?}, recorded {}", row["result"]["done_tick"]));
    }
    let kind = board.peek("LastMotionType");
    if kind != number(&row["LastMotionType"]) {
        found.push(format!("LastMotionType {kind}, recorded {}", row["LastMotionType"]));
    }
    if board.said != row["console"].as_str().unwrap_or_default() {
        found.push(format!("says {:?}", board.said));
    }
    found
}

#[test]
fn moves_of_the_model_are_as_recorded_of_firmware_5() {
    compare(&["move"], differences);
}
