//! Random scenarios: generated from seeds, played on the model and on the firmware file, and reduced if the boards
//! differ.
//!
//! A scenario is either a program that executes each statement in a slice of its own and records axes and outputs, or a
//! list of lines sent by the PC. Both boards get the same text. Differences are kept as vectors for the tests of the
//! board.

mod areas;
mod draw;
mod observation;
mod reduce;
mod scenario;
mod vector;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result};
use cc67_host::BootedFirmware;
use clap::Args;

use crate::cli::io::exit::Exit;
use crate::cli::io::output;
use areas::Area;
use observation::{Difference, Observation, ScenarioBoard};
use scenario::Scenario;

/// Arguments for random scenarios.
#[derive(Clone, Debug, Args)]
pub(super) struct RandomArguments {
    /// Compare random scenarios of an AREA instead of programs, reduced to the smallest where they differ
    #[arg(long, value_name = "AREA,…", value_enum, value_delimiter = ',', num_args = 0.., require_equals = true)]
    random: Option<Vec<Area>>,
    /// Draw N scenarios of each area
    #[arg(long, value_name = "N", default_value = "20", requires = "random")]
    count: u64,
    /// First seed
    #[arg(long, value_name = "N", default_value = "1", requires = "random")]
    seed: u64,
    /// Append reduced scenarios to FILE, each with what the firmware did, as a line of JSON
    #[arg(long, value_name = "FILE", requires = "random")]
    keep: Option<PathBuf>,
}

/// The results of an area.
#[derive(Debug, Default)]
struct Tally {
    equal: u64,
    /// The first quantities that differ, each with its scenarios.
    different: BTreeMap<String, Vec<u64>>,
}

impl RandomArguments {
    /// The requested areas: all if none is named.
    fn areas(&self) -> Vec<Area> {
        let named = self.random.as_deref().unwrap_or_default();
        if named.is_empty() { Area::ALL.to_vec() } else { named.to_vec() }
    }

    /// Returns whether scenarios are compared instead of programs.
    pub(super) const fn is_requested(&self) -> bool {
        self.random.is_some()
    }

    /// Compares the scenarios; exit code 5 if any differs.
    pub(super) fn compare(&self, firmware: &BootedFirmware) -> Result<Exit> {
        let mut table = format!("{:10} {:>6} {:>6}  first difference: seeds\n", "area", "equal", "of");
        let mut exit = Exit::Success;
        for area in self.areas() {
            let tally = self.area(area, firmware)?;
            let differences: Vec<String> = tally
                .different
                .iter()
                .map(|(what, seeds)| {
                    let seeds: Vec<String> = seeds.iter().map(u64::to_string).collect();
                    format!("{what}: {}", seeds.join(" "))
                })
                .collect();
            let (name, equal) = (area.name(), tally.equal);
            writeln!(table, "{name:10} {equal:6} {:6}  {}", self.count, differences.join("; "))?;
            if !differences.is_empty() {
                exit = Exit::Unmet;
            }
        }
        output::print(&table)?;
        Ok(exit)
    }

    fn area(&self, area: Area, firmware: &BootedFirmware) -> Result<Tally> {
        let mut tally = Tally::default();
        for seed in self.seed..self.seed.saturating_add(self.count) {
            let scenario = area.scenario(seed);
            match compare_scenario(&scenario, firmware)?.0 {
                None => tally.equal += 1,
                Some(difference) => {
                    self.report(&scenario, &difference, firmware)?;
                    tally.different.entry(class(&difference)).or_default().push(seed);
                }
            }
        }
        Ok(tally)
    }

    /// Reduces a scenario, shows it and stores it.
    fn report(&self, scenario: &Scenario, found: &Difference, firmware: &BootedFirmware) -> Result<()> {
        let mut same = |scenario: &Scenario| {
            let (difference, ..) = compare_scenario(scenario, firmware).ok()?;
            difference.filter(|other| class(other) == class(found))
        };
        let small = reduce::reduced(scenario, &mut same);
        let (difference, [model, booted]) = compare_scenario(&small, firmware)?;
        let difference = difference.with_context(|| format!("{} differs only once", small.name))?;
        output::print(&describe_difference(&small, &difference))?;
        let Some(path) = &self.keep else { return Ok(()) };
        let failed = || format!("cannot write {}", path.display());
        let mut file = OpenOptions::new().create(true).append(true).open(path).with_context(failed)?;
        let vector = vector::vector(&small, &difference, &model, &booted);
        writeln!(file, "{vector}").with_context(failed)
    }
}

/// Plays a scenario on both boards; returns the first difference, and the observations of the model and of the
/// firmware.
fn compare_scenario(
    scenario: &Scenario,
    firmware: &BootedFirmware,
) -> Result<(Option<Difference>, [Observation; 2])> {
    let play = |subject: ScenarioBoard<'_>| subject.play(scenario).with_context(|| scenario.name.clone());
    let observations = [play(ScenarioBoard::Model)?, play(ScenarioBoard::Firmware(firmware))?];
    let difference = observations[0].difference(&observations[1], scenario);
    Ok((difference, observations))
}

/// The quantity of a difference, without the number of the axis or element.
fn class(difference: &Difference) -> String {
    difference.what.chars().filter(|c| !c.is_ascii_digit()).collect::<String>().replace("[]", "")
}

/// A reduced scenario and its difference, as text.
fn describe_difference(scenario: &Scenario, difference: &Difference) -> String {
    let mut text = format!("{}: {}", scenario.name, difference.what);
    if let Some(at) = difference.at {
        text += &format!(", sample {}", at * scenario.samples_every());
    }
    text += &format!("\n  model:    {}\n  firmware: {}\n", difference.model, difference.firmware);
    for part in &scenario.parts {
        text += &format!("    {}\n", part.shown());
    }
    text
}
