//! Threads that trap deep inside calls, call-backs that trap, and threads that are killed leave nothing allocated:
//! neither memory nor native stacks.

use std::fs;
use std::path::Path;

use compiler::{Options, image};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, EventKind};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;

use crate::{MEMORY, alone};

/// Programs that end with an error, or not at all; each runs for some ticks and is then killed.
const PROGRAMS: [(&str, &str); 5] = [
    (
        "overflow",
        "int deep(int n) { int a[8]; a[n & 7] = n; return deep(n + 1) + a[n & 3]; } main() { deep(0); }",
    ),
    ("wild", "int deep(int n) { return n ? deep(n - 1) + n : *(int *)0x70000000; } main() { deep(300); }"),
    ("killed", "int deep(int n) { while (n > 300) ; return deep(n + 1) + 1; } main() { deep(0); }"),
    (
        "waiting",
        "int deep(int n) { if (n > 300) Delay_sec(1000); return deep(n + 1) + 1; } main() { deep(0); }",
    ),
    (
        "callback",
        "int deep(int n) { return n ? deep(n - 1) + n : 7 / n; } void back(void) { deep(100); }\n\
                  main() { UserCallBack = back; for (;;) ; }",
    ),
];

fn compile(name: &str, source: &str) -> Vec<u8> {
    let options = Options::default();
    let source = format!("#include \"KMotionDef.h\"\n{source}\n");
    let files = compiler::pp::Disk;
    let mut compilation = compiler::compile(Path::new(name), source.into(), &options, &files);
    let linked = compilation.link(thread(), &options);
    let linked = linked.unwrap_or_else(|| panic!("{name}: {:?}", compilation.diagnostics()));
    image::write(&linked).expect("an image of a small program can be written")
}

fn thread() -> ThreadId {
    ThreadId::new(1).expect("there is a thread 1")
}

/// The number of allocated bytes, and of mapped memory ranges if the operating system reports them.
fn held() -> (usize, usize) {
    let maps = fs::read_to_string("/proc/self/maps").map_or(0, |maps| maps.lines().count());
    (MEMORY.current_usage(), maps)
}

/// Runs each program `times` times on one board; returns the allocations after that, and the number of traps.
fn run<E: Engine>(board: &mut Board<E>, images: &[Vec<u8>], times: u32) -> (usize, usize, usize) {
    let mut traps = 0;
    for _ in 0..times {
        for image in images {
            board.load(thread(), image).expect("what the compiler makes can be loaded");
            board.start(thread()).expect("it is loaded");
            let end = Ticks::new(board.machine_mut().tick().get() + 25);
            board.run(end, &mut |event| traps += usize::from(matches!(event.kind, EventKind::Trap(_))));
            board.stop_threads([thread()]);
        }
    }
    let (bytes, maps) = held();
    (bytes, maps, traps)
}

fn check<E: Engine>(engine: &str) {
    let images = PROGRAMS.map(|(name, source)| compile(name, source));
    let before = held();
    let mut board: Board<E> = Board::new(Config::default());
    let (bytes, maps, _) = run(&mut board, &images, 20);
    let (later_bytes, later_maps, traps) = run(&mut board, &images, 100);
    assert!(traps >= 300, "{engine}: {traps} traps of three programs run a hundred times");
    let grown = later_bytes.saturating_sub(bytes);
    println!("{engine}: 500 programs later {grown} bytes and {} maps more", later_maps.saturating_sub(maps));
    assert!(grown < 100_000, "{engine}: {grown} bytes more");
    assert!(later_maps <= maps + 8, "{engine}: {maps} ranges of memory, then {later_maps}");
    drop(board);
    let left = held().0.saturating_sub(before.0);
    assert!(left < 100_000, "{engine}: {left} bytes are left");
}

#[test]
fn programs_that_end_badly_leak_nothing() {
    let _alone = alone();
    check::<BytecodeEngine>("bytecode");
    #[cfg(feature = "native")]
    check::<vm::native::NativeEngine>("native");
}
