//! Generated programs: their output, duration and final memory are the same on both engines, and their output is the
//! same as code for the real processor, at every level of optimisation, and with `gcc` if it is installed. Up to seven
//! programs also run together in seven threads, which interrupt each other anywhere; they do so on the released
//! firmware, too, if `CC67_FIRMWARE` names its file.
//!
//! A normal run takes a few programs. `CC67_PROGRAMS=20000` takes that many, `CC67_SEED=n` begins with another seed.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, LazyLock, Mutex};
use std::thread as host;

use boot::{BootedBoard, BootedSnapshot, FirmwareFile};
use compiler::diag::Severity;
use compiler::firmware::{Firmware, FirmwareFile as Symbols};
use compiler::passes::Level;
use compiler::target::Target;
use compiler::{Options, image};
use harness::oracles::{Seen, execute, execute_everywhere};
use harness::{Scratch, kinds};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, EventKind, RunEnd};
use vm::interp::BytecodeEngine;

/// The number of programs in a normal run.
const PROGRAMS: u64 = 14;

/// The number of programs that `gcc` compiles at once.
const BATCH: usize = 42;

const LEVELS: &[Level] = &[Level::None, Level::Full, Level::Fast, Level::Small];

/// Cycles of a tick on a board.
const TICK: u64 = 18_000;

/// The board time after which a program has failed: a minute.
const LIMIT: Ticks = Ticks::new(666_667);

/// The program for a seed; its line of output contains the seed.
fn source(seed: u64, prefix: &str) -> String {
    kinds::of_any_kind(seed, prefix, &format!("{seed}: "))
}

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// The image of a program for a thread.
fn compile(seed: u64, source: &str, thread: ThreadId, options: &Options) -> Vec<u8> {
    let files = compiler::pp::Disk;
    let mut compilation = compiler::compile(Path::new("generated.c"), source.into(), options, &files);
    let linked = compilation.link(thread, options);
    let errors = || compilation.diagnostics().into_iter().filter(|found| found.severity == Severity::Error);
    let linked = linked.unwrap_or_else(|| panic!("seed {seed}: {:?}", errors().collect::<Vec<_>>()));
    image::write(&linked).expect("an image of a small program can be written")
}

fn options(level: Level, target: Target) -> Options {
    Options { level, target, ..Options::default() }
}

fn thread(number: usize) -> ThreadId {
    ThreadId::new(i32::try_from(number).expect("small")).expect("a thread")
}

/// Runs an image on every available engine, between which there must be no difference, and returns the console.
fn run(seed: u64, image: &[u8]) -> String {
    console(seed, execute_everywhere(image, LIMIT).expect("what the compiler makes can be loaded"))
}

/// Runs code for the real processor.
fn run_code(seed: u64, image: &[u8]) -> String {
    let (seen, _) = execute::<BytecodeEngine>(image, LIMIT, Config::default()).expect("it can be loaded");
    console(seed, seen)
}

fn console(seed: u64, seen: Seen) -> String {
    assert_eq!(seen.end, RunEnd::AllEnded, "seed {seed}: the program does not end");
    let mut text = String::new();
    for event in seen.events {
        match event.kind {
            EventKind::ConsoleLine(line) => text.push_str(&String::from_utf8_lossy(&line)),
            other => text.push_str(&format!("{other:?}")),
        }
        text.push('\n');
    }
    text
}

/// The lines in alphabetical order, since threads print at any time.
fn sorted(text: &str) -> Vec<&str> {
    let mut lines: Vec<_> = text.lines().collect();
    lines.sort_unstable();
    lines
}

/// Runs images in threads 1, 2, … at the same time, for the duration that their code has on a board, and returns the
/// console.
fn run_together(seeds: &[u64], images: &[Vec<u8>]) -> String {
    let mut board = Board::<BytecodeEngine>::new(Config::default());
    for (index, image) in images.iter().enumerate() {
        board.load(thread(index + 1), image).expect("it can be loaded");
        board.start(thread(index + 1)).expect("it was loaded");
    }
    let mut events = Vec::new();
    let end = board.run(LIMIT, &mut |event| events.push(event));
    console(seeds[0], Seen { events, end })
}

/// A board that has booted the released firmware, and its symbols; `None` without a firmware file.
fn released() -> Option<(BootedBoard, Firmware)> {
    static BOOTED: LazyLock<Option<(Mutex<BootedSnapshot>, Firmware)>> = LazyLock::new(|| {
        let bytes = fs::read(std::env::var_os("CC67_FIRMWARE")?).expect("CC67_FIRMWARE names a file");
        let file = FirmwareFile::read(&bytes).expect("it is a firmware file");
        let mut board = BootedBoard::booted(Arc::new(file)).unwrap_or_else(|crash| panic!("{crash}"));
        let symbols = Arc::new(Symbols::read(&bytes).expect("it has symbols"));
        Some((Mutex::new(board.snapshot()), Firmware::File(symbols)))
    });
    let (snapshot, symbols) = BOOTED.as_ref()?;
    Some((snapshot.lock().expect("nothing panics with it").board(), symbols.clone()))
}

/// Runs the images together on the released firmware.
fn run_released(seeds: &[u64], mut board: BootedBoard, images: &[Vec<u8>]) -> String {
    let threads: Vec<_> = (1..=images.len()).map(thread).collect();
    for (thread, image) in threads.iter().zip(images) {
        board.load_program(*thread, image).expect("it is an image of this processor");
    }
    board.execute_together(&threads).unwrap_or_else(|crash| panic!("seeds {seeds:?}: {crash}"));
    let mut text = String::new();
    let mut lines = 0;
    let last = board.cycle() + LIMIT.get() * TICK;
    while lines < images.len() && board.cycle() < last {
        let next = board.cycle() + TICK;
        board.run_to(next).unwrap_or_else(|crash| panic!("seeds {seeds:?}: {crash}"));
        for line in board.take_lines() {
            text.push_str(&String::from_utf8_lossy(&line.text));
            text.push('\n');
            lines += 1;
        }
    }
    text
}

/// Up to seven programs in as many threads, at every level, must have the same output as each alone.
fn compare_together(seeds: &[u64], expected: &str) {
    let images = |options: &Options| -> Vec<_> {
        let numbered = seeds.iter().enumerate();
        numbered.map(|(index, seed)| compile(*seed, &source(*seed, ""), thread(index + 1), options)).collect()
    };
    for level in LEVELS {
        let options = options(*level, Target::C67x);
        let found = run_together(seeds, &images(&options));
        agree(seeds, &format!("together at {level:?}"), &found, expected);
        if let Some((board, firmware)) = released() {
            let options = Options { firmware, ..options };
            let found = run_released(seeds, board, &images(&options));
            agree(seeds, &format!("on the released firmware at {level:?}"), &found, expected);
        }
    }
}

/// The statement with which `gcc` flushes denormals to zero, as the controller's processor does, on hosts that support
/// it.
const WITHOUT_TINY: Option<&str> =
    if cfg!(target_arch = "x86_64") { Some("__builtin_ia32_ldmxcsr(0x9fc0);") } else { None };

/// Returns the output of the programs for `seeds` when compiled by `gcc`; `None` if it is not installed.
fn gcc(seeds: &[u64], level: &str) -> Option<Vec<String>> {
    gcc_after("", seeds, level)
}

/// Does the same as [`gcc`], with `first` as the first statement of `main`.
fn gcc_after(first: &str, seeds: &[u64], level: &str) -> Option<Vec<String>> {
    let scratch = Scratch::new(&format!("differential-{}", seeds[0]));
    let mut text = String::new();
    let mut main = format!("int main(void)\n{{\n    {first}\n");
    for seed in seeds {
        text.push_str(&source(*seed, &format!("p{seed}_")));
        main.push_str(&format!("    p{seed}_main();\n"));
    }
    scratch.write("all.c", format!("{text}\n{main}    return 0;\n}}\n"));
    let program = scratch.path().join("all");
    // GCC 12 evaluates `x >= x` as true if x is a NaN and jump threading applies
    // (tests/filetests/language/nan_compared_with_itself.c at -O1), so jump threading is disabled. Vectorised at -O2,
    // the output of program 373 differs from that at -O0, at -O1, and with its sanitizers.
    let compiler = Command::new("gcc")
        .args(["-w", level, "-fno-thread-jumps", "-fno-tree-vectorize"])
        .args(["-fwrapv", "-fsigned-char", "-ffp-contract=off", "-o"])
        .arg(&program)
        .arg(scratch.path().join("all.c"))
        .status();
    if !compiler.is_ok_and(|status| status.success()) {
        return None;
    }
    let output = Command::new(&program).output().expect("what gcc has made starts");
    let text = String::from_utf8_lossy(&output.stdout);
    Some(text.lines().map(|line| format!("{line}\n")).collect())
}

/// Asserts that programs have the same output; stores those that do not in `target/found`.
fn agree(seeds: &[u64], what: &str, found: &str, expected: &str) {
    let (found, expected) = (sorted(found), sorted(expected));
    if found == expected {
        return;
    }
    let folder = harness::root().join("target/found");
    fs::create_dir_all(&folder).expect("it is writable");
    let has_line = |seed: &&u64| {
        let prefix = format!("{seed}: ");
        let of =
            |lines: &[&str]| lines.iter().find(|line| line.starts_with(&prefix)).map(ToString::to_string);
        of(&found).is_some() && of(&found) == of(&expected)
    };
    let wrong: Vec<_> = seeds.iter().filter(|seed| !has_line(seed)).collect();
    for seed in &wrong {
        fs::write(folder.join(format!("{seed}.c")), source(**seed, "")).expect("it is writable");
    }
    panic!("seeds {wrong:?} of {seeds:?}, {what}: {found:?} instead of {expected:?}");
}

/// The console of a program that runs alone.
struct Alone {
    /// As bytecode.
    plain: String,
    /// As code for the processor: the same, except for programs that compute with denormals, which it flushes to zero.
    code: String,
}

/// Compares the output of a program that runs alone, on every engine and at every level.
fn compare_alone(seed: u64) -> Alone {
    let image = |level, target| compile(seed, &source(seed, ""), thread(1), &options(level, target));
    let plain = run(seed, &image(Level::None, Target::Sim));
    let code = run_code(seed, &image(Level::None, Target::C67x));
    if code != plain {
        let without_tiny = WITHOUT_TINY.and_then(|first| gcc_after(first, &[seed], "-O0"));
        agree(
            &[seed],
            "code for the processor",
            &code,
            &without_tiny.map_or(plain.clone(), |lines| lines.concat()),
        );
    }
    for level in LEVELS {
        agree(&[seed], &format!("bytecode at {level:?}"), &run(seed, &image(*level, Target::Sim)), &plain);
        let found = run_code(seed, &image(*level, Target::C67x));
        agree(&[seed], &format!("code for the processor at {level:?}"), &found, &code);
    }
    Alone { plain, code }
}

/// Compares the programs for `seeds`; returns how many were compared with `gcc`.
fn compare(seeds: &[u64]) -> usize {
    let mut compared = 0;
    for batch in seeds.chunks(BATCH) {
        let found: Vec<_> = batch.iter().map(|seed| compare_alone(*seed)).collect();
        for level in ["-O0", "-O1", "-O2"] {
            if let Some(expected) = gcc(batch, level) {
                let plain: String = found.iter().map(|alone| alone.plain.as_str()).collect();
                agree(batch, &format!("gcc {level}"), &expected.concat(), &plain);
                compared += batch.len();
            }
        }
        for (seeds, expected) in batch.chunks(7).zip(found.chunks(7)) {
            let code: String = expected.iter().map(|alone| alone.code.as_str()).collect();
            compare_together(seeds, &code);
        }
    }
    compared / 3
}

/// A program in which a sum becomes a denormal.
#[test]
fn a_program_with_tiny_numbers_is_compared_with_a_compiler_that_counts_them_as_zero() {
    let seed = 8_000_080;
    if WITHOUT_TINY.and_then(|first| gcc_after(first, &[seed], "-O0")).is_none() {
        return;
    }
    let alone = compare_alone(seed);
    assert_ne!(alone.plain, alone.code);
}

#[test]
fn generated_programs_do_the_same_everywhere() {
    let (first, count) = (number("CC67_SEED", 1), number("CC67_PROGRAMS", PROGRAMS));
    let seeds: Vec<u64> = (first..first + count).collect();
    let workers = host::available_parallelism().map_or(1, |workers| workers.get());
    let share = seeds.len().div_ceil(workers).max(1);
    let compared: usize = host::scope(|scope| {
        let handles: Vec<_> = seeds.chunks(share).map(|seeds| scope.spawn(move || compare(seeds))).collect();
        handles.into_iter().map(|handle| handle.join().expect("the programs agree")).sum()
    });
    println!("seeds {first} to {}, {compared} of {count} compared with gcc", first + count - 1);
}
