//! An option that nothing reads would be accepted and do nothing. The compiler does not see it: what the library of
//! command lines derives counts as a use.

use crate::shapes::sources;
use crate::tokens::{Token, closing};

/// A field of an argument structure.
#[derive(Debug)]
struct CommandOption {
    file: String,
    structure: String,
    name: String,
}

fn text(tokens: &[Token], at: usize) -> &str {
    tokens.get(at).map_or("", |token| token.text.as_str())
}

/// Fields of argument structures: what follows `#[arg(…)]`.
fn options(file: &str, tokens: &[Token]) -> Vec<CommandOption> {
    let attribute =
        |at: usize| text(tokens, at) == "#" && text(tokens, at + 1) == "[" && text(tokens, at + 2) == "arg";
    let field =
        |at: usize| (at..tokens.len()).find(|at| text(tokens, at + 1) == ":" && text(tokens, at + 2) != ":");
    let structure = |at: usize| (0..at).rev().find(|at| ["struct", "enum"].contains(&text(tokens, *at)));
    let begins = (0..tokens.len()).filter(|at| attribute(*at));
    let found = begins.filter_map(|at| Some((structure(at)? + 1, field(closing(tokens, at + 1))?)));
    found
        .map(|(structure, name)| CommandOption {
            file: file.to_owned(),
            structure: text(tokens, structure).to_owned(),
            name: text(tokens, name).to_owned(),
        })
        .collect()
}

/// Whether a file reads an option: after a dot, where `self` is the structure in its own file alone, or as a part of a
/// pattern of the structure.
fn reads(file: &str, tokens: &[Token], option: &CommandOption) -> bool {
    let is_own = file == option.file;
    let is_of = |at: usize| text(tokens, at) == option.structure || is_own && text(tokens, at) == "Self";
    let mut patterns = Vec::new();
    for at in 1..tokens.len() {
        if is_of(at)
            && text(tokens, at + 1) == "{"
            && !["struct", "enum", "for", "impl"].contains(&text(tokens, at - 1))
        {
            patterns.push(at..closing(tokens, at + 1));
        }
    }
    (2..tokens.len()).filter(|at| text(tokens, *at) == option.name).any(|at| {
        let is_after_dot = text(tokens, at - 1) == "." && text(tokens, at + 1) != "(";
        let is_in_pattern = text(tokens, at + 1) != ":" && patterns.iter().any(|range| range.contains(&at));
        is_after_dot && (is_own || text(tokens, at - 2) != "self") || is_in_pattern
    })
}

#[test]
fn every_option_has_an_effect() {
    let command: Vec<_> = sources().into_iter().filter(|(file, _)| file.starts_with("cc67/src/")).collect();
    let options: Vec<_> = command.iter().flat_map(|(file, tokens)| options(file, tokens)).collect();
    assert!(options.len() > 100, "options are not found: {}", options.len());
    let idle: Vec<_> = options
        .iter()
        .filter(|option| !command.iter().any(|(file, tokens)| reads(file, tokens, option)))
        .map(|CommandOption { file, structure, name }| format!("{file}: {structure}::{name}"))
        .collect();
    assert!(idle.is_empty(), "nothing reads these options: {idle:#?}");
}
