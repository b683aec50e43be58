//! Blocks of a source text, found by their braces.

/// A traversal of a text that skips comments, strings and characters.
struct Braces<'a> {
    text: &'a [u8],
    at: usize,
}

impl Iterator for Braces<'_> {
    /// A brace and its position.
    type Item = (u8, usize);

    fn next(&mut self) -> Option<(u8, usize)> {
        while let Some(&byte) = self.text.get(self.at) {
            let at = self.at;
            self.at += 1;
            match byte {
                b'{' | b'}' => return Some((byte, at)),
                b'"' | b'\'' => self.skip_quoted(byte),
                b'/' if self.text.get(self.at) == Some(&b'/') => self.skip_to(b"\n"),
                b'/' if self.text.get(self.at) == Some(&b'*') => {
                    self.at += 1;
                    self.skip_to(b"*/");
                }
                _ => {}
            }
        }
        None
    }
}

impl Braces<'_> {
    fn skip_quoted(&mut self, quote: u8) {
        while let Some(&byte) = self.text.get(self.at) {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == quote || byte == b'\n' {
                return;
            }
        }
    }

    fn skip_to(&mut self, end: &[u8]) {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let found = rest.windows(end.len()).position(|window| window == end);
        self.at += found.map_or(rest.len(), |found| found + end.len());
    }
}

/// The position of the closing brace of the block around a position.
pub(super) fn end_of_block(text: &[u8], from: usize) -> Option<usize> {
    let mut depth = 0_u32;
    for (brace, at) in (Braces { text, at: from }) {
        match brace {
            b'{' => depth += 1,
            _ if depth == 0 => return Some(at),
            _ => depth -= 1,
        }
    }
    None
}

/// The position after the opening brace of the first block after a position.
pub(super) fn begin_of_body(text: &[u8], from: usize) -> Option<usize> {
    (Braces { text, at: from }).find(|(brace, _)| *brace == b'{').map(|(_, at)| at + 1)
}

/// The line of a position, counted from 1.
pub(super) fn line_of(text: &[u8], at: usize) -> u32 {
    1 + text.iter().take(at).filter(|byte| **byte == b'\n').count() as u32
}

/// The position at which a line begins.
pub(super) fn begin_of_line(text: &[u8], line: u32) -> usize {
    let mut starts = std::iter::once(0)
        .chain(text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1));
    starts.nth(line.saturating_sub(1) as usize).unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_around_a_place_ends_at_its_own_brace() {
        let text = b"f() { int a; /* } */ if (\"}\"[0] == '}') { b; } // }\n c; }\n";
        let end = |needle: &[u8]| {
            let at = text.windows(needle.len()).position(|window| window == needle).expect("it is there");
            end_of_block(text, at).map(|end| text.len() - end)
        };
        let last = text.len() - 2;
        assert_eq!((end(b"int a"), end(b"c;")), (Some(2), Some(2)));
        assert!(end(b"b;") > Some(2));
        assert_eq!((line_of(text, 3), line_of(text, last), begin_of_line(text, 1)), (1, 2, 0));
        assert_eq!(line_of(text, begin_of_line(text, 2)), 2);
    }
}
