//! `cc67 firmware`: the simulated firmware as a file for linking, and as a list.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS, Origin};
use kmotiondef::limits::VERSION;
use kmotiondef::variables::FIRMWARE_VARIABLES;
use serde_json::json;

use crate::cli::args::compiler::board;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use compiler::firmware::{self, FirmwareFile};

/// Arguments of `cc67 firmware`.
#[derive(Debug, Args)]
pub(super) struct FirmwareArguments {
    #[command(subcommand)]
    command: FirmwareCommand,
}

#[derive(Debug, Subcommand)]
enum FirmwareCommand {
    /// Write names and addresses as a file for `--firmware` and for other linkers
    Export {
        /// File to write
        #[arg(value_name = "FILE", default_value = "DSPKFLOP.out")]
        file: PathBuf,
        /// The board whose firmware it is
        #[arg(long, value_name = "NAME", default_value = TargetBoard::default_board().name, value_parser = board)]
        board: &'static TargetBoard,
    },
    /// Describe an unknown firmware file, for `kmotiondef/boards` of cc67's sources
    Facts {
        /// A firmware file
        #[arg(value_name = "FILE")]
        file: PathBuf,
        /// The board whose declarations, structures and constants it has
        #[arg(long = "like", value_name = "NAME", default_value = "kflop-5.3.2", value_parser = board)]
        board: &'static TargetBoard,
    },
    /// List functions and variables with their addresses and descriptions
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
}

/// Executes the request.
pub(super) fn firmware(arguments: &FirmwareArguments) -> Result<Exit> {
    match &arguments.command {
        FirmwareCommand::Export { file, board } => output::write(file, &firmware::export(board)?)?,
        FirmwareCommand::Facts { file, board } => output::print(&facts(file, board)?)?,
        FirmwareCommand::List { json: true } => output::print(&list_json())?,
        FirmwareCommand::List { json: false } => output::print(&list())?,
    }
    Ok(Exit::Success)
}

/// Describes a firmware file.
fn facts(path: &Path, like: &TargetBoard) -> Result<String> {
    let file = FirmwareFile::read(&read(path)?).with_context(|| path.display().to_string())?;
    let version = file.version().with_context(|| format!("{} does not state its version", path.display()))?;
    let symbols: Vec<_> = file.symbols().collect();
    Ok(like.facts_of(version, file.time_stamp(), &symbols))
}

fn list() -> String {
    let mut out = format!("{}\n\nfunctions\n", VERSION.trim_end());
    for function in FIRMWARE_FUNCTIONS.iter().filter(|function| !ABSENT.contains(&function.name)) {
        let note = match function.origin {
            Origin::Header => "",
            Origin::Firmware => " (KMotionDef.h does not declare it)",
            Origin::Library => " (not in firmware 4.34; the simulated board supplies it)",
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{:08x} {};\n         {}{note}",
            function.address.get(),
            function.prototype(),
            function.doc
        );
    }
    out.push_str("\nvariables\n");
    for variable in FIRMWARE_VARIABLES {
        let declaration = variable.ty.declare(variable.name);
        let _ =
            writeln!(out, "{:08x} {declaration};\n         {}", variable.address.get(), variable.doc.trim());
    }
    out
}

fn list_json() -> String {
    let functions: Vec<_> = FIRMWARE_FUNCTIONS
        .iter()
        .filter(|function| !ABSENT.contains(&function.name))
        .map(|function| {
            json!({
                "name": function.name,
                "address": function.address.get(),
                "prototype": function.prototype(),
                "cost": function.cost.get(),
                "group": function.group,
                "in_firmware": function.origin != Origin::Library,
                "doc": function.doc,
            })
        })
        .collect();
    let variables: Vec<_> = FIRMWARE_VARIABLES
        .iter()
        .map(|variable| {
            json!({
                "name": variable.name,
                "address": variable.address.get(),
                "size": variable.size,
                "type": variable.ty.declare(""),
                "doc": variable.doc.trim(),
            })
        })
        .collect();
    let all = json!({ "version": VERSION.trim_end(), "functions": functions, "variables": variables });
    format!("{all:#}\n")
}
