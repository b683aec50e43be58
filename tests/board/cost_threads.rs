//! Waits and delays of a thread while six others are busy, compared with `data/vectors/threads.jsonl`: within 10 %.
//!
//! They were recorded without wait states of memory, with the vendor's compiler, on the released firmware.

use std::fs;

use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use harness::Scratch;
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::{ThreadId, Ticks};
use serde_json::Value as Json;

/// The relative tolerance for a duration.
const LIMIT: f64 = 0.1;

/// The possible difference in seconds between two positions in the same rotation: the first wait of a series begins
/// where the code before it has ended.
const BEGINNING: f64 = 10e-6;

/// A reading of the clock within a slice, which is a time and not a duration: the calls before it are charged with the
/// wait states of the bus, which the recorded ones do not have.
const INSTANT: &str = "Time_sec after WaitNextTimeSlice minus ServoTick*TIMEBASE";
const WITHIN: f64 = 1.5e-6;

fn vectors() -> Vec<Json> {
    let path = harness::root().join("tests/data/vectors/threads.jsonl");
    let text = fs::read_to_string(path).expect("the measurements are there");
    let lines = text.lines().map(|line| serde_json::from_str::<Json>(line).expect("JSON"));
    let is_of_seven = |row: &Json| row["other_threads"].as_array().is_some_and(|others| others.len() == 6);
    lines.filter(|row| row["kind"] == "times" && is_of_seven(row)).collect()
}

/// Returns the first `count` values that `statements` in thread 1 store in `g[]`, while six threads are busy.
fn times(statements: &str, count: usize, level: Level) -> Vec<f64> {
    let scratch = Scratch::new("cost-threads");
    scratch.write(
        "a.c",
        format!(
            "#include \"KMotionDef.h\"\ndouble g[200];\nmain()\n{{\n  int i; double T;\n  {statements}\n}}\n"
        ),
    );
    scratch.write("busy.c", "int n;\nmain() { for (;;) n++; }\n");
    let mut setup = Setup::default();
    setup.options.timing = Timing::Vendor(WaitStates::NONE);
    setup.options.level = level;
    for number in 1..=7 {
        let thread = ThreadId::new(number).expect("a thread");
        let file = if number == 1 { "a.c" } else { "busy.c" };
        let program = UserProgram::compile(&scratch.path().join(file), thread, &setup.options);
        setup.programs.push(program.unwrap_or_else(|error| panic!("{error}")).started());
    }
    let mut session = setup.session().expect("it fits");
    let _ = session.run(Ticks::new(2000), &mut |_| ());
    (0..count).map(|index| session.read(&format!("g[{index}]")).expect("it is a variable")).collect()
}

#[test]
fn waits_beside_six_busy_threads_take_as_long_as_on_the_board_at_every_level() {
    let vectors = vectors();
    assert_eq!(vectors.len(), 4);
    let mut worst = (0.0, String::new());
    for row in &vectors {
        let (name, program) = (row["name"].as_str().expect("text"), row["program"].as_str().expect("text"));
        let recorded: Vec<f64> =
            row["values"].as_array().expect("values").iter().filter_map(Json::as_f64).collect();
        let found = times(program, recorded.len(), Level::None);
        assert_eq!(found, times(program, recorded.len(), Level::Full), "{name}: at -O0 and at -O1");
        let durations = |values: &[f64]| match name {
            "WaitNextTimeSlice returns" => values.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            _ => values.to_vec(),
        };
        let (recorded, found): (Vec<f64>, Vec<f64>) = (durations(&recorded), durations(&found));
        for (index, (recorded, found)) in recorded.into_iter().zip(found).enumerate() {
            let off = (found - recorded).abs();
            let error = off / recorded;
            let text = format!("{name} {index}: {found:.8}, recorded {recorded:.8} ({:.1} %)", 100.0 * error);
            if name == INSTANT {
                assert!(off < WITHIN, "{text}");
                continue;
            }
            assert!(error < LIMIT || (index == 0 && off < BEGINNING), "{text}");
            if error > worst.0 {
                worst = (error, text);
            }
        }
    }
    eprintln!("the worst: {}", worst.1);
}
