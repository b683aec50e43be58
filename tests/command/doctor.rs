//! `cc67 doctor` and `cc67 --version --verbose`: what a report of a fault needs.

use harness::{Scratch, cc67};

/// The value of a row.
#[track_caller]
fn row<'a>(text: &'a str, name: &str) -> &'a str {
    let found = text.lines().find_map(|line| line.strip_prefix(name)).map(str::trim);
    found.unwrap_or_else(|| panic!("no row {name}:\n{text}"))
}

#[test]
fn the_version_in_full_says_how_the_command_was_built() {
    let scratch = Scratch::new("version");
    let short = cc67(&scratch, ["--version"]);
    for options in [["--version", "--verbose"], ["-v", "-V"]] {
        let output = cc67(&scratch, options);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""));
        let first = output.stdout.lines().next().unwrap_or_default();
        assert_eq!(
            first.split_once(' ').map(|(_, version)| version),
            short.stdout.trim_end().split_once(' ').map(|(_, version)| version)
        );
        assert!(row(&output.stdout, "built for").starts_with(std::env::consts::OS));
        let native = if cfg!(feature = "native") { "native" } else { "native (not built in)" };
        assert_eq!(row(&output.stdout, "engines"), format!("bytecode, {native}, dsp"));
    }
}

#[test]
fn doctor_shows_all_parts_on_one_screen() {
    let scratch = Scratch::new("doctor");
    let output = cc67(&scratch, ["doctor"]);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{}", output.stdout);
    assert!(output.stdout.lines().count() <= 24, "{}", output.stdout);
    let examples =
        row(&output.stdout, "examples").split(' ').next().and_then(|count| count.parse::<u32>().ok());
    assert!(examples.is_some_and(|count| count >= 100), "{}", output.stdout);
    assert_eq!(row(&output.stdout, "firmware"), "KFLOP 4.34 Build 16:07:06 Aug 14 2018 (modelled)");
    for name in ["command", "editors", "Python", "controller"] {
        assert!(!row(&output.stdout, name).is_empty(), "{}", output.stdout);
    }
}

#[test]
fn a_file_that_is_no_firmware_is_refused_by_doctor() {
    let scratch = Scratch::new("doctor-boot");
    scratch.write("other.out", "not a firmware");
    let output = cc67(&scratch, ["doctor", "--boot", "other.out"]);
    assert_eq!((output.code, output.stdout.as_str()), (2, ""));
    assert!(output.stderr.starts_with("cc67: other.out: "), "{}", output.stderr);
}
