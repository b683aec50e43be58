//! Forward: to a breakpoint, by steps of one thread while the others continue, to a time.

use std::sync::atomic::Ordering;

use cc67_host::{Capability, Target};
use kmotiondef::{Bit, CodeAddr, GuestAddr, ThreadId, Ticks};
use runtime::{Event, EventKind};
use vm::engine::{AccessRange, ContextId};
use vm::scheduler::ThreadSet;

use super::{Breakpoint, BreakpointKind, DebugError, Debugger, Events, Reason, Stop, WatchedAccess};

/// The goal at which a run ends, besides breakpoints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Goal {
    /// Nothing.
    None,
    /// The next line of a context: from which line and depth it comes, and whether calls are followed.
    Line { context: ContextId, line: u32, depth: usize, into: bool },
    /// The end of an inlined call of this depth.
    Leave { context: ContextId, depth: usize },
    /// A call of the machine with fewer calls around it, at one of these addresses.
    Above { context: ContextId, depth: usize, at: Vec<u32> },
    /// One of these addresses.
    Address(Vec<u32>),
    /// One of these addresses, or the return to the caller.
    Until { at: Vec<u32>, caller: Option<Box<Goal>> },
    /// One instruction.
    Instruction(ContextId),
    /// The end of a tick.
    Tick(Ticks),
}

/// The kind of a movement forward.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepKind {
    /// To the next stop.
    Continue,
    /// To the next line, into functions.
    Into,
    /// To the next line, over functions.
    Over,
    /// Out of the function.
    Out,
    /// One instruction.
    Instruction,
}

impl<T: Target> Debugger<T> {
    /// Continues to the next stop.
    pub fn go_on(&mut self, events: Events<'_>) -> Stop {
        self.run(&Goal::None, events)
    }

    /// Returns the goal of a movement.
    ///
    /// # Errors
    /// The debugger cannot move so.
    pub(crate) fn goal(&self, kind: StepKind) -> Result<Goal, DebugError> {
        match kind {
            StepKind::Continue => Ok(Goal::None),
            StepKind::Into => self.line_goal(true),
            StepKind::Over => self.line_goal(false),
            StepKind::Out => self.outer_goal(),
            StepKind::Instruction => {
                self.must_hold()?;
                self.must_be_active()?;
                Ok(Goal::Instruction(self.context()))
            }
        }
    }

    /// Continues to the goal, but no further than to the end of a tick: [`Reason::Time`] there. For a board that is run
    /// elsewhere, and continues later.
    pub(crate) fn proceed(&mut self, goal: &Goal, limit: Ticks, events: Events<'_>) -> Stop {
        self.limit = limit;
        self.run(goal, events)
    }

    /// Stops where the board is, between two ticks.
    pub(crate) fn halt(&mut self, reason: Reason) -> Stop {
        self.stopped(reason, None)
    }

    /// Continues to the next line of the selected thread, into the functions that it calls.
    ///
    /// # Errors
    /// The thread runs nothing, or nothing is known about its program.
    pub fn step(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        let goal = self.goal(StepKind::Into)?;
        Ok(self.run(&goal, events))
    }

    /// Continues to the next line of the function, or of its caller.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn next(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        let goal = self.goal(StepKind::Over)?;
        Ok(self.run(&goal, events))
    }

    /// Continues until the function that is looked at has returned.
    ///
    /// # Errors
    /// It is the outermost.
    pub fn finish(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        let goal = self.goal(StepKind::Out)?;
        Ok(self.run(&goal, events))
    }

    fn outer_goal(&self) -> Result<Goal, DebugError> {
        self.must_hold()?;
        let context = self.context();
        let frames = self.frames(context);
        let caller = frames.get(self.frame + 1);
        let caller = caller.ok_or("\"finish\" not meaningful in the outermost frame.")?;
        let is_inlined = frames.get(self.frame).is_some_and(|frame| frame.real == caller.real);
        if is_inlined {
            return Ok(Goal::Leave { context, depth: frames.len() - self.frame });
        }
        let depth = frames.last().map_or(0, |last| last.real + 1) - caller.real;
        Ok(Goal::Above { context, depth, at: vec![caller.view.continues_at.get()] })
    }

    /// Executes one instruction of the selected thread.
    ///
    /// # Errors
    /// The thread is not active.
    pub fn step_instruction(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        let goal = self.goal(StepKind::Instruction)?;
        Ok(self.run(&goal, events))
    }

    /// Continues to a place: `FILE:LINE`, `LINE`, `FUNCTION` or `*ADDRESS`.
    ///
    /// # Errors
    /// There is no code.
    pub fn until(&mut self, place: &str, events: Events<'_>) -> Result<Stop, DebugError> {
        self.must_hold()?;
        let (found, note) = self.resolve(place, None)?;
        if !note.is_empty() {
            self.messages.push_back(note.trim_start().to_owned());
        }
        let at = found.iter().map(|one| one.address).collect();
        let caller = self.outer_goal().ok().map(Box::new);
        Ok(self.run(&Goal::Until { at, caller }, events))
    }

    /// Goes on to a later line of the function that is looked at, or to its caller.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn until_later(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        let context = self.context();
        let from = self.frames(context).first().map(|frame| (frame.address, self.depth(context)));
        loop {
            let stop = self.next(events)?;
            let now = self.frames(context).first().map(|frame| (frame.address, self.depth(context)));
            let is_back =
                from.zip(now).is_some_and(|((start, depth), (at, now))| now == depth && at <= start);
            if stop.reason != Reason::Step || !is_back {
                return Ok(stop);
            }
        }
    }

    /// Continues to the end of a tick.
    pub fn run_to(&mut self, tick: Ticks, events: Events<'_>) -> Stop {
        self.run(&Goal::Tick(tick), events)
    }

    /// Continues to the end of the tick in progress, or of the next one.
    pub fn step_tick(&mut self, events: Events<'_>) -> Stop {
        let tick = self.session.tick();
        let tick = if self.session.held().is_some() { tick } else { tick.next() };
        self.run(&Goal::Tick(tick), events)
    }

    /// Continues to the end of the next tick in which the selected thread has the processor.
    ///
    /// # Errors
    /// The time of the target passes by itself.
    pub fn step_slice(&mut self, events: Events<'_>) -> Result<Stop, DebugError> {
        self.session.require(Capability::StopTime)?;
        loop {
            let stop = self.step_tick(events);
            let is_its = self.session.target().turn() == vm::scheduler::SliceOwner::User(self.thread);
            if stop.reason != Reason::Time || is_its || self.session.tick() >= self.limit {
                return Ok(stop);
            }
        }
    }

    fn must_be_active(&self) -> Result<(), DebugError> {
        let thread = self.thread;
        let is_active = self.session.thread(thread).is_active() || self.context() == ContextId::CALLBACK;
        if is_active { Ok(()) } else { Err(format!("Thread {thread} is not active.").into()) }
    }

    fn line_goal(&self, into: bool) -> Result<Goal, DebugError> {
        self.must_hold()?;
        self.must_be_active()?;
        self.programs.of(self.thread)?;
        let context = self.context();
        let frames = self.frames(context);
        let place = frames.first().and_then(|frame| frame.place.clone());
        Ok(Goal::Line { context, line: place.map_or(0, |place| place.line), depth: frames.len(), into })
    }

    /// Sets the addresses at which contexts are held for breakpoints and a goal.
    pub(super) fn arm(&mut self, goal: &Goal, also: Option<CodeAddr>) {
        let mut addresses: Vec<u32> = also.map(CodeAddr::get).into_iter().collect();
        let mut ranges: Vec<(GuestAddr, u32)> = Vec::new();
        for breakpoint in self.breakpoints.iter().filter(|breakpoint| breakpoint.is_enabled) {
            if let BreakpointKind::Code(_, at) = &breakpoint.kind {
                addresses.extend(at);
            }
            let Some(watched) = breakpoint.subject.watched() else { continue };
            ranges.extend(&watched.ranges);
            if watched.has_registers {
                // A register is looked at before every line.
                addresses.extend(self.statements());
            }
        }
        let caller = if let Goal::Until { caller, .. } = goal { caller.as_deref() } else { None };
        match caller.unwrap_or(goal) {
            Goal::Line { .. } | Goal::Leave { .. } => addresses.extend(self.statements()),
            Goal::Above { at, .. } => addresses.extend(at),
            Goal::Address(_) | Goal::Until { .. } => {}
            Goal::None | Goal::Instruction(_) | Goal::Tick(_) => {}
        }
        if let Goal::Address(at) | Goal::Until { at, .. } = goal {
            addresses.extend(at);
        }
        self.session.set_breakpoints(addresses.into_iter().filter_map(CodeAddr::new));
        self.session.set_watched(&ranges);
        self.session.set_accessed(&self.accessed());
        self.session.set_stepping(if let Goal::Instruction(context) = goal { Some(*context) } else { None });
    }

    /// Nothing is held any more.
    pub(super) fn disarm(&mut self) {
        self.session.set_breakpoints([]);
        self.session.set_watched(&[]);
        self.session.set_accessed(&[]);
        self.session.set_stepping(None);
    }

    /// The memory whose accesses stop.
    fn accessed(&self) -> Vec<AccessRange> {
        let range = |breakpoint: &Breakpoint| {
            let BreakpointKind::Access(_, access) = &breakpoint.kind else { return None };
            let (address, size) = breakpoint.subject.accessed()?.own?;
            Some(AccessRange { address, size, has_stores: *access == WatchedAccess::ReadWrite })
        };
        self.breakpoints.iter().filter(|breakpoint| breakpoint.is_enabled).filter_map(range).collect()
    }

    /// The statements of all programs.
    fn statements(&self) -> Vec<u32> {
        let threads: Vec<_> = self.programs.all().map(|(thread, _)| thread).collect();
        let of = |thread| self.programs.statements(thread, None).into_iter().map(|one| one.address);
        threads.into_iter().flat_map(of).collect()
    }

    fn run(&mut self, goal: &Goal, events: Events<'_>) -> Stop {
        self.refresh_watches();
        self.arm(goal, None);
        let stop = self.run_armed(goal, events);
        self.disarm();
        stop
    }

    fn run_armed(&mut self, goal: &Goal, events: Events<'_>) -> Stop {
        let limit = if let Goal::Tick(tick) = goal { *tick } else { self.limit };
        let mut infos: Vec<_> = self.session.debug().into_iter().map(|(_, info)| info).collect();
        let catches = self.catches.clone();
        let mut active = self.session.target().active();
        loop {
            if self.is_interrupted() {
                return self.stopped(Reason::Interrupted, None);
            }
            let before = active;
            let bits = self.bits();
            let mut caught = None;
            let step = self.next_tick(limit);
            let mut programs_changed = false;
            self.session.step(step, &mut |event| {
                programs_changed |= matches!(event.kind, EventKind::Loaded(..));
                if caught.is_none() {
                    caught = catch(&event, &catches, &infos);
                }
                events(&event);
            });
            if programs_changed {
                self.programs.update(&self.session);
                self.compile_conditions();
                infos = self.session.debug().into_iter().map(|(_, info)| info).collect();
            }
            if let Some(timeline) = &mut self.timeline {
                let _ = timeline.keep(&mut self.session);
            }
            if let Some(hold) = self.session.take_hold() {
                if let Some(reason) = self.stop_reason(hold, goal, true) {
                    return self.stopped(reason, Some(hold.context));
                }
                active = self.session.target().active();
                continue;
            }
            if let Some((reason, thread)) = caught {
                return self.stopped(reason, thread.map(ContextId::of));
            }
            active = self.session.target().active();
            if let Some(reason) = self.between_ticks(goal, (before, active), &bits) {
                let context = if let Reason::Started(thread) | Reason::Ended(thread) = &reason {
                    Some(ContextId::of(*thread))
                } else {
                    None
                };
                return self.stopped(reason, context);
            }
            if self.session.tick() >= limit {
                return self.stopped(Reason::Time, None);
            }
            if let Some(reason) = self.session.target().loss_reason() {
                let reason = Reason::LinkLost(reason.to_owned());
                return self.stopped(reason, None);
            }
            if active.is_empty()
                && !self.is_lent()
                && self.session.has_ended()
                && !matches!(goal, Goal::Tick(_))
            {
                self.session.finish(&mut |event| events(&event));
                return self.stopped(Reason::AllEnded, None);
            }
        }
    }

    /// Returns whether a stop was requested since the last call.
    fn is_interrupted(&self) -> bool {
        // To exchange a value takes a processor much longer than to read it, and this is asked every tick.
        self.interrupt.load(Ordering::Relaxed) && self.interrupt.swap(false, Ordering::Relaxed)
    }

    /// Repeats the inputs that were made at this instant before, and returns the tick up to which the board may run
    /// until the next ones.
    pub(super) fn next_tick(&mut self, limit: Ticks) -> Ticks {
        let Some(timeline) = &mut self.timeline else { return limit };
        timeline.redo(&mut self.session);
        timeline.next_input().map_or(limit, |next| next.min(limit))
    }

    fn bits(&self) -> Vec<bool> {
        if self.catches.bits.is_empty() {
            return Vec::new();
        }
        self.catches.bits.iter().map(|bit| Bit::new(*bit).is_some_and(|bit| self.session.bit(bit))).collect()
    }

    /// Returns the reason to stop at the end of a tick, if there is one; takes the threads that were and are active.
    fn between_ticks(
        &mut self,
        goal: &Goal,
        (before, now): (ThreadSet, ThreadSet),
        bits: &[bool],
    ) -> Option<Reason> {
        if let Some(reason) = self.judge_tick(true) {
            return Some(reason);
        }
        if before == now && bits.is_empty() {
            return None;
        }
        let changed = |from: ThreadSet, to: ThreadSet| {
            ThreadId::all().filter(move |thread| from.contains(*thread) && !to.contains(*thread))
        };
        let stepped = match goal {
            Goal::Line { context, .. }
            | Goal::Leave { context, .. }
            | Goal::Above { context, .. }
            | Goal::Instruction(context) => context.thread(),
            Goal::None | Goal::Address(_) | Goal::Until { .. } | Goal::Tick(_) => None,
        };
        let is_meant = |thread: &ThreadId| self.catches.ends || stepped == Some(*thread);
        if let Some(thread) = changed(before, now).find(is_meant) {
            return Some(Reason::Ended(thread));
        }
        if self.catches.starts
            && let Some(thread) = changed(now, before).next()
        {
            return Some(Reason::Started(thread));
        }
        let changed = self.bits().iter().zip(bits).position(|(now, before)| now != before)?;
        let level = u8::from(self.bits()[changed]);
        Some(Reason::Bit(format!("bit {} is {level}", self.catches.bits[changed])))
    }

    pub(super) fn is_reached(&self, goal: &Goal, context: ContextId, at: u32) -> bool {
        match goal {
            Goal::Line { context: of, line, depth: from, into } => {
                let Some(place) = self.place(at).filter(|_| *of == context) else { return false };
                let now = self.depth(context);
                now < *from || (now == *from && place.line != *line) || (now > *from && *into)
            }
            Goal::Leave { context: of, depth: from } => *of == context && self.depth(context) < *from,
            Goal::Above { context: of, depth: wanted, at: addresses } => {
                *of == context && addresses.contains(&at) && self.session.frames(context).len() <= *wanted
            }
            Goal::Address(addresses) => addresses.contains(&at),
            Goal::Until { at: addresses, caller } => {
                let has_left = caller.as_ref().is_some_and(|goal| self.is_reached(goal, context, at));
                addresses.contains(&at) || has_left
            }
            Goal::None | Goal::Instruction(_) | Goal::Tick(_) => false,
        }
    }
}

/// Returns the reason for which an event stops the board, if it does, and its context.
pub(super) fn catch(
    event: &Event,
    catches: &super::Catchpoints,
    infos: &[runtime::debug::DebugInfo],
) -> Option<(Reason, Option<ThreadId>)> {
    match &event.kind {
        EventKind::Trap(trap) if !catches.no_traps => {
            let text = cc67_host::remark::describe(event, infos).unwrap_or_else(|| trap.to_string());
            Some((Reason::Trap(text), trap.thread))
        }
        EventKind::Remark(_) if catches.remarks => {
            Some((Reason::Remark(cc67_host::remark::describe(event, infos)?), None))
        }
        EventKind::ConsoleLine(line) => {
            let line = String::from_utf8_lossy(line);
            let is_meant = catches.texts.iter().any(|text| line.contains(text.as_str()));
            is_meant.then(|| (Reason::Console(line.into_owned()), None))
        }
        _ => None,
    }
}
