//! Properties for any bytes: every oracle with random inputs, the same in each run, and with all inputs that ever
//! failed.
//!
//! An input that fails, here or in `tests/fuzz`, is stored in `tests/data/failed/TARGET/` under any name, and is tried
//! in every run from then on.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};

use harness::choices::random_bytes;
use harness::is_long;
use harness::oracles::{TARGETS, Target};

/// The number of inputs for each target in a normal run; with `CC67_LONG=1` in the environment a hundred times as many.
const INPUTS: u64 = 20;

/// For each named oracle, tests with random inputs and with all inputs that ever failed.
macro_rules! oracles {
    ($($name:ident)+) => {
        const NAMES: &[&str] = &[$(stringify!($name)),+];

        $(mod $name {
            #[test]
            fn withstands_random_inputs() {
                super::random(super::named(stringify!($name)));
            }

            #[test]
            fn withstands_every_input_that_ever_failed() {
                super::failed(super::named(stringify!($name)));
            }
        })+
    };
}

oracles! {
    source tokens image execution processor translated program machine_file stimulus commands format world debug_adapter
    page wire
}

fn named(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).expect("every oracle here is one of the harness")
}

#[test]
fn every_oracle_has_tests_here_and_a_fuzz_target() {
    let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
    assert_eq!(names, NAMES);
    let folder = harness::root().join("tests/fuzz");
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).expect("the manifest is readable");
    for name in names {
        let path = format!("fuzz_targets/{name}.rs");
        assert!(manifest.contains(&path) && folder.join(&path).exists(), "{path} is missing");
    }
}

fn random(target: &Target) {
    let count = if is_long() { 100 * INPUTS } else { INPUTS };
    for seed in 0..count {
        let input = random_bytes(seed, 8 + (seed as usize * 37) % 400);
        attempt(target, &input, &format!("seed {seed}"));
    }
}

fn failed(target: &Target) {
    let Ok(folder) = fs::read_dir(harness::root().join("tests/data/failed").join(target.name)) else {
        return;
    };
    for entry in folder {
        let path = entry.expect("the folder is readable").path();
        attempt(target, &fs::read(&path).expect("the input is readable"), &path.display().to_string());
    }
}

/// Tries an input; names it in case of a failure.
fn attempt(target: &Target, input: &[u8], what: &str) {
    let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    if let Err(panic) = outcome {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
        panic!("{what}: {}", text.unwrap_or_default());
    }
}
