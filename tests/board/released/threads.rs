//! Threads, time and the duration of the servo interrupt: `data/vectors/threads.jsonl`.
//!
//! The firmware's own actions must be reproduced to the cycle. The recorded programs were compiled by the vendor's
//! compiler: times between two of their calls include its code, here cc67's code, and may differ by [`CODE`].

use kmotiondef::ThreadId;
use serde_json::Value as Json;

use super::{Released, TICK, list, number, released, report, rows, text, thread};

/// The tolerance for the code between two calls, relative to the vendor's, in seconds.
const CODE: f64 = 2e-6;
/// The tolerance for the first time of a series, which begins where the code before it has ended.
const FIRST: f64 = 10e-6;
/// The cycles for taking an interrupt, and for the branch that returns from it: interrupts are enabled during these.
const AROUND: u64 = 11 + 5;
/// Cycles per second.
const SECOND: f64 = 2e8;
/// The number of cycles before the end of an interrupt from which each cycle is checked.
const NEAR: u64 = 100;
/// The maximum number of ticks for a recorded program.
const LONGEST: u32 = 20_000;

fn threads(list: &Json) -> Vec<ThreadId> {
    super::list(list).iter().filter_map(Json::as_u64).map(thread).collect()
}

/// A program that ends itself.
fn ending(statements: &str) -> String {
    format!(
        "double g[200];\nmain()\n{{\n  int i, t0; double T;\n  {statements}\n  persist.UserData[9] = 1;\n}}\n"
    )
}

const BUSY: &str = "main() { for (;;) ; }\n";
/// The program of thread 2 in the scenarios: it counts starts in a global and a static.
const SECOND_THREAD: &str = "int g = 5; int s = 7;\nmain()\n{\n  g++; s++;\n  persist.UserData[20] = g; \
    persist.UserData[21] = s; persist.UserData[22] = 0;\n  persist.UserData[23]++;\n";

/// Compares the thread of each slice over many slices.
fn rotation(row: &Json, mut board: Released) -> Vec<String> {
    let active = threads(&row["active"]);
    for thread in &active {
        board.load(*thread, BUSY);
    }
    board.board.execute_together(&active).unwrap_or_else(|crash| panic!("{crash}"));
    board.interrupt();
    let expect = text(&row["slices"]);
    let slices = expect.len() + active.len();
    let mut seen = String::new();
    for _ in 0..slices {
        seen += &board.int("CurrentThread").to_string();
        board.interrupt();
    }
    // The recording begins anywhere in the rotation.
    if seen.contains(expect) { Vec::new() } else { vec![format!("{active:?}: {seen}, recorded {expect}")] }
}

/// Returns whether values are as recorded: counts exactly, times within the tolerance for the code between calls.
fn is_time(name: &str, index: usize, found: f64, recorded: f64) -> bool {
    match name {
        "ServoTick growth over Delay_sec(0.09)" | "CurrentThread as read by thread 1" => found == recorded,
        "TIMER0 per WaitNextTimeSlice" => index == 0 || (found - recorded).abs() <= 50e6 * CODE,
        // A slice that ends between two calls.
        "consecutive Time_sec() differences" => {
            found > 90e-6 || recorded > 90e-6 || (found - recorded).abs() <= CODE
        }
        _ => (found - recorded).abs() <= if index == 0 { FIRST } else { CODE },
    }
}

fn times(row: &Json, mut board: Released) -> Vec<String> {
    let name = text(&row["name"]);
    let program = board.load(thread(1), &ending(text(&row["program"])));
    let mut all = vec![thread(1)];
    for other in threads(&row["other_threads"]) {
        board.load(other, BUSY);
        all.push(other);
    }
    board.run_threads(&all, LONGEST);
    let recorded: Vec<f64> = list(&row["values"]).iter().map(number).collect();
    let at = |index: u32| board.board.memory().peek::<f64>(program.variable("g").offset(8 * index));
    let mut found: Vec<f64> = (0..recorded.len() as u32).map(at).collect();
    let mut expect = recorded;
    if name == "WaitNextTimeSlice returns" {
        // From the first one on.
        for values in [&mut found, &mut expect] {
            let first = values[0];
            values.iter_mut().for_each(|value| *value -= first);
        }
    }
    let wrong = found
        .iter()
        .zip(&expect)
        .enumerate()
        .filter(|(index, (found, expect))| !is_time(name, *index, **found, **expect));
    wrong
        .map(|(index, (found, expect))| format!("value {index}: {found:e}, recorded {expect:e}"))
        .take(3)
        .collect()
}

fn scenario(row: &Json, mut board: Released) -> Vec<String> {
    let name = text(&row["name"]);
    // In the scenarios about threads that ended, thread 2's program returns.
    let ends = name.contains("re-run") || name.contains("ended");
    let second = if ends { "}\n" } else { "  for (;;) persist.UserData[24]++;\n}\n" };
    board.load(thread(2), &format!("{SECOND_THREAD}{second}"));
    board.load(thread(1), &format!("main()\n{{\n  {}\n  for (;;) ;\n}}\n", text(&row["program"])));
    board.board.execute_together(&[thread(1)]).unwrap_or_else(|crash| panic!("{crash}"));
    board.ticks(2000);
    let mut found = Vec::new();
    for (index, expect) in row["UserData"].as_object().expect("values") {
        let index: usize = index.parse().expect("an index");
        // The value reached by a counter depends on the code; that it does not change while paused does not.
        let is = if matches!(index, 30 | 31) && number(expect) > 20_000.0 {
            let stands = board.user_data(30) == board.user_data(31) && board.user_data(30) > 0;
            i32::from(stands) * number(expect) as i32
        } else {
            board.user_data(index)
        };
        if f64::from(is) != number(expect) {
            found.push(format!("UserData[{index}] {is}, recorded {expect}"));
        }
    }
    let said = board.said();
    if said != text(&row["console"]) {
        found.push(format!("says {said:?}"));
    }
    found
}

/// Two threads increment one variable, with and without a lock.
fn preemption(row: &Json, mut board: Released) -> Vec<String> {
    let (lock, unlock) = if number(&row["mutex"]) == 0.0 {
        ("", "")
    } else {
        ("MutexLock(&persist.UserData[1]);", "MutexUnlock(&persist.UserData[1]);")
    };
    let source = format!(
        "main()\n{{\n  int i, x;\n  for (i = 0; i < 20000; i++) {{ {lock} x = persist.UserData[0]; x++; \
         persist.UserData[0] = x; {unlock} }}\n  if (++persist.UserData[2] == 2) persist.UserData[9] = 1;\n}}\n"
    );
    let both = [thread(1), thread(2)];
    both.iter().for_each(|one| drop(board.load(*one, &source)));
    board.run_threads(&both, LONGEST);
    let (sum, recorded) = (board.user_data(0), number(&row["result"]));
    // Without a lock, the number of lost increments depends on the code.
    let is_right = if lock.is_empty() { sum < 40_000 } else { f64::from(sum) == recorded };
    if is_right { Vec::new() } else { vec![format!("{sum}, recorded {recorded}")] }
}

fn commands(row: &Json, mut board: Released) -> Vec<String> {
    board.load(thread(2), &format!("{SECOND_THREAD}  for (;;) ;\n}}\n"));
    let mut found = Vec::new();
    for values in list(&row["rows"]) {
        let reply = board.command(text(&values[0]));
        let is = (reply.as_str(), f64::from(board.user_data(23)), f64::from(board.user_data(20)));
        let expect = (text(&values[1]), number(&values[2]), number(&values[3]));
        if is != expect {
            found.push(format!("{}: {is:?}, recorded {expect:?}", values[0]));
        }
    }
    found
}

fn callback(row: &Json, mut board: Released) -> Vec<String> {
    let source = "double g[8]; int calls;\nvoid Call(void)\n{\n  \
        if (calls < 8) g[calls] = Time_sec() - ServoTick * TIMEBASE;\n  calls++; persist.UserData[1] = CurrentThread;\n}\n\
        main()\n{\n  UserCallBack = Call; Delay_sec(0.05); UserCallBack = 0; persist.UserData[9] = 1;\n}\n";
    let program = board.load(thread(1), source);
    board.run_threads(&[thread(1)], LONGEST);
    let mut found = Vec::new();
    let calls: i32 = board.board.memory().peek(program.variable("calls"));
    let ticks = (f64::from(calls) * TICK as f64 - 0.05 * SECOND) / TICK as f64;
    if !(-2.0..2.0).contains(&ticks) {
        found.push(format!("{calls} calls"));
    }
    if f64::from(board.user_data(1)) != number(&row["CurrentThread_seen"]) {
        found.push(format!("it sees thread {}", board.user_data(1)));
    }
    for (index, expect) in (0..).zip(list(&row["values"])) {
        let is: f64 = board.board.memory().peek(program.variable("g").offset(8 * index));
        if (is - number(expect)).abs() > CODE {
            found.push(format!("value {index}: {is:e}, recorded {expect}"));
        }
    }
    found
}

/// Compares the arguments of `main(a, b, c)`: nothing is passed, and the registers of a thread that has never run are
/// 0.
fn main_arguments(row: &Json, mut board: Released) -> Vec<String> {
    let third = thread(row["thread"].as_u64().expect("a thread"));
    let source = "main(int a, int b, int c)\n{\n  persist.UserData[1] = a; persist.UserData[2] = b; \
        persist.UserData[3] = c; persist.UserData[9] = 1;\n}\n";
    board.load(third, source);
    // Later runs find the values that the previous run's code left in the registers, which depend on the compiler.
    board.run_threads(&[third], LONGEST);
    let is = [1, 2, 3].map(|index| f64::from(board.user_data(index)));
    let expect: Vec<f64> = list(&row["runs"][0]).iter().map(number).collect();
    if is.as_slice() == expect { Vec::new() } else { vec![format!("{is:?}, recorded {expect:?}")] }
}

/// A lock whose owner has ended, or a variable that contains an invalid owner.
fn mutex(row: &Json, mut board: Released) -> Vec<String> {
    let case = text(&row["case"]);
    let taker = "main()\n{\n  persist.UserData[3] = persist.UserData[1]; MutexLock(&persist.UserData[1]); \
        persist.UserData[2] = 1; for (;;) ;\n}\n";
    board.load(thread(1), taker);
    let Some(held) = case.strip_prefix("variable holds ") else {
        let rest = if case == "owner returned" { "" } else { "for (;;) ;" };
        board.load(thread(2), &format!("main() {{ MutexLock(&persist.UserData[1]); {rest} }}\n"));
        return owned_mutex(row, board, case);
    };
    let held = held.split(',').next().unwrap_or_default();
    board.command(&format!("SetPersistDec 1 {held}"));
    board.board.execute_together(&[thread(1)]).unwrap_or_else(|crash| panic!("{crash}"));
    board.ticks(200);
    let got = board.user_data(2) == 1;
    if got == row["got_it"] { Vec::new() } else { vec![format!("got it: {got}")] }
}

fn owned_mutex(row: &Json, mut board: Released, case: &str) -> Vec<String> {
    board.command("Execute2");
    let locked = board.user_data(1);
    if case == "owner killed" {
        board.command("Kill2");
    }
    board.command("Execute1");
    board.ticks(200);
    let got = board.user_data(2) == 1;
    let is = [locked, board.user_data(3), board.user_data(1)].map(f64::from);
    let expect =
        ["value_while_locked", "value_before_second_lock", "value_after"].map(|name| number(&row[name]));
    let agrees = is == expect && got == row["second_thread_got_it"];
    if agrees { Vec::new() } else { vec![format!("{is:?} {got}, recorded {row}")] }
}

/// The cycles of the next interrupt from its vector to the return; it takes at least `least`.
fn length(board: &mut Released, least: u64) -> u64 {
    board.reach_match();
    while !board.is_in_interrupt() {
        board.run(1);
    }
    let began = board.board.cycle();
    board.run(least);
    while board.is_in_interrupt() {
        board.run(1);
    }
    board.board.cycle() - began + AROUND
}

/// A board with a number of axes enabled in a mode, at rest.
fn at_rest(board: &Released, axes: u8, input: f64, output: f64) -> Released {
    let mut board = board.clone();
    for axis in 0..axes {
        board.poke_axis(axis, "InputMode", input);
        board.poke_axis(axis, "OutputMode", output);
        board.poke_axis(axis, "OutputChan0", f64::from(axis));
        board.command(&format!("EnableAxisDest{axis} 0"));
    }
    board
}

fn servo_cycles(row: &Json, board: &Released) -> Vec<String> {
    if row["output_mode"].is_null() {
        return moving(board);
    }
    let (input, output) = (number(&row["input_mode"]), number(&row["output_mode"]));
    let mut found = Vec::new();
    for (axes, expect) in (0..).zip(list(&row["cycles"])) {
        let cycles = length(&mut at_rest(board, axes, input, output), number(&expect[0]) as u64 - NEAR);
        if cycles as f64 != number(&expect[0]) {
            found.push(format!("{axes} axes: {cycles}, recorded {expect}"));
        }
    }
    found
}

/// Eight axes in default modes, all moving: 5198 cycles.
fn moving(board: &Released) -> Vec<String> {
    let mut board = board.clone();
    for axis in 0..8 {
        board.command(&format!("EnableAxis{axis}"));
        board.command(&format!("Jog{axis}=100"));
    }
    let cycles = length(&mut board, 5198 - NEAR);
    if cycles == 5198 { Vec::new() } else { vec![format!("{cycles} cycles")] }
}

/// Output modes by the names of the rows, with the corresponding input modes.
const MODES: &[(&str, f64, f64)] = &[
    ("MICROSTEP", 1.0, 1.0),
    ("DC_SERVO", 2.0, 1.0),
    ("3PH", 3.0, 1.0),
    ("DAC", 5.0, 1.0),
    ("STEP_DIR", 6.0, 0.0),
    ("CL_STEP_DIR", 7.0, 1.0),
];

/// Microseconds with and without waits for registers. Two rows about motion do not specify the channels or the path.
fn servo_time(row: &Json, board: &Released) -> Vec<String> {
    let Some(name) = row["output_mode"].as_str() else { return Vec::new() };
    let (_, output, input) = MODES.iter().find(|mode| mode.0 == name).expect("a mode");
    let mut board = board.clone();
    board.board.set_register_waits(number(&row["fpga_access_cycles"]) as u32);
    let mut found = Vec::new();
    for (axes, expect) in (0_u8..).zip(list(&row["axes_0_to_8"])) {
        let cycles = length(&mut at_rest(&board, axes, *input, *output), super::SHORTEST);
        let time = cycles as f64 / SECOND * 1e6;
        if (time - number(expect)).abs() > 0.011 {
            found.push(format!("{axes} axes: {time:.3} µs, recorded {expect}"));
        }
    }
    found
}

#[test]
fn the_released_firmware_reproduces_the_recorded_threads() {
    let Some(board) = released() else { return };
    let rows = rows("threads.jsonl");
    let mut wrong = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let fresh = board.clone();
        let found = match text(&row["kind"]) {
            "rotation" => rotation(row, fresh),
            "times" => times(row, fresh),
            "scenario" => scenario(row, fresh),
            "preemption" => preemption(row, fresh),
            "commands" => commands(row, fresh),
            "callback" => callback(row, fresh),
            "main_arguments" => main_arguments(row, fresh),
            "mutex" => mutex(row, fresh),
            "servo_cycles" => servo_cycles(row, &board),
            "servo_time_us" => servo_time(row, &board),
            other => panic!("a kind of row that nobody replays: {other}"),
        };
        if !found.is_empty() {
            let name = row["name"].as_str().or(row["case"].as_str()).or(row["note"].as_str());
            let name = name.unwrap_or_default();
            wrong.push(format!("row {index} ({}: {name}):\n {}", row["kind"], found.join("\n ")));
        }
    }
    report(&wrong, rows.len());
}
