//! The longest punctuator at a place.

use super::super::token::TokenKind::{
    self, And, AndAnd, AndAssign, Arrow, Assign, Colon, Comma, Dot, Ellipsis, Equal, Greater, GreaterEqual,
    Hash, HashHash, LeftBrace, LeftBracket, LeftParen, Less, LessEqual, Minus, MinusAssign, MinusMinus, Not,
    NotEqual, Or, OrAssign, OrOr, Percent, PercentAssign, Plus, PlusAssign, PlusPlus, Question, RightBrace,
    RightBracket, RightParen, Semicolon, ShiftLeft, ShiftLeftAssign, ShiftRight, ShiftRightAssign, Slash,
    SlashAssign, Star, StarAssign, Tilde, Xor, XorAssign,
};
use super::Lexer;

impl Lexer {
    /// Reads the punctuator that starts with `byte`, the next one.
    pub(super) fn punctuator(&mut self, byte: u8) -> Option<TokenKind> {
        let kind = match byte {
            b'(' => LeftParen,
            b')' => RightParen,
            b'[' => LeftBracket,
            b']' => RightBracket,
            b'{' => LeftBrace,
            b'}' => RightBrace,
            b';' => Semicolon,
            b',' => Comma,
            b'?' => Question,
            b':' => Colon,
            b'~' => Tilde,
            b'.' => Dot,
            b'+' => return Some(self.longest(Plus, &[(b'+', PlusPlus), (b'=', PlusAssign)])),
            b'-' => {
                return Some(self.longest(Minus, &[(b'-', MinusMinus), (b'=', MinusAssign), (b'>', Arrow)]));
            }
            b'*' => return Some(self.longest(Star, &[(b'=', StarAssign)])),
            b'/' => return Some(self.longest(Slash, &[(b'=', SlashAssign)])),
            b'%' => return Some(self.longest(Percent, &[(b'=', PercentAssign)])),
            b'=' => return Some(self.longest(Assign, &[(b'=', Equal)])),
            b'!' => return Some(self.longest(Not, &[(b'=', NotEqual)])),
            b'&' => return Some(self.longest(And, &[(b'&', AndAnd), (b'=', AndAssign)])),
            b'|' => return Some(self.longest(Or, &[(b'|', OrOr), (b'=', OrAssign)])),
            b'^' => return Some(self.longest(Xor, &[(b'=', XorAssign)])),
            b'#' => return Some(self.longest(Hash, &[(b'#', HashHash)])),
            b'<' => return Some(self.longest(Less, &[(b'=', LessEqual), (b'<', ShiftLeft)])),
            b'>' => return Some(self.longest(Greater, &[(b'=', GreaterEqual), (b'>', ShiftRight)])),
            _ => return None,
        };
        self.at += 1;
        if kind == Dot {
            let second = self.past_splices(self.at);
            let third = self.past_splices(second + 1);
            if self.byte(second) == b'.' && self.byte(third) == b'.' {
                self.at = third + 1;
                return Some(Ellipsis);
            }
        }
        Some(kind)
    }

    /// `short`, or what the byte after it makes of it.
    fn longest(&mut self, short: TokenKind, long: &[(u8, TokenKind)]) -> TokenKind {
        self.at += 1;
        let next = self.past_splices(self.at);
        let byte = self.byte(next);
        let Some((_, kind)) = long.iter().find(|(second, _)| *second == byte) else { return short };
        match kind {
            // Steps onto the second byte, which then is the first of what remains.
            ShiftLeft => {
                self.at = next;
                self.longest(ShiftLeft, &[(b'=', ShiftLeftAssign)])
            }
            ShiftRight => {
                self.at = next;
                self.longest(ShiftRight, &[(b'=', ShiftRightAssign)])
            }
            _ => {
                self.at = next + 1;
                *kind
            }
        }
    }
}
