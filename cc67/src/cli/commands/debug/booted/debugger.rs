//! The debugger of a booted board: breakpoints, runs, steps, and the way back.

use std::collections::BTreeSet;

use boot::{Halted, Ran, Reached};
use cc67_host::Interrupter;
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::{Cycles, ThreadId, Ticks};
use runtime::Event;
use vm::engine::ContextId;

use super::calls::{self, OpenCalls, is_of_program};
use super::history::{History, Mark};
use super::programs::{BootedProgram, BootedPrograms, CodeLine, ShownValue, items_in};
use crate::cli::session::booted::Booted;

/// Cycles of a tick.
const TICK: u64 = Cycles::PER_TICK.get() as u64;
/// Ticks without an active thread after which what programs have printed has come, too.
const QUIET: u32 = 22;

/// What receives the events of a run.
pub(super) type Events<'a> = &'a mut dyn FnMut(Event);

/// Where to stop.
#[derive(Debug)]
pub(super) struct Breakpoint {
    /// Its number, from 1.
    pub(super) id: u32,
    /// In words.
    pub(super) text: String,
    addresses: Vec<u32>,
    condition: Option<String>,
    is_temporary: bool,
    /// How often it has stopped.
    pub(super) hits: u64,
}

/// Why the board stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Reason {
    /// At a breakpoint.
    Breakpoint(u32),
    /// A step is over.
    Step,
    /// The requested time, or the limit.
    Time,
    /// A thread has ended.
    Ended(ThreadId),
    /// All threads have ended.
    AllEnded,
    /// Somebody has interrupted it.
    Interrupted,
    /// The firmware ran away.
    Crashed(String),
    /// The beginning of the past that is kept.
    BeginOfHistory,
}

/// Why the board stands, and whose program is about to continue, if it is one's.
pub(super) type Stop = (Reason, Option<ContextId>);

/// A call in progress.
#[derive(Clone, Debug)]
pub(super) struct ShownCall {
    /// The next packet, or the call.
    pub(super) at: u32,
    /// Where that is in the source.
    pub(super) place: Option<CodeLine>,
    /// The function of the firmware that it is.
    pub(super) firmware: Option<String>,
}

/// What ends a run.
#[derive(Clone, Debug)]
enum Goal {
    /// Nothing but breakpoints and ends.
    None,
    /// Another line of a context, or one with fewer calls in progress; with more only if `into`.
    Line { context: ContextId, line: u32, depth: usize, into: bool },
    /// The place to which a function returns, with fewer calls in progress.
    Leave { context: ContextId, depth: usize, back: u32 },
    /// One of these packets.
    Place(Vec<u32>),
    /// The end of a tick.
    Tick(Ticks),
}

/// What is wanted of the past.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    /// The last breakpoint.
    Breakpoint,
    /// The beginning of the last line with at most this many calls in progress.
    Line { context: ContextId, depth: usize },
}

/// A debugger of a booted board.
pub(super) struct Debugger {
    /// The board.
    pub(super) booted: Booted,
    /// What is known about its programs.
    pub(super) programs: BootedPrograms,
    calls: OpenCalls,
    history: History,
    /// The part of the run under way: the tick of its begin, the cycle of its end.
    part: (Ticks, u64),
    /// Ticks in which no thread was active.
    quiet: u32,
    breakpoints: Vec<Breakpoint>,
    next_id: u32,
    /// The thread that is looked at.
    pub(super) thread: ThreadId,
    limit: Ticks,
    interrupter: Interrupter,
}

impl Debugger {
    /// A debugger of a board on which programs are about to begin.
    pub(super) fn new(mut booted: Booted, limit: Ticks) -> Self {
        let programs = BootedPrograms::new(booted.programs(), booted.compile_options());
        let thread = programs.all().first().map(|known| known.thread);
        let thread = thread.or_else(|| ThreadId::all().next()).expect("there are threads");
        let interrupter = booted.interrupter();
        let part = (booted.tick(), booted.board.cycle() + TICK);
        let (calls, packets) = (OpenCalls::default(), booted.board.packets());
        let begin = Mark { board: booted.board.snapshot(), calls: calls.clone(), part, packets };
        Self {
            booted,
            programs,
            calls,
            history: History::new(begin),
            part,
            quiet: 0,
            breakpoints: Vec::new(),
            next_id: 1,
            thread,
            limit,
            interrupter,
        }
    }

    /// The breakpoints.
    pub(super) fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints
    }

    /// Sets a breakpoint; its number and where it is.
    pub(super) fn break_at(
        &mut self,
        place: &str,
        thread: Option<ThreadId>,
        (condition, is_temporary): (Option<&str>, bool),
    ) -> Result<(u32, String), String> {
        let addresses = self.programs.resolve(place, thread)?;
        if let Some(condition) = condition {
            self.evaluate(condition)?;
        }
        let text = addresses.first().and_then(|at| Some((at, self.programs.place(*at)?))).map_or_else(
            || place.to_owned(),
            |(_, place)| format!("{}, {}:{}", place.function, place.file, place.line),
        );
        let id = self.next_id;
        self.next_id += 1;
        let condition = condition.map(str::to_owned);
        self.breakpoints.push(Breakpoint {
            id,
            text: text.clone(),
            addresses,
            condition,
            is_temporary,
            hits: 0,
        });
        Ok((id, text))
    }

    /// Deletes a breakpoint, or all; whether there was one.
    pub(super) fn delete(&mut self, id: Option<u32>) -> bool {
        let count = self.breakpoints.len();
        self.breakpoints.retain(|one| id.is_some_and(|id| one.id != id));
        self.breakpoints.len() < count || id.is_none()
    }

    /// The calls in progress of a context, innermost first.
    pub(super) fn frames(&self, context: ContextId) -> Vec<ShownCall> {
        let Some((at, function)) = self.calls.last(context) else { return Vec::new() };
        let name = |function: u32| {
            let found = self.booted.board.file().function_at(function);
            ShownCall {
                at: function,
                place: None,
                firmware: Some(found.map_or_else(String::new, |(name, _)| name)),
            }
        };
        let outer = self.calls.entered(context).filter_map(|one| one.call);
        let own = std::iter::once(at).chain(outer);
        let own = own.map(|at| ShownCall { at, place: self.programs.place(at), firmware: None });
        function.map(name).into_iter().chain(own).collect()
    }

    /// Where the program of a context is.
    pub(super) fn place(&self, context: ContextId) -> Option<CodeLine> {
        self.calls.last(context).and_then(|(at, _)| self.programs.place(at))
    }

    /// The value of an expression.
    pub(super) fn evaluate(&mut self, expression: &str) -> Result<ShownValue, String> {
        let items = items_in(expression).into_iter();
        let items: Vec<_> = items.map(|(name, item)| (name, self.booted.item(item))).collect();
        self.known()?.evaluate(expression, &items, self.booted.board.memory())
    }

    fn known(&self) -> Result<&BootedProgram, String> {
        self.programs.of(self.thread).ok_or_else(|| format!("no program is loaded in thread {}", self.thread))
    }

    /// Gives a variable another value; the past that is kept begins here then.
    pub(super) fn set(&mut self, place: &str, value: &str) -> Result<(), String> {
        let number = self.evaluate(value)?.number.ok_or_else(|| format!("`{value}` is not a number"))?;
        let (address, bytes) = self.known()?.stored(place, number, self.booted.board.memory())?;
        let stored = self.booted.board.memory_mut().poke_bytes(address, &bytes);
        stored.map_err(|_| format!("there is no memory at {address}"))?;
        self.history = History::new(self.mark());
        Ok(())
    }

    /// Goes on to the next stop.
    pub(super) fn go(&mut self, events: Events<'_>) -> Stop {
        self.run(&Goal::None, events)
    }

    /// Goes on to a place.
    pub(super) fn go_to(&mut self, place: &str, events: Events<'_>) -> Result<Stop, String> {
        let addresses = self.programs.resolve(place, None)?;
        Ok(self.run(&Goal::Place(addresses), events))
    }

    /// Goes on to the end of a tick, or back to it.
    pub(super) fn go_to_tick(&mut self, tick: Ticks, events: Events<'_>) -> Stop {
        if tick < self.booted.tick() {
            let marks = self.history.marks();
            let Some(index) = marks.iter().rposition(|mark| mark.part.0 <= tick) else {
                self.restore(0);
                return (Reason::BeginOfHistory, None);
            };
            self.restore(index);
            let breakpoints = std::mem::take(&mut self.breakpoints);
            let stop = self.run(&Goal::Tick(tick), &mut |_| ());
            self.breakpoints = breakpoints;
            return stop;
        }
        self.run(&Goal::Tick(tick), events)
    }

    /// Goes on to the next line of the thread that is looked at, into the functions that it calls or over them.
    pub(super) fn step(&mut self, into: bool, events: Events<'_>) -> Stop {
        let context = self.context();
        let depth = self.calls.entered(context).len();
        // Of one that has not begun, the first line.
        let line = self.place(context).map_or(0, |place| place.line);
        self.run(&Goal::Line { context, line, depth: depth.max(1), into }, events)
    }

    /// Runs to the place to which the function returns.
    pub(super) fn finish(&mut self, events: Events<'_>) -> Result<Stop, String> {
        let context = self.context();
        let depth = self.calls.entered(context).len();
        let inner = self.calls.entered(context).next().filter(|inner| inner.call.is_some());
        let back = inner.ok_or("\"finish\" not meaningful in the outermost frame.")?.back;
        Ok(self.run(&Goal::Leave { context, depth, back }, events))
    }

    /// Executes the next packet of the thread that is looked at.
    pub(super) fn step_packet(&mut self, events: Events<'_>) -> Stop {
        let context = self.context();
        self.arm(&Goal::None);
        let before = self.booted.board.packets();
        loop {
            if self.interrupter.take() {
                return (Reason::Interrupted, None);
            }
            let ran = match self.booted.board.cycle() + 1 {
                next if next < self.part.1 => self.booted.board.run_to_stop(next),
                _ => self.advance(events),
            };
            if let Err(Halted::Crashed(crash)) = ran {
                return (Reason::Crashed(crash.to_string()), None);
            }
            let arrival = self.arrive();
            if calls::context(&arrival) == Some(context) && self.booted.board.packets() > before {
                return (Reason::Step, Some(context));
            }
            if let Some(thread) = context.thread().filter(|thread| !self.is_active(*thread)) {
                return (Reason::Ended(thread), None);
            }
        }
    }

    /// Goes back to the last breakpoint.
    pub(super) fn reverse_go(&mut self) -> Stop {
        self.back(Wanted::Breakpoint)
    }

    /// Goes back to the beginning of the last line, into functions that were called or over them.
    pub(super) fn reverse_step(&mut self, into: bool) -> Stop {
        let context = self.context();
        let depth = if into { usize::MAX } else { self.calls.entered(context).len() };
        self.back(Wanted::Line { context, depth })
    }

    /// Begins again.
    pub(super) fn restart(&mut self) {
        self.restore(0);
    }

    /// How many snapshots there are, and the tick of the first one.
    pub(super) fn past(&self) -> (usize, Ticks) {
        let marks = self.history.marks();
        (marks.len(), marks.first().map_or(Ticks::new(0), |mark| mark.part.0))
    }

    /// The context of the thread that is looked at.
    pub(super) fn context(&self) -> ContextId {
        ContextId::of(self.thread)
    }

    fn is_active(&self, thread: ThreadId) -> bool {
        self.booted.board.is_active(thread).unwrap_or(false)
    }

    fn mark(&mut self) -> Mark {
        let Self { booted, calls, part, .. } = self;
        let packets = booted.board.packets();
        Mark { board: booted.board.snapshot(), calls: calls.clone(), part: *part, packets }
    }

    fn restore(&mut self, index: usize) {
        let Some(mark) = self.history.marks().get(index) else { return };
        self.booted.board.restore(&mark.board);
        (self.calls, self.part, self.quiet) = (mark.calls.clone(), mark.part, 0);
        self.booted.looks.hold(&mut self.booted.board);
    }

    /// Sets the stops that breakpoints and a goal need, and those that record calls.
    fn arm(&mut self, goal: &Goal) {
        let file = self.booted.board.file();
        let functions = FIRMWARE_FUNCTIONS.iter().filter_map(|function| file.address(function.name));
        let mut stops: BTreeSet<u32> = functions.map(|at| at.get()).collect();
        stops.extend(self.programs.entries());
        stops.extend(self.breakpoints.iter().flat_map(|one| &one.addresses));
        match goal {
            Goal::Line { .. } => stops.extend(self.programs.statements()),
            Goal::Leave { back, .. } => _ = stops.insert(*back),
            Goal::Place(addresses) => stops.extend(addresses),
            Goal::None | Goal::Tick(_) => {}
        }
        self.booted.looks.set_stops(&mut self.booted.board, stops);
    }

    /// Runs to a stop or through the part under way.
    fn advance(&mut self, events: Events<'_>) -> Result<Ran, Halted> {
        let ran = self.booted.advance_to_stop(self.part, events)?;
        if ran == Ran::Through {
            self.part = (self.booted.tick(), self.booted.board.cycle() + TICK);
            if self.history.is_due(self.part.0, self.booted.board.packets()) {
                let mark = self.mark();
                self.history.add(mark);
            }
        }
        Ok(ran)
    }

    /// Notes where the processor is.
    fn arrive(&mut self) -> Reached {
        let arrival = self.booted.board.reached();
        self.calls.arrive(&arrival, self.programs.begins(arrival.pc));
        arrival
    }

    fn run(&mut self, goal: &Goal, events: Events<'_>) -> Stop {
        self.arm(goal);
        // What was asked while nothing ran is over.
        let _ = self.interrupter.take();
        loop {
            if self.interrupter.take() {
                return (Reason::Interrupted, None);
            }
            match self.advance(events) {
                Err(Halted::Crashed(crash)) => return (Reason::Crashed(crash.to_string()), None),
                Ok(Ran::ToStop) => {
                    let arrival = self.arrive();
                    if let Some(context) = calls::context(&arrival).filter(|_| is_of_program(arrival.pc))
                        && let Some(reason) = self.judge(arrival.pc, context, goal)
                    {
                        return (reason, Some(context));
                    }
                }
                Ok(Ran::Through) => {
                    if let Some(reason) = self.between(goal) {
                        return (reason, None);
                    }
                }
            }
        }
    }

    /// Whether a context that is at a packet has to stop there, and why.
    fn judge(&mut self, at: u32, context: ContextId, goal: &Goal) -> Option<Reason> {
        if let Some(id) = self.breakpoint_at(at, context) {
            if let Some(one) = self.breakpoints.iter_mut().find(|one| one.id == id) {
                one.hits += 1;
            }
            self.breakpoints.retain(|one| one.id != id || !one.is_temporary);
            return Some(Reason::Breakpoint(id));
        }
        let is_reached = match goal {
            Goal::Line { context: of, line, depth, into } if *of == context => {
                let now = self.calls.entered(context).len();
                let is_other = || self.programs.place(at).is_some_and(|place| place.line != *line);
                let is_there = now < *depth || now == *depth && is_other() || now > *depth && *into;
                is_there && self.programs.begins_line(at)
            }
            Goal::Leave { context: of, depth, back } => {
                *of == context && at == *back && self.calls.entered(context).len() < *depth
            }
            Goal::Place(addresses) => addresses.contains(&at),
            Goal::Line { .. } | Goal::None | Goal::Tick(_) => false,
        };
        is_reached.then_some(Reason::Step)
    }

    /// The breakpoint at a packet, whose condition holds there.
    fn breakpoint_at(&mut self, at: u32, context: ContextId) -> Option<u32> {
        let here = self.breakpoints.iter().filter(|one| one.addresses.contains(&at));
        let here: Vec<_> = here.map(|one| (one.id, one.condition.clone())).collect();
        let thread = self.thread;
        self.thread = context.thread().unwrap_or(thread);
        let found = here.into_iter().find(|(_, condition)| {
            let value = condition.as_deref().map(|condition| self.evaluate(condition));
            // A condition that has no value any more stops, too.
            value.is_none_or(|value| value.map_or(true, |value| value.number != Some(0.0)))
        });
        self.thread = thread;
        found.map(|(id, _)| id)
    }

    /// What is to stop at the end of a part.
    fn between(&mut self, goal: &Goal) -> Option<Reason> {
        let stepped = match goal {
            Goal::Line { context, .. } | Goal::Leave { context, .. } => context.thread(),
            Goal::None | Goal::Place(_) | Goal::Tick(_) => None,
        };
        let entered = |calls: &OpenCalls, thread: ThreadId| calls.last(ContextId::of(thread)).is_some();
        let ended =
            ThreadId::all().filter(|thread| entered(&self.calls, *thread) && !self.is_active(*thread));
        let ended: Vec<_> = ended.collect();
        ended.iter().for_each(|thread| self.calls.end(*thread));
        if let Some(thread) = stepped.filter(|thread| ended.contains(thread)) {
            return Some(Reason::Ended(thread));
        }
        let limit = if let Goal::Tick(tick) = goal { *tick } else { self.limit };
        if self.booted.tick() >= limit {
            return Some(Reason::Time);
        }
        let is_quiet = self.booted.active().is_empty() && !self.booted.board.is_starting();
        self.quiet = if is_quiet { self.quiet + 1 } else { 0 };
        (self.quiet >= QUIET && !matches!(goal, Goal::Tick(_))).then_some(Reason::AllEnded)
    }

    /// Goes back to what is wanted: the stretch after each snapshot is executed again, the latest first.
    fn back(&mut self, wanted: Wanted) -> Stop {
        let mut bound = self.booted.board.packets();
        self.arm(&match wanted {
            Wanted::Breakpoint => Goal::None,
            Wanted::Line { context, depth } => Goal::Line { context, line: 0, depth, into: true },
        });
        for index in (0..self.history.marks().len()).rev() {
            let begin = self.history.marks().get(index).map_or(0, |mark| mark.packets);
            if begin >= bound {
                continue;
            }
            if let Some((packets, reason, context)) = self.search(index, bound, wanted) {
                self.search_to(index, packets);
                return (reason, Some(context));
            }
            bound = begin;
        }
        self.restore(0);
        (Reason::BeginOfHistory, None)
    }

    /// The last place between a snapshot and a bound that is wanted.
    fn search(&mut self, index: usize, bound: u64, wanted: Wanted) -> Option<(u64, Reason, ContextId)> {
        self.restore(index);
        let (mut found, mut last) = (None, None);
        loop {
            let ran = self.advance(&mut |_| ());
            let packets = self.booted.board.packets();
            let Some(ran) = ran.ok().filter(|_| packets < bound) else { return found };
            if ran != Ran::ToStop {
                continue;
            }
            let arrival = self.arrive();
            let Some(context) = calls::context(&arrival).filter(|_| is_of_program(arrival.pc)) else {
                continue;
            };
            let reason = match wanted {
                Wanted::Breakpoint => self.breakpoint_at(arrival.pc, context).map(Reason::Breakpoint),
                Wanted::Line { context: of, depth } => {
                    let now = self.calls.entered(context).len();
                    let is_meant = of == context && now <= depth && self.programs.begins_line(arrival.pc);
                    let line =
                        self.programs.place(arrival.pc).filter(|_| is_meant).map(|place| (place.line, now));
                    let is_new = line.is_some() && line != last;
                    last = line.or(last);
                    is_new.then_some(Reason::Step)
                }
            };
            found = reason.map(|reason| (packets, reason, context)).or(found);
        }
    }

    /// Goes from a snapshot to a place that was found.
    fn search_to(&mut self, index: usize, packets: u64) {
        self.restore(index);
        while self.booted.board.packets() < packets {
            match self.advance(&mut |_| ()) {
                Ok(Ran::ToStop) => _ = self.arrive(),
                Ok(Ran::Through) => {}
                Err(_) => return,
            }
        }
    }
}
