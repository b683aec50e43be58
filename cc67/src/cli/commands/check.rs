//! `cc67 check`: diagnostics only.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use kmotiondef::ThreadId;
use kmotiondef::timing::Timing;

use crate::cli::args::compiler::SourceArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use crate::cli::report::diagnostics;
use compiler::image;
use compiler::inspect::Inspection;
use compiler::pp::Disk;
use compiler::target::Target;

/// Arguments of `cc67 check`.
#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Programs to check
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Show the stack that each function needs on the controller, and the worst chain of calls
    #[arg(long)]
    stack: bool,
    #[command(flatten)]
    compiler: SourceArguments,
}

/// Compiles every program and reports what is wrong with it.
pub(super) fn check(arguments: &CheckArguments) -> Result<Exit> {
    let target = if arguments.stack { Target::C67x } else { Target::default() };
    let options = arguments.compiler.resolve(target, Timing::VENDOR)?;
    let levels = arguments.compiler.levels()?;
    let mut has_errors = false;
    for path in &arguments.files {
        let text = read(path)?;
        let mut compilation = compiler::compile(path, text, &options, &Disk);
        // Which thread it would run in makes no difference to what can be wrong.
        let thread = ThreadId::all().next().context("the board has threads")?;
        let linked = compilation.link(thread, &options);
        has_errors |= diagnostics::report(&compilation, &levels, arguments.compiler.format());
        if let Some(linked) = linked.filter(|_| arguments.stack) {
            let name =
                if arguments.files.len() > 1 { format!("{}\n", path.display()) } else { String::new() };
            output::print(&(name + &Inspection::read(&image::write(&linked)?)?.stack()))?;
        }
    }
    Ok(if has_errors { Exit::Failure } else { Exit::Success })
}
