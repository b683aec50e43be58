//! The areas from which scenarios are generated: one file each.

mod commands;
mod moves;
mod outputs;
mod paths;
mod servo;
mod text;
mod threads;

use clap::ValueEnum;

use super::draw::Draw;
use super::scenario::{Part, PartKind, RecordTimes, Scenario};

/// A part of the board's behaviour in which scenarios are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli::commands::compare) enum Area {
    /// Script commands, also misspelled ones
    Commands,
    /// Moves and jogs, feedhold, slaves
    Moves,
    /// Paths that programs build, overrides, feedhold
    Paths,
    /// Gains, filters, feed forward and limits of a servo with a motor
    Servo,
    /// Outputs of axes in all modes, writes to amplifiers, bits
    Outputs,
    /// Threads that start, pause and resume one another, locks
    Threads,
    /// Formatted output and input, conversions
    Text,
}

impl Area {
    pub(in crate::cli::commands::compare) const ALL: [Self; 7] =
        [Self::Commands, Self::Moves, Self::Paths, Self::Servo, Self::Outputs, Self::Threads, Self::Text];

    /// Its name on the command line.
    pub(in crate::cli::commands::compare) fn name(self) -> &'static str {
        match self {
            Self::Commands => "commands",
            Self::Moves => "moves",
            Self::Paths => "paths",
            Self::Servo => "servo",
            Self::Outputs => "outputs",
            Self::Threads => "threads",
            Self::Text => "text",
        }
    }

    /// Generates the scenario of a seed.
    pub(in crate::cli::commands::compare) fn scenario(self, seed: u64) -> Scenario {
        let mut writer = ScenarioWriter::new(self.name(), seed);
        match self {
            Self::Commands => commands::draw(&mut writer),
            Self::Moves => moves::draw(&mut writer),
            Self::Paths => paths::draw(&mut writer),
            Self::Servo => servo::draw(&mut writer),
            Self::Outputs => outputs::draw(&mut writer),
            Self::Threads => threads::draw(&mut writer),
            Self::Text => text::draw(&mut writer),
        }
        writer.scenario
    }
}

/// Builds a scenario part by part.
struct ScenarioWriter {
    draw: Draw,
    scenario: Scenario,
    /// The slice of the next statement.
    slice: u32,
}

impl ScenarioWriter {
    fn new(area: &str, seed: u64) -> Self {
        let scenario = Scenario {
            name: format!("{area} {seed}"),
            parts: Vec::new(),
            slices: 0,
            observed: RecordTimes::Printed,
            columns: Vec::new(),
        };
        Self { draw: Draw::new(area, seed), scenario, slice: 0 }
    }

    fn part(&mut self, kind: PartKind, text: impl Into<String>) {
        self.scenario.parts.push(Part { kind, text: text.into() });
    }

    fn line(&mut self, text: impl Into<String>) {
        self.part(PartKind::Line, text);
    }

    fn head(&mut self, text: impl Into<String>) {
        self.part(PartKind::Head, text);
    }

    fn start(&mut self, text: impl Into<String>) {
        self.part(PartKind::Start, text);
    }

    /// Adds a statement some slices after the previous one.
    fn add_later(&mut self, low: u32, high: u32, text: impl Into<String>) {
        self.slice += low + self.draw.below(high - low + 1);
        let slice = self.slice;
        self.part(PartKind::Slice { thread: 1, slice }, text);
    }

    /// Ends the program some slices after its last statement; it records the columns in about 60 slices.
    fn observe_slices(&mut self, more: u32, columns: impl IntoIterator<Item = String>) {
        self.scenario.slices = self.slice + more;
        self.scenario.observed = RecordTimes::Slices((self.scenario.slices / 60).max(1));
        self.scenario.columns = columns.into_iter().collect();
    }

    /// Ends the program some slices after its last statement; it records the columns in every tick.
    fn observe_ticks(&mut self, more: u32, columns: impl IntoIterator<Item = String>) {
        self.scenario.slices = self.slice + more;
        self.scenario.observed = RecordTimes::Ticks;
        self.scenario.columns = columns.into_iter().collect();
    }
}

#[cfg(test)]
mod tests {
    use super::super::observation::ScenarioBoard;
    use super::*;

    #[test]
    fn the_scenarios_of_all_areas_can_be_played() {
        for area in Area::ALL {
            for seed in 0..4 {
                let scenario = area.scenario(seed);
                let played = ScenarioBoard::Model.play(&scenario);
                let observation = played.unwrap_or_else(|error| panic!("{}: {error}", scenario.name));
                assert!(observation.difference(&observation, &scenario).is_none());
                assert_eq!(observation.rows.len(), scenario.samples(), "{}", scenario.name);
                assert_eq!(area.scenario(seed), scenario);
            }
        }
    }
}
