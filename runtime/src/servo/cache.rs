//! Values derived from guest memory that the servo keeps from tick to tick, and the one way to invalidate them.
//!
//! Guest memory is the only source of an axis' settings. Three values are derived from it: the plans of the axes,
//! whether a tick would change anything at all, and whether the last tick left nothing to do. Code that changes their
//! inputs must call [`Cache::invalidate`] with an [`Invalidation`]; only this file decides which values a change affects.

use kmotiondef::timing::WaitStates;
use kmotiondef::{Axes, AxisId, Cycles, GuestAddr};
use vm::memory::GuestMemory;

use super::duration::duration;
use super::interrupt::Interrupt;
use super::plan::AxisPlan;
use super::still::Stillness;
use crate::machine::wiring::Wiring;

/// The kind of change that invalidates derived values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Invalidation {
    /// Anything may have: code outside the tick has had the board.
    Anything,
    /// Memory may have been written, by programs or by inputs at the beginning of a tick.
    Memory,
    /// Something moves, or the remembered state of an axis in the servo or in a load was replaced.
    Motion,
    /// An axis was switched off.
    SwitchedOff,
    /// A thread has had the processor.
    Thread,
}

/// The derived values, until they are invalidated.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cache {
    plans: [AxisPlan; Axes::MAX],
    /// The variable that selects whether the derivative gain acts on the error; `None` in firmware 4.34, which does not
    /// have it.
    pub(crate) derivative_method: Option<GuestAddr>,
    /// True if the plans, and the values derived from them, agree with memory.
    has_plans: bool,
    /// True if an axis depends on another by them.
    is_coupled: bool,
    /// True if one follows a master by them.
    has_slaves: bool,
    /// The time of the interrupt with them.
    duration: Cycles,
    /// The interrupt's duration on the board, apart from the motion in progress.
    interrupt: Interrupt,
    still: Stillness,
    /// A bit for each disabled axis that a tick does not change, until something is written or moved from outside.
    resting: u16,
    /// True if the last tick changed nothing and no thread has run since.
    is_settled: bool,
}

impl Cache {
    /// Drops the values that a change may have made wrong.
    #[inline]
    pub(crate) const fn invalidate(&mut self, change: Invalidation) {
        match change {
            Invalidation::Anything => {
                self.is_settled = false;
                self.has_plans = false;
                self.still.interrupt();
                self.wake();
            }
            Invalidation::Memory => {
                self.has_plans = false;
                self.wake();
            }
            Invalidation::Motion => {
                self.still.interrupt();
                self.wake();
            }
            Invalidation::SwitchedOff => {
                self.has_plans = false;
                self.still.interrupt();
                self.wake();
            }
            Invalidation::Thread => self.is_settled = false,
        }
    }

    /// Every axis is computed in the next tick.
    pub(super) const fn wake(&mut self) {
        self.resting = 0;
    }

    /// Returns whether a tick of a disabled axis would change nothing.
    #[inline(always)]
    pub(super) const fn is_resting(&self, axis: AxisId) -> bool {
        self.resting >> axis.index() & 1 != 0
    }

    /// Notes that a tick has not changed a disabled axis, and that nothing but its memory and its load can.
    #[inline(always)]
    pub(super) const fn rest(&mut self, axis: AxisId) {
        self.resting |= 1 << axis.index();
    }

    /// Returns the plan of an axis.
    #[inline(always)]
    pub(super) const fn plan(&self, axis: AxisId) -> &AxisPlan {
        &self.plans[axis.index()]
    }

    /// Returns whether an axis depends on another.
    pub(super) const fn is_coupled(&self) -> bool {
        self.is_coupled
    }

    /// Returns whether an axis follows a master.
    pub(super) const fn has_slaves(&self) -> bool {
        self.has_slaves
    }

    /// Returns the time that the servo interrupt takes of a tick.
    #[inline]
    pub(crate) fn duration(&self, memory: &GuestMemory) -> Cycles {
        if self.has_plans { self.duration } else { duration(memory) }
    }

    /// Returns the time that the interrupt takes on the board, with the waits for memory.
    #[inline]
    pub(crate) fn interrupt(&self, memory: &GuestMemory, waits: WaitStates) -> Cycles {
        if self.has_plans {
            self.interrupt.time(memory, waits, self.is_settled)
        } else {
            Interrupt::of(memory).time(memory, waits, false)
        }
    }

    /// Computes the plans, unless they are known.
    pub(super) fn make_plans(&mut self, memory: &mut GuestMemory, wiring: &Wiring) {
        if !self.has_plans {
            for axis in memory.axes().iter() {
                self.plans[axis.index()] = AxisPlan::of(memory, wiring, axis, self.derivative_method);
            }
            self.is_coupled = memory.axes().iter().any(|axis| self.plans[axis.index()].is_coupled(axis));
            self.has_slaves = self.plans.iter().any(|plan| plan.is_slave);
            self.duration = duration(memory);
            self.interrupt = Interrupt::of(memory);
            self.has_plans = true;
        }
        debug_assert!(
            self.plans_hold(memory, wiring) && self.duration == duration(memory),
            "settings have changed unnoticed"
        );
    }

    /// Returns whether the plans still agree with the settings.
    fn plans_hold(&self, memory: &mut GuestMemory, wiring: &Wiring) -> bool {
        memory.axes().iter().zip(&self.plans).all(|(axis, plan)| {
            let now = AxisPlan::of(memory, wiring, axis, self.derivative_method);
            // A setting that is NaN only equals itself in print.
            *plan == now || format!("{plan:?}") == format!("{now:?}")
        })
    }

    /// Returns whether a tick of the axes would change nothing. If `is_touched` is false, the axis structures have not
    /// been written to.
    #[inline]
    pub(super) fn is_still(&self, memory: &GuestMemory, is_touched: bool) -> bool {
        self.still.is_still(memory, is_touched)
    }

    /// A tick of the axes is computed.
    pub(super) fn begin(&mut self, memory: &mut GuestMemory, wiring: &Wiring) {
        self.still.begin(memory);
        self.make_plans(memory, wiring);
    }

    /// An axis depends on inputs that are not compared: every tick is computed.
    pub(super) const fn watch(&mut self) {
        self.still.watch();
    }

    /// Ends the tick of the axes; returns whether it has changed anything, which `moved` implies.
    pub(super) fn end(&mut self, memory: &GuestMemory, moved: bool) -> bool {
        if moved {
            self.still.interrupt();
            return true;
        }
        !self.still.end(memory)
    }

    /// Ends the whole tick; `is_settled` if the next one may be skipped unless a thread runs before.
    pub(crate) const fn settle(&mut self, is_settled: bool) {
        self.is_settled = is_settled;
    }

    /// Returns whether the last tick changed nothing and nothing has changed since.
    pub(crate) const fn is_settled(&self) -> bool {
        self.is_settled
    }
}
