//! What the programs call their bits, and what they do with them: read from their sources.
//!
//! `#define ESTOP 136` with `ReadBit(ESTOP)` somewhere makes bit 136 the input `ESTOP`. A number without a macro is a
//! bit, too, where it is an argument of such a function.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use kmotiondef::Bit;

/// Functions with a bit as their first argument, and whether they make it an output.
const FUNCTIONS: [(&str, bool); 5] = [
    ("ReadBit", false),
    ("SetBit", true),
    ("ClearBit", true),
    ("SetStateBit", true),
    ("SetBitDirection", true),
];
/// Files that are read for a program at most.
const FILES: usize = 100;

/// A bit that the programs use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Used {
    /// The macro that names it.
    pub(crate) name: Option<String>,
    /// Whether a program reads it.
    pub(crate) is_read: bool,
    /// Whether a program writes it.
    pub(crate) is_written: bool,
}

/// A source and the files it includes between quotation marks, as far as they are found.
pub(crate) fn files_of(source: &Path, include_dirs: &[PathBuf]) -> Vec<PathBuf> {
    let mut found = vec![source.to_owned()];
    let mut next = 0;
    while let Some(path) = found.get(next).cloned() {
        next += 1;
        let Ok(bytes) = fs::read(&path) else { continue };
        let text = String::from_utf8_lossy(&bytes);
        let folder = path.parent().unwrap_or(Path::new(""));
        for name in text.lines().filter_map(included) {
            let folders = std::iter::once(folder).chain(include_dirs.iter().map(PathBuf::as_path));
            let file = folders.map(|folder| folder.join(name.replace('\\', "/"))).find(|file| file.is_file());
            if let Some(file) = file
                && found.len() < FILES
                && !found.contains(&file)
            {
                found.push(file);
            }
        }
    }
    found
}

/// What `#include "…"` names.
fn included(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
    rest.trim_start().strip_prefix('"')?.split('"').next()
}

/// The bits that some texts use.
pub(crate) fn bits_of(texts: &[String]) -> BTreeMap<Bit, Used> {
    let texts: Vec<String> = texts.iter().map(|text| without_comments(text)).collect();
    let macros: BTreeMap<&str, &str> =
        texts.iter().flat_map(|text| text.lines().filter_map(defined)).collect();
    let mut bits: BTreeMap<Bit, Used> = BTreeMap::new();
    for (function, writes) in FUNCTIONS {
        for argument in texts.iter().flat_map(|text| arguments(text, function)) {
            let Some(bit) = number(argument, &macros).and_then(Bit::new) else { continue };
            let used = bits.entry(bit).or_default();
            used.is_read |= !writes;
            used.is_written |= writes;
            if macros.contains_key(argument) {
                used.name.get_or_insert_with(|| argument.to_owned());
            }
        }
    }
    bits
}

/// Name and text of a macro without arguments.
fn defined(line: &str) -> Option<(&str, &str)> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("define")?;
    let rest = rest.strip_prefix([' ', '\t'])?.trim_start();
    let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))?;
    let (name, value) = rest.split_at(end);
    value.starts_with([' ', '\t']).then(|| (name, value.trim()))
}

/// The first arguments of the calls of a function.
fn arguments<'a>(text: &'a str, function: &str) -> Vec<&'a str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let call = |(at, _): (usize, &str)| {
        if text.get(..at)?.ends_with(is_word) {
            return None;
        }
        let rest = text.get(at + function.len()..)?.trim_start().strip_prefix('(')?;
        Some(rest.get(..rest.find([',', ')'])?)?.trim())
    };
    text.match_indices(function).filter_map(call).collect()
}

/// The value of a number, or of a macro for one.
fn number(text: &str, macros: &BTreeMap<&str, &str>) -> Option<i32> {
    let mut text = text;
    let mut seen = BTreeSet::new();
    while let Some(value) = macros.get(text.trim()) {
        if !seen.insert(text.trim()) {
            return None;
        }
        text = value;
    }
    let text = text.trim();
    let text = text.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')).unwrap_or(text).trim();
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => i32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

/// A text with blanks in place of comments and of what is in quotation marks.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(character) = rest.next() {
        match character {
            '/' if rest.peek() == Some(&'/') => while rest.next_if(|c| *c != '\n').is_some() {},
            '/' if rest.peek() == Some(&'*') => {
                let mut before = ' ';
                let _ = rest.next();
                for inner in rest.by_ref() {
                    if inner == '\n' {
                        out.push('\n');
                    }
                    if before == '*' && inner == '/' {
                        break;
                    }
                    before = inner;
                }
                out.push(' ');
            }
            '"' => {
                while let Some(inner) = rest.next_if(|c| *c != '"' && *c != '\n') {
                    if inner == '\\' {
                        let _ = rest.next();
                    }
                }
                let _ = rest.next_if_eq(&'"');
                out.push(' ');
            }
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expect: &str) {
        let bits = bits_of(&[text.to_owned()]);
        let shown: Vec<_> = bits
            .iter()
            .map(|(bit, used)| {
                let way = [(used.is_read, "r"), (used.is_written, "w")];
                let way: String = way.into_iter().filter(|(is, _)| *is).map(|(_, letter)| letter).collect();
                format!("{bit} {} {way}", used.name.as_deref().unwrap_or("-"))
            })
            .collect();
        assert_eq!(shown.join(", "), expect);
    }

    #[test]
    fn bits_are_found_with_their_names() {
        check("#define ESTOP 136\nmain() { while (!ReadBit(ESTOP)); }", "136 ESTOP r");
        check("#define A (0x10)\n#define B A // the door\nReadBit( B ); SetBit(A);", "16 B rw");
        check("ReadBit(1024 + i); MyReadBit(5); SetStateBit(46, x); ClearBit(9999);", "46 - w");
        check("/* ReadBit(1) */ // ReadBit(2)\nprintf(\"ReadBit(3) \\\" ReadBit(4)\"); ReadBit(5);", "5 - r");
        check("#define LOOP LOOP\n#define F(x) 3\nReadBit(LOOP); ReadBit(F(1));", "");
    }

    #[test]
    fn includes_between_quotation_marks_are_followed() {
        assert_eq!(included("  # include \"a.h\" // b"), Some("a.h"));
        assert_eq!(included("#include <a.h>"), None);
    }
}
