//! Reads of uninitialised locals.
//!
//! A read is certain to be uninitialised if no store comes before it in the text, and every path to a later store, in a
//! loop around both, passes a read. A read is doubtful if some path reaches it without a store; since it is unknown
//! which paths are taken, many of these are false alarms. Functions with labels are left out, and so are locals in
//! memory, whose addresses may have been passed on.

use std::collections::{BTreeMap, BTreeSet};

use super::flow::Flow;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{
    Callee, ExprId, ExprKind, Function, LocalId, LoopTest, PlaceId, PlaceKind, Stmt, StmtKind, UnaryOp,
};

/// Reports every local that is read before a store, once.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    // Code with errors may have contained the store.
    if sink.has_errors() {
        return;
    }
    program
        .whole_functions()
        .filter(|function| function.labels.is_empty())
        .for_each(|function| search(function, sink));
}

fn search(function: &Function, sink: &mut Sink) {
    let mut search = Search {
        function,
        stored: BTreeSet::new(),
        stored_unread: BTreeSet::new(),
        suspects: BTreeMap::new(),
        flow: Flow::start(),
        doubtful: BTreeMap::new(),
        exits: Vec::new(),
    };
    let hidden = function.hidden.variable_arguments.iter().chain(&function.hidden.result_pointer);
    function.parameters.iter().chain(hidden).for_each(|local| search.stored_in(*local));
    search.stmts(&function.body);
    for (local, span) in &search.doubtful {
        if search.suspects.contains_key(local) {
            continue;
        }
        let local = &function.locals[*local];
        let message = format!("`{}` may be read before it has a value", local.name);
        sink.report(
            Diagnostic::warning(Lint::MaybeUninitialized, *span, message)
                .at("not assigned on every path to here")
                .label(local.span, "declared without a value"),
        );
    }
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
    /// Locals with a store in the text so far.
    stored: BTreeSet<LocalId>,
    /// Locals with a store that some path reaches without a read of the local.
    stored_unread: BTreeSet<LocalId>,
    /// Locals that were read first, and where.
    suspects: BTreeMap<LocalId, Span>,
    /// The locals in which every path to the current position has stored.
    flow: Flow,
    /// Locals that were read where not every path has stored in them, with the position.
    doubtful: BTreeMap<LocalId, Span>,
    /// The loops and switches around the current place, the innermost last.
    exits: Vec<Exits>,
}

/// The facts at the exits of a loop or switch, merged.
struct Exits {
    /// In front of the cases of a switch; `None` for a loop.
    cases: Option<Flow>,
    breaks: Flow,
    continues: Flow,
}

impl Exits {
    fn new(cases: Option<Flow>) -> Self {
        Self { cases, breaks: Flow::Unreachable, continues: Flow::Unreachable }
    }
}

impl Search<'_> {
    fn stmts(&mut self, stmts: &[Stmt]) {
        for stmt in stmts {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Expr(expr) => self.expr(*expr),
            StmtKind::Block(inner) => self.stmts(inner),
            StmtKind::If { condition, then, otherwise } => {
                let (holds, fails) = self.condition(Some(*condition));
                self.flow = holds;
                self.stmts(then);
                let behind = std::mem::replace(&mut self.flow, fails);
                self.stmts(otherwise);
                self.flow.join(&behind);
            }
            StmtKind::Loop { condition, test, body, step } => {
                self.in_loop(|search| search.iteration(*condition, *test, body, *step));
            }
            StmtKind::Switch { value, has_default, body, .. } => {
                self.expr(*value);
                let cases = std::mem::replace(&mut self.flow, Flow::Unreachable);
                self.exits.push(Exits::new(Some(cases)));
                self.stmts(body);
                let Some(Exits { cases: Some(cases), breaks, .. }) = self.exits.pop() else { return };
                self.flow.join(&breaks);
                if !has_default {
                    self.flow.join(&cases);
                }
            }
            StmtKind::Case(_) | StmtKind::DefaultCase => {
                if let Some(cases) = self.exits.iter().rev().find_map(|exits| exits.cases.as_ref()) {
                    self.flow.join(cases);
                }
            }
            StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::GotoAddress(_) => {
                self.leave(&stmt.kind);
            }
            StmtKind::Label(_) | StmtKind::Goto(_) => {}
        }
    }

    /// Handles a statement after which control continues elsewhere.
    fn leave(&mut self, kind: &StmtKind) {
        if let StmtKind::Return(Some(value)) | StmtKind::GotoAddress(value) = kind {
            self.expr(*value);
        }
        let flow = std::mem::replace(&mut self.flow, Flow::Unreachable);
        let meeting = match kind {
            StmtKind::Break => self.exits.last_mut().map(|exits| &mut exits.breaks),
            StmtKind::Continue => {
                let inner_loop = self.exits.iter_mut().rev().find(|exits| exits.cases.is_none());
                inner_loop.map(|exits| &mut exits.continues)
            }
            _ => None,
        };
        if let Some(meeting) = meeting {
            meeting.join(&flow);
        }
    }

    /// Analyses a loop: the facts at the start of the first iteration hold in all.
    fn iteration(&mut self, condition: Option<ExprId>, test: LoopTest, body: &[Stmt], step: Option<ExprId>) {
        self.exits.push(Exits::new(None));
        let before = (test == LoopTest::Before).then(|| self.condition(condition));
        let mut behind = Flow::Unreachable;
        if let Some((holds, fails)) = before {
            (self.flow, behind) = (holds, fails);
        }
        self.stmts(body);
        if let Some(exits) = self.exits.last() {
            self.flow.join(&exits.continues);
        }
        step.into_iter().for_each(|step| self.expr(step));
        if test == LoopTest::Behind {
            behind = self.condition(condition).1;
        }
        if let Some(exits) = self.exits.pop() {
            behind.join(&exits.breaks);
        }
        self.flow = behind;
    }

    /// A condition, or none, which is always true: the locals stored in if it holds, and if it does not.
    fn condition(&mut self, condition: Option<ExprId>) -> (Flow, Flow) {
        let Some(condition) = condition else { return (self.flow.clone(), Flow::Unreachable) };
        match self.function.exprs[condition].kind {
            ExprKind::And(a, b) => {
                let (holds, mut fails) = self.condition(Some(a));
                self.flow = holds;
                let (holds, other) = self.condition(Some(b));
                fails.join(&other);
                (holds, fails)
            }
            ExprKind::Or(a, b) => {
                let (mut holds, fails) = self.condition(Some(a));
                self.flow = fails;
                let (other, fails) = self.condition(Some(b));
                holds.join(&other);
                (holds, fails)
            }
            ExprKind::Unary(UnaryOp::Not, value) => {
                let (holds, fails) = self.condition(Some(value));
                (fails, holds)
            }
            _ => {
                self.expr(condition);
                (self.flow.clone(), self.flow.clone())
            }
        }
    }

    /// Analyses the body of a loop: a local that is stored in later in the body may be read earlier in the next
    /// iteration, unless the path to that store passes a read.
    fn in_loop(&mut self, body: impl FnOnce(&mut Self)) {
        let known: BTreeSet<_> = self.suspects.keys().copied().collect();
        body(self);
        let stored = &self.stored_unread;
        self.suspects.retain(|local, _| known.contains(local) || !stored.contains(local));
    }

    fn expr(&mut self, expr: ExprId) {
        // A long sum is nested on the left: its spine is walked iteratively.
        let mut spine = Vec::new();
        let mut first = expr;
        while let ExprKind::Binary(_, a, b) | ExprKind::Compare(_, a, b) | ExprKind::Comma(a, b) =
            self.function.exprs[first].kind
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
                // `sum = sum + x` is an update, too.
                if self.adds_to(*place, *value) { self.update(*place) } else { self.store(*place) }
            }
            ExprKind::Update(update) => {
                self.read(update.place);
                self.expr(update.operand);
                self.update(update.place);
            }
            ExprKind::Copy { to, from } => {
                self.place(*to);
                self.place(*from);
            }
            ExprKind::Unary(_, value) | ExprKind::Convert(value) => self.expr(*value),
            ExprKind::And(..) | ExprKind::Or(..) => {
                let (holds, fails) = self.condition(Some(expr));
                self.flow = holds;
                self.flow.join(&fails);
            }
            ExprKind::Conditional(test, a, b) => {
                let (holds, fails) = self.condition(Some(*test));
                self.flow = holds;
                self.expr(*a);
                let behind = std::mem::replace(&mut self.flow, fails);
                self.expr(*b);
                self.flow.join(&behind);
            }
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
            ExprKind::Binary(_, a, b) | ExprKind::Compare(_, a, b) | ExprKind::Comma(a, b) => {
                self.expr(*a);
                self.expr(*b);
            }
        }
    }

    /// Analyses the expressions that compute a place.
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
        if entry.in_memory || entry.name.is_empty() {
            return;
        }
        let span = self.function.places[place].span;
        if !self.stored.contains(&local) {
            self.suspects.entry(local).or_insert(span);
            self.flow.read(local);
        }
        if !self.flow.is_stored(local) {
            self.doubtful.entry(local).or_insert(span);
        }
    }

    /// Reports whether a value is computed from the place's value by sums, differences or products, on every path.
    fn adds_to(&self, place: PlaceId, value: ExprId) -> bool {
        match self.function.exprs[value].kind {
            ExprKind::Load(from) => {
                let local = |place| match self.function.places[place].kind {
                    PlaceKind::Local(local, 0) => Some(local),
                    _ => None,
                };
                local(from).is_some() && local(from) == local(place)
            }
            ExprKind::Binary(_, a, b) => self.adds_to(place, a) || self.adds_to(place, b),
            ExprKind::Convert(inner) => self.adds_to(place, inner),
            _ => false,
        }
    }

    fn store(&mut self, place: PlaceId) {
        if let PlaceKind::Local(local, _) = self.function.places[place].kind {
            self.stored_in(local);
        }
    }

    /// Leaves a place without a value that had none before an update.
    fn update(&mut self, place: PlaceId) {
        if let PlaceKind::Local(local, _) = self.function.places[place].kind {
            self.flow.store(local);
        }
    }

    fn stored_in(&mut self, local: LocalId) {
        self.stored.insert(local);
        if !self.flow.is_read(local) {
            self.stored_unread.insert(local);
        }
        self.flow.store(local);
    }
}
