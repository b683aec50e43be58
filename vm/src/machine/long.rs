//! Long slices: the only active thread computes through many ticks in which the board does nothing.
//!
//! The context gets the budget of all its slices at once. It stops before it does anything other than compute with
//! registers and SDRAM; the cycles spent until then determine the slice in which this happens. [`Firmware::skip_ticks`]
//! makes up for the ticks before, so everything happens at the same time as with slices of one tick each.

use kmotiondef::{Cycles, ThreadId, Ticks};

use super::{Machine, Window, end_of, start_of};
use crate::engine::{ContextId, Engine, Polling, Preemption, Slice, Stop};
use crate::firmware::Firmware;
use crate::scheduler::SliceOwner;
use crate::thread::{Progress, ThreadState};

/// The most ordinary slices that a long slice replaces: a tenth of a second of board time.
const MOST_SLICES: u64 = 512;

/// A long slice.
struct LongSlice {
    thread: ThreadId,
    slices: u64,
    /// The budget of each slice, in cycles.
    each: Cycles,
    /// The overdraft of the previous slice, which is taken from the first slice.
    debt: Cycles,
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Runs a long slice, if one is possible before tick `limit` is over; returns whether it did.
    pub(super) fn run_long_slice(&mut self, limit: Ticks) -> bool {
        let Some(plan) = self.plan_long_slice(limit) else { return false };
        let (stop, spent) = self.compute(&plan);
        // A segment that ends exactly with a slice belongs to it.
        let whole = (spent.get() - 1).max(0) / plan.each.get();
        let whole = whole.min(plan.slices as i64 - 1);
        let left = Cycles::new(plan.each.get() * (whole + 1)) - spent;
        self.pass_ticks(whole.cast_unsigned() * 2 + 1);
        let end = end_of(self.tick);
        if matches!(stop, Stop::NeedsBoard) {
            let start = start_of(self.tick) + self.servo_time();
            self.run_thread(plan.thread, Window { start, end, callback: Cycles::default() }, left, None);
        } else {
            self.stopped(plan.thread, end, left, stop);
        }
        true
    }

    /// Combines the next slices into a long one: every other tick; the primary thread has the ticks between.
    fn plan_long_slice(&self, limit: Ticks) -> Option<LongSlice> {
        let active = self.threads.active();
        // A slice that is over must end exactly there.
        let is_split = self.config.preemption == Preemption::Instructions;
        if active.len() != 1 || self.turn != SliceOwner::Primary || is_split {
            return None;
        }
        let thread = ThreadId::all().find(|thread| active.contains(*thread))?;
        let is_going = matches!(self.threads.state(thread), ThreadState::Active(Progress::Going));
        let loaded = self.loaded(thread)?;
        if !is_going || !self.engines.takes_long_slices(ContextId::of(thread), loaded) {
            return None;
        }
        let ticks = limit.get().saturating_sub(self.tick.get()).min(self.firmware.quiet_slices(&self.memory));
        let slices = (ticks / 2).min(MOST_SLICES);
        let each = Cycles::PER_TICK - self.servo_time();
        let debt = self.threads.overdraft(thread);
        // No block may take a whole slice: it would be skipped.
        let longest = debt.max(self.longest_steps[thread.index()]);
        let is_callback_set = !self.firmware.callback(&self.memory).is_null();
        (slices > 1 && longest < each && !is_callback_set).then_some(LongSlice { thread, slices, each, debt })
    }

    /// Lets the thread compute; returns its stop, and the cycles spent including the debt.
    fn compute(&mut self, plan: &LongSlice) -> (Stop, Cycles) {
        let all = Cycles::new(plan.each.get() * plan.slices as i64);
        let Some(loaded) = self.loaded[plan.thread.index()].as_ref() else {
            return (Stop::NeedsBoard, plan.debt);
        };
        let mut slice = Slice {
            memory: &mut self.memory,
            threads: &mut self.threads,
            firmware: &mut self.firmware,
            tick: self.tick,
            start: start_of(self.tick),
            length: all,
            budget: all - plan.debt,
            woken: None,
            is_long: true,
            polling: Polling::new(self.config.shortcuts),
        };
        let stop = self.engines.resume(ContextId::of(plan.thread), loaded, &mut slice);
        let spent = all - slice.budget;
        self.work += (spent - slice.polling.passed()).get().unsigned_abs();
        (stop, spent)
    }
}
