//! Generated programs: what they print, how long they take and what they leave in memory is the same on both
//! engines, and what they print is the same as code for the real processor, at every level of optimisation and by `gcc`, where that is installed.
//!
//! An ordinary run takes a few programs. `CC67_PROGRAMS=20000` takes this many, `CC67_SEED=n` begins at another seed.

use std::path::Path;
use std::process::Command;
use std::thread;

use compiler::diag::Severity;
use compiler::passes::Level;
use compiler::target::Target;
use compiler::{Options, image};
use harness::oracles::{Seen, execute, execute_everywhere};
use harness::{Scratch, generate};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Config, EventKind, RunEnd};
use vm::interp::BytecodeEngine;

/// Programs of an ordinary run.
const PROGRAMS: u64 = 24;

/// Programs that `gcc` compiles in one go.
const BATCH: u64 = 40;

/// Board time after which a program has gone wrong: a minute.
const LIMIT: Ticks = Ticks::new(666_667);

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// The image of a program.
fn compile(seed: u64, source: &str, level: Level, target: Target) -> Vec<u8> {
    let options = Options { level, target, ..Options::default() };
    let files = compiler::pp::Disk;
    let mut compilation = compiler::compile(Path::new("generated.c"), source.into(), &options, &files);
    let linked = compilation.link(thread_1(), &options);
    let errors = || compilation.diagnostics().into_iter().filter(|found| found.severity == Severity::Error);
    let linked = linked.unwrap_or_else(|| panic!("seed {seed}: {:?}", errors().collect::<Vec<_>>()));
    image::write(&linked).expect("an image of a small program can be written")
}

fn thread_1() -> ThreadId {
    ThreadId::new(1).expect("there is a thread 1")
}

/// Runs an image on every engine there is, which must not differ in anything, and yields the console.
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

/// Returns the outputs of the programs `seeds` when compiled by `gcc`; `None` where that is not installed.
fn gcc(seeds: &[u64]) -> Option<Vec<String>> {
    let scratch = Scratch::new(&format!("differential-{}", seeds[0]));
    let mut source = String::new();
    let mut main = String::from("int main(void)\n{\n");
    for seed in seeds {
        source.push_str(&generate::program(*seed, &format!("p{seed}_"), ""));
        main.push_str(&format!("    p{seed}_main();\n"));
    }
    scratch.write("all.c", format!("{source}\n{main}    return 0;\n}}\n"));
    let program = scratch.path().join("all");
    // GCC 12 takes `x >= x` for true where x is a NaN and it follows a jump to there
    // (tests/filetests/language/nan_compared_with_itself.c at -O1), so it may not follow jumps.
    let compiler = Command::new("gcc")
        .args(["-w", "-O1", "-fno-thread-jumps", "-fwrapv", "-fsigned-char", "-ffp-contract=off", "-o"])
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

/// Compares the programs `seeds`; returns how many were compared with `gcc`.
fn compare(seeds: &[u64]) -> usize {
    let mut compared = 0;
    for batch in seeds.chunks(BATCH as usize) {
        let expected = gcc(batch);
        for (index, seed) in batch.iter().enumerate() {
            let source = generate::program(*seed, "", "");
            let optimised = run(*seed, &compile(*seed, &source, Level::Full, Target::Sim));
            let plain = run(*seed, &compile(*seed, &source, Level::None, Target::Sim));
            assert_eq!(optimised, plain, "seed {seed}: optimised and not");
            for level in [Level::Fast, Level::Full, Level::Small, Level::None] {
                let code = run_code(*seed, &compile(*seed, &source, level, Target::C67x));
                assert_eq!(code, plain, "seed {seed}: code for the processor at {level:?}");
            }
            if let Some(expected) = &expected {
                assert_eq!(expected.get(index), Some(&plain), "seed {seed}: gcc and cc67");
                compared += 1;
            }
        }
    }
    compared
}

#[test]
fn generated_programs_do_the_same_everywhere() {
    let (first, count) = (number("CC67_SEED", 1), number("CC67_PROGRAMS", PROGRAMS));
    let seeds: Vec<u64> = (first..first + count).collect();
    let workers = thread::available_parallelism().map_or(1, |workers| workers.get());
    let share = seeds.len().div_ceil(workers).max(1);
    let compared: usize = thread::scope(|scope| {
        let handles: Vec<_> = seeds.chunks(share).map(|seeds| scope.spawn(move || compare(seeds))).collect();
        handles.into_iter().map(|handle| handle.join().expect("the programs agree")).sum()
    });
    println!("seeds {first} to {}, {compared} of {count} compared with gcc", first + count - 1);
}
