//! What going back costs, and what it costs that one can.
//!
//! `back/...`: one step back of a thread after a minute of board time. `run/...`: ten seconds of the same program in a
//! session, and in a debugger without a breakpoint. Before them, what the past of a run takes in memory is said: ten
//! minutes of board time, with `CC67_LONG=1` an hour.
//!
//! `cargo bench -p cc67-debug`

use std::hint::black_box;
use std::path::PathBuf;

use cc67_debug::Debugger;
use cc67_host::{Session, Setup, UserProgram};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};

/// Moves to and fro and prints, as jobs do.
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

fn tick(seconds: f64) -> Ticks {
    Ticks::new((seconds / TIMEBASE).round() as u64)
}

fn session() -> Session {
    let folder = std::env::temp_dir().join(format!("cc67-travel-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut setup = Setup::default();
    for ((name, text), thread) in
        [("moves.c", MOVES), ("watches.c", WATCHES)].into_iter().zip(ThreadId::all())
    {
        let file: PathBuf = folder.join(name);
        std::fs::write(&file, text).expect("a file");
        let program = UserProgram::compile(&file, thread, &setup.options).expect("it compiles");
        setup.programs.push(program.started());
    }
    setup.session().expect("a board")
}

fn debugger(seconds: f64) -> Debugger {
    let mut debugger = Debugger::new(session(), tick(1e6));
    debugger.run_to(tick(seconds), &mut |_| ());
    debugger
}

/// Bytes of memory of this process, where the system says so.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.split_whitespace().next()?.parse::<u64>().ok().map(|kib| kib << 10)
}

fn memory() {
    let minutes = if std::env::var_os("CC67_LONG").is_some() { 60.0 } else { 10.0 };
    let before = resident().unwrap_or(0);
    let debugger = debugger(60.0 * minutes);
    let (bytes, snapshots) = debugger.history();
    let all = resident().map_or(0, |now| now.saturating_sub(before));
    println!(
        "the past of {minutes} minutes: {snapshots} snapshots, {} MB of pages, {} MB in all with the board",
        bytes / 1_000_000,
        all / 1_000_000
    );
}

fn back(c: &mut Criterion) {
    memory();
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
        b.iter_batched(session, |mut session| session.advance(end, &mut |_| ()), BatchSize::PerIteration);
    });
    group.bench_function("debugged", |b| {
        b.iter_batched(
            || Debugger::new(session(), end),
            |mut debugger| debugger.go_on(&mut |_| ()),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, run, back);
criterion_main!(benches);
