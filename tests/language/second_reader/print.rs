//! The tree of `lang-c` in our printed form, see `compiler::parse::print`.

use lang_c::ast::{
    ArraySize, BinaryOperator, BlockItem, Constant, Declaration, DeclarationSpecifier, Declarator,
    DeclaratorKind, DerivedDeclarator, Designator, Ellipsis, Expression, ExternalDeclaration, Float,
    FloatFormat, ForInitializer, FunctionDefinition, FunctionSpecifier, GenericAssociation, Initializer,
    InitializerListItem, Integer, IntegerBase, IntegerSize, Label, MemberOperator, OffsetMember,
    ParameterDeclaration, PointerQualifier, SpecifierQualifier, Statement, StaticAssert,
    StorageClassSpecifier, StructDeclaration, StructKind, StructType, TranslationUnit, TypeName, TypeOf,
    TypeQualifier, TypeSpecifier, UnaryOperator,
};
use lang_c::span::Node;

/// The text of a translation unit, one item per line.
pub(super) fn print(unit: &TranslationUnit) -> String {
    let mut lines = String::new();
    for item in &unit.0 {
        let line = match &item.node {
            ExternalDeclaration::Declaration(declaration) => self::declaration(&declaration.node),
            ExternalDeclaration::StaticAssert(assert) => static_assert(&assert.node),
            ExternalDeclaration::FunctionDefinition(function) => self::function(&function.node),
        };
        lines.push_str(&line);
        lines.push('\n');
    }
    lines
}

/// `(head part part …)`, without empty parts.
fn list(head: &str, parts: impl IntoIterator<Item = String>) -> String {
    format!("({})", joined(std::iter::once(head.to_owned()).chain(parts)))
}

fn joined(parts: impl IntoIterator<Item = String>) -> String {
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}

fn function(function: &FunctionDefinition) -> String {
    let parts = [specifiers(&function.specifiers), declarator(&function.declarator.node)];
    let old_style = function.declarations.iter().map(|old| declaration(&old.node));
    list("function", parts.into_iter().chain(old_style).chain([statement(&function.statement.node)]))
}

fn declaration(declaration: &Declaration) -> String {
    let specifiers = specifiers(&declaration.specifiers);
    if declaration.declarators.is_empty() {
        return list("type", [specifiers]);
    }
    let shown = declaration.declarators.iter().map(|init| {
        let name = declarator(&init.node.declarator.node);
        match &init.node.initializer {
            Some(initializer) => format!("{name} = {}", self::initializer(&initializer.node)),
            None => name,
        }
    });
    list("var", [specifiers, shown.collect::<Vec<_>>().join(", ")])
}

fn static_assert(assert: &StaticAssert) -> String {
    list("static-assert", [expression(&assert.expression.node)])
}

/// The contents of a list of specifiers, in any order.
#[derive(Default)]
struct SpecifierList {
    storage: &'static str,
    is_inline: bool,
    is_const: bool,
    is_volatile: bool,
    words: Vec<&'static str>,
    other: Option<String>,
}

impl SpecifierList {
    fn qualifier(&mut self, qualifier: &TypeQualifier) {
        match qualifier {
            TypeQualifier::Const => self.is_const = true,
            TypeQualifier::Volatile => self.is_volatile = true,
            _ => {}
        }
    }

    fn ty(&mut self, specifier: &TypeSpecifier) {
        match specifier {
            TypeSpecifier::Void => self.words.push("void"),
            TypeSpecifier::Char => self.words.push("char"),
            TypeSpecifier::Short => self.words.push("short"),
            TypeSpecifier::Int => self.words.push("int"),
            TypeSpecifier::Long => self.words.push("long"),
            TypeSpecifier::Float => self.words.push("float"),
            TypeSpecifier::Double => self.words.push("double"),
            TypeSpecifier::Signed => self.words.push("signed"),
            TypeSpecifier::Unsigned => self.words.push("unsigned"),
            TypeSpecifier::Bool => self.words.push("_Bool"),
            TypeSpecifier::Struct(record) => self.other = Some(self::record(&record.node)),
            TypeSpecifier::Enum(enumeration) => {
                let enumeration = &enumeration.node;
                let tag = enumeration.identifier.as_ref().map(|tag| tag.node.name.clone());
                let enumerators = enumeration.enumerators.iter().map(|enumerator| {
                    let name = enumerator.node.identifier.node.name.clone();
                    match &enumerator.node.expression {
                        Some(value) => list("=", [name, expression(&value.node)]),
                        None => name,
                    }
                });
                self.other = Some(list("enum", tag.into_iter().chain(enumerators)));
            }
            TypeSpecifier::TypedefName(name) => self.other = Some(name.node.name.clone()),
            TypeSpecifier::TypeOf(of) => {
                self.other = Some(match &of.node {
                    TypeOf::Expression(inner) => list("typeof", [expression(&inner.node)]),
                    TypeOf::Type(inner) => list("typeof", [type_name(&inner.node)]),
                });
            }
            other => self.other = Some(format!("{other:?}")),
        }
    }

    fn show(self) -> String {
        let flag = |is: bool, word: &str| if is { word.to_owned() } else { String::new() };
        let ty = self.other.unwrap_or_else(|| basic(&self.words).to_owned());
        joined([
            self.storage.to_owned(),
            flag(self.is_inline, "inline"),
            flag(self.is_const, "const"),
            flag(self.is_volatile, "volatile"),
            ty,
        ])
    }
}

/// The type named by specifiers in any order.
fn basic(words: &[&str]) -> &'static str {
    let count = |word: &str| words.iter().filter(|found| **found == word).count();
    let has = |word: &str| count(word) > 0;
    let unsigned = has("unsigned");
    let pick = |signed: &'static str, without: &'static str| if unsigned { without } else { signed };
    match count("long") {
        _ if has("void") => "void",
        _ if has("_Bool") => "_Bool",
        _ if has("float") => "float",
        0 if has("double") => "double",
        _ if has("double") => "ldouble",
        _ if has("char") && has("signed") => "schar",
        _ if has("char") => pick("char", "uchar"),
        _ if has("short") => pick("short", "ushort"),
        0 if words.is_empty() => "?",
        0 => pick("int", "uint"),
        1 => pick("long", "ulong"),
        _ => pick("llong", "ullong"),
    }
}

fn specifiers(specifiers: &[Node<DeclarationSpecifier>]) -> String {
    let mut list = SpecifierList::default();
    for specifier in specifiers {
        match &specifier.node {
            DeclarationSpecifier::StorageClass(class) => {
                list.storage = match class.node {
                    StorageClassSpecifier::Typedef => "typedef",
                    StorageClassSpecifier::Extern => "extern",
                    StorageClassSpecifier::Static => "static",
                    StorageClassSpecifier::ThreadLocal => "thread-local",
                    StorageClassSpecifier::Auto => "auto",
                    StorageClassSpecifier::Register => "register",
                };
            }
            DeclarationSpecifier::TypeSpecifier(ty) => list.ty(&ty.node),
            DeclarationSpecifier::TypeQualifier(qualifier) => list.qualifier(&qualifier.node),
            DeclarationSpecifier::Function(function) => {
                list.is_inline |= function.node == FunctionSpecifier::Inline;
            }
            DeclarationSpecifier::Alignment(_) | DeclarationSpecifier::Extension(_) => {}
        }
    }
    list.show()
}

fn specifier_qualifiers(specifiers: &[Node<SpecifierQualifier>]) -> String {
    let mut list = SpecifierList::default();
    for specifier in specifiers {
        match &specifier.node {
            SpecifierQualifier::TypeSpecifier(ty) => list.ty(&ty.node),
            SpecifierQualifier::TypeQualifier(qualifier) => list.qualifier(&qualifier.node),
            SpecifierQualifier::Extension(_) => {}
        }
    }
    list.show()
}

fn record(record: &StructType) -> String {
    let head = if record.kind.node == StructKind::Struct { "struct" } else { "union" };
    let tag = record.identifier.as_ref().map(|tag| tag.node.name.clone());
    let members = record.declarations.iter().flatten().map(|line| match &line.node {
        StructDeclaration::StaticAssert(assert) => static_assert(&assert.node),
        StructDeclaration::Field(field) => {
            let members = field.node.declarators.iter().map(|member| {
                let name = member.node.declarator.as_ref().map(|name| declarator(&name.node));
                let width = member.node.bit_width.as_ref();
                joined(name.into_iter().chain(width.map(|width| format!(": {}", expression(&width.node)))))
            });
            let members = members.collect::<Vec<_>>().join(", ");
            list("member", [specifier_qualifiers(&field.node.specifiers), members])
        }
    });
    list(head, tag.into_iter().chain(members))
}

fn type_name(ty: &TypeName) -> String {
    let derived = ty.declarator.as_ref().map(|derived| declarator(&derived.node));
    joined([specifier_qualifiers(&ty.specifiers), derived.unwrap_or_default()])
}

/// The name, then the derivations from inside to outside: those after the name, then the pointers before it.
fn declarator(declarator: &Declarator) -> String {
    let inner = match &declarator.kind.node {
        DeclaratorKind::Abstract => String::new(),
        DeclaratorKind::Identifier(name) => name.node.name.clone(),
        DeclaratorKind::Declarator(inner) => self::declarator(&inner.node),
    };
    let is_pointer =
        |derived: &&Node<DerivedDeclarator>| matches!(derived.node, DerivedDeclarator::Pointer(_));
    let after = declarator.derived.iter().filter(|derived| !is_pointer(derived));
    let before = declarator.derived.iter().filter(is_pointer).rev();
    joined(std::iter::once(inner).chain(after.chain(before).map(|derived| self::derived(&derived.node))))
}

fn derived(derived: &DerivedDeclarator) -> String {
    match derived {
        DerivedDeclarator::Pointer(qualifiers) | DerivedDeclarator::Block(qualifiers) => {
            let mut list = SpecifierList { other: Some(String::new()), ..SpecifierList::default() };
            for qualifier in qualifiers {
                if let PointerQualifier::TypeQualifier(qualifier) = &qualifier.node {
                    list.qualifier(&qualifier.node);
                }
            }
            joined(["*".to_owned(), list.show()])
        }
        DerivedDeclarator::Array(array) => match &array.node.size {
            ArraySize::Unknown | ArraySize::VariableUnknown => "[]".to_owned(),
            ArraySize::VariableExpression(length) | ArraySize::StaticExpression(length) => {
                format!("[{}]", expression(&length.node))
            }
        },
        DerivedDeclarator::Function(function) => {
            let parameters = parameters(&function.node.parameters);
            let more = if function.node.ellipsis == Ellipsis::Some { "..." } else { "" };
            list("fn", [parameters, more.to_owned()])
        }
        DerivedDeclarator::KRFunction(names) if names.is_empty() => "()".to_owned(),
        DerivedDeclarator::KRFunction(names) => {
            list("names", names.iter().map(|name| name.node.name.clone()))
        }
    }
}

fn parameters(parameters: &[Node<ParameterDeclaration>]) -> String {
    let shown: Vec<_> = parameters
        .iter()
        .map(|parameter| {
            let declarator =
                parameter.node.declarator.as_ref().map(|declarator| self::declarator(&declarator.node));
            joined([specifiers(&parameter.node.specifiers), declarator.unwrap_or_default()])
        })
        .collect();
    // `(void)` means that there are no parameters.
    if shown == ["void"] { String::new() } else { shown.join(", ") }
}

fn initializer(initializer: &Initializer) -> String {
    match initializer {
        Initializer::Expression(value) => expression(&value.node),
        Initializer::List(list) => items(list),
    }
}

fn items(items: &[Node<InitializerListItem>]) -> String {
    list(
        "list",
        items.iter().map(|item| {
            let path: Vec<_> =
                item.node.designation.iter().map(|designator| self::designator(&designator.node)).collect();
            let value = initializer(&item.node.initializer.node);
            if path.is_empty() { value } else { format!("{} = {value}", path.join(" ")) }
        }),
    )
}

fn designator(designator: &Designator) -> String {
    match designator {
        Designator::Index(index) => list("at", [expression(&index.node)]),
        Designator::Member(name) => format!(".{}", name.node.name),
        Designator::Range(range) => {
            list("from", [expression(&range.node.from.node), expression(&range.node.to.node)])
        }
    }
}

fn statement(statement: &Statement) -> String {
    let of = |inner: &Node<Statement>| self::statement(&inner.node);
    let value = |inner: &Node<Expression>| expression(&inner.node);
    match statement {
        Statement::Labeled(labelled) => {
            let body = of(&labelled.node.statement);
            match &labelled.node.label.node {
                Label::Identifier(name) => list("label", [name.node.name.clone(), body]),
                Label::Case(first) => list("case", [value(first), body]),
                Label::CaseRange(range) => {
                    list("case", [value(&range.node.low), "...".to_owned(), value(&range.node.high), body])
                }
                Label::Default => list("default", [body]),
            }
        }
        Statement::Compound(items) => list("block", items.iter().map(|item| block_item(&item.node))),
        Statement::Expression(None) => "()".to_owned(),
        Statement::Expression(Some(inner)) => value(inner),
        Statement::If(inner) => {
            let parts = [value(&inner.node.condition), of(&inner.node.then_statement)];
            list("if", parts.into_iter().chain(inner.node.else_statement.iter().map(|inner| of(inner))))
        }
        Statement::Switch(inner) => {
            list("switch", [value(&inner.node.expression), of(&inner.node.statement)])
        }
        Statement::While(inner) => list("while", [value(&inner.node.expression), of(&inner.node.statement)]),
        Statement::DoWhile(inner) => list("do", [of(&inner.node.statement), value(&inner.node.expression)]),
        Statement::For(inner) => {
            let start = match &inner.node.initializer.node {
                ForInitializer::Empty => "()".to_owned(),
                ForInitializer::Expression(start) => value(start),
                ForInitializer::Declaration(start) => declaration(&start.node),
                ForInitializer::StaticAssert(assert) => static_assert(&assert.node),
            };
            let part = |part: &Option<Box<Node<Expression>>>| {
                part.as_ref().map_or("()".to_owned(), |part| value(part))
            };
            list(
                "for",
                [start, part(&inner.node.condition), part(&inner.node.step), of(&inner.node.statement)],
            )
        }
        Statement::Goto(label) => list("goto", [label.node.name.clone()]),
        Statement::Continue => "continue".to_owned(),
        Statement::Break => "break".to_owned(),
        Statement::Return(inner) => list("return", inner.iter().map(|inner| value(inner))),
        Statement::Asm(_) => "asm".to_owned(),
    }
}

fn block_item(item: &BlockItem) -> String {
    match item {
        BlockItem::Declaration(inner) => declaration(&inner.node),
        BlockItem::StaticAssert(inner) => static_assert(&inner.node),
        BlockItem::Statement(inner) => statement(&inner.node),
    }
}

fn expression(expression: &Expression) -> String {
    let of = |inner: &Node<Expression>| self::expression(&inner.node);
    let ty = |ty: &Node<TypeName>| format!("({})", type_name(&ty.node));
    match expression {
        Expression::Identifier(name) => match name.node.name.as_str() {
            "__FUNCTION__" | "__PRETTY_FUNCTION__" => "__func__".to_owned(),
            name => name.to_owned(),
        },
        Expression::Constant(constant) => self::constant(&constant.node),
        Expression::StringLiteral(pieces) => string(&pieces.node),
        Expression::GenericSelection(generic) => {
            let choices = generic.node.associations.iter().map(|choice| match &choice.node {
                GenericAssociation::Type(choice) => {
                    list("case", [ty(&choice.node.type_name), of(&choice.node.expression)])
                }
                GenericAssociation::Default(choice) => list("default", [of(choice)]),
            });
            list("generic", std::iter::once(of(&generic.node.expression)).chain(choices))
        }
        Expression::Member(member) => {
            let head = if member.node.operator.node == MemberOperator::Indirect { "->" } else { "." };
            list(head, [of(&member.node.expression), member.node.identifier.node.name.clone()])
        }
        Expression::Call(call) => {
            let callee = of(&call.node.callee);
            let arguments = call.node.arguments.iter().map(of);
            // Our parser represents these as separate kinds of expressions.
            match callee.strip_prefix("__builtin_").unwrap_or(&callee) {
                head @ ("va_start" | "va_end" | "va_copy") => list(head, arguments),
                _ => list("call", std::iter::once(callee.clone()).chain(arguments)),
            }
        }
        Expression::CompoundLiteral(literal) => {
            list("literal", [ty(&literal.node.type_name), items(&literal.node.initializer_list)])
        }
        Expression::SizeOfTy(inner) => list("sizeof-type", [ty(&inner.node.0)]),
        Expression::SizeOfVal(inner) => list("sizeof", [of(&inner.node.0)]),
        Expression::AlignOf(inner) => list("alignof", [ty(&inner.node.0)]),
        Expression::UnaryOperator(unary) => {
            list(unary_head(&unary.node.operator.node), [of(&unary.node.operand)])
        }
        Expression::Cast(cast) => list("cast", [ty(&cast.node.type_name), of(&cast.node.expression)]),
        Expression::BinaryOperator(binary) => {
            list(binary_head(&binary.node.operator.node), [of(&binary.node.lhs), of(&binary.node.rhs)])
        }
        Expression::Conditional(inner) => {
            let inner = &inner.node;
            list("?", [of(&inner.condition), of(&inner.then_expression), of(&inner.else_expression)])
        }
        Expression::Comma(parts) => {
            let mut parts = parts.iter().map(of);
            let first = parts.next().unwrap_or_default();
            parts.fold(first, |before, part| list(",", [before, part]))
        }
        Expression::OffsetOf(inner) => {
            let designator = &inner.node.designator.node;
            let members = designator.members.iter().map(|member| match &member.node {
                OffsetMember::Member(name) | OffsetMember::IndirectMember(name) => {
                    format!(".{}", name.node.name)
                }
                OffsetMember::Index(index) => list("at", [of(index)]),
            });
            let first = format!(".{}", designator.base.node.name);
            list("offsetof", [ty(&inner.node.type_name), first].into_iter().chain(members))
        }
        Expression::VaArg(inner) => list("va_arg", [ty(&inner.node.type_name), of(&inner.node.va_list)]),
        Expression::Statement(inner) => {
            let block = statement(&inner.node);
            block.replacen("(block", "(statements", 1)
        }
    }
}

fn unary_head(operator: &UnaryOperator) -> &'static str {
    match operator {
        UnaryOperator::PostIncrement => "post++",
        UnaryOperator::PostDecrement => "post--",
        UnaryOperator::PreIncrement => "pre++",
        UnaryOperator::PreDecrement => "pre--",
        UnaryOperator::Address => "&",
        UnaryOperator::Indirection => "*",
        UnaryOperator::Plus => "+",
        UnaryOperator::Minus => "-",
        UnaryOperator::Complement => "~",
        UnaryOperator::Negate => "!",
    }
}

fn binary_head(operator: &BinaryOperator) -> &'static str {
    match operator {
        BinaryOperator::Index => "index",
        BinaryOperator::Multiply => "*",
        BinaryOperator::Divide => "/",
        BinaryOperator::Modulo => "%",
        BinaryOperator::Plus => "+",
        BinaryOperator::Minus => "-",
        BinaryOperator::ShiftLeft => "<<",
        BinaryOperator::ShiftRight => ">>",
        BinaryOperator::Less => "<",
        BinaryOperator::Greater => ">",
        BinaryOperator::LessOrEqual => "<=",
        BinaryOperator::GreaterOrEqual => ">=",
        BinaryOperator::Equals => "==",
        BinaryOperator::NotEquals => "!=",
        BinaryOperator::BitwiseAnd => "&",
        BinaryOperator::BitwiseXor => "^",
        BinaryOperator::BitwiseOr => "|",
        BinaryOperator::LogicalAnd => "&&",
        BinaryOperator::LogicalOr => "||",
        BinaryOperator::Assign => "=",
        BinaryOperator::AssignMultiply => "*=",
        BinaryOperator::AssignDivide => "/=",
        BinaryOperator::AssignModulo => "%=",
        BinaryOperator::AssignPlus => "+=",
        BinaryOperator::AssignMinus => "-=",
        BinaryOperator::AssignShiftLeft => "<<=",
        BinaryOperator::AssignShiftRight => ">>=",
        BinaryOperator::AssignBitwiseAnd => "&=",
        BinaryOperator::AssignBitwiseXor => "^=",
        BinaryOperator::AssignBitwiseOr => "|=",
    }
}

fn constant(constant: &Constant) -> String {
    match constant {
        Constant::Integer(integer) => self::integer(integer),
        Constant::Float(float) => self::float(float),
        Constant::Character(text) => {
            let (prefix, inside) = unquoted(text, '\'');
            let elements = unescaped(inside);
            let value = match elements[..] {
                // A byte has the signedness of `char`.
                [byte] if prefix.is_empty() && byte < 256 => i64::from(byte as u8 as i8),
                [one] => i64::from(one),
                _ => elements.iter().fold(0, |value, byte| value << 8 | i64::from(*byte)),
            };
            format!("{prefix}'{value}'")
        }
    }
}

fn integer(integer: &Integer) -> String {
    let radix = match integer.base {
        IntegerBase::Decimal => 10,
        IntegerBase::Octal => 8,
        IntegerBase::Hexadecimal => 16,
        IntegerBase::Binary => 2,
    };
    let value = if integer.number.is_empty() { Ok(0) } else { u64::from_str_radix(&integer.number, radix) };
    let unsigned = if integer.suffix.unsigned { "u" } else { "" };
    let long = if integer.suffix.size == IntegerSize::LongLong { "ll" } else { "" };
    value.map_or_else(|_| integer.number.to_string(), |value| format!("{value}{unsigned}{long}"))
}

fn float(float: &Float) -> String {
    if float.suffix.format == FloatFormat::Float {
        return float
            .number
            .parse::<f32>()
            .map_or_else(|_| float.number.to_string(), |value| format!("{:?}f", f64::from(value)));
    }
    float.number.parse::<f64>().map_or_else(|_| float.number.to_string(), |value| format!("{value:?}"))
}

/// The prefix and the contents of a literal.
fn unquoted(text: &str, quote: char) -> (&str, &str) {
    let (prefix, rest) = text.split_once(quote).unwrap_or(("", text));
    (prefix, rest.strip_suffix(quote).unwrap_or(rest))
}

/// The characters of a literal, with escapes replaced; literal text as bytes.
fn unescaped(text: &str) -> Vec<u32> {
    let bytes = text.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while let Some(&byte) = bytes.get(at) {
        at += 1;
        if byte != b'\\' {
            found.push(u32::from(byte));
            continue;
        }
        let escape = bytes.get(at).copied().unwrap_or(b'\\');
        at += 1;
        found.push(match escape {
            b'n' => 10,
            b't' => 9,
            b'r' => 13,
            b'a' => 7,
            b'b' => 8,
            b'f' => 12,
            b'v' => 11,
            b'e' => 27,
            b'x' => digits(text, &mut at, 16, 8),
            b'0'..=b'7' => {
                at -= 1;
                digits(text, &mut at, 8, 3)
            }
            other => u32::from(other),
        });
    }
    found
}

/// The number of the digits that begin at `at`.
fn digits(text: &str, at: &mut usize, radix: u32, most: usize) -> u32 {
    let digits: String = text[*at..].chars().take(most).take_while(|c| c.is_digit(radix)).collect();
    *at += digits.len();
    u32::from_str_radix(&digits, radix).unwrap_or(0)
}

fn string(pieces: &[String]) -> String {
    let parts: Vec<_> = pieces.iter().map(|piece| unquoted(piece, '"')).collect();
    let prefix = parts.iter().map(|(prefix, _)| *prefix).find(|prefix| !prefix.is_empty()).unwrap_or("");
    let shown = |element: u32| match u8::try_from(element) {
        Ok(byte) => byte.escape_ascii().to_string(),
        Err(_) => format!("\\{{{element:x}}}"),
    };
    let text: String = parts.iter().flat_map(|(_, inside)| unescaped(inside)).map(shown).collect();
    format!("{prefix}\"{text}\"")
}
