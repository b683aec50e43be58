//! `cc67 serve --boot FILE`: the user's own firmware file is what clients talk to.

use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::channel;

use anyhow::{Result, bail};
use kmotiondef::Ticks;
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};

use super::board::ServedBoard;
use super::desk::Desk;
use super::link::CONSOLE_LINES;
use super::served::Served;
use super::{Terms, end_on_signal, listen};
use crate::cli::args::board::BoardArguments;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use crate::cli::report::trace::Trace;
use crate::cli::session::booted::{Begun, Booted};

/// What runs on the firmware, and what is around it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked<'a> {
    /// Programs to load and start.
    pub(crate) programs: &'a [OsString],
    /// The board.
    pub(crate) board: &'a BoardArguments,
    /// How programs are compiled.
    pub(crate) compiler: &'a CompilerArguments,
}

/// Starts the firmware and serves clients until it is ended.
pub(crate) fn serve(asked: &Asked<'_>, file: &Path, terms: &Terms<'_>) -> Result<Exit> {
    if let Some(option) = asked.board.left_out_by_boot() {
        bail!("`{option}` does not work with `--boot`");
    }
    let mut booted = Booted::new(file)?;
    let begun = booted.begin(asked.programs, asked.board, asked.compiler, Some(terms.trace))?;
    let Some(Begun { request }) = begun else { return Ok(Exit::Failure) };
    let trace = request.as_ref().map(|request| Trace::begin(terms.trace, request)).transpose()?;
    booted.connect()?;
    let board = ServedBoard::new(
        OwnFirmware { booted, crashed: None, is_deaf: false, has_told: false },
        trace,
        terms,
    )?;
    let (notes, inbox) = channel();
    end_on_signal(notes.clone(), Arc::default())?;
    let places = listen::listen(&terms.addresses, terms.option, &notes)?;
    drop(notes);
    let exit = Desk::new(board, terms, inbox).run();
    drop(places);
    exit
}

/// A board that runs the user's firmware.
#[derive(Debug)]
struct OwnFirmware {
    booted: Booted,
    /// The tick that it has come to since the firmware ran away: nothing happens there any more.
    crashed: Option<Ticks>,
    /// Whether console lines are discarded, and whether this was reported.
    is_deaf: bool,
    has_told: bool,
}

impl Served for OwnFirmware {
    fn tick(&self) -> Ticks {
        self.crashed.unwrap_or_else(|| self.booted.tick())
    }

    fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        let is_deaf = self.is_deaf;
        let mut hear = |event: Event| {
            if !is_deaf || !matches!(event.kind, EventKind::ConsoleLine(_)) {
                sink(event);
            }
        };
        while self.tick() < limit {
            if self.crashed.is_some() {
                self.crashed = Some(limit);
            } else if let Err(halted) = self.booted.advance_tick(&mut hear) {
                terminal::note(halted.to_string().trim_end());
                self.crashed = Some(limit);
            }
        }
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.booted.board.send(bytes);
    }

    fn is_receiving(&self) -> bool {
        self.crashed.is_none() && !self.booted.board.has_read_all()
    }

    fn is_in_command(&self) -> bool {
        // Only the firmware knows.
        false
    }

    fn listen(&mut self, listens: bool) {
        // A firmware that waits for the PC takes no commands either, so that nobody could read what waits.
        self.is_deaf = !listens;
        if self.is_deaf && !std::mem::replace(&mut self.has_told, true) {
            terminal::note(&format!(
                "more than {CONSOLE_LINES} console lines wait for their client: further ones are lost"
            ));
        }
    }

    fn programs(&self) -> Vec<DebugInfo> {
        self.booted.debug().into_iter().map(|(_, debug)| debug).collect()
    }

    fn keep_flash(&mut self) -> Result<()> {
        self.booted.keep_flash()
    }

    fn finish(&mut self, sink: &mut dyn FnMut(Event)) -> Result<()> {
        self.booted.finish(sink)
    }
}
