//! Comparisons whose result is determined by types, `unsigned >= 0`, `char == 200`, or by the function, `ReadBit(3) ==
//! 5`; pairs that are always true, `x != 1 || x != 2`, or always false, `x < 1 && x > 2`.

use std::collections::BTreeMap;

use kmotiondef::firmware::row_named;
use kmotiondef::function::PolledState;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::source::ExpansionId;
use crate::ty::{TypeId, Types};
use crate::typed::{Expr, ExprId, ExprKind, Function, LocalId, PlaceKind};

/// Reports comparisons with a constant that no value of the other side's type decides differently.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let narrow = narrow_variables(function);
        for expr in function.exprs.values() {
            sink.report_if(pair(program, function, expr));
            let ExprKind::Compare(op, a, b) = expr.kind else { continue };
            let sides = match (constant(function, a), constant(function, b)) {
                (None, Some(number)) => Some((op, a, number)),
                (Some(number), None) => Some((mirrored(op), b, number)),
                _ => None,
            };
            let Some((op, value, number)) = sides else { continue };
            let Some(Range { of, least, most, help }) =
                answer(program, function, value).or_else(|| range(program, function, value, number, &narrow))
            else {
                continue;
            };
            let Some(result) = decided(op, least, most, number) else { continue };
            let message = format!("this comparison is always {result}");
            sink.report(
                Diagnostic::warning(Lint::ConstantComparison, expr.span, message)
                    .label(function.exprs[value].span, format!("`{of}`, which is {least} to {most}"))
                    .help(help),
            );
        }
    }
}

/// Two comparisons of the same variable that exclude or complete each other.
fn pair(program: &AnalysedProgram<'_>, function: &Function, expr: &Expr) -> Option<Diagnostic> {
    let (is_or, a, b) = match expr.kind {
        ExprKind::Or(a, b) => (true, a, b),
        ExprKind::And(a, b) => (false, a, b),
        _ => return None,
    };
    let (one, other) = (compared(program, function, a)?, compared(program, function, b)?);
    // An `or` is always true where the opposite of both cannot be.
    let opposite = |op| if is_or { negated(op) } else { op };
    let (low, high) = (opposite(one.op), opposite(other.op));
    let is_impossible = one.of == other.of && excludes((low, one.number), (high, other.number));
    is_impossible.then(|| {
        let message = format!("this condition is always {is_or}");
        let (used, meant) = if is_or { ("||", "&&") } else { ("&&", "||") };
        Diagnostic::warning(Lint::ConstantComparison, expr.span, message)
            .at(format!("`{}` is a single number", one.of))
            .help(format!("write `{meant}` in place of `{used}`, or compare different things"))
    })
}

/// A comparison of a variable with a number.
struct Compared {
    op: CompareOp,
    /// The text of the variable.
    of: String,
    number: f64,
}

fn compared(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Option<Compared> {
    let ExprKind::Compare(op, a, b) = function.exprs[expr].kind else { return None };
    let number = |expr: ExprId| match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number as f64),
        ExprKind::Float(number) => Some(number),
        _ => None,
    };
    let (op, value, number) = match (number(a), number(b)) {
        (None, Some(number)) => (op, a, number),
        (Some(number), None) => (mirrored(op), b, number),
        _ => return None,
    };
    let load = function.unconverted(value);
    // A state for which a program waits may change in between.
    let ExprKind::Load(place) = function.exprs[load].kind else { return None };
    let is_plain = !matches!(function.places[place].kind, PlaceKind::Bits(..));
    let span = function.exprs[load].span;
    let of = String::from_utf8_lossy(program.sources.text(span)).into_owned();
    let is_named = span.expansion == ExpansionId::NONE && !of.is_empty() && !of.contains(['(', '+', '=']);
    (is_plain && is_named).then_some(Compared { op, of, number })
}

const fn negated(op: CompareOp) -> CompareOp {
    match op {
        CompareOp::Equal => CompareOp::NotEqual,
        CompareOp::NotEqual => CompareOp::Equal,
        CompareOp::Less => CompareOp::GreaterEqual,
        CompareOp::LessEqual => CompareOp::Greater,
        CompareOp::Greater => CompareOp::LessEqual,
        CompareOp::GreaterEqual => CompareOp::Less,
    }
}

/// Returns whether no number satisfies both comparisons.
fn excludes((op, number): (CompareOp, f64), (other, limit): (CompareOp, f64)) -> bool {
    use CompareOp::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    match (op, other) {
        (Equal, Equal) => number != limit,
        (Less | LessEqual, Greater) | (Less, GreaterEqual) => number <= limit,
        (LessEqual, GreaterEqual) => number < limit,
        (Greater | GreaterEqual, Less) | (Greater, LessEqual) => number >= limit,
        (GreaterEqual, LessEqual) => number > limit,
        (Equal, NotEqual | Less | LessEqual | Greater | GreaterEqual)
        | (NotEqual, _)
        | (Less | LessEqual, Equal | NotEqual | Less | LessEqual)
        | (Greater | GreaterEqual, Equal | NotEqual | Greater | GreaterEqual) => false,
    }
}

fn constant(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}

const fn mirrored(op: CompareOp) -> CompareOp {
    match op {
        CompareOp::Equal => CompareOp::Equal,
        CompareOp::NotEqual => CompareOp::NotEqual,
        CompareOp::Less => CompareOp::Greater,
        CompareOp::LessEqual => CompareOp::GreaterEqual,
        CompareOp::Greater => CompareOp::Less,
        CompareOp::GreaterEqual => CompareOp::LessEqual,
    }
}

/// The values that an expression can have.
struct Range {
    /// A type or a function.
    of: String,
    least: i64,
    most: i64,
    help: &'static str,
}

/// The results of a firmware function that answers a question.
fn answer(program: &AnalysedProgram<'_>, function: &Function, value: ExprId) -> Option<Range> {
    let ExprKind::Call(call) = &function.exprs[value].kind else { return None };
    let name = called_firmware(program.unit, call)?;
    let (least, most, help) = match row_named(name)?.attributes.polls? {
        PolledState::Bit => (0, 1, "a bit is 0 or 1"),
        PolledState::Motion => (-1, 1, "1 is done, 0 in motion, -1 disabled"),
        PolledState::Time | PolledState::Path | PolledState::Recording | PolledState::Lock => return None,
    };
    Some(Range { of: name.to_owned(), least, most, help })
}

/// The type of a value before C widens it, and its range.
fn range(
    program: &AnalysedProgram<'_>,
    function: &Function,
    value: ExprId,
    number: i64,
    narrow: &BTreeMap<LocalId, TypeId>,
) -> Option<Range> {
    let value = unwidened(function, value);
    let variable = register(function, value).and_then(|local| narrow.get(&local).copied());
    let ty = variable.unwrap_or(function.exprs[value].ty);
    let (least, most) = range_of(ty)?;
    let is_byte = matches!(ty, Types::CHAR | Types::SIGNED_CHAR) && (0..=0xff).contains(&number);
    let help = match (is_byte, variable) {
        (true, None) => "use an `unsigned char`",
        (true, Some(_)) => "mask the value where it is stored: `& 0xff`",
        (false, _) => "use an `int`",
    };
    Some(Range { of: program.spell(ty), least, most, help })
}

/// A value without the conversions that widen it.
fn unwidened(function: &Function, mut value: ExprId) -> ExprId {
    let is_plain = |ty: TypeId| ty.is_integer() && !ty.is_long_long();
    while let ExprKind::Convert(inner) = function.exprs[value].kind
        && is_plain(function.exprs[inner].ty)
        && range_of(function.exprs[inner].ty).is_some()
        && is_plain(function.exprs[value].ty)
    {
        value = inner;
    }
    value
}

/// The variable from which a value is read, if only this function can change it.
fn register(function: &Function, value: ExprId) -> Option<LocalId> {
    let ExprKind::Load(place) = function.exprs[value].kind else { return None };
    match function.places[place].kind {
        PlaceKind::Local(local, 0) if !function.locals[local].in_memory => Some(local),
        _ => None,
    }
}

/// The variables of type `int` in which only values of one signed type of 8 bits are stored, each with the type.
fn narrow_variables(function: &Function) -> BTreeMap<LocalId, TypeId> {
    let mut types: BTreeMap<LocalId, Option<TypeId>> =
        function.parameters.iter().map(|&parameter| (parameter, None)).collect();
    for expr in function.exprs.values() {
        let (place, ty) = match &expr.kind {
            ExprKind::Update(update) => (update.place, None),
            ExprKind::Assign(place, value) => (*place, Some(function.exprs[unwidened(function, *value)].ty)),
            _ => continue,
        };
        let PlaceKind::Local(local, _) = function.places[place].kind else { continue };
        let is_byte = |ty: &TypeId| matches!(*ty, Types::CHAR | Types::SIGNED_CHAR);
        let ty = ty.filter(|ty| is_byte(ty) && function.locals[local].ty == Types::INT);
        types.entry(local).and_modify(|only| *only = only.filter(|only| Some(*only) == ty)).or_insert(ty);
    }
    types.into_iter().filter_map(|(local, ty)| Some((local, ty?))).collect()
}

/// The range of a type that is narrower than `int`, or unsigned.
const fn range_of(ty: TypeId) -> Option<(i64, i64)> {
    match ty {
        Types::CHAR | Types::SIGNED_CHAR => Some((i8::MIN as i64, i8::MAX as i64)),
        Types::UNSIGNED_CHAR => Some((0, u8::MAX as i64)),
        Types::SHORT => Some((i16::MIN as i64, i16::MAX as i64)),
        Types::UNSIGNED_SHORT => Some((0, u16::MAX as i64)),
        Types::UNSIGNED => Some((0, u32::MAX as i64)),
        _ => None,
    }
}

/// The result of a comparison that is the same for every value of a range.
fn decided(op: CompareOp, least: i64, most: i64, number: i64) -> Option<bool> {
    let is_outside = number < least || number > most;
    match op {
        CompareOp::Equal => is_outside.then_some(false),
        CompareOp::NotEqual => is_outside.then_some(true),
        CompareOp::Less => always(most < number, least >= number),
        CompareOp::LessEqual => always(most <= number, least > number),
        CompareOp::Greater => always(least > number, most <= number),
        CompareOp::GreaterEqual => always(least >= number, most < number),
    }
}

fn always(is_true: bool, is_false: bool) -> Option<bool> {
    (is_true || is_false).then_some(is_true)
}
