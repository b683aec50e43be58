//! `cc67 test`: golden tests of user programs.
//!
//! A test is a program `NAME.c` with `NAME.expected` beside it, which holds what the console shows.
//! The program is run by this very command, in a process of its own for each engine, so a test is
//! exactly what `cc67 run` does and no program can spoil another's result. The results are listed in
//! the order of the programs' names, whichever is ready first.

mod case;
mod execute;
mod golden;
mod human;
mod machine;

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;

use super::run::EngineName;
use super::{Exit, output};
use execute::Verdict;

/// Arguments of `cc67 test`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct Arguments {
    /// Programs, and folders to search for them
    #[arg(required_unless_present = "explain", value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Write what the programs show now to their .expected files
    #[arg(long)]
    bless: bool,
    /// Run on this engine alone; else on all, which must agree
    #[arg(long, value_enum)]
    engine: Option<EngineName>,
    /// Runs at a time, a program on two engines being two; else as many as there are processors
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print the results as JSON
    #[arg(long)]
    json: bool,
    /// Write the results as a JUnit report, too
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Options of `cc67 run` for every program
    #[arg(last = true, value_name = "OPTION")]
    options: Vec<String>,
}

const HELP: &str = "\
A test is a program NAME.c with NAME.expected beside it: the lines of the console, then `---- notes` and the
messages of the board, if there were any, then `---- exit N` unless the run succeeded.
The first line of the program may say how it is run:
    // cc67: run --for 2.5 --stim door.stim also 2:watchdog.c
NAME.toml beside it, if there is one, is its machine file, and NAME.stim its stimulus.
Exit code: 0 all as expected, 1 not all, 2 wrong usage.";

/// Finds the tests, runs them and reports.
pub(super) fn test(arguments: &Arguments) -> Result<Exit> {
    let cases = case::find(&arguments.paths)?;
    if cases.is_empty() {
        bail!(
            "no tests there: a test is a program NAME.c with NAME.expected beside it, which `cc67 test --bless NAME.c` writes"
        );
    }
    let engines = arguments.engine.map_or_else(EngineName::available, |engine| vec![engine]);
    let jobs = arguments.jobs.map_or_else(processors, usize::from);
    let verdicts = execute::all(&cases, &engines, &arguments.options, arguments.bless, jobs)?;
    if let Some(path) = &arguments.junit {
        output::write(path, machine::junit(&cases, &verdicts).as_bytes())?;
    }
    let text = if arguments.json {
        machine::json(&cases, &verdicts)
    } else {
        human::report(&cases, &verdicts, super::terminal::color(&std::io::stdout()))
    };
    output::print(&text)?;
    Ok(if verdicts.iter().all(Verdict::is_good) { Exit::Success } else { Exit::Failure })
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The command itself, to run programs with.
fn this_command() -> Result<PathBuf> {
    std::env::current_exe().context("cannot find the file of this command")
}
