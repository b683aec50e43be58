//! The subcommands: one file each, one row each, of which [`Command`] is made.
//!
//! A subcommand has arguments, does its work with what is below it, and says by an exit code how that went.

mod build;
mod check;
mod compare;
mod console;
mod cycles;
mod debug;
mod deferred;
mod diff;
mod doctor;
mod drop_in;
mod examples;
mod explain;
mod firmware;
mod init;
mod inspect;
pub mod limits;
#[cfg(feature = "live")]
mod live;
mod machine;
mod package;
mod plot;
mod run;
mod serve;
mod shell;
mod test;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, Parser, Subcommand};
use compiler::words::suggest;

use self::deferred::Deferred;
use super::args::beside::Beside;
use super::io::exit::Exit;
use super::io::{output, terminal};

/// C compiler, linker and simulated KFLOP board.
#[derive(Debug, Parser)]
#[command(name = "cc67", version = VERSION, about, max_term_width = 100, arg_required_else_help = true, args_override_self = true)]
struct Arguments {
    /// Explain a function, field, bit, script command, warning, remark or topic; `topics` lists the topics
    #[arg(long, value_name = "NAME", global = true, allow_hyphen_values = true)]
    explain: Option<String>,
    #[command(subcommand)]
    command: Option<Command>,
}

/// Our version and that of the firmware which the simulated board models.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (models KFLOP firmware 4.34)");

macro_rules! subcommands {
    ($(
        $(#[doc = $doc:literal])+
        $(#[cfg($condition:meta)])?
        $name:ident($kind:ty) as $arguments:ident => $run:expr;
    )*) => {
        #[derive(Debug, Subcommand)]
        enum Command {
            $($(#[doc = $doc])+ $(#[cfg($condition)])? $name(Deferred<$kind>),)*
        }

        impl Command {
            fn run(&self) -> Result<Exit> {
                match self {
                    $($(#[cfg($condition)])? Self::$name($arguments) => $run,)*
                }
            }
        }
    };
}

subcommands! {
    /// Compile programs, run them in threads of the simulated board and print the console
    Run(run::RunArguments) as arguments => run::run(arguments);
    /// Compile and link a program into an image for one thread, FILE(N).out
    Build(build::BuildArguments) as arguments => build::build(arguments);
    /// Compile programs and report mistakes
    Check(check::CheckArguments) as arguments => check::check(arguments);
    /// Talk to a simulated board, interactively or from a script: send script commands, run programs
    Console(console::ConsoleArguments) as arguments => console::console(arguments);
    /// Serve a simulated board to programs that use the vendor's client library; replaces the vendor's server
    Serve(serve::ServeArguments) as arguments => serve::serve(arguments);
    /// Show a simulated board in the browser: axes, inputs and outputs, console, threads, signals
    #[cfg(feature = "live")]
    Live(live::LiveArguments) as arguments => live::live(arguments);
    /// Debug programs, forwards and backwards: in the terminal, from a script, or from an editor (--dap)
    Debug(debug::DebugArguments) as arguments => debug::debug(arguments);
    /// Show the contents of an image: headers, symbols, lines, instructions, calls, stack
    Inspect(inspect::InspectArguments) as arguments => inspect::inspect(arguments);
    /// Show the cycles of functions and loops on the controller's processor, computed from their code
    Cycles(cycles::CyclesArguments) as arguments => cycles::cycles(arguments);
    /// Run programs on the modelled firmware and on your own firmware file, and show where they differ
    Compare(compare::CompareArguments) as arguments => compare::compare(arguments);
    /// Show how two images differ
    Diff(diff::DiffArguments) as arguments => diff::diff(arguments);
    /// List the simulated firmware's names, or export them as a file to link against
    Firmware(firmware::FirmwareArguments) as arguments => firmware::firmware(arguments);
    /// Run programs and compare their output with the expected output
    Test(test::TestArguments) as arguments => test::test(arguments);
    /// Create a project folder, ready for an editor and for CI
    Init(init::InitArguments) as arguments => init::init(arguments);
    /// Compute keys of a machine file from the data sheets of motor, amplifier and encoder
    Machine(machine::MachineArguments) as arguments => machine::machine(arguments);
    /// List the example programs, or copy one
    Examples(examples::ExamplesArguments) as arguments => examples::examples(arguments);
    /// Plot saved data over time: columns of numbers, traces (.csv, .vcd)
    Plot(plot::PlotArguments) as arguments => plot::plot(arguments);
    /// Run programs for many combinations of parameters (FILE.toml) and write a table; needs the Python package
    Sweep(package::PackageArguments) as arguments => package::run("sweep", arguments);
    /// Measure step and frequency response, following error or tolerance of a program; needs the Python package
    Study(package::PackageArguments) as arguments => package::run("study", arguments);
    /// Show what is installed: command, engines, examples, editors, Python, controllers; for reports of faults
    Doctor(doctor::DoctorArguments) as arguments => doctor::doctor(arguments);
    /// Print the completion script for a shell
    Completions(shell::CompletionArguments) as arguments => shell::completions(arguments, Arguments::command());
    /// Write manual pages
    Man(shell::ManArguments) as arguments => shell::man(arguments, Arguments::command());
}

/// `-std=c99`, as other compilers take it, is `--std=c99` here.
fn as_long_option(argument: OsString) -> OsString {
    match argument.to_str().and_then(|text| text.strip_prefix("-std=")) {
        Some(standard) => format!("--std={standard}").into(),
        None => argument,
    }
}

/// Runs the command with the arguments of a process, the program's name first.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if drop_in::is_meant(&arguments) {
        return drop_in::main(&arguments);
    }
    let arguments = serve::home::called_as_server(&arguments).unwrap_or(arguments);
    let words: Vec<OsString> = arguments.into_iter().map(as_long_option).collect();
    if asks_for_version_in_full(&words) {
        return output::print(&doctor::version()).map_or(Exit::WrongInput, |()| Exit::Success).into();
    }
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => match arguments.with_sidecars(&words) {
            Ok(arguments) => arguments,
            Err(error) => {
                terminal::error(&error);
                return Exit::WrongInput.into();
            }
        },
        Err(error) => match advice(&error) {
            Some(advice) => {
                terminal::note(&advice);
                return Exit::WrongInput.into();
            }
            // Help and version go to stdout with success, wrong usage to stderr with 2.
            None => error.exit(),
        },
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

/// Whether the arguments are `--version` and `--verbose`, in either order.
fn asks_for_version_in_full(words: &[OsString]) -> bool {
    let [_, options @ ..] = words else { return false };
    let has = |names: [&str; 2]| options.iter().any(|option| names.iter().any(|name| option == name));
    options.len() == 2 && has(["--version", "-V"]) && has(["--verbose", "-v"])
}

impl Arguments {
    /// The same with the options of the project file and of the files beside the first program; one line names them.
    fn with_sidecars(mut self, words: &[OsString]) -> Result<Self> {
        if let Some(Command::Compare(arguments)) = &mut self.command {
            // Each of its programs has its own.
            arguments.words = words.to_vec();
        }
        let (name, programs) = match &self.command {
            Some(Command::Run(arguments)) => ("run", arguments.with_sidecars()),
            #[cfg(feature = "live")]
            Some(Command::Live(arguments)) => ("live", arguments.with_sidecars()),
            Some(Command::Debug(arguments)) => ("debug", arguments.with_sidecars()),
            Some(Command::Test(_)) => ("test", None),
            _ => return Ok(self),
        };
        let (beside, line) = match (programs, &self.command) {
            (Some(programs), _) => {
                let beside = Beside::of(name, programs, words, |option| knows(name, option))?;
                let line = programs.first().and_then(|program| beside.line(program));
                (beside, line)
            }
            (None, Some(Command::Test(arguments))) => (Beside::from(arguments.of_project()?), None),
            (None, _) => return Ok(self),
        };
        if beside.is_empty() {
            return Ok(self);
        }
        let at = words.iter().position(|word| word == name).context("the subcommand is among the words")? + 1;
        let (before, given) = words.split_at(at);
        let arguments = Self::try_parse_from([before, &beside.options, given, &beside.also].concat());
        let arguments = arguments.map_err(|error| {
            let text = error.to_string();
            let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
            anyhow!("{}: {first}", line.as_deref().unwrap_or("cc67.toml"))
        })?;
        line.iter().for_each(|line| terminal::note(line));
        Ok(arguments)
    }
}

/// Whether a subcommand has an option, by its long or short name.
fn knows(subcommand: &str, option: &str) -> bool {
    let mut command = Arguments::command();
    command.build();
    let Some(subcommand) = command.find_subcommand(subcommand) else { return false };
    subcommand.get_arguments().any(|argument| {
        let long = argument.get_long_and_visible_aliases().unwrap_or_default();
        let aliases = argument.get_all_aliases().unwrap_or_default();
        let is_long = long.into_iter().chain(aliases).any(|name| option == format!("--{name}"));
        is_long
            || argument
                .get_short()
                .is_some_and(|short| option.starts_with(&format!("-{short}")) && !option.starts_with("--"))
    })
}

/// What to type in place of a word that is not a subcommand: a program needs `run`, and another word may be misspelt.
fn advice(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let path = Path::new(word);
    let suffix = path.extension().unwrap_or_default();
    if ["c", "out"].iter().any(|known| suffix.eq_ignore_ascii_case(known)) || path.is_file() {
        return Some(format!("`{word}` is not a subcommand; to run it: `cc67 run {word}`"));
    }
    let command = Arguments::command();
    let similar = suggest(word, command.get_subcommands().map(clap::Command::get_name))?;
    Some(format!("`{word}` is not a subcommand; did you mean `{similar}`?"))
}
