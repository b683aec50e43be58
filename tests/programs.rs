//! Every program of `c-programs/` compiles without a word and shows its golden console, on all engines.

use std::fs;

use harness::{files, run_in};

/// Options that must not change a byte of what a program shows.
const VARIANTS: &[&[&str]] = &[&[], &["--", "--no-shortcuts"]];

#[test]
fn every_program_shows_its_golden_console() {
    for variant in VARIANTS {
        let arguments = ["test", "c-programs"].iter().chain(*variant);
        let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), harness::root(), arguments);
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
fn every_program_compiles_without_a_word() {
    for path in files(&harness::root().join("c-programs"), "c") {
        if !fs::read_to_string(&path).expect("programs are UTF-8").starts_with("// cc67: ") {
            continue;
        }
        let name = path.to_string_lossy().into_owned();
        let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), harness::root(), ["check", &name]);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}");
    }
}
