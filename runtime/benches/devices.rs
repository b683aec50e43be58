//! The cost of the simulated world: a tick of a board whose program toggles a bit in every second tick.
//!
//! `devices/none`: no device is attached, nothing is recorded. `devices/wire`: an input follows the bit.
//! `devices/stimulus`: a stimulus waits for an edge of another bit. `devices/trace`: every edge and slice is recorded.
//! An element is one tick.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
use kmotiondef::map::program_base;
use kmotiondef::{ThreadId, Ticks};
use runtime::stimulus::Stimulus;
use runtime::trace::TraceRequest;
use runtime::{Board, Config};
use vm::machine::Config as MachineConfig;
use vm::text::assemble;
use vm::verify::verify;

/// The number of ticks in a measurement.
const TICKS: u64 = 1000;
/// First word of the program after its header.
const MAIN: usize = 4;

/// A program that sets and clears bit 8 about five times in each of its slices, forever.
fn program() -> String {
    let address = |name: &str| FIRMWARE_FUNCTIONS[function_named(name).expect(name)].address.get();
    let (set, clear) = (address("SetBit"), address("ClearBit"));
    format!(
        "program 1, 0\nsig 0, 0\nsig 1, 0\ntypes 0\n@main: func sig0, 2, 0\ntypes 0xc\n\
         @loop: charge 2000\nconst_i32 r0, 8\narg_i32 r0, 0\ncall_fw sig1, {set:#x}\ncharge 20\narg_i32 r0, 0\n\
         call_fw sig1, {clear:#x}\ncharge 20\nbr @loop"
    )
}

/// A board that runs the program.
fn board() -> Board {
    let machine = MachineConfig { shortcuts: false, ..MachineConfig::default() };
    let mut board: Board = Board::new(Config { machine, ..Config::default() });
    let thread = ThreadId::new(1).expect("1 is a thread");
    let text = assemble(&program()).unwrap_or_else(|error| panic!("{error}"));
    let program = verify(&text, program_base(thread)).unwrap_or_else(|error| panic!("{error}"));
    let entry = program.address_of(MAIN).as_guest_addr();
    board.memory_mut().poke_bytes(program_base(thread), &text).expect("mapped");
    board.load_program(thread, program, entry);
    board.start(thread).expect("loaded");
    board
}

/// A board with a stimulus.
fn board_with(stimulus: &str) -> Board {
    let mut board = board();
    board.play(Stimulus::parse(stimulus, "bench").unwrap_or_else(|error| panic!("{error}")));
    board
}

fn devices(criterion: &mut Criterion) {
    let mut traced = board();
    traced.record(TraceRequest { quantities: Vec::new(), every: 1, changes: true, packets: None });
    let boards = [
        ("none", board()),
        ("wire", board_with("device wire from=8 to=12")),
        ("stimulus", board_with("when bit 9 rises pulse bit 12")),
        ("trace", traced),
    ];
    let mut group = criterion.benchmark_group("devices");
    group.throughput(Throughput::Elements(TICKS));
    for (name, mut board) in boards {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let end = Ticks::new(board.tick().get() + TICKS);
                black_box(board.run_part(end, &mut |event| drop(black_box(event))))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, devices);
criterion_main!(benches);
