//! Runs every program of `filetests/`, each as a test of its own name, and holds it to what it states.
//!
//! The directives are described in `harness/filetest.rs`. Files in a folder `parts` are not tests:
//! programs include them. With the feature `native` every program runs on both engines, which must agree.

use std::path::Path;
use std::process::ExitCode;

use harness::filetest::FileTest;
use libtest_mimic::{Arguments, Failed, Trial};

/// Options that must not change a byte of what a program prints.
const VARIANTS: &[&[&str]] = &[
    #[cfg(feature = "native")]
    &["--engine", "bytecode"],
];

fn main() -> ExitCode {
    let folder = harness::root().join("tests/filetests");
    let trials = harness::files(&folder, "c")
        .into_iter()
        .filter(|path| !path.components().any(|part| part.as_os_str() == "parts"))
        .map(|path| {
            let name = path.strip_prefix(&folder).expect("it lies there").with_extension("");
            Trial::test(name.to_string_lossy().replace('\\', "/"), move || check(&path))
        })
        .collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

fn check(path: &Path) -> Result<(), Failed> {
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
    Ok(())
}

/// Snapshots have their place beside the program that they belong to.
fn snapshots_in(folder: &Path) -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings
}
