//! The past is reproduced exactly: a state reached backwards equals the one reached forwards, byte for byte.
//!
//! One debugger only goes forward and records the state of the whole board at random instants: memory, registers,
//! threads, kernel, devices, plant, files. Another runs to the end and goes back from instant to instant. `CC67_LONG=1`
//! takes more programs, more instants, and longer runs.

use std::path::PathBuf;

use cc67_debug::{Debugger, Reason};
use cc67_host::{Setup, UserProgram};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Event, EventKind, MachineFile};
use vm::engine::ContextId;

/// Programs: the machine on which they run, and the files for threads 1, 2, and so on. The first few are always tested.
const PROGRAMS: &[(&str, &[&str])] = &[
    ("", &["threads/relay.c", "threads/relay.c"]),
    ("gather/step_response.toml", &["gather/step_response.c"]),
    ("", &["threads/callback.c"]),
    ("machine/home.toml", &["machine/home.c"]),
    ("", &["motion/path.c"]),
    ("", &["motion/one_axis.c"]),
    ("", &["motion/feedhold.c"]),
    ("", &["motion/jog_bits.c", "motion/jog_panel.c"]),
    ("", &["motion/sequence.c"]),
    ("", &["motion/slave.c"]),
    ("", &["motion/soft_limits.c"]),
    ("", &["motion/following_error.c"]),
    ("machine/servo.toml", &["machine/servo.c"]),
    ("homing/index.toml", &["homing/index.c"]),
    ("", &["threads/mutex.c", "threads/mutex_adder.c"]),
    ("", &["threads/pause.c", "threads/pause_counter.c"]),
    ("", &["threads/rerun.c", "threads/rerun_part.c"]),
    ("", &["threads/slices.c", "threads/slices_companion.c", "threads/slices_companion.c"]),
    ("", &["threads/watchdog.c", "threads/watchdog_job.c"]),
    ("", &["host/variables.c"]),
];

/// The extent of a test.
struct Extent {
    programs: usize,
    instants: u64,
    /// The length of a run in ticks.
    ticks: u64,
    /// The work between snapshots: so little that snapshots are dropped, some of them while going back.
    interval: u64,
}

fn extent() -> Extent {
    if std::env::var_os("CC67_LONG").is_some() {
        Extent { programs: PROGRAMS.len(), instants: 200, ticks: 8000, interval: 40_000 }
    } else {
        Extent { programs: 5, instants: 10, ticks: 900, interval: 500 }
    }
}

/// A pseudo-random number generator with the same numbers in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

/// An instant: a number of instructions of a thread after the end of a tick.
struct Instant {
    tick: Ticks,
    thread: ThreadId,
    steps: u64,
    /// The board at the end of the tick, and after the steps if the thread had the processor soon enough.
    at_tick: String,
    at_step: Option<String>,
    /// The number of console lines until then.
    lines: usize,
}

fn debugger(machine: &str, files: &[&str], interval: u64) -> Debugger {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../c-programs");
    let mut setup = Setup::default();
    if !machine.is_empty() {
        let text = std::fs::read_to_string(folder.join(machine)).expect("it is part of the repository");
        setup.config.machine_file = MachineFile::parse(&text).expect("it is right");
    }
    for (file, thread) in files.iter().zip(ThreadId::all()) {
        let program = UserProgram::compile(&folder.join(file), thread, &setup.options).expect("it compiles");
        setup.programs.push(program.started());
    }
    let mut debugger = Debugger::new(setup.session().expect("a board"), Ticks::new(1_000_000));
    debugger.catches.no_traps = true;
    debugger.keep_every(interval);
    debugger
}

/// The whole state of the board, as text.
fn state(debugger: &mut Debugger) -> String {
    format!("{:?}", debugger.snapshot())
}

/// Executes instructions of a thread; returns whether it had executed them within a few ticks.
fn step(debugger: &mut Debugger, thread: ThreadId, steps: u64, lines: &mut Vec<String>) -> bool {
    debugger.select(thread, 0).expect("there is such a thread");
    if !debugger.session().thread(thread).is_active() {
        return false;
    }
    (0..steps).all(|_| {
        let stop = debugger.step_instruction(&mut |event| note(event, lines));
        stop.is_ok_and(|stop| stop.reason == Reason::Step && stop.context == Some(ContextId::of(thread)))
    })
}

fn note(event: &Event, lines: &mut Vec<String>) {
    if let EventKind::ConsoleLine(line) = &event.kind {
        lines.push(String::from_utf8_lossy(line).into_owned());
    }
}

/// Only goes forward.
fn forwards(debugger: &mut Debugger, extent: &Extent, numbers: &mut Numbers) -> (Vec<Instant>, Vec<String>) {
    let mut ticks: Vec<_> = (0..extent.instants).map(|_| 1 + numbers.below(extent.ticks)).collect();
    ticks.sort_unstable();
    let mut lines = Vec::new();
    let mut instants: Vec<Instant> = Vec::new();
    for tick in ticks {
        if debugger.session().tick() >= Ticks::new(tick) {
            continue;
        }
        debugger.run_to(Ticks::new(tick), &mut |event| note(event, &mut lines));
        let active: Vec<_> =
            ThreadId::all().filter(|thread| debugger.session().thread(*thread).is_active()).collect();
        let thread = active.get(numbers.below(active.len().max(1) as u64) as usize);
        let thread = thread.copied().or_else(|| ThreadId::new(1)).expect("there are 7");
        let (steps, before) = (1 + numbers.below(12), lines.len());
        let at_tick = state(debugger);
        let at_step = step(debugger, thread, steps, &mut lines).then(|| state(debugger));
        instants.push(Instant { tick: Ticks::new(tick), thread, steps, at_tick, at_step, lines: before });
    }
    debugger.run_to(Ticks::new(extent.ticks), &mut |event| note(event, &mut lines));
    (instants, lines)
}

/// Shows the differences of two texts.
fn assert_same(expect: &str, found: &str, what: &str) {
    if expect != found {
        let at = expect.bytes().zip(found.bytes()).take_while(|(one, other)| one == other).count();
        let around = |text: &str| {
            let bytes = &text.as_bytes()[at.saturating_sub(200)..(at + 100).min(text.len())];
            String::from_utf8_lossy(bytes).into_owned()
        };
        panic!("{what}:\nforwards:  {}\nbackwards: {}", around(expect), around(found));
    }
}

/// Compares instants within a tick, and returns their number.
fn compare(machine: &str, files: &[&str], extent: &Extent, numbers: &mut Numbers) -> usize {
    let (instants, lines) = forwards(&mut debugger(machine, files, extent.interval), extent, numbers);
    let mut back = debugger(machine, files, extent.interval);
    back.run_to(Ticks::new(extent.ticks), &mut |_| ());
    let mut compared = 0;
    for instant in instants.iter().rev() {
        let what = format!("{files:?} after tick {}", instant.tick.get());
        back.go_to(instant.tick).expect("it is in the past");
        assert_same(&instant.at_tick, &state(&mut back), &what);
        let Some(at_step) = &instant.at_step else { continue };
        // One more instruction, so that the last step is one back.
        if step(&mut back, instant.thread, instant.steps + 1, &mut Vec::new()) {
            back.reverse_step_instruction();
            let what = format!("{what}, {} instructions of thread {}", instant.steps, instant.thread);
            assert_same(at_step, &state(&mut back), &what);
            compared += 1;
        }
    }
    // From the earliest instant, the rest is reported again.
    let first = &instants[0];
    back.go_to(first.tick).expect("it is in the past");
    let mut again = Vec::new();
    back.run_to(Ticks::new(extent.ticks), &mut |event| note(event, &mut again));
    assert_eq!(lines[first.lines..], again, "{files:?}");
    compared
}

#[test]
fn a_state_reached_backwards_equals_the_one_reached_forwards() {
    let extent = extent();
    let mut within = 0;
    for (number, (machine, files)) in PROGRAMS.iter().take(extent.programs).enumerate() {
        let compared = compare(machine, files, &extent, &mut Numbers(number as u64 + 1));
        println!("{files:?}: the same at {} instants, {compared} of them within a tick", extent.instants);
        within += compared;
    }
    assert!(within > 0, "no instant within a tick was compared");
}
