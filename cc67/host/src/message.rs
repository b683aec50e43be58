//! Messages in a caller's buffer.

/// Copies as much of `text` as fits, and ends it with a 0; a character that does not fit completely is omitted.
///
/// Nothing is written to an empty buffer.
///
/// ```
/// let mut buffer = [0xff; 4];
/// cc67_host::fill(&mut buffer, "errors");
/// assert_eq!(&buffer, b"err\0");
/// ```
pub fn fill(buffer: &mut [u8], text: &str) {
    let Some(room) = buffer.len().checked_sub(1) else { return };
    let end = (0..=room.min(text.len())).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
    buffer[..end].copy_from_slice(&text.as_bytes()[..end]);
    buffer[end] = 0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_always_fits_its_buffer_and_is_terminated() {
        for (length, text, expect) in [
            (0, "abc", &b""[..]),
            (1, "abc", b"\0"),
            (3, "abc", b"ab\0"),
            (6, "abc", b"abc\0\xff\xff"),
            (3, "aé", b"a\0\xff"),
            (2, "", b"\0\xff"),
        ] {
            let mut buffer = vec![0xff; length];
            fill(&mut buffer, text);
            assert_eq!(buffer, expect, "{length} {text}");
        }
    }
}
