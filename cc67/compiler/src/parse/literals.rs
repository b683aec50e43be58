//! Constants and strings.

use std::ops::Range;

use crate::ast::{Expression, ExpressionKind, StringLiteral};
use crate::diag::{Diagnostic, Lint};
use crate::pp::number::{self, Number};
use crate::pp::quoted::{self, ProblemKind};
use crate::pp::{Flags, Token, TokenKind};
use crate::source::Span;

use super::Parser;

impl Parser<'_> {
    /// The value of a number, which was read.
    pub(super) fn number(&mut self, token: Token) -> Expression {
        let span = token.span;
        if token.flags.has(Flags::BROKEN) {
            return Expression { kind: ExpressionKind::Error, span };
        }
        let text = self.token_text(token);
        let kind = match number::parse(&text) {
            Ok(Number::Floating(literal)) => ExpressionKind::Floating(literal),
            Ok(Number::Integer { literal, has_float_suffix }) => {
                if has_float_suffix {
                    let written = String::from_utf8_lossy(&text).into_owned();
                    let digits = written.trim_end_matches(['f', 'F']);
                    self.report(
                        Diagnostic::warning(
                            Lint::IntegerFloatSuffix,
                            span,
                            format!("`{written}` is an integer"),
                        )
                        .note("the suffix `f` needs a decimal point before it")
                        .help(format!("write `{digits}.0f` for a `float`, `{digits}` for an `int`")),
                    );
                }
                ExpressionKind::Integer(literal)
            }
            Err(problem) => {
                let diagnostic = Diagnostic::error(part(token, &problem.range), problem.message);
                self.report(match problem.help {
                    Some(help) => diagnostic.help(help),
                    None => diagnostic,
                });
                ExpressionKind::Error
            }
        };
        Expression { kind, span }
    }

    /// The value of a character constant, which was read.
    pub(super) fn character(&mut self, token: Token) -> Expression {
        let span = token.span;
        if token.flags.has(Flags::BROKEN) {
            return Expression { kind: ExpressionKind::Error, span };
        }
        let text = self.token_text(token);
        let (value, problems) = quoted::character(&text);
        let is_wrong = problems.iter().any(|problem| problem.kind == ProblemKind::Error);
        self.report_quoted(token, problems);
        let kind = if is_wrong {
            ExpressionKind::Error
        } else {
            ExpressionKind::Character(value, quoted::encoding(&text))
        };
        Expression { kind, span }
    }

    /// Reads adjacent strings as one.
    pub(super) fn string(&mut self) -> Expression {
        let start = self.peek().span;
        let literal = self.string_literal();
        let span = self.span_since(start);
        Expression { kind: ExpressionKind::String(literal), span }
    }

    /// Reads adjacent strings as one.
    pub(super) fn string_literal(&mut self) -> StringLiteral {
        let mut parts = Vec::new();
        while let Some(token) = self.eat(TokenKind::String) {
            if !token.flags.has(Flags::BROKEN) {
                parts.push((token, self.token_text(token)));
            }
        }
        // A prefix applies to all parts: `L"a" "b"` is `L"ab"`.
        let encodings = parts.iter().map(|(_, text)| quoted::encoding(text));
        let encoding = encodings.max_by_key(|encoding| encoding.size()).unwrap_or_default();
        let mut elements = Vec::new();
        for (token, text) in parts {
            let (part, problems) = quoted::string(&text, encoding);
            self.report_quoted(token, problems);
            elements.extend(part);
        }
        StringLiteral { elements, encoding }
    }

    fn report_quoted(&mut self, token: Token, problems: Vec<quoted::QuotedProblem>) {
        for problem in problems {
            let span = part(token, &problem.range);
            let diagnostic = match problem.kind {
                ProblemKind::Error => Diagnostic::error(span, problem.message),
                ProblemKind::Warning => Diagnostic::warning(Lint::LaxText, span, problem.message),
            };
            self.report(match problem.help {
                Some(help) => diagnostic.help(help),
                None => diagnostic,
            });
        }
    }

    fn token_text(&self, token: Token) -> Vec<u8> {
        crate::pp::token_text(token, self.sources).into_owned()
    }
}

/// The span of some bytes of a token's text.
fn part(token: Token, range: &Range<usize>) -> Span {
    if token.flags.has(Flags::SPLICED) {
        return token.span;
    }
    let offset =
        |at: usize| token.span.lo.saturating_add(u32::try_from(at).unwrap_or(u32::MAX)).min(token.span.hi);
    Span { lo: offset(range.start), hi: offset(range.end), ..token.span }
}
