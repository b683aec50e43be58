//! Mistakes do on the released firmware what they do on the model: a wrong channel, a wrong sign, a limit that stops.
//!
//! Where `CC67_FIRMWARE` names a file, every program of `filetests/mistakes` that uses an axis runs on both.

use std::fs;
use std::path::Path;

use harness::{cc67, files, root};
use serde_json::Value;

use crate::boot::firmware;

/// Longest run in seconds of board time.
const LIMIT: &str = "4";

/// Difference of two places that a start some milliseconds later explains: a part of the way, and some units.
const PART: f64 = 0.005;
const UNITS: f64 = 3.0;

/// One axis at the end of a run.
#[derive(Debug)]
struct Axis {
    number: u64,
    is_enabled: bool,
    /// Dest and Position; nothing for what is not a number.
    places: [Option<f64>; 2],
}

impl Axis {
    fn is_like(&self, other: &Self) -> bool {
        let is_near = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() <= UNITS + PART * a.abs().max(b.abs()),
            (None, None) => true,
            _ => false,
        };
        (self.number, self.is_enabled) == (other.number, other.is_enabled)
            && self.places.iter().zip(&other.places).all(is_near)
    }
}

/// The arguments of a program that is executed.
fn arguments(program: &Path) -> Option<Vec<String>> {
    let text = fs::read_to_string(program).expect("programs are UTF-8");
    let words = text.lines().find_map(|line| line.strip_prefix("//@ args: ")).unwrap_or_default();
    let mut words: Vec<_> = words.split(' ').filter(|word| !word.is_empty()).map(str::to_owned).collect();
    if !words.iter().any(|word| word == "--for") {
        words.extend(["--for".to_owned(), LIMIT.to_owned()]);
    }
    let uses_axis = text.contains("ch0->") || text.contains("ch1->");
    (words[0] != "check" && uses_axis).then_some(words)
}

/// Runs a program and returns its axes.
fn axes(program: &Path, boot: &[&str], arguments: &[String]) -> Vec<Axis> {
    let folder = program.parent().expect("a folder");
    let name = program.to_str().expect("a name of text");
    let words = ["run", "--json"].iter().chain(boot).copied();
    let words = words.chain(arguments.iter().map(String::as_str)).chain([name]);
    let output = cc67(folder, words.collect::<Vec<_>>());
    let last = output.stdout.lines().last().unwrap_or_default();
    let end: Value = serde_json::from_str(last).unwrap_or_else(|_| panic!("{name}: {output:?}"));
    let axis = |axis: &Value| Axis {
        number: axis["axis"].as_u64().expect("a number"),
        is_enabled: axis["enabled"].as_bool().expect("a flag"),
        places: [axis["dest"].as_f64(), axis["position"].as_f64()],
    };
    end["axes"].as_array().map(|all| all.iter().map(axis).collect()).unwrap_or_default()
}

#[test]
fn mistakes_do_the_same_on_the_firmware() {
    let Some(firmware) = firmware() else { return };
    let programs = files(&root().join("tests/filetests/mistakes"), "c");
    let programs = programs.iter().filter(|path| !path.components().any(|part| part.as_os_str() == "parts"));
    let mut compared = 0;
    let mut wrong = Vec::new();
    for program in programs {
        let Some(arguments) = arguments(program) else { continue };
        let model = axes(program, &[], &arguments);
        let witness = axes(program, &["--boot", &firmware], &arguments);
        let pairs =
            model.iter().filter_map(|axis| Some((axis, witness.iter().find(|b| b.number == axis.number)?)));
        for (model, witness) in pairs {
            compared += 1;
            if !model.is_like(witness) {
                wrong.push(format!("{}: {model:?}, the firmware {witness:?}", program.display()));
            }
        }
    }
    assert!(compared >= 80, "only {compared} axes");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
