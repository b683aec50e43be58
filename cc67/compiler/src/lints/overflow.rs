//! `50000 * 50000`: a computation with `int` constants that leaves the range of `int`, also where a variable holds one.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::changes::{Changes, symbol};
use super::program::AnalysedProgram;
use super::value_range::single_values;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{Definition, ExprId, ExprKind, Function, LocalId, PlaceKind, SymbolId};

/// The depth of products and sums in which values are computed.
const DEPTH: u32 = 4;

/// Reports products with variables that have a single value, a constant.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let changes = OnceCell::new();
    for function in program.functions() {
        let known = Known { program, function, locals: single_values(function), changes: &changes };
        for expr in function.exprs.values() {
            let ExprKind::Binary(BinaryOp::Multiply, a, b) = expr.kind else { continue };
            if expr.ty == Types::INT
                && let (Some(a), Some(b)) = (known.value(a, DEPTH), known.value(b, DEPTH))
            {
                sink.report_if(finding(BinaryOp::Multiply, a, b, expr.span));
            }
        }
    }
}

/// The values known in a function.
struct Known<'a> {
    program: &'a AnalysedProgram<'a>,
    function: &'a Function,
    locals: BTreeMap<LocalId, i64>,
    changes: &'a OnceCell<Changes>,
}

impl Known<'_> {
    /// A constant, the value of a known variable, or a value computed from these.
    fn value(&self, expr: ExprId, depth: u32) -> Option<i64> {
        match self.function.exprs[expr].kind {
            ExprKind::Int(number) => Some(number),
            ExprKind::Load(place) => match self.function.places[place].kind {
                PlaceKind::Local(local, 0) => self.locals.get(&local).copied(),
                _ => self.first(symbol(self.function, place)?).filter(|_| self.is_int(expr)),
            },
            ExprKind::Binary(op, a, b) if depth > 0 && self.is_int(expr) => {
                let exact = op.exactly(self.value(a, depth - 1)?, self.value(b, depth - 1)?)?;
                i32::try_from(exact).ok().map(i64::from)
            }
            _ => None,
        }
    }

    fn is_int(&self, expr: ExprId) -> bool {
        self.function.exprs[expr].ty == Types::INT
    }

    /// The initial value of a global `int`, if nothing changes it.
    fn first(&self, symbol: SymbolId) -> Option<i64> {
        let Definition::Data(data) = &self.program.unit.symbols[symbol].definition else { return None };
        let bytes = <[u8; 4]>::try_from(data.bytes.as_slice()).ok().filter(|_| data.addresses.is_empty())?;
        let changes = self.changes.get_or_init(|| Changes::of(self.program));
        let is_changed = changes.set.contains(&symbol) || changes.counted.contains(&symbol);
        (!is_changed).then(|| i64::from(i32::from_le_bytes(bytes)))
    }
}

/// The message for a computation of two signed constants of 32 bits.
pub(crate) fn finding(op: BinaryOp, a: i64, b: i64, span: Span) -> Option<Diagnostic> {
    let exact = op.exactly(a, b)?;
    let stored = exact as i32;
    (i64::from(stored) != exact).then(|| {
        Diagnostic::warning(Lint::Overflow, span, format!("{exact} does not fit in an `int`"))
            .at(format!("the result is {stored}"))
            .help("write one of the numbers with a decimal point, as in `50000.0`, and store the result in a `double`")
    })
}
