//! The position of an axis from its input. Source: axes-and-motion.md section 9.

use std::f32::consts::{PI, TAU};

use kmotiondef::AxisId;
use kmotiondef::structs::Chan;
use kmotiondef::variables::RESOLVER_FACTOR;
use vm::memory::GuestMemory;

use super::plan::{Encoder, Input};
use crate::io::kanalog::conversion;
use crate::machine::Loads;
use crate::views::{AxisView, TypedAccess};

/// Takes the position from an input that is not an encoder.
pub(crate) fn measure(input: Input, loads: &mut Loads, memory: &mut GuestMemory, axis: AxisId) {
    match input {
        Input::None | Input::Encoder(_) => {}
        Input::Adc => convert(loads, memory, axis),
        Input::Resolver => {
            let angle = resolver_angle(memory, axis);
            turn_resolver(memory, axis, angle);
        }
    }
}

/// The register of an encoder: the counts of the load that turns it, plus those made by hand.
#[inline(always)]
pub(crate) fn register(encoder: &Encoder, loads: &mut Loads) -> i8 {
    let by_load = match encoder.turned_by {
        Some(axis) if encoder.is_held => loads[axis].hold_encoder(),
        Some(axis) => loads[axis].encoder(encoder.turned_gain),
        None => 0,
    };
    by_load.wrapping_add(loads.by_hand(encoder.channel))
}

/// Adds the counts of the encoder's register since the last tick. Returns the channel and the register if it has
/// counted.
#[inline(always)]
pub(crate) fn count(
    input: &Input,
    loads: &mut Loads,
    chan: &mut AxisView<'_>,
    axis: AxisId,
) -> Option<(usize, i8)> {
    let Input::Encoder(encoder) = input else { return None };
    let count = register(encoder, loads);
    let moved = count.wrapping_sub(chan.get(Chan::LAST_ENC));
    if moved == 0 {
        return None;
    }
    chan.set(Chan::LAST_ENC, count);
    let position = chan.get(Chan::POSITION) + encoder.gain * f64::from(moved);
    chan.set(Chan::POSITION, position);
    loads[axis].note_position(position);
    Some((encoder.channel? as usize, count))
}

/// Takes the position from an analog input.
fn convert(loads: &mut Loads, memory: &mut GuestMemory, axis: AxisId) {
    let input = f64::from(converted(memory, memory.axis(axis, Chan::INPUT_CHAN0)));
    let mut chan = AxisView::of(memory, axis);
    let offset = f64::from(chan.get(Chan::INPUT_OFFSET0));
    let position = f64::from(chan.get(Chan::INPUT_GAIN0)) * input + offset;
    chan.set(Chan::POSITION, position);
    loads[axis].note_position(position);
}

/// An analog input, −2048 to 2047; 0 for a channel that does not exist.
fn converted(memory: &GuestMemory, channel: i32) -> i32 {
    let channel = usize::try_from(channel).ok().filter(|&channel| channel < 8);
    channel.map_or(0, |channel| conversion(memory, channel) - 2048)
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

/// Adds the rotation of a resolver since the last reading to the position.
pub(crate) fn turn_resolver(memory: &mut GuestMemory, axis: AxisId, (x, y): (f32, f32)) {
    let angle = libm::atan2f(y, x) + memory.axis(axis, Chan::THETA_CORRECTION);
    let mut turned = angle - memory.axis(axis, Chan::LAST_THETA);
    if turned > PI {
        turned -= TAU;
    } else if turned <= -PI {
        turned += TAU;
    }
    memory.set_axis(axis, Chan::LAST_THETA, angle);
    let position = memory.axis(axis, Chan::POSITION) + memory.get(RESOLVER_FACTOR) * f64::from(turned);
    memory.set_axis(axis, Chan::POSITION, position);
}
