//! All recorded instructions and packets.

use std::fs;

use c67x::{Control, Reg};
use serde_json::{Map, Value};

use super::flat::Flat;
use crate::dsp::{Core, State};

const PLACE: u32 = 0x1002_0000;

fn recorded(name: &str) -> Vec<Value> {
    let path = format!("{}/c67x/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("recorded lines");
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

fn hex(value: &Value) -> u32 {
    u32::from_str_radix(value.as_str().expect("a string"), 16).expect("a word")
}

fn fields<'a>(line: &'a Value, name: &str) -> impl Iterator<Item = (&'a str, &'a Value)> {
    let object: Option<&Map<String, Value>> = line[name].as_object();
    object.into_iter().flatten().map(|(key, value)| (key.as_str(), value))
}

fn reg(name: &str) -> Reg {
    let number = name[1..].parse().expect("a number");
    if name.starts_with('A') { Reg::a(number) } else { Reg::b(number) }
}

fn control(name: &str) -> Control {
    Control::ALL.iter().copied().find(|control| control.names().0 == name).expect("a control register")
}

/// A core and memory in the line's initial state.
fn set_up(line: &Value, pc: u32) -> (Core, Flat) {
    let mut core = Core::new(pc);
    let mut memory = Flat::default();
    for (name, value) in fields(line, "in") {
        core.state.set_reg(reg(name), hex(value));
    }
    for (name, value) in fields(line, "cr") {
        core.state.set_control(control(name), hex(value));
    }
    for (at, bytes) in fields(line, "mem") {
        memory.hex(u32::from_str_radix(at, 16).expect("an address"), bytes.as_str().expect("bytes"));
    }
    (core, memory)
}

fn registers(state: &State) -> Vec<u32> {
    (0..Reg::COUNT).filter_map(Reg::from_index).map(|reg| state.reg(reg)).collect()
}

/// The differences of memory and control registers from the line.
fn differences(line: &Value, core: &Core, memory: &Flat) -> Vec<String> {
    let mut found = Vec::new();
    for (at, bytes) in fields(line, "memout") {
        let wanted = bytes.as_str().expect("bytes");
        let address = u32::from_str_radix(at, 16).expect("an address");
        let is = memory.text(address, (wanted.len() / 2) as u32);
        if is != wanted {
            found.push(format!("memory {at}: {is}, not {wanted}"));
        }
    }
    for (name, value) in fields(line, "crout") {
        let is = core.state.control(control(name));
        if is != hex(value) {
            found.push(format!("{name}: {is:08x}, not {value}"));
        }
    }
    found
}

fn check_instruction(line: &Value) -> Vec<String> {
    let pc = line.get("pc").map_or(PLACE, hex);
    let (mut core, mut memory) = set_up(line, pc);
    let mut wanted = registers(&core.state);
    for (name, value) in fields(line, "out") {
        wanted[reg(name).index()] = hex(value);
    }
    memory.words(pc, [hex(&line["w"])]);
    let cycles = line["cyc"].as_u64().expect("a number");
    while core.state.cycle() < cycles {
        if let Err(halt) = core.step(&mut memory) {
            return vec![format!("{halt:?}")];
        }
    }
    let mut found = differences(line, &core, &memory);
    let is = registers(&core.state);
    for index in (0..Reg::COUNT).filter(|index| is[*index] != wanted[*index]) {
        let reg = Reg::from_index(index).expect("a register");
        found.push(format!("{reg}: {:08x}, not {:08x}", is[index], wanted[index]));
    }
    if let Some(pcout) = line.get("pcout").map(hex)
        && core.state.pc() != pcout
    {
        found.push(format!("pc: {:08x}, not {pcout:08x}", core.state.pc()));
    }
    found
}

#[test]
fn every_recorded_instruction_computes_what_was_recorded() {
    let lines = recorded("instructions.jsonl");
    assert_eq!(lines.len(), 8528);
    let wrong: Vec<String> = lines
        .iter()
        .filter_map(|line| {
            let found = check_instruction(line);
            (!found.is_empty()).then(|| format!("{} {}: {found:?}", line["id"], line["asm"]))
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "{} of {}:\n{}",
        wrong.len(),
        lines.len(),
        wrong[..wrong.len().min(40)].join("\n")
    );
}

fn check_packets(line: &Value) -> Vec<String> {
    let (mut core, mut memory) = set_up(line, hex(&line["pc"]));
    for (at, words) in fields(line, "code") {
        let words = words.as_array().expect("words").iter().map(hex);
        memory.words(u32::from_str_radix(at, 16).expect("an address"), words);
    }
    let mut expected = registers(&core.state);
    for (number, entry) in line["trace"].as_array().expect("a trace").iter().enumerate() {
        if let Err(halt) = core.step(&mut memory) {
            return vec![format!("packet {number}: {halt:?}")];
        }
        for (name, value) in entry[2].as_object().expect("registers") {
            expected[reg(name).index()] = hex(value);
        }
        let state = &core.state;
        let is = (state.cycle(), state.pc());
        if is != (entry[0].as_u64().expect("a cycle"), hex(&entry[1])) {
            return vec![format!("packet {number}: cycle and pc {is:x?}, not {entry}")];
        }
        let is = registers(state);
        if let Some(index) = (0..Reg::COUNT).find(|index| is[*index] != expected[*index]) {
            let reg = Reg::from_index(index).expect("a register");
            return vec![format!("packet {number}: {reg} {:08x}, not {:08x}", is[index], expected[index])];
        }
    }
    differences(line, &core, &memory)
}

#[test]
fn every_recorded_sequence_of_packets_runs_as_recorded() {
    let lines = recorded("packets.jsonl");
    assert_eq!(lines.len(), 654);
    let wrong: Vec<String> = lines
        .iter()
        .filter_map(|line| {
            let found = check_packets(line);
            (!found.is_empty()).then(|| format!("{} {}: {found:?}", line["id"], line["note"]))
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "{} of {}:\n{}",
        wrong.len(),
        lines.len(),
        wrong[..wrong.len().min(40)].join("\n")
    );
}
