//! A trace as the events of trace viewers: threads as tracks, bits and items as counters, prints as marks.
//!
//! The format is the "Trace Event Format" of Chrome, which Perfetto reads; with the suffix `.json.gz` it is compressed,
//! which Perfetto also reads. Tracks are named where they begin.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use std::path::Path;

use anyhow::Result;
use flate2::Compression;
use flate2::write::GzEncoder;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::trace::Item;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::columns::Columns;
use super::{Sink, TraceEntry, nanoseconds};
use crate::cli::io::output::Draft;

/// The board as the viewer's process, and its tracks in addition to the threads, whose tracks have the thread numbers.
const BOARD: u32 = 1;
const CONSOLE: u32 = 8;
const UART: u32 = 9;

/// One event. Times are microseconds.
#[derive(Serialize)]
struct Event {
    name: String,
    ph: &'static str,
    pid: u32,
    tid: u32,
    ts: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<f64>,
    /// The scope of a mark.
    #[serde(skip_serializing_if = "Option::is_none")]
    s: Option<&'static str>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    args: Map<String, Value>,
}

impl Event {
    fn new(ph: &'static str, name: String, tid: u32, at: Cycles) -> Self {
        Self { name, ph, pid: BOARD, tid, ts: microseconds(at), dur: None, s: None, args: Map::new() }
    }

    fn with(mut self, key: &str, value: Value) -> Self {
        self.args.insert(key.to_owned(), value);
        self
    }

    /// Gives a track its name.
    fn track(tid: u32, name: &str) -> Self {
        Self::new("M", "thread_name".to_owned(), tid, Cycles::default()).with("name", json!(name))
    }

    fn mark(name: String, tid: u32, at: Cycles) -> Self {
        Self { s: Some("t"), ..Self::new("i", name, tid, at) }
    }

    fn level(bit: Bit, level: bool, at: Cycles) -> Self {
        Self::new("C", format!("bit {bit}"), 0, at).with("level", json!(u8::from(level)))
    }
}

fn microseconds(at: Cycles) -> f64 {
    nanoseconds(at) as f64 / 1000.0
}

/// The bytes of the file, plain or compressed.
enum TraceFile {
    Plain(Draft),
    Compressed(GzEncoder<Draft>),
}

impl TraceFile {
    /// Creates the file; its suffix determines the format.
    fn new(path: &Path) -> Result<Self> {
        let draft = Draft::new(path)?;
        let is_compressed = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("gz"));
        Ok(if is_compressed {
            Self::Compressed(GzEncoder::new(draft, Compression::default()))
        } else {
            Self::Plain(draft)
        })
    }

    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Self::Plain(draft) => draft,
            Self::Compressed(encoder) => encoder,
        }
    }

    fn path(&self) -> &Path {
        match self {
            Self::Plain(draft) => draft.path(),
            Self::Compressed(encoder) => encoder.get_ref().path(),
        }
    }

    /// Completes the file.
    fn commit(self) -> Result<()> {
        match self {
            Self::Plain(draft) => draft.commit(),
            Self::Compressed(encoder) => encoder.finish()?.commit(),
        }
    }
}

/// The file being written.
pub(super) struct Events {
    file: TraceFile,
    columns: Columns,
    /// True if an event has been written, after which a comma is needed.
    has_any: bool,
    threads: BTreeSet<ThreadId>,
    bits: BTreeSet<Bit>,
    has_sent: bool,
    /// The latest values of the counters, by their indices in a sample.
    shown: BTreeMap<usize, f64>,
}

impl Events {
    /// Creates the file.
    pub(super) fn new(path: &Path, columns: Columns) -> Result<Self> {
        let mut file = TraceFile::new(path)?;
        write!(file.writer(), "{{\"displayTimeUnit\":\"ns\",\"traceEvents\":[")?;
        let mut events = Self {
            file,
            columns,
            has_any: false,
            threads: BTreeSet::new(),
            bits: BTreeSet::new(),
            has_sent: false,
            shown: BTreeMap::new(),
        };
        let name = Event::new("M", "process_name".to_owned(), 0, Cycles::default());
        events.write(&name.with("name", json!("board")))?;
        events.write(&Event::track(CONSOLE, "console"))?;
        Ok(events)
    }

    fn write(&mut self, event: &Event) -> io::Result<()> {
        let between: &[u8] = if std::mem::replace(&mut self.has_any, true) { b",\n" } else { b"\n" };
        let mut writer = self.file.writer();
        writer.write_all(between)?;
        serde_json::to_writer(&mut writer, event).map_err(io::Error::from)
    }

    /// Writes the items whose values have changed.
    fn sample(&mut self, at: Cycles, values: &[f64]) -> io::Result<()> {
        let columns: Vec<(usize, Option<Bit>, String)> = self
            .columns
            .table_columns()
            .map(|(index, shown)| (index, shown.item().and_then(Item::bit), shown.to_string()))
            .collect();
        for (index, bit, name) in columns {
            // JSON has no infinity, and viewers have no notation for a gap.
            let value = values.get(index).copied().filter(|value| value.is_finite()).unwrap_or_default();
            if let Some(bit) = bit {
                if self.bits.insert(bit) {
                    self.write(&Event::level(bit, value != 0.0, at))?;
                }
            } else if self.shown.insert(index, value) != Some(value) {
                self.write(&Event::new("C", name, 0, at).with("value", json!(value)))?;
            }
        }
        Ok(())
    }
}

impl Sink for Events {
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()> {
        match entry {
            TraceEntry::Bit { bit, level, .. } => {
                if self.bits.insert(*bit) {
                    self.write(&Event::level(*bit, !level, Cycles::default()))?;
                }
                self.write(&Event::level(*bit, *level, at))
            }
            TraceEntry::Slice { thread, end, .. } => {
                let (track, name) = (thread.get().into(), format!("thread {thread}"));
                if self.threads.insert(*thread) {
                    self.write(&Event::track(track, &name))?;
                }
                let slice = Event::new("X", name, track, at);
                self.write(&Event { dur: Some(microseconds(*end - at)), ..slice })
            }
            TraceEntry::Sample { values, enabled } => {
                self.columns.note(*enabled);
                self.sample(at, values)
            }
            TraceEntry::Line(line) => self.write(&Event::mark(line.clone(), CONSOLE, at)),
            TraceEntry::Sent(byte) => {
                if !std::mem::replace(&mut self.has_sent, true) {
                    self.write(&Event::track(UART, "serial port"))?;
                }
                self.write(&Event::mark(byte.escape_ascii().to_string(), UART, at))
            }
            TraceEntry::Packet { .. } | TraceEntry::Race(_) => Ok(()),
        }
    }

    fn finish(mut self: Box<Self>, _: Ticks) -> Result<()> {
        writeln!(self.file.writer(), "\n]}}")?;
        self.file.commit()
    }

    fn path(&self) -> &Path {
        self.file.path()
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_trace_contains_the_events_of_a_run() {
        insta::assert_snapshot!(super::super::testing::file("run.json"), @r#"
        {"displayTimeUnit":"ns","traceEvents":[
        {"name":"process_name","ph":"M","pid":1,"tid":0,"ts":0.0,"args":{"name":"board"}},
        {"name":"thread_name","ph":"M","pid":1,"tid":8,"ts":0.0,"args":{"name":"console"}},
        {"name":"dest0","ph":"C","pid":1,"tid":0,"ts":180.0,"args":{"value":0.5}},
        {"name":"bit 46","ph":"C","pid":1,"tid":0,"ts":180.0,"args":{"level":1}},
        {"name":"thread_name","ph":"M","pid":1,"tid":1,"ts":0.0,"args":{"name":"thread 1"}},
        {"name":"thread 1","ph":"X","pid":1,"tid":1,"ts":205.0,"dur":25.0},
        {"name":"bit 46","ph":"C","pid":1,"tid":0,"ts":215.0,"args":{"level":0}},
        {"name":"a \"b\"","ph":"i","pid":1,"tid":8,"ts":450.0,"s":"t"},
        {"name":"dest0","ph":"C","pid":1,"tid":0,"ts":540.0,"args":{"value":2.0}},
        {"name":"thread_name","ph":"M","pid":1,"tid":9,"ts":0.0,"args":{"name":"serial port"}},
        {"name":"x","ph":"i","pid":1,"tid":9,"ts":560.0,"s":"t"}
        ]}
        "#);
    }
}
