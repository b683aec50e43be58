//! The wiring of the machine: the input of each motor's encoder, and the output that drives the motor.
//!
//! A machine file may define both. Otherwise they follow from the program: the load of an axis follows the axis,
//! whatever output it uses. The encoder of a load with a motor is on the input with the number of the axis.

use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::DAC_BUFFER;
use kmotiondef::{Axes, AxisId};
use vm::memory::GuestMemory;

use super::description::{Axis, Channel, Encoder, Model};
use crate::views::TypedAccess;
use chips::stepgen::generator_of;

/// Encoder inputs of a board and its SnapAmps.
pub(crate) const ENCODERS: usize = 16;
/// Analog outputs, and PWM channels.
pub(crate) const DACS: usize = 8;
pub(crate) const PWMS: usize = 16;

/// The connections of encoders and motors.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Wiring {
    /// The input of each axis' encoder, if it is known.
    inputs: [Option<usize>; Axes::MAX],
    /// The output that drives each motor, if the machine file names it.
    drives: [Option<Channel>; Axes::MAX],
    /// Axes whose encoder the machine file describes, and axes that it describes without an encoder.
    has_encoder: [bool; Axes::MAX],
    has_none: [bool; Axes::MAX],
    /// Inputs with an encoder that a stimulus or the machine file turns.
    by_hand: [bool; ENCODERS],
}

impl Wiring {
    /// Creates the wiring of a machine file.
    pub(crate) fn new(axes: &[Axis; Axes::MAX]) -> Self {
        let mut wiring = Self::default();
        for (index, axis) in axes.iter().enumerate() {
            let by_number = (axis.model == Model::Motor).then_some(index);
            wiring.inputs[index] = axis.connection.input.or(by_number);
            wiring.drives[index] = axis.connection.drive;
            wiring.has_none[index] = axis.connection.encoder == Encoder::Absent;
            wiring.has_encoder[index] = !wiring.has_none[index]
                && (wiring.inputs[index].is_some() || axis.connection.encoder == Encoder::Connected);
        }
        wiring
    }

    /// The input of the encoder of an axis, if it is known.
    pub(crate) fn input(&self, axis: AxisId) -> Option<usize> {
        self.inputs[axis.index()]
    }

    /// The output that drives the motor of an axis, if the machine file names it.
    #[inline(always)]
    pub(crate) fn drive(&self, axis: AxisId) -> Option<Channel> {
        self.drives[axis.index()]
    }

    /// Returns whether the machine file connects any motor to an output.
    pub(crate) fn has_drives(&self) -> bool {
        self.drives.iter().any(Option::is_some)
    }

    /// The axis with its motor on a step generator.
    pub(crate) fn motor_on(&self, generator: usize) -> Option<AxisId> {
        AxisId::all().find(|axis| self.drive(*axis) == Some(Channel::Generator(generator)))
    }

    /// The axis whose load turns the encoder read by `axis`.
    pub(crate) fn driving_axis(&self, memory: &GuestMemory, axis: AxisId) -> Option<AxisId> {
        let channel = memory.axis(axis, Chan::INPUT_CHAN0);
        let input = usize::try_from(channel).ok();
        // No board has an input of such a number.
        if input.is_none_or(|input| input >= ENCODERS) {
            return None;
        }
        if let Some(other) = AxisId::all().find(|other| input.is_some() && self.input(*other) == input) {
            return Some(other);
        }
        // The axis' own encoder is known to be on another input.
        if self.input(axis).is_some() {
            return None;
        }
        // An axis without a motor reads the encoder of another axis.
        let watches = channel != i32::from(axis.get())
            && memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::None.get();
        if watches {
            memory.axes().get(channel).filter(|other| self.input(*other).is_none())
        } else {
            Some(axis)
        }
    }

    /// Notes that the encoder on this input is turned by hand.
    pub(crate) fn turn_by_hand(&mut self, input: usize) {
        self.by_hand[input] = true;
    }

    /// Returns whether the encoder on the input that an axis reads is turned by hand.
    pub(crate) fn reads_hand(&self, memory: &GuestMemory, axis: AxisId) -> bool {
        let input = usize::try_from(memory.axis(axis, Chan::INPUT_CHAN0)).ok();
        input.is_some_and(|input| self.by_hand.get(input) == Some(&true))
    }

    /// Returns whether the encoder that an axis reads is turned only by hand, not by a load.
    pub(crate) fn is_hand_alone(&self, memory: &GuestMemory, axis: AxisId) -> bool {
        self.reads_hand(memory, axis)
            && self.coupled_axis(memory, memory.axis(axis, Chan::INPUT_CHAN0) as usize).is_none()
    }

    /// Returns whether the machine file describes the encoder of an axis.
    pub(crate) fn describes_encoder(&self, axis: AxisId) -> bool {
        self.has_encoder[axis.index()]
    }

    /// The axis whose load turns along when the encoder on an input is turned from outside.
    ///
    /// It is the axis that the machine file connects there, or an axis with its own encoder there. A load without a
    /// description, whose axis has no encoder, leaves its input to a hand wheel.
    pub(crate) fn coupled_axis(&self, memory: &GuestMemory, input: usize) -> Option<AxisId> {
        let axes = || memory.axes().iter();
        if let Some(axis) = axes().find(|axis| self.input(*axis) == Some(input)) {
            return Some(axis).filter(|axis| !self.has_none[axis.index()]);
        }
        let has_motor = |axis: AxisId| memory.axis(axis, Chan::OUTPUT_MODE) != OutputMode::None.get();
        let own = memory.axes().get(input as i32);
        let other = axes().find(|axis| Some(*axis) != own && has_motor(*axis) && reads(memory, *axis, input));
        let axis =
            other.or(own).filter(|axis| self.input(*axis).is_none() && !self.has_none[axis.index()])?;
        if other.is_some() || self.has_encoder[axis.index()] || !has_motor(axis) {
            return Some(axis);
        }
        let is_loop = !OutputMode::is_open_loop(OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)));
        let is_others = || axes().any(|other| other != axis && reads(memory, other, input));
        (reads(memory, axis, input) && (is_loop || !is_others())).then_some(axis)
    }
}

/// Returns whether an axis reads the encoder on an input.
pub(crate) fn reads(memory: &GuestMemory, axis: AxisId, input: usize) -> bool {
    memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get()
        && usize::try_from(memory.axis(axis, Chan::INPUT_CHAN0)) == Ok(input)
}

/// The step generator meant by an output channel: a Kogna has sixteen, of which only the first eight have pins here.
pub(crate) fn generator(memory: &GuestMemory, channel: i32) -> usize {
    if memory.has_other_map() { (channel & 15) as usize } else { generator_of(channel) }
}

/// The output driven by an axis, if its number is valid.
pub(crate) fn channel_of(memory: &GuestMemory, axis: AxisId) -> Option<Channel> {
    let number = memory.axis(axis, Chan::OUTPUT_CHAN0);
    let index = usize::try_from(number).ok();
    match OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE))? {
        OutputMode::None => None,
        OutputMode::StepDir | OutputMode::ClosedLoopStepDir => {
            Some(Channel::Generator(generator(memory, number)))
        }
        OutputMode::DacServo => index.filter(|dac| *dac < DACS).map(Channel::Dac),
        OutputMode::Microstep
        | OutputMode::ClosedLoopMicrostep
        | OutputMode::DcServo
        | OutputMode::Brushless3Ph
        | OutputMode::Brushless4Ph => index.filter(|pwm| *pwm < PWMS).map(Channel::Pwm),
    }
}

/// The value of an analog output, −2048 to 2047.
pub(crate) fn dac_value(memory: &GuestMemory, dac: usize) -> i32 {
    // The buffer holds the value in offset binary, from the other side.
    let value = (i32::from(memory.get(DAC_BUFFER.element(dac))) + 2048) & 0xfff;
    if value >= 2048 { value - 4096 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(number: i32) -> AxisId {
        AxisId::new(number).expect("an axis")
    }

    #[test]
    fn an_encoder_is_where_the_machine_file_says() {
        let mut axes: [Axis; Axes::MAX] = std::array::from_fn(|_| Axis::default());
        axes[0].connection.input = Some(3);
        axes[1].model = Model::Motor;
        let wiring = Wiring::new(&axes);
        let mut memory = GuestMemory::default();
        memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::DacServo.get());
        memory.set_axis(axis(1), Chan::OUTPUT_MODE, OutputMode::DacServo.get());
        memory.set_axis(axis(2), Chan::OUTPUT_MODE, OutputMode::DacServo.get());
        for (reader, input, expect) in
            [(0, 3, Some(0)), (0, 0, None), (1, 1, Some(1)), (1, 4, None), (2, 5, Some(2))]
        {
            memory.set_axis(axis(reader), Chan::INPUT_CHAN0, input);
            assert_eq!(
                wiring.driving_axis(&memory, axis(reader)),
                expect.map(axis),
                "axis {reader} on {input}"
            );
        }
    }
}
