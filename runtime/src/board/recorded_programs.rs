//! Programs of the vendor's compiler, compared with their runs on the released firmware.

use std::fs;

use coff::{Container, Contents, FileFlags, Image, Name, Program, Section, SectionFlags, Target};
use kmotiondef::{ThreadId, Ticks};
use serde_json::Value;
use vm::engine::{ContextId, Executor};
use vm::machine::Config as MachineConfig;

use crate::board::{Board, Config, RunEnd};
use crate::out::EventKind;

fn recorded() -> Vec<Value> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/vectors/c67x-programs.jsonl");
    let text = fs::read_to_string(path).expect("the recorded programs");
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

fn hex(value: &Value) -> u32 {
    u32::from_str_radix(value.as_str().expect("a string"), 16).expect("a word")
}

fn bytes(section: &Value) -> Vec<u8> {
    if let Some(words) = section["words"].as_array() {
        return words.iter().flat_map(|word| hex(word).to_le_bytes()).collect();
    }
    let text = section["bytes"].as_str().expect("bytes");
    (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).expect("a byte")).collect()
}

/// The image as the vendor's compiler writes it, without symbols.
fn image(line: &Value) -> Vec<u8> {
    let sections = line["load"].as_array().expect("sections").iter().map(|section| {
        let name = section["section"].as_str().expect("a name");
        let address = hex(&section["addr"]);
        Section {
            name: Name::from(name),
            physical: address,
            address,
            flags: if name == ".text" { SectionFlags::TEXT } else { SectionFlags::DATA },
            page: 0,
            contents: Contents::Data(bytes(section)),
            relocations: Vec::new(),
            lines: Vec::new(),
        }
    });
    let image = Image {
        container: Container::Coff,
        target: Target::C6000,
        timestamp: 0,
        flags: FileFlags::EXECUTABLE,
        program: Some(Program { entry: hex(&line["entry"]), version_stamp: 0x190, ..Program::default() }),
        sections: sections.collect(),
        symbols: Vec::new(),
    };
    image.write().expect("it can be written")
}

/// Runs a program in thread 1; returns its output and the differences from the recorded line.
fn run(line: &Value, shortcuts: bool) -> Vec<String> {
    let machine = MachineConfig { shortcuts, ..MachineConfig::default() };
    let mut board: Board = Board::new(Config { machine, ..Config::default() });
    let thread = ThreadId::new(1).expect("1 is a thread");
    board.load(thread, &image(line)).expect("it loads");
    board.start(thread).expect("it is loaded");
    let mut console = String::new();
    let mut found = Vec::new();
    let end = board.run(Ticks::new(100_000), &mut |event| match &event.kind {
        EventKind::ConsoleLine(text) => console += &format!("{}\n", String::from_utf8_lossy(text)),
        EventKind::Trap(trap) => found.push(trap.to_string()),
        _ => {}
    });
    let id = ContextId::of(thread);
    let core = board.machine().images().core(id).expect("it ran");
    let result = core.state.reg(c67x::Reg::a(4)).cast_signed();
    let mut expect = |name: &str, is: String, wanted: String| {
        if is != wanted {
            found.push(format!("{name}: {is}, not {wanted}"));
        }
    };
    expect("end", format!("{end:?}"), format!("{:?}", RunEnd::AllEnded));
    expect("console", format!("{console:?}"), format!("{:?}", line["console"].as_str().unwrap_or_default()));
    expect("result", result.to_string(), line["main_result"].to_string());
    expect("cycles", core.state.cycle().to_string(), line["user_cycles"].to_string());
    expect("packets", core.packets().to_string(), line["user_packets"].to_string());
    if line["firmware_calls"] == 0 {
        let used = board.machine().images().stack_used(id);
        expect("stack", used.to_string(), line["stack_bytes"].to_string());
    }
    found
}

#[test]
fn every_recorded_program_prints_and_costs_what_it_did_on_the_board() {
    let lines = recorded();
    assert_eq!(lines.len(), 54);
    let wrong: Vec<String> = lines
        .iter()
        .flat_map(|line| [run(line, true), run(line, false)].into_iter().map(move |found| (line, found)))
        .filter(|(_, found)| !found.is_empty())
        .map(|(line, found)| format!("{}: {found:#?}", line["id"]))
        .collect();
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}
