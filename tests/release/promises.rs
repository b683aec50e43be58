//! Each promise in the READMEs and the book about installation, editors and packages has a test.
//!
//! `promises.tsv` has a row for each: the page, the words, and the test. The test is a function (`FILE::FUNCTION`), or
//! a script with the words in it that do the work (`SCRIPT: WORDS`), which `.ci/run` or a workflow runs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::{files, relative, root};

/// Words that make a line of a page a promise.
const WORDS: &[&str] = &[
    "F5",
    "Ctrl+Shift+B",
    "cargo install",
    "pip install",
    "ompletion",
    "anual page",
    ".deb",
    "Debian package",
    "winget",
    "scoop",
    "Homebrew",
    "archive",
    "container",
    ".vsix",
    ".whl",
    "cc67 doctor",
    "attest",
    "SHA256SUMS",
    "CycloneDX",
    "THIRD-PARTY",
    "onfiguration* offers",
    "nippets",
];

/// Lines with such a word that are not promises of this kind.
const OTHER: &[(&str, &str)] = &[
    ("debugging.md", "gdb's commands, with completion and history"),
    ("editors.md", "clangd provides completion"),
    ("project/README.md", "clangd: completion and help"),
    ("editors.md", "completion = [{ name"),
    ("from-arduino.md", "pio"),
];

struct Promise {
    page: String,
    text: String,
    kept_by: Vec<String>,
}

/// The rows of the table.
fn promises() -> Vec<Promise> {
    let text = fs::read_to_string(root().join("tests/release/promises.tsv")).expect("the table is there");
    let rows = text.lines().skip(1).map(|line| {
        let [page, text, kept_by] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("three columns: {line}")
        };
        let kept_by = kept_by.split("; ").map(str::to_owned).collect();
        Promise { page: page.to_owned(), text: text.to_owned(), kept_by }
    });
    rows.collect()
}

/// The READMEs for users: of the repository, the extension, the Python package and a new project.
const READMES: &[&str] = &[
    "README.md",
    "cc67/editors/README.md",
    "cc67/editors/vscode/README.md",
    "cc67/python/README.md",
    "cc67/src/cli/commands/init/project/README.md",
];

/// The pages for users: READMEs, and the chapters that are neither generated from tables nor for contributors.
fn pages() -> Vec<(String, String)> {
    const OTHERS: &[&str] =
        &["contributing.md", "architecture.md", "messages.md", "warnings.md", "SUMMARY.md"];
    let folder = root().join("cc67/book/src");
    let chapters = files(&folder, "md").into_iter().filter(|path| path.parent() == Some(&folder));
    let chapters = chapters.filter(|path| !OTHERS.iter().any(|name| path.ends_with(name)));
    let paths = chapters.chain(READMES.iter().map(|name| root().join(name)));
    paths.map(|path| (relative(&path), fs::read_to_string(&path).expect("pages are UTF-8"))).collect()
}

/// The lines of a page that need a row or a test: those with one of the words, and commands for the user that no test
/// of the book runs.
fn lines_of_promises(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut block: Option<&str> = None;
    for line in text.lines() {
        if let Some(info) = line.strip_prefix("```") {
            block = if block.is_some() { None } else { Some(info) };
            continue;
        }
        let is_command = block == Some("sh") && !line.trim().is_empty() && !line.starts_with("cc67 ");
        let is_prose = (block.is_none() && !line.starts_with('#')) || block == Some("sh");
        if is_command || (is_prose && WORDS.iter().any(|word| line.contains(word))) {
            found.push(line);
        }
    }
    found
}

#[test]
fn every_promise_of_a_page_is_in_the_table() {
    assert_eq!(
        lines_of_promises("F5 starts\nplain\n```sh\nmake it\ncc67 run a.c\n```\n```c\nF5\n```\n"),
        ["F5 starts", "make it"]
    );
    let rows = promises();
    let mut open = Vec::new();
    for (page, text) in pages() {
        for line in lines_of_promises(&text) {
            let is_row = rows.iter().any(|row| row.page == page && line.contains(&row.text));
            let is_other = OTHER.iter().any(|(name, part)| page.ends_with(name) && line.contains(part));
            if !is_row && !is_other {
                open.push(format!("{page}: {line}"));
            }
        }
    }
    assert!(open.is_empty(), "promises without a row in tests/release/promises.tsv:\n{}", open.join("\n"));
}

#[test]
fn every_row_is_a_promise_of_its_page() {
    let pages = pages();
    for row in promises() {
        let (_, text) = pages
            .iter()
            .find(|(page, _)| *page == row.page)
            .unwrap_or_else(|| panic!("no page {}", row.page));
        assert!(text.contains(&row.text), "{} does not say: {}", row.page, row.text);
    }
}

/// The texts that run scripts: the check of every commit, the workflows, and scripts that these run.
fn runners() -> String {
    let workflows = files(&root().join(".github/workflows"), "yml").into_iter();
    let scripts = ["run", "dry-run", "archive", "packages"].map(|name| root().join(".ci").join(name));
    workflows.chain(scripts).map(|path| fs::read_to_string(path).expect("scripts are UTF-8")).collect()
}

#[test]
fn what_keeps_a_promise_exists_and_is_run() {
    let runners = runners();
    let mut used = BTreeSet::new();
    for row in promises() {
        for keeper in &row.kept_by {
            used.insert(keeper.clone());
            if let Some((file, function)) = keeper.split_once("::") {
                let text =
                    fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
                let is_test = match Path::new(file).extension().and_then(|suffix| suffix.to_str()) {
                    Some("rs") => text.contains(&format!("#[test]\nfn {function}()")),
                    _ => text.contains(&format!("\ndef {function}(")),
                };
                assert!(is_test, "{file} has no test {function}, which shall keep: {}", row.text);
                continue;
            }
            let (script, words) = keeper.split_once(": ").unwrap_or_else(|| panic!("what is {keeper}?"));
            let text =
                fs::read_to_string(root().join(script)).unwrap_or_else(|error| panic!("{script}: {error}"));
            assert!(text.contains(words), "{script} does not have `{words}`, which shall keep: {}", row.text);
            let is_workflow = script.starts_with(".github/workflows/");
            assert!(is_workflow || script == ".ci/run" || runners.contains(script), "nothing runs {script}");
        }
    }
    assert!(used.len() >= 12, "{used:?}");
}
