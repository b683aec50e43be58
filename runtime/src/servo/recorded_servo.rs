//! Replays the recorded compensation, inputs and outputs of the released firmware.

use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::{ADC_BUFFER_IN, DAC_BUFFER, LAST_PWM};
use kmotiondef::{AxisId, CType, GuestAddr};
use serde_json::Value as Json;

use crate::testing::Desk;
use crate::text::vectors::rows;
use crate::views::{Typed, chan};

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

fn poke(desk: &mut Desk, name: &str, value: f64) {
    match place(name) {
        (address, CType::Float) => desk.memory.poke(address, value as f32),
        (address, CType::Double) => desk.memory.poke(address, value),
        (address, _) => desk.memory.poke(address, value as i32),
    }
}

fn peek(desk: &Desk, name: &str) -> f64 {
    match place(name) {
        (address, CType::Float) => f64::from(desk.memory.peek::<f32>(address)),
        (address, CType::Double) => desk.memory.peek(address),
        (address, _) => f64::from(desk.memory.peek::<i32>(address)),
    }
}

fn number(value: &Json) -> f64 {
    value.as_f64().expect("a number")
}

/// A desk with an axis enabled at 0 whose position programs write, and the row's parameters.
fn desk(row: &Json) -> Desk {
    let mut desk = Desk::new();
    poke(&mut desk, "InputMode", 4.0);
    for (name, limit) in [("MaxOutput", 1e5), ("MaxErr", 1e6), ("MaxI", 1e6)] {
        poke(&mut desk, name, limit);
    }
    desk.call("EnableAxisDest", &[0, 0]);
    for (name, value) in row["parameters"].as_object().expect("parameters") {
        poke(&mut desk, name, number(value));
    }
    desk
}

fn close(found: f64, expect: f64) -> bool {
    (found - expect).abs() <= 1e-6 * expect.abs().max(1.0)
}

fn check_compensation(row: &Json) {
    let mut desk = desk(row);
    let columns: Vec<&str> =
        row["columns"].as_array().expect("columns").iter().filter_map(Json::as_str).collect();
    // One recording changes the offset on the way, in the tick that shows an error of 6.
    let has_offset = row["name"] == "DestOffset";
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(&mut desk, "Position", number(&values[0]));
        poke(&mut desk, "Dest", number(&values[1]));
        if has_offset {
            poke(&mut desk, "DestOffset", number(&values[3]) - number(&values[1]));
        }
        desk.run(1);
        for (column, expect) in columns.iter().zip(values.as_array().expect("values")).skip(2) {
            let found = peek(&desk, column);
            assert!(close(found, number(expect)), "{} tick {tick} {column}: {found} {expect}", row["name"]);
        }
    }
}

fn check_output(row: &Json) {
    let mut desk = desk(row);
    desk.run(2);
    for (tick, values) in row["rows"].as_array().expect("rows").iter().enumerate() {
        poke(&mut desk, "Dest", number(&values["Dest"]));
        desk.run(1);
        let place = format!("{} tick {tick}", row["name"]);
        let output = peek(&desk, "Output");
        assert!(close(output, number(&values["Output"])), "{place}: {output} {}", values["Output"]);
        for (channel, word) in values["LastPWM"].as_object().expect("words") {
            let channel: usize = channel.parse().expect("a channel");
            assert_eq!(
                f64::from(desk.memory.get(LAST_PWM.element(channel))),
                number(word),
                "{place} PWM {channel}"
            );
        }
        if let Some(word) = values["DAC"].as_f64() {
            let channel = peek(&desk, "OutputChan0") as usize;
            assert_eq!(f64::from(desk.memory.get(DAC_BUFFER.element(channel))), word, "{place}");
        }
    }
}

fn check_analog_input(row: &Json) {
    let mut desk = Desk::new();
    poke(&mut desk, "InputMode", 2.0);
    poke(&mut desk, "InputChan0", 1.0);
    for name in ["InputGain0", "InputOffset0"] {
        poke(&mut desk, name, number(&row[name]));
    }
    for values in row["rows"].as_array().expect("rows") {
        desk.memory.set(ADC_BUFFER_IN.element(1), number(&values[0]) as i32);
        desk.run(1);
        assert_eq!(peek(&desk, "Position"), number(&values[1]));
    }
}

#[test]
fn the_board_computes_and_puts_out_the_same() {
    let mut replayed = 0;
    for row in rows("servo.jsonl") {
        match row["kind"].as_str() {
            Some("pid") => check_compensation(&row),
            Some("output") => check_output(&row),
            Some("adc_input") => check_analog_input(&row),
            _ => continue,
        }
        replayed += 1;
    }
    assert_eq!(replayed, 64);
}
