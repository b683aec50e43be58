//! `--stim FILE|TEXT`: the actions of the world around the board.

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use runtime::machine_file::MachineFile;
use runtime::stimulus::Stimulus;

use super::program::ProgramFile;
use crate::cli::io::input::read as read_file;

/// The name used in messages for statements of the command line.
const OPTION: &str = "--stim";

/// Reads all stimuli, one after another.
pub(crate) fn read(arguments: &[String]) -> Result<Stimulus> {
    let mut all = Stimulus::default();
    for argument in arguments {
        all.extend(one(argument)?);
    }
    Ok(all)
}

/// The programs that stimuli may load, without duplicates.
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

/// Reads a file with that name, or otherwise parses statements: these contain spaces or special characters.
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
    // The full text, as a line and column alone would be of little help.
    Stimulus::parse(argument, OPTION).map_err(|error| anyhow!("{error} in `{argument}`"))
}

/// Takes events and devices from a machine file; its other tables belong to `--machine`.
fn table(text: &str, name: &str) -> Result<Stimulus> {
    let machine = MachineFile::parse(text)
        .map_err(|error| anyhow!("{name}:{}:{}: {error}", error.line, error.column))?;
    let others = MachineFile { stimulus: machine.stimulus.clone(), ..MachineFile::default() };
    if machine != others {
        bail!("{name}: a stimulus has only [[event]] and [[device]]; the rest belongs to `--machine`");
    }
    Ok(machine.stimulus)
}
