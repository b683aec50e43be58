//! The time that firmware 4.34 takes to plan a motion, by its kind.
//!
//! Only the phases of a motion determine its planning time (measured: 600 motions, each within a few cycles). An empty
//! phase takes longer than one that exists. In motion, the time counts from the slice in which the board plans.

use kmotiondef::AxisId;
use vm::memory::GuestMemory;

use super::independent::{has_motion, present};
use super::profile::{self, Limits, Phases, Point, is_in_three};

/// A move from rest to where the axis is.
const NOWHERE: i64 = 2488;
/// A move from rest that reaches its velocity.
const FULL: i64 = 3345;
/// The two phases of constant acceleration, if they are empty.
const WITHOUT_CONSTANT: i64 = 692;
/// A move from rest that only reaches its acceleration limit, and a move that reaches neither limit.
const ACCELERATED: i64 = 3193;
const SHORT: i64 = 3417;
/// The phase of constant velocity, if it is empty.
const WITHOUT_CRUISE: i64 = 580;
/// A move in the negative direction.
const NEGATIVE: i64 = 25;
/// A move from rest that is planned in the slice after the call.
const LATER: i64 = 110;
/// A move in motion that continues at full velocity.
const CONTINUED: i64 = 4772;
/// A move in motion that stops first, without the move from rest that follows.
const STOPPED: i64 = 3290;
/// A change of speed that reaches its acceleration limit: the time to find its duration, and to store it.
const WEIGHED: i64 = 425;
const WRITTEN: i64 = 560;
/// A jog from rest, and in motion.
const JOG: i64 = 1418;
const JOG_IN_MOTION: i64 = 1559;

/// Returns the cycles that a move of an axis to a place is planned.
pub(crate) fn of_move(memory: &GuestMemory, axis: AxisId, target: f64, limits: &Limits) -> i64 {
    let point = present(memory, axis);
    let is_moving = has_motion(memory, axis);
    if point.v == 0.0 && point.a == 0.0 {
        return from_rest(target - point.x, limits) + if is_moving { LATER } else { 0 };
    }
    in_motion(point, target, limits)
}

/// Returns the cycles that a jog of an axis is planned.
pub(crate) fn of_jog(memory: &GuestMemory, axis: AxisId, velocity: f64, limits: &Limits) -> i64 {
    let start = profile::after_lead(present(memory, axis));
    let base = if has_motion(memory, axis) { JOG_IN_MOTION } else { JOG };
    base + if is_in_three(start, velocity, limits) { WRITTEN } else { 0 }
}

/// Cycles of a move over `distance` from rest.
fn from_rest(distance: f64, limits: &Limits) -> i64 {
    if distance == 0.0 {
        return NOWHERE;
    }
    let phases = Phases::of(distance, limits);
    let cruise = if phases.cruise > 0.0 { 0 } else { WITHOUT_CRUISE };
    let kind = if phases.is_full {
        FULL + cruise + if phases.constant > 0.0 { 0 } else { WITHOUT_CONSTANT }
    } else if phases.constant == 0.0 {
        SHORT
    } else {
        ACCELERATED + cruise
    };
    kind + if distance < 0.0 { NEGATIVE } else { 0 }
}

/// Cycles of a move to `target` in motion.
fn in_motion(start: Point, target: f64, limits: &Limits) -> i64 {
    let profile::MovingStart { stop, sign, .. } = profile::plan_moving_start(start, target, limits);
    let start = profile::after_lead(start);
    let changes = [(start, sign * limits.v), (Point { v: sign * limits.v, ..Point::rest(0.0) }, 0.0)];
    let long = changes.iter().filter(|(from, to)| is_in_three(*from, *to, limits)).count() as i64;
    match stop {
        None => CONTINUED + long * (WEIGHED + WRITTEN),
        Some(rest) => {
            let stop = if is_in_three(start, 0.0, limits) { WRITTEN } else { 0 };
            STOPPED + long * WEIGHED + stop + from_rest(target - rest, limits)
        }
    }
}
