//! Profiles of firmware 5: a move goes directly to its target from any motion of the axis, with separate acceleration
//! and deceleration.
//!
//! Source: measurements of the released firmware 5.3.2, `fw5.jsonl`. The speed reached by a move that is too short for
//! its limit is found by a search: the board solves equations of which only the solutions are known.

use kmotiondef::limits::TIMEBASE;

use super::profile::{FOREVER, Limits, Mode, MotionState, Path, Point, lead_in};

/// Halvings of the range of a move's peak speed: the full resolution of a double.
const HALVINGS: usize = 120;

/// A move to `to`; it slows down with `decel`.
pub(crate) fn move_direct(start: Point, to: f64, limits: &Limits, decel: f64) -> Vec<MotionState> {
    let is_resting = start.v == 0.0 && start.a == 0.0;
    let begin = if is_resting { Path::exact(start) } else { lead_in(start).with_exact_roots() };
    let mut states = merge_states(plan_direct(begin, to, limits, decel));
    states.push(MotionState::END);
    states
}

/// A jog to a velocity.
pub(crate) fn jog_direct(start: Point, velocity: f64, limits: &Limits) -> Vec<MotionState> {
    let is_resting = start.v == 0.0 && start.a == 0.0;
    let mut path = if is_resting { Path::exact(start) } else { lead_in(start).with_exact_roots() };
    path.change(velocity, limits);
    let end = path.end;
    let mut states = path.states;
    if velocity != 0.0 {
        states.push(MotionState { mode: Mode::Independent, t: FOREVER, a: 0.0, b: 0.0, c: end.v, d: end.x });
    }
    states.push(MotionState { c: velocity, ..MotionState::END });
    states
}

/// The fastest way from the end of a path to rest at `to`, with the resting tick after it.
fn plan_direct(begin: Path, to: f64, limits: &Limits, decel: f64) -> Vec<MotionState> {
    let slowing = Limits { a: decel, ..*limits };
    let through = |speed: f64| {
        let mut path = begin.clone();
        let is_slower = speed.abs() < path.end.v.abs() && speed * path.end.v >= 0.0;
        path.change(speed, if is_slower { &slowing } else { limits });
        path
    };
    let reached = |speed: f64| {
        let mut path = through(speed);
        path.change(0.0, &slowing);
        path.end.x
    };
    let sign = if to < reached(0.0) { -1.0 } else { 1.0 };
    let room = |speed: f64| sign * (to - reached(sign * speed));
    let full = room(limits.v);
    let (speed, cruise) =
        if full >= 0.0 { (limits.v, full / limits.v) } else { (highest_speed(limits.v, room), 0.0) };
    let mut path = through(sign * speed);
    if cruise > 0.0 {
        path.append(cruise, 0.0);
    }
    path.change(0.0, &slowing);
    path.states.push(MotionState::hold(to, TIMEBASE));
    path.states
}

/// The highest speed up to `limit` that leaves room.
fn highest_speed(limit: f64, room: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if room(middle) >= 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The states, with neighbours of the same jerk merged.
fn merge_states(states: Vec<MotionState>) -> Vec<MotionState> {
    let mut joined: Vec<MotionState> = Vec::with_capacity(states.len());
    for state in states {
        match joined.last_mut() {
            Some(last) if state.a != 0.0 && last.a == state.a => last.t += state.t,
            _ => joined.push(state),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_have_the_recorded_phases() {
        let limits = |a| Limits::new(500.0, a, 100_000.0).expect("positive limits");
        for (start, to, accel, decel, expect) in [
            (
                Point::rest(0.0),
                100.0,
                5000.0,
                2000.0,
                &[0.05, 0.047_371_185_280_648_88, 0.07, 0.223_427_963_201_622_23, 0.02, 9e-5][..],
            ),
            (
                Point { x: 15.936_959_709_231_806, v: 415.287_137_635_266_8, a: 4_116.135_623_730_907 },
                200.0,
                10_000.0,
                10_000.0,
                &[
                    0.0018,
                    0.041_161_356_237_309_085,
                    0.257_083_610_067_203_5,
                    0.070_710_678,
                    0.070_710_678,
                    9e-5,
                ],
            ),
        ] {
            let states = move_direct(start, to, &limits(accel), decel);
            let durations: Vec<f64> = states.iter().map(|state| state.t).filter(|t| *t > 1e-9).collect();
            assert_eq!(durations.len(), expect.len(), "{states:?}");
            for (found, expect) in durations.iter().zip(expect) {
                assert!((found - expect).abs() < 1e-9, "{durations:?}");
            }
        }
    }

    #[test]
    fn a_jog_from_rest_starts_at_once_and_ends_its_list() {
        let limits = Limits::new(500.0, 5000.0, 100_000.0).expect("positive limits");
        let states = jog_direct(Point::rest(0.0), 500.0, &limits);
        let [.., constant, end] = &states[..] else { panic!("{states:?}") };
        assert_eq!((constant.t, end.mode, end.c), (FOREVER, Mode::Off, 500.0));
        assert!((states[0].t - 0.05).abs() < 1e-12 && (constant.d - 37.5).abs() < 1e-9, "{states:?}");
    }
}
