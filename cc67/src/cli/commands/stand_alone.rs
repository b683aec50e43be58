//! The command of an executable from `cc67 build --emit native`: `cc67 run` of the program that it contains as machine
//! code.

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;

use anyhow::{Context, Result};
use clap::Parser;
use runtime::loader::prepare;
use vm::native::{Linked, LinkedEngine, LinkedError};

use super::{explain, run};
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;

/// A KFLOP program with the simulated board that it runs on, made by `cc67 build --emit native`.
///
/// The options are those of `cc67 run`; further programs run beside it in other threads.
#[derive(Debug, Parser)]
#[command(max_term_width = 100)]
struct StandAlone {
    /// Explain a warning, or limits, machine, stimulus, as `cc67 --explain` does
    #[arg(long, value_name = "WARNING")]
    explain: Option<String>,
    #[command(flatten)]
    run: run::RunArguments,
}

/// Runs the program that the executable holds, with the arguments of the process, its name first.
pub fn main(
    arguments: impl IntoIterator<Item = OsString>,
    linked: std::result::Result<Linked, LinkedError>,
) -> Exit {
    let exit =
        linked.map_err(Into::into).and_then(|linked| run(arguments, &linked)).unwrap_or_else(|error| {
            terminal::error(&error);
            Exit::WrongInput
        });
    // Where C's `main` came first, nobody else does it; who has gone reads no more.
    let _ = io::stdout().flush();
    exit
}

fn run(arguments: impl IntoIterator<Item = OsString>, linked: &Linked) -> Result<Exit> {
    let (image, thread) = (linked.image(), linked.thread());
    let prepared = prepare(image, thread, |_| false).context("the image in this executable")?;
    let program = prepared.code.program().context("the image in this executable is not bytecode")?;
    let engine = LinkedEngine::with_linked(linked, (**program).clone(), &runtime::pure_function)?;

    let mut arguments = arguments.into_iter();
    let own = arguments.next().unwrap_or_default();
    // The program is the first of the line: for messages a file of its name, which nobody reads.
    let mut name = OsString::from(format!("{thread}:"));
    name.push(Path::new(&own).file_stem().unwrap_or_default());
    name.push(".out");
    let arguments = StandAlone::parse_from([own, name].into_iter().chain(arguments));
    match &arguments.explain {
        Some(name) => explain::explain(name),
        None => run::run_held(&arguments.run, image, engine),
    }
}
