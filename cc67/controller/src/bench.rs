//! A stimulus at a bench: the PC's part is automatic, and a person is asked to do the rest.
//!
//! A controller has no model of a machine around it. From a stimulus it takes the actions of the PC (commands, threads,
//! answers, elements of `persist`), manual actions (`manual`), and expectations. Times count from the start of the
//! programs. Conditions are checked with each status record, so a level that lasts less than 50 ms may be missed.

use std::collections::BTreeMap;
use std::mem;

use kmotiondef::{AxisId, Bit, Cycles, ThreadId};
use runtime::stimulus::{
    Action, Condition, Expectation, Facts, Predicate, Rule, Stimulus, StimulusError, Subject, Trigger,
};

/// The facts about a controller that conditions and expectations examine.
pub(crate) trait BenchFacts {
    /// Returns a value; `None` if it cannot be known.
    fn value(&self, subject: &Subject) -> Option<f64>;

    /// Returns the level of a bit; `None` if it cannot be known.
    fn level(&self, bit: Bit) -> Option<bool>;

    /// Returns whether an axis is enabled.
    fn is_enabled(&self, axis: AxisId) -> bool;

    /// Returns whether a thread is active.
    fn is_active(&self, thread: ThreadId) -> bool;
}

/// The facts about the board, together with the printed lines.
struct BenchView<'a, F> {
    facts: &'a F,
    lines: &'a [String],
}

impl<F: BenchFacts> BenchView<'_, F> {
    /// Returns the state that a condition tests; `None` if it cannot be known, and for other conditions.
    fn state(&self, condition: &Condition) -> Option<bool> {
        match condition {
            Condition::Bit(bit, _) => self.facts.level(*bit),
            Condition::Starts(thread) | Condition::Ends(thread) => Some(self.facts.is_active(*thread)),
            Condition::Becomes(expectation) => Some(expectation.look(self).is_met),
            Condition::Printed(_) | Condition::UartSent(_) => None,
        }
    }
}

/// Returns whether a change to this state meets a condition.
fn counts(condition: &Condition, state: bool) -> bool {
    match condition {
        Condition::Bit(_, edge) => edge.fits(state),
        Condition::Ends(_) => !state,
        Condition::Starts(_) | Condition::Becomes(_) => state,
        Condition::Printed(_) | Condition::UartSent(_) => false,
    }
}

impl<F: BenchFacts> Facts for BenchView<'_, F> {
    fn value(&self, subject: &Subject) -> Option<f64> {
        self.facts.value(subject)
    }

    fn has_printed(&self, text: &str) -> bool {
        self.lines.iter().any(|line| line.contains(text))
    }

    fn is_enabled(&self, axis: AxisId) -> bool {
        self.facts.is_enabled(axis)
    }

    fn is_active(&self, thread: ThreadId) -> bool {
        self.facts.is_active(thread)
    }
}

/// The progress of a statement.
#[derive(Debug, Default)]
struct BenchProgress {
    /// The last observed state of its condition: a level, a thread's activity, the truth of a comparison.
    state: Option<bool>,
    /// True once its condition has been met.
    has_happened: bool,
}

/// A stimulus in progress at a bench.
#[derive(Debug, Default)]
pub(crate) struct Bench {
    rules: Vec<Rule>,
    progress: Vec<BenchProgress>,
    /// Due statements, by time and then in the order in which they were scheduled.
    due: BTreeMap<(Cycles, u64), usize>,
    planned: u64,
    /// All printed lines.
    lines: Vec<String>,
    /// The number of `lines` that have been compared with all conditions.
    compared: usize,
}

/// An action that is due.
#[derive(Debug, PartialEq)]
pub(crate) enum BenchAct {
    /// An action for the PC or a person.
    Act(Action),
    /// An expectation was not met.
    Unmet(String),
}

impl Bench {
    /// Prepares a stimulus.
    ///
    /// # Errors
    /// The first statement that needs a model of the machine.
    pub(crate) fn new(stimulus: Stimulus) -> Result<Self, StimulusError> {
        for rule in &stimulus.rules {
            if let Some(message) = refusal(rule) {
                return Err(StimulusError { place: rule.place.clone(), message });
            }
        }
        let mut bench = Self::default();
        for (index, rule) in stimulus.rules.iter().enumerate() {
            if let Trigger::At(time) | Trigger::Every { from: time, .. } = rule.trigger {
                bench.plan(time, index);
            }
        }
        bench.progress = stimulus.rules.iter().map(|_| BenchProgress::default()).collect();
        bench.rules = stimulus.rules;
        Ok(bench)
    }

    fn plan(&mut self, at: Cycles, index: usize) {
        self.due.insert((at, self.planned), index);
        self.planned += 1;
    }

    /// Notes a console line.
    pub(crate) fn note_line(&mut self, line: &[u8]) {
        if !self.rules.is_empty() {
            self.lines.push(String::from_utf8_lossy(line).into_owned());
        }
    }

    /// Checks all conditions, and schedules the statements that follow.
    pub(crate) fn look(&mut self, now: Cycles, facts: &impl BenchFacts) {
        let fresh = mem::replace(&mut self.compared, self.lines.len());
        for index in 0..self.rules.len() {
            let Trigger::When { condition, after, is_once } = &self.rules[index].trigger else { continue };
            let (after, is_once) = (*after, *is_once);
            let has_happened = match condition {
                Condition::Printed(text) => {
                    self.lines.get(fresh..).unwrap_or_default().iter().any(|line| line.contains(text))
                }
                _ => self.has_changed(index, facts),
            };
            if has_happened && !(is_once && self.progress[index].has_happened) {
                self.progress[index].has_happened = true;
                self.plan(now + after, index);
            }
        }
    }

    /// Returns whether the state of a statement's condition has changed to the awaited one.
    fn has_changed(&mut self, index: usize, facts: &impl BenchFacts) -> bool {
        let view = BenchView { facts, lines: &self.lines };
        let Trigger::When { condition, .. } = &self.rules[index].trigger else { return false };
        let state = view.state(condition);
        // A comparison that is true from the beginning counts, and so does a thread that is active.
        let first = matches!(condition, Condition::Becomes(_) | Condition::Starts(_)).then_some(false);
        let before = mem::replace(&mut self.progress[index].state, state).or(first);
        matches!((before, state), (Some(before), Some(state)) if before != state && counts(condition, state))
    }

    /// Takes the next due action.
    pub(crate) fn take_due(&mut self, now: Cycles, facts: &impl BenchFacts) -> Option<BenchAct> {
        loop {
            let entry = self.due.first_entry().filter(|entry| entry.key().0 <= now)?;
            let index = entry.remove();
            self.progress[index].has_happened = true;
            if !self.repeat(index, now, facts) {
                continue;
            }
            let act = match &self.rules[index].action {
                Action::Expect(_) => self.unmet(index, now, facts).map(BenchAct::Unmet),
                action => Some(BenchAct::Act(action.clone())),
            };
            if act.is_some() {
                return act;
            }
        }
    }

    /// Schedules the next time of a repeated statement; returns whether it acts now.
    fn repeat(&mut self, index: usize, now: Cycles, facts: &impl BenchFacts) -> bool {
        let Trigger::Every { period, from, until, ref while_met } = self.rules[index].trigger else {
            return true;
        };
        let view = BenchView { facts, lines: &self.lines };
        let is_so = while_met.as_ref().is_none_or(|met| met.look(&view).is_met);
        let next = from + Cycles::new(((now - from).get() / period.get() + 1) * period.get());
        if until.is_none_or(|until| next <= until) {
            self.plan(next, index);
        }
        is_so
    }

    /// Checks an expectation; returns the message if it is not met.
    fn unmet(&self, index: usize, now: Cycles, facts: &impl BenchFacts) -> Option<String> {
        let rule = &self.rules[index];
        let Action::Expect(expectation) = &rule.action else { return None };
        if !is_known(expectation, facts) {
            return None;
        }
        let seen = expectation.look(&BenchView { facts, lines: &self.lines });
        let seconds = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
        (!seen.is_met).then(|| format!("{}: at {seconds:.3} s {}", rule.place, seen.text))
    }

    /// Returns whether actions of a person or the PC are still scheduled.
    pub(crate) fn has_plans(&self) -> bool {
        self.due.values().any(|index| {
            !matches!(self.rules[*index].trigger, Trigger::Every { .. })
                && !matches!(self.rules[*index].action, Action::Expect(_))
        })
    }

    /// Ends the run: returns the messages of expectations that are not met at its end.
    pub(crate) fn finish(&mut self, now: Cycles, facts: &impl BenchFacts) -> Vec<String> {
        let late = mem::take(&mut self.due).into_values();
        let at_end = (0..self.rules.len()).filter(|index| self.rules[*index].trigger == Trigger::End);
        let all: Vec<usize> = late.chain(at_end).collect();
        all.into_iter().filter_map(|index| self.unmet(index, now, facts)).collect()
    }

    /// Returns the positions of expectations that are not checked on a controller: expectations over a time, and those
    /// for values that are not in the status record.
    pub(crate) fn unchecked(&self, facts: &impl BenchFacts) -> Vec<String> {
        let is_unchecked = |rule: &&Rule| match (&rule.trigger, &rule.action) {
            (Trigger::Always { .. } | Trigger::Within { .. }, _) => true,
            (_, Action::Expect(expectation)) => !is_known(expectation, facts),
            _ => false,
        };
        self.rules.iter().filter(is_unchecked).map(|rule| rule.place.to_string()).collect()
    }
}

/// Returns whether the values of an expectation are known on a controller.
fn is_known(expectation: &Expectation, facts: &impl BenchFacts) -> bool {
    match &expectation.predicate {
        Predicate::Value { subject, .. } => facts.value(subject).is_some(),
        Predicate::Printed(_) | Predicate::Enabled(..) | Predicate::Active(..) => true,
    }
}

/// The reason why a statement cannot be used at a bench; `None` if it can.
fn refusal(rule: &Rule) -> Option<String> {
    if let Trigger::When { condition: Condition::UartSent(_), .. } = rule.trigger {
        return Some("the PC does not hear the serial port of a controller".to_owned());
    }
    match &rule.action {
        Action::Command(_)
        | Action::Start(_)
        | Action::Kill(_)
        | Action::Persist(..)
        | Action::Answer(_)
        | Action::Manual(_)
        | Action::Expect(_) => None,
        _ => Some(
            "only the model of a machine does this: before the action, `manual \"press START\"` asks a person at the \
             controller to do it"
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A board with one bit, one axis and thread 1.
    #[derive(Default)]
    struct Known {
        level: bool,
        position: f64,
        is_active: bool,
    }

    impl BenchFacts for Known {
        fn value(&self, subject: &Subject) -> Option<f64> {
            matches!(subject, Subject::Item(..)).then_some(self.position)
        }

        fn level(&self, _: Bit) -> Option<bool> {
            Some(self.level)
        }

        fn is_enabled(&self, _: AxisId) -> bool {
            true
        }

        fn is_active(&self, _: ThreadId) -> bool {
            self.is_active
        }
    }

    fn bench(text: &str) -> Bench {
        let stimulus = Stimulus::parse(text, "a.stim").unwrap_or_else(|error| panic!("{error}"));
        Bench::new(stimulus).unwrap_or_else(|error| panic!("{error}"))
    }

    const fn seconds(seconds: i64) -> Cycles {
        Cycles::new(seconds * Cycles::PER_SECOND.get())
    }

    /// The texts of the due requests to a person.
    fn asked(bench: &mut Bench, at: i64, facts: &Known) -> Vec<String> {
        bench.look(seconds(at), facts);
        std::iter::from_fn(|| bench.take_due(seconds(at), facts))
            .map(|act| match act {
                BenchAct::Act(Action::Manual(step)) => step.text,
                other => format!("{other:?}"),
            })
            .collect()
    }

    #[test]
    fn a_person_is_asked_when_the_moment_comes() {
        let mut bench = bench(
            "at 2s manual \"press START\" pulse bit 136\n\
             once printed \"load\" manual \"load a part\" set bit 137\n\
             when bit 46 rises after 1s manual \"close the door\" set bit 138\n",
        );
        let mut facts = Known { is_active: true, ..Known::default() };
        assert!(asked(&mut bench, 1, &facts).is_empty());
        assert!(bench.has_plans());
        bench.note_line(b"please load");
        assert_eq!(asked(&mut bench, 2, &facts), ["press START", "load a part"]);
        bench.note_line(b"please load again");
        facts.level = true;
        assert!(asked(&mut bench, 3, &facts).is_empty());
        assert_eq!(asked(&mut bench, 4, &facts), ["close the door"]);
        assert!(!bench.has_plans());
    }

    #[test]
    fn what_needs_a_model_is_refused_with_its_place() {
        let stimulus =
            Stimulus::parse("at 1s persist 5 = 1\nat 2s pulse bit 136\n", "a.stim").expect("it is right");
        let error = Bench::new(stimulus).expect_err("nobody can do that");
        assert!(error.to_string().starts_with("a.stim:2:1: only the model of a machine"), "{error}");
    }

    #[test]
    fn expectations_are_checked_as_far_as_the_board_shows_values() {
        let mut bench = bench(
            "expect axis 0 position = 500 ± 1\n\
             expect printed \"done\"\n\
             expect Parts = 3\n\
             never printed \"boom\"\n",
        );
        let facts = Known { position: 480.0, ..Known::default() };
        let unmet = bench.finish(seconds(1), &facts);
        let expected = [
            "a.stim:1:1: at 1.000 s axis 0 position is 480, expected 500 ± 1",
            "a.stim:2:1: at 1.000 s no line contains \"done\", expected one",
        ];
        assert_eq!(unmet, expected);
        assert_eq!(bench.unchecked(&facts), ["a.stim:3:1", "a.stim:4:1"]);
    }
}
