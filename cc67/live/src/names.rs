//! The programs' names for bits and uses of them, read from their sources.
//!
//! `#define ESTOP 136` with `ReadBit(ESTOP)` somewhere makes bit 136 the input `ESTOP`. A number without a macro is
//! also a bit if it is an argument of such a function. In a sum the first macro names the bit: with `#define HOME_X
//! 136`, `ReadBit(HOME_X + 1)` makes bit 137 `HOME_X + 1`. `ReadBit(HOME_X + axis)` makes bit 136 `HOME_X`, and also
//! names the following bits, if they are used elsewhere.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use kmotiondef::Bit;
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::function::BitAccess;

/// The maximum number of terms and macros in the number of one bit.
const TERMS: u32 = 100;
/// The maximum number of bits in a group: one for each axis.
const GROUP: i32 = 8;
/// The maximum number of files read for a program.
const FILES: usize = 100;

/// A bit that the programs use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct UsedBit {
    /// The macro that names it.
    pub(crate) name: Option<String>,
    /// True if a program reads it.
    pub(crate) is_read: bool,
    /// True if a program writes it.
    pub(crate) is_written: bool,
    /// True if it is the first of a group: a program adds a variable to its name.
    pub(crate) is_base: bool,
}

/// Names the unnamed bits after the first of a group, at most as many as there are axes.
pub(crate) fn name_groups(bits: &mut BTreeMap<Bit, UsedBit>) {
    let bases = bits.iter().filter(|(_, used)| used.is_base);
    let bases: Vec<_> = bases.filter_map(|(bit, used)| Some((*bit, used.name.clone()?))).collect();
    for (first, name) in bases {
        for offset in 1..GROUP {
            let bit = Bit::new(i32::from(first.get()) + offset);
            let Some(used) = bit.and_then(|bit| bits.get_mut(&bit)) else { continue };
            if used.name.is_some() {
                break;
            }
            used.name = Some(format!("{name} + {offset}"));
        }
    }
}

/// A source and the files that it includes in quotation marks, if they are found.
pub(crate) fn files_of(source: &Path, include_dirs: &[PathBuf]) -> Vec<PathBuf> {
    let mut found = vec![source.to_owned()];
    let mut next = 0;
    while let Some(path) = found.get(next).cloned() {
        next += 1;
        let Ok(bytes) = fs::read(&path) else { continue };
        let text = decode_text(&bytes);
        let folder = path.parent().unwrap_or(Path::new(""));
        for name in text.lines().filter_map(included_file) {
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

/// Returns the file named by an `#include "…"`.
fn included_file(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
    rest.trim_start().strip_prefix('"')?.split('"').next()
}

/// Decodes bytes: UTF-8, or otherwise Latin-1.
pub(crate) fn decode_text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// The bits used by some sources.
pub(crate) fn bits_of(texts: &[String]) -> BTreeMap<Bit, UsedBit> {
    let texts: Vec<String> = texts.iter().map(|text| without_comments(text)).collect();
    let macros: BTreeMap<&str, &str> =
        texts.iter().flat_map(|text| text.lines().filter_map(macro_definition)).collect();
    let mut bits: BTreeMap<Bit, UsedBit> = BTreeMap::new();
    // A bit that is both read and written has the name with which it is read.
    let accesses = [BitAccess::Read, BitAccess::Write].into_iter().flat_map(|access| {
        let rows = FIRMWARE_FUNCTIONS.iter().filter(move |row| row.attributes.bit_access == Some(access));
        rows.map(move |row| (row.name, access))
    });
    for (function, access) in accesses {
        for argument in texts.iter().flat_map(|text| arguments(text, function)) {
            // For a sum with a variable, the base is shown, which is the first of the bits.
            let whole = number(argument, &macros).map(|bit| (argument, bit));
            let is_base = whole.is_none();
            let Some((named, bit)) = whole.or_else(|| base(argument, &macros)) else { continue };
            let Some(bit) = Bit::new(bit) else { continue };
            let used = bits.entry(bit).or_default();
            used.is_base |= is_base;
            used.is_read |= access == BitAccess::Read;
            used.is_written |= access == BitAccess::Write;
            if named.split(['+', '-']).any(|term| macros.contains_key(term.trim())) {
                used.name.get_or_insert_with(|| named.to_owned());
            }
        }
    }
    bits
}

/// Name and text of a macro without arguments.
fn macro_definition(line: &str) -> Option<(&str, &str)> {
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
        let mut depth = 0;
        let end = rest.find(|c: char| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth < 0 || (c == ',' && depth == 0)
        });
        Some(rest.get(..end?)?.trim())
    };
    text.match_indices(function).filter_map(call).collect()
}

/// The macro in a sum with a variable, and its value.
fn base<'a>(text: &'a str, macros: &BTreeMap<&'a str, &'a str>) -> Option<(&'a str, i32)> {
    let mut terms = text.split('+').map(str::trim);
    let named = terms.find(|term| macros.contains_key(term)).filter(|named| *named != text)?;
    Some((named, number(named, macros)?))
}

/// The value of a number, of a macro for a number, or of a sum of these.
fn number(text: &str, macros: &BTreeMap<&str, &str>) -> Option<i32> {
    sum(text, macros, &mut { TERMS })
}

/// Does the same with a limit: a macro with more than `rest` terms, or that refers to itself, has no value.
fn sum(text: &str, macros: &BTreeMap<&str, &str>, rest: &mut u32) -> Option<i32> {
    *rest = rest.checked_sub(1)?;
    let text = text.trim();
    if let Some(value) = macros.get(text) {
        return sum(value, macros, rest);
    }
    if let Some(inner) = text.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')) {
        return sum(inner, macros, rest);
    }
    // The last operator, since subtraction is left-associative.
    if let Some((left, right)) = text.rfind(['+', '-']).and_then(|at| text.split_at_checked(at)) {
        let left = sum(left, macros, rest)?;
        let value = sum(right.get(1..)?, macros, rest)?;
        return if right.starts_with('+') { left.checked_add(value) } else { left.checked_sub(value) };
    }
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => i32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

/// A text with comments and quoted text replaced by blanks.
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
        check(
            "#define HOME_X 136\n#define HOME_Y (HOME_X + 1)\nReadBit(HOME_X + n); ReadBit(HOME_Y);",
            "136 HOME_X r, 137 HOME_Y r",
        );
        check("#define OUT 10\nSetBit(OUT + 2); ClearBit((OUT)); SetBit(i + OUT);", "10 OUT w, 12 OUT + 2 w");
        check("#define LOOP LOOP\n#define F(x) 3\nReadBit(LOOP); ReadBit(F(1));", "");
    }

    #[test]
    fn bits_after_the_first_of_a_group_are_named_with_it() {
        let text = "#define HOME_X 136\n#define DOOR 139\nReadBit(HOME_X + axis); ReadBit(DOOR);";
        let mut bits = bits_of(&[text.to_owned()]);
        for number in [137, 138, 140] {
            bits.entry(Bit::new(number).expect("a bit")).or_default().is_read = true;
        }
        name_groups(&mut bits);
        let names: Vec<_> = bits.values().map(|used| used.name.as_deref().unwrap_or("-")).collect();
        assert_eq!(names, ["HOME_X", "HOME_X + 1", "HOME_X + 2", "DOOR", "-"]);
    }

    #[test]
    fn text_that_is_not_utf8_is_latin1() {
        assert_eq!(
            (decode_text(b"\xe9t\xe9"), decode_text("été".as_bytes())),
            ("été".to_owned(), "été".to_owned())
        );
    }

    #[test]
    fn includes_between_quotation_marks_are_followed() {
        assert_eq!(included_file("  # include \"a.h\" // b"), Some("a.h"));
        assert_eq!(included_file("#include <a.h>"), None);
    }
}
