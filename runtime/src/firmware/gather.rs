//! The data recorder's functions. Source: gather-persist-console.md section 1.

use kmotiondef::GuestAddr;
use kmotiondef::firmware::Function;
use kmotiondef::limits::MAX_GATHER_DATA;
use kmotiondef::modes::GatherType;
use kmotiondef::structs::{Chan, Gather, GatherValueDef};
use kmotiondef::variables::{GATHER, GATHER_BUFFER};
use vm::firmware::Caller;

use super::parts::Parts;
use crate::out::Message;
use crate::views::{TypedAccess, chan};

/// An address beyond any end: recording is idle.
const IDLE: GuestAddr = GuestAddr::new(0xFFFF_FFFC);
/// Bytes of a sample of six doubles.
const SAMPLE: u32 = 48;
/// Samples of six doubles in the buffer.
const MOST: usize = MAX_GATHER_DATA / 6;

/// Records destination, position, output and three amplifier readings of an axis.
pub(crate) fn setup_gather_all_on_axis(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32, samples: i32) {
    let Some(axis) = caller.memory.axes().get(axis) else {
        parts.out.diagnose(caller, Message::NoSuchAxis { function: Function::SetupGatherAllOnAxis, axis });
        return;
    };
    let chan = chan(axis);
    let items = [
        (GatherType::Double, caller.memory.locate(chan.field(Chan::DEST))),
        (GatherType::Double, caller.memory.locate(chan.field(Chan::POSITION))),
        (GatherType::Float, caller.memory.locate(chan.field(Chan::OUTPUT))),
        // The amplifier's analog words: a board without an amplifier reads zeros.
        (GatherType::Adc, GuestAddr::NULL),
        (GatherType::Null, GuestAddr::NULL),
        (GatherType::Null, GuestAddr::NULL),
        (GatherType::End, GuestAddr::NULL),
    ];
    for (index, (kind, address)) in items.into_iter().enumerate() {
        let item = GATHER.field(Gather::LIST.element(index));
        caller.memory.set(item.field(GatherValueDef::TYPE), kind.get());
        caller.memory.set(item.field(GatherValueDef::ADDR), address);
    }
    if usize::try_from(samples).is_ok_and(|count| count > MOST) {
        parts.out.diagnose(caller, Message::RecordingTooLong { samples, most: MOST });
    }
    let length = SAMPLE.wrapping_mul(samples.max(0) as u32);
    let end = caller.memory.get(GATHER_BUFFER).offset(length);
    caller.memory.set(GATHER.field(Gather::BUFPTR), IDLE);
    caller.memory.set(GATHER.field(Gather::ENDPTR), end);
    caller.memory.set(GATHER.field(Gather::INJECT), 0);
}

/// Starts recording at the beginning of the buffer.
pub(crate) fn trigger_gather(_: &mut Parts, caller: &mut Caller<'_>) {
    let start = caller.memory.get(GATHER_BUFFER);
    caller.memory.set(GATHER.field(Gather::BUFPTR), start);
}

/// 1 when recording has reached its end.
pub(crate) fn check_done_gather(parts: &mut Parts, caller: &mut Caller<'_>) -> i32 {
    let memory = &*caller.memory;
    // The PC may request it at any time.
    if caller.thread.is_some() && memory.get(GATHER.field(Gather::BUFPTR)) == IDLE {
        parts.out.diagnose(caller, Message::NotRecording {});
    }
    i32::from(memory.get(GATHER.field(Gather::BUFPTR)) >= memory.get(GATHER.field(Gather::ENDPTR)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn an_axis_is_recorded_in_six_doubles_a_tick() {
        // `checks.jsonl`, "SetupGatherAllOnAxis(0,100)": 600 doubles.
        let mut bench = TestBench::new();
        assert_eq!(bench.call_i32("CheckDoneGather", &[]), 1);
        bench.call("EnableAxisDest", &[0, 2.5_f64.to_bits()]);
        bench.call("SetupGatherAllOnAxis", &[0, 100]);
        bench.call("TriggerGather", &[]);
        assert_eq!(bench.call_i32("CheckDoneGather", &[]), 0);
        bench.run(100);
        assert_eq!(bench.call_i32("CheckDoneGather", &[]), 1);
        let buffer = bench.memory.get(GATHER_BUFFER);
        let sample: Vec<f64> = (0..6).map(|index| bench.memory.peek(buffer.offset(8 * index))).collect();
        assert_eq!(sample, [2.5, 0.0, 2.5, -2048.0, 0.0, 0.0]);
        let end = bench.memory.get(GATHER.field(Gather::BUFPTR)).get();
        assert_eq!(end - buffer.get(), 4800);
    }
}
