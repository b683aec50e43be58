//! Following errors, limit switches and soft limits, tick by tick: rows of kind `protection`.

use serde_json::Value as Json;

use super::{Released, is_same, list, number, text};

/// The number of ticks from a command to the first row.
const FIRST: u32 = 200;

/// Executes an action of a recording: a poke at once, a command as a line.
fn act(board: &mut Released, action: &str) {
    match action.strip_prefix("!poke VirtualBits i ") {
        Some(value) => {
            let at = board.address("VirtualBits");
            board.memory().poke(at, value.parse::<i32>().expect("a number"));
        }
        None => board.board.send_line(action.as_bytes()),
    }
}

/// Returns the columns after the action.
fn columns(board: &Released) -> [f64; 5] {
    let moving = f64::from(u8::from(board.peek("pcoeff") != 0.0));
    let state = f64::from(board.int("CS0_StoppingState"));
    [board.peek("Enable"), board.peek("Dest"), board.peek("Output"), moving, state]
}

fn agree(found: &[f64; 5], values: &Json) -> bool {
    found.iter().zip(&list(values)[1..]).all(|(found, expect)| is_same(*found, expect))
}

/// Returns the differences of a row.
pub(super) fn differences(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (board.clone(), Vec::new());
    board.poke("InputMode", 4.0);
    board.set(&row["parameters"]);
    board.board.take_bytes();
    let rows = list(&row["rows"]);
    for action in list(&row["before"]) {
        act(&mut board, text(action));
        while !board.board.has_read_all() {
            board.interrupt();
        }
    }
    if rows[0][0].is_null() {
        let is_there = |board: &Released| agree(&columns(board), &rows[0]);
        let mut left = FIRST;
        while left > 0 && !is_there(&board) {
            board.interrupt();
            left -= 1;
        }
    }
    for (tick, values) in rows.iter().enumerate() {
        // A command is sent in the slice before its tick.
        let action = values[0].as_str().filter(|action| action.parse::<f64>().is_err());
        if tick == 0 {
            board.reach_match();
        }
        if let Some(action) = action {
            act(&mut board, action);
        }
        board.reach_match();
        if action.is_none() && !values[0].is_null() {
            board.poke("Dest", number(&values[0]));
        }
        if tick > 0 || !values[0].is_null() {
            board.interrupt();
        }
        let is = columns(&board);
        if !agree(&is, values) {
            found.push(format!("tick {tick}: {is:?}, recorded {values}"));
            break;
        }
    }
    let console = board.said();
    if found.is_empty() && console != text(&row["console"]) {
        found.push(format!("says {console:?}, recorded {}", row["console"]));
    }
    // In the order of the recording, which JSON does not preserve: a message comes with the first reply.
    for (command, expect) in row["after"].as_object().expect("replies").iter().rev() {
        let reply = board.command(command);
        if found.is_empty() && reply != text(expect) {
            found.push(format!("{command}: {reply:?}, recorded {expect}"));
        }
    }
    found
}
