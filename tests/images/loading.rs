//! The memory that a load writes and that a second execution finds: section 1.6 of the dialect.

use std::path::Path;

use coff::{Contents, Image, Name};
use compiler::pp::MemoryFiles;
use compiler::{Options, compile};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, Event, EventKind, MachineFile};

/// Counts its runs in an initialised and in an uninitialised global.
const COUNTER: &str =
    "#include \"KMotionDef.h\"\nint set = 5, unset;\nmain() { printf(\"%d %d\\n\", set++, unset++); }\n";

/// Shows a byte of each of its uninitialised objects.
const UNSET: &str = "#include \"KMotionDef.h\"\nint unset;\nchar text[3];\nmain() { static char local; printf(\"%x %x %x\\n\", unset, text[2] & 0xff, local & 0xff); unset = 7; }\n";

fn first_thread() -> ThreadId {
    ThreadId::new(1).expect("there is a thread 1")
}

fn image_of(source: &str) -> Vec<u8> {
    let options = Options::default();
    let mut compilation = compile(Path::new("a.c"), source.into(), &options, &MemoryFiles::new());
    let linked = compilation.link(first_thread(), &options);
    let linked = linked.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics()));
    compiler::image::write(&linked).expect("the image can be written")
}

fn load(board: &mut Board, image: &[u8]) {
    board.load(first_thread(), image).expect("the image is loaded");
}

/// Executes the loaded program and returns its line of output.
fn execute(board: &mut Board) -> String {
    let mut lines = Vec::new();
    board.start(first_thread()).expect("a program is loaded");
    let limit = Ticks::new(board.tick().get() + 10_000);
    board.run(limit, &mut |event: Event| {
        if let EventKind::ConsoleLine(line) = event.kind {
            lines.push(String::from_utf8_lossy(&line).into_owned());
        }
    });
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines.remove(0)
}

#[test]
fn a_load_zeroes_bss_and_rewrites_data() {
    let (mut board, image) = (Board::new(Config::default()), image_of(COUNTER));
    load(&mut board, &image);
    assert_eq!([execute(&mut board), execute(&mut board)], ["5 0", "6 1"]);
    load(&mut board, &image);
    assert_eq!([execute(&mut board), execute(&mut board)], ["5 0", "6 1"]);
}

#[test]
fn another_byte_can_fill_bss() {
    let mut board: Board = Board::new(Config { bss_fill: 0xa5, ..Config::default() });
    load(&mut board, &image_of(UNSET));
    assert_eq!(execute(&mut board), "a5a5a5a5 a5 a5");
}

/// A board with a machine file.
fn board(machine: &str) -> Board {
    let machine_file = MachineFile::parse(machine).unwrap_or_else(|error| panic!("{error}"));
    Board::new(Config { machine_file, ..Config::default() })
}

#[test]
fn a_machine_file_can_reset_globals_at_each_start() {
    let mut board = board("[cpu]\nfresh_globals = true");
    load(&mut board, &image_of(COUNTER));
    assert_eq!([execute(&mut board), execute(&mut board)], ["5 0", "5 0"]);
}

#[test]
fn a_machine_file_says_how_fast_programs_run() {
    // Iterations of a loop without a call in a millisecond.
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int n = 0;\n  double end = ServoTick + 11;\n  \
                  while (ServoTick < end) n++;\n  printf(\"%d\\n\", n);\n}\n";
    let image = image_of(source);
    let turns = |machine: &str| -> f64 {
        let mut board = board(machine);
        load(&mut board, &image);
        execute(&mut board).parse().expect("a number")
    };
    let usual = turns("");
    for (machine, factor) in
        [("[cpu]\nns_per_instruction = 10", 0.5), ("[cpu]\nns_per_instruction = 50", 0.1)]
    {
        let ratio = turns(machine) / usual;
        assert!((ratio / factor - 1.0).abs() < 0.03, "{machine}: {ratio}");
    }
    assert_eq!(turns("[cpu]\nns_per_instruction = 5"), usual);
}

#[test]
fn a_machine_file_says_how_long_a_motion_is_planned() {
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  double begin;\n  EnableAxisDest(0, 0);\n  \
                  begin = ServoTick;\n  Move(0, 100);\n  while (ch0->Dest == 0) ;\n  \
                  printf(\"%.0f\\n\", ServoTick - begin);\n}\n";
    let image = image_of(source);
    let ticks = |machine: &str| -> f64 {
        let mut board = board(machine);
        load(&mut board, &image);
        execute(&mut board).parse().expect("a number")
    };
    let late = ticks("[cpu]\nplan_ticks = 26") - ticks("");
    assert!((25.0..=28.0).contains(&late), "{late}");
}

#[test]
fn an_image_without_bss_leaves_that_memory_alone() {
    let mut image = Image::read(&image_of(UNSET)).expect("our own image is readable");
    image.sections.retain(|section| section.name != Name::new(b".bss"));
    image.symbols.clear();
    assert!(image.sections.iter().all(|section| matches!(section.contents, Contents::Data(_))));
    let image = image.write().expect("it can be written");
    let mut board = Board::new(Config::default());
    load(&mut board, &image);
    assert_eq!(execute(&mut board), "0 0 0");
    load(&mut board, &image);
    assert_eq!(execute(&mut board), "7 0 0");
}
