//! The outcome of a run on either board, and the differences.

use std::fmt;

use cc67_host::{BootedTarget, Session, Target};
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{BIT_DIR_SHADOW, PERSIST, chan};
use kmotiondef::{Bit, Cycles, Ticks};
use runtime::{Event, EventKind};

use crate::cli::report::numbers::{Deviation, Tolerance, deviation};
use crate::cli::session::BoardSession;

/// The number of pins of the board.
const PINS: i32 = 48;
/// Pins of step generators: the level of a pulse is not modelled at register level.
const STEP_PINS: [std::ops::Range<usize>; 2] = [8..16, 36..44];
/// Pins that the firmware toggles while there is a KStep: they select its inputs.
const KSTEP_PINS: std::ops::Range<usize> = 2..4;
/// The precision with which positions are compared: a thousandth.
const POSITION: f64 = 1e-3;

/// The kind of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineKind {
    Console,
    Reply,
    /// An action of the PC.
    Host,
    /// An expectation of the stimulus that was not met.
    Unmet,
}

/// The outcome of a run on either board.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// Board time in seconds, the kind, and the text.
    pub(super) lines: Vec<(f64, LineKind, String)>,
    /// The end of the run.
    pub(super) end: String,
    /// The time of the end.
    pub(super) ticks: Ticks,
    /// The characters sent by the serial port, if recorded.
    serial: Vec<u8>,
    user_data: Vec<u32>,
    /// The state before the run, for a board that was not reset.
    before: StartState,
    /// The commanded and measured position of each axis.
    pub(super) axes: Vec<(f64, f64)>,
    /// The commanded movement of each axis during the tolerance of time, if it is still moving.
    pub(super) reach: Vec<f64>,
    /// The positions of the axes at the very end, for those that came to rest a little later.
    pub(super) last_axes: Vec<(f64, f64)>,
    /// The pins at the end.
    pins: Vec<Pin>,
    /// True if there is a KStep.
    has_kstep: bool,
}

/// The state before a run of a board that was not reset.
#[derive(Clone, Debug, Default, PartialEq)]
struct StartState {
    user_data: Vec<u32>,
    axes: Vec<(f64, f64)>,
    pins: Vec<Pin>,
}

/// A difference: the quantity, its values on the model and on the firmware, and the page with the specification.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Difference {
    pub(super) what: String,
    pub(super) model: String,
    pub(super) firmware: String,
    pub(super) page: &'static str,
}

impl Outcome {
    /// Records an event's line.
    pub(super) fn note(&mut self, event: &Event) {
        if let EventKind::UartSent(byte) = event.kind {
            self.serial.push(byte);
        }
        let seconds = event.at.get() as f64 / Cycles::PER_SECOND.get() as f64;
        let (kind, text) = match &event.kind {
            EventKind::ConsoleLine(text) => (LineKind::Console, String::from_utf8_lossy(text)),
            EventKind::Reply(text) => (LineKind::Reply, String::from_utf8_lossy(text)),
            EventKind::Host(text) => (LineKind::Host, text.into()),
            EventKind::Unmet(text) => (LineKind::Unmet, text.into()),
            _ => return,
        };
        self.lines.push((seconds, kind, text.into_owned()));
    }

    /// Records the state before the run of a board that was not reset.
    pub(super) fn look_before<T: Target>(&mut self, session: &Session<T>) {
        let (user_data, axes, pins) = (user_data(session), axes(session), pins(session));
        self.before = StartState { user_data, axes, pins };
    }

    /// Drops the lines that only a simulated PC reports.
    pub(super) fn without_the_pc(&mut self) {
        self.lines.retain(|line| line.1 != LineKind::Host);
    }

    /// Records the final state of the modelled board or of a controller.
    pub(super) fn look_at_model<T: Target>(&mut self, board: &BoardSession<T>) {
        let session = &board.session;
        self.ticks = session.tick();
        self.user_data = user_data(session);
        self.axes = axes(session);
        self.pins = pins(session);
    }

    /// Records the final state of the board with the firmware file.
    pub(super) fn look_at_firmware(&mut self, session: &Session<BootedTarget>) {
        let target = session.target();
        if let Some(persist) = target.file().address("persist") {
            let data = persist.offset(Persist::USER_DATA.offset());
            self.user_data = (0..200).map(|index| session.peek(data.offset(4 * index))).collect();
        }
        let kstep = target.file().address("KStepPresent").map(|at| session.peek::<u32>(at));
        self.has_kstep = kstep.is_some_and(|present| present != 0);
        let pin = |(is_output, is_high)| Pin { is_output, is_high };
        self.pins = (0..PINS as usize).map(|number| pin(target.pin(number))).collect();
    }

    /// The largest difference between the times of lines, relative to the first lines.
    pub(super) fn latest(&self, other: &Self) -> f64 {
        let pairs = self.lines.iter().zip(&other.lines);
        pairs.map(|(one, two)| (one.0 - two.0).abs()).fold(0.0, f64::max)
    }

    /// Returns the differences, in the order in which they occur, and the values within tolerance.
    pub(super) fn differences(
        &self,
        firmware: &Self,
        allowed: Option<Tolerance>,
    ) -> (Vec<Difference>, NearLines) {
        let mut near = NearLines::default();
        let mut found = self.lines_that_differ(firmware, allowed, &mut near);
        if self.end != firmware.end {
            let page = "threads-and-time.md";
            found.push(Difference::new("how it ended", &self.end, &firmware.end, page));
        }
        if self.serial != firmware.serial {
            let shown = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            let (one, two) = (shown(&self.serial), shown(&firmware.serial));
            found.push(Difference::new("serial port", one, two, "devices.md"));
        }
        for (index, (one, two)) in self.user_data.iter().zip(&firmware.user_data).enumerate() {
            // A value that neither run has changed carries no information.
            let is_untouched = *one == 0 && firmware.before.user_data.get(index) == Some(two);
            if one != two && !is_untouched {
                let hex = |word: &u32| format!("0x{word:08X}");
                let what = format!("persist.UserData[{index}]");
                found.push(Difference::new(what, hex(one), hex(two), "gather-persist-console.md"));
            }
        }
        found.extend(self.axes_that_differ(firmware));
        found.extend(self.pins_that_differ(firmware));
        (found, near)
    }

    fn lines_that_differ(
        &self,
        firmware: &Self,
        allowed: Option<Tolerance>,
        near: &mut NearLines,
    ) -> Vec<Difference> {
        let mut found = Vec::new();
        for index in 0..self.lines.len().max(firmware.lines.len()) {
            let (one, two) = (self.lines.get(index), firmware.lines.get(index));
            if one.map(|one| (one.1, &one.2)) == two.map(|two| (two.1, &two.2)) {
                continue;
            }
            if let (Some(one), Some(two), Some(allowed)) = (one, two, allowed)
                && one.1 == two.1
                && let Some(deviation) = deviation(&one.2, &two.2, allowed)
            {
                near.note(index + 1, deviation);
                continue;
            }
            let shown = |line: Option<&(f64, LineKind, String)>| match line {
                Some((at, _, text)) => format!("{at:.6} s  {text}"),
                None => "(no more lines)".to_owned(),
            };
            let page = "gather-persist-console.md, threads-and-time.md";
            found.push(Difference::new(format!("line {}", index + 1), shown(one), shown(two), page));
        }
        found
    }

    fn axes_that_differ(&self, firmware: &Self) -> Vec<Difference> {
        let mut found = Vec::new();
        for (axis, (one, two)) in self.axes.iter().zip(&firmware.axes).enumerate() {
            if one.0 == 0.0 && firmware.before.axes.get(axis).is_some_and(|before| before.0 == two.0) {
                continue;
            }
            let last = firmware.last_axes.get(axis).map_or(two.0, |last| last.0);
            let reach = POSITION + firmware.reach.get(axis).copied().unwrap_or(0.0);
            if (one.0 - two.0).abs() > reach && (one.0 - last).abs() > POSITION {
                let shown = |axis: &(f64, f64)| format!("Dest {:.6}", axis.0);
                let what = format!("axis {axis}");
                found.push(Difference::new(what, shown(one), shown(two), "axes-and-motion.md"));
            }
        }
        found
    }

    fn pins_that_differ(&self, firmware: &Self) -> Vec<Difference> {
        let mut found = Vec::new();
        for (pin, (one, two)) in self.pins.iter().zip(&firmware.pins).enumerate() {
            let is_pulsed = STEP_PINS.iter().any(|pins| pins.contains(&pin))
                || firmware.has_kstep && KSTEP_PINS.contains(&pin);
            // Inputs are driven equally on both boards, and the output of a generator is high for only part of the
            // time. A pin made an output only by an earlier program carries no information.
            let is_untouched = !one.is_output && firmware.before.pins.get(pin) == Some(two);
            let matters = (one.is_output || two.is_output) && !is_pulsed && !is_untouched;
            if matters && one.is_high != two.is_high {
                let shown = |pin: &Pin| u8::from(pin.is_high).to_string();
                found.push(Difference::new(format!("bit {pin}"), shown(one), shown(two), "io.md"));
            }
        }
        found
    }
}

/// The pins of a board, from its memory and its bits.
fn pins<T: Target>(session: &Session<T>) -> Vec<Pin> {
    let directions = [0, 1].map(|word| session.peek_object::<u32>(BIT_DIR_SHADOW.element(word).address()));
    let pins = (0..PINS).map(|pin| Pin {
        is_output: directions[usize::from(pin >= 32)] >> (pin % 32) & 1 != 0,
        is_high: Bit::new(pin).is_some_and(|bit| session.bit(bit)),
    });
    pins.collect()
}

/// The commanded and measured position of each axis.
fn axes<T: Target>(session: &Session<T>) -> Vec<(f64, f64)> {
    let axes = session.target().axes().iter().map(|axis| {
        let base = chan(axis).address();
        let position = |field: u32| session.peek_object(base.offset(field));
        (position(Chan::DEST.offset()), position(Chan::POSITION.offset()))
    });
    axes.collect()
}

/// The elements of `persist.UserData`.
fn user_data<T: Target>(session: &Session<T>) -> Vec<u32> {
    let data = PERSIST.field(Persist::USER_DATA).address();
    (0..200).map(|index| session.peek_object(data.offset(4 * index))).collect()
}

/// A pin of the board.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pin {
    is_output: bool,
    is_high: bool,
}

impl Difference {
    fn new(
        what: impl Into<String>,
        model: impl Into<String>,
        firmware: impl Into<String>,
        page: &'static str,
    ) -> Self {
        Self { what: what.into(), model: model.into(), firmware: firmware.into(), page }
    }
}

/// Lines whose numbers differ within the tolerance.
#[derive(Debug, Default)]
pub(super) struct NearLines {
    count: usize,
    /// The index of the first.
    first: usize,
    /// The largest deviation.
    most: Deviation,
}

impl NearLines {
    /// `self` if there are any such lines.
    pub(super) fn any(&self) -> Option<&Self> {
        (self.count > 0).then_some(self)
    }

    fn note(&mut self, line: usize, deviation: Deviation) {
        if self.count == 0 {
            self.first = line;
        }
        // A number in a different notation is still the same number.
        if !deviation.is_none() {
            self.count += 1;
            self.most = self.most.max(deviation);
        }
    }
}

impl fmt::Display for NearLines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            1 => write!(f, "line {}: its numbers differ by {}", self.first, self.most),
            count => write!(
                f,
                "line {} and {} more: their numbers differ by {} at most",
                self.first,
                count - 1,
                self.most
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALLOWED: Tolerance = Tolerance { seconds: 0.001, number: 0.001 };

    fn of_lines(lines: &[&str]) -> Outcome {
        let lines = lines.iter().map(|line| (0.0, LineKind::Console, (*line).to_owned()));
        Outcome { lines: lines.collect(), ..Outcome::default() }
    }

    #[test]
    fn lines_with_nearly_equal_times_are_reported_but_do_not_differ() {
        let model = of_lines(&["wound 4 layers", "took 3.200123 s", "in 3.2003 s"]);
        let firmware = of_lines(&["wound 4 layers", "took 3.200126 s", "in 3.2004 s"]);
        let (found, near) = model.differences(&firmware, Some(ALLOWED));
        assert_eq!(found, []);
        assert_eq!(near.to_string(), "line 2 and 1 more: their numbers differ by 100 µs at most");
        assert_eq!(model.differences(&firmware, None).0.len(), 2);
        assert!(model.differences(&model, None).1.any().is_none());
    }

    #[test]
    fn changed_and_missing_lines_differ() {
        let (found, near) =
            of_lines(&["4 layers", "end"]).differences(&of_lines(&["5 layers"]), Some(ALLOWED));
        let what: Vec<_> = found.iter().map(|difference| difference.what.as_str()).collect();
        assert_eq!((what, near.any().is_none()), (vec!["line 1", "line 2"], true));
        assert_eq!(found[1].firmware, "(no more lines)");
    }

    #[test]
    fn pins_differ_only_where_one_board_drives_them() {
        let of =
            |is_output, is_high| Outcome { pins: vec![Pin { is_output, is_high }], ..Outcome::default() };
        let count = |model: Outcome, firmware: Outcome| model.differences(&firmware, None).0.len();
        assert_eq!(count(of(false, true), of(false, false)), 0);
        assert_eq!(count(of(true, true), of(true, false)), 1);
        assert_eq!(count(of(false, true), of(true, false)), 1);
    }
}
