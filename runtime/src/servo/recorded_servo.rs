//! Replays the recorded compensation, inputs and outputs of the released firmware.

use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::{ADC_BUFFER_IN, CS0_STOPPING_STATE, DAC_BUFFER, LAST_PWM, VIRTUAL_BITS};
use kmotiondef::{AxisId, CType, GuestAddr};
use serde_json::Value as Json;

use super::coordinated::system;
use super::hold;
use crate::testing::TestBench;
use crate::text::vectors::rows;
use crate::views::{TypedAccess, chan};

fn axis() -> AxisId {
    AxisId::new(0).expect("0 is an axis")
}

/// The place and type of a field as the recording names it: `P`, `iir0__A1`, `iir0.d0`.
fn place(name: &str) -> (GuestAddr, CType) {
    let parts: Vec<&str> = name.split("__").flat_map(|part| part.split('.')).collect();
    if let [filter, coefficient] = parts[..] {
        let number = filter.trim_start_matches("iir").parse().expect("a filter");
        let field = Iir::STRUCTURE.fields.iter().find(|field| field.name == coefficient).expect(name);
        let filter = chan(axis()).field(Chan::IIR.element(number));
        return (filter.address().offset(field.offset), field.ty);
    }
    let field = Chan::STRUCTURE.fields.iter().find(|field| field.name == name).expect(name);
    (chan(axis()).address().offset(field.offset), field.ty)
}

fn poke(bench: &mut TestBench, name: &str, value: f64) {
    match place(name) {
        (address, CType::Float) => bench.memory.poke(address, value as f32),
        (address, CType::Double) => bench.memory.poke(address, value),
        (address, _) => bench.memory.poke(address, value as i32),
    }
}

fn peek(bench: &TestBench, name: &str) -> f64 {
    match place(name) {
        (address, CType::Float) => f64::from(bench.memory.peek::<f32>(address)),
        (address, CType::Double) => bench.memory.peek(address),
        (address, _) => f64::from(bench.memory.peek::<i32>(address)),
    }
}

fn number(value: &Json) -> f64 {
    value.as_f64().expect("a number")
}

/// A bench with an axis that is enabled at 0 and whose position programs write, and with the row's parameters.
fn bench(row: &Json) -> TestBench {
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 4.0);
    for (name, limit) in [("MaxOutput", 1e5), ("MaxErr", 1e6), ("MaxI", 1e6)] {
        poke(&mut bench, name, limit);
    }
    bench.call("EnableAxisDest", &[0, 0]);
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        poke(&mut bench, name, number(value));
    }
    bench
}

fn close(found: f64, expect: f64) -> bool {
    (found - expect).abs() <= 1e-6 * expect.abs().max(1.0)
}

fn check_compensation(row: &Json) {
    let mut bench = bench(row);
    let columns: Vec<&str> =
        row["columns"].as_array().expect("columns").iter().filter_map(Json::as_str).collect();
    // One recording changes the offset during the run, in the tick with an error of 6.
    let has_offset = row["name"] == "DestOffset";
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(&mut bench, "Position", number(&values[0]));
        poke(&mut bench, "Dest", number(&values[1]));
        if has_offset {
            poke(&mut bench, "DestOffset", number(&values[3]) - number(&values[1]));
        }
        bench.run(1);
        for (column, expect) in columns.iter().zip(values.as_array().expect("values")).skip(2) {
            let found = peek(&bench, column);
            assert!(close(found, number(expect)), "{} tick {tick} {column}: {found} {expect}", row["name"]);
        }
    }
}

fn check_output(row: &Json) {
    let mut bench = bench(row);
    bench.run(2);
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(&mut bench, "Dest", number(&values["Dest"]));
        bench.run(1);
        let place = format!("{} tick {tick}", row["name"]);
        let output = peek(&bench, "Output");
        assert!(close(output, number(&values["Output"])), "{place}: {output} {}", values["Output"]);
        for (channel, word) in values["LastPWM"].as_object().expect("words") {
            let channel: usize = channel.parse().expect("a channel");
            assert_eq!(
                f64::from(bench.memory.get(LAST_PWM.element(channel))),
                number(word),
                "{place} PWM {channel}"
            );
        }
        if let Some(word) = values["DAC"].as_f64() {
            let channel = peek(&bench, "OutputChan0") as usize;
            assert_eq!(f64::from(bench.memory.get(DAC_BUFFER.element(channel))), word, "{place}");
        }
    }
}

fn check_analog_input(row: &Json) {
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 2.0);
    poke(&mut bench, "InputChan0", 1.0);
    for name in ["InputGain0", "InputOffset0"] {
        poke(&mut bench, name, number(&row[name]));
    }
    for values in row["rows"].as_array().expect("rows") {
        bench.memory.set(ADC_BUFFER_IN.element(1), number(&values[0]) as i32);
        bench.run(1);
        assert_eq!(peek(&bench, "Position"), number(&values[1]));
    }
}

/// Checks encoder registers and positions: the load is turned to match the recorded register.
fn check_encoder(row: &Json) {
    let channel = row["InputChan0"].as_i64().expect("a channel");
    let mut bench = TestBench::new();
    poke(&mut bench, "InputChan0", channel as f64);
    let gain = number(&row["InputGain0"]);
    poke(&mut bench, "InputGain0", gain);
    bench.run(1);
    let mut last = 0_i8;
    for values in row["rows"].as_array().expect("rows") {
        let register = (number(&values[0]) as i64) as i8;
        // A board without a SnapAmp has no channel after 8. An encoder turns by counts of its own axis.
        if let Some(turned) = AxisId::new(channel as i32) {
            let unit = if turned == axis() { gain } else { 1.0 };
            bench.kernel.parts.machine.loads.push(turned, f64::from(register.wrapping_sub(last)) * unit);
        }
        last = register;
        bench.run(1);
        assert!(close(peek(&bench, "Position"), number(&values[1])), "{row} {values}");
    }
}

fn check_backlash(row: &Json) {
    let mut bench = desk_with(row, &["BacklashAmount", "BacklashRate"]);
    poke(&mut bench, "BacklashMode", 1.0);
    check_columns(&mut bench, row, 1);
}

/// A bench with some of the row's own values.
fn desk_with(row: &Json, names: &[&str]) -> TestBench {
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 4.0);
    poke(&mut bench, "MaxOutput", 1e5);
    bench.call("EnableAxisDest", &[0, 0]);
    for name in names {
        poke(&mut bench, name, number(&row[*name]));
    }
    bench
}

/// Writes the first column, the destination, and compares the others after each tick.
fn check_columns(bench: &mut TestBench, row: &Json, first: usize) {
    let columns: Vec<&str> =
        row["columns"].as_array().expect("columns").iter().filter_map(Json::as_str).collect();
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(bench, "Dest", number(&values[0]));
        bench.run(1);
        for (column, expect) in columns.iter().zip(values.as_array().expect("values")).skip(first) {
            let found = peek(bench, column);
            assert!(close(found, number(expect)), "tick {tick} {column}: {found} {expect} of {row}");
        }
    }
}

/// Slaves: the first column is written to the master.
fn check_slave(row: &Json) {
    let note = row["note"].as_str().unwrap_or_default();
    let [master, slave] = if note.contains("higher") { [1, 0] } else { [0, 1] };
    let mut bench = TestBench::new();
    let axes = [master, slave].map(|axis| AxisId::new(axis).expect("an axis"));
    let columns = row["rows"][0].as_array().expect("values").len();
    let start = number(&row["rows"][0][2]);
    for (axis, dest) in axes.into_iter().zip([0.0_f64, start]) {
        bench.call("EnableAxisDest", &[u64::from(axis.get()), dest.to_bits()]);
    }
    if note.contains("disabled") {
        bench.call("DisableAxis", &[u64::from(axes[0].get())]);
    }
    bench.memory.set_axis(axes[1], Chan::MASTER_AXIS, master);
    bench.memory.set_axis(axes[1], Chan::SLAVE_GAIN, row["SlaveGain"].as_f64().unwrap_or(1.0));
    let rows = row["rows"].as_array().expect("rows");
    for (tick, values) in rows.iter().enumerate() {
        if note.contains("before the last two") && tick == rows.len() - 2 {
            bench.memory.set_axis(axes[1], Chan::MASTER_AXIS, -1);
        }
        bench.memory.set_axis(axes[0], Chan::DEST, number(&values[0]));
        bench.run(1);
        let found = axes.map(|axis| bench.memory.axis(axis, Chan::DEST));
        assert_eq!(found, [number(&values[1]), number(&values[2])], "tick {tick} of {row}");
        assert!(columns < 4 || bench.memory.axis(axes[1], Chan::UNFILTERED_DEST) == number(&values[3]));
    }
}

/// Checks following errors by their destinations, and limit switches by the resulting state of the axis.
fn check_following_error(row: &Json) {
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 4.0);
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        poke(&mut bench, name, number(value));
    }
    bench.call("EnableAxisDest", &[0, 0]);
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(&mut bench, "Dest", number(&values[0]));
        bench.run(1);
        for (column, name) in [(1, "Enable"), (2, "Dest"), (3, "Output")] {
            let found = peek(&bench, name);
            assert!(close(found, number(&values[column])), "tick {tick} {name}: {found} of {row}");
        }
    }
    check_console(&mut bench, row);
}

fn check_console(bench: &mut TestBench, row: &Json) {
    let printed: String = bench.printed().iter().map(|line| format!("\u{1b}{line}\r\n")).collect();
    assert_eq!(Json::from(printed), row["console"], "{}", row["name"]);
}

/// A limit switch becomes active at rest or in motion.
fn check_limit_switch(row: &Json) {
    let name = row["name"].as_str().expect("a name");
    let before = |text: &str| row["before"].as_array().expect("a list").iter().any(|line| line == text);
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 4.0);
    // The recording jogs an axis of the coordinate system while the status is not polled.
    bench.kernel.parts.pc.host.connect(false);
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        poke(&mut bench, name, number(value));
    }
    let inactive = if name.contains("active low") { 3 } else { 0 };
    bench.memory.set(VIRTUAL_BITS, inactive);
    bench.call("EnableAxisDest", &[0, 0]);
    for speed in [1000.0_f64, -1000.0] {
        if before(&format!("Jog0={speed}")) {
            bench.call("Jog", &[0, speed.to_bits()]);
        }
    }
    bench.run(100);
    bench.memory.set(VIRTUAL_BITS, inactive ^ if name.contains("neg") { 1 } else { 2 });
    bench.run(20);
    let after = &row["after"];
    let enabled = format!("{}\r\n", peek(&bench, "Enable"));
    assert_eq!(Json::from(enabled), after["Enabled0"], "{name}");
    if after["GetStopState"].is_string() {
        let state = format!("{}\r\n", bench.memory.get(CS0_STOPPING_STATE));
        assert_eq!(Json::from(state), after["GetStopState"], "{name}");
    }
    check_console(&mut bench, row);
}

/// Carries out a command of a recording of protections.
fn command(bench: &mut TestBench, text: &str) {
    if let Some(value) = text.strip_prefix("!poke VirtualBits i ") {
        return bench.memory.set(VIRTUAL_BITS, value.parse().expect(text));
    }
    let words = text.find(|letter: char| letter.is_ascii_digit() || letter == '=').expect(text);
    let (name, rest) = text.split_at(words);
    let numbers: Vec<f64> = rest
        .split([' ', '='])
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().expect(text))
        .collect();
    match name {
        "DefineCS" => {
            let axes: Vec<i32> = numbers.iter().map(|&axis| axis as i32).collect();
            system::assign(&mut bench.memory, &axes);
        }
        "EnableAxis" => bench.call(name, &[numbers[0] as u64]),
        _ => bench.call_in_slices(name, &[numbers[0] as u64, numbers[1].to_bits()]),
    }
}

/// Checks following errors, limits packed in a word, and soft limits, which are recorded in every tick.
///
/// The primary thread has every other tick; `wait` ticks pass before the first command, so that both cases are tested.
fn protects(row: &Json, wait: u64) -> Result<(), String> {
    let mut bench = TestBench::new();
    poke(&mut bench, "InputMode", 4.0);
    bench.kernel.parts.pc.host.connect(false);
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        poke(&mut bench, name, number(value));
    }
    bench.run(wait);
    let before = row["before"].as_array().expect("a list");
    before.iter().for_each(|text| command(&mut bench, text.as_str().expect("a command")));
    let rows = row["rows"].as_array().expect("rows");
    // The first row is some ticks after the last command.
    let is_at = |bench: &TestBench| (peek(bench, "Dest") - number(&rows[0][2])).abs() < 1e-12;
    for _ in 0..100 {
        if is_at(&bench) {
            break;
        }
        bench.run(1);
    }
    for (tick, values) in rows.iter().enumerate() {
        let action = values[0].as_str().unwrap_or_default();
        if action.starts_with("!poke") {
            command(&mut bench, action);
        }
        if let Some(dest) = values[0].as_f64() {
            poke(&mut bench, "Dest", dest);
        }
        let state = bench.memory.get(CS0_STOPPING_STATE);
        if tick > 0 || number(&values[2]) == 0.0 {
            bench.run(1);
            // No interrupt of the recorder came between the beginning of a stop and its first axis; on a board one does.
            hold::stop_next(&mut bench.kernel.parts.servo, &mut bench.memory);
        }
        let moves = !bench.memory.axis(axis(), Chan::PCOEFF).is_null();
        let found = [
            peek(&bench, "Enable"),
            peek(&bench, "Dest"),
            peek(&bench, "Output"),
            f64::from(u8::from(moves)),
            f64::from(state),
        ];
        for (column, found) in (1..).zip(found) {
            let expect = number(&values[column]);
            if (found - expect).abs() > 1e-8 * expect.abs() {
                return Err(format!("tick {tick}, column {column}: {found} instead of {expect}"));
            }
        }
        if action.starts_with("EnableAxis") {
            command(&mut bench, action);
        }
        // A jog in motion had been waiting for this slice; one in a feedhold is ignored.
        if let Some(speed) = action.strip_prefix("Jog0=") {
            let arguments = [0, speed.parse::<f64>().expect("a speed").to_bits()];
            let is_done = bench.is_done("Jog", &arguments) || bench.wake("Jog", &arguments);
            assert!(is_done, "{action}");
        }
    }
    let printed: String = bench.printed().iter().map(|line| format!("\u{1b}{line}\r\n")).collect();
    if row["console"] == printed.as_str() { Ok(()) } else { Err(printed) }
}

fn check_protection(row: &Json) {
    let tried = [protects(row, 0), protects(row, 1)];
    assert!(tried.iter().any(Result::is_ok), "{}: {tried:?}", row["name"]);
}

/// Checks calls of enable, disable and zero in motion: fields before and after.
fn check_enable(row: &Json) {
    let mut bench = TestBench::new();
    let text = row["command"].as_str().expect("a command");
    let (name, value) = match text.split_once("0") {
        Some((name, rest)) => (name, rest.trim().parse().unwrap_or(0.0_f64)),
        None => panic!("{text}"),
    };
    poke(&mut bench, "InputMode", 4.0);
    bench.call("EnableAxisDest", &[0, 0]);
    bench.call("Jog", &[0, 1000.0_f64.to_bits()]);
    bench.run(5);
    for (name, value) in row["before"].as_object().expect("fields") {
        if let Some(value) = value.as_f64() {
            poke(&mut bench, name, value);
        }
    }
    bench.call(name, &[0, value.to_bits()]);
    // The effect of the call alone, for fields that the recording's next tick has not changed.
    let after = &row["after"];
    for field in ["Enable", "UnfilteredDest", "Position", "Backlash", "LastNonZeroDir", "DirectionOfMotion"] {
        if name != "DisableAxis" || matches!(field, "Enable" | "UnfilteredDest" | "Position") {
            assert_eq!(peek(&bench, field), number(&after[field]), "{text}: {field}");
        }
    }
    let moves = !bench.memory.axis(axis(), Chan::PCOEFF).is_null();
    assert_eq!(Json::from(moves), after["pcoeff"], "{text}");
    if name != "DisableAxis" {
        for field in ["Dest", "last_dest", "prev_dest", "last_vel"] {
            assert_eq!(peek(&bench, field), number(&after[field]), "{text}: {field}");
        }
    }
}

/// Returns whether a row is about the limit switches of a single axis, judging by its name.
fn is_limit_switch(row: &Json) -> bool {
    row["name"].as_str().is_some_and(|name| name.starts_with("limit ") && name.contains("option 0x1"))
}

#[test]
fn servo_outputs_match_the_recording() {
    let mut replayed = 0;
    for row in rows("servo.jsonl") {
        match row["kind"].as_str() {
            Some("pid") => check_compensation(&row),
            Some("output") => check_output(&row),
            Some("adc_input") => check_analog_input(&row),
            Some("encoder") => check_encoder(&row),
            Some("backlash") => check_backlash(&row),
            Some("slave") => check_slave(&row),
            Some("enable") => check_enable(&row),
            Some("protection") if is_limit_switch(&row) => check_limit_switch(&row),
            Some("protection") if row["name"].as_str().is_some_and(|name| name.contains("output mode")) => {
                check_following_error(&row);
            }
            Some("protection") => check_protection(&row),
            other => panic!("a kind of row that nobody replays: {other:?}"),
        }
        replayed += 1;
    }
    assert_eq!(replayed, 130);
}
