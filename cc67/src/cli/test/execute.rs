//! Runs the tests, several at a time.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, process, thread};

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};

use super::case::Case;
use super::golden::{self, Shown};
use super::this_command;
use crate::cli::output;
use crate::cli::run::EngineName;

/// How a test ended.
#[derive(Debug)]
pub(super) enum Verdict {
    /// Every engine showed what was expected.
    Passed,
    /// The expected text was written anew.
    Blessed,
    /// There is no expected text.
    Unknown,
    /// An engine showed something else.
    Differs(EngineName, Shown),
    /// The second engine did not show what the first did.
    Disagrees(Shown, EngineName, Shown),
}

impl Verdict {
    /// Whether the test is as it should be.
    pub(super) fn is_good(&self) -> bool {
        matches!(self, Self::Passed | Self::Blessed)
    }
}

/// Runs all cases on all engines, `jobs` at a time; the verdicts have the order of the cases.
pub(super) fn all(
    cases: &[Case],
    engines: &[EngineName],
    options: &[String],
    bless: bool,
    jobs: usize,
) -> Result<Vec<Verdict>> {
    let command = this_command()?;
    let bar = ProgressBar::new(cases.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    let next = AtomicUsize::new(0);
    let verdicts: Vec<_> = cases.iter().map(|_| Mutex::new(None)).collect();
    thread::scope(|scope| {
        for _ in 0..jobs.min(cases.len()) {
            scope.spawn(|| {
                while let Some(index) = claim(&next, cases.len()) {
                    let (Some(case), Some(slot)) = (cases.get(index), verdicts.get(index)) else { return };
                    bar.set_message(case.name());
                    let test = Test { command: &command, case, options, scratch: index };
                    let verdict = test.run(engines, bless);
                    if let Ok(mut slot) = slot.lock() {
                        *slot = Some(verdict);
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    verdicts.into_iter().map(|slot| slot.into_inner().ok().flatten().context("a test was not run")?).collect()
}

/// The index of a case that nobody has taken.
fn claim(next: &AtomicUsize, count: usize) -> Option<usize> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    (index < count).then_some(index)
}

/// One test about to be run.
struct Test<'a> {
    command: &'a Path,
    case: &'a Case,
    options: &'a [String],
    /// A number of its own, for the name of its temporary folder.
    scratch: usize,
}

impl Test<'_> {
    fn run(&self, engines: &[EngineName], bless: bool) -> Result<Verdict> {
        let mut first: Option<Shown> = None;
        for engine in engines {
            let shown = self.run_on(*engine)?;
            match (&first, &self.case.expected) {
                (Some(first), _) if first.golden != shown.golden => {
                    return Ok(Verdict::Disagrees(first.clone(), *engine, shown));
                }
                (_, Some(expected)) if !bless && *expected != shown.golden => {
                    return Ok(Verdict::Differs(*engine, shown));
                }
                _ => first = Some(shown),
            }
        }
        match (first, &self.case.expected) {
            (Some(shown), expected) if bless && expected.as_ref() != Some(&shown.golden) => {
                output::write(&self.case.golden(), shown.golden.as_bytes())?;
                Ok(Verdict::Blessed)
            }
            (_, None) => Ok(Verdict::Unknown),
            _ => Ok(Verdict::Passed),
        }
    }

    /// Runs the program in its folder; files that it writes go to a temporary one.
    fn run_on(&self, engine: EngineName) -> Result<Shown> {
        let files = env::temp_dir().join(format!("cc67-test-{}-{}", process::id(), self.scratch));
        let name = self.case.source.file_name().unwrap_or_default();
        let mut command = Command::new(self.command);
        command.arg("run").arg("--engine").arg(engine.name());
        if !self.case.options.iter().any(|option| option.starts_with("--files")) {
            command.arg("--files").arg(&files);
        }
        command.args(self.options).args(&self.case.options).arg(name).args(&self.case.also);
        command.current_dir(self.case.folder()).stdin(Stdio::null()).env("NO_COLOR", "1");
        let output = command.output().with_context(|| format!("cannot run {}", self.case.name()))?;
        // It exists only if the program wrote a file.
        let _ = fs::remove_dir_all(&files);
        Ok(golden::shown(&output.stdout, &output.stderr, output.status.code()))
    }
}
