//! Data lines: the further lines that some commands take.
//!
//! A data line holds a fixed number of hexadecimal numbers; the rest of the line is ignored.

use kmotiondef::GuestAddr;
use kmotiondef::limits::N_BYTES_PER_LINE;
use kmotiondef::variables::{READ_DISK_BUFFER, READ_DISK_BUFFER_STATUS};
use vm::firmware::TickContext;
use vm::memory::GuestMemory;

use super::arguments::{LineReader, Mistake};
use crate::pc::Downloads;
use crate::views::TypedAccess;

/// Words on a line of gather data.
pub(super) const WORDS_PER_LINE: usize = 8;
/// Words of the gather buffer.
pub(super) const GATHER_WORDS: i32 = 2_000_000;
/// Bytes on a line of a disk file's text.
const DISK_BYTES_PER_LINE: usize = 80;

/// The use of the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DataKind {
    /// Bytes of a program, which are stored.
    Program,
    /// Bytes of a new firmware, which are not.
    Firmware,
    /// Words of the gather buffer.
    Gather,
    /// A line of a file on the PC.
    Disk,
}

impl DataKind {
    /// Numbers on a full line.
    const fn per_line(self) -> usize {
        match self {
            Self::Program | Self::Firmware => N_BYTES_PER_LINE,
            Self::Gather => WORDS_PER_LINE,
            Self::Disk => DISK_BYTES_PER_LINE,
        }
    }
}

/// A command that waits for data lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Data {
    kind: DataKind,
    /// The address of the first number.
    start: GuestAddr,
    /// The address of the next number.
    place: GuestAddr,
    /// The count of numbers that are still missing.
    left: usize,
}

impl Data {
    /// Data of `count` numbers that are stored from `start` on.
    pub(super) const fn new(kind: DataKind, start: GuestAddr, count: usize) -> Self {
        Self { kind, start, place: start, left: count }
    }

    /// Returns whether all numbers have arrived.
    pub(super) const fn is_complete(&self) -> bool {
        self.left == 0
    }

    /// Takes one line; numbers before a mistake are stored.
    pub(super) fn line(&mut self, memory: &mut GuestMemory, line: &[u8]) -> Result<(), Mistake> {
        let mut reader = LineReader::new(line, 0);
        for _ in 0..self.left.min(self.kind.per_line()) {
            let size = if self.kind == DataKind::Gather {
                memory.poke(self.place, reader.hex()?);
                4
            } else {
                let byte = reader.byte()?;
                if self.kind != DataKind::Firmware {
                    memory.poke(self.place, byte);
                }
                1
            };
            self.place = self.place.offset(size);
            self.left -= 1;
        }
        Ok(())
    }

    /// Acts on the complete data.
    pub(super) fn finish(&self, downloads: &mut Downloads, context: &mut TickContext<'_>) {
        match self.kind {
            DataKind::Program => downloads.record(self.start, self.place),
            DataKind::Disk => {
                context.memory.poke(self.place, 0_u8);
                context.memory.set(READ_DISK_BUFFER_STATUS, 1);
            }
            DataKind::Firmware | DataKind::Gather => {}
        }
    }

    /// Room for a line of a file.
    pub(super) fn disk(memory: &GuestMemory, count: usize) -> Self {
        Self::new(DataKind::Disk, memory.locate(READ_DISK_BUFFER), count)
    }
}
