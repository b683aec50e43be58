//! The position of an axis from its input. Source: axes-and-motion.md section 9.

use kmotiondef::AxisId;
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::ADC_BUFFER_IN;
use vm::memory::GuestMemory;

use crate::plant::Plant;
use crate::views::{AxisView, Typed};

/// Takes the position from the axis' input. An encoder that has counted is told: its channel and register.
pub(crate) fn measure(
    plants: &mut [Plant; N_CHANNELS],
    memory: &mut GuestMemory,
    axis: AxisId,
) -> Option<(usize, i8)> {
    match InputMode::new(AxisView::of(memory, axis).get(Chan::INPUT_MODE)) {
        Some(InputMode::Encoder) => return count(plants, memory, axis),
        Some(InputMode::Adc) => {
            let input = f64::from(converted(memory, memory.axis(axis, Chan::INPUT_CHAN0)));
            let mut chan = AxisView::of(memory, axis);
            let offset = f64::from(chan.get(Chan::INPUT_OFFSET0));
            let position = f64::from(chan.get(Chan::INPUT_GAIN0)) * input + offset;
            chan.set(Chan::POSITION, position);
            plants[axis.index()].note_position(position);
        }
        Some(InputMode::Resolver) => {
            let angle = resolver_angle(memory, axis);
            crate::firmware::motion::turn_resolver(memory, axis, angle);
        }
        Some(InputMode::None | InputMode::User) | None => {}
    }
    None
}

/// Adds what the encoder's register has counted since the last tick.
#[inline]
fn count(plants: &mut [Plant; N_CHANNELS], memory: &mut GuestMemory, axis: AxisId) -> Option<(usize, i8)> {
    let mut chan = AxisView::of(memory, axis);
    let gain = f64::from(chan.get(Chan::INPUT_GAIN0));
    let channel = chan.get(Chan::INPUT_CHAN0);
    let count = if channel != i32::from(axis.get()) && chan.get(Chan::OUTPUT_MODE) == OutputMode::None.get() {
        // An axis without a motor watches somebody else's encoder.
        let other = AxisId::new(channel)?;
        let gain = f64::from(memory.axis(other, Chan::INPUT_GAIN0));
        chan = AxisView::of(memory, axis);
        plants[other.index()].encoder(gain)
    } else {
        plants[axis.index()].encoder(gain)
    };
    let moved = count.wrapping_sub(chan.get(Chan::LAST_ENC));
    if moved == 0 {
        return None;
    }
    chan.set(Chan::LAST_ENC, count);
    let position = chan.get(Chan::POSITION) + gain * f64::from(moved);
    chan.set(Chan::POSITION, position);
    plants[axis.index()].note_position(position);
    Some((usize::try_from(channel).ok()?, count))
}

/// An analog input, −2048 to 2047; 0 for a channel that does not exist.
fn converted(memory: &GuestMemory, channel: i32) -> i32 {
    let channel = usize::try_from(channel).ok().filter(|&channel| channel < 8);
    channel.map_or(0, |channel| memory.get(ADC_BUFFER_IN.element(channel)) - 2048)
}

/// The angle of a resolver from its two analog inputs.
fn resolver_angle(memory: &GuestMemory, axis: AxisId) -> (f32, f32) {
    let input = |channel, gain: f32, offset| gain * converted(memory, channel) as f32 + offset;
    let x = input(
        memory.axis(axis, Chan::INPUT_CHAN0),
        memory.axis(axis, Chan::INPUT_GAIN0),
        memory.axis(axis, Chan::INPUT_OFFSET0),
    );
    let y = input(
        memory.axis(axis, Chan::INPUT_CHAN1),
        memory.axis(axis, Chan::INPUT_GAIN1),
        memory.axis(axis, Chan::INPUT_OFFSET1),
    );
    (x, y)
}
