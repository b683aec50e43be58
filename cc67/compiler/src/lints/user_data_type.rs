//! An element of `persist.UserData` that holds a floating-point number and is read as an integer, one that holds an
//! integer and is read as a floating-point number, an element that is stored over half of a `double`, and a `double` in the elements through which a program and the PC exchange requests.
//!
//! The types of the PC's elements are those of `gather-persist-console.md` sections 5 and 8.

use std::collections::{BTreeMap, BTreeSet};

use super::format::literal_format;
use super::program::{AnalysedProgram, PERSIST};
use super::user_data_index;
use super::value_range::single_stores;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, StmtKind};

/// Elements in which the PC stores a `float`: offset, factor, speed and limit of constant surface speed.
const PC_FLOATS: std::ops::RangeInclusive<i32> = 111..=114;

/// Elements of requests to the PC: the code, and what belongs to it.
const MAILBOX: std::ops::RangeInclusive<i32> = 100..=107;

/// Bytes of an element.
const ELEMENT: i32 = 4;

/// The stores of a program in an element.
#[derive(Clone, Copy, Default)]
struct Stores {
    /// The first store of a floating-point number, and its type.
    floating: Option<(Span, TypeId)>,
    /// True if other values are stored there as well.
    has_others: bool,
    /// The first store of a small constant other than 0, whose bits are next to 0 as a floating-point number.
    small: Option<(Span, i64)>,
    /// True if anything else is stored there, such as 0 or a value that is computed.
    has_more: bool,
    /// The first store that begins there, of anything but 0, and its type.
    begun: Option<(Span, TypeId)>,
    /// The first store of 0 that begins there, and its type.
    zero: Option<(Span, TypeId)>,
    /// The first store of a `double` whose second half is there.
    second_half: Option<Span>,
}

/// Reports elements of one type that are used as another.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let stores = stores(program, sink);
    overlaps(program, &stores, sink);
    halves(program, &stores, sink);
    for function in program.functions() {
        let elements = Elements::of(program, function);
        let walk = Walk { function, extent: Extent::All };
        let copied = copied(function);
        second_halves(&elements, &stores, sink);
        walk.stmts(&function.body, &mut |expr| {
            sink.report_if(integer_bits(&elements, expr, &stores));
            if !copied.contains(&expr) {
                sink.report_if(bits_of_the_pc(&elements, expr, &stores));
            }
            for (value, use_of) in uses(program, function, expr) {
                let Some(element) = elements.integer_load(value) else { continue };
                let stored = stores.get(&element).copied().unwrap_or_default();
                if is_float_of_the_pc(program, element) && stored.begun.is_none() {
                    continue;
                }
                let span = function.exprs[value].span;
                let message = format!("`persist.UserData[{element}]` is read as an integer");
                let finding = Diagnostic::warning(Lint::UserDataType, span, message);
                let (what, finding) = match stored.floating {
                    Some((place, ty)) if !stored.has_others => {
                        let what = program.spell(ty);
                        let label = format!("a `{what}` is stored here");
                        (what, finding.label(place, label))
                    }
                    None if PC_FLOATS.contains(&element) && use_of == Use::Floating => {
                        ("float".to_owned(), finding.note("the PC stores a `float` there"))
                    }
                    _ => continue,
                };
                let even = element - element % 2;
                let index = if what == "double" { even } else { element };
                sink.report(
                    finding
                        .at("the bits of a floating-point number")
                        .help(format!("write `*({what} *)&persist.UserData[{index}]`")),
                );
            }
        });
    }
}

/// Reports stores in the second half of a `double`, unless the program uses its first half as an integer as well.
fn overlaps(program: &AnalysedProgram<'_>, stores: &BTreeMap<i32, Stores>, sink: &mut Sink) {
    for (element, stored) in stores {
        let (Some((span, ty)), Some(double)) = (stored.begun, stored.second_half) else { continue };
        let first = stores.get(&(element - 1)).copied().unwrap_or_default();
        if first.has_others || ty == Types::DOUBLE && double == span {
            continue;
        }
        let message = format!("`persist.UserData[{element}]` is the second half of a `double`");
        sink.report(
            Diagnostic::warning(Lint::UserDataType, span, message)
                .at(format!("a `{}` overwrites it", program.spell(ty)))
                .label(double, format!("elements {} and {element} hold this one", element - 1))
                .help("a `double` takes two elements: use the next even index after it"),
        );
    }
}

/// Reports integers that are stored in one half of a `double` which the same program reads.
fn halves(program: &AnalysedProgram<'_>, stores: &BTreeMap<i32, Stores>, sink: &mut Sink) {
    let is_int = |element: i32| {
        stores.get(&element).is_some_and(|stored| stored.has_others && stored.floating.is_none())
    };
    let mut reported = BTreeSet::new();
    for function in program.functions() {
        let elements = Elements::of(program, function);
        for expr in function.exprs.values() {
            let ExprKind::Load(place) = expr.kind else { continue };
            if function.places[place].ty != Types::DOUBLE {
                continue;
            }
            let Some(first) = elements.element(place) else { continue };
            // Both halves together are a copy.
            let (half, which) = match (is_int(first), is_int(first + 1)) {
                (true, false) => (first, "first"),
                (false, true) => (first + 1, "second"),
                (true, true) | (false, false) => continue,
            };
            let Some((span, _)) = stores.get(&half).and_then(|stored| stored.begun.or(stored.zero)) else {
                continue;
            };
            if !reported.insert(half) {
                continue;
            }
            let message = format!("`persist.UserData[{half}]` is the {which} half of a `double`");
            sink.report(
                Diagnostic::warning(Lint::UserDataType, span, message)
                    .at("an `int` overwrites it")
                    .label(
                        expr.span,
                        format!("elements {first} and {} are read as a `double` here", first + 1),
                    )
                    .help(
                        "a `double` takes two elements: index N of the doubles is elements 2 N and 2 N + 1",
                    ),
            );
        }
    }
}

/// Reports an element that is read as a floating-point number where the program only stores small integers.
fn integer_bits(
    elements: &Elements<'_, '_>,
    expr: ExprId,
    stores: &BTreeMap<i32, Stores>,
) -> Option<Diagnostic> {
    let Elements { program, function, .. } = *elements;
    let ExprKind::Load(place) = function.exprs[expr].kind else { return None };
    let ty = function.places[place].ty;
    let element = elements.element(place).filter(|_| ty.is_floating())?;
    let stored = stores.get(&element).filter(|stored| !stored.has_more && stored.floating.is_none())?;
    let (place, value) = stored.small?;
    // The PC answers in the mailbox, and other functions may have told it to store something else.
    let is_pcs = MAILBOX.contains(&element) || PC_FLOATS.contains(&element);
    if is_pcs || !function.exprs.values().any(|expr| expr.span == place) {
        return None;
    }
    let message = format!("`persist.UserData[{element}]` is read as a `{}`", program.spell(ty));
    Some(
        Diagnostic::warning(Lint::UserDataType, function.exprs[expr].span, message)
            .at(format!("the bits of the integer {value}, which are a number next to 0"))
            .label(place, "an `int` is stored here")
            .help(format!("write `persist.UserData[{element}]`")),
    )
}

/// Reports an integer that is read from the second half of a `double`, where the first half is not one.
fn second_halves(elements: &Elements<'_, '_>, stores: &BTreeMap<i32, Stores>, sink: &mut Sink) {
    let exprs = &elements.function.exprs;
    // A print may show the halves on purpose.
    let printed: BTreeSet<ExprId> =
        elements.function.calls().flat_map(|(_, call)| call.variable.iter().flatten().copied()).collect();
    let loads = exprs.iter().filter(|(id, _)| !printed.contains(id));
    let loads = loads.filter_map(|(id, expr)| Some((elements.integer_load(id)?, expr.span)));
    let loads: Vec<_> = loads.collect();
    let loaded: BTreeSet<i32> = loads.iter().map(|(element, _)| *element).collect();
    let is_double = |element: i32| {
        let first = stores.get(&(element - 1)).copied().unwrap_or_default();
        !first.has_others && !loaded.contains(&(element - 1))
    };
    let found = loads.iter().find_map(|(element, span)| {
        let double = stores.get(element)?.second_half.filter(|_| is_double(*element))?;
        Some((element, span, double))
    });
    let Some((element, span, double)) = found else { return };
    let message = format!("`persist.UserData[{element}]` is the second half of a `double`");
    sink.report(
        Diagnostic::warning(Lint::UserDataType, *span, message)
            .at("read as an integer")
            .label(double, format!("this `double` is in elements {} and {element}", element - 1))
            .help(
                "use an element that no `double` takes: index N of the doubles is elements 2 N and 2 N + 1",
            ),
    );
}

/// Returns whether the PC stores a `float` in an element before the program starts.
fn is_float_of_the_pc(program: &AnalysedProgram<'_>, element: i32) -> bool {
    u32::try_from(element).is_ok_and(|element| program.float_elements.contains(&element))
}

/// Reports an element that is read as an integer, where a `float` is stored before the program starts and by nothing else.
fn bits_of_the_pc(
    elements: &Elements<'_, '_>,
    expr: ExprId,
    stores: &BTreeMap<i32, Stores>,
) -> Option<Diagnostic> {
    let Elements { program, function, .. } = *elements;
    let element = elements.integer_load(expr).filter(|element| is_float_of_the_pc(program, *element))?;
    if stores.get(&element).is_some_and(|stored| stored.begun.is_some()) {
        return None;
    }
    let message = format!("`persist.UserData[{element}]` is read as an integer");
    Some(
        Diagnostic::warning(Lint::UserDataType, function.exprs[expr].span, message)
            .at("the bits of a floating-point number")
            .note("the options of this run store a `float` there, as the PC does for M codes")
            .help(format!("write `*(float *)&persist.UserData[{element}]`")),
    )
}

/// The values that a function stores in memory as they are, such as elements that it copies.
fn copied(function: &Function) -> BTreeSet<ExprId> {
    let stored = function.exprs.values().filter_map(|expr| match expr.kind {
        ExprKind::Assign(place, value) => {
            (!matches!(function.places[place].kind, PlaceKind::Local(..))).then_some(value)
        }
        _ => None,
    });
    stored.collect()
}

/// The use of a value.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    /// It becomes a floating-point number.
    Floating,
    /// It is printed, or the like.
    Argument,
}

/// The values that an expression takes as numbers.
fn uses(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Vec<(ExprId, Use)> {
    let expr = &function.exprs[expr];
    match &expr.kind {
        ExprKind::Convert(inner) if expr.ty.is_floating() => vec![(*inner, Use::Floating)],
        ExprKind::Call(call) => {
            // `%x` shows the bits on purpose.
            let format = literal_format(program.unit, function, call);
            let shows_bits = format.is_some_and(|(_, text)| text.iter().any(|byte| b"xX".contains(byte)));
            let values = call.variable.iter().flatten().filter(|_| !shows_bits);
            values.map(|value| (*value, Use::Argument)).collect()
        }
        _ => Vec::new(),
    }
}

/// Every store at a constant index; a `double` in the mailbox is reported.
fn stores(program: &AnalysedProgram<'_>, sink: &mut Sink) -> BTreeMap<i32, Stores> {
    let mut stores: BTreeMap<i32, Stores> = BTreeMap::new();
    let mut has_none = None;
    for function in program.functions() {
        let elements = Elements::of(program, function);
        Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
            let (place, value) = match &function.exprs[expr].kind {
                ExprKind::Assign(place, value) => (*place, small(function, *value)),
                ExprKind::Update(update) => (update.place, None),
                _ => return,
            };
            let Some(element) = elements.element(place) else { return };
            let (ty, span) = (function.places[place].ty, function.exprs[expr].span);
            let is_double = ty == Types::DOUBLE;
            if is_double && MAILBOX.contains(&element) {
                sink.report(mailbox(element, span));
            }
            let is_mailbox = element == *MAILBOX.start() && !is_double;
            if is_mailbox
                && is_own_number(program, function, expr)
                && *has_none.get_or_insert_with(|| makes_no_requests(program))
            {
                sink.report(request(span));
            }
            let is_zero = matches!(function.exprs[expr].kind, ExprKind::Assign(_, value)
                if matches!(function.exprs[value].kind, ExprKind::Int(0)));
            let entry = stores.entry(element).or_default();
            if is_zero {
                entry.zero.get_or_insert((span, ty));
            } else {
                entry.begun.get_or_insert((span, ty));
            }
            if is_double {
                stores.entry(element + 1).or_default().second_half.get_or_insert(span);
            }
            for index in element..=element + i32::from(is_double) {
                let entry = stores.entry(index).or_default();
                match value {
                    Some(value) => _ = entry.small.get_or_insert((span, value)),
                    None => entry.has_more = true,
                }
                if ty.is_floating() {
                    entry.floating.get_or_insert((span, ty));
                } else {
                    entry.has_others = true;
                }
            }
        });
    }
    stores
}

/// A positive constant whose bits are next to 0 as a floating-point number.
fn small(function: &Function, value: ExprId) -> Option<i64> {
    const LARGE: i64 = 1 << 23;
    match function.exprs[value].kind {
        ExprKind::Int(value) if (1..LARGE).contains(&value) => Some(value),
        _ => None,
    }
}

fn mailbox(element: i32, span: Span) -> Diagnostic {
    let message =
        format!("a `double` is stored in `persist.UserData[{element}]`, which is part of the PC's mailbox");
    Diagnostic::warning(Lint::UserDataType, span, message)
        .at(format!("elements {element} and {}", element + 1))
        .note("elements 100 to 107 hold requests to the PC: it takes what it finds in element 100 as the code of one")
        .help("use elements outside 100 to 107: `double` index 50 is element 100")
}

/// Returns whether a program makes no requests to the PC: it stores no parameters of any and reads no answers, and no loop of
/// it waits until the PC has taken one.
fn makes_no_requests(program: &AnalysedProgram<'_>) -> bool {
    !program.functions().any(|function| {
        let others = *MAILBOX.start() + 1..=*MAILBOX.end();
        let has_parameters = |place: PlaceId| {
            element(program, function, place).is_some_and(|element| others.contains(&element))
        };
        function.places.keys().any(has_parameters) || waits_for_the_pc(program, function)
    })
}

/// Returns whether a store in the mailbox is one of a number for the program's own use, in a program without requests: it
/// names no request, and its value is not an argument.
fn is_own_number(program: &AnalysedProgram<'_>, function: &Function, store: ExprId) -> bool {
    const REQUESTS: &[u8] = b"PC_COMM";
    let is_argument = |value: ExprId| match function.exprs[value].kind {
        ExprKind::Load(place) => matches!(function.places[place].kind,
            PlaceKind::Local(local, _) if function.parameters.contains(&local)),
        _ => false,
    };
    let text = program.sources.text(function.exprs[store].span);
    if text.windows(REQUESTS.len()).any(|word| word == REQUESTS) {
        return false;
    }
    match function.exprs[store].kind {
        ExprKind::Assign(_, value) => {
            !matches!(function.exprs[value].kind, ExprKind::Int(0)) && !is_argument(value)
        }
        _ => true,
    }
}

/// Returns whether a loop of a function looks at the mailbox.
fn waits_for_the_pc(program: &AnalysedProgram<'_>, function: &Function) -> bool {
    let mut waits = false;
    function.each_stmt(&mut |stmt| {
        let StmtKind::Loop { condition: Some(condition), .. } = stmt.kind else { return };
        Walk { function, extent: Extent::All }.expr(condition, &mut |expr| {
            waits |= matches!(function.exprs[expr].kind, ExprKind::Load(place)
                if element(program, function, place) == Some(*MAILBOX.start()));
        });
    });
    waits
}

fn request(span: Span) -> Diagnostic {
    let message = format!("`persist.UserData[{}]` is the PC's mailbox", MAILBOX.start());
    Diagnostic::warning(Lint::UserDataType, span, message)
        .at("the PC takes any number here as the code of a request")
        .note("elements 100 to 107 hold requests to the PC; they are written as `PC_COMM_…`")
        .help("use an element outside 100 to 107 for a number of your own")
}

/// The elements that a function reaches, also through pointers such as `double *d = (double *)persist.UserData;`.
struct Elements<'p, 'a> {
    program: &'p AnalysedProgram<'a>,
    function: &'a Function,
    /// The byte of `persist` to which a variable always points.
    pointers: BTreeMap<LocalId, i32>,
}

impl<'p, 'a> Elements<'p, 'a> {
    fn of(program: &'p AnalysedProgram<'a>, function: &'a Function) -> Self {
        let pointers = single_stores(function, |value| address(program, function, value));
        Self { program, function, pointers }
    }

    /// The element at which a place begins.
    fn element(&self, place: PlaceId) -> Option<i32> {
        let PlaceKind::Pointer(pointer, offset) = self.function.places[place].kind else {
            return element(self.program, self.function, place);
        };
        self.pointed(pointer).and_then(|byte| element_at(byte.checked_add(offset)?))
    }

    fn pointed(&self, pointer: ExprId) -> Option<i32> {
        match self.function.exprs[pointer].kind {
            ExprKind::Convert(inner) => self.pointed(inner),
            ExprKind::Binary(BinaryOp::Add, base, bytes) => match self.function.exprs[bytes].kind {
                ExprKind::Int(bytes) => self.pointed(base)?.checked_add(bytes.try_into().ok()?),
                _ => None,
            },
            ExprKind::Load(place) => match self.function.places[place].kind {
                PlaceKind::Local(local, 0) => self.pointers.get(&local).copied(),
                _ => None,
            },
            _ => None,
        }
    }

    /// The element that is read as an integer.
    fn integer_load(&self, value: ExprId) -> Option<i32> {
        match self.function.exprs[value].kind {
            ExprKind::Load(place) if self.function.places[place].ty == Types::INT => self.element(place),
            _ => None,
        }
    }
}

/// The byte of `persist` whose address an expression is.
fn address(program: &AnalysedProgram<'_>, function: &Function, value: ExprId) -> Option<i32> {
    match function.exprs[value].kind {
        ExprKind::Convert(inner) => address(program, function, inner),
        ExprKind::Address(place) => match function.places[place].kind {
            PlaceKind::Symbol(symbol, byte) if program.name(symbol) == PERSIST => Some(byte),
            _ => None,
        },
        _ => None,
    }
}

/// The element of `persist.UserData` at which a place begins.
pub(super) fn element(program: &AnalysedProgram<'_>, function: &Function, place: PlaceId) -> Option<i32> {
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, byte) if program.name(symbol) == PERSIST => element_at(byte),
        _ => None,
    }
}

/// The element that begins at a byte of `persist`.
fn element_at(byte: i32) -> Option<i32> {
    let (first, end) = user_data_index::range();
    let is_element = (first..end).contains(&byte) && (byte - first) % ELEMENT == 0;
    is_element.then(|| (byte - first) / ELEMENT)
}
