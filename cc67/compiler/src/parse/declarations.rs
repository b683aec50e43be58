//! Declarations, function definitions, and the translation unit.

use crate::ast::{
    Declaration, Declarator, Derived, FunctionDefinition, InitDeclarator, Item, Parameters, Specifiers,
    Statement, StatementKind, StaticAssert, Storage, TranslationUnit,
};
use crate::diag::Diagnostic;
use crate::names::word;
use crate::pp::{Flags, TokenKind};
use crate::source::Span;

use super::declarators::NameRule;
use super::scopes::NameMeaning;
use super::{ErrorReported, ParseResult, Parser};

/// A parsed declaration.
enum DeclarationHead {
    /// Variables, types, prototypes.
    Names(Declaration),
    /// Everything before the body of a function.
    Function(Specifiers, Declarator),
}

impl Parser<'_> {
    /// Parses the whole unit.
    pub(super) fn translation_unit(&mut self) -> TranslationUnit {
        // A declaration in a header has about ten tokens.
        let mut unit = TranslationUnit { items: Vec::with_capacity(self.tokens.len() / 10) };
        while self.kind() != TokenKind::End {
            let start = self.at;
            match self.external() {
                Ok(Some(item)) => unit.items.push(item),
                Ok(None) => {}
                Err(ErrorReported) => {
                    self.recovery.is_unwinding = false;
                    self.skip_statement(0);
                }
            }
            // A token that cannot begin a declaration is skipped, so that parsing always makes progress.
            if self.at == start && !self.recovery.is_stopped {
                self.at += 1;
            }
        }
        unit
    }

    fn external(&mut self) -> ParseResult<Option<Item>> {
        let start = self.peek();
        match (start.kind, self.name()) {
            (TokenKind::Semicolon, _) => {
                self.at += 1;
                return Ok(None);
            }
            (TokenKind::RightBrace, _) => {
                self.at += 1;
                // After statements outside of a function, it ends what should be a function.
                if self.recovery.has_loose_statement {
                    return Ok(None);
                }
                return self.fail(Diagnostic::error(start.span, "`}` without `{`").at("closes nothing"));
            }
            (_, Some(word::STATIC_ASSERT)) => return Ok(Some(Item::StaticAssert(self.static_assert()?))),
            (_, Some(word::STATIC_ASSERT_MACRO)) if self.is_static_assert() => {
                return Ok(Some(Item::StaticAssert(self.static_assert()?)));
            }
            (_, Some(word::ASM | word::ASM_ | word::ASM__)) => {
                self.assembler()?;
            }
            _ => {}
        }
        if self.skip_foreign_declaration() {
            return Ok(None);
        }
        if self.is_loose_statement() {
            return self.loose_statement();
        }
        match self.declaration_head(start.span)? {
            DeclarationHead::Names(declaration) => Ok(Some(Item::Declaration(declaration))),
            DeclarationHead::Function(specifiers, declarator) => self
                .function(specifiers, declarator, start.span)
                .map(|function| Some(Item::Function(function))),
        }
    }

    /// A declaration among statements.
    pub(super) fn local_declaration(&mut self) -> ParseResult<Statement> {
        let (start, index) = (self.peek(), self.at);
        match self.declaration_head(start.span)? {
            DeclarationHead::Names(declaration) => {
                let span = declaration.span;
                Ok(Statement { kind: StatementKind::Declaration(declaration), span })
            }
            DeclarationHead::Function(_, declarator) => self.nested_function(&declarator, index),
        }
    }

    /// Reports a function within a function. One that begins a line is probably not meant to be inside.
    pub(super) fn nested_function(
        &mut self,
        declarator: &Declarator,
        start: usize,
    ) -> ParseResult<Statement> {
        let name =
            declarator.name.map_or_else(String::new, |(name, _)| format!(" `{}`", self.spelling(name)));
        let span = declarator.name.map_or(declarator.span, |(_, span)| span);
        let mut diagnostic =
            Diagnostic::error(span, format!("function{name} is defined inside another function"));
        let first = self.tokens.get(start).copied().unwrap_or(self.end);
        let column = self.sources.place(first.span).map_or(1, |place| place.column);
        let is_outer = first.flags.has(Flags::LINE_START) && column == 1;
        if let Some(open) = self.recovery.open.iter().find(|token| token.kind == TokenKind::LeftBrace) {
            // The function's own tokens do not show what was open before it.
            let end = std::mem::replace(&mut self.at, start);
            let open = if is_outer { self.unclosed_brace(*open) } else { *open };
            self.at = end;
            diagnostic = diagnostic.label(open.span, "this `{` is open");
        }
        if is_outer {
            self.report(diagnostic.help("is a `}` missing before it?"));
            // After too many errors the rest was skipped, which must not be undone.
            if !self.recovery.is_stopped {
                self.at = start;
                self.recovery.is_unwinding = true;
            }
        } else {
            self.report(diagnostic.note("functions cannot be nested"));
            self.skip_braces();
        }
        Err(ErrorReported)
    }

    /// `_Static_assert(condition, "message");`
    pub(super) fn static_assert(&mut self) -> ParseResult<StaticAssert> {
        let start = self.next().span;
        if self.kind() != TokenKind::LeftParen {
            return self.fail_expected("`(`");
        }
        self.open();
        let condition = self.conditional()?;
        let message = match self.eat(TokenKind::Comma) {
            Some(_) if self.kind() == TokenKind::String => {
                let elements = self.string_literal().elements;
                Some(elements.into_iter().filter_map(|element| u8::try_from(element).ok()).collect())
            }
            Some(_) => return self.fail_expected("a message in quotes"),
            None => None,
        };
        self.close(TokenKind::RightParen)?;
        let span = self.span_since(start);
        self.semicolon(span)?;
        Ok(StaticAssert { condition, message, span })
    }

    /// Reports whether `static_assert`, which is a macro in C, is used as one.
    pub(super) fn is_static_assert(&self) -> bool {
        self.kind_at(1) == TokenKind::LeftParen
            && self.scopes.meaning(word::STATIC_ASSERT_MACRO) == NameMeaning::Unknown
    }

    /// Reads a declaration, or a function definition up to its body.
    fn declaration_head(&mut self, start: Span) -> ParseResult<DeclarationHead> {
        let mut specifiers = self.specifiers()?;
        if specifiers.ty.is_none() && self.is_unknown_type() {
            self.unknown_type(&mut specifiers);
        }
        // Most declarations have one declarator; a push into an empty vector makes room for four.
        let mut declarators = Vec::with_capacity(1);
        if self.kind() != TokenKind::Semicolon && !self.ends_type_alone(&specifiers) {
            loop {
                let declarator = self.declarator(NameRule::Required)?;
                if declarators.is_empty() && self.begins_body(&declarator) {
                    return Ok(DeclarationHead::Function(specifiers, declarator));
                }
                if self.has_surplus_semicolon(&declarator) {
                    return Ok(DeclarationHead::Function(specifiers, declarator));
                }
                self.declare(&specifiers, &declarator);
                let initializer = if self.eat(TokenKind::Assign).is_some() || self.takes_equality(&declarator)
                {
                    Some(self.initializer()?)
                } else {
                    None
                };
                declarators.push(InitDeclarator { declarator, initializer });
                if self.eat(TokenKind::Comma).is_some() {
                    self.skip_decimals();
                } else if !self.continues_name() && !self.continues_without_comma() {
                    break;
                }
                if self.kind() == TokenKind::Semicolon {
                    break;
                }
            }
        }
        let span = self.span_since(start);
        // The declaration is kept, even if its end is wrong.
        if self.semicolon(span).is_err() {
            let open = self.recovery.open.len();
            self.skip_statement(open);
        }
        Ok(DeclarationHead::Names(Declaration { specifiers, declarators, span }))
    }

    /// Reports whether a type without declarators ends here, its `;` forgotten.
    fn ends_type_alone(&self, specifiers: &Specifiers) -> bool {
        let behind_brace = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        specifiers.ty.is_some()
            && behind_brace.is_some_and(|token| token.kind == TokenKind::RightBrace)
            && self.peek().flags.has(Flags::LINE_START)
            && (self.kind() == TokenKind::End
                || self.name().is_some_and(|name| self.is_declaration_word(name))
                || self.is_identifier_at(0) && self.kind_at(1) == TokenKind::LeftParen)
    }

    /// Reports a `;` between the head of a function and its body; returns true if there is one.
    fn has_surplus_semicolon(&mut self, declarator: &Declarator) -> bool {
        let is_head = matches!(declarator.derived.first(), Some(Derived::Function(_)))
            && self.scopes.is_outermost()
            && self.kind() == TokenKind::Semicolon
            && self.kind_at(1) == TokenKind::LeftBrace;
        if is_head {
            let span = self.next().span;
            let message = "`;` between the head of a function and its body";
            self.report(Diagnostic::error(span, message).help("remove the `;`"));
        }
        is_head
    }

    /// Reads an `==` in place of the `=` before an initialiser, and reports it.
    fn takes_equality(&mut self, declarator: &Declarator) -> bool {
        let Some(token) = self.eat(TokenKind::Equal) else { return false };
        let name = declarator.name.map_or("it", |(name, _)| self.spelling(name));
        let help = format!("write `=` to give `{name}` its value");
        self.report(Diagnostic::error(token.span, "`==` compares").help(help));
        true
    }

    /// Skips the decimals of a number that was written with a comma, as in `double x = 2,54;`.
    fn skip_decimals(&mut self) {
        let whole = self.at.checked_sub(2).and_then(|at| self.tokens.get(at)).copied();
        let token = self.peek();
        let Some(whole) = whole.filter(|whole| whole.kind == TokenKind::Number) else { return };
        if token.kind == TokenKind::Number && !token.flags.has(Flags::SPACE) {
            self.at += 1;
            let number = format!("{}.{}", self.text(whole.span), self.text(token.span));
            let span = whole.span.to(token.span);
            let diagnostic = Diagnostic::error(span, "the decimal point of a number is `.`, not `,`");
            self.report(diagnostic.help(format!("write `{number}`")));
        }
    }

    /// Reports a variable that begins without a comma, as in `int last = 0 pulses = 0;`; returns true if there is one.
    fn continues_without_comma(&mut self) -> bool {
        let next = self.peek();
        let is_variable = self.is_identifier_at(0)
            && !next.flags.has(Flags::LINE_START)
            && self.kind_at(1) == TokenKind::Assign;
        if is_variable {
            let before = format!("before {}", self.describe(next));
            let diagnostic = Diagnostic::error(self.end_of_last(), "expected `,` between two variables");
            self.report(diagnostic.at(before));
        }
        is_variable
    }

    /// Reports a name that continues after a `-`, as in `int home-speed = 5;`; returns true if there is one.
    fn continues_name(&mut self) -> bool {
        let Some(first) = self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).copied() else {
            return false;
        };
        let is_name = first.kind == TokenKind::Identifier
            && self.kind() == TokenKind::Minus
            && self.is_identifier_at(1);
        if !is_name {
            return false;
        }
        self.at += 1;
        let span = first.span.to(self.peek().span);
        let name = format!("{}_{}", self.text(first.span), self.text(self.peek().span));
        let diagnostic = Diagnostic::error(span, "a name can contain only letters, digits and `_`");
        self.report(diagnostic.help(format!("write `{name}`")));
        true
    }

    fn declare(&mut self, specifiers: &Specifiers, declarator: &Declarator) {
        let is_typedef = matches!(specifiers.storage, Some((Storage::Typedef, _)));
        if let Some((name, _)) = declarator.name {
            self.scopes.declare(name, if is_typedef { NameMeaning::Type } else { NameMeaning::Ordinary });
        }
    }

    /// Reports whether the declarator is of a function, followed by its body or old-style declarations.
    fn begins_body(&self, declarator: &Declarator) -> bool {
        match declarator.derived.first() {
            Some(Derived::Function(Parameters::Names(_))) => {
                self.kind() == TokenKind::LeftBrace
                    || self.name().is_some_and(|name| self.is_declaration_word(name))
                        && !self.peek_is_new_declaration()
            }
            Some(Derived::Function(_)) => self.kind() == TokenKind::LeftBrace,
            _ => false,
        }
    }

    /// Reports whether another function or prototype follows an old-style list, the `;` forgotten.
    fn peek_is_new_declaration(&self) -> bool {
        let mut ahead = 0;
        loop {
            match self.kind_at(ahead) {
                TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::Comma | TokenKind::End => {
                    return false;
                }
                TokenKind::LeftParen => return self.kind_at(ahead + 1) != TokenKind::Star,
                _ => ahead += 1,
            }
        }
    }

    fn function(
        &mut self,
        specifiers: Specifiers,
        declarator: Declarator,
        start: Span,
    ) -> ParseResult<FunctionDefinition> {
        self.has_function = true;
        self.declare(&specifiers, &declarator);
        self.scopes.enter();
        self.declare_parameters(&declarator);
        let result = self.function_body();
        self.scopes.leave();
        let (old_style, body) = result?;
        Ok(FunctionDefinition { specifiers, declarator, old_style, body, span: self.span_since(start) })
    }

    fn function_body(&mut self) -> ParseResult<(Vec<Declaration>, Statement)> {
        let mut old_style = Vec::new();
        while self.kind() != TokenKind::LeftBrace {
            let start = self.peek().span;
            match self.declaration_head(start)? {
                DeclarationHead::Names(declaration) => old_style.push(declaration),
                DeclarationHead::Function(_, declarator) => {
                    let message = "expected the body of the function before this one";
                    return self.fail(Diagnostic::error(declarator.span, message));
                }
            }
            if !self.name().is_some_and(|name| self.is_declaration_word(name))
                && self.kind() != TokenKind::LeftBrace
            {
                return self.fail_expected("`{`, the body of the function");
            }
        }
        let start = self.peek().span;
        let statements = self.nested(Self::block);
        if self.recovery.is_unwinding {
            self.recovery.is_unwinding = false;
            self.recovery.open.clear();
        }
        let kind = StatementKind::Block(statements?);
        Ok((old_style, Statement { kind, span: self.span_since(start) }))
    }

    fn declare_parameters(&mut self, declarator: &Declarator) {
        match declarator.derived.first() {
            Some(Derived::Function(Parameters::Prototype { parameters, .. })) => {
                for (name, _) in parameters.iter().filter_map(|parameter| parameter.declarator.name) {
                    self.scopes.declare(name, NameMeaning::Ordinary);
                }
            }
            Some(Derived::Function(Parameters::Names(names))) => {
                for (name, _) in names {
                    self.scopes.declare(*name, NameMeaning::Ordinary);
                }
            }
            _ => {}
        }
    }

    /// Reports whether a statement is at a position where only declarations are allowed.
    fn is_loose_statement(&self) -> bool {
        let Some(name) = self.name() else {
            return self.kind() != TokenKind::Star && self.kind() != TokenKind::LeftParen;
        };
        if name.is_keyword() {
            return !self.is_declaration_word(name) && name != word::EXTENSION;
        }
        if self.is_type_word(name) {
            return false;
        }
        match self.kind_at(1) {
            TokenKind::Arrow | TokenKind::Dot | TokenKind::PlusPlus | TokenKind::MinusMinus => true,
            TokenKind::LeftParen => matches!(
                self.kind_at(2),
                TokenKind::Number
                    | TokenKind::String
                    | TokenKind::Character
                    | TokenKind::And
                    | TokenKind::Minus
            ),
            kind => kind.compound_assignment().is_some(),
        }
    }

    fn loose_statement(&mut self) -> ParseResult<Option<Item>> {
        if self.recovery.has_loose_statement {
            self.at += 1;
            return Err(ErrorReported);
        }
        self.recovery.has_loose_statement = true;
        if self.kind() != TokenKind::Identifier {
            return self.fail_expected("a declaration");
        }
        // The `}` that ended a function before this statement is surplus.
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).copied();
        let token = self.next();
        let text = self.text(token.span);
        let diagnostic = Diagnostic::error(token.span, format!("statement outside a function, at `{text}`"));
        self.fail(match before {
            Some(brace) if brace.kind == TokenKind::RightBrace && self.has_function => {
                diagnostic.label(brace.span, "this `}` ends the function before").help("remove the extra `}`")
            }
            _ => diagnostic.help("put it between the braces of a function such as `main() { … }`"),
        })
    }
}
