//! Encoders that are turned from outside: hand wheels, and shafts turned by hand.
//!
//! Counts are counts of the input, whatever the gain of the axis that reads it. A load on the same shaft turns with the
//! encoder.

use kmotiondef::modes::InputMode;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Cycles};
use vm::memory::GuestMemory;

use super::Machine;
use super::wiring::{ENCODERS, reads};
use crate::out::{Message, Out};
use crate::views::TypedAccess;

impl Machine {
    /// Turns the encoder on an input by counts.
    pub(crate) fn turn_encoder(
        &mut self,
        memory: &GuestMemory,
        out: &mut Out,
        input: usize,
        counts: f64,
        now: Cycles,
    ) {
        let input = self.turned_input(memory, input);
        let shaft = self.wiring.coupled_axis(memory, input);
        let unit = shaft.and_then(|axis| {
            let gain = f64::from(memory.axis(axis, Chan::INPUT_GAIN0));
            Some((axis, self.loads[axis].unit(gain)?))
        });
        match unit {
            Some((axis, unit)) => {
                self.loads.push(axis, counts * unit);
                let is_twice = self.loads[axis].is_driven() && !reads(memory, axis, input);
                if is_twice && self.wiring.describes_encoder(axis) {
                    out.remark(now, Message::EncoderTurnedTwice { input, axis });
                }
            }
            None => self.loads.turn(input, counts),
        }
    }

    /// The input meant by `encoder N`: the input of that number or, if nothing reads it, the input of the axis of that
    /// number.
    fn turned_input(&self, memory: &GuestMemory, number: usize) -> usize {
        let is_read = memory.axes().iter().any(|axis| reads(memory, axis, number));
        let axis = memory.axes().get(number as i32).filter(|_| !is_read);
        let of_axis = axis.and_then(|axis| {
            let read = (0..ENCODERS).find(|input| reads(memory, axis, *input));
            read.or_else(|| self.wiring.input(axis))
        });
        of_axis.unwrap_or(number)
    }

    /// Makes a remark on an encoder that has been turned but is not read.
    pub(crate) fn check_read(&self, memory: &GuestMemory, out: &mut Out, input: usize, now: Cycles) {
        let input = self.turned_input(memory, input);
        // Switches, sources and devices depend on the load that turns with it.
        let is_seen = |axis: AxisId| {
            let mode = memory.axis(axis, Chan::INPUT_MODE);
            self.has_mechanics() && self.mechanics.depends_on(axis)
                || ![InputMode::Encoder.get(), InputMode::None.get()].contains(&mode)
        };
        let is_read = memory.axes().iter().any(|axis| reads(memory, axis, input));
        if !is_read && !self.wiring.coupled_axis(memory, input).is_some_and(is_seen) {
            out.remark(now, Message::EncoderUnread { input });
        }
    }
}
