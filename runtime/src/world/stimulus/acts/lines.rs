//! Levels of inputs and virtual bits, and analog inputs.

use kmotiondef::bits::{BitDirection, range_of};
use kmotiondef::variables::KANALOG_PRESENT;
use kmotiondef::{Bit, Cycles};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use crate::io::bits::bit_state;
use crate::io::kanalog::{COUNTS_PER_VOLT, is_volts};
use crate::out::Message;
use crate::views::TypedAccess;
use crate::world::WorldAccess;
use crate::world::stimulus::reader::{StatementReader, number};
use crate::world::stimulus::scene::Scene;
use crate::world::stimulus::tokens::Mistake;
use crate::world::stimulus::wave::Wave;
use chips::kanalog::ADC_CHANNELS;

/// Length of a pulse that does not say it: 10 ms.
const PULSE: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 100);
/// Inputs of Kanalog.
const KANALOG_INPUTS: std::ops::RangeInclusive<u16> = 128..=143;

pub(crate) fn read_bit(reader: &mut StatementReader<'_>) -> Result<(Bit, bool), Mistake> {
    let bit = reader.input_number()?;
    reader.expect_equals()?;
    Ok((bit, reader.level()?))
}

/// `set bit 5`; `set bit 5 = 1` and `set bit 5 1` are accepted, too.
pub(crate) fn read_set(reader: &mut StatementReader<'_>) -> Result<(Bit, bool), Mistake> {
    let bit = reader.input()?;
    let is_alone = !reader.accept_sign("=") && reader.tokens.is_empty();
    Ok((bit, is_alone || reader.level()?))
}

pub(crate) fn read_clear(reader: &mut StatementReader<'_>) -> Result<(Bit, bool), Mistake> {
    Ok((reader.input()?, false))
}

pub(crate) fn set(scene: &mut Scene<'_, '_, '_>, bit: Bit, level: bool) {
    drive(scene.access, scene.context, bit, level);
}

pub(crate) fn read_toggle(reader: &mut StatementReader<'_>) -> Result<(Bit,), Mistake> {
    Ok((reader.input()?,))
}

pub(crate) fn toggle(scene: &mut Scene<'_, '_, '_>, bit: Bit) {
    let level = level(scene, bit);
    set(scene, bit, !level);
}

pub(crate) fn read_pulse(reader: &mut StatementReader<'_>) -> Result<(Bit, Cycles), Mistake> {
    let bit = reader.input()?;
    Ok((bit, if reader.accept("for") { reader.time()? } else { PULSE }))
}

pub(crate) fn pulse(scene: &mut Scene<'_, '_, '_>, bit: Bit, duration: Cycles) {
    if duration < Cycles::PER_TICK {
        let us = 1e6 * duration.get() as f64 / Cycles::PER_SECOND.get() as f64;
        scene.access.out.remark(scene.context.now, Message::ShortPulse { bit, us });
    }
    let level = level(scene, bit);
    let gives_back = detach_switch(scene, bit, duration);
    set(scene, bit, !level);
    end(scene, bit, duration, level, gives_back);
}

/// Detaches an input from its switch for a time, unless an earlier action has done so; returns whether it has.
fn detach_switch(scene: &mut Scene<'_, '_, '_>, bit: Bit, duration: Cycles) -> bool {
    let is_switch = scene.access.machine.mechanics.contact(bit).is_some();
    let is_taken = is_switch && !scene.access.machine.mechanics.is_held(bit);
    if is_taken {
        let ms = 1e3 * duration.get() as f64 / Cycles::PER_SECOND.get() as f64;
        hold(scene.access, bit, &format!(" for {ms} ms"));
    }
    is_taken
}

/// Ends an action with a duration: the input returns to its switch, or to a level.
fn end(scene: &mut Scene<'_, '_, '_>, bit: Bit, duration: Cycles, level: bool, gives_back: bool) {
    let end = scene.context.now + duration;
    if gives_back {
        scene.plans.release(end, bit);
    } else {
        scene.plans.level(end, bit, level);
    }
}

pub(crate) fn press(scene: &mut Scene<'_, '_, '_>, bit: Bit) {
    let active = scene.access.machine.mechanics.contact(bit).is_none_or(|(.., active)| active);
    set(scene, bit, active);
}

pub(crate) fn release(scene: &mut Scene<'_, '_, '_>, bit: Bit) {
    if !let_go(scene.access, bit) {
        let idle = scene.access.io.pins.is_described(bit);
        set(scene, bit, idle);
    }
}

/// Reattaches an input to its switch; returns whether it has one.
pub(crate) fn let_go(access: &mut WorldAccess<'_>, bit: Bit) -> bool {
    access.machine.mechanics.let_go(bit);
    access.machine.mechanics.contact(bit).is_some()
}

/// When a contact that bounces inverts its level, as parts of the time that it takes. A switch drives its input again
/// at the end.
const BOUNCES: [f64; 4] = [0.12, 0.3, 0.55, 1.0];

pub(crate) fn bounce(scene: &mut Scene<'_, '_, '_>, bit: Bit, duration: Cycles) {
    let old = level(scene, bit);
    let gives_back = detach_switch(scene, bit, duration);
    set(scene, bit, !old);
    for (index, part) in BOUNCES.into_iter().enumerate() {
        let after = Cycles::new((duration.get() as f64 * part) as i64);
        scene.plans.level(scene.context.now + after, bit, (index % 2 == 0) == old);
    }
    if gives_back {
        scene.plans.release(scene.context.now + duration, bit);
    }
}

/// Declares a bit as driven, so that no remark calls its use accidental; a Kanalog whose inputs are driven is present.
pub(crate) fn announce(bit: &Bit, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
    access.io.pins.declare(*bit);
    if KANALOG_INPUTS.contains(&bit.get()) {
        memory.set(KANALOG_PRESENT, 1);
    }
}

/// Connects an analog input, and marks Kanalog as present.
pub(crate) fn connect_adc(channel: &usize, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
    access.io.kanalog.connect(*channel);
    memory.set(KANALOG_PRESENT, 1);
}

pub(crate) fn read_adc(reader: &mut StatementReader<'_>) -> Result<(usize, Wave), Mistake> {
    let channel = reader.below("an analog input from 0 to 7", ADC_CHANNELS)?;
    reader.expect_equals()?;
    Ok((channel, wave(reader)?))
}

pub(crate) fn adc(scene: &mut Scene<'_, '_, '_>, channel: usize, wave: Wave) {
    if let Wave::Constant(value) = wave
        && is_volts(value)
    {
        let (now, volts) = (scene.context.now, value / COUNTS_PER_VOLT);
        let (wanted, place) = (format!("{value}V"), format!("{}: ", scene.place));
        scene.access.out.remark(now, Message::FewCounts { place, channel, value, volts, wanted });
    }
    if scene.access.machine.mechanics.hold_analog(channel) {
        scene.access.out.remark(scene.context.now, Message::SourceOverridden { channel });
    }
    scene.plans.begin_wave(channel, wave, scene.context.now);
}

fn wave(reader: &mut StatementReader<'_>) -> Result<Wave, Mistake> {
    let word = reader.peek().unwrap_or_default().to_owned();
    match word.as_str() {
        "sine" => {
            reader.advance();
            let mean = if reader.accept("mean") { counts(reader)? } else { 0.0 };
            reader.expect("amplitude")?;
            let amplitude = counts(reader)?;
            reader.expect("hz")?;
            Ok(Wave::Sine { mean, amplitude, hz: reader.number("a frequency")? })
        }
        "square" => {
            reader.advance();
            reader.expect("low")?;
            let low = counts(reader)?;
            reader.expect("high")?;
            let high = counts(reader)?;
            reader.expect("hz")?;
            Ok(Wave::Square { low, high, hz: reader.number("a frequency")? })
        }
        "ramp" => {
            reader.advance();
            reader.expect("from")?;
            let from = counts(reader)?;
            reader.expect("to")?;
            let to = counts(reader)?;
            reader.expect("in")?;
            Ok(Wave::Ramp { from, to, over: reader.time()? })
        }
        "follows" => {
            reader.advance();
            reader.expect("axis")?;
            let axis = reader.axis()?;
            let gain = if reader.accept("gain") { reader.number("a factor")? } else { 1.0 };
            let offset = if reader.accept("offset") { counts(reader)? } else { 0.0 };
            Ok(Wave::Follows { axis, gain, offset })
        }
        _ => counts(reader).map(Wave::Constant),
    }
}

/// Counts of an analog input, or volts.
fn counts(reader: &mut StatementReader<'_>) -> Result<f64, Mistake> {
    reader.take("counts, volts such as 2.5V, `sine`, `square`, `ramp` or `follows`", |word| {
        match word.strip_suffix('V') {
            Some(volts) => number(volts).map(|volts| volts * COUNTS_PER_VOLT),
            None => number(word),
        }
    })
}

/// Returns whether a bit lives in guest memory.
fn is_memory(bit: Bit) -> bool {
    range_of(bit).is_some_and(|range| range.direction == BitDirection::Memory)
}

/// The level that the world gives a bit.
pub(crate) fn level(scene: &Scene<'_, '_, '_>, bit: Bit) -> bool {
    if is_memory(bit) {
        bit_state(scene.access.io, scene.context.memory, bit).0
    } else {
        scene.access.io.pins.input(bit)
    }
}

/// Gives a bit its level.
pub(crate) fn drive(access: &mut WorldAccess<'_>, context: &mut TickContext<'_>, bit: Bit, level: bool) {
    if is_memory(bit) {
        access.lines().write(context.memory, bit, level);
    } else {
        hold(access, bit, &format!(", until `release bit {bit}`"));
        access.lines().drive(bit, level);
    }
}

/// Overrides a switch on the same input, for a time or until it is released.
fn hold(access: &mut WorldAccess<'_>, bit: Bit, span: &str) {
    if let Some((axis, ..)) = access.machine.mechanics.contact(bit)
        && access.machine.mechanics.hold(bit)
    {
        let now = access.lines().now;
        access.out.remark(now, Message::SwitchOverridden { bit, axis, span: span.to_owned() });
    }
}
