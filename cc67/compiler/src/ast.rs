//! The syntax tree: the result of parsing, in the terms of the C grammar.
//!
//! Nothing is resolved here: an identifier is a name, a type is the list of specifiers and declarators as written.
//! Implicit `int` appears as an empty specifier list.

use crate::names::Name;
use crate::operators::BinaryOperator;
use crate::source::Span;

/// A whole translation unit.
#[derive(Debug, Default)]
pub struct TranslationUnit {
    /// Declarations and function definitions in their order.
    pub items: Vec<Item>,
}

/// An external declaration.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "most items are functions or declarations; a box each would cost more"
)]
pub enum Item {
    /// `int f(void) { … }`
    Function(FunctionDefinition),
    /// `int a, *b;`; also a type without declarators
    Declaration(Declaration),
    /// `_Static_assert(…)`
    StaticAssert(StaticAssert),
}

/// A function definition.
#[derive(Debug)]
pub struct FunctionDefinition {
    /// Result type and storage class.
    pub specifiers: Specifiers,
    /// Name and parameters.
    pub declarator: Declarator,
    /// Old-style parameter declarations between the list and the body.
    pub old_style: Vec<Declaration>,
    /// The body, a [`StatementKind::Block`].
    pub body: Statement,
    /// From the first specifier to the closing brace.
    pub span: Span,
}

/// A declaration with any number of declarators.
#[derive(Debug)]
pub struct Declaration {
    /// The words before the declarators.
    pub specifiers: Specifiers,
    /// The declared names; empty for a type without declarators.
    pub declarators: Vec<InitDeclarator>,
    /// The whole declaration.
    pub span: Span,
}

/// A declarator with its initialiser.
#[derive(Debug)]
pub struct InitDeclarator {
    /// Name and derivation.
    pub declarator: Declarator,
    /// The initialiser after `=`.
    pub initializer: Option<Initializer>,
}

/// Storage classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// `typedef`
    Typedef,
    /// `extern`
    Extern,
    /// `static`
    Static,
    /// `auto`
    Auto,
    /// `register`
    Register,
}

/// Type qualifiers as written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Qualifiers {
    /// `const`
    pub is_const: bool,
    /// `volatile`
    pub is_volatile: bool,
}

/// The words that open a declaration.
#[derive(Debug)]
pub struct Specifiers {
    /// Storage class, if one was written.
    pub storage: Option<(Storage, Span)>,
    /// Qualifiers.
    pub qualifiers: Qualifiers,
    /// `inline` was written.
    pub is_inline: bool,
    /// Alignments requested.
    pub alignments: Vec<Alignment>,
    /// The type; `None` if no word names one (implicit `int`).
    pub ty: Option<TypeSpecifier>,
    /// All words; for an empty list, the place where they would be.
    pub span: Span,
}

/// A minimum alignment of an object, member or record.
#[derive(Debug)]
pub enum Alignment {
    /// `_Alignas(16)`, `__attribute__((aligned(16)))`
    Value(Expression),
    /// `_Alignas(double)`
    Type(TypeName),
    /// `__attribute__((aligned))`: as much as any type needs.
    Largest,
}

/// A type named by specifiers.
#[derive(Debug)]
pub enum TypeSpecifier {
    /// `void`, `unsigned long`, `double` …
    Basic(BasicType),
    /// A `typedef` name.
    Typedef(Name),
    /// `struct` or `union`.
    Record(RecordSpecifier),
    /// `enum`.
    Enum(EnumSpecifier),
    /// `typeof (expression)`.
    TypeofExpression(Box<Expression>),
    /// `typeof (type)`.
    TypeofType(Box<TypeName>),
}

/// The arithmetic types by their written words; `long` is distinguished from `int` only here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BasicType {
    /// `void`
    Void,
    /// `_Bool`
    Bool,
    /// `char`
    Char,
    /// `signed char`
    SignedChar,
    /// `unsigned char`
    UnsignedChar,
    /// `short`
    Short,
    /// `unsigned short`
    UnsignedShort,
    /// `int`
    Int,
    /// `unsigned`
    Unsigned,
    /// `long`
    Long,
    /// `unsigned long`
    UnsignedLong,
    /// `long long`
    LongLong,
    /// `unsigned long long`
    UnsignedLongLong,
    /// `float`
    Float,
    /// `double`
    Double,
    /// `long double`
    LongDouble,
}

/// `struct` or `union`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordKind {
    /// `struct`
    Struct,
    /// `union`
    Union,
}

/// `struct tag { … }`
#[derive(Debug)]
pub struct RecordSpecifier {
    /// The keyword: `struct` or `union`.
    pub kind: RecordKind,
    /// The tag.
    pub tag: Option<(Name, Span)>,
    /// The members; `None` for a mere reference.
    pub members: Option<Vec<MemberDeclaration>>,
    /// Alignments requested before the tag or after the brace.
    pub alignments: Vec<Alignment>,
    /// From the keyword to the closing brace or tag.
    pub span: Span,
}

/// A declaration of members.
#[derive(Debug)]
pub struct MemberDeclaration {
    /// The type words.
    pub specifiers: Specifiers,
    /// The members; empty for an anonymous structure or union.
    pub members: Vec<MemberDeclarator>,
    /// The whole line.
    pub span: Span,
}

/// A member.
#[derive(Debug)]
pub struct MemberDeclarator {
    /// Name and derivation; `None` for an unnamed bit-field.
    pub declarator: Option<Declarator>,
    /// Width of a bit-field.
    pub width: Option<Expression>,
}

/// `enum tag { … }`
#[derive(Debug)]
pub struct EnumSpecifier {
    /// The tag.
    pub tag: Option<(Name, Span)>,
    /// The enumerators; `None` for a mere reference.
    pub enumerators: Option<Vec<Enumerator>>,
    /// From the keyword to the closing brace or tag.
    pub span: Span,
}

/// An enumerator.
#[derive(Debug)]
pub struct Enumerator {
    /// Its name.
    pub name: Name,
    /// Its position in the source.
    pub span: Span,
    /// The value after `=`.
    pub value: Option<Expression>,
}

/// A declarator: the name and the type derived around it.
#[derive(Debug)]
pub struct Declarator {
    /// The name; `None` in an abstract declarator.
    pub name: Option<(Name, Span)>,
    /// Derivations from the name outwards: `int *a[3]` is `[Array, Pointer]`.
    pub derived: Vec<Derived>,
    /// Alignments requested after the declarator.
    pub alignments: Vec<Alignment>,
    /// The whole declarator.
    pub span: Span,
}

/// A derivation.
#[derive(Debug)]
pub enum Derived {
    /// `*` with its qualifiers.
    Pointer(Qualifiers),
    /// `[length]`.
    Array(Option<Box<Expression>>),
    /// `(parameters)`.
    Function(Parameters),
}

/// A parameter list.
#[derive(Debug)]
pub enum Parameters {
    /// `()`: unspecified.
    Unspecified,
    /// `(void)`, `(int a, …)`.
    Prototype {
        /// The parameters; empty for `(void)`.
        parameters: Vec<Parameter>,
        /// `...` ends the list.
        is_variadic: bool,
    },
    /// `(a, b)`: an old-style list of names.
    Names(Vec<(Name, Span)>),
}

/// A parameter of a prototype.
#[derive(Debug)]
pub struct Parameter {
    /// The type words.
    pub specifiers: Specifiers,
    /// Name, if any, and derivation.
    pub declarator: Declarator,
    /// The whole parameter.
    pub span: Span,
}

/// A type in a cast, `sizeof` or compound literal.
#[derive(Debug)]
pub struct TypeName {
    /// The type words.
    pub specifiers: Specifiers,
    /// The abstract declarator.
    pub declarator: Declarator,
    /// The whole name.
    pub span: Span,
}

/// `_Static_assert(condition, "message")`
#[derive(Debug)]
pub struct StaticAssert {
    /// The condition.
    pub condition: Expression,
    /// The message, if one was given.
    pub message: Option<Vec<u8>>,
    /// The whole assertion.
    pub span: Span,
}

/// An initialiser of an object.
#[derive(Debug)]
pub enum Initializer {
    /// `= expression`
    Expression(Expression),
    /// `= { … }`
    List {
        /// The elements.
        items: Vec<InitializerItem>,
        /// From brace to brace.
        span: Span,
    },
}

/// An element of an initialiser list.
#[derive(Debug)]
pub struct InitializerItem {
    /// `.x[3] =`, also the GNU form `x:`.
    pub designators: Vec<Designator>,
    /// The value.
    pub initializer: Initializer,
}

/// A step of a designation.
#[derive(Debug)]
pub enum Designator {
    /// `.name`
    Member(Name, Span),
    /// `[index]`
    Index(Expression),
    /// `[first ... last]`
    Range(Expression, Expression),
}

/// A statement.
#[derive(Debug)]
pub struct Statement {
    /// The kind of statement.
    pub kind: StatementKind,
    /// Its range in the source.
    pub span: Span,
}

/// The kinds of statement.
#[derive(Debug)]
pub enum StatementKind {
    /// `;`
    Empty,
    /// `expression;`
    Expression(Expression),
    /// `{ … }`
    Block(Vec<Statement>),
    /// A declaration among statements.
    Declaration(Declaration),
    /// A static assertion among statements.
    StaticAssert(StaticAssert),
    /// `if`
    If {
        /// The condition.
        condition: Expression,
        /// Executed when it is not zero.
        then: Box<Statement>,
        /// Executed otherwise.
        otherwise: Option<Box<Statement>>,
    },
    /// `while`
    While {
        /// The condition, tested before each iteration.
        condition: Expression,
        /// The body.
        body: Box<Statement>,
    },
    /// `do … while`
    DoWhile {
        /// The body.
        body: Box<Statement>,
        /// The condition, tested after each iteration.
        condition: Expression,
    },
    /// `for`
    For {
        /// An expression statement, a declaration or an empty statement.
        init: Box<Statement>,
        /// The condition, tested before each iteration.
        condition: Option<Expression>,
        /// The expression evaluated after each iteration.
        step: Option<Expression>,
        /// The body.
        body: Box<Statement>,
    },
    /// `switch`
    Switch {
        /// The value.
        value: Expression,
        /// The body.
        body: Box<Statement>,
    },
    /// `case first … last:` with the statement after it
    Case {
        /// The value, or the first of a range.
        first: Expression,
        /// The last of a range.
        last: Option<Expression>,
        /// The labelled statement.
        body: Box<Statement>,
    },
    /// `default:` with the statement after it
    Default(Box<Statement>),
    /// `name:` with the statement after it
    Label {
        /// The label.
        name: Name,
        /// The position of the name.
        name_span: Span,
        /// The labelled statement.
        body: Box<Statement>,
    },
    /// `goto name;`
    Goto(Name, Span),
    /// `goto *address;`
    GotoAddress(Expression),
    /// `break;`
    Break,
    /// `continue;`
    Continue,
    /// `return expression;`
    Return(Option<Expression>),
}

/// An expression.
#[derive(Debug)]
pub struct Expression {
    /// The kind of expression.
    pub kind: ExpressionKind,
    /// Its range in the source.
    pub span: Span,
}

/// The kinds of expression.
#[derive(Debug)]
pub enum ExpressionKind {
    /// A name.
    Identifier(Name),
    /// An integer constant; its type follows from value, base and suffix.
    Integer(IntegerLiteral),
    /// A floating constant.
    Floating(FloatingLiteral),
    /// A character constant; its type follows from the prefix.
    Character(i32, Encoding),
    /// A string, adjacent ones joined, without the closing NUL.
    String(StringLiteral),
    /// `__func__`, `__FUNCTION__`
    FunctionName,
    /// `a[b]`
    Index(Box<Expression>, Box<Expression>),
    /// `f(a, b)`
    Call(Box<Expression>, Vec<Expression>),
    /// `a.b` or `a->b`
    Member {
        /// The structure or pointer.
        base: Box<Expression>,
        /// True for `->`, false for `.`.
        arrow: bool,
        /// The member.
        member: Name,
        /// The member's place.
        member_span: Span,
    },
    /// A prefix operator.
    Unary(UnaryOperator, Box<Expression>),
    /// `++` or `--`, prefix or postfix.
    Increment {
        /// The operand.
        operand: Box<Expression>,
        /// True for `++`, false for `--`.
        is_increment: bool,
        /// True if the operator comes before the operand.
        is_prefix: bool,
    },
    /// `(type) a`
    Cast(Box<TypeName>, Box<Expression>),
    /// `(type) { … }`
    CompoundLiteral(Box<TypeName>, Vec<InitializerItem>),
    /// `sizeof a`
    SizeofExpression(Box<Expression>),
    /// `sizeof (type)`
    SizeofType(Box<TypeName>),
    /// `_Alignof (type)`
    AlignofType(Box<TypeName>),
    /// `__alignof__ a`
    AlignofExpression(Box<Expression>),
    /// `a + b` and the other operators without side effects of their own, including `&&` and `||`.
    Binary(BinaryOperator, Box<Expression>, Box<Expression>),
    /// `a = b`
    Assign(Box<Expression>, Box<Expression>),
    /// `a += b`
    AssignWith(BinaryOperator, Box<Expression>, Box<Expression>),
    /// `a ? b : c`; the GNU form `a ?: c` has no middle operand.
    Conditional {
        /// The condition.
        condition: Box<Expression>,
        /// The value if the condition is not zero.
        then: Option<Box<Expression>>,
        /// The value otherwise.
        otherwise: Box<Expression>,
    },
    /// `a, b`
    Comma(Box<Expression>, Box<Expression>),
    /// `va_start(list, last)`
    VaStart(Box<Expression>, Box<Expression>),
    /// `va_arg(list, type)`
    VaArg(Box<Expression>, Box<TypeName>),
    /// `va_end(list)`
    VaEnd(Box<Expression>),
    /// `va_copy(to, from)`
    VaCopy(Box<Expression>, Box<Expression>),
    /// `offsetof(type, member)` as `__builtin_offsetof`
    Offsetof(Box<TypeName>, Vec<Designator>),
    /// `_Generic(value, type: a, default: b)`
    Generic {
        /// The value whose type selects an association.
        value: Box<Expression>,
        /// The choices; `None` is `default`.
        choices: Vec<(Option<TypeName>, Expression)>,
    },
    /// `({ … })`
    StatementExpression(Vec<Statement>),
    /// `&&label`
    LabelAddress(Name, Span),
    /// An expression that was diagnosed and skipped; it causes no further diagnostics.
    Error,
}

/// An integer constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerLiteral {
    /// The value.
    pub value: u64,
    /// Written in base ten.
    pub is_decimal: bool,
    /// Suffix `u`.
    pub is_unsigned: bool,
    /// Suffix `ll`.
    pub is_long_long: bool,
}

/// A floating constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingLiteral {
    /// The value, correctly rounded to its type.
    pub value: f64,
    /// Suffix `f`.
    pub is_single: bool,
}

/// A string.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StringLiteral {
    /// Its elements: bytes, or units of the encoding.
    pub elements: Vec<i32>,
    /// The encoding, from the prefix.
    pub encoding: Encoding,
}

/// The prefix of a string or character constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// No prefix: bytes as in the source.
    #[default]
    Plain,
    /// `u8`: the same.
    Utf8,
    /// `u`: units of 16 bits.
    Utf16,
    /// `U`: code points.
    Utf32,
    /// `L`: code points as `int`.
    Wide,
}

impl Encoding {
    /// The prefix as written in the source.
    #[must_use]
    pub const fn prefix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Utf8 => "u8",
            Self::Utf16 => "u",
            Self::Utf32 => "U",
            Self::Wide => "L",
        }
    }

    /// Bytes of an element.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::Plain | Self::Utf8 => 1,
            Self::Utf16 => 2,
            Self::Utf32 | Self::Wide => 4,
        }
    }
}

/// Prefix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOperator {
    /// `&`
    AddressOf,
    /// `*`
    Dereference,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `~`
    Complement,
    /// `!`
    Not,
}
