//! The subcommands: one file each, and one row each in the table from which [`Command`] is made.
//!
//! A subcommand has arguments, works through the layers below it, and returns an exit code.

mod boards;
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
mod flash;
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

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use clap::builder::{StyledStr, Styles};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};
use compiler::words::suggest;

use self::deferred::Deferred;
use super::args::board::canonical_words;
use super::args::sidecars::{Project, Sidecars};
use super::io::exit::Exit;
use super::io::{output, stack, terminal};

/// C compiler, linker and simulated KFLOP board.
#[derive(Debug, Parser)]
#[command(name = "cc67", version = VERSION, about, max_term_width = 100, arg_required_else_help = true, args_override_self = true, override_help = overview())]
struct Arguments {
    /// Explain a name, as `cc67 explain NAME` does
    #[arg(long, value_name = "NAME", global = true, allow_hyphen_values = true, hide = true)]
    explain: Option<String>,
    #[command(subcommand)]
    command: Option<Command>,
}

/// Our version, and the version of the modelled firmware.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (models KFLOP firmware 4.34)");

macro_rules! subcommands {
    ($($group:literal {$(
        #[doc = $doc:literal]
        $(#[cfg($condition:meta)])?
        $name:ident($kind:ty) as $arguments:ident => $run:expr;
    )*})*) => {
        #[derive(Debug, Subcommand)]
        enum Command {
            $($(#[doc = $doc] $(#[cfg($condition)])? $name(Deferred<$kind>),)*)*
        }

        impl Command {
            fn run(&self) -> Result<Exit> {
                match self {
                    $($($(#[cfg($condition)])? Self::$name($arguments) => $run,)*)*
                }
            }
        }

        /// The subcommands by group, each with its description.
        const GROUPS: &[(&str, &[(&str, &str)])] =
            &[$(($group, &[$($(#[cfg($condition)])? (stringify!($name), $doc),)*])),*];
    };
}

subcommands! {
    "Start" {
        /// Create a project folder, ready for an editor and for CI
        Init(init::InitArguments) as arguments => init::init(arguments);
        /// List the example programs, or copy one
        Examples(examples::ExamplesArguments) as arguments => examples::examples(arguments);
        /// Compute keys of a machine file from the data sheets of motor, amplifier and encoder
        Machine(machine::MachineArguments) as arguments => machine::machine(arguments);
        /// Explain a function, field, bit, script command, warning, remark or topic
        Explain(explain::ExplainArguments) as arguments => explain::explain(&arguments.name);
    }
    "Build and check" {
        /// Compile programs and report mistakes
        Check(check::CheckArguments) as arguments => check::check(arguments);
        /// Compile and link a program into an image for one thread, FILE(N).out
        Build(build::BuildArguments) as arguments => build::build(arguments);
    }
    "Run and watch" {
        /// Compile programs, run them in threads of a simulated board, print the console
        Run(run::RunArguments) as arguments => run::run(arguments);
        /// Run programs and compare their output with the expected output
        Test(test::TestArguments) as arguments => test::test(arguments);
        /// Debug programs, forwards and backwards: in the terminal, by a script, in an editor
        Debug(debug::DebugArguments) as arguments => debug::debug(arguments);
        /// Show a simulated board in the browser: axes, inputs and outputs, console, signals
        #[cfg(feature = "live")]
        Live(live::LiveArguments) as arguments => live::live(arguments);
        /// Plot saved data over time: columns of numbers, traces (.csv, .vcd)
        Plot(plot::PlotArguments) as arguments => plot::plot(arguments);
    }
    "Boards and PCs" {
        /// List the controllers that are connected to this computer
        Boards(boards::BoardsArguments) as arguments => boards::boards(arguments);
        /// Save programs and settings to the flash of a controller, which starts with them
        Flash(flash::FlashArguments) as arguments => flash::flash(arguments);
        /// Send script commands to a simulated board, interactively or from a script
        Console(console::ConsoleArguments) as arguments => console::console(arguments);
        /// Serve a simulated board to programs that use the vendor's client library
        Serve(serve::ServeArguments) as arguments => serve::serve(arguments);
        /// Run programs on the modelled firmware and on your firmware file, show differences
        Compare(compare::CompareArguments) as arguments => compare::compare(arguments);
        /// List the simulated firmware's names, or export them as a file to link against
        Firmware(firmware::FirmwareArguments) as arguments => firmware::firmware(arguments);
    }
    "Analyse" {
        /// Show the contents of an image: headers, symbols, lines, instructions, calls, stack
        Inspect(inspect::InspectArguments) as arguments => inspect::inspect(arguments);
        /// Show how two images differ
        Diff(diff::DiffArguments) as arguments => diff::diff(arguments);
        /// Compute the cycles of functions and loops on the controller's processor
        Cycles(cycles::CyclesArguments) as arguments => cycles::cycles(arguments);
        /// Run programs for many combinations of parameters (needs the Python package)
        Sweep(package::PackageArguments) as arguments => package::run("sweep", arguments);
        /// Measure step and frequency response, following error (needs the Python package)
        Study(package::PackageArguments) as arguments => package::run("study", arguments);
    }
    "More" {
        /// Show what is installed, for bug reports: command, engines, editors, controllers
        Doctor(doctor::DoctorArguments) as arguments => doctor::doctor(arguments);
        /// Print the completion script for a shell
        Completions(shell::CompletionArguments) as arguments => shell::completions(arguments, Arguments::command());
        /// Write manual pages
        Man(shell::ManArguments) as arguments => shell::man(arguments, Arguments::command());
    }
}

/// Returns the definition of the whole command line: options, and subcommands with their options.
#[must_use]
pub fn description() -> clap::Command {
    let mut command = Arguments::command();
    command.build();
    command
}

/// The help of the command: the subcommands by group.
fn overview() -> StyledStr {
    let styles = Styles::styled();
    let (heading, word) = (styles.get_header(), styles.get_literal());
    let mut text = format!(
        "Compile, run, test and debug C programs for KFLOP motion controllers\n\n\
         {heading}Usage:{heading:#} {word}cc67{word:#} COMMAND [OPTION]... [FILE]...\n"
    );
    for (group, commands) in GROUPS {
        text.push_str(&format!("\n{heading}{group}:{heading:#}\n"));
        for (name, about) in *commands {
            text.push_str(&format!("  {word}{:<13}{word:#}{}\n", name.to_ascii_lowercase(), about.trim()));
        }
    }
    text.push_str(&format!(
        "\n{heading}Options:{heading:#}\n  {word}-h{word:#}, {word}--help{word:#}     Print help; \
         `cc67 COMMAND --help` describes the options of a command\n  {word}-V{word:#}, \
         {word}--version{word:#}  Print version; with --verbose also how it was built\n\n\
         `cc67 explain topics` lists subjects with a page each. The book, with a tutorial, is the folder\n\
         cc67/book of the sources.\n"
    ));
    text.into()
}

/// Converts `-std=c99`, the form of other compilers, to `--std=c99`.
fn as_long_option(argument: OsString) -> OsString {
    match argument.to_str().and_then(|text| text.strip_prefix("-std=")) {
        Some(standard) => format!("--std={standard}").into(),
        None => argument,
    }
}

/// Runs the command with the arguments of a process, the program's name first.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if !stack::is_small() {
        return command(arguments);
    }
    stack::on_own(move || command(arguments)).unwrap_or_else(|error| {
        terminal::note(&format!("the system starts no thread for the command: {error}"));
        Exit::WrongInput.into()
    })
}

/// Executes the command.
fn command(arguments: Vec<OsString>) -> ExitCode {
    if drop_in::is_invoked(&arguments) {
        return drop_in::main(&arguments);
    }
    let arguments = serve::home::called_as_server(&arguments).unwrap_or(arguments);
    let words = canonical_words(arguments.into_iter().map(as_long_option));
    if asks_for_version_in_full(&words) {
        return output::print(&doctor::version()).map_or(Exit::WrongInput, |()| Exit::Success).into();
    }
    let (words, parsed) = match Arguments::try_parse_from(&words) {
        Err(error) if let Some(words) = with_programs_of_project(&error, &words) => {
            let parsed = Arguments::try_parse_from(&words);
            (words, parsed)
        }
        parsed => (words, parsed),
    };
    let arguments = match parsed {
        Ok(arguments) => match arguments.with_sidecars(&words) {
            Ok(arguments) => arguments,
            Err(error) => {
                terminal::error(&error);
                return Exit::WrongInput.into();
            }
        },
        Err(error) => match advice(&error, &words) {
            Some(advice) => {
                terminal::note(&advice);
                return Exit::WrongInput.into();
            }
            // Help and version go to stdout with exit code 0, usage errors to stderr with 2.
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

/// Returns the words of a command that runs programs but names none, with the programs of the project file.
fn with_programs_of_project(error: &clap::Error, words: &[OsString]) -> Option<Vec<OsString>> {
    let is_without = error.kind() == ErrorKind::MissingRequiredArgument
        && ["run", "live", "debug"].iter().any(|name| words.get(1).is_some_and(|word| word == name));
    let project = is_without.then(|| Project::find_above(Path::new(""))).and_then(Result::ok).flatten()?;
    (!project.programs().is_empty()).then(|| [words, project.programs()].concat())
}

/// Returns whether the arguments are `--version` and `--verbose`, in either order.
fn asks_for_version_in_full(words: &[OsString]) -> bool {
    let [_, options @ ..] = words else { return false };
    let has = |names: [&str; 2]| options.iter().any(|option| names.iter().any(|name| option == name));
    options.len() == 2 && has(["--version", "-V"]) && has(["--verbose", "-v"])
}

impl Arguments {
    /// Adds the options of the project file and of the files next to the first program, which are named in one line of
    /// output.
    fn with_sidecars(mut self, words: &[OsString]) -> Result<Self> {
        if let Some(Command::Compare(arguments)) = &mut self.command {
            // Each of its programs has its own files.
            arguments.words = words.to_vec();
        }
        if let Some(Command::Debug(arguments)) = &mut self.command {
            let words = words.iter().skip_while(|word| *word != "debug").skip(1);
            arguments.words = words.cloned().collect();
        }
        let (name, programs) = match &self.command {
            Some(Command::Run(arguments)) => ("run", arguments.with_sidecars()),
            #[cfg(feature = "live")]
            Some(Command::Live(arguments)) => ("live", arguments.with_sidecars()),
            Some(Command::Debug(arguments)) => ("debug", arguments.with_sidecars()),
            Some(Command::Test(_)) => ("test", None),
            Some(Command::Check(_)) => ("check", None),
            Some(Command::Build(_)) => ("build", None),
            Some(Command::Cycles(_)) => ("cycles", None),
            _ => return Ok(self),
        };
        let (sidecars, line) = match (programs, &self.command) {
            (Some(programs), _) => {
                let sidecars = Sidecars::of(name, programs, words, |option| is_option_of(name, option))?;
                let line = programs.first().and_then(|program| sidecars.line(program));
                (sidecars, line)
            }
            (None, Some(Command::Test(arguments))) => (Sidecars::from(arguments.of_project()?), None),
            (None, Some(Command::Check(arguments))) => (of_sources(name, arguments.first())?, None),
            (None, Some(Command::Build(arguments))) => (of_sources(name, arguments.first())?, None),
            (None, Some(Command::Cycles(arguments))) => (of_sources(name, arguments.first())?, None),
            (None, _) => return Ok(self),
        };
        if sidecars.is_empty() {
            return Ok(self);
        }
        let at = words.iter().position(|word| word == name).context("the subcommand is among the words")? + 1;
        let (before, given) = words.split_at(at);
        let arguments = Self::try_parse_from(canonical_words(
            [before, &sidecars.options, given, &sidecars.also].concat(),
        ));
        let arguments = arguments.map_err(|error| {
            let text = error.to_string();
            let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
            anyhow!("{}: {first}", line.as_deref().unwrap_or("cc67.toml"))
        })?;
        line.iter().for_each(|line| terminal::note(line));
        Ok(arguments)
    }
}

/// Returns the options of the project file for the sources of a subcommand.
fn of_sources(subcommand: &str, first: Option<&OsStr>) -> Result<Sidecars> {
    Sidecars::of_sources(first, |option| is_option_of(subcommand, option))
}

/// Returns whether a subcommand has an option, by its long or short name.
fn is_option_of(subcommand: &str, option: &str) -> bool {
    description().find_subcommand(subcommand).is_some_and(|subcommand| has_option(subcommand, option))
}

/// Returns whether a subcommand has an option, by its long or short name.
fn has_option(subcommand: &clap::Command, option: &str) -> bool {
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

/// Returns the correction for a word that is not a subcommand, or not an option of the given one: a program needs
/// `run`, an option may belong to other subcommands, and another word may be misspelled.
fn advice(error: &clap::Error, words: &[OsString]) -> Option<String> {
    if let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg)
        && error.kind() == ErrorKind::UnknownArgument
    {
        return other_subcommands(option, words);
    }
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

/// Returns the subcommands that have an option which the one in `words` lacks.
fn other_subcommands(option: &str, words: &[OsString]) -> Option<String> {
    let command = description();
    let is_subcommand = |word: &&OsString| command.get_subcommands().any(|known| **word == *known.get_name());
    let used = words.iter().skip(1).find(is_subcommand)?.to_str()?;
    let option = option.split('=').next().unwrap_or(option);
    let have = command.get_subcommands().filter(|known| has_option(known, option));
    let have: Vec<_> = have.map(|known| format!("`cc67 {}`", known.get_name())).collect();
    let (last, others) = have.split_last()?;
    let have = if others.is_empty() { last.clone() } else { format!("{} and {last}", others.join(", ")) };
    let after = if used == "test" && have.contains("`cc67 run`") {
        format!("; `cc67 test … -- {option}` passes it to the programs of the tests")
    } else {
        String::new()
    };
    Some(format!("`{option}` has no effect in `cc67 {used}`; it is an option of {have}{after}"))
}
