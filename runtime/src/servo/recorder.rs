//! The data recorder: one sample a tick. Source: gather-persist-console.md section 1.

use kmotiondef::GuestAddr;
use kmotiondef::limits::{MAX_GATHER_DATA, MAX_GATHER_VALUES};
use kmotiondef::modes::GatherType;
use kmotiondef::structs::{Gather, GatherValueDef};
use kmotiondef::variables::{GATHER, GATHER_BUFFER};
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// Returns whether samples are being taken.
pub(crate) fn is_recording(memory: &GuestMemory) -> bool {
    memory.get(GATHER.field(Gather::BUFPTR)) < end(memory)
}

/// Returns whether a recording also writes outside its buffer.
fn writes_outside_buffer(memory: &GuestMemory) -> bool {
    memory.get(GATHER.field(Gather::INJECT)) != 0
}

/// Returns the end of the recording: at most the end of the buffer, if it records there.
fn end(memory: &GuestMemory) -> GuestAddr {
    let limit = memory.get(GATHER_BUFFER).offset(8 * MAX_GATHER_DATA as u32);
    memory.get(GATHER.field(Gather::ENDPTR)).min(limit)
}

/// Takes one sample if recording is on; returns whether it was.
pub(crate) fn sample(memory: &mut GuestMemory) -> bool {
    if !is_recording(memory) {
        return false;
    }
    let mut place = memory.get(GATHER.field(Gather::BUFPTR));
    let mut first = 0;
    if writes_outside_buffer(memory) {
        let target = memory.get(GATHER.field(Gather::LIST.element(0).field(GatherValueDef::ADDR)));
        let stimulus: f64 = memory.peek(place);
        memory.poke(target, stimulus);
        // The stimulus keeps its position in the record.
        place = place.offset(8);
        first = 1;
    }
    for index in first..MAX_GATHER_VALUES {
        let item = GATHER.field(Gather::LIST.element(index));
        let kind = memory.get(item.field(GatherValueDef::TYPE));
        let address = memory.get(item.field(GatherValueDef::ADDR));
        let Some(value) = GatherType::new(kind).and_then(|kind| value(memory, kind, address)) else { break };
        memory.poke(place, value);
        place = place.offset(8);
    }
    memory.untouched(|memory| memory.set(GATHER.field(Gather::BUFPTR), place));
    if writes_outside_buffer(memory) && !is_recording(memory) {
        let target = memory.get(GATHER.field(Gather::LIST.element(0).field(GatherValueDef::ADDR)));
        memory.poke(target, 0.0_f64);
    }
    true
}

/// One quantity as a double; `None` ends the list.
fn value(memory: &GuestMemory, kind: GatherType, address: GuestAddr) -> Option<f64> {
    Some(match kind {
        GatherType::End => return None,
        GatherType::Int => f64::from(memory.peek::<i32>(address)),
        GatherType::LastPwm => f64::from(memory.peek::<i32>(address).wrapping_sub(1280)),
        GatherType::LastPwmC => f64::from(memory.peek::<i32>(address).wrapping_sub(41_984)),
        GatherType::Float => f64::from(memory.peek::<f32>(address)),
        GatherType::Double => memory.peek::<f64>(address),
        GatherType::Adc => f64::from(memory.peek::<u32>(address) >> 20) - 2048.0,
        GatherType::Null => 0.0,
    })
}
