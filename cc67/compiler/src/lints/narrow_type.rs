//! `short place = ch0->Position;`: a place of an axis, or an analog input, in a type that is too small for it.

use kmotiondef::firmware::Function as FirmwareFunction;
use kmotiondef::structs::Chan;

use super::format::called_firmware;
use super::loop_condition::axis_place;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::{TypeId, Types};
use crate::typed::{ExprId, ExprKind, Function};

/// The fields of an axis that are places on it.
const PLACES: [(&str, u32); 2] = [("Dest", Chan::DEST.offset()), ("Position", Chan::POSITION.offset())];

/// Reports values that are converted to a type which holds only a part of them; a cast is meant.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            let Some((what, range)) = source(program, function, inner, expr.ty) else { continue };
            if program.sources.text(expr.span).starts_with(b"(") {
                continue;
            }
            let (ty, most) = (program.spell(expr.ty), most(expr.ty).unwrap_or_default());
            sink.report(
                Diagnostic::warning(
                    Lint::NarrowType,
                    function.exprs[inner].span,
                    format!("`{what}` does not fit in a `{ty}`"),
                )
                .at(range)
                .note(format!("a `{ty}` ends at {most}, and what is beyond begins again at its other end"))
                .help("use an `int`, or a `double`"),
            );
        }
    }
}

/// The largest number of a type that is smaller than `int`.
const fn most(ty: TypeId) -> Option<i64> {
    match ty {
        Types::CHAR | Types::SIGNED_CHAR => Some(i8::MAX as i64),
        Types::UNSIGNED_CHAR => Some(u8::MAX as i64),
        Types::SHORT => Some(i16::MAX as i64),
        Types::UNSIGNED_SHORT => Some(u16::MAX as i64),
        _ => None,
    }
}

/// The name of an expression with values outside of a type's range, and those values.
fn source(
    program: &AnalysedProgram<'_>,
    function: &Function,
    expr: ExprId,
    ty: TypeId,
) -> Option<(&'static str, &'static str)> {
    let most = most(ty)?;
    if let ExprKind::Call(call) = &function.exprs[expr].kind {
        const ADC: i64 = 2047;
        let name = FirmwareFunction::ReadADC.name();
        let is_adc = called_firmware(program.unit, call) == Some(name);
        return (is_adc && most < ADC).then_some((name, "counts from -2048 to 2047"));
    }
    let field = axis_place(program, function, expr)?;
    let (name, _) = PLACES.iter().find(|(_, offset)| *offset == field)?;
    Some((name, "counts, of which an axis has many more"))
}
