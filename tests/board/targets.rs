//! A common test of all targets: the model on each engine, and the firmware files named by `CC67_FIRMWARE` and
//! `CC67_FIRMWARE_5`.
//!
//! The same two programs run on each. The console lines must be the same on all; on each, the restored past must equal
//! the original, and so must the continuation.

use std::collections::BTreeMap;
use std::env;
use std::path::PathBuf;

use cc67_host::{BootedFirmware, Session, Setup, Target, Timeline, UserProgram};
use compiler::target::Target as CodeTarget;
use harness::Scratch;
use harness::random::Random;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_SIZE};
use kmotiondef::{Cycles, GuestAddr, ThreadId, Ticks};
use runtime::{Event, EventKind};
use vm::interp::BytecodeEngine;
use vm::native::NativeEngine;

/// Moves an axis and answers requests of the other thread.
const MOVER: &str = "\
#include \"KMotionDef.h\"
int answered;
main()
{
    int i;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 20000;
    ch0->Accel = 400000;
    ch0->Jerk = 4e7;
    EnableAxisDest(0, 0);
    persist.UserData[10] = 0;
    for (i = 1; i <= 3; i++)
    {
        MoveRel(0, 250);
        while (!CheckDone(0)) WaitNextTimeSlice();
        printf(\"at %.1f, %d asked\\n\", ch0->Dest, persist.UserData[11] > 0);
        answered = i;
        persist.UserData[10] = i;
    }
}
";
/// Counts slices, calls a library function of the firmware, and ends when the first thread has moved three times.
const ASKER: &str = "\
#include \"KMotionDef.h\"
double sum;
main()
{
    persist.UserData[11] = 0;
    while (persist.UserData[10] != 3)
    {
        persist.UserData[11]++;
        sum += sqrtf(persist.UserData[11]);
        SetBit(1030);
        WaitNextTimeSlice();
        ClearBit(1030);
    }
    Delay_sec(0.02);
    printf(\"asked %s\\n\", persist.UserData[11] > 100 ? \"often\" : \"rarely\");
}
";

/// The end of the test: 0.27 s.
const END: u64 = 3000;
/// The number of times that are restored.
const INSTANTS: usize = 200;
/// Lines of both programs.
const LINES: [&str; 4] = ["asked often", "at 250.0, 1 asked", "at 500.0, 1 asked", "at 750.0, 1 asked"];

/// Both programs, compiled with these options.
fn setup(scratch: &Scratch, options: compiler::Options) -> Setup {
    scratch.write("mover.c", MOVER).write("asker.c", ASKER);
    let mut setup = Setup { options, ..Setup::default() };
    for (number, name) in [(1, "mover.c"), (2, "asker.c")] {
        let thread = ThreadId::new(number).expect("there are 7");
        let program = UserProgram::compile(&scratch.path().join(name), thread, &setup.options);
        setup.programs.push(program.expect("it is right").started());
    }
    setup
}

/// The state of a target at one time: the memory of both programs, their shared data, an axis, and the time.
#[derive(Debug, PartialEq)]
struct Seen {
    memory: Vec<u8>,
    shared: [Option<i32>; 2],
    dest: Option<u64>,
    now: Cycles,
}

fn seen<T: Target>(session: &Session<T>) -> Seen {
    let mut memory = vec![0; 2 * PROGRAM_SIZE as usize];
    session.target().read(GuestAddr::new(PROGRAM_BASE), &mut memory).expect("programs are there");
    Seen {
        memory,
        shared: [session.user_data(10), session.user_data(11)],
        dest: session.item("dest0").map(f64::to_bits),
        now: session.now(),
    }
}

/// Random ticks of the test.
fn instants() -> Vec<Ticks> {
    let mut random = Random::new(0x5EED);
    (0..INSTANTS).map(|_| Ticks::new(1 + random.draw() % (END - 1))).collect()
}

/// The console lines of a session, each with its time.
fn console(lines: &mut Vec<(Cycles, String)>) -> impl FnMut(Event) {
    |event| {
        if let EventKind::ConsoleLine(line) = event.kind {
            lines.push((event.at, String::from_utf8_lossy(&line).into_owned()));
        }
    }
}

/// Tests one target; returns its console lines in alphabetical order.
fn trial<T: Target>(name: &str, mut session: Session<T>) -> Vec<String> {
    let mut timeline = Timeline::new(&mut session).expect(name);
    let order = instants();
    let mut sorted = order.clone();
    sorted.sort();
    let mut first = BTreeMap::new();
    let mut lines = Vec::new();
    for at in sorted {
        let _ = timeline.advance(&mut session, at, &mut console(&mut lines));
        first.insert(at, seen(&session));
    }
    let _ = timeline.advance(&mut session, Ticks::new(END), &mut console(&mut lines));
    let end = seen(&session);
    for at in &order {
        timeline.go_to(&mut session, *at).expect(name);
        assert!(
            seen(&session) == first[at],
            "{name}: tick {} is another one when it is reached again",
            at.get()
        );
    }
    // The continuation must be the same.
    for at in order.iter().take(5) {
        timeline.go_to(&mut session, *at).expect(name);
        let (from, mut again) = (session.now(), Vec::new());
        session.advance(Ticks::new(END), &mut console(&mut again));
        let expect: Vec<_> = lines.iter().filter(|(when, _)| *when > from).cloned().collect();
        assert_eq!(again, expect, "{name}: from tick {}", at.get());
        assert!(seen(&session) == end, "{name}: the end, from tick {}", at.get());
    }
    let mut texts: Vec<_> = lines.into_iter().map(|(_, text)| text).collect();
    texts.sort();
    texts
}

#[test]
fn every_target_reaches_its_past_and_its_future_again() {
    let scratch = Scratch::new("targets");
    let bytecode = || setup(&scratch, compiler::Options::default());
    let processor =
        || setup(&scratch, compiler::Options { target: CodeTarget::C67x, ..compiler::Options::default() });
    let mut said = vec![
        ("bytecode", trial("bytecode", bytecode().session_on(BytecodeEngine::default()).expect("it begins"))),
        ("native", trial("native", bytecode().session_on(NativeEngine::default()).expect("it begins"))),
        ("dsp", trial("dsp", processor().session().expect("it begins"))),
        ("any", trial("any", bytecode().session_on_any(None).expect("it begins"))),
    ];
    for variable in ["CC67_FIRMWARE", "CC67_FIRMWARE_5"] {
        let Some(path) = env::var_os(variable).map(PathBuf::from) else {
            println!("not tried: {variable} names no firmware file");
            continue;
        };
        let firmware = BootedFirmware::open(&path).expect(variable);
        let setup = setup(&scratch, firmware.options(compiler::Options::default()));
        said.push((variable, trial(variable, setup.session_on_any(Some(&firmware)).expect("it begins"))));
    }
    for (name, lines) in said {
        assert_eq!(lines, LINES, "{name}");
    }
}
