//! The words that open a declaration.

use crate::ast::{
    Alignment, BasicType, Declarator, Derived, Qualifiers, Specifiers, Storage, TypeName, TypeSpecifier,
};
use crate::diag::Diagnostic;
use crate::names::{Name, word};
use crate::pp::{Flags, TokenKind};
use crate::source::Span;

use super::scopes::NameMeaning;
use super::{ParseResult, Parser};

/// The words of an arithmetic type, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct ArithmeticWords {
    /// `void`, `char`, `int`, `float`, `double` or `_Bool`; `None` for `unsigned`, `long` …
    base: Option<BaseType>,
    short: u8,
    long: u8,
    signed: u8,
    unsigned: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BaseType {
    Void,
    Char,
    Int,
    Float,
    Double,
    Bool,
}

impl Parser<'_> {
    /// Reads all words before a declarator; perhaps none.
    pub(super) fn specifiers(&mut self) -> ParseResult<Specifiers> {
        let first = self.at;
        let start = self.peek().span;
        let mut specifiers = Specifiers {
            storage: None,
            qualifiers: Qualifiers::default(),
            is_inline: false,
            alignments: Vec::new(),
            ty: None,
            span: Span { hi: start.lo, ..start },
        };
        let mut words = ArithmeticWords::default();
        while let Some(name) = self.name() {
            if self.attribute(&mut specifiers.alignments)?
                || self.qualifier(&mut specifiers.qualifiers)?
                || self.storage(&mut specifiers)?
            {
                continue;
            }
            let is_open = specifiers.ty.is_none() && words == ArithmeticWords::default();
            if name.is_keyword() {
                if self.arithmetic_word(name, &mut words)? {
                    if specifiers.ty.is_some() {
                        return self.two_types(&specifiers);
                    }
                    continue;
                }
                let Some(ty) = self.keyword_type(name, is_open, &specifiers)? else { break };
                specifiers.ty = Some(ty);
            } else {
                if !is_open {
                    break;
                }
                let Some(ty) = self.named_type(name) else { break };
                specifiers.ty = Some(ty);
            }
            if matches!(specifiers.ty, Some(TypeSpecifier::Record(_) | TypeSpecifier::Enum(_)))
                && self.lacks_semicolon()
            {
                break;
            }
        }
        if words != ArithmeticWords::default() {
            specifiers.ty = Some(TypeSpecifier::Basic(self.basic_type(words, self.span_since(start))?));
        }
        if self.at > first {
            specifiers.span = self.span_since(start);
        }
        Ok(specifiers)
    }

    /// Reads qualifiers and misplaced tokens there; true if anything was read.
    pub(super) fn qualifier(&mut self, qualifiers: &mut Qualifiers) -> ParseResult<bool> {
        match self.name() {
            Some(word::CONST | word::CONST_ | word::CONST__) => qualifiers.is_const = true,
            Some(word::VOLATILE | word::VOLATILE_ | word::VOLATILE__) => qualifiers.is_volatile = true,
            Some(word::RESTRICT | word::RESTRICT_ | word::RESTRICT__ | word::EXTENSION) => {}
            Some(word::ATOMIC) if self.kind_at(1) != TokenKind::LeftParen => {}
            // After a `*` an attribute applies to the pointer, and no such attribute has an effect here.
            _ => return self.attribute(&mut Vec::new()),
        }
        self.at += 1;
        Ok(true)
    }

    /// Reads attributes; returns their alignments.
    pub(super) fn attributes(&mut self) -> ParseResult<Vec<Alignment>> {
        let mut alignments = Vec::new();
        while matches!(self.name(), Some(word::ATTRIBUTE | word::ATTRIBUTE__)) {
            self.attribute(&mut alignments)?;
        }
        Ok(alignments)
    }

    /// Reads one `__attribute__((…))` or `_Alignas(…)`; true if there was one.
    fn attribute(&mut self, alignments: &mut Vec<Alignment>) -> ParseResult<bool> {
        match self.name() {
            Some(word::ATTRIBUTE | word::ATTRIBUTE__) => {
                self.at += 1;
                self.attribute_lists(alignments)?;
            }
            Some(word::ALIGNAS) => {
                self.at += 1;
                if self.kind() != TokenKind::LeftParen {
                    return self.fail_expected("`(`");
                }
                let alignment = self.alignment()?;
                alignments.push(alignment);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `(16)` or `(type)`
    fn alignment(&mut self) -> ParseResult<Alignment> {
        self.open();
        let alignment = if self.is_type_at(0) {
            Alignment::Type(self.type_name()?)
        } else {
            Alignment::Value(self.nested(Self::conditional)?)
        };
        self.close(TokenKind::RightParen)?;
        Ok(alignment)
    }

    /// Reports whether a word begins a type in any context.
    pub(super) fn is_type_word(&self, name: Name) -> bool {
        match name {
            word::VOID
            | word::CHAR
            | word::SHORT
            | word::INT
            | word::LONG
            | word::FLOAT
            | word::DOUBLE
            | word::SIGNED
            | word::SIGNED_
            | word::SIGNED__
            | word::UNSIGNED
            | word::BOOL
            | word::COMPLEX
            | word::STRUCT
            | word::UNION
            | word::ENUM
            | word::TYPEOF
            | word::TYPEOF_
            | word::TYPEOF__
            | word::CONST
            | word::CONST_
            | word::CONST__
            | word::VOLATILE
            | word::VOLATILE_
            | word::VOLATILE__
            | word::RESTRICT
            | word::RESTRICT_
            | word::RESTRICT__
            | word::ATOMIC
            | word::ATTRIBUTE
            | word::ATTRIBUTE__
            | word::ALIGNAS
            | word::BUILTIN_VA_LIST => true,
            _ if name.is_keyword() => false,
            word::VA_LIST => self.scopes.meaning(name) != NameMeaning::Ordinary,
            _ => matches!(self.scopes.meaning(name), NameMeaning::Type | NameMeaning::MissingType),
        }
    }

    /// Reports whether a word begins a declaration.
    pub(super) fn is_declaration_word(&self, name: Name) -> bool {
        matches!(
            name,
            word::TYPEDEF
                | word::EXTERN
                | word::STATIC
                | word::AUTO
                | word::REGISTER
                | word::INLINE
                | word::INLINE_
                | word::INLINE__
                | word::NORETURN
                | word::THREAD_LOCAL
        ) || self.is_type_word(name)
    }

    #[inline(never)]
    fn storage(&mut self, specifiers: &mut Specifiers) -> ParseResult<bool> {
        let storage = match self.name() {
            Some(word::TYPEDEF) => Storage::Typedef,
            Some(word::EXTERN) => Storage::Extern,
            Some(word::STATIC) => Storage::Static,
            Some(word::AUTO) => Storage::Auto,
            Some(word::REGISTER) => Storage::Register,
            Some(word::INLINE | word::INLINE_ | word::INLINE__) => {
                specifiers.is_inline = true;
                self.at += 1;
                return Ok(true);
            }
            Some(word::NORETURN) => {
                self.at += 1;
                return Ok(true);
            }
            Some(word::THREAD_LOCAL) => {
                let span = self.next().span;
                self.report(Diagnostic::error(span, "thread-local variables are not supported"));
                return Ok(true);
            }
            _ => return Ok(false),
        };
        let token = self.next();
        match specifiers.storage {
            Some((other, before)) if other != storage => {
                let diagnostic = Diagnostic::error(token.span, "two storage classes in one declaration");
                self.report(diagnostic.label(before, "the other one"));
            }
            _ => specifiers.storage = Some((storage, token.span)),
        }
        Ok(true)
    }

    /// Counts a word of an arithmetic type.
    #[inline(never)]
    fn arithmetic_word(&mut self, name: Name, words: &mut ArithmeticWords) -> ParseResult<bool> {
        let base = match name {
            word::VOID => BaseType::Void,
            word::CHAR => BaseType::Char,
            word::INT => BaseType::Int,
            word::FLOAT => BaseType::Float,
            word::DOUBLE => BaseType::Double,
            word::BOOL => BaseType::Bool,
            _ => {
                let count = match name {
                    word::SHORT => &mut words.short,
                    word::LONG => &mut words.long,
                    word::SIGNED | word::SIGNED_ | word::SIGNED__ => &mut words.signed,
                    word::UNSIGNED => &mut words.unsigned,
                    _ => return Ok(false),
                };
                *count = count.saturating_add(1);
                self.at += 1;
                return Ok(true);
            }
        };
        let token = self.next();
        if words.base.replace(base).is_some() {
            let message = format!("two types in one declaration; `{}` is the second", self.text(token.span));
            return self
                .fail(Diagnostic::error(token.span, message).help("is a `;` or `,` missing before it?"));
        }
        Ok(true)
    }

    /// The type that the counted words name.
    #[inline(never)]
    fn basic_type(&mut self, words: ArithmeticWords, span: Span) -> ParseResult<BasicType> {
        let ArithmeticWords { base, short, long, signed, unsigned } = words;
        let is_unsigned = unsigned > 0;
        let pick = |plain, other| if is_unsigned { other } else { plain };
        let is_plain = signed == 0 && unsigned == 0;
        let ty = match (base, short, long) {
            _ if signed > 0 && is_unsigned => None,
            (Some(BaseType::Void), 0, 0) if is_plain => Some(BasicType::Void),
            (Some(BaseType::Bool), 0, 0) if is_plain => Some(BasicType::Bool),
            (Some(BaseType::Float), 0, 0) if is_plain => Some(BasicType::Float),
            (Some(BaseType::Double), 0, 0) if is_plain => Some(BasicType::Double),
            (Some(BaseType::Double), 0, 1) if is_plain => Some(BasicType::LongDouble),
            (Some(BaseType::Char), 0, 0) if signed > 0 => Some(BasicType::SignedChar),
            (Some(BaseType::Char), 0, 0) => Some(pick(BasicType::Char, BasicType::UnsignedChar)),
            (None | Some(BaseType::Int), 1, 0) => Some(pick(BasicType::Short, BasicType::UnsignedShort)),
            (None | Some(BaseType::Int), 0, 0) => Some(pick(BasicType::Int, BasicType::Unsigned)),
            (None | Some(BaseType::Int), 0, 1) => Some(pick(BasicType::Long, BasicType::UnsignedLong)),
            (None | Some(BaseType::Int), 0, 2) => {
                Some(pick(BasicType::LongLong, BasicType::UnsignedLongLong))
            }
            _ => None,
        };
        match ty {
            Some(ty) => Ok(ty),
            None => {
                let message = format!("`{}` is not a type", self.text(span));
                self.fail(Diagnostic::error(span, message).at("no type is named by these keywords together"))
            }
        }
    }

    /// A type that begins with a keyword; `None` if the keyword has another role.
    #[inline(never)]
    fn keyword_type(
        &mut self,
        name: Name,
        is_open: bool,
        specifiers: &Specifiers,
    ) -> ParseResult<Option<TypeSpecifier>> {
        let is_type = matches!(
            name,
            word::STRUCT
                | word::UNION
                | word::ENUM
                | word::TYPEOF
                | word::TYPEOF_
                | word::TYPEOF__
                | word::BUILTIN_VA_LIST
                | word::COMPLEX
                | word::IMAGINARY
                | word::ATOMIC
        );
        if !is_type {
            return Ok(None);
        }
        if matches!(name, word::COMPLEX | word::IMAGINARY) {
            let span = self.peek().span;
            return self.fail(Diagnostic::error(span, "complex numbers are not supported"));
        }
        if !is_open {
            return self.two_types(specifiers);
        }
        match name {
            word::STRUCT | word::UNION => self.record().map(|record| Some(TypeSpecifier::Record(record))),
            word::ENUM => self.enumeration().map(|enumeration| Some(TypeSpecifier::Enum(enumeration))),
            word::TYPEOF | word::TYPEOF_ | word::TYPEOF__ => self.typeof_().map(Some),
            word::BUILTIN_VA_LIST => {
                let span = self.next().span;
                Ok(Some(va_list(span)))
            }
            word::ATOMIC => {
                self.at += 1;
                self.open();
                let ty = self.type_name()?;
                self.close(TokenKind::RightParen)?;
                Ok(Some(TypeSpecifier::TypeofType(Box::new(ty))))
            }
            _ => Ok(None),
        }
    }

    /// A `typedef` name, `va_list`, or a name used like a type.
    fn named_type(&mut self, name: Name) -> Option<TypeSpecifier> {
        match self.scopes.meaning(name) {
            NameMeaning::Type => {
                self.at += 1;
                Some(TypeSpecifier::Typedef(name))
            }
            NameMeaning::MissingType => {
                let span = self.next().span;
                Some(Self::missing_type(span))
            }
            NameMeaning::Unknown if name == word::VA_LIST => {
                let span = self.next().span;
                Some(va_list(span))
            }
            NameMeaning::Unknown | NameMeaning::Ordinary => None,
        }
    }

    /// `typeof (expression)` or `typeof (type)`
    #[inline(never)]
    fn typeof_(&mut self) -> ParseResult<TypeSpecifier> {
        self.at += 1;
        if self.kind() != TokenKind::LeftParen {
            return self.fail_expected("`(` after `typeof`");
        }
        self.open();
        let ty = if self.name().is_some_and(|name| self.is_type_word(name)) {
            TypeSpecifier::TypeofType(Box::new(self.type_name()?))
        } else {
            TypeSpecifier::TypeofExpression(Box::new(self.expression()?))
        };
        self.close(TokenKind::RightParen)?;
        Ok(ty)
    }

    #[inline(never)]
    fn two_types<T>(&mut self, specifiers: &Specifiers) -> ParseResult<T> {
        let token = self.peek();
        let message = format!("two types in one declaration; `{}` is the second", self.text(token.span));
        let diagnostic =
            Diagnostic::error(token.span, message).label(specifiers.span, "the declaration begins here");
        self.fail(diagnostic.help("is a `;` or `,` missing before it?"))
    }

    /// Reports whether `struct { … }` is followed by a declaration on a new line.
    fn lacks_semicolon(&self) -> bool {
        let next = self.peek();
        let behind_brace = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        next.flags.has(Flags::LINE_START)
            && behind_brace.is_some_and(|token| token.kind == TokenKind::RightBrace)
            && self.name().is_some_and(|name| self.is_declaration_word(name))
    }

    /// Reads the balanced `((aligned(8), …))` of an attribute.
    fn attribute_lists(&mut self, alignments: &mut Vec<Alignment>) -> ParseResult<()> {
        if self.kind() != TokenKind::LeftParen {
            return self.fail_expected("`(`");
        }
        let base = self.recovery.open.len();
        loop {
            match self.kind() {
                TokenKind::LeftParen => {
                    self.open();
                }
                TokenKind::RightParen => {
                    self.close(TokenKind::RightParen)?;
                    if self.recovery.open.len() == base {
                        return Ok(());
                    }
                }
                TokenKind::End => return self.fail_expected("`)`"),
                _ if self.recovery.open.len() == base + 2
                    && matches!(self.name(), Some(word::ALIGNED | word::ALIGNED__)) =>
                {
                    self.at += 1;
                    let has_value = self.kind() == TokenKind::LeftParen;
                    alignments.push(if has_value { self.alignment()? } else { Alignment::Largest });
                }
                _ => self.at += 1,
            }
        }
    }
}

/// The type of argument lists: `char *`.
fn va_list(span: Span) -> TypeSpecifier {
    let specifiers = Specifiers {
        storage: None,
        qualifiers: Qualifiers::default(),
        is_inline: false,
        alignments: Vec::new(),
        ty: Some(TypeSpecifier::Basic(BasicType::Char)),
        span,
    };
    let derived = vec![Derived::Pointer(Qualifiers::default())];
    let declarator = Declarator { name: None, derived, alignments: Vec::new(), span };
    TypeSpecifier::TypeofType(Box::new(TypeName { specifiers, declarator, span }))
}
