//! No text of the repository contains a phrase in the list of worn phrases, `worn-phrases.tsv`.
//!
//! The pages are checked, and the strings and doc comments of the sources. Blocks of code and text in backquotes are
//! ignored.

use std::collections::BTreeMap;
use std::fs;

use harness::tokens::texts;
use harness::{files, relative, root};

/// A phrase of the list.
struct Phrase {
    /// The alternatives for each word; empty for any word.
    words: Vec<Vec<String>>,
    /// The usual words.
    usual: String,
    /// Words after which the phrase is allowed.
    after: Vec<String>,
    /// Words before which the phrase is allowed.
    before: Vec<String>,
}

impl Phrase {
    fn parse(line: &str) -> Self {
        let mut columns = line.split('\t');
        let mut next = || columns.next().unwrap_or_default();
        let list = |text: &str| text.split_whitespace().map(str::to_owned).collect();
        let either = |word: &str| match word {
            "*" => Vec::new(),
            word => word.split('|').map(str::to_owned).collect(),
        };
        Self {
            words: next().split_whitespace().map(either).collect(),
            usual: next().to_owned(),
            after: list(next()),
            before: list(next()),
        }
    }

    /// Returns whether the phrase is at a position of a text.
    fn is_at(&self, text: &[Word], at: usize) -> bool {
        let Some(found) = text.get(at..at + self.words.len()) else { return false };
        let has = |list: &[String], word: Option<&Word>| word.is_some_and(|word| list.contains(&word.text));
        found.iter().zip(&self.words).all(|(word, either)| either.is_empty() || either.contains(&word.text))
            && !has(&self.after, at.checked_sub(1).and_then(|before| text.get(before)))
            && !has(&self.before, text.get(at + self.words.len()))
    }
}

/// A word or punctuation mark of a text.
struct Word {
    text: String,
    line: usize,
}

/// The words of a page in lower case, without code; punctuation marks are words, and a heading begins with `#`.
fn words(page: &str) -> Vec<Word> {
    let mut words = Vec::new();
    let mut is_code = false;
    for (index, line) in page.lines().enumerate() {
        let line_number = index + 1;
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        }
        if is_code || line.starts_with("    ") {
            continue;
        }
        if line.starts_with('#') {
            words.push(Word { text: "#".to_owned(), line: line_number });
        }
        for (part, text) in line.split('`').enumerate() {
            if part % 2 == 1 {
                words.push(Word { text: "`".to_owned(), line: line_number });
                continue;
            }
            let mut rest = text.trim_start_matches('#');
            while let Some(first) = rest.chars().next() {
                let is_letter = |c: char| c.is_alphanumeric() || matches!(c, '\'' | '-' | '_');
                let end = rest.find(|c| !is_letter(c)).unwrap_or(rest.len()).max(first.len_utf8());
                let (word, after) = rest.split_at(end);
                if !word.trim().is_empty() {
                    words.push(Word { text: word.to_lowercase(), line: line_number });
                }
                rest = after;
            }
        }
    }
    words
}

fn phrases() -> Vec<Phrase> {
    let list = fs::read_to_string(root().join("tests/docs/worn-phrases.tsv")).expect("the list exists");
    list.lines().filter(|line| line.contains('\t')).map(Phrase::parse).collect()
}

/// The phrases by each of their first words.
fn by_first_word(phrases: &[Phrase]) -> BTreeMap<&str, Vec<&Phrase>> {
    let mut map: BTreeMap<&str, Vec<&Phrase>> = BTreeMap::new();
    for phrase in phrases {
        for first in phrase.words.first().into_iter().flatten() {
            map.entry(first).or_default().push(phrase);
        }
    }
    map
}

/// The phrases in a text, each with its line and the usual words.
fn found(phrases: &BTreeMap<&str, Vec<&Phrase>>, path: &str, first: usize, text: &str) -> Vec<String> {
    let words = words(text);
    let mut found = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let candidates = phrases.get(word.text.as_str()).into_iter().flatten();
        for phrase in candidates.filter(|phrase| phrase.is_at(&words, at)) {
            let text: Vec<_> =
                words[at..].iter().take(phrase.words.len()).map(|word| word.text.as_str()).collect();
            let line = first + word.line - 1;
            found.push(format!("{path}:{line}: \"{}\": write {}", text.join(" "), phrase.usual));
        }
    }
    found
}

#[test]
fn no_page_has_a_worn_phrase() {
    let phrases = phrases();
    assert!(phrases.len() >= 40, "only {} phrases", phrases.len());
    let phrases = by_first_word(&phrases);
    let mut all = Vec::new();
    for file in files(root(), "md") {
        let path = relative(&file);
        let text = fs::read_to_string(&file).expect("pages are UTF-8");
        all.extend(found(&phrases, &path, 1, &text));
    }
    assert!(all.is_empty(), "{} worn phrases:\n{}", all.len(), all.join("\n"));
}

#[test]
fn no_source_has_a_worn_phrase_in_a_string_or_a_doc_comment() {
    let phrases = phrases();
    let phrases = by_first_word(&phrases);
    let mut all = Vec::new();
    for file in files(root(), "rs") {
        let path = relative(&file);
        // Its tests contain some.
        if path == "tests/docs/phrases.rs" {
            continue;
        }
        let text = fs::read_to_string(&file).expect("sources are UTF-8");
        for (line, text) in texts(&text) {
            all.extend(found(&phrases, &path, line, &unindented(&text)));
        }
    }
    assert!(all.is_empty(), "{} worn phrases:\n{}", all.len(), all.join("\n"));
}

/// A text whose lines lack the blank after comment markers, and in which an escaped newline ends a word and the
/// arguments of a format are left out.
fn unindented(text: &str) -> String {
    let lines = text.lines().map(|line| line.strip_prefix(' ').unwrap_or(line));
    let text = lines.collect::<Vec<_>>().join("\n").replace("\\n", " . ");
    let mut parts = text.split('{');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let after = part.split_once('}').filter(|(name, _)| !name.contains(char::is_whitespace));
        plain.push_str(&format!("{{{}", after.map_or(part, |(_, after)| after)));
    }
    plain
}

#[test]
fn phrases_are_found_across_lines_and_not_in_code() {
    let count = |text: &str| {
        let (phrases, words) = (phrases(), words(text));
        (0..words.len()).filter(|at| phrases.iter().any(|phrase| phrase.is_at(&words, *at))).count()
    };
    assert_eq!(count("It is told\nof once."), 2);
    assert_eq!(count("`behind` and\n```text\nbehind\n```\n"), 0);
    assert_eq!(count("Leave it behind"), 1);
    assert_eq!(count("He left behind"), 0);
    assert_eq!(count("## What stands"), 2);
}
