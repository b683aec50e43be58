//! The observation of a scenario on a board, and the first difference between two of them.

use cc67_host::{BootedFirmware, HostError, Session, Setup, Target, UserProgram};
use kmotiondef::structs::Chan;
use kmotiondef::timing::Timing;
use kmotiondef::variables::GATHER_BUFFER;
use kmotiondef::{AxisId, CType, GuestAddr, ThreadId, Ticks};
use runtime::{Event, EventKind};

use super::scenario::Scenario;
use crate::record::{PATH, PATH_VARIABLES, PRECISION, SAMPLES, STATES};

/// The number of ticks of the longest program; one that has stopped the board never ends.
const LONGEST: u64 = 12_000;
/// The number of ticks in which printed texts reach the PC.
const TO_THE_END: u64 = 300;
/// The number of elements of `persist.UserData` that are compared.
const USER_DATA: usize = 100;
/// A number at the end of a program.
#[derive(Clone, Debug)]
pub(super) struct EndValue {
    pub(super) name: String,
    pub(super) value: f64,
    is_single: bool,
}

/// The observation of a scenario on a board.
#[derive(Clone, Debug, Default)]
pub(super) struct Observation {
    /// Console lines, or the answer to each line sent.
    pub(super) texts: Vec<String>,
    /// The columns of each sample.
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) end: Vec<EndValue>,
    /// The reason why the board, or the program in thread 1, did not reach its end.
    halted: Option<String>,
}

/// The first difference between two observations.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Difference {
    /// The quantity: a column, a final value, or a text.
    pub(super) what: String,
    /// The number of the sample, or of the text.
    pub(super) at: Option<usize>,
    pub(super) model: String,
    pub(super) firmware: String,
}

/// A board on which scenarios are played.
#[derive(Clone, Copy, Debug)]
pub(super) enum ScenarioBoard<'f> {
    Model,
    Firmware(&'f BootedFirmware),
}

impl ScenarioBoard<'_> {
    /// Plays a scenario on this board, from power-up.
    pub(super) fn play(self, scenario: &Scenario) -> Result<Observation, HostError> {
        let mut setup = Setup::default();
        setup.options.timing = Timing::VENDOR;
        if let Self::Firmware(firmware) = self {
            setup.options = firmware.options(setup.options);
        }
        for (thread, text) in scenario.programs() {
            let Some(thread) = ThreadId::new(i32::from(thread)) else { continue };
            let path = format!("thread{thread}.c");
            let text = format!("#include \"KMotionDef.h\"\n{text}");
            let mut program = UserProgram::compile_text(path.as_ref(), text.into(), thread, &setup.options)?;
            program.starts = thread.get() == 1;
            setup.programs.push(program);
        }
        Ok(match self {
            Self::Model => play_session(&mut setup.session()?, scenario),
            Self::Firmware(firmware) => play_session(&mut setup.session_on_firmware(firmware)?, scenario),
        })
    }
}

/// Plays a scenario on a board with loaded programs.
fn play_session<T: Target>(session: &mut Session<T>, scenario: &Scenario) -> Observation {
    let mut observation = Observation::default();
    if scenario.is_session() {
        session.tap_wire();
        for line in scenario.lines() {
            observation.texts.push(answer(session, line));
        }
        return observation;
    }
    let mut hear = |event: Event| match event.kind {
        EventKind::ConsoleLine(line) => observation.texts.push(String::from_utf8_lossy(&line).into_owned()),
        EventKind::Halted(text) => observation.halted = Some(text),
        EventKind::Trap(trap) => observation.halted = Some(trap.to_string()),
        _ => {}
    };
    let limit = Ticks::new(LONGEST);
    while session.user_data(0) != Some(1) && session.tick() < limit {
        session.step(limit, &mut hear);
    }
    session.advance(Ticks::new(session.tick().get() + TO_THE_END), &mut hear);
    if session.user_data(0) != Some(1) {
        let reason = observation.halted.take().unwrap_or_default();
        observation.halted = Some(format!("did not end {reason}").trim_end().to_owned());
        return observation;
    }
    observation.halted = None;
    observation.look_at(session, scenario);
    observation
}

/// Sends a line, or lets time pass; returns the answer.
fn answer<T: Target>(session: &mut Session<T>, line: &str) -> String {
    if let Some(seconds) = line.strip_prefix("(run ").and_then(|rest| rest.strip_suffix(')')) {
        let limit = session.tick_after(seconds.parse().unwrap_or_default());
        session.advance(limit, &mut |_| {});
    } else {
        session.exchange(line.as_bytes(), &mut |_| {});
    }
    String::from_utf8_lossy(&session.take_wire()).into_owned()
}

impl Observation {
    /// Records the values that a program has left in memory.
    fn look_at<T: Target>(&mut self, session: &Session<T>, scenario: &Scenario) {
        let data = (1..USER_DATA).filter_map(|index| Some((index, session.user_data(index)?)));
        self.end.extend(data.map(|(index, value)| EndValue {
            name: format!("persist.UserData[{index}]"),
            value: f64::from(value),
            is_single: false,
        }));
        if scenario.columns.is_empty() {
            return;
        }
        let begin = GuestAddr::new(session.peek_object(GATHER_BUFFER.address()));
        let at = |index: u32| begin.offset(4 * index);
        let columns = scenario.columns.len() as u32;
        let row = |sample: u32| {
            let first = SAMPLES + 2 * sample * columns;
            (0..columns).map(|column| session.peek_object(at(first + 2 * column))).collect()
        };
        self.rows = (0..scenario.samples() as u32).map(row).collect();
        for axis in session.target().axes().iter() {
            self.look_at_axis(session, axis, at(axis.index() as u32 * Chan::STRUCTURE.size / 4));
            let state: i32 = session.peek_object(at(STATES + axis.index() as u32));
            let name = format!("chan[{axis}].pcoeff-c");
            self.end.push(EndValue { name, value: f64::from(state), is_single: false });
        }
        for (index, name) in (0..).zip(PATH_VARIABLES) {
            let value = session.peek_object(at(PATH + 2 * index));
            self.end.push(EndValue { name: name.to_owned(), value, is_single: false });
        }
    }

    /// Records the numbers in a copy of an axis, without pointers and unused fields.
    fn look_at_axis<T: Target>(&mut self, session: &Session<T>, axis: AxisId, begin: GuestAddr) {
        for field in Chan::STRUCTURE.fields {
            let at = begin.offset(field.offset);
            let name = format!("chan[{axis}].{}", field.name);
            let value = match field.ty {
                CType::Float => f64::from(session.peek_object::<f32>(at)),
                CType::Double => session.peek_object(at),
                CType::Int => f64::from(session.peek_object::<i32>(at)),
                _ => continue,
            };
            self.end.push(EndValue { name, value, is_single: field.ty == CType::Float });
        }
        for filter in 0..3 {
            // The coefficients were stored by the program; words 5 and 6 hold the filter's state.
            for word in 5..7 {
                let at = begin.offset(Chan::IIR.element(filter).offset() + 4 * word);
                let value = f64::from(session.peek_object::<f32>(at));
                let name = format!("chan[{axis}].iir[{filter}][{word}]");
                self.end.push(EndValue { name, value, is_single: true });
            }
        }
    }

    /// The first difference from the firmware's observation.
    pub(super) fn difference(&self, firmware: &Self, scenario: &Scenario) -> Option<Difference> {
        if self.halted != firmware.halted {
            let shown = |halted: &Option<String>| halted.clone().unwrap_or_else(|| "ends".to_owned());
            let (model, firmware) = (shown(&self.halted), shown(&firmware.halted));
            return Some(Difference { what: "end of the run".to_owned(), at: None, model, firmware });
        }
        self.different_row(firmware, scenario)
            .or_else(|| self.different_text(firmware))
            .or_else(|| self.different_ends(firmware).next())
    }

    fn different_text(&self, firmware: &Self) -> Option<Difference> {
        let count = self.texts.len().max(firmware.texts.len());
        let at = (0..count).find(|&at| self.texts.get(at) != firmware.texts.get(at))?;
        let shown =
            |texts: &[String]| texts.get(at).map_or("(nothing)".to_owned(), |text| format!("{text:?}"));
        let (model, firmware) = (shown(&self.texts), shown(&firmware.texts));
        Some(Difference { what: "text".to_owned(), at: Some(at), model, firmware })
    }

    fn different_row(&self, firmware: &Self, scenario: &Scenario) -> Option<Difference> {
        for (at, (model, firmware)) in self.rows.iter().zip(&firmware.rows).enumerate() {
            for ((column, model), firmware) in scenario.columns.iter().zip(model).zip(firmware) {
                // Samples are doubles, whatever the types of their variables.
                if !is_equal(*model, *firmware, false) {
                    let (model, firmware) = (format!("{model:?}"), format!("{firmware:?}"));
                    return Some(Difference { what: column.clone(), at: Some(at), model, firmware });
                }
            }
        }
        None
    }

    /// The final values that differ.
    pub(super) fn different_ends(&self, firmware: &Self) -> impl Iterator<Item = Difference> {
        let pairs = self.end.iter().zip(&firmware.end);
        pairs.filter(|(one, two)| !is_equal(one.value, two.value, one.is_single)).map(|(one, two)| {
            let (model, firmware) = (format!("{:?}", one.value), format!("{:?}", two.value));
            Difference { what: format!("end {}", one.name), at: None, model, firmware }
        })
    }
}

/// Returns whether two numbers are equal: floats exactly, doubles approximately.
fn is_equal(one: f64, two: f64, is_single: bool) -> bool {
    let is_same = one.to_bits() == two.to_bits() || one == two || one.is_nan() && two.is_nan();
    is_same || !is_single && (one - two).abs() <= PRECISION * two.abs().max(1.0)
}
