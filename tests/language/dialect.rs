//! Every statement of the dialect has a test, and every test of the dialect names its statement.
//!
//! `data/dialect/rows.csv` lists the statements by section. The tests of `2.1/crlf-lines` are the programs
//! `filetests/dialect/2.1/crlf-lines.c` and `crlf-lines.*.c`, so a failing test names the violated statement. A
//! statement that a program alone cannot test names its test in the column `tested_by`: a function as
//! `tests/command/run.rs::name`, or a program elsewhere as `filetests/board/bits`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use harness::csv::{Row, read};

fn rows() -> Vec<Row> {
    read(&harness::root().join("tests/data/dialect/rows.csv"))
}

/// Test programs of the dialect by the id of their statement.
fn programs() -> BTreeMap<String, usize> {
    let folder = harness::root().join("tests/filetests/dialect");
    let mut programs = BTreeMap::new();
    for path in harness::files(&folder, "c") {
        let relative = path.strip_prefix(&folder).expect("it lies there");
        if relative.components().any(|part| part.as_os_str() == "parts") {
            continue;
        }
        let section = relative.parent().expect("a file has a folder").to_string_lossy();
        let name = relative.file_name().expect("a file has a name").to_string_lossy();
        let name = name.split('.').next().unwrap_or_default();
        *programs.entry(format!("{section}/{name}")).or_default() += 1;
    }
    programs
}

/// Returns whether a test named in `tested_by` exists.
fn exists(test: &str) -> bool {
    match test.split_once("::") {
        None => harness::root().join("tests").join(test).with_extension("c").is_file(),
        Some((file, function)) => {
            let text = fs::read_to_string(harness::root().join(file)).unwrap_or_default();
            let is_rust = Path::new(file).extension().is_some_and(|extension| extension == "rs");
            is_rust && text.contains(&format!("fn {function}("))
        }
    }
}

#[test]
fn every_statement_has_a_test() {
    let programs = programs();
    let untested: Vec<_> = rows()
        .into_iter()
        .filter(|row| match row["tested_by"].as_str() {
            "" => !programs.contains_key(&row["id"]),
            tests => !tests.split_whitespace().all(exists),
        })
        .map(|row| format!("{}  {}  {}", row["id"], row["title"], row["tested_by"]))
        .collect();
    assert!(untested.is_empty(), "{} without a test:\n{}", untested.len(), untested.join("\n"));
}

#[test]
fn every_test_names_a_statement() {
    let ids: BTreeSet<_> = rows().into_iter().map(|row| row["id"].clone()).collect();
    let strays: Vec<_> = programs().into_keys().filter(|id| !ids.contains(id)).collect();
    assert!(strays.is_empty(), "no statement with this id:\n{}", strays.join("\n"));
}

#[test]
fn ids_are_section_and_name_and_are_unique() {
    let mut seen = BTreeSet::new();
    for row in rows() {
        let id = &row["id"];
        let (section, name) = id.split_once('/').expect("an id is section/name");
        assert!(section.chars().all(|c| c.is_ascii_digit() || c == '.'), "{id}");
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{id}");
        assert!(!row["title"].is_empty(), "{id} has no title");
        assert!(seen.insert(id.clone()), "{id} stands twice");
    }
}
