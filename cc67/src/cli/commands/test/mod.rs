//! `cc67 test`: golden tests of user programs.
//!
//! A test is a program `NAME.c` with a file `NAME.expected`, which contains the console output. This same command runs
//! the program in a separate process for each engine, so a test is exactly what `cc67 run` does, and programs cannot
//! influence each other's results. The results are listed in the order of the programs' names, whichever is ready
//! first.

mod case;
mod connected;
mod execute;
mod executor;
mod firmware;
mod golden;
mod human;
mod machine;
mod near;
mod relay;
mod schedules;
mod verdict;

use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use cc67_controller::Address;
use clap::Args;

use crate::cli::args::board::RunForm;
use crate::cli::args::engine::EngineName;
use crate::cli::args::sidecars::Project;
use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};
use crate::cli::session::controller;
use connected::Unchecked;
use executor::Executor;
use golden::Shown;
use schedules::ScheduleArguments;
use verdict::Verdict;

/// Options of the command itself; all others in `[test]` of a project file are options for its programs.
const OWN_OPTIONS: &[&str] =
    &["bless", "force", "engine", "as", "boot", "schedules", "seed", "jobs", "json", "junit", "on", "yes"];

/// Arguments of `cc67 test`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct TestArguments {
    /// Programs, or folders to search for programs
    #[arg(required_unless_present = "explain", value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Record the present output in the .expected files; ask before recording remarks, traps or exit codes
    #[arg(long)]
    bless: bool,
    /// With --bless, record remarks, traps and exit codes without asking
    #[arg(long, requires = "bless")]
    force: bool,
    /// Run only on this engine [default: on all, which must agree]
    #[arg(long, value_enum)]
    engine: Option<EngineName>,
    /// `board`: run each program also with threads switched inside statements, as on the board; the results must agree
    #[arg(long = "as", value_name = "FIDELITY", value_enum, default_value_t)]
    form: RunForm,
    /// Run on your own firmware file; skip tests that need the modelled firmware
    #[arg(long, value_name = "FILE", conflicts_with_all = ["engine", "bless", "form"])]
    boot: Option<PathBuf>,
    /// Run on a connected controller, one test at a time; skip tests that need a simulated board
    #[arg(long, value_name = "BOARD", conflicts_with_all = ["engine", "bless", "form", "boot", "schedules"])]
    on: Option<Address>,
    /// With --on, connect without asking for confirmation the first time; for scripts
    #[arg(long, requires = "on")]
    yes: bool,
    #[command(flatten)]
    schedules: ScheduleArguments,
    /// Number of simultaneous runs, where a program on two engines counts as two [default: the number of processors]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print the results as JSON
    #[arg(long)]
    json: bool,
    /// Also write the results as a JUnit report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Options of `cc67 run` for every program
    #[arg(last = true, value_name = "OPTION")]
    options: Vec<String>,
}

/// Lines are wrapped to the width of the terminal.
const HELP: &str = "\
A test is a program NAME.c with NAME.expected beside it, which holds the expected console lines, then `---- notes` and \
the remarks of the board, if any, then `---- exit N` unless the run succeeds. The first line of the program may say how \
to run it; words may be quoted as in a shell:\n
    // cc67: run --for 2.5 --stim door.stim also 2:watchdog.c\n
NAME.toml, if it exists, is its machine file, and NAME.stim its stimulus; cc67.toml in its folder or above sets defaults. \
With --boot, console and exit code must be as expected, numbers within 0.001 and times within 1 ms; remarks are not \
compared, because they come from the modelled firmware.\n
With --on, console and exit code are compared, without board times; the report says what was not checked.\n
Exit code: 0 all tests passed, 1 some failed, 2 wrong usage.";

impl TestArguments {
    /// The command's own options in the project file of the tests.
    pub(super) fn of_project(&self) -> Result<Vec<OsString>> {
        let Some(path) = self.paths.first() else { return Ok(Vec::new()) };
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new("")) };
        let project = Project::find_above(folder)?;
        let own = |project: Project| project.parted_options("test", |option| OWN_OPTIONS.contains(&option)).0;
        Ok(project.map(own).unwrap_or_default())
    }

    /// The means of executing each program.
    fn executors(&self) -> Vec<Executor> {
        let engines = self.engines();
        let as_board = engines.clone().into_iter().map(Executor::AsBoard);
        let is_wanted = self.form == RunForm::Board;
        let fast = engines.into_iter().map(Executor::Engine);
        fast.chain(as_board.filter(|_| is_wanted)).collect()
    }

    fn engines(&self) -> Vec<EngineName> {
        self.engine.map_or_else(EngineName::available, |engine| vec![engine])
    }
}

/// Finds the tests, runs them and reports the results.
pub(super) fn test(arguments: &TestArguments) -> Result<Exit> {
    let mut cases = case::find(&arguments.paths)?;
    if cases.is_empty() {
        bail!(
            "no tests there: a test is a program NAME.c with NAME.expected beside it, which `cc67 test --bless NAME.c` writes"
        );
    }
    let mut unchecked = Unchecked::default();
    let executors = match (&arguments.boot, &arguments.on) {
        (Some(file), _) => {
            cases.iter_mut().for_each(firmware::reduce);
            vec![Executor::firmware(file)?]
        }
        (None, Some(address)) => {
            controller::agree_unless(arguments.yes)?;
            unchecked = Unchecked::reduce(&mut cases);
            vec![Executor::Controller(address.to_string())]
        }
        (None, None) => arguments.executors(),
    };
    // A controller runs one test at a time.
    let jobs = if arguments.on.is_some() { 1 } else { arguments.jobs.map_or_else(processors, usize::from) };
    let (mut verdicts, took) = execute::all(&cases, &executors, &arguments.options, arguments.bless, jobs)?;
    for (case, verdict) in cases.iter().zip(&mut verdicts) {
        if let Verdict::Asked(shown) = verdict
            && (arguments.force || ask_to_accept(&case.name(), shown)?)
        {
            execute::write(case, shown)?;
            *verdict = Verdict::Blessed;
        }
    }
    arguments.schedules.explore(&cases, &mut verdicts, &arguments.options, jobs)?;
    if let Some(path) = &arguments.junit {
        output::write(path, machine::junit(&cases, &verdicts, &took).as_bytes())?;
    }
    let text = if arguments.json {
        machine::json(&cases, &verdicts)
    } else {
        unchecked.report() + &human::report(&cases, &verdicts, terminal::color(&std::io::stdout()))
    };
    output::print(&text)?;
    Ok(if verdicts.iter().any(Verdict::is_bad) { Exit::Failure } else { Exit::Success })
}

/// Asks whether faults, remarks, traps and an exit code should become expected output; without a terminal, it
/// returns false.
fn ask_to_accept(name: &str, shown: &Shown) -> Result<bool> {
    if !io::stdin().is_terminal() {
        return Ok(false);
    }
    let notes = human::indented(&shown.doubts());
    terminal::print_separated(&format!(
        "{name}: this would become the expected output:\n{notes}Write it? [y/N] "
    ));
    let mut answer = String::new();
    io::stdin().read_line(&mut answer).context("cannot read the answer")?;
    Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The command itself, for running programs: this executable, or the script by which a package started it.
fn this_command() -> Result<PathBuf> {
    if let Some(script) = std::env::var_os("CC67_COMMAND") {
        return Ok(script.into());
    }
    std::env::current_exe().context("cannot find the file of this command")
}
