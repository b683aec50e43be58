//! `--stim FILE|TEXT`: what the world around the board does.

use std::path::Path;

use anyhow::{Result, anyhow, bail};
use runtime::stimulus::Stimulus;

/// What messages call statements that stand on the command line.
const OPTION: &str = "--stim";

/// Reads all stimuli, one behind the other.
pub(super) fn read(arguments: &[String]) -> Result<Stimulus> {
    let mut all = Stimulus::default();
    for argument in arguments {
        all.extend(one(argument)?);
    }
    Ok(all)
}

/// A file of that name, else statements: those have spaces or signs in them.
fn one(argument: &str) -> Result<Stimulus> {
    let path = Path::new(argument);
    if path.exists() || !argument.contains([' ', '=']) {
        let bytes = super::run::read(path)?;
        let Ok(text) = String::from_utf8(bytes) else { bail!("{argument} is not text") };
        return Ok(Stimulus::parse(&text, argument)?);
    }
    // The statements in full help where the line and column alone do not.
    Stimulus::parse(argument, OPTION).map_err(|error| anyhow!("{error} in `{argument}`"))
}
