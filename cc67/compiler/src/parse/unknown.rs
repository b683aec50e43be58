//! Names used like types that are not types.
//!
//! The usual reason is a missing include, so this is the first error of many programs. Each such name is reported once;
//! its declarations get the type of an expression that was already diagnosed.

use crate::ast::{Expression, ExpressionKind, Specifiers, TypeSpecifier};
use crate::diag::Diagnostic;
use crate::names::Name;
use crate::pp::TokenKind;
use crate::source::Span;
use crate::words::foreign as foreign_words;
use crate::words::suggest;

use super::Parser;
use super::scopes::NameMeaning;

/// Types of the board's header.
const HEADER_TYPES: &[&str] = &[
    "CHAN",
    "PERSIST",
    "GATHER",
    "GATHER_VALUE_DEF",
    "SPINDLE",
    "IIR",
    "MAIN_STATUS",
    "TRIP_COEFF",
    "PARAMETRIC_COEFF",
    "USERCALLBACK",
    "BOOL",
    "FILE",
    "size_t",
];

/// Words that may come before a name.
const WORDS: &[&str] = &[
    "int", "double", "float", "char", "void", "unsigned", "short", "long", "struct", "static", "extern",
    "const", "typedef", "return", "else", "case", "goto",
];

impl Parser<'_> {
    /// The type of declarations with a missing type.
    pub(super) fn missing_type(span: Span) -> TypeSpecifier {
        TypeSpecifier::TypeofExpression(Box::new(Expression { kind: ExpressionKind::Error, span }))
    }

    /// Reports whether the next tokens can only be a declaration with a type that does not exist: `name name`, or `name
    /// *name` where `name` is undeclared.
    pub(super) fn is_unknown_type(&self) -> bool {
        let Some(name) = self.name().filter(|name| !name.is_keyword()) else { return false };
        if self.is_type_word(name) || self.scopes.meaning(name) != NameMeaning::Unknown {
            return false;
        }
        match self.kind_at(1) {
            TokenKind::Identifier => self.is_identifier_at(1),
            TokenKind::Star => {
                let stars = (1..).take_while(|ahead| self.kind_at(*ahead) == TokenKind::Star).count();
                self.is_identifier_at(1 + stars)
                    && matches!(
                        self.kind_at(2 + stars),
                        TokenKind::Semicolon
                            | TokenKind::Assign
                            | TokenKind::Comma
                            | TokenKind::LeftBracket
                            | TokenKind::LeftParen
                            | TokenKind::RightParen
                    )
            }
            _ => false,
        }
    }

    /// Reads a name that is not a type in place of one, reports it, and completes `specifiers` with it.
    pub(super) fn unknown_type(&mut self, specifiers: &mut Specifiers) {
        let token = self.next();
        self.report_unknown_type(token.name, token.span);
        specifiers.ty = Some(Self::missing_type(token.span));
        specifiers.span = self.span_since(if specifiers.span.lo == specifiers.span.hi {
            token.span
        } else {
            specifiers.span
        });
    }

    fn report_unknown_type(&mut self, name: Name, span: Span) {
        self.scopes.set_missing_type(name);
        // A file that was not found may define it.
        if self.sink.lacks_names() {
            return;
        }
        let spelling = self.spelling(name);
        let diagnostic = Diagnostic::error(span, format!("unknown type `{spelling}`"));
        let diagnostic = diagnostic.help(self.type_help(spelling));
        self.report(diagnostic);
    }

    /// The advice about a missing type.
    fn type_help(&self, spelling: &str) -> String {
        if let Some(keyword) = self.tag_keyword(spelling) {
            return format!("write `{keyword} {spelling}`");
        }
        if let Some((_, help)) = foreign_words::TYPES.iter().find(|(other, _)| *other == spelling) {
            return (*help).to_owned();
        }
        if HEADER_TYPES.contains(&spelling) {
            return "is `KMotionDef.h` included?".to_owned();
        }
        if let Some(near) = suggest(spelling, WORDS.iter().copied()) {
            return format!("did you mean `{near}`?");
        }
        match (suggest(spelling, HEADER_TYPES.iter().copied()), self.has_board_header()) {
            (Some(near), true) => format!("did you mean `{near}`?"),
            (Some(near), false) => format!("did you mean `{near}`? is `KMotionDef.h` included?"),
            (None, true) => "declare it with `typedef` or `struct`".to_owned(),
            (None, false) => "is the header that declares it included, such as `KMotionDef.h`?".to_owned(),
        }
    }

    /// The keyword that would make a name a type, if it is a tag.
    fn tag_keyword(&self, spelling: &str) -> Option<&'static str> {
        let name = self.names.find(spelling)?;
        self.tags.iter().find(|(tag, _)| *tag == name).map(|(_, keyword)| *keyword)
    }

    /// Reports whether the board's header was read: it declares the persistent memory.
    fn has_board_header(&self) -> bool {
        self.names.find("persist").is_some_and(|name| self.scopes.meaning(name) != NameMeaning::Unknown)
    }
}
