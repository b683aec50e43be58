//! The cost of a tick: the servo with no other work. An element is one tick of 90 µs.
//!
//! `servo/moving/8`: eight servo axes with encoders, jogging. `servo/still/3`: three of them at rest. `servo/idle`: no
//! axis is enabled. Shortcuts are off, so that no tick is skipped.
//!
//! Processor time is measured if the operating system reports it, so that a busy machine does not distort the result.
//! Goal: 2,000,000 ticks per second with eight moving axes, 5,000,000 with three axes at rest.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
use kmotiondef::map::program_base;
use kmotiondef::modes::OutputMode;
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::CHAN;
use kmotiondef::{Field, ThreadId, Ticks};
use runtime::{Board, Config};
use vm::machine::Config as MachineConfig;
use vm::text::assemble;
use vm::thread::ThreadState;
use vm::verify::verify;

/// The number of ticks in a measurement.
const TICKS: u64 = 1000;
/// First word of the program after its header.
const MAIN: usize = 5;

/// A program that calls a firmware function with each axis number and the value in the pool.
fn program(name: &str, axes: u64, value: f64) -> String {
    let address = FIRMWARE_FUNCTIONS[function_named(name).expect(name)].address.get();
    let head = format!("program 1, 1\nword {:#x}\nsig 0, 0\nsig 2, 0\ntypes 0xc\n", value.to_bits());
    let call = |axis| {
        format!(
            "charge 20\nconst_i32 r0, {axis}\nconst_f64 d1, pool[0]\narg_i32 r0, 0\narg_f64 d1, 1\n\
             call_fw sig1, {address:#x}\n"
        )
    };
    let calls: String = (0..axes).map(call).collect();
    format!("{head}@main: func sig0, 2, 0\ntypes 0xc\n{calls}charge 2\nret")
}

/// Runs a program to its end.
fn call(board: &mut Board, name: &str, axes: u64, value: f64) {
    let thread = ThreadId::new(1).expect("1 is a thread");
    let text = assemble(&program(name, axes, value)).unwrap_or_else(|error| panic!("{error}"));
    let program = verify(&text, program_base(thread)).unwrap_or_else(|error| panic!("{error}"));
    let entry = program.address_of(MAIN).as_guest_addr();
    board.memory_mut().poke_bytes(program_base(thread), &text).expect("mapped");
    board.load_program(thread, program, entry);
    board.start(thread).expect("loaded");
    run(board, 20);
    assert_eq!(*board.thread(thread), ThreadState::Ready, "{name}");
}

/// Lets this many ticks pass.
fn run(board: &mut Board, ticks: u64) {
    let end = Ticks::new(board.tick().get() + ticks);
    board.machine_mut().run_until(end);
}

/// A board with the first axes enabled as servos with a filter and feed forward.
fn board(axes: u64) -> Board {
    let machine = MachineConfig { shortcuts: false, ..MachineConfig::default() };
    let mut board = Board::new(Config { machine, host: false, ..Config::default() });
    for axis in 0..axes {
        let chan = CHAN.element(axis as usize);
        let mut set = |field: Field<f32>, value: f32| {
            board.memory_mut().poke(chan.field(field).address(), value);
        };
        set(Chan::I, 0.001);
        set(Chan::D, 10.0);
        set(Chan::FF_VEL, 0.01);
        let filter = Chan::IIR.element(0);
        for (field, value) in [(Iir::A1, 1.5), (Iir::A2, -0.6), (Iir::B0, 0.05), (Iir::B1, 0.05)] {
            set(filter.field(field), value);
        }
        board.memory_mut().poke(chan.field(Chan::OUTPUT_MODE).address(), OutputMode::DcServo.get());
    }
    if axes > 0 {
        call(&mut board, "EnableAxisDest", axes, 0.0);
    }
    board
}

/// The processor time of this process.
struct CpuTime;

/// The processor time so far, if the operating system reports it.
fn on_cpu() -> Option<Duration> {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
    }
    #[cfg(not(unix))]
    None
}

impl Measurement for CpuTime {
    type Intermediate = (Option<Duration>, Instant);
    type Value = Duration;

    fn start(&self) -> Self::Intermediate {
        (on_cpu(), WallTime.start())
    }

    fn end(&self, (before, start): Self::Intermediate) -> Duration {
        match (before, on_cpu()) {
            (Some(before), Some(now)) => now.saturating_sub(before),
            _ => WallTime.end(start),
        }
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        WallTime.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

fn servo(criterion: &mut Criterion<CpuTime>) {
    let mut group = criterion.benchmark_group("servo");
    group.throughput(Throughput::Elements(TICKS));
    let mut measure = |name: &str, mut board: Board| {
        group.bench_function(name, |bencher| bencher.iter(|| run(black_box(&mut board), TICKS)));
    };
    let mut moving = board(8);
    call(&mut moving, "Jog", 8, 5000.0);
    measure("moving/8", moving);
    let mut still = board(3);
    run(&mut still, 100_000);
    measure("still/3", still);
    measure("idle", board(0));
}

criterion_group!(name = benches; config = Criterion::default().with_measurement(CpuTime); targets = servo);
criterion_main!(benches);
