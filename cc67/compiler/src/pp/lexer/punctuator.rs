//! The longest punctuator at a place.

use super::super::token::TokenKind;
use super::Lexer;

impl Lexer {
    /// Reads the punctuator that starts with `byte`, the next one.
    pub(super) fn punctuator(&mut self, byte: u8) -> Option<TokenKind> {
        for (text, kind) in TokenKind::punctuators_from(byte) {
            if let Some(end) = self.punctuator_end(text) {
                self.at = end;
                return Some(*kind);
            }
        }
        None
    }

    /// The end of a punctuator that begins with the next byte, if the rest of it follows.
    fn punctuator_end(&self, text: &[u8]) -> Option<usize> {
        let mut end = self.at + 1;
        for byte in text.iter().skip(1) {
            let next = self.past_splices(end);
            if self.byte(next) != *byte {
                return None;
            }
            end = next + 1;
        }
        Some(end)
    }
}
