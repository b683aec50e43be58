//! Runs a test with many schedules, and reduces a failing one.

use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{env, process, thread};

use anyhow::{Context, Result, bail};
use cc67_host::Schedule;
use clap::Args;

use super::case::Case;
use super::this_command;
use super::verdict::Verdict;
use crate::cli::commands::run::schedules::ScheduleFailure;

/// Options for schedules.
#[derive(Debug, Args)]
pub(super) struct ScheduleArguments {
    /// Also run each test by N schedules: other starts, inputs some ticks earlier or later, switches between accesses to
    /// shared memory; report the first that shows something else, and the smallest
    #[arg(long, value_name = "N", conflicts_with_all = ["bless", "boot"])]
    schedules: Option<u64>,
    /// The first seed
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "schedules")]
    seed: u64,
}

/// A schedule with which a test fails.
#[derive(Debug)]
pub(super) struct FailingSchedule {
    /// The seed with which it was found.
    pub(super) seed: u64,
    /// The smallest schedule that fails.
    pub(super) smallest: Schedule,
    /// The reason of the failure.
    pub(super) why: String,
    /// The remarks of the board in that run.
    pub(super) notes: String,
}

/// The number of seeds that are run in one process.
const CHUNK: u64 = 32;

impl ScheduleArguments {
    /// Runs the tests that have passed so far with the schedules.
    pub(super) fn explore(
        &self,
        cases: &[Case],
        verdicts: &mut [Verdict],
        options: &[String],
        jobs: usize,
    ) -> Result<()> {
        let Some(count) = self.schedules else { return Ok(()) };
        let seeds = self.seed..self.seed.saturating_add(count);
        let command = this_command()?;
        for (case, verdict) in cases.iter().zip(verdicts).filter(|(_, verdict)| verdict.is_good()) {
            let search = ScheduleSearch { command: &command, case, options };
            if let Some(found) = search.first(seeds.clone(), jobs)? {
                *verdict = Verdict::FailsBySchedule(search.smallest(found)?);
            }
        }
        Ok(())
    }
}

/// A test whose schedules are searched.
#[derive(Clone, Copy)]
struct ScheduleSearch<'a> {
    command: &'a Path,
    case: &'a Case,
    options: &'a [String],
}

impl ScheduleSearch<'_> {
    /// The lowest seed that fails.
    fn first(&self, seeds: Range<u64>, jobs: usize) -> Result<Option<ScheduleFailure>> {
        let next = AtomicU64::new(seeds.start);
        let found: Mutex<Vec<ScheduleFailure>> = Mutex::default();
        let work = || -> Result<()> {
            loop {
                let from = next.fetch_add(CHUNK, Ordering::Relaxed);
                // A failure found with a lower seed makes this chunk unnecessary.
                let is_found =
                    found.lock().is_ok_and(|found| found.iter().any(|failing| failing.number < from));
                if from >= seeds.end || is_found {
                    return Ok(());
                }
                let failing = self.failing(&format!("{from}..{}", (from + CHUNK).min(seeds.end)))?;
                if let Ok(mut found) = found.lock() {
                    found.extend(failing);
                }
            }
        };
        thread::scope(|scope| {
            let workers: Vec<_> = (0..jobs.max(1)).map(|_| scope.spawn(work)).collect();
            workers
                .into_iter()
                .try_for_each(|worker| worker.join().unwrap_or_else(|_| bail!("a search has ended early")))
        })?;
        let found = found.into_inner().unwrap_or_default();
        Ok(found.into_iter().min_by_key(|failing| failing.number))
    }

    /// Finds the smallest schedule that fails, by removing parts as long as the rest still fails.
    fn smallest(&self, found: ScheduleFailure) -> Result<FailingSchedule> {
        let parse =
            |failing: &ScheduleFailure| failing.schedule.parse::<Schedule>().map_err(anyhow::Error::msg);
        let seed = found.number;
        let mut smallest = found;
        loop {
            let smaller: Vec<_> = parse(&smallest)?.smaller().map(|smaller| smaller.to_string()).collect();
            if smaller.is_empty() {
                break;
            }
            let Some(failing) = self.failing(&smaller.join(";"))?.into_iter().next() else { break };
            smallest = failing;
        }
        let schedule = parse(&smallest)?;
        let output = self.run(["--schedule".into(), smallest.schedule.into()])?;
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        let notes =
            notes.lines().filter(|line| line.starts_with("cc67: ")).map(|line| format!("{line}\n")).collect();
        Ok(FailingSchedule { seed, smallest: schedule, why: smallest.why, notes })
    }

    /// Returns the failing schedules of a list.
    fn failing(&self, list: &str) -> Result<Vec<ScheduleFailure>> {
        let golden = self.case.golden();
        let golden = golden.canonicalize().with_context(|| format!("cannot read {}", golden.display()))?;
        let output = self.run(["--explore".into(), list.into(), "--golden".into(), golden.into()])?;
        if !output.status.success() {
            bail!("{}: {}", self.case.name(), String::from_utf8_lossy(&output.stderr).trim_end());
        }
        let text = String::from_utf8_lossy(&output.stdout);
        text.lines().map(|line| serde_json::from_str(line).context("a line is a schedule")).collect()
    }

    /// Runs the programs with additional options.
    fn run<const N: usize>(&self, also: [OsString; N]) -> Result<process::Output> {
        let files =
            env::temp_dir().join(format!("cc67-schedules-{}-{:?}", process::id(), thread::current().id()));
        let mut command = Command::new(self.command);
        command.args(["run", "--no-sidecar"]).args(also);
        if !self.case.options.iter().any(|option| option.starts_with("--files")) {
            command.arg("--files").arg(&files);
        }
        let name = self.case.source.file_name().unwrap_or_default();
        command.args(self.options).args(&self.case.options).arg(name).args(&self.case.also);
        command.current_dir(self.case.folder()).stdin(Stdio::null()).env("NO_COLOR", "1");
        let output = command.output().with_context(|| format!("cannot run {}", self.case.name()))?;
        // The folder exists only if the program wrote a file.
        let _ = fs::remove_dir_all(&files);
        Ok(output)
    }
}
