//! Programs on firmware 5: sizes, locks, library functions, symbols that resolve, the derivative gain of an axis.

use serde_json::Value as Json;

use super::{Model, Program, compare, list, number, target, text, thread};

/// The number of ticks after which a program that has not ended waits forever.
const FOREVER: u32 = 2000;
/// The tolerance in seconds for the code of a program and of its calls.
const CODE: f64 = 15e-6;

fn source(statements: &str) -> String {
    format!(
        "double d[20];\nint ended;\nint main()\n{{\n  int *u = persist.UserData; int i;\n  {statements}\n  ended = 1;\n  \
         return 0;\n}}\n"
    )
}

fn program(row: &Json) -> Vec<String> {
    if let Some(link) = row["result"]["link"].as_str() {
        let name = link.split('\'').nth(1).expect("it names the symbol");
        return if target().has(name) { vec![format!("the board has {name}")] } else { Vec::new() };
    }
    let mut board = Model::new();
    for (number, source) in row["others"].as_object().into_iter().flatten() {
        board.load(thread(number.parse().expect("a thread")), text(source));
    }
    let program = board.load(thread(1), &source(text(&row["program"])));
    board.board.start(thread(1)).expect("it is loaded");
    let ended = program.variable("ended");
    for _ in 0..FOREVER {
        board.ticks(1);
        if board.int(ended) != 0 {
            break;
        }
    }
    // What it has printed comes in the slices of the primary thread.
    board.ticks(20);
    check(row, &board, &program)
}

fn check(row: &Json, board: &Model, program: &Program) -> Vec<String> {
    let (expect, mut found) = (&row["result"], Vec::new());
    let ended = board.int(program.variable("ended")) != 0;
    if expect["ended"] != ended {
        found.push(format!("ended: {ended}"));
    }
    let is_address = text(&row["name"]).contains("address of the first local");
    for (index, value) in expect["UserData"].as_object().into_iter().flatten() {
        let is = board.user_data(index.parse().expect("an index"));
        // Programs of the model have a stack of their own.
        if value.as_i64() != Some(is.into()) && !(is_address && index == "0") {
            found.push(format!("UserData[{index}] {is}, recorded {value}"));
        }
    }
    let doubles = expect["doubles"].as_array().into_iter().flatten();
    for (index, value) in (0..).zip(doubles) {
        let is = board.double(program.variable("d").offset(8 * index));
        let value = number(value);
        let slack = if text(&row["name"]).starts_with("mutex") { CODE } else { f64::EPSILON * value.abs() };
        if (is - value).abs() > slack {
            found.push(format!("d[{index}] {is:e}, recorded {value}"));
        }
    }
    if board.said != expect["console"].as_str().unwrap_or_default() {
        found.push(format!("says {:?}", board.said));
    }
    found
}

#[test]
fn programs_do_on_the_model_what_was_recorded_of_firmware_5() {
    compare(&["program"], program);
}

fn compensation(row: &Json) -> Vec<String> {
    let (mut board, mut found) = (Model::new(), Vec::new());
    let method = target().variable("StandardDerivativeMethod").expect("it has one");
    board.board.memory_mut().poke(method, number(&row["StandardDerivativeMethod"]) as i32);
    board.poke("InputMode", 4.0);
    board.poke("MaxErr", 1e6);
    board.command("EnableAxisDest0 0");
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        board.poke(name, number(value));
    }
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        let [position, dest, output] = [0, 1, 2].map(|column| number(&values[column]));
        board.poke("Position", position);
        board.poke("Dest", dest);
        board.ticks(1);
        if board.peek("Output") as f32 != output as f32 {
            found.push(format!("tick {tick}: {}, recorded {output}", board.peek("Output")));
        }
    }
    found
}

#[test]
fn compensation_of_the_model_is_as_recorded_of_firmware_5() {
    compare(&["pid"], compensation);
}
