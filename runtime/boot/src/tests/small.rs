//! A firmware of our own, so small that it is contained in this file: it starts, handles its timer, sends text, echoes
//! bytes from the PC, and moves a step generator.

use std::sync::Arc;

use coff::{
    Container, Contents, FileFlags, Image, Name, Program, Section, SectionFlags, SectionNumber, StorageClass,
    Symbol, SymbolType, Target,
};

use crate::{BootedBoard, FirmwareError, FirmwareFile, FlashError, HaltError, SentKind};

/// The address of the code, the interrupt vector, and the code of the interrupt.
const START: u32 = 0x8000_0000;
const VECTOR: u32 = 0x1000_0080;
const HANDLER: u32 = 0x8000_1000;
/// The address at which a board starts from flash.
const FROM_FLASH: u32 = 0x1000_1000;

/// Two instructions that load a constant.
fn constant(unit: &str, value: u32, reg: &str) -> String {
    // MVKH takes the upper half of the whole constant.
    format!("MVK {unit} {},{reg}\nMVKH {unit} 0x{value:08X},{reg}\n", i32::from(value as u16 as i16))
}

/// Stores a word, half word or byte at an address.
fn store(op: &str, address: u32, value: u32) -> String {
    constant(".S1", address, "A20") + &constant(".S1", value, "A21") + &format!("{op} .D1T1 A21,*A20\n")
}

/// The words of a program.
fn code(text: &str, base: u32) -> Vec<u8> {
    let mut at = base;
    let mut bytes = Vec::new();
    for line in text.lines() {
        let line = c67x::assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}"));
        assert!(!line.joins_previous, "one instruction a packet");
        bytes.extend(line.inst.encode(false).to_le_bytes());
        at += 4;
    }
    bytes
}

/// The start: vectors, a timer of 90 µs, enabled interrupts, and then a loop that echoes.
fn start() -> String {
    start_at(START)
}

/// The start code at this address.
fn start_at(base: u32) -> String {
    let timer = |offset: u32, value: u32| store("STW", 0x4200_0000 + offset, value);
    let set = [(0x18, 1), (0x38, 1), (0x0C, 1), (0x50, 4500), (0x54, 4500), (0x80, 1), (0x00, 3)];
    let control = |value: u32, name: &str| constant(".S2", value, "B20") + &format!("MVC .S2 B20,{name}\n");
    let mut text = control(0x1000_0000, "ISTP") + &control(0x13, "IER");
    set.iter().for_each(|(offset, value)| text += &timer(*offset, *value));
    text += &control(0x103, "CSR");
    text += &(constant(".S1", 0x9100_0012, "A4") + &constant(".S1", 0x9100_0016, "A5"));
    let echo = base + 4 * text.lines().count() as u32;
    text += "LDBU .D1T1 *A4,A1\nNOP 4\n";
    text += &format!("[!A1] B .S1 0x{echo:08X}\nNOP 5\nLDBU .D1T1 *A5,A6\nNOP 4\nSTB .D1T1 A6,*A4\n");
    text + &format!("B .S1 0x{echo:08X}\nNOP 5\n")
}

/// Clears the flag, counts the tick, sends a line at the third tick, and makes a generator step from the fifth on.
fn handler() -> String {
    let mut text = store("STW", 0x4200_0088, 1) + "ADD .L1 1,A16,A16\n";
    for (tick, stores) in [
        (3, b"\x1bhi\r\n".iter().map(|byte| (0x9100_0012, u32::from(*byte))).collect::<Vec<_>>()),
        // 2^20 / 2^23 of 200 MHz / 12 are 2,083,333 steps per second; generator 2.
        (5, vec![(0x9100_00F2, 0), (0x9100_00F6, 0), (0x9100_00FA, 0x10), (0x9100_00FE, 0x82)]),
    ] {
        text += &format!("CMPEQ .L1 {tick},A16,A2\n");
        for (address, value) in stores {
            text += &store("STB", address, value).replace("STB", "[A2] STB");
        }
    }
    text + "B .S2 IRP\nNOP 5\n"
}

fn goes_to(place: u32) -> String {
    constant(".S2", place, "B31") + "B .S2 B31\nNOP 5\n"
}

fn section(name: &str, address: u32, bytes: Vec<u8>) -> Section {
    Section {
        name: Name::from(name),
        physical: address,
        address,
        flags: SectionFlags::TEXT,
        page: 0,
        contents: Contents::Data(bytes),
        relocations: Vec::new(),
        lines: Vec::new(),
    }
}

fn image(start: &str) -> Image {
    let jump = goes_to(HANDLER);
    let symbols =
        [("_c_int00", START), ("_main", START), ("_persist", START), ("_chan", START), ("_handler", HANDLER)];
    let symbol = |(name, value): (&str, u32)| Symbol {
        name: Name::from(name),
        value,
        section: SectionNumber(1),
        ty: SymbolType::default(),
        class: StorageClass::EXTERNAL,
        aux: Vec::new(),
    };
    Image {
        container: Container::Coff,
        target: Target::C6000,
        timestamp: 0,
        flags: FileFlags::EXECUTABLE,
        program: Some(Program { entry: START, ..Program::default() }),
        sections: vec![
            section(".text", START, code(start, START)),
            section("vectors", VECTOR, code(&jump, VECTOR)),
            section(".tick", HANDLER, code(&handler(), HANDLER)),
            section(".bstart", FROM_FLASH, code(&goes_to(START), FROM_FLASH)),
        ],
        symbols: symbols.map(symbol).to_vec(),
    }
}

fn file(start: &str) -> Arc<FirmwareFile> {
    let bytes = image(start).write().expect("it can be written");
    Arc::new(FirmwareFile::read(&bytes).unwrap_or_else(|error| panic!("{error}")))
}

fn booted() -> BootedBoard {
    BootedBoard::booted(file(&start())).unwrap_or_else(|crash| panic!("{crash}"))
}

#[test]
fn a_small_firmware_handles_its_timer_prints_and_drives_a_generator() {
    let mut board = booted();
    let begun = board.cycle();
    board.run_to(begun + 20 * 18_000).expect("it runs");
    let lines = board.take_lines();
    let [line] = lines.as_slice() else { panic!("one line: {lines:?}") };
    assert_eq!((line.kind, line.text.as_slice()), (SentKind::Console, b"hi".as_slice()));
    assert!((line.cycle - 3 * 18_000) < 1000, "in the third tick: {}", line.cycle);
    let (steps, rate) = board.steps(2);
    assert!((rate - 2_083_333.333).abs() < 0.01, "{rate}");
    let expected = rate * (board.cycle() - 5 * 18_000) as f64 * 5e-9;
    // The rate is written some hundred cycles after the match.
    assert!((steps - expected).abs() < 4.0, "{steps} of {expected}");
}

#[test]
fn what_the_pc_sends_is_echoed() {
    let mut board = booted();
    board.send(b"abc\n");
    board.run_to(board.cycle() + 9000).expect("it runs");
    assert!(board.has_read_all());
    let texts: Vec<_> = board.take_lines().into_iter().map(|line| (line.kind, line.text)).collect();
    assert_eq!(texts, [(SentKind::Reply, b"abc".to_vec())]);
}

#[test]
fn skipping_the_wait_changes_nothing() {
    let run = |skips: bool| {
        let mut board = booted();
        board.skip_waits(skips);
        for part in 0..10 {
            board.run_to(board.cycle() + 50_001).expect("it runs");
            board.send(format!("{part}\n").as_bytes());
        }
        let (registers, cycle, packets) = (board.registers(), board.cycle(), board.packets());
        let lines = board.take_lines();
        let skipped = board.skipped();
        assert_eq!(skipped > 100_000, skips, "{skipped}");
        (registers, cycle, packets, lines, board.steps(2))
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn a_restored_snapshot_continues_as_the_board_did() {
    let mut board = booted();
    board.run_to(board.cycle() + 70_000).expect("it runs");
    let snapshot = board.snapshot();
    let on = |board: &mut BootedBoard| {
        board.run_to(board.cycle() + 90_000).expect("it runs");
        (board.cycle(), board.registers(), board.take_lines(), board.steps(2))
    };
    let first = on(&mut board);
    board.restore(&snapshot);
    assert_eq!(on(&mut board), first);
    assert_eq!(on(&mut snapshot.board()), first);
}

#[test]
fn a_board_starts_from_its_flash_only_if_it_holds_this_firmware() {
    let before = booted();
    let mut flash = before.flash().to_vec();
    flash[0x18_0000] = 7;
    let from = |flash: &[u8]| BootedBoard::booted_from(file(&start()), flash);
    let mut board = from(&flash).expect("it starts");
    assert!(board.flash() == flash);
    board.run_to(board.cycle() + 20 * 18_000).expect("it runs");
    assert_eq!(board.take_lines().len(), 1);
    for other in [vec![0xFF; flash.len()], flash[..1000].to_vec()] {
        assert_eq!(from(&other).expect_err("it is refused"), FlashError::OtherFirmware);
    }
}

#[test]
fn processor_activity_is_visible_inside_and_outside_the_interrupt() {
    let mut board = booted();
    let outside = board.processor_state();
    assert!(!outside.is_masked && outside.pc < HANDLER, "{outside:?}");
    board.run_to(board.next_tick() + 40).expect("it runs");
    let inside = board.processor_state();
    assert!(inside.is_masked && inside.thread.is_none(), "{inside:?}");
    let looks = board.poll_count();
    board.run_to(board.cycle() + 1000).expect("it runs");
    assert!(board.poll_count() > looks, "it looks for the PC all the while");
}

/// A firmware that repeatedly calls `sqrt` in the ROM with the argument 2.25, and counts the calls.
fn file_with_rom(address: u32) -> Arc<FirmwareFile> {
    let (low, high) = (2.25_f64.to_bits() as u32, (2.25_f64.to_bits() >> 32) as u32);
    let set = start_at(START);
    let set: Vec<&str> = set.lines().collect();
    // Without the echo loop: a single poll of the link reports that it is ready.
    let looks = set.iter().position(|line| line.contains("LDBU")).expect("it looks") + 1;
    let mut text = set[..looks].join("\n") + "\nNOP 4\n";
    let turn = START + 4 * text.lines().count() as u32;
    text += &(constant(".S1", low, "A4") + &constant(".S1", high, "A5") + &constant(".S2", address, "B20"));
    let back = START + 4 * (text.lines().count() as u32 + 4);
    text += &(constant(".S2", back, "B3") + "B .S2 B20\nNOP 5\n");
    text += &format!("ADD .L1 1,A10,A10\nMV .L1 A4,A11\nMV .S1 A5,A12\nB .S1 0x{turn:08X}\nNOP 5\n");
    let mut image = image(&text);
    image.symbols.push(Symbol {
        name: Name::from("_sqrt"),
        value: 0x2D460,
        section: SectionNumber::ABSOLUTE,
        ty: SymbolType::default(),
        class: StorageClass::EXTERNAL,
        aux: Vec::new(),
    });
    let bytes = image.write().expect("it can be written");
    Arc::new(FirmwareFile::read(&bytes).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn functions_in_rom_are_computed_and_interrupts_stay_on_time() {
    let file = file_with_rom(0x2D460);
    assert_eq!(file.function_at(0x2D460), Some(("sqrt".to_owned(), 0)));
    let mut board = BootedBoard::booted(file).unwrap_or_else(|crash| panic!("{crash}"));
    let begun = board.cycle();
    board.run_to(begun + 20 * 18_000).expect("it runs");
    let registers = board.registers();
    let register = |name: &str| registers.iter().find(|one| one.0 == name).expect(name).1;
    assert_eq!(u64::from(register("A12")) << 32 | u64::from(register("A11")), 1.5_f64.to_bits());
    // 379 cycles each, about forty around each call, and the time of the interrupts.
    assert!((700..950).contains(&register("A10")), "{} calls", register("A10"));
    for _ in 0..20 {
        board.run_to(board.next_tick() + 40).expect("it runs");
        assert!(board.processor_state().is_masked, "the interrupt waits for no function");
    }
}

#[test]
fn a_place_in_rom_without_a_function_ends_the_run_with_a_reason() {
    let Err(HaltError::Crashed(crash)) = BootedBoard::booted(file_with_rom(0x2D464)).and_then(|mut board| {
        let end = board.cycle() + 18_000;
        board.run_to(end)
    }) else {
        panic!("it cannot go on")
    };
    assert!(crash.to_string().contains("0x0002D464 in the processor's ROM"), "{crash}");
}

/// The text of the crash of a firmware with this start code.
fn crash(start: &str) -> String {
    let Err(HaltError::Crashed(crash)) = BootedBoard::booted(file(start)) else { panic!("it starts") };
    crash.to_string()
}

#[test]
fn a_runaway_firmware_is_stopped_and_shown_with_registers_and_code() {
    let away = constant(".S2", 0x1234_5678, "B20") + "B .S2 B20\nNOP 5\n";
    let text = crash(&away);
    assert!(text.contains("it went to 0x12345678, where this board has no memory for code"), "{text}");
    assert!(text.contains(" B20=12345678"), "{text}");
    let wild = store("STW", 0x7000_0000, 1) + "NOP 5\n";
    let text = crash(&wild);
    assert!(text.contains("write of the unmapped address 0x70000000"), "{text}");
    assert!(text.contains("STW .D1T1 A21,*"), "{text}");
}

#[test]
fn a_long_start_without_interrupts_can_run_in_one_step() {
    // 0.3 s of a loop before the timer is set.
    let wait = constant(".S1", 9_000_000, "A1") + "ADD .L1 -1,A1,A1\n[A1] B .S1 0x80000008\nNOP 5\n";
    let base = START + 4 * wait.lines().count() as u32;
    let mut board = BootedBoard::new(file(&(wait + &start_at(base))));
    board.run_to(100_000_000).expect("it runs");
    assert_eq!(board.take_lines().len(), 1);
}

#[test]
fn files_that_are_not_firmware_are_refused_with_a_reason() {
    let bytes = image(&start()).write().expect("it can be written");
    let refused = |bytes: &[u8]| FirmwareFile::read(bytes).expect_err("it is refused").to_string();
    assert!(refused(b"#include \"KMotionDef.h\"").starts_with("not a firmware file"));
    assert!(refused(&bytes[..bytes.len() / 2]).starts_with("not a firmware file"));
    let mut low = image(&start());
    low.sections[0].address = 0x1000;
    let low = low.write().expect("it can be written");
    assert!(matches!(FirmwareFile::read(&low), Err(FirmwareError::OtherBoard { .. })), "{}", refused(&low));
    let mut program = image(&start());
    program.symbols.truncate(2);
    let program = program.write().expect("it can be written");
    assert!(refused(&program).contains("it has no `persist`"));
}
