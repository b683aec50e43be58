//! Whatever the bytes: every oracle over random inputs, the same in each run, and over all that ever failed.
//!
//! An input that fails, here or in `tests/fuzz`, goes into `tests/data/failed/TARGET/` under any name, and is tried
//! in every run from then on.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};

use harness::choices::random_bytes;
use harness::is_long;
use harness::oracles::{TARGETS, Target};
use libtest_mimic::{Arguments, Failed, Trial};

/// Inputs of each target in an ordinary run; with `CC67_LONG=1` in the environment a hundred times as many.
const INPUTS: u64 = 20;

fn main() {
    let trials = TARGETS.iter().flat_map(|target| {
        [
            Trial::test(format!("{}/random", target.name), move || random(target)),
            Trial::test(format!("{}/failed", target.name), move || failed(target)),
        ]
    });
    let listed = Trial::test("each has a fuzz target", each_has_a_fuzz_target);
    libtest_mimic::run(&Arguments::from_args(), trials.chain([listed]).collect()).exit();
}

fn each_has_a_fuzz_target() -> Result<(), Failed> {
    let folder = harness::root().join("tests/fuzz");
    let manifest = fs::read_to_string(folder.join("Cargo.toml"))?;
    for Target { name, .. } in TARGETS {
        let path = format!("fuzz_targets/{name}.rs");
        if !manifest.contains(&path) || !folder.join(&path).exists() {
            return Err(format!("{path} is missing").into());
        }
    }
    Ok(())
}

fn random(target: &Target) -> Result<(), Failed> {
    let count = if is_long() { 100 * INPUTS } else { INPUTS };
    for seed in 0..count {
        let input = random_bytes(seed, 8 + (seed as usize * 37) % 400);
        attempt(target, &input).map_err(|error| format!("seed {seed}: {error}"))?;
    }
    Ok(())
}

fn failed(target: &Target) -> Result<(), Failed> {
    let Ok(folder) = fs::read_dir(harness::root().join("tests/data/failed").join(target.name)) else {
        return Ok(());
    };
    for entry in folder {
        let path = entry?.path();
        attempt(target, &fs::read(&path)?).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// Tries an input; what it panicked with.
fn attempt(target: &Target, input: &[u8]) -> Result<(), String> {
    catch_unwind(AssertUnwindSafe(|| (target.run)(input))).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default()
    })
}
