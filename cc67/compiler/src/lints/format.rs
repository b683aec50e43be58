//! `printf` and `scanf` formats against their arguments.
//!
//! Only a mismatch that prints or stores something wrong is reported: `%d` for an `unsigned` is fine, `%d` for a
//! `double` is not (`dialect.md` 5). Only a format that is a literal in the call is checked.

use kmotiondef::ctype::Role;
use kmotiondef::firmware::row_named;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{self, Call, Callee, Definition, ExprId, ExprKind, PlaceKind, Unit};

/// Compares every format with the arguments after it.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            let Some((taker, format)) = literal_format(program.unit, function, call) else { continue };
            let values = call.variable.iter().flatten();
            let arguments: Vec<_> = values.map(|value| written(function, *value)).collect();
            let span = function.exprs[call.arguments[taker.format]].span;
            for finding in compare(&program.unit.types, taker, format, &arguments) {
                sink.report(finding.into_diagnostic(program, span));
            }
        }
    }
}

/// An argument as written in the program: a `float` is passed as a `double`, but the message should say `float`.
fn written(function: &typed::Function, value: ExprId) -> PassedArgument {
    let expr = &function.exprs[value];
    match expr.kind {
        ExprKind::Convert(inner) if expr.ty == Types::DOUBLE && function.exprs[inner].ty == Types::FLOAT => {
            (Types::FLOAT, expr.span)
        }
        _ => (expr.ty, expr.span),
    }
}

/// The function that a call calls and the text of its format, if that is a string literal.
pub(super) fn literal_format<'p>(
    unit: &'p Unit,
    function: &typed::Function,
    call: &Call,
) -> Option<(FormatFunction, &'p [u8])> {
    let taker = FormatFunction::by_name(called_firmware(unit, call)?)?;
    Some((taker, literal_argument(unit, function, call, taker.format)?))
}

/// The name of the function that a call calls, if the program does not define it.
pub(super) fn called_firmware<'p>(unit: &'p Unit, call: &Call) -> Option<&'p str> {
    let Callee::Symbol(callee) = call.callee else { return None };
    let callee = &unit.symbols[callee];
    matches!(callee.definition, Definition::None).then_some(&callee.name)
}

/// The text of an argument of a call, counted from 0, if that is a string literal.
pub(super) fn literal_argument<'p>(
    unit: &'p Unit,
    function: &typed::Function,
    call: &Call,
    index: usize,
) -> Option<&'p [u8]> {
    let text = function.unconverted(*call.arguments.get(index)?);
    let ExprKind::Address(place) = function.exprs[text].kind else { return None };
    let PlaceKind::Symbol(symbol, 0) = function.places[place].kind else { return None };
    let literal = unit.symbols.get(symbol).filter(|symbol| symbol.is_anonymous())?;
    let Definition::Data(data) = &literal.definition else { return None };
    data.bytes.strip_suffix(&[0])
}

/// A function that takes a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FormatFunction {
    /// The index of the format argument, counted from 0.
    pub(super) format: usize,
    /// True for `scanf` and its kind, which store through their arguments.
    pub(super) is_scan: bool,
}

impl FormatFunction {
    /// The function of this name, if it takes a format and variable arguments.
    pub(super) fn by_name(name: &str) -> Option<Self> {
        let function = row_named(name).filter(|row| row.is_variadic)?;
        let format = function.argument(|role| matches!(role, Role::PrintFormat | Role::ScanFormat))?;
        Some(Self { format, is_scan: function.params[format].role == Role::ScanFormat })
    }
}

/// An argument after the format: its type after array and function names became pointers, and its place.
type PassedArgument = (TypeId, Span);

/// A mismatch.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Finding {
    /// The argument that does not match; `None` if the format itself is wrong.
    argument: Option<PassedArgument>,
    /// The message.
    message: String,
    /// A conversion that would match.
    help: Option<String>,
    /// True if the mistake is a missing `&`.
    lacks_address: bool,
}

impl Finding {
    fn into_diagnostic(self, program: &AnalysedProgram<'_>, format: Span) -> Diagnostic {
        let lint = if self.lacks_address { Lint::MissingAddress } else { Lint::Format };
        let diagnostic = match self.argument {
            Some((ty, span)) => {
                Diagnostic::warning(lint, span, self.message).at(format!("this is `{}`", program.spell(ty)))
            }
            None => Diagnostic::warning(Lint::Format, format, self.message),
        };
        match self.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    }
}

/// A conversion as a message names it: a line end would break the message.
fn printable(conversion: &[u8]) -> String {
    let text = String::from_utf8_lossy(conversion);
    let escaped = text
        .chars()
        .map(|one| if one.is_control() { one.escape_default().to_string() } else { one.to_string() });
    escaped.collect()
}

/// Compares a format with the arguments after it.
fn compare(
    types: &Types,
    function: FormatFunction,
    format: &[u8],
    arguments: &[PassedArgument],
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut left = arguments.iter();
    let mut rest = format;
    while let Some(start) = rest.iter().position(|byte| *byte == b'%') {
        let (conversion, behind) = Conversion::parse(&rest[start + 1..], function.is_scan);
        let spelled = printable(&rest[start..rest.len() - behind.len()]);
        rest = behind;
        if conversion.letter == b'%' || conversion.is_suppressed {
            continue;
        }
        if conversion.letter == 0 {
            findings.push(finding(
                None,
                format!("`{spelled}` is not a conversion"),
                Some("write `%%` for a percent sign".to_owned()),
            ));
            return findings;
        }
        for _ in 0..conversion.stars {
            if let Some(&argument) = left.next().filter(|argument| !is_int(argument.0)) {
                findings.push(finding(
                    Some(argument),
                    format!("the `*` of `{spelled}` needs an `int`"),
                    None,
                ));
            }
        }
        let Some(&argument) = left.next() else {
            findings.push(finding(None, format!("there is no argument for `{spelled}`"), None));
            return findings;
        };
        let wanted = if function.is_scan {
            conversion.scanned(types, argument.0)
        } else {
            conversion.printed(types, argument.0)
        };
        if let Err(wanted) = wanted {
            let help = if function.is_scan {
                scan_help(types, argument.0)
            } else {
                conversion.print_help(types, argument.0)
            };
            let lacks_address = function.is_scan && types.pointee(argument.0).is_none();
            let message = format!("`{spelled}` needs {wanted}");
            findings.push(Finding { lacks_address, ..finding(Some(argument), message, help) });
        }
    }
    let further = left.len();
    if let Some(&argument) = left.next() {
        let are = if further == 1 { "argument is" } else { "arguments are" };
        findings.push(finding(Some(argument), format!("{further} {are} not in the format"), None));
    }
    findings
}

fn finding(argument: Option<PassedArgument>, message: String, help: Option<String>) -> Finding {
    Finding { argument, message, help, lacks_address: false }
}

/// A `%` sequence.
#[derive(Clone, Copy, Debug)]
struct Conversion {
    /// The letter; 0 if there is no known one.
    letter: u8,
    /// Number of `*` that take an argument.
    stars: u32,
    /// `*` in `scanf`: reads without storing.
    is_suppressed: bool,
    /// Number of `l`; `L` counts one.
    longs: u32,
    /// Number of `h`.
    halves: u32,
}

impl Conversion {
    /// Reads a conversion after `%`; returns it with the rest of the format.
    fn parse(text: &[u8], is_scan: bool) -> (Self, &[u8]) {
        let mut conversion = Self { letter: 0, stars: 0, is_suppressed: false, longs: 0, halves: 0 };
        let mut rest = text;
        while let Some((&byte, behind)) = rest.split_first() {
            rest = behind;
            match byte {
                b'-' | b'+' | b' ' | b'#' | b'0'..=b'9' | b'.' => {}
                b'*' if is_scan => conversion.is_suppressed = true,
                b'*' => conversion.stars += 1,
                b'l' | b'L' => conversion.longs += 1,
                b'h' => conversion.halves += 1,
                b'[' if is_scan => {
                    conversion.letter = byte;
                    // A `]` directly after `[` or `[^` belongs to the set.
                    let skip = 1 + usize::from(rest.first() == Some(&b'^'));
                    let end = rest.iter().skip(skip).position(|byte| *byte == b']').map(|end| end + skip + 1);
                    return (conversion, end.and_then(|end| rest.get(end..)).unwrap_or_default());
                }
                b'%' | b'd' | b'i' | b'u' | b'x' | b'X' | b'o' | b'c' | b's' | b'p' | b'n' | b'e' | b'E'
                | b'f' | b'F' | b'g' | b'G' => {
                    conversion.letter = byte;
                    return (conversion, rest);
                }
                _ => return (conversion, rest),
            }
        }
        (conversion, rest)
    }

    /// Checks that `printf` prints this type; the error is the type it expects.
    fn printed(self, types: &Types, ty: TypeId) -> Result<(), &'static str> {
        let (fits, wanted) = match self.letter {
            b'd' | b'i' | b'u' | b'x' | b'X' | b'o' | b'c' if self.longs >= 2 => {
                (ty.is_long_long(), "a `long long`")
            }
            b'd' | b'i' | b'u' | b'x' | b'X' | b'o' | b'c' => (is_int(ty), "an `int`"),
            b's' => (points_to(types, ty, |to| to.is_character() || to.is_void()), "a string"),
            b'p' => (types.is_pointer(ty), "a pointer"),
            b'n' => (points_to(types, ty, is_int), "a pointer to `int`"),
            _ => (ty.is_floating(), "a `double`"),
        };
        if fits { Ok(()) } else { Err(wanted) }
    }

    /// Checks that `scanf` can store through this type; the error is the type it expects.
    fn scanned(self, types: &Types, ty: TypeId) -> Result<(), &'static str> {
        let sized = |size| points_to(types, ty, |to| to.is_integer() && types.size_of(to) == Some(size));
        let (fits, wanted) = match self.letter {
            b's' | b'c' | b'[' => {
                (points_to(types, ty, |to| to.is_character() || to.is_void()), "a `char *`")
            }
            b'p' => (points_to(types, ty, |to| types.is_pointer(to)), "a pointer to a pointer"),
            b'e' | b'E' | b'f' | b'F' | b'g' | b'G' if self.longs > 0 => {
                (points_to(types, ty, |to| to == Types::DOUBLE), "a `double *`")
            }
            b'e' | b'E' | b'f' | b'F' | b'g' | b'G' => {
                (points_to(types, ty, |to| to == Types::FLOAT), "a `float *`")
            }
            _ if self.longs >= 2 => (sized(8), "a `long long *`"),
            _ if self.halves == 1 => (sized(2), "a `short *`"),
            _ if self.halves >= 2 => (sized(1), "a `char *`"),
            _ => (sized(4), "an `int *`"),
        };
        if fits { Ok(()) } else { Err(wanted) }
    }
}

/// Reports whether a value of the type is passed as a word and is an integer.
fn is_int(ty: TypeId) -> bool {
    ty.is_integer() && !ty.is_long_long()
}

fn points_to(types: &Types, ty: TypeId, is_wanted: impl Fn(TypeId) -> bool) -> bool {
    types.pointee(ty).is_some_and(|to| is_wanted(to.ty))
}

impl Conversion {
    /// The advice for an argument that does not match: the value to which it points, if that would match, or another
    /// conversion.
    fn print_help(self, types: &Types, ty: TypeId) -> Option<String> {
        let to = types.pointee(ty).map(|to| to.ty).filter(|to| !to.is_character());
        match to {
            Some(to) if self.printed(types, to).is_ok() => {
                Some("write `*` before it for the value that it points to".to_owned())
            }
            None if self.letter == b's' && is_int(ty) => {
                Some("use `%c` for a character, `%d` for a number".to_owned())
            }
            _ => print_help(types, ty),
        }
    }
}

fn print_help(types: &Types, ty: TypeId) -> Option<String> {
    let conversion = match () {
        () if ty.is_floating() => "%f",
        () if ty.is_long_long() => "%lld",
        () if ty.is_integer() => "%d",
        () if points_to(types, ty, TypeId::is_character) => "%s",
        () if types.is_pointer(ty) => "%p",
        () => return None,
    };
    Some(format!("use `{conversion}`"))
}

fn scan_help(types: &Types, ty: TypeId) -> Option<String> {
    let Some(to) = types.pointee(ty) else { return Some("pass the address with `&`".to_owned()) };
    let conversion = match to.ty {
        Types::DOUBLE => "%lf",
        Types::FLOAT => "%f",
        ty if ty.is_character() => "%s",
        Types::SHORT | Types::UNSIGNED_SHORT => "%hd",
        ty if is_int(ty) => "%d",
        _ => return None,
    };
    Some(format!("use `{conversion}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(function: &str, format: &str, arguments: &[TypeId], types: &Types) -> Vec<String> {
        let function = FormatFunction::by_name(function).expect("known");
        let arguments: Vec<_> = arguments.iter().map(|ty| (*ty, Span::new(0, 0))).collect();
        compare(types, function, format.as_bytes(), &arguments)
            .into_iter()
            .map(|finding| finding.message)
            .collect()
    }

    #[test]
    fn matching_formats_give_no_warning() {
        let mut types = Types::new();
        let text = types.pointer_to(Types::CHAR);
        let arguments =
            [Types::INT, Types::UNSIGNED, Types::FLOAT, text, Types::DOUBLE, Types::CHAR, Types::INT];
        let format = "%d %08X %0.lf %s %.17g %c %%%5d\n";
        assert_eq!(messages("printf", format, &arguments, &types), [""; 0]);
        let (int, double) = (types.pointer_to(Types::INT), types.pointer_to(Types::DOUBLE));
        assert_eq!(messages("sscanf", "%d,%lf %*d %[^]]x%n", &[int, double, text, int], &types), [""; 0]);
    }

    #[test]
    fn mismatched_formats_say_what_they_need() {
        let mut types = Types::new();
        let int = types.pointer_to(Types::INT);
        let check = |function, format, arguments: &[TypeId], expect: &str| {
            assert_eq!(messages(function, format, arguments, &types), [expect], "{format}");
        };
        check("printf", "%d", &[Types::DOUBLE], "`%d` needs an `int`");
        check("printf", "%5.2f", &[Types::INT], "`%5.2f` needs a `double`");
        check("printf", "%d", &[int], "`%d` needs an `int`");
        check("printf", "%d %d", &[Types::INT], "there is no argument for `%d`");
        check("printf", "%d", &[Types::INT, Types::INT], "1 argument is not in the format");
        check("printf", "50% of", &[], "there is no argument for `% o`");
        check("printf", "%k", &[Types::INT], "`%k` is not a conversion");
        check("printf", "100%\n", &[], "`%\\n` is not a conversion");
        check("sscanf", "%d", &[Types::INT], "`%d` needs an `int *`");
        check("fscanf", "%lf", &[int], "`%lf` needs a `double *`");
    }
}
