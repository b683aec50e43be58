//! Random programs that move axes, whose final positions must be the same on two boards.
//!
//! The same code takes a few microseconds more or less on the two boards, so the motions must not depend on its timing:
//! a group of motions begins with a slice when everything is at rest, each further motion of the group begins with a
//! later slice, and the next group waits until everything has ended. Nothing interrupts a path of several axes: the
//! tick in which it begins follows from the cost of its planning, on which the boards agree within a tenth.

use std::fmt::Write as _;

use crate::random::Random;

/// The number of axes.
const AXES: u64 = 8;
/// The interval between slices of a thread that runs alone, in µs.
const SLICE: u64 = 180;
/// The number of slices that is never exceeded by the call of a motion.
const FEW: u64 = 5;

/// Waits until nothing moves, at most 2 s: no motion takes longer, but some never report that they are done.
const HEAD: &str = "\
#include \"KMotionDef.h\"

void Settle(void)
{
    int i, busy = 1;
    double end = Time_sec() + 2;

    while (busy && Time_sec() < end)
    {
        WaitNextTimeSlice();
        busy = !CheckDoneXYZABC();
        for (i = 0; i < 8; i++)
            if (chan[i].Enable && !CheckDone(i)) busy = 1;
    }
    WaitNextTimeSlice();
}

main()
{
    double t;

";

/// The program for a seed.
#[must_use]
pub fn program(seed: u64) -> String {
    let mut writer = MotionWriter::new(seed);
    writer.axes();
    for group in 0..3 + writer.below(4) {
        writer.group(group);
    }
    writer.text + "}\n"
}

/// The object of a motion.
#[derive(PartialEq, Eq)]
enum Moved {
    /// One axis.
    Axis,
    /// All axes of the coordinate system, along a path.
    Path,
}

struct MotionWriter {
    random: Random,
    /// The first axis, and the end of the range.
    first: u64,
    end: u64,
    /// The number of slices since the beginning of the group.
    slices: u64,
    text: String,
}

impl MotionWriter {
    fn new(seed: u64) -> Self {
        let random = Random::new((seed * 2 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let mut writer = Self { random, first: 0, end: 0, slices: 0, text: HEAD.to_owned() };
        // Adjacent seeds begin with similar numbers.
        for _ in 0..8 {
            writer.below(2);
        }
        writer
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.random.draw() % limit
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.below(from.len() as u64) as usize]
    }

    fn line(&mut self, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "    {text}");
    }

    fn place(&mut self) -> String {
        format!("{}.{:02}", self.below(200) as i64 - 100, self.below(100))
    }

    fn axis(&mut self) -> u64 {
        self.first + self.below(self.end - self.first)
    }

    /// One to three axes in step modes, which form a coordinate system.
    fn axes(&mut self) {
        let count = 1 + self.below(3);
        self.first = self.below(AXES - count + 1);
        self.end = self.first + count;
        for axis in self.first..self.end {
            let velocity = self.pick(&["500", "1000", "2500.5", "20000"]);
            let (acceleration, jerk) = (self.pick(&["5e3", "1e5", "2e6"]), self.pick(&["1e5", "4e6", "1e9"]));
            self.line(&format!("ch{axis}->InputMode = NO_INPUT_MODE;"));
            self.line(&format!("ch{axis}->OutputMode = STEP_DIR_MODE;"));
            self.line(&format!("ch{axis}->OutputChan0 = 8 + {axis};"));
            self.line(&format!("ch{axis}->Vel = {velocity};"));
            self.line(&format!("ch{axis}->Accel = {acceleration};"));
            self.line(&format!("ch{axis}->Jerk = {jerk};"));
            let place = self.place();
            self.line(&format!("EnableAxisDest({axis}, {place});"));
        }
        let system: Vec<String> = (self.first..self.first + 4)
            .map(|axis| if axis < self.end { axis.to_string() } else { "-1".to_owned() })
            .collect();
        self.line(&format!("DefineCoordSystem({});", system.join(", ")));
    }

    /// Up to three motions, each of which may interrupt the previous one; then a line for each axis.
    fn group(&mut self, group: u64) {
        self.line("WaitNextTimeSlice();");
        self.line("t = Time_sec();");
        self.slices = 0;
        let mut jogs: Vec<u64> = Vec::new();
        for motion in 0..1 + self.below(3) {
            if motion > 0 {
                self.wait(400);
            }
            let axis = self.axis();
            jogs.retain(|jog| *jog != axis);
            if self.motion(axis, &mut jogs) == Moved::Path {
                break;
            }
        }
        for axis in jogs {
            self.wait(100);
            self.line(&format!("Jog({axis}, 0);"));
        }
        self.line("Settle();");
        for axis in self.first..self.end {
            self.line(&format!("printf(\"{group} {axis} %.3f %d\\n\", ch{axis}->Dest, CheckDone({axis}));"));
        }
    }

    /// Waits for one of the next few slices: for a time at which thread 0 has the processor, counted from the beginning
    /// of the group, so that microseconds do not matter.
    fn wait(&mut self, most: u64) {
        self.slices += FEW + self.below(most);
        let microseconds = SLICE * self.slices + SLICE * 3 / 4;
        self.line(&format!("WaitUntil(t + {microseconds}e-6);"));
    }

    fn motion(&mut self, axis: u64, jogs: &mut Vec<u64>) -> Moved {
        let kind = self.below(8);
        let place = self.place();
        let velocity = self.pick(&["300", "500", "5000"]);
        let text = match kind {
            0 => format!("Move({axis}, {place});"),
            1 => format!("MoveRel({axis}, {place});"),
            2 => format!("MoveAtVel({axis}, {place}, {velocity});"),
            3 => format!("MoveRelAtVel({axis}, {place}, {velocity});"),
            4 => {
                jogs.push(axis);
                format!("Jog({axis}, {place});")
            }
            5 => format!("Jog({axis}, 0);"),
            6 => format!("MoveExp({axis}, {place}, {});", self.pick(&["0.005", "0.05"])),
            _ => {
                jogs.clear();
                let places: Vec<String> = (0..6).map(|_| self.place()).collect();
                format!("MoveXYZABC({});", places.join(", "))
            }
        };
        self.line(&text);
        if text.starts_with("MoveXYZABC") { Moved::Path } else { Moved::Axis }
    }
}
