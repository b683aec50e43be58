//! Every program of `c-programs/` compiles without a word and prints its golden console.
//!
//! The first line of a program is `// cc67: …` and says how it is run: `run` with arguments,
//! among them `also N:FILE` for a program in another thread; or `part of FILE` for one that
//! only makes sense beside another. A file without such a line is included by others.

use std::fs;
use std::path::{Path, PathBuf};

use harness::{Scratch, files, run_in};

/// Options that must not change a byte of what a program prints.
const VARIANTS: &[&[&str]] = &[
    &["--no-shortcuts"],
    #[cfg(feature = "native")]
    &["--engine", "native"],
];

fn folder() -> PathBuf {
    harness::root().join("c-programs")
}

/// How a program wants to be run: the arguments behind `cc67`; `None` if it does not run by itself.
fn arguments(path: &Path) -> Option<Vec<String>> {
    let text = fs::read_to_string(path).expect("programs are UTF-8");
    let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
    let line = text.lines().next()?.strip_prefix("// cc67: ")?;
    let mut words = line.split_whitespace().map(str::to_owned);
    match words.next().as_deref() {
        Some("part") => return None,
        Some("run") => {}
        other => panic!("{}: `{other:?}` is not a way to run a program", path.display()),
    }
    let mut arguments = vec!["run".to_owned()];
    let mut also = Vec::new();
    while let Some(word) = words.next() {
        match word.as_str() {
            "also" => also.extend(words.next()),
            _ => arguments.push(word),
        }
    }
    arguments.push(name);
    arguments.extend(also);
    Some(arguments)
}

#[test]
fn every_program_prints_its_golden_console() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("snapshots/programs");
    settings.set_prepend_module_to_snapshot(false);
    let _bound = settings.bind_to_scope();
    let mut run = 0;
    for path in files(&folder(), "c") {
        let Some(arguments) = arguments(&path) else { continue };
        let directory = path.parent().expect("a file has a folder");
        let scratch = Scratch::new(&format!("program-{run}"));
        let files = ["--files".to_owned(), scratch.path().to_string_lossy().into_owned()];
        let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), directory, arguments.iter().chain(&files));
        for variant in VARIANTS {
            let varied: Vec<_> = arguments
                .iter()
                .chain(&files)
                .cloned()
                .chain(variant.iter().map(ToString::to_string))
                .collect();
            let other = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), directory, &varied);
            assert_eq!(other, output, "{} differs with {variant:?}", path.display());
        }
        let relative = path.strip_prefix(folder()).expect("it lies there").with_extension("");
        let name = relative.to_string_lossy().replace(['/', '\\'], "__");
        insta::assert_snapshot!(name, format!("$ cc67 {}\n{}", arguments.join(" "), output.render()));
        run += 1;
    }
    assert!(run >= 20, "only {run} programs");
}

#[test]
fn every_program_compiles_without_a_word() {
    for path in files(&folder(), "c") {
        if !fs::read_to_string(&path).expect("programs are UTF-8").starts_with("// cc67: ") {
            continue;
        }
        let name = path.to_string_lossy().into_owned();
        let output = run_in(env!("CARGO_BIN_EXE_cc67-under-test"), harness::root(), ["check", &name]);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{name}");
    }
}
