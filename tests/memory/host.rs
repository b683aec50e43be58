//! Console lines pass through the host interface in bounded memory.

use std::sync::mpsc;

use cc67_host::Board;
use harness::Scratch;

use crate::{MEMORY, alone};

#[test]
fn a_million_lines_arrive_in_order_and_in_bounded_memory() {
    let _alone = alone();
    let source = "#include \"KMotionDef.h\"\nmain()\n{\n  int i;\n  for (i = 0; i < 1000000; i++) printf(\"line %d\\n\", i);\n}\n";
    let scratch = Scratch::new("host-million");
    scratch.write("a.c", source);
    let mut board = Board::new();
    board.compile_and_load_coff(&scratch.path().join("a.c"), 1).expect("the program is right");
    board.write_line("Execute1").expect("it is connected");
    let (sender, count) = mpsc::channel();
    let mut next = 0;
    board.set_console_callback(move |line| {
        assert_eq!(line, format!("line {next}"));
        next += 1;
        if next % 100_000 == 0 {
            sender.send(next).expect("it is awaited");
        }
    });
    board.run_for(1.0);
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let is_done = |session: &mut cc67_host::Session<cc67_host::AnyTarget>| session.has_ended();
    assert!(board.run_until(200.0, is_done), "two periods of 90 µs for each line are 180 s");
    assert_eq!(count.try_iter().last(), Some(1_000_000));
    let growth = MEMORY.peak_usage().saturating_sub(before);
    println!("memory grew by {growth} bytes");
    assert!(growth < 1 << 20, "memory grew by {growth} bytes");
}
