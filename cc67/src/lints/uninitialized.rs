//! Reads of locals in which nothing was stored.
//!
//! Only what is certain is reported: no store stands before the read in the text, and none
//! behind it in a loop around both. Functions with labels are left out. Locals in memory are,
//! too: their address may have been passed on.

use std::collections::{BTreeMap, BTreeSet};

use super::Lint;
use super::program::Program;
use crate::diag::{Diagnostic, Sink};
use crate::source::Span;
use crate::typed::{
    Callee, ExprId, ExprKind, Function, LocalId, LoopTest, PlaceId, PlaceKind, Stmt, StmtKind,
};

/// Reports every local that is read before anything is stored in it, once.
pub(super) fn check(program: &Program<'_>, sink: &mut Sink) {
    program
        .functions()
        .filter(|function| function.labels.is_empty())
        .for_each(|function| search(function, sink));
}

fn search(function: &Function, sink: &mut Sink) {
    let mut search = Search { function, stored: BTreeSet::new(), suspects: BTreeMap::new() };
    search.stored.extend(&function.parameters);
    search.stored.extend(function.variable_arguments);
    search.stored.extend(function.result_pointer);
    search.stmts(&function.body);
    for (local, span) in search.suspects {
        let local = &function.locals[local];
        sink.report(
            Diagnostic::warning(
                Lint::Uninitialized,
                span,
                format!("`{}` is read before it has a value", local.name),
            )
            .label(local.span, "declared without a value"),
        );
    }
}

struct Search<'a> {
    function: &'a Function,
    /// Locals that a store stands for in the text so far.
    stored: BTreeSet<LocalId>,
    /// Locals that were read first, and where.
    suspects: BTreeMap<LocalId, Span>,
}

impl Search<'_> {
    fn stmts(&mut self, stmts: &[Stmt]) {
        for stmt in stmts {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Expr(expr) | StmtKind::Return(Some(expr)) | StmtKind::GotoAddress(expr) => {
                self.expr(*expr);
            }
            StmtKind::Block(inner) => self.stmts(inner),
            StmtKind::If { condition, then, otherwise } => {
                self.expr(*condition);
                self.stmts(then);
                self.stmts(otherwise);
            }
            StmtKind::Loop { condition, test, body, step } => self.in_loop(|search| {
                let (first, last) = match test {
                    LoopTest::Before => (*condition, None),
                    LoopTest::Behind => (None, *condition),
                };
                first.into_iter().for_each(|expr| search.expr(expr));
                search.stmts(body);
                step.iter().chain(&last).for_each(|expr| search.expr(*expr));
            }),
            StmtKind::Switch { value, body, .. } => {
                self.expr(*value);
                self.stmts(body);
            }
            StmtKind::Case(_)
            | StmtKind::DefaultCase
            | StmtKind::Break
            | StmtKind::Continue
            | StmtKind::Return(None)
            | StmtKind::Label(_)
            | StmtKind::Goto(_) => {}
        }
    }

    /// What is stored further down in a loop may be read further up in its next turn.
    fn in_loop(&mut self, body: impl FnOnce(&mut Self)) {
        let known: BTreeSet<_> = self.suspects.keys().copied().collect();
        body(self);
        let stored = &self.stored;
        self.suspects.retain(|local, _| known.contains(local) || !stored.contains(local));
    }

    fn expr(&mut self, expr: ExprId) {
        // A long sum leans to the left: its spine is walked, not recursed into.
        let mut spine = Vec::new();
        let mut first = expr;
        while let ExprKind::Binary(_, a, b)
        | ExprKind::Compare(_, a, b)
        | ExprKind::And(a, b)
        | ExprKind::Or(a, b)
        | ExprKind::Comma(a, b) = self.function.exprs[first].kind
        {
            spine.push(b);
            first = a;
        }
        self.operand(first);
        while let Some(next) = spine.pop() {
            self.expr(next);
        }
    }

    fn operand(&mut self, expr: ExprId) {
        let function = self.function;
        match &function.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) | ExprKind::Clear(_) => {}
            ExprKind::Load(place) => self.read(*place),
            ExprKind::Address(place) | ExprKind::VaArg(place) => self.place(*place),
            ExprKind::Assign(place, value) => {
                self.place(*place);
                self.expr(*value);
                self.store(*place);
            }
            ExprKind::Update(update) => {
                self.read(update.place);
                self.expr(update.operand);
                self.store(update.place);
            }
            ExprKind::Copy { to, from } => {
                self.place(*to);
                self.place(*from);
            }
            ExprKind::Unary(_, value) | ExprKind::Convert(value) => self.expr(*value),
            ExprKind::Conditional(test, a, b) => [test, a, b].into_iter().for_each(|expr| self.expr(*expr)),
            ExprKind::Call(call) => {
                if let Callee::Pointer(pointer) = call.callee {
                    self.expr(pointer);
                }
                call.arguments.iter().chain(call.variable.iter().flatten()).for_each(|expr| self.expr(*expr));
            }
            ExprKind::Statements(stmts, value) => {
                self.stmts(stmts);
                value.iter().for_each(|expr| self.expr(*expr));
            }
            // The spine of `expr` never ends in these.
            ExprKind::Binary(_, a, b)
            | ExprKind::Compare(_, a, b)
            | ExprKind::And(a, b)
            | ExprKind::Or(a, b)
            | ExprKind::Comma(a, b) => {
                self.expr(*a);
                self.expr(*b);
            }
        }
    }

    /// What is evaluated to find a place.
    fn place(&mut self, place: PlaceId) {
        match self.function.places[place].kind {
            PlaceKind::Local(..) | PlaceKind::Symbol(..) => {}
            PlaceKind::Pointer(pointer, _) => self.expr(pointer),
            PlaceKind::Bits(unit, _) => self.place(unit),
        }
    }

    fn read(&mut self, place: PlaceId) {
        let PlaceKind::Local(local, _) = self.function.places[place].kind else { return self.place(place) };
        let Some(entry) = self.function.locals.get(local) else { return };
        if !entry.in_memory && !entry.name.is_empty() && !self.stored.contains(&local) {
            self.suspects.entry(local).or_insert(self.function.places[place].span);
        }
    }

    fn store(&mut self, place: PlaceId) {
        if let PlaceKind::Local(local, _) = self.function.places[place].kind {
            self.stored.insert(local);
        }
    }
}
