//! Plays a stimulus: performs due actions, and watches for conditions.

use std::collections::VecDeque;

use kmotiondef::{Bit, Cycles, ThreadId};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;
use vm::scheduler::ThreadSet;
use vm::thread::Threads;

use super::acts::lines::{drive, let_go};
use super::monitor::Progress;
use super::plans::{DueEvent, MOST_PLANNED, Plans};
use super::scene::Scene;
use super::{Action, Condition, Edge, Rule, Stimulus, Trigger};
use super::{idle, reading};
use crate::io::changes;
use crate::machine::SentByte;
use crate::out::{Message, Out};
use crate::world::WorldAccess;
use crate::world::trace::{Item, View};
use chips::changes::BitChange;

/// A stimulus in progress.
#[derive(Clone, Debug)]
pub(crate) struct Player {
    pub(super) rules: Vec<Rule>,
    /// The progress of each rule.
    pub(super) progress: Vec<Progress>,
    pub(super) plans: Plans,
    /// Console lines that have not been compared with statements yet, and the number of statements that existed when
    /// each was printed.
    lines: VecDeque<(Cycles, String, usize)>,
    /// The last characters that the serial port has sent.
    sent: VecDeque<u8>,
    active: ThreadSet,
    /// The bits whose levels statements have changed.
    moved: Vec<Bit>,
    /// The starts of each thread at the end of the last tick.
    starts: [u32; ThreadId::MAX as usize],
    /// True if the last tick had nothing for which a statement could wait: no thread is active any more.
    is_idle: bool,
}

impl Player {
    /// A player without statements.
    pub(crate) fn new() -> Self {
        Self {
            rules: Vec::new(),
            progress: Vec::new(),
            plans: Plans::default(),
            lines: VecDeque::new(),
            sent: VecDeque::new(),
            active: ThreadSet::EMPTY,
            moved: Vec::new(),
            starts: [0; ThreadId::MAX as usize],
            is_idle: false,
        }
    }

    /// Takes the console lines that were sent since the last call.
    fn take_lines(&mut self, out: &mut Out) {
        while let Some((at, line)) = out.next_line() {
            self.note_line(&line, at);
        }
    }

    /// Prepares for more statements; option boards that they use were detected at power-up.
    pub(crate) fn extend(
        &mut self,
        stimulus: Stimulus,
        access: &mut WorldAccess<'_>,
        memory: &mut GuestMemory,
    ) {
        // Earlier output does not count for the new rules.
        self.take_lines(access.out);
        for rule in stimulus.rules {
            rule.action.announce(access, memory);
            if let Some(Condition::UartSent(_)) = rule.trigger.condition() {
                access.io.uart.listen();
            }
            let index = self.rules.len();
            let is_initial =
                matches!(rule.trigger, Trigger::At(time) if time <= access.now + Cycles::PER_TICK);
            match rule.trigger {
                Trigger::At(time) | Trigger::Every { from: time, .. } => {
                    self.plans.add(time, DueEvent::Rule(index));
                }
                Trigger::When { .. } | Trigger::Within { .. } | Trigger::Always { .. } | Trigger::End => {}
            }
            self.rules.push(rule);
            self.progress.push(Progress::new(is_initial));
        }
    }

    /// Bits whose changes statements wait for.
    pub(crate) fn watched(&self) -> impl Iterator<Item = Bit> {
        self.rules.iter().filter_map(|rule| match rule.trigger.condition()? {
            Condition::Bit(bit, _) => Some(*bit),
            Condition::Printed(_)
            | Condition::UartSent(_)
            | Condition::Starts(_)
            | Condition::Ends(_)
            | Condition::Becomes(_) => None,
        })
    }

    /// The PC has received a line.
    fn note_line(&mut self, line: &[u8], at: Cycles) {
        let line = String::from_utf8_lossy(line).into_owned();
        self.lines.push_back((at, line, self.rules.len()));
    }

    /// Returns whether a thread is still to be started or a command to be sent, so that the run must continue.
    ///
    /// Lines that were sent after the last tick have not been compared yet.
    pub(crate) fn is_busy(&self, has_shown_lines: bool) -> bool {
        let awaits = self.is_waiting();
        let is_due = self.plans.all().any(|due| match due {
            DueEvent::Rule(index) => {
                let rule = &self.rules[index];
                let is_endless = matches!(rule.trigger, Trigger::Every { .. });
                (awaits && !is_endless) || rule.action.keeps_the_run()
            }
            DueEvent::Level(..) | DueEvent::Release(_) | DueEvent::Check => false,
        });
        is_due || (awaits && !(self.is_idle && has_shown_lines))
    }

    /// Returns whether a statement still waits for the first occurrence of its condition in order to start something.
    fn is_waiting(&self) -> bool {
        self.rules.iter().zip(&self.progress).any(|(rule, progress)| {
            let is_once = matches!(rule.trigger, Trigger::When { is_once: true, .. });
            is_once && !progress.happened && rule.action.keeps_the_run()
        })
    }

    /// Returns the number of ticks without any action after the one that began at `now`.
    pub(crate) fn quiet_ticks(&self, now: Cycles) -> u64 {
        let is_ending = self.active.is_empty() && !self.is_idle && self.is_waiting();
        if is_ending || !self.lines.is_empty() { 0 } else { self.plans.quiet_ticks(now) }
    }

    /// Executes the actions due at the beginning of a tick; returns whether there were any.
    pub(crate) fn tick(
        &mut self,
        access: &mut WorldAccess<'_>,
        context: &mut TickContext<'_>,
        changes: &[BitChange],
        sent: &[SentByte],
    ) -> bool {
        self.take_lines(access.out);
        self.is_idle = changes.is_empty()
            && sent.is_empty()
            && self.lines.is_empty()
            && context.threads.active().is_empty();
        self.watch_bits(changes);
        self.watch_uart(sent);
        self.watch_lines();
        self.watch_threads(context);
        self.watch_values(access, context);
        if self.plans.limit() {
            access.out.remark(context.now, Message::TooMuchPlanned { most: MOST_PLANNED });
        }
        let mut acted = false;
        while let Some(due) = self.plans.take(context.now) {
            acted = true;
            match due {
                DueEvent::Level(bit, level) => drive(access, context, bit, level),
                DueEvent::Rule(index) => self.act(access, context, index),
                DueEvent::Release(bit) => {
                    let_go(access, bit);
                }
                DueEvent::Check => {}
            }
        }
        if acted {
            self.forget_done();
        }
        self.is_idle &= !acted;
        self.watch(access, context);
        let turns = self.plans.is_turning();
        self.plans.run(access, context);
        acted || turns
    }

    /// Drops trailing statements that were due once and have acted: otherwise each statement that a person executes
    /// would slow down the following ones.
    fn forget_done(&mut self) {
        while let (
            Some(Rule { trigger: Trigger::At(_), .. }),
            Some(Progress { happened: true, idle: None, .. }),
        ) = (self.rules.last(), self.progress.last())
        {
            self.rules.pop();
            self.progress.pop();
        }
    }

    fn watch_bits(&mut self, changes: &[BitChange]) {
        for change in changes {
            self.trigger_rules(change.at, |condition| {
                matches!(condition, Condition::Bit(bit, edge) if *bit == change.bit && edge.fits(change.level))
            });
        }
    }

    /// Compares the output of the serial port, after each character.
    fn watch_uart(&mut self, sent: &[SentByte]) {
        /// The length of the longest text for which a statement can wait.
        const LONGEST: usize = 256;
        for SentByte { at, byte } in sent {
            self.sent.push_back(*byte);
            if self.sent.len() > LONGEST {
                self.sent.pop_front();
            }
            let bytes: Vec<u8> = self.sent.iter().copied().collect();
            self.trigger_rules(
                *at,
                |condition| matches!(condition, Condition::UartSent(text) if bytes.ends_with(text)),
            );
        }
    }

    fn watch_lines(&mut self) {
        while let Some((at, line, known)) = self.lines.pop_front() {
            self.note_text(&line, at, known);
            self.trigger_rules(
                at,
                |condition| matches!(condition, Condition::Printed(text) if line.contains(text.as_str())),
            );
        }
    }

    fn watch_threads(&mut self, context: &TickContext<'_>) {
        let before = std::mem::replace(&mut self.active, context.threads.active());
        let starts_before = std::mem::replace(&mut self.starts, context.threads.starts());
        let (after, starts) = (self.active, self.starts);
        if before == after && starts_before == starts {
            return;
        }
        for thread in ThreadId::all() {
            let (was_active, is_active) = (before.contains(thread), after.contains(thread));
            // A short program starts and ends within a tick.
            let has_passed =
                !was_active && !is_active && starts_before[thread.index()] != starts[thread.index()];
            if has_passed || !was_active && is_active {
                self.trigger_rules(
                    context.now,
                    |condition| matches!(condition, Condition::Starts(named) if *named == thread),
                );
            }
            if has_passed || was_active && !is_active {
                self.trigger_rules(
                    context.now,
                    |condition| matches!(condition, Condition::Ends(named) if *named == thread),
                );
            }
        }
    }

    /// Something has happened at `at`: plans the rules that waited for it.
    pub(super) fn trigger_rules(&mut self, at: Cycles, fits: impl Fn(&Condition) -> bool) {
        self.begin_waiting(at, &fits);
        for index in 0..self.rules.len() {
            let Trigger::When { condition, after, is_once } = &self.rules[index].trigger else { continue };
            let time = at + *after;
            let was_due = self.progress[index].last_due;
            if fits(condition) && !(*is_once && was_due.is_some()) && was_due != Some(time) {
                self.progress[index].last_due = Some(time);
                self.plans.add(time, DueEvent::Rule(index));
            }
        }
    }

    fn act(&mut self, access: &mut WorldAccess<'_>, context: &mut TickContext<'_>, index: usize) {
        let now = context.now;
        if let Trigger::Every { period, from, until, ref while_met } = self.rules[index].trigger {
            let is_so = while_met.as_ref().is_none_or(|met| self.look(access, context, index, met).0);
            // Counted from the first, so that rounding to ticks does not add up.
            let next = from + Cycles::new(((now - from).get() / period.get() + 1) * period.get());
            if until.is_none_or(|until| next <= until) {
                self.plans.add(next, DueEvent::Rule(index));
            }
            if !is_so {
                return;
            }
        }
        self.progress[index].happened = true;
        let Rule { place, action, .. } = self.rules[index].clone();
        let place = place.to_string();
        let Self { plans, moved, progress, .. } = self;
        let mut scene = Scene { plans, access, context, place: &place, moved, is_checked: false };
        let idle = idle::state(&scene, &action);
        let bit = idle::bit(&action);
        action.act(&mut scene);
        let is_checked = scene.is_checked;
        let progress = &mut progress[index];
        if idle.is_none() {
            progress.has_changed = true;
            moved.extend(bit.filter(|bit| !moved.contains(bit)));
        } else if !progress.is_initial {
            progress.idle = idle;
        }
        if is_checked {
            self.check(access, context, index);
        }
    }

    /// The statements that have had no effect.
    fn never_happened(&self, view: &View<'_>, threads: &Threads) -> Vec<String> {
        let idle = self.rules.iter().zip(&self.progress).filter(|(_, progress)| !progress.happened);
        idle.map(|(rule, progress)| {
            let near = || progress.near.as_ref().map(|near| format!(" (a line contains \"{near}\")"));
            let reason = unchanged_level(rule, progress, view).or_else(|| other_reading(rule, view));
            let reason =
                reason.or_else(near).or_else(|| too_late(rule, view)).or_else(|| still_runs(rule, threads));
            format!("{}: {}{}", rule.place, rule.trigger, reason.unwrap_or_default())
        })
        .collect()
    }

    /// Checks, at the end of the run, the expectations for the end, and those later than the run lasted.
    pub(crate) fn finish(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        changes::scan_virtual_bits(&mut access.io.pins.changes, context.memory, access.now);
        self.take_lines(access.out);
        self.watch_bits(&access.io.pins.changes.take());
        self.watch_lines();
        self.watch_threads(context);
        let late = self.plans.take_all().filter_map(|due| match due {
            DueEvent::Rule(index) => Some(index),
            DueEvent::Level(..) | DueEvent::Release(_) | DueEvent::Check => None,
        });
        let mut checked: Vec<usize> = late.collect();
        checked.extend((0..self.rules.len()).filter(|&index| self.rules[index].trigger == Trigger::End));
        for index in checked {
            self.check(access, context, index);
        }
        self.finish_watching(access, context);
        let view = View::new(access.machine, access.io, context.now, context.memory);
        let statements = self.never_happened(&view, context.threads);
        if !statements.is_empty() {
            access.out.remark(context.now, Message::NeverHappened { statements: statements.join("; ") });
        }
        self.finish_doubts(access, context);
    }
}

/// The level of a bit for whose edge a statement waits, if the bit had the level after that edge all the time.
fn unchanged_level(rule: &Rule, progress: &Progress, view: &View<'_>) -> Option<String> {
    match rule.trigger.condition()? {
        Condition::Bit(bit, edge @ (Edge::Rises | Edge::Falls)) if progress.last_due.is_none() => {
            let level = view.item(Item::of_bit(*bit)) != 0.0;
            edge.fits(level).then(|| format!(" (it was {} all the time)", u8::from(level)))
        }
        _ => None,
    }
}

/// A thread that has not ended although a statement waits for its end.
fn still_runs(rule: &Rule, threads: &Threads) -> Option<String> {
    let Condition::Ends(thread) = rule.trigger.condition()? else { return None };
    let effect = match &rule.action {
        Action::Start(other) => format!(", which still runs: thread {other} was not started"),
        _ => ", which still runs".to_owned(),
    };
    threads.state(*thread).is_active().then_some(effect)
}

/// The end of a run that was over before the moment of a statement, and a remedy where that was probably meant in
/// milliseconds.
fn too_late(rule: &Rule, view: &View<'_>) -> Option<String> {
    const LONG: f64 = 10.0;
    const MS: f64 = 1000.0;
    let Trigger::At(time) = rule.trigger else { return None };
    let end = view.tick_start();
    let seconds = |time: Cycles| time.get() as f64 / Cycles::PER_SECOND.get() as f64;
    let number = seconds(time);
    let is_likely = number >= LONG && number.fract() == 0.0 && number / MS <= seconds(end);
    let remedy = match rule.action {
        _ if is_likely => format!(" (milliseconds are `{number}ms`)"),
        Action::Set(bit, false) if view.item(Item::of_bit(bit)) == 0.0 => format!(
            "; bit {bit} is 0 without it: `idle_high = [{bit}]` under `[inputs]` of the machine file makes an input 1 at \
             rest"
        ),
        _ => String::new(),
    };
    (time > end).then(|| format!(", but the run ended at {:.3} s{remedy}", seconds(end)))
}

/// The form in which the element of `persist.UserData` has the number that a statement waits for in another one.
fn other_reading(rule: &Rule, view: &View<'_>) -> Option<String> {
    let Condition::Becomes(expectation) = rule.trigger.condition()? else { return None };
    reading::hint(expectation, |subject| subject.value(view))
}
