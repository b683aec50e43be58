//! Threads that start, pause and resume one another, wait, count and lock.

use super::ScenarioWriter;
use crate::cli::commands::compare::random::scenario::PartKind;

/// A slice in which a thread holds a lock on a variable that nothing else stores to.
const LOCKED: &str =
    "MutexLock(&persist.UserData[18]); WaitNextTimeSlice(); MutexUnlock(&persist.UserData[18]);";

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    let count = 1 + writer.draw.below(3);
    for thread in 2..2 + count as u8 {
        let mut slice = 0;
        for _ in 0..1 + writer.draw.below(5) {
            slice += writer.draw.below(12);
            let text = statement(writer, u32::from(thread), count);
            writer.part(PartKind::Slice { thread, slice }, text);
        }
        let counts = format!("persist.UserData[{}]++;", 10 + thread);
        writer.part(PartKind::Slice { thread, slice: 1 + slice }, counts);
        writer.add_later(1, 8, format!("StartThread({thread});"));
    }
    for _ in 0..1 + writer.draw.below(6) {
        let text = statement(writer, 1, count);
        writer.add_later(1, 12, text);
    }
    let more = 10 + writer.draw.below(30);
    let data = (10..20).map(|index| format!("persist.UserData[{index}]"));
    writer.observe_slices(more, ["ServoTick-T0_".to_owned()].into_iter().chain(data).collect::<Vec<_>>());
}

fn statement(writer: &mut ScenarioWriter, own: u32, count: u32) -> String {
    let draw = &mut writer.draw;
    let other = 2 + draw.below(count);
    let cell = 10 + draw.below(8);
    match draw.below(16) {
        // A thread that never ran must not be resumed: that stops the board.
        0 | 1 if own == 1 => format!("PauseThread({other});"),
        2 | 3 if own == 1 => format!("StartThread({other});"),
        4 => format!("PauseThread({other});"),
        5 => format!("if(persist.UserData[10+{other}]) persist.UserData[{cell}]=ResumeThread({other});"),
        6 => format!("Delay_sec({:?});", draw.magnitude(1e-5, 0.003)),
        7 => format!("WaitUntil(Time_sec()+{:?});", draw.real(-0.0005, 0.003)),
        8 => format!("persist.UserData[{cell}]=TestAndSet(&persist.UserData[19],{});", draw.below(9)),
        9 => LOCKED.to_owned(),
        10 => format!("printf(\"{own} %d\\n\",n);"),
        11 => format!("AtomicSet(&persist.UserData[{cell}],{});", draw.below(1024)),
        12 => format!("AtomicClear(&persist.UserData[{cell}],{});", draw.below(1024)),
        13 => "WaitNextTimeSlice();".to_owned(),
        14 if own != 1 => "ThreadDone();".to_owned(),
        _ => format!("persist.UserData[{cell}]+={};", draw.integer(-9, 9)),
    }
}
