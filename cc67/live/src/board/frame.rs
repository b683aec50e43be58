//! A frame: the visible state of the board at one time, in few bytes.
//!
//! Numbers are little endian. `page/frame.js` reads this layout:
//!
//! | from | what |
//! |---|---|
//! | 0 | version, flags (1 running, 2 in the past, 4 programs ended), as u32 |
//! | 8 | tick, last tick of the run, speed requested, speed measured, as f64 |
//! | 40 | generation of the signals, numbers in a row, rows, axes after the first eight, as u32 |
//! | 56 | eight axes of 72 bytes: Dest, Position, load, output, velocity, soft limits, Vel as f64; enable, input mode, output mode, limits reached, spare as u8 |
//! | 632 | levels of the 2048 bits; then directions of the first 64, 1 for an output |
//! | 896 | eight analog inputs, eight analog outputs, as i16 |
//! | 928 | the 200 words of `persist.UserData` |
//! | 1728 | the axes after the first eight; then rows of samples: tick and values as f64 |

use cc67_host::{Session, Target};
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{ADC_BUFFER_IN, BIT_DIR_SHADOW, DAC_BUFFER, PERSIST, chan};
use kmotiondef::{AxisId, Bit, Field, GuestAddr, Ticks};
use runtime::trace::Item;

use super::samples::Samples;

/// The version of the layout.
const VERSION: u32 = 1;
/// The offset of the axes after the first eight, or of the samples if there are none.
const LATER_AXES: usize = 1728;
/// Bits that have a direction.
const PINS: u16 = 64;

/// The part of a frame's data that is not the board's state.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameClock {
    /// True if the clock runs.
    pub(super) is_running: bool,
    /// True if the board is shown at an earlier time from which it would continue.
    pub(super) is_past: bool,
    /// The last tick of the run.
    pub(super) end: Ticks,
    /// The requested and the measured speed.
    pub(super) speed: [f64; 2],
}

/// Creates a frame of a board, with the samples from a row on; returns the frame and the row after these samples.
pub(super) fn frame<T: Target>(
    session: &Session<T>,
    moment: FrameClock,
    samples: &Samples,
    next_row: u64,
) -> (Vec<u8>, u64) {
    let mut out = Vec::with_capacity(LATER_AXES + 4096);
    let flags = [moment.is_running, moment.is_past, session.has_ended()];
    let flags = flags.iter().rev().fold(0, |all, flag| all << 1 | u32::from(*flag));
    out.extend([VERSION, flags].iter().flat_map(|word| word.to_le_bytes()));
    let ticks = [session.tick(), moment.end].map(|tick| tick.get() as f64);
    out.extend(ticks.iter().chain(&moment.speed).flat_map(|number| number.to_le_bytes()));
    let counts_at = out.len();
    out.extend([0; 16]);
    let axes = session.target().axes();
    axes.iter().take(N_CHANNELS).for_each(|axis| write_axis(session, axis, &mut out));
    write_bits(session, &mut out);
    write_analog(session, &mut out);
    let data = PERSIST.field(Persist::USER_DATA);
    let words = (0..kmotiondef::limits::N_USER_DATA_VARS).map(|index| data.element(index).address());
    out.extend(words.flat_map(|address| word(session, address).to_le_bytes()));
    debug_assert_eq!(out.len(), LATER_AXES, "the table above");
    let later = axes.iter().skip(N_CHANNELS);
    let later_count = later.len() as u32;
    later.for_each(|axis| write_axis(session, axis, &mut out));
    let (rows, next) = samples.write(next_row, &mut out);
    let counts = [samples.generation, samples.names().len() as u32 + 1, rows, later_count];
    let counts: Vec<u8> = counts.iter().flat_map(|word| word.to_le_bytes()).collect();
    out.splice(counts_at..counts_at + counts.len(), counts);
    (out, next)
}

/// The address of a field of an axis.
fn place<T>(axis: AxisId, field: Field<T>) -> GuestAddr {
    chan(axis).field(field).address()
}

/// A double; NaN if it is unknown.
fn double<T: Target>(session: &Session<T>, address: GuestAddr) -> f64 {
    session.glance_at_object(address).map_or(f64::NAN, f64::from_bits)
}

/// A float; NaN if it is unknown.
fn float<T: Target>(session: &Session<T>, address: GuestAddr) -> f64 {
    session.glance_at_object(address).map_or(f64::NAN, |bits| f64::from(f32::from_bits(bits)))
}

/// A word; 0 if it is unknown.
fn word<T: Target>(session: &Session<T>, address: GuestAddr) -> u32 {
    session.glance_at_object(address).unwrap_or_default()
}

fn write_axis<T: Target>(session: &Session<T>, axis: AxisId, out: &mut Vec<u8>) {
    let load = Item::among(session.target().axes(), &format!("load{axis}"))
        .map_or(0.0, |item| session.target().value(item));
    let int = |field: Field<i32>| word(session, place(axis, field)).cast_signed();
    let numbers = [
        double(session, place(axis, Chan::DEST)),
        double(session, place(axis, Chan::POSITION)),
        load,
        float(session, place(axis, Chan::OUTPUT)),
        float(session, place(axis, Chan::LAST_VEL)),
        float(session, place(axis, Chan::SOFT_LIMIT_NEG)),
        float(session, place(axis, Chan::SOFT_LIMIT_POS)),
        float(session, place(axis, Chan::VEL)),
    ];
    out.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    let reached = u8::from(numbers[0] <= numbers[5]) | u8::from(numbers[0] >= numbers[6]) << 1;
    let modes = [int(Chan::INPUT_MODE), int(Chan::OUTPUT_MODE)].map(|mode| mode.clamp(0, 255) as u8);
    let enable = u8::from(int(Chan::ENABLE) != 0);
    out.extend([enable, modes[0], modes[1], reached, 0, 0, 0, 0]);
}

fn write_bits<T: Target>(session: &Session<T>, out: &mut Vec<u8>) {
    let from = out.len();
    out.resize(from + usize::from(Bit::MAX / 8) + 1, 0);
    for bit in Bit::all().filter(|bit| session.bit(*bit)) {
        if let Some(byte) = out.get_mut(from + bit.index() / 8) {
            *byte |= 1 << (bit.index() % 8);
        }
    }
    let directions = (0..usize::from(PINS / 32)).map(|word| BIT_DIR_SHADOW.element(word).address());
    out.extend(directions.flat_map(|word| self::word(session, word).to_le_bytes()));
}

fn write_analog<T: Target>(session: &Session<T>, out: &mut Vec<u8>) {
    // If an input has 16 bits, the bits above them are ignored here, too.
    let inputs =
        (0..8).map(|index| word(session, ADC_BUFFER_IN.element(index).address()).cast_signed() - 2048);
    let output = |index| session.glance_at_object::<u16>(DAC_BUFFER.element(index).address());
    let outputs = (0..8).map(|index| output(index).unwrap_or(2048) & 0xfff);
    let outputs = outputs.map(|word| i32::from(word) - 2048);
    out.extend(inputs.chain(outputs).flat_map(|number| (number as i16).to_le_bytes()));
}
