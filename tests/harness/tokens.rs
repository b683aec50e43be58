//! Rust sources as flat lists of tokens, and the texts in them that are read by people.

use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};

/// A token, and its line, counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// Its text; `"` for a string, `'` for a character. `::`, `->` and `=>` are single tokens.
    pub text: String,
    /// Its line.
    pub line: usize,
    /// The text between the quotes of a string, as written.
    pub inside: String,
}

/// Returns the tokens of a source, without comments and without items that are only for tests.
#[must_use]
pub fn tokens(source: &str) -> Vec<Token> {
    let mut found = Vec::new();
    flatten(parsed(source), false, &mut found);
    found
}

/// Returns the strings and the doc comments of a source, including those of tests, each with its first line.
///
/// Consecutive lines of a doc comment are one text.
#[must_use]
pub fn texts(source: &str) -> Vec<(usize, String)> {
    let mut all = Vec::new();
    flatten(parsed(source), true, &mut all);
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut next_line = 0;
    for Token { text, line, inside } in all {
        match text.as_str() {
            DOC if line == next_line => {
                let (_, before) = found.last_mut().expect("the line before is a doc comment");
                before.push('\n');
                before.push_str(&inside);
                next_line += 1;
            }
            DOC => {
                next_line = line + 1;
                found.push((line, inside));
            }
            "\"" => found.push((line, inside)),
            _ => {}
        }
    }
    found
}

/// Returns the index after the bracket that closes the one at `at`.
#[must_use]
pub fn closing(tokens: &[Token], at: usize) -> usize {
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

/// The text of the token for a line of a doc comment.
const DOC: &str = "///";

fn parsed(source: &str) -> TokenStream {
    source.parse().expect("sources are Rust")
}

/// Adds the tokens of a stream; with `everything`, including doc comments and test items.
fn flatten(stream: TokenStream, everything: bool, found: &mut Vec<Token>) {
    let trees: Vec<TokenTree> = stream.into_iter().collect();
    let mut at = 0;
    while at < trees.len() {
        if let Some((attribute, end)) = attribute(&trees, at) {
            if let Some(text) = attribute.strip_prefix("doc = ") {
                if everything {
                    found.push(Token { text: DOC.to_owned(), line: line(&trees[at]), inside: inside(text) });
                }
                at = end;
                continue;
            }
            if !everything && is_for_tests(&attribute) {
                at = item_end(&trees, end);
                continue;
            }
        }
        if let Some(sign) = joined(&trees[at..]) {
            found.push(Token { text: sign.to_owned(), line: line(&trees[at]), inside: String::new() });
            at += 2;
            continue;
        }
        push(&trees[at], everything, found);
        at += 1;
    }
}

/// Returns the two-character sign at the beginning of some trees, whose characters are separate tokens.
fn joined(trees: &[TokenTree]) -> Option<&'static str> {
    let [TokenTree::Punct(first), TokenTree::Punct(second), ..] = trees else { return None };
    let is_joint = first.spacing() == Spacing::Joint;
    match (first.as_char(), second.as_char()) {
        (':', ':') if is_joint => Some("::"),
        ('-', '>') if is_joint => Some("->"),
        ('=', '>') if is_joint => Some("=>"),
        _ => None,
    }
}

/// Adds a token, or those of a group with its brackets.
fn push(tree: &TokenTree, everything: bool, found: &mut Vec<Token>) {
    let token = |text: &str, span: Span| Token {
        text: text.to_owned(),
        line: span.start().line,
        inside: String::new(),
    };
    match tree {
        TokenTree::Group(group) => {
            let (open, close) = match group.delimiter() {
                Delimiter::Parenthesis => ("(", ")"),
                Delimiter::Bracket => ("[", "]"),
                Delimiter::Brace => ("{", "}"),
                Delimiter::None => return flatten(group.stream(), everything, found),
            };
            found.push(token(open, group.span_open()));
            flatten(group.stream(), everything, found);
            found.push(token(close, group.span_close()));
        }
        TokenTree::Literal(literal) => {
            let text = literal.to_string();
            found.push(match text.chars().next_back() {
                Some('"' | '#') => Token { inside: inside(&text), ..token("\"", literal.span()) },
                Some('\'') => token("'", literal.span()),
                _ => token(&text, literal.span()),
            });
        }
        TokenTree::Ident(_) | TokenTree::Punct(_) => found.push(token(&tree.to_string(), tree.span())),
    }
}

fn line(tree: &TokenTree) -> usize {
    tree.span().start().line
}

/// Returns the text between the quotes of a literal.
fn inside(literal: &str) -> String {
    let begin = literal.find('"').map_or(0, |at| at + 1);
    let end = literal.rfind('"').unwrap_or(literal.len()).max(begin);
    literal[begin..end].to_owned()
}

/// Returns the text of the attribute at `at`, and the index after it.
fn attribute(trees: &[TokenTree], at: usize) -> Option<(String, usize)> {
    let is = |at: usize, sign: char| matches!(trees.get(at), Some(TokenTree::Punct(found)) if found.as_char() == sign);
    if !is(at, '#') {
        return None;
    }
    let at = at + 1 + usize::from(is(at + 1, '!'));
    match trees.get(at) {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => {
            Some((group.stream().to_string(), at + 1))
        }
        _ => None,
    }
}

fn is_for_tests(attribute: &str) -> bool {
    let has = |word: &str| attribute.split(|c: char| !c.is_alphanumeric()).any(|part| part == word);
    attribute == "test" || attribute.starts_with("cfg") && has("test") && !has("not")
}

/// Returns the index after the item that begins at `at`, perhaps with more attributes.
fn item_end(trees: &[TokenTree], mut at: usize) -> usize {
    while let Some((_, end)) = attribute(trees, at) {
        at = end;
    }
    let ends = |tree: &TokenTree| match tree {
        TokenTree::Punct(sign) => sign.as_char() == ';',
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Ident(_) | TokenTree::Literal(_) => false,
    };
    trees[at..].iter().position(ends).map_or(trees.len(), |end| at + end + 1)
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
        /// Doc.
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
    let texts = texts("//! a\n//! b\n\n/// c\nfn d() { e(\"f {g}\", r#\"h\"#) } // i\n");
    let expect = [(1, " a\n b"), (4, " c"), (5, "f {g}"), (5, "h")];
    assert_eq!(texts, expect.map(|(line, text)| (line, text.to_owned())));
}
