//! Programs that wait by polling do the same with and without shortcuts: output with its times, remarks, traces, memory
//! and threads, on both engines, in both modes of preemption, and from a snapshot on.
//!
//! A normal run takes a few programs. `CC67_PROGRAMS=1000` takes that many, `CC67_SEED=n` begins with another seed.

use std::path::Path;
use std::thread;

use compiler::target::Target;
use compiler::{Options, image};
use harness::polling;
use kmotiondef::timing::Timing;
use kmotiondef::{CodeAddr, ThreadId, Ticks};
use runtime::trace::TraceRequest;
use runtime::{Board, Config, Event, EventKind, MachineFile};
use vm::engine::{Engine, Preemption};
use vm::interp::BytecodeEngine;
use vm::machine::Config as MachineConfig;
use vm::thread::ThreadState;

/// The number of programs in a normal run, and the maximum in a long one.
const FEW: u64 = 5;
const MOST: u64 = 1000;

/// Programs that have shown a difference: a mathematical function ended a wait on only one of the engines.
const FOUND: &[u64] = &[205];

/// The board time of a run: 90 ms.
const LIMIT: Ticks = Ticks::new(1000);
/// The time of the snapshot.
const HALF: Ticks = Ticks::new(450);

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// All observations of a run.
#[derive(Debug, PartialEq)]
struct Seen {
    events: Vec<Event>,
    threads: Vec<(ThreadState, Vec<CodeAddr>)>,
    memory: u64,
}

fn compile(source: &str, thread: ThreadId) -> Vec<u8> {
    let options = Options { target: Target::Sim, ..Options::default() };
    let mut compilation =
        compiler::compile(Path::new("polls.c"), source.into(), &options, &compiler::pp::Disk);
    let linked = compilation.link(thread, &options);
    let linked = linked.unwrap_or_else(|| panic!("{:?}\n{source}", compilation.diagnostics()));
    image::write(&linked).expect("an image of a small program can be written")
}

/// A board that runs `images` in threads 1, 2 and so on.
fn board<E: Engine>(images: &[Vec<u8>], shortcuts: bool, preemption: Preemption) -> Board<E> {
    let machine = MachineConfig { shortcuts, preemption, ..MachineConfig::default() };
    let machine_file = MachineFile::parse(polling::MACHINE).expect("the machine file is correct");
    let mut board =
        Board::<E>::new(Config { machine, machine_file, timing: Timing::Fast, ..Config::default() });
    board.record(TraceRequest { quantities: Vec::new(), every: 1, changes: true, packets: None });
    for (thread, image) in ThreadId::all().zip(images) {
        board.load(thread, image).expect("what the compiler makes can be loaded");
        board.start(thread).expect("it was loaded");
    }
    board
}

fn finish<E: Engine>(mut events: Vec<Event>, board: &mut Board<E>) -> Seen {
    board.run(LIMIT, &mut |event| events.push(event));
    let threads =
        ThreadId::all().map(|thread| (board.thread(thread).clone(), board.machine().backtrace(thread)));
    Seen { threads: threads.collect(), memory: checksum(board), events }
}

/// A checksum of on-chip RAM and of the SDRAM for programs (FNV-1a by words).
fn checksum<E: Engine>(board: &Board<E>) -> u64 {
    let words = (0x1000_0000..0x1004_0000_u32).chain(0x8000_0000..0x8010_0000).step_by(4);
    words.fold(0xcbf2_9ce4_8422_2325, |sum, address| {
        let word: u32 = board.memory().peek(kmotiondef::GuestAddr::new(address));
        (sum ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Runs the programs on one engine with and without shortcuts; returns the observations, and the executed cycles with
/// and without them.
fn run<E: Engine>(seed: u64, images: &[Vec<u8>], preemption: Preemption) -> (Seen, [u64; 2]) {
    let mut plain = board::<E>(images, false, preemption);
    let expected = finish(Vec::new(), &mut plain);
    let mut quick = board::<E>(images, true, preemption);
    let mut events = Vec::new();
    quick.run_part(HALF, &mut |event| events.push(event));
    let snapshot = quick.snapshot();
    let seen = finish(events.clone(), &mut quick);
    assert_same(seed, &expected, &seen, preemption, "shortcuts");
    let work = [quick.machine().work(), plain.machine().work()];
    quick.restore(&snapshot).expect("it is of the same board");
    assert_same(seed, &expected, &finish(events, &mut quick), preemption, "snapshot");
    (expected, work)
}

fn assert_same(seed: u64, expected: &Seen, seen: &Seen, preemption: Preemption, what: &str) {
    for (index, (expected, seen)) in expected.events.iter().zip(&seen.events).enumerate() {
        assert_eq!(expected, seen, "seed {seed}, event {index}, {preemption:?}, {what}");
    }
    let more = |few: &[Event], many: &[Event]| many.get(few.len()).cloned();
    assert_eq!(more(&seen.events, &expected.events), None, "seed {seed}, {preemption:?}, {what}");
    assert_eq!(more(&expected.events, &seen.events), None, "seed {seed}, {preemption:?}, {what}");
    assert_eq!(expected.threads, seen.threads, "seed {seed}, {preemption:?}, {what}");
    assert!(expected.memory == seen.memory, "seed {seed}, {preemption:?}, {what}: memory differs");
}

/// Compares the programs for `seeds`; returns the executed cycles with and without shortcuts.
fn compare(seeds: &[u64]) -> [u64; 2] {
    let mut all = [0; 2];
    for seed in seeds {
        let sources = polling::programs(*seed);
        let images: Vec<_> =
            ThreadId::all().zip(&sources).map(|(thread, source)| compile(source, thread)).collect();
        for preemption in [Preemption::Segments, Preemption::Instructions] {
            let (bytecode, work) = run::<BytecodeEngine>(*seed, &images, preemption);
            all = [all[0] + work[0], all[1] + work[1]];
            #[cfg(feature = "native")]
            {
                let (native, _) = run::<vm::native::NativeEngine>(*seed, &images, preemption);
                assert_same(*seed, &bytecode, &native, preemption, "engines");
            }
            #[cfg(not(feature = "native"))]
            drop(bytecode);
        }
    }
    all
}

#[test]
fn polling_programs_do_the_same_without_shortcuts() {
    let (first, count) = (number("CC67_SEED", 1), number("CC67_PROGRAMS", FEW).min(MOST));
    let seeds: Vec<u64> = FOUND.iter().copied().chain(first..first + count).collect();
    let workers = thread::available_parallelism().map_or(1, |workers| workers.get());
    let share = seeds.len().div_ceil(workers).max(1);
    let works: Vec<[u64; 2]> = thread::scope(|scope| {
        let handles: Vec<_> = seeds.chunks(share).map(|seeds| scope.spawn(move || compare(seeds))).collect();
        handles.into_iter().map(|handle| handle.join().expect("the programs do the same")).collect()
    });
    let [with, without] = [0, 1].map(|index| works.iter().map(|work| work[index]).sum::<u64>());
    println!("seeds {first} to {}: {with} cycles executed of {without}", first + count - 1);
    assert!(4 * with < 3 * without, "the loops are not passed over: {with} cycles of {without}");
}

/// A move of two seconds.
const MOVE: &str = "\
#include \"KMotionDef.h\"
main()
{
    ch0->InputMode = NO_INPUT_MODE; ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000; ch0->Accel = 100000; ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 18000);
    while (CONDITION) ;
    printf(\"done\\n\");
}
";

fn waits_in_few_cycles<E: Engine>(condition: &str) {
    let image = compile(&MOVE.replace("CONDITION", condition), ThreadId::all().next().expect("thread 1"));
    let mut board = board::<E>(&[image], true, Preemption::Segments);
    let mut events = Vec::new();
    board.run(Ticks::new(30_000), &mut |event| events.push(event));
    let done = EventKind::ConsoleLine(b"done".to_vec());
    assert!(events.iter().any(|event| event.kind == done), "{condition}: the wait does not end");
    // The elapsed time is 400 million cycles; 22,000 ticks count as 500 each.
    let work = board.machine().work();
    assert!(work < 25_000_000, "{condition}: {work} cycles");
}

#[test]
fn a_wait_takes_little_work() {
    for condition in [
        "!CheckDone(0)",
        "!CheckDoneXYZABC()",
        "ch0->Dest < 17990",
        "!ReadBit(1030) && !CheckDone(0)",
        "Time_sec() < 2.0",
        "Time_sec() - 1.0 < 1.0 && !ReadBit(1030)",
    ] {
        waits_in_few_cycles::<BytecodeEngine>(condition);
        #[cfg(feature = "native")]
        waits_in_few_cycles::<vm::native::NativeEngine>(condition);
    }
}
