//! Statements.

use super::Sema;
use super::body::LabelState;
use super::constants::Constant;
use super::conversions::AssignmentTarget;
use super::operands::Operand;
use crate::ast::{Expression, Statement, StatementKind};
use crate::diag::Diagnostic;
use crate::lints::{
    assignment_condition, dangling_else, duplicated_condition, empty_body, misleading_indentation,
    multistatement_macro, precedence, unused_value,
};
use crate::names::Name;
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Label, LabelId, LoopTest, PlaceKind, Stmt, StmtKind};

impl Sema<'_> {
    /// The statements of a block, whose scope is open.
    pub(super) fn statements(&mut self, statements: &[Statement], out: &mut Vec<Stmt>) {
        for (index, statement) in statements.iter().enumerate() {
            self.statement(statement, out);
            if let Some(next) = statements.get(index + 1) {
                self.report_finding(misleading_indentation::finding(self.sources, statement, next));
                self.report_finding(multistatement_macro::finding(self.sources, statement, next));
                self.report_finding(empty_body::loop_finding(self.sources, statement, next));
            }
        }
    }

    /// Analyses a statement; it may become several or none.
    pub(super) fn statement(&mut self, statement: &Statement, out: &mut Vec<Stmt>) {
        let span = statement.span;
        match &statement.kind {
            StatementKind::Empty => {}
            StatementKind::Expression(expression) => self.expression_statement(expression, out),
            StatementKind::Block(inner) => {
                let inner = self.block(inner);
                out.push(Stmt { kind: StmtKind::Block(inner), span });
            }
            StatementKind::Declaration(declaration) => self.block_declaration(declaration, out),
            StatementKind::StaticAssert(assertion) => self.static_assert(assertion),
            StatementKind::If { .. }
            | StatementKind::While { .. }
            | StatementKind::DoWhile { .. }
            | StatementKind::Switch { .. } => {
                self.scopes.enter();
                self.controlled_statement(statement, out);
                self.scopes.leave();
            }
            StatementKind::For { init, condition, step, body } => {
                let inner = self.for_statement(init, condition.as_ref(), step.as_ref(), body, span);
                out.push(Stmt { kind: StmtKind::Block(inner), span });
            }
            StatementKind::Case { first, last, body } => {
                self.case_label(first, last.as_ref(), span, out);
                self.statement(body, out);
            }
            StatementKind::Default(body) => {
                self.default_label(span, out);
                self.statement(body, out);
            }
            StatementKind::Label { name, name_span, body } => {
                let label = self.define_label(*name, *name_span);
                out.push(Stmt { kind: StmtKind::Label(label), span: *name_span });
                self.statement(body, out);
            }
            StatementKind::Goto(name, name_span) => {
                let label = self.label(*name, *name_span, |state| &mut state.used);
                out.push(Stmt { kind: StmtKind::Goto(label), span });
            }
            StatementKind::GotoAddress(address) => {
                if let Some(address) = self.label_pointer(address) {
                    out.push(Stmt { kind: StmtKind::GotoAddress(address), span });
                }
            }
            StatementKind::Break => self.leave_statement(StmtKind::Break, span, out),
            StatementKind::Continue => self.leave_statement(StmtKind::Continue, span, out),
            StatementKind::Return(value) => self.return_statement(value.as_ref(), span, out),
        }
    }

    /// A statement with a controlling expression, whose scope is open: declarations in the expression end with the
    /// statement (C99 6.8.4, 6.8.5).
    fn controlled_statement(&mut self, statement: &Statement, out: &mut Vec<Stmt>) {
        let span = statement.span;
        match &statement.kind {
            StatementKind::If { condition, then, otherwise } => {
                self.if_statement(condition, then, otherwise.as_deref(), span, out);
            }
            StatementKind::While { condition, body } => {
                let condition = self.condition(condition);
                let body = self.loop_body(body);
                self.push_loop(Some(condition), LoopTest::Before, body, None, span, out);
            }
            StatementKind::DoWhile { body, condition } => {
                let body = self.loop_body(body);
                let condition = self.condition(condition);
                self.push_loop(Some(condition), LoopTest::Behind, body, None, span, out);
            }
            StatementKind::Switch { value, body } => self.switch_statement(value, body, span, out),
            _ => {}
        }
    }

    /// The statements of a block with a scope of its own.
    pub(super) fn block(&mut self, statements: &[Statement]) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(statements.len());
        self.scopes.enter();
        self.statements(statements, &mut out);
        self.scopes.leave();
        out
    }

    /// A statement that may be a declaration, in a scope of its own.
    fn scoped(&mut self, statement: &Statement) -> Vec<Stmt> {
        match &statement.kind {
            StatementKind::Block(inner) => self.block(inner),
            _ => self.block(std::slice::from_ref(statement)),
        }
    }

    fn expression_statement(&mut self, expression: &Expression, out: &mut Vec<Stmt>) {
        let span = expression.span;
        let Some(operand) = self.operand(expression) else { return };
        self.lint_unused(expression, operand);
        let effect = self.evaluate_effect(operand, span);
        out.push(Stmt { kind: StmtKind::Expr(effect), span });
    }

    /// Warns about a value that is computed and dropped; reading a volatile object is an effect.
    pub(super) fn lint_unused(&mut self, expression: &Expression, operand: Operand) {
        let ty = self.operand_type(operand);
        if !ty.ty.is_void() && !ty.is_volatile {
            let is_function = matches!(operand, Operand::Function(..));
            self.report_finding(unused_value::finding(expression, is_function));
        }
    }

    /// A condition: a scalar value; 0 instead if it is wrong.
    pub(super) fn condition(&mut self, expression: &Expression) -> ExprId {
        if self.refuse_assigned_call(expression) {
            return self.placeholder(expression.span);
        }
        self.report_finding(assignment_condition::finding(expression));
        self.report_finding(precedence::finding(expression));
        self.value(expression).unwrap_or_else(|| self.placeholder(expression.span))
    }

    /// A value in place of one that was diagnosed.
    pub(super) fn placeholder(&mut self, span: Span) -> ExprId {
        self.body.int(0, Types::INT, span)
    }

    fn if_statement(
        &mut self,
        condition: &Expression,
        then: &Statement,
        otherwise: Option<&Statement>,
        span: Span,
        out: &mut Vec<Stmt>,
    ) {
        let value = self.condition(condition);
        self.report_finding(empty_body::finding(self.sources, condition, then, otherwise));
        self.report_finding(duplicated_condition::finding(condition, otherwise));
        if otherwise.is_none() {
            self.report_finding(dangling_else::finding(self.sources, span, then));
        }
        let then = self.scoped(then);
        let otherwise = otherwise.map_or_else(Vec::new, |otherwise| self.scoped(otherwise));
        out.push(Stmt { kind: StmtKind::If { condition: value, then, otherwise }, span });
    }

    fn loop_body(&mut self, body: &Statement) -> Vec<Stmt> {
        // `break` means this loop: an outer switch is not reached from here, its cases are.
        self.body.jumps.loops += 1;
        let body = self.scoped(body);
        self.body.jumps.loops -= 1;
        body
    }

    fn for_statement(
        &mut self,
        init: &Statement,
        condition: Option<&Expression>,
        step: Option<&Expression>,
        body: &Statement,
        span: Span,
    ) -> Vec<Stmt> {
        let mut out = Vec::new();
        self.scopes.enter();
        self.statement(init, &mut out);
        let condition = condition.map(|condition| self.condition(condition));
        let step = step.and_then(|step| {
            let operand = self.operand(step)?;
            self.lint_unused(step, operand);
            Some(self.evaluate_effect(operand, step.span))
        });
        let body = self.loop_body(body);
        self.push_loop(condition, LoopTest::Before, body, step, span, &mut out);
        self.scopes.leave();
        out
    }

    fn push_loop(
        &mut self,
        condition: Option<ExprId>,
        test: LoopTest,
        body: Vec<Stmt>,
        step: Option<ExprId>,
        span: Span,
        out: &mut Vec<Stmt>,
    ) {
        // A condition that is always true is none.
        let is_true = |value: ExprId| self.body.as_constant(value).is_some_and(Constant::is_true);
        let condition = condition.filter(|value| !is_true(*value));
        out.push(Stmt { kind: StmtKind::Loop { condition, test, body, step }, span });
    }

    fn leave_statement(&mut self, kind: StmtKind, span: Span, out: &mut Vec<Stmt>) {
        let is_break = matches!(kind, StmtKind::Break);
        if self.body.jumps.loops > 0 || (is_break && !self.body.jumps.switches.is_empty()) {
            out.push(Stmt { kind, span });
            return;
        }
        // A `case` outside of a `switch` was already reported.
        if is_break && self.body.jumps.has_lost_case {
            return;
        }
        let message = match is_break {
            true => "`break` outside a loop or `switch`",
            false => "`continue` outside a loop",
        };
        self.report(Diagnostic::error(span, message));
    }

    fn label(&mut self, name: Name, span: Span, place: fn(&mut LabelState) -> &mut Option<Span>) -> LabelId {
        let body = &mut self.body;
        let names = self.names;
        let state = body.jumps.label_names.entry(name).or_insert_with(|| LabelState {
            label: body.jumps.labels.push(Label { name: names.get(name).to_owned(), span, address: None }),
            defined: None,
            used: None,
        });
        place(state).get_or_insert(span);
        state.label
    }

    fn define_label(&mut self, name: Name, span: Span) -> LabelId {
        if let Some(first) = self.body.jumps.label_names.get(&name).and_then(|state| state.defined) {
            let message = format!("label `{}` is defined twice", self.spelling(name));
            self.report(Diagnostic::error(span, message).label(first, "first defined here"));
        }
        let label = self.label(name, span, |state| &mut state.defined);
        self.body.jumps.labels[label].span = span;
        label
    }

    /// `&&name`: a unique number of type `void *`, which only `goto *` can use.
    pub(super) fn label_address(&mut self, name: Name, name_span: Span, span: Span) -> Option<ExprId> {
        if self.body.name.is_empty() {
            self.report(Diagnostic::error(span, "the address of a label cannot be taken outside a function"));
            return None;
        }
        let label = self.label(name, name_span, |state| &mut state.used);
        let next = 1 + self.body.jumps.labels.values().filter(|label| label.address.is_some()).count() as u32;
        let number = *self.body.jumps.labels[label].address.get_or_insert(next);
        let pointer = self.types.pointer_to(Types::VOID);
        Some(self.body.int(i64::from(number), pointer, span))
    }

    /// The operand of `goto *`.
    fn label_pointer(&mut self, address: &Expression) -> Option<ExprId> {
        let value = self.value(address)?;
        if self.types.is_pointer(self.body.ty(value)) {
            return Some(value);
        }
        let spelled = self.spell(self.body.ty(value));
        let message = format!("`goto *` needs the address of a label, not `{spelled}`");
        self.report(Diagnostic::error(address.span, message).help("`&&name` is the address of a label"));
        None
    }

    fn return_statement(&mut self, value: Option<&Expression>, span: Span, out: &mut Vec<Stmt>) {
        let result = self.body.result;
        let value = match value {
            None => self.zero_of_result(span),
            Some(value) if self.types.record_of(result).is_some() => {
                out.extend(self.return_record(value).map(|copy| Stmt { kind: StmtKind::Expr(copy), span }));
                None
            }
            Some(value) => self.return_value(value).or_else(|| self.zero_of_result(span)),
        };
        out.push(Stmt { kind: StmtKind::Return(value), span });
    }

    /// The value that `return;` yields in a function that has a result.
    fn zero_of_result(&mut self, span: Span) -> Option<ExprId> {
        let result = self.body.result;
        if result.is_void() || self.types.record_of(result).is_some() {
            return None;
        }
        Some(self.zero_value(result, span))
    }

    fn return_value(&mut self, expression: &Expression) -> Option<ExprId> {
        let (result, span) = (self.body.result, expression.span);
        let operand = self.operand(expression)?;
        // `return f();` in a `void` function passes no value if `f` is `void`, too.
        if self.body.is_void && self.operand_type(operand).ty.is_void() {
            let effect = self.evaluate_effect(operand, span);
            let zero = self.body.int(0, result, span);
            return Some(self.body.comma(effect, zero, span));
        }
        let value = self.read(operand, span)?;
        self.convert_as_assignment(value, result, AssignmentTarget::Return, span)
    }

    /// Copies a structure to the caller's result object.
    fn return_record(&mut self, expression: &Expression) -> Option<ExprId> {
        let (result, span) = (self.body.result, expression.span);
        let operand = self.operand(expression)?;
        let from = self.record_source(operand, result, AssignmentTarget::Return, span)?;
        let pointer = self.body.load_local(self.body.hidden.result_pointer?, span);
        let to = self.body.place(PlaceKind::Pointer(pointer, 0), result, span);
        Some(self.body.expr(ExprKind::Copy { to, from }, Types::VOID, span))
    }
}
