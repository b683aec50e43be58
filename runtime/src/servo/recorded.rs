//! Replays the recorded motions of the released firmware.

use kmotiondef::limits::TIMEBASE;
use serde_json::Value as Json;

use super::profile::{FOREVER, Limits, Mode, MotionState, Point, jog, move_from_rest, move_in_motion};
use super::trajectory::{Approach, Cursor, Step, point, step};
use crate::text::vectors::rows;

/// An axis as the recording shows it.
struct Axis {
    limits: Limits,
    list: Vec<MotionState>,
    cursor: Option<Cursor>,
    dest: f64,
    last_vel: f32,
    vc: f32,
    xc: f32,
}

impl Axis {
    fn tick(&mut self) {
        let before = self.dest;
        if let Some(cursor) = self.cursor {
            let approach = Approach {
                dest: self.dest,
                velocity: f64::from(self.last_vel),
                vc: f64::from(self.vc),
                xc: f64::from(self.xc),
                v: self.limits.v,
                a: self.limits.a,
            };
            match step(cursor, || approach, |index| self.list[index]) {
                Step::Moving(dest, next) => {
                    self.dest = dest;
                    self.cursor = Some(next);
                }
                Step::Approaching(dest, _) => self.dest = dest,
                Step::Ended(_) => self.cursor = None,
            }
        }
        self.last_vel = ((self.dest - before) / TIMEBASE) as f32;
    }

    fn point(&self) -> Point {
        self.cursor.map_or(Point::rest(self.dest), |cursor| {
            point(cursor, self.dest, f64::from(self.last_vel), |index| self.list[index])
        })
    }

    /// Makes a call whose destination at its beginning was `dest`.
    fn call(&mut self, name: &str, args: &[f64], dest: f64) {
        let speed = args.get(1).copied().unwrap_or(self.limits.v).abs() as f32;
        let limits = Limits { v: f64::from(speed), ..self.limits };
        let target = if name.contains("Rel") { dest + args[0] } else { args[0] };
        let start = self.point();
        let moving = start.v != 0.0 || start.a != 0.0;
        match name {
            "Jog" if args[0] == 0.0 && self.cursor.is_none() => {
                self.list = vec![MotionState::END];
                return;
            }
            "Jog" => self.list = jog(start, args[0], &self.limits),
            "MoveExp" => return self.approach(args[0], args[1]),
            _ if moving => self.list = move_in_motion(start, target, &limits),
            _ => self.list = move_from_rest(start.x, target, &limits),
        }
        self.cursor = Some(Cursor { index: 0, t: 0.0 });
    }

    fn approach(&mut self, target: f64, tau: f64) {
        self.vc = (self.limits.a * tau) as f32;
        self.xc = (f64::from(self.vc) * tau) as f32;
        let ratio = libm::exp(-TIMEBASE / tau);
        self.list =
            vec![MotionState { mode: Mode::Exponential, t: 0.0, a: ratio, b: target, c: 0.0, d: 0.0 }];
        self.cursor = Some(Cursor { index: 0, t: 0.0 });
    }
}

fn number(value: &Json) -> f64 {
    value.as_f64().expect("a number")
}

/// Reports whether two numbers agree to 1e-9, and to the rounding of the numbers of size `scale` whose difference they
/// are.
fn close(found: f64, expect: f64, scale: f64) -> bool {
    (found - expect).abs() <= 1e-9 * expect.abs() + 1e-12 * scale
}

/// The largest distance of a recorded motion from its start.
fn travel(row: &Json) -> f64 {
    let start = number(&row["start_dest"]);
    let samples = row["samples"].as_array().expect("samples");
    samples.iter().map(|sample| (number(&sample[1]) - start).abs()).fold(0.0, f64::max)
}

/// The largest number in a column of a list, apart from the number that stands for "without end".
fn largest(states: &[[f64; 5]], column: usize) -> f64 {
    states.iter().map(|state| state[column].abs()).filter(|&value| value < FOREVER).fold(0.0, f64::max)
}

fn check_states(row: &Json, call: &Json, found: &[MotionState], problems: &mut Vec<String>) {
    let list = call["states"].as_array().expect("states");
    let expect: Vec<[f64; 5]> =
        list.iter().map(|state| ["t", "a", "b", "c", "d"].map(|name| number(&state[name]))).collect();
    let scales: [f64; 5] = std::array::from_fn(|column| largest(&expect, column));
    let same = found.len() == expect.len()
        && found
            .iter()
            .zip(list)
            .all(|(found, expect)| found.mode.number() == number(&expect["mode"]) as i32)
        && found.iter().zip(&expect).all(|(found, expect)| {
            let found = [found.t, found.a, found.b, found.c, found.d];
            (0..5).all(|column| close(found[column], expect[column], scales[column]))
        });
    if !same {
        problems.push(format!("{} {}: states\n {found:?}\n {expect:?}", row["tag"], call["call"]));
    }
}

fn check(row: &Json) -> Vec<String> {
    let field = |name: &str| number(&row[name]) as f32;
    let limits = Limits::new(field("Vel"), field("Accel"), field("Jerk")).expect("positive limits");
    let mut axis = Axis {
        limits,
        list: Vec::new(),
        cursor: None,
        dest: number(&row["start_dest"]),
        last_vel: 0.0,
        vc: 0.0,
        xc: 0.0,
    };
    let (travel, mut problems) = (travel(row), Vec::new());
    let mut calls = row["calls"].as_array().expect("calls").iter().peekable();
    let mut samples = row["samples"].as_array().expect("samples").iter().peekable();
    let (mut done, mut begun) = (None, axis.dest);
    let mut tick = 0;
    while samples.peek().is_some() || calls.peek().is_some() {
        if tick > 0 {
            axis.tick();
        }
        if done.is_none() && axis.cursor.is_none() && calls.peek().is_none() {
            done = Some(tick);
        }
        if let Some(sample) = samples.next_if(|sample| number(&sample[0]) as u64 == tick)
            && !close(axis.dest, number(&sample[1]), travel)
        {
            problems.push(format!("{} tick {tick}: {} instead of {}", row["tag"], axis.dest, sample[1]));
            return problems;
        }
        if calls.peek().is_some_and(|call| number(&call["begin_tick"]) as u64 == tick) {
            begun = axis.dest;
        }
        while let Some(call) = calls.next_if(|call| number(&call["end_tick"]) as u64 == tick) {
            let args: Vec<f64> = call["args"].as_array().expect("args").iter().map(number).collect();
            let name = call["call"].as_str().expect("a name");
            axis.call(name, &args, begun);
            done = None;
            if name != "MoveExp" {
                check_states(row, call, &axis.list, &mut problems);
            }
        }
        tick += 1;
    }
    let expect = row["done_tick"].as_u64();
    if done != expect {
        problems.push(format!("{}: done in {done:?} instead of {expect:?}", row["tag"]));
    }
    problems
}

#[test]
fn motions_match_the_recording() {
    let problems: Vec<Vec<String>> =
        rows("motion.jsonl").iter().map(check).filter(|list| !list.is_empty()).collect();
    let shown: Vec<String> = problems.iter().take(12).map(|list| list.join("\n")).collect();
    assert!(problems.is_empty(), "{} rows differ\n{}", problems.len(), shown.join("\n"));
}
