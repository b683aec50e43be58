//! Coordinated motion: the coordinate system, the buffer and its segments, overrides, spindle.
//!
//! A segment that is sent in hexadecimal omits the points that the board remembers: its beginning (`LHex1`), or its
//! beginning and end (`LHex2`). [`Geometry`] remembers them.

use kmotiondef::structs::Spindle;
use kmotiondef::variables::{CS0_STOPPING_STATE, SPINDLE};

use super::arguments::Values;
use super::memory::Geometry;
use super::motion::planned_answer;
use super::numbers::{format_fixed, time};
use super::session::{Answer, Session};
use crate::firmware::{coord, spindle};
use crate::out::Message;
use crate::servo::coordinated::download::{self, Circle, Plane, Point, Timing};
use crate::servo::coordinated::segment::Command;
use crate::servo::coordinated::system::{LETTERS, letters};
use crate::servo::coordinated::{buffer, rate, system};
use crate::servo::hold;
use crate::views::TypedAccess;

/// Letters of the commands without U and V.
const SIX: usize = 6;

/// Coefficients of the parameter as a function of time.
const TIMING: usize = 5;

fn timing(numbers: &[f32]) -> Timing {
    let number = |index: usize| numbers.get(index).copied().unwrap_or(0.0);
    Timing { polynomial: std::array::from_fn(number), duration: number(4) }
}

/// The letters from `first` on, set from numbers; the others are 0.
fn point(first: usize, numbers: &[f32]) -> Point {
    let mut point = [0.0; LETTERS];
    for (letter, number) in point.iter_mut().skip(first).zip(numbers) {
        *letter = *number;
    }
    point
}

/// Reports the state of the buffer.
fn report_buffer(session: &mut Session<'_, '_>, result: Result<(), Message>) -> Answer {
    if let Err(message) = result {
        session.parts.out.remark(session.context.now, message);
    }
    Answer::Nothing
}

/// Adds a line.
fn add_line(session: &mut Session<'_, '_>, begin: Point, end: Point, numbers: &[f32]) -> Answer {
    let result = download::line(session.memory(), &begin, &end, &timing(numbers));
    report_buffer(session, result)
}

/// `Linear` and its variants with `letters` letters: beginning, end, timing.
pub(super) fn linear(session: &mut Session<'_, '_>, values: &Values, letters: usize) -> Answer {
    let numbers = values.singles();
    let (begin, rest) = numbers.split_at(letters.min(numbers.len()));
    let (end, timing) = rest.split_at(letters.min(rest.len()));
    add_line(session, point(0, begin), point(0, end), timing)
}

/// `LinearHex` and its variants: as `linear`, and remembered.
pub(super) fn linear_hex(session: &mut Session<'_, '_>, values: &Values, letters: usize) -> Answer {
    let numbers = values.singles();
    let (begin, rest) = numbers.split_at(letters.min(numbers.len()));
    let (end, timing) = rest.split_at(letters.min(rest.len()));
    *session.geometry = Geometry { begin: point(0, begin), end: point(0, end) };
    linear_again_with(session, timing)
}

/// Adds a line from the end of the previous segment: `LHex1` and its variants.
pub(super) fn linear_on(session: &mut Session<'_, '_>, values: &Values, letters: usize) -> Answer {
    let numbers = values.singles();
    let (end, timing) = numbers.split_at(letters.min(numbers.len()));
    *session.geometry = Geometry { begin: session.geometry.end, end: point(0, end) };
    linear_again_with(session, timing)
}

/// `LHex2`: the line before again, with another timing.
pub(super) fn linear_again(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    linear_again_with(session, &values.singles())
}

fn linear_again_with(session: &mut Session<'_, '_>, timing: &[f32]) -> Answer {
    let Geometry { begin, end } = *session.geometry;
    add_line(session, begin, end, timing)
}

/// `Arc` and its variants: centre, radii, angles, the other letters' beginning and end, timing.
pub(super) fn arc(session: &mut Session<'_, '_>, values: &Values, plane: Plane) -> Answer {
    let numbers = values.singles();
    let Some((&[x, y, radius_x, radius_y, angle, turn], rest)) = numbers.split_first_chunk() else {
        return Answer::Nothing;
    };
    let circle = Circle { plane, centre: [x, y], radii: [radius_x, radius_y], angle, turn };
    let (others, numbers) = rest.split_at(rest.len().saturating_sub(TIMING));
    let (begin, end) = others.split_at(others.len() / 2);
    let [begin, end] = [begin, end].map(|numbers| other_letters(plane, numbers));
    let result = download::arc(session.memory(), &circle, &begin, &end, &timing(numbers));
    report_buffer(session, result)
}

/// The letters outside an arc's plane: first the remaining one of X, Y and Z, then A and the following.
fn other_letters(plane: Plane, numbers: &[f32]) -> Point {
    let mut letters = point(2, numbers);
    let rest = match plane {
        Plane::Xy => 2,
        Plane::Zx => 1,
        Plane::Yz => 0,
    };
    letters[rest] = numbers.first().copied().unwrap_or(0.0);
    letters
}

/// Adds a command to the buffer.
fn add(session: &mut Session<'_, '_>, command: Command) -> Answer {
    let result = download::command(session.memory(), command);
    report_buffer(session, result)
}

pub(super) fn set_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    add(session, Command::Drive(values.bit(), true))
}

pub(super) fn clear_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    add(session, Command::Drive(values.bit(), false))
}

pub(super) fn set_state_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    add(session, Command::Drive(values.bit(), values.integer(1) != 0))
}

pub(super) fn wait_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    add(session, Command::Wait(values.bit(), true))
}

pub(super) fn wait_not_bit(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    add(session, Command::Wait(values.bit(), false))
}

pub(super) fn begin_rapid(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    add(session, Command::Rapid(true))
}

pub(super) fn end_rapid(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    add(session, Command::Rapid(false))
}

pub(super) fn open(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    buffer::open(session.memory());
    Answer::Nothing
}

pub(super) fn execute(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    buffer::execute(session.memory());
    Answer::Nothing
}

pub(super) fn flush(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    buffer::flush(session.memory());
    Answer::Nothing
}

pub(super) fn executed_time(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    time(buffer::executed_time(session.memory())).into()
}

pub(super) fn check_done(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    buffer::check_done(session.memory()).into()
}

/// Reports or assigns the axes of the first `count` letters.
fn system(session: &mut Session<'_, '_>, values: &Values, count: usize) -> Answer {
    if values.is_question() {
        let axes = letters(session.memory()).map(|axis| axis.map_or(-1, |axis| i32::from(axis.get())));
        let axes: Vec<String> = axes.iter().take(count).map(ToString::to_string).collect();
        return axes.join(" ").into();
    }
    session.call(|parts, caller| coord::define(parts, caller, &values.integers()));
    Answer::Nothing
}

pub(super) fn define_cs(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    system(session, values, SIX)
}

pub(super) fn define_cs_ex(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    system(session, values, LETTERS)
}

pub(super) fn set_fro(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let time = system::nominal_change_time(session.memory());
    rate::set_feed(session.memory(), values.single(0), time);
    Answer::Nothing
}

pub(super) fn set_rapid_fro(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let time = system::nominal_change_time(session.memory());
    rate::set_rapid(session.memory(), values.single(0), time);
    Answer::Nothing
}

pub(super) fn set_fro_temp(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let time = system::nominal_change_time(session.memory());
    rate::ramp_to_override(session.memory(), values.single(0), time);
    Answer::Nothing
}

/// The overrides with a rate: each of them ends the released firmware's command loop.
pub(super) fn fro_with_rate(_: &mut Session<'_, '_>, _: &Values) -> Answer {
    Answer::Stopped(Box::new(Answer::Console("Fatal Error:Interp".into())))
}

/// Stop, resume or clear.
pub(super) fn stop_immediate(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    if values.integer(0) != 0 {
        session.call(|parts, caller| hold::complete(&mut parts.servo, caller.memory));
    }
    match values.integer(0) {
        0 => planned_answer(session.call(coord::stop_coordinated_motion)),
        1 => planned_answer(session.call(coord::resume_coordinated_motion)),
        _ => {
            session.call(coord::clear_stop_immediately);
            Answer::Nothing
        }
    }
}

pub(super) fn stop_state(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    hold::update_state(session.memory());
    session.memory().get(CS0_STOPPING_STATE).into()
}

pub(super) fn configure_spindle(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (kind, axis) = (values.integer(0), values.integer(1));
    let [update, tau, counts] = [2, 3, 4].map(|index| values.single(index));
    session.call(|parts, caller| spindle::configure_spindle(parts, caller, kind, axis, update, tau, counts));
    Answer::Nothing
}

pub(super) fn trigger_threading(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let speed = values.single(0);
    session.call(|parts, caller| spindle::trig_threading(parts, caller, speed));
    Answer::Nothing
}

pub(super) fn spindle_speed(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    format_fixed(session.memory().get(SPINDLE.field(Spindle::TRUE_SPEED_RPS)).into()).into()
}
