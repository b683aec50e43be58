//! Loops that never end and do nothing: the thread spends its slices on them forever. Also `while (!ReadBit(n) && now - start <
//! 5)`, a time-out that does not come because nothing in the loop changes `now`.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, Stmt, StmtKind};

/// Reports `for (;;) ;` and `while (n) ;`, if nothing changes `n`.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        function.each_stmt(&mut |stmt| {
            sink.report_if(finding(function, stmt).or_else(|| dead_time_out(program, function, stmt)));
        });
    }
}

fn finding(function: &Function, stmt: &Stmt) -> Option<Diagnostic> {
    let StmtKind::Loop { condition, body, step, .. } = &stmt.kind else { return None };
    let mut effects = Effects { function, read: BTreeSet::new(), written: BTreeSet::new() };
    let is_idle = condition.is_none_or(|condition| effects.is_pure(condition))
        && body.iter().all(|stmt| effects.is_idle(stmt))
        && step.is_none_or(|step| effects.is_pure(step));
    if !is_idle {
        return None;
    }
    let help = "end the program by returning from `main`, or call `WaitNextTimeSlice()` in the loop";
    let Some(condition) = condition else {
        let message = "this loop does nothing and never ends";
        return Some(Diagnostic::warning(Lint::IdleLoop, stmt.span, message).help(help));
    };
    let mut tested = Effects { function, read: BTreeSet::new(), written: BTreeSet::new() };
    tested.is_pure(*condition);
    if !tested.read.is_disjoint(&effects.written) {
        return None;
    }
    let name = &function.locals[*tested.read.first()?].name;
    let message = format!("this loop only tests `{name}`, which nothing in it changes");
    Some(
        Diagnostic::warning(Lint::IdleLoop, function.exprs[*condition].span, message)
            .at("the same in every iteration")
            .help("no other thread sees a local variable; wait for a global or an element of `persist.UserData`"),
    )
}

/// A part of a loop's condition that compares the difference of two local numbers, which nothing in the loop changes.
fn dead_time_out(program: &AnalysedProgram<'_>, function: &Function, stmt: &Stmt) -> Option<Diagnostic> {
    let StmtKind::Loop { condition: Some(condition), body, step, .. } = &stmt.kind else { return None };
    let (compared, names) = conjuncts(function, *condition)
        .into_iter()
        .find_map(|part| Some((part, difference(function, part)?)))?;
    let mut is_changed = false;
    let walk = Walk { function, extent: Extent::All };
    let mut look = |expr: ExprId| {
        let place = match &function.exprs[expr].kind {
            ExprKind::Assign(place, _) => *place,
            ExprKind::Update(update) => update.place,
            _ => return,
        };
        is_changed |=
            matches!(function.places[place].kind, PlaceKind::Local(local, _) if names.contains(&local));
    };
    walk.expr(*condition, &mut look);
    step.iter().for_each(|step| walk.expr(*step, &mut look));
    walk.stmts(body, &mut look);
    let is_alone = compared == *condition;
    if is_changed || is_alone {
        return None;
    }
    let span = function.exprs[compared].span;
    let text = String::from_utf8_lossy(program.sources.text(span));
    let [one, two] = names.map(|local| &function.locals[local].name);
    let message =
        format!("`{text}` is the same in every iteration: nothing in this loop changes `{one}` or `{two}`");
    Some(
        Diagnostic::warning(Lint::IdleLoop, span, message)
            .at("so this does not end the loop")
            .help("read the time again in the loop, as in `Time_sec() - start < 5`"),
    )
}

/// The parts of a condition that all have to hold.
fn conjuncts(function: &Function, condition: ExprId) -> Vec<ExprId> {
    match function.exprs[condition].kind {
        ExprKind::And(a, b) => [conjuncts(function, a), conjuncts(function, b)].concat(),
        _ => vec![condition],
    }
}

/// The two locals whose difference is compared with something.
fn difference(function: &Function, part: ExprId) -> Option<[LocalId; 2]> {
    let ExprKind::Compare(_, a, _) = function.exprs[part].kind else { return None };
    let ExprKind::Binary(BinaryOp::Subtract, one, two) = function.exprs[a].kind else { return None };
    let local = |side: ExprId| match function.exprs[side].kind {
        ExprKind::Load(place) => match function.places[place].kind {
            PlaceKind::Local(local, 0) => Some(local).filter(|local| !function.locals[*local].in_memory),
            _ => None,
        },
        _ => None,
    };
    function.exprs[a].ty.is_floating().then_some([local(one)?, local(two)?])
}

/// The effects of a piece of a function on its locals in registers.
struct Effects<'a> {
    function: &'a Function,
    read: BTreeSet<LocalId>,
    written: BTreeSet<LocalId>,
}

impl Effects<'_> {
    /// Reports whether a statement has no other effect and does not leave its loop.
    fn is_idle(&mut self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Expr(expr) => self.is_pure(*expr),
            StmtKind::Block(inner) => inner.iter().all(|stmt| self.is_idle(stmt)),
            StmtKind::If { condition, then, otherwise } => {
                self.is_pure(*condition) && then.iter().chain(otherwise).all(|stmt| self.is_idle(stmt))
            }
            StmtKind::Continue => true,
            _ => false,
        }
    }

    /// Reports whether an expression reads nothing else and has no other effect.
    fn is_pure(&mut self, expr: ExprId) -> bool {
        match &self.function.exprs[expr].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => true,
            ExprKind::Load(place) => self.register(*place).is_some_and(|local| {
                self.read.insert(local);
                true
            }),
            ExprKind::Update(update) => self.is_pure(update.operand) && self.writes(update.place),
            ExprKind::Assign(place, value) => self.is_pure(*value) && self.writes(*place),
            ExprKind::Unary(_, value) | ExprKind::Convert(value) => self.is_pure(*value),
            ExprKind::Binary(_, a, b)
            | ExprKind::Compare(_, a, b)
            | ExprKind::And(a, b)
            | ExprKind::Or(a, b)
            | ExprKind::Comma(a, b) => self.is_pure(*b) && self.is_pure(*a),
            _ => false,
        }
    }

    fn writes(&mut self, place: PlaceId) -> bool {
        self.register(place).is_some_and(|local| {
            self.written.insert(local);
            true
        })
    }

    /// The local that a place consists of, if only this function can change it.
    fn register(&self, place: PlaceId) -> Option<LocalId> {
        match self.function.places[place].kind {
            PlaceKind::Local(local, _) => (!self.function.locals[local].in_memory).then_some(local),
            _ => None,
        }
    }
}
