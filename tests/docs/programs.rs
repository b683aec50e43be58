//! Every program of `c-programs/` compiles without messages and produces its expected output, on all engines.

use std::fs;

use harness::{cc67, files};

/// Options that must not change a byte of a program's output.
const VARIANTS: &[&[&str]] = &[&[], &["--", "--no-shortcuts"]];

#[test]
fn every_program_shows_its_golden_console() {
    for variant in VARIANTS {
        let arguments = ["test", "c-programs"].iter().chain(*variant);
        let output = cc67(harness::root(), arguments);
        assert_eq!(output.code, 0, "with {variant:?}:\n{}{}", output.stdout, output.stderr);
        let passed: usize = output
            .stdout
            .split(' ')
            .next()
            .and_then(|word| word.parse().ok())
            .expect("it counts the programs");
        assert!(passed >= 90, "only {passed} programs");
    }
}

/// Programs whose output differs as real code: one prints the duration of its own code, and a remark of the other has
/// no line, because the call goes through a jump inserted by the linker, which has none.
const OTHERWISE: &[&str] = &["io/thermocouple:", "io/digital:"];

#[test]
fn every_program_shows_its_golden_console_as_code_for_the_processor() {
    for level in ["-O0", "-O1", "-O2"] {
        let output = cc67(
            harness::root(),
            ["test", "--engine", "bytecode", "c-programs", "--", "--target", "c67x", level],
        );
        let failed = output.stdout.lines().filter(|line| line.starts_with("FAIL"));
        let failed = failed.filter(|line| !OTHERWISE.iter().any(|name| line.contains(name)));
        let failed: Vec<_> = failed.collect();
        assert!(failed.is_empty(), "{level}: {failed:?}\n{}{}", output.stdout, output.stderr);
    }
}

#[test]
fn every_golden_console_has_its_program() {
    for golden in files(&harness::root().join("c-programs"), "expected") {
        assert!(golden.with_extension("c").exists(), "{} belongs to no program", golden.display());
    }
}

#[test]
fn the_index_lists_every_program_and_nothing_else() {
    let folder = harness::root().join("c-programs");
    let index = fs::read_to_string(folder.join("README.md")).expect("there is an index");
    let listed: Vec<&str> = index
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .filter(|link| link.ends_with(".c"))
        .collect();
    for link in &listed {
        assert!(folder.join(link).exists(), "the index lists {link}, which is not there");
    }
    for golden in files(&folder, "expected") {
        let program = golden.with_extension("c");
        let relative =
            program.strip_prefix(&folder).expect("it lies there").to_string_lossy().replace('\\', "/");
        assert!(listed.contains(&relative.as_str()), "{relative} is not in the index");
    }
}

#[test]
fn every_program_compiles_without_messages() {
    for path in files(&harness::root().join("c-programs"), "c") {
        if !fs::read_to_string(&path).expect("programs are UTF-8").starts_with("// cc67: ") {
            continue;
        }
        let name = path.to_string_lossy().into_owned();
        let output = cc67(harness::root(), ["check", &name]);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}");
    }
}

/// Returns the position in a move from rest over 20 units, by the textbook: 200 units/s, 2000 units/s², 100000
/// units/s³.
fn textbook(time: f64) -> f64 {
    const A: f64 = 2000.0;
    const J: f64 = 100_000.0;
    const LENGTH: f64 = 20.0;
    let ramp = A / J;
    // The peak is below 200: 12 units are needed to reach that speed and 12 to stop.
    let peak = A / 2.0 * ((ramp * ramp + 4.0 * LENGTH / A).sqrt() - ramp);
    let constant = peak / A - ramp;
    let (mut x, mut v, mut a, mut left) = (0.0, 0.0, 0.0, time.max(0.0));
    let phases = [(ramp, J), (constant, 0.0), (ramp, -J), (ramp, -J), (constant, 0.0), (ramp, J)];
    for (duration, jerk) in phases {
        let t = left.min(duration);
        x += ((jerk / 6.0 * t + a / 2.0) * t + v) * t;
        v += (jerk / 2.0 * t + a) * t;
        a += jerk * t;
        left -= t;
    }
    x
}

#[test]
fn recorded_coils_follow_the_recorded_move_which_follows_the_textbook() {
    const TICK: f64 = 90e-6;
    let text =
        fs::read_to_string(harness::root().join("c-programs/gather/pwm_log.expected")).expect("a golden");
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let rows: Vec<[f64; 4]> = text
        .lines()
        .map(|line| line.split(',').map(number).collect::<Vec<_>>().try_into().expect("four columns"))
        .collect();
    assert_eq!(rows.len(), 556);
    for (index, &[sample, sine, cosine, position]) in rows.iter().enumerate() {
        assert_eq!(sample, 10.0 * index as f64);
        let angle = std::f64::consts::TAU * position;
        // Positions are printed with four digits, coil outputs are whole counts.
        assert!((sine - 200.0 * libm::sin(angle)).abs() < 0.6, "sample {sample}");
        assert!((cosine - 200.0 * libm::cos(angle)).abs() < 0.6, "sample {sample}");
    }
    // The move begins a few ticks after the recording.
    let follows = |late: f64| {
        rows.iter().all(|&[sample, .., position]| (textbook((sample - late) * TICK) - position).abs() < 6e-5)
    };
    assert!((0..10).any(|late| follows(f64::from(late))));
}
