//! Code that the vendor's compiler translates wrongly, for people who still use it.
//!
//! The list is from `c67-subset.md` section 9; cc67 translates all of this code as C requires. Partly initialised
//! locals are found with the initialisers, parameters in `vendor_parameter.rs`, the rest in the finished tree.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{Expr, ExprId, ExprKind, Function, PlaceKind, UnaryOp};

/// The first address of RAM that is negative when addresses are compared as signed numbers.
const NEGATIVE: u32 = 0x8000_0000;

/// Looks at every function.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        if function.hidden.result_pointer.is_some() {
            sink.report(structure_result(program, function));
        }
        let inner = inner_assignments(function);
        for (id, expr) in &function.exprs {
            sink.report_if(signed_comparison(program, function, expr));
            if !inner.contains(&id) {
                sink.report_if(long_chain(program, function, id));
            }
        }
    }
}

/// The message for a local array or structure that its initialiser does not fill.
pub(crate) fn partly_initialised(span: Span) -> Diagnostic {
    warning(span, "clears the wrong memory for a partially initialised local")
        .at("some elements have no value here")
        .note("the call that clears the rest passes its arguments in the wrong order")
        .help("give every element a value, or make the local `static`")
}

fn warning(span: Span, fault: &str) -> Diagnostic {
    Diagnostic::warning(Lint::Vendor, span, format!("the vendor's compiler {fault}"))
}

fn structure_result(program: &AnalysedProgram<'_>, function: &Function) -> Diagnostic {
    let message = format!("returns the structure of `{}` to a wrong address", program.name(function.symbol));
    warning(function.span, &message).help("pass the address of the result, and store through it")
}

/// `<` and the like of unsigned values one of which may have its highest bit set.
fn signed_comparison(program: &AnalysedProgram<'_>, function: &Function, expr: &Expr) -> Option<Diagnostic> {
    let ExprKind::Compare(op, a, b) = expr.kind else { return None };
    let is_ordered = !matches!(op, CompareOp::Equal | CompareOp::NotEqual);
    let ty = function.exprs[a].ty;
    let what = if ty == Types::UNSIGNED && (may_be_large(function, a) || may_be_large(function, b)) {
        "unsigned values"
    } else if program.unit.types.pointee(ty).is_some() && (is_low(function, a) || is_low(function, b)) {
        "a pointer and a low address"
    } else {
        return None;
    };
    let finding = warning(expr.span, &format!("compares {what} as signed numbers"));
    is_ordered.then(|| {
        finding
            .at("wrong where one is 0x80000000 or more")
            .help("compare for equality, or use `int` where it suffices")
    })
}

/// Reports whether an unsigned value may be 0x80000000 or more.
fn may_be_large(function: &Function, expr: ExprId) -> bool {
    let small = |expr| !may_be_large(function, expr);
    match function.exprs[expr].kind {
        ExprKind::Int(value) => value as u32 >= NEGATIVE,
        ExprKind::Convert(from) => !is_never_negative(function, from),
        ExprKind::Binary(BinaryOp::And, a, b) => !(small(a) || small(b)),
        ExprKind::Binary(BinaryOp::Remainder, _, b) => !small(b),
        ExprKind::Binary(BinaryOp::Divide, a, b) => {
            !small(a) && !matches!(function.exprs[b].kind, ExprKind::Int(by) if by > 1)
        }
        ExprKind::Binary(BinaryOp::ShiftRight, _, by) => {
            !matches!(function.exprs[by].kind, ExprKind::Int(by) if by > 0)
        }
        _ => true,
    }
}

/// Reports whether the highest bit of a value that becomes unsigned is 0.
fn is_never_negative(function: &Function, expr: ExprId) -> bool {
    let Expr { kind, ty, .. } = &function.exprs[expr];
    match kind {
        _ if is_narrow(*ty) => true,
        ExprKind::Int(value) => (0..i64::from(NEGATIVE)).contains(value),
        ExprKind::Convert(from) => is_narrow(function.exprs[*from].ty),
        ExprKind::Compare(..) | ExprKind::And(..) | ExprKind::Or(..) | ExprKind::Unary(UnaryOp::Not, _) => {
            true
        }
        _ => false,
    }
}

fn is_narrow(ty: TypeId) -> bool {
    [Types::BOOL, Types::UNSIGNED_CHAR, Types::UNSIGNED_SHORT].contains(&ty)
}

/// Reports whether a pointer is a number that is positive as a signed one; programs and their data are elsewhere.
fn is_low(function: &Function, expr: ExprId) -> bool {
    match function.exprs[expr].kind {
        ExprKind::Int(value) => (value as u32) < NEGATIVE,
        ExprKind::Convert(from) => is_low(function, from),
        _ => false,
    }
}

/// `a->x = a->y = … = 0` with more targets than the vendor's compiler survives.
fn long_chain(program: &AnalysedProgram<'_>, function: &Function, head: ExprId) -> Option<Diagnostic> {
    let mut targets = Vec::new();
    let mut at = head;
    while let ExprKind::Assign(place, value) = function.exprs[at].kind {
        if let PlaceKind::Pointer(pointer, _) = function.places[place].kind {
            targets.push(limit(function, pointer, function.places[place].ty));
        }
        at = function.unconverted(value);
    }
    let limit = *targets.iter().min()?;
    (targets.len() >= limit).then(|| {
        let spelled = program.spell(function.exprs[head].ty);
        let count = targets.len();
        warning(function.exprs[head].span, &format!("crashes at {count} targets in one assignment"))
            .at(format!("it takes fewer than {limit} of type `{spelled}` that are reached through addresses"))
            .help("write two assignments")
    })
}

/// The smallest number of targets of a type that the vendor's compiler does not survive.
fn limit(function: &Function, pointer: ExprId, ty: TypeId) -> usize {
    let is_plain = matches!(function.exprs[pointer].kind, ExprKind::Load(_) | ExprKind::Int(_));
    match (is_plain, ty) {
        (true, Types::UNSIGNED_CHAR | Types::UNSIGNED_SHORT | Types::INT | Types::UNSIGNED) => 7,
        (true, _) => 5,
        (false, Types::UNSIGNED_CHAR) => 6,
        (false, _) => 4,
    }
}

/// The assignments whose values are stored by another assignment.
fn inner_assignments(function: &Function) -> BTreeSet<ExprId> {
    let values = function.exprs.values().filter_map(|expr| match expr.kind {
        ExprKind::Assign(_, value) => Some(value),
        _ => None,
    });
    values.map(|value| function.unconverted(value)).collect()
}
