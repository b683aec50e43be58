//! The expressions of `#if`.
//!
//! They are computed in 64 bits, signed unless an operand is unsigned, as in C99. Operands that `&&`, `||` and `?:` do
//! not evaluate are parsed, but cannot divide by zero.

use crate::diag::Diagnostic;
use crate::names::word;
use crate::operators::{BinaryOp, BinaryOperator, OperatorMeaning};
use crate::source::Span;

use super::engine::Preprocessor;
use super::number::Number;
use super::token::{Flags, Token, TokenKind};
use super::{limits, number, quoted};

/// A value in 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ConditionValue {
    bits: i64,
    is_unsigned: bool,
}

impl ConditionValue {
    const fn signed(bits: i64) -> Self {
        Self { bits, is_unsigned: false }
    }

    const fn from_bool(truth: bool) -> Self {
        Self::signed(if truth { 1 } else { 0 })
    }

    const fn is_true(self) -> bool {
        self.bits != 0
    }
}

/// Says that the expression was reported to be wrong.
struct ErrorReported;

/// The precedence of `,`, lower than that of any operator.
const COMMA: u8 = 0;

type EvalResult = Result<ConditionValue, ErrorReported>;

impl Preprocessor<'_> {
    /// The truth of the expression on the rest of the line; false, with an error, if it is not an expression.
    pub(super) fn condition(&mut self, directive: Span) -> bool {
        let tokens = self.condition_tokens();
        if tokens.is_empty() {
            self.sink.report(Diagnostic::error(directive, "expression missing after the directive"));
            return false;
        }
        let mut parser = Parser { pp: self, tokens: &tokens, at: 0, depth: 0, is_evaluated: true };
        match parser.parse_all() {
            Ok(value) => value.is_true(),
            Err(ErrorReported) => false,
        }
    }

    /// The rest of the line, expanded except for the operands of `defined`.
    fn condition_tokens(&mut self) -> Vec<Token> {
        let mut tokens: Vec<Token> = Vec::new();
        loop {
            let mut token = self.directive_token();
            if token.kind == TokenKind::End {
                return self.expand_list(tokens);
            }
            let is_defined = |token: Option<&Token>| token.is_some_and(|token| token.name == word::DEFINED);
            let is_paren = tokens.last().is_some_and(|token| token.kind == TokenKind::LeftParen);
            let before_paren = tokens.len().checked_sub(2).and_then(|at| tokens.get(at));
            if is_defined(tokens.last()) || is_paren && is_defined(before_paren) {
                token.flags = token.flags.with(Flags::NO_EXPAND);
            }
            tokens.push(token);
        }
    }
}

struct Parser<'a, 'b> {
    pp: &'a mut Preprocessor<'b>,
    tokens: &'a [Token],
    at: usize,
    depth: usize,
    /// The value is needed.
    is_evaluated: bool,
}

impl Parser<'_, '_> {
    fn parse_all(&mut self) -> EvalResult {
        let value = self.conditional()?;
        match self.peek() {
            None => Ok(value),
            Some(token) => {
                let found = self.text(token);
                let diagnostic =
                    Diagnostic::error(token.span, format!("unexpected `{found}` in `#if` expression"));
                let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
                let is_call = token.kind == TokenKind::LeftParen;
                let diagnostic = match before.filter(|before| is_call && before.kind == TokenKind::Identifier)
                {
                    Some(before) if before.name == word::SIZEOF => diagnostic
                        .note("the preprocessor does not know types, so it cannot evaluate `sizeof`"),
                    Some(before) => diagnostic.note(format!("no macro `{}` is defined", self.text(*before))),
                    None => diagnostic,
                };
                self.fail(diagnostic)
            }
        }
    }

    /// `a ? b : c` and everything that binds tighter.
    fn conditional(&mut self) -> EvalResult {
        self.depth += 1;
        if self.depth > limits::NESTING {
            let span = self.peek().map_or(Span::new(0, 0), |token| token.span);
            let message = format!("`#if` expression nested deeper than {}", limits::NESTING);
            return self.fail(Diagnostic::error(span, message));
        }
        let condition = self.binary(0)?;
        let value = if self.eat(TokenKind::Question) {
            let then = self.parse_if_needed(condition.is_true(), Self::conditional)?;
            self.expect(TokenKind::Colon)?;
            let otherwise = self.parse_if_needed(!condition.is_true(), Self::conditional)?;
            let chosen = if condition.is_true() { then } else { otherwise };
            ConditionValue { is_unsigned: then.is_unsigned || otherwise.is_unsigned, ..chosen }
        } else {
            condition
        };
        self.depth -= 1;
        Ok(value)
    }

    /// Operators of at least the precedence `least`.
    fn binary(&mut self, least: u8) -> EvalResult {
        let mut left = self.unary()?;
        while let Some(token) = self.peek() {
            let operator = token.kind.binary_operator();
            let is_comma = token.kind == TokenKind::Comma;
            let binding = operator.map(BinaryOperator::binding).or(is_comma.then_some(COMMA));
            let Some(binding) = binding.filter(|binding| *binding >= least) else { break };
            self.at += 1;
            let meaning = operator.map(BinaryOperator::meaning);
            let is_decided = matches!(
                meaning,
                Some(OperatorMeaning::Logical(decides)) if left.is_true() == decides
            );
            let right = self.parse_if_needed(!is_decided, |parser| parser.binary(binding + 1))?;
            left = match meaning {
                Some(meaning) => self.apply(meaning, token.span, left, right)?,
                None => right,
            };
        }
        Ok(left)
    }

    fn unary(&mut self) -> EvalResult {
        let mut operators = Vec::new();
        while let Some(token) = self.peek() {
            if !matches!(token.kind, TokenKind::Not | TokenKind::Tilde | TokenKind::Minus | TokenKind::Plus) {
                break;
            }
            operators.push(token.kind);
            self.at += 1;
        }
        let mut value = self.primary()?;
        while let Some(operator) = operators.pop() {
            value = match operator {
                TokenKind::Not => ConditionValue::from_bool(!value.is_true()),
                TokenKind::Tilde => ConditionValue { bits: !value.bits, ..value },
                TokenKind::Minus => ConditionValue { bits: value.bits.wrapping_neg(), ..value },
                _ => value,
            };
        }
        Ok(value)
    }

    fn primary(&mut self) -> EvalResult {
        let Some(token) = self.peek() else {
            let span = self.tokens.last().map_or(Span::new(0, 0), |token| token.span);
            return self.fail(
                Diagnostic::error(span, "`#if` expression ends too early")
                    .at("expected an operand after this"),
            );
        };
        self.at += 1;
        match token.kind {
            TokenKind::Identifier if token.name == word::DEFINED => self.parse_defined(token),
            TokenKind::Identifier => Ok(ConditionValue::signed(0)),
            TokenKind::Number => self.number(token),
            TokenKind::Character => {
                let text = self.pp.spelling(token);
                let (value, problems) = quoted::character(&text);
                let broken = token.flags.has(Flags::BROKEN);
                match problems.into_iter().next().filter(|_| !broken) {
                    Some(problem) => self.fail(Diagnostic::error(token.span, problem.message)),
                    None => Ok(ConditionValue::signed(i64::from(value))),
                }
            }
            TokenKind::LeftParen => {
                let value = self.conditional()?;
                self.expect(TokenKind::RightParen)?;
                Ok(value)
            }
            _ => {
                let found = self.text(token);
                let message = format!("`{found}` is not allowed in an `#if` expression");
                self.fail(Diagnostic::error(token.span, message).at("expected an operand"))
            }
        }
    }

    /// `defined name` or `defined(name)`
    fn parse_defined(&mut self, operator: Token) -> EvalResult {
        let has_paren = self.eat(TokenKind::LeftParen);
        let Some(name) = self.peek().filter(|token| token.kind == TokenKind::Identifier) else {
            return self.fail(Diagnostic::error(operator.span, "expected a name after `defined`"));
        };
        self.at += 1;
        if has_paren {
            self.expect(TokenKind::RightParen)?;
        }
        Ok(ConditionValue::from_bool(self.pp.is_defined(name.name)))
    }

    fn number(&mut self, token: Token) -> EvalResult {
        if token.flags.has(Flags::BROKEN) {
            return Err(ErrorReported);
        }
        let text = self.pp.spelling(token);
        match number::parse(&text) {
            Ok(Number::Integer { literal, .. }) => {
                let bits = literal.value.cast_signed();
                let is_unsigned = literal.is_unsigned || bits < 0;
                Ok(ConditionValue { bits, is_unsigned })
            }
            Ok(Number::Floating(_)) => {
                let message = "floating constant in an `#if` expression";
                self.fail(Diagnostic::error(token.span, message).note("only integers are allowed"))
            }
            Err(problem) => self.fail(Diagnostic::error(token.span, problem.message)),
        }
    }

    fn apply(
        &mut self,
        meaning: OperatorMeaning,
        span: Span,
        left: ConditionValue,
        right: ConditionValue,
    ) -> EvalResult {
        let is_unsigned = left.is_unsigned || right.is_unsigned;
        let (a, b) = (left.bits, right.bits);
        let bits = match meaning {
            OperatorMeaning::Logical(decides) => {
                let is_decided = left.is_true() == decides || right.is_true() == decides;
                return Ok(ConditionValue::from_bool(is_decided == decides));
            }
            OperatorMeaning::Compare(op) => {
                let unsigned = a.cast_unsigned().cmp(&b.cast_unsigned());
                let order = if is_unsigned { unsigned } else { a.cmp(&b) };
                return Ok(ConditionValue::from_bool(op.holds(Some(order))));
            }
            OperatorMeaning::Shift(op) => return Ok(ConditionValue { bits: shift(op, left, b), ..left }),
            OperatorMeaning::Arithmetic(op) | OperatorMeaning::Bitwise(op) => {
                match op.in_64_bits(is_unsigned)(a, b) {
                    Some(bits) => bits,
                    None if self.is_evaluated => {
                        return self.fail(Diagnostic::error(span, "division by zero in `#if` expression"));
                    }
                    None => 0,
                }
            }
        };
        Ok(ConditionValue { bits, is_unsigned })
    }

    /// Parses an operand that is only evaluated under a condition.
    fn parse_if_needed(&mut self, is_needed: bool, parse: impl Fn(&mut Self) -> EvalResult) -> EvalResult {
        let outer = self.is_evaluated;
        self.is_evaluated &= is_needed;
        let value = parse(self);
        self.is_evaluated = outer;
        value
    }

    fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).copied()
    }

    fn eat(&mut self, kind: TokenKind) -> bool {
        let is_next = self.peek().is_some_and(|token| token.kind == kind);
        self.at += usize::from(is_next);
        is_next
    }

    fn expect(&mut self, kind: TokenKind) -> Result<(), ErrorReported> {
        if self.eat(kind) {
            return Ok(());
        }
        let wanted = kind.punctuator().unwrap_or("an operand");
        let (span, found) = match self.peek() {
            Some(token) => (token.span, format!(", found `{}`", self.text(token))),
            None => (self.tokens.last().map_or(Span::new(0, 0), |token| token.span), String::new()),
        };
        let message = format!("expected `{wanted}` in `#if` expression{found}");
        self.fail(Diagnostic::error(span, message)).map(|_| ())
    }

    fn text(&self, token: Token) -> String {
        String::from_utf8_lossy(&self.pp.spelling(token)).into_owned()
    }

    fn fail(&mut self, diagnostic: Diagnostic) -> EvalResult {
        self.pp.sink.report(diagnostic);
        Err(ErrorReported)
    }
}

/// `value op count`; to the other side for a negative count.
fn shift(op: BinaryOp, value: ConditionValue, count: i64) -> i64 {
    if (0..i64::from(i64::BITS)).contains(&count) {
        return op.in_64_bits(value.is_unsigned)(value.bits, count).unwrap_or_default();
    }
    let is_left = (op == BinaryOp::ShiftLeft) == (count >= 0);
    let distance = u32::try_from(count.unsigned_abs()).unwrap_or(u32::MAX);
    match (is_left, value.is_unsigned) {
        (true, _) => value.bits.checked_shl(distance).unwrap_or(0),
        (false, true) => value.bits.cast_unsigned().checked_shr(distance).unwrap_or(0).cast_signed(),
        (false, false) => value.bits >> distance.min(63),
    }
}
