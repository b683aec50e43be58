//! Each list exists only once, and each row of a table is used.

use std::collections::BTreeSet;
use std::fs;

use harness::tokens::{Token, closing, tokens};
use kmotiondef::firmware::function_named;

use crate::imports::is_test;
use crate::{files, relative, root};

/// The table of firmware functions.
const FUNCTIONS: &str = "kmotiondef/src/firmware.rs";

/// Files whose words belong to another language that shares names with C, each with that language.
const OTHER_LANGUAGES: &[(&str, &str)] = &[
    ("runtime/src/commands/", "script commands"),
    ("runtime/src/pc/", "G code, and the buttons of the PC's boxes"),
    ("runtime/src/firmware/math.rs", "functions of the engines"),
    ("runtime/boot/src/rom.rs", "functions of the processor's ROM"),
    ("cc67/compiler/src/watch.rs", "functions of watched expressions"),
    ("cc67/compiler/src/words/", "words of other systems, each with the board's word for it"),
    ("cc67/debug/src/words.rs", "commands of the debugger"),
    ("cc67/src/cli/commands/console/words.rs", "commands of the console"),
    ("cc67/src/cli/commands/compare/random/", "statements and script commands that are drawn"),
    ("cc67/src/record.rs", "columns of vectors"),
    ("cc67/src/cli/commands/explain/topics.rs", "topics"),
    ("cc67/live/src/board/mod.rs", "messages of the page"),
];

/// The tokens of every source file except those of tests.
fn sources() -> Vec<(String, Vec<Token>)> {
    let all = files(root(), "rs").into_iter().map(|path| (relative(&path), path));
    let sources =
        all.filter(|(name, _)| !is_test(name) && name.contains("/src/") && !name.starts_with("tests/"));
    sources
        .map(|(name, path)| (name, tokens(&fs::read_to_string(path).expect("sources are UTF-8"))))
        .collect()
}

/// The names of modules in separate files, except those of tests.
fn modules(all: &[(String, Vec<Token>)]) -> BTreeSet<&str> {
    let declared = |tokens: &'_ [Token]| tokens[0].text == "mod" && tokens[2].text == ";";
    let rows = all.iter().flat_map(|(_, tokens)| tokens.windows(3).filter(|row| declared(row)));
    rows.map(|row| row[1].text.as_str()).chain(["lib", "main"]).collect()
}

#[test]
fn no_list_of_firmware_functions_is_outside_the_table() {
    let mut found = Vec::new();
    let all = sources();
    let modules = modules(&all);
    let is_module = |file: &str| {
        let stem = file.trim_end_matches(".rs").trim_end_matches("/mod");
        stem.rsplit('/').next().is_some_and(|name| modules.contains(name))
    };
    for (file, tokens) in all.iter().filter(|(file, _)| is_module(file)) {
        if file == FUNCTIONS {
            let rows = tokens.iter().filter(|token| function_named(&token.text).is_some()).count();
            assert!(rows > 200, "the rows are not found: {rows}");
        } else if !OTHER_LANGUAGES.iter().any(|(other, _)| file.starts_with(other)) {
            let names =
                tokens.iter().filter(|token| token.text == "\"" && function_named(&token.inside).is_some());
            found.extend(names.map(|token| format!("{file}:{}: {}", token.line, token.inside)));
        }
    }
    assert!(found.is_empty(), "write an attribute of the row, or `Function::Name`: {found:#?}");
}

#[test]
fn every_remark_is_made() {
    let all = sources();
    let (table, others): (Vec<_>, Vec<_>) =
        all.iter().partition(|(file, _)| file == "runtime/src/out/remarks.rs");
    let (_, table) = table[0];
    let text = |at: usize| table.get(at).map_or("", |token| token.text.as_str());
    // `Name { … } = "code"`.
    let is_row = |at: &usize| {
        let end = closing(table, at + 1);
        text(at + 1) == "{" && text(end) == "=" && text(end + 1) == "\""
    };
    let rows: Vec<_> = (0..table.len()).filter(is_row).map(text).collect();
    assert!(rows.len() > 50, "rows are not found: {}", rows.len());
    let mut pairs = others.iter().flat_map(|(_, tokens)| tokens.windows(2));
    let made: Vec<_> = (&mut pairs).filter(|pair| pair[0].text == "::").map(|pair| &*pair[1].text).collect();
    let idle: Vec<_> = rows.into_iter().filter(|name| !made.contains(name)).collect();
    assert!(idle.is_empty(), "nobody makes these remarks: {idle:?}");
}

#[test]
fn every_pass_is_run() {
    let path = root().join("cc67/compiler/src/passes/mod.rs");
    let text = fs::read_to_string(path).expect("the table of passes is there");
    let (before, rest) = text.split_once("pub const ALL: ").expect("there is a table of all passes");
    let (rows, after) = rest.split_once("];\n").expect("the table ends");
    let names: Vec<_> = rows.split("(\"").skip(1).filter_map(|row| row.split('"').next()).collect();
    assert!(names.len() > 5, "rows are not found: {names:?}");
    for name in names {
        let call = format!("{name}::");
        assert!(before.contains(&call) || after.contains(&call), "the pass `{name}` is not run");
    }
}
