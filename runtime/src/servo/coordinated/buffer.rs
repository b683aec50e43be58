//! The buffer of entries: filling, opening, executing.
//!
//! The buffer is a ring of [`MAX_SEGMENTS`] entries. The entry after the last valid one always ends the path.

use kmotiondef::limits::{MAX_SEGMENTS, TIMEBASE};
use kmotiondef::variables::{
    COORD_SYSTEM0, CS0_DOING_RAPID, CS0_FLUSHED, CS0_T, CS0_TIME_DOWNLOADED, CS0_TIME_EXECUTED,
    CS0_TIME_LOST, KLP, LAST_COORD_SYSTEM0, LAST_VALID_TRAJ_SEGMENT, PARAMETRIC_COEFFS,
    PARAMETRIC_COEFFS_END, PARAMETRIC_INDEX, PARAMETRIC_INDEX_WRAPPED, TAU_KLP,
};
use vm::memory::GuestMemory;

use super::segment::{Entry, Kind, SIZE};
use super::{rate, system};
use crate::arithmetic::division::divide;
use crate::arithmetic::doubles::log;
use crate::out::Message;
use crate::views::TypedAccess;

/// The result of `ExecTime` instead of a time of 0 when nothing is executing.
const IDLE: f64 = -0.001;

/// The entry of an index, which may be any number that a program has stored.
fn entry(memory: &GuestMemory, index: i32) -> Entry {
    Entry::at(memory.get(PARAMETRIC_COEFFS).offset((index as u32).wrapping_mul(SIZE)))
}

/// The entry that is written next.
pub(crate) fn next_written(memory: &GuestMemory) -> Entry {
    entry(memory, memory.get(PARAMETRIC_INDEX))
}

/// The entry after another.
pub(crate) fn after(memory: &GuestMemory, entry: Entry) -> Entry {
    let next = entry.address().offset(SIZE);
    Entry::at(if next == memory.get(PARAMETRIC_COEFFS_END) { memory.get(PARAMETRIC_COEFFS) } else { next })
}

/// The entry before another; `None` at the beginning of the buffer and outside it.
pub(crate) fn previous_entry(memory: &GuestMemory, entry: Entry) -> Option<Entry> {
    let (start, end) = (memory.get(PARAMETRIC_COEFFS), memory.get(PARAMETRIC_COEFFS_END));
    let address = entry.address();
    if address <= start || address >= end {
        let wraps = address == start && memory.get(PARAMETRIC_INDEX_WRAPPED) != 0;
        return wraps.then(|| Entry::at(end.offset(SIZE.wrapping_neg())));
    }
    Some(Entry::at(address.offset(SIZE.wrapping_neg())))
}

/// Empties the buffer; a path in progress is dropped. Its time stays for the next execution to set.
pub(crate) fn open(memory: &mut GuestMemory) {
    memory.set(PARAMETRIC_INDEX, 0);
    memory.set(PARAMETRIC_INDEX_WRAPPED, 0);
    for time in [CS0_TIME_DOWNLOADED, CS0_TIME_LOST, CS0_TIME_EXECUTED] {
        memory.set(time, 0.0);
    }
    memory.set(CS0_DOING_RAPID, 0);
    let start = memory.get(PARAMETRIC_COEFFS);
    Entry::at(start).end_path(memory);
    for entry in [COORD_SYSTEM0, LAST_VALID_TRAJ_SEGMENT] {
        memory.set(entry, kmotiondef::GuestAddr::NULL);
    }
    memory.set(LAST_COORD_SYSTEM0, start);
}

/// Adds the entry at the index, which has just been filled, to the path.
///
/// # Errors
/// The path being executed has been overwritten.
pub(crate) fn advance(memory: &mut GuestMemory) -> Result<(), Message> {
    let filled = next_written(memory);
    add(memory, CS0_TIME_DOWNLOADED, filled.duration(memory));
    let mut index = memory.get(PARAMETRIC_INDEX).wrapping_add(1);
    if !(0..MAX_SEGMENTS as i32).contains(&index) {
        index = 0;
        memory.set(PARAMETRIC_INDEX_WRAPPED, 1);
    }
    memory.set(PARAMETRIC_INDEX, index);
    let next = next_written(memory);
    if memory.get(PARAMETRIC_INDEX_WRAPPED) != 0 {
        add(memory, CS0_TIME_LOST, next.duration(memory));
    }
    next.end_path(memory);
    if next.address() == memory.get(COORD_SYSTEM0) {
        return Err(Message::PathOverwritten {});
    }
    Ok(())
}

fn add(memory: &mut GuestMemory, time: kmotiondef::Place<f64>, seconds: f64) {
    memory.set(time, memory.get(time) + seconds);
}

/// Executes the segments of the buffer that were not executed before; a path being executed begins again.
pub(crate) fn execute(memory: &mut GuestMemory) {
    let klp = memory.get(KLP);
    memory.set(TAU_KLP, if klp > 0.0 { divide(-TIMEBASE, log(klp)) as f32 } else { 0.0 });
    memory.set(CS0_FLUSHED, 0);
    memory.set(CS0_T, 0.0);
    rate::start(memory, system::nominal_change_time(memory));
    let start = memory.get(LAST_COORD_SYSTEM0);
    if Entry::at(start).kind(memory) != Kind::Off {
        memory.set(COORD_SYSTEM0, start);
    }
}

/// Says that the path is complete: running out of entries is its end.
pub(crate) fn flush(memory: &mut GuestMemory) {
    memory.set(CS0_FLUSHED, 1);
}

/// Seconds of path done; negative when no path is executing.
pub(crate) fn executed_time(memory: &GuestMemory) -> f64 {
    let time = memory.get(CS0_TIME_EXECUTED) + memory.get(CS0_T);
    if !memory.get(COORD_SYSTEM0).is_null() {
        time
    } else if time == 0.0 {
        IDLE
    } else {
        -time
    }
}

/// Returns the result of `CheckDoneBuf`: 1 done, 0 executing, -1 an axis of the coordinate system is disabled.
pub(crate) fn check_done(memory: &GuestMemory) -> i32 {
    if system::is_disabled(memory) { -1 } else { i32::from(memory.get(COORD_SYSTEM0).is_null()) }
}

#[cfg(test)]
mod tests {
    use kmotiondef::modes::TrajectoryMode;
    use kmotiondef::structs::ParametricCoeff;

    use super::*;
    use crate::testing::powered_memory;

    fn board() -> GuestMemory {
        let mut memory = powered_memory();
        open(&mut memory);
        memory
    }

    /// Adds a line that takes so long.
    fn add_line(memory: &mut GuestMemory, seconds: f64) -> Result<(), Message> {
        let entry = next_written(memory);
        memory.set(entry.field(ParametricCoeff::TRAJECTORY_MODE), TrajectoryMode::Linear.get() as i8);
        memory.set(entry.field(ParametricCoeff::T), seconds);
        advance(memory)
    }

    #[test]
    fn the_ring_counts_what_it_overwrites() {
        let mut memory = board();
        for _ in 0..MAX_SEGMENTS - 1 {
            add_line(&mut memory, 0.5).expect("room");
        }
        assert_eq!(memory.get(PARAMETRIC_INDEX), 34_999);
        assert_eq!((memory.get(PARAMETRIC_INDEX_WRAPPED), memory.get(CS0_TIME_LOST)), (0, 0.0));
        add_line(&mut memory, 0.5).expect("room");
        assert_eq!(memory.get(PARAMETRIC_INDEX), 0);
        assert_eq!((memory.get(PARAMETRIC_INDEX_WRAPPED), memory.get(CS0_TIME_LOST)), (1, 0.5));
        assert_eq!(memory.get(CS0_TIME_DOWNLOADED), 17_500.0);
    }

    #[test]
    fn overwriting_the_executing_segment_is_reported() {
        let mut memory = board();
        add_line(&mut memory, 0.5).expect("room");
        execute(&mut memory);
        for _ in 0..MAX_SEGMENTS - 2 {
            add_line(&mut memory, 0.5).expect("room");
        }
        assert!(add_line(&mut memory, 0.5).is_err());
    }

    #[test]
    fn neighbours_wrap_with_the_ring() {
        let mut memory = board();
        let (first, last) = (entry(&memory, 0), entry(&memory, MAX_SEGMENTS as i32 - 1));
        assert_eq!(after(&memory, last).address(), first.address());
        assert!(previous_entry(&memory, first).is_none());
        memory.set(PARAMETRIC_INDEX_WRAPPED, 1);
        assert_eq!(previous_entry(&memory, first).map(Entry::address), Some(last.address()));
        assert!(previous_entry(&memory, Entry::at(kmotiondef::GuestAddr::new(0x8005_0000))).is_none());
    }

    #[test]
    fn time_executed_is_negative_when_nothing_runs() {
        let mut memory = board();
        assert_eq!(executed_time(&memory), -0.001);
        memory.set(CS0_TIME_EXECUTED, 1.5);
        assert_eq!(executed_time(&memory), -1.5);
        memory.set(COORD_SYSTEM0, memory.get(PARAMETRIC_COEFFS));
        assert_eq!(executed_time(&memory), 1.5);
    }
}
