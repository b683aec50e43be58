//! The expressions that a piece of a function evaluates.

use crate::typed::{Callee, ExprId, ExprKind, Function, PlaceId, PlaceKind, Stmt, StmtKind};

/// The expressions to visit.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Extent {
    /// Every one.
    All,
    /// Expressions that are always evaluated exactly once, in code that is not left early.
    Always,
}

/// Visits expressions, outer ones first, but not the inside of statement expressions.
#[derive(Clone, Copy)]
pub(super) struct Walk<'a> {
    pub(super) function: &'a Function,
    pub(super) extent: Extent,
}

impl Walk<'_> {
    /// Hands over the expressions of statements.
    pub(super) fn stmts(self, stmts: &[Stmt], visit: &mut dyn FnMut(ExprId)) {
        stmts.iter().for_each(|stmt| self.stmt(stmt, visit));
    }

    fn stmt(self, stmt: &Stmt, visit: &mut dyn FnMut(ExprId)) {
        let all = self.extent == Extent::All;
        match &stmt.kind {
            StmtKind::Expr(expr) => self.expr(*expr, visit),
            StmtKind::Block(inner) => self.stmts(inner, visit),
            StmtKind::If { condition, then, otherwise } => {
                self.expr(*condition, visit);
                if all {
                    self.stmts(then, visit);
                    self.stmts(otherwise, visit);
                }
            }
            StmtKind::Loop { condition, body, step, .. } if all => {
                condition.iter().chain(step).for_each(|expr| self.expr(*expr, visit));
                self.stmts(body, visit);
            }
            StmtKind::Switch { value, body, .. } => {
                self.expr(*value, visit);
                if all {
                    self.stmts(body, visit);
                }
            }
            StmtKind::Return(Some(value)) | StmtKind::GotoAddress(value) => self.expr(*value, visit),
            _ => {}
        }
    }

    /// Hands over an expression and its parts.
    pub(super) fn expr(self, expr: ExprId, visit: &mut dyn FnMut(ExprId)) {
        visit(expr);
        let all = self.extent == Extent::All;
        match &self.function.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) | ExprKind::Statements(..) => {}
            ExprKind::Load(place)
            | ExprKind::Address(place)
            | ExprKind::Clear(place)
            | ExprKind::VaArg(place) => {
                self.place(*place, visit);
            }
            ExprKind::Assign(place, value) => {
                self.place(*place, visit);
                self.expr(*value, visit);
            }
            ExprKind::Update(update) => {
                self.place(update.place, visit);
                self.expr(update.operand, visit);
            }
            ExprKind::Copy { to, from } => {
                self.place(*to, visit);
                self.place(*from, visit);
            }
            ExprKind::Unary(_, value) | ExprKind::Convert(value) => self.expr(*value, visit),
            ExprKind::Binary(_, a, b) | ExprKind::Compare(_, a, b) | ExprKind::Comma(a, b) => {
                self.expr(*a, visit);
                self.expr(*b, visit);
            }
            ExprKind::And(a, b) | ExprKind::Or(a, b) => {
                self.expr(*a, visit);
                if all {
                    self.expr(*b, visit);
                }
            }
            ExprKind::Conditional(condition, a, b) => {
                self.expr(*condition, visit);
                if all {
                    self.expr(*a, visit);
                    self.expr(*b, visit);
                }
            }
            ExprKind::Call(call) => {
                if let Callee::Pointer(callee) = call.callee {
                    self.expr(callee, visit);
                }
                let arguments = call.arguments.iter().chain(call.variable.iter().flatten());
                arguments.for_each(|argument| self.expr(*argument, visit));
            }
        }
    }

    /// Visits the expressions that are evaluated to determine a place.
    fn place(self, place: PlaceId, visit: &mut dyn FnMut(ExprId)) {
        match self.function.places[place].kind {
            PlaceKind::Pointer(pointer, _) => self.expr(pointer, visit),
            PlaceKind::Bits(unit, _) => self.place(unit, visit),
            PlaceKind::Local(..) | PlaceKind::Symbol(..) => {}
        }
    }
}
