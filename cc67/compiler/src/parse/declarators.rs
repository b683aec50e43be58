//! Declarators: a name, and the type derived around it.

use crate::ast::{Alignment, Declarator, Derived, Parameter, Parameters, Qualifiers, Specifiers, TypeName};
use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::pp::TokenKind;
use crate::source::Span;

use super::{NESTING, ParseResult, Parser};

/// The name of a declarator and the derivations inside its parentheses.
type DirectDeclarator = (Option<(Name, Span)>, Vec<Derived>);

/// The rule for the name of a declarator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NameRule {
    /// In a declaration.
    Required,
    /// In a parameter.
    Optional,
    /// In a cast or `sizeof`.
    Forbidden,
}

impl Parser<'_> {
    /// Reads a declarator.
    pub(super) fn declarator(&mut self, naming: NameRule) -> ParseResult<Declarator> {
        let start = self.peek().span;
        let pointers = self.pointers()?;
        let (name, mut derived) = self.direct_declarator(naming)?;
        loop {
            match self.kind() {
                TokenKind::LeftBracket => derived.push(self.array()?),
                TokenKind::LeftParen => {
                    let parameters = self.nested(Self::parameters)?;
                    derived.push(Derived::Function(parameters));
                }
                _ => break,
            }
        }
        if derived.len() + pointers.len() > NESTING {
            return Err(self.too_deep());
        }
        derived.extend(pointers.into_iter().rev().map(Derived::Pointer));
        let span = if name.is_none() && derived.is_empty() {
            Span { hi: start.lo, ..start }
        } else {
            self.span_since(start)
        };
        let alignments = self.labels_and_attributes()?;
        Ok(Declarator { name, derived, alignments, span })
    }

    /// `type declarator` without a name.
    pub(super) fn type_name(&mut self) -> ParseResult<TypeName> {
        let start = self.peek().span;
        let mut specifiers = self.specifiers()?;
        if specifiers.ty.is_none() && self.is_identifier_at(0) {
            self.unknown_type(&mut specifiers);
        }
        let declarator = self.declarator(NameRule::Forbidden)?;
        Ok(TypeName { specifiers, declarator, span: self.span_since(start) })
    }

    #[inline(never)]
    fn pointers(&mut self) -> ParseResult<Vec<Qualifiers>> {
        let mut pointers = Vec::new();
        while self.eat(TokenKind::Star).is_some() {
            let mut qualifiers = Qualifiers::default();
            while self.qualifier(&mut qualifiers)? {}
            pointers.push(qualifiers);
        }
        Ok(pointers)
    }

    /// The name, or a declarator in parentheses.
    fn direct_declarator(&mut self, naming: NameRule) -> ParseResult<DirectDeclarator> {
        if naming != NameRule::Forbidden && self.is_identifier_at(0) {
            let token = self.next();
            return Ok((Some((token.name, token.span)), Vec::new()));
        }
        if self.kind() == TokenKind::LeftParen && (naming == NameRule::Required || !self.opens_parameters()) {
            self.open();
            self.attributes()?;
            let inner = self.nested(|parser| parser.declarator(naming))?;
            self.close(TokenKind::RightParen)?;
            return Ok((inner.name, inner.derived));
        }
        if naming == NameRule::Required {
            return self.fail_expected("a name");
        }
        Ok((None, Vec::new()))
    }

    /// Reports whether the next parenthesis holds the parameters of a function without a name.
    ///
    /// Attributes can begin both: `int (__attribute__((noinline)) *)(void)` is a pointer.
    fn opens_parameters(&self) -> bool {
        let first = self.after_attributes(1);
        self.kind_at(first) == TokenKind::RightParen
            || self.kind_at(first) == TokenKind::Ellipsis
            || self.name_at(first).is_some_and(|name| self.is_declaration_word(name))
    }

    /// The index of the first token at or after `ahead` that does not belong to an attribute.
    fn after_attributes(&self, mut ahead: usize) -> usize {
        while matches!(self.name_at(ahead), Some(word::ATTRIBUTE | word::ATTRIBUTE__)) {
            let mut depth = 0;
            loop {
                ahead += 1;
                match self.kind_at(ahead) {
                    TokenKind::LeftParen => depth += 1,
                    TokenKind::RightParen => depth -= 1,
                    TokenKind::End => return ahead,
                    _ => {}
                }
                if depth <= 0 {
                    break;
                }
            }
            ahead += 1;
        }
        ahead
    }

    /// `[length]`, `[]` or `[*]`
    #[inline(never)]
    fn array(&mut self) -> ParseResult<Derived> {
        self.open();
        let mut qualifiers = Qualifiers::default();
        while self.take_word(word::STATIC).is_some() || self.qualifier(&mut qualifiers)? {}
        let length = match self.kind() {
            TokenKind::RightBracket => None,
            // `[*]` in a prototype: a length that the definition gives.
            TokenKind::Star if self.kind_at(1) == TokenKind::RightBracket => {
                self.at += 1;
                None
            }
            _ => Some(Box::new(self.nested(Self::assignment)?)),
        };
        self.close(TokenKind::RightBracket)?;
        Ok(Derived::Array(length))
    }

    /// `(parameters)`
    #[inline(never)]
    fn parameters(&mut self) -> ParseResult<Parameters> {
        self.open();
        let parameters = if self.kind() == TokenKind::RightParen {
            Parameters::Unspecified
        } else if self.name() == Some(word::VOID) && self.kind_at(1) == TokenKind::RightParen {
            self.at += 1;
            Parameters::Prototype { parameters: Vec::new(), is_variadic: false }
        } else if self.opens_names() {
            self.parameter_names()?
        } else {
            self.prototype()?
        };
        self.close(TokenKind::RightParen)?;
        Ok(parameters)
    }

    /// Reports whether an old-style list of names is next.
    fn opens_names(&self) -> bool {
        self.is_identifier_at(0)
            && !self.name().is_some_and(|name| self.is_type_word(name))
            && matches!(self.kind_at(1), TokenKind::Comma | TokenKind::RightParen)
    }

    fn parameter_names(&mut self) -> ParseResult<Parameters> {
        let mut names = Vec::new();
        loop {
            if !self.is_identifier_at(0) {
                return self.fail_expected("the name of a parameter");
            }
            let token = self.next();
            names.push((token.name, token.span));
            if self.eat(TokenKind::Comma).is_none() {
                return Ok(Parameters::Names(names));
            }
        }
    }

    fn prototype(&mut self) -> ParseResult<Parameters> {
        let mut parameters = Vec::with_capacity(1);
        loop {
            if self.eat(TokenKind::Ellipsis).is_some() {
                return Ok(Parameters::Prototype { parameters, is_variadic: true });
            }
            parameters.push(self.parameter()?);
            if self.eat(TokenKind::Comma).is_none() {
                return Ok(Parameters::Prototype { parameters, is_variadic: false });
            }
        }
    }

    #[inline(never)]
    fn parameter(&mut self) -> ParseResult<Parameter> {
        let start = self.peek();
        let mut specifiers = self.specifiers()?;
        let is_bare = specifiers.span.lo == specifiers.span.hi;
        if specifiers.ty.is_none() && (self.is_unknown_type() || is_bare && self.is_identifier_at(0)) {
            // `const x` is an `int`; a mere name among typed parameters, or two names, lack a type.
            self.unknown_type(&mut specifiers);
        } else if is_bare {
            return self.fail_expected("a parameter");
        }
        self.reference(&mut specifiers);
        let declarator = self.declarator(NameRule::Optional)?;
        Ok(Parameter { specifiers, declarator, span: self.span_since(start.span) })
    }

    /// Skips the `&` of a C++ reference; the declared type has already been reported.
    fn reference(&mut self, specifiers: &mut Specifiers) {
        if self.kind() != TokenKind::And || !self.is_identifier_at(1) {
            return;
        }
        let token = self.next();
        let (ty, name) = (self.text(specifiers.span), self.text(self.peek().span));
        let diagnostic = Diagnostic::error(token.span, "references belong to C++");
        self.report(
            diagnostic.help(format!("write a pointer, `{ty} *{name}`, and `{name}->` for its members")),
        );
        specifiers.ty = Some(Self::missing_type(token.span));
    }

    /// `asm("name")` and attributes after a declarator.
    fn labels_and_attributes(&mut self) -> ParseResult<Vec<Alignment>> {
        if matches!(self.name(), Some(word::ASM | word::ASM_ | word::ASM__)) {
            self.assembler()?;
        }
        self.attributes()
    }
}
