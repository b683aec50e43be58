//! Third-order (jerk-limited) profiles: lists of states of constant jerk.
//!
//! Source: measurements of the released firmware (`axes-and-motion.md` section 4, `motion.jsonl`). Some of its
//! intermediate results are singles, and its divisions are those of [`division`](crate::arithmetic::division); both are
//! reproduced here, because programs can read the states, even those of a few attoseconds that result only from
//! rounding.

use kmotiondef::limits::TIMEBASE;

use crate::arithmetic::division::{divide, square_root};

/// Seconds at constant velocity in front of a profile planned in motion: the board's planning time.
pub(crate) const LEAD: f64 = 0.0018;
/// A state without end.
pub(crate) const FOREVER: f64 = 1e99;
/// Entries of one axis' state list.
pub(crate) const MAX_STATES: usize = 20;

/// The kind of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Ends the list.
    Off,
    /// A polynomial of time.
    Independent,
    /// An exponential approach: `a` is the ratio a tick, `b` the target.
    Exponential,
}

impl Mode {
    /// The number that programs see.
    pub(crate) fn number(self) -> i32 {
        match self {
            Self::Off => 0,
            Self::Independent => 1,
            Self::Exponential => 5,
        }
    }

    /// The mode with a number; an unknown number ends the list.
    pub(crate) fn from_number(number: i32) -> Self {
        match number {
            1 => Self::Independent,
            5 => Self::Exponential,
            _ => Self::Off,
        }
    }
}

/// One state: position = a·t³ + b·t² + c·t + d for `t` from 0 to its duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionState {
    /// The kind.
    pub(crate) mode: Mode,
    /// Duration in seconds.
    pub(crate) t: f64,
    /// A sixth of the jerk.
    pub(crate) a: f64,
    /// Half the acceleration at its start.
    pub(crate) b: f64,
    /// Velocity at its start.
    pub(crate) c: f64,
    /// Position at its start.
    pub(crate) d: f64,
}

impl MotionState {
    /// Rests at `position` for `duration`.
    pub(crate) fn hold(position: f64, duration: f64) -> Self {
        Self { mode: Mode::Independent, t: duration, a: 0.0, b: 0.0, c: 0.0, d: position }
    }

    /// The end of a list, remembering where motion stopped.
    pub(crate) fn off(t: f64, position: f64) -> Self {
        Self { mode: Mode::Off, t, a: 0.0, b: 0.0, c: 0.0, d: position }
    }

    /// The end of a profile from rest.
    pub(crate) const END: Self = Self { mode: Mode::Off, t: 0.0, a: 0.0, b: 0.0, c: 0.0, d: 0.0 };

    /// Position, velocity and acceleration at `t` seconds into the state.
    pub(crate) fn at(&self, t: f64) -> Point {
        Point {
            x: ((self.a * t + self.b) * t + self.c) * t + self.d,
            v: (3.0 * self.a * t + 2.0 * self.b) * t + self.c,
            a: 6.0 * self.a * t + 2.0 * self.b,
        }
    }
}

/// A point of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Position.
    pub(crate) x: f64,
    /// Velocity.
    pub(crate) v: f64,
    /// Acceleration.
    pub(crate) a: f64,
}

impl Point {
    /// At rest at `x`.
    pub(crate) fn rest(x: f64) -> Self {
        Self { x, v: 0.0, a: 0.0 }
    }
}

/// Limits of a motion, all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Velocity.
    pub(crate) v: f64,
    /// Acceleration.
    pub(crate) a: f64,
    /// Jerk.
    pub(crate) j: f64,
}

impl Limits {
    /// Limits from the axis' fields; `None` unless all are positive.
    pub(crate) fn new(v: f32, a: f32, j: f32) -> Option<Self> {
        let usable = |limit: f32| limit > 0.0 && limit.is_finite();
        (usable(v) && usable(a) && usable(j)).then(|| Self {
            v: f64::from(v),
            a: f64::from(a),
            j: f64::from(j),
        })
    }
}

/// A list under construction and the point it has reached.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pub(super) states: Vec<MotionState>,
    pub(super) end: Point,
    /// The square root: on the board a single, or a double.
    root: fn(f64) -> f64,
}

impl Path {
    fn from(start: Point) -> Self {
        Self { states: Vec::new(), end: start, root: square_root }
    }

    /// A path with square roots that are doubles.
    pub(super) fn exact(start: Point) -> Self {
        Self::from(start).with_exact_roots()
    }

    /// Continues the path with square roots that are doubles.
    pub(super) fn with_exact_roots(self) -> Self {
        Self { root: libm::sqrt, ..self }
    }

    /// Appends `duration` seconds of constant `jerk`; no state for a duration of 0.
    fn push(&mut self, duration: f64, jerk: f64) {
        if duration.is_nan() {
            return;
        }
        self.append(duration, jerk);
        if duration <= 0.0 {
            // The following states still start from its end.
            self.states.pop();
        }
    }

    /// Appends `duration` seconds of constant `jerk`, even if they are none or, by rounding, less.
    pub(super) fn append(&mut self, duration: f64, jerk: f64) {
        let Point { x, v, a } = self.end;
        let state = MotionState {
            mode: Mode::Independent,
            t: duration,
            a: divide(jerk, 6.0),
            b: a / 2.0,
            c: v,
            d: x,
        };
        self.end = state.at(duration);
        self.states.push(state);
    }

    /// Appends a segment that starts with exactly this acceleration.
    fn push_at(&mut self, duration: f64, jerk: f64, acceleration: f64) {
        self.end.a = acceleration;
        self.push(duration, jerk);
    }

    /// Appends the change to velocity `target`, reached with acceleration 0, in the shortest time.
    pub(super) fn change(&mut self, target: f64, limits: &Limits) {
        let Point { v, a, .. } = self.end;
        let gain = target - v;
        let ramp_down = divide(a * a.abs(), 2.0 * limits.j);
        let sign = if gain >= ramp_down { 1.0 } else { -1.0 };
        let jerk = sign * limits.j;
        let last = (self.root)((divide(gain, jerk) + divide(a * a, 2.0 * limits.j * limits.j)).max(0.0));
        if last * limits.j <= limits.a {
            self.append(last - divide(a, jerk), jerk);
            self.append(last, -jerk);
        } else {
            let peak = sign * limits.a;
            let first = divide(peak - a, jerk);
            // Already beyond the limit: the acceleration decreases to it. Less than a nanosecond is rounding.
            let beyond = first < -1e-9;
            self.append(if beyond { -first } else { first }, if beyond { -jerk } else { jerk });
            let last = divide(limits.a, limits.j);
            let between = divide(target - self.end.v - peak * last / 2.0, peak);
            self.end.a = peak;
            self.append(between, 0.0);
            self.end.a = peak;
            self.append(last, -jerk);
        }
        self.end.v = target;
        self.end.a = 0.0;
    }

    /// Appends a move from rest to `target`, with the resting tick the board puts after it. A half without its outer
    /// change of acceleration is as fast at the end of its constant phase; only a move that reaches the limit of the
    /// velocity has such halves.
    fn move_from_rest(&mut self, target: f64, ramps: [Ramp; 2], limits: &Limits) {
        let distance = target - self.end.x;
        let sign = if distance < 0.0 { -1.0 } else { 1.0 };
        let Phases { ramp, constant, cruise, peak, is_full } = Phases::of(distance, limits);
        let jerk = sign * limits.j;
        let turn = sign * peak;
        let abrupt = ramps.map(|kind| is_full && kind == Ramp::Abrupt);
        let saved = if abrupt.contains(&true) { peak * ramp * ramp / 24.0 / limits.v } else { 0.0 };
        let cruise = abrupt.iter().filter(|&&is| is).fold(cruise, |cruise, _| cruise + saved);
        if !abrupt[0] {
            self.push(ramp, jerk);
        }
        self.push_at(if abrupt[0] { constant + ramp / 2.0 } else { constant }, 0.0, turn);
        self.push_at(ramp, -jerk, turn);
        self.push_at(cruise, 0.0, 0.0);
        self.push_at(ramp, -jerk, 0.0);
        self.push_at(if abrupt[1] { constant + ramp / 2.0 } else { constant }, 0.0, -turn);
        if !abrupt[1] {
            self.push_at(ramp, jerk, -turn);
        }
        self.states.push(MotionState::hold(target, TIMEBASE));
        self.end = Point::rest(target);
    }
}

/// A symmetric move from rest to rest: ramp, constant, ramp, cruise, ramp, constant, ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phases {
    /// Seconds of each change of the acceleration.
    ramp: f64,
    /// Seconds of constant acceleration.
    pub(super) constant: f64,
    /// Seconds of constant velocity.
    pub(super) cruise: f64,
    /// The acceleration that is reached.
    peak: f64,
    /// True if the limit of the velocity is reached.
    pub(super) is_full: bool,
}

impl Phases {
    /// The fastest move over `distance` within the limits.
    pub(super) fn of(distance: f64, limits: &Limits) -> Self {
        let length = distance.abs();
        let Limits { v, a, j } = *limits;
        // The product is a single on the board.
        let peak = a.min(libm::sqrt(f64::from(((v * j) as f32).max(f32::MIN_POSITIVE))));
        let ramp = divide(peak, j);
        if length < 2.0 * peak * ramp * ramp {
            let ramp = libm::cbrt(divide(length, 2.0 * j));
            return Self { ramp, constant: 0.0, cruise: 0.0, peak: j * ramp, is_full: false };
        }
        let way = |v: f64| v * (divide(v, peak) + ramp);
        let constant = divide(v, peak) - ramp;
        // Without a constant phase at full speed, lower speeds have none either.
        if length > way(v) || constant <= 0.0 {
            let cruise = divide(length - way(v), v);
            return Self { ramp, constant, cruise, peak, is_full: true };
        }
        // (J·r/2)·c² + (3·J·r²/2)·c + (J·r³ − L/2) = 0 for the constant phase c. The board's root is a single. If it
        // leaves no constant phase, at a length just between two cases, the board takes the other solution, a time
        // before the start, and its list jumps, as recorded. Backwards the coefficients have the opposite sign, so that
        // the other solution is the board's first choice, and its fallback is the correct one.
        let half = peak * ramp / 2.0;
        let sum = square_root(half * half + peak * length);
        let constant = divide(sum - 3.0 * half, peak);
        let constant =
            if constant <= 0.0 && distance > 0.0 { -divide(sum + 3.0 * half, peak) } else { constant };
        // The rest due to the rounding of the single is covered at the velocity limit, even if that is not reached.
        let cruise = divide(length - way(sum - half), v);
        Self { ramp, constant, cruise, peak: j * ramp, is_full: false }
    }
}

/// A move from rest, for a new axis or an axis at standstill.
pub(crate) fn move_from_rest(from: f64, to: f64, limits: &Limits) -> Vec<MotionState> {
    if from.is_nan() {
        return move_from_nowhere(to, limits);
    }
    let mut states = bare_move(from, to, [Ramp::Smooth; 2], limits);
    states.push(MotionState::END);
    states
}

/// A move of an axis whose destination is NaN: four phases of full length, and the last state that every move from rest
/// has (coordinated-motion.md section 6).
fn move_from_nowhere(to: f64, limits: &Limits) -> Vec<MotionState> {
    let phase =
        MotionState { mode: Mode::Independent, t: limits.a / limits.j, a: 0.0, b: 0.0, c: 0.0, d: f64::NAN };
    let last = MotionState { t: TIMEBASE, d: to, ..phase };
    vec![phase, phase, phase, phase, last, MotionState::END]
}

/// The change of speed in a half of a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ramp {
    /// With limited jerk.
    Smooth,
    /// With a step of the acceleration where the axis rests.
    Abrupt,
}

/// The states of a move from rest, each half with its own ramp, and the resting tick, but not the end of the list.
pub(crate) fn bare_move(from: f64, to: f64, ramps: [Ramp; 2], limits: &Limits) -> Vec<MotionState> {
    let mut path = Path::from(Point::rest(from));
    path.move_from_rest(to, ramps, limits);
    path.states
}

/// A move planned while the axis moves: 20 ticks continue unchanged, then the target is approached at full speed, or
/// the axis stops and starts again.
pub(crate) fn move_in_motion(start: Point, to: f64, limits: &Limits) -> Vec<MotionState> {
    let MovingStart { mut path, sign, remaining, stop } = plan_moving_start(start, to, limits);
    if stop.is_some() {
        path.move_from_rest(to, [Ramp::Smooth; 2], limits);
        path.states.push(MotionState::END);
        return path.states;
    }
    path.append(divide(remaining, sign * limits.v), 0.0);
    path.change(0.0, limits);
    path.states.push(MotionState::off(FOREVER, to));
    path.states
}

/// The beginning of a move in motion.
#[derive(Clone, Debug)]
pub(super) struct MovingStart {
    /// Its first phases: to full speed, or to rest.
    path: Path,
    /// The direction of its full speed.
    pub(super) sign: f64,
    /// The distance at full speed.
    remaining: f64,
    /// The place where the axis stops first, if it does.
    pub(super) stop: Option<f64>,
}

/// Decides whether a move in motion continues or stops first.
pub(super) fn plan_moving_start(start: Point, to: f64, limits: &Limits) -> MovingStart {
    let path = lead_in(start);
    let mut stopped = path.clone();
    stopped.change(0.0, limits);
    let distance = to - path.end.x;
    let sign = if distance < stopped.end.x - path.end.x { -1.0 } else { 1.0 };
    let mut direct = path;
    direct.change(sign * limits.v, limits);
    let mut shortest = direct.clone();
    shortest.change(0.0, limits);
    let remaining = to - shortest.end.x;
    if sign * remaining < 0.0 {
        let stop = Some(stopped.end.x);
        return MovingStart { path: stopped, sign, remaining, stop };
    }
    MovingStart { path: direct, sign, remaining, stop: None }
}

/// The point from which a motion changes its speed after the planning time.
pub(super) fn after_lead(start: Point) -> Point {
    lead_in(start).end
}

/// Returns whether a change of speed has a phase of constant acceleration.
pub(super) fn is_in_three(start: Point, velocity: f64, limits: &Limits) -> bool {
    let mut path = Path::from(start);
    path.change(velocity, limits);
    path.states.len() > 2
}

/// A jog: 20 ticks unchanged, then the change to the new velocity, which lasts.
pub(crate) fn jog(start: Point, velocity: f64, limits: &Limits) -> Vec<MotionState> {
    let mut path = lead_in(start);
    path.change(velocity, limits);
    path.states.push(if velocity == 0.0 {
        MotionState::off(FOREVER, path.end.x)
    } else {
        constant(&path.end)
    });
    path.states
}

/// Constant velocity without end.
fn constant(point: &Point) -> MotionState {
    MotionState { mode: Mode::Independent, t: FOREVER, a: 0.0, b: 0.0, c: point.v, d: point.x }
}

/// The 20 ticks at constant velocity, during which the acceleration pauses.
pub(super) fn lead_in(start: Point) -> Path {
    let mut path = Path::from(Point { a: 0.0, ..start });
    path.push(LEAD, 0.0);
    path.end.a = start.a;
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(limits: [f32; 3], distance: f64, durations: &[f64]) {
        let limits = Limits::new(limits[0], limits[1], limits[2]).expect("positive limits");
        let states = move_from_rest(0.0, distance, &limits);
        let found: Vec<f64> =
            states[..states.len() - 2].iter().map(|state| state.t).filter(|&t| t > 1e-6).collect();
        assert_eq!(found.len(), durations.len(), "{found:?}");
        for (found, expect) in found.iter().zip(durations) {
            assert!((found - expect).abs() < 1e-8, "{found} {expect}");
        }
    }

    #[test]
    fn moves_from_rest_have_the_classical_phases() {
        check([40000.0, 400_000.0, 4e6], 1000.0, &[0.05; 4]);
        check([40000.0, 400_000.0, 4e6], 10000.0, &[0.1, 0.1, 0.05, 0.1, 0.1]);
        check([40000.0, 200_000.0, 4e6], 800.0, &[0.046_415_888_336_127_79; 4]);
        check([40000.0, 200_000.0, 4e6], 100_000.0, &[0.05, 0.15, 0.05, 2.25, 0.05, 0.15, 0.05]);
    }

    #[test]
    fn abrupt_halves_have_no_outer_jerk_phase() {
        let limits = Limits::new(300.0, 3000.0, 50_000.0).expect("positive limits");
        let check = |ramps: [Ramp; 2], distance: f64, durations: &[f64]| {
            let states = bare_move(5.0, 5.0 + distance, ramps, &limits);
            let found: Vec<f64> = states.iter().map(|state| state.t).collect();
            assert_eq!(found.len(), durations.len() + 1, "{found:?}");
            assert!(found.iter().zip(durations).all(|(a, b)| (a - b).abs() < 1e-10), "{found:?}");
            assert_eq!(states.last(), Some(&MotionState::hold(5.0 + distance, TIMEBASE)));
            let [.., last, _] = &states[..] else { panic!("{states:?}") };
            let end = last.at(last.t);
            assert!((end.x - 5.0 - distance).abs() < 1e-5 && end.v.abs() < 1e-9, "{end:?}");
        };
        let (smooth, abrupt) = (Ramp::Smooth, Ramp::Abrupt);
        check([abrupt, smooth], 1000.0, &[0.07, 0.06, 3.174_833_333_333_333, 0.06, 0.04, 0.06]);
        check([smooth, abrupt], -1005.0, &[0.06, 0.04, 0.06, 3.1915, 0.06, 0.07]);
        check([abrupt; 2], 48.0, &[0.07, 0.06, 0.003, 0.06, 0.07]);
        // The limit of the velocity is not reached.
        let constant = 0.022_101_145_426_4;
        check([abrupt; 2], 35.0, &[0.06, constant, 0.06, 0.06, constant, 0.06]);
    }

    #[test]
    fn a_jog_changes_speed_in_the_shortest_time() {
        let limits = Limits::new(1.0, 100_000.0, 4e6).expect("positive limits");
        let states = jog(Point { x: 0.0, v: 10000.0, a: 50000.0 }, -5000.0, &limits);
        let durations: Vec<f64> = states.iter().map(|state| state.t).collect();
        for (found, expect) in durations.iter().zip([0.0018, 0.0375, 0.128_125, 0.025, FOREVER]) {
            assert!((found - expect).abs() <= expect * 1e-7, "{durations:?}");
        }
        let end = states[4].d - states[1].d;
        assert!((end - 600.7487).abs() < 1e-3, "{end}");
    }
}
