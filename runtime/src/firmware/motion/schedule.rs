//! The slices in which the board plans a motion.
//!
//! The motion of an axis at rest is planned at once; it begins when the plan is complete, in the next slice if this one
//! is too short. An axis in motion is planned in the next slice of the caller. The call-back cannot wait.

use kmotiondef::firmware::Function;
use kmotiondef::{AxisId, Cycles};
use vm::firmware::{Caller, Wake};

use super::super::costs;
use super::super::parts::Parts;
use crate::servo::independent::has_motion;
use crate::servo::moves::Planner;

/// The progress of a motion call with one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlanningStage {
    /// It begins.
    Called,
    /// Its slice has come.
    Due,
    /// It is planned and begins.
    Planned,
}

/// The wait of a motion call, and the progress of the call after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pause {
    pub(crate) wake: Wake,
    pub(crate) then: PlanningStage,
}

/// Waits for the caller's next slice if the axis is moving; for the planning time of the machine file if it has one.
pub(super) fn planning_wait(parts: &Parts, caller: &Caller<'_>, axis: AxisId) -> Option<Wake> {
    caller.thread?;
    if parts.calls.plan_ticks > 0 {
        let planning = Cycles::PER_TICK.get() * i64::from(parts.calls.plan_ticks);
        return Some(Wake::At(caller.now() + Cycles::new(planning)));
    }
    has_motion(caller.memory, axis).then_some(Wake::NextSlice)
}

/// Spends the time for planning the motion of an axis; returns the wait before it continues, if there is one.
///
/// `charged` is the cycles that the call has already spent, `planning` the cycles of the whole planning.
pub(crate) fn plan(
    parts: &Parts,
    caller: &mut Caller<'_>,
    axis: AxisId,
    progress: PlanningStage,
    charged: i64,
    planning: impl FnOnce(&Caller<'_>) -> i64,
) -> Option<Pause> {
    let is_direct = parts.servo.planner == Planner::Direct;
    match progress {
        PlanningStage::Planned => return None,
        PlanningStage::Called => {
            if let Some(wake) = planning_wait(parts, caller, axis) {
                if !is_direct {
                    costs::spend(caller, costs::BEFORE_A_WAIT - charged);
                }
                return Some(Pause { wake, then: PlanningStage::Due });
            }
            if is_direct {
                return None;
            }
            let cycles = planning(caller) - charged;
            costs::spend(caller, cycles);
        }
        PlanningStage::Due => {
            let cycles = planning(caller);
            costs::spend(caller, cycles);
            return None;
        }
    }
    let is_late = *caller.budget < Cycles::default() && caller.thread.is_some();
    is_late.then_some(Pause { wake: Wake::NextSlice, then: PlanningStage::Planned })
}

/// The cycles of the row of a function.
pub(super) fn row_cost(function: Function) -> i64 {
    function.row().cost.get()
}
