//! The servo interrupt: the board's work in every tick.
//!
//! Measured order of the released firmware (`firmware.md` section 4): trajectories of all axes, slaves, then axis by
//! axis position, backlash, limits, following error, compensation and output; then `prev_dest`, and the recorder last.
//! The call-back comes before all of this and is the machine's work.

mod backlash;
pub(crate) mod cache;
#[cfg(test)]
mod closed_form;
mod compensation;
pub(crate) mod coordinated;
mod direct;
mod duration;
#[cfg(test)]
mod equations;
pub(crate) mod hold;
#[cfg(test)]
mod hostile;
pub(crate) mod independent;
pub(crate) mod input;
mod interrupt;
pub(crate) mod limits;
pub(crate) mod moves;
mod output;
pub(crate) mod plan;
pub(crate) mod planning;
pub(crate) mod profile;
#[cfg(test)]
mod recorded;
#[cfg(test)]
mod recorded_servo;
mod recorder;
pub(crate) mod sine;
mod slave;
pub(crate) mod spindle;
mod state;
mod still;
mod stop;
pub(crate) mod switching;
pub(crate) mod trajectory;
pub(crate) mod wired;

use kmotiondef::limits::TIMEBASE;
use kmotiondef::modes::{LastMotion, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Bit};
use vm::memory::GuestMemory;

use crate::machine::description::Gantry;
use crate::machine::{Drive, RackedGantry, UnitMismatch};
use crate::out::Message;
use crate::servo::cache::Invalidation;
use crate::servo::plan::Input;
use crate::servo::state::AxisMemory;
use crate::servo::trajectory::TICKS_PER_SECOND;
use crate::views::{AxisView, TypedAccess};
use chips::stepgen::{StepLimit, generator_of};

pub(crate) use output::{four_phase, load_drive, three_phase};
pub(crate) use state::{CallPlace, Servo, Tick};

/// The number of step generators of a KStep, and the bit that enables its amplifiers.
const ON_KSTEP: usize = 4;
const KSTEP_ENABLE: i32 = 45;

/// Executes one tick of the servo; returns whether anything changed, so that the next tick may change something, too.
///
/// `is_touched` is set if on-chip RAM may have been written to since the last tick.
pub(crate) fn tick(tick: &mut Tick<'_>, memory: &mut GuestMemory, is_touched: bool) -> bool {
    let is_driven = tick.machine.drive(tick.io, tick.out, memory, tick.now);
    let turned = spindle::measure(memory);
    let stepped = tick.io.stepgens.is_driven() && run_generators(tick, memory);
    notice_pushes(tick);
    let has_path = !tick.servo.coordinated.is_idle(memory);
    let is_touched = memory.take_touched() || is_touched;
    if is_touched {
        tick.servo.cache.wake();
    }
    let moved = if has_path || !tick.servo.cache.is_still(memory, is_touched) {
        run_axes(tick, memory)
    } else {
        tick.machine.signal(tick.io, tick.now);
        false
    };
    if let Some(RackedGantry { gantry: Gantry { axes: [axis, other], most }, apart }) =
        tick.machine.mechanics.take_racked()
    {
        tick.out.remark(tick.now, Message::GantryRacks { axis, other, apart, most });
    }
    // The writes so far are the servo's own. A recording may write anywhere.
    memory.take_touched();
    let recorded = recorder::sample(memory);
    is_driven | turned | stepped | moved | recorded
}

/// Runs the step generators that programs drive directly, and the loads connected to them: of the axis that names a
/// generator as its output, otherwise of the axis with the same number.
fn run_generators(tick: &mut Tick<'_>, memory: &GuestMemory) -> bool {
    let moved = tick.io.stepgens.run(TIMEBASE, &mut tick.io.pins, tick.now);
    let is_off = amplifiers_are_off(tick);
    for (generator, steps) in moved.into_iter().enumerate().filter(|(_, steps)| *steps != 0.0) {
        let names = |axis: &AxisId| {
            let mode = OutputMode::new(memory.axis(*axis, Chan::OUTPUT_MODE));
            OutputMode::has_generator(mode)
                && generator_of(memory.axis(*axis, Chan::OUTPUT_CHAN0)) == generator
        };
        let wired = tick.machine.wiring.motor_on(generator);
        let axis = wired
            .or_else(|| memory.axes().iter().find(names))
            .or_else(|| memory.axes().get(generator as i32));
        let Some(axis) = axis.filter(|_| !is_off || generator >= ON_KSTEP) else { continue };
        let gain = f64::from(memory.axis(axis, Chan::OUTPUT_GAIN));
        if gain != 0.0 {
            tick.machine.loads.push(axis, steps / gain);
        }
    }
    true
}

/// Returns whether the amplifiers of a KStep wait for their enable signal.
fn amplifiers_are_off(tick: &Tick<'_>) -> bool {
    tick.machine.needs_enable
        && !Bit::new(KSTEP_ENABLE).is_some_and(|bit| tick.io.pins.is_output(bit) && tick.io.pins.level(bit))
}

/// Recomputes the axes if a load may have been moved from outside.
#[inline]
fn notice_pushes(tick: &mut Tick<'_>) {
    if tick.machine.loads.take_pushed() {
        tick.servo.cache.invalidate(Invalidation::Motion);
    }
}

/// Executes one tick of all axes; returns whether anything changed.
fn run_axes(tick: &mut Tick<'_>, memory: &mut GuestMemory) -> bool {
    tick.servo.cache.begin(memory, &tick.machine.wiring);
    let mut changed = false;
    if tick.machine.needs_enable || tick.machine.wiring.has_drives() {
        switch_amplifiers(tick, memory);
    }
    let has_path = !tick.servo.coordinated.is_idle(memory);
    if has_path || tick.servo.cache.is_coupled() || tick.machine.has_mechanics() {
        changed |= run_together(tick, memory);
    } else {
        for axis in memory.axes().iter() {
            if !tick.servo.cache.is_resting(axis) {
                changed |= run_alone(tick, memory, axis);
            } else if cfg!(debug_assertions) {
                assert!(!run_alone(tick, memory, axis), "axis {axis} was at rest and has changed");
            }
        }
    }
    notice_pushes(tick);
    tick.servo.cache.end(memory, changed)
}

/// Executes one tick of an axis that depends on no other axis; returns whether anything changed.
#[inline(never)]
fn run_alone(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId) -> bool {
    let changed = advance(tick, memory, axis) | run_axis(tick, memory, axis);
    if !changed && memory.axis(axis, Chan::ENABLE) == 0 && depends_on_itself(tick, axis) {
        tick.servo.cache.rest(axis);
    }
    changed
}

/// Returns whether nothing but the memory and the load of a disabled axis changes its position.
fn depends_on_itself(tick: &Tick<'_>, axis: AxisId) -> bool {
    let plant = &tick.machine.loads[axis];
    let is_own = match &tick.servo.cache.plan(axis).input {
        Input::None => true,
        Input::Encoder(encoder) => encoder.turned_by.is_none_or(|other| other == axis),
        Input::Adc | Input::Resolver => false,
    };
    is_own && plant.drive == Drive::None && !plant.has_motor() && tick.machine.wiring.drive(axis).is_none()
}

/// Executes one tick of all axes, step by step, as each may depend on the others; returns whether anything changed.
fn run_together(tick: &mut Tick<'_>, memory: &mut GuestMemory) -> bool {
    let mut changed = false;
    for axis in memory.axes().iter() {
        changed |= advance(tick, memory, axis);
    }
    tick.machine.signal(tick.io, tick.now);
    if !tick.servo.coordinated.is_idle(memory) {
        changed |= coordinated::board::tick(tick, memory);
    }
    if tick.servo.cache.has_slaves() {
        slave::follow(tick.servo, memory);
    }
    for axis in memory.axes().iter() {
        changed |= run_axis(tick, memory, axis);
    }
    changed
}

/// Switches the amplifiers of a KStep by their enable signal, and off where the steps move another load.
fn switch_amplifiers(tick: &mut Tick<'_>, memory: &mut GuestMemory) {
    let is_off = amplifiers_are_off(tick);
    for axis in memory.axes().iter() {
        let is_on_kstep = generator_of(memory.axis(axis, Chan::OUTPUT_CHAN0)) < ON_KSTEP;
        let is_own = wired::steps_are_own(tick.machine, memory, axis);
        tick.machine.loads[axis].set_amplifier(is_own && !(is_off && is_on_kstep));
    }
}

/// Moves the load of an axis by the output of the last tick, and its destination by its command; returns whether that
/// changed anything.
#[inline(always)]
fn advance(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId) -> bool {
    if let Some(drive) = wired::drive(tick.machine, tick.io, memory, axis) {
        tick.machine.loads[axis].drive = drive;
    }
    let chan = AxisView::of(memory, axis);
    let (plant, plan) = (&mut tick.machine.loads[axis], tick.servo.cache.plan(axis));
    let moved = plant.advance(&chan, plan.reach, || tick.io.stepgens.steps_per_tick(axis));
    let is_enabled = chan.get(Chan::ENABLE) != 0;
    let is_told = is_enabled && !chan.get(Chan::PCOEFF).is_null();
    let AxisMemory { has_run, dest, knows_dest, .. } = tick.servo.axes[axis.index()];
    let leap = (knows_dest && is_enabled && chan.get(Chan::DEST) != dest).then_some(dest);
    let rewritten = plant.take_rewritten().filter(|_| is_enabled && has_run);
    let stopped_at = plant.take_stopped().filter(|_| is_told);
    if plant.has_stepped() {
        step(tick, memory, axis);
    }
    if let Some(place) = stopped_at {
        note_stopped(tick, memory, axis, place);
    }
    if let Some((from, to)) = rewritten {
        note_rewritten(tick, memory, axis, from, to);
    }
    if let Some(from) = leap {
        note_leap(tick, memory, axis, from);
    }
    if !is_told {
        return moved;
    }
    if !independent::advance(memory, axis) {
        tick.out.remark(tick.now, Message::NoStates { axis });
    }
    true
}

/// The position of an enabled axis was written: its loop takes it for a following error.
fn note_rewritten(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId, from: f64, to: f64) {
    const FAR: f64 = 100.0;
    let plan = tick.servo.cache.plan(axis);
    let dest = memory.axis(axis, Chan::DEST);
    let is_loop = matches!(plan.input, Input::Encoder(_)) && !plan.is_open_loop && plan.mode.is_some();
    if is_loop && plan.mode != Some(OutputMode::None) && (dest - to).abs() > (dest - from).abs() + FAR {
        // The following error that comes of it has no other cause.
        tick.servo.axes[axis.index()].is_explained = true;
        tick.remark_near(Message::PositionWritten { axis, from, to });
    }
}

/// The load of an axis in motion has run into a hard stop.
fn note_stopped(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId, place: f64) {
    let effect = if tick.servo.cache.plan(axis).is_open_loop {
        "a stepper loses its steps there"
    } else {
        "its motor pushes against the stop"
    };
    let plant = &tick.machine.loads[axis];
    let key = tick.machine.notes.key(axis, if place == plant.ends().0 { "min" } else { "max" });
    let effect = match tick.machine.notes.other_units(memory, axis) {
        Some(UnitMismatch { units, place, unit, .. }) => {
            format!("{effect}; min, max and start are in {unit}, not in {units} ({place})")
        }
        None => effect.to_owned(),
    };
    tick.servo.axes[axis.index()].is_explained = true;
    tick.remark_on_axis(memory, axis, Message::HardStop { axis, place, key, effect });
}

/// The destination of an enabled axis was written: whether a motor could follow that.
fn note_leap(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId, from: f64) {
    const FAR: f64 = 100.0;
    /// The time at full speed within which a motor may follow a step.
    const SECONDS: f64 = 0.02;
    let to = memory.axis(axis, Chan::DEST);
    // A closed loop may be given a step on purpose, to record its response.
    let plan = tick.servo.cache.plan(axis);
    let is_stepper = plan.is_open_loop && OutputMode::has_generator(plan.mode);
    let reach = SECONDS * f64::from(memory.axis(axis, Chan::VEL));
    if is_stepper && (to - from).abs() > FAR.max(reach) {
        tick.remark_near(Message::DestLeaps { axis, from, to });
    }
}

/// The step generator of an axis has moved its load.
fn step(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId) {
    let plant = &mut tick.machine.loads[axis];
    let steps = plant.take_stepped() * f64::from(memory.axis(axis, Chan::OUTPUT_GAIN));
    if plant.take_behind()
        && let Some(StepLimit { fastest, length }) = tick.io.stepgens.limit(axis)
    {
        let is_jog = memory.axis(axis, Chan::LAST_MOTION_TYPE) == LastMotion::Jog.get();
        let slower = if is_jog { "jog with fewer counts a second" } else { "lower Vel" };
        tick.remark_on_axis(memory, axis, Message::StepsTooFast { axis, fastest, length, slower });
    }
    tick.io.stepgens.step(axis, steps, &mut tick.io.pins, tick.now);
    if tick.machine.wiring.has_drives() {
        wired::step_other(tick.machine, memory, axis, steps);
    }
}

/// Position, protection, compensation and output of one axis; returns whether it moves or has a command.
#[inline(always)]
fn run_axis(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId) -> bool {
    let Tick { servo, machine, io, now, .. } = tick;
    let plan = servo.cache.plan(axis);
    if !matches!(plan.input, Input::Encoder(_)) {
        input::measure(plan.input, &mut machine.loads, memory, axis);
    }
    let own = &mut servo.axes[axis.index()];
    let mut chan = AxisView::of(memory, axis);
    if let Some((channel, count)) = input::count(&plan.input, &mut machine.loads, &mut chan, axis) {
        io.encoders.count(channel, count, &mut io.pins, *now);
    }
    if chan.get(Chan::ENABLE) == 0 {
        own.knows_dest = false;
        machine.loads[axis].release();
        io.stepgens.release(axis, &mut io.pins, *now);
        return false;
    }
    let moves = direction(own, &mut chan);
    if plan.has_backlash {
        backlash::advance(&mut chan);
    }
    let command = command(&chan);
    if limits::may_act(&chan, plan) || !plan.is_open_loop && limits::follows_badly(&mut chan, plan, command) {
        return run_guarded(tick, memory, axis, command) | moves;
    }
    put_out(tick, memory, axis, command);
    moves
}

/// Executes the rest of a tick of an axis that its limits may stop; returns whether they did.
fn run_guarded(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId, command: f64) -> bool {
    tick.servo.cache.watch();
    let is_open_loop = tick.servo.cache.plan(axis).is_open_loop;
    let is_enabled = limits::check(tick, memory, axis, (!is_open_loop).then_some(command));
    if is_enabled {
        put_out(tick, memory, axis, command);
    }
    !is_enabled
}

/// Compensation and output of an enabled axis.
#[inline(always)]
fn put_out(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId, command: f64) {
    let own = &mut tick.servo.axes[axis.index()];
    own.has_run = true;
    let plan = tick.servo.cache.plan(axis);
    let mut chan = AxisView::of(memory, axis);
    let output = if plan.is_open_loop {
        chan.get(Chan::OUTPUT)
    } else {
        let moved = chan.get(Chan::POSITION) - chan.get(Chan::LAST_POSITION);
        own.response += f64::from(chan.get(Chan::OUTPUT)) * moved;
        let error = command - chan.get(Chan::POSITION);
        own.note_way(moved);
        if error * f64::from(own.velocity) < 0.0 && error.abs() > own.ahead {
            own.ahead = error.abs();
        }
        let before = chan.get(Chan::OUTPUT);
        let output = compensation::advance(own, &plan.gains, &mut chan, command);
        if before * output < 0.0 && (output - before).abs() > chan.get(Chan::MAX_OUTPUT) {
            own.flips = own.flips.saturating_add(1);
        }
        output
    };
    chan.set(Chan::PREV_DEST, chan.get(Chan::DEST));
    output::drive(tick, memory, axis, command, output);
}

/// Returns the value that the servo follows.
#[inline]
fn command(chan: &AxisView<'_>) -> f64 {
    chan.get(Chan::DEST) + f64::from(chan.get(Chan::BACKLASH)) + chan.get(Chan::DEST_OFFSET)
}

/// Updates velocity and direction of the destination in this tick; returns whether its velocity changes.
#[inline]
fn direction(own: &mut AxisMemory, chan: &mut AxisView<'_>) -> bool {
    let dest = chan.get(Chan::DEST);
    let last = own.dest;
    chan.set(Chan::LAST_DEST, last);
    own.last_velocity = chan.get(Chan::LAST_VEL);
    own.dest = dest;
    own.knows_dest = true;
    let (mut sign, mut goes_on) = (0, false);
    if dest == last {
        own.velocity = 0.0;
    } else {
        own.velocity = ((dest - last) * TICKS_PER_SECOND) as f32;
        sign = i32::from(dest > last) - i32::from(dest < last);
        // The first tick in a new direction counts as standing still.
        goes_on = sign != 0 && chan.get(Chan::LAST_NON_ZERO_DIR) == sign;
        if sign != 0 {
            chan.set(Chan::LAST_NON_ZERO_DIR, sign);
        }
    }
    chan.set(Chan::LAST_VEL, own.velocity);
    chan.set(Chan::DIRECTION_OF_MOTION, if goes_on { sign } else { 0 });
    own.velocity != 0.0 || own.last_velocity != 0.0
}
