//! Compensation, inputs, slaves and calls that enable axes: `data/vectors/servo.jsonl`.

use serde_json::Value as Json;

use super::{Released, list, number, outputs, protection, released, report, rows, text};

/// The number of ticks after which filters have settled.
const SETTLED: u32 = 300;

/// A board with axis 0 enabled at 0, whose position and destination the test writes.
pub(super) fn enabled(board: &Released) -> Released {
    let mut board = board.clone();
    board.poke("InputMode", 4.0);
    for (name, limit) in [("MaxOutput", 1e5), ("MaxErr", 1e6), ("MaxI", 1e6)] {
        board.poke(name, limit);
    }
    board.command("EnableAxisDest0 0");
    board.reach_match();
    board
}

/// Compares columns of a row after a tick.
fn compare(board: &Released, tick: usize, columns: &[&str], values: &[Json], found: &mut Vec<String>) {
    for (column, expect) in columns.iter().zip(values) {
        if !board.is(0, column, expect) {
            found.push(format!("tick {tick} {column}: {}, recorded {expect}", board.peek(column)));
        }
    }
}

pub(super) fn compensation(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (enabled(board), Vec::new());
    board.set(&row["parameters"]);
    let columns: Vec<&str> = list(&row["columns"]).iter().map(text).collect();
    // One recording changes the offset during the run, in the tick with an error of 6.
    let has_offset = row["name"] == "DestOffset";
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        let values = list(values);
        board.poke("Position", number(&values[0]));
        board.poke("Dest", number(&values[1]));
        if has_offset {
            board.poke("DestOffset", number(&values[3]) - number(&values[1]));
        }
        board.interrupt();
        compare(&board, tick, &columns[2..], &values[2..], &mut found);
        board.reach_match();
    }
    found
}

fn backlash(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (enabled(board), Vec::new());
    for name in ["BacklashAmount", "BacklashRate"] {
        board.poke(name, number(&row[name]));
    }
    board.poke("BacklashMode", 1.0);
    let columns: Vec<&str> = list(&row["columns"]).iter().map(text).collect();
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        board.poke("Dest", number(&values[0]));
        board.interrupt();
        compare(&board, tick, &columns[1..], &list(values)[1..], &mut found);
        board.reach_match();
    }
    found
}

fn analog_input(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (board.clone(), Vec::new());
    let inputs = board.address("ADC_BufferIn");
    for (name, value) in [("InputMode", 2.0), ("InputChan0", 1.0)] {
        board.poke(name, value);
    }
    for name in ["InputGain0", "InputOffset0"] {
        board.poke(name, number(&row[name]));
    }
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        board.reach_match();
        board.memory().poke(inputs.offset(4), number(&values[0]) as i32);
        board.interrupt();
        compare(&board, tick, &["Position"], &list(values)[1..], &mut found);
    }
    found
}

fn encoder(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (board.clone(), Vec::new());
    for name in ["InputChan0", "InputGain0", "InputOffset0"] {
        board.poke(name, number(&row[name]));
    }
    let channel = number(&row["InputChan0"]) as usize;
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        board.reach_match();
        board.board.show_encoder(channel, number(&values[0]) as u8);
        board.interrupt();
        compare(&board, tick, &["Position"], &list(values)[1..], &mut found);
    }
    found
}

/// Slaves: the first column is written to the master.
fn slave(row: &Json, board: &Released) -> Vec<String> {
    let note = text(&row["note"]);
    let [master, slave] = if note.contains("higher") { [1, 0] } else { [0, 1] };
    let (mut board, mut found) = (board.clone(), Vec::new());
    let rows = list(&row["rows"]);
    for (axis, dest) in [(master, 0.0), (slave, number(&rows[0][2]))] {
        board.poke_axis(axis, "InputMode", 4.0);
        board.command(&format!("EnableAxisDest{axis} {dest:?}"));
    }
    if note.contains("disabled") {
        board.command(&format!("DisableAxis{master}"));
    }
    let gain = row.get("SlaveGain").map_or(1.0, number);
    board.poke_axis(slave, "MasterAxis", f64::from(master));
    board.poke_axis(slave, "SlaveGain", gain);
    for (tick, values) in rows.iter().enumerate() {
        board.reach_match();
        if note.contains("before the last two") && tick == rows.len() - 2 {
            board.poke_axis(slave, "MasterAxis", -1.0);
        }
        board.poke_axis(master, "Dest", number(&values[0]));
        board.interrupt();
        let columns = [(master, "Dest"), (slave, "Dest"), (slave, "UnfilteredDest")];
        for ((axis, column), expect) in columns.into_iter().zip(&list(values)[1..]) {
            if !board.is(axis, column, expect) {
                let is = board.peek_axis(axis, column);
                found.push(format!("tick {tick} axis {axis} {column}: {is}, recorded {expect}"));
            }
        }
    }
    found
}

/// The fields of axis 0 that differ from the expected values.
fn differing(board: &Released, fields: &Json) -> Vec<String> {
    let fields = fields.as_object().expect("fields").iter();
    let differing = fields.filter(|(name, expect)| !board.is(0, name, expect));
    differing.map(|(name, expect)| format!("{name} {}, recorded {expect}", board.peek(name))).collect()
}

/// Calls that enable, disable and zero an axis in motion: every field before and after.
fn enable(row: &Json, board: &Released) -> Vec<String> {
    let mut board = board.clone();
    for (name, value) in [("OutputMode", 2.0), ("InputMode", 4.0), ("P", 1.0), ("I", 0.5), ("iir0.A1", 0.5)] {
        board.poke(name, value);
    }
    board.poke("Position", -7.0);
    board.command("EnableAxis0");
    board.poke("Dest", 0.0);
    board.board.send_line(b"Jog0=100");
    for _ in 0..200 {
        board.reach_match();
        if differing(&board, &row["before"]).is_empty() {
            break;
        }
        board.interrupt();
    }
    let mut found = differing(&board, &row["before"]);
    board.board.send_line(text(&row["command"]).as_bytes());
    let mut after = Vec::new();
    for _ in 0..SETTLED {
        board.interrupt();
        board.reach_match();
        after = differing(&board, &row["after"]);
        if after.is_empty() {
            break;
        }
    }
    found.append(&mut after);
    found
}

#[test]
fn the_released_firmware_reproduces_the_recorded_servo_outputs() {
    let Some(board) = released() else { return };
    let rows = rows("servo.jsonl");
    let mut wrong = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let found = match text(&row["kind"]) {
            "pid" => compensation(row, &board),
            "output" => outputs::differences(row, &board),
            "adc_input" => analog_input(row, &board),
            "encoder" => encoder(row, &board),
            "backlash" => backlash(row, &board),
            "slave" => slave(row, &board),
            "enable" => enable(row, &board),
            "protection" => protection::differences(row, &board),
            other => panic!("a kind of row that nobody replays: {other}"),
        };
        if !found.is_empty() {
            let name = row["name"].as_str().or(row["note"].as_str()).unwrap_or_default();
            wrong.push(format!("row {index} ({}: {name}):\n {}", row["kind"], found.join("\n ")));
        }
    }
    report(&wrong, rows.len());
}
