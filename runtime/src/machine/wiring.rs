//! The wiring of the machine: the encoder input that each motor's encoder is on, and the output that drives it.
//!
//! A machine file may say both. What it leaves open is taken from the program: the load of an axis follows the axis,
//! whatever output it uses. The encoder of a load with a motor is on the input of its own number.

use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::variables::DAC_BUFFER;
use kmotiondef::{Axes, AxisId};
use vm::memory::GuestMemory;

use super::description::{Axis, Channel, Model};
use crate::views::Typed;
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
}

impl Wiring {
    /// Creates the wiring of a machine file.
    pub(crate) fn new(axes: &[Axis; Axes::MAX]) -> Self {
        let mut wiring = Self::default();
        for (index, axis) in axes.iter().enumerate() {
            let by_number = (axis.model == Model::Motor).then_some(index);
            wiring.inputs[index] = axis.connection.input.or(by_number);
            wiring.drives[index] = axis.connection.drive;
        }
        wiring
    }

    /// The input that the encoder of an axis is on, if it is known.
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

    /// The axis whose motor is on a step generator.
    pub(crate) fn motor_on(&self, generator: usize) -> Option<AxisId> {
        AxisId::all().find(|axis| self.drive(*axis) == Some(Channel::Generator(generator)))
    }

    /// The axis whose load turns the encoder that `axis` reads.
    pub(crate) fn turns(&self, memory: &GuestMemory, axis: AxisId) -> Option<AxisId> {
        let channel = memory.axis(axis, Chan::INPUT_CHAN0);
        let input = usize::try_from(channel).ok();
        // No board has an input of such a number.
        if input.is_none_or(|input| input >= ENCODERS) {
            return None;
        }
        if let Some(other) = AxisId::all().find(|other| input.is_some() && self.input(*other) == input) {
            return Some(other);
        }
        // The axis' own encoder is known to be elsewhere.
        if self.input(axis).is_some() {
            return None;
        }
        // An axis without a motor watches somebody else's encoder.
        let watches = channel != i32::from(axis.get())
            && memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::None.get();
        if watches { memory.axes().get(channel) } else { Some(axis) }
    }
}

/// The step generator that an output channel names: a Kogna has sixteen, of which the first eight have pins here.
pub(crate) fn generator(memory: &GuestMemory, channel: i32) -> usize {
    if memory.has_other_map() { (channel & 15) as usize } else { generator_of(channel) }
}

/// The output that an axis drives, if there is one of that number.
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
            assert_eq!(wiring.turns(&memory, axis(reader)), expect.map(axis), "axis {reader} on {input}");
        }
    }
}
