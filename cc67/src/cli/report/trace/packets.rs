//! Packets of real code as a table: `cycle,thread,address,cycles,packet`, with thread 0 for the call-back.
//!
//! `cycle` is the board time at which the packet began, in cycles of 5 ns since power-up; `cycles` is its duration.

use std::io::{self, Write};
use std::path::Path;

use anyhow::{Result, bail};
use cc67_host::{Session, Target};
use kmotiondef::{Cycles, ThreadId, Ticks};
use runtime::trace::Packets;

use super::{Sink, TraceEntry};
use crate::cli::args::trace::PacketFile;
use crate::cli::io::output::Draft;

/// The threads whose packets should be recorded.
///
/// # Errors
/// The named thread has a program that is not real code, or no thread has real code.
pub(super) fn wanted<T: Target>(file: &PacketFile, session: &Session<T>) -> Result<Packets> {
    let all = ThreadId::all().filter(|thread| file.thread.is_none_or(|wanted| wanted == *thread));
    let loaded: Vec<_> =
        all.filter_map(|thread| Some((thread, session.target().runs_processor_code(thread)?))).collect();
    let has_real_code = loaded.iter().any(|(_, is_real)| *is_real);
    // If nothing is loaded yet, real code may be loaded later.
    if let (Some((thread, _)), false) = (loaded.first(), has_real_code) {
        bail!(
            "`--trace-packets`: thread {thread} runs bytecode, which has no packets; `--engine dsp` compiles for the \
             controller's processor"
        );
    }
    Ok(file.thread.map_or(Packets::All, Packets::Of))
}

/// The table being written.
pub(super) struct PacketTable(Draft);

impl PacketTable {
    /// Creates the table.
    pub(super) fn new(path: &Path) -> Result<Self> {
        let mut draft = Draft::new(path)?;
        writeln!(draft, "cycle,thread,address,cycles,packet")?;
        Ok(Self(draft))
    }
}

impl Sink for PacketTable {
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()> {
        let TraceEntry::Packet { thread, address, cycles, text } = entry else { return Ok(()) };
        let thread = thread.map_or(0, |thread| thread.get());
        writeln!(self.0, "{},{thread},{address},{},\"{text}\"", at.get(), cycles.get())
    }

    fn finish(self: Box<Self>, _: Ticks) -> Result<()> {
        self.0.commit()
    }

    fn path(&self) -> &Path {
        self.0.path()
    }
}
