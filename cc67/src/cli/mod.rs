//! The command line: one file a subcommand, one row each in [`Command`].
//!
//! What a program prints goes to stdout byte for byte, everything else to stderr. Messages
//! about the request or its inputs are single lines that begin with `cc67: `. Where `cc67` stands
//! in for the vendor's compiler ([`drop_in`]), arguments and messages are that one's.

mod build;
mod check;
mod console;
mod diff;
mod drop_in;
mod exit;
mod explain;
mod firmware;
mod init;
mod inspect;
mod options;
mod output;
mod pace;
mod pc;
mod plot;
mod profile;
mod program;
mod repeats;
mod run;
mod screen;
mod setting;
mod shell;
#[cfg(feature = "native")]
mod stand_alone;
mod stimulus;
mod terminal;
mod test;
mod trace;
mod uart;
mod units;

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

pub use exit::Exit;
pub(crate) use repeats::MOST as SHOWN_REMARKS;
pub(crate) use runtime::FILE_BYTES as PC_FILE_BYTES;
pub(crate) use runtime::stimulus::MOST_PLANNED as STIMULUS_PLANS;
#[cfg(feature = "native")]
pub use stand_alone::main as stand_alone;
pub(crate) use trace::SAMPLES as PICTURE_SAMPLES;

/// C compiler, linker and simulated KFLOP board.
#[derive(Debug, Parser)]
#[command(name = "cc67", version = VERSION, about, max_term_width = 100, arg_required_else_help = true)]
struct Arguments {
    /// Explain a warning by the name in its brackets; `warnings` lists them all; also limits, machine, stimulus
    #[arg(long, value_name = "WARNING", global = true, allow_hyphen_values = true)]
    explain: Option<String>,
    #[command(subcommand)]
    command: Option<Command>,
}

/// Our version and that of the firmware which the simulated board models.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (models KFLOP firmware 4.34)");

#[derive(Debug, Subcommand)]
enum Command {
    /// Compile programs into threads, execute them on the simulated board, print the console
    Run(Box<run::Arguments>),
    /// Compile and link a program for a thread into an image, FILE(N).out
    Build(build::Arguments),
    /// Compile programs and report what is wrong with them
    Check(check::Arguments),
    /// Talk to a simulated board: script commands, programs, what they print; interactive or from a script
    Console(console::Arguments),
    /// Show what is in an image: headers, symbols, lines, instructions, calls, stack
    Inspect(inspect::Arguments),
    /// Show how two images differ
    Diff(diff::Arguments),
    /// The simulated firmware as a file to link against, and as a list
    Firmware(firmware::Arguments),
    /// Run programs and compare their consoles with what is expected
    Test(test::Arguments),
    /// Make a project folder ready for an editor and for CI
    Init(init::Arguments),
    /// Draw saved data over time: columns of numbers, traces (.csv, .vcd)
    Plot(plot::Arguments),
    /// Print a script that completes commands and options in a shell
    Completions(shell::CompletionArguments),
    /// Write manual pages
    Man(shell::ManArguments),
}

impl Command {
    fn run(&self) -> Result<Exit> {
        match self {
            Self::Run(arguments) => run::run(arguments),
            Self::Build(arguments) => build::build(arguments),
            Self::Check(arguments) => check::check(arguments),
            Self::Console(arguments) => console::console(arguments),
            Self::Inspect(arguments) => inspect::inspect(arguments),
            Self::Diff(arguments) => diff::diff(arguments),
            Self::Firmware(arguments) => firmware::firmware(arguments),
            Self::Test(arguments) => test::test(arguments),
            Self::Init(arguments) => init::init(arguments),
            Self::Plot(arguments) => plot::plot(arguments),
            Self::Completions(arguments) => shell::completions(arguments),
            Self::Man(arguments) => shell::man(arguments),
        }
    }
}

/// Runs the command with the arguments of a process, the program's name first.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if drop_in::is_meant(&arguments) {
        return drop_in::main(&arguments);
    }
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to stdout with success, wrong usage to stderr with 2.
            error.exit()
        }
    };
    let result = match (&arguments.explain, &arguments.command) {
        (Some(name), _) => explain::explain(name),
        (None, Some(command)) => command.run(),
        (None, None) => return Exit::WrongInput.into(),
    };
    result
        .unwrap_or_else(|error| {
            terminal::error(&error);
            Exit::WrongInput
        })
        .into()
}
