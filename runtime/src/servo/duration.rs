//! The duration of the servo interrupt, which determines the part of a tick left for the threads.
//!
//! Measured on the released firmware: a constant, and for each enabled axis the time of its output and input modes
//! (`servo_cycles` of the recorded thread measurements; means at rest, by output mode, for an axis without input;
//! reading an encoder takes additional time).

use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::{Cycles, GuestType};
use vm::memory::GuestMemory;

use crate::views::{TypedAccess, chan, field_of};

/// Without an enabled axis.
const IDLE: i64 = 2006;
/// For reading its encoder.
const ENCODER: i64 = 44;

/// Returns the time that the servo interrupt takes of a tick.
pub(crate) fn duration(memory: &GuestMemory) -> Cycles {
    const SIZE: usize = Chan::SIZE as usize;
    let chans = memory.axes().iter().filter_map(|axis| memory.block::<SIZE>(memory.locate(chan(axis))));
    let enabled = chans.filter(|chan| field_of(chan, Chan::ENABLE) != 0);
    let axes = enabled.map(|chan| {
        // As measured: a number below the valid modes costs as much as the first mode, a number above them nothing.
        let mode = OutputMode::new(field_of(chan, Chan::OUTPUT_MODE).max(0));
        let output = mode.map_or(0, |mode| mode.traits().cycles);
        let reads_encoder = InputMode::new(field_of(chan, Chan::INPUT_MODE)) == Some(InputMode::Encoder);
        output + if reads_encoder { ENCODER } else { 0 }
    });
    Cycles::new(IDLE + axes.sum::<i64>())
}

#[cfg(test)]
mod tests {
    use kmotiondef::Axes;

    use super::*;
    use crate::testing::powered_memory;
    use crate::views::TypedAccess;

    #[test]
    fn enabled_axes_cost_what_was_measured() {
        let mut memory = powered_memory();
        assert_eq!(duration(&memory).get(), 2006);
        for axis in Axes::default().iter() {
            memory.set_axis(axis, Chan::ENABLE, 1);
            memory.set_axis(axis, Chan::OUTPUT_MODE, 2);
        }
        // Eight DC servo axes with encoders: 4750 cycles measured.
        assert_eq!(duration(&memory).get(), 4750);
    }
}
