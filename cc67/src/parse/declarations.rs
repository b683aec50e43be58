//! Declarations, function definitions, and the translation unit.

use crate::ast::{
    Declaration, Declarator, Derived, FunctionDefinition, InitDeclarator, Item, Parameters, Specifiers,
    Statement, StatementKind, StaticAssert, Storage, TranslationUnit,
};
use crate::diag::Diagnostic;
use crate::names::word;
use crate::pp::{Flags, TokenKind};
use crate::source::Span;

use super::declarators::Naming;
use super::scopes::Meaning;
use super::{Parsed, Parser, Reported};

/// What a declaration turned out to be.
enum Declared {
    /// Variables, types, prototypes.
    Names(Declaration),
    /// Everything before the body of a function.
    Function(Specifiers, Declarator),
}

impl Parser<'_> {
    /// Reads everything.
    pub(super) fn translation_unit(&mut self) -> TranslationUnit {
        let mut unit = TranslationUnit::default();
        while self.kind() != TokenKind::End {
            let start = self.at;
            match self.external() {
                Ok(Some(item)) => unit.items.push(item),
                Ok(None) => {}
                Err(Reported) => {
                    self.is_unwinding = false;
                    self.skip_statement(0);
                }
            }
            // Whatever cannot begin a declaration is left out, so that parsing always goes on.
            if self.at == start && !self.is_stopped {
                self.at += 1;
            }
        }
        unit
    }

    fn external(&mut self) -> Parsed<Option<Item>> {
        let start = self.peek();
        match (start.kind, self.name()) {
            (TokenKind::Semicolon, _) => {
                self.at += 1;
                return Ok(None);
            }
            (TokenKind::RightBrace, _) => {
                self.at += 1;
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
        if self.is_loose_statement() {
            return self.loose_statement();
        }
        match self.declared(start.span)? {
            Declared::Names(declaration) => Ok(Some(Item::Declaration(declaration))),
            Declared::Function(specifiers, declarator) => self
                .function(specifiers, declarator, start.span)
                .map(|function| Some(Item::Function(function))),
        }
    }

    /// A declaration among statements.
    pub(super) fn local_declaration(&mut self) -> Parsed<Statement> {
        let (start, index) = (self.peek(), self.at);
        match self.declared(start.span)? {
            Declared::Names(declaration) => {
                let span = declaration.span;
                Ok(Statement { kind: StatementKind::Declaration(declaration), span })
            }
            Declared::Function(_, declarator) => self.nested_function(&declarator, index),
        }
    }

    /// Reports a function within a function. One that begins a line is probably not meant to be inside.
    pub(super) fn nested_function(&mut self, declarator: &Declarator, start: usize) -> Parsed<Statement> {
        let name =
            declarator.name.map_or_else(String::new, |(name, _)| format!(" `{}`", self.spelling(name)));
        let span = declarator.name.map_or(declarator.span, |(_, span)| span);
        let mut diagnostic = Diagnostic::error(span, format!("function{name} is defined within a function"));
        let first = self.tokens.get(start).copied().unwrap_or(self.end);
        let column = self.sources.place(first.span).map_or(1, |place| place.column);
        let is_outer = first.flags.has(Flags::LINE_START) && column == 1;
        if let Some(open) = self.open.last() {
            diagnostic = diagnostic.label(open.span, "this `{` is open");
        }
        if is_outer {
            self.report(diagnostic.help("is a `}` missing before it?"));
            self.at = start;
            self.is_unwinding = true;
        } else {
            self.report(diagnostic.note("functions cannot be nested"));
            self.skip_braces();
        }
        Err(Reported)
    }

    /// `_Static_assert(condition, "message");`
    pub(super) fn static_assert(&mut self) -> Parsed<StaticAssert> {
        let start = self.next().span;
        if self.kind() != TokenKind::LeftParen {
            return self.fail_expected("`(`");
        }
        self.open();
        let condition = self.conditional()?;
        let message = match self.take(TokenKind::Comma) {
            Some(_) if self.kind() == TokenKind::String => {
                let elements = self.string_literal().elements;
                Some(elements.into_iter().filter_map(|element| u8::try_from(element).ok()).collect())
            }
            Some(_) => return self.fail_expected("a message in quotes"),
            None => None,
        };
        self.close(TokenKind::RightParen)?;
        let span = self.since(start);
        self.semicolon(span)?;
        Ok(StaticAssert { condition, message, span })
    }

    /// Whether `static_assert`, which is a macro in C, is used as one.
    pub(super) fn is_static_assert(&self) -> bool {
        self.kind_at(1) == TokenKind::LeftParen
            && self.scopes.meaning(word::STATIC_ASSERT_MACRO) == Meaning::Unknown
    }

    /// Reads a declaration, or a function definition up to its body.
    fn declared(&mut self, start: Span) -> Parsed<Declared> {
        let mut specifiers = self.specifiers()?;
        if specifiers.ty.is_none() && self.is_unknown_type() {
            self.unknown_type(&mut specifiers);
        }
        let mut declarators = Vec::new();
        if self.kind() != TokenKind::Semicolon && !self.ends_type_alone(&specifiers) {
            loop {
                let declarator = self.declarator(Naming::Required)?;
                if declarators.is_empty() && self.begins_body(&declarator) {
                    return Ok(Declared::Function(specifiers, declarator));
                }
                self.declare(&specifiers, &declarator);
                let initializer = match self.take(TokenKind::Assign) {
                    Some(_) => Some(self.initializer()?),
                    None => None,
                };
                declarators.push(InitDeclarator { declarator, initializer });
                if self.take(TokenKind::Comma).is_none() {
                    break;
                }
            }
        }
        let span = self.since(start);
        // What was read is kept, even if its end is in doubt.
        if self.semicolon(span).is_err() {
            let open = self.open.len();
            self.skip_statement(open);
        }
        Ok(Declared::Names(Declaration { specifiers, declarators, span }))
    }

    /// Whether a type without declarators ends here, its `;` forgotten.
    fn ends_type_alone(&self, specifiers: &Specifiers) -> bool {
        let behind_brace = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        specifiers.ty.is_some()
            && behind_brace.is_some_and(|token| token.kind == TokenKind::RightBrace)
            && self.peek().flags.has(Flags::LINE_START)
            && (self.kind() == TokenKind::End
                || self.name().is_some_and(|name| self.is_declaration_word(name)))
    }

    fn declare(&mut self, specifiers: &Specifiers, declarator: &Declarator) {
        let is_typedef = matches!(specifiers.storage, Some((Storage::Typedef, _)));
        if let Some((name, _)) = declarator.name {
            self.scopes.declare(name, if is_typedef { Meaning::Type } else { Meaning::Ordinary });
        }
    }

    /// Whether the declarator is that of a function whose body, or old-style declarations, come next.
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

    /// Whether what follows an old-style list is another function or prototype, the `;` forgotten.
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
    ) -> Parsed<FunctionDefinition> {
        self.declare(&specifiers, &declarator);
        self.scopes.enter();
        self.declare_parameters(&declarator);
        let result = self.function_body();
        self.scopes.leave();
        let (old_style, body) = result?;
        Ok(FunctionDefinition { specifiers, declarator, old_style, body, span: self.since(start) })
    }

    fn function_body(&mut self) -> Parsed<(Vec<Declaration>, Statement)> {
        let mut old_style = Vec::new();
        while self.kind() != TokenKind::LeftBrace {
            let start = self.peek().span;
            match self.declared(start)? {
                Declared::Names(declaration) => old_style.push(declaration),
                Declared::Function(_, declarator) => {
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
        if self.is_unwinding {
            self.is_unwinding = false;
            self.open.clear();
        }
        let kind = StatementKind::Block(statements?);
        Ok((old_style, Statement { kind, span: self.since(start) }))
    }

    fn declare_parameters(&mut self, declarator: &Declarator) {
        match declarator.derived.first() {
            Some(Derived::Function(Parameters::Prototype { parameters, .. })) => {
                for (name, _) in parameters.iter().filter_map(|parameter| parameter.declarator.name) {
                    self.scopes.declare(name, Meaning::Ordinary);
                }
            }
            Some(Derived::Function(Parameters::Names(names))) => {
                for (name, _) in names {
                    self.scopes.declare(*name, Meaning::Ordinary);
                }
            }
            _ => {}
        }
    }

    /// Whether a statement stands where only declarations may.
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
            kind => super::operators::compound_assignment(kind).is_some(),
        }
    }

    fn loose_statement(&mut self) -> Parsed<Option<Item>> {
        if self.has_loose_statement {
            self.at += 1;
            return Err(Reported);
        }
        self.has_loose_statement = true;
        if self.kind() != TokenKind::Identifier {
            return self.fail_expected("a declaration");
        }
        let token = self.next();
        let text = self.text(token.span);
        self.fail(
            Diagnostic::error(token.span, format!("statement outside of a function, at `{text}`"))
                .note("statements stand between the braces of a function such as `main() { … }`")
                .help("is there a `}` too many before it?"),
        )
    }
}
