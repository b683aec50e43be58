//! Running backwards: the past is executed again from a snapshot, and the last stop before the present is the result.
//!
//! Each search covers the interval from one snapshot to the next, the latest first. A first pass counts the stops; a
//! second one takes the session to the right one. A search for a step has too many stops to keep, so it covers only the
//! last ticks at first, then more.

use std::sync::atomic::Ordering;

use cc67_host::{Capability, Target};
use kmotiondef::Ticks;
use vm::engine::ContextId;

use super::run::{Goal, catch};
use super::{DebugError, Debugger, Position, Reason, Stop};

/// The number of ticks that a search for a step covers at first, and the factor by which it grows.
const WINDOW: u64 = 2;
const WIDER: u64 = 6;

/// The reason why a board without a past cannot go back.
pub(crate) const ONLY_FORWARD: &str = "others use this board: it does not go back";

/// The target of a search of the past.
#[derive(Clone, Debug)]
enum SearchTarget {
    /// The last stop at a breakpoint or similar.
    Stop,
    /// The beginning of the last line with at most this many enclosing calls.
    Line { context: ContextId, depth: usize },
    /// The call of a function, at this depth of machine calls.
    Call { context: ContextId, depth: usize, at: u32 },
    /// The last instruction.
    Instruction(ContextId),
}

impl SearchTarget {
    /// The goal of the run that finds it.
    fn goal(&self) -> Goal {
        match self {
            Self::Stop => Goal::None,
            Self::Line { context, .. } => Goal::Line { context: *context, line: 0, depth: 0, into: true },
            Self::Call { at, .. } => Goal::Address(vec![*at]),
            Self::Instruction(context) => Goal::Instruction(*context),
        }
    }

    /// Returns whether the user's breakpoints count.
    const fn is_stop(&self) -> bool {
        matches!(self, Self::Stop)
    }
}

/// The result of the first pass: the number of the hold, counted from 1, and whether more of the past must be searched
/// to be sure.
#[derive(Clone, Copy, Debug, Default)]
struct SearchResult {
    number: u64,
    is_first: bool,
}

impl<T: Target> Debugger<T> {
    /// Goes back to the last breakpoint, change of a watched expression or trap.
    pub fn reverse_continue(&mut self) -> Stop {
        self.back(&SearchTarget::Stop)
    }

    /// Goes back to the beginning of the last line of the selected thread, stepping into called functions.
    ///
    /// # Errors
    /// There is no debug information for the thread's program.
    pub fn reverse_step(&mut self) -> Result<Stop, DebugError> {
        self.programs.of(self.thread)?;
        Ok(self.back(&SearchTarget::Line { context: self.context(), depth: usize::MAX }))
    }

    /// Goes back to the beginning of the last line, stepping over called functions.
    ///
    /// # Errors
    /// As [`reverse_step`](Self::reverse_step).
    pub fn reverse_next(&mut self) -> Result<Stop, DebugError> {
        self.programs.of(self.thread)?;
        let depth = self.frames(self.context()).len();
        let depth = if depth == 0 { usize::MAX } else { depth };
        Ok(self.back(&SearchTarget::Line { context: self.context(), depth }))
    }

    /// Goes back to the call of the function.
    ///
    /// # Errors
    /// The function is the outermost.
    pub fn reverse_finish(&mut self) -> Result<Stop, DebugError> {
        let context = self.context();
        let frames = self.frames(context);
        let caller = frames.get(self.frame + 1).ok_or("\"finish\" not meaningful in the outermost frame.")?;
        let is_inlined = frames.get(self.frame).is_some_and(|frame| frame.real == caller.real);
        let wanted = if is_inlined {
            // The beginning of the line that contains the call.
            SearchTarget::Line { context, depth: frames.len() - self.frame - 1 }
        } else {
            let depth = frames.last().map_or(0, |last| last.real + 1) - caller.real;
            SearchTarget::Call { context, depth, at: caller.address.get() }
        };
        Ok(self.back(&wanted))
    }

    /// Goes back by one instruction of the thread.
    pub fn reverse_step_instruction(&mut self) -> Stop {
        self.back(&SearchTarget::Instruction(self.context()))
    }

    /// Goes back, or forward in the known past, to the end of a tick.
    ///
    /// # Errors
    /// The tick is before the beginning of the past.
    pub fn go_to(&mut self, tick: Ticks) -> Result<Stop, DebugError> {
        self.disarm();
        self.session.require(Capability::Snapshots)?;
        let timeline = self.timeline.as_mut().ok_or(ONLY_FORWARD)?;
        timeline.go_to(&mut self.session, tick).map_err(|error| error.to_string())?;
        Ok(self.stopped(Reason::Time, None))
    }

    /// Restarts the board from its beginning.
    ///
    /// # Errors
    /// The snapshots belong to another board.
    pub fn restart(&mut self) -> Result<Stop, DebugError> {
        self.disarm();
        self.session.require(Capability::Snapshots)?;
        let timeline = self.timeline.as_mut().ok_or(ONLY_FORWARD)?;
        timeline.restore(&mut self.session, 0).map_err(|error| error.to_string())?;
        Ok(self.stopped(Reason::Begin, None))
    }

    /// Restores the snapshot at a position, or the last one before it; returns whether there is one.
    fn restore(&mut self, place: u64) -> bool {
        let timeline = self.timeline.as_mut();
        timeline.is_some_and(|timeline| timeline.restore_place(&mut self.session, place).is_ok())
    }

    /// The position of the last snapshot before a position, or of the last of all.
    fn snapshot_before(&self, place: Option<u64>) -> Option<u64> {
        self.timeline.as_ref()?.before(place)
    }

    fn back(&mut self, wanted: &SearchTarget) -> Stop {
        let here = self.position();
        let mut bound = here;
        let mut next = self.snapshot_before(None);
        while let Some(place) = next {
            if !self.restore(place) {
                break;
            }
            let begin = self.position();
            next = self.snapshot_before(Some(place));
            if !is_before(&begin, &bound) {
                continue;
            }
            if let Some(reason) = self.search(place, &begin, &bound, wanted) {
                self.disarm();
                self.refresh_watches();
                return self.stopped(reason, None);
            }
            if let Some(reason) = self.stop_at(place, wanted) {
                self.disarm();
                self.refresh_watches();
                return self.stopped(reason, None);
            }
            if self.interrupt.swap(false, Ordering::Relaxed) {
                self.disarm();
                return self.stopped(Reason::Interrupted, None);
            }
            bound = begin;
        }
        self.disarm();
        if !self.restore(0) {
            self.messages.push_back("the beginning of the past cannot be reached".to_owned());
        }
        self.stopped(Reason::BeginOfHistory, None)
    }

    /// The reason to stop at a snapshot that was taken within a tick: a user changed something there, so the earlier
    /// history leads to the same position in another state.
    fn stop_at(&mut self, place: u64, wanted: &SearchTarget) -> Option<Reason> {
        self.disarm();
        if !self.restore(place) {
            return None;
        }
        let (held, _) = self.session.held()?;
        let frames = self.session.frames(held);
        let at = frames.first()?.at.get();
        match wanted {
            SearchTarget::Stop => self.judge_breakpoints(held, at, false),
            SearchTarget::Instruction(context) => (held == *context).then_some(Reason::Step),
            SearchTarget::Line { context, depth } => {
                let here = self.line_and_depth(held).filter(|(_, now)| held == *context && now <= depth);
                here.map(|_| Reason::Step)
            }
            SearchTarget::Call { context, depth, at: call } => {
                (held == *context && frames.len() == *depth && at == *call).then_some(Reason::Step)
            }
        }
    }

    /// Searches one interval of the past; if the target is found, the session is taken there.
    fn search(
        &mut self,
        place: u64,
        begin: &Position,
        bound: &Position,
        wanted: &SearchTarget,
    ) -> Option<Reason> {
        let mut window = if wanted.is_stop() { u64::MAX } else { WINDOW };
        loop {
            let from = Ticks::new(bound.tick.get().saturating_sub(window)).max(begin.tick);
            let is_all = from == begin.tick;
            let found = self.way(place, from, bound, wanted, None).0;
            if found.number > 0 && (is_all || !found.is_first) {
                return self.way(place, from, bound, wanted, Some(found.number)).1;
            }
            if is_all {
                return None;
            }
            window = window.saturating_mul(WIDER);
        }
    }

    /// Executes an interval again, held from the end of tick `from` on, up to the hold with a number, or to its end.
    fn way(
        &mut self,
        place: u64,
        from: Ticks,
        bound: &Position,
        wanted: &SearchTarget,
        number: Option<u64>,
    ) -> (SearchResult, Option<Reason>) {
        self.disarm();
        if !self.restore(place) {
            return (SearchResult::default(), None);
        }
        if let Some(timeline) = self.timeline.as_mut().filter(|_| from > self.session.tick()) {
            timeline.replay(&mut self.session, from);
        }
        self.refresh_watches();
        let goal = wanted.goal();
        let disabled = self.set_enabled(wanted.is_stop());
        self.arm(&goal, bound.held.map(|(_, _, at)| at));
        let result = self.way_armed(bound, wanted, &goal, number);
        self.restore_enabled(&disabled);
        result
    }

    fn way_armed(
        &mut self,
        bound: &Position,
        wanted: &SearchTarget,
        goal: &Goal,
        number: Option<u64>,
    ) -> (SearchResult, Option<Reason>) {
        let (mut found, mut count, mut last) = (SearchResult::default(), 0, None);
        let catches = self.catches.clone();
        let infos: Vec<_> = self.session.debug().into_iter().map(|(_, info)| info).collect();
        loop {
            let is_at_end = self.session.held().is_none() && self.session.tick() >= bound.tick;
            if is_at_end || self.session.tick() > bound.tick {
                return (found, None);
            }
            let limit = self.next_tick(bound.tick);
            let mut caught = None;
            self.session.step(limit, &mut |event| {
                if caught.is_none() && wanted.is_stop() {
                    caught = catch(&event, &catches, &infos);
                }
            });
            let hold = self.session.take_hold();
            if hold.is_some() && self.position() == *bound {
                return (found, None);
            }
            let is_over = self.session.held().is_none() && self.session.tick() >= bound.tick;
            let reason = match (hold, wanted) {
                (Some(hold), SearchTarget::Stop) => self.stop_reason(hold, goal, false),
                (Some(hold), SearchTarget::Instruction(context)) => {
                    (hold.context == *context).then_some(Reason::Step)
                }
                (Some(hold), SearchTarget::Line { context, depth }) if hold.context == *context => {
                    let here = self.line_and_depth(hold.context).filter(|(_, now)| now <= depth);
                    let is_new = here.is_some() && here != last;
                    last = here.or(last);
                    is_new.then_some(Reason::Step)
                }
                (Some(hold), SearchTarget::Call { context, depth, at }) => {
                    let frames = self.session.frames(hold.context);
                    let is_it = hold.context == *context
                        && frames.len() == *depth
                        && frames.first().is_some_and(|frame| frame.at.get() == *at);
                    is_it.then_some(Reason::Step)
                }
                (Some(_), _) => None,
                // Events at the very last tick are at the present position already.
                (None, SearchTarget::Stop) => {
                    let changed = self.judge_tick(false);
                    caught.map(|(reason, _)| reason).or(changed).filter(|_| !is_over)
                }
                (None, _) => None,
            };
            if let Some(reason) = reason {
                count += 1;
                found = SearchResult {
                    number: count,
                    is_first: count == 1 && matches!(wanted, SearchTarget::Line { .. }),
                };
                if number == Some(count) {
                    return (found, Some(reason));
                }
            }
        }
    }

    /// The line that begins at a context's position, if one does, and the number of calls in progress.
    fn line_and_depth(&self, context: ContextId) -> Option<(u32, usize)> {
        let at = self.session.frames(context).first()?.at.get();
        let place = self.place(at).filter(|_| self.is_statement(at))?;
        Some((place.line, self.depth(context)))
    }

    /// Returns whether a statement begins at an address.
    pub(crate) fn is_statement(&self, address: u32) -> bool {
        self.programs.at(address).is_some_and(|(_, _, function)| {
            function.statements.iter().any(|(statement, _)| *statement == address)
        })
    }

    /// Enables or disables all breakpoints; returns those that were enabled.
    fn set_enabled(&mut self, are: bool) -> Vec<u32> {
        let enabled: Vec<_> = self
            .breakpoints
            .iter()
            .filter(|breakpoint| breakpoint.is_enabled)
            .map(|breakpoint| breakpoint.id)
            .collect();
        if !are {
            self.breakpoints.iter_mut().for_each(|breakpoint| breakpoint.is_enabled = false);
        }
        enabled
    }

    fn restore_enabled(&mut self, enabled: &[u32]) {
        for breakpoint in &mut self.breakpoints {
            breakpoint.is_enabled = enabled.contains(&breakpoint.id);
        }
    }
}

/// Returns whether one position is before another.
fn is_before(one: &Position, other: &Position) -> bool {
    match (one.held, other.held) {
        (None, None) => one.tick < other.tick,
        (None, Some(_)) => one.tick < other.tick,
        (Some(_), None) => one.tick <= other.tick,
        (Some((_, at, _)), Some((_, other, _))) => at < other,
    }
}
