//! Matches over instructions, operators and modes name every one of them.
//!
//! An arm `_` would take in whatever is silently added later. It is fine over numbers, texts and pairs of facts.

use crate::shapes::sources;
use crate::tokens::{Token, closing};

/// The enums of which a match names every variant.
const TABLES: &[&str] = &[
    "BinaryOp",
    "Class",
    "CompareOp",
    "ConvertOp",
    "InstKind",
    "Op",
    "OutputMode",
    "Terminator",
    "UnaryOp",
    "Width",
];

/// An arm of a match: its pattern, and where it is.
struct Arm<'a> {
    pattern: &'a [Token],
}

/// The arms of the match whose keyword is at `at`.
fn arms(tokens: &[Token], at: usize) -> Vec<Arm<'_>> {
    let mut open = at + 1;
    while let Some(token) = tokens.get(open) {
        match token.text.as_str() {
            "(" | "[" => open = closing(tokens, open),
            "{" => break,
            _ => open += 1,
        }
    }
    if open >= tokens.len() {
        return Vec::new();
    }
    let end = closing(tokens, open) - 1;
    let mut found = Vec::new();
    let mut start = open + 1;
    while start < end {
        let Some(arrow) = next(tokens, start, end, "=>") else { break };
        found.push(Arm { pattern: &tokens[start..arrow] });
        let body = arrow + 1;
        start = match tokens.get(body).map(|token| token.text.as_str()) {
            Some("{") => closing(tokens, body),
            _ => next(tokens, body, end, ",").map_or(end, |comma| comma + 1),
        };
        if tokens.get(start).is_some_and(|token| token.text == ",") {
            start += 1;
        }
    }
    found
}

/// The next token of this text outside of brackets.
fn next(tokens: &[Token], mut at: usize, end: usize, text: &str) -> Option<usize> {
    while at < end {
        match tokens[at].text.as_str() {
            found if found == text => return Some(at),
            "(" | "[" | "{" => at = closing(tokens, at),
            _ => at += 1,
        }
    }
    None
}

/// The table whose variants the patterns name.
fn table_of(arms: &[Arm<'_>]) -> Option<&'static str> {
    TABLES.iter().copied().find(|table| {
        arms.iter().any(|arm| {
            // The pattern itself, or one of several; not a part of a pair.
            arm.pattern.windows(2).enumerate().any(|(index, pair)| {
                let is_first = index == 0 || ["|", "&", "@"].contains(&arm.pattern[index - 1].text.as_str());
                is_first && pair[0].text == *table && pair[1].text == "::"
            })
        })
    })
}

/// The lines of a file with an arm `_` in a match over a table.
fn silent(tokens: &[Token]) -> Vec<(usize, &'static str)> {
    let keywords = tokens.iter().enumerate().filter(|(_, token)| token.text == "match");
    keywords
        .filter_map(|(at, _)| {
            let arms = arms(tokens, at);
            let table = table_of(&arms)?;
            let silent =
                arms.iter().find(|arm| arm.pattern.first().is_some_and(|token| token.text == "_"))?;
            Some((silent.pattern[0].line, table))
        })
        .collect()
}

#[test]
fn matches_over_tables_name_every_row() {
    let mut found = Vec::new();
    for (file, tokens) in sources() {
        found.extend(silent(&tokens).iter().map(|(line, table)| format!("{file}:{line}: `_` over {table}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_wildcard_arm_is_found() {
    let lines = |text: &str| silent(&crate::tokens::tokens(text));
    assert_eq!(lines("fn f() { match op { Op::Add { a } => { 1 } \n _ => 2, } }"), [(2, "Op")]);
    assert_eq!(lines("match x { Some(Op::Add) => 1, _ => 2 }"), []);
    assert_eq!(lines("match x { Op::Add | Op::Sub => match y { _ => 1 }, Op::Mul => 2 }"), []);
}
