//! Programs: sizes, locks, library functions, names that link; and programs linked for the other firmware.

use kmotiondef::boards::TargetBoard;
use kmotiondef::map::PROGRAM_SIZE;
use serde_json::Value as Json;

use super::super::servo::compensation;
use super::super::{Program, Released, list, number, released, report, text, thread};
use super::{compare, firmware_5, of_kinds};

/// The number of ticks after which a program that has not ended waits forever.
const FOREVER: u32 = 2000;
/// The tolerance in seconds for the code of a program, at most twenty iterations, compared with the vendor's code.
const CODE: f64 = 8e-6;
/// The relative tolerance for numbers that depend on the last digits of a function in the processor's ROM.
const ROM: f64 = 2.0 * f64::EPSILON;
/// The stack of thread 1: its first address and its size.
const STACK: std::ops::Range<i64> = 0x1001_7AE0..0x1001_82E0;

fn source(statements: &str) -> String {
    format!(
        "double d[20];\nint ended;\nint main()\n{{\n  int *u = persist.UserData; int i;\n  {statements}\n  ended = 1;\n  \
         return 0;\n}}\n"
    )
}

fn program(row: &Json, mut board: Released) -> Vec<String> {
    let expect = &row["result"];
    if let Some(link) = expect["link"].as_str() {
        let name = link.split('\'').nth(1).expect("it names the symbol");
        let has = board.board.file().address(name).is_some()
            || TargetBoard::named("kflop-5.3.2").is_some_and(|board| board.has(name));
        return if has { vec![format!("the firmware has {name}, recorded {link}")] } else { Vec::new() };
    }
    for (number, source) in row["others"].as_object().into_iter().flatten() {
        board.load(thread(number.parse().expect("a thread")), text(source));
    }
    let program = board.load(thread(1), &source(text(&row["program"])));
    board.said();
    board.board.execute(thread(1));
    let ended = program.variable("ended");
    for _ in 0..FOREVER {
        board.ticks(1);
        if board.board.memory().peek::<i32>(ended) != 0 {
            break;
        }
    }
    // The printed lines are sent in the slices of the primary thread.
    board.ticks(20);
    check(row, board, &program)
}

fn check(row: &Json, mut board: Released, program: &Program) -> Vec<String> {
    let (expect, mut found) = (&row["result"], Vec::new());
    let ended = board.board.memory().peek::<i32>(program.variable("ended")) != 0;
    if expect["ended"] != ended {
        found.push(format!("ended: {ended}"));
    }
    let is_address = text(&row["name"]).contains("address of the first local");
    for (index, value) in expect["UserData"].as_object().into_iter().flatten() {
        let is = i64::from(board.user_data(index.parse().expect("an index")));
        // The addresses of locals on the stack depend on the compiler.
        let is_same =
            if is_address && index == "0" { STACK.contains(&is) } else { Some(is) == value.as_i64() };
        if !is_same {
            found.push(format!("UserData[{index}] {is}, recorded {value}"));
        }
    }
    let doubles = expect["doubles"].as_array().into_iter().flatten();
    for (index, value) in (0..).zip(doubles) {
        let is: f64 = board.board.memory().peek(program.variable("d").offset(8 * index));
        let slack = if text(&row["name"]).starts_with("mutex") { CODE } else { ROM * number(value).abs() };
        if (is - number(value)).abs() > slack {
            found.push(format!("d[{index}] {is:e}, recorded {value}"));
        }
    }
    let said = board.said();
    if said != expect["console"].as_str().unwrap_or_default() {
        found.push(format!("says {said:?}"));
    }
    found
}

/// Runs a program linked for one version on the other: it stores and prints nothing, and the board no longer answers.
fn cross(row: &Json, mut board: Released, linked: &Released) -> Vec<String> {
    let source = text(&row["program"]).replace("#include \"KMotionDef.h\"\n", "");
    let image = linked.compiled(thread(1), &source);
    board.load_image(thread(1), &image);
    let before: Vec<u8> = {
        let base = kmotiondef::map::program_base(thread(1));
        board.board.memory().read_bytes(base, PROGRAM_SIZE).expect("mapped").to_vec()
    };
    assert!(before.iter().any(|byte| *byte != 0), "the program is there");
    board.said();
    board.board.execute(thread(1));
    // It may crash.
    let end = board.board.cycle() + 200 * super::super::TICK;
    let has_run_away = board.board.run_to(end).is_err();
    let mut found = Vec::new();
    for (index, value) in list(&row["UserData"]).iter().enumerate() {
        if f64::from(board.user_data(index)) != number(value) {
            found.push(format!("UserData[{index}] {}, recorded {value}", board.user_data(index)));
        }
    }
    let said = board.said();
    if said != text(&row["console"]) {
        found.push(format!("says {said:?}"));
    }
    let reply = if has_run_away { String::new() } else { board.tried("Version") };
    if reply != text(&row["version_reply_afterwards"]) {
        found.push(format!("answers {reply:?}"));
    }
    // The function that a call reaches depends on the code around it, which also decides whether thread 1 ends.
    let active = board.int("ThreadActive") | 1 << 1;
    if f64::from(active) != number(&row["ThreadActive"]) {
        found.push(format!("ThreadActive {active}, recorded {}", row["ThreadActive"]));
    }
    found
}

#[test]
fn programs_do_on_firmware_5_what_was_recorded() {
    compare(&["program"], program);
}

#[test]
fn compensation_of_firmware_5_is_as_recorded() {
    compare(&["pid"], |row, mut board| {
        let method = board.address("StandardDerivativeMethod");
        board.memory().poke(method, number(&row["StandardDerivativeMethod"]) as i32);
        compensation(row, &board)
    });
}

#[test]
fn programs_for_the_other_version_do_what_was_recorded() {
    let (Some(old), Some(new)) = (released(), firmware_5()) else { return };
    let rows = of_kinds(&["cross"]);
    let mut wrong = Vec::new();
    for (index, row) in &rows {
        let (board, linked) = if row["run_on"] == "5.3.2" { (&new, &old) } else { (&old, &new) };
        let found = cross(row, board.clone(), linked);
        if !found.is_empty() {
            wrong.push(format!("row {index}:\n {}", found.join("\n ")));
        }
    }
    report(&wrong, rows.len());
}
