//! The cost of going back: memory of a long run, and time of a run without a breakpoint.
//!
//! The board is busy: a servo axis with a motor and two more axes move, two programs run, and each move is printed.
//! `CC67_LONG=1` takes an hour of board time.

#![cfg(target_os = "linux")]

mod boards;

use std::path::PathBuf;
use std::time::Duration;

use boards::{board, tick};
use cc67_debug::Debugger;
use cc67_host::Session;

/// Moves three axes to and fro, the first one with a servo controller.
const MOVES: &str = r#"
    #include "KMotionDef.h"
    int rounds;
    main()
    {
        int axis;
        ch0->InputMode = ENCODER_MODE;
        ch0->OutputMode = DC_SERVO_MODE;
        ch0->OutputChan0 = 0;
        ch0->P = 1; ch0->D = 50; ch0->MaxOutput = 230; ch0->MaxFollowingError = 1e6;
        for (axis = 0; axis < 3; axis++)
        {
            if (axis > 0) { chan[axis].InputMode = NO_INPUT_MODE; chan[axis].OutputMode = NO_OUTPUT_MODE; }
            chan[axis].Vel = 1000; chan[axis].Accel = 5000; chan[axis].Jerk = 50000;
            EnableAxisDest(axis, 0);
        }
        for (;;)
        {
            for (axis = 0; axis < 3; axis++) Move(axis, rounds % 2 ? 0 : 200 * (axis + 1));
            while (!CheckDone(0) || !CheckDone(1) || !CheckDone(2)) WaitNextTimeSlice();
            rounds = rounds + 1;
            printf("%d: %f\n", rounds, ch0->Position);
        }
    }
"#;

/// Watches an input and stores the values seen.
const WATCHES: &str = r#"
    #include "KMotionDef.h"
    double history[5000];
    main()
    {
        int n = 0;
        for (;;)
        {
            history[n] = ReadBit(136) + ch0->Dest;
            persist.UserData[20] = n;
            n = (n + 1) % 5000;
            WaitNextTimeSlice();
        }
    }
"#;

/// Returns the folder of the programs, where a debugger reads them.
fn folder() -> PathBuf {
    std::env::temp_dir().join(format!("cc67-debug-cost-{}", std::process::id()))
}

fn session() -> Session {
    let machine = "[axis.0]\nmodel = \"motor\"\nku = 435\ntau_s = 0.02\n";
    board(&folder(), machine, &[("moves.c", MOVES), ("watches.c", WATCHES)])
}

/// The memory of this process, in bytes.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux has it");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("it is listed");
    line.split_whitespace().next().and_then(|kib| kib.parse::<u64>().ok()).expect("a number") << 10
}

/// Returns the processor time of some work, independent of other load.
fn time(work: impl FnOnce()) -> Duration {
    let begin = on_processor();
    work();
    on_processor() - begin
}

/// Returns the processor time of this thread.
fn on_processor() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux has it");
    let nanoseconds = text.split_whitespace().next().and_then(|word| word.parse().ok());
    Duration::from_nanos(nanoseconds.expect("a number"))
}

/// An expression that is never true, and is evaluated after every tick.
const ERROR: &str = "fabs(ch0->Dest - ch0->Position) > 1e9";

/// Returns the ratio of run times with and without a debugger that has no breakpoint, or that catches an expression:
/// the shortest of several runs each, as other load can only lengthen a run.
fn ratio(pairs: usize, seconds: f64, caught: Option<&str>) -> f64 {
    let end = tick(seconds);
    let (mut plain, mut debugged) = (Duration::MAX, Duration::MAX);
    for _ in 0..pairs {
        let mut session = self::session();
        plain = plain.min(time(|| session.advance(end, &mut |_| ())));
        let mut debugger = Debugger::new(self::session(), end);
        if let Some(expression) = caught {
            debugger.catch_when(expression).expect("it is right");
        }
        debugged = debugged.min(time(|| _ = debugger.go_on(&mut |_| ())));
    }
    debugged.as_secs_f64() / plain.as_secs_f64()
}

/// A single test for all measurements, as other work in the process would be measured, too.
#[test]
fn hours_of_history_take_little_memory_and_time() {
    let is_long = std::env::var_os("CC67_LONG").is_some();
    let (minutes, pairs, seconds, most) = if is_long { (60.0, 15, 100.0, 1.3) } else { (0.5, 7, 20.0, 1.6) };

    let before = resident();
    let mut debugger = Debugger::new(session(), tick(1e6));
    let length = time(|| _ = debugger.run_to(tick(60.0 * minutes), &mut |_| ()));
    let rounds = debugger.evaluate("rounds").expect("it is a variable").text;
    let (bytes, snapshots) = debugger.history();
    let all = resident().saturating_sub(before);
    println!(
        "{minutes} minutes of board time in {length:.1?}: {rounds} rounds, {snapshots} snapshots with {} MB of pages, \
         {} MB with the board",
        bytes / 1_000_000,
        all / 1_000_000
    );
    assert!(rounds.parse::<f64>().expect("a number") > minutes * 20.0, "the board works: {rounds}");
    assert!(all < 500_000_000, "{all} bytes");
    drop(debugger);

    // Evaluating an expression after every tick costs half as much as this machine's servo.
    let rows = [(None, "a run in a debugger", most), (Some(ERROR), "a run that catches an expression", 2.0)];
    for (caught, name, most) in rows {
        let ratio = ratio(pairs, seconds, caught);
        println!(
            "{name} takes {ratio:.3} times a plain one, the shortest of {pairs} runs of {seconds} s each"
        );
        assert!(ratio < most, "{ratio}");
    }
    std::fs::remove_dir_all(folder()).expect("the folder is ours");
}
