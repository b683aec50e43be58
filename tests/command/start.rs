//! The time from the command line to the end of a short program.

use std::time::Duration;

use harness::{Scratch, cc67, promptness};

/// A run takes at most this many times the time of `--version`, which only starts the process: about six times in a
/// release build, native translation included. Tables that a start makes and does not need took 23 times.
const MOST: u32 = 12;

/// Attempts before the machine is not to blame any more.
const ATTEMPTS: usize = 50;

#[test]
fn a_start_makes_only_what_a_run_needs() {
    let scratch = Scratch::new("start");
    scratch.write("a.c", "#include \"KMotionDef.h\"\nmain() { printf(\"%s\\n\", BOARD); }\n");
    let time = |arguments: &[&str]| promptness::timed(|| assert_eq!(cc67(&scratch, arguments).code, 0));
    let (mut version, mut run) = (Duration::MAX, Duration::MAX);
    // Other work on the machine only makes a time longer: the least ones count.
    for _ in 0..ATTEMPTS {
        version = version.min(time(&["--version"]));
        run = run.min(time(&["run", "a.c"]));
        if run < version * MOST {
            return;
        }
    }
    panic!("a run takes {run:?}, and the process alone {version:?}");
}
