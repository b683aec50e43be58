//! Constants beyond what an output of the board takes.

use kmotiondef::ctype::Role;
use kmotiondef::firmware::row_named;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::typed::{Callee, ExprKind};

/// The words of the analog outputs.
pub(crate) const DAC_WORDS: &str = "DAC_Buffer";

/// The bits of such a word, which the macro `DAC` cuts its value to.
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
    /// The state of the constant `x op y`, given that of `x`.
    pub(crate) fn after(op: BinaryOp, (x, word): (i64, Option<&Self>), y: i64) -> Option<Self> {
        match (op, word) {
            (BinaryOp::Subtract, _) if y == DAC_ZERO => Some(Self { value: x, is_cut: false }),
            (BinaryOp::And, Some(word)) if y == DAC_BITS => Some(Self { is_cut: true, ..*word }),
            _ => None,
        }
    }

    /// The message where it is stored.
    pub(crate) fn finding(self, span: Span) -> Option<Diagnostic> {
        let value = self.value;
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

/// Reports calls with constants that are cut.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
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
