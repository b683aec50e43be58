//! Telling source text from other files before the preprocessor finds a thousand mistakes in them.

use std::path::Path;

/// Bytes of a file that are examined.
const SAMPLE: usize = 4096;

/// Formats by their first bytes.
const FORMATS: &[(&[u8], &str)] = &[
    (b"\x7fELF", "an ELF executable"),
    (b"MZ", "a Windows executable"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\xc2\x00", "a TI COFF image; `run` takes images by the suffix `.out`"),
    (b"\x89PNG", "a PNG picture"),
    (b"%PDF", "a PDF document"),
    (b"\xff\xfe", "text in UTF-16; save it as UTF-8"),
    (b"\xfe\xff", "text in UTF-16; save it as UTF-8"),
];

/// Text files of the vendor's application, by the suffix of their names.
const SUFFIXES: &[(&str, &str)] = &[
    ("ngc", "G code, which the PC application executes and not the board"),
    ("nc", "G code, which the PC application executes and not the board"),
    ("tap", "G code, which the PC application executes and not the board"),
    (
        "mot",
        "a motor file of the PC application, with the settings of an axis; a C program sets the fields of `chan[]`",
    ),
];

/// Describes a file that cannot be C source text; `None` if it can be.
///
/// A single stray byte is left to the preprocessor, which shows its position.
#[must_use]
pub(crate) fn not_source(path: &Path, text: &[u8]) -> Option<&'static str> {
    let suffix = path.extension().and_then(|suffix| suffix.to_str()).unwrap_or_default();
    let named = SUFFIXES.iter().find(|(known, _)| known.eq_ignore_ascii_case(suffix));
    if let Some((_, what)) = named {
        return Some(what);
    }
    let sample = text.get(..SAMPLE).unwrap_or(text);
    let control = |byte: &&u8| **byte < 0x20 && !b"\t\n\r\x0b\x0c\x1a".contains(*byte);
    let controls = sample.iter().filter(control).count();
    if controls * 20 <= sample.len() && controls < 16 {
        return None;
    }
    let format = FORMATS.iter().find(|(magic, _)| text.starts_with(magic));
    Some(format.map_or("a binary file", |(_, name)| *name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn not_source(text: &[u8]) -> Option<&'static str> {
        super::not_source(Path::new("a.c"), text)
    }

    #[test]
    fn files_of_the_vendors_application_are_named() {
        let what = super::not_source(Path::new("part.NGC"), b"G0 X1\n").expect("it is no source");
        assert!(what.starts_with("G code"), "{what}");
    }

    #[test]
    fn source_may_contain_a_stray_byte_but_not_be_binary() {
        assert_eq!(not_source(b"int x; \x01 main() { return 0; } /* long enough */\n"), None);
        assert_eq!(not_source("int größe; // größer\r\n".as_bytes()), None);
        assert_eq!(not_source(b""), None);
        assert_eq!(not_source(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0"), Some("an ELF executable"));
        assert_eq!(not_source(&[7; 40]), Some("a binary file"));
    }
}
