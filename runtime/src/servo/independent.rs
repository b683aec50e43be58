//! Independent motion of an axis: its state list in guest memory, and one tick of it.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::{Chan, TripCoeff};
use kmotiondef::{AxisId, GuestAddr, GuestType, Place};
use vm::memory::GuestMemory;

use super::profile::{LEAD, MAX_STATES, Mode, MotionState, Point};
use super::trajectory::{Approach, Cursor, Step, entered, point, step};
use crate::views::{AxisView, TypedAccess, field_of};

/// The state list of an axis.
fn list(memory: &GuestMemory, axis: AxisId) -> Place<[TripCoeff; MAX_STATES]> {
    Place::new(memory.axis(axis, Chan::C))
}

/// Reads one state; beyond the list and outside of memory, the end of a list.
#[inline(always)]
fn read(memory: &GuestMemory, base: GuestAddr, index: usize) -> MotionState {
    const SIZE: usize = TripCoeff::SIZE as usize;
    let address = base.offset(TripCoeff::SIZE.wrapping_mul(index as u32));
    let Some(bytes) = memory.block::<SIZE>(address).filter(|_| index < MAX_STATES) else {
        return MotionState::END;
    };
    MotionState {
        mode: Mode::from_number(field_of(bytes, TripCoeff::TRAJECTORY_MODE)),
        t: field_of(bytes, TripCoeff::T),
        a: field_of(bytes, TripCoeff::A),
        b: field_of(bytes, TripCoeff::B),
        c: field_of(bytes, TripCoeff::C),
        d: field_of(bytes, TripCoeff::D),
    }
}

/// Writes as many states as fit into an axis' list from `offset` on.
pub(crate) fn write(memory: &mut GuestMemory, axis: AxisId, offset: usize, states: &[MotionState]) {
    let list = list(memory, axis);
    for (index, state) in (offset..MAX_STATES).zip(states) {
        let place = list.element(index);
        memory.set(place.field(TripCoeff::TRAJECTORY_MODE), state.mode.number());
        memory.set(place.field(TripCoeff::T), state.t);
        memory.set(place.field(TripCoeff::A), state.a);
        memory.set(place.field(TripCoeff::B), state.b);
        memory.set(place.field(TripCoeff::C), state.c);
        memory.set(place.field(TripCoeff::D), state.d);
    }
}

/// The state at an index of an axis' list.
pub(crate) fn state(memory: &GuestMemory, axis: AxisId, index: usize) -> MotionState {
    read(memory, memory.axis(axis, Chan::C), index)
}

/// Starts the list of an axis from its first state.
pub(crate) fn start(memory: &mut GuestMemory, axis: AxisId) {
    memory.set_axis(axis, Chan::T, 0.0);
    let first = memory.axis(axis, Chan::C);
    memory.set_axis(axis, Chan::PCOEFF, first);
}

/// Replaces the motion of an axis.
pub(crate) fn run(memory: &mut GuestMemory, axis: AxisId, states: &[MotionState]) {
    write(memory, axis, 0, states);
    start(memory, axis);
}

/// Runs the list; the mode of the first state is kept if it matters.
pub(crate) fn run_kept(memory: &mut GuestMemory, axis: AxisId, states: &[MotionState]) {
    let mode = list(memory, axis).element(0).field(TripCoeff::TRAJECTORY_MODE);
    let kept = memory.get(mode);
    write(memory, axis, 0, states);
    // Any other number acts like the polynomial mode.
    if kept == Mode::Off.number() || kept == Mode::Exponential.number() {
        memory.set(mode, kept);
    }
    start(memory, axis);
}

/// Gives the first state of every axis a mode, which a jog from rest keeps.
pub(crate) fn prepare(memory: &mut GuestMemory) {
    for axis in memory.axes().iter() {
        let mode = list(memory, axis).element(0).field(TripCoeff::TRAJECTORY_MODE);
        memory.set(mode, Mode::Independent.number());
    }
}

/// Returns whether a list is being executed.
pub(crate) fn has_motion(memory: &GuestMemory, axis: AxisId) -> bool {
    !memory.axis(axis, Chan::PCOEFF).is_null()
}

/// Returns whether a motion that was called in motion has not begun yet: the axis keeps its speed while it is planned.
pub(crate) fn is_planned(memory: &GuestMemory, axis: AxisId) -> bool {
    let first = state(memory, axis, 0);
    has_motion(memory, axis)
        && memory.axis(axis, Chan::PCOEFF) == memory.axis(axis, Chan::C)
        && memory.axis(axis, Chan::T) < LEAD
        && (first.t, first.a, first.b) == (LEAD, 0.0, 0.0)
}

/// Returns whether an axis approaches its target by a time constant.
pub(crate) fn is_exponential(memory: &GuestMemory, axis: AxisId) -> bool {
    has_motion(memory, axis) && read(memory, memory.axis(axis, Chan::PCOEFF), 0).mode == Mode::Exponential
}

/// Returns whether an enabled axis executes a list.
pub(crate) fn is_moving(memory: &GuestMemory, axis: AxisId) -> bool {
    memory.axis(axis, Chan::ENABLE) != 0 && has_motion(memory, axis)
}

/// The place in the list, counted from the current state: the states after it follow in memory.
fn cursor(memory: &GuestMemory, axis: AxisId) -> Cursor {
    Cursor { index: 0, t: memory.axis(axis, Chan::T) }
}

/// Position, velocity and acceleration from which a new motion starts.
pub(crate) fn present(memory: &GuestMemory, axis: AxisId) -> Point {
    let dest = memory.axis(axis, Chan::DEST);
    if !has_motion(memory, axis) {
        return Point::rest(dest);
    }
    let current = memory.axis(axis, Chan::PCOEFF);
    let velocity = f64::from(memory.axis(axis, Chan::LAST_VEL));
    let read = |index| read(memory, current, index);
    point(entered(cursor(memory, axis), read), dest, velocity, read)
}

/// Advances the motion of an axis by one tick; returns whether its pointer points to a state.
#[inline(always)]
pub(crate) fn advance(memory: &mut GuestMemory, axis: AxisId) -> bool {
    let (current, t) = (memory.axis(axis, Chan::PCOEFF), memory.axis(axis, Chan::T));
    let state = read(memory, current, 0);
    if state.mode != Mode::Independent || t >= state.t {
        return enter(memory, axis);
    }
    // Most ticks stay inside a polynomial.
    let mut chan = AxisView::of(memory, axis);
    chan.set(Chan::DEST, state.at(t).x);
    let next = t + TIMEBASE;
    chan.set(Chan::T, next);
    if next >= state.t {
        enter_reached(memory, axis, current);
    }
    true
}

/// Enters the states that are due: the board does so at the end of a tick and, for a new motion, at its beginning.
fn enter_reached(memory: &mut GuestMemory, axis: AxisId, current: GuestAddr) {
    let reached = entered(cursor(memory, axis), |index| read(memory, current, index));
    if reached.index > 0 {
        let mut chan = AxisView::of(memory, axis);
        chan.set(Chan::T, reached.t);
        chan.set(Chan::PCOEFF, current.offset(TripCoeff::SIZE * reached.index as u32));
    }
}

/// Enters a state; returns whether another state begins, or something other than a polynomial follows.
fn enter(memory: &mut GuestMemory, axis: AxisId) -> bool {
    let current = memory.axis(axis, Chan::PCOEFF);
    let stepped = {
        let read = |index| read(memory, current, index);
        step(cursor(memory, axis), || approach(memory, axis), read)
    };
    let mut chan = AxisView::of(memory, axis);
    match stepped {
        Step::Moving(dest, next) => {
            chan.set(Chan::DEST, dest);
            chan.set(Chan::T, next.t);
            let present = current.offset(TripCoeff::SIZE * next.index as u32);
            if next.index > 0 {
                chan.set(Chan::PCOEFF, present);
            }
            enter_reached(memory, axis, present);
        }
        Step::Approaching(dest, velocity) => {
            chan.set(Chan::DEST, dest);
            chan.set(Chan::LAST_VEL, velocity);
        }
        Step::Ended(t) => {
            chan.set(Chan::PCOEFF, GuestAddr::NULL);
            chan.set(Chan::T, t);
            return memory.block::<{ TripCoeff::SIZE as usize }>(current).is_some();
        }
    }
    true
}

/// Returns the inputs of an exponential approach.
fn approach(memory: &GuestMemory, axis: AxisId) -> Approach {
    Approach {
        dest: memory.axis(axis, Chan::DEST),
        velocity: f64::from(memory.axis(axis, Chan::LAST_VEL)),
        vc: f64::from(memory.axis(axis, Chan::EXP_MOTION_VC)),
        xc: f64::from(memory.axis(axis, Chan::EXP_MOTION_XC)),
        v: f64::from(memory.axis(axis, Chan::VEL)),
        a: f64::from(memory.axis(axis, Chan::ACCEL)),
    }
}
