//! A remark that nobody makes would have a page and a switch, and never be read.

use crate::shapes::sources;
use crate::tokens::{Token, closing};

/// Where the rows are.
const TABLE: &str = "runtime/src/out/remarks.rs";

/// The names of the rows: `Name { … } = "code"`.
fn rows(tokens: &[Token]) -> Vec<&str> {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let is_row = |at: &usize| {
        let end = closing(tokens, at + 1);
        text(at + 1) == "{" && text(end) == "=" && text(end + 1) == "\""
    };
    (0..tokens.len()).filter(is_row).map(text).collect()
}

#[test]
fn every_remark_is_used() {
    let all = sources();
    let (table, others): (Vec<_>, Vec<_>) = all.iter().partition(|(file, _)| file == TABLE);
    let rows: Vec<_> = table.iter().flat_map(|(_, tokens)| rows(tokens)).collect();
    assert!(rows.len() > 50, "rows are not found: {}", rows.len());
    let is_made = |name: &str| {
        let mut pairs = others.iter().flat_map(|(_, tokens)| tokens.iter().zip(tokens.iter().skip(1)));
        pairs.any(|(before, token)| before.text == "::" && token.text == name)
    };
    let idle: Vec<_> = rows.into_iter().filter(|name| !is_made(name)).collect();
    assert!(idle.is_empty(), "nobody makes these remarks: {idle:?}");
}
