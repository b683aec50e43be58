//! Reads the recorded vectors and the C arguments in them.

use std::path::Path;

use serde_json::Value as Json;

/// A value passed to a variadic call.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Argument {
    /// An integer or address.
    Word(u32),
    /// A `long long`.
    LongLong(u64),
    /// A double.
    Double(f64),
    /// A string.
    Text(Vec<u8>),
    /// A null string.
    Null,
}

/// The rows of one file of vectors.
pub(crate) fn rows(name: &str) -> Vec<Json> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/vectors").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.lines().map(|line| serde_json::from_str(line).expect("a line is an object")).collect()
}

/// Splits the arguments of a recorded call into its first string and the values after it.
pub(crate) fn call(text: &str) -> (Vec<u8>, Vec<Argument>) {
    let mut parts = split(text).into_iter();
    let first = parts.next().unwrap_or_default();
    (unquote(&first), parts.map(|part| argument(&part)).collect())
}

/// Splits a text at commas outside string literals.
pub(crate) fn split(text: &str) -> Vec<String> {
    let (mut parts, mut quoted, mut escaped) = (vec![String::new()], false, false);
    for letter in text.chars() {
        if letter == ',' && !quoted {
            parts.push(String::new());
            continue;
        }
        quoted ^= letter == '"' && !escaped;
        escaped = letter == '\\' && !escaped;
        parts.last_mut().expect("there is one").push(letter);
    }
    parts
}

/// The bytes of a C string literal.
pub(crate) fn unquote(literal: &str) -> Vec<u8> {
    let inner = literal.trim().strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or_default();
    let inner = inner.replace("\\t", "\t").replace("\\n", "\n").replace("\\033", "\x1b");
    inner.replace("\\\"", "\"").into_bytes()
}

/// The value of one argument.
fn argument(text: &str) -> Argument {
    match text.trim() {
        "(char*)0" => Argument::Null,
        "\"x\"==0" => Argument::Word(0),
        "'A'" => Argument::Word(u32::from(b'A')),
        "-2147483647-1" | "(-2147483647-1)" | "(int)1e20" | "(int)-1e20" | "(int)2147483648.0" => {
            Argument::Word(0x8000_0000)
        }
        "(unsigned)3e9" => Argument::Word(3_000_000_000),
        "(float)16777217" => Argument::Double(16_777_216.0),
        "1.0/3.0" => Argument::Double(1.0 / 3.0),
        "1.0/zero" => Argument::Double(f64::INFINITY),
        "-1.0/zero" => Argument::Double(f64::NEG_INFINITY),
        "zero/zero" => Argument::Double(f64::NAN),
        text if text.starts_with('"') => Argument::Text(unquote(text)),
        text => number(text),
    }
}

/// A plain constant; a cast to float rounds it.
fn number(text: &str) -> Argument {
    if let Some(text) = text.strip_prefix("(float)") {
        return Argument::Double(f64::from(text.parse::<f32>().expect("a float")));
    }
    if let Some(text) = text.strip_prefix("0x") {
        let digits = text.trim_end_matches(['u', 'U', 'L']);
        return Argument::Word(u32::from_str_radix(digits, 16).expect("hexadecimal digits"));
    }
    if text.contains(['.', 'e']) {
        return Argument::Double(text.parse().expect("a double"));
    }
    let integer: i64 = text.trim_end_matches(['u', 'U', 'L']).parse().expect("an integer");
    Argument::Word(integer as u32)
}
