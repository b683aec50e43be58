//! `cc67 serve --boot FILE`: the user's own firmware file is what clients talk to.

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
use super::{ServeArguments, Terms, end_on_signal, listen};
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use crate::cli::report::trace::Trace;
use crate::cli::session::booted::{Begun, Booted};

/// Starts the firmware and serves clients until it is ended.
pub(super) fn serve(arguments: &ServeArguments, file: &Path, terms: &Terms<'_>) -> Result<Exit> {
    if let Some(option) = left_out(arguments) {
        bail!("`{option}` does not work with `--boot`");
    }
    let mut booted = Booted::new(file)?;
    let begun =
        booted.begin(&arguments.programs, &arguments.board, &arguments.compiler, Some(&arguments.trace))?;
    let Some(Begun { request }) = begun else { return Ok(Exit::Failure) };
    let trace = request.as_ref().map(|request| Trace::begin(&arguments.trace, request)).transpose()?;
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

/// The first option given that a booted board does not know.
fn left_out(arguments: &ServeArguments) -> Option<&'static str> {
    #[cfg(feature = "live")]
    let is_live = arguments.page.live;
    #[cfg(not(feature = "live"))]
    let is_live = false;
    let live = is_live.then_some("--live");
    live.or(arguments.trace.left_out_by_boot()).or_else(|| arguments.board.left_out_by_boot())
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
        Vec::new()
    }

    fn keep_flash(&mut self) -> Result<()> {
        self.booted.keep_flash()
    }

    fn finish(&mut self, sink: &mut dyn FnMut(Event)) -> Result<()> {
        self.booted.finish(sink)
    }
}
