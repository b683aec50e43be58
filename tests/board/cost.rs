//! The 32 complete programs of `data/vectors/costs.jsonl`: the readings of `Time_sec` before and after their work.
//!
//! The recorded times belong to the vendor's compiler on the released firmware, with no other thread but thread 0. For
//! work that ends near the end of a slice, a few cycles decide whether it ends in this slice or in the next, a whole
//! rotation later.

use std::fs;

use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use harness::Scratch;
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::{Cycles, ThreadId, Ticks};
use serde_json::Value as Json;

/// The time until a thread's next slice, with no other thread but thread 0: a tick and the thread's own servo
/// interrupt.
const ROTATION: f64 = 18_000.0 + 2446.0;

/// Programs that do little besides reading and setting bits. The cost of a call includes the wait states of the bus as
/// set by the firmware, so without wait states they take the same time as with them.
const OF_CALLS: &[&str] = &["bits", "io"];

fn programs() -> Vec<Json> {
    let text =
        fs::read_to_string(harness::root().join("tests/data/vectors/costs.jsonl")).expect("it is there");
    let lines = text.lines().map(|line| serde_json::from_str::<Json>(line).expect("JSON"));
    lines.filter(|line| line["kind"] == "program").collect()
}

/// The cycles that a program's `work` takes by its own clock.
fn time(scratch: &Scratch, work: &str, level: Level, waits: WaitStates) -> f64 {
    let main = "double T;\nmain()\n{\n  double begin; WaitNextTimeSlice();\n  begin = Time_sec(); work(); \
                T = Time_sec() - begin;\n}\n";
    scratch.write("work.c", format!("#include \"KMotionDef.h\"\n{work}\n{main}"));
    let mut setup = Setup::default();
    setup.options.timing = Timing::Vendor(waits);
    setup.options.level = level;
    let thread = ThreadId::new(1).expect("a thread");
    let program = UserProgram::compile(&scratch.path().join("work.c"), thread, &setup.options);
    setup.programs.push(program.unwrap_or_else(|error| panic!("{error}")).started());
    let mut session = setup.session().expect("it fits");
    let _ = session.run(Ticks::new(1000), &mut |_| ());
    assert!(session.has_ended(), "{work}");
    session.read("T").expect("it is a variable") * Cycles::PER_SECOND.get() as f64
}

#[test]
fn whole_programs_take_as_long_as_on_the_board_at_every_level() {
    let scratch = Scratch::new("cost");
    let settings = [WaitStates::NONE, WaitStates::REGISTERS, WaitStates { register: 44, sdram: 20 }];
    let (mut report, mut moved, mut errors) = (String::new(), 0, Vec::new());
    let programs = programs();
    assert_eq!(programs.len(), 32);
    for program in &programs {
        let (name, work) = (&program["name"], program["c"].as_str().expect("a source"));
        for (setting, waits) in settings.into_iter().enumerate() {
            let measured =
                if setting == 0 && OF_CALLS.iter().any(|known| name == known) { 1 } else { setting };
            let recorded = program["time_sec_cycles"][measured].as_f64().expect("a number");
            let found = time(&scratch, work, Level::None, waits);
            if setting == 1 {
                let other = time(&scratch, work, Level::Full, waits);
                assert!((other - found).abs() < 1.0, "{name}: {found} at -O0, {other} at -O2");
            }
            let shifts = ((found - recorded) / ROTATION).round();
            let error = (found - shifts * ROTATION - recorded) / recorded;
            moved += i32::from(shifts != 0.0);
            errors.push(error.abs());
            if error.abs() > 0.1 || shifts.abs() > 1.0 {
                report +=
                    &format!("{name} {setting}: {found:.0}, recorded {recorded}: {:.1} %\n", 100.0 * error);
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    eprintln!(
        "median error {:.2} %, worst {:.1} %, {moved} moved by a rotation",
        100.0 * errors[48],
        100.0 * errors[95]
    );
    assert!(report.is_empty() && moved <= 8, "{moved} moved by a rotation\n{report}");
}
