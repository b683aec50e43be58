//! `for (i = 0; i == 7; i++)`, which never begins, `for (i = 0; i < 7; i--)`, which counts away from its end, and
//! `for (x = 0; x != 1; x += 0.1)`, which steps over it; `while (CheckDone(0));`, which waits while the axis rests;
//! `while (ch0->Position != 1000);`, which a measured position hardly ever ends, and `while (persist.UserData[100] != 0);`,
//! which an error of the PC does not end.

use kmotiondef::firmware::Function as FirmwareFunction;
use kmotiondef::structs::Chan;

use super::program::{AnalysedProgram, CHANNELS, axis_of_pointer};
use super::user_data_type;
use super::wait_for_any::{called, is_check_done};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::typed::{ExprId, ExprKind, Function, LocalId, LoopTest, PlaceId, PlaceKind, Stmt, StmtKind};

/// Functions that only let time pass.
const PAUSES: [&str; 2] = [FirmwareFunction::WaitNextTimeSlice.name(), FirmwareFunction::Delay_sec.name()];

/// Reports `for` loops whose first test fails, or whose step does not lead to the end, and loops that wait while an
/// axis is at rest.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        loops(function, &function.body, sink);
        function.each_stmt(&mut |stmt| match &stmt.kind {
            StmtKind::Loop { condition, body, .. } => {
                sink.report_if(
                    condition.and_then(|condition| waits_at_rest(program, function, condition, body)),
                );
                sink.report_if(condition.and_then(|condition| waits_for_exact(program, function, condition)));
                sink.report_if(
                    condition.and_then(|condition| waits_for_0(program, function, condition, body)),
                );
                loops(function, body, sink);
            }
            StmtKind::Block(body) | StmtKind::Switch { body, .. } => loops(function, body, sink),
            StmtKind::If { then, otherwise, .. } => {
                loops(function, then, sink);
                loops(function, otherwise, sink);
            }
            _ => {}
        });
    }
}

fn loops(function: &Function, stmts: &[Stmt], sink: &mut Sink) {
    for [before, stmt] in stmts.array_windows() {
        let StmtKind::Loop { condition: Some(condition), test: LoopTest::Before, step: Some(step), .. } =
            stmt.kind
        else {
            continue;
        };
        sink.report_if(
            never_begins(function, before, condition)
                .or_else(|| goes_away(function, condition, step))
                .or_else(|| steps_over(function, condition, step)),
        );
        if let StmtKind::Loop { body, .. } = &stmt.kind
            && let Some(counter) = counted(function, step)
        {
            reused(function, body, counter, sink);
        }
    }
}

/// A loop without work of its own that runs while an axis is at rest.
fn waits_at_rest(
    program: &AnalysedProgram<'_>,
    function: &Function,
    condition: ExprId,
    body: &[Stmt],
) -> Option<Diagnostic> {
    let waits = is_check_done(program, function, condition)
        && body.iter().all(|stmt| only_waits(program, function, stmt));
    waits.then(|| {
        let span = function.exprs[condition].span;
        Diagnostic::warning(Lint::LoopCondition, span, "this loop ends as soon as the axis moves")
            .at("1 when the axis has arrived, 0 while it moves")
            .help("to wait until it has arrived, write `!` before `CheckDone`")
    })
}

/// A loop until a measured position is exactly a number.
fn waits_for_exact(
    program: &AnalysedProgram<'_>,
    function: &Function,
    condition: ExprId,
) -> Option<Diagnostic> {
    let ExprKind::Compare(CompareOp::NotEqual, a, b) = function.exprs[condition].kind else { return None };
    let is_position = |expr: ExprId| axis_place(program, function, expr) == Some(Chan::POSITION.offset());
    (is_position(a) || is_position(b)).then(|| {
        let span = function.exprs[condition].span;
        Diagnostic::warning(
            Lint::LoopCondition,
            span,
            "this loop ends only if `Position` is exactly this number",
        )
        .at("a motor stops a little beside it")
        .help("wait with `while (!CheckDone(n));`, or until the difference is small: `while (fast_fabs(a - b) > 2);`")
    })
}

/// The offset of the field of an axis that an expression loads.
pub(super) fn axis_place(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Option<u32> {
    let place = match function.exprs[expr].kind {
        ExprKind::Load(place) => place,
        ExprKind::Convert(inner) => return axis_place(program, function, inner),
        _ => return None,
    };
    match function.places[place].kind {
        PlaceKind::Pointer(pointer, offset) => {
            let ExprKind::Load(pointer) = function.exprs[pointer].kind else { return None };
            let PlaceKind::Symbol(symbol, 0) = function.places[pointer].kind else { return None };
            axis_of_pointer(program.name(symbol)).map(|_| offset.cast_unsigned())
        }
        PlaceKind::Symbol(symbol, offset) if program.name(symbol) == CHANNELS => {
            Some(offset.cast_unsigned() % Chan::STRUCTURE.size)
        }
        _ => None,
    }
}

/// A loop until the PC has stored 0, which it does not where it refuses the request.
fn waits_for_0(
    program: &AnalysedProgram<'_>,
    function: &Function,
    condition: ExprId,
    body: &[Stmt],
) -> Option<Diagnostic> {
    const CODE: i32 = 100;
    let value = match function.exprs[condition].kind {
        ExprKind::Compare(CompareOp::NotEqual, value, zero) if int(function, zero) == Some(0) => value,
        _ => condition,
    };
    let ExprKind::Load(place) = function.exprs[value].kind else { return None };
    let is_code = user_data_type::element(program, function, place) == Some(CODE);
    (is_code && body.iter().all(|stmt| only_waits(program, function, stmt))).then(|| {
        let span = function.exprs[condition].span;
        Diagnostic::warning(Lint::LoopCondition, span, "this loop never ends if the PC refuses the request")
            .at("then the PC stores a negative number")
            .help("write `while (persist.UserData[100] > 0)`, and look at the number after the loop")
    })
}

/// Returns whether a statement only lets time pass.
fn only_waits(program: &AnalysedProgram<'_>, function: &Function, stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Block(body) => body.iter().all(|stmt| only_waits(program, function, stmt)),
        StmtKind::Expr(call) => called(program, function, *call).is_some_and(|name| PAUSES.contains(&name)),
        _ => false,
    }
}

fn local(function: &Function, place: PlaceId) -> Option<LocalId> {
    match function.places[place].kind {
        PlaceKind::Local(local, 0) if !function.locals[local].in_memory => Some(local),
        _ => None,
    }
}

fn int(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}

fn loaded(function: &Function, expr: ExprId) -> Option<LocalId> {
    match function.exprs[expr].kind {
        ExprKind::Load(place) => local(function, place),
        ExprKind::Convert(inner) => loaded(function, inner),
        _ => None,
    }
}

/// A loop whose counter starts where its condition is false.
fn never_begins(function: &Function, before: &Stmt, condition: ExprId) -> Option<Diagnostic> {
    let StmtKind::Expr(start) = before.kind else { return None };
    let ExprKind::Assign(place, start) = function.exprs[start].kind else { return None };
    let ExprKind::Compare(op, tested, end) = function.exprs[condition].kind else { return None };
    let counter = local(function, place).filter(|counter| loaded(function, tested) == Some(*counter))?;
    let (start, end) = (int(function, start)?, int(function, end)?);
    let holds = match op {
        CompareOp::Equal => start == end,
        CompareOp::NotEqual => start != end,
        // A number of iterations that is set to 0 switches a loop off on purpose.
        CompareOp::Less => start <= end,
        CompareOp::LessEqual => start <= end,
        CompareOp::Greater => start >= end,
        CompareOp::GreaterEqual => start >= end,
    };
    let name = &function.locals[counter].name;
    (!holds && !name.is_empty()).then(|| {
        let span = function.exprs[condition].span;
        Diagnostic::warning(Lint::LoopCondition, span, "this loop never runs")
            .at(format!("false at the start, where `{name}` is {start}"))
            .help("a loop runs while its condition is true: `i < 8` counts to 7")
    })
}

/// A loop whose counter moves away from its end.
fn goes_away(function: &Function, condition: ExprId, step: ExprId) -> Option<Diagnostic> {
    let ExprKind::Compare(op, tested, _) = function.exprs[condition].kind else { return None };
    let ExprKind::Update(update) = &function.exprs[step].kind else { return None };
    let counter =
        local(function, update.place).filter(|counter| loaded(function, tested) == Some(*counter))?;
    // Counting an unsigned number down until it wraps is an idiom.
    if function.locals[counter].ty.is_unsigned() {
        return None;
    }
    let amount = match function.exprs[update.operand].kind {
        ExprKind::Int(number) => number as f64,
        ExprKind::Float(number) => number,
        _ => return None,
    };
    let goes_up = if update.op == BinaryOp::Add {
        amount > 0.0
    } else if update.op == BinaryOp::Subtract {
        amount < 0.0
    } else {
        return None;
    };
    let is_away = match op {
        CompareOp::Less | CompareOp::LessEqual => !goes_up,
        CompareOp::Greater | CompareOp::GreaterEqual => goes_up,
        CompareOp::Equal | CompareOp::NotEqual => false,
    };
    let name = &function.locals[counter].name;
    (is_away && amount != 0.0 && !name.is_empty()).then(|| {
        let way = if goes_up { "up" } else { "down" };
        let span = function.exprs[step].span;
        Diagnostic::warning(
            Lint::LoopCondition,
            span,
            format!("`{name}` counts {way}, away from the end of the loop"),
        )
        .label(function.exprs[condition].span, "stays true until the number overflows")
        .help(if goes_up {
            "count down, or compare with `<`"
        } else {
            "count up, or compare with `>`"
        })
    })
}

/// A loop that ends at one floating-point number, which its steps miss.
pub(super) fn steps_over(function: &Function, condition: ExprId, step: ExprId) -> Option<Diagnostic> {
    /// Steps that are a multiple of this part of 1 have exact sums.
    const EXACT: f64 = 1_048_576.0;
    let ExprKind::Compare(CompareOp::NotEqual, tested, _) = function.exprs[condition].kind else {
        return None;
    };
    let ExprKind::Update(update) = &function.exprs[step].kind else { return None };
    let counter =
        local(function, update.place).filter(|counter| loaded(function, tested) == Some(*counter))?;
    let ExprKind::Float(amount) = function.exprs[update.operand].kind else { return None };
    if (amount * EXACT).fract() == 0.0 {
        return None;
    }
    let name = &function.locals[counter].name;
    let span = function.exprs[condition].span;
    Some(
        Diagnostic::warning(Lint::LoopCondition, span, format!("`{name}` steps over the end of the loop"))
            .label(function.exprs[step].span, format!("{amount} is rounded, and so are its sums"))
            .help("compare with `<`, or count with an `int`"),
    )
}

/// The local that a step counts.
fn counted(function: &Function, step: ExprId) -> Option<LocalId> {
    match &function.exprs[step].kind {
        ExprKind::Update(update) => local(function, update.place),
        _ => None,
    }
}

/// Reports loops in the body of a loop that start and count its counter.
fn reused(function: &Function, stmts: &[Stmt], counter: LocalId, sink: &mut Sink) {
    for [before, stmt] in stmts.array_windows() {
        let (StmtKind::Expr(start), StmtKind::Loop { step: Some(step), .. }) = (&before.kind, &stmt.kind)
        else {
            continue;
        };
        let ExprKind::Assign(place, _) = function.exprs[*start].kind else { continue };
        if local(function, place) == Some(counter) && counted(function, *step) == Some(counter) {
            let name = &function.locals[counter].name;
            let message = format!("this loop changes `{name}`, the counter of the enclosing loop");
            sink.report(
                Diagnostic::warning(Lint::LoopCondition, function.exprs[*step].span, message)
                    .help("use another variable here"),
            );
        }
    }
    for stmt in stmts {
        match &stmt.kind {
            StmtKind::Block(inner) | StmtKind::Loop { body: inner, .. } => {
                reused(function, inner, counter, sink);
            }
            StmtKind::If { then, otherwise, .. } => {
                reused(function, then, counter, sink);
                reused(function, otherwise, counter, sink);
            }
            _ => {}
        }
    }
}
