//! The status record, `MAIN_STATUS`, as the board sends it to the PC.
//!
//! Layout: gather-persist-console.md section 3, host-protocol.md section 5.

mod of_kogna;

use kmotiondef::boards::StructureLayout;
use kmotiondef::limits::{N_CHANNELS, N_DACS, N_PC_COMM_PERSIST, PC_COMM_PERSIST, TIMEBASE};
use kmotiondef::structs::{Chan, MainStatus, Persist};
use kmotiondef::variables::{
    ADC_BUFFER_IN_SNAP, BIT_DIR_SHADOW, BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1, CS0_STOPPING_STATE,
    DAC_BUFFER, EDIT_CHANGE_COUNT, HOST_STATUS, LAST_PWM, PERSIST, SERVO_TICK, STATUS_REQUEST_COUNTER,
    VIRTUAL_BITS, VIRTUAL_BITS_EX,
};
use kmotiondef::{Bit, Cycles, Field, Plain, Scalar, ThreadId};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use super::arguments::Values;
use super::session::{Answer, Session};
use crate::firmware::parts::Parts;
use crate::io::kanalog::conversion;
use crate::servo::hold;
use crate::views::TypedAccess;

/// Version of the record, and its words.
const VERSION_AND_SIZE: i32 = 308 << 16 | WORDS as i32;
/// Words of the record.
const WORDS: usize = 116;
/// Words on a line.
const WORDS_PER_LINE: usize = 16;
/// The converters' word for zero.
const ZERO: i32 = 2048;
/// The first input and the first output of a Kanalog.
const KAN_INPUTS: i32 = 128;
const KAN_OUTPUTS: i32 = 144;

/// The record being filled.
struct Record(Vec<u8>);

impl Record {
    fn set<T: Scalar>(&mut self, field: Field<T>, value: T::Value) {
        let start = field.offset() as usize;
        let bytes = value.into_bits().to_le_bytes();
        self.0[start..start + T::SIZE as usize].copy_from_slice(&bytes[..T::SIZE as usize]);
    }

    /// The bytes of a record of another version: the same fields where its layout has them.
    fn in_layout(&self, layout: &StructureLayout, version: i32) -> Vec<u8> {
        let mut bytes = vec![0; layout.size as usize];
        for field in MainStatus::STRUCTURE.fields {
            if let Some(there) = layout.fields.iter().find(|there| there.name == field.name) {
                let (from, to) = (field.offset as usize, there.offset as usize);
                let size = field.size.min(there.size) as usize;
                bytes[to..to + size].copy_from_slice(&self.0[from..from + size]);
            }
        }
        let first = (version << 16) | (layout.size as i32 / 4);
        bytes[..4].copy_from_slice(&first.to_le_bytes());
        bytes
    }
}

/// The record of this instant.
pub(crate) fn record(parts: &Parts, context: &TickContext<'_>) -> Vec<u8> {
    let memory = &*context.memory;
    let mut record = Record(vec![0; WORDS * 4]);
    record.set(MainStatus::VERSION_AND_SIZE, VERSION_AND_SIZE);
    analog(&mut record, context);
    axes(&mut record, context);
    let states = |first, count| bits(parts, memory, first, count);
    for index in 0..2 {
        record.set(MainStatus::BITS_STATE.element(index), states(32 * index as i32, 32));
        record.set(MainStatus::BITS_DIRECTION.element(index), memory.get(BIT_DIR_SHADOW.element(index)));
    }
    record.set(MainStatus::SNAP_BITS_DIRECTION0, memory.get(BIT_DIR_SHADOW_SNAP0));
    record.set(MainStatus::SNAP_BITS_DIRECTION1, memory.get(BIT_DIR_SHADOW_SNAP1));
    record.set(MainStatus::KANALOG_BITS_STATE_INPUTS, states(KAN_INPUTS, 16));
    record.set(MainStatus::KANALOG_BITS_STATE_OUTPUTS, states(KAN_OUTPUTS, 8));
    record.set(MainStatus::RUN_ON_START_UP, memory.get(PERSIST.field(Persist::RUN_ON_START_UP)));
    record.set(MainStatus::THREAD_ACTIVE, active_threads(context));
    record.set(MainStatus::STOP_IMMEDIATE_STATE, memory.get(CS0_STOPPING_STATE));
    record.set(MainStatus::TIME_STAMP, seconds(context));
    for index in 0..N_PC_COMM_PERSIST {
        let data = PERSIST.field(Persist::USER_DATA).element(PC_COMM_PERSIST + index);
        record.set(MainStatus::PC_COMM.element(index), memory.get(data));
    }
    record.set(MainStatus::VIRTUAL_BITS, memory.get(VIRTUAL_BITS));
    record.set(MainStatus::VIRTUAL_BITS_EX0, memory.get(VIRTUAL_BITS_EX.element(0)));
    match parts.level.status() {
        Some(layout) => {
            let bytes = record.in_layout(layout, parts.level.behaviour().status_version);
            match &parts.io.kogna {
                Some(kogna) => of_kogna::complete(bytes, layout, (parts, memory), kogna),
                None => bytes,
            }
        }
        None => record.0,
    }
}

/// Seconds since power-up.
fn seconds(context: &TickContext<'_>) -> f64 {
    let tick = context.memory.get(SERVO_TICK);
    let inside = context.now.get() - context.tick.get() as i64 * Cycles::PER_TICK.get();
    tick * TIMEBASE + inside.max(0) as f64 / Cycles::PER_SECOND.get() as f64
}

/// Analog inputs and outputs.
fn analog(record: &mut Record, context: &TickContext<'_>) {
    let memory = &*context.memory;
    for index in 0..8 {
        record.set(MainStatus::ADC.element(index), conversion(memory, index) - ZERO);
    }
    for index in 0..16 {
        record.set(MainStatus::ADC.element(8 + index), memory.get(ADC_BUFFER_IN_SNAP.element(index)));
        record.set(MainStatus::PWM.element(index), memory.get(LAST_PWM.element(index)));
    }
    for index in 0..N_DACS {
        let word = i32::from(memory.get(DAC_BUFFER.element(index)));
        record.set(MainStatus::DAC.element(index), word - ZERO);
    }
}

/// Adds the values of each axis to the record.
fn axes(record: &mut Record, context: &TickContext<'_>) {
    let memory = &*context.memory;
    let (mut enables, mut done) = (0, 0);
    let (mut inputs, mut outputs) = ([0; 2], [0; 2]);
    for axis in memory.axes().iter().take(N_CHANNELS) {
        let index = axis.index();
        record.set(MainStatus::POSITION.element(index), memory.axis(axis, Chan::POSITION));
        record.set(MainStatus::DEST.element(index), memory.axis(axis, Chan::DEST));
        record.set(MainStatus::OUTPUT_CHAN0.element(index), memory.axis(axis, Chan::OUTPUT_CHAN0) as u8);
        inputs[index / 4] |= (memory.axis(axis, Chan::INPUT_MODE) & 0xf) << (index % 4 * 4);
        outputs[index / 4] |= (memory.axis(axis, Chan::OUTPUT_MODE) & 0xf) << (index % 4 * 4);
        let is_enabled = memory.axis(axis, Chan::ENABLE) != 0;
        let is_done = is_enabled && memory.axis(axis, Chan::PCOEFF).is_null();
        enables |= i32::from(is_enabled) << index;
        done |= i32::from(is_done) << index;
    }
    record.set(MainStatus::INPUT_MODES, inputs[0]);
    record.set(MainStatus::INPUT_MODES2, inputs[1]);
    record.set(MainStatus::OUTPUT_MODES, outputs[0]);
    record.set(MainStatus::OUTPUT_MODES2, outputs[1]);
    record.set(MainStatus::ENABLES, enables);
    record.set(MainStatus::AXIS_DONE, done);
}

/// The levels of consecutive bits from a given one on.
fn bits(parts: &Parts, memory: &GuestMemory, first: i32, count: i32) -> i32 {
    let is_high = |offset: &i32| Bit::new(first + offset).is_some_and(|bit| parts.level(memory, bit));
    (0..count).filter(is_high).fold(0, |word, offset| word | 1 << offset)
}

/// Active threads; bit 0 is the board's own.
fn active_threads(context: &TickContext<'_>) -> i32 {
    let active = ThreadId::all().filter(|&thread| context.threads.state(thread).is_active());
    active.fold(1, |bits, thread| bits | 1 << thread.get())
}

/// Takes the PC's own status, and sends the record.
pub(super) fn get(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    for (index, place) in [HOST_STATUS, EDIT_CHANGE_COUNT].into_iter().enumerate() {
        if let Some(word) = values.optional_word(index) {
            session.memory().set(place, word.cast_signed());
        }
    }
    let polls = session.memory().get(STATUS_REQUEST_COUNTER).wrapping_add(1);
    session.memory().set(STATUS_REQUEST_COUNTER, polls);
    hold::update_state(session.memory());
    let record = record(session.parts, session.context);
    let words: Vec<String> = record
        .chunks(4)
        .map(|word| word.iter().rev().fold(String::new(), |text, byte| text + &format!("{byte:02X}")))
        .collect();
    Answer::Lines(words.chunks(WORDS_PER_LINE).map(|line| line.join(" ")).collect())
}
