//! Statements.

use crate::ast::{Expression, ExpressionKind, Statement, StatementKind};
use crate::diag::Diagnostic;
use crate::names::word;
use crate::pp::{Flags, TokenKind};
use crate::source::Span;

use super::{ErrorReported, ParseResult, Parser};

impl Parser<'_> {
    /// `{ … }`: its statements.
    pub(super) fn block(&mut self) -> ParseResult<Vec<Statement>> {
        let depth = self.recovery.open.len();
        self.open();
        self.scopes.enter();
        let mut statements = Vec::new();
        while !matches!(self.kind(), TokenKind::RightBrace | TokenKind::End) && !self.recovery.is_unwinding {
            if self.is_branch && self.ends_before_else() {
                self.scopes.leave();
                return Ok(statements);
            }
            let is_branch = std::mem::take(&mut self.is_branch);
            statements.push(self.statement());
            self.is_branch = is_branch;
        }
        self.scopes.leave();
        if self.recovery.is_unwinding {
            self.recovery.open.truncate(depth);
            return Ok(statements);
        }
        self.close(TokenKind::RightBrace)?;
        Ok(statements)
    }

    /// A statement or declaration; after an error it is reported and skipped.
    fn statement(&mut self) -> Statement {
        let (start, index, open) = (self.peek().span, self.at, self.recovery.open.len());
        match self.nested(Self::any_statement) {
            Ok(statement) => statement,
            Err(ErrorReported) => {
                self.skip_statement(open);
                if self.at == index
                    && !self.recovery.is_stopped
                    && !self.recovery.is_unwinding
                    && self.kind() != TokenKind::RightBrace
                {
                    self.at += 1;
                }
                let span = if self.recovery.is_unwinding { start } else { self.span_since(start) };
                let error = Expression { kind: ExpressionKind::Error, span };
                Statement { kind: StatementKind::Expression(error), span }
            }
        }
    }

    /// The statement that a condition, a loop or a label governs.
    fn body(&mut self) -> ParseResult<Box<Statement>> {
        if self.kind() == TokenKind::RightBrace || self.kind() == TokenKind::End {
            return self.fail_expected("a statement");
        }
        Ok(Box::new(self.statement()))
    }

    fn any_statement(&mut self) -> ParseResult<Statement> {
        let start = self.peek().span;
        match self.kind() {
            TokenKind::LeftBrace => {
                let statements = self.block()?;
                Ok(self.finish(StatementKind::Block(statements), start))
            }
            TokenKind::Semicolon => {
                self.at += 1;
                Ok(Statement { kind: StatementKind::Empty, span: start })
            }
            TokenKind::Identifier => self.word_statement(start),
            TokenKind::RightParen | TokenKind::RightBracket => self.surplus_bracket(),
            _ => self.expression_statement(start),
        }
    }

    /// A bracket without an opening partner, and the statement after it.
    fn surplus_bracket(&mut self) -> ParseResult<Statement> {
        let token = self.next();
        let text = token.kind.punctuator().unwrap_or_default();
        self.report(Diagnostic::error(token.span, format!("extra `{text}`")).at("closes nothing"));
        while matches!(self.kind(), TokenKind::RightParen | TokenKind::RightBracket) {
            self.at += 1;
        }
        match self.kind() {
            TokenKind::RightBrace | TokenKind::End => Err(ErrorReported),
            _ => self.any_statement(),
        }
    }

    /// A statement that begins with a word.
    fn word_statement(&mut self, start: Span) -> ParseResult<Statement> {
        let Some(name) = self.name() else { return self.expression_statement(start) };
        if !name.is_keyword() && self.kind_at(1) == TokenKind::Colon {
            return self.label(start);
        }
        if let Some(statement) = self.foreign_statement() {
            return statement;
        }
        let name = self.miswritten_keyword().unwrap_or(name);
        let kind = match name {
            word::IF => self.if_()?,
            word::WHILE => self.while_()?,
            word::DO => return self.do_while(start),
            word::FOR => self.for_()?,
            word::SWITCH => self.switch()?,
            word::CASE => self.case()?,
            word::DEFAULT => {
                self.at += 1;
                self.colon("after `default`")?;
                StatementKind::Default(self.labelled_statement()?)
            }
            word::GOTO | word::BREAK | word::CONTINUE | word::RETURN => return self.jump(start),
            word::ELSE => {
                let token = self.next();
                return self.fail(
                    Diagnostic::error(token.span, "`else` without `if`")
                        .note("one statement, or several in `{ }`, can be between `if (…)` and `else`")
                        .help("are braces missing, or is there a `;` directly after `if (…)`?"),
                );
            }
            word::ASM | word::ASM_ | word::ASM__ => {
                self.assembler()?;
                StatementKind::Empty
            }
            word::STATIC_ASSERT => StatementKind::StaticAssert(self.static_assert()?),
            word::STATIC_ASSERT_MACRO if self.is_static_assert() => {
                StatementKind::StaticAssert(self.static_assert()?)
            }
            word::EXTENSION if self.is_extended_declaration() => return self.local_declaration(),
            _ if self.is_declaration_word(name) || self.is_unknown_type() => return self.local_declaration(),
            _ => return self.expression_statement(start),
        };
        Ok(self.finish(kind, start))
    }

    fn is_extended_declaration(&self) -> bool {
        let ahead = (0..).take_while(|ahead| self.name_at(*ahead) == Some(word::EXTENSION)).count();
        self.name_at(ahead).is_some_and(|name| self.is_declaration_word(name))
    }

    fn finish(&self, kind: StatementKind, start: Span) -> Statement {
        Statement { kind, span: self.span_since(start) }
    }

    fn expression_statement(&mut self, start: Span) -> ParseResult<Statement> {
        let index = self.at;
        let expression = self.expression()?;
        if self.kind() == TokenKind::LeftBrace
            && let ExpressionKind::Call(function, _) = &expression.kind
            && let ExpressionKind::Identifier(name) = function.kind
        {
            let declarator = crate::ast::Declarator {
                name: Some((name, function.span)),
                derived: Vec::new(),
                alignments: Vec::new(),
                span: function.span,
            };
            return self.nested_function(&declarator, index);
        }
        let span = expression.span;
        self.semicolon(span)?;
        Ok(self.finish(StatementKind::Expression(expression), start))
    }

    /// `( … )` after `if`, `while` and the like. If it cannot be parsed the statement is parsed all the same.
    fn condition(&mut self, keyword: &str) -> ParseResult<Expression> {
        let start = self.peek();
        if start.kind != TokenKind::LeftParen {
            return self.bare_condition(keyword);
        }
        let open = self.recovery.open.len();
        self.open();
        let condition =
            self.expression().and_then(|condition| self.close(TokenKind::RightParen).map(|_| condition));
        match condition {
            Ok(condition) => Ok(condition),
            Err(ErrorReported) if self.recovery.is_stopped || self.recovery.is_unwinding => {
                Err(ErrorReported)
            }
            Err(ErrorReported) => {
                self.skip_to_close(open);
                Ok(Expression { kind: ExpressionKind::Error, span: self.span_since(start.span) })
            }
        }
    }

    /// A condition without its parentheses, as in `if x > 3:`.
    fn bare_condition(&mut self, keyword: &str) -> ParseResult<Expression> {
        let start = self.peek();
        let expected = format!("`(` after `{keyword}`");
        let begins_operand = matches!(
            start.kind,
            TokenKind::Identifier | TokenKind::Number | TokenKind::Not | TokenKind::Minus
        );
        if !begins_operand || start.flags.has(Flags::BROKEN) {
            return self.fail_expected(&expected);
        }
        let message = format!("expected {expected}, found {}", self.describe(start));
        let help = format!("the condition needs parentheses: `{keyword} (…)`");
        self.report(Diagnostic::error(start.span, message).help(help));
        self.expression()?;
        self.eat(TokenKind::Colon);
        Ok(Expression { kind: ExpressionKind::Error, span: self.span_since(start.span) })
    }

    fn if_(&mut self) -> ParseResult<StatementKind> {
        self.at += 1;
        let condition = self.condition("if")?;
        self.skip_then();
        self.is_branch = true;
        let then = self.body();
        self.is_branch = false;
        let then = then?;
        let otherwise = if self.take_word(word::ELSE).is_some() || self.is_miswritten_else() {
            Some(self.body()?)
        } else if self.is_else_if() {
            let start = self.peek().span;
            let kind = self.nested(Self::if_)?;
            Some(Box::new(self.finish(kind, start)))
        } else {
            None
        };
        Ok(StatementKind::If { condition, then, otherwise })
    }

    /// Reads an `else` with a capital letter.
    fn is_miswritten_else(&mut self) -> bool {
        let is_else = self.name().is_some_and(|name| self.spelling(name).eq_ignore_ascii_case("else"))
            && self.miswritten_keyword() == Some(word::ELSE);
        self.at += usize::from(is_else);
        is_else
    }

    /// Reports a block after `if` that lacks its `}` before an `else`; returns true if there is one.
    fn ends_before_else(&mut self) -> bool {
        let Some(opener) = self.recovery.open.last().copied() else { return false };
        if self.name() != Some(word::ELSE) || !self.stands_left_of_block(opener) {
            return false;
        }
        let diagnostic = Diagnostic::error(self.peek().span, "expected `}` before `else`");
        self.report(diagnostic.label(opener.span, "this `{` is open"));
        self.recovery.open.pop();
        true
    }

    fn while_(&mut self) -> ParseResult<StatementKind> {
        self.at += 1;
        let condition = self.condition("while")?;
        Ok(StatementKind::While { condition, body: self.body()? })
    }

    fn do_while(&mut self, start: Span) -> ParseResult<Statement> {
        self.at += 1;
        let body = self.body()?;
        if self.take_word(word::WHILE).is_none() {
            return self.fail_expected("`while` after the body of `do`");
        }
        let condition = self.condition("while")?;
        let span = self.span_since(start);
        self.semicolon(span)?;
        Ok(Statement { kind: StatementKind::DoWhile { body, condition }, span })
    }

    fn for_(&mut self) -> ParseResult<StatementKind> {
        self.at += 1;
        if self.kind() != TokenKind::LeftParen {
            return self.fail_expected("`(` after `for`");
        }
        let open = self.recovery.open.len();
        let start = self.open().span;
        self.scopes.enter();
        let head = self.for_head();
        let head = match head {
            Ok(head) => Ok(head),
            Err(ErrorReported) if self.recovery.is_stopped || self.recovery.is_unwinding => {
                Err(ErrorReported)
            }
            Err(ErrorReported) => {
                self.skip_to_close(open);
                let span = self.span_since(start);
                let init = Box::new(Statement { kind: StatementKind::Empty, span });
                Ok((init, Some(Expression { kind: ExpressionKind::Error, span }), None))
            }
        };
        let result = head.and_then(|(init, condition, step)| {
            Ok(StatementKind::For { init, condition, step, body: self.body()? })
        });
        self.scopes.leave();
        result
    }

    /// `init; condition; step)`
    fn for_head(&mut self) -> ParseResult<(Box<Statement>, Option<Expression>, Option<Expression>)> {
        let start = self.peek().span;
        let init = match self.name() {
            _ if self.kind() == TokenKind::Semicolon => {
                self.at += 1;
                Statement { kind: StatementKind::Empty, span: start }
            }
            Some(name) if self.is_declaration_word(name) || self.is_unknown_type() => {
                self.local_declaration()?
            }
            _ => {
                let init = self.expression()?;
                self.for_semicolon("after the first part of `for`")?;
                self.finish(StatementKind::Expression(init), start)
            }
        };
        let condition = if self.kind() == TokenKind::Semicolon { None } else { Some(self.expression()?) };
        self.for_semicolon("after the condition of `for`")?;
        let step = if self.kind() == TokenKind::RightParen { None } else { Some(self.expression()?) };
        self.close(TokenKind::RightParen)?;
        Ok((Box::new(init), condition, step))
    }

    fn for_semicolon(&mut self, what: &str) -> ParseResult<()> {
        if self.eat(TokenKind::Semicolon).is_some() {
            return Ok(());
        }
        let found = self.peek();
        if found.kind == TokenKind::End || found.flags.has(Flags::BROKEN) {
            return self.fail_expected(&format!("`;` {what}"));
        }
        let message = format!("expected `;` {what}, found {}", self.describe(found));
        let help = "the three parts are separated by `;`, as in `for (i = 0; i < 8; i++)`";
        self.fail(Diagnostic::error(found.span, message).help(help))
    }

    fn switch(&mut self) -> ParseResult<StatementKind> {
        self.at += 1;
        let value = self.condition("switch")?;
        Ok(StatementKind::Switch { value, body: self.body()? })
    }

    fn case(&mut self) -> ParseResult<StatementKind> {
        self.at += 1;
        let first = self.conditional()?;
        let last = match self.eat(TokenKind::Ellipsis) {
            Some(_) => Some(self.conditional()?),
            None => None,
        };
        self.colon("after the value of `case`")?;
        Ok(StatementKind::Case { first, last, body: self.labelled_statement()? })
    }

    /// Takes `:`; a `;` in its place is accepted after an error.
    fn colon(&mut self, what: &str) -> ParseResult<()> {
        if self.eat(TokenKind::Colon).is_some() {
            return Ok(());
        }
        let found = self.peek();
        if found.kind == TokenKind::Semicolon
            || found.flags.has(Flags::LINE_START) && found.kind != TokenKind::End
        {
            let diagnostic = Diagnostic::error(self.end_of_last(), format!("expected `:` {what}"));
            self.report(diagnostic);
            self.eat(TokenKind::Semicolon);
            return Ok(());
        }
        self.fail_expected(&format!("`:` {what}"))
    }

    fn label(&mut self, start: Span) -> ParseResult<Statement> {
        let token = self.next();
        self.at += 1;
        self.attributes()?;
        let (name, name_span) = (token.name, token.span);
        let body = self.labelled_statement()?;
        Ok(self.finish(StatementKind::Label { name, name_span, body }, start))
    }

    /// Parses the statement after a label, which may be missing at the end of a block.
    fn labelled_statement(&mut self) -> ParseResult<Box<Statement>> {
        if self.kind() == TokenKind::RightBrace {
            return Ok(Box::new(Statement { kind: StatementKind::Empty, span: self.end_of_last() }));
        }
        self.body()
    }

    /// `goto`, `break`, `continue`, `return`
    fn jump(&mut self, start: Span) -> ParseResult<Statement> {
        let keyword = self.next();
        let kind = match keyword.name {
            word::BREAK => StatementKind::Break,
            word::CONTINUE => StatementKind::Continue,
            word::GOTO if self.is_identifier_at(0) => {
                let label = self.next();
                StatementKind::Goto(label.name, label.span)
            }
            word::GOTO if self.eat(TokenKind::Star).is_some() => {
                StatementKind::GotoAddress(self.expression()?)
            }
            word::GOTO => return self.fail_expected("a label"),
            _ if matches!(self.kind(), TokenKind::Semicolon | TokenKind::RightBrace) => {
                StatementKind::Return(None)
            }
            _ => StatementKind::Return(Some(self.expression()?)),
        };
        let span = self.span_since(start);
        self.semicolon(span)?;
        Ok(self.finish(kind, start))
    }
}
