//! `cc67 check`: diagnostics only.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use kmotiondef::ThreadId;

use crate::cli::args::compiler::CompilerArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::report::diagnostics;
use compiler::pp::Disk;

/// Arguments of `cc67 check`.
#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// The programs
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    compiler: CompilerArguments,
}

/// Compiles every program and reports what is wrong with it.
pub(super) fn check(arguments: &CheckArguments) -> Result<Exit> {
    let options = arguments.compiler.resolve()?;
    let levels = arguments.compiler.levels()?;
    let mut has_errors = false;
    for path in &arguments.files {
        let text = read(path)?;
        let mut compilation = compiler::compile(path, text, &options, &Disk);
        // Which thread it would run in makes no difference to what can be wrong.
        let thread = ThreadId::all().next().context("the board has threads")?;
        compilation.link(thread, &options);
        has_errors |= diagnostics::report(&compilation, &levels, arguments.compiler.format());
    }
    Ok(if has_errors { Exit::Failure } else { Exit::Success })
}
