//! `abs(error)` and `persist.UserData[40] = length` with fractional numbers: `abs` takes an `int`, and the elements are
//! of type `int`.
//!
//! Fractional constants are found where they are converted.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::{AnalysedProgram, CHANNELS, PERSIST, axis_of_pointer};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function as TypedFunction, PlaceId, PlaceKind, UnaryOp};

/// The function that takes an `int` and is used for every number.
const ABS: &str = Function::abs.name();

/// Reports floating-point numbers that are passed to `abs` or stored in elements of `persist.UserData`.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        user_data(program, function, sink);
        for (_, call) in function.calls() {
            if called_firmware(program.unit, call) != Some(ABS) {
                continue;
            }
            let Some(&argument) = call.arguments.first() else { continue };
            let expr = &function.exprs[argument];
            if let ExprKind::Convert(inner) = expr.kind
                && function.exprs[inner].ty.is_floating()
                && expr.ty.is_integer()
            {
                sink.report(
                    Diagnostic::warning(
                        Lint::LostFraction,
                        expr.span,
                        "`abs` takes an `int`: the fraction is lost",
                    )
                    .at(format!("this is `{}`", program.spell(function.exprs[inner].ty)))
                    .help("write `fast_fabs(x)`, or `fast_fabsf(x)` for a `float`"),
                );
            }
        }
    }
}

/// Reports numbers with a fraction that are stored in elements without a cast.
fn user_data(program: &AnalysedProgram<'_>, function: &TypedFunction, sink: &mut Sink) {
    for expr in function.exprs.values() {
        let ExprKind::Assign(place, value) = expr.kind else { continue };
        let ExprKind::Convert(number) = function.exprs[value].kind else { continue };
        let from = function.exprs[number].ty;
        let is_element = function.places[place].ty == Types::INT && is_persist(program, function, place);
        if !is_element || !from.is_floating() || is_whole(program, function, number) {
            continue;
        }
        let span = function.exprs[value].span;
        if program.sources.text(span).starts_with(b"(") && function.exprs[number].span != span {
            continue;
        }
        let name = program.spell(from);
        let element = String::from_utf8_lossy(program.sources.text(function.places[place].span));
        sink.report(
            Diagnostic::warning(Lint::LostFraction, span, "the fraction is lost in an element of `persist.UserData`, an `int`")
                .at(format!("this is `{name}`"))
                .help(format!("store the number itself with `*(float *)&{element} = …`, or write `(int)` if whole numbers are meant")),
        );
    }
}

/// Reports whether a place is a part of `persist`.
fn is_persist(program: &AnalysedProgram<'_>, function: &TypedFunction, place: PlaceId) -> bool {
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, _) => program.name(symbol) == PERSIST,
        PlaceKind::Pointer(mut pointer, _) => loop {
            match function.exprs[pointer].kind {
                ExprKind::Convert(inner) | ExprKind::Binary(BinaryOp::Add, inner, _) => pointer = inner,
                ExprKind::Address(place) => break is_persist(program, function, place),
                _ => break false,
            }
        },
        PlaceKind::Local(..) | PlaceKind::Bits(..) => false,
    }
}

/// Reports whether a number has no fraction, or loses it on purpose: it is scaled, rounded, or in counts.
fn is_whole(program: &AnalysedProgram<'_>, function: &TypedFunction, number: ExprId) -> bool {
    /// A factor that makes a fraction a whole number, such as thousandths.
    const SCALE: f64 = 10.0;
    let is_whole = |expr| is_whole(program, function, expr);
    let constant = |expr: ExprId| match function.exprs[expr].kind {
        ExprKind::Float(number) => Some(number.abs()),
        _ => None,
    };
    let is = |expr, test: fn(f64) -> bool| constant(expr).is_some_and(test);
    match &function.exprs[number].kind {
        ExprKind::Float(number) => number.fract() == 0.0,
        ExprKind::Convert(inner) if function.exprs[*inner].ty.is_floating() => is_whole(*inner),
        ExprKind::Convert(_) => true,
        ExprKind::Unary(UnaryOp::Negate, inner) => is_whole(*inner),
        ExprKind::Binary(BinaryOp::Multiply, a, b) => {
            let is_scaled = |expr| is(expr, |factor| factor >= SCALE);
            is_scaled(*a) || is_scaled(*b) || (is_whole(*a) && is_whole(*b))
        }
        ExprKind::Binary(BinaryOp::Divide, _, b) => is(*b, |divisor| divisor < 1.0),
        ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract, a, b) => {
            let is_rounding = |expr| is(expr, |half| half == 0.5);
            is_rounding(*a) || is_rounding(*b) || (is_whole(*a) && is_whole(*b))
        }
        ExprKind::Conditional(_, a, b) => is_whole(*a) && is_whole(*b),
        // Functions of the board that return a number give times, counts or whole numbers.
        ExprKind::Call(call) => called_firmware(program.unit, call).is_some(),
        // Fields of an axis are counts, and other variables are whole numbers unless a fractional value is stored in
        // them.
        ExprKind::Load(place) => is_of_axis(program, function, *place) || !holds_fraction(function, *place),
        _ => false,
    }
}

/// Reports whether a number that has a fraction, or most likely has one, is stored in a local variable.
fn holds_fraction(function: &TypedFunction, place: PlaceId) -> bool {
    let PlaceKind::Local(local, offset) = function.places[place].kind else { return false };
    let is_it = |place: PlaceId| matches!(function.places[place].kind, PlaceKind::Local(other, at) if other == local && at == offset);
    function.exprs.values().any(|expr| match &expr.kind {
        ExprKind::Assign(place, value) => is_it(*place) && has_fraction(function, *value),
        ExprKind::Update(update) => {
            is_it(update.place) && (update.op == BinaryOp::Divide || has_fraction(function, update.operand))
        }
        _ => false,
    })
}

/// Reports whether a value is a constant with a fraction, a quotient, or computed with one.
fn has_fraction(function: &TypedFunction, value: ExprId) -> bool {
    match function.exprs[value].kind {
        ExprKind::Float(number) => number.fract() != 0.0,
        ExprKind::Convert(inner) => function.exprs[inner].ty.is_floating() && has_fraction(function, inner),
        ExprKind::Unary(UnaryOp::Negate, inner) => has_fraction(function, inner),
        ExprKind::Binary(BinaryOp::Divide, _, divisor) => {
            !matches!(function.exprs[divisor].kind, ExprKind::Float(number) if number.abs() < 1.0)
        }
        ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Multiply, a, b) => {
            has_fraction(function, a) || has_fraction(function, b)
        }
        _ => false,
    }
}

/// Reports whether a place is a field of an axis.
fn is_of_axis(program: &AnalysedProgram<'_>, function: &TypedFunction, place: PlaceId) -> bool {
    let is_axis = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Symbol(symbol, _) => {
            let name = program.name(symbol);
            name == CHANNELS || axis_of_pointer(name).is_some()
        }
        _ => false,
    };
    match function.places[place].kind {
        PlaceKind::Pointer(mut pointer, _) => loop {
            match function.exprs[pointer].kind {
                ExprKind::Convert(inner) | ExprKind::Binary(BinaryOp::Add, inner, _) => pointer = inner,
                ExprKind::Address(place) | ExprKind::Load(place) => break is_axis(place),
                _ => break false,
            }
        },
        _ => is_axis(place),
    }
}
