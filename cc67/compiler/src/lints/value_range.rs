//! Constants out of the range of the board's outputs.

use std::collections::BTreeMap;

use kmotiondef::ctype::Role;
use kmotiondef::firmware::row_named;

use super::adc_counts::{COUNTS_PER_VOLT, VOLTS};
use super::program::{AnalysedProgram, PERSIST};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::typed::{Callee, ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, SymbolId};

/// The words of the analog outputs.
pub(crate) const DAC_WORDS: &str = "DAC_Buffer";

/// The bits of such a word, to which the macro `DAC` truncates its value.
const DAC_BITS: i64 = 0xfff;

/// The encoding of 0 in such a word.
const DAC_ZERO: i64 = 2048;

/// A constant that is computed as the macro `DAC` does: `(value - 2048) & 0xfff`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DacWord {
    value: i64,
    is_cut: bool,
}

impl DacWord {
    /// The state of the constant `x op y`, given the state of `x`.
    pub(crate) fn after(op: BinaryOp, (x, word): (i64, Option<&Self>), y: i64) -> Option<Self> {
        match (op, word) {
            (BinaryOp::Subtract, _) if y == DAC_ZERO => Some(Self { value: x, is_cut: false }),
            (BinaryOp::And, Some(word)) if y == DAC_BITS => Some(Self { is_cut: true, ..*word }),
            _ => None,
        }
    }

    /// The message at the store of the constant.
    pub(crate) fn finding(self, span: Span) -> Option<Diagnostic> {
        let value = self.value;
        if self.is_cut && value != 0 && value.abs() as f64 <= VOLTS {
            return Some(volts(value, span));
        }
        if !self.is_cut || (-DAC_ZERO..DAC_ZERO).contains(&value) {
            return None;
        }
        let wrapped = ((value + DAC_ZERO) & DAC_BITS) - DAC_ZERO;
        let message = format!("`DAC` takes values from -{DAC_ZERO} to {}, but this is {value}", DAC_ZERO - 1);
        Some(
            Diagnostic::warning(Lint::ValueRange, span, message)
                .at(format!("the output has 12 bits and is set to {wrapped}")),
        )
    }
}

/// The message for a number of counts that looks like volts.
fn volts(value: i64, span: Span) -> Diagnostic {
    let counts = libm::round(value as f64 * COUNTS_PER_VOLT);
    let message = format!("`DAC` takes a number of counts, and {value} counts are almost nothing");
    Diagnostic::warning(Lint::DacCounts, span, message)
        .at("this looks like volts")
        .note("10 V are 2047 counts on a Kanalog")
        .help(format!("write {counts} for {value} V"))
}

/// Reports calls with constants that are cut.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        dac_variables(program, function, sink);
        start_up(program, function, sink);
        for (_, call) in function.calls() {
            let Callee::Symbol(callee) = call.callee else { continue };
            let name = program.name(callee);
            let Some(row) = row_named(name) else { continue };
            for (param, argument) in row.params.iter().zip(&call.arguments) {
                let argument = &function.exprs[*argument];
                if let (Role::Within(most), ExprKind::Int(value)) = (param.role, &argument.kind)
                    && value.unsigned_abs() > u64::from(most.unsigned_abs())
                {
                    let message =
                        format!("`{name}` takes values from -{most} to {most}, but this is {value}");
                    sink.report(
                        Diagnostic::warning(Lint::ValueRange, argument.span, message)
                            .at(format!("the board limits it to {}", i64::from(most) * value.signum())),
                    );
                }
            }
        }
    }
}

/// Reports bits of `persist.RunOnStartUp` that belong to no thread: bit n is thread n, and there is no thread 0.
fn start_up(program: &AnalysedProgram<'_>, function: &Function, sink: &mut Sink) {
    /// Bits 1 to 7.
    const THREADS: i64 = 0xFE;
    for expr in function.exprs.values() {
        let (place, value) = match &expr.kind {
            ExprKind::Assign(place, value) => (*place, *value),
            ExprKind::Update(update) if update.op == BinaryOp::Or => (update.place, update.operand),
            _ => continue,
        };
        let PlaceKind::Symbol(symbol, 0) = function.places[place].kind else { continue };
        let ExprKind::Int(bits) = *plain(function, value) else { continue };
        if program.name(symbol) == PERSIST && bits & !THREADS != 0 {
            let message =
                format!("bit n of `{RUN_ON_START_UP}` starts thread n, from 1 to 7, but this is {bits}");
            let finding = Diagnostic::warning(Lint::ValueRange, expr.span, message);
            let finding = match bits & !THREADS {
                1 => finding.at("bit 0 belongs to no thread"),
                _ => finding.at("bits beyond 7 belong to no thread"),
            };
            let help = (1..=7)
                .contains(&bits)
                .then(|| format!("write `{RUN_ON_START_UP} |= 1 << {bits};` for thread {bits}"));
            sink.report(match help {
                Some(help) => finding.help(help),
                None => finding,
            });
        }
    }
}

const RUN_ON_START_UP: &str = "persist.RunOnStartUp";

/// Reports variables with a single value, a constant, that the macro `DAC` cuts.
fn dac_variables(program: &AnalysedProgram<'_>, function: &Function, sink: &mut Sink) {
    for expr in function.exprs.values() {
        let ExprKind::Assign(place, value) = expr.kind else { continue };
        let is_dac = pointed(function, place).is_some_and(|symbol| program.name(symbol) == DAC_WORDS);
        match cut_variable(program, function, value).filter(|_| is_dac) {
            Some((name, Some(value))) => {
                let word = DacWord { value, is_cut: true };
                sink.report_if(
                    word.finding(expr.span).map(|found| found.note(format!("`{name}` is {value}"))),
                );
            }
            Some((name, None)) if names_volts(name) => {
                let message = format!("`DAC` takes a number of counts, and `{name}` looks like volts");
                sink.report(
                    Diagnostic::warning(Lint::DacCounts, expr.span, message)
                        .note("10 V are 2047 counts on a Kanalog")
                        .help(format!("write `(int)({name} * {COUNTS_PER_VOLT:.1})` for it")),
                );
            }
            Some((_, None)) | None => {}
        }
    }
}

/// The symbol to whose elements a place belongs.
fn pointed(function: &Function, place: PlaceId) -> Option<SymbolId> {
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, _) => Some(symbol),
        PlaceKind::Pointer(mut pointer, _) => loop {
            match function.exprs[pointer].kind {
                ExprKind::Convert(inner) | ExprKind::Binary(BinaryOp::Add, inner, _) => pointer = inner,
                ExprKind::Address(place) => break pointed(function, place),
                _ => break None,
            }
        },
        PlaceKind::Local(..) | PlaceKind::Bits(..) => None,
    }
}

/// Returns whether a variable is named for volts, and not for the counts of some.
fn names_volts(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.contains("volt") && !name.contains("count") && !name.contains("dac")
}

/// The name of the variable in `(variable - 2048) & 0xfff`, and its value if it has only one.
fn cut_variable<'a>(
    program: &AnalysedProgram<'a>,
    function: &'a Function,
    value: ExprId,
) -> Option<(&'a str, Option<i64>)> {
    let ExprKind::Binary(BinaryOp::And, word, mask) = plain(function, value) else { return None };
    let ExprKind::Binary(BinaryOp::Subtract, variable, zero) = plain(function, *word) else { return None };
    let is_macro = matches!(plain(function, *mask), ExprKind::Int(DAC_BITS))
        && matches!(plain(function, *zero), ExprKind::Int(DAC_ZERO));
    let ExprKind::Load(place) = plain(function, *variable) else { return None };
    match function.places[*place].kind {
        _ if !is_macro => None,
        PlaceKind::Local(local, 0) => {
            Some((function.locals[local].name.as_str(), single_values(function).get(&local).copied()))
        }
        PlaceKind::Symbol(symbol, 0) => Some((program.name(symbol), None)),
        PlaceKind::Local(..) | PlaceKind::Symbol(..) | PlaceKind::Pointer(..) | PlaceKind::Bits(..) => None,
    }
}

/// An expression without its conversions.
fn plain(function: &Function, expr: ExprId) -> &ExprKind {
    &function.exprs[function.unconverted(expr)].kind
}

/// The variables that are only assigned one constant, with that constant.
pub(super) fn single_values(function: &Function) -> BTreeMap<LocalId, i64> {
    single_stores(function, |value| constant(function, value))
}

/// The variables that are only assigned one value, with the result of `known` for it.
pub(super) fn single_stores<T>(
    function: &Function,
    known: impl Fn(ExprId) -> Option<T>,
) -> BTreeMap<LocalId, T> {
    let stored = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Local(local, _) => Some(local),
        _ => None,
    };
    let mut values: BTreeMap<LocalId, Option<T>> =
        function.parameters.iter().map(|&parameter| (parameter, None)).collect();
    for expr in function.exprs.values() {
        let (local, value) = match &expr.kind {
            ExprKind::Update(update) => (stored(update.place), None),
            ExprKind::Assign(place, value) => (stored(*place), known(*value)),
            _ => continue,
        };
        if let Some(local) = local {
            values.entry(local).and_modify(|only| *only = None).or_insert(value);
        }
    }
    let is_in_memory = |local: LocalId| function.locals[local].in_memory;
    values
        .into_iter()
        .filter_map(|(local, value)| Some((local, value?)))
        .filter(|(local, _)| !is_in_memory(*local))
        .collect()
}

fn constant(function: &Function, value: ExprId) -> Option<i64> {
    match function.exprs[value].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}
