//! Spindle measurement, and threading: the path's clock follows the spindle.
//!
//! Source: coordinated-motion.md section 7 and the recorded runs (`coord.jsonl`): the time that corresponds to the
//! spindle's angle goes through a low-pass filter; the speed, multiplied by the filter's time constant, is added before
//! the filter, so that a constant speed is followed without lag.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::{Chan, Spindle};
use kmotiondef::variables::{COORD_SYSTEM0, CS0_TIME_BASE, SERVO_TICK, SPINDLE};
use kmotiondef::{AxisId, Field, Scalar};
use vm::memory::GuestMemory;

use super::coordinated::buffer;
use crate::views::{TypedAccess, chan};

/// A spindle whose axis is read as an encoder.
const ENCODER: i32 = 1;

fn get<T: Scalar>(memory: &GuestMemory, field: Field<T>) -> T::Value {
    memory.get(SPINDLE.field(field))
}

fn set<T: Scalar>(memory: &mut GuestMemory, field: Field<T>, value: T::Value) {
    memory.set(SPINDLE.field(field), value);
}

/// A program's description of its spindle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    /// True if it has an encoder.
    pub(crate) has_encoder: bool,
    /// The axis with that encoder as its position.
    pub(crate) axis: AxisId,
    /// Seconds between two measurements of the speed.
    pub(crate) update_time: f32,
    /// Time constant of the threading filter in seconds.
    pub(crate) tau: f32,
    /// Counts of a revolution.
    pub(crate) counts: f32,
}

/// Sets the measurement up; it begins with the next tick.
pub(crate) fn configure(memory: &mut GuestMemory, setup: &Setup) {
    let position = memory.locate(chan(setup.axis).field(Chan::POSITION));
    let ticks = f64::from((f64::from(setup.update_time) / TIMEBASE) as i32).max(1.0);
    let counts = f64::from(setup.counts);
    set(memory, Spindle::P_ENCODER_POS, position);
    set(memory, Spindle::REVS_PER_COUNT, if counts == 0.0 { 0.0 } else { 1.0 / counts });
    set(memory, Spindle::DELTA_TICKS, ticks);
    set(memory, Spindle::INV_UPDATE_TIME, (1.0 / (ticks * TIMEBASE)) as f32);
    set(memory, Spindle::UPDATE_TICK, memory.get(SERVO_TICK) + ticks);
    set(memory, Spindle::TAU, setup.tau);
    // The board stores it as a double, and computes it as a single.
    let k = if setup.tau > 0.0 { libm::exp(-TIMEBASE / f64::from(setup.tau)) as f32 } else { 0.0 };
    set(memory, Spindle::K, f64::from(k));
    set(memory, Spindle::TRUE_SPEED_RPS, 0.0);
    set(memory, Spindle::TYPE, if setup.has_encoder { ENCODER } else { 0 });
    if setup.has_encoder {
        let position = position_now(memory);
        set(memory, Spindle::POSITION, position);
        set(memory, Spindle::LAST_UPDATE_POSITION, position);
    }
}

fn position_now(memory: &GuestMemory) -> f64 {
    memory.peek::<f64>(get(memory, Spindle::P_ENCODER_POS)) * get(memory, Spindle::REVS_PER_COUNT)
}

/// Returns whether there is a spindle to measure.
pub(crate) fn is_measured(memory: &GuestMemory) -> bool {
    get(memory, Spindle::TYPE) == ENCODER
}

/// Executes one tick of the measurement; returns whether it changed anything.
pub(crate) fn measure(memory: &mut GuestMemory) -> bool {
    if !is_measured(memory) {
        return false;
    }
    let position = position_now(memory);
    let mut changed = position != get(memory, Spindle::POSITION);
    set(memory, Spindle::POSITION, position);
    let update = get(memory, Spindle::UPDATE_TICK);
    if memory.get(SERVO_TICK) >= update {
        let revolutions = position - get(memory, Spindle::LAST_UPDATE_POSITION);
        let speed = (revolutions * f64::from(get(memory, Spindle::INV_UPDATE_TIME))) as f32;
        changed |= speed != get(memory, Spindle::TRUE_SPEED_RPS);
        set(memory, Spindle::TRUE_SPEED_RPS, speed);
        set(memory, Spindle::LAST_UPDATE_POSITION, position);
        set(memory, Spindle::UPDATE_TICK, update + get(memory, Spindle::DELTA_TICKS).max(1.0));
    }
    if is_threading(memory) {
        drive(memory);
        changed = true;
    }
    // The speed of a spindle that has just stopped is still to be measured.
    changed || get(memory, Spindle::TRUE_SPEED_RPS) != 0.0
}

/// Starts the path in the buffer, driven by the spindle from a whole revolution on.
pub(crate) fn thread(memory: &mut GuestMemory, base_speed: f32) {
    let inverse = 1.0 / base_speed;
    let k = get(memory, Spindle::K);
    set(memory, Spindle::INV_BASE_SPEED_RPS, inverse);
    set(memory, Spindle::INV_BASE_SPEED_RPS_K1, f64::from(inverse) * (1.0 - k));
    let start = libm::floor(get(memory, Spindle::POSITION)) + 2.0;
    set(memory, Spindle::START_POSITION, start);
    set(memory, Spindle::ADJ_TIME_FILT, (get(memory, Spindle::POSITION) - start) * f64::from(inverse));
    set(memory, Spindle::LAST_CS_TIME, 0.0);
    buffer::execute(memory);
    memory.set(CS0_TIME_BASE, 0.0);
    set(memory, Spindle::THREADING_ACTIVE, 1);
}

/// Returns whether the spindle drives the path.
pub(crate) fn is_threading(memory: &GuestMemory) -> bool {
    get(memory, Spindle::THREADING_ACTIVE) != 0
}

/// Executes one tick of threading: sets the advance of the path in this tick. It never goes back. The end of the path
/// ends the threading.
fn drive(memory: &mut GuestMemory) {
    let revolutions = get(memory, Spindle::POSITION) - get(memory, Spindle::START_POSITION);
    let ahead = f64::from(get(memory, Spindle::TRUE_SPEED_RPS) * get(memory, Spindle::TAU));
    let time = get(memory, Spindle::K) * get(memory, Spindle::ADJ_TIME_FILT)
        + get(memory, Spindle::INV_BASE_SPEED_RPS_K1) * (revolutions + ahead);
    set(memory, Spindle::ADJ_TIME_FILT, time);
    let last = get(memory, Spindle::LAST_CS_TIME);
    let reached = time.max(last);
    set(memory, Spindle::LAST_CS_TIME, reached);
    memory.set(CS0_TIME_BASE, f64::from((reached - last) as f32));
    if memory.get(COORD_SYSTEM0).is_null() {
        set(memory, Spindle::THREADING_ACTIVE, 0);
    }
}
