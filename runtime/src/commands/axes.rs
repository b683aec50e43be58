//! Settings of an axis, each a field of its structure, and enabling.

use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{AxisId, Field};
use vm::memory::GuestMemory;

use super::arguments::Values;
use super::motion::planned_answer;
use super::numbers::{format_plain, format_precise};
use super::session::{Answer, Session};
use crate::firmware::motion;
use crate::views::TypedAccess;

/// Reports or sets an integer; its limits are the table's.
pub(super) fn integer(session: &mut Session<'_, '_>, values: &Values, field: Field<i32>) -> Answer {
    if values.is_question() {
        return session.memory().axis(values.axis(), field).into();
    }
    session.memory().set_axis(values.axis(), field, values.integer(1));
    Answer::Nothing
}

/// Reports or sets a word, in hexadecimal.
pub(super) fn word(session: &mut Session<'_, '_>, values: &Values, field: Field<i32>) -> Answer {
    if values.is_question() {
        return format!("{:X}", session.memory().axis(values.axis(), field)).into();
    }
    session.memory().set_axis(values.axis(), field, values.word(1).cast_signed());
    Answer::Nothing
}

/// Reports or sets a single.
pub(super) fn single(session: &mut Session<'_, '_>, values: &Values, field: Field<f32>) -> Answer {
    if values.is_question() {
        return format_plain(session.memory().axis(values.axis(), field).into()).into();
    }
    session.memory().set_axis(values.axis(), field, values.single(1));
    Answer::Nothing
}

/// Reports or sets a double.
pub(super) fn double(session: &mut Session<'_, '_>, values: &Values, field: Field<f64>) -> Answer {
    if values.is_question() {
        let dialect = session.parts.level.behaviour().text;
        return format_precise(dialect, session.memory().axis(values.axis(), field)).into();
    }
    session.memory().set_axis(values.axis(), field, values.real(1));
    Answer::Nothing
}

/// Reports or sets the five coefficients of a filter.
pub(super) fn filter(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let filter = Chan::IIR.element(values.count(1));
    let fields = [Iir::A1, Iir::A2, Iir::B0, Iir::B1, Iir::B2].map(|field| filter.field(field));
    if values.is_question() {
        let numbers = fields.map(|field| format_plain(session.memory().axis(values.axis(), field).into()));
        return numbers.join(" ").into();
    }
    for (index, field) in fields.into_iter().enumerate() {
        session.memory().set_axis(values.axis(), field, values.single(index + 2));
    }
    Answer::Nothing
}

/// Reports whether an axis is enabled. The released firmware cannot set it, and stops at any further argument.
pub(super) fn enabled(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    if values.is_question() {
        return session.memory().axis(values.axis(), Chan::ENABLE).into();
    }
    Answer::Stopped(Box::new(Answer::Nothing))
}

pub(super) fn enable(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    planned_answer(session.call(|parts, caller| motion::enable_axis(parts, caller, values.integer(0))))
}

pub(super) fn enable_dest(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, dest) = (values.integer(0), values.real(1));
    planned_answer(session.call(|parts, caller| motion::enable_axis_dest(parts, caller, axis, dest)))
}

pub(super) fn disable(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| motion::disable_axis(parts, caller, values.integer(0)));
    Answer::Nothing
}

pub(super) fn zero(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| motion::zero(parts, caller, values.integer(0)));
    Answer::Nothing
}

/// The address of an axis, as firmware functions take it.
pub(super) fn pointer(memory: &GuestMemory, axis: AxisId) -> kmotiondef::GuestAddr {
    memory.locate(crate::views::chan(axis))
}
