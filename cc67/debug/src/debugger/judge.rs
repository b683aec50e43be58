//! The decision to stop the board for a breakpoint, a change, an access, or an expression that has become true.

use cc67_host::Target;
use kmotiondef::CodeAddr;
use vm::engine::{ContextId, Hold, HoldReason};

use super::breakpoints::WatchedExpression;
use super::run::Goal;
use super::{Breakpoint, BreakpointKind, Debugger, Reason, WatchedAccess, file_name};

/// The name for the unknown writer of a value that is checked only after every tick.
const IN_TICK: &str = "a program or the board in the last tick";
/// The name for the writer of a value that no program writes.
const BY_SERVO: &str = "the servo or the firmware";

impl<T: Target> Debugger<T> {
    /// Returns the reason to stop at the end of a tick: a watched value that has changed in it, or a condition that has
    /// become true.
    pub(super) fn judge_tick(&mut self, counts: bool) -> Option<Reason> {
        if let Some(index) = self.session.take_change()
            && let Some(reason) = self.judge_change(index, BY_SERVO.to_owned(), counts)
        {
            return Some(reason);
        }
        (0..self.breakpoints.len()).find_map(|index| {
            if !self.breakpoints[index].is_polled() {
                return None;
            }
            let id = self.breakpoints[index].id;
            if self.breakpoints[index].subject.watched().is_some() {
                return self.judge_watch(id, IN_TICK.to_owned(), counts);
            }
            let is_so = self.is_so(&self.breakpoints[index]);
            let was_so = self.breakpoints[index].subject.was_true_mut()?;
            let is_new = is_so && !std::mem::replace(was_so, is_so);
            if !is_new || !self.is_to_stop(index, self.context(), counts) {
                return None;
            }
            let BreakpointKind::When(expression) = self.breakpoints[index].kind.clone() else { return None };
            Some(Reason::When { id, expression })
        })
    }

    /// Returns the reason for which a held context must stop, if there is one; `counts` is true except in a search of
    /// the past.
    pub(super) fn stop_reason(&mut self, hold: Hold, goal: &Goal, counts: bool) -> Option<Reason> {
        match hold.reason {
            HoldReason::Step => (*goal == Goal::Instruction(hold.context)).then_some(Reason::Step),
            HoldReason::Changed { index, by } => {
                let by = by.map_or_else(|| BY_SERVO.to_owned(), |at| self.writer(hold.context, at));
                self.judge_change(index, by, counts)
            }
            HoldReason::Accessed { index, by, .. } => {
                let by = self.writer(hold.context, by);
                self.judge_access(index, by, counts)
            }
            HoldReason::Breakpoint => {
                let at = self.session.frames(hold.context).first()?.at.get();
                self.judge_registers(hold.context, counts)
                    .or_else(|| self.judge_breakpoints(hold.context, at, counts))
                    .or_else(|| self.is_reached(goal, hold.context, at).then_some(Reason::Step))
            }
        }
    }

    fn writer(&self, context: ContextId, at: CodeAddr) -> String {
        let who =
            context.thread().map_or_else(|| "the call-back".to_owned(), |thread| format!("thread {thread}"));
        match self.place(at.get()) {
            Some(place) => format!("{who}, {} at {}:{}", place.function, file_name(&place.file), place.line),
            None => format!("{who} at {at}"),
        }
    }

    /// Handles a change of a watched range.
    fn judge_change(&mut self, range: usize, by: String, counts: bool) -> Option<Reason> {
        let mut ranges = 0;
        let found =
            self.breakpoints.iter().filter(|breakpoint| breakpoint.is_enabled).position(|breakpoint| {
                ranges += breakpoint.subject.watched().map_or(0, |watched| watched.ranges.len());
                range < ranges
            })?;
        let id = self.breakpoints.iter().filter(|breakpoint| breakpoint.is_enabled).nth(found)?.id;
        self.judge_watch(id, by, counts)
    }

    fn judge_registers(&mut self, context: ContextId, counts: bool) -> Option<Reason> {
        let watching = |watched: &WatchedExpression| {
            watched.has_registers && watched.prepared.frame.is_some_and(|(of, _)| of == context)
        };
        let ids: Vec<_> = (self.breakpoints.iter())
            .filter(|breakpoint| breakpoint.is_enabled && breakpoint.subject.watched().is_some_and(watching))
            .map(|breakpoint| breakpoint.id)
            .collect();
        let by =
            context.thread().map_or_else(|| "the call-back".to_owned(), |thread| format!("thread {thread}"));
        ids.into_iter().find_map(|id| self.judge_watch(id, by.clone(), counts))
    }

    fn judge_watch(&mut self, id: u32, by: String, counts: bool) -> Option<Reason> {
        let index = self.breakpoints.iter().position(|breakpoint| breakpoint.id == id)?;
        let watched = self.breakpoints[index].subject.watched()?;
        let new = self.watched_text(watched)?;
        if new == watched.last {
            return None;
        }
        let BreakpointKind::Watch(expression) = self.breakpoints[index].kind.clone() else { return None };
        let old = self.breakpoints[index]
            .subject
            .watched_mut()
            .map(|watched| std::mem::replace(&mut watched.last, new.clone()))?;
        let context = self.session.held().map_or_else(|| self.context(), |(context, _)| context);
        if !self.is_to_stop(index, context, counts) {
            return None;
        }
        Some(Reason::Changed { id, expression, old, new, by })
    }

    /// Handles an access to the memory of an expression.
    fn judge_access(&mut self, range: usize, by: String, counts: bool) -> Option<Reason> {
        let is_meant = |index: &usize| {
            let breakpoint = &self.breakpoints[*index];
            breakpoint.is_enabled
                && breakpoint.subject.accessed().is_some_and(|watched| watched.own.is_some())
        };
        let index = (0..self.breakpoints.len()).filter(is_meant).nth(range)?;
        let value = self.watched_text(self.breakpoints[index].subject.accessed()?)?;
        let watched = self.breakpoints[index].subject.expression_mut()?;
        let old = std::mem::replace(&mut watched.last, value.clone());
        let context = self.session.held().map_or_else(|| self.context(), |(context, _)| context);
        if !self.is_to_stop(index, context, counts) {
            return None;
        }
        let Breakpoint { id, kind: BreakpointKind::Access(expression, access), .. } =
            &self.breakpoints[index]
        else {
            return None;
        };
        let (expression, access) = (expression.clone(), *access);
        let old = Some(old).filter(|old| *old != value && access == WatchedAccess::ReadWrite);
        Some(Reason::Accessed { id: *id, expression, access, old, value, by })
    }

    pub(super) fn judge_breakpoints(&mut self, context: ContextId, at: u32, counts: bool) -> Option<Reason> {
        let is_here = |kind: &BreakpointKind| matches!(kind, BreakpointKind::Code(_, addresses) if addresses.contains(&at));
        let here: Vec<_> = (0..self.breakpoints.len())
            .filter(|index| self.breakpoints[*index].is_enabled && is_here(&self.breakpoints[*index].kind))
            .collect();
        let mut ids = Vec::new();
        for index in here {
            if self.is_to_stop(index, context, counts) {
                ids.push(self.breakpoints[index].id);
            }
        }
        (!ids.is_empty()).then_some(Reason::Breakpoint(ids))
    }

    /// Returns whether a breakpoint that was reached stops: its condition holds, its ignore count is used up, and it is
    /// not a log point.
    fn is_to_stop(&mut self, index: usize, context: ContextId, counts: bool) -> bool {
        if self.breakpoints[index].condition.is_some() {
            match self.holds(context, &self.breakpoints[index].conditions) {
                Ok(true) => {}
                Ok(false) => return false,
                Err(error) => {
                    let id = self.breakpoints[index].id;
                    self.messages.push_back(format!("condition of breakpoint {id}: {error}"));
                }
            }
        }
        if let Some(log) = self.breakpoints[index].log.clone() {
            if counts {
                self.breakpoints[index].hits += 1;
                let (thread, frame, stop) = (self.thread, self.frame, self.stop.clone());
                (self.thread, self.frame) = (context.thread().unwrap_or(thread), 0);
                self.stop.context = Some(context);
                let text = self.filled(&log);
                self.messages.push_back(text);
                (self.thread, self.frame, self.stop) = (thread, frame, stop);
            }
            return false;
        }
        if !counts {
            return true;
        }
        let breakpoint = &mut self.breakpoints[index];
        breakpoint.hits += 1;
        if breakpoint.ignore > 0 {
            breakpoint.ignore -= 1;
            return false;
        }
        breakpoint.stops_at.is_none_or(|condition| condition.stops(breakpoint.hits))
    }
}
