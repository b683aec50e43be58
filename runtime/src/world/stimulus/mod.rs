//! The stimulus: what the world around the board does, and when, as data.
//!
//! One statement a line, in words: a moment, then what happens.
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
//! device spi select=16 clock=17 out=18 word=0x0190
//! ```
//!
//! Everything happens in board time, at the beginning of the first tick that does not begin before the moment, in the
//! order of the text; so a run stays a function of its inputs. Source: plant.md section 8.

mod action;
mod assist;
mod player;
mod text;
mod tokens;
mod trigger;
mod wave;

pub use action::{Action, Expectation};
pub use player::MOST_PLANNED;
pub use text::StimulusError;
pub use trigger::{Condition, Edge, Trigger};
pub use wave::Wave;

pub(crate) use assist::{Assist, Step};
pub(crate) use player::Player;
pub(crate) use wave::conversion;

use std::fmt;
use std::sync::Arc;

use kmotiondef::ThreadId;

/// Where a statement stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, or the option that holds the text.
    pub source: Arc<str>,
    /// The line, from 1.
    pub line: usize,
    /// The character in the line, from 1.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}:{}", self.source, self.line, self.column)
    }
}

/// One statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Where it stands.
    pub place: Place,
    /// When it acts.
    pub trigger: Trigger,
    /// What it does.
    pub action: Action,
}

/// A whole stimulus.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stimulus {
    /// Its statements in the order of the text.
    pub rules: Vec<Rule>,
}

impl Stimulus {
    /// Reads statements; `source` is what messages call the text.
    ///
    /// # Errors
    /// The first statement that is wrong, and where.
    pub fn parse(text: &str, source: &str) -> Result<Self, StimulusError> {
        text::parse(text, source).map(|rules| Self { rules })
    }

    /// Adds the statements of another one behind these.
    pub fn extend(&mut self, other: Self) {
        self.rules.extend(other.rules);
    }

    /// Programs that it loads while it is played, each with its thread.
    pub fn programs(&self) -> impl Iterator<Item = (ThreadId, &Arc<str>)> {
        self.rules.iter().filter_map(|rule| match &rule.action {
            Action::Run(thread, name) => Some((*thread, name)),
            _ => None,
        })
    }

    /// Whether it does nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }
}
