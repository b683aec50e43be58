//! Doc comments are sentences or noun phrases, as in the standard library: "Returns the …", "The axis that …".

use std::fs;

use crate::{files, root};

/// The first words of noun clauses, which name a subject only by a question about it.
const QUESTIONS: [&str; 7] = ["What", "Where", "Whether", "How", "Who", "Why", "Which"];

/// The allowed share of such doc comments: one in this many.
const ONE_IN: usize = 50;

/// The marker and the text of a line of a doc comment.
fn doc_line(line: &str) -> Option<(&str, &str)> {
    let line = line.trim_start();
    let is_doc = (line.starts_with("///") && !line.starts_with("////")) || line.starts_with("//!");
    is_doc.then(|| line.split_at(3))
}

/// The first word of each doc comment of a source; consecutive lines are one comment.
fn first_words(source: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut before = None;
    for line in source.lines() {
        let line = doc_line(line);
        if let Some((marker, text)) = line
            && before != Some(marker)
        {
            let is_letter = |c: char| c.is_alphanumeric() || c == '_';
            found.extend(text.split(|c| !is_letter(c)).find(|word| !word.is_empty()));
        }
        before = line.map(|(marker, _)| marker);
    }
    found
}

#[test]
fn doc_comments_are_sentences_or_noun_phrases() {
    let sources: Vec<_> =
        files(root(), "rs").iter().map(|file| fs::read_to_string(file).expect("sources are UTF-8")).collect();
    let words: Vec<_> = sources.iter().flat_map(|source| first_words(source)).collect();
    let questions = words.iter().filter(|word| QUESTIONS.contains(word)).count();
    println!("{questions} of {} doc comments begin with a word of {QUESTIONS:?}", words.len());
    assert!(words.len() > 10_000, "comments are not found: {}", words.len());
    assert!(
        questions * ONE_IN <= words.len(),
        "{questions} of {} doc comments are noun clauses",
        words.len()
    );
}

#[test]
fn the_first_word_of_each_comment_is_found() {
    let source = "//! `a` b.\n//! Who?\n\n/// What c\n/// d\nfn e() {} // Why\n    /// **How**\n    f: g,\n//// Where\n";
    assert_eq!(first_words(source), ["a", "What", "How"]);
}
