//! `cc67 debug --boot FILE`: programs on the user's own firmware file, stopped anywhere.
//!
//! All of the board is stopped: the firmware, its interrupt and all threads. What is executed, and when, is the same
//! as in a run of `cc67 run --boot`.
//!
//! ```text
//! words      commands that people know from gdb
//! debugger   breakpoints, runs, steps, the way back
//! history    snapshots of the past
//! calls      the calls in progress
//! programs   functions, lines, variables
//! ```

mod calls;
mod debugger;
mod history;
mod programs;
mod words;

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::talker::Talker;
use super::{DebugArguments, LIMIT};
use crate::cli::session::Started;
use crate::cli::session::booted::Booted;
use debugger::Debugger;
use words::Shell;

/// A debugger of the programs on a firmware file; `None` if one has errors, which have been reported.
pub(super) fn shell(arguments: &DebugArguments, file: &Path) -> Result<Option<impl Talker + use<>>> {
    if let Some(option) = arguments.board.left_out_by_boot() {
        bail!("`{option}` does not work with `--boot`");
    }
    let uart = &arguments.board.uart;
    ensure!(
        uart.uart.is_none() && uart.uart_output.is_none(),
        "a debugged board has no peer at its serial port, which could not go back in time: `--uart-input`"
    );
    let mut booted = Booted::new(file)?;
    let started = Started { programs: &arguments.programs, first: &arguments.beside.first };
    if booted.begin(started, &arguments.board, &arguments.compiler, None)?.is_none() {
        return Ok(None);
    }
    let interrupter = booted.interrupter();
    ctrlc::set_handler(move || interrupter.interrupt()).context("cannot take Ctrl-C")?;
    let limit = Ticks::new((arguments.limit.unwrap_or(LIMIT) / TIMEBASE).round() as u64);
    let shell = Shell::new(Debugger::new(booted, limit));
    shell.unknown().for_each(|why| crate::cli::io::terminal::note(&why));
    Ok(Some(shell))
}
