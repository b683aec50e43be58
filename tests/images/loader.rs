//! Images that a board refuses to load, keeping its previous program.

use std::path::Path;

use coff::{Contents, FileFlags, Image, Relocation, Section, SectionFlags, Target};
use compiler::pp::Disk;
use compiler::{Options, image};
use kmotiondef::map::{self, program_base};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, EventKind};

fn thread(number: i32) -> ThreadId {
    ThreadId::new(number).expect("1 to 7")
}

/// The image of a program for a thread.
fn build(source: &str, number: i32) -> Vec<u8> {
    let options = Options::default();
    let source = format!("#include \"KMotionDef.h\"\n{source}");
    let mut compilation = compiler::compile(Path::new("a.c"), source.into_bytes(), &options, &Disk);
    let linked = compilation.link(thread(number), &options).expect("the program links");
    image::write(&linked).expect("it fits")
}

const COUNTER: &str = "int start = 5;\nint count;\nmain() { printf(\"%d %d\\n\", start++, count++); }\n";

/// Runs the program in thread 1 and returns its output.
fn execute(board: &mut Board) -> String {
    board.start(thread(1)).expect("a program is loaded");
    let mut text = Vec::new();
    board.run(Ticks::new(100_000), &mut |event| {
        if let EventKind::ConsoleLine(line) = event.kind {
            text.extend_from_slice(&line);
        }
    });
    String::from_utf8_lossy(&text).into_owned()
}

/// The bytes of the board's memory.
fn memory(board: &Board) -> Vec<u8> {
    let region = map::SDRAM;
    board.memory().read_bytes(region.base, region.size).expect("it is memory").to_vec()
}

/// Loads a modified image of [`COUNTER`] into a board that contains another program.
#[track_caller]
fn refused(change: impl FnOnce(&mut Image), expect: &str) {
    let mut image = Image::read(&build(COUNTER, 1)).expect("the image is good");
    change(&mut image);
    refused_bytes(&image.write().expect("it fits"), expect);
}

#[track_caller]
fn refused_bytes(bytes: &[u8], expect: &str) {
    let mut board: Board = Board::new(Config::default());
    board.load(thread(1), &build("main() { printf(\"kept\\n\"); }\n", 1)).expect("it loads");
    let before = memory(&board);
    let error = board.load(thread(1), bytes).expect_err("the image is refused").to_string();
    assert!(error.contains(expect), "{expect:?} in {error:?}");
    assert!(memory(&board) == before, "memory has changed: {error}");
    assert_eq!(execute(&mut board), "kept");
}

fn section<'a>(image: &'a mut Image, name: &str) -> &'a mut Section {
    image.sections.iter_mut().find(|section| section.name == *name).expect("the section exists")
}

#[test]
fn truncated_or_foreign_files_are_refused() {
    let whole = build(COUNTER, 1);
    for length in [0, 10, 30, 100, 300, whole.len() - 1] {
        refused_bytes(&whole[..length], "not a KFLOP image: ");
    }
    refused_bytes(b"MZ and so on, long enough", "not a KFLOP image: not a COFF2 image");
    refused_bytes(b"\x7fELF and so on, long enough", "not a KFLOP image: damaged ELF file");
    refused(|image| image.target = Target(0x14c), "code for target 332");
}

#[test]
fn images_not_linked_for_this_board_are_refused() {
    refused(|image| image.flags = FileFlags::LITTLE_ENDIAN, "not linked yet");
    let relocation = Relocation { address: 0, symbol: 0, displacement: 0, kind: 1 };
    refused(|image| section(image, ".text").relocations.push(relocation), "not linked yet");
    refused(|image| image.program = None, "the image has no entry point");
    let stamp =
        |stamp| move |image: &mut Image| image.program.as_mut().expect("it has one").version_stamp = stamp;
    refused(stamp(510), "linked against firmware of version 5.10; the board runs KFLOP 4.34");
    refused(stamp(0), "linked against firmware of an unknown version");
    refused(|image| image.program.as_mut().expect("it has one").entry += 8, "is not a function of the image");
    refused_bytes(&build(COUNTER, 2), "linked for thread 2, not for thread 1");
}

#[test]
fn sections_must_lie_inside_the_program_area_and_not_overlap() {
    let outside = "is outside the program area";
    refused(|image| section(image, ".data").address = 0x8004_0000, outside);
    refused(|image| section(image, ".data").address = 0x1001_0000, outside);
    refused(|image| section(image, ".bss").contents = Contents::Uninitialised(u32::MAX), outside);
    refused(|image| section(image, ".text").address += 0x100, outside);
    refused(|image| section(image, ".data").address = 0x8005_0040, "sections .text and .data overlap");
    refused(|image| image.sections.remove(0).lines.clear(), "the image has no section .text");
}

#[test]
fn code_that_the_machine_cannot_run_is_refused() {
    let text = |change: fn(&mut Vec<u8>)| {
        move |image: &mut Image| {
            if let Contents::Data(bytes) = &mut section(image, ".text").contents {
                change(bytes);
            }
        }
    };
    refused(text(|bytes| bytes[0] = 0xff), "the code is refused: ");
    refused(text(|bytes| bytes.truncate(20)), "the code is refused: ");
    refused(
        text(|bytes| bytes.iter_mut().rev().take(8).for_each(|byte| *byte = 0xff)),
        "the code is refused: ",
    );
    refused(text(Vec::clear), "the code is refused: ");
}

/// A loader that ignored the target would make the processor execute bytecode.
#[test]
fn a_processor_that_is_given_bytecode_returns_at_once() {
    let mut image = Image::read(&build(COUNTER, 1)).expect("the image is good");
    assert_eq!(image.program.expect("it has one").entry, section(&mut image, ".text").address);
    image.target = Target::C6000;
    let mut board: Board = Board::new(Config::default());
    board.load(thread(1), &image.write().expect("it fits")).expect("it is taken for the processor's code");
    assert_eq!(execute(&mut board), "");
    assert!(!board.thread(thread(1)).is_active());
}

#[test]
fn bytecode_that_a_processor_would_execute_is_refused() {
    let strip = |image: &mut Image| {
        if let Contents::Data(bytes) = &mut section(image, ".text").contents {
            bytes.drain(..vm::guard::BYTES);
        }
    };
    refused(strip, "the text begins with bytecode, where a real processor would begin to execute it");
}

#[test]
fn a_program_does_not_enter_the_space_of_another() {
    let mut board: Board = Board::new(Config::default());
    let large = build("char big[70000];\nmain() { printf(\"%d\\n\", big[69999]); }\n", 1);
    board.load(thread(2), &build(COUNTER, 2)).expect("it loads");
    let error = board.load(thread(1), &large).expect_err("thread 2 is taken").to_string();
    assert_eq!(error, "the program enters the space of thread 2, which holds another program");
    let mut board: Board = Board::new(Config::default());
    board.load(thread(1), &large).expect("thread 2 is free");
    assert_eq!(execute(&mut board), "0");
    let error = board.load(thread(2), &build(COUNTER, 2)).expect_err("thread 1 reaches there").to_string();
    assert_eq!(error, "the space of thread 2 is taken: the program of a lower thread reaches into it");
    board.load(thread(1), &build(COUNTER, 1)).expect("a program can replace its own");
    board.load(thread(2), &build(COUNTER, 2)).expect("the space is free again");
}

#[test]
fn sections_that_are_not_loaded_are_left_out() {
    let mut image = Image::read(&build(COUNTER, 1)).expect("the image is good");
    let data = section(&mut image, ".data").clone();
    for (name, address, flags) in [
        (".comment", 0, SectionFlags::COPY),
        (".dummy", data.address, SectionFlags::DSECT),
        (".kept", program_base(thread(7)).get(), SectionFlags::NOLOAD),
    ] {
        image.sections.push(Section { name: name.into(), address, flags, ..data.clone() });
    }
    let bytes = image.write().expect("it fits");
    let (mut board, mut plain): (Board, Board) =
        (Board::new(Config::default()), Board::new(Config::default()));
    board.load(thread(1), &bytes).expect("the others are ignored");
    plain.load(thread(1), &build(COUNTER, 1)).expect("it loads");
    assert!(memory(&board) == memory(&plain));
}

#[test]
fn a_load_resets_all_data_and_execution_resets_none() {
    let image = build(COUNTER, 1);
    let mut board: Board = Board::new(Config::default());
    board.load(thread(1), &image).expect("it loads");
    assert_eq!(execute(&mut board), "5 0");
    assert_eq!(execute(&mut board), "6 1");
    board.load(thread(1), &image).expect("it loads");
    assert_eq!(execute(&mut board), "5 0");
}

#[test]
fn uninitialised_data_can_hold_a_pattern() {
    let mut board: Board = Board::new(Config { bss_fill: 0xA5, ..Config::default() });
    board.load(thread(1), &build("int count;\nmain() { printf(\"%x\\n\", count); }\n", 1)).expect("it loads");
    assert_eq!(execute(&mut board), "a5a5a5a5");
}
