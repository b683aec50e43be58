//! Replays the recorded coordinated motion of the released firmware.
//!
//! A recording is a list of script commands with the ticks at which they were sent, and rows of the contents of guest
//! memory after some ticks. The script commands are interpreted here, by hand; the rest of the board is complete.
//! [`IN_SLICE`] lists the two rows that differ; the test fails if one of them no longer differs.

use std::collections::VecDeque;

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::{Chan, Spindle};
use kmotiondef::variables::{
    CHAN, COORD_SYSTEM0, CS0_DECEL_TIME, CS0_DOING_RAPID, CS0_FLUSHED, CS0_HOLD_AT_END, CS0_LAST_FRO,
    CS0_LAST_RAPID_FRO, CS0_NOM_DECEL_2TB2, CS0_STOPPING_STATE, CS0_T, CS0_TIME_BASE, CS0_TIME_BASE_DELTA,
    CS0_TIME_BASE_DESIRED, CS0_TIME_DOWNLOADED, CS0_TIME_EXECUTED, CS0_TIME_LOST, KLP, SPINDLE,
    SPLINE_TAU_FACTOR, TAU_KLP, VIRTUAL_BITS,
};
use kmotiondef::{AxisId, Bit, GuestAddr};
use serde_json::Value as Json;
use vm::memory::GuestMemory;

use super::download::{self, Circle, Plane, Point, Timing};
use super::segment::Command;
use super::{buffer, system};
use crate::testing::TestBench;
use crate::text::vectors::rows;
use crate::views::TypedAccess;

/// Rows that were read in the middle of a slice, by the recording and its ticks: the primary thread had not yet stored
/// the stop that it was computing. No program runs between this point and the next tick, so none can observe it.
const IN_SLICE: (&str, [u64; 2]) =
    ("limit switch action stop during buffer execution, resume into the limit", [3002, 6004]);

/// A spindle turned by a recording: the axis whose position was written, its initial position and its counts per tick.
struct RecordedSpindle {
    name: &'static str,
    axis: i32,
    offset: f64,
    counts: f64,
    /// The tick and the base speed at which threading was triggered.
    threads: Option<(u64, f32)>,
}

const SPINDLES: [RecordedSpindle; 4] = [
    RecordedSpindle { name: "spindle speed measurement", axis: 0, offset: 0.0, counts: 0.9, threads: None },
    RecordedSpindle {
        name: "threading at the base speed",
        axis: 3,
        offset: 0.0,
        counts: 3.6864,
        threads: Some((301, 10.0)),
    },
    RecordedSpindle {
        name: "threading at half the base speed",
        axis: 3,
        offset: 100.0,
        counts: 1.8432,
        threads: Some((301, 10.0)),
    },
    RecordedSpindle {
        name: "threading, spindle turning backwards",
        axis: 3,
        offset: 0.0,
        counts: -3.6864,
        threads: Some((301, 10.0)),
    },
];

/// Precision of threading: speed and filter are singles.
const SPINDLE_FILTER: f64 = 1e-8;

/// Ticks between setting the spindle up and the first row of its recordings, as the measurements show.
const SPINDLE_LEAD: u64 = 76;

/// The columns that hold positions.
const POSITIONS: [usize; 4] = [7, 8, 9, 14];

/// The board of the recordings: axes 0 and 1 enabled, X and Y.
struct RecordedBoard {
    bench: TestBench,
    /// A motion call that waits for its caller's next slice: in this many ticks.
    waiting: Option<(u64, String, Vec<u64>)>,
    /// The tolerance of a result, relative: values that pass through the board's divisions and singles are less exact.
    precision: f64,
    /// The results of `CheckDoneBuf` after the latest ticks, newest first.
    done: VecDeque<i32>,
}

impl RecordedBoard {
    fn new() -> Self {
        let mut bench = TestBench::new();
        // The status was not requested while the recordings were made.
        bench.kernel.parts.pc.host.connect(false);
        system::assign(&mut bench.memory, &[0, 1, -1, -1]);
        for axis in AxisId::all().take(3) {
            bench.memory.set_axis(axis, Chan::VEL, 1000.0);
            bench.memory.set_axis(axis, Chan::ACCEL, 10_000.0);
            bench.memory.set_axis(axis, Chan::JERK, 100_000.0);
        }
        for axis in AxisId::all().take(2) {
            bench.call("EnableAxisDest", &[axis.get().into(), 0]);
        }
        Self { bench, waiting: None, precision: 1e-9, done: VecDeque::new() }
    }

    /// Notes the answer that a thread would get now.
    fn ask(&mut self) {
        self.done.push_front(self.bench.call_i32("CheckDoneBuf", &[]));
        self.done.truncate(3);
    }

    /// Carries out a line of commands; the last one's reply is the result.
    fn line(&mut self, line: &str) -> Result<String, String> {
        let mut reply = String::new();
        for text in line.split(';') {
            reply = self.command(text.trim_start_matches('?'))?;
        }
        Ok(reply)
    }

    fn command(&mut self, text: &str) -> Result<String, String> {
        if let Some(poke) = text.strip_prefix("!poke ") {
            return self.poke(poke);
        }
        let words = text.len() - text.trim_start_matches(|letter: char| letter.is_ascii_alphabetic()).len();
        let (word, rest) = text.split_at(words);
        let parsed: Result<Vec<f32>, _> =
            rest.split([' ', '=']).filter(|part| !part.is_empty()).map(str::parse).collect();
        let numbers = parsed.map_err(|_| text.to_owned())?;
        self.buffer_command(word, &numbers)
            .or_else(|| self.motion_command(word, &numbers))
            .or_else(|| self.function_command(word, &numbers))
            .unwrap_or_else(|| Err(text.to_owned()))
    }

    fn buffer_command(&mut self, word: &str, numbers: &[f32]) -> Option<Result<String, String>> {
        let memory = &mut self.bench.memory;
        let bit = numbers.first().and_then(|number| Bit::new(*number as i32));
        match word {
            "OpenBuf" => buffer::open(memory),
            "ExecBuf" => buffer::execute(memory),
            "FlushBuf" => buffer::flush(memory),
            "ExecTime" => return Some(Ok(format!("{:.6}\r\n", buffer::executed_time(memory)))),
            "CheckDoneBuf" => return Some(Ok(format!("{}\r\n", buffer::check_done(memory)))),
            "Linear" => line(memory, numbers),
            "Arc" => arc(memory, Plane::Xy, numbers),
            "ArcXZ" => arc(memory, Plane::Zx, numbers),
            "ArcYZ" => arc(memory, Plane::Yz, numbers),
            "SetBitBuf" => add(memory, Command::Drive(bit?, true)),
            "ClearBitBuf" => add(memory, Command::Drive(bit?, false)),
            "SetStateBitBuf" => add(memory, Command::Drive(bit?, numbers[1] == 1.0)),
            "WaitBitBuf" => add(memory, Command::Wait(bit?, true)),
            "WaitNotBitBuf" => add(memory, Command::Wait(bit?, false)),
            "BegRapidBuf" => add(memory, Command::Rapid(true)),
            "EndRapidBuf" => add(memory, Command::Rapid(false)),
            _ => return None,
        }
        Some(Ok(String::new()))
    }

    /// The commands that may wait for slices of their caller, which has every other tick.
    fn motion_command(&mut self, word: &str, numbers: &[f32]) -> Option<Result<String, String>> {
        let number = |index: usize| numbers.get(index).copied().unwrap_or_default();
        let double = |index| f64::from(number(index)).to_bits();
        let axis = u64::from(number(0) as u32);
        let arguments = match word {
            "Jog" | "Move" | "MoveRel" => vec![axis, double(1)],
            "MoveExp" => vec![axis, double(1), double(2)],
            "MoveXYZABC" => (0..6).map(double).collect(),
            "StopImmediate" if number(0) < 2.0 => Vec::new(),
            _ => return None,
        };
        let word = match (word, number(0) == 0.0) {
            ("StopImmediate", true) => "StopCoordinatedMotion",
            ("StopImmediate", false) => "ResumeCoordinatedMotion",
            _ => word,
        };
        // The primary thread reads six numbers until its next slice.
        let is_long = word == "MoveXYZABC";
        if is_long || !self.bench.is_done(word, &arguments) {
            self.waiting = Some((2, word.to_owned(), arguments));
        }
        Some(Ok(String::new()))
    }

    /// Turns the spindle before a tick as in the recording.
    fn turn(&mut self, spindle: &RecordedSpindle, tick: u64, last: u64) -> Result<(), String> {
        let axis = AxisId::new(spindle.axis).ok_or("an axis")?;
        if tick < last {
            let position = spindle.offset + spindle.counts * tick as f64;
            self.bench.memory.set_axis(axis, Chan::POSITION, position);
        }
        if let Some((_, speed)) = spindle.threads.filter(|threads| threads.0 == tick) {
            self.bench.call("TrigThreading", &[speed.to_bits().into()]);
        }
        if spindle.threads.is_none() && tick == 3000 {
            let found = self.line("GetSpindleRPS")?;
            (found == "2.441406\r\n").then_some(()).ok_or(found)?;
        }
        Ok(())
    }

    /// Makes the call that is due before a tick, and executes the tick.
    fn tick(&mut self) {
        if let Some((ticks, name, arguments)) = self.waiting.take() {
            if ticks > 0 {
                self.waiting = Some((ticks - 1, name, arguments));
            } else if !self.bench.wake(&name, &arguments) {
                self.waiting = Some((1, name, arguments));
            }
        }
        self.bench.run(1);
    }

    /// The commands that are calls of firmware functions.
    fn function_command(&mut self, word: &str, numbers: &[f32]) -> Option<Result<String, String>> {
        let first = numbers.first().copied().unwrap_or_default();
        let (bench, single, integer) = (&mut self.bench, u64::from(first.to_bits()), first as i32);
        let second = numbers.get(1).map_or(0, |number| f64::from(*number).to_bits());
        let number = u64::from(integer as u32);
        match (word, integer) {
            ("ConfigSpindle", _) => {
                let single =
                    |index: usize| u64::from(numbers.get(index).copied().unwrap_or_default().to_bits());
                let axis = numbers.get(1).map_or(0, |axis| *axis as u64);
                bench.call("ConfigureSpindle", &[number, axis, single(2), single(3), single(4)]);
                bench.memory.set_axis(AxisId::new(axis as i32)?, Chan::INPUT_MODE, 4);
            }
            ("GetSpindleRPS", _) => {
                let speed = bench.memory.get(SPINDLE.field(Spindle::TRUE_SPEED_RPS));
                return Some(Ok(format!("{speed:.6}\r\n")));
            }
            ("SetFRO" | "SetRapidFRO" | "SetFROTemp", _) => bench.call(word, &[single]),
            ("StopImmediate", 2) => bench.call("ClearStopImmediately", &[]),
            ("SetBit" | "ClearBit" | "DisableAxis", _) => bench.call(word, &[number]),
            ("EnableAxisDest", _) => bench.call(word, &[number, second]),
            ("GetStopState", _) => return Some(Ok(self.stop_state())),
            ("Dest", _) => {
                bench.memory.set_axis(AxisId::new(integer)?, Chan::DEST, f64::from(*numbers.get(1)?));
            }
            ("DefineCS", _) => {
                let axes: Vec<i32> = numbers.iter().map(|number| *number as i32).collect();
                system::assign(&mut bench.memory, &axes);
            }
            _ => return None,
        }
        Some(Ok(String::new()))
    }

    fn stop_state(&mut self) -> String {
        self.bench.call("UpdateStoppingState", &[]);
        format!("{}\r\n", self.bench.memory.get(CS0_STOPPING_STATE))
    }

    /// `chan+88 f 1000.0`, `KLP d 0.9`: stores a value directly.
    fn poke(&mut self, text: &str) -> Result<String, String> {
        let refused = || text.to_owned();
        let mut words = text.split(' ');
        let (place, kind) = (words.next().ok_or_else(refused)?, words.next().ok_or_else(refused)?);
        let value: f64 = words.next().and_then(|word| word.parse().ok()).ok_or_else(refused)?;
        let address = address(place).ok_or_else(refused)?;
        match kind {
            "i" => self.bench.memory.poke(address, value as i32),
            "f" => self.bench.memory.poke(address, value as f32),
            "d" => self.bench.memory.poke(address, value),
            _ => return Err(refused()),
        }
        Ok(String::new())
    }

    /// Returns whether a value is equal within the digits and the precision of the recording.
    fn is_close(&self, column: usize, found: f64, expect: f64, [extent, path_time]: [f64; 2]) -> bool {
        let tolerance = match column {
            1 => self.precision * path_time.abs(),
            // Overrides are recorded with nine digits.
            3 | 4 => f64::max(6.0 * self.precision, 6e-9) * expect.abs(),
            _ if POSITIONS.contains(&column) => self.precision * extent,
            _ => self.precision * expect.abs(),
        };
        (found - expect).abs() <= tolerance + 1e-12
    }

    /// Returns the difference between a recorded row and the board.
    fn difference(&self, row: &[Json]) -> Option<String> {
        let memory = &self.bench.memory;
        let axis = |number, field| AxisId::new(number).map_or(f64::NAN, |axis| memory.axis(axis, field));
        let executing = !memory.get(COORD_SYSTEM0).is_null();
        let found = [
            (1, memory.get(CS0_T)),
            (2, memory.get(CS0_TIME_EXECUTED)),
            (3, memory.get(CS0_TIME_BASE) / TIMEBASE),
            (4, memory.get(CS0_TIME_BASE_DESIRED) / TIMEBASE),
            (5, f64::from(memory.get(CS0_STOPPING_STATE))),
            (6, f64::from(u8::from(executing))),
            (7, axis(0, Chan::DEST)),
            (8, axis(0, Chan::UNFILTERED_DEST)),
            (9, axis(1, Chan::DEST)),
            (13, f64::from(memory.get(VIRTUAL_BITS))),
            (14, axis(2, Chan::DEST)),
        ];
        // Rounding on the board is relative to the whole path.
        let extent = POSITIONS.iter().map(|&column| number(&row[column]).abs()).fold(1.0, f64::max);
        let path_time = number(&row[1]) + number(&row[2]);
        let wrong = found.iter().find(|&&(column, value)| {
            !self.is_close(column, value, number(&row[column]), [extent, path_time])
        });
        if let Some((column, value)) = wrong {
            return Some(format!("column {column}: {value:?} instead of {}", row[*column]));
        }
        // The recording queried it from a thread, up to two ticks before.
        let done = &row[11];
        let seen = self.done.iter().any(|&value| done.as_i64() == Some(value.into()));
        (!seen).then(|| format!("CheckDoneBuf: {:?} instead of {done}", self.done))
    }

    /// The final value of a variable.
    fn variable(&self, name: &str) -> Option<f64> {
        let memory = &self.bench.memory;
        Some(match name {
            "CS0_TimeDownloaded" => memory.get(CS0_TIME_DOWNLOADED),
            "CS0_TimeLost" => memory.get(CS0_TIME_LOST),
            "CS0_TimeBaseDelta" => memory.get(CS0_TIME_BASE_DELTA),
            "CS0_DecelTime" => memory.get(CS0_DECEL_TIME).into(),
            "CS0_LastFRO" => memory.get(CS0_LAST_FRO).into(),
            "CS0_LastRapidFRO" => memory.get(CS0_LAST_RAPID_FRO).into(),
            "CS0_Flushed" => memory.get(CS0_FLUSHED).into(),
            "CS0_DoingRapid" => memory.get(CS0_DOING_RAPID).into(),
            "TauKLP" => memory.get(TAU_KLP).into(),
            "CS0_NomDecel2TB2" => memory.get(CS0_NOM_DECEL_2TB2).into(),
            "Spindle" => memory.get(SPINDLE.field(Spindle::POSITION)),
            "Spindle+8" => memory.get(SPINDLE.field(Spindle::START_POSITION)),
            "Spindle+16" => memory.get(SPINDLE.field(Spindle::LAST_UPDATE_POSITION)),
            "Spindle+24" => memory.get(SPINDLE.field(Spindle::REVS_PER_COUNT)),
            "Spindle+40" => memory.get(SPINDLE.field(Spindle::DELTA_TICKS)),
            "Spindle+48" => memory.get(SPINDLE.field(Spindle::ADJ_TIME_FILT)),
            "Spindle+56" => memory.get(SPINDLE.field(Spindle::LAST_CS_TIME)),
            "GetNominalFROChangeTime" => system::nominal_change_time(memory).into(),
            _ => return None,
        })
    }
}

fn line(memory: &mut GuestMemory, numbers: &[f32]) {
    let timing = timing(&numbers[12..]);
    download::line(memory, &point(0, &numbers[..6]), &point(0, &numbers[6..12]), &timing).expect("room");
}

fn arc(memory: &mut GuestMemory, plane: Plane, numbers: &[f32]) {
    let circle = Circle {
        plane,
        centre: [numbers[0], numbers[1]],
        radii: [numbers[2], numbers[3]],
        angle: numbers[4],
        turn: numbers[5],
    };
    // The letter outside of the plane comes first.
    let rest = match plane {
        Plane::Xy => 2,
        Plane::Zx => 1,
        Plane::Yz => 0,
    };
    let others = |numbers: &[f32]| {
        let mut others = point(2, numbers);
        others[rest] = numbers[0];
        others
    };
    let timing = timing(&numbers[14..]);
    download::arc(memory, &circle, &others(&numbers[6..10]), &others(&numbers[10..14]), &timing)
        .expect("room");
}

fn add(memory: &mut GuestMemory, command: Command) {
    download::command(memory, command).expect("room");
}

/// The letters from `first` on, set from numbers; the others are 0.
fn point(first: usize, numbers: &[f32]) -> Point {
    let mut point = Point::default();
    point[first..first + numbers.len()].copy_from_slice(numbers);
    point
}

fn timing(numbers: &[f32]) -> Timing {
    Timing { polynomial: [numbers[0], numbers[1], numbers[2], numbers[3]], duration: numbers[4] }
}

fn address(place: &str) -> Option<GuestAddr> {
    Some(match place {
        "VirtualBits" => VIRTUAL_BITS.address(),
        "KLP" => KLP.address(),
        "SplineTauFactor" => SPLINE_TAU_FACTOR.address(),
        "CS0_HoldAtEnd" => CS0_HOLD_AT_END.address(),
        _ => CHAN.address().offset(place.strip_prefix("chan+")?.parse().ok()?),
    })
}

fn number(value: &Json) -> f64 {
    value.as_f64().expect("a number")
}

/// Replays a recording; the result is the first difference.
fn replay(recording: &Json) -> Result<(), String> {
    let mut board = RecordedBoard::new();
    for line in recording["setup"].as_array().expect("a list") {
        board.line(line.as_str().expect("a line"))?;
    }
    let spindle = SPINDLES.iter().find(|spindle| recording["name"] == spindle.name);
    if spindle.is_some() {
        board.precision = SPINDLE_FILTER;
        board.bench.run(SPINDLE_LEAD);
    }
    let nothing = Vec::new();
    let timeline = recording["timeline"].as_array().unwrap_or(&nothing);
    let last_tick =
        recording["rows"].as_array().and_then(|rows| rows.last()).map_or(0, |row| number(&row[0]) as u64);
    let mut replies = recording["replies"].as_array().expect("a list").iter();
    let mut rows = recording["rows"].as_array().expect("a list").iter().peekable();
    let (mut tick, mut due) = (0, Vec::new());
    while let Some(row) = rows.peek() {
        for event in timeline {
            let line = event[1].as_str().expect("a line");
            let sent = number(&event[0]) as u64;
            let comes = if line.starts_with("!poke") { sent } else { sent | 1 };
            if comes == tick {
                due.push(line);
            }
        }
        for line in std::mem::take(&mut due) {
            let reply = board.line(line)?;
            if line.starts_with('?') {
                let expect = &replies.next().expect("a reply")[2];
                (*expect == reply).then_some(()).ok_or(format!("{line}: {reply} instead of {expect}"))?;
            }
        }
        if let Some(spindle) = spindle {
            board.turn(spindle, tick, last_tick)?;
        }
        if tick > 0 {
            board.tick();
        }
        board.ask();
        if number(&row[0]) as u64 == tick {
            let row = row.as_array().expect("a row");
            let is_in_slice = recording["name"] == IN_SLICE.0 && IN_SLICE.1.contains(&tick);
            match board.difference(row) {
                None if is_in_slice => return Err(format!("tick {tick} is reproduced, though listed")),
                Some(text) if !is_in_slice => return Err(format!("tick {tick}, {text}")),
                _ => {}
            }
            rows.next();
        }
        tick += 1;
    }
    for (name, expect) in recording["at_end"].as_object().expect("variables") {
        let found = board.variable(name).ok_or(name.as_str())?;
        close_enough(name, found, number(expect))?;
    }
    Ok(())
}

/// Compares a final value.
fn close_enough(name: &str, found: f64, expect: f64) -> Result<(), String> {
    let differs = (found - expect).abs() > 1e-12 * expect.abs();
    if differs { Err(format!("{name}: {found:?} instead of {expect:?}")) } else { Ok(()) }
}

#[test]
fn paths_match_the_recording() {
    let recordings = rows("coord.jsonl");
    let name = |recording: &Json| recording["name"].as_str().expect("a name").to_owned();
    let differing: Vec<(String, String)> =
        recordings.iter().filter_map(|recording| Some((name(recording), replay(recording).err()?))).collect();
    assert!(differing.is_empty(), "{} differ: {differing:#?}", differing.len());
}
