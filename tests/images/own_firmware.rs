//! A firmware of our own, written in C and compiled for the real processor, on the board that boots firmware files. The
//! parts that C cannot express are assembled: the start, the interrupt vector, and the code that saves the registers
//! around the C function.

use std::path::Path;
use std::sync::Arc;

use boot::{BootedBoard, FirmwareFile, HaltError, ProgramPacket, RunOutcome, SentKind};
use coff::{
    Contents, Image, Name, Program, Section, SectionFlags, SectionNumber, StorageClass, Symbol, SymbolType,
};
use compiler::pp::MemoryFiles;
use compiler::target::Target;
use compiler::{Options, compile};
use kmotiondef::ThreadId;
use kmotiondef::map::{IRAM, SDRAM};

const SOURCE: &str = include_str!("own_firmware.c");
/// A function that the C code calls with the number of each tick; it returns at once.
const SERVICE: u32 = 0x8000_2000;
/// The addresses of the assembled parts, and the end of the stack.
const START: u32 = 0x8000_0000;
const HANDLER: u32 = 0x8000_1000;
const VECTOR: u32 = 0x1000_0080;
const STACK: u32 = 0x8007_FFF0;
/// The size of the saved registers in bytes, a multiple of 8.
const KEPT: u32 = 64 * 4 + 8;
/// Cycles of a tick.
const TICK: u64 = 18_000;

fn constant(value: u32, reg: &str) -> String {
    format!("MVK .S2 {},{reg}\nMVKH .S2 0x{value:08X},{reg}\n", i32::from(value as u16 as i16))
}

/// The words of a text, one instruction per packet.
fn code(text: &str, base: u32) -> Vec<u8> {
    let words = text.lines().zip((base..).step_by(4)).map(|(line, at)| {
        c67x::assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}")).inst.encode(false)
    });
    words.flat_map(u32::to_le_bytes).collect()
}

/// Sets up the stack, the vectors and the interrupts; then calls C.
fn start(main: u32) -> String {
    let control = |value: u32, name: &str| constant(value, "B20") + &format!("MVC .S2 B20,{name}\n");
    let set = control(0x1000_0000, "ISTP") + &control(0x13, "IER") + &control(0x103, "CSR");
    constant(STACK, "B15") + &set + &constant(main, "B20") + "B .S2 B20\nNOP 5\n"
}

/// Saves all registers, calls C, and returns.
fn handler(tick: u32) -> String {
    let registers = || (0..32).flat_map(|number| [('A', number), ('B', number)]);
    let each = |op: &str| {
        let kept = registers().filter(|register| *register != ('B', 15));
        let lines = kept.map(|(file, number)| {
            let (path, slot) = if file == 'A' { (1, 2 + number) } else { (2, 34 + number) };
            match op {
                "STW" => format!("STW .D2T{path} {file}{number},*+B15[{slot}]\n"),
                _ => format!("LDW .D2T{path} *+B15[{slot}],{file}{number}\n"),
            }
        });
        lines.collect::<String>()
    };
    let keep = format!("ADDK .S2 -{KEPT},B15\n") + &each("STW") + &constant(tick, "B5");
    let back = HANDLER + 4 * (keep.lines().count() as u32 + 4);
    let call = constant(back, "B3") + "B .S2 B5\nNOP 5\n";
    keep + &call + &each("LDW") + &format!("NOP 4\nADDK .S2 {KEPT},B15\nB .S2 IRP\nNOP 5\n")
}

fn section(name: &str, address: u32, text: &str) -> Section {
    Section {
        name: Name::from(name),
        physical: address,
        address,
        flags: SectionFlags::TEXT,
        page: 0,
        contents: Contents::Data(code(text, address)),
        relocations: Vec::new(),
        lines: Vec::new(),
    }
}

/// The C code, linked as a program for thread 1.
fn compiled() -> Image {
    let options = Options { target: Target::C67x, ..Options::default() };
    let mut compilation = compile(Path::new("own_firmware.c"), SOURCE.into(), &options, &MemoryFiles::new());
    let linked = compilation.link(ThreadId::new(1).expect("there is a thread 1"), &options);
    let linked = linked.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics()));
    let bytes = compiler::image::write(&linked).expect("the image can be written");
    Image::read(&bytes).expect("it is one")
}

fn address(image: &Image, name: &str) -> u32 {
    let named = |symbol: &&Symbol| symbol.name.to_str().trim_start_matches('_') == name;
    image.symbols.iter().find(named).unwrap_or_else(|| panic!("there is a {name}")).value
}

fn firmware() -> Vec<u8> {
    let mut image = compiled();
    let (main, tick) = (address(&image, "main"), address(&image, "tick"));
    let jump = constant(HANDLER, "B31") + "B .S2 B31\nNOP 5\n";
    image.sections.push(section("start", START, &start(main)));
    image.sections.push(section("vectors", VECTOR, &jump));
    image.sections.push(section("handler", HANDLER, &handler(tick)));
    image.sections.push(section("service", SERVICE, "B .S2 B3\nNOP 5\n"));
    let places = [("_c_int00", START), ("_main", main), ("_persist", START), ("_chan", START)];
    image.symbols.retain(|symbol| symbol.name.to_str() != "_main");
    image.symbols.extend(places.map(|(name, value)| Symbol {
        name: Name::from(name),
        value,
        section: SectionNumber(1),
        ty: SymbolType::default(),
        class: StorageClass::EXTERNAL,
        aux: Vec::new(),
    }));
    image.program = Some(Program { entry: START, ..image.program.unwrap_or_default() });
    image.write().expect("it can be written")
}

fn booted() -> BootedBoard {
    let file = FirmwareFile::read(&firmware()).unwrap_or_else(|error| panic!("{error}"));
    let booted = BootedBoard::booted(Arc::new(file));
    let mut board = booted.unwrap_or_else(|HaltError::Crashed(crash)| panic!("{crash}"));
    board.keep_pin_changes();
    board
}

#[test]
fn a_firmware_in_c_handles_its_timer_prints_and_drives_a_generator() {
    let mut board = booted();
    board.run_to(board.cycle() + 25 * TICK).unwrap_or_else(|halted| panic!("{halted}"));
    let lines: Vec<_> = board.take_lines().into_iter().map(|line| (line.kind, line.text)).collect();
    assert_eq!(lines, ["tick 10", "tick 20"].map(|text| (SentKind::Console, text.as_bytes().to_vec())));
    let (steps, rate) = board.steps(2);
    assert!((rate - 2_083_333.333).abs() < 0.01, "{rate}");
    assert!((steps / rate - 20.0 * 90e-6).abs() < 100e-6, "{steps} steps since the fifth tick");
}

#[test]
fn a_firmware_in_c_echoes_while_it_is_interrupted() {
    let mut board = booted();
    let text: Vec<u8> = (0..200).map(|number| b'a' + number % 26).collect();
    for part in text.chunks(7) {
        board.send(part);
        board.run_to(board.cycle() + TICK / 2).unwrap_or_else(|halted| panic!("{halted}"));
    }
    let bytes: Vec<u8> = board.take_bytes().into_iter().map(|(_, byte)| byte).collect();
    // Text printed by the interrupt appears at any position in between.
    let all = String::from_utf8(bytes).expect("it is text");
    let (one, rest) = all.split_once("\x1btick 10\r\n").expect("a tenth tick");
    assert_eq!(one.to_owned() + rest, String::from_utf8_lossy(&text));
}

/// The whole observable state of a board, and the bytes that it has sent since the last call.
fn seen(board: &mut BootedBoard) -> impl PartialEq + std::fmt::Debug + use<> {
    let bytes = board.take_bytes();
    let place = (board.cycle(), board.packets(), board.registers(), board.steps(2));
    let changes = board.take_pin_changes();
    let memory = board.memory();
    let ram = [IRAM, SDRAM].map(|region| memory.read_bytes(region.base, region.size).expect("it is RAM"));
    // As a hash, since memory is too large to be printed.
    let mut hash = std::hash::DefaultHasher::new();
    std::hash::Hash::hash(&ram, &mut hash);
    (bytes, place, changes, std::hash::Hasher::finish(&hash))
}

fn run_to(board: &mut BootedBoard, cycle: u64) {
    board.run_to(cycle).unwrap_or_else(|halted| panic!("{halted}"));
}

#[test]
fn a_board_restored_from_a_snapshot_continues_as_before() {
    let mut board = booted();
    // Between ticks, within the interrupt of one, and while it prints.
    for at in [3 * TICK + 7777, 5 * TICK + 300, 10 * TICK + 450, 10 * TICK + 455] {
        run_to(&mut board, at);
        board.send(b"in flight");
        let _ = board.take_bytes();
        let snapshot = board.snapshot();
        let end = at + 12 * TICK + 1234;
        run_to(&mut board, end);
        let once = seen(&mut board);
        board.restore(&snapshot);
        assert_eq!(board.cycle(), snapshot.cycle());
        run_to(&mut board, end);
        assert_eq!(seen(&mut board), once, "from cycle {at}");
        let mut other = snapshot.board();
        // In parts, which must not make a difference.
        (at..end).step_by(997).for_each(|cycle| run_to(&mut other, cycle));
        run_to(&mut other, end);
        assert_eq!(seen(&mut other), once, "from cycle {at}, in parts");
        board.restore(&snapshot);
    }
}

#[test]
fn stops_do_not_change_a_run() {
    let mut plain = booted();
    let begin = plain.cycle();
    run_to(&mut plain, begin + 25 * TICK);
    let tick = address(&compiled(), "tick");
    let mut board = booted();
    board.set_stops([tick, SERVICE]);
    let (mut ticks, mut calls) = (Vec::new(), Vec::new());
    while board.run_to_stop(begin + 25 * TICK).unwrap_or_else(|halted| panic!("{halted}"))
        == RunOutcome::ToStop
    {
        match board.processor_state().pc {
            SERVICE => calls.extend(board.program_call()),
            pc => {
                assert_eq!(pc, tick);
                assert_eq!(board.program_call(), None, "a call of the firmware's own");
                ticks.push(board.cycle());
            }
        }
    }
    assert!(seen(&mut board) == seen(&mut plain));
    assert!(ticks.len() >= 24 && ticks.windows(2).all(|pair| pair[1] - pair[0] > TICK / 2), "{ticks:?}");
    let numbers: Vec<_> = calls.iter().map(|call| (call.argument, call.thread, call.function)).collect();
    assert_eq!(numbers, (1..=ticks.len() as i32).map(|number| (number, None, SERVICE)).collect::<Vec<_>>());
    assert!(calls.iter().all(|call| call.at > tick && call.at < tick + 0x200), "{calls:X?}");
}

#[test]
fn packets_of_programs_are_recorded_as_they_are_executed() {
    let mut plain = booted();
    let begin = plain.cycle();
    run_to(&mut plain, begin + 3 * TICK);
    let mut board = booted();
    board.keep_packets(true);
    run_to(&mut board, begin + 3 * TICK);
    let packets = board.take_packets();
    assert!(seen(&mut board) == seen(&mut plain));
    let is_program = |packet: &ProgramPacket| (0x8005_0000..0x8006_0000).contains(&packet.at);
    assert!(packets.len() > 5000 && packets.iter().all(is_program), "{}", packets.len());
    let follows = |pair: &[ProgramPacket]| pair[0].cycle + pair[0].cycles as u64 <= pair[1].cycle;
    assert!(packets.windows(2).all(follows));
    // Only the start, the vector, the saving of registers and the called function are outside these packets.
    let own: i64 = packets.iter().map(|packet| packet.cycles).sum();
    assert!(own > 2 * TICK as i64 && own < 3 * TICK as i64, "{own}");
    let first = packets.iter().find(|packet| packet.text.contains("LDB")).expect("it reads registers");
    assert!(first.text.contains(".D1") || first.text.contains(".D2"), "{first:?}");
}
