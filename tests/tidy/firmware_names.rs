//! The row of a firmware function says all of it: no other source has a list of such names.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::firmware::function_named;

use crate::shapes::sources;
use crate::tokens::Token;

/// Where the rows are.
const TABLE: &str = "kmotiondef/src/firmware.rs";

/// Files whose words belong to another language that shares names with C, and that language.
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

/// The names of modules in files of their own, those of tests left out.
fn modules(all: &[(String, Vec<Token>)]) -> BTreeSet<String> {
    let declared = |tokens: &[Token]| match tokens {
        [word, name, end] if word.text == "mod" && end.text == ";" => Some(name.text.clone()),
        _ => None,
    };
    all.iter().flat_map(|(_, tokens)| tokens.windows(3).filter_map(declared)).collect()
}

/// Whether a file is the root of a crate or one of these modules.
fn is_module(file: &str, modules: &BTreeSet<String>) -> bool {
    let mut parts = file.strip_suffix(".rs").unwrap_or(file).rsplit('/');
    let name = match parts.next() {
        Some("mod") => parts.next(),
        name => name,
    };
    name.is_some_and(|name| matches!(name, "lib" | "main") || modules.contains(name))
}

#[test]
fn no_list_of_firmware_functions_is_outside_the_table() {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut rows = 0;
    let all = sources();
    let modules = modules(&all);
    for (file, tokens) in all {
        if file == TABLE {
            rows = tokens.iter().filter(|token| function_named(&token.text).is_some()).count();
            continue;
        }
        if !is_module(&file, &modules) || OTHER_LANGUAGES.iter().any(|(other, _)| file.starts_with(other)) {
            continue;
        }
        let names =
            tokens.iter().filter(|token| token.text == "\"" && function_named(&token.inside).is_some());
        let names: Vec<_> = names.map(|token| format!("{} in line {}", token.inside, token.line)).collect();
        if !names.is_empty() {
            found.insert(file, names);
        }
    }
    assert!(rows > 200, "the rows are not found: {rows}");
    assert!(found.is_empty(), "write an attribute of the row, or `Function::Name`: {found:#?}");
}
