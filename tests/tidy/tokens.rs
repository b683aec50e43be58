//! Rust source as tokens: words, strings, `::`, `->`, `=>` and single characters, without comments and items under
//! `#[cfg(test)]`; and the texts in a source that people read: strings and doc comments.

/// A token and the line that it is in, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    /// Its text; `"` for a string, `'` for a character or a lifetime's mark.
    pub(crate) text: String,
    /// Its line.
    pub(crate) line: usize,
    /// What is between the quotes of a string, as written.
    pub(crate) inside: String,
}

/// The tokens of a source text.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    let mut all = all_tokens(text);
    all.retain(|token| token.text != DOC);
    without_tests(&all)
}

/// The strings and doc comments of a source text, those of tests included, each with its first line.
///
/// Consecutive lines of a doc comment are one text.
pub(crate) fn texts(text: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut next_line = 0;
    for token in all_tokens(text) {
        match token.text.as_str() {
            DOC if token.line == next_line => {
                let (_, before) = found.last_mut().expect("the line before is a doc comment");
                before.push('\n');
                before.push_str(&token.inside);
                next_line += 1;
            }
            DOC => {
                next_line = token.line + 1;
                found.push((token.line, token.inside));
            }
            "\"" => found.push((token.line, token.inside)),
            _ => {}
        }
    }
    found
}

/// The text of the token of a doc comment.
const DOC: &str = "///";

fn all_tokens(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let (mut found, mut at, mut line) = (Vec::new(), 0, 1);
    while at < chars.len() {
        let start = at;
        let (end, token) = next(&chars, at);
        at = end;
        if let Some(text) = token {
            let inside = match text.as_str() {
                "\"" => inside(&chars[start..at]),
                DOC => chars[start + DOC.len()..at].iter().collect(),
                _ => String::new(),
            };
            found.push(Token { text, line, inside });
        }
        line += chars[start..at].iter().filter(|c| **c == '\n').count();
    }
    found
}

/// Where the token at `at` ends, and its text, if it is not white space or a comment.
fn next(chars: &[char], at: usize) -> (usize, Option<String>) {
    let rest = &chars[at..];
    let has = |text: &str| text.chars().eq(rest.iter().copied().take(text.chars().count()));
    let word = |c: char| c.is_alphanumeric() || c == '_';
    if has("//!") || (has("///") && !has("////")) {
        let end = rest.iter().position(|c| *c == '\n').unwrap_or(rest.len());
        return (at + end, Some(DOC.to_owned()));
    }
    if has("//") {
        return (at + rest.iter().position(|c| *c == '\n').unwrap_or(rest.len()), None);
    }
    if has("/*") {
        return (at + block_comment(rest), None);
    }
    if let Some(length) = string(rest) {
        return (at + length, Some("\"".to_owned()));
    }
    match rest[0] {
        '\'' => (at + character(rest), Some("'".to_owned())),
        c if word(c) => {
            let length = rest.iter().position(|c| !word(*c)).unwrap_or(rest.len());
            (at + length, Some(rest[..length].iter().collect()))
        }
        c if c.is_whitespace() => (at + 1, None),
        _ if has("::") || has("->") || has("=>") => (at + 2, Some(rest[..2].iter().collect())),
        c => (at + 1, Some(c.to_string())),
    }
}

/// What is between the quotes of a string.
fn inside(string: &[char]) -> String {
    let text: String = string.iter().collect();
    let begin = text.find('"').map_or(0, |at| at + 1);
    let end = text.rfind('"').unwrap_or(text.len()).max(begin);
    text[begin..end].to_owned()
}

fn block_comment(rest: &[char]) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at + 1 < rest.len() {
        match (rest[at], rest[at + 1]) {
            ('/', '*') => (depth, at) = (depth + 1, at + 2),
            ('*', '/') if depth == 1 => return at + 2,
            ('*', '/') => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
    }
    rest.len()
}

/// The length of a string that begins here, raw ones and ones of bytes included.
fn string(rest: &[char]) -> Option<usize> {
    let marks = rest.iter().take_while(|c| "brc".contains(**c)).count();
    let hashes = rest[marks..].iter().take_while(|c| **c == '#').count();
    if marks > 2 || rest.get(marks + hashes) != Some(&'"') {
        return None;
    }
    let is_raw = rest[..marks].contains(&'r');
    if hashes > 0 && !is_raw {
        return None;
    }
    let mut at = marks + hashes + 1;
    while at < rest.len() {
        if rest[at] == '\\' && !is_raw {
            at += 2;
            continue;
        }
        let closing = rest[at + 1..].iter().take_while(|c| **c == '#').count();
        if rest[at] == '"' && closing >= hashes {
            return Some(at + 1 + hashes);
        }
        at += 1;
    }
    Some(rest.len())
}

/// The length of a character, or of the mark of a lifetime.
fn character(rest: &[char]) -> usize {
    if rest.get(1) == Some(&'\\') {
        let end = rest.iter().skip(3).position(|c| *c == '\'').unwrap_or(0);
        return end + 4;
    }
    if rest.get(2) == Some(&'\'') { 3 } else { 1 }
}

/// The index after the bracket that closes the one at `at`.
pub(crate) fn closing(tokens: &[Token], at: usize) -> usize {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(at) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return index + 1;
        }
    }
    tokens.len()
}

fn is(tokens: &[Token], at: usize, text: &str) -> bool {
    tokens.get(at).is_some_and(|token| token.text == text)
}

fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let mut kept = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        if is(tokens, at, "#") && is(tokens, at + 1, "[") {
            let end = closing(tokens, at + 1);
            let words: Vec<&str> = tokens[at..end].iter().map(|token| token.text.as_str()).collect();
            let is_test = words.get(2) == Some(&"test")
                || (words.get(2) == Some(&"cfg") && words.contains(&"test") && !words.contains(&"not"));
            if is_test {
                at = item_end(tokens, end);
                continue;
            }
        }
        kept.push(tokens[at].clone());
        at += 1;
    }
    kept
}

/// Where the item that begins at `at`, perhaps with more attributes, ends.
fn item_end(tokens: &[Token], mut at: usize) -> usize {
    while is(tokens, at, "#") && is(tokens, at + 1, "[") {
        at = closing(tokens, at + 1);
    }
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            ";" => return at + 1,
            "{" => return closing(tokens, at),
            "(" | "[" => at = closing(tokens, at),
            _ => at += 1,
        }
    }
    at
}

#[test]
fn comments_strings_and_tests_are_left_out() {
    let text = r##"
        use a::b; // c::d
        /* e /* f */ g */ fn h<'a>(x: &'a str) -> char { let _ = (r#"i " j"#, b"k\"", '\'', 'l', "//"); 'm' }
        #[cfg(test)]
        mod tests { fn n() {} }
        #[cfg(all(test, feature = "x"))]
        use o::p;
        #[cfg(feature = "y")]
        struct Q;
    "##;
    let found: Vec<String> = tokens(text).into_iter().map(|token| token.text).collect();
    assert_eq!(
        found.join(" "),
        "use a :: b ; fn h < ' a > ( x : & ' a str ) -> char { let _ = ( \" , \" , ' , ' , \" ) ; ' } \
         # [ cfg ( feature = \" ) ] struct Q ;"
    );
}

#[test]
fn texts_are_strings_and_doc_comments() {
    let text = "//! a\n//! b\n\n/// c\nfn d() { e(\"f {g}\", r#\"h\"#) } // i\n";
    let texts = texts(text);
    let expect = [(1, " a\n b"), (4, " c"), (5, "f {g}"), (5, "h")];
    assert_eq!(texts, expect.map(|(line, text)| (line, text.to_owned())));
}
