//! The stimulus: the actions of the world around the board, and their times, as data.
//!
//! One statement per line, in words: a moment, then an action.
//!
//! ```text
//! # The operator presses start, the machine answers.
//! at 0.5s bit 136 = 1
//! at 2s pulse bit 137 for 50ms
//! when bit 46 rises after 20ms pulse bit 0
//! once printed "ready" uart "G1 X10\r"
//! every 10ms from 1s until 2s toggle bit 24
//! adc 3 = sine mean 0 amplitude 1000 hz 2
//! at 1s axis 0 push 100
//! at end expect printed "done"
//! within 0.5s of printed "start" expect axis 0 enabled
//! never axis 0 dest > 501
//! once printed "load a part" manual "load a part" pulse bit 138
//! device spi select=16 clock=17 out=18 word=0x0190
//! ```
//!
//! Everything happens in board time, at the beginning of the first tick that does not begin before the moment, in the
//! order of the text; so a run remains a function of its inputs. Source: plant.md section 8.

mod action;
mod acts;
mod assist;
mod expectation;
mod idle;
mod monitor;
mod plans;
mod player;
mod reader;
mod reading;
mod relation;
mod scene;
mod text;
mod tokens;
mod trigger;
mod vacuous;
mod wave;

pub use action::{Action, usages};
pub use acts::manual::ManualStep;
pub use expectation::{
    Examination, Expectation, Expression, Facts, Predicate, Sense, Subject, UserDataFormat,
};
pub use plans::MOST_PLANNED;
pub use relation::Relation;
pub use text::StimulusError;
pub use trigger::{Condition, Edge, Trigger};
pub use wave::Wave;

pub(crate) use action::{Form, KEYS};
pub(crate) use assist::{Assist, InputReader, Step};
pub(crate) use player::Player;

use std::fmt;
use std::sync::Arc;

use kmotiondef::{Axes, AxisId, ThreadId};

use crate::world::trace::Formula;

/// The location of a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatementPlace {
    /// The file, or the option that holds the text.
    pub source: Arc<str>,
    /// The line, from 1.
    pub line: usize,
    /// The character in the line, from 1.
    pub column: usize,
}

impl fmt::Display for StatementPlace {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}:{}", self.source, self.line, self.column)
    }
}

/// One statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Its location.
    pub place: StatementPlace,
    /// When it acts.
    pub trigger: Trigger,
    /// Its action.
    pub action: Action,
    /// The highest axis that it names.
    pub highest_axis: Option<AxisId>,
}

/// A whole stimulus.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stimulus {
    /// Its statements in the order of the text.
    pub rules: Vec<Rule>,
}

impl Stimulus {
    /// Reads statements; `source` is the name of the text in messages.
    ///
    /// # Errors
    /// The first error, with its location.
    pub fn parse(text: &str, source: &str) -> Result<Self, StimulusError> {
        text::parse(text, source).map(|rules| Self { rules })
    }

    /// Adds the statements of another one after these.
    pub fn extend(&mut self, other: Self) {
        self.rules.extend(other.rules);
    }

    /// The programs that it loads while it is played, each with its thread.
    pub fn programs(&self) -> impl Iterator<Item = (ThreadId, &Arc<str>)> {
        self.rules.iter().filter_map(|rule| match &rule.action {
            Action::Run(thread, name) => Some((*thread, name)),
            _ => None,
        })
    }

    /// Resolves the expressions in its expectations by code that knows the programs, and keeps their evaluators.
    ///
    /// # Errors
    /// The first invalid expression, or a statement about an axis that the board does not have, with its location.
    pub fn resolve(
        &mut self,
        axes: Axes,
        mut find: impl FnMut(&str) -> Result<Arc<dyn Formula>, String>,
    ) -> Result<(), StimulusError> {
        for Rule { place, trigger, action, highest_axis } in &mut self.rules {
            if let Some(axis) = highest_axis.filter(|axis| axis.index() >= axes.count()) {
                let message = format!("axis {axis}: the board has axes 0 to {}", axes.last());
                return Err(StimulusError { place: place.clone(), message });
            }
            let expected = match action {
                Action::Expect(expectation) => expectation.expression(),
                _ => None,
            };
            let condition = match trigger {
                Trigger::Always { while_met: Some(expectation) } => expectation.expression(),
                _ => None,
            };
            for expression in expected.into_iter().chain(condition) {
                let found = find(&expression.text);
                let found = found.map_err(|message| StimulusError { place: place.clone(), message })?;
                expression.formula = Some(found);
            }
        }
        Ok(())
    }

    /// Returns whether it has no rules.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }
}
