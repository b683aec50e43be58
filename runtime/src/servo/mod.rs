//! The servo interrupt: what the board does once a tick.
//!
//! Measured order of the released firmware (`firmware.md` section 4): trajectories of all axes, slaves, then axis by
//! axis position, backlash, limits, following error, compensation and output; then `prev_dest`, and the recorder last.
//! The call-back comes before all of this and is the machine's work.

mod backlash;
mod compensation;
pub(crate) mod coordinated;
mod duration;
pub(crate) mod independent;
mod limits;
mod output;
pub(crate) mod plant;
pub(crate) mod profile;
#[cfg(test)]
mod recorded;
#[cfg(test)]
mod recorded_servo;
mod recorder;
mod slave;
pub(crate) mod trajectory;

use kmotiondef::limits::N_CHANNELS;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::{ADC_BUFFER_IN, CHAN};
use kmotiondef::{AxisId, Cycles, GuestType};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use crate::kernel::Kernel;
use crate::servo::plant::Plant;
use crate::views::Typed;

pub(crate) use duration::duration;
pub(crate) use output::{four_phase, switch_off, three_phase};
pub(crate) use profile::TIMEBASE;

/// What the servo remembers of an axis beside its structure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisMemory {
    /// Destination at the end of the last tick.
    pub(crate) dest: f64,
    /// Its velocity in the last tick, for the feed forward.
    velocity: f64,
    /// The velocity in the tick before.
    last_velocity: f64,
    /// Whether a feedhold interrupted a motion of the axis.
    pub(crate) is_held: bool,
}

impl AxisMemory {
    /// Stands at `dest`, so that no velocity is seen.
    pub(crate) fn rest(dest: f64) -> Self {
        Self { dest, ..Self::default() }
    }
}

/// What the servo remembers beside guest memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Servo {
    pub(crate) axes: [AxisMemory; N_CHANNELS],
    pub(crate) plants: [Plant; N_CHANNELS],
    pub(crate) coordinated: coordinated::Coordinated,
}

impl Servo {
    /// Whether a path or an axis on its own moves or something is being recorded.
    pub(crate) fn is_busy(memory: &GuestMemory) -> bool {
        recorder::is_recording(memory)
            || coordinated::path::is_under_way(memory)
            || AxisId::all().any(|axis| independent::is_moving(memory, axis))
    }
}

/// One tick of the servo; whether anything changed.
pub(crate) fn tick(kernel: &mut Kernel, context: &mut TickContext<'_>) -> bool {
    let before = (snapshot(context.memory), kernel.servo.clone());
    for axis in AxisId::all() {
        plant::advance(&mut kernel.servo.plants[axis.index()], context.memory, axis);
    }
    for axis in AxisId::all() {
        if context.memory.axis(axis, Chan::ENABLE) != 0 {
            independent::advance(context.memory, axis);
        }
    }
    let path_moves = coordinated::board::tick(kernel, context.memory);
    slave::follow(&kernel.servo, context.memory);
    for axis in AxisId::all() {
        run_axis(kernel, context.memory, axis, context.now);
    }
    let recorded = recorder::sample(context.memory);
    recorded || path_moves || before.0 != snapshot(context.memory) || before.1 != kernel.servo
}

/// The bytes of all axis structures.
fn snapshot(memory: &GuestMemory) -> Vec<u8> {
    let size = Chan::SIZE * N_CHANNELS as u32;
    memory.read_bytes(CHAN.address(), size).map(<[u8]>::to_vec).unwrap_or_default()
}

/// Position, protection, compensation and output of one axis.
fn run_axis(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, now: Cycles) {
    measure(kernel, memory, axis);
    direction(&mut kernel.servo.axes[axis.index()], memory, axis);
    if memory.axis(axis, Chan::ENABLE) == 0 {
        return;
    }
    backlash::advance(memory, axis);
    let command = command(memory, axis);
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    limits::check(kernel, memory, axis, now);
    let is_open_loop = matches!(mode, None | Some(OutputMode::Microstep | OutputMode::StepDir));
    if !is_open_loop {
        limits::check_following_error(kernel, memory, axis, command);
    }
    if memory.axis(axis, Chan::ENABLE) == 0 {
        return;
    }
    let output = if is_open_loop {
        memory.set_axis(axis, Chan::OUTPUT, 0.0);
        0.0
    } else {
        compensation::advance(&kernel.servo.axes[axis.index()], memory, axis, command)
    };
    output::drive(kernel, memory, axis, command, output);
    let dest = memory.axis(axis, Chan::DEST);
    memory.set_axis(axis, Chan::PREV_DEST, dest);
}

/// What the servo is to follow.
pub(crate) fn command(memory: &GuestMemory, axis: AxisId) -> f64 {
    memory.axis(axis, Chan::DEST)
        + f64::from(memory.axis(axis, Chan::BACKLASH))
        + memory.axis(axis, Chan::DEST_OFFSET)
}

/// Takes the position from the axis' input.
fn measure(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) {
    let gain = f64::from(memory.axis(axis, Chan::INPUT_GAIN0));
    let position = match InputMode::new(memory.axis(axis, Chan::INPUT_MODE)) {
        Some(InputMode::Encoder) => {
            let count = kernel.servo.plants[axis.index()].encoder(gain);
            let moved = count.wrapping_sub(memory.axis(axis, Chan::LAST_ENC));
            memory.set_axis(axis, Chan::LAST_ENC, count);
            memory.axis(axis, Chan::POSITION) + gain * f64::from(moved)
        }
        Some(InputMode::Adc) => {
            let channel = memory.axis(axis, Chan::INPUT_CHAN0);
            let offset = f64::from(memory.axis(axis, Chan::INPUT_OFFSET0));
            gain * f64::from(converted(memory, channel)) + offset
        }
        Some(InputMode::Resolver) => {
            let angle = resolver_angle(memory, axis);
            return crate::firmware::motion::turn_resolver(memory, axis, angle);
        }
        Some(InputMode::None | InputMode::User) | None => return,
    };
    memory.set_axis(axis, Chan::POSITION, position);
    kernel.servo.plants[axis.index()].note_position(position);
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

/// Velocity and direction of the destination in this tick.
fn direction(axis_memory: &mut AxisMemory, memory: &mut GuestMemory, axis: AxisId) {
    let dest = memory.axis(axis, Chan::DEST);
    let last = axis_memory.dest;
    memory.set_axis(axis, Chan::LAST_DEST, last);
    axis_memory.last_velocity = axis_memory.velocity;
    axis_memory.velocity = (dest - last) / TIMEBASE;
    axis_memory.dest = dest;
    memory.set_axis(axis, Chan::LAST_VEL, axis_memory.velocity as f32);
    let sign = i32::from(dest > last) - i32::from(dest < last);
    // The first tick of a direction counts as standing still.
    let goes_on = sign != 0 && memory.axis(axis, Chan::LAST_NON_ZERO_DIR) == sign;
    memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, if goes_on { sign } else { 0 });
    if sign != 0 {
        memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, sign);
    }
}
