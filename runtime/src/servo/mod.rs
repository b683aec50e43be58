//! The servo interrupt: what the board does once a tick.
//!
//! Measured order of the released firmware (`firmware.md` section 4): trajectories of all axes, slaves, then axis by
//! axis position, backlash, limits, following error, compensation and output; then `prev_dest`, and the recorder last.
//! The call-back comes before all of this and is the machine's work.

mod backlash;
#[cfg(test)]
mod closed_form;
mod compensation;
pub(crate) mod coordinated;
mod dsp;
mod duration;
#[cfg(test)]
mod equations;
#[cfg(test)]
mod hostile;
pub(crate) mod independent;
mod input;
pub(crate) mod limits;
mod output;
pub(crate) mod profile;
#[cfg(test)]
mod recorded;
#[cfg(test)]
mod recorded_servo;
mod recorder;
mod slave;
pub(crate) mod spindle;
mod still;
pub(crate) mod trajectory;

use kmotiondef::limits::N_CHANNELS;
use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Cycles};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use crate::kernel::Kernel;
use crate::plant::{self, Plant};
use crate::servo::still::Stillness;
use crate::views::AxisView;

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
#[derive(Clone, Debug, Default)]
pub(crate) struct Servo {
    pub(crate) axes: [AxisMemory; N_CHANNELS],
    pub(crate) plants: [Plant; N_CHANNELS],
    pub(crate) coordinated: coordinated::Coordinated,
    pub(crate) still: Stillness,
    pub(crate) stop_request: limits::StopRequest,
}

impl Servo {
    /// Something outside moves the load of an axis.
    pub(crate) fn push(&mut self, axis: AxisId, units: f64) {
        self.plants[axis.index()].push(units);
        self.still.interrupt();
    }

    /// Whether a path or an axis on its own moves or something is being recorded.
    pub(crate) fn is_busy(memory: &GuestMemory) -> bool {
        recorder::is_recording(memory)
            || coordinated::path::is_under_way(memory)
            || AxisId::all().any(|axis| independent::is_moving(memory, axis))
    }
}

/// One tick of the servo; whether anything changed, so that the next tick may change something too.
pub(crate) fn tick(kernel: &mut Kernel, context: &mut TickContext<'_>) -> bool {
    let memory = &mut *context.memory;
    let is_driven = plant::drive(kernel, memory, context.now);
    let turned = spindle::measure(memory);
    let has_path = !kernel.servo.coordinated.is_idle(memory);
    let moved = if has_path || !kernel.servo.still.lasts(memory) {
        run_axes(kernel, memory, context.now)
    } else {
        plant::signal(kernel, context.now);
        false
    };
    is_driven | turned | moved | recorder::sample(memory)
}

/// One tick of all axes; whether anything changed.
fn run_axes(kernel: &mut Kernel, memory: &mut GuestMemory, now: Cycles) -> bool {
    kernel.servo.still.begin(memory);
    let mut changed = false;
    let mut has_slaves = false;
    for axis in AxisId::all() {
        let chan = AxisView::of(memory, axis);
        changed |= kernel.servo.plants[axis.index()].advance(&chan);
        if chan.get(Chan::ENABLE) != 0 {
            has_slaves |= chan.get(Chan::MASTER_AXIS) >= 0;
            if !chan.get(Chan::PCOEFF).is_null() {
                changed = true;
                independent::advance(memory, axis);
            }
        }
    }
    plant::signal(kernel, now);
    changed |= coordinated::board::tick(kernel, memory);
    if has_slaves {
        slave::follow(&kernel.servo, memory);
    }
    for axis in AxisId::all() {
        changed |= run_axis(kernel, memory, axis);
    }
    if changed {
        kernel.servo.still.interrupt();
        return true;
    }
    !kernel.servo.still.end(memory)
}

/// Position, protection, compensation and output of one axis; whether it moves or is told something.
fn run_axis(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) -> bool {
    input::measure(&mut kernel.servo.plants, memory, axis);
    let (own, plant) = (&mut kernel.servo.axes[axis.index()], &mut kernel.servo.plants[axis.index()]);
    let mut chan = AxisView::of(memory, axis);
    let moves = direction(own, &mut chan);
    if chan.get(Chan::ENABLE) == 0 {
        plant.release();
        return moves;
    }
    backlash::advance(&mut chan);
    let command = command(&chan);
    let mode = OutputMode::new(chan.get(Chan::OUTPUT_MODE));
    let is_open_loop = matches!(mode, None | Some(OutputMode::Microstep | OutputMode::StepDir));
    if limits::may_act(&chan) || !is_open_loop && limits::follows_badly(&mut chan, command) {
        kernel.servo.still.watch();
        if !limits::check(kernel, memory, axis, (!is_open_loop).then_some(command)) {
            return true;
        }
        chan = AxisView::of(memory, axis);
    }
    let output = if is_open_loop {
        chan.set(Chan::OUTPUT, 0.0);
        0.0
    } else {
        compensation::advance(&kernel.servo.axes[axis.index()], &mut chan, command)
    };
    chan.set(Chan::PREV_DEST, chan.get(Chan::DEST));
    output::drive(kernel, memory, axis, command, output);
    moves
}

/// What the servo is to follow.
#[inline]
fn command(chan: &AxisView<'_>) -> f64 {
    chan.get(Chan::DEST) + f64::from(chan.get(Chan::BACKLASH)) + chan.get(Chan::DEST_OFFSET)
}

/// Velocity and direction of the destination in this tick; whether its velocity changes.
#[inline]
fn direction(own: &mut AxisMemory, chan: &mut AxisView<'_>) -> bool {
    let dest = chan.get(Chan::DEST);
    let last = own.dest;
    chan.set(Chan::LAST_DEST, last);
    own.last_velocity = own.velocity;
    own.velocity = if dest == last { 0.0 } else { (dest - last) / TIMEBASE };
    own.dest = dest;
    chan.set(Chan::LAST_VEL, own.velocity as f32);
    let sign = i32::from(dest > last) - i32::from(dest < last);
    // The first tick of a direction counts as standing still.
    let goes_on = sign != 0 && chan.get(Chan::LAST_NON_ZERO_DIR) == sign;
    chan.set(Chan::DIRECTION_OF_MOTION, if goes_on { sign } else { 0 });
    if sign != 0 {
        chan.set(Chan::LAST_NON_ZERO_DIR, sign);
    }
    own.velocity != 0.0 || own.last_velocity != 0.0
}
