//! A small program of cc67 in a free thread of the board that samples variables for a scope, about a thousand times per
//! second.
//!
//! The status record comes 20 times per second. The sampler copies variables to a ring of rows in the gather buffer, in
//! the part from the third megabyte on that recordings also use; the PC reads the rows with each status record. The
//! sampler ends by itself when the PC has not read for three seconds, so it does not keep running on a board whose
//! cable was unplugged.

use cc67_host::HostError;
use cc67_wire::{Client, WireError};
use compiler::Options;
use kmotiondef::limits::{MAX_GATHER_DATA, TIMEBASE};
use kmotiondef::modes::GatherType;
use kmotiondef::{GuestAddr, ThreadId};
use runtime::trace::{Quantity, RecordedCell};

use crate::monitor;
use crate::resident::ResidentProgram;

const PROGRAM: ResidentProgram =
    ResidentProgram { name: "cc67-sampler.c", source: include_str!("sampler.c"), title: "cc67's sampler" };
/// The words before the ring in the gather buffer: the number of rows written, and a count that the PC changes.
const HEAD: u32 = MAX_GATHER_DATA as u32 / 4 * 2;
/// The first word of the ring.
const RING: u32 = HEAD + 2;
/// The size of the ring in doubles: rows of several seconds.
const ROOM: u32 = 1 << 16;
/// The maximum number of variables.
const CELLS: usize = 32;
/// The shortest interval in ticks: at best, threads have the processor every second tick.
const SHORTEST: f64 = 10.0;
/// The limit for rows on the link, in bytes per second: a sixth of 300 KB/s.
const BYTES_A_SECOND: f64 = 50_000.0;
/// The bytes of a double on the link: two words of eight digits and a blank.
const BYTES: f64 = 18.0;
/// The number of words that are read at once.
const AT_ONCE: u32 = 2048;

const _: () = assert!(RING + 2 * ROOM <= monitor::REPLY, "the ring ends before the answers of the monitor");

/// The values at one time; those that the sampler cannot read are NaN.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SampledRow {
    /// Seconds since power-up.
    pub(crate) seconds: f64,
    /// A value of each quantity.
    pub(crate) values: Vec<f64>,
}

/// The sampler in its thread.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    thread: ThreadId,
    /// The variables; `None` for computed quantities.
    cells: Vec<Option<RecordedCell>>,
    /// The interval between rows, in seconds.
    interval: f64,
    /// The number of rows that were read or skipped.
    done: u32,
    beat: u32,
}

impl Sampler {
    /// Creates a sampler of these quantities on a board; `place` returns the board's address of a variable in the
    /// tables. `None` if none of the quantities is a variable.
    pub(crate) fn new(
        thread: ThreadId,
        quantities: &[Quantity],
        place: impl Fn(GuestAddr) -> GuestAddr,
    ) -> Option<Self> {
        let mut left = CELLS;
        let mut cell = |quantity: &Quantity| {
            let is_known = |cell: &RecordedCell| {
                matches!(cell.kind, GatherType::Int | GatherType::Float | GatherType::Double)
            };
            let cell = quantity.cell().filter(is_known)?;
            left = left.checked_sub(1)?;
            let address = if quantity.item().is_some() { place(cell.address) } else { cell.address };
            Some(RecordedCell { address, ..cell })
        };
        let cells: Vec<_> = quantities.iter().map(&mut cell).collect();
        let count = cells.iter().flatten().count();
        let bytes = (count + 1) as f64 * BYTES;
        let interval = (bytes / BYTES_A_SECOND).max(SHORTEST * TIMEBASE);
        (count > 0).then_some(Self { thread, cells, interval, done: 0, beat: 0 })
    }

    /// The thread of the sampler.
    pub(crate) const fn thread(&self) -> ThreadId {
        self.thread
    }

    /// The number of rows per second.
    pub(crate) fn rate(&self) -> f64 {
        1.0 / self.interval
    }

    /// Loads and starts the sampler.
    ///
    /// # Errors
    /// The link fails.
    pub(crate) fn begin(
        &self,
        board: &mut Client,
        options: &Options,
        linked_for: &str,
    ) -> Result<(), HostError> {
        let request = PROGRAM.load(board, options, linked_for, self.thread)?;
        self.start(board, request).map_err(|error| HostError::Link(error.to_string()))
    }

    fn start(&self, board: &mut Client, request: u32) -> Result<(), WireError> {
        board.store(request, &self.request())?;
        board.set_gather(HEAD, &[0, self.beat])?;
        board.execute(&[self.thread])
    }

    /// The request in the format of `sampler.c`.
    fn request(&self) -> Vec<u8> {
        let cells: Vec<_> = self.cells.iter().flatten().collect();
        let mut bytes = self.interval.to_le_bytes().to_vec();
        for word in [self.rows(), cells.len() as u32] {
            bytes.extend(word.to_le_bytes());
        }
        for cell in cells {
            bytes.extend(cell.kind.get().to_le_bytes());
            bytes.extend(cell.address.get().to_le_bytes());
        }
        bytes
    }

    /// The number of doubles in a row: the time, and the variables.
    fn width(&self) -> u32 {
        self.cells.iter().flatten().count() as u32 + 1
    }

    /// The number of rows in the ring.
    fn rows(&self) -> u32 {
        ROOM / self.width()
    }

    /// Reads the rows written since the last call, and keeps the sampler alive.
    ///
    /// # Errors
    /// The board does not answer.
    pub(crate) fn read(&mut self, board: &mut Client) -> Result<Vec<SampledRow>, WireError> {
        self.beat = self.beat.wrapping_add(1);
        board.set_gather(HEAD + 1, &[self.beat])?;
        let written = board.gather(HEAD, 1)?.first().copied().unwrap_or_default();
        // Rows that will soon be overwritten are skipped.
        let oldest = written.saturating_sub(self.rows() * 3 / 4);
        self.done = self.done.max(oldest);
        let mut rows = Vec::new();
        while self.done < written {
            let first = self.done % self.rows();
            let most = (AT_ONCE / (2 * self.width())).max(1);
            let count = (written - self.done).min(self.rows() - first).min(most);
            let words = board.gather(RING + first * 2 * self.width(), count * 2 * self.width())?;
            rows.extend(words.chunks(2 * self.width() as usize).map(|words| self.row(words)));
            self.done += count;
        }
        Ok(rows)
    }

    /// The row in words of the gather buffer.
    fn row(&self, words: &[u32]) -> SampledRow {
        let double = |words: &[u32; 2]| f64::from_bits(u64::from(words[1]) << 32 | u64::from(words[0]));
        let mut doubles = words.as_chunks().0.iter().map(double);
        let seconds = doubles.next().unwrap_or_default();
        let mut value = |cell: &Option<RecordedCell>| {
            let cell = cell.as_ref()?;
            Some(doubles.next()? + cell.offset)
        };
        let values = self.cells.iter().map(|cell| value(cell).unwrap_or(f64::NAN)).collect();
        SampledRow { seconds, values }
    }
}

#[cfg(test)]
mod tests {
    use runtime::trace::Item;

    use super::*;

    fn sampler(names: &[&str]) -> Option<Sampler> {
        let quantities: Vec<_> =
            names.iter().map(|name| Quantity::from(Item::new(name).expect("an item"))).collect();
        Sampler::new(ThreadId::new(7)?, &quantities, |address| address)
    }

    #[test]
    fn rows_have_the_variables_in_the_order_of_the_signals() {
        let sampler = sampler(&["dest0", "bit46", "adc1"]).expect("two of them are variables");
        let words = |value: f64| [value.to_bits() as u32, (value.to_bits() >> 32) as u32];
        let row = sampler.row(&[words(1.25), words(500.0), words(2058.0)].concat());
        assert_eq!((row.seconds, row.values[0], row.values[2]), (1.25, 500.0, 10.0));
        assert!(row.values[1].is_nan());
    }

    #[test]
    fn the_rate_leaves_the_link_to_others() {
        let rate = |names: &[&str]| sampler(names).expect("variables").rate();
        assert!((rate(&["dest0"]) - 1111.1).abs() < 0.1);
        let all: Vec<String> = (0..8).map(|axis| format!("dest{axis}")).collect();
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        assert!(rate(&all) * 9.0 * BYTES <= BYTES_A_SECOND);
        assert!(sampler(&["bit46"]).is_none());
    }
}
