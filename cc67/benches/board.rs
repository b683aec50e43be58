//! The time from an image to a running program: reading, loading, translating, running, calling the firmware.
//!
//! `image/read/...`: converts bytes to an image. `load/...`: loads an image as a program in a thread, with all checks
//! and the first tick, before which the native engine translates it. `execute/...`: a program that computes, and one
//! that calls the firmware or one of its own functions through a pointer in each iteration, so that the difference is
//! the cost of a call.
//!
//! `cargo bench -p cc67 --bench board`

use std::hint::black_box;
use std::path::Path;

use coff::Image;
use compiler::pp::Disk;
use compiler::{Options, firmware, image};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, RunEnd};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
#[cfg(feature = "native")]
use vm::native::NativeEngine;

/// The number of calls in a run.
const CALLS: u64 = 100_000;

fn thread() -> ThreadId {
    ThreadId::new(1).expect("1 is a thread")
}

fn compile(path: &Path, text: Vec<u8>) -> Vec<u8> {
    let options = Options::default();
    let linked = compiler::compile(path, text, &options, &Disk).link(thread(), &options);
    image::write(&linked.expect("the program of a bench is correct")).expect("it fits")
}

fn program(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../c-programs").join(name);
    let text = std::fs::read(&path).expect("it is part of the repository");
    compile(&path, text)
}

/// A program that repeats a statement this many times.
fn repeat(what: &str) -> Vec<u8> {
    let text = format!(
        "#include \"KMotionDef.h\"\nint state;\nint own(int bit) {{ return state >> bit & 1; }}\n\
         int (*called)(int) = own;\n\
         main() {{ int i, n = 0; for (i = 0; i < {CALLS}; i++) {{ {what}; }} state = n; }}\n"
    );
    compile(Path::new("repeat.c"), text.into_bytes())
}

fn images(c: &mut Criterion) {
    let files = [
        ("program", program("motion/path.c")),
        ("firmware", firmware::export(kmotiondef::boards::TargetBoard::default_board()).expect("it fits")),
    ];
    let mut group = c.benchmark_group("image/read");
    for (name, bytes) in files {
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        group.bench_function(name, |b| b.iter(|| Image::read(black_box(&bytes))));
    }
    group.finish();
}

fn load<E: Engine>(c: &mut Criterion, engine: &str) {
    let image = program("motion/path.c");
    let mut board = Board::<E>::new(Config::default());
    c.bench_function(&format!("load/{engine}/path"), |b| {
        b.iter(|| {
            board.load(thread(), black_box(&image)).expect("it is an image");
            board.start(thread()).expect("it is loaded");
            let limit = Ticks::new(board.tick().get() + 2);
            board.run(limit, &mut |event| drop(black_box(event)))
        });
    });
}

/// A run from the start of the program to its end.
fn execute<E: Engine>(c: &mut Criterion, engine: &str) {
    let programs = [
        ("nothing", repeat("n += i")),
        ("firmware", repeat("n += ReadBit(i & 31)")),
        ("function", repeat("n += called(i & 31)")),
    ];
    let mut group = c.benchmark_group(format!("execute/{engine}"));
    group.throughput(Throughput::Elements(CALLS)).sample_size(20);
    for (name, image) in programs {
        let mut board = Board::<E>::new(Config::default());
        board.load(thread(), &image).expect("it is an image");
        group.bench_function(name, |b| {
            b.iter(|| {
                board.start(thread()).expect("it is loaded");
                let limit = Ticks::new(board.tick().get() + 1_000_000);
                assert_eq!(board.run(limit, &mut |event| drop(black_box(event))), RunEnd::AllEnded);
            });
        });
    }
    group.finish();
}

fn engines(c: &mut Criterion) {
    load::<BytecodeEngine>(c, "bytecode");
    execute::<BytecodeEngine>(c, "bytecode");
    #[cfg(feature = "native")]
    {
        load::<NativeEngine>(c, "native");
        execute::<NativeEngine>(c, "native");
    }
}

criterion_group!(benches, images, engines);
criterion_main!(benches);
