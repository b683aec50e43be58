//! Profiles compared with an independent calculation: the textbook formulas of jerk-limited motion.
//!
//! Nothing here depends on the planner. Limits, distances and speeds are random over several decades; at every sample,
//! and in every tick of the shorter motions, the limits hold, and the time equals that of the formulas to within a
//! tick. A move from rest ends exactly on its target. A move planned in motion ends as on the board, at the position of
//! its last tick: within the last bits of the board's singles, and of the distance left for a tick.

use kmotiondef::limits::TIMEBASE;
use proptest::prelude::*;

use super::profile::{FOREVER, Limits, Mode, MotionState, Point, jog, move_from_rest, move_in_motion};
use super::trajectory::{Cursor, Step, step};

/// Planning time of the board before a motion planned while another is in progress.
const LEAD: f64 = 0.0018;
/// The board keeps velocities and times of some profiles as singles: the sum of their rounding errors.
const SINGLE: f64 = 8.0 / (1 << 23) as f64;
/// Motions of more ticks than this are only sampled.
const MOST_TICKS: usize = 3000;

/// Seconds of a change of speed, acceleration 0 at both ends.
fn change_time(by: f64, limits: &Limits) -> f64 {
    let by = by.abs();
    let ramp = limits.a / limits.j;
    if by >= limits.a * ramp { by / limits.a + ramp } else { 2.0 * (by / limits.j).sqrt() }
}

/// The distance of such a change: symmetric, so at the mean speed.
fn change_way(from: f64, to: f64, limits: &Limits) -> f64 {
    (from + to) / 2.0 * change_time(to - from, limits)
}

/// Seconds of a move from rest to rest.
fn move_time(length: f64, limits: &Limits) -> f64 {
    let to_full = change_way(0.0, limits.v, limits);
    if length >= 2.0 * to_full {
        return 2.0 * change_time(limits.v, limits) + (length - 2.0 * to_full) / limits.v;
    }
    // The speed that is just reached; the distance grows with it.
    let (mut low, mut high) = (0.0, limits.v);
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if 2.0 * change_way(0.0, middle, limits) <= length { low = middle } else { high = middle }
    }
    2.0 * change_time(low, limits)
}

/// The duration of a motion in seconds, without the tick at rest that the board appends, or without the last, endless
/// state.
fn duration(states: &[MotionState]) -> f64 {
    let moving = states.iter().filter(|state| state.mode == Mode::Independent && state.t < FOREVER);
    moving.filter(|state| (state.a, state.b, state.c) != (0.0, 0.0, 0.0)).map(|state| state.t).sum()
}

/// A length within rounding of the border between two kinds of move, where the board's list jumps.
fn is_on_border(length: f64, limits: &Limits) -> bool {
    let peak = limits.a.min((limits.v * limits.j).sqrt());
    let border = 2.0 * peak * (peak / limits.j) * (peak / limits.j);
    (length - border).abs() <= 1e-5 * border
}

/// Checks that a point is within the limits.
fn check_point(point: Point, fastest: f64, limits: &Limits) -> Result<(), TestCaseError> {
    prop_assert!(point.v.abs() <= fastest * (1.0 + SINGLE), "speed {} of {fastest}", point.v);
    prop_assert!(point.a.abs() <= limits.a * (1.0 + SINGLE), "acceleration {} of {}", point.a, limits.a);
    Ok(())
}

/// Checks every state at its ends and in between, and every tick of a short motion: the limits hold, and position and
/// speed do not jump. Returns the position of the last tick.
fn check(start: Point, states: &[MotionState], limits: &Limits, scale: f64) -> Result<f64, TestCaseError> {
    const SAMPLES: usize = 40;
    let fastest = limits.v.max(start.v.abs());
    let (mut x, mut v) = (start.x, start.v);
    for state in states.iter().filter(|state| state.mode == Mode::Independent) {
        let begin = state.at(0.0);
        prop_assert!((begin.x - x).abs() <= SINGLE * scale, "place jumps by {} of {scale}", begin.x - x);
        prop_assert!((begin.v - v).abs() <= SINGLE * fastest, "speed jumps by {} of {fastest}", begin.v - v);
        prop_assert!(6.0 * state.a.abs() <= limits.j * (1.0 + f64::EPSILON * 4.0), "jerk {}", 6.0 * state.a);
        let length = state.t.min(1e6);
        for sample in 0..=SAMPLES {
            check_point(state.at(length * sample as f64 / SAMPLES as f64), fastest, limits)?;
        }
        let end = state.at(if state.t < FOREVER { state.t } else { 0.0 });
        (x, v) = (end.x, end.v);
    }
    let (mut cursor, mut dest) = (Cursor { index: 0, t: 0.0 }, start.x);
    let state = |index: usize| states.get(index).copied().unwrap_or(MotionState::END);
    for _ in 0..MOST_TICKS {
        let Step::Moving(next, ahead) = step(cursor, || unreachable!("no exponential state"), state) else {
            return Ok(dest);
        };
        let point = state(ahead.index).at(ahead.t - TIMEBASE);
        check_point(point, fastest, limits)?;
        (cursor, dest) = (ahead, next);
    }
    Ok(x)
}

fn near(found: f64, expect: f64) -> bool {
    (found - expect).abs() <= TIMEBASE + SINGLE * expect
}

/// Numbers over decades.
fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|exponent| libm::pow(10.0, exponent))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn profiles_agree_with_the_formulas(
        v in decades(0.0, 6.0),
        a in decades(1.0, 7.0),
        j in decades(2.0, 9.0),
        distance in decades(-3.0, 6.0),
        backwards: bool,
        speed in -1.0..1.0,
        jogged in -2.0..2.0,
    ) {
        let limits = Limits::new(v as f32, a as f32, j as f32).expect("positive limits");
        prop_assume!(!is_on_border(distance, &limits));
        let target = if backwards { 5.0 - distance } else { 5.0 + distance };
        let distance = target - 5.0;

        let states = move_from_rest(5.0, target, &limits);
        let end = check(Point::rest(5.0), &states, &limits, distance.abs().max(5.0))?;
        prop_assert_eq!(end, target);
        let (found, expect) = (duration(&states), move_time(distance.abs(), &limits));
        prop_assert!(near(found, expect), "from rest: {} s instead of {}", found, expect);

        let start = Point { x: 0.0, v: speed * limits.v, a: 0.0 };
        let target: f64 = jogged * limits.v;
        let reach = start.v.abs().max(target.abs());
        let states = jog(start, target, &limits);
        let loose = Limits { v: reach, ..limits };
        let expect = LEAD + change_time(target - start.v, &limits);
        check(start, &states, &loose, reach * expect)?;
        let planned: f64 = states.iter().filter(|state| state.t < FOREVER).map(|state| state.t).sum();
        prop_assert!(near(planned, expect), "jog: {} s instead of {}", planned, expect);

        let states = move_in_motion(start, distance, &limits);
        let begun = start.v * LEAD;
        let from_stop = distance - begun - change_way(start.v, 0.0, &limits);
        prop_assume!(!is_on_border(from_stop.abs(), &limits));
        let scale = distance.abs().max(limits.v * limits.v / limits.a).max(begun.abs()).max(change_way(start.v, 0.0, &limits).abs());
        check(start, &states, &limits, scale)?;
        // The length of a short move after a stop is a small difference of singles, and its time a root of it.
        let rounding = SINGLE * scale;
        let times = [-rounding, 0.0, rounding].map(|by| in_motion(start.v, distance - begun + by, &limits));
        let (shortest, longest) = times.iter().fold((f64::MAX, 0.0_f64), |(min, max), time| (min.min(*time), max.max(*time)));
        let found = duration(&states);
        let is_within = near(found, found.clamp(shortest, longest));
        prop_assert!(is_within, "in motion: {} s instead of {}", found, times[1]);
        let moving: Vec<&MotionState> = states.iter().filter(|state| state.mode == Mode::Independent).collect();
        let end = moving.last().map(|state| state.at(state.t).x).unwrap_or_default();
        prop_assert!((end - distance).abs() <= SINGLE * scale, "ends at {} instead of {}", end, distance);
    }
}

/// The duration of a move planned at speed `v0`, in seconds: the lead, then at full speed if there is room, otherwise a
/// stop and a move.
fn in_motion(v0: f64, way: f64, limits: &Limits) -> f64 {
    let lead = if v0 == 0.0 { 0.0 } else { LEAD };
    let stop = change_way(v0, 0.0, limits);
    let sign = if way < stop { -1.0 } else { 1.0 };
    let full = sign * limits.v;
    let shortest = change_way(v0, full, limits) + change_way(full, 0.0, limits);
    if sign * (way - shortest) >= 0.0 {
        let cruise = (way - shortest) / full;
        return lead + change_time(full - v0, limits) + cruise + change_time(full, limits);
    }
    lead + change_time(v0, limits) + move_time((way - stop).abs(), limits)
}

#[test]
fn invalid_limits_plan_nothing() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for limits in [[bad, 1.0, 1.0], [1.0, bad, 1.0], [1.0, 1.0, bad]] {
            assert_eq!(Limits::new(limits[0], limits[1], limits[2]), None, "{limits:?}");
        }
    }
}
