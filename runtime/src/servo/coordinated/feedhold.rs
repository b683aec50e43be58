//! Feedhold of a path: `CS0_StoppingState` and the transitions that concern coordinated motion.
//!
//! Independent motions of the member axes are held too, when no path is executing; that part is the axes' own.

use kmotiondef::GuestAddr;
use kmotiondef::variables::{COORD_SYSTEM0, CS0_DECEL_TIME, CS0_STOPPING_STATE, CS0_TIME_BASE_DELTA};
use vm::memory::GuestMemory;

use super::{rate, system};
use crate::views::TypedAccess;

/// The minimum time for stopping a path, in seconds.
const LEAST_STOPPING_TIME: f32 = 1e-6;

/// The progress of a feedhold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HoldState {
    /// None.
    Running,
    /// A path is decelerating.
    StoppingPath,
    /// Independent motions are decelerating.
    StoppingAxes,
    /// A path has stopped.
    PathStopped,
    /// Independent motions have stopped.
    AxesStopped,
}

impl HoldState {
    /// The state in guest memory; a number without a meaning is none.
    pub(crate) fn of(memory: &GuestMemory) -> Self {
        match memory.get(CS0_STOPPING_STATE) {
            1 => Self::StoppingPath,
            2 => Self::StoppingAxes,
            3 => Self::PathStopped,
            4 => Self::AxesStopped,
            _ => Self::Running,
        }
    }

    /// The number that programs see.
    pub(crate) const fn number(self) -> i32 {
        match self {
            Self::Running => 0,
            Self::StoppingPath => 1,
            Self::StoppingAxes => 2,
            Self::PathStopped => 3,
            Self::AxesStopped => 4,
        }
    }
}

/// Notes the duration of a stop from the present speeds.
///
/// The caller has checked that no feedhold is active.
pub(crate) fn note_time(memory: &mut GuestMemory) {
    memory.set(CS0_DECEL_TIME, system::stopping_time(memory));
}

/// Begins to stop an executing path, in the time that was noted. Returns whether there was one.
pub(crate) fn stop(memory: &mut GuestMemory) -> bool {
    let executing = !memory.get(COORD_SYSTEM0).is_null();
    if executing {
        let time = memory.get(CS0_DECEL_TIME).max(LEAST_STOPPING_TIME);
        memory.set(CS0_DECEL_TIME, time);
        rate::ramp_to_override(memory, 0.0, time);
        memory.set(CS0_STOPPING_STATE, HoldState::StoppingPath.number());
    }
    executing
}

/// Continues a held path. Says whether one was held.
pub(crate) fn resume(memory: &mut GuestMemory) -> bool {
    let held = is_path_held(memory);
    if held {
        memory.set(CS0_STOPPING_STATE, HoldState::Running.number());
        rate::ramp_to_override(memory, rate::current_override(memory), system::nominal_change_time(memory));
    }
    held
}

/// Ends a feedhold and the path, whether it is held or not; its times and its rate are unchanged.
pub(crate) fn clear(memory: &mut GuestMemory) {
    memory.set(CS0_STOPPING_STATE, HoldState::Running.number());
    memory.set(COORD_SYSTEM0, GuestAddr::NULL);
    memory.set(CS0_TIME_BASE_DELTA, 0.0);
}

fn is_path_held(memory: &GuestMemory) -> bool {
    matches!(HoldState::of(memory), HoldState::StoppingPath | HoldState::PathStopped)
}
