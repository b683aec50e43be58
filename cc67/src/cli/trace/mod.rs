//! `--trace` and its kin: what a run did, as a file for a viewer or a table.
//!
//! The suffix of the file decides: `.vcd` for waveform viewers, `.json` for trace viewers (Perfetto, Chrome), anything
//! else is a table of values. Everything is kept until the run is over, as the head of these files names what is in
//! them; then each file is written under a temporary name and renamed.

mod bits;
mod chrome;
mod picture;
mod table;
mod vcd;
mod watch;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::trace::{Item, Quantity, Record, Request};
use runtime::{Event, EventKind};

use super::output;
use super::plot::{self, Form};
use crate::Options;

pub(super) use watch::Watched;

/// What to trace.
#[derive(Debug, Args)]
pub(super) struct TraceOptions {
    /// Write what happens to FILE: .vcd for waveform viewers, .json for Perfetto, else a table (CSV)
    #[arg(long, value_name = "FILE")]
    trace: Vec<PathBuf>,
    /// Write every change of a bit with its nanosecond and thread to FILE (CSV)
    #[arg(long, value_name = "FILE")]
    trace_bits: Option<PathBuf>,
    /// Draw what moved: .svg, .png, or .html for a page with zoom and cursor
    #[arg(long, value_name = "FILE")]
    plot: Vec<PathBuf>,
    /// What is traced and drawn: axis0,bit46,persist.5,adc2, variables and expressions such as "ch0->Dest - home"; else
    /// the axes that are enabled
    #[arg(long, visible_alias = "watch", value_name = "LIST")]
    trace_items: Option<String>,
    /// Sample every N servo ticks
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    trace_every: u64,
}

impl TraceOptions {
    /// What the board is to record of these programs; `None` if nothing is traced.
    pub(super) fn request(&self, programs: &[Watched<'_>], options: &Options) -> Result<Option<Request>> {
        if self.trace.is_empty() && self.trace_bits.is_none() && self.plot.is_empty() {
            return Ok(None);
        }
        for picture in &self.plot {
            Form::of(picture)?;
        }
        let quantities = match &self.trace_items {
            None => Item::of_axes().into_iter().map(Quantity::from).collect(),
            Some(list) => watch::quantities(list, programs, options)?,
        };
        let is_table = |path: &PathBuf| !matches!(suffix(path).as_str(), "vcd" | "json");
        let changes = self.trace_bits.is_some() || !self.plot.is_empty() || !self.trace.iter().all(is_table);
        Ok(Some(Request { quantities, every: self.trace_every, changes }))
    }

    /// Writes all files; `end` is the last tick of the run, `title` what pictures are called.
    pub(super) fn write(&self, log: &Log, end: Ticks, title: &str) -> Result<()> {
        for path in &self.plot {
            let chart = picture::chart(log, title.to_owned(), self.trace_every, end);
            plot::write(&chart, Form::of(path)?, path)?;
        }
        for path in &self.trace {
            let text = match suffix(path).as_str() {
                "vcd" => vcd::text(log),
                "json" => chrome::text(log)?,
                _ => table::text(log, self.trace_every, end),
            };
            output::write(path, text.as_bytes())?;
        }
        match &self.trace_bits {
            Some(path) => output::write(path, bits::text(log).as_bytes()),
            None => Ok(()),
        }
    }
}

fn suffix(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// A change of a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Change {
    at: Cycles,
    bit: Bit,
    level: bool,
    thread: Option<ThreadId>,
}

/// Everything that was recorded.
#[derive(Debug, Default)]
pub(super) struct Log {
    quantities: Vec<Quantity>,
    /// Whether these are the items of all axes, of which only the enabled ones are shown.
    is_default: bool,
    changes: Vec<Change>,
    slices: Vec<(ThreadId, Cycles, Cycles)>,
    samples: Vec<(Cycles, Vec<f64>)>,
    /// Axes that were enabled at some time.
    enabled: u8,
    lines: Vec<(Cycles, String)>,
    sent: Vec<(Cycles, u8)>,
}

impl Log {
    /// Nothing yet, of what was asked for.
    pub(super) fn new(request: &Request) -> Self {
        let items: Vec<_> = request.quantities.iter().filter_map(Quantity::item).collect();
        let is_default = items == Item::of_axes();
        Self { quantities: request.quantities.clone(), is_default, ..Self::default() }
    }

    /// Takes up an event, if it belongs to a trace.
    pub(super) fn note(&mut self, event: &Event) {
        let at = event.at;
        match &event.kind {
            EventKind::Trace(Record::Bit { bit, level, thread }) => {
                self.changes.push(Change { at, bit: *bit, level: *level, thread: *thread });
            }
            EventKind::Trace(Record::Slice { thread, end }) => self.slices.push((*thread, at, *end)),
            EventKind::Trace(Record::Sample { values, enabled }) => {
                self.enabled |= enabled;
                self.samples.push((at, values.clone()));
            }
            EventKind::ConsoleLine(line) => {
                self.lines.push((at, String::from_utf8_lossy(line).into_owned()));
            }
            EventKind::UartSent(byte) => self.sent.push((at, *byte)),
            _ => {}
        }
    }

    /// What to show, and where each stands in a sample.
    fn columns(&self) -> Vec<(usize, &Quantity)> {
        let is_shown = |quantity: &Quantity| {
            let axis = quantity.item().and_then(Item::axis);
            !self.is_default || axis.is_none_or(|axis| self.enabled >> axis & 1 != 0)
        };
        self.quantities.iter().enumerate().filter(|(_, quantity)| is_shown(quantity)).collect()
    }

    /// Bits that have changed, in ascending order, each with its level before.
    fn bits(&self) -> Vec<(Bit, bool)> {
        let mut bits: Vec<(Bit, bool)> = Vec::new();
        for change in &self.changes {
            if bits.iter().all(|(bit, _)| *bit != change.bit) {
                bits.push((change.bit, !change.level));
            }
        }
        bits.sort_unstable();
        bits
    }
}

/// Nanoseconds since power-up.
fn nanoseconds(at: Cycles) -> i64 {
    at.get() * (1_000_000_000 / Cycles::PER_SECOND.get())
}

#[cfg(test)]
pub(super) mod testing {
    use super::*;

    /// A run of a few records of each kind.
    pub(super) fn log() -> Log {
        let us = |us: i64| Cycles::new(us * Cycles::PER_SECOND.get() / 1_000_000);
        let item = |name| Quantity::from(Item::new(name).expect("an item"));
        let quantities = ["dest0", "bit46"].map(item).to_vec();
        let mut log = Log::new(&Request { quantities, every: 2, changes: true });
        let (bit, thread) = (Bit::new(46).expect("a bit"), ThreadId::new(1).expect("1 is a thread"));
        let kinds = [
            (180, EventKind::Trace(Record::Sample { values: vec![0.5, 1.0], enabled: 1 })),
            (215, EventKind::Trace(Record::Bit { bit, level: false, thread: Some(thread) })),
            (205, EventKind::Trace(Record::Slice { thread, end: us(230) })),
            (450, EventKind::ConsoleLine(b"a \"b\"".to_vec())),
            (540, EventKind::Trace(Record::Sample { values: vec![2.0, 0.0], enabled: 1 })),
            (560, EventKind::UartSent(b'x')),
        ];
        for (at, kind) in kinds {
            log.note(&Event { at: us(at), kind });
        }
        log
    }
}
