//! Independent motion: `data/vectors/motion.jsonl`.

use std::fmt::Write as _;

use kmotiondef::structs::{Chan, TripCoeff};
use serde_json::Value as Json;

use super::{Program, Released, list, number, released, report, rows, text, thread};

/// The maximum number of ticks until a program begins.
const BEGIN: u32 = 200;
/// The number of ticks of a motion that is always followed to its end, and of other motions after their last call.
const SHORT: u64 = 1000;
const AFTER: u64 = 100;

/// A program that makes the calls of a row in their recorded ticks; it notes the time of each call's begin and end.
fn program(row: &Json) -> String {
    let mut source =
        "double begun[8], ended[8], first;\nmain()\n{\n  WaitNextTimeSlice();\n  first = ServoTick;\n"
            .to_owned();
    for (index, call) in list(&row["calls"]).iter().enumerate() {
        let begin = number(&call["begin_tick"]);
        let name = text(&call["call"]);
        let args: Vec<String> = list(&call["args"]).iter().map(|arg| format!("{:?}", number(arg))).collect();
        let _ = write!(
            source,
            "  while (ServoTick < first + {begin:?}) WaitNextTimeSlice();\n  \
             begun[{index}] = ServoTick;\n  {name}(0, {});\n  ended[{index}] = ServoTick;\n",
            args.join(", ")
        );
    }
    source + "  for (;;) WaitNextTimeSlice();\n}\n"
}

/// The list of states of axis 0, up to its end.
pub(super) fn states(board: &Released) -> Vec<[f64; 6]> {
    let memory = board.board.memory();
    let base = board.address("chan").offset(Chan::C.offset());
    let first: u32 = memory.peek(base);
    let mut found = Vec::new();
    for at in (first..).step_by(TripCoeff::STRUCTURE.size as usize).take(20) {
        let at = kmotiondef::GuestAddr::new(at);
        let mode: i32 = memory.peek(at);
        let fields = [TripCoeff::T, TripCoeff::A, TripCoeff::B, TripCoeff::C, TripCoeff::D];
        let [t, a, b, c, d] = fields.map(|field| memory.peek::<f64>(at.offset(field.offset())));
        found.push([f64::from(mode), t, a, b, c, d]);
        if mode == 0 || t == 1e99 {
            break;
        }
    }
    found
}

fn recorded_states(call: &Json) -> Vec<[f64; 6]> {
    let field = |state: &Json| ["mode", "t", "a", "b", "c", "d"].map(|name| number(&state[name]));
    list(&call["states"]).iter().map(field).collect()
}

/// The tick up to which a row is followed: its last sample if `CC67_LONG` is set, which may be after seconds of a
/// crawl; otherwise a little after its last call, or the end of a short motion.
fn end(row: &Json) -> u64 {
    let last = list(&row["samples"]).iter().map(|sample| number(&sample[0]) as u64).max().unwrap_or(0);
    let called = list(&row["calls"]).iter().map(|call| number(&call["end_tick"]) as u64).max().unwrap_or(0);
    if harness::is_long() || last <= SHORT { last } else { last.min(called + AFTER) }
}

/// A row during its replay.
struct Replay<'r> {
    row: &'r Json,
    board: Released,
    program: Program,
    /// The tick in whose slice the first call began.
    first: f64,
    found: Vec<String>,
}

impl<'r> Replay<'r> {
    /// A board at the end of the slice in which the program of a row makes its first call.
    fn begin(row: &'r Json, mut board: Released) -> Self {
        for name in ["Vel", "Accel", "Jerk"] {
            board.poke(name, number(&row[name]));
        }
        board.poke("InputMode", 4.0);
        board.command(&format!("EnableAxisDest0 {:?}", number(&row["start_dest"])));
        // Set exactly: the firmware's conversion of numbers has an error of one bit with some fractions.
        board.poke("Dest", number(&row["start_dest"]));
        let program = board.load(thread(1), &program(row));
        board.board.execute_together(&[thread(1)]).unwrap_or_else(|crash| panic!("{crash}"));
        board.reach_match();
        let mut replay = Self { row, board, program, first: 0.0, found: Vec::new() };
        for _ in 0..BEGIN {
            replay.first = replay.noted("first", 0);
            if replay.first != 0.0 {
                return replay;
            }
            replay.board.next_match();
        }
        panic!("the program does not begin");
    }

    /// Returns a value noted by the program.
    fn noted(&self, name: &str, index: u32) -> f64 {
        self.board.board.memory().peek(self.program.variable(name).offset(8 * index))
    }

    /// Checks a call that has ended: the time, and the resulting states.
    fn check_call(&mut self, call: &Json, index: u32) {
        let at = ["begun", "ended"].map(|name| self.noted(name, index) - self.first);
        let expect = ["begin_tick", "end_tick"].map(|name| number(&call[name]));
        if at != expect {
            self.found.push(format!("{} in ticks {at:?}, recorded {expect:?}", call["call"]));
        }
        let (states, expect) = (states(&self.board), recorded_states(call));
        if states != expect {
            self.found.push(format!("{}: states\n  {states:?}\n  {expect:?}", call["call"]));
        }
    }

    fn check_sample(&mut self, tick: u64, sample: &Json) {
        if !(self.board.is(0, "Dest", &sample[1]) && self.board.is(0, "last_vel", &sample[2])) {
            let is = ["Dest", "last_vel"].map(|name| self.board.peek(name));
            self.found.push(format!("tick {tick}: {is:?}, recorded {sample}"));
        }
    }

    fn check_end(&mut self, done: Option<u64>) {
        if done != self.row["done_tick"].as_u64() {
            self.found.push(format!("done in {done:?}, recorded {:?}", self.row["done_tick"]));
        }
        for name in ["LastMotionType", "LastMotionDest", "ExpMotionVc", "ExpMotionXc"] {
            if !self.board.is(0, name, &self.row[name]) {
                self.found.push(format!("{name} {}, recorded {}", self.board.peek(name), self.row[name]));
            }
        }
    }
}

/// Returns the differences between the firmware and its recording.
fn differences(row: &Json, board: Released) -> Vec<String> {
    let mut replay = Replay::begin(row, board);
    let mut calls = list(&row["calls"]).iter().zip(0_u32..).peekable();
    let mut samples = list(&row["samples"]).iter().peekable();
    let (mut tick, mut done) = (0, None);
    let last = end(row);
    loop {
        while let Some((call, index)) = calls.next_if(|(_, index)| replay.noted("ended", *index) != 0.0) {
            replay.check_call(call, index);
            done = None;
        }
        if !replay.found.is_empty() || tick >= last && calls.peek().is_none() {
            break;
        }
        tick += 1;
        replay.board.next_match();
        if done.is_none() && calls.peek().is_none() && replay.board.peek("pcoeff") == 0.0 {
            done = Some(tick);
        }
        if let Some(sample) = samples.next_if(|sample| number(&sample[0]) as u64 == tick) {
            replay.check_sample(tick, sample);
        }
    }
    if replay.found.is_empty() && samples.peek().is_none() {
        replay.check_end(done);
    }
    replay.found
}

#[test]
fn the_released_firmware_reproduces_the_recorded_motions() {
    let Some(board) = released() else { return };
    let rows = rows("motion.jsonl");
    let mut wrong = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let found = differences(row, board.clone());
        if !found.is_empty() {
            wrong.push(format!("row {index} ({}):\n {}", text(&row["tag"]), found.join("\n ")));
        }
    }
    report(&wrong, rows.len());
}
