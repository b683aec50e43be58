//! Actions that push loads, and that turn encoders or make them fail.

use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Cycles};
use vm::memory::GuestMemory;

use crate::machine::COUNTS_PER_TICK;
use crate::views::TypedAccess;
use crate::world::WorldAccess;
use crate::world::stimulus::plans::MovingObject;
use crate::world::stimulus::reader::StatementReader;
use crate::world::stimulus::scene::Scene;
use crate::world::stimulus::tokens::Mistake;
use chips::encoder::CHANNELS;

pub(crate) fn read_push(reader: &mut StatementReader<'_>) -> Result<(AxisId, f64), Mistake> {
    let axis = reader.axis()?;
    reader.expect("push")?;
    Ok((axis, reader.number("a distance")?))
}

/// Moves a load in one step, or as fast as its encoder can be read.
pub(crate) fn push(scene: &mut Scene<'_, '_, '_>, axis: AxisId, units: f64) {
    let gain = f64::from(scene.context.memory.axis(axis, Chan::INPUT_GAIN0));
    let unit = scene.access.machine.loads[axis].unit(gain).unwrap_or(gain);
    let ticks = (units / unit / COUNTS_PER_TICK).abs().ceil();
    if unit == 0.0 || ticks <= 1.0 {
        return scene.access.machine.loads.push(axis, units);
    }
    let over = Cycles::new((ticks as i64).saturating_mul(Cycles::PER_TICK.get()));
    scene.plans.begin_turn(MovingObject::Load(axis), units, over, scene.context.now);
}

pub(crate) fn read_pull(reader: &mut StatementReader<'_>) -> Result<(AxisId, f64), Mistake> {
    let axis = reader.axis()?;
    reader.expect("pull")?;
    reader.expect_equals()?;
    Ok((axis, reader.number("a speed in units per second")?))
}

/// Changes the constant load on a motor, which affects its speed.
pub(crate) fn pull(scene: &mut Scene<'_, '_, '_>, axis: AxisId, speed: f64) {
    scene.access.machine.loads.set_load(axis, speed);
}

pub(crate) fn read_load_spindle(reader: &mut StatementReader<'_>) -> Result<(AxisId, f64), Mistake> {
    let axis = reader.axis()?;
    reader.expect("load")?;
    reader.expect_equals()?;
    let column = reader.column();
    let load = reader.number("a part of full load from 0 to 1")?;
    if (0.0..=1.0).contains(&load) {
        Ok((axis, load))
    } else {
        Err((column, "a load is from 0 to 1".to_owned()))
    }
}

/// Changes the load of a spindle, whose droop reduces its speed.
pub(crate) fn load_spindle(scene: &mut Scene<'_, '_, '_>, axis: AxisId, load: f64) {
    scene.access.machine.mechanics.load_spindle(axis, load);
}

pub(crate) fn read_turn(reader: &mut StatementReader<'_>) -> Result<(usize, f64, Cycles), Mistake> {
    let input = encoder(reader)?;
    reader.expect("moves")?;
    let counts = reader.number("a number of counts")?;
    Ok((input, counts, if reader.accept("in") { reader.time()? } else { Cycles::default() }))
}

fn encoder(reader: &mut StatementReader<'_>) -> Result<usize, Mistake> {
    reader.below("an encoder input from 0 to 15", CHANNELS)
}

pub(crate) fn turn(scene: &mut Scene<'_, '_, '_>, input: usize, counts: f64, over: Cycles) {
    scene.plans.begin_turn(MovingObject::Encoder(input), counts, over, scene.context.now);
}

/// Declares the encoder as present from the beginning.
pub(crate) fn announce_turn(input: &usize, access: &mut WorldAccess<'_>, _: &mut GuestMemory) {
    access.machine.wiring.turn_by_hand(*input);
}

pub(crate) fn read_fail(reader: &mut StatementReader<'_>) -> Result<(usize,), Mistake> {
    let channel = encoder(reader)?;
    reader.expect("fails")?;
    Ok((channel,))
}

pub(crate) fn fail(scene: &mut Scene<'_, '_, '_>, channel: usize) {
    scene.access.io.encoders.fail(channel);
}
