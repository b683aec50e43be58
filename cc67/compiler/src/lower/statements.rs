//! Statements to blocks.

use super::conditions::Sense;
use super::{Lowering, Switch, cost_table};
use crate::ir::inst::Terminator;
use crate::typed::{ExprId, LoopTest, Stmt, StmtKind};

impl Lowering<'_> {
    /// Lowers statements one after another.
    pub(super) fn statements(&mut self, statements: &[Stmt]) {
        for statement in statements {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Stmt) {
        self.builder.set_span(statement.span);
        match &statement.kind {
            StmtKind::Expr(expr) => self.lower_effect(*expr),
            StmtKind::Block(statements) => self.statements(statements),
            StmtKind::If { condition, then, otherwise } => self.if_statement(*condition, then, otherwise),
            StmtKind::Loop { condition, test, body, step } => {
                self.loop_statement(*condition, *test, body, *step);
            }
            StmtKind::Switch { value, cases, has_default, body } => {
                self.switch_statement(*value, cases, *has_default, body);
            }
            StmtKind::Case(number) => {
                let cases = self.jumps.switches.last().map(|switch| &switch.cases);
                if let Some(block) = cases.and_then(|cases| cases.get(*number as usize)).copied() {
                    // Whoever falls through jumps over the comparison with the case.
                    self.cost(cost_table::BRANCH);
                    self.builder.open(block);
                }
            }
            StmtKind::DefaultCase => {
                if let Some(Switch { default, .. }) = self.jumps.switches.last() {
                    self.builder.open(*default);
                }
            }
            StmtKind::Break => {
                if let Some(block) = self.jumps.breaks.last().copied() {
                    self.cost(cost_table::BRANCH);
                    self.builder.jump(block);
                }
            }
            StmtKind::Continue => {
                if let Some(block) = self.jumps.continues.last().copied() {
                    self.cost(cost_table::BRANCH);
                    self.builder.jump(block);
                }
            }
            StmtKind::Return(value) => self.return_statement(*value),
            StmtKind::Label(label) => {
                let block = self.label(*label);
                self.builder.open(block);
            }
            StmtKind::Goto(label) => {
                let block = self.label(*label);
                self.cost(cost_table::BRANCH);
                self.builder.jump(block);
            }
            StmtKind::GotoAddress(address) => self.goto_address(*address),
        }
    }

    /// A table of the labels that have an address; any other value stops the thread.
    fn goto_address(&mut self, address: ExprId) {
        let index = self.value(address);
        self.cost(cost_table::POINTER_BRANCH);
        let nowhere = self.builder.block();
        let function = self.function;
        let mut targets = vec![nowhere];
        let mut taken: Vec<_> =
            function.labels.iter().filter_map(|(id, label)| Some((label.address?, id))).collect();
        taken.sort_unstable();
        targets.extend(taken.into_iter().map(|(_, label)| self.label(label)));
        let targets = targets.into_boxed_slice();
        self.builder.terminate(Terminator::Table { index, targets, default: nowhere });
        self.builder.open(nowhere);
        self.builder.terminate(Terminator::Unreachable);
    }

    fn if_statement(&mut self, condition: ExprId, then: &[Stmt], otherwise: &[Stmt]) {
        let (yes, end) = (self.builder.block(), self.builder.block());
        let no = if otherwise.is_empty() { end } else { self.builder.block() };
        self.branch(condition, Sense::JumpIfFalse, yes, no);
        self.builder.open(yes);
        self.statements(then);
        if no != end {
            self.cost(cost_table::BRANCH);
            self.builder.jump(end);
            self.builder.open(no);
            self.statements(otherwise);
        }
        self.builder.open(end);
    }

    /// Lowers a loop with its test at the bottom, so that an iteration costs one branch. A small condition is
    /// duplicated before the loop; for a large one there is a jump to it.
    fn loop_statement(
        &mut self,
        condition: Option<ExprId>,
        test: LoopTest,
        body: &[Stmt],
        step: Option<ExprId>,
    ) {
        let span = self.builder.span();
        let (top, next, end) = (self.builder.block(), self.builder.block(), self.builder.block());
        let mut bottom = None;
        if let (Some(condition), LoopTest::Before) = (condition, test) {
            if self.is_small(condition) {
                self.branch(condition, Sense::JumpIfFalse, top, end);
            } else {
                let block = self.builder.block();
                bottom = Some(block);
                self.builder.jump(block);
            }
        }
        if step.is_some() && condition.is_none() {
            // The vendor's loops have their step in front of the body.
            self.cost(cost_table::BRANCH);
        }
        self.builder.open(top);
        if step.is_some() {
            self.cost(cost_table::BRANCH);
        }
        self.jumps.breaks.push(end);
        self.jumps.continues.push(next);
        self.statements(body);
        self.jumps.continues.pop();
        self.jumps.breaks.pop();
        if test == LoopTest::Before {
            self.cost(cost_table::BRANCH);
        }
        self.builder.open(next);
        if let Some(step) = step {
            self.builder.set_span(self.function.exprs[step].span);
            self.lower_effect(step);
            self.cost(cost_table::BRANCH);
        }
        if let Some(bottom) = bottom {
            self.builder.open(bottom);
        }
        self.builder.set_span(span);
        match condition {
            Some(condition) => {
                self.builder.set_span(self.function.exprs[condition].span);
                let sense = Sense::of(test == LoopTest::Before);
                self.branch(condition, sense, top, end);
            }
            None => self.builder.jump(top),
        }
        self.builder.open(end);
    }

    fn return_statement(&mut self, value: Option<ExprId>) {
        let class = self.signatures.get(self.builder.function.signature).result;
        match (value, class) {
            (Some(value), Some(class)) => {
                let source = value;
                let value = self.value(source);
                self.charge_return(Some(source));
                let value = if self.builder.function.class(value) == class {
                    value
                } else {
                    self.adapt_class(value, class)
                };
                self.builder.terminate(Terminator::Return(Some(value)));
            }
            (Some(value), None) => {
                self.lower_effect(value);
                self.charge_return(None);
                self.builder.terminate(Terminator::Return(None));
            }
            (None, _) => {
                self.charge_return(None);
                self.return_zero();
            }
        }
    }

    /// Returns without a value, or 0 where one is expected (specification, dialect.md 1.3).
    pub(super) fn return_zero(&mut self) {
        let class = self.signatures.get(self.builder.function.signature).result;
        let value = class.map(|class| class.zero().into());
        self.builder.terminate(Terminator::Return(value));
    }
}
