//! Converts bytes to tokens, one at a time.
//!
//! The lexer works on bytes and never copies them. It is lazy because the meaning of a byte depends on the directives:
//! text skipped by `#if` need not consist of tokens, and the text of `#error` is plain text. A backslash at the end of
//! a line joins it with the next, which only the slow paths handle: the fast ones stop at any backslash.
//!
//! Files come from Windows tools: a lone carriage return is white space, a `//` comment that
//! ends in a backslash (a path) is not continued, a string may run over several lines.

mod foreign;
pub(super) mod header;
mod punctuator;
mod quoted;
mod space;

use std::sync::Arc;

use crate::diag::{Diagnostic, Sink};
use crate::names::{Names, SpellingHash, is_name_byte, word};
use crate::source::Span;

use super::token::{Flags, Token, TokenKind};

/// The parts of the preprocessor that the lexer uses.
pub(super) struct LexerContext<'a> {
    /// The table of names, which numbers identifiers.
    pub(super) names: &'a mut Names,
    /// The sink of diagnostics.
    pub(super) sink: &'a mut Sink,
}

/// A place in the text of a file.
#[derive(Debug)]
pub(super) struct Lexer {
    /// The bytes that count.
    text: Arc<Vec<u8>>,
    /// Offset of the next byte.
    at: usize,
    /// Offset after the last byte.
    end: usize,
    /// Position of the first byte in the source map.
    base: u32,
    /// The next token is the first of its line.
    is_line_start: bool,
    /// A line feed ends the tokens and is not consumed.
    pub(super) in_directive: bool,
    /// Splices before this offset have been reported.
    checked_splices: usize,
    /// Bytes that need only one complaint a file had theirs.
    complained: foreign::ReportedComplaints,
}

impl Lexer {
    /// A lexer at the start of a file.
    pub(super) fn new(text: Arc<Vec<u8>>, base: u32) -> Self {
        let at = if text.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        // A Ctrl-Z used to end text files; only padding may follow it.
        let padding =
            text.iter().rev().take_while(|byte| matches!(byte, 0x1A | 0) || byte.is_ascii_whitespace());
        let tail = text.len() - padding.count();
        let ctrl_z = text.iter().skip(tail).position(|byte| *byte == 0x1A);
        let end = ctrl_z.map_or(text.len(), |offset| tail + offset);
        let text = if end < text.len() { Arc::new(text.get(..end).unwrap_or(&[]).to_vec()) } else { text };
        Self {
            text,
            at,
            end,
            base,
            is_line_start: true,
            in_directive: false,
            checked_splices: 0,
            complained: foreign::ReportedComplaints::default(),
        }
    }

    /// Restricts the lexer to a part of the text.
    pub(super) fn restrict(self, lo: usize, hi: usize) -> Self {
        Self { at: lo, end: hi, ..self }
    }

    /// Reports whether the file is in an encoding that cannot be C source.
    pub(super) fn is_utf16(&self) -> bool {
        self.text.starts_with(b"\xFF\xFE") || self.text.starts_with(b"\xFE\xFF")
    }

    /// The span of the rest of the text.
    pub(super) fn end_span(&self) -> Span {
        self.span_to(self.end, self.end)
    }

    /// The position of the next byte.
    pub(super) fn position(&self) -> Span {
        self.span_to(self.at, self.at)
    }

    /// Reads a token. At the end of the file or, in a directive, of the line: repeatedly `End`.
    pub(super) fn next(&mut self, cx: &mut LexerContext<'_>) -> Token {
        loop {
            let flags = self.skip_space(cx);
            let lo = self.at;
            if lo >= self.end {
                return Token::new(TokenKind::End, flags, self.end_span());
            }
            let byte = self.byte(lo);
            let token = match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.identifier(flags, cx),
                b'0'..=b'9' => self.number(flags, cx),
                b'.' if self.byte(self.past_splices(lo + 1)).is_ascii_digit() => self.number(flags, cx),
                b'"' | b'\'' => self.quoted_token(lo, flags, cx),
                b'\n' => return Token::new(TokenKind::End, flags, self.position()),
                _ => match self.punctuator(byte) {
                    Some(kind) => Token::new(kind, flags, self.span_from(lo)),
                    None => match self.foreign_token(flags, cx) {
                        Some(token) => token,
                        None => continue,
                    },
                },
            };
            self.is_line_start = false;
            return token;
        }
    }

    /// Reports whether the next token is `(`, without reading it.
    pub(super) fn is_before_paren(&self) -> bool {
        let mut at = self.at;
        loop {
            at = match self.byte(at) {
                b'(' => return true,
                b'\n' if self.in_directive => return false,
                b' ' | b'\t' | b'\n' | b'\r' | 0x0B | 0x0C => at + 1,
                b'\\' if self.past_splices(at) != at => self.past_splices(at),
                b'/' => match self.byte(at + 1) {
                    b'/' => self.end_of_line(at),
                    b'*' => self.end_of_comment(at + 2).unwrap_or(self.end),
                    _ => return false,
                },
                _ => return false,
            };
        }
    }

    /// Reports whether the next byte is `(`, which makes a definition a function-like macro.
    pub(super) fn is_at_paren(&self) -> bool {
        self.byte(self.past_splices(self.at)) == b'('
    }

    /// The byte at an offset; NUL after the end.
    fn byte(&self, at: usize) -> u8 {
        self.text.get(at).copied().unwrap_or(0)
    }

    /// The bytes of a range.
    fn bytes(&self, lo: usize, hi: usize) -> &[u8] {
        self.text.get(lo..hi.min(self.text.len())).unwrap_or(&[])
    }

    fn span_to(&self, lo: usize, hi: usize) -> Span {
        // A file has at most `limits::FILE_BYTES` bytes.
        let position = |at: usize| self.base.saturating_add(u32::try_from(at).unwrap_or(u32::MAX));
        Span::new(position(lo), position(hi))
    }

    fn span_from(&self, lo: usize) -> Span {
        self.span_to(lo, self.at)
    }

    fn identifier(&mut self, flags: Flags, cx: &mut LexerContext<'_>) -> Token {
        let lo = self.at;
        let mut hash = SpellingHash::START;
        let mut length = 0;
        for byte in self.bytes(lo, self.end) {
            if !is_name_byte(*byte) {
                break;
            }
            hash = hash.with(*byte);
            length += 1;
        }
        self.at += length;
        let mut flags = flags;
        match self.byte(self.at) {
            b'\\' if self.past_splices(self.at) != self.at => {
                self.skip_spliced(is_name_byte, cx);
                flags = flags.with(Flags::SPLICED);
            }
            b'"' | b'\'' if matches!(self.bytes(lo, self.at), b"L" | b"u" | b"U" | b"u8") => {
                return self.quoted_token(lo, flags, cx);
            }
            byte if byte >= 0x80 && self.is_foreign_letter() => return self.foreign_name(lo, flags, cx),
            _ => {}
        }
        let name = if flags.has(Flags::SPLICED) {
            let spelling = without_splices(self.bytes(lo, self.at));
            cx.names.intern_hashed(&spelling, SpellingHash::of(&spelling))
        } else {
            cx.names.intern_hashed(self.bytes(lo, self.at), hash)
        };
        // Every byte was checked to be a letter, a digit or an underscore.
        let name = name.unwrap_or(word::FUNC);
        Token { kind: TokenKind::Identifier, flags, name, span: self.span_from(lo) }
    }

    /// A preprocessing number: digits, letters, dots, and signs after an exponent's letter.
    fn number(&mut self, flags: Flags, cx: &mut LexerContext<'_>) -> Token {
        let lo = self.at;
        let mut flags = flags;
        let mut last = 0;
        loop {
            let byte = self.byte(self.at);
            let is_sign = matches!(byte, b'+' | b'-') && matches!(last, b'e' | b'E' | b'p' | b'P');
            if is_name_byte(byte) || byte == b'.' || is_sign {
                last = byte;
                self.at += 1;
            } else if byte == b'\\' && self.splice(cx) {
                flags = flags.with(Flags::SPLICED);
            } else {
                return Token::new(TokenKind::Number, flags, self.span_from(lo));
            }
        }
    }

    /// Skips splices and the bytes that `belongs` accepts.
    fn skip_spliced(&mut self, belongs: fn(u8) -> bool, cx: &mut LexerContext<'_>) {
        while belongs(self.byte(self.at)) || self.splice(cx) {
            if belongs(self.byte(self.at)) {
                self.at += 1;
            }
        }
    }

    /// The offset after any backslashes that join lines at `at`.
    fn past_splices(&self, mut at: usize) -> usize {
        while self.byte(at) == b'\\' {
            let blanks = self.bytes(at + 1, self.end).iter().take_while(|byte| is_blank(**byte)).count();
            let newline = at + 1 + blanks;
            if self.byte(newline) != b'\n' {
                break;
            }
            at = newline + 1;
        }
        at
    }

    /// Joins the next line at a backslash; complains about blanks after it.
    fn splice(&mut self, cx: &mut LexerContext<'_>) -> bool {
        let behind = self.past_splices(self.at);
        if behind == self.at {
            return false;
        }
        let has_blanks = self.bytes(self.at, behind).iter().any(|byte| matches!(byte, b' ' | b'\t'));
        if has_blanks && self.at >= self.checked_splices {
            let span = self.span_to(self.at, self.at + 1);
            cx.sink.report(
                Diagnostic::warning(super::LAX, span, "whitespace after a backslash at the end of a line")
                    .at("this line is joined with the next")
                    .help("remove the whitespace; other compilers do not join the lines"),
            );
            self.checked_splices = behind;
        }
        self.at = behind;
        true
    }
}

/// White space within a line; a carriage return alone does not end one.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0B | 0x0C)
}

/// The text without the backslashes that join lines.
pub(super) fn without_splices(text: &[u8]) -> Vec<u8> {
    let mut result = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some((byte, behind)) = rest.split_first() {
        let blanks = behind.iter().take_while(|byte| is_blank(**byte)).count();
        match behind.get(blanks..) {
            Some([b'\n', next @ ..]) if *byte == b'\\' => rest = next,
            _ => {
                result.push(*byte);
                rest = behind;
            }
        }
    }
    result
}
