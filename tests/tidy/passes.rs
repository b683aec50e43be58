//! A pass that has a row and no turn would pass its tests, and change no program.

use std::ops::Range;

use crate::shapes::sources;
use crate::tokens::{Token, closing};

/// Where the rows are.
const TABLE: &str = "cc67/compiler/src/passes/mod.rs";

fn text(tokens: &[Token], at: usize) -> &str {
    tokens.get(at).map_or("", |token| token.text.as_str())
}

/// The rows: from the name of the table to its end.
fn rows(tokens: &[Token]) -> Range<usize> {
    let name =
        (0..tokens.len()).find(|at| text(tokens, *at) == "ALL").expect("there is a table of all passes");
    let value = (name..tokens.len()).find(|at| text(tokens, *at) == "=").expect("the table has rows");
    let open = (value..tokens.len()).find(|at| text(tokens, *at) == "[").expect("the table is a list");
    name..closing(tokens, open)
}

#[test]
fn every_pass_is_run() {
    let all = sources();
    let (_, table) = all.iter().find(|(file, _)| file == TABLE).expect("the table of passes is there");
    let rows = rows(table);
    let names: Vec<_> =
        table[rows.clone()].iter().filter(|token| token.text == "\"").map(|token| &token.inside).collect();
    assert!(names.len() > 5, "rows are not found: {names:?}");
    let calls = |name: &str| {
        let mut elsewhere = (0..table.len()).filter(|at| !rows.contains(at));
        elsewhere.any(|at| text(table, at) == name && text(table, at + 1) == "::")
    };
    let idle: Vec<_> = names.into_iter().filter(|name| !calls(name)).collect();
    assert!(idle.is_empty(), "these passes have no turn in {TABLE}: {idle:?}");
}
