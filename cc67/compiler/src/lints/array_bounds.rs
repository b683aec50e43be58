//! Accesses beyond the end of an array.
//!
//! Only whole objects count: programs access the next member after a member array on purpose. A variable index is
//! followed through the simplest loops, where every iteration is known, and into the parameters of functions.

use std::collections::BTreeMap;

use super::program::{AnalysedProgram, PERSIST};
use super::user_data_index;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::TypeId;
use crate::typed::{
    Callee, Expr, ExprId, ExprKind, Function, LocalId, LoopTest, PlaceId, PlaceKind, Stmt, StmtKind, SymbolId,
};

/// Reports loads and stores outside arrays, at constant indexes and in loops that count.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let reached = reached(program);
    for function in program.whole_functions() {
        let search = Search { program, function, reached: &reached };
        for place in function.exprs.values().flat_map(|expr| accesses(function, &expr.kind)) {
            sink.report_if(search.finding(place, &[]));
        }
        for expr in function.exprs.values() {
            search.call(expr, &[], sink);
        }
        search.loops(&function.body, sink);
        function.each_stmt(&mut |stmt| match &stmt.kind {
            StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => {
                search.loops(body, sink);
            }
            StmtKind::If { then, otherwise, .. } => {
                search.loops(then, sink);
                search.loops(otherwise, sink);
            }
            _ => {}
        });
    }
}

/// The places that an expression itself reads or writes.
fn accesses(function: &Function, kind: &ExprKind) -> impl Iterator<Item = PlaceId> {
    let places = match kind {
        ExprKind::Load(place) | ExprKind::Assign(place, _) => [Some(*place), None],
        ExprKind::Update(update) => [Some(update.place), None],
        ExprKind::Copy { to, from } => [Some(*to), Some(*from)],
        _ => [None, None],
    };
    places.into_iter().flatten().map(|place| match function.places[place].kind {
        PlaceKind::Bits(unit, _) => unit,
        _ => place,
    })
}

/// An object with its own address.
#[derive(Clone, Copy)]
enum Object {
    Local(LocalId),
    Symbol(SymbolId),
}

/// A loop counter: its value in the first iteration of a loop, and in the last.
#[derive(Clone, Copy)]
struct Counter {
    local: LocalId,
    first: i64,
    last: i64,
}

impl Counter {
    /// The values of counters in their first iterations, and in their last.
    fn values(counters: &[Self]) -> [Vec<Value>; 2] {
        let values = |value: fn(&Self) -> i64| counters.iter().map(|one| (one.local, value(one))).collect();
        [values(|counter| counter.first), values(|counter| counter.last)]
    }
}

/// A local whose value is known.
type Value = (LocalId, i64);

/// An argument of a call: its value in the first iteration of a loop around the call, and in the last.
#[derive(Clone, Copy)]
struct Passed {
    /// The parameter.
    local: LocalId,
    first: i64,
    last: i64,
    call: Span,
}

/// A function of the program, and the places that it always reaches, each by the value of a parameter.
struct Reached<'a> {
    function: &'a Function,
    places: Vec<(LocalId, PlaceId)>,
}

/// The functions of a program that always reach an element by the value of a parameter.
fn reached<'a>(program: &AnalysedProgram<'a>) -> BTreeMap<SymbolId, Reached<'a>> {
    let nothing = BTreeMap::new();
    let functions = program.whole_functions().filter(|function| !function.parameters.is_empty());
    let reached = functions.filter_map(|function| {
        let search = Search { program, function, reached: &nothing };
        let places = search.reached();
        (!places.is_empty()).then_some((function.symbol, Reached { function, places }))
    });
    reached.collect()
}

struct Search<'a> {
    program: &'a AnalysedProgram<'a>,
    function: &'a Function,
    reached: &'a BTreeMap<SymbolId, Reached<'a>>,
}

impl Search<'_> {
    /// Reports accesses in the loops of `stmts` that are made in every iteration.
    fn loops(&self, stmts: &[Stmt], sink: &mut Sink) {
        for [before, stmt] in stmts.array_windows() {
            let StmtKind::Loop { condition: Some(condition), test: LoopTest::Before, body, step: Some(step) } =
                &stmt.kind
            else {
                continue;
            };
            let Some(counter) = self.counter(before, *condition, *step) else { continue };
            if is_plain(body) && !self.changes(body, counter.local) {
                self.iterations(body, &[counter], sink);
            }
        }
    }

    /// Hands over the counting loops of `stmts` that are always executed, with their counters.
    fn inner_loops<'s>(&self, stmts: &'s [Stmt], visit: &mut dyn FnMut(Counter, &'s [Stmt])) {
        for stmt in stmts {
            if let StmtKind::Block(inner) = &stmt.kind {
                self.inner_loops(inner, visit);
            }
        }
        for [before, stmt] in stmts.array_windows() {
            let StmtKind::Loop { condition: Some(condition), test: LoopTest::Before, body, step: Some(step) } =
                &stmt.kind
            else {
                continue;
            };
            let counter = self.counter(before, *condition, *step);
            if let Some(counter) = counter.filter(|counter| !self.changes(body, counter.local)) {
                visit(counter, body);
            }
        }
    }

    /// The counter of `for (i = 0; i < 8; i++)`.
    fn counter(&self, before: &Stmt, condition: ExprId, step: ExprId) -> Option<Counter> {
        let exprs = &self.function.exprs;
        let (StmtKind::Expr(start), ExprKind::Update(update)) = (&before.kind, &exprs[step].kind) else {
            return None;
        };
        let ExprKind::Assign(place, start) = exprs[*start].kind else { return None };
        let ExprKind::Compare(op, tested, end) = exprs[condition].kind else { return None };
        let local = self.register(place)?;
        let (ExprKind::Int(first), ExprKind::Int(end), ExprKind::Int(step)) =
            (&exprs[start].kind, &exprs[end].kind, &exprs[update.operand].kind)
        else {
            return None;
        };
        let last = match op {
            CompareOp::Less => end - 1,
            CompareOp::LessEqual => *end,
            CompareOp::Equal | CompareOp::NotEqual | CompareOp::Greater | CompareOp::GreaterEqual => {
                return None;
            }
        };
        let counts = update.op == BinaryOp::Add && self.register(update.place) == Some(local) && *step > 0;
        if !counts || self.loaded(tested) != Some(local) || last < *first {
            return None;
        }
        Some(Counter { local, first: *first, last: last - (last - first) % step })
    }

    /// The places that a call of the function always reaches, each by the value of a parameter that never changes.
    fn reached(&self) -> Vec<(LocalId, PlaceId)> {
        let body = &self.function.body;
        let always = body.iter().take_while(|stmt| is_plain(std::slice::from_ref(stmt))).count();
        let parameters: Vec<_> =
            self.function.parameters.iter().copied().filter(|local| !self.changes(body, *local)).collect();
        let mut places = Vec::new();
        Walk { function: self.function, extent: Extent::Always }.stmts(&body[..always], &mut |expr| {
            for place in accesses(self.function, &self.function.exprs[expr].kind) {
                let depends = |local: &LocalId| {
                    self.target(place, &[]).is_none() && self.target(place, &[(*local, 0)]).is_some()
                };
                places.extend(parameters.iter().copied().filter(depends).map(|local| (local, place)));
            }
        });
        places
    }

    /// Reports accesses of a called function outside an array, by its arguments.
    fn call(&self, expr: &Expr, counters: &[Counter], sink: &mut Sink) {
        let ExprKind::Call(call) = &expr.kind else { return };
        let Callee::Symbol(callee) = call.callee else { return };
        let Some(Reached { function, places }) = self.reached.get(&callee) else { return };
        let callee = Search { function, ..*self };
        for (local, place) in places {
            let at = function.parameters.iter().position(|parameter| parameter == local);
            let Some(argument) = at.and_then(|at| call.arguments.get(at)) else { continue };
            let [Some(first), Some(last)] =
                Counter::values(counters).map(|values| self.number(*argument, &values))
            else {
                continue;
            };
            // A constant is looked at without a loop.
            if !counters.is_empty() && first == last {
                continue;
            }
            let passed = Passed { local: *local, first, last, call: expr.span };
            sink.report_if(callee.finding_of_call(*place, passed));
        }
    }

    /// The local that a place consists of, if only this function can change it.
    fn register(&self, place: PlaceId) -> Option<LocalId> {
        match self.function.places[place].kind {
            PlaceKind::Local(local, 0) if !self.function.locals[local].in_memory => Some(local),
            _ => None,
        }
    }

    /// The local whose value an expression loads.
    fn loaded(&self, expr: ExprId) -> Option<LocalId> {
        match self.function.exprs[expr].kind {
            ExprKind::Load(place) => self.register(place),
            ExprKind::Convert(inner) => self.loaded(inner),
            _ => None,
        }
    }

    /// Reports whether something in `body` writes `local`.
    fn changes(&self, body: &[Stmt], local: LocalId) -> bool {
        let mut found = false;
        Walk { function: self.function, extent: Extent::All }.stmts(body, &mut |expr| {
            let kind = &self.function.exprs[expr].kind;
            found |= match kind {
                ExprKind::Assign(place, _) => self.register(*place) == Some(local),
                ExprKind::Update(update) => self.register(update.place) == Some(local),
                ExprKind::Statements(..) => true,
                _ => false,
            };
        });
        found
    }

    /// Reports accesses of every iteration that are outside an array in the first or last one.
    fn iterations(&self, body: &[Stmt], counters: &[Counter], sink: &mut Sink) {
        // What depends on inner loops alone is reported with these.
        let [_, inner @ ..] = counters else { return };
        let [inner, _] = Counter::values(inner);
        Walk { function: self.function, extent: Extent::Always }.stmts(body, &mut |expr| {
            for place in accesses(self.function, &self.function.exprs[expr].kind) {
                if inner.is_empty() || self.target(place, &inner).is_none() {
                    sink.report_if(self.finding(place, counters));
                }
            }
            if inner.is_empty() {
                self.call(&self.function.exprs[expr], counters, sink);
            }
        });
        self.inner_loops(body, &mut |counter, body| {
            self.iterations(body, &[counters, &[counter]].concat(), sink);
        });
    }

    /// The message for an access to `place`, in the first and the last iterations of counters or without any.
    fn finding(&self, place: PlaceId, counters: &[Counter]) -> Option<Diagnostic> {
        let [first, last] = Counter::values(counters);
        let (object, from) = self.target(place, &first)?;
        let (_, to) = self.target(place, &last)?;
        if !counters.is_empty() && from == to {
            return None;
        }
        if let Some(finding) = self.user_data(object, place, from, to).filter(|_| !counters.is_empty()) {
            return Some(finding);
        }
        let (finding, wrong) = self.outside(place, object, [to, from])?;
        let (values, iteration) = if wrong == to { (last, "last") } else { (first, "first") };
        let is = |(local, value): &Value| format!("`{}` is {value}", self.function.locals[*local].name);
        Some(match values.as_slice() {
            [] => finding,
            [one] => finding.note(format!("{} in the {iteration} iteration of the loop", is(one))),
            all => {
                let all: Vec<_> = all.iter().map(is).collect();
                finding.note(format!("{} in the {iteration} iterations of the loops", all.join(" and ")))
            }
        })
    }

    /// The message for an access to `place` in a call.
    fn finding_of_call(&self, place: PlaceId, passed: Passed) -> Option<Diagnostic> {
        let Passed { local, first, last, call } = passed;
        let (object, from) = self.target(place, &[(local, first)])?;
        let (_, to) = self.target(place, &[(local, last)])?;
        let (finding, wrong) = self.outside(place, object, [to, from])?;
        let name = &self.function.locals[local].name;
        Some(if first == last {
            finding.label(call, format!("`{name}` is {first} in this call"))
        } else {
            let (value, iteration) = if wrong == to { (last, "last") } else { (first, "first") };
            finding.label(call, format!("`{name}` is {value} in the {iteration} iteration of this loop"))
        })
    }

    /// The message for an access at one of two offsets of an object if it is outside of the object, and that offset.
    fn outside(&self, place: PlaceId, object: Object, at: [i64; 2]) -> Option<(Diagnostic, i64)> {
        let (name, ty) = self.named(object)?;
        let types = &self.program.unit.types;
        let (element, length) = types.array(ty)?;
        let element = i64::from(types.size_of(element.ty)?.max(1));
        let size = i64::from(types.size_of(self.function.places[place].ty)?.max(1));
        let end = element * i64::from(length?);
        let wrong = at.into_iter().find(|at| *at < 0 || at + size > end)?;
        // If an access begins inside, the rest is after the end.
        let index = if wrong < 0 { wrong } else { wrong.max(end) }.div_euclid(element);
        let message = format!("`{name}` has no element {index}");
        let has =
            length?.checked_sub(1).map_or("it has none".to_owned(), |last| format!("it has 0 to {last}"));
        let span = self.function.places[place].span;
        Some((Diagnostic::warning(Lint::ArrayBounds, span, message).at(has), wrong))
    }

    /// The message for a loop from an element of `persist.UserData` to one that does not exist.
    fn user_data(&self, object: Object, place: PlaceId, from: i64, to: i64) -> Option<Diagnostic> {
        let Object::Symbol(symbol) = object else { return None };
        let (from, to) = (i32::try_from(from).ok()?, i32::try_from(to).ok()?);
        let place = &self.function.places[place];
        let size = self.program.unit.types.size_of(place.ty)?;
        user_data_index::finding(from, to, size, place.span).filter(|_| self.program.name(symbol) == PERSIST)
    }

    /// The object that a place lies in or beside, and the byte of it, with locals as numbers.
    fn target(&self, place: PlaceId, values: &[Value]) -> Option<(Object, i64)> {
        match self.function.places[place].kind {
            PlaceKind::Local(local, offset) => Some((Object::Local(local), offset.into())),
            PlaceKind::Symbol(symbol, offset) => Some((Object::Symbol(symbol), offset.into())),
            PlaceKind::Pointer(pointer, offset) => {
                let (object, at) = self.pointed(pointer, values)?;
                Some((object, at + i64::from(offset)))
            }
            PlaceKind::Bits(..) => None,
        }
    }

    fn pointed(&self, pointer: ExprId, values: &[Value]) -> Option<(Object, i64)> {
        match self.function.exprs[pointer].kind {
            ExprKind::Address(place) => self.target(place, values),
            ExprKind::Convert(inner) => self.pointed(inner, values),
            ExprKind::Binary(BinaryOp::Add, base, bytes) => {
                let (object, at) = self.pointed(base, values)?;
                Some((object, at + self.number(bytes, values)?))
            }
            _ => None,
        }
    }

    /// The value of an expression of constants and of locals that are known.
    fn number(&self, expr: ExprId, values: &[Value]) -> Option<i64> {
        match self.function.exprs[expr].kind {
            ExprKind::Int(number) => Some(number),
            ExprKind::Convert(inner) => self.number(inner, values),
            ExprKind::Load(_) => {
                let local = self.loaded(expr)?;
                values.iter().find(|(known, _)| *known == local).map(|(_, number)| *number)
            }
            ExprKind::Binary(op, a, b) => op.exactly(self.number(a, values)?, self.number(b, values)?),
            _ => None,
        }
    }

    /// Name and type of an object that is not the firmware's.
    fn named(&self, object: Object) -> Option<(&str, TypeId)> {
        match object {
            Object::Local(local) => {
                let local = &self.function.locals[local];
                Some((local.name.as_str(), local.ty)).filter(|(name, _)| !name.is_empty())
            }
            Object::Symbol(symbol) => {
                let symbol = &self.program.unit.symbols[symbol];
                (!symbol.is_anonymous()).then_some((symbol.name.as_str(), symbol.ty))
            }
        }
    }
}

/// Reports whether every iteration of a loop with this body goes from its beginning to its end.
fn is_plain(body: &[Stmt]) -> bool {
    body.iter().all(|stmt| match &stmt.kind {
        StmtKind::Expr(_) | StmtKind::Case(_) | StmtKind::DefaultCase => true,
        StmtKind::Block(inner)
        | StmtKind::Loop { body: inner, .. }
        | StmtKind::Switch { body: inner, .. } => is_plain(inner),
        StmtKind::If { then, otherwise, .. } => is_plain(then) && is_plain(otherwise),
        StmtKind::Break
        | StmtKind::Continue
        | StmtKind::Return(_)
        | StmtKind::Label(_)
        | StmtKind::Goto(_)
        | StmtKind::GotoAddress(_) => false,
    })
}
