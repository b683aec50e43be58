//! Runs the same programs with many schedules, in one process: the part of `cc67 test --schedules` that happens in the
//! process of a test.
//!
//! For each failing schedule, one JSON object is written to a line of stdout.

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Context, Result};
use cc67_host::Schedule;
use clap::Args;
use kmotiondef::Ticks;
use runtime::{Event, EventKind};
use serde::{Deserialize, Serialize};
use vm::interp::BytecodeEngine;

use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use crate::cli::report::seen::Failures;
use crate::cli::session::Setup;

/// Arguments of `cc67 test` to the runs that it starts.
#[derive(Debug, Args)]
pub(crate) struct ExploreArguments {
    /// Run by each of these schedules, seeds FROM..TO or several with `;` between them, and print those that fail
    #[arg(long, hide = true, requires = "golden")]
    explore: Option<String>,
    /// The expected output of each program
    #[arg(long, hide = true)]
    golden: Option<PathBuf>,
}

/// A schedule that fails.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ScheduleFailure {
    /// Its position in the list of schedules.
    pub(crate) number: u64,
    /// The schedule as text.
    pub(crate) schedule: String,
    /// The reason of the failure.
    pub(crate) why: String,
}

impl ExploreArguments {
    /// Returns whether schedules are explored.
    pub(super) fn is_requested(&self) -> bool {
        self.explore.is_some()
    }

    /// Runs with all schedules; `make` sets up one run, and returns `None` if a program has errors.
    pub(super) fn explore(
        &self,
        limit: Ticks,
        is_limited: bool,
        make: impl Fn() -> Result<Option<Setup>>,
    ) -> Result<Exit> {
        let list = self.explore.as_deref().unwrap_or_default();
        let golden = self.golden.as_deref().context("there is something to compare with")?;
        let expected = String::from_utf8_lossy(&read(golden)?).replace("\r\n", "\n");
        for (number, schedule) in schedules(list)? {
            let Some(setup) = make()? else { return Ok(Exit::Failure) };
            let seen = run(setup.with_schedule(&schedule)?, limit, is_limited)?;
            if let Some(why) = seen.difference(&expected) {
                let failing = ScheduleFailure { number, schedule: schedule.to_string(), why };
                output::print(&format!("{}\n", serde_json::to_string(&failing)?))?;
            }
        }
        Ok(Exit::Success)
    }
}

/// The schedules of a list, with their numbers.
fn schedules(list: &str) -> Result<Vec<(u64, Schedule)>> {
    if let Some((from, to)) = list.split_once("..") {
        let seeds: Range<u64> = from.parse()?..to.parse()?;
        return Ok(seeds.map(|seed| (seed, Schedule::from_seed(seed))).collect());
    }
    let parse = |(number, text): (u64, &str)| Ok((number, text.parse().map_err(anyhow::Error::msg)?));
    (0..).zip(list.split(';')).map(parse).collect()
}

/// The output of a run.
#[derive(Debug, Default)]
struct ScheduledRun {
    console: String,
    /// The first lost update found by the detector.
    loss: Option<&'static str>,
    exit: Option<Exit>,
}

impl ScheduledRun {
    fn note(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) => {
                self.console.push_str(&String::from_utf8_lossy(line));
                self.console.push('\n');
            }
            EventKind::Remark(remark) if remark.message.is_loss() => {
                self.loss.get_or_insert(remark.message.code());
            }
            EventKind::Trap(_)
            | EventKind::Halted(_)
            | EventKind::Unmet(_)
            | EventKind::Remark(_)
            | EventKind::Reply(_)
            | EventKind::Echo(_)
            | EventKind::Aborted
            | EventKind::Loaded(..)
            | EventKind::Trace(_)
            | EventKind::UartSent(_)
            | EventKind::Host(_) => {}
        }
    }

    /// Returns the difference from the expected output, if there is one.
    fn difference(&self, expected: &str) -> Option<String> {
        let code = self.exit.map_or(0, |exit| exit as u8);
        let end = if code == 0 { String::new() } else { format!("---- exit {code}\n") };
        let has_end =
            |text: &str| text.lines().any(|line| line.starts_with("---- exit ") && line == end.trim_end());
        let console = expected.split_inclusive('\n').take_while(|line| !line.starts_with("---- "));
        let console: String = console.collect();
        if code != 0 && !has_end(expected) {
            return Some(match self.exit {
                Some(Exit::Trapped) => "a thread is stopped by a trap".to_owned(),
                Some(Exit::Unmet) => "an expectation of the stimulus is not met".to_owned(),
                Some(Exit::StillRunning) => "threads wait forever".to_owned(),
                _ => format!("exit code {code}"),
            });
        }
        if console != self.console {
            let mut lines = console.lines();
            let differing = self.console.lines().find(|line| lines.next() != Some(line));
            return Some(match differing {
                Some(line) => format!("the console shows `{line}`"),
                None => "the console shows fewer lines".to_owned(),
            });
        }
        self.loss.map(|code| format!("the detector has seen a loss ({code})"))
    }
}

fn run(setup: Setup, limit: Ticks, is_limited: bool) -> Result<ScheduledRun> {
    let mut board = setup.modelled_session(BytecodeEngine::default())?;
    let (mut shown, mut seen) = (ScheduledRun::default(), Failures::default());
    let mut sink = |event: Event| {
        seen.note(&event);
        shown.note(&event);
    };
    let end = board.run(limit, None, &mut sink);
    board.finish(&mut sink)?;
    shown.exit = Some(seen.exit(end, is_limited).0);
    Ok(shown)
}
