//! `sprintf` and `strcpy` into an array that is too small for any text that they can store.

use kmotiondef::firmware::Function;

use super::format::{called_firmware, literal_argument};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{self, Call, Definition, ExprId, ExprKind, PlaceKind};

/// Reports calls whose shortest text, including its terminator, is longer than the array.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (expr, call) in function.calls() {
            let Some(name) = called_firmware(program.unit, call) else { continue };
            if let Some(finding) = block(program, function, (name, call), expr.span) {
                sink.report(finding);
            }
            let Some(length) = shortest(program, function, call, name) else { continue };
            let Some((array, size)) = call.arguments.first().and_then(|to| room(program, function, *to))
            else {
                continue;
            };
            let bytes = length + 1;
            if bytes > size as usize {
                let message =
                    format!("`{name}` stores at least {bytes} bytes in `{array}`, which has {size}");
                sink.report(
                    Diagnostic::warning(Lint::TextOverflow, expr.span, message)
                        .at("the memory after the array is overwritten")
                        .note("the end of a text takes one byte")
                        .help("make the array larger"),
                );
            }
        }
    }
}

/// Functions that store a number of bytes that is one of their arguments, counted from 0.
const BLOCKS: [(&str, usize); 4] = [
    (Function::memset.name(), 2),
    (Function::memcpy.name(), 2),
    (Function::strncpy.name(), 2),
    (Function::fgets.name(), 1),
];

/// The message for a call that should store more bytes than an array has.
fn block(
    program: &AnalysedProgram<'_>,
    function: &typed::Function,
    (name, call): (&str, &Call),
    span: Span,
) -> Option<Diagnostic> {
    let (_, index) = BLOCKS.into_iter().find(|(known, _)| *known == name)?;
    let bytes = constant(function, *call.arguments.get(index)?)?;
    let (array, size) = room(program, function, *call.arguments.first()?)?;
    (bytes > i64::from(size)).then(|| {
        let message = format!("`{name}` may store {bytes} bytes in `{array}`, which has {size}");
        Diagnostic::warning(Lint::TextOverflow, span, message)
            .at("the memory after the array is overwritten")
            .help(format!("pass `sizeof({array})`"))
    })
}

/// Characters of the shortest text that a call can store.
fn shortest(
    program: &AnalysedProgram<'_>,
    function: &typed::Function,
    call: &Call,
    name: &str,
) -> Option<usize> {
    let text = |index| literal_argument(program.unit, function, call, index);
    if [Function::strcpy.name(), Function::strcat.name()].contains(&name) {
        return Some(text(1)?.len());
    }
    if name != Function::sprintf.name() {
        return None;
    }
    let mut values = call.variable.iter().flatten();
    Some(formatted(text(1)?, &mut || values.next().map(|value| constant(function, *value))))
}

/// A value of a call, if it is known.
fn constant(function: &typed::Function, value: ExprId) -> Option<i64> {
    match function.exprs[value].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}

/// The length of the shortest text of a format; `next` yields the next argument, if there is one, and its value if
/// known.
fn formatted(format: &[u8], next: &mut dyn FnMut() -> Option<Option<i64>>) -> usize {
    let mut length = 0;
    let mut rest = format;
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'%' {
            length += 1;
            continue;
        }
        let count = |text: &[u8], of: &dyn Fn(u8) -> bool| text.iter().take_while(|byte| of(**byte)).count();
        let number = |digits: &[u8]| std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
        rest = &rest[count(rest, &|byte| b"-+ #0".contains(&byte))..];
        let (width, after) = rest.split_at(count(rest, &|byte| byte.is_ascii_digit() || byte == b'*'));
        rest = after;
        let mut precision = None;
        if let Some(after) = rest.strip_prefix(b".") {
            let (digits, after) = after.split_at(count(after, &|byte| byte.is_ascii_digit() || byte == b'*'));
            precision = Some(number(digits).unwrap_or(0));
            rest = after;
        }
        rest = &rest[count(rest, &|byte| b"hlL".contains(&byte))..];
        let Some((&letter, after)) = rest.split_first() else { return length };
        rest = after;
        let least = match letter {
            b'%' => 1,
            b'd' | b'i' => next().flatten().map_or(1, |value| value.to_string().len()),
            b's' => next().map_or(0, |_| 0),
            b'f' | b'F' => next().map_or(0, |_| match precision.unwrap_or(6_usize) {
                0 => 1,
                digits => digits.saturating_add(2),
            }),
            b'e' | b'E' => next().map_or(0, |_| precision.unwrap_or(6_usize).saturating_add(6)),
            _ => next().map_or(0, |_| 1),
        };
        length += least.max(number(width).unwrap_or(0));
    }
    length
}

/// The array into which an address points, and its remaining bytes.
fn room<'p>(
    program: &AnalysedProgram<'p>,
    function: &'p typed::Function,
    to: ExprId,
) -> Option<(&'p str, u32)> {
    let ExprKind::Address(place) = function.exprs[function.unconverted(to)].kind else { return None };
    let (name, ty, offset) = match function.places[place].kind {
        PlaceKind::Local(local, offset) => {
            let local = &function.locals[local];
            (local.name.as_str(), local.ty, offset)
        }
        PlaceKind::Symbol(symbol, offset) => {
            let symbol = &program.unit.symbols[symbol];
            let is_own = matches!(symbol.definition, Definition::Tentative | Definition::Data(_));
            (symbol.name.as_str(), symbol.ty, u32::try_from(offset).ok().filter(|_| is_own)?)
        }
        PlaceKind::Pointer(..) | PlaceKind::Bits(..) => return None,
    };
    program.unit.types.array(ty)?;
    let size = program.unit.types.size_of(ty)?;
    Some((name, size.checked_sub(offset)?)).filter(|(name, _)| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_text_of_a_format_is_counted() {
        for (format, values, expect) in [
            ("position %d", vec![None], 10),
            ("position %d", vec![Some(123_456)], 15),
            ("%f %.2f %.0f", vec![None; 3], 8 + 1 + 4 + 1 + 1),
            ("%8d|%-5s|%%", vec![None; 2], 8 + 1 + 5 + 1 + 1),
            ("%s%c%x", vec![None; 3], 2),
        ] {
            let mut values = values.into_iter();
            assert_eq!(formatted(format.as_bytes(), &mut || values.next()), expect, "{format}");
        }
    }
}
