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
mod plan;
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
use kmotiondef::{AxisId, Bit, Cycles};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use crate::io::stepgen::generator_of;
use crate::kernel::Kernel;
use crate::machine::plant::{self, Plant};
use crate::out::EventKind;
use crate::servo::plan::{Input, Plan};
use crate::servo::still::Stillness;
use crate::views::{AxisView, Typed};

pub(crate) use output::{four_phase, switch_off, three_phase};
pub(crate) use profile::TIMEBASE;

/// Step generators of a KStep, from 0 on, and the bit that enables its amplifiers.
const ON_KSTEP: usize = 4;
const KSTEP_ENABLE: i32 = 45;

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
    plans: [Plan; N_CHANNELS],
    /// Whether nobody else may have changed what they were made of.
    has_plans: bool,
    /// Whether an axis depends on another by them.
    is_coupled: bool,
    /// What the interrupt takes with them.
    duration: Cycles,
    pub(crate) coordinated: coordinated::Coordinated,
    pub(crate) still: Stillness,
    pub(crate) stop_request: limits::StopRequest,
    /// Whether motors on the first four step generators need the enable signal of a KStep.
    pub(crate) needs_enable: bool,
}

impl Servo {
    /// Something outside moves the load of an axis.
    pub(crate) fn push(&mut self, axis: AxisId, units: f64) {
        self.plants[axis.index()].push(units);
        self.still.interrupt();
    }

    /// What the servo interrupt takes of a tick.
    #[inline]
    pub(crate) fn duration(&self, memory: &GuestMemory) -> Cycles {
        if self.has_plans { self.duration } else { duration::duration(memory) }
    }

    /// Whether a path or an axis on its own moves or something is being recorded.
    pub(crate) fn is_busy(memory: &GuestMemory) -> bool {
        recorder::is_recording(memory)
            || coordinated::path::is_under_way(memory)
            || AxisId::all().any(|axis| independent::is_moving(memory, axis))
    }
}

/// One tick of the servo; whether anything changed, so that the next tick may change something too.
///
/// `is_touched` says whether anybody may have written to on-chip RAM since the last.
pub(crate) fn tick(kernel: &mut Kernel, context: &mut TickContext<'_>, is_touched: bool) -> bool {
    let memory = &mut *context.memory;
    let is_driven = plant::drive(kernel, memory, context.now);
    let turned = spindle::measure(memory);
    let stepped = kernel.stepgens.is_driven() && run_generators(kernel, memory, context.now);
    let has_path = !kernel.servo.coordinated.is_idle(memory);
    let is_touched = memory.take_touched() || is_touched;
    let moved = if has_path || !kernel.servo.still.lasts(memory, is_touched) {
        run_axes(kernel, memory, context.now)
    } else {
        plant::signal(kernel, context.now);
        false
    };
    // What was written so far is the servo's own. A recording may write anywhere.
    memory.take_touched();
    let recorded = recorder::sample(memory);
    is_driven | turned | stepped | moved | recorded
}

/// Runs the step generators that programs drive by themselves, and what is connected to them: the axis that names a
/// generator as its output, or else the one of its number.
fn run_generators(kernel: &mut Kernel, memory: &GuestMemory, now: Cycles) -> bool {
    let moved = kernel.stepgens.run(TIMEBASE, &mut kernel.pins, now);
    let is_off = amplifiers_are_off(kernel);
    for (generator, steps) in moved.into_iter().enumerate().filter(|(_, steps)| *steps != 0.0) {
        let names = |axis: &AxisId| {
            let mode = OutputMode::new(memory.axis(*axis, Chan::OUTPUT_MODE));
            matches!(mode, Some(OutputMode::StepDir | OutputMode::ClosedLoopStepDir))
                && generator_of(memory.axis(*axis, Chan::OUTPUT_CHAN0)) == generator
        };
        let axis = AxisId::all().find(names).or_else(|| AxisId::new(generator as i32));
        let Some(axis) = axis.filter(|_| !is_off || generator >= ON_KSTEP) else { continue };
        let gain = f64::from(memory.axis(axis, Chan::OUTPUT_GAIN));
        if gain != 0.0 {
            kernel.servo.push(axis, steps / gain);
        }
    }
    true
}

/// Whether the amplifiers of a KStep wait for their enable signal.
fn amplifiers_are_off(kernel: &Kernel) -> bool {
    kernel.servo.needs_enable
        && !Bit::new(KSTEP_ENABLE).is_some_and(|bit| kernel.pins.is_output(bit) && kernel.pins.level(bit))
}

/// One tick of all axes; whether anything changed.
fn run_axes(kernel: &mut Kernel, memory: &mut GuestMemory, now: Cycles) -> bool {
    kernel.servo.still.begin(memory);
    kernel.servo.make_plans(memory);
    let mut changed = false;
    if kernel.servo.needs_enable {
        switch_amplifiers(kernel, memory);
    }
    let has_path = !kernel.servo.coordinated.is_idle(memory);
    if has_path || kernel.servo.is_coupled || plant::has_mechanics(kernel) {
        changed |= run_together(kernel, memory, now);
    } else {
        for axis in AxisId::all() {
            changed |= run_alone(kernel, memory, axis, now);
        }
    }
    if changed {
        kernel.servo.still.interrupt();
        return true;
    }
    !kernel.servo.still.end(memory)
}

/// One tick of an axis that depends on nothing but itself; whether anything changed.
#[inline(never)]
fn run_alone(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, now: Cycles) -> bool {
    advance(kernel, memory, axis, now) | run_axis(kernel, memory, axis)
}

/// One tick of all axes, step by step, as each may depend on the others; whether anything changed.
fn run_together(kernel: &mut Kernel, memory: &mut GuestMemory, now: Cycles) -> bool {
    let mut changed = false;
    for axis in AxisId::all() {
        changed |= advance(kernel, memory, axis, now);
    }
    plant::signal(kernel, now);
    if !kernel.servo.coordinated.is_idle(memory) {
        changed |= coordinated::board::tick(kernel, memory);
    }
    if kernel.servo.plans.iter().any(|plan| plan.is_slave) {
        slave::follow(&kernel.servo, memory);
    }
    for axis in AxisId::all() {
        changed |= run_axis(kernel, memory, axis);
    }
    changed
}

/// Switches the amplifiers of a KStep as their enable signal says.
fn switch_amplifiers(kernel: &mut Kernel, memory: &mut GuestMemory) {
    let is_off = amplifiers_are_off(kernel);
    for axis in AxisId::all() {
        let is_on_kstep = generator_of(memory.axis(axis, Chan::OUTPUT_CHAN0)) < ON_KSTEP;
        kernel.servo.plants[axis.index()].set_amplifier(!(is_off && is_on_kstep));
    }
}

/// Moves the load of an axis by what the last tick has put out, and its destination by what it is told; whether that
/// changed anything.
#[inline(always)]
fn advance(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, now: Cycles) -> bool {
    let chan = AxisView::of(memory, axis);
    let (plant, plan) = (&mut kernel.servo.plants[axis.index()], &kernel.servo.plans[axis.index()]);
    let moved = plant.advance(&chan, plan.reach, || kernel.stepgens.steps_per_tick(axis));
    let is_told = chan.get(Chan::ENABLE) != 0 && !chan.get(Chan::PCOEFF).is_null();
    if plant.has_stepped() {
        step(kernel, memory, axis, now);
    }
    if !is_told {
        return moved;
    }
    if !independent::advance(memory, axis) {
        let text = format!("axis {axis}: pcoeff points at no list of states; its motion has ended");
        kernel.tell(now, EventKind::Diagnostic(text));
    }
    true
}

/// The step generator of an axis has moved its load.
fn step(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, now: Cycles) {
    let plant = &mut kernel.servo.plants[axis.index()];
    let steps = plant.take_stepped() * f64::from(memory.axis(axis, Chan::OUTPUT_GAIN));
    if plant.take_behind()
        && let Some(text) = kernel.stepgens.fall_behind(axis)
    {
        kernel.tell(now, EventKind::Diagnostic(text));
    }
    kernel.stepgens.step(axis, steps, &mut kernel.pins, now);
}

/// Position, protection, compensation and output of one axis; whether it moves or is told something.
#[inline(always)]
fn run_axis(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) -> bool {
    let servo = &mut kernel.servo;
    let plan = &servo.plans[axis.index()];
    if !matches!(plan.input, Input::Encoder(_)) {
        input::measure(plan.input, &mut servo.plants, memory, axis);
    }
    let (plan, own) = (&servo.plans[axis.index()], &mut servo.axes[axis.index()]);
    let mut chan = AxisView::of(memory, axis);
    if let Some((channel, count)) = input::count(&plan.input, &mut servo.plants, &mut chan, axis) {
        kernel.encoders.count(channel, count, &mut kernel.pins, kernel.tick_start);
    }
    let moves = direction(own, &mut chan);
    if chan.get(Chan::ENABLE) == 0 {
        servo.plants[axis.index()].release();
        kernel.stepgens.release(axis, &mut kernel.pins, kernel.tick_start);
        return moves;
    }
    if plan.has_backlash {
        backlash::advance(&mut chan);
    } else {
        chan.set(Chan::BACKLASH, 0.0);
    }
    let command = command(&chan);
    if limits::may_act(&chan, plan) || !plan.is_open_loop && limits::follows_badly(&mut chan, plan, command) {
        return run_guarded(kernel, memory, axis, command) | moves;
    }
    put_out(kernel, memory, axis, command);
    moves
}

/// The rest of a tick of an axis that its limits may stop; whether they did.
fn run_guarded(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, command: f64) -> bool {
    kernel.servo.still.watch();
    let is_open_loop = kernel.servo.plans[axis.index()].is_open_loop;
    let is_enabled = limits::check(kernel, memory, axis, (!is_open_loop).then_some(command));
    if is_enabled {
        put_out(kernel, memory, axis, command);
    }
    !is_enabled
}

/// Compensation and output of an enabled axis.
#[inline(always)]
fn put_out(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, command: f64) {
    let mut chan = AxisView::of(memory, axis);
    let (plan, own) = (&kernel.servo.plans[axis.index()], &kernel.servo.axes[axis.index()]);
    let output = if plan.is_open_loop {
        chan.set(Chan::OUTPUT, 0.0);
        0.0
    } else {
        compensation::advance(own, &plan.gains, &mut chan, command)
    };
    chan.set(Chan::PREV_DEST, chan.get(Chan::DEST));
    output::drive(kernel, memory, axis, command, output);
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
    own.dest = dest;
    let (mut sign, mut goes_on) = (0, false);
    if dest == last {
        own.velocity = 0.0;
    } else {
        own.velocity = (dest - last) / TIMEBASE;
        sign = i32::from(dest > last) - i32::from(dest < last);
        // The first tick of a direction counts as standing still.
        goes_on = sign != 0 && chan.get(Chan::LAST_NON_ZERO_DIR) == sign;
        if sign != 0 {
            chan.set(Chan::LAST_NON_ZERO_DIR, sign);
        }
    }
    chan.set(Chan::LAST_VEL, own.velocity as f32);
    chan.set(Chan::DIRECTION_OF_MOTION, if goes_on { sign } else { 0 });
    own.velocity != 0.0 || own.last_velocity != 0.0
}
