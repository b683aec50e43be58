//! `cc67 cycles`: the cost of code on the processor.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;
use kmotiondef::ThreadId;
use kmotiondef::timing::Timing;

use super::build::thread;
use super::inspect::Folder;
use crate::cli::args::compiler::SourceArguments;
use crate::cli::compile::units;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use crate::cli::report::diagnostics;
use compiler::inspect::Inspection;
use compiler::target::Target;
use compiler::{image, link_units};

/// Arguments of `cc67 cycles`.
#[derive(Debug, Args)]
pub(super) struct CyclesArguments {
    /// Sources and objects of one program, or an image (.out)
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Thread of the program, 1 to 7
    #[arg(long, short = 't', value_name = "N", default_value = "1", value_parser = thread)]
    thread: ThreadId,
    /// Also list the instructions of all functions or one, packet by packet
    #[arg(long, value_name = "FUNCTION", num_args = 0..=1, require_equals = true)]
    asm: Option<Option<String>>,
    #[command(flatten)]
    compiler: SourceArguments,
}

/// Prints the cycles of functions and loops.
pub(super) fn cycles(arguments: &CyclesArguments) -> Result<Exit> {
    let first = arguments.files.first().context("there is a file")?;
    let bytes = read(first)?;
    let inspection = match Inspection::read(&bytes) {
        Ok(inspection) if inspection.image.program.is_some() => {
            ensure!(
                arguments.files.len() == 1,
                "`{}` is a whole program: name no other files",
                first.display()
            );
            inspection
        }
        _ => match arguments.build()? {
            Some(inspection) => inspection,
            None => return Ok(Exit::Failure),
        },
    };
    let mut text = inspection.cycles();
    if let Some(only) = &arguments.asm {
        let folder = Folder::new(first.parent().unwrap_or(Path::new("")));
        text = text + "\n" + &inspection.assembly(&folder, only.as_deref());
    }
    output::print(&text)?;
    Ok(Exit::Success)
}

impl CyclesArguments {
    /// The first file on the command line.
    pub(super) fn first(&self) -> Option<&OsStr> {
        self.files.first().map(|path| path.as_os_str())
    }

    /// The program linked from the sources; `None` after errors.
    fn build(&self) -> Result<Option<Inspection>> {
        let options = self.compiler.resolve(Target::C67x, Timing::VENDOR)?;
        let mut units = units::compile(&self.files, &options)?;
        let linked = link_units(&mut units, self.thread, &options);
        let has_errors = diagnostics::report_all(&units, &self.compiler.levels()?, self.compiler.format());
        let Some(linked) = linked.filter(|_| !has_errors) else { return Ok(None) };
        Ok(Some(Inspection::read(&image::write(&linked)?)?))
    }
}
