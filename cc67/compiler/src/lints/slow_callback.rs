//! A call-back of the servo interrupt that takes more time than the servo leaves.
//!
//! The estimate is for one pass: the cycles of the called firmware functions on the board (`costs.md` section 2), and a
//! few cycles for each operation of the program; a loop counts with its iterations if their number is constant,
//! otherwise once. So it is a lower bound if the call-back does not return early; `cc67 cycles` counts the packets.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::firmware::row_named;

use super::call_back_wait::call_backs;
use super::call_graph::CallGraph;
use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::typed::{
    Callee, ExprId, ExprKind, Function, LoopTest, PlaceId, PlaceKind, Stmt, StmtKind, SymbolId,
};

/// Cycles between two interrupts: 90 µs at 200 MHz.
const TICK: u64 = 18_000;
/// Cycles of the interrupt with eight moving axes (`costs.md` section 5), and the cycles that are left for a call-back.
const SERVO: u64 = 10_974;
const LEFT: u64 = TICK - SERVO;
/// Cycles of an operation of the program, and of a call without its callee.
const OPERATION: u64 = 2;
const CALL: u64 = 14;
/// Cycles of a microsecond.
const MICROSECOND: u64 = 200;

/// Reports call-backs that take longer than the servo of a KFLOP leaves; the times of other boards are unknown.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    if !program.firmware.board().is_proven {
        return;
    }
    let graph = CallGraph::new(program);
    for root in call_backs(program) {
        let Some(function) = graph.function(root) else { continue };
        let mut estimate = Estimate { program, graph: &graph, known: BTreeMap::new(), open: BTreeSet::new() };
        let cycles = estimate.function(root);
        if cycles <= LEFT {
            continue;
        }
        let message = format!(
            "the call-back `{}` takes about {cycles} cycles, {} µs, in each servo interrupt",
            program.name(root),
            cycles / MICROSECOND
        );
        let note = format!(
            "{LEFT} of the {TICK} cycles between two interrupts are left where eight axes move; threads stop meanwhile"
        );
        let mut diagnostic = Diagnostic::warning(Lint::SlowCallback, function.span, message)
            .at("the servo is late if it does")
            .note(note);
        if let Some(slowest) = estimate.slowest(function) {
            diagnostic = diagnostic.note(slowest);
        }
        sink.report(diagnostic.help("compute in a thread, and read the result here"));
    }
}

/// The estimated time of functions, in cycles.
struct Estimate<'a> {
    program: &'a AnalysedProgram<'a>,
    graph: &'a CallGraph<'a>,
    known: BTreeMap<SymbolId, u64>,
    /// The functions being analysed: a recursive one counts once.
    open: BTreeSet<SymbolId>,
}

impl Estimate<'_> {
    /// Cycles of a call of a function.
    fn function(&mut self, symbol: SymbolId) -> u64 {
        if let Some(known) = self.known.get(&symbol) {
            return *known;
        }
        let cycles = match self.graph.function(symbol) {
            Some(_) if !self.open.insert(symbol) => return 0,
            Some(function) => self.stmts(function, &function.body),
            None => firmware(self.program.name(symbol)),
        };
        self.open.remove(&symbol);
        self.known.insert(symbol, cycles);
        cycles
    }

    fn stmts(&mut self, function: &Function, stmts: &[Stmt]) -> u64 {
        let mut sum: u64 = 0;
        for (index, stmt) in stmts.iter().enumerate() {
            let before = index.checked_sub(1).and_then(|before| stmts.get(before));
            sum = sum.saturating_add(self.stmt(function, stmt, before));
        }
        sum
    }

    /// Cycles of a statement; `before` is the previous statement.
    fn stmt(&mut self, function: &Function, stmt: &Stmt, before: Option<&Stmt>) -> u64 {
        match &stmt.kind {
            StmtKind::Expr(expr) | StmtKind::Return(Some(expr)) | StmtKind::GotoAddress(expr) => {
                self.expr(function, *expr)
            }
            StmtKind::Block(body) => self.stmts(function, body),
            StmtKind::If { condition, then, otherwise } => {
                let ways = [then, otherwise].map(|way| self.stmts(function, way));
                self.expr(function, *condition).saturating_add(ways[0].max(ways[1]))
            }
            StmtKind::Loop { condition, body, step, .. } => {
                let parts = condition.iter().chain(step).map(|expr| self.expr(function, *expr));
                let iteration = parts.sum::<u64>().saturating_add(self.stmts(function, body));
                iteration.saturating_mul(iterations(function, stmt, before))
            }
            // Only one of the cases is executed, and the longest is unknown.
            StmtKind::Switch { value, .. } => self.expr(function, *value),
            _ => 0,
        }
    }

    fn expr(&mut self, function: &Function, expr: ExprId) -> u64 {
        let mut sum: u64 = 0;
        Walk { function, extent: Extent::All }.expr(expr, &mut |part| {
            sum = sum.saturating_add(match &function.exprs[part].kind {
                ExprKind::Int(_) | ExprKind::Float(_) => 0,
                ExprKind::Call(call) => match call.callee {
                    Callee::Symbol(callee) => self.function(callee).saturating_add(CALL),
                    Callee::Pointer(_) => CALL,
                },
                _ => OPERATION,
            });
        });
        sum
    }

    /// Describes the slowest of the functions that a function calls.
    fn slowest(&self, function: &Function) -> Option<String> {
        let called = function.calls().filter_map(|(_, call)| match call.callee {
            Callee::Symbol(callee) => Some((self.known.get(&callee).copied()?, callee)),
            Callee::Pointer(_) => None,
        });
        let (cycles, callee) = called.max()?;
        Some(format!("a call of `{}` takes about {cycles}", self.program.name(callee)))
    }
}

/// The cycles of a firmware function on the board, without waiting.
fn firmware(name: &str) -> u64 {
    row_named(name).map_or(0, |function| function.cost.get().max(0).unsigned_abs())
}

/// Number of iterations of a loop whose counter is incremented from a constant to a constant; 1 for any other loop.
fn iterations(function: &Function, stmt: &Stmt, before: Option<&Stmt>) -> u64 {
    let StmtKind::Loop { condition: Some(condition), test: LoopTest::Before, step: Some(step), .. } =
        &stmt.kind
    else {
        return 1;
    };
    let ExprKind::Compare(op, a, b) = &function.exprs[*condition].kind else { return 1 };
    let ExprKind::Update(update) = &function.exprs[*step].kind else { return 1 };
    let (Some(counter), Some(limit)) = (read(function, *a), number(function, *b)) else { return 1 };
    let is_counter = |place: PlaceId| function.places[place].kind == function.places[counter].kind;
    let first = before.and_then(|before| match before.kind {
        StmtKind::Expr(expr) => match function.exprs[expr].kind {
            ExprKind::Assign(place, value) if is_counter(place) => number(function, value),
            _ => None,
        },
        _ => None,
    });
    if !is_counter(update.place) || number(function, update.operand) != Some(1) {
        return 1;
    }
    let end = match op {
        CompareOp::Less | CompareOp::NotEqual => limit,
        CompareOp::LessEqual => limit.saturating_add(1),
        CompareOp::Equal | CompareOp::Greater | CompareOp::GreaterEqual => return 1,
    };
    first.map_or(1, |first| u64::try_from(end.saturating_sub(first)).unwrap_or(0))
}

/// The local that an expression reads.
fn read(function: &Function, expr: ExprId) -> Option<PlaceId> {
    match function.exprs[expr].kind {
        ExprKind::Load(place) if matches!(function.places[place].kind, PlaceKind::Local(..)) => Some(place),
        ExprKind::Convert(value) => read(function, value),
        _ => None,
    }
}

fn number(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(value) => Some(value),
        ExprKind::Convert(value) => number(function, value),
        _ => None,
    }
}
