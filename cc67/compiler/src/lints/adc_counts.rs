//! `ReadADC(0) > 5.0`: analog inputs are read in counts, not in volts.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::typed::{Expr, ExprId, ExprKind, Function as TypedFunction, PlaceId, PlaceKind};

/// The function that reads an analog input, in counts from -2048 to 2047.
const READ: &str = Function::ReadADC.name();

/// The words that the macro `ADC` reads, in the same counts, and the offset that it subtracts.
const WORDS: &str = "ADC_BufferIn";
const ZERO: i64 = 2048;

/// The range of analog inputs and outputs in volts: constants outside of it are counts.
pub(super) const VOLTS: f64 = 10.0;
pub(super) const COUNTS_PER_VOLT: f64 = 204.8;

/// Reports comparisons of an analog input with constants that look like volts.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let compared = |expr: &Expr| {
            let ExprKind::Compare(_, a, b) = expr.kind else { return None };
            let (name, constant) =
                compared(program, function, a, b).or_else(|| compared(program, function, b, a))?;
            Some((name, constant, volts(function, constant)?))
        };
        let found: Vec<_> = function.exprs.values().filter_map(compared).collect();
        for &(name, constant, volts) in &found {
            // A pair of limits around 0 is a dead band.
            if found.iter().any(|(.., other)| *other == -volts) {
                continue;
            }
            let message = format!("`{name}` is a number of counts, and {volts} counts are almost nothing");
            let counts = libm::round(volts * COUNTS_PER_VOLT);
            sink.report(
                Diagnostic::warning(Lint::AdcCounts, function.exprs[constant].span, message)
                    .at("this looks like volts")
                    .note("10 V are 2047 counts on a Kanalog")
                    .help(format!("write {counts} for {volts} V")),
            );
        }
    }
}

/// An analog input that is compared with the other side.
fn compared(
    program: &AnalysedProgram<'_>,
    function: &TypedFunction,
    input: ExprId,
    other: ExprId,
) -> Option<(&'static str, ExprId)> {
    let name = match &function.exprs[unconverted(function, input)].kind {
        ExprKind::Call(call) if called_firmware(program.unit, call) == Some(READ) => READ,
        ExprKind::Binary(BinaryOp::Subtract, word, zero) => {
            let is_zero = matches!(function.exprs[*zero].kind, ExprKind::Int(ZERO));
            let ExprKind::Load(place) = function.exprs[unconverted(function, *word)].kind else {
                return None;
            };
            (is_zero && symbol(program, function, place) == Some(WORDS)).then_some("ADC")?
        }
        _ => return None,
    };
    Some((name, other))
}

/// The array to whose elements a place belongs.
fn symbol<'p>(program: &AnalysedProgram<'p>, function: &TypedFunction, place: PlaceId) -> Option<&'p str> {
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, _) => Some(program.name(symbol)),
        PlaceKind::Pointer(pointer, _) => match function.exprs[pointer].kind {
            ExprKind::Binary(_, base, _) => address(program, function, base),
            _ => address(program, function, pointer),
        },
        PlaceKind::Local(..) | PlaceKind::Bits(..) => None,
    }
}

fn address<'p>(program: &AnalysedProgram<'p>, function: &TypedFunction, base: ExprId) -> Option<&'p str> {
    match function.exprs[unconverted(function, base)].kind {
        ExprKind::Address(place) => match function.places[place].kind {
            PlaceKind::Symbol(symbol, _) => Some(program.name(symbol)),
            _ => None,
        },
        _ => None,
    }
}

fn unconverted(function: &TypedFunction, expr: ExprId) -> ExprId {
    match function.exprs[expr].kind {
        ExprKind::Convert(inner) => unconverted(function, inner),
        _ => expr,
    }
}

/// A constant that can be a voltage.
fn volts(function: &TypedFunction, constant: ExprId) -> Option<f64> {
    let value = match function.exprs[unconverted(function, constant)].kind {
        ExprKind::Int(value) => value as f64,
        ExprKind::Float(value) => value,
        _ => return None,
    };
    (value != 0.0 && value.abs() <= VOLTS).then_some(value)
}
