//! The C headers of a board: those in `include/` with the facts of the board applied.

use std::fmt::Write as _;

use super::{BoardFacts, Header, StructureLayout};
use crate::headers::EMBEDDED;

/// The headers for a kind of board and a firmware version.
pub(super) fn of_board(facts: &BoardFacts, version: (&str, &str)) -> Vec<Header> {
    let mut texts: Vec<String> =
        EMBEDDED.iter().map(|(_, text)| String::from_utf8_lossy(text).into_owned()).collect();
    let (kind, number) = version;
    for text in &mut texts {
        *text = text.replace("release 4.34", &format!("release {number}"));
        *text = text.replace("the KFLOP board", &format!("the {kind} board"));
    }
    let mut more = vec![String::new(); texts.len()];
    let [board, constants, ..] = more.as_mut_slice() else { return Vec::new() };
    for name in &facts.undefines {
        replace(
            &mut texts,
            |text| definition(text, name).map(|(start, end)| (start, line_end(text, end))),
            "",
        );
    }
    for (name, value) in &facts.defines {
        let line = format!("#define {name}{value}");
        if !replace(&mut texts, |text| definition(text, name), &line) {
            let _ = writeln!(constants, "{line}");
        }
    }
    for (name, enumerators) in &facts.enumerations {
        let list = enumerators.replace(' ', ", ").replace('=', " = ");
        let _ = writeln!(constants, "typedef enum {{ {list} }} {name};");
    }
    for structure in &facts.structures {
        let declared = declaration_of(structure);
        replace(&mut texts, |text| structure_in(text, structure.name), &declared);
    }
    for (name, variable) in &facts.variables {
        let line = format!("extern {variable};");
        if !replace(&mut texts, |text| variable_in(text, name), &line) {
            let _ = writeln!(board, "{line}");
        }
    }
    for name in &facts.removed {
        replace(&mut texts, |text| function_in(text, name), "");
    }
    for (name, prototype) in &facts.declared {
        let line = format!("{prototype};");
        if !replace(&mut texts, |text| function_in(text, name), &line) {
            let _ = writeln!(board, "{line}");
        }
    }
    for (text, more) in texts.iter_mut().zip(&more) {
        if let Some(end) = text.rfind("#endif").filter(|_| !more.is_empty()) {
            let title = format!("// ---- Of firmware {number} ");
            text.insert_str(end, &format!("{title:-<108}\n\n{more}\n"));
        }
    }
    let leak = |text: String| -> &'static [u8] { Box::leak(text.into_bytes().into_boxed_slice()) };
    EMBEDDED.iter().zip(texts).map(|((name, _), text)| (*name, leak(text))).collect()
}

/// Reports whether a header defines a macro.
pub(super) fn defines(text: &[u8], name: &str) -> bool {
    str::from_utf8(text).is_ok_and(|text| definition(text, name).is_some())
}

/// The definition or declaration of a name in the default headers.
pub(super) fn stated(name: &str) -> Option<&'static str> {
    let texts = || EMBEDDED.iter().filter_map(|(_, text)| str::from_utf8(text).ok());
    let defined = texts().find_map(|text| {
        let (start, end) = definition(text, name)?;
        let line = text.get(start..end)?;
        Some(line[word_in(line, name)? + name.len()..].trim())
    });
    defined.or_else(|| {
        texts().find_map(|text| {
            let (start, end) = variable_in(text, name)?;
            Some(text.get(start..end)?.trim_start_matches("extern ").trim_end_matches(';'))
        })
    })
}

/// The end of the line that contains a position.
fn line_end(text: &str, at: usize) -> usize {
    text[at..].find('\n').map_or(text.len(), |length| at + length + 1)
}

/// Replaces the range found in the first text in which `find` succeeds.
fn replace(texts: &mut [String], find: impl Fn(&str) -> Option<(usize, usize)>, by: &str) -> bool {
    for text in texts {
        if let Some((start, end)) = find(text) {
            text.replace_range(start..end, by);
            return true;
        }
    }
    false
}

const fn is_word(byte: u8) -> bool {
    byte == b'_' || byte.is_ascii_alphanumeric()
}

/// The lines of a text with their positions.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_inclusive('\n').scan(0, |at, line| {
        let start = *at;
        *at += line.len();
        Some((start, line))
    })
}

/// The position of `name` as a whole word in a line.
fn word_in(line: &str, name: &str) -> Option<usize> {
    let bytes = line.as_bytes();
    line.match_indices(name).map(|(at, _)| at).find(|at| {
        let after = bytes.get(at + name.len());
        (*at == 0 || !is_word(bytes[at - 1])) && !after.is_some_and(|byte| is_word(*byte))
    })
}

/// The part of a piece of C before its comment, without trailing blanks.
fn code(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim_end()
}

/// `#define NAME …`, up to the comment.
fn definition(text: &str, name: &str) -> Option<(usize, usize)> {
    lines(text).find_map(|(start, line)| {
        let rest = line.strip_prefix("#define ")?.trim_start();
        (word_in(rest, name)? == 0).then(|| (start, start + code(line).len()))
    })
}

/// `extern … NAME …;`, up to the comment.
fn variable_in(text: &str, name: &str) -> Option<(usize, usize)> {
    lines(text).find_map(|(start, line)| {
        let code = code(line);
        (code.starts_with("extern ") && word_in(code, name).is_some()).then_some((start, start + code.len()))
    })
}

/// `typedef struct { … } NAME;`
fn structure_in(text: &str, name: &str) -> Option<(usize, usize)> {
    let end_line = format!("\n}} {name};");
    let end = text.find(&end_line)?;
    Some((text[..end].rfind("typedef struct {")?, end + end_line.len()))
}

/// The prototype of a function, on one or more lines, with the comment before it.
fn function_in(text: &str, name: &str) -> Option<(usize, usize)> {
    let mut comment = None;
    lines(text).find_map(|(start, line)| {
        let before = comment;
        comment = if line.starts_with("//") { before.or(Some(start)) } else { None };
        let is_code = line.starts_with(|c: char| c == '_' || c.is_ascii_alphabetic());
        let at = word_in(line, name).filter(|at| is_code && line[at + name.len()..].starts_with('('))?;
        let end = start + at + text[start + at..].find(';')? + 1;
        Some((before.unwrap_or(start), end))
    })
}

/// A structure with its fields.
fn declaration_of(structure: &StructureLayout) -> String {
    let mut text = String::from("typedef struct {\n");
    for field in &structure.fields {
        let _ = writeln!(text, "    {}; // {}", field.declaration, field.meaning);
    }
    let _ = write!(text, "}} {};", structure.name);
    text
}
