//! An element of `persist.UserData` that holds a floating-point number and is read as an integer, one that holds an
//! integer and is read as a floating-point number, halves of a `double` ([`halves`]), and numbers of a program in the mailbox ([`mailbox`]).
//!
//! The types of the PC's elements are those of `gather-persist-console.md` sections 5 and 8.

mod halves;
mod mailbox;

use std::collections::{BTreeMap, BTreeSet};

use super::format::literal_format;
use super::program::{AnalysedProgram, PERSIST};
use super::user_data_index::{self, MAILBOX, PC_FLOATS};
use super::value_range::single_stores;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::{TypeId, Types};
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind};

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
    halves::stored_over(program, &stores, sink);
    halves::integers_stored(program, &stores, sink);
    for function in program.functions() {
        let elements = Elements::of(program, function);
        let walk = Walk { function, extent: Extent::All };
        let copied = copied(function);
        halves::integers_read(&elements, &stores, sink);
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
                sink.report(mailbox::double(element, span));
            }
            let is_mailbox = element == *MAILBOX.start() && !is_double;
            if is_mailbox
                && mailbox::is_own_number(program, function, expr)
                && *has_none.get_or_insert_with(|| mailbox::makes_no_requests(program))
            {
                sink.report(mailbox::own_number(span));
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
