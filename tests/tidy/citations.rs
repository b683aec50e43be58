//! Every page and section of the book cited in a comment exists.
//!
//! Comments cite pages of `cc67/book/src/board` by file name and section number, as in "io.md sections 5 and 6".

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::{files, relative, root};

/// The comments of a source file; those on adjacent lines are joined by a blank.
fn comments(text: &str) -> String {
    let mut found = String::new();
    for line in text.lines() {
        match line.split_once("//") {
            Some((_, comment)) => found.push_str(comment.trim_start_matches(['/', '!'])),
            None => found.push('\n'),
        }
    }
    found
}

/// The number of a section at the beginning of a text, such as `7`, `4.2` or `D4`, and the rest of the text.
fn section(text: &str) -> Option<(&str, &str)> {
    let digits = text.strip_prefix('D').unwrap_or(text);
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let end = text.len() - digits.trim_start_matches(is_part).len();
    let (number, rest) = text.split_at(end);
    let kept = number.trim_end_matches('.');
    Some((kept, rest))
}

/// The sections listed after the name of a page.
fn sections(after: &str) -> Vec<&str> {
    let mut rest = after.trim_start_matches('`').trim_start_matches(' ');
    rest = rest.strip_prefix("sections ").or_else(|| rest.strip_prefix("section ")).unwrap_or(rest);
    let mut found = Vec::new();
    while let Some((number, after)) = section(rest) {
        found.push(number);
        let next = [", ", " and ", " to "].iter().find_map(|link| after.strip_prefix(link));
        let Some(next) = next else { break };
        rest = next;
    }
    found
}

/// Every page cited in a text, with the sections after its name.
fn citations(text: &str) -> Vec<(&str, Vec<&str>)> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let mut found = Vec::new();
    for (at, mark) in text.match_indices(".md") {
        let (before, after) = (&text[..at], &text[at + mark.len()..]);
        let stem = before.trim_end_matches(is_name).len();
        let is_word = stem < at && !after.starts_with(|c: char| is_name(c) || c == '(');
        if is_word && !before[..stem].ends_with(['.', '*', '{']) {
            found.push((&text[stem..at + mark.len()], sections(after)));
        }
    }
    found
}

/// The sections of a page: headings that begin with a number.
fn headings(text: &str) -> BTreeSet<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings
        .filter_map(|line| section(line.trim_start_matches(['#', ' '])))
        .map(|(number, _)| number.to_owned())
        .collect()
}

#[test]
fn every_cited_page_and_section_is_in_the_book() {
    let mut pages = BTreeMap::new();
    for file in files(root(), "md") {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_reference = relative(&file).starts_with("cc67/book/src/board/");
        if is_reference || !pages.contains_key(&name) {
            pages.insert(name, headings(&fs::read_to_string(&file).expect("pages are UTF-8")));
        }
    }
    let mut broken = Vec::new();
    let mut count = 0;
    for file in files(root(), "rs").into_iter().filter(|file| !relative(file).starts_with("tests/tidy/")) {
        let text = comments(&fs::read_to_string(&file).expect("sources are UTF-8"));
        for (page, sections) in citations(&text) {
            count += 1;
            match pages.get(page) {
                None => broken.push(format!("{} cites {page}, which does not exist", relative(&file))),
                Some(known) => broken.extend(
                    sections
                        .iter()
                        .filter(|number| !known.contains(**number))
                        .map(|number| format!("{} cites {page} {number}: no such section", relative(&file))),
                ),
            }
        }
    }
    assert!(count >= 100, "only {count} citations");
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn citations_are_read_with_their_sections() {
    let text = comments(
        "//! Source: io.md sections 5 and 6, `axes-and-motion.md`\n//! section 11.\nx();\n// design.md D4;",
    );
    let found = citations(&text);
    assert_eq!(
        found,
        [("io.md", vec!["5", "6"]), ("axes-and-motion.md", vec!["11"]), ("design.md", vec!["D4"]),]
    );
}
