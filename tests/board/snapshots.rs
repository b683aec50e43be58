//! A board can return to any time, and continues from there as it did then, on all engines.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use cc67_host::{Session, Setup, UserProgram};
use compiler::target::Target;
use harness::random::Random;
use harness::root;
use kmotiondef::{Cycles, ThreadId, Ticks};
use runtime::stimulus::Stimulus;
use runtime::{Board, Event, MachineFile};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::memory::GuestMemory;
use vm::native::NativeEngine;

/// Programs of `c-programs/`; together they use motors, switches, a gantry, a spindle, option boards, the serial port,
/// a call-back, several threads, flash, recordings and a path of the coordinate system.
const PROGRAMS: [&str; 21] = [
    "flash/start_up",
    "gather/log",
    "homing/gantry",
    "homing/home3",
    "homing/index",
    "homing/probe",
    "host/message",
    "io/debounce",
    "io/estop",
    "kanalog/terminal",
    "konnect/panel",
    "machine/thread",
    "motion/path",
    "motion/slave",
    "plasma/pierce",
    "resolver/excite",
    "serial/modbus",
    "spindle/orient",
    "threads/callback",
    "threads/mutex",
    "util/recover",
];

/// The number of snapshot times in a program: random ones between power-up and the tick of its end.
const INSTANTS: usize = 10;

/// The maximum number of ticks for a program: 1.8 s.
const LONGEST: u64 = 20_000;

/// A program with its associated files, and with the programs that its first line names for other threads.
fn setup(name: &str, target: Target) -> Setup {
    let path = root().join("c-programs").join(name).with_extension("c");
    let beside = |suffix: &str| fs::read_to_string(path.with_extension(suffix)).ok();
    let mut setup = Setup::default();
    setup.options.target = target;
    if let Some(text) = beside("toml") {
        setup.config.machine_file = MachineFile::parse(&text).expect(name);
    }
    if let Some(text) = beside("stim") {
        setup.stimulus = Stimulus::parse(&text, name).expect(name);
    }
    let source = fs::read_to_string(&path).expect(name);
    let head: Vec<&str> = source.lines().next().unwrap_or_default().split(' ').collect();
    let also =
        head.windows(2).filter(|words| words[0] == "also").filter_map(|words| words[1].split_once(':'));
    load(&mut setup, 1, &path);
    for (number, other) in also {
        load(&mut setup, number.parse().expect(name), &path.with_file_name(other));
    }
    setup
}

/// Adds a program for a thread, to be started at power-up.
fn load(setup: &mut Setup, number: i32, path: &Path) {
    let thread = ThreadId::new(number).expect("a thread");
    let program = UserProgram::compile(path, thread, &setup.options).expect("it is right");
    setup.programs.push(program.started());
}

/// The state of a board: guest memory, the firmware with the servo, devices, loads and the PC as text, the threads, and
/// board time.
#[derive(PartialEq)]
struct Seen {
    memory: GuestMemory,
    firmware: String,
    threads: String,
    now: Cycles,
}

fn seen<E: Engine>(session: &Session<Board<E>>) -> Seen {
    let machine = session.target().machine();
    let places: Vec<_> = ThreadId::all().map(|thread| machine.backtrace(thread)).collect();
    Seen {
        memory: machine.memory().clone(),
        firmware: format!("{:?}", machine.firmware()),
        threads: format!("{:?} {:?} {places:x?}", machine.threads(), machine.turn()),
        now: session.now(),
    }
}

/// A run from its beginning or from a snapshot on: every event with its time, and the end.
struct Run {
    events: Vec<Event>,
    end: Seen,
}

impl Run {
    fn to<E: Engine>(session: &mut Session<Board<E>>, end: Ticks) -> Self {
        let mut events = Vec::new();
        session.advance(end, &mut |event| events.push(event));
        Self { events, end: seen(session) }
    }

    /// Checks that another run equals the last part of this one.
    fn check(&self, other: &Self, what: &str) {
        let first = self.events.len().checked_sub(other.events.len());
        let events = first.map(|first| &self.events[first..]);
        assert!(events == Some(&other.events[..]), "{what}: events {events:?}, {:?}", other.events);
        assert_eq!(self.end.now, other.end.now, "{what}");
        assert_eq!(self.end.threads, other.end.threads, "{what}");
        assert!(self.end.firmware == other.end.firmware, "{what}: the firmware differs");
        assert!(self.end.memory == other.end.memory, "{what}: memory differs");
    }
}

/// Runs a program without interruption, then with snapshots at random times, and then from each of them.
fn check<E: Engine>(name: &str, target: Target, random: &mut Random) {
    let session = || setup(name, target).session_on(E::default()).expect(name);
    let mut straight = session();
    let mut events = Vec::new();
    let _ = straight.run(Ticks::new(LONGEST), &mut |event| events.push(event));
    let end = straight.tick();
    let whole = Run { events, end: seen(&straight) };
    drop(straight);

    let mut session = session();
    let mut instants: Vec<u64> = (0..INSTANTS).map(|_| random.draw() % end.get()).collect();
    instants.sort_unstable();
    let mut events = Vec::new();
    let kept: Vec<_> = instants
        .iter()
        .map(|tick| {
            session.advance(Ticks::new(*tick), &mut |event| events.push(event));
            (session.snapshot().expect("it has snapshots"), events.len())
        })
        .collect();
    let rest = Run::to(&mut session, end);
    events.extend(rest.events);
    whole.check(&Run { events, end: rest.end }, name);
    let count = whole.events.len();
    for (snapshot, before) in kept.iter().rev() {
        let what = format!("{name} from tick {}", snapshot.tick().get());
        session.restore(snapshot).expect("it is of this board");
        assert_eq!(session.tick(), snapshot.tick());
        // Runs for some ticks, and again from the same snapshot.
        let way = session.tick().get() + random.draw() % 50;
        session.advance(Ticks::new(way.min(end.get())), &mut |_| ());
        session.restore(snapshot).expect("it is of this board");
        let rest = Run::to(&mut session, end);
        assert_eq!(rest.events.len(), count - before, "{what}");
        whole.check(&rest, &what);
    }
}

fn check_all<E: Engine>(target: Target) {
    let mut random = Random::new(0x5EED_0019);
    for name in PROGRAMS {
        check::<E>(name, target, &mut random);
    }
}

#[test]
fn boards_resume_from_any_instant_on_the_interpreter() {
    check_all::<BytecodeEngine>(Target::Sim);
}

#[test]
fn boards_resume_from_any_instant_on_the_native_engine() {
    check_all::<NativeEngine>(Target::Sim);
}

#[test]
fn boards_with_real_code_resume_from_any_instant_interpreted() {
    check_all::<BytecodeEngine>(Target::C67x);
}

#[test]
fn boards_with_real_code_resume_from_any_instant_translated() {
    check_all::<NativeEngine>(Target::C67x);
}

#[test]
#[expect(clippy::disallowed_methods, reason = "measures what the host takes")]
fn a_snapshot_of_a_board_takes_little_time_and_memory() {
    let mut session =
        setup("machine/thread", Target::Sim).session_on(NativeEngine::default()).expect("it is right");
    session.advance(Ticks::new(5000), &mut |_| ());
    let first = session.snapshot().expect("it has snapshots");
    session.advance(Ticks::new(5100), &mut |_| ());
    let times = (0..20).map(|_| {
        let begin = Instant::now();
        let _ = session.snapshot().expect("it has snapshots");
        begin.elapsed()
    });
    let taken = times.min().expect("there are some");
    let second = session.snapshot().expect("it has snapshots");
    let begin = Instant::now();
    session.restore(&first).expect("it is of this board");
    println!("snapshot {taken:?}, back {:?}, {} bytes changed", begin.elapsed(), second.bytes_beyond(&first));
    // Many times the expected duration, for a busy computer.
    assert!(taken < Duration::from_millis(200), "{taken:?}");
    assert!(second.bytes_beyond(&first) < 0x10_0000);
}
