//! White space, comments, and text that is skipped.

use crate::diag::Diagnostic;
use crate::names::Name;
use crate::source::Span;

use super::super::LAX;
use super::super::token::Flags;
use super::{Lexer, LexerContext, is_blank};

impl Lexer {
    /// Skips to the next token, in a directive at most to the end of the line.
    pub(super) fn skip_space(&mut self, cx: &mut LexerContext<'_>) -> Flags {
        let mut flags = if self.is_line_start { Flags::LINE_START } else { Flags::NONE };
        loop {
            match self.byte(self.at) {
                b' ' | b'\t' | b'\r' | 0x0B | 0x0C => self.at += 1,
                b'\n' if self.in_directive => return flags,
                b'\n' => {
                    self.at += 1;
                    self.is_line_start = true;
                    flags = Flags::LINE_START;
                    continue;
                }
                b'/' if self.skip_comment(cx) => {}
                b'\\' if self.splice(cx) => continue,
                0xA0.. if self.skip_foreign_space(cx) => {}
                _ => return flags,
            }
            flags = flags.with(Flags::SPACE);
        }
    }

    /// Skips the rest of a directive's line, in which quotes have no meaning.
    pub(in super::super) fn skip_line(&mut self, cx: &mut LexerContext<'_>) {
        loop {
            match self.byte(self.at) {
                b'\n' => return,
                _ if self.at >= self.end => return,
                b'/' if self.skip_comment(cx) => {}
                b'"' | b'\'' => self.skip_quoted_in_line(),
                b'\\' if self.splice(cx) => {}
                _ => self.at += 1,
            }
        }
    }

    /// Takes the rest of a directive's line as text, without blanks around it.
    pub(in super::super) fn take_line(&mut self) -> Vec<u8> {
        let lo = self.at;
        loop {
            match self.byte(self.at) {
                b'\n' => break,
                _ if self.at >= self.end => break,
                b'\\' if self.past_splices(self.at) != self.at => self.at = self.past_splices(self.at),
                _ => self.at += 1,
            }
        }
        super::without_splices(self.bytes(lo, self.at)).trim_ascii().to_vec()
    }

    /// Reads the name of a directive in skipped text; `None` if there is no name.
    pub(in super::super) fn directive_name(&mut self, cx: &mut LexerContext<'_>) -> Option<Name> {
        let flags = self.skip_space(cx);
        match self.byte(self.at) {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => Some(self.identifier(flags, cx).name),
            _ => None,
        }
    }

    /// Skips excluded lines up to the next directive, and its `#`; `None` if there is none before the end of the file.
    pub(in super::super) fn skip_to_directive(&mut self, cx: &mut LexerContext<'_>) -> Option<Span> {
        self.in_directive = false;
        while self.at < self.end {
            let flags = self.skip_space(cx);
            if flags.has(Flags::LINE_START) && self.byte(self.at) == b'#' {
                self.at += 1;
                self.is_line_start = false;
                return Some(self.span_to(self.at - 1, self.at));
            }
            self.is_line_start = false;
            self.skip_line(cx);
        }
        None
    }

    /// The offset of the line feed that ends the line of `at`.
    pub(super) fn end_of_line(&self, at: usize) -> usize {
        let rest = self.bytes(at, self.end);
        at + memchr::memchr(b'\n', rest).unwrap_or(rest.len())
    }

    /// The offset after the end of the block comment whose text begins at `at`.
    pub(super) fn end_of_comment(&self, at: usize) -> Option<usize> {
        Some(at + find_pair(self.bytes(at, self.end), *b"*/")? + 2)
    }

    fn skip_comment(&mut self, cx: &mut LexerContext<'_>) -> bool {
        let second = self.past_splices(self.at + 1);
        match self.byte(second) {
            b'/' => self.skip_line_comment(second + 1, cx),
            b'*' => self.skip_block_comment(second + 1, cx),
            _ => return false,
        }
        true
    }

    /// A comment to the end of the line. It usually ends in a backslash because a path does, so unlike in
    /// standard C that does not continue it.
    fn skip_line_comment(&mut self, text: usize, cx: &mut LexerContext<'_>) {
        let newline = self.end_of_line(text);
        let line = self.bytes(text, newline);
        if line.trim_ascii_end().ends_with(b"\\") {
            let next = self.bytes(newline + 1, self.end_of_line(newline + 1));
            if !next.trim_ascii().is_empty() {
                let backslash = text + line.trim_ascii_end().len() - 1;
                let span = self.span_to(backslash, backslash + 1);
                cx.sink.report(
                    Diagnostic::remark(span, "comment ends in a backslash")
                        .note("the next line is not part of it; in standard C it would be"),
                );
            }
        }
        self.at = newline;
    }

    fn skip_block_comment(&mut self, text: usize, cx: &mut LexerContext<'_>) {
        let opener = self.at;
        let Some(end) = self.end_of_comment(text) else {
            let span = self.span_to(opener, text);
            cx.sink.report_lost_text(Diagnostic::error(span, "comment is never closed").at("it starts here"));
            self.at = self.end;
            return;
        };
        let comment = self.bytes(text, end - 2);
        if let Some(inner) = find_pair(comment, *b"/*") {
            let span = self.span_to(text + inner, text + inner + 2);
            cx.sink.report(
                Diagnostic::warning(LAX, span, "`/*` within a comment")
                    .at("comments do not nest; the next `*/` ends it")
                    .label(self.span_to(opener, text), "the comment starts here"),
            );
        }
        self.at = end;
    }

    /// Skips a quoted text if it ends on this line, otherwise only the quote: an apostrophe.
    fn skip_quoted_in_line(&mut self) {
        let quote = self.byte(self.at);
        let mut at = self.at + 1;
        while at < self.end {
            match self.byte(at) {
                b'\n' => break,
                b'\\' if is_blank(self.byte(at + 1)) || self.byte(at + 1) == b'\n' => break,
                b'\\' => at += 2,
                byte if byte == quote => {
                    self.at = at + 1;
                    return;
                }
                _ => at += 1,
            }
        }
        self.at += 1;
    }
}

/// The position of the first pair of two bytes.
fn find_pair(text: &[u8], [first, second]: [u8; 2]) -> Option<usize> {
    memchr::memchr_iter(first, text).find(|at| text.get(at + 1) == Some(&second))
}
