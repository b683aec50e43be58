//! The state of the board when a run is over: the event for which each thread waits, the activity of each axis and the
//! reason why it does not move.
//!
//! It contains only facts; reports put them into words.

use std::fmt;

use kmotiondef::bits::{BitDirection, BitKind};
use kmotiondef::function::PolledState;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::{COORD_SYSTEM0, CS0_STOPPING_STATE};
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId};
use vm::engine::Engine;
use vm::memory::GuestMemory;
use vm::thread::{Progress, ThreadState};
use vm::wake::Wake;

use super::Board;
use crate::firmware::calls::RepeatedCall;
use crate::io::bits::{bit_state, range_of};
use crate::servo::coordinated::{rate, system};
use crate::servo::independent::{has_motion, state};
use crate::servo::profile::Mode;
use crate::views::TypedAccess;

/// A thread that has not ended.
#[derive(Clone, Debug, PartialEq)]
pub struct UnfinishedThread {
    /// Its number.
    pub thread: ThreadId,
    /// Its state.
    pub state: ThreadActivity,
    /// The current instruction, then the calls that led to it, innermost first.
    pub calls: Vec<CodeAddr>,
    /// The last time at which it did anything other than poll and wait.
    pub since: Cycles,
    /// The values that it has polled since.
    pub awaited: Vec<AwaitedState>,
}

/// The state of a thread that has not ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThreadActivity {
    /// It computes.
    Computing,
    /// It waits for an instant.
    Until(Cycles),
    /// It waits for its next slice.
    Slice,
    /// It waits in a call that only the board can end: of this function, as long as the words say.
    Call(&'static str, &'static str),
    /// Another thread has paused it, or it has paused itself.
    Paused,
    /// It was resumed without ever having been started, and does nothing.
    Idle,
}

/// A state that a thread polls while it waits.
#[derive(Clone, Debug, PartialEq)]
pub enum AwaitedState {
    /// The level of a bit.
    Bit(Bit, bool, Source),
    /// The end of the motion of an axis, with the result of `CheckDone`.
    Motion(AxisId, i32),
    /// The end of a path.
    Path,
    /// The end of a recording.
    Recording,
    /// A lock.
    Lock(Option<Owner>),
}

/// The thread that has a lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Owner {
    /// Its number.
    pub thread: ThreadId,
    /// The reason for which it does not free the lock.
    pub state: OwnerState,
    /// The call that took it, if that is known.
    pub at: Option<CodeAddr>,
}

/// The state of a thread that has a lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OwnerState {
    /// It runs.
    Active,
    /// It is paused.
    Paused,
    /// Its program has ended.
    Ended,
}

/// The origin of a bit's level.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Nothing drives the input.
    Nothing,
    /// A switch, a probe or an index of an axis: its position, its level when closed, and the position of the axis.
    Contact(AxisId, String, bool, f64),
    /// Another source drives the input: a wire, a device, the stimulus; with the beginning and end of its last pulse,
    /// if that came before the wait.
    Outside(Option<(Cycles, Cycles)>),
    /// The program itself: it is an output.
    Output,
    /// Any program: the bit is memory.
    Memory,
    /// A KStep, whose inputs are read only once `KStepPresent` is set.
    NoKstep,
}

/// An axis that programs have used.
#[derive(Clone, Debug, PartialEq)]
pub struct UsedAxis {
    /// Its number.
    pub axis: AxisId,
    /// Its name in the machine file; empty if it has none.
    pub name: String,
    /// Its unit in the machine file; empty if it has none.
    pub units: String,
    /// True if its position is measured: its `InputMode` is not `NO_INPUT_MODE`.
    pub is_measured: bool,
    /// True if it is enabled.
    pub is_enabled: bool,
    /// Its commanded position.
    pub dest: f64,
    /// Its measured position.
    pub position: f64,
    /// The commanded velocity, in units a second.
    pub velocity: f64,
    /// The reasons for which it does not move, or its movements.
    pub reasons: Vec<Reason>,
}

/// A reason for which an axis does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// It is disabled.
    Disabled,
    /// `OutputMode` is `NO_OUTPUT_MODE`.
    DrivesNothing,
    /// `Vel`, `Accel` or `Jerk` is not positive.
    NoLimits(&'static str),
    /// A feedhold.
    FeedHold,
    /// A feedhold, as Dest is beyond a soft limit.
    SoftLimit(&'static str, f32),
    /// It belongs to a path that is executed.
    OnPath,
    /// It belongs to a path that waits for more segments.
    PathStarves,
    /// A limit switch that is watched is active.
    Limit(Bit),
    /// It approaches a place, which has no end.
    Approaches,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disabled => f.write_str("it is disabled"),
            Self::DrivesNothing => f.write_str("its OutputMode is NO_OUTPUT_MODE, so it drives nothing"),
            Self::NoLimits(field) => write!(f, "its {field} is 0"),
            Self::FeedHold => f.write_str("feedhold"),
            Self::SoftLimit(name, limit) => write!(f, "feedhold, as Dest is beyond {name} = {limit}"),
            Self::OnPath => f.write_str("it follows a path"),
            Self::PathStarves => f.write_str(
                "its path has used up its segments and waits for more, as CS0_Flushed is 0: set it to 1 after the last segment",
            ),
            Self::Approaches => f.write_str("MoveExp has no end, so CheckDone stays 0"),
            Self::Limit(bit) => write!(f, "its limit switch, bit {bit}, is active"),
        }
    }
}

impl<E: Engine> Board<E> {
    /// The threads that have not ended, and the event for which each waits.
    #[must_use]
    pub fn standing_threads(&self) -> Vec<UnfinishedThread> {
        ThreadId::all().filter_map(|thread| self.unfinished_thread(thread)).collect()
    }

    fn unfinished_thread(&self, thread: ThreadId) -> Option<UnfinishedThread> {
        let state = match *self.thread(thread) {
            ThreadState::Active(Progress::Fresh | Progress::Going) => ThreadActivity::Computing,
            ThreadState::Active(Progress::Waiting(Wake::At(time))) => ThreadActivity::Until(time),
            ThreadState::Active(Progress::Waiting(Wake::NextSlice)) => ThreadActivity::Slice,
            ThreadState::Active(Progress::Waiting(Wake::Retry)) => {
                let called = self.machine.firmware().parts.calls.waits.wait_of(thread).called;
                let (name, waits) =
                    called.map_or(("the firmware", None), |row| (row.name, row.attributes.waits));
                ThreadActivity::Call(name, waits.unwrap_or("until the board ends the call"))
            }
            ThreadState::Active(Progress::Idle) => ThreadActivity::Idle,
            ThreadState::Paused(_) => ThreadActivity::Paused,
            ThreadState::Empty | ThreadState::Ready | ThreadState::Faulted(_) => return None,
        };
        let wait = self.machine.firmware().parts.calls.waits.wait_of(thread);
        let mut awaited = Vec::new();
        for one in wait.calls.iter().filter_map(|call| self.awaited_state(call)) {
            if !awaited.contains(&one) {
                awaited.push(one);
            }
        }
        let calls = self.machine.backtrace(thread);
        Some(UnfinishedThread { thread, state, calls, since: wait.since, awaited })
    }

    fn awaited_state(&self, call: &RepeatedCall) -> Option<AwaitedState> {
        match call.polls {
            PolledState::Bit => {
                let bit = Bit::new(call.argument)?;
                Some(AwaitedState::Bit(bit, self.bit(bit), self.source_of(bit, call.since)))
            }
            PolledState::Motion => {
                let axis = self.memory().axes().get(call.argument)?;
                let is_enabled = self.memory().axis(axis, Chan::ENABLE) != 0;
                let done = if is_enabled { i32::from(!has_motion(self.memory(), axis)) } else { -1 };
                Some(AwaitedState::Motion(axis, done))
            }
            PolledState::Path => Some(AwaitedState::Path),
            PolledState::Recording => Some(AwaitedState::Recording),
            PolledState::Lock => Some(AwaitedState::Lock(self.owner(call.argument))),
            PolledState::Time => None,
        }
    }

    /// The owner of a lock, according to the word of the lock.
    fn owner(&self, lock: i32) -> Option<Owner> {
        let word: i32 = self.memory().peek(GuestAddr::new(lock.cast_unsigned()));
        let thread = ThreadId::new(word.checked_sub(1)?)?;
        let state = match *self.thread(thread) {
            ThreadState::Active(_) => OwnerState::Active,
            ThreadState::Paused(_) => OwnerState::Paused,
            ThreadState::Empty | ThreadState::Ready | ThreadState::Faulted(_) => OwnerState::Ended,
        };
        let held = self.machine.firmware().parts.calls.locks.held().iter();
        let held = held.rev().find(|held| held.thread == thread && held.lock.get() == lock.cast_unsigned());
        Some(Owner { thread, state, at: held.and_then(|held| held.at) })
    }

    /// Returns the origin of a bit's level, for which a thread has waited since an instant.
    fn source_of(&self, bit: Bit, since: Cycles) -> Source {
        let parts = &self.machine.firmware().parts;
        if let Some((axis, condition, active)) = parts.machine.mechanics.contact(bit) {
            let load = parts.machine.table(axis);
            return Source::Contact(
                axis,
                condition.map_or("once a turn".to_owned(), |condition| condition.to_string()),
                active,
                load,
            );
        }
        let (_, is_input) = bit_state(&parts.io, self.memory(), bit);
        let range = range_of(&parts.io, bit);
        match range.map(|range| range.direction) {
            Some(BitDirection::Memory) => Source::Memory,
            _ if range.is_some_and(|range| range.kind == BitKind::KstepInput) && !is_input => Source::NoKstep,
            _ if !is_input => Source::Output,
            _ if parts.io.pins.is_driven(bit) || parts.io.pins.is_described(bit) => {
                Source::Outside(parts.machine.pulses.last_before(bit, since))
            }
            _ => Source::Nothing,
        }
    }

    /// The axes that programs have used, and those that are enabled.
    #[must_use]
    pub fn standing_axes(&self) -> Vec<UsedAxis> {
        let waits = &self.machine.firmware().parts.calls.waits;
        let is_enabled = |axis| self.memory().axis(axis, Chan::ENABLE) != 0;
        let used = self.memory().axes().iter().filter(|&axis| waits.has_touched(axis) || is_enabled(axis));
        used.map(|axis| self.standing_axis(axis)).collect()
    }

    fn standing_axis(&self, axis: AxisId) -> UsedAxis {
        let memory = self.memory();
        let is_enabled = memory.axis(axis, Chan::ENABLE) != 0;
        let velocity = if is_enabled { f64::from(memory.axis(axis, Chan::LAST_VEL)) } else { 0.0 };
        let (name, units) = self.names[axis.index()].clone();
        UsedAxis {
            axis,
            name,
            units,
            is_measured: memory.axis(axis, Chan::INPUT_MODE) != InputMode::None.get(),
            is_enabled,
            dest: memory.axis(axis, Chan::DEST),
            position: memory.axis(axis, Chan::POSITION),
            velocity,
            reasons: self.reasons(axis, is_enabled),
        }
    }

    fn reasons(&self, axis: AxisId, is_enabled: bool) -> Vec<Reason> {
        let memory = self.memory();
        let limit_switch = || self.machine.firmware().active_limit(memory, axis).map(Reason::Limit);
        if !is_enabled {
            return [Some(Reason::Disabled), limit_switch()].into_iter().flatten().collect();
        }
        let is_member = system::is_member(memory, axis);
        let is_held = is_member && memory.get(CS0_STOPPING_STATE) != 0;
        let limit = |field| memory.axis(axis, field) <= 0.0;
        let lacking = [("Vel", Chan::VEL), ("Accel", Chan::ACCEL), ("Jerk", Chan::JERK)];
        let lacking = lacking.into_iter().find(|(_, field)| limit(*field));
        let drives_nothing = memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::None.get();
        let approaches = has_motion(memory, axis) && state(memory, axis, 0).mode == Mode::Exponential;
        [
            approaches.then_some(Reason::Approaches),
            drives_nothing.then_some(Reason::DrivesNothing),
            lacking.map(|(name, _)| Reason::NoLimits(name)),
            is_held.then(|| beyond_soft_limit(memory, axis).unwrap_or(Reason::FeedHold)),
            (is_member && !memory.get(COORD_SYSTEM0).is_null()).then_some(
                match rate::is_starved(memory, 0.0) {
                    true => Reason::PathStarves,
                    false => Reason::OnPath,
                },
            ),
            limit_switch(),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// The soft limit beyond which Dest of an axis is.
fn beyond_soft_limit(memory: &GuestMemory, axis: AxisId) -> Option<Reason> {
    let dest = memory.axis(axis, Chan::DEST);
    let (neg, pos) = (memory.axis(axis, Chan::SOFT_LIMIT_NEG), memory.axis(axis, Chan::SOFT_LIMIT_POS));
    match () {
        () if dest < f64::from(neg) => Some(Reason::SoftLimit("SoftLimitNeg", neg)),
        () if dest > f64::from(pos) => Some(Reason::SoftLimit("SoftLimitPos", pos)),
        () => None,
    }
}
