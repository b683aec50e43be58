//! `cc67 completions` and `cc67 man`: information about the command line for shells and for the manual.
//!
//! Both are generated from the definition of the command line itself, so they are always up to date.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, Command};
use clap_complete::Shell;

use crate::cli::io::exit::Exit;
use crate::cli::io::output;

/// Arguments of `cc67 completions`.
#[derive(Debug, Args)]
pub(super) struct CompletionArguments {
    /// The shell
    #[arg(required_unless_present = "explain", value_enum)]
    shell: Option<Shell>,
}

/// Arguments of `cc67 man`.
#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Folder for the pages; created if it does not exist
    #[arg(required_unless_present = "explain", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// Prints a script that completes the subcommands and options of the command.
pub(super) fn completions(arguments: &CompletionArguments, mut command: Command) -> Result<Exit> {
    let Some(shell) = arguments.shell else { return Ok(Exit::WrongInput) };
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "cc67", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Success)
}

/// Writes a manual page for the command and one for each subcommand.
pub(super) fn man(arguments: &ManArguments, mut command: Command) -> Result<Exit> {
    let Some(folder) = &arguments.folder else { return Ok(Exit::WrongInput) };
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    command.build();
    for (name, command) in pages(&command) {
        let mut page = Vec::new();
        clap_mangen::Man::new(command).render(&mut page)?;
        output::write(&folder.join(format!("{name}.1")), &page)?;
    }
    Ok(Exit::Success)
}

/// The command and its subcommands, each with the name of its page.
fn pages(command: &Command) -> Vec<(String, Command)> {
    let name = command.get_name().to_owned();
    let mut pages = vec![(name.clone(), command.clone())];
    for part in command.get_subcommands().filter(|part| !part.is_hide_set() && part.get_name() != "help") {
        pages.push((format!("{name}-{}", part.get_name()), part.clone()));
    }
    pages
}
