//! Recordings by the board's own data recorder: variables in each servo tick, read after the run.
//!
//! The recorder stores doubles from a given address on. Recordings use the gather buffer from its third megabyte on;
//! the part before is left to programs, and the end to the answers of the [monitor](crate::monitor). Source:
//! gather-persist-console.md section 1.

use cc67_wire::{Client, WireError};
use kmotiondef::limits::{MAX_GATHER_DATA, MAX_GATHER_VALUES};
use kmotiondef::modes::GatherType;
use kmotiondef::structs::{Chan, Gather};
use kmotiondef::variables::{GATHER, chan};
use kmotiondef::{AxisId, GuestAddr};
use runtime::trace::{Quantity, RecordedCell, TraceRequest};

use crate::monitor;

/// The first double of a recording in the gather buffer.
const FIRST: u32 = MAX_GATHER_DATA as u32 / 4;
/// The end of the range of doubles for a recording.
const END: u32 = monitor::REPLY / 2;
/// A pointer value with which the recorder is idle, above the end of any recording.
const IDLE: u32 = 0xffff_fffc;
/// The number of samples of a recording that are read at once.
const AT_ONCE: u32 = 64;

/// The reason why a quantity cannot be recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordingError(pub(crate) String);

/// A recording.
#[derive(Debug)]
pub(crate) struct BoardRecording {
    cells: Vec<RecordedCell>,
    /// The number of requested cells; those after them are the enable flags of `axes`.
    requested: usize,
    axes: Vec<AxisId>,
    /// The number of ticks between samples.
    every: u64,
    /// The descriptor of the recorder.
    descriptor: GuestAddr,
    /// The address of the gather buffer.
    buffer: GuestAddr,
}

/// The variables at one time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BoardSample {
    /// Servo ticks since the start.
    pub(crate) tick: u64,
    /// The values of the requested quantities.
    pub(crate) values: Vec<f64>,
    /// The enabled axes, one bit each.
    pub(crate) enabled: u16,
}

/// The end of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RecordingEnd {
    /// The number of samples taken.
    pub(crate) samples: u32,
    /// True if the buffer was full before the end of the run.
    pub(crate) is_full: bool,
}

impl BoardRecording {
    /// Creates a recording of the requested quantities on a board; `place` returns the board's address of a variable in
    /// the tables, and `buffer` is the address of its gather buffer.
    ///
    /// # Errors
    /// A quantity is computed, or there are too many.
    pub(crate) fn new(
        request: &TraceRequest,
        place: impl Fn(GuestAddr) -> GuestAddr,
        buffer: GuestAddr,
    ) -> Result<Self, RecordingError> {
        let cell = |quantity: &Quantity| {
            let cell = quantity.cell().ok_or_else(|| RecordingError(format!("`{quantity}`")))?;
            // Expressions name variables at their own addresses; items name them by their addresses in the tables.
            let address = if quantity.item().is_some() { place(cell.address) } else { cell.address };
            Ok(RecordedCell { address, ..cell })
        };
        let mut cells = request.quantities.iter().map(cell).collect::<Result<Vec<_>, _>>()?;
        let requested = cells.len();
        let mut axes: Vec<_> = request.quantities.iter().filter_map(axis_of).collect();
        axes.sort_unstable();
        axes.dedup();
        cells.extend(axes.iter().map(|axis| {
            let enable = chan(*axis).field(Chan::ENABLE);
            RecordedCell::new(place(enable.address()), GatherType::Int)
        }));
        if cells.len() >= MAX_GATHER_VALUES {
            let most = MAX_GATHER_VALUES - 1;
            return Err(RecordingError(format!("{} values: the recorder takes {most}", cells.len())));
        }
        Ok(Self { cells, requested, axes, every: request.every, descriptor: place(GATHER.address()), buffer })
    }

    /// The maximum number of samples.
    pub(crate) fn capacity(&self) -> u32 {
        (END - FIRST) / self.cells.len().max(1) as u32
    }

    fn start(&self) -> GuestAddr {
        self.buffer.offset(FIRST * 8)
    }

    fn end(&self) -> u32 {
        self.start().get() + self.capacity() * self.cells.len() as u32 * 8
    }

    /// The part of the recorder's descriptor that a recording needs, beginning with the field `endptr`.
    fn descriptor(&self) -> Vec<u8> {
        let mut bytes = self.end().to_le_bytes().to_vec();
        bytes.resize(Gather::LIST.offset() as usize - Gather::ENDPTR.offset() as usize, 0);
        for cell in &self.cells {
            bytes.extend(cell.kind.get().to_le_bytes());
            bytes.extend(cell.address.get().to_le_bytes());
        }
        bytes.extend(GatherType::End.get().to_le_bytes());
        bytes
    }

    /// Begins to record with the next tick. A pointer is stored byte by byte, the lowest first; until its last byte is
    /// stored it is above the end, so the recorder is idle.
    ///
    /// # Errors
    /// The board does not answer.
    pub(crate) fn begin(&self, board: &mut Client) -> Result<(), WireError> {
        self.stop(board)?;
        board.store(self.descriptor.offset(Gather::ENDPTR.offset()).get(), &self.descriptor())?;
        board.store(self.descriptor.get(), &self.start().get().to_le_bytes())
    }

    /// Stops the recorder.
    fn stop(&self, board: &mut Client) -> Result<(), WireError> {
        board.store(self.descriptor.get(), &IDLE.to_le_bytes())
    }

    /// Stops the recorder, and returns its progress; `head` is the present descriptor. `None` if a program has used the
    /// recorder meanwhile.
    ///
    /// # Errors
    /// The board does not answer.
    pub(crate) fn end_of(&self, board: &mut Client, head: &[u8]) -> Result<Option<RecordingEnd>, WireError> {
        let (pointer, rest) = head.split_at_checked(4).unwrap_or_default();
        let pointer = u32::from_le_bytes(pointer.try_into().unwrap_or_default());
        let Some(bytes) = pointer.checked_sub(self.start().get()) else { return Ok(None) };
        if pointer > self.end() || !self.descriptor().starts_with(rest) {
            return Ok(None);
        }
        self.stop(board)?;
        let samples = bytes / (self.cells.len().max(1) as u32 * 8);
        Ok(Some(RecordingEnd { samples, is_full: samples == self.capacity() }))
    }

    /// The descriptor's address, and the number of its bytes that a recording uses.
    pub(crate) fn head(&self) -> (GuestAddr, usize) {
        (self.descriptor, Gather::ENDPTR.offset() as usize + self.descriptor().len())
    }

    /// Reads samples, and passes on those that were requested.
    ///
    /// # Errors
    /// The board does not answer.
    pub(crate) fn read(
        &self,
        board: &mut Client,
        samples: u32,
        sink: &mut dyn FnMut(BoardSample),
    ) -> Result<(), WireError> {
        let words = self.cells.len() as u32 * 2;
        let mut done = 0;
        while done < samples {
            let count = AT_ONCE.min(samples - done);
            let read = board.gather(FIRST * 2 + done * words, count * words)?;
            for (index, sample) in (u64::from(done)..).zip(read.chunks(words as usize)) {
                // The first sample belongs to the first tick, whose number is 0.
                if (index + 1).is_multiple_of(self.every) {
                    sink(self.sample(index, sample));
                }
            }
            done += count;
        }
        Ok(())
    }

    /// The sample in words of the gather buffer.
    fn sample(&self, tick: u64, words: &[u32]) -> BoardSample {
        let double = |words: &[u32; 2]| f64::from_bits(u64::from(words[1]) << 32 | u64::from(words[0]));
        let values: Vec<_> = words.as_chunks().0.iter().map(double).collect();
        let (requested, enables) = values.split_at_checked(self.requested).unwrap_or((&values, &[]));
        let values = requested.iter().zip(&self.cells).map(|(value, cell)| value + cell.offset).collect();
        let bits = self.axes.iter().zip(enables).filter(|(_, enable)| **enable != 0.0);
        let enabled = bits.fold(0, |bits, (axis, _)| bits | 1 << axis.index());
        BoardSample { tick, values, enabled }
    }
}

/// The axis of a quantity.
fn axis_of(quantity: &Quantity) -> Option<AxisId> {
    AxisId::new(i32::try_from(quantity.item()?.axis()?).ok()?)
}

#[cfg(test)]
mod tests {
    use runtime::trace::Item;

    use super::*;

    fn recording(names: &[&str]) -> Result<BoardRecording, RecordingError> {
        let item = |name: &&str| Quantity::from(Item::new(name).expect("an item"));
        let quantities = names.iter().map(item).collect();
        let request = TraceRequest { quantities, every: 2, changes: false, packets: None };
        BoardRecording::new(&request, |address| address, GuestAddr::new(0x8010_2010))
    }

    #[test]
    fn samples_have_the_values_and_the_axes_that_are_enabled() {
        let recording = recording(&["dest1", "adc0"]).expect("variables");
        let words = |value: f64| [value.to_bits() as u32, (value.to_bits() >> 32) as u32];
        let sample = [words(2.5), words(2048.0), words(1.0)].concat();
        let expected = BoardSample { tick: 7, values: vec![2.5, 0.0], enabled: 0b10 };
        assert_eq!(recording.sample(7, &sample), expected);
        // Three doubles per sample, in three quarters of a buffer of 1,000,000.
        assert_eq!(recording.capacity(), 249_957);
    }

    #[test]
    fn what_is_no_variable_is_refused() {
        assert_eq!(recording(&["bit46"]).map(drop), Err(RecordingError("`bit46`".to_owned())));
        let many: Vec<_> = (0..32).map(|index| format!("persist{index}")).collect();
        let many: Vec<_> = many.iter().map(String::as_str).collect();
        assert!(recording(&many).is_err_and(|error| error.0.contains("takes 31")));
    }
}
