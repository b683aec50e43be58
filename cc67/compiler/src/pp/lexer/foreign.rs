//! Bytes without a meaning in C outside of comments and strings.
//!
//! They come from word processors, web pages and other keyboards. Each gets one message with the character's name and
//! its replacement, and is then treated as that replacement.

use crate::diag::Diagnostic;
use crate::names::is_name_byte;

use super::super::LAX;
use super::super::token::{Flags, Token, TokenKind};
use super::{Lexer, LexerContext};

/// The complaints already reported for this file.
#[derive(Debug, Default)]
pub(super) struct ReportedComplaints {
    space: bool,
    control: bool,
}

/// The meaning of a character.
enum CharacterMeaning {
    Space,
    Quote(u8),
    Punctuator(TokenKind, &'static str),
    Letter,
}

impl Lexer {
    /// Skips a space that is none in C.
    pub(super) fn skip_foreign_space(&mut self, cx: &mut LexerContext<'_>) -> bool {
        let (character, length) = self.character();
        if !matches!(character_meaning(character), CharacterMeaning::Space) {
            return false;
        }
        if !self.complained.space {
            let span = self.span_to(self.at, self.at + length);
            let message = format!("{} is treated as a space", name_of(character));
            cx.sink.report(Diagnostic::warning(LAX, span, message).help("replace it with a space"));
            self.complained.space = true;
        }
        self.at += length;
        true
    }

    /// Reports whether the next bytes are a character that can be mistaken for a letter.
    pub(super) fn is_foreign_letter(&self) -> bool {
        matches!(character_meaning(self.character().0), CharacterMeaning::Letter)
    }

    /// Reads a name that continues with other letters.
    pub(super) fn foreign_name(&mut self, lo: usize, flags: Flags, cx: &mut LexerContext<'_>) -> Token {
        let mut first = None;
        loop {
            let (character, length) = self.character();
            if character.is_ascii() && is_name_byte(self.byte(self.at)) {
                self.at += 1;
            } else if !character.is_ascii()
                && matches!(character_meaning(character), CharacterMeaning::Letter)
            {
                first = first.or(Some((self.at, self.at + length, character)));
                self.at += length;
            } else {
                break;
            }
        }
        if let Some((from, to, character)) = first {
            let message = format!("{} outside a comment or string", name_of(character));
            cx.sink.report(
                Diagnostic::error(self.span_to(from, to), message)
                    .note("names consist of the letters A to Z, digits and underscores"),
            );
        }
        let spelling = String::from_utf8_lossy(self.bytes(lo, self.at)).into_owned();
        let name = cx.names.intern(&spelling);
        Token { kind: TokenKind::Identifier, flags, name, span: self.span_from(lo) }
    }

    /// Reads a token from a byte that cannot begin a C token; `None` if nothing remains of it.
    pub(super) fn foreign_token(&mut self, flags: Flags, cx: &mut LexerContext<'_>) -> Option<Token> {
        let lo = self.at;
        let (character, length) = self.character();
        if character.is_ascii_control() {
            self.control(character, cx);
            return None;
        }
        if character.is_ascii() {
            self.at += 1;
            return Some(Token::new(TokenKind::Stray, flags, self.span_from(lo)));
        }
        match character_meaning(character) {
            CharacterMeaning::Quote(quote) => Some(self.curly(quote, character, length, flags, cx)),
            CharacterMeaning::Punctuator(kind, text) => {
                self.at += length;
                let span = self.span_from(lo);
                let message = format!("{} outside a comment or string", name_of(character));
                cx.sink.report(Diagnostic::error(span, message).help(format!("write `{text}`")));
                Some(Token::new(kind, flags, span))
            }
            CharacterMeaning::Letter | CharacterMeaning::Space => Some(self.foreign_name(lo, flags, cx)),
        }
    }

    /// NUL, Ctrl-Z and other control characters.
    fn control(&mut self, character: char, cx: &mut LexerContext<'_>) {
        let span = self.span_to(self.at, self.at + 1);
        self.at += 1;
        if self.complained.control {
            return;
        }
        self.complained.control = true;
        let message = match character {
            '\0' => "NUL byte in the source text".to_owned(),
            '\x1A' => "Ctrl-Z before the end of the source text".to_owned(),
            _ => format!("control character 0x{:02X} in the source text", u32::from(character)),
        };
        let diagnostic = Diagnostic::error(span, message);
        cx.sink.report(if character == '\0' {
            diagnostic.note("the file may be damaged, or saved as UTF-16")
        } else {
            diagnostic
        });
    }

    /// A typographic quote: the text up to its partner on the same line is a broken string or constant.
    fn curly(
        &mut self,
        quote: u8,
        character: char,
        length: usize,
        flags: Flags,
        cx: &mut LexerContext<'_>,
    ) -> Token {
        let lo = self.at;
        let opening = self.span_to(lo, lo + length);
        let line_end = self.end_of_line(lo);
        let mut closing = None;
        self.at += length;
        let behind = self.at;
        while self.at < line_end && closing.is_none() {
            let (next, length) = self.character();
            let is_partner =
                matches!(character_meaning(next), CharacterMeaning::Quote(other) if other == quote);
            self.at += length;
            closing = (is_partner || next == char::from(quote)).then_some(self.at);
        }
        self.at = closing.unwrap_or(behind);
        let message = format!("{} is not a quote in C", name_of(character));
        let help = format!("write `{}`", char::from(quote));
        cx.sink.report(Diagnostic::error(opening, message).help(help));
        let kind = if quote == b'"' { TokenKind::String } else { TokenKind::Character };
        Token::new(kind, flags.with(Flags::BROKEN), self.span_from(lo))
    }

    /// The next character and its length in bytes: UTF-8, or the Windows code page if it is not.
    fn character(&self) -> (char, usize) {
        let bytes = self.bytes(self.at, self.at + 4);
        let first = self.byte(self.at);
        let length = match first {
            0xC2..=0xDF => 2,
            0xE0..=0xEF => 3,
            0xF0..=0xF4 => 4,
            _ => 1,
        };
        let decoded = bytes.get(..length).and_then(|bytes| std::str::from_utf8(bytes).ok());
        match decoded.and_then(|text| text.chars().next()) {
            Some(character) => (character, length),
            None => (from_windows(first), 1),
        }
    }
}

/// Code page 1252, as far as relevant differences from Latin-1 are concerned.
fn from_windows(byte: u8) -> char {
    match byte {
        0x82 | 0x91 => '\u{2018}',
        0x92 => '\u{2019}',
        0x84 | 0x93 => '\u{201C}',
        0x94 => '\u{201D}',
        0x85 => '\u{2026}',
        0x96 => '\u{2013}',
        0x97 => '\u{2014}',
        _ => char::from(byte),
    }
}

fn character_meaning(character: char) -> CharacterMeaning {
    match character {
        '\u{A0}' | '\u{2000}'..='\u{200B}' | '\u{202F}' | '\u{205F}' | '\u{3000}' | '\u{FEFF}' => {
            CharacterMeaning::Space
        }
        '\u{201C}'..='\u{201F}' | '\u{AB}' | '\u{BB}' => CharacterMeaning::Quote(b'"'),
        '\u{2018}'..='\u{201B}' | '\u{B4}' => CharacterMeaning::Quote(b'\''),
        '\u{2010}'..='\u{2015}' | '\u{2212}' => CharacterMeaning::Punctuator(TokenKind::Minus, "-"),
        '\u{D7}' => CharacterMeaning::Punctuator(TokenKind::Star, "*"),
        '\u{F7}' => CharacterMeaning::Punctuator(TokenKind::Slash, "/"),
        '\u{2026}' => CharacterMeaning::Punctuator(TokenKind::Ellipsis, "..."),
        '\u{2264}' => CharacterMeaning::Punctuator(TokenKind::LessEqual, "<="),
        '\u{2265}' => CharacterMeaning::Punctuator(TokenKind::GreaterEqual, ">="),
        '\u{2260}' => CharacterMeaning::Punctuator(TokenKind::NotEqual, "!="),
        '\u{37E}' | '\u{FF1B}' => CharacterMeaning::Punctuator(TokenKind::Semicolon, ";"),
        _ => CharacterMeaning::Letter,
    }
}

/// The character as a message names it.
fn name_of(character: char) -> String {
    let name = match character {
        '\u{A0}' => "no-break space",
        '\u{FEFF}' => "byte order mark",
        '\u{200B}' => "zero-width space",
        _ if matches!(character_meaning(character), CharacterMeaning::Space) => "typographic space",
        _ => return format!("character `{character}` (U+{:04X})", u32::from(character)),
    };
    format!("{name} (U+{:04X})", u32::from(character))
}
