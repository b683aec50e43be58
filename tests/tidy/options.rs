//! An option that nothing reads would be accepted and do nothing. The compiler does not see it: what the library of
//! command lines derives counts as a use.

use crate::shapes::sources;
use crate::tokens::{Token, closing};

/// Fields of argument structures, with their file: what follows `#[arg(…)]`.
fn options(file: &str, tokens: &[Token]) -> Vec<(String, String)> {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let attribute = |at: usize| text(at) == "#" && text(at + 1) == "[" && text(at + 2) == "arg";
    let field = |at: usize| (at..tokens.len()).find(|at| text(at + 1) == ":" && text(at + 2) != ":");
    let begins = (0..tokens.len()).filter(|at| attribute(*at));
    begins
        .filter_map(|at| field(closing(tokens, at + 1)))
        .map(|at| (file.to_owned(), text(at).to_owned()))
        .collect()
}

/// Whether the tokens use a field: after a dot, or by its name alone, as patterns do.
fn uses(tokens: &[Token], name: &str) -> bool {
    tokens.iter().enumerate().any(|(at, token)| {
        let after_dot = at > 0 && tokens[at - 1].text == ".";
        let before_colon = tokens.get(at + 1).is_some_and(|next| next.text == ":");
        token.text == name && (after_dot || !before_colon)
    })
}

#[test]
fn every_option_has_an_effect() {
    let command: Vec<_> = sources().into_iter().filter(|(file, _)| file.starts_with("cc67/src/")).collect();
    let options: Vec<_> = command.iter().flat_map(|(file, tokens)| options(file, tokens)).collect();
    assert!(options.len() > 100, "options are not found: {}", options.len());
    let idle: Vec<_> =
        options.iter().filter(|(_, name)| !command.iter().any(|(_, tokens)| uses(tokens, name))).collect();
    assert!(idle.is_empty(), "nothing reads these options: {idle:?}");
}
