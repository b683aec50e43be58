//! Changes of bits as a table: `time_ns,bit,value,thread`, with thread 0 for changes that no thread made.

use std::io::{self, Write};
use std::path::Path;

use anyhow::Result;
use kmotiondef::{Cycles, Ticks};

use super::{Sink, TraceEntry, nanoseconds};
use crate::cli::io::output::Draft;

/// The table being written.
pub(super) struct Changes(Draft);

impl Changes {
    /// Creates the table.
    pub(super) fn new(path: &Path) -> Result<Self> {
        let mut draft = Draft::new(path)?;
        writeln!(draft, "time_ns,bit,value,thread")?;
        Ok(Self(draft))
    }
}

impl Sink for Changes {
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()> {
        let TraceEntry::Bit { bit, level, thread } = entry else { return Ok(()) };
        let (value, thread) = (u8::from(*level), thread.map_or(0, |thread| thread.get()));
        writeln!(self.0, "{},{bit},{value},{thread}", nanoseconds(at))
    }

    fn finish(self: Box<Self>, _: Ticks) -> Result<()> {
        self.0.commit()
    }

    fn path(&self) -> &Path {
        self.0.path()
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn each_change_is_one_line() {
        let text = super::super::testing::file("bits.csv");
        assert_eq!(text, "time_ns,bit,value,thread\n215000,46,0,1\n");
    }
}
