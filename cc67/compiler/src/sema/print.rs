//! The typed tree as text, for users and tests.
//!
//! Every conversion and every byte offset is shown; types other than `int` are written out. `@name` is a symbol, `name`
//! a local, `t3` a temporary.

use std::fmt::Write;

use crate::names::Names;
use crate::ty::{TypeId, Types};
use crate::typed::{
    Call, Callee, Definition, ExprId, ExprKind, Function, LocalId, LoopTest, PlaceId, PlaceKind, Stmt,
    StmtKind, UnaryOp, Unit, UpdateResult,
};

/// A unit: its data, then its functions.
#[must_use]
pub fn unit(unit: &Unit, names: &Names) -> String {
    let mut out = String::new();
    for symbol in unit.symbols.values() {
        let ty = unit.types.spell_declaration(names, symbol.ty, &symbol.name);
        match &symbol.definition {
            Definition::None | Definition::Function => {}
            Definition::Tentative => out.push_str(&format!("{ty};\n")),
            Definition::Data(data) => {
                let bytes: Vec<_> = data.bytes.iter().map(|byte| format!("{byte:02x}")).collect();
                let _ = write!(out, "{ty} = {}", bytes.join(" "));
                for word in &data.addresses {
                    let symbol = &unit.symbols[word.symbol].name;
                    let _ = write!(out, ", @{symbol}{:+} at {}", word.addend, word.offset);
                }
                out.push_str(";\n");
            }
        }
    }
    for body in &unit.functions {
        out.push_str(&function(unit, body, names));
    }
    out
}

/// Prints a function.
#[must_use]
pub fn function(unit: &Unit, function: &Function, names: &Names) -> String {
    let mut printer = Printer { unit, function, names, out: String::new(), depth: 1 };
    let parameters: Vec<_> =
        function.parameters.iter().map(|local| printer.declaration_text(*local)).collect();
    let result = unit.types.spell(names, function.ty.result);
    let name = &unit.symbols[function.symbol].name;
    let _ = writeln!(printer.out, "{result} {name}({}) {{", parameters.join(", "));
    printer.stmts(&function.body);
    printer.out.push_str("}\n");
    printer.out
}

struct Printer<'a> {
    unit: &'a Unit,
    function: &'a Function,
    names: &'a Names,
    out: String,
    depth: usize,
}

impl Printer<'_> {
    fn declaration_text(&self, local: LocalId) -> String {
        let ty = self.function.locals[local].ty;
        self.unit.types.spell_declaration(self.names, ty, &self.local(local))
    }

    fn local(&self, local: LocalId) -> String {
        let name = &self.function.locals[local].name;
        if name.is_empty() { format!("t{}", local.as_u32()) } else { name.clone() }
    }

    fn ty(&self, ty: TypeId) -> String {
        self.unit.types.spell(self.names, ty)
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.out, "{:indent$}{text}", "", indent = self.depth * 2);
    }

    fn print_block(&mut self, stmts: &[Stmt]) {
        self.depth += 1;
        self.stmts(stmts);
        self.depth -= 1;
    }

    fn stmts(&mut self, stmts: &[Stmt]) {
        for stmt in stmts {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Expr(expr) => self.line(&format!("{};", self.expr(*expr))),
            StmtKind::Block(inner) => {
                self.line("{");
                self.print_block(inner);
                self.line("}");
            }
            StmtKind::If { condition, then, otherwise } => {
                self.line(&format!("if {} {{", self.expr(*condition)));
                self.print_block(then);
                if !otherwise.is_empty() {
                    self.line("} else {");
                    self.print_block(otherwise);
                }
                self.line("}");
            }
            StmtKind::Loop { condition, test, body, step } => {
                let condition = condition.map_or_else(|| "true".to_owned(), |condition| self.expr(condition));
                let step = step.map_or_else(String::new, |step| format!("; {}", self.expr(step)));
                let (head, tail) = match test {
                    LoopTest::Before => (format!("while {condition}{step} {{"), "}".to_owned()),
                    LoopTest::Behind => ("do {".to_owned(), format!("}} while {condition}")),
                };
                self.line(&head);
                self.print_block(body);
                self.line(&tail);
            }
            StmtKind::Switch { value, cases, has_default, body } => {
                let cases: Vec<_> = cases
                    .iter()
                    .map(|case| match case.first == case.last {
                        true => case.first.to_string(),
                        false => format!("{}...{}", case.first, case.last),
                    })
                    .collect();
                let default = if *has_default { "; default" } else { "" };
                self.line(&format!("switch {} [{}{default}] {{", self.expr(*value), cases.join(", ")));
                self.print_block(body);
                self.line("}");
            }
            StmtKind::Case(number) => self.line(&format!("case #{number}:")),
            StmtKind::DefaultCase => self.line("default:"),
            StmtKind::Break => self.line("break;"),
            StmtKind::Continue => self.line("continue;"),
            StmtKind::Return(None) => self.line("return;"),
            StmtKind::Return(Some(value)) => self.line(&format!("return {};", self.expr(*value))),
            StmtKind::Label(label) => self.line(&format!("{}:", self.function.labels[*label].name)),
            StmtKind::Goto(label) => self.line(&format!("goto {};", self.function.labels[*label].name)),
            StmtKind::GotoAddress(address) => self.line(&format!("goto *{};", self.expr(*address))),
        }
    }

    fn expr(&self, id: ExprId) -> String {
        let expr = &self.function.exprs[id];
        match &expr.kind {
            ExprKind::Int(value) if expr.ty == Types::INT => value.to_string(),
            ExprKind::Int(value) => format!("{value}:{}", self.ty(expr.ty)),
            ExprKind::Float(value) if expr.ty == Types::FLOAT => format!("{value:?}f"),
            ExprKind::Float(value) => format!("{value:?}"),
            ExprKind::Load(place) => self.place(*place),
            ExprKind::Address(place) => format!("&{}", self.place(*place)),
            ExprKind::Assign(place, value) => format!("{} = {}", self.place(*place), self.expr(*value)),
            ExprKind::Update(update) => {
                let (place, operand) = (self.place(update.place), self.expr(update.operand));
                let computed = self.ty(update.computed);
                let old = if update.result == UpdateResult::Old { "old " } else { "" };
                format!("{old}{place} {}= {operand} in {computed}", update.op.spelling())
            }
            ExprKind::Copy { to, from } => format!("copy {} <- {}", self.place(*to), self.place(*from)),
            ExprKind::Clear(place) => format!("clear {}", self.place(*place)),
            ExprKind::Unary(op, value) => {
                let op = match op {
                    UnaryOp::Negate => "-",
                    UnaryOp::Complement => "~",
                    UnaryOp::Not => "!",
                };
                format!("{op}{}", self.expr(*value))
            }
            ExprKind::Binary(op, a, b) => format!("({} {} {})", self.expr(*a), op.spelling(), self.expr(*b)),
            ExprKind::Compare(op, a, b) => format!("({} {} {})", self.expr(*a), op.spelling(), self.expr(*b)),
            ExprKind::And(a, b) => format!("({} && {})", self.expr(*a), self.expr(*b)),
            ExprKind::Or(a, b) => format!("({} || {})", self.expr(*a), self.expr(*b)),
            ExprKind::Conditional(test, a, b) => {
                format!("({} ? {} : {})", self.expr(*test), self.expr(*a), self.expr(*b))
            }
            ExprKind::Comma(a, b) => format!("({}, {})", self.expr(*a), self.expr(*b)),
            ExprKind::Convert(value) => format!("({})[{}]", self.ty(expr.ty), self.expr(*value)),
            ExprKind::Call(call) => self.call(call),
            ExprKind::VaArg(list) => format!("va_arg({}, {})", self.place(*list), self.ty(expr.ty)),
            ExprKind::Statements(stmts, value) => self.statements(stmts, *value),
        }
    }

    fn call(&self, call: &Call) -> String {
        let callee = match call.callee {
            Callee::Symbol(symbol) => self.unit.symbols[symbol].name.clone(),
            Callee::Pointer(pointer) => format!("(*{})", self.expr(pointer)),
        };
        let mut arguments: Vec<_> = call.arguments.iter().map(|argument| self.expr(*argument)).collect();
        if let Some(variable) = &call.variable {
            let variable: Vec<_> = variable.iter().map(|argument| self.expr(*argument)).collect();
            arguments.push(format!("... {}", variable.join(", ")).trim_end().to_owned());
        }
        format!("{callee}({})", arguments.join(", "))
    }

    fn statements(&self, stmts: &[Stmt], value: Option<ExprId>) -> String {
        let mut inner = Printer { out: String::new(), depth: self.depth + 1, ..*self };
        inner.stmts(stmts);
        let value = value.map_or_else(String::new, |value| self.expr(value));
        format!("({{\n{}{:indent$}{value} }})", inner.out, "", indent = (self.depth + 1) * 2)
    }

    fn place(&self, id: PlaceId) -> String {
        let place = &self.function.places[id];
        let part = |offset: i64, whole: TypeId| match offset == 0 && whole == place.ty {
            true => String::new(),
            false => format!("{{{offset}:{}}}", self.ty(place.ty)),
        };
        match place.kind {
            PlaceKind::Local(local, offset) => {
                format!("{}{}", self.local(local), part(i64::from(offset), self.function.locals[local].ty))
            }
            PlaceKind::Symbol(symbol, offset) => {
                let symbol = &self.unit.symbols[symbol];
                format!("@{}{}", symbol.name, part(i64::from(offset), symbol.ty))
            }
            PlaceKind::Pointer(pointer, offset) => {
                let ty = self.function.exprs[pointer].ty;
                let whole = self.unit.types.pointee(ty).map_or(Types::VOID, |to| to.ty);
                format!("*{}{}", self.expr(pointer), part(i64::from(offset), whole))
            }
            PlaceKind::Bits(unit, bits) => format!("{}<{}+{}>", self.place(unit), bits.shift, bits.width),
        }
    }
}
