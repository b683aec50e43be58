//! The duration of the servo interrupt on the board: settings, motion, recording and the waits for memory.
//!
//! Measured on the released firmware (costs.md section 5): within 1 % up to eight axes. The other timing only depends
//! on the settings ([`super::duration`]).

use kmotiondef::limits::MAX_GATHER_VALUES;
use kmotiondef::modes::{GatherType, InputMode, OutputMode};
use kmotiondef::structs::{Chan, Gather, GatherValueDef};
use kmotiondef::timing::WaitStates;
use kmotiondef::variables::{COORD_SYSTEM0, GATHER, USER_CALL_BACK};
use kmotiondef::{Axes, Cycles};
use vm::memory::GuestMemory;

use super::coordinated::system;
use super::independent::{has_motion, state};
use super::profile::Mode;
use super::recorder::is_recording;
use crate::views::TypedAccess;

/// The duration without an enabled axis, including its memory accesses: eight encoders and two registers.
const IDLE: i64 = 2006;
const IDLE_ACCESSES: i64 = 10;
/// The cost of calling the call-back; the call-back's own time is counted separately.
const CALL_BACK: i64 = 6;
/// For recording, and for each double of a sample.
const RECORDING: i64 = 13;
const RECORDED_DOUBLE: i64 = 47;
/// For each axis of a path that is executed, and the words of SDRAM that it reads.
const ON_PATH: i64 = 116;
const PATH_WORDS: i64 = 11;
/// Words of SDRAM that a moving axis reads.
const MOTION_WORDS: i64 = 11;
/// The additional time of a motion that approaches its target by a time constant.
const EXPONENTIAL: i64 = 91;

/// The time added by an enabled axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct AxisTime {
    cycles: i64,
    accesses: i64,
    /// The time that it adds while it moves.
    moving: i64,
}

fn output_time(mode: Option<OutputMode>, is_upper: bool) -> AxisTime {
    let upper = if is_upper { 12 } else { 0 };
    let (cycles, accesses, moving) = match mode {
        None => (0, 0, 65),
        Some(OutputMode::None) => (290, 0, 65),
        Some(OutputMode::Microstep) => (274 + upper, 4, 86),
        Some(OutputMode::DcServo) => (299, 2, 65),
        Some(OutputMode::Brushless3Ph) => (429, 4, 65),
        Some(OutputMode::Brushless4Ph) => (459 + upper, 4, 65),
        Some(OutputMode::DacServo) => (323, 0, 86),
        Some(OutputMode::StepDir) => (225, 7, 65),
        Some(OutputMode::ClosedLoopStepDir) => (429, 7, 65),
        Some(OutputMode::ClosedLoopMicrostep) => (481 + upper, 4, 86),
    };
    AxisTime { cycles, accesses, moving }
}

fn input_cycles(mode: Option<InputMode>) -> i64 {
    match mode {
        Some(InputMode::Encoder) => 44,
        Some(InputMode::Adc) => 17,
        Some(InputMode::Resolver) => 191,
        Some(InputMode::None | InputMode::User) | None => 0,
    }
}

/// The duration that follows from the settings of the axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Interrupt {
    cycles: i64,
    accesses: i64,
    /// The time added by motion, for each axis; 0 for a disabled one.
    moving: [i64; Axes::MAX],
}

impl Interrupt {
    /// The duration by the present settings.
    pub(super) fn of(memory: &GuestMemory) -> Self {
        let mut interrupt = Self { cycles: IDLE, accesses: IDLE_ACCESSES, ..Self::default() };
        for axis in memory.axes().iter().filter(|axis| memory.axis(*axis, Chan::ENABLE) != 0) {
            // As measured: a number below the valid modes costs as much as the first mode, a number above them nothing.
            let output = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE).max(0));
            let input = InputMode::new(memory.axis(axis, Chan::INPUT_MODE));
            let time = output_time(output, axis.index() >= 4);
            interrupt.cycles += time.cycles + input_cycles(input);
            interrupt.accesses += time.accesses - i64::from(input != Some(InputMode::Encoder));
            interrupt.moving[axis.index()] = time.moving;
        }
        interrupt
    }

    /// Returns the time that the interrupt takes of a tick, with the motions in progress.
    pub(super) fn time(&self, memory: &GuestMemory, waits: WaitStates, is_settled: bool) -> Cycles {
        let (mut cycles, mut words) = (self.cycles, 0);
        if !is_settled {
            let going = memory
                .axes()
                .iter()
                .filter(|axis| self.moving[axis.index()] != 0 && has_motion(memory, *axis));
            for axis in going {
                let is_exponential = state(memory, axis, 0).mode == Mode::Exponential;
                cycles += self.moving[axis.index()] + if is_exponential { EXPONENTIAL } else { 0 };
                words += MOTION_WORDS;
            }
            if !memory.get(COORD_SYSTEM0).is_null() {
                let members = system::members(memory).count() as i64;
                cycles += members * ON_PATH;
                words += members * PATH_WORDS;
            }
            if is_recording(memory) {
                let doubles = recorded_doubles(memory);
                cycles += RECORDING + RECORDED_DOUBLE * doubles;
                words += 2 * doubles;
            }
        }
        if !memory.get(USER_CALL_BACK).is_null() {
            cycles += CALL_BACK;
        }
        Cycles::new(cycles + self.accesses * i64::from(waits.register) + words * i64::from(waits.sdram))
    }
}

/// Doubles of a sample.
fn recorded_doubles(memory: &GuestMemory) -> i64 {
    let kind = |index| memory.get(GATHER.field(Gather::LIST.element(index)).field(GatherValueDef::TYPE));
    let is_end = |index: &usize| GatherType::new(kind(*index)).is_none_or(|kind| kind == GatherType::End);
    (0..MAX_GATHER_VALUES).take_while(|index| !is_end(index)).count() as i64
}

#[cfg(test)]
mod tests {
    use serde_json::Value as Json;

    use super::*;
    use crate::testing::powered_memory;
    use crate::text::vectors::rows;

    /// The mode with this name in the vectors.
    fn input(name: &str) -> i32 {
        match name {
            "ENCODER" => 1,
            "ADC" => 2,
            "RESOLVER" => 3,
            "USER_INPUT" => 4,
            _ => 0,
        }
    }

    fn output(name: &str) -> Option<OutputMode> {
        Some(match name {
            "NO_OUTPUT" => OutputMode::None,
            "MICROSTEP" => OutputMode::Microstep,
            "DC_SERVO" => OutputMode::DcServo,
            "BRUSHLESS_3PH" => OutputMode::Brushless3Ph,
            "BRUSHLESS_4PH" => OutputMode::Brushless4Ph,
            "DAC_SERVO" => OutputMode::DacServo,
            "STEP_DIR" => OutputMode::StepDir,
            "CL_STEP_DIR" => OutputMode::ClosedLoopStepDir,
            "CL_MICROSTEP" => OutputMode::ClosedLoopMicrostep,
            _ => return None,
        })
    }

    /// Cycles of a row in a setting.
    fn recorded(row: &Json, what: &str, setting: usize) -> f64 {
        row[what][setting][0].as_f64().expect("it was measured")
    }

    #[test]
    fn enabled_axes_take_what_was_measured() {
        let mut compared = 0;
        for row in rows("costs.jsonl").iter().filter(|row| row["what"] == "axes enabled") {
            let mut memory = powered_memory();
            let Some(mode) = output(row["output"].as_str().expect("a name")) else { continue };
            let count = row["n"].as_u64().expect("a number") as usize;
            for axis in memory.axes().iter().take(count) {
                memory.set_axis(axis, Chan::ENABLE, 1);
                memory.set_axis(axis, Chan::OUTPUT_MODE, mode.get());
                memory.set_axis(axis, Chan::INPUT_MODE, input(row["input"].as_str().expect("a name")));
            }
            let settings = [WaitStates::NONE, WaitStates::REGISTERS, WaitStates { register: 44, sdram: 20 }];
            for (setting, waits) in settings.into_iter().enumerate() {
                let still = Interrupt::of(&memory).time(&memory, waits, false).get() as f64;
                let found = recorded(row, "mean_max_still", setting);
                assert!((still / found - 1.0).abs() < 0.01, "{row}: {still}");
            }
            for axis in memory.axes().iter().take(count) {
                let first = memory.axis(axis, Chan::C);
                memory.set_axis(axis, Chan::PCOEFF, first);
            }
            for (setting, waits) in settings.into_iter().enumerate() {
                let moving = Interrupt::of(&memory).time(&memory, waits, false).get() as f64;
                let found = recorded(row, "mean_max_moving", setting);
                assert!((moving / found - 1.0).abs() < 0.015, "{row}: {moving}");
            }
            compared += 1;
        }
        assert!(compared > 40, "{compared}");
    }
}
