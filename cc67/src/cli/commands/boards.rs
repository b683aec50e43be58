//! `cc67 boards`: the controllers connected to this computer.

use anyhow::Result;
use cc67_controller::{Address, ControllerLink, FoundBoard, boards as found_boards, kognas};
use clap::Args;

use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};

/// Arguments of `cc67 boards`.
#[derive(Debug, Args)]
pub(super) struct BoardsArguments {
    /// Send nothing: the firmware of controllers is not requested, and networks are not searched for a Kogna
    #[arg(long)]
    quiet: bool,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
}

/// Lists the controllers, one line each.
pub(super) fn boards(arguments: &BoardsArguments) -> Result<Exit> {
    let mut found = found_boards()?;
    if !arguments.quiet {
        match kognas() {
            Ok(kognas) => found.extend(kognas),
            Err(error) => terminal::note(&error.to_string()),
        }
    }
    for board in &found {
        let firmware = firmware(board, arguments.quiet);
        output::print(&if arguments.json { json(board, &firmware) } else { line(board, &firmware) })?;
    }
    if found.is_empty() {
        terminal::note(
            "no controller found: looked for USB devices 0403:f231 and 0403:f230, for a Kogna in networks 10, 172 and \
             192, and for the vendor's server; serial ports of other names are not searched: `--on serial:PATH`",
        );
        return Ok(Exit::Failure);
    }
    Ok(Exit::Success)
}

/// The firmware of a controller, or the reason why it is unknown.
fn firmware(board: &FoundBoard, is_quiet: bool) -> Result<String, String> {
    if is_quiet {
        return Err("not asked".to_owned());
    }
    if let Some(holder) = &board.holder {
        return Err(format!("held by {holder}"));
    }
    let address: Address = board.address.parse().map_err(|error| format!("{error}"))?;
    let connection = ControllerLink::open(&address).map_err(|error| error.to_string())?;
    Ok(connection.version().trim_end().to_owned())
}

fn line(board: &FoundBoard, firmware: &Result<String, String>) -> String {
    let serial = board.serial.as_ref().map_or(String::new(), |serial| format!(", serial number {serial}"));
    let firmware = firmware.as_ref().map_or_else(|why| format!("({why})"), Clone::clone);
    format!("{:<24} {}{serial}: {firmware}\n", board.address, board.name)
}

fn json(board: &FoundBoard, firmware: &Result<String, String>) -> String {
    let row = serde_json::json!({
        "address": board.address,
        "name": board.name,
        "serial": board.serial,
        "holder": board.holder,
        "firmware": firmware.as_ref().ok(),
        "error": firmware.as_ref().err(),
    });
    format!("{row}\n")
}
