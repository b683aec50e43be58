//! The syntax tree as text: one S-expression per item.
//!
//! Declarations are made explicit: `int *a[3];` is `(var int a [3] *)`, with derivations from the name outwards.
//! Implicit `int` is `?`.

use crate::ast::{
    BasicType, Declaration, Declarator, Derived, Designator, EnumSpecifier, Expression, ExpressionKind,
    FloatingLiteral, FunctionDefinition, Initializer, InitializerItem, IntegerLiteral, Item, Parameters,
    Qualifiers, RecordKind, RecordSpecifier, Specifiers, Statement, StatementKind, StaticAssert, Storage,
    StringLiteral, TranslationUnit, TypeName, TypeSpecifier, UnaryOperator,
};
use crate::names::{Name, Names};

/// The text of a translation unit.
#[must_use]
pub fn print(unit: &TranslationUnit, names: &Names) -> String {
    let mut printer = Printer { names, text: String::new() };
    for item in &unit.items {
        match item {
            Item::Function(function) => printer.function(function),
            Item::Declaration(declaration) => printer.declaration(declaration),
            Item::StaticAssert(assert) => printer.static_assert(assert),
        }
        printer.text.push('\n');
    }
    printer.text
}

struct Printer<'a> {
    names: &'a Names,
    text: String,
}

impl Printer<'_> {
    /// Appends a word, separated from the previous one.
    fn word(&mut self, word: impl AsRef<str>) {
        if !self.text.is_empty() && !self.text.ends_with(['(', '\n', ' ']) {
            self.text.push(' ');
        }
        self.text.push_str(word.as_ref());
    }

    fn name(&mut self, name: Name) {
        let names = self.names;
        self.word(names.get(name));
    }

    fn open(&mut self, head: impl AsRef<str>) {
        self.word("(");
        self.text.push_str(head.as_ref());
    }

    fn close(&mut self) {
        self.text.push(')');
    }

    /// `(head part part …)`
    fn list<'e>(&mut self, head: &str, parts: impl IntoIterator<Item = &'e Expression>) {
        self.open(head);
        for part in parts {
            self.expression(part);
        }
        self.close();
    }

    fn function(&mut self, function: &FunctionDefinition) {
        self.open("function");
        self.specifiers(&function.specifiers);
        self.declarator(&function.declarator);
        for declaration in &function.old_style {
            self.declaration(declaration);
        }
        self.statement(&function.body);
        self.close();
    }

    fn declaration(&mut self, declaration: &Declaration) {
        if declaration.declarators.is_empty() {
            self.open("type");
            self.specifiers(&declaration.specifiers);
            return self.close();
        }
        self.open("var");
        self.specifiers(&declaration.specifiers);
        for (index, init) in declaration.declarators.iter().enumerate() {
            if index > 0 {
                self.text.push(',');
            }
            self.declarator(&init.declarator);
            if let Some(initializer) = &init.initializer {
                self.word("=");
                self.initializer(initializer);
            }
        }
        self.close();
    }

    fn static_assert(&mut self, assert: &StaticAssert) {
        self.list("static-assert", [&assert.condition]);
    }

    fn specifiers(&mut self, specifiers: &Specifiers) {
        if let Some((storage, _)) = specifiers.storage {
            self.word(match storage {
                Storage::Typedef => "typedef",
                Storage::Extern => "extern",
                Storage::Static => "static",
                Storage::Auto => "auto",
                Storage::Register => "register",
            });
        }
        if specifiers.is_inline {
            self.word("inline");
        }
        self.qualifiers(specifiers.qualifiers);
        match &specifiers.ty {
            None => self.word("?"),
            Some(TypeSpecifier::Basic(basic)) => self.word(basic_text(*basic)),
            Some(TypeSpecifier::Typedef(name)) => self.name(*name),
            Some(TypeSpecifier::Record(record)) => self.record(record),
            Some(TypeSpecifier::Enum(enumeration)) => self.enumeration(enumeration),
            Some(TypeSpecifier::TypeofExpression(expression)) => self.list("typeof", [&**expression]),
            Some(TypeSpecifier::TypeofType(ty)) => {
                self.open("typeof");
                self.type_name(ty);
                self.close();
            }
        }
    }

    fn record(&mut self, record: &RecordSpecifier) {
        self.open(if record.kind == RecordKind::Struct { "struct" } else { "union" });
        if let Some((tag, _)) = record.tag {
            self.name(tag);
        }
        for line in record.members.iter().flatten() {
            self.open("member");
            self.specifiers(&line.specifiers);
            for (index, member) in line.members.iter().enumerate() {
                if index > 0 {
                    self.text.push(',');
                }
                if let Some(declarator) = &member.declarator {
                    self.declarator(declarator);
                }
                if let Some(width) = &member.width {
                    self.word(":");
                    self.expression(width);
                }
            }
            self.close();
        }
        self.close();
    }

    fn enumeration(&mut self, enumeration: &EnumSpecifier) {
        self.open("enum");
        if let Some((tag, _)) = enumeration.tag {
            self.name(tag);
        }
        for enumerator in enumeration.enumerators.iter().flatten() {
            match &enumerator.value {
                Some(value) => {
                    self.open("=");
                    self.name(enumerator.name);
                    self.expression(value);
                    self.close();
                }
                None => self.name(enumerator.name),
            }
        }
        self.close();
    }

    fn qualifiers(&mut self, qualifiers: Qualifiers) {
        if qualifiers.is_const {
            self.word("const");
        }
        if qualifiers.is_volatile {
            self.word("volatile");
        }
    }

    fn type_name(&mut self, ty: &TypeName) {
        self.specifiers(&ty.specifiers);
        self.declarator(&ty.declarator);
    }

    fn declarator(&mut self, declarator: &Declarator) {
        if let Some((name, _)) = declarator.name {
            self.name(name);
        }
        for derived in &declarator.derived {
            match derived {
                Derived::Pointer(qualifiers) => {
                    self.word("*");
                    self.qualifiers(*qualifiers);
                }
                Derived::Array(None) => self.word("[]"),
                Derived::Array(Some(length)) => {
                    self.word("[");
                    self.text.push_str(&{
                        let mut inner = Printer { names: self.names, text: String::new() };
                        inner.expression(length);
                        inner.text
                    });
                    self.text.push(']');
                }
                Derived::Function(parameters) => self.parameters(parameters),
            }
        }
    }

    fn parameters(&mut self, parameters: &Parameters) {
        match parameters {
            Parameters::Unspecified => self.word("()"),
            Parameters::Names(names) => {
                self.open("names");
                for (name, _) in names {
                    self.name(*name);
                }
                self.close();
            }
            Parameters::Prototype { parameters, is_variadic } => {
                self.open("fn");
                for (index, parameter) in parameters.iter().enumerate() {
                    if index > 0 {
                        self.text.push(',');
                    }
                    self.specifiers(&parameter.specifiers);
                    self.declarator(&parameter.declarator);
                }
                if *is_variadic {
                    self.word("...");
                }
                self.close();
            }
        }
    }

    fn initializer(&mut self, initializer: &Initializer) {
        match initializer {
            Initializer::Expression(expression) => self.expression(expression),
            Initializer::List { items, .. } => self.items(items),
        }
    }

    fn items(&mut self, items: &[InitializerItem]) {
        self.open("list");
        for item in items {
            if !item.designators.is_empty() {
                self.designators(&item.designators);
                self.word("=");
            }
            self.initializer(&item.initializer);
        }
        self.close();
    }

    fn designators(&mut self, designators: &[Designator]) {
        for designator in designators {
            match designator {
                Designator::Member(name, _) => {
                    let names = self.names;
                    self.word(format!(".{}", names.get(*name)));
                }
                Designator::Index(index) => self.list("at", [index]),
                Designator::Range(first, last) => self.list("from", [first, last]),
            }
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::Empty => self.word("()"),
            StatementKind::Expression(expression) => self.expression(expression),
            StatementKind::Block(statements) => self.statements("block", statements),
            StatementKind::Declaration(declaration) => self.declaration(declaration),
            StatementKind::StaticAssert(assert) => self.static_assert(assert),
            StatementKind::If { condition, then, otherwise } => {
                self.open("if");
                self.expression(condition);
                self.statement(then);
                if let Some(otherwise) = otherwise {
                    self.statement(otherwise);
                }
                self.close();
            }
            StatementKind::While { condition, body } => self.print_controlled("while", condition, body),
            StatementKind::Switch { value, body } => self.print_controlled("switch", value, body),
            StatementKind::DoWhile { body, condition } => {
                self.open("do");
                self.statement(body);
                self.expression(condition);
                self.close();
            }
            StatementKind::For { init, condition, step, body } => {
                self.open("for");
                self.statement(init);
                for part in [condition, step] {
                    match part {
                        Some(part) => self.expression(part),
                        None => self.word("()"),
                    }
                }
                self.statement(body);
                self.close();
            }
            StatementKind::Case { first, last, body } => {
                self.open("case");
                self.expression(first);
                if let Some(last) = last {
                    self.word("...");
                    self.expression(last);
                }
                self.statement(body);
                self.close();
            }
            StatementKind::Default(body) => self.print_labelled("default", None, body),
            StatementKind::Label { name, body, .. } => self.print_labelled("label", Some(*name), body),
            StatementKind::Goto(name, _) => {
                self.open("goto");
                self.name(*name);
                self.close();
            }
            StatementKind::GotoAddress(address) => {
                self.open("goto*");
                self.expression(address);
                self.close();
            }
            StatementKind::Break => self.word("break"),
            StatementKind::Continue => self.word("continue"),
            StatementKind::Return(value) => self.list("return", value),
        }
    }

    fn statements(&mut self, head: &str, statements: &[Statement]) {
        self.open(head);
        for statement in statements {
            self.statement(statement);
        }
        self.close();
    }

    fn print_controlled(&mut self, head: &str, condition: &Expression, body: &Statement) {
        self.open(head);
        self.expression(condition);
        self.statement(body);
        self.close();
    }

    fn print_labelled(&mut self, head: &str, name: Option<Name>, body: &Statement) {
        self.open(head);
        if let Some(name) = name {
            self.name(name);
        }
        self.statement(body);
        self.close();
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Identifier(name) => self.name(*name),
            ExpressionKind::Integer(literal) => self.word(integer_text(*literal)),
            ExpressionKind::Floating(literal) => self.word(floating_text(*literal)),
            ExpressionKind::Character(value, encoding) => {
                self.word(format!("{}'{value}'", encoding.prefix()));
            }
            ExpressionKind::String(literal) => self.word(string_text(literal)),
            ExpressionKind::FunctionName => self.word("__func__"),
            ExpressionKind::Index(a, b) => self.list("index", [&**a, b]),
            ExpressionKind::Call(function, arguments) => {
                self.list("call", std::iter::once(&**function).chain(arguments));
            }
            ExpressionKind::Member { base, arrow, member, .. } => {
                self.open(if *arrow { "->" } else { "." });
                self.expression(base);
                self.name(*member);
                self.close();
            }
            ExpressionKind::Unary(operator, a) => self.list(unary_text(*operator), [&**a]),
            ExpressionKind::Increment { operand, is_increment, is_prefix } => {
                let head = match (is_prefix, is_increment) {
                    (true, true) => "pre++",
                    (true, false) => "pre--",
                    (false, true) => "post++",
                    (false, false) => "post--",
                };
                self.list(head, [&**operand]);
            }
            ExpressionKind::Binary(operator, a, b) => self.list(operator.spelling(), [&**a, b]),
            ExpressionKind::Assign(a, b) => self.list("=", [&**a, b]),
            ExpressionKind::AssignWith(operator, a, b) => {
                self.list(&format!("{}=", operator.spelling()), [&**a, b]);
            }
            ExpressionKind::Conditional { condition, then: Some(then), otherwise } => {
                self.list("?", [&**condition, then, otherwise]);
            }
            ExpressionKind::Conditional { condition, then: None, otherwise } => {
                self.list("?:", [&**condition, otherwise]);
            }
            ExpressionKind::Comma(a, b) => self.list(",", [&**a, b]),
            ExpressionKind::VaStart(a, b) => self.list("va_start", [&**a, b]),
            ExpressionKind::VaCopy(a, b) => self.list("va_copy", [&**a, b]),
            ExpressionKind::VaEnd(a) => self.list("va_end", [&**a]),
            ExpressionKind::SizeofExpression(a) => self.list("sizeof", [&**a]),
            ExpressionKind::StatementExpression(statements) => self.statements("statements", statements),
            ExpressionKind::LabelAddress(name, _) => {
                self.open("&&");
                self.name(*name);
                self.close();
            }
            ExpressionKind::Error => self.word("error"),
            typed => self.print_typed_expression(typed),
        }
    }

    /// Expressions with a type in them.
    fn print_typed_expression(&mut self, kind: &ExpressionKind) {
        match kind {
            ExpressionKind::Cast(ty, operand) => {
                self.with_type("cast", ty);
                self.expression(operand);
            }
            ExpressionKind::CompoundLiteral(ty, items) => {
                self.with_type("literal", ty);
                self.items(items);
            }
            ExpressionKind::SizeofType(ty) => self.with_type("sizeof-type", ty),
            ExpressionKind::AlignofType(ty) => self.with_type("alignof", ty),
            ExpressionKind::AlignofExpression(operand) => {
                self.open("alignof");
                self.expression(operand);
                self.close();
            }
            ExpressionKind::VaArg(list, ty) => {
                self.with_type("va_arg", ty);
                self.expression(list);
            }
            ExpressionKind::Offsetof(ty, path) => {
                self.with_type("offsetof", ty);
                self.designators(path);
            }
            ExpressionKind::Generic { value, choices } => {
                self.open("generic");
                self.expression(value);
                for (ty, choice) in choices {
                    match ty {
                        Some(ty) => self.with_type("case", ty),
                        None => self.open("default"),
                    }
                    self.expression(choice);
                    self.close();
                }
            }
            _ => return,
        }
        self.close();
    }

    fn with_type(&mut self, head: &str, ty: &TypeName) {
        self.open(head);
        self.open("");
        self.type_name(ty);
        self.close();
    }
}

fn integer_text(literal: IntegerLiteral) -> String {
    let mut text = literal.value.to_string();
    if literal.is_unsigned {
        text.push('u');
    }
    if literal.is_long_long {
        text.push_str("ll");
    }
    text
}

fn floating_text(literal: FloatingLiteral) -> String {
    format!("{:?}{}", literal.value, if literal.is_single { "f" } else { "" })
}

fn string_text(literal: &StringLiteral) -> String {
    let shown = |element: &i32| match u8::try_from(*element) {
        Ok(byte) => byte.escape_ascii().to_string(),
        Err(_) => format!("\\{{{element:x}}}"),
    };
    let text: String = literal.elements.iter().map(shown).collect();
    format!("{}\"{text}\"", literal.encoding.prefix())
}

fn unary_text(operator: UnaryOperator) -> &'static str {
    match operator {
        UnaryOperator::AddressOf => "&",
        UnaryOperator::Dereference => "*",
        UnaryOperator::Plus => "+",
        UnaryOperator::Minus => "-",
        UnaryOperator::Complement => "~",
        UnaryOperator::Not => "!",
    }
}

fn basic_text(basic: BasicType) -> &'static str {
    match basic {
        BasicType::Void => "void",
        BasicType::Bool => "_Bool",
        BasicType::Char => "char",
        BasicType::SignedChar => "schar",
        BasicType::UnsignedChar => "uchar",
        BasicType::Short => "short",
        BasicType::UnsignedShort => "ushort",
        BasicType::Int => "int",
        BasicType::Unsigned => "uint",
        BasicType::Long => "long",
        BasicType::UnsignedLong => "ulong",
        BasicType::LongLong => "llong",
        BasicType::UnsignedLongLong => "ullong",
        BasicType::Float => "float",
        BasicType::Double => "double",
        BasicType::LongDouble => "ldouble",
    }
}
