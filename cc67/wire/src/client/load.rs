//! Loading programs. Source: wire.md section 3; coff.md section 9.
//!
//! The board does not answer a download, so each block ends with a fence, and any message before its reply is an error
//! of the load. The first word of the thread's space is 0 from the first byte sent to the last: such a thread cannot be
//! started, so an interrupted load leaves nothing that could run.

use kmotiondef::ThreadId;
use kmotiondef::boards::TargetBoard;
use kmotiondef::map::ProgramSpaces;

use super::{ANSWER_WITHIN, Client};
use crate::disk::hexadecimal;
use crate::error::WireError;

/// The size of a block in bytes; other programs may use a shared board between blocks.
const PIECE: usize = 0x4000;
/// The number of bytes in a data line; the board takes no other number.
const BYTES_PER_LINE: usize = 64;
/// The size of the word that prevents a thread from being started.
const GUARD: usize = 4;

/// A program for a thread, as bytes at addresses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadImage {
    /// The thread.
    pub thread: ThreadId,
    /// The address at which it begins.
    pub entry: u32,
    /// The bytes, each part with its address.
    pub parts: Vec<(u32, Vec<u8>)>,
    /// The version text of the firmware for which it was linked, if known.
    pub firmware: Option<String>,
}

/// The progress of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The number of bytes that have arrived.
    pub done: usize,
    /// The total number of bytes.
    pub total: usize,
}

impl LoadImage {
    /// Checks that the image matches the board's firmware and the space of its thread.
    ///
    /// # Errors
    /// It was made for another firmware or space.
    pub fn check(&self, version: &str) -> Result<(), WireError> {
        if let Some(firmware) = &self.firmware
            && firmware.trim_end() != version.trim_end()
        {
            return Err(WireError::WrongFirmware {
                board: version.into(),
                program: firmware.trim_end().into(),
            });
        }
        self.check_space(&program_spaces(version))
    }

    /// Checks that the image begins in the space of its thread and ends within the spaces of programs.
    ///
    /// # Errors
    /// It has bytes outside these spaces.
    fn check_space(&self, spaces: &ProgramSpaces) -> Result<(), WireError> {
        let start = spaces.start(self.thread).get();
        let end = start + spaces.size - 1;
        let wrong = |address| WireError::WrongSpace { thread: self.thread, address, start, end };
        if !(start..=end).contains(&self.entry) {
            return Err(wrong(self.entry));
        }
        for (address, bytes) in &self.parts {
            let last = u64::from(*address) + bytes.len().saturating_sub(1) as u64;
            if *address < start || *address > end {
                return Err(wrong(*address));
            }
            // A large program may continue in the space of the next thread (dialect.md section 7).
            if last >= u64::from(spaces.limit) {
                return Err(wrong(spaces.limit));
            }
        }
        Ok(())
    }

    /// The number of bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.parts.iter().map(|(_, bytes)| bytes.len()).sum()
    }

    /// The parts in the order in which they are sent, the first word of the space last.
    fn ordered(&self, spaces: &ProgramSpaces) -> Vec<(u32, Vec<u8>)> {
        let start = spaces.start(self.thread).get();
        let mut parts = vec![];
        let mut last = vec![];
        for (address, bytes) in &self.parts {
            match bytes.split_at_checked(GUARD) {
                Some((guard, rest)) if *address == start => {
                    parts.push((start, vec![0; GUARD]));
                    parts.push((start + GUARD as u32, rest.to_vec()));
                    last.push((start, guard.to_vec()));
                }
                _ => parts.push((*address, bytes.clone())),
            }
        }
        parts.extend(last);
        parts
    }
}

/// The program spaces of a board by its version; for an unknown version, those of a KFLOP.
fn program_spaces(version: &str) -> ProgramSpaces {
    TargetBoard::of_version(version.trim_end()).unwrap_or_else(TargetBoard::default_board).programs()
}

impl Client {
    /// Loads a program into its thread, which is stopped first. Nothing is started.
    ///
    /// # Errors
    /// The image is rejected before anything is sent, or the load failed; the thread cannot be started then.
    pub fn load(
        &mut self,
        image: &LoadImage,
        is_forced: bool,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<(), WireError> {
        if is_forced {
            image.check_space(&program_spaces(&self.version))?;
        } else {
            image.check(&self.version)?;
        }
        self.stop_thread(image.thread)?;
        let total = image.size();
        let mut done = 0;
        progress(Progress { done, total });
        for (address, bytes) in image.ordered(&program_spaces(&self.version)) {
            for (piece, at) in bytes.chunks(PIECE).zip((address..).step_by(PIECE)) {
                self.send_piece(at, piece).map_err(|error| load_error(image, error))?;
                done = (done + piece.len()).min(total);
                progress(Progress { done, total });
            }
        }
        self.command(&format!("EntryPoint{} {:X}", image.thread, image.entry))
            .map_err(|error| load_error(image, error))?;
        progress(Progress { done: total, total });
        Ok(())
    }

    /// Stores bytes in the memory of the board, one by one: a program that reads a word meanwhile may see a mixture of
    /// old and new bytes.
    ///
    /// # Errors
    /// The board rejects it, or does not answer.
    pub fn store(&mut self, address: u32, bytes: &[u8]) -> Result<(), WireError> {
        for (piece, at) in bytes.chunks(PIECE).zip((address..).step_by(PIECE)) {
            self.send_piece(at, piece)?;
        }
        Ok(())
    }

    /// Sends one block, and waits until the board has taken all of it.
    fn send_piece(&mut self, address: u32, bytes: &[u8]) -> Result<(), WireError> {
        let command = format!("LOADDATA {address:X} {:X}", bytes.len());
        let data = bytes.chunks(BYTES_PER_LINE).map(hexadecimal);
        let mut lines: Vec<_> = std::iter::once(command.clone().into_bytes()).chain(data).collect();
        lines.push(b"Version".to_vec());
        self.link.claim(ANSWER_WITHIN)?;
        let result = self.exchange(&lines, &command, ANSWER_WITHIN);
        self.link.release();
        self.check_block(address, result)
    }

    /// Judges the success of a block by the lines before the reply of its fence.
    fn check_block(&mut self, address: u32, result: Result<Vec<String>, WireError>) -> Result<(), WireError> {
        let foreign = result?.len();
        self.foreign_lines += foreign as u64;
        if self.refusals().is_empty() {
            return Ok(());
        }
        // A rejected data line means that the command loop had already dropped the block.
        let is_data =
            |line: &str| line.len() >= 2 && line.bytes().all(|byte| byte.is_ascii_hexdigit() || byte == b' ');
        let foreign = self.refusals().iter().find(|refusal| !is_data(&refusal.command));
        let message = match foreign {
            Some(refusal) => format!("another program sent `{}` into the download", refusal.command),
            None => "the board restarted, or another program interrupted the download".to_owned(),
        };
        Err(WireError::Refused { command: format!("LOADDATA {address:X}"), message })
    }
}

/// The error of a load that did not arrive completely.
fn load_error(image: &LoadImage, error: WireError) -> WireError {
    let start = image.parts.iter().map(|(address, _)| *address).min().unwrap_or(image.entry);
    let end = image.parts.iter().map(|(address, bytes)| address.saturating_add(bytes.len() as u32)).max();
    let reason = match error {
        WireError::Refused { message, .. } => message,
        WireError::Disconnected { place, .. } => format!("{place} was disconnected during the download"),
        error => error.to_string(),
    };
    WireError::LoadFailed { thread: image.thread, start, end: end.unwrap_or(image.entry), reason }
}
