//! Independent trajectories: one tick of a state list.
//!
//! `t` counts the seconds inside the current state. A tick first enters the states that `t` has reached, then computes
//! the position at `t`, and advances `t` last; so a motion planned in tick k leaves its start in tick k + 2.

use kmotiondef::limits::TIMEBASE;

use super::profile::{Mode, MotionState, Point};
use crate::arithmetic::division::square_root;

/// The position of a motion in its list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cursor {
    /// Index of the current state.
    pub(crate) index: usize,
    /// Seconds inside it.
    pub(crate) t: f64,
}

/// The inputs of an exponential approach in addition to its state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approach {
    /// Destination before this tick.
    pub(crate) dest: f64,
    /// Velocity of the last tick.
    pub(crate) velocity: f64,
    /// Velocity at which the exponential part begins.
    pub(crate) vc: f64,
    /// Distance at which it begins.
    pub(crate) xc: f64,
    /// Velocity limit.
    pub(crate) v: f64,
    /// Acceleration limit.
    pub(crate) a: f64,
}

/// The result of one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// The destination of this tick, and the place in the list where the next one begins.
    Moving(f64, Cursor),
    /// The destination of this tick in an approach by a time constant, and its velocity.
    Approaching(f64, f32),
    /// The list has ended, and so much of a tick after its end this was; the destination stays.
    Ended(f64),
}

/// Advances a motion by one tick; `state` reads the list, `approach` the further inputs of an exponential state.
#[inline]
pub(crate) fn step(
    cursor: Cursor,
    approach: impl FnOnce() -> Approach,
    state: impl Fn(usize) -> MotionState,
) -> Step {
    let mut cursor = entered(cursor, &state);
    let current = state(cursor.index);
    let dest = match current.mode {
        Mode::Off => return Step::Ended(cursor.t),
        Mode::Independent => current.at(cursor.t).x,
        // It does not use the time.
        Mode::Exponential => return exponential(&current, &approach()),
    };
    cursor.t += TIMEBASE;
    Step::Moving(dest, cursor)
}

/// The place in the list after the states that are over.
pub(crate) fn entered(mut cursor: Cursor, state: impl Fn(usize) -> MotionState) -> Cursor {
    let mut current = state(cursor.index);
    while current.mode == Mode::Independent && cursor.t >= current.t {
        cursor.t -= current.t;
        cursor.index += 1;
        current = state(cursor.index);
    }
    cursor
}

/// Position, velocity and acceleration from which a new motion is planned.
pub(crate) fn point(cursor: Cursor, dest: f64, velocity: f64, state: impl Fn(usize) -> MotionState) -> Point {
    let current = state(cursor.index);
    match current.mode {
        Mode::Independent => current.at(cursor.t),
        Mode::Off => Point::rest(dest),
        // The place it would have in the next tick, where the new motion begins.
        Mode::Exponential => Point { x: dest + velocity * TIMEBASE, v: velocity, a: 0.0 },
    }
}

/// Ticks a second, by which the board multiplies where it could divide by [`TIMEBASE`].
pub(crate) const TICKS_PER_SECOND: f64 = 11_111.111_111_111_111;

/// One tick of an exponential approach.
///
/// The velocity of the approach is limited to the change that the acceleration allows since the last tick, then by the
/// velocity limit. While it is above the velocity at which the approach begins, it is also limited by a root, which
/// brakes. The board computes the root in singles, from the magnitude of the square: near its target, an axis that is
/// still too fast is slowed down to it at once.
fn exponential(state: &MotionState, approach: &Approach) -> Step {
    let Approach { dest, velocity, vc, xc, v, a } = *approach;
    let next = (1.0 - state.a) * state.b + state.a * dest;
    let wanted = (next - dest) * TICKS_PER_SECOND;
    let step = a * TIMEBASE;
    let mut reached = if wanted > velocity + step {
        velocity + step
    } else if velocity - step > wanted {
        velocity - step
    } else {
        wanted
    };
    reached = clamp_velocity(reached, v);
    let (vc, xc, a) = (vc as f32, xc as f32, a as f32);
    if (reached as f32).abs() > vc {
        let rest = (dest as f32 - state.b as f32).abs();
        let square = (rest - xc) * (a + a) + vc * vc;
        reached = clamp_velocity(reached, square_root(f64::from(square.abs())));
    }
    Step::Approaching(dest + reached * TIMEBASE, reached as f32)
}

/// A velocity within a limit of both directions.
fn clamp_velocity(velocity: f64, limit: f64) -> f64 {
    match velocity {
        velocity if velocity > limit => limit,
        velocity if velocity < -limit => -limit,
        velocity => velocity,
    }
}
