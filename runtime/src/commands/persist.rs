//! Persistent variables.

use kmotiondef::Place;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;

use super::arguments::Values;
use super::session::{Answer, Session};
use crate::views::TypedAccess;

/// The element selected by the first argument.
fn element(values: &Values) -> Place<i32> {
    PERSIST.field(Persist::USER_DATA).element(values.count(0))
}

pub(super) fn get_decimal(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.memory().get(element(values)).into()
}

pub(super) fn get_hex(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    format!("{:X}", session.memory().get(element(values))).into()
}

/// A real is truncated toward zero and saturates.
pub(super) fn set_decimal(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.memory().set(element(values), values.real(1) as i32);
    Answer::Nothing
}

pub(super) fn set_hex(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.memory().set(element(values), values.word(1).cast_signed());
    Answer::Nothing
}
