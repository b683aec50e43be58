//! Watches expectations that hold over a time: `within …`, `always …`, `never …`.
//!
//! They are checked in every tick, before the servo acts. Each failure is reported once per statement, at the first
//! tick in which it was detected.

use kmotiondef::Cycles;
use vm::firmware::TickContext;

use super::expectation::ExpectationContext;
use super::plans::DueEvent;
use super::player::Player;
use super::vacuous;
use super::{Action, Condition, Expectation, Predicate, Rule, Sense, Trigger};
use crate::out::{EventKind, Message};
use crate::world::WorldAccess;
use crate::world::trace::View;

/// The progress of a statement.
#[derive(Clone, Debug, Default)]
pub(super) struct Progress {
    /// The time at which it was last due. Simultaneous repeats count once, so that rules which trigger each other do
    /// not multiply.
    pub(super) last_due: Option<Cycles>,
    /// True if the value that it waits for compared as true in the last tick.
    pub(super) was_so: bool,
    /// True if its expected text was printed, after the condition if there is one.
    pub(super) is_printed: bool,
    /// Its text as printed in a line, if only letter case differs.
    pub(super) near: Option<String>,
    /// True if it has acted or checked something.
    pub(super) happened: bool,
    /// The state found by its action when it changed nothing, and whether it ever changed anything.
    pub(super) idle: Option<String>,
    /// True if its action has changed something.
    pub(super) has_changed: bool,
    /// True if it acts as soon as it is known: it prepares the machine, or a person has entered it.
    pub(super) is_initial: bool,
    /// The value that an expectation of the whole run has seen, and whether it was ever another one.
    value: Option<f64>,
    /// See `value`.
    has_varied: bool,
    /// True if a failure was reported.
    told: bool,
    /// The time of the condition after which an event must follow.
    since: Option<Cycles>,
}

impl Progress {
    /// A statement without any progress.
    pub(super) fn new(is_initial: bool) -> Self {
        Self { is_initial, ..Self::default() }
    }

    /// Returns whether an expectation has seen more than one value, or none.
    pub(super) const fn has_varied(&self) -> bool {
        self.has_varied || self.value.is_none()
    }

    /// An expectation of the whole run has seen a value.
    fn note_value(&mut self, value: f64) {
        self.has_varied |= self.value.replace(value).is_some_and(|before| before != value);
    }
}

impl Player {
    /// Notes a line: marks the statements, among those that existed at the time, whose text it contains.
    pub(super) fn note_text(&mut self, line: &str, at: Cycles, known: usize) {
        for (rule, progress) in self.rules.iter().zip(&mut self.progress).take(known) {
            note_case(rule, progress, line);
            let Action::Expect(expectation) = &rule.action else { continue };
            let is_in_time = match &rule.trigger {
                Trigger::Within { limit, .. } => {
                    progress.since.is_some_and(|since| at > since && at <= since + *limit)
                }
                _ => true,
            };
            progress.is_printed |=
                is_in_time && expectation.printed().is_some_and(|text| line.contains(text));
        }
    }

    /// Notes that a condition has occurred: the events that must follow within a time are expected from now on.
    pub(super) fn begin_waiting(&mut self, at: Cycles, fits: &impl Fn(&Condition) -> bool) {
        for index in 0..self.rules.len() {
            let Trigger::Within { limit, condition } = &self.rules[index].trigger else { continue };
            if !fits(condition) || self.progress[index].since.is_some() {
                continue;
            }
            let deadline = at + *limit;
            let progress = &mut self.progress[index];
            (progress.since, progress.is_printed) = (Some(at), false);
            self.plans.add(deadline, DueEvent::Check);
        }
    }

    /// Returns whether a state is checked in every tick.
    pub(crate) fn is_watching(&self) -> bool {
        self.rules.iter().zip(&self.progress).any(|(rule, progress)| match &rule.trigger {
            Trigger::Always { .. } => !progress.told,
            Trigger::Within { .. } => progress.since.is_some(),
            Trigger::When { condition: Condition::Becomes(_), .. } => true,
            Trigger::At(_) | Trigger::Every { .. } | Trigger::When { .. } | Trigger::End => false,
        })
    }

    /// Checks the values for which statements wait.
    pub(super) fn watch_values(&mut self, access: &WorldAccess<'_>, context: &TickContext<'_>) {
        for index in 0..self.rules.len() {
            let Some(Condition::Becomes(expectation)) = self.rules[index].trigger.condition() else {
                continue;
            };
            let (is_so, _) = self.look(access, context, index, expectation);
            if is_so && !self.progress[index].was_so {
                let risen = Condition::Becomes(expectation.clone());
                self.trigger_rules(context.now, |condition| *condition == risen);
            }
            self.progress[index].was_so = is_so;
        }
    }

    /// Checks all watched expectations.
    pub(super) fn watch(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        for index in 0..self.rules.len() {
            match &self.rules[index].trigger {
                Trigger::Always { while_met } => {
                    let is_watched =
                        while_met.as_ref().is_none_or(|met| self.look(access, context, index, met).0);
                    if is_watched && !self.progress[index].told {
                        self.note_value(access, context, index);
                        self.check(access, context, index);
                    }
                }
                Trigger::Within { .. } => self.watch_deadline(access, context, index),
                Trigger::At(_) | Trigger::Every { .. } | Trigger::When { .. } | Trigger::End => {}
            }
        }
    }

    /// Notes the current value of an expectation of the whole run.
    fn note_value(&mut self, access: &WorldAccess<'_>, context: &TickContext<'_>, index: usize) {
        if let Action::Expect(Expectation { predicate: Predicate::Value { subject, .. }, .. }) =
            &self.rules[index].action
        {
            let view = View::new(access.machine, access.io, context.now, context.memory);
            let value = subject.value(&view);
            value.into_iter().for_each(|value| self.progress[index].note_value(value));
        }
    }

    /// Checks a statement with a deadline: reports its failure once the time has passed.
    fn watch_deadline(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>, index: usize) {
        let Trigger::Within { limit, .. } = self.rules[index].trigger else { return };
        let Action::Expect(expectation) = &self.rules[index].action else { return };
        let Some(since) = self.progress[index].since else { return };
        if self.look(access, context, index, expectation).0 {
            self.progress[index].happened = true;
            self.progress[index].since = None;
        } else if context.now >= since + limit {
            self.check(access, context, index);
            self.progress[index].since = None;
        }
    }

    /// Checks an expectation of a statement; returns whether it is met, with the actual and the expected value.
    pub(super) fn look(
        &self,
        access: &WorldAccess<'_>,
        context: &TickContext<'_>,
        index: usize,
        expectation: &Expectation,
    ) -> (bool, String) {
        let view = View::new(access.machine, access.io, context.now, context.memory);
        let look = ExpectationContext {
            view,
            threads: context.threads.active(),
            is_printed: self.progress[index].is_printed,
        };
        let seen = expectation.look(&look);
        (seen.is_met, seen.text)
    }

    /// Reports expectations that are not met.
    pub(super) fn check(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>, index: usize) {
        let rule = &self.rules[index];
        let Action::Expect(expectation) = &rule.action else { return };
        let (is_met, text) = self.look(access, context, index, expectation);
        if !is_met {
            let (place, at) = (&rule.place, seconds(context.now));
            let within = match (&rule.trigger, self.progress[index].since) {
                (Trigger::Within { limit, condition }, Some(since)) => {
                    format!(", within {} s of {condition} at {} s", seconds(*limit), seconds(since))
                }
                _ => String::new(),
            };
            let near = self.progress[index].near.as_deref().filter(|_| expectation.sense == Sense::Is);
            let near = near.map_or(String::new(), |near| format!(" (one contains \"{near}\")"));
            let text = format!("{place}: at {at} s {text}{near}{within}");
            access.out.emit(context.now, EventKind::Unmet(text));
            self.progress[index].told = true;
        }
        self.progress[index].happened = true;
    }

    /// Checks the watched expectations a last time at the end of the run, and reports those that were not met.
    pub(super) fn finish_watching(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        self.watch(access, context);
        for index in 0..self.rules.len() {
            let Trigger::Within { condition, .. } = &self.rules[index].trigger else { continue };
            if self.progress[index].since.is_some() {
                self.check(access, context, index);
            } else if !self.progress[index].happened {
                let place = &self.rules[index].place;
                let text = format!("{place}: {condition} never happened, so nothing was checked");
                access.out.emit(context.now, EventKind::Unmet(text));
                self.progress[index].happened = true;
            }
        }
    }
}

impl Player {
    /// Reports, at the end of the run, actions that have changed nothing and expectations that could not fail.
    pub(super) fn finish_doubts(&self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        for (index, progress) in self.progress.iter().enumerate() {
            let place = self.rules[index].place.to_string();
            if let Some(state) = progress.idle.clone().filter(|_| !progress.has_changed) {
                let state = state + &self.out_of_order(index);
                access.out.remark(context.now, Message::NothingChanged { place, state });
                continue;
            }
            if let Some(printed) = self.other_letters(index) {
                access.out.remark(context.now, Message::OtherLetters { place, printed });
                continue;
            }
            let view = View::new(access.machine, access.io, context.now, context.memory);
            let cause = vacuous::cause(&self.rules, &self.progress, index, &view).filter(|_| !progress.told);
            if let Some(cause) = cause {
                access.out.remark(context.now, Message::CannotFail { place, cause });
            }
        }
    }
}

impl Player {
    /// A hint for a statement whose moment lies before that of the statement above it.
    fn out_of_order(&self, index: usize) -> String {
        let moment = |rule: &Rule| match rule.trigger {
            Trigger::At(time) => Some(time),
            _ => None,
        };
        let rule = &self.rules[index];
        let before = index.checked_sub(1).map(|before| &self.rules[before]);
        match before.filter(|before| before.place.source == rule.place.source) {
            Some(before) if moment(rule).zip(moment(before)).is_some_and(|(this, other)| this < other) => {
                format!(
                    " (times count from power-up: this moment is before that of line {})",
                    before.place.line
                )
            }
            _ => String::new(),
        }
    }

    /// The text that was printed where a statement forbids it in other letters.
    fn other_letters(&self, index: usize) -> Option<String> {
        let Action::Expect(expectation) = &self.rules[index].action else { return None };
        let progress = &self.progress[index];
        let is_forbidden = expectation.sense != Sense::Is && !progress.told;
        let printed = progress.near.clone().filter(|_| is_forbidden && expectation.printed().is_some())?;
        // Whoever writes both means both.
        let is_known = self.rules.iter().any(|rule| line_text(rule) == Some(printed.as_str()));
        (!is_known).then_some(printed)
    }
}

/// Notes the text of a line that differs only in upper and lower case from what a statement waits for or expects.
fn note_case(rule: &Rule, progress: &mut Progress, line: &str) {
    let Some(wanted) = line_text(rule).filter(|wanted| !wanted.is_empty() && progress.near.is_none()) else {
        return;
    };
    let mut starts = line.char_indices().map(|(at, _)| at);
    let near = starts.find_map(|at| {
        line.get(at..at + wanted.len()).filter(|near| near.eq_ignore_ascii_case(wanted) && *near != wanted)
    });
    progress.near = near.map(str::to_owned);
}

/// The text of a line that a statement waits for, expects or forbids.
fn line_text(rule: &Rule) -> Option<&str> {
    match (rule.trigger.condition(), &rule.action) {
        (Some(Condition::Printed(text)), _) => Some(text.as_str()),
        (_, Action::Expect(expectation)) => expectation.printed(),
        _ => None,
    }
}

/// Seconds as short as they are exact to the nanosecond.
fn seconds(time: Cycles) -> f64 {
    time.get() as f64 / Cycles::PER_SECOND.get() as f64
}
