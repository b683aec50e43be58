//! `--stim FILE|TEXT`: what the world around the board does.

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use runtime::machine_file::MachineFile;
use runtime::stimulus::Stimulus;

use super::program::ProgramFile;
use crate::cli::io::input::read as read_file;

/// The name of the command line's statements in messages.
const OPTION: &str = "--stim";

/// Reads all stimuli, one after another.
pub(crate) fn read(arguments: &[String]) -> Result<Stimulus> {
    let mut all = Stimulus::default();
    for argument in arguments {
        all.extend(one(argument)?);
    }
    Ok(all)
}

/// Programs that stimuli load while they are played, each once.
pub(crate) fn programs(stimuli: &[&Stimulus]) -> Vec<ProgramFile> {
    let named = stimuli.iter().flat_map(|stimulus| stimulus.programs());
    let mut programs: Vec<ProgramFile> = Vec::new();
    for program in named.map(|(thread, name)| ProgramFile { thread, path: PathBuf::from(&**name) }) {
        if !programs.contains(&program) {
            programs.push(program);
        }
    }
    programs
}

/// A file of that name, else statements: those have spaces or signs in them.
fn one(argument: &str) -> Result<Stimulus> {
    let path = Path::new(argument);
    if path.exists() || !argument.contains([' ', '=']) {
        let bytes = read_file(path)?;
        let Ok(text) = String::from_utf8(bytes) else { bail!("{argument} is not text") };
        if path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("toml")) {
            return table(&text, argument);
        }
        return Ok(Stimulus::parse(&text, argument)?);
    }
    // The statements in full help where the line and column alone do not.
    Stimulus::parse(argument, OPTION).map_err(|error| anyhow!("{error} in `{argument}`"))
}

/// Events and devices as a machine file has them; what else it says belongs to `--machine`.
fn table(text: &str, name: &str) -> Result<Stimulus> {
    let machine = MachineFile::parse(text)
        .map_err(|error| anyhow!("{name}:{}:{}: {error}", error.line, error.column))?;
    let others = MachineFile { stimulus: machine.stimulus.clone(), ..MachineFile::default() };
    if machine != others {
        bail!("{name}: a stimulus has only [[event]] and [[device]]; the rest belongs to `--machine`");
    }
    Ok(machine.stimulus)
}
