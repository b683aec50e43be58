//! Rust source as tokens: words, `::`, `->`, `=>` and single characters, without comments, the insides of strings, and
//! items under `#[cfg(test)]`.

/// A token and the line that it stands in, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    /// Its text; `"` for a string, `'` for a character or a lifetime's mark.
    pub(crate) text: String,
    /// Its line.
    pub(crate) line: usize,
}

/// The tokens of a source text.
pub(crate) fn tokens(text: &str) -> Vec<Token> {
    without_tests(&all_tokens(text))
}

fn all_tokens(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let (mut found, mut at, mut line) = (Vec::new(), 0, 1);
    while at < chars.len() {
        let start = at;
        let (end, token) = next(&chars, at);
        at = end;
        if let Some(text) = token {
            found.push(Token { text, line });
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

/// The index behind the bracket that closes the one at `at`.
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
