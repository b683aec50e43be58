//! Structures of a size that one can hold in mind, and names that mean one thing.

use std::collections::BTreeMap;
use std::fs;

use crate::imports::is_test;
use crate::tokens::{Token, closing, tokens};
use crate::{files, relative, root};

/// The most fields of a structure that is neither a table nor a list of arguments.
const FIELDS: usize = 12;

/// Structures that still have more; the number may only fall.
const LARGE: &[(&str, usize)] = &[];

/// The most types of one name.
const SHARED: usize = 3;

/// The tokens of every source file but those of tests.
pub(crate) fn sources() -> Vec<(String, Vec<Token>)> {
    let read = |path: &std::path::PathBuf| fs::read_to_string(path).expect("sources are UTF-8");
    files(root(), "rs")
        .iter()
        .map(|path| (relative(path), path))
        .filter(|(name, _)| !is_test(name) && name.contains("/src/") && !name.starts_with("tests/"))
        .map(|(name, path)| (name, tokens(&read(path))))
        .collect()
}

/// How many fields the structure has whose name is at `at`.
fn fields(tokens: &[Token], at: usize) -> usize {
    let Some(open) = (at..tokens.len()).find(|index| ["{", ";", "("].contains(&tokens[*index].text.as_str()))
    else {
        return 0;
    };
    if tokens[open].text == ";" {
        return 0;
    }
    let end = closing(tokens, open) - 1;
    let (mut count, mut angles, mut has_any, mut index) = (0, 0_i32, false, open + 1);
    while index < end {
        match tokens[index].text.as_str() {
            "#" => {
                index = closing(tokens, index + 1);
                continue;
            }
            "(" | "[" | "{" => {
                index = closing(tokens, index);
                has_any = true;
                continue;
            }
            "<" => angles += 1,
            ">" => angles -= 1,
            "," if angles == 0 => {
                count += 1;
                has_any = false;
                index += 1;
                continue;
            }
            _ => {}
        }
        has_any = true;
        index += 1;
    }
    count + usize::from(has_any)
}

/// Whether the attributes before `at` make the structure a list of arguments.
fn is_argument_list(tokens: &[Token], at: usize) -> bool {
    let start = at.saturating_sub(60);
    let before = &tokens[start..at];
    let since =
        before.iter().rposition(|token| ["}", ";"].contains(&token.text.as_str())).map_or(0, |end| end + 1);
    before[since..].iter().any(|token| ["Args", "Parser", "Subcommand"].contains(&token.text.as_str()))
}

#[test]
fn no_structure_has_too_many_fields() {
    let known: BTreeMap<&str, usize> = LARGE.iter().copied().collect();
    let mut wrong = Vec::new();
    for (file, tokens) in sources() {
        for at in 1..tokens.len() {
            if tokens[at - 1].text != "struct" || is_argument_list(&tokens, at) {
                continue;
            }
            let (name, count) = (&tokens[at].text, fields(&tokens, at));
            let key = format!("{} {name}", file.split("/src/").next().unwrap_or_default());
            if count > known.get(key.as_str()).copied().unwrap_or(FIELDS) {
                wrong.push(format!("(\"{key}\", {count}), // {file}"));
            }
        }
    }
    assert!(wrong.is_empty(), "more than {FIELDS} fields:\n{}", wrong.join("\n"));
}

#[test]
fn no_name_is_used_for_more_than_three_types() {
    const KINDS: [&str; 5] = ["struct", "enum", "trait", "union", "type"];
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, tokens) in sources() {
        let mut at = 0;
        while at + 1 < tokens.len() {
            match tokens[at].text.as_str() {
                // Only names of the file's own level.
                "{" | "(" | "[" => at = closing(&tokens, at),
                kind if KINDS.contains(&kind) => {
                    places.entry(tokens[at + 1].text.clone()).or_default().push(file.clone());
                    at += 2;
                }
                _ => at += 1,
            }
        }
    }
    let wrong: Vec<_> = (places.iter())
        .filter(|(_, files)| files.len() > SHARED)
        .map(|(name, files)| format!("{name}: {}", files.join(" ")))
        .collect();
    assert!(wrong.is_empty(), "more than {SHARED} types of one name:\n{}", wrong.join("\n"));
}
