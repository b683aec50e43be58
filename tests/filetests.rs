//! Runs every program of `filetests/`, each as a test with its own name, and checks it against its directives.
//!
//! The directives are described in `harness/filetest.rs`. Files in a folder `parts` are not tests:
//! programs include them. A `.txt` file is a test of one stage of the compiler (`harness/stages.rs`). With the feature `native` every program runs on both engines, which must agree.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use harness::filetest::FileTest;
use harness::stages::{self, StageTest};
use libtest_mimic::{Arguments, Failed, Trial};

/// Options that must not change a byte of a program's output.
const VARIANTS: &[&[&str]] = &[
    #[cfg(feature = "native")]
    &["--engine", "bytecode"],
];

fn main() -> ExitCode {
    let is_bless = |word: &String| word == "--bless";
    let is_blessed = std::env::args().any(|word| is_bless(&word));
    let arguments = Arguments::from_iter(std::env::args().filter(|word| !is_bless(word)));
    let folder = harness::root().join("tests/filetests");
    let name_of = |path: &Path| {
        let name = path.strip_prefix(&folder).expect("it lies there").with_extension("");
        name.to_string_lossy().replace('\\', "/")
    };
    let is_part = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "parts");
    let programs = harness::files(&folder, "c").into_iter().filter(|path| !is_part(path));
    let mut trials: Vec<_> =
        programs.map(|path| Trial::test(name_of(&path), move || check(&path, is_blessed))).collect();
    for (room, least) in [("mistakes", 120), ("twins", 60)] {
        let programs =
            harness::files(&folder.join(room), "c").into_iter().filter(|path| !is_part(path)).count();
        trials.push(Trial::test(format!("{room}: at least {least} programs"), move || {
            if programs < least { Err(format!("there are {programs}").into()) } else { Ok(()) }
        }));
    }
    let tests = harness::files(&folder, "txt");
    for (stage, least) in stages::folders() {
        let count = tests.iter().filter(|path| path.starts_with(folder.join(&stage))).count();
        trials.push(Trial::test(format!("{stage}: at least {least} tests"), move || {
            if count < least { Err(format!("there are {count}").into()) } else { Ok(()) }
        }));
    }
    for path in tests {
        let test = StageTest::read(&folder, &path);
        trials.push(Trial::test(name_of(&path), move || test.check(is_blessed).map_err(Failed::from)));
    }
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn check(path: &Path, is_blessed: bool) -> Result<(), Failed> {
    let test = FileTest::read(path);
    let output = test.run(&[]);
    if let Some(complaint) = test.complaint(&output) {
        return Err(complaint.into());
    }
    if test.is_snapshot() {
        let name = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        snapshots_in(test.folder()).bind(|| insta::assert_snapshot!(name, output.stderr));
    }
    for variant in VARIANTS.iter().filter(|_| test.is_executed()) {
        let other = test.run(variant);
        if other != output {
            let (path, variant) = (path.display(), variant.join(" "));
            return Err(
                format!("{path} differs with {variant}\n{}{}", output.render(), other.render()).into()
            );
        }
    }
    check_code(&test)?;
    check_cycles(&test, is_blessed)
}

/// Checks the output of a program as code for the real processor, at every level; programs that end in a trap are only
/// for the other engines.
fn check_code(test: &FileTest) -> Result<(), Failed> {
    let Some(expected) = test.stdout_of_code() else { return Ok(()) };
    for level in ["-O0", "-O1", "-O2"] {
        let output = test.run(&["-w", "--target", "c67x", level]);
        if (output.code, output.stdout.as_str()) != (0, expected) {
            let name = test.folder().display();
            return Err(format!(
                "{name}: as code at {level}, expected\n{}\nnot {}",
                expected,
                output.render()
            )
            .into());
        }
    }
    Ok(())
}

/// Checks that a program states the exact number of cycles that it spends.
fn check_cycles(test: &FileTest, is_blessed: bool) -> Result<(), Failed> {
    let measured = if test.is_executed() { test.measured_cycles() } else { None };
    match (measured, test.cycles()) {
        (found, stated) if found == stated => Ok(()),
        (Some(found), _) if is_blessed => {
            test.state_cycles(found);
            Ok(())
        }
        // A new program states nothing until `--bless` has written it.
        (Some(_), None) => Ok(()),
        (Some(found), Some(stated)) => {
            Err(format!("{found} cycles are spent, not {stated} as stated").into())
        }
        (None, _) => Err("cycles are stated of a program that is not executed by itself".into()),
    }
}

/// Places snapshots next to the program to which they belong.
fn snapshots_in(folder: &Path) -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings
}
