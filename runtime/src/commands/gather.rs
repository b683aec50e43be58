//! The gather buffer over the link: words, recorded motions, injected noise.
//!
//! `GatherMove` and `GatherStep` record an axis while it goes away and comes back: it rests for 0.02 s, moves (or
//! jumps), and moves back halfway through the recording. `Inject` disturbs an axis with filtered noise and records the
//! response; the noise is the same in every run.

use std::f64::consts::TAU;

use kmotiondef::limits::{N_CPLX, TIMEBASE};
use kmotiondef::modes::GatherType;
use kmotiondef::structs::{Chan, Gather, GatherValueDef};
use kmotiondef::variables::{GATHER, GATHER_BUFFER};
use kmotiondef::{AxisId, GuestAddr, Place};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use super::arguments::Values;
use super::data::{Data, DataKind, GATHER_WORDS, WORDS_PER_LINE};
use super::memory::Experiment;
use super::session::{Answer, Session};
use crate::arithmetic::division::divide_singles;
use crate::firmware::gather;
use crate::firmware::parts::Parts;
use crate::servo::{Servo, moves};
use crate::views::{TypedAccess, chan};

/// Ticks before an experiment's motion: 0.02 s.
const REST: u64 = 222;
/// Doubles of a recorded sample, and how many of them are uploaded.
const RECORDED: u32 = 6;
/// Doubles of an injected sample: stimulus, position, destination, output.
const INJECTED: u32 = 4;
/// Numbers on a line of an upload.
const NUMBERS_PER_LINE: usize = 24;
/// Bytes of a double.
const DOUBLE: u32 = 8;

/// Begins the legs of an experiment that are due; the experiment is over after the last leg.
pub(crate) fn advance(running: &mut Option<Experiment>, parts: &mut Parts, context: &mut TickContext<'_>) {
    let Some(experiment) = running else { return };
    let Some(&due) = experiment.legs.get(experiment.done) else {
        *running = None;
        return;
    };
    if context.tick.get() >= due {
        let distance = if experiment.done == 0 { experiment.amount } else { -experiment.amount };
        go(&mut parts.servo, context, experiment.axis, distance, experiment.jumps);
        experiment.done += 1;
        parts.note_external_change();
    }
}

fn go(servo: &mut Servo, context: &mut TickContext<'_>, axis: AxisId, distance: f64, jumps: bool) {
    let dest = context.memory.axis(axis, Chan::DEST) + distance;
    if jumps {
        context.memory.set_axis(axis, Chan::DEST, dest);
        servo.jump(axis, dest);
    } else if let Some(limits) = moves::limits(context.memory, axis, None) {
        let planner = servo.planner;
        let limits = (&limits, limits.a);
        moves::start_move_to(
            context.memory,
            axis,
            dest,
            limits,
            kmotiondef::modes::LastMotion::Move,
            planner,
        );
    }
}

fn experiment(session: &mut Session<'_, '_>, values: &Values, jumps: bool) -> Answer {
    let (axis, amount, samples) = (values.axis(), values.real(1), values.integer(2));
    session.call(|parts, caller| {
        gather::setup_gather_all_on_axis(parts, caller, i32::from(axis.get()), samples);
        gather::trigger_gather(parts, caller);
    });
    let now = session.context.tick.get();
    let half = u64::from(samples.unsigned_abs()) / 2;
    let legs = [now + REST, now + half.max(REST)];
    *session.experiment = Some(Experiment { axis, amount, jumps, legs, done: 0 });
    Answer::Nothing
}

pub(super) fn gather_move(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    experiment(session, values, false)
}

pub(super) fn gather_step(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    experiment(session, values, true)
}

pub(super) fn check_done(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.call(gather::check_done_gather).into()
}

/// A double of the buffer.
fn double(memory: &GuestMemory, index: u32) -> f64 {
    memory.peek(memory.get(GATHER_BUFFER).offset(index * DOUBLE))
}

/// Numbers as the bits of singles, 24 on a line.
fn upload(numbers: impl Iterator<Item = f64>) -> Answer {
    let words: Vec<String> = numbers.map(|number| format!("{:08X}", (number as f32).to_bits())).collect();
    Answer::Lines(words.chunks(NUMBERS_PER_LINE).map(|line| line.join(" ")).collect())
}

/// Destination, position and output of each sample.
pub(super) fn get(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let memory = &*session.memory();
    let samples = 0..values.integer(0).unsigned_abs();
    upload(samples.flat_map(|sample| (0..3).map(move |item| double(memory, sample * RECORDED + item))))
}

/// A word of the buffer.
fn word(session: &mut Session<'_, '_>, values: &Values) -> Place<i32> {
    Place::new(session.memory().get(GATHER_BUFFER).offset(4 * values.integer(0).unsigned_abs()))
}

pub(super) fn get_decimal(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = word(session, values);
    session.memory().get(place).into()
}

/// A real is truncated toward zero and saturates.
pub(super) fn set_decimal(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = word(session, values);
    session.memory().set(place, values.real(1) as i32);
    Answer::Nothing
}

/// The number of requested words, from the first one on, that are inside the buffer.
fn available(values: &Values) -> usize {
    values.count(1).min(GATHER_WORDS as usize - values.count(0))
}

/// Words, eight per line; words after the end of the buffer are omitted.
pub(super) fn get_hex(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let start = word(session, values).address();
    let memory = &*session.memory();
    let words: Vec<String> = (0..available(values) as u32)
        .map(|index| format!("{:08X}", memory.peek::<u32>(start.offset(4 * index))))
        .collect();
    Answer::Lines(words.chunks(WORDS_PER_LINE).map(|line| line.join(" ")).collect())
}

pub(super) fn set_hex(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let start = word(session, values).address();
    Answer::Data(Data::new(DataKind::Gather, start, available(values)))
}

/// The PC's answer to a request for a line of a file.
pub(super) fn read_disk_data(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (status, count) = (values.integer(0), values.count(1));
    let data = Data::disk(session.memory(), count);
    if status == 1 && count > 0 {
        return Answer::Data(data);
    }
    if status == 1 {
        data.finish(&mut session.parts.pc.downloads, session.context);
    } else {
        session.memory().set(kmotiondef::variables::READ_DISK_BUFFER_STATUS, status);
    }
    Answer::Nothing
}

/// The largest number of `rand`.
const RAND_MAX: f32 = 32_767.0;

/// Fills the buffer with noise below a frequency, and makes the servo add it to an axis and record. The noise is that
/// of `rand` through a first-order low-pass filter, as measured.
pub(super) fn inject(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (chan, cutoff, amplitude) = (chan(values.axis()), values.real(1), values.real(2));
    let start = session.memory().get(GATHER_BUFFER);
    let turn = TAU * cutoff * TIMEBASE;
    let kept = (2.0 - turn) / (2.0 + turn);
    let mut level = 0.0;
    for sample in 0..N_CPLX as u32 {
        let random = divide_singles(session.parts.calls.random() as f32, RAND_MAX) - 0.5;
        level = kept * level + (1.0 - kept) * f64::from(random) * amplitude;
        session.memory().poke(start.offset(sample * INJECTED * DOUBLE), level);
    }
    let memory = session.memory();
    let items = [
        (GatherType::Double, memory.locate(chan.field(Chan::DEST_OFFSET))),
        (GatherType::Double, memory.locate(chan.field(Chan::POSITION))),
        (GatherType::Double, memory.locate(chan.field(Chan::DEST))),
        (GatherType::Float, memory.locate(chan.field(Chan::OUTPUT))),
        (GatherType::End, GuestAddr::NULL),
    ];
    for (index, (kind, address)) in items.into_iter().enumerate() {
        let item = GATHER.field(Gather::LIST.element(index));
        memory.set(item.field(GatherValueDef::TYPE), kind.get());
        memory.set(item.field(GatherValueDef::ADDR), address);
    }
    memory.set(GATHER.field(Gather::INJECT), 1);
    memory.set(GATHER.field(Gather::ENDPTR), start.offset(N_CPLX as u32 * INJECTED * DOUBLE));
    memory.set(GATHER.field(Gather::BUFPTR), start);
    Answer::Nothing
}

/// Stimulus, position less destination, and output of each injected sample.
pub(super) fn get_inject(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    let memory = &*session.memory();
    let sample = |sample: u32| {
        let item = |index: u32| double(memory, sample * INJECTED + index);
        [item(0), item(1) - item(2), item(3)]
    };
    upload((0..N_CPLX as u32).flat_map(sample))
}
