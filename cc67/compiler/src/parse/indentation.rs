//! Finds the `{` that was probably left open, by indentation.
//!
//! After a missing `}`, every later one closes the wrong block, so that the first brace of the function remains open.
//! But a `}` at the beginning of a line is indented like the line of its `{`; the first `}` that is further left than
//! the block it closes shows which block was not closed.

use crate::pp::{Flags, Token, TokenKind};

use super::Parser;

impl Parser<'_> {
    /// The brace that was probably left open between `outer`, an open one, and the next token.
    pub(super) fn unclosed_brace(&self, outer: Token) -> Token {
        if outer.kind != TokenKind::LeftBrace {
            return outer;
        }
        let Some(tokens) = self.tokens.get(..self.at) else { return outer };
        let start = tokens.partition_point(|token| token.span.lo < outer.span.lo);
        // Spans of included files are not in the order of the including file.
        let start = match tokens.get(start) {
            Some(token) if token.span == outer.span => start,
            _ => match tokens.iter().rposition(|token| token.span == outer.span) {
                Some(start) => start,
                None => return outer,
            },
        };
        let mut open: Vec<(Token, u32)> = Vec::new();
        let mut indent = self.column(outer);
        for token in tokens.get(start..).unwrap_or_default() {
            if token.flags.has(Flags::LINE_START) {
                indent = self.column(*token);
            }
            match token.kind {
                TokenKind::LeftBrace => open.push((*token, indent)),
                TokenKind::RightBrace => {
                    let Some((opener, of_block)) = open.pop() else { return outer };
                    if token.flags.has(Flags::LINE_START) && indent < of_block {
                        return opener;
                    }
                }
                _ => {}
            }
        }
        open.last().map_or(outer, |(opener, _)| *opener)
    }

    /// Reports whether the next token, which begins a line, is not further right than the line of `opener`.
    pub(super) fn stands_left_of_block(&self, opener: Token) -> bool {
        let token = self.peek();
        token.flags.has(Flags::LINE_START) && self.column(token) <= self.indent(opener)
    }

    /// The column of the first token of the line that holds `token`.
    fn indent(&self, token: Token) -> u32 {
        let before = self.tokens.get(..self.at).unwrap_or_default().iter().rev();
        let mut line = before.skip_while(|known| known.span != token.span);
        line.find(|known| known.flags.has(Flags::LINE_START)).map_or(1, |first| self.column(*first))
    }

    fn column(&self, token: Token) -> u32 {
        self.sources.place(token.span).map_or(1, |place| place.column)
    }
}
