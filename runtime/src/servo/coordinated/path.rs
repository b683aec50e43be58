//! One tick of the path.

use kmotiondef::GuestAddr;
use kmotiondef::limits::MAX_SEGMENTS;
use kmotiondef::variables::{
    COORD_SYSTEM0, CS0_DOING_RAPID, CS0_HOLD_AT_END, CS0_STOPPING_STATE, CS0_T, CS0_TIME_BASE,
    CS0_TIME_EXECUTED, LAST_COORD_SYSTEM0, LAST_VALID_TRAJ_SEGMENT,
};
use vm::memory::GuestMemory;

use super::feedhold::HoldState;
use super::segment::{Command, Entry, Kind};
use super::smoothing::{self, Spline};
use super::{Bits, CoordinatedMotion, buffer, rate};
use crate::servo::spindle;
use crate::views::TypedAccess;

/// The time before its end at which a path that must not end yet is held, in seconds.
const HELD_SHORT: f64 = 1e-6;

/// The position on the path after its commands have been executed.
#[derive(Clone, Copy, Debug)]
enum Halt {
    /// In a segment.
    Segment(Entry),
    /// At a command that waits.
    Wait(Entry),
    /// At the end.
    End(Entry),
}

impl CoordinatedMotion {
    /// Returns whether there is no path.
    #[inline]
    pub(crate) fn is_idle(&self, memory: &GuestMemory) -> bool {
        self.spline.is_none() && memory.get(COORD_SYSTEM0).is_null()
    }

    /// Moves the axes of the path by one tick. Says whether the path has moved or will.
    pub(crate) fn tick(&mut self, memory: &mut GuestMemory, bits: &mut impl Bits) -> bool {
        let before = clock(memory);
        self.step(memory, bits);
        self.spline.is_some() || before != clock(memory)
    }

    fn step(&mut self, memory: &mut GuestMemory, bits: &mut impl Bits) {
        let current = memory.get(COORD_SYSTEM0);
        self.spline.take_if(|spline| !spline.ends_at(current));
        if current.is_null() {
            return;
        }
        if self.spline.is_some() {
            return self.follow_spline(memory);
        }
        match pass_commands(memory, bits, Entry::at(current)) {
            Halt::Segment(entry) => self.advance(memory, bits, entry),
            Halt::Wait(entry) => wait(memory, entry),
            Halt::End(entry) if is_held_open(memory) => wait(memory, entry),
            Halt::End(entry) => self.end(memory, entry),
        }
    }

    /// Advances the path time and moves the axes to it.
    fn advance(&mut self, memory: &mut GuestMemory, bits: &mut impl Bits, entry: Entry) {
        let time_base = memory.get(CS0_TIME_BASE);
        memory.set(CS0_T, memory.get(CS0_T) + time_base);
        run_clock(memory);
        if time_base < 0.0 {
            let entry = go_back(memory, entry);
            return evaluate(memory, entry);
        }
        match go_on(memory, bits, entry) {
            Halt::Segment(entry) => evaluate(memory, entry),
            Halt::Wait(entry) => memory.set(COORD_SYSTEM0, entry.address()),
            Halt::End(entry) => self.end(memory, entry),
        }
    }

    /// Ends the path at its end entry, unless it is held open. The axes stay at their positions of the last tick.
    fn end(&mut self, memory: &mut GuestMemory, entry: Entry) {
        memory.set(COORD_SYSTEM0, entry.address());
        if !is_held_open(memory) {
            self.spline = Spline::plan(memory, entry.address());
            self.follow_spline(memory);
        }
    }

    /// One tick of the last, smoothed segment, if there is one; after it the path is done.
    fn follow_spline(&mut self, memory: &mut GuestMemory) {
        self.spline.take_if(|spline| !spline.step(memory));
        if self.spline.is_none() {
            memory.set(LAST_COORD_SYSTEM0, memory.get(COORD_SYSTEM0));
            abort(memory);
        }
    }
}

/// Returns whether a path is executing and not held.
pub(crate) fn is_under_way(memory: &GuestMemory) -> bool {
    !memory.get(COORD_SYSTEM0).is_null() && HoldState::of(memory) != HoldState::PathStopped
}

/// Returns the values that change from tick to tick while a path is executing.
fn clock(memory: &GuestMemory) -> (GuestAddr, [f64; 3], i32) {
    let times = [CS0_T, CS0_TIME_EXECUTED, CS0_TIME_BASE].map(|time| memory.get(time));
    (memory.get(COORD_SYSTEM0), times, memory.get(CS0_STOPPING_STATE))
}

/// Drops the path immediately; its times and its axes are unchanged.
pub(crate) fn abort(memory: &mut GuestMemory) {
    memory.set(COORD_SYSTEM0, GuestAddr::NULL);
}

/// Drops the path immediately, together with the segments for `ExecBuf`: nothing runs until the buffer is opened again.
pub(crate) fn drop_all(memory: &mut GuestMemory) {
    abort(memory);
    memory.set(LAST_COORD_SYSTEM0, GuestAddr::NULL);
}

/// Moves the time base towards the override, unless the spindle drives the path.
fn run_clock(memory: &mut GuestMemory) {
    if !spindle::is_threading(memory) {
        rate::ramp(memory);
    }
}

/// Returns whether the path waits at its end for more data.
fn is_held_open(memory: &GuestMemory) -> bool {
    memory.get(CS0_HOLD_AT_END) != 0
}

/// Waits at a command or at a held end. Only backwards does the path time continue, into the previous segment. A path
/// that has not moved yet keeps its time base.
fn wait(memory: &mut GuestMemory, entry: Entry) {
    memory.set(COORD_SYSTEM0, entry.address());
    let time_base = memory.get(CS0_TIME_BASE);
    if memory.get(CS0_TIME_EXECUTED) + memory.get(CS0_T) > 0.0 {
        run_clock(memory);
    }
    if time_base < 0.0 {
        memory.set(CS0_T, memory.get(CS0_T) + time_base);
        let entry = go_back(memory, entry);
        evaluate(memory, entry);
    }
}

/// Executes the commands from an entry on, up to one that waits.
fn pass_commands(memory: &mut GuestMemory, bits: &mut impl Bits, mut entry: Entry) -> Halt {
    for _ in 0..MAX_SEGMENTS {
        match entry.kind(memory) {
            Kind::Off => return Halt::End(entry),
            Kind::Segment(_) => return Halt::Segment(entry),
            Kind::Command(Command::Wait(bit, high)) if bits.is_high(memory, bit) != high => {
                return Halt::Wait(entry);
            }
            Kind::Command(Command::Drive(bit, high)) => bits.drive(memory, bit, high),
            Kind::Command(Command::Rapid(begins)) => rate::set_doing_rapid(memory, begins),
            Kind::Command(Command::Wait(..) | Command::Nothing) => {}
        }
        entry = buffer::after(memory, entry);
    }
    // A ring that contains only commands: the next tick continues.
    Halt::Wait(entry)
}

/// Enters the segments that the path time has reached, with the commands between them.
fn go_on(memory: &mut GuestMemory, bits: &mut impl Bits, mut entry: Entry) -> Halt {
    for _ in 0..MAX_SEGMENTS {
        let (t, duration) = (memory.get(CS0_T), entry.duration(memory));
        // A NaN duration never passes.
        if t.partial_cmp(&duration).is_none_or(std::cmp::Ordering::is_lt) {
            break;
        }
        let next = buffer::after(memory, entry);
        if is_held_open(memory) && next.kind(memory) == Kind::Off {
            memory.set(CS0_T, f64::max(duration - HELD_SHORT, 0.0));
            break;
        }
        memory.set(CS0_TIME_EXECUTED, memory.get(CS0_TIME_EXECUTED) + duration);
        memory.set(CS0_T, t - duration);
        memory.set(LAST_VALID_TRAJ_SEGMENT, entry.address());
        match pass_commands(memory, bits, next) {
            Halt::Segment(segment) => entry = segment,
            halt => return halt,
        }
    }
    Halt::Segment(entry)
}

/// Goes back over the segments that the path time has left. The axes stop abruptly at the beginning of the first one,
/// where the time base is unchanged.
fn go_back(memory: &mut GuestMemory, mut entry: Entry) -> Entry {
    for _ in 0..MAX_SEGMENTS {
        let t = memory.get(CS0_T);
        if t >= 0.0 {
            break;
        }
        let Some(previous) = stretch_before(memory, entry) else {
            memory.set(CS0_T, 0.0);
            break;
        };
        entry = previous;
        let duration = entry.duration(memory);
        memory.set(CS0_TIME_EXECUTED, memory.get(CS0_TIME_EXECUTED) - duration);
        memory.set(CS0_T, t + duration);
    }
    entry
}

/// The segment before an entry. Of the commands between them only rapids are undone.
fn stretch_before(memory: &mut GuestMemory, mut entry: Entry) -> Option<Entry> {
    let mut rapid = None;
    for _ in 0..MAX_SEGMENTS {
        entry = buffer::previous_entry(memory, entry)?;
        match entry.kind(memory) {
            Kind::Off => return None,
            Kind::Segment(_) => {
                if let Some(doing) = rapid {
                    memory.set(CS0_DOING_RAPID, i32::from(doing));
                }
                return Some(entry);
            }
            Kind::Command(Command::Rapid(begins)) => rapid = Some(!begins),
            Kind::Command(_) => {}
        }
    }
    None
}

/// Puts the axes of a segment where they are at the path time; any other entry moves none.
fn evaluate(memory: &mut GuestMemory, entry: Entry) {
    memory.set(COORD_SYSTEM0, entry.address());
    for (axis, position) in entry.positions(memory, memory.get(CS0_T)).into_iter().flatten() {
        smoothing::move_to(memory, axis, position);
    }
}
