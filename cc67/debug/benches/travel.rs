//! The cost of going back in time, and of keeping the past.
//!
//! `back/...`: one step back of a thread after a minute of board time. `run/...`: ten seconds of the same program in a
//! session, and in a debugger without a breakpoint. The test `cost` measures the memory used for the past.
//!
//! `cargo bench -p cc67-debug`

#[path = "../tests/boards/mod.rs"]
mod boards;

use std::hint::black_box;

use boards::{board, tick};
use cc67_debug::Debugger;
use cc67_host::Session;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use kmotiondef::ThreadId;

/// Moves to and fro and prints, as production programs do.
const MOVES: &str = r#"
    #include "KMotionDef.h"
    int rounds;
    main()
    {
        ch0->InputMode = NO_INPUT_MODE;
        ch0->OutputMode = NO_OUTPUT_MODE;
        ch0->Vel = 1000; ch0->Accel = 5000; ch0->Jerk = 50000;
        EnableAxisDest(0, 0);
        for (;;)
        {
            Move(0, rounds % 2 ? 0 : 500);
            while (!CheckDone(0)) WaitNextTimeSlice();
            rounds = rounds + 1;
            printf("%d\n", rounds);
        }
    }
"#;

/// Watches inputs, as service loops do.
const WATCHES: &str = r#"
    #include "KMotionDef.h"
    int on, history[1000];
    main()
    {
        int n = 0;
        for (;;)
        {
            on = ReadBit(136);
            history[n] = on + n;
            n = (n + 1) % 1000;
            WaitNextTimeSlice();
        }
    }
"#;

fn session() -> Session {
    let folder = std::env::temp_dir().join(format!("cc67-travel-{}", std::process::id()));
    board(&folder, "", &[("moves.c", MOVES), ("watches.c", WATCHES)])
}

fn debugger(seconds: f64) -> Debugger {
    let mut debugger = Debugger::new(session(), tick(1e6));
    debugger.run_to(tick(seconds), &mut |_| ());
    debugger
}

fn back(c: &mut Criterion) {
    let mut group = c.benchmark_group("back");
    group.sample_size(10);
    let mut debugger = debugger(60.0);
    let first = ThreadId::all().next().expect("there are 7");
    debugger.select(first, 0).expect("it runs");
    group.bench_function("line", |b| b.iter(|| black_box(debugger.reverse_next())));
    group.bench_function("instruction", |b| b.iter(|| black_box(debugger.reverse_step_instruction())));
    group.finish();
}

fn run(c: &mut Criterion) {
    let mut group = c.benchmark_group("run");
    group.sample_size(10);
    let end = tick(10.0);
    group.bench_function("plain", |b| {
        b.iter_batched_ref(session, |session| session.advance(end, &mut |_| ()), BatchSize::PerIteration);
    });
    group.bench_function("debugged", |b| {
        b.iter_batched_ref(
            || Debugger::new(session(), end),
            |debugger| debugger.go_on(&mut |_| ()),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, run, back);
criterion_main!(benches);
