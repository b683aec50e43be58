//! The session: a board under control, on both engines, and the repetition of manual actions.

use cc67_host::{End, Session, Setup, Until, UserProgram, WatchError};
use harness::Scratch;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::stimulus::Stimulus;
use runtime::{Board, Event, EventKind};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::native::NativeEngine;

/// Two threads: one counts ticks in which a switch is on, the other prints the values in UserData.
const COUNTER: &str = "\
#include \"KMotionDef.h\"
int count, ticks;
struct { unsigned low : 3; int high : 5; } fields;
double half = 0.5;
main()
{
    for (;;)
    {
        WaitNextTimeSlice();
        ++ticks;
        if (ReadBit(136)) ++count;
        if (ticks < 0) half = fields.low + fields.high;
    }
}
";
const PRINTER: &str = "\
#include \"KMotionDef.h\"
int last;
main()
{
    while (last != 99)
    {
        if (persist.UserData[5] != last) printf(\"%d at %d\\n\", last = persist.UserData[5], (int)(Time_sec() * 1e6));
        WaitNextTimeSlice();
    }
    printf(\"%d characters\\n\", persist.UserData[6]);
}
";

fn thread(number: i32) -> ThreadId {
    ThreadId::new(number).expect("there are 7")
}

fn setup(scratch: &Scratch) -> Setup {
    scratch.write("counter.c", COUNTER).write("printer.c", PRINTER);
    let mut setup = Setup::default();
    for (number, name) in [(1, "counter.c"), (2, "printer.c")] {
        let program = UserProgram::compile(&scratch.path().join(name), thread(number), &setup.options);
        setup.programs.push(program.expect("it is right").started());
    }
    setup
}

fn session(name: &str) -> (Session, Scratch) {
    let scratch = Scratch::new(name);
    (setup(&scratch).session().expect("the programs fit"), scratch)
}

/// The output of a session, and its end.
#[derive(Debug, PartialEq)]
struct Shown {
    lines: Vec<(Cycles, String)>,
    end: Ticks,
    memory: Vec<u8>,
}

/// Keeps the console and the replies of a session.
fn lines(kept: &mut Vec<(Cycles, String)>) -> impl FnMut(Event) {
    |event| {
        if let EventKind::ConsoleLine(line) | EventKind::Reply(line) = event.kind {
            kept.push((event.at, String::from_utf8_lossy(&line).into_owned()));
        }
    }
}

/// All memory that contains programs and their data.
fn memory<E: Engine>(session: &Session<Board<E>>) -> Vec<u8> {
    let (base, size) = (kmotiondef::map::PROGRAM_BASE, 7 * kmotiondef::map::PROGRAM_SIZE);
    let bytes = session.target().memory().read_bytes(kmotiondef::GuestAddr::new(base), size);
    bytes.expect("it is there").to_vec()
}

/// Makes manual actions at many times; returns the output, and the recording.
fn by_hand<E: Engine>(mut session: Session<Board<E>>) -> (Shown, String) {
    let mut kept = Vec::new();
    let mut hear = lines(&mut kept);
    for round in 0..40_u64 {
        session.advance(Ticks::new(round * round * 7 + round), &mut hear);
        match round % 8 {
            0 => session.act(&format!("bit 136 = {}", round / 8 % 2)).expect("a statement"),
            1 => session.drive_input(Bit::new(136).expect("a bit"), round / 8 % 2 == 0).expect("an input"),
            2 => assert!(session.set_user_data(5, round as i32)),
            3 => session.command(format!("SetPersistDec 5 {round};GetPersistDec 5").as_bytes()),
            4 => session.exchange(b"Version", &mut hear),
            5 => session.act("adc 3 = sine mean 0 amplitude 1000 hz 50").expect("a statement"),
            6 => session.stop(thread(1)),
            _ => session.start(thread(1)).expect("it holds a program"),
        }
    }
    assert!(session.set_user_data(5, 99));
    assert!(!session.run_until(&Until::Trapped, session.tick_after(0.1), &mut hear));
    session.finish(&mut hear);
    assert!(session.recording().is_complete());
    let (end, memory, text) = (session.tick(), memory(&session), session.recording().text().to_owned());
    drop(hear);
    (Shown { lines: kept, end, memory }, text)
}

/// Runs a setup with a recording as its stimulus.
fn again<E: Engine>(mut setup: Setup, engine: E, recording: &str, end: Ticks) -> Shown {
    setup.stimulus = Stimulus::parse(recording, "recording").expect("it is a stimulus");
    let mut session = setup.session_on(engine).expect("the programs fit");
    let mut kept = Vec::new();
    let mut hear = lines(&mut kept);
    session.advance(end, &mut hear);
    session.finish(&mut hear);
    drop(hear);
    Shown { lines: kept, end: session.tick(), memory: memory(&session) }
}

#[test]
fn a_recording_of_manual_actions_replays_the_same_on_both_engines() {
    let scratch = Scratch::new("session-replay");
    let (shown, text) = by_hand(setup(&scratch).session().expect("the programs fit"));
    assert!(shown.lines.len() > 20, "{:?}", shown.lines);
    assert_eq!(text.lines().count(), 41, "{text}");
    let native = by_hand(setup(&scratch).session_on(NativeEngine::default()).expect("the programs fit"));
    assert!(native == (shown, text.clone()), "the engines differ");
    let (shown, _) = native;
    for engine in ["bytecode", "native"] {
        let again = match engine {
            "native" => again(setup(&scratch), NativeEngine::default(), &text, shown.end),
            _ => again(setup(&scratch), BytecodeEngine::default(), &text, shown.end),
        };
        assert_eq!(again.lines, shown.lines, "{engine}\n{text}");
        assert!(again == shown, "{engine}: memory differs");
    }
}

#[test]
fn a_condition_ends_a_run_in_the_tick_in_which_it_is_met() {
    let (mut session, _scratch) = session("session-conditions");
    let ticks = Until::True(session.watch("ticks >= 10").expect("an expression"));
    assert!(session.run_until(&ticks, Ticks::new(1000), &mut |_| ()));
    assert_eq!(session.read("ticks"), Ok(10.0));
    let tick = session.tick();
    assert!(session.run_until(&ticks, Ticks::new(1000), &mut |_| ()), "it is met already");
    assert_eq!(session.tick(), tick);

    assert!(session.set_user_data(5, 7));
    let printed = Until::Printed("7 at".to_owned());
    assert!(session.run_until(&printed, Ticks::new(1000), &mut |_| ()));
    assert!(!session.run_until(&printed, Ticks::new(1000), &mut |_| ()), "it was printed before");
    assert_eq!(session.tick(), Ticks::new(1000));

    assert!(session.set_user_data(5, 99));
    let either = Until::Any(vec![Until::Trapped, Until::Active(thread(2), false)]);
    assert!(session.run_until(&either, Ticks::new(2000), &mut |_| ()));
    assert!(session.tick() < Ticks::new(1100));
    assert!(session.thread(thread(1)).is_active());
}

#[test]
fn a_step_is_a_tick_a_slice_or_the_next_slice_of_a_thread() {
    let (mut session, _scratch) = session("session-steps");
    let limit = Ticks::new(1000);
    session.step_tick(&mut |_| ());
    assert_eq!(session.tick(), Ticks::new(1));
    let slices: Vec<_> = (0..6).map(|_| session.step_slice(limit, &mut |_| ()).map(ThreadId::get)).collect();
    assert!(slices == [Some(1), Some(2)].repeat(3) || slices == [Some(2), Some(1)].repeat(3), "{slices:?}");
    let before = session.read("ticks").expect("an expression");
    assert!(session.step_thread(thread(1), limit, &mut |_| ()));
    assert_eq!(session.read("ticks"), Ok(before + 1.0));
    session.stop(thread(1));
    assert!(!session.step_thread(thread(1), limit, &mut |_| ()));
    assert_eq!(session.tick(), limit);
}

#[test]
fn expressions_are_read_and_written_with_the_programs_names() {
    let (mut session, _scratch) = session("session-expressions");
    assert_eq!(session.write("persist.7", -2.0), Ok(()));
    assert_eq!(session.recording().text(), "at 90us persist 7 = -2\n");
    for (place, value, expect) in [
        ("count", 7.9, 7.0),
        ("fields.low", 13.0, 5.0),
        ("fields.high", -3.0, -3.0),
        ("half", 0.25, 0.25),
        ("2:last", 11.0, 11.0),
        ("persist.5", -1.0, -1.0),
        ("chan[2].Dest", 1.5, 1.5),
        ("*(int *)&persist.UserData[8]", 4.0, 4.0),
    ] {
        assert_eq!(session.write(place, value), Ok(()), "{place}");
        assert_eq!(session.read(place), Ok(expect), "{place}");
    }
    assert_eq!(session.read("fields.low"), Ok(5.0), "its neighbour is written beside it");
    assert_eq!(session.read("count + persist.5 * 2"), Ok(5.0));
    assert_eq!(session.read("dest2"), Ok(1.5));
    assert!(!session.recording().is_complete(), "no statement writes to a variable");
    for text in ["dest2", "count + 1", "7"] {
        assert_eq!(session.write(text, 1.0), Err(WatchError::NoPlace(text.to_owned())));
    }
    let error = session.read("conut").expect_err("there is none");
    assert_eq!(error.to_string(), "`conut`: `conut` is not declared; did you mean `count`?");
}

#[test]
fn signals_arrive_at_their_rate_even_when_ticks_are_skipped() {
    let scratch = Scratch::new("session-signals");
    scratch.write(
        "a.c",
        "#include \"KMotionDef.h\"\nint n;\nmain() { Delay_sec(0.05); n = 1; Delay_sec(0.05); }\n",
    );
    let mut setup = Setup::default();
    let program = UserProgram::compile(&scratch.path().join("a.c"), thread(1), &setup.options);
    setup.programs.push(program.expect("it is right").started());
    let mut session = setup.session().expect("the program fits");
    let (sender, samples) = std::sync::mpsc::channel();
    let watched = vec![session.watch("n").expect("a variable")];
    let id = session.subscribe(watched, 250, move |tick, values| {
        sender.send((tick.get(), values.to_vec())).expect("it is awaited");
    });
    assert_eq!(session.run(Ticks::new(10_000), &mut |_| ()), End::AllEnded);
    let end = session.tick().get();
    session.unsubscribe(id);
    session.advance(Ticks::new(end + 1000), &mut |_| ());
    let samples: Vec<_> = samples.try_iter().collect();
    let ticks: Vec<u64> = samples.iter().map(|(tick, _)| *tick).collect();
    assert_eq!(ticks, (1..=end / 250).map(|index| index * 250).collect::<Vec<_>>());
    assert!(
        samples.iter().all(|(tick, values)| values == &[f64::from(u8::from(*tick > 556))]),
        "{samples:?}"
    );
}

#[test]
fn a_run_can_be_interrupted_from_another_thread() {
    let (mut session, _scratch) = session("session-interrupt");
    let interrupter = session.interrupter();
    let beside = std::thread::spawn(move || interrupter.interrupt());
    // The programs never end.
    assert_eq!(session.run(Ticks::new(u64::MAX), &mut |_| ()), End::Interrupted);
    beside.join().expect("it interrupts");
    assert!(session.thread(thread(1)).is_active());
    assert_eq!(session.run(session.tick_after(0.01), &mut |_| ()), End::Limit);
}

#[test]
fn impossible_actions_are_refused_and_change_nothing() {
    let (mut session, scratch) = session("session-refused");
    assert!(session.act("bit 46 = 1").is_err(), "only the board drives an output");
    assert!(session.act("when bit 46 rises bit 136 = 1").is_err(), "it has a moment of its own");
    assert!(session.drive_input(Bit::new(46).expect("a bit"), true).is_err());
    assert!(!session.set_user_data(200, 1));
    assert!(session.start(thread(3)).is_err());
    assert_eq!(session.recording().text(), "");
    scratch.write("a.out", "\x7fELF");
    let image = UserProgram::from_image(&scratch.path().join("a.out"), thread(1)).expect("it can be read");
    let error = session.load(image).expect_err("it is no image").to_string();
    assert!(error.contains("a.out"), "{error}");
    session.advance(Ticks::new(10), &mut |_| ());
    assert_eq!(session.read("ticks > 0"), Ok(1.0), "the program goes on");
}
