//! Telling source text from other files before the preprocessor finds a thousand mistakes in them.

/// How much of a file is looked at.
const SAMPLE: usize = 4096;

/// Formats by the bytes they begin with.
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

/// What a file is that cannot be C source text; `None` if it may be.
///
/// A single stray byte is left to the preprocessor, which shows where it is.
#[must_use]
pub(crate) fn not_source(text: &[u8]) -> Option<&'static str> {
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

    #[test]
    fn source_may_contain_a_stray_byte_but_not_be_binary() {
        assert_eq!(not_source(b"int x; \x01 main() { return 0; } /* long enough */\n"), None);
        assert_eq!(not_source("int größe; // größer\r\n".as_bytes()), None);
        assert_eq!(not_source(b""), None);
        assert_eq!(not_source(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0"), Some("an ELF executable"));
        assert_eq!(not_source(&[7; 40]), Some("a binary file"));
    }
}
