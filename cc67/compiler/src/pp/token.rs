//! Preprocessing tokens.
//!
//! A token is twenty bytes and `Copy`: its kind, the name of an identifier, and the span of its text. Text made by the
//! preprocessor (joined and quoted tokens) is in the source map's scratch space, so that a span is enough for every
//! token.

use std::borrow::Cow;

use cranelift_entity::EntityRef;
use cranelift_entity::packed_option::ReservedValue;

use crate::names::Name;
use crate::operators::{BinaryOperator, for_each_binary_operator};
use crate::source::{SourceMap, Span};

use super::lexer::without_splices;

/// A preprocessing token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// The kind of token.
    pub kind: TokenKind,
    /// Further facts about it.
    pub flags: Flags,
    /// The name of an identifier; for operands of a macro body the number of the parameter.
    pub name: Name,
    /// The range of its text, and the macro through which it came.
    pub span: Span,
}

impl Token {
    /// Creates a token that is not an identifier.
    #[must_use]
    pub fn new(kind: TokenKind, flags: Flags, span: Span) -> Self {
        Self { kind, flags, name: Name::reserved_value(), span }
    }

    /// The parameter that an operand in a macro body names.
    #[must_use]
    pub(super) fn parameter(&self) -> usize {
        self.name.index()
    }
}

/// The text of a token, as the program means it.
#[must_use]
pub fn token_text(token: Token, sources: &SourceMap) -> Cow<'_, [u8]> {
    let text = sources.text(token.span);
    if token.flags.has(Flags::SPLICED) { without_splices(text).into() } else { text.into() }
}

/// A set of facts about a token.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags(u8);

impl Flags {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// White space or a comment precedes it.
    pub const SPACE: Self = Self(1);
    /// It is the first of its line.
    pub const LINE_START: Self = Self(1 << 1);
    /// A macro name found in its own expansion; it is never expanded.
    pub const NO_EXPAND: Self = Self(1 << 2);
    /// Its text contains a line splice, which does not belong to it.
    pub const SPLICED: Self = Self(1 << 3);
    /// It was diagnosed already; its value is meaningless.
    pub const BROKEN: Self = Self(1 << 4);

    /// The union of both sets of facts.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The facts of `self` that are not in `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// The facts that are in both.
    #[must_use]
    pub const fn only(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Reports whether any fact of `other` is in `self`.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Reports whether the token is separated from the previous one.
    #[must_use]
    pub const fn is_separated(self) -> bool {
        self.has(Self(Self::SPACE.0 | Self::LINE_START.0))
    }
}

macro_rules! token_kinds {
    (
        $($(#[$doc:meta])* $class:ident,)*
        ;
        $($punctuator:ident = $text:literal,)*
    ) => {
        /// The kinds of token.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum TokenKind {
            $($(#[$doc])* $class,)*
            $(
                #[doc = concat!("`", $text, "`")]
                $punctuator,
            )*
        }

        impl TokenKind {
            /// The text of a punctuator.
            #[must_use]
            pub const fn punctuator(self) -> Option<&'static str> {
                match self {
                    $(Self::$punctuator => Some($text),)*
                    _ => None,
                }
            }

            /// Every punctuator with its text.
            const PUNCTUATORS: &[Punctuator] = &[$(($text.as_bytes(), Self::$punctuator),)*];
        }
    };
}

/// A punctuator and its text.
type Punctuator = (&'static [u8], TokenKind);

/// The punctuators, grouped by first byte, the longest first.
static BY_FIRST_BYTE: [Punctuator; TokenKind::PUNCTUATORS.len()] = by_first_byte();

/// For each byte, which of them begin with it.
static OF_FIRST_BYTE: [(u8, u8); 256] = of_first_byte();

impl TokenKind {
    /// The punctuators that begin with a byte, the longest first.
    pub(super) fn punctuators_from(first: u8) -> &'static [Punctuator] {
        let (start, end) = OF_FIRST_BYTE.get(usize::from(first)).copied().unwrap_or_default();
        BY_FIRST_BYTE.get(usize::from(start)..usize::from(end)).unwrap_or(&[])
    }
}

#[expect(clippy::indexing_slicing, reason = "runs when the compiler is built")]
const fn by_first_byte() -> [Punctuator; TokenKind::PUNCTUATORS.len()] {
    let mut sorted = [(b"".as_slice(), TokenKind::End); TokenKind::PUNCTUATORS.len()];
    let mut number = 0;
    while number < sorted.len() {
        let (text, kind) = TokenKind::PUNCTUATORS[number];
        let mut at = number;
        while at > 0 && is_before(text, sorted[at - 1].0) {
            sorted[at] = sorted[at - 1];
            at -= 1;
        }
        sorted[at] = (text, kind);
        number += 1;
    }
    sorted
}

/// Reports whether a punctuator is ordered before another one.
#[expect(clippy::indexing_slicing, reason = "runs when the compiler is built")]
const fn is_before(text: &[u8], other: &[u8]) -> bool {
    text[0] < other[0] || text[0] == other[0] && text.len() > other.len()
}

#[expect(clippy::indexing_slicing, clippy::as_conversions, reason = "runs when the compiler is built")]
const fn of_first_byte() -> [(u8, u8); 256] {
    let mut ranges = [(0, 0); 256];
    let mut at = 0;
    while at < BY_FIRST_BYTE.len() {
        let (start, end) = &mut ranges[BY_FIRST_BYTE[at].0[0] as usize];
        if *end == 0 {
            *start = at as u8;
        }
        at += 1;
        *end = at as u8;
    }
    ranges
}

token_kinds! {
    /// An identifier or keyword.
    Identifier,
    /// A preprocessing number: anything that looks like one.
    Number,
    /// A character constant.
    Character,
    /// A string literal.
    String,
    /// A character that starts no token of C.
    Stray,
    /// In a macro body: a parameter.
    Parameter,
    /// In a macro body: `#parameter`.
    Stringize,
    /// In a macro body: `##`.
    Paste,
    /// The end of the file, of the directive, or of the macro argument.
    End,
    ;
    LeftParen = "(", RightParen = ")", LeftBracket = "[", RightBracket = "]", LeftBrace = "{", RightBrace = "}",
    Semicolon = ";", Comma = ",", Question = "?", Colon = ":", Tilde = "~",
    Dot = ".", Ellipsis = "...", Arrow = "->",
    Plus = "+", PlusPlus = "++", PlusAssign = "+=",
    Minus = "-", MinusMinus = "--", MinusAssign = "-=",
    Star = "*", StarAssign = "*=", Slash = "/", SlashAssign = "/=", Percent = "%", PercentAssign = "%=",
    Less = "<", LessEqual = "<=", ShiftLeft = "<<", ShiftLeftAssign = "<<=",
    Greater = ">", GreaterEqual = ">=", ShiftRight = ">>", ShiftRightAssign = ">>=",
    Assign = "=", Equal = "==", Not = "!", NotEqual = "!=",
    And = "&", AndAnd = "&&", AndAssign = "&=", Or = "|", OrOr = "||", OrAssign = "|=",
    Xor = "^", XorAssign = "^=", Hash = "#", HashHash = "##",
}

macro_rules! tokens_of_operators {
    ($(
        $operator:ident $text:literal = $token:ident $binding:literal $(, $assignment:ident)? => $meaning:ident($of:expr);
    )*) => {
        impl TokenKind {
            /// The binary operator that the token is.
            #[must_use]
            pub(crate) const fn binary_operator(self) -> Option<BinaryOperator> {
                match self {
                    $(Self::$token => Some(BinaryOperator::$operator),)*
                    _ => None,
                }
            }

            /// The operator of the compound assignment that the token is.
            #[must_use]
            pub(crate) const fn compound_assignment(self) -> Option<BinaryOperator> {
                match self {
                    $($(Self::$assignment => Some(BinaryOperator::$operator),)?)*
                    _ => None,
                }
            }
        }
    };
}

for_each_binary_operator!(tokens_of_operators);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn punctuators_are_found_by_their_first_byte_and_the_longest_is_first() {
        let found: usize = (0..=u8::MAX).map(|first| TokenKind::punctuators_from(first).len()).sum();
        assert_eq!(found, TokenKind::PUNCTUATORS.len());
        for (text, kind) in TokenKind::PUNCTUATORS {
            let list = TokenKind::punctuators_from(*text.first().unwrap());
            assert!(
                list.contains(&(*text, *kind)) && list.is_sorted_by_key(|(text, _)| usize::MAX - text.len())
            );
        }
    }

    #[test]
    fn a_token_is_small() {
        assert_eq!(size_of::<Token>(), 20);
    }
}
