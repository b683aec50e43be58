//! Entries sent by the PC: lines, arcs and commands, each stored at the next free entry.
//!
//! The board reads all numbers of a download as singles.

use std::f32::consts::FRAC_PI_2;

use kmotiondef::modes::TrajectoryMode;
use kmotiondef::structs::{ParametricCoeff, TripCircleLinear, TripLinear};
use kmotiondef::{AxisId, Field};
use vm::memory::GuestMemory;

use super::buffer;
use super::segment::{Command, Entry};
use super::system::{self, LETTERS};
use crate::out::Message;
use crate::views::TypedAccess;

/// The positions of the eight letters.
pub(crate) type Point = [f32; LETTERS];

const AXES: [Field<u8>; LETTERS] = [
    ParametricCoeff::X_AXIS,
    ParametricCoeff::Y_AXIS,
    ParametricCoeff::Z_AXIS,
    ParametricCoeff::A_AXIS,
    ParametricCoeff::B_AXIS,
    ParametricCoeff::C_AXIS,
    ParametricCoeff::U_AXIS,
    ParametricCoeff::V_AXIS,
];

/// The coefficients of the letters after X and Y.
const LINEAR: [Field<TripLinear>; LETTERS - 2] = [
    ParametricCoeff::COORD_Z,
    ParametricCoeff::COORD_A,
    ParametricCoeff::COORD_B,
    ParametricCoeff::COORD_C,
    ParametricCoeff::COORD_U,
    ParametricCoeff::COORD_V,
];

/// The value of a slot without an axis.
const UNUSED: u8 = 255;

/// The parameter as a function of time, and its duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Timing {
    /// Coefficients of t³, t², t and 1.
    pub(crate) polynomial: [f32; 4],
    /// Seconds.
    pub(crate) duration: f32,
}

/// The plane of an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    /// X is the cosine, Y the sine.
    Xy,
    /// Z is the cosine, X the sine.
    Zx,
    /// Y is the cosine, Z the sine.
    Yz,
}

impl Plane {
    /// The letters of cosine and sine, and the remaining one.
    fn letters(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }
}

/// The circle, or ellipse, of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    /// Its plane.
    pub(crate) plane: Plane,
    /// Its centre, cosine letter first.
    pub(crate) centre: [f32; 2],
    /// Its radii.
    pub(crate) radii: [f32; 2],
    /// The angle at which it begins, in radians.
    pub(crate) angle: f32,
    /// The angle that it covers, in radians.
    pub(crate) turn: f32,
}

/// Adds a line.
///
/// # Errors
/// As [`buffer::advance`].
pub(crate) fn line(
    memory: &mut GuestMemory,
    begin: &Point,
    end: &Point,
    timing: &Timing,
) -> Result<(), Message> {
    let letters = [0, 1, 2, 3, 4, 5, 6, 7];
    let Some(entry) = begin_segment(memory, TrajectoryMode::Linear, letters, timing) else { return Ok(()) };
    let has_y = system::letters(memory)[1].is_some();
    let coefficients = [ParametricCoeff::COORD_X, ParametricCoeff::COORD_Y];
    for (coefficients, letter) in coefficients.into_iter().zip(0..).take(if has_y { 2 } else { 1 }) {
        let (from, to) = (f64::from(begin[letter]), f64::from(end[letter]));
        set_arc(memory, entry, coefficients, [0.0, 0.0, to - from, from]);
    }
    set_lines(memory, entry, letters, begin, end);
    buffer::advance(memory)
}

/// Adds an arc; `begin` and `end` count for the letters outside its plane.
///
/// # Errors
/// As [`buffer::advance`].
pub(crate) fn arc(
    memory: &mut GuestMemory,
    circle: &Circle,
    begin: &Point,
    end: &Point,
    timing: &Timing,
) -> Result<(), Message> {
    let [cosine, sine, rest] = circle.plane.letters();
    let letters = [cosine, sine, rest, 3, 4, 5, 6, 7];
    let Some(entry) = begin_segment(memory, TrajectoryMode::Circular, letters, timing) else { return Ok(()) };
    let turn = f64::from(circle.turn);
    let [cosine_angle, sine_angle] = [circle.angle + FRAC_PI_2, circle.angle].map(f64::from);
    let [radius_x, radius_y] = circle.radii.map(f64::from);
    let [x, y] = circle.centre.map(f64::from);
    set_arc(memory, entry, ParametricCoeff::COORD_X, [turn, cosine_angle, radius_x, x]);
    set_arc(memory, entry, ParametricCoeff::COORD_Y, [turn, sine_angle, radius_y, y]);
    set_lines(memory, entry, letters, begin, end);
    buffer::advance(memory)
}

/// Adds a command.
///
/// # Errors
/// As [`buffer::advance`].
pub(crate) fn command(memory: &mut GuestMemory, command: Command) -> Result<(), Message> {
    let entry = buffer::next_written(memory);
    let (number, bit) = command.encode();
    set_mode(memory, entry, TrajectoryMode::Special);
    memory.set(entry.field(ParametricCoeff::X_AXIS), number);
    memory.set(entry.field(ParametricCoeff::SPECIAL_PARAM), bit);
    memory.set(entry.field(ParametricCoeff::T), 0.0);
    buffer::advance(memory)
}

/// Begins the next entry with its timing and the axes of its slots; a segment without duration is left out.
fn begin_segment(
    memory: &mut GuestMemory,
    mode: TrajectoryMode,
    letters: [usize; LETTERS],
    timing: &Timing,
) -> Option<Entry> {
    if timing.duration == 0.0 {
        return None;
    }
    let entry = buffer::next_written(memory);
    set_mode(memory, entry, mode);
    let axes = system::letters(memory);
    for (slot, letter) in AXES.into_iter().zip(letters) {
        memory.set(entry.field(slot), axes[letter].map_or(UNUSED, AxisId::get));
    }
    memory.set(entry.field(ParametricCoeff::T), f64::from(timing.duration));
    let fields = [ParametricCoeff::A, ParametricCoeff::B, ParametricCoeff::C, ParametricCoeff::D];
    for (field, coefficient) in fields.into_iter().zip(timing.polynomial) {
        memory.set(entry.field(field), f64::from(coefficient));
    }
    Some(entry)
}

fn set_mode(memory: &mut GuestMemory, entry: Entry, mode: TrajectoryMode) {
    memory.set(entry.field(ParametricCoeff::TRAJECTORY_MODE), mode.get() as i8);
}

fn set_arc(memory: &mut GuestMemory, entry: Entry, coefficients: Field<TripCircleLinear>, values: [f64; 4]) {
    let fields = [TripCircleLinear::A, TripCircleLinear::B, TripCircleLinear::C, TripCircleLinear::D];
    for (field, value) in fields.into_iter().zip(values) {
        memory.set(entry.field(coefficients.field(field)), value);
    }
}

/// Fills the slots after the first two. Board quirk: the slot of the remaining letter of X, Y and Z is filled if Z has
/// an axis, whichever letter it is; slots that are not filled keep their old contents.
fn set_lines(memory: &mut GuestMemory, entry: Entry, letters: [usize; LETTERS], begin: &Point, end: &Point) {
    let has_axis = system::letters(memory).map(|axis| axis.is_some());
    let slots = LINEAR.into_iter().zip(letters.into_iter().skip(2)).zip(has_axis.into_iter().skip(2));
    for ((coefficients, letter), _) in slots.filter(|(_, has_axis)| *has_axis) {
        let (from, to) = (f64::from(begin[letter]), f64::from(end[letter]));
        memory.set(entry.field(coefficients.field(TripLinear::C)), to - from);
        memory.set(entry.field(coefficients.field(TripLinear::D)), from);
    }
}
