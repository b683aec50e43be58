//! Runs the tests, several at a time.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use std::{env, fs, process, thread};

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};

use super::case::Case;
use super::executor::Executor;
use super::golden::{self, Shown};
use super::this_command;
use super::verdict::Verdict;
use super::{connected, firmware, relay};
use crate::cli::io::{output, terminal};

/// Runs all cases on all engines, with `jobs` runs at a time; returns the verdicts in the order of the cases.
pub(super) fn all(
    cases: &[Case],
    executors: &[Executor],
    options: &[String],
    bless: bool,
    jobs: usize,
) -> Result<(Vec<Verdict>, Vec<Duration>)> {
    let command = this_command()?;
    let runs: Vec<_> = cases
        .iter()
        .flat_map(|case| executors.iter().map(move |executor| (case, executor)))
        .zip(0..)
        .map(|((case, executor), scratch)| Run { command: &command, case, executor, options, scratch })
        .collect();
    let shown = execute(&runs, jobs)?;
    let took = shown.chunks(executors.len().max(1)).map(|runs| runs.iter().map(|shown| shown.took).sum());
    let took = took.collect();
    let mut shown = shown.into_iter();
    let of_case = |case: &Case| verdict(case, executors.iter().zip(shown.by_ref()), bless);
    Ok((cases.iter().map(of_case).collect::<Result<_>>()?, took))
}

/// Executes all runs and returns their output in order.
fn execute(runs: &[Run<'_>], jobs: usize) -> Result<Vec<Shown>> {
    let bar = ProgressBar::new(runs.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    let next = AtomicUsize::new(0);
    let slots: Vec<_> = runs.iter().map(|_| Mutex::new(None)).collect();
    thread::scope(|scope| {
        for _ in 0..jobs.min(runs.len()) {
            scope.spawn(|| {
                while let Some(index) = claim(&next, runs.len()) {
                    let (Some(run), Some(slot)) = (runs.get(index), slots.get(index)) else { return };
                    bar.set_message(run.case.name());
                    let shown = run.execute(&bar);
                    if let Ok(mut slot) = slot.lock() {
                        *slot = Some(shown);
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    slots.into_iter().map(|slot| slot.into_inner().ok().flatten().context("a test was not run")?).collect()
}

/// Judges the runs of a case, beginning with the first engine.
fn verdict<'a>(
    case: &Case,
    runs: impl Iterator<Item = (&'a Executor, Shown)>,
    bless: bool,
) -> Result<Verdict> {
    let mut first: Option<Shown> = None;
    let mut verdict = None;
    for (executor, shown) in runs {
        match executor {
            Executor::Boot(_) => return Ok(firmware::verdict(case, shown)),
            Executor::Controller(_) => return Ok(connected::verdict(case, shown)),
            Executor::Engine(_) | Executor::AsBoard(_) => {}
        }
        match &first {
            None => first = Some(shown),
            Some(first) if first.golden != shown.golden => {
                verdict.get_or_insert(Verdict::Disagrees(first.clone(), executor.clone(), shown));
            }
            Some(_) => {}
        }
    }
    let first = first.context("a test was not run")?;
    if let Some(verdict) = verdict {
        return Ok(verdict);
    }
    Ok(match &case.expected {
        Some(expected) if *expected == first.golden => Verdict::Passed,
        _ if bless && matches!(first.code, None | Some(1 | 2)) => Verdict::Refused(first),
        _ if bless && !first.doubts().is_empty() => Verdict::Asked(first),
        _ if bless => {
            write(case, &first)?;
            Verdict::Blessed
        }
        None => Verdict::Unknown,
        Some(_) => Verdict::Differs(first),
    })
}

/// Writes the output of a run as the expected output.
pub(super) fn write(case: &Case, shown: &Shown) -> Result<()> {
    output::write(&case.golden(), shown.golden.as_bytes())
}

/// The index of the next run that has not been taken.
fn claim(next: &AtomicUsize, count: usize) -> Option<usize> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    (index < count).then_some(index)
}

/// One test, to be run on one engine, or on the firmware file.
struct Run<'a> {
    command: &'a Path,
    case: &'a Case,
    executor: &'a Executor,
    options: &'a [String],
    /// A unique number, for the name of its temporary folder.
    scratch: usize,
}

impl Run<'_> {
    /// Runs the program in its folder; files that it writes go to a temporary folder.
    fn execute(&self, bar: &ProgressBar) -> Result<Shown> {
        let files = env::temp_dir().join(format!("cc67-test-{}-{}", process::id(), self.scratch));
        let name = self.case.source.file_name().unwrap_or_default();
        let mut command = Command::new(self.command);
        command.arg("run").arg("--no-sidecar").args(self.executor.options());
        if !self.case.options.iter().any(|option| option.starts_with("--files")) {
            command.arg("--files").arg(&files);
        }
        command.args(self.options).args(&self.case.options).arg(name).args(&self.case.also);
        command.current_dir(self.case.folder()).stdin(Stdio::null()).env("NO_COLOR", "1");
        let start = now();
        let output = match self.executor {
            Executor::Controller(_) => relay::output(&mut command, |line| bar.suspend(|| self.relay(line))),
            Executor::Engine(_) | Executor::AsBoard(_) | Executor::Boot(_) => command.output(),
        };
        let output = output.with_context(|| format!("cannot run {}", self.case.name()))?;
        let took = start.elapsed();
        // The folder exists only if the program wrote a file.
        let _ = fs::remove_dir_all(&files);
        // An expected output contains the default folder of files.
        let stderr = String::from_utf8_lossy(&output.stderr).replace(&*files.to_string_lossy(), "cc67-files");
        let shown = golden::shown(&output.stdout, stderr.as_bytes(), output.status.code());
        Ok(Shown { took, ..shown })
    }

    /// Shows a line of the run that is meant for the user at the controller.
    fn relay(&self, line: &str) {
        if let Some(text) = connected::for_person(line) {
            terminal::note(&format!("{}: {text}", self.case.name()));
        }
    }
}

#[expect(clippy::disallowed_methods, reason = "a report says how long a test took; no result depends on it")]
fn now() -> Instant {
    Instant::now()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::engine::EngineName;

    fn check(expected: Option<&str>, shown: [&str; 2], expect: &str) {
        let case = Case {
            source: "a.c".into(),
            expected: expected.map(str::to_owned),
            options: Vec::new(),
            also: Vec::new(),
        };
        let shown = shown.map(|text| golden::shown(text.as_bytes(), b"", Some(0)));
        let engines = [EngineName::Bytecode, EngineName::Native].map(Executor::Engine);
        let runs = engines.iter().zip(shown);
        let verdict = verdict(&case, runs, false).map(|verdict| format!("{verdict:?}"));
        let verdict = verdict.expect("nothing is written");
        assert!(verdict.starts_with(expect), "{verdict}");
    }

    #[test]
    fn engines_must_agree_with_each_other_and_with_what_is_expected() {
        check(Some("a\n"), ["a", "a"], "Passed");
        check(Some("a\n"), ["b", "b"], "Differs");
        check(Some("a\n"), ["a", "b"], "Disagrees");
        check(Some("a\n"), ["b", "a"], "Disagrees");
        check(None, ["a", "a"], "Unknown");
    }
}
