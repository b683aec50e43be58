//! The messages of the compiler, found in its sources, as a chapter of the book.
//!
//! A message is the last argument of `Diagnostic::error` or a similar function: a text, a format, a variable with one
//! of several texts, or a parameter, whose texts are in the calls of that function. Texts of lints and of preprocessor
//! and linker errors are stored in separate values, with a field `message` or an attribute `error`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use harness::tokens::{Token, closing, tokens};

/// The constructors of a diagnostic, and the kind that each creates.
const KINDS: &[(&str, &str)] = &[
    ("error", "error"),
    ("global_error", "error"),
    ("warning", "warning"),
    ("global_warning", "warning"),
    ("requested_warning", "warning"),
    ("remark", "note"),
];

/// A message of the compiler.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Message {
    /// Its text with the names of its arguments in braces.
    pub(crate) text: String,
    /// `error`, `warning` or `note`.
    pub(crate) kind: &'static str,
    /// The part of the compiler that reports it: a folder of its sources.
    pub(crate) part: String,
}

/// A source file: its path relative to the compiler's folder, and its tokens.
pub(crate) struct Source {
    path: String,
    tokens: Vec<Token>,
}

/// The sources of the compiler, except those of tests.
pub(crate) fn sources(folder: &Path) -> Vec<Source> {
    let files = harness::files(folder, "rs").into_iter();
    files
        .map(|file| {
            let path =
                file.strip_prefix(folder).expect("the file is there").to_string_lossy().replace('\\', "/");
            (path, fs::read_to_string(&file).expect("sources are UTF-8"))
        })
        .filter(|(path, _)| !path.contains("tests") && !path.starts_with("render/"))
        .map(|(path, text)| Source { path, tokens: tokens(&text) })
        .collect()
}

/// All messages, and the positions of those whose texts were not found.
pub(crate) fn messages(sources: &[Source]) -> (BTreeSet<Message>, Vec<String>) {
    let (mut found, mut unknown) = (BTreeSet::new(), Vec::new());
    // Code that creates a diagnostic for any message has none of its own.
    for source in sources.iter().filter(|source| !source.path.starts_with("diag/")) {
        let part = source.path.split(['/', '.']).next().unwrap_or_default().to_owned();
        for (at, kind) in constructors(&source.tokens) {
            let arguments = arguments(&source.tokens, at);
            let Some(last) = arguments.last() else { continue };
            let is_link = source.path == "link/error.rs";
            if is_kept_elsewhere(last) || is_link {
                continue;
            }
            let texts = texts(sources, source, at, last, 0);
            if texts.is_empty() {
                unknown.push(format!("{}:{}", source.path, source.tokens[at].line));
            }
            found.extend(texts.into_iter().map(|text| Message { text, kind, part: part.clone() }));
        }
        found.extend(kept(sources, source).into_iter().map(|(kind, text)| Message {
            text,
            kind,
            part: part.clone(),
        }));
    }
    (found, unknown)
}

/// The texts of values whose message becomes a diagnostic elsewhere: those in an attribute `error`, and, in files whose
/// structures have a field `message`, the values of that field.
fn kept(sources: &[Source], source: &Source) -> Vec<(&'static str, String)> {
    let tokens = &source.tokens;
    let is = |at: usize, text: &str| tokens.get(at).is_some_and(|token| token.text == text);
    let mut found = Vec::new();
    if source.path.starts_with("link/") {
        for at in
            (0..tokens.len()).filter(|at| is(*at, "error") && is(at + 1, "(") && is(at.wrapping_sub(1), "["))
        {
            let warns = tokens[at..].iter().take(12).any(|token| token.text == "EntersOtherThreads");
            let kind = if warns { "warning" } else { "error" };
            found.extend(strings(&tokens[at..closing(tokens, at + 1)]).into_iter().map(|text| (kind, text)));
        }
    }
    let kind = if source.path.starts_with("lints/") { "warning" } else { "error" };
    let structs = (0..tokens.len()).filter(|at| is(*at, "struct") && is(at + 2, "{"));
    let has_message =
        |at: usize| tokens[at..closing(tokens, at + 2)].iter().any(|token| token.text == "message");
    if !structs.clone().any(has_message) {
        return found;
    }
    for at in 0..tokens.len() {
        let texts = match tokens[at].text.as_str() {
            "let" if is(at + 1, "message") => strings(&tokens[at..statement_end(tokens, at)]),
            "message" if is(at + 1, ":") && is(at + 2, "\"") => strings(&tokens[at + 2..at + 3]),
            "message" if is(at + 1, ":") && is(at + 2, "format") => {
                strings(&tokens[at..closing(tokens, at + 4)])
            }
            "problem" | "finding" | "new" if is(at + 1, "(") && !is(at - 1, "fn") => {
                arguments(tokens, at + 1)
                    .iter()
                    .take(2)
                    .flat_map(|argument| texts(sources, source, at, argument, 4))
                    .collect()
            }
            _ => Vec::new(),
        };
        found.extend(texts.into_iter().map(|text| (kind, text)));
    }
    found
}

/// The positions of the parentheses after `Diagnostic::KIND`, with the kind.
fn constructors(tokens: &[Token]) -> Vec<(usize, &'static str)> {
    let is = |at: usize, text: &str| tokens.get(at).is_some_and(|token| token.text == text);
    (0..tokens.len())
        .filter(|at| is(*at, "Diagnostic") && is(at + 1, "::") && is(at + 3, "("))
        .filter_map(|at| {
            let (_, kind) = KINDS.iter().find(|(name, _)| is(at + 2, name))?;
            Some((at + 3, *kind))
        })
        .collect()
}

/// The arguments between the parenthesis at `at` and its closing one.
fn arguments(tokens: &[Token], at: usize) -> Vec<Vec<Token>> {
    let inside = &tokens[at + 1..closing(tokens, at) - 1];
    let (mut parts, mut depth): (Vec<Vec<Token>>, usize) = (vec![Vec::new()], 0);
    for token in inside {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 0 => {
                parts.push(Vec::new());
                continue;
            }
            _ => {}
        }
        if let Some(part) = parts.last_mut() {
            part.push(token.clone());
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// Returns whether an argument is the message of a value, which [`kept`] finds.
fn is_kept_elsewhere(argument: &[Token]) -> bool {
    let words: Vec<_> = argument.iter().map(|token| token.text.as_str()).collect();
    matches!(words[..], [_, ".", "message"] | ["self", ".", "to_string", "(", ")"])
}

/// The possible texts of an argument.
fn texts(sources: &[Source], source: &Source, at: usize, argument: &[Token], depth: usize) -> Vec<String> {
    const DEEPEST: usize = 4;
    let own = strings(argument);
    if !own.is_empty() || depth > DEEPEST {
        return own;
    }
    let names = argument.iter().filter(|token| token.text.chars().all(|c| c.is_alphanumeric() || c == '_'));
    let name = match names.map(|token| token.text.as_str()).collect::<Vec<_>>()[..] {
        [name] => name,
        [name, "clone" | "to_owned" | "to_string" | "into"] => name,
        [function, ..] => return of_function(sources, source, function, depth),
        [] => return Vec::new(),
    };
    if name.chars().all(|c| c.is_uppercase() || c == '_') {
        return of_constant(sources, name);
    }
    let begin = function_start(&source.tokens, at);
    if let Some(texts) = of_variable(sources, source, begin, at, name, depth) {
        return texts;
    }
    match parameter(&source.tokens, begin, name) {
        Some((function, index)) => of_calls(sources, function, index, depth),
        None => Vec::new(),
    }
}

/// The name of the function that begins at `begin`, and the index of its parameter with a name, not counting `self`.
fn parameter<'a>(tokens: &'a [Token], begin: usize, name: &str) -> Option<(&'a str, usize)> {
    let function = tokens.get(begin + 1)?;
    let open = begin + tokens[begin..].iter().position(|token| token.text == "(")?;
    let parameters = arguments(tokens, open).into_iter();
    let has = |parameter: &Vec<Token>, name: &str| parameter.iter().take(3).any(|token| token.text == name);
    let index =
        parameters.filter(|parameter| !has(parameter, "self")).position(|parameter| has(&parameter, name))?;
    Some((function.text.as_str(), index))
}

/// The text of a constant.
fn of_constant(sources: &[Source], name: &str) -> Vec<String> {
    let of = |source: &Source| {
        let tokens = &source.tokens;
        let at = tokens.windows(2).position(|pair| pair[0].text == "const" && pair[1].text == name)?;
        Some(strings(&tokens[at..statement_end(tokens, at)]))
    };
    sources.iter().find_map(of).unwrap_or_default()
}

/// The strings in some tokens that read like a sentence.
fn strings(tokens: &[Token]) -> Vec<String> {
    let strings = tokens.iter().filter(|token| token.text == "\"");
    strings.map(|token| unescaped(&token.inside)).filter(|text| text.trim().contains(' ')).collect()
}

/// A string as it is printed.
fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        plain.push_str(before);
        rest = match after.strip_prefix('\n') {
            Some(next) => next.trim_start(),
            None => {
                let mut characters = after.chars();
                plain.extend(characters.next());
                characters.as_str()
            }
        };
    }
    plain + rest
}

/// Returns the index of the `fn` of the function that contains a token.
fn function_start(tokens: &[Token], at: usize) -> usize {
    tokens[..at].iter().rposition(|token| token.text == "fn").unwrap_or(0)
}

/// The texts of the last `let` with a name before `at`.
fn of_variable(
    sources: &[Source],
    source: &Source,
    begin: usize,
    at: usize,
    name: &str,
    depth: usize,
) -> Option<Vec<String>> {
    let tokens = &source.tokens;
    // Several branches may have a variable with this name.
    let is_named = |index: &usize| tokens[*index + 1].text == name && tokens[*index + 2].text == "=";
    let lets = (begin..at).rev().filter(|index| tokens[*index].text == "let");
    let own = lets.clone().filter(is_named);
    let own: Vec<_> = own.flat_map(|index| strings(&tokens[index..statement_end(tokens, index)])).collect();
    if !own.is_empty() {
        return Some(own);
    }
    for index in lets {
        let Some(equals) = tokens[index..at].iter().position(|token| token.text == "=") else { continue };
        if !tokens[index..index + equals].iter().any(|token| token.text == name) {
            continue;
        }
        let end = statement_end(tokens, index + equals + 1);
        let value = &tokens[index + equals + 1..end];
        let own = strings(value);
        return Some(match own.is_empty() {
            false => own,
            true => {
                let value: Vec<_> = value.to_vec();
                texts(sources, source, index, &value, depth + 1)
            }
        });
    }
    None
}

/// The position of the `;` or `else` that ends the statement whose value begins at `at`.
fn statement_end(tokens: &[Token], mut at: usize) -> usize {
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            ";" => return at,
            "(" | "[" | "{" => at = closing(tokens, at),
            _ => at += 1,
        }
    }
    at
}

/// The texts that a function of the same file returns.
fn of_function(sources: &[Source], source: &Source, function: &str, depth: usize) -> Vec<String> {
    let all = std::iter::once(source).chain(sources);
    for source in all {
        let tokens = &source.tokens;
        let begin = tokens.windows(2).position(|pair| pair[0].text == "fn" && pair[1].text == function);
        let Some(begin) = begin else { continue };
        let brace = tokens[begin..].iter().position(|token| token.text == "{").map(|at| begin + at);
        let Some(brace) = brace else { continue };
        let body = &tokens[brace..closing(tokens, brace)];
        let own = strings(body);
        if !own.is_empty() || depth > 0 {
            return own;
        }
    }
    Vec::new()
}

/// The texts that calls of a function pass as the argument with an index.
fn of_calls(sources: &[Source], function: &str, index: usize, depth: usize) -> Vec<String> {
    let mut found = Vec::new();
    for source in sources {
        let tokens = &source.tokens;
        for at in 1..tokens.len().saturating_sub(1) {
            let is_call =
                tokens[at].text == function && tokens[at + 1].text == "(" && tokens[at - 1].text != "fn";
            if !is_call {
                continue;
            }
            if let Some(argument) = arguments(tokens, at + 1).get(index) {
                found.extend(texts(sources, source, at, argument, depth + 1));
            }
        }
    }
    found
}

/// Returns whether a message that was shown matches a text with arguments in braces.
pub(crate) fn is_of(shown: &str, text: &str) -> bool {
    let mut rest = shown;
    let mut parts = text.split('{').enumerate().map(|(index, part)| match index {
        0 => part,
        _ => part.split_once('}').map_or(part, |(_, after)| after),
    });
    let Some(after) = parts.next().and_then(|first| rest.strip_prefix(first)) else { return false };
    rest = after;
    let parts: Vec<_> = parts.collect();
    let Some((last, middle)) = parts.split_last() else { return rest.is_empty() };
    for part in middle {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[test]
fn a_shown_message_is_found_by_its_text() {
    assert!(is_of("`a` has no member `b`", "`{spelled}` has no member `{spelling}`"));
    assert!(is_of("no `main`", "no `main`"));
    assert!(!is_of("no `main` here", "no `main`"));
    assert!(!is_of("`a` has no part `b`", "`{spelled}` has no member `{spelling}`"));
}
