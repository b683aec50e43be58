//! The file that stores a board's flash memory.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use runtime::{Event, EventKind, FLASH_SIZE};

use crate::cli::io::input::read;
use crate::cli::io::{output, terminal};

/// The file for flash memory, if there is one, and its contents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Flash {
    path: Option<PathBuf>,
    /// The contents at the start, or as last written; `None` if there was no file.
    before: Option<Vec<u8>>,
    /// True if the last contents could not be written.
    is_lost: bool,
}

/// The reply of the board to a command that writes flash.
const COMPLETE: &[u8] = b"Program Flash Image Complete";
/// The message that it prints after that.
const VERIFIED: &[u8] = b"Verify Complete";

/// Events that are held until the file contains the data whose storage the first of them acknowledges.
#[derive(Debug, Default)]
pub(super) struct HeldEvents {
    events: Vec<Event>,
    /// True if the data are stored in a file.
    is_kept: bool,
    /// True if the last contents could not be written.
    is_lost: bool,
}

impl HeldEvents {
    /// Passes an event on; holds it, and all later ones, if it acknowledges that flash is written.
    pub(super) fn pass(&mut self, event: Event, sink: &mut dyn FnMut(Event)) {
        let is_complete = matches!(&event.kind, EventKind::Reply(line) if line == COMPLETE);
        let is_verified = matches!(&event.kind, EventKind::ConsoleLine(line) if line == VERIFIED);
        if self.events.is_empty() && !(is_complete && self.is_kept) {
            if !(is_verified && self.is_lost) {
                sink(event);
            }
        } else {
            self.events.push(event);
        }
    }

    /// Passes on the held events; without the acknowledgement if flash is not stored.
    fn hand_on(self, is_kept: bool, sink: &mut dyn FnMut(Event)) {
        let is_acknowledgement = |event: &Event| match &event.kind {
            EventKind::Reply(line) => line == COMPLETE,
            EventKind::ConsoleLine(line) => line == VERIFIED,
            _ => false,
        };
        self.events.into_iter().filter(|event| is_kept || !is_acknowledgement(event)).for_each(sink);
    }
}

impl Flash {
    /// Reads the file, if it exists.
    pub(super) fn read(path: Option<PathBuf>) -> Result<Self> {
        let Some(path) = path else { return Ok(Self::default()) };
        let before = if path.exists() { Some(read(&path)?) } else { None };
        if let Some(bytes) = before.as_ref().filter(|bytes| bytes.len() != FLASH_SIZE) {
            bail!(
                "{} is not a board's flash: it has {} bytes, not {FLASH_SIZE}",
                path.display(),
                bytes.len()
            );
        }
        Ok(Self { path: Some(path), before, is_lost: false })
    }

    /// Creates the queue for the next events.
    pub(super) fn held(&self) -> HeldEvents {
        HeldEvents { events: Vec::new(), is_kept: self.path.is_some(), is_lost: self.is_lost }
    }

    /// Writes the flash to its file if events are held for that, and passes them on.
    pub(super) fn acknowledge<'m>(
        &mut self,
        held: HeldEvents,
        now: impl FnOnce() -> &'m [u8],
        sink: &mut dyn FnMut(Event),
    ) {
        if held.events.is_empty() {
            return;
        }
        let kept = self.keep(now).map_err(|error| terminal::error(&error.context("the flash is not kept")));
        self.is_lost = kept.is_err();
        held.hand_on(kept.is_ok(), sink);
    }

    /// Returns the initial contents for a board.
    pub(super) fn contents(&self) -> Option<Vec<u8>> {
        self.before.clone()
    }

    /// Notes the initial contents of a board: only different contents are stored.
    pub(super) fn begins_with(&mut self, now: &[u8]) {
        if self.path.is_some() && self.before.is_none() {
            self.before = Some(now.to_vec());
        }
    }

    /// The file and its contents, if it exists.
    pub(super) fn file(&self) -> Option<(&Path, &[u8])> {
        self.path.as_deref().zip(self.before.as_deref())
    }

    /// Stores the present contents of flash memory if they have changed; reads them only if there is a file.
    pub(crate) fn keep<'m>(&mut self, now: impl FnOnce() -> &'m [u8]) -> Result<()> {
        let Some(path) = &self.path else { return Ok(()) };
        let now = now();
        let is_erased = || now.iter().all(|byte| *byte == 0xFF);
        if self.before.as_ref().map_or_else(|| !is_erased(), |before| before != now) {
            output::write_durably(path, now)?;
            self.before = Some(now.to_vec());
        }
        Ok(())
    }
}

#[cfg(feature = "live")]
impl<T: cc67_host::Target> cc67_live::Keeper<T> for Flash {
    fn keep(&mut self, session: &cc67_host::Session<T>, events: Vec<Event>) -> Vec<Event> {
        let (mut held, mut shown) = (self.held(), Vec::new());
        events.into_iter().for_each(|event| held.pass(event, &mut |event| shown.push(event)));
        self.acknowledge(held, || session.target().flash().unwrap_or_default(), &mut |event| {
            shown.push(event);
        });
        shown
    }
}
