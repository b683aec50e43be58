//! Programs for threads: one image each, compiled from a source or read from a file.

use anyhow::{Context, Result};
use cc67_host::UserProgram;

use compiler::Options;
use compiler::diag::levels::Levels;
use compiler::render::Format;

use super::units;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::program::ProgramFile;
use crate::cli::io::input::read;
use crate::cli::report::diagnostics;

/// The programs of files, for the target and the firmware of the options; `None` if a source has errors, after all of
/// them have been compiled.
pub(crate) fn programs(
    files: &[ProgramFile],
    compiler: &CompilerArguments,
    options: &Options,
) -> Result<Option<Vec<UserProgram>>> {
    let levels = compiler.levels()?;
    let format = compiler.format();
    let mut programs = Vec::new();
    let mut has_errors = false;
    for file in files {
        let bytes = read(&file.path)?;
        let program = if file.is_image() {
            Some(UserProgram::of_bytes(&file.path, file.thread, bytes))
        } else {
            build(file, bytes, options, &levels, format)?
        };
        has_errors |= program.is_none();
        programs.extend(program);
    }
    Ok((!has_errors).then_some(programs))
}

/// Compiles, links and reports; `None` after errors.
fn build(
    program: &ProgramFile,
    text: Vec<u8>,
    options: &Options,
    levels: &Levels,
    format: Format,
) -> Result<Option<UserProgram>> {
    let mut compilation = units::unit(&program.path, text, options)?;
    let linked = compilation.link(program.thread, options);
    if diagnostics::report(&compilation, levels, format) {
        return Ok(None);
    }
    let Some(linked) = linked else { return Ok(None) };
    let made = UserProgram::of_linked(&program.path, &linked);
    Ok(Some(made.with_context(|| program.name().to_string())?))
}
