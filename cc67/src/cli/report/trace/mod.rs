//! `--trace` and related options: the events and values of a run, as a file for a viewer or as a table.
//!
//! The suffix of the file determines the format: `.vcd` for waveform viewers, `.json` for trace viewers (Perfetto,
//! Chrome), anything else for a table of values. Files grow while the run continues, under temporary names, and get
//! their own names at the end: a run of any length needs no more memory than a short one, and a killed run leaves no
//! incomplete file. Only plots are made from data in memory, whose size is also bounded.

mod bits;
mod chrome;
mod columns;
mod log;
mod order;
mod packets;
mod picture;
mod table;
mod unit;
mod vcd;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use cc67_host::{Capability, Session, Target, WatchError};
use kmotiondef::{Axes, Bit, CodeAddr, Cycles, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::standing::UsedAxis;
use runtime::trace::{Item, Packets, Quantity, Record, TraceRequest};
use runtime::{Event, EventKind, Remark};

use crate::cli::args::trace::TraceArguments;
use crate::cli::io::{output, terminal};
use crate::cli::report::plot::samples::PlottedAxis;
use crate::cli::report::plot::{self, Form};
use columns::Columns;
use log::Log;
pub(crate) use log::SAMPLES;
use order::Order;

/// Returns the recording that a session should make; `None` if there is no trace.
///
/// # Errors
/// The request is not valid, or the target does not support it.
pub(crate) fn request<T: Target>(
    arguments: &TraceArguments,
    session: &Session<T>,
) -> Result<Option<TraceRequest>> {
    let packets = arguments.trace_packets.as_ref().map(|file| packets::wanted(file, session)).transpose()?;
    let request = requested(arguments, packets, session.target().axes(), |list| session.quantities(list))?;
    let Some(request) = request else { return Ok(None) };
    session.require(Capability::Recordings)?;
    if arguments.trace_bits.is_some() || arguments.trace_packets.is_some() {
        session.require(Capability::Surroundings)?;
    }
    if !session.can(Capability::StopTime) {
        recorded_by_the_board(arguments, &request)?;
        return Ok(Some(request));
    }
    for quantity in &request.quantities {
        if let Some(item) = quantity.items().iter().find(|item| !session.target().has_item(**item)) {
            bail!(
                "`--watch {quantity}`: `{item}` belongs to an option board that {} does not have",
                session.target().name()
            );
        }
    }
    Ok(Some(request))
}

/// Rejects quantities that the data recorder of a controller cannot record.
fn recorded_by_the_board(arguments: &TraceArguments, request: &TraceRequest) -> Result<()> {
    if arguments.trace_items.is_none() {
        bail!(
            "with `--on`, `--watch` names what is recorded, such as axis0,persist.5: the fewer, the longer"
        );
    }
    if let Some(quantity) = request.quantities.iter().find(|quantity| quantity.cell().is_none()) {
        bail!(
            "`--watch {quantity}`: a controller records axes (dest0, pos0, out0, vel0), adc0, persist.5, and variables of \
             the types int, float and double; it computes nothing"
        );
    }
    Ok(())
}

fn requested(
    arguments: &TraceArguments,
    packets: Option<Packets>,
    axes: Axes,
    quantities: impl FnOnce(&str) -> Result<Vec<Quantity>, WatchError>,
) -> Result<Option<TraceRequest>> {
    let TraceArguments { trace, trace_bits, trace_packets, plot, trace_items, trace_every } = arguments;
    if trace.is_empty() && trace_bits.is_none() && trace_packets.is_none() && plot.is_empty() {
        if trace_items.is_some() {
            bail!("`--watch` says what is shown; `--plot FILE.svg` or `--trace FILE.csv` says where");
        }
        return Ok(None);
    }
    trace.iter().try_for_each(|path| known_suffix(path))?;
    for picture in plot {
        Form::of(picture)?;
    }
    let quantities = match trace_items {
        None if plot.is_empty() => Item::of_axes(axes).into_iter().map(Quantity::from).collect(),
        None => Columns::of_pictures(axes).into_iter().map(Quantity::from).collect(),
        Some(list) => quantities(list).map_err(refused)?,
    };
    let is_table = |path: &PathBuf| !matches!(suffix(path).as_str(), "vcd" | "json");
    let changes = trace_bits.is_some() || !plot.is_empty() || !trace.iter().all(is_table);
    Ok(Some(TraceRequest { quantities, every: *trace_every, changes, packets }))
}

/// Checks that a suffix is known, or absent.
fn known_suffix(path: &Path) -> Result<()> {
    match suffix(path).as_str() {
        "" | "csv" | "txt" | "vcd" | "json" => Ok(()),
        "svg" | "png" | "html" => bail!("`--trace {0}`: a picture is drawn by `--plot {0}`", path.display()),
        other => bail!(
            "`--trace {}`: unknown trace format `.{other}`; known: .csv, .txt, .vcd, .json and .json.gz",
            path.display()
        ),
    }
}

/// The suffix that determines the format; for a compressed file it is the one before `.gz`, if it is known.
fn suffix(path: &Path) -> String {
    let last = |path: &Path| path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let suffix = last(path);
    let before = path.file_stem().map(|stem| last(Path::new(stem))).unwrap_or_default();
    if suffix == "gz" && before == "json" { before } else { suffix }
}

/// An entry of a trace; its time is passed separately.
#[derive(Clone, Debug, PartialEq)]
enum TraceEntry {
    /// A bit has changed; with the thread that changed it.
    Bit { bit: Bit, level: bool, thread: Option<ThreadId> },
    /// A thread has the processor until `end`; with the instruction before which the servo interrupt stopped it.
    Slice { thread: ThreadId, end: Cycles, interrupted_at: Option<CodeAddr> },
    /// A remark on accesses of two threads.
    Race(Remark),
    /// The processor has executed a packet of real code.
    Packet { thread: Option<ThreadId>, address: CodeAddr, cycles: Cycles, text: String },
    /// The values of the items, and the enabled axes.
    Sample { values: Vec<f64>, enabled: u16 },
    /// A console line.
    Line(String),
    /// A character sent by the serial port.
    Sent(u8),
}

impl TraceEntry {
    /// Converts an event, if it belongs to a trace.
    fn of(event: &Event) -> Option<Self> {
        Some(match &event.kind {
            EventKind::Trace(Record::Bit { bit, level, thread }) => {
                Self::Bit { bit: *bit, level: *level, thread: *thread }
            }
            EventKind::Trace(Record::Slice { thread, end, interrupted_at }) => {
                Self::Slice { thread: *thread, end: *end, interrupted_at: *interrupted_at }
            }
            EventKind::Remark(remark) if remark.other_thread().is_some() => Self::Race(remark.clone()),
            EventKind::Trace(Record::Packet { thread, address, cycles, text }) => {
                Self::Packet { thread: *thread, address: *address, cycles: *cycles, text: text.clone() }
            }
            EventKind::Trace(Record::Sample { values, enabled }) => {
                Self::Sample { values: values.clone(), enabled: *enabled }
            }
            EventKind::ConsoleLine(line) => Self::Line(String::from_utf8_lossy(line).into_owned()),
            EventKind::UartSent(byte) => Self::Sent(*byte),
            _ => return None,
        })
    }
}

/// A file that grows during a run.
trait Sink {
    /// Writes an entry; times never decrease.
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()>;

    /// Completes the file; the run has ended with this tick.
    fn finish(self: Box<Self>, end: Ticks) -> Result<()>;

    /// The path of the file.
    fn path(&self) -> &Path;
}

/// All files of a run.
pub(crate) struct Trace {
    /// True if nothing is written before the end.
    is_late: bool,
    order: Order,
    sinks: Vec<Box<dyn Sink>>,
    log: Option<Log>,
    /// The labels of axes in plots.
    axes: BTreeMap<usize, PlottedAxis>,
    /// The lines of programs, some of which are named in plots.
    programs: Vec<DebugInfo>,
    /// The first file that could not be written, with the error.
    failed: Option<(PathBuf, io::Error)>,
}

/// The reason why a quantity cannot be recorded, as a message about the option.
fn refused(error: WatchError) -> anyhow::Error {
    match error {
        WatchError::Missing => {
            anyhow!("`--watch` needs names between its commas, such as axis0,bit46,persist.5")
        }
        WatchError::Item(_) => error.into(),
        WatchError::TooLong | WatchError::NoPlace(_) => anyhow!("`--watch`: {error}"),
        WatchError::Wrong { expression, message } => anyhow!("`--watch {expression}`: {message}"),
    }
}

impl Trace {
    /// Creates all files; `is_late` is true if samples come at the end, after all other entries.
    pub(crate) fn begin(arguments: &TraceArguments, request: &TraceRequest, is_late: bool) -> Result<Self> {
        let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
        for path in &arguments.trace {
            let columns = Columns::new(request);
            sinks.push(match suffix(path).as_str() {
                "vcd" => Box::new(vcd::Dump::new(path, columns)?),
                "json" => Box::new(chrome::Events::new(path, columns)?),
                _ => Box::new(table::Table::new(path, columns, request.every)?),
            });
        }
        if let Some(path) = &arguments.trace_bits {
            sinks.push(Box::new(bits::Changes::new(path)?));
        }
        if let Some(file) = &arguments.trace_packets {
            sinks.push(Box::new(packets::PacketTable::new(&file.path)?));
        }
        let log = (!arguments.plot.is_empty()).then(|| Log::new(request));
        let (axes, programs) = Default::default();
        Ok(Self { is_late, order: Order::default(), sinks, log, axes, programs, failed: None })
    }

    /// Takes information from the board for plots: the names of axes in the machine file, the axes that are not
    /// measured, and the lines of programs.
    pub(crate) fn know_board<T: Target>(&mut self, session: &Session<T>) {
        self.programs = session.debug().into_iter().map(|(_, debug)| debug).collect();
        self.know_axes(session.target().standing_axes());
    }

    fn know_axes(&mut self, axes: Vec<UsedAxis>) {
        let plotted = |axis: UsedAxis| {
            let UsedAxis { axis, name, units, is_measured, .. } = axis;
            (axis.index(), PlottedAxis { name, units, is_measured })
        };
        self.axes.extend(axes.into_iter().map(plotted));
    }

    /// Completes all files; `end` is the last tick of the run, `title` the title of plots.
    pub(crate) fn finish(mut self, arguments: &TraceArguments, end: Ticks, title: &str) -> Result<()> {
        self.pass_on(true);
        if let Some((path, error)) = self.failed {
            return Err(output::cannot_write(&path, &error));
        }
        for sink in self.sinks {
            let path = sink.path().to_owned();
            sink.finish(end).map_err(|error| match error.downcast::<io::Error>() {
                Ok(error) => output::cannot_write(&path, &error),
                Err(other) => other,
            })?;
        }
        let every = self.log.as_ref().map_or(0, |log| log.step.get() / Cycles::PER_TICK.get());
        if every as u64 > arguments.trace_every {
            terminal::note(&format!(
                "the picture shows every {every} ticks what was so then: it is made of {SAMPLES} samples at most; \
                 `--trace FILE` writes all"
            ));
        }
        for path in &arguments.plot {
            let Some(log) = &self.log else { continue };
            let chart = picture::chart(log, title.to_owned(), end, &self.axes, &self.programs);
            plot::write(&chart, Form::of(path)?, path)?;
        }
        Ok(())
    }

    /// Handles an event, if it belongs to a trace.
    pub(crate) fn note(&mut self, event: &Event) {
        if let Some(entry) = TraceEntry::of(event) {
            self.order.add(event.at, entry);
            if !self.is_late {
                self.pass_on(false);
            }
        }
    }

    /// Writes the entries that are in order; at the end, all entries.
    fn pass_on(&mut self, is_over: bool) {
        while let Some((at, entry)) = self.order.take(is_over) {
            for sink in &mut self.sinks {
                if self.failed.is_none()
                    && let Err(error) = sink.note(at, &entry)
                {
                    self.failed = Some((sink.path().to_owned(), error));
                }
            }
            if let Some(log) = &mut self.log {
                log.note(at, entry);
            }
        }
    }
}

/// Nanoseconds since power-up.
fn nanoseconds(at: Cycles) -> i64 {
    at.get() * (1_000_000_000 / Cycles::PER_SECOND.get())
}

#[cfg(test)]
mod testing {
    use super::*;

    /// The request for a run with a few records of each kind.
    pub(crate) fn request() -> TraceRequest {
        let item = |name| Quantity::from(Item::new(name).expect("an item"));
        TraceRequest {
            quantities: ["dest0", "bit46"].map(item).to_vec(),
            every: 2,
            changes: true,
            packets: None,
        }
    }

    /// Its records in the order of arrival: not quite sorted by time.
    pub(crate) fn events() -> Vec<Event> {
        let us = |us: i64| Cycles::new(us * Cycles::PER_SECOND.get() / 1_000_000);
        let (bit, thread) = (Bit::new(46).expect("a bit"), ThreadId::new(1).expect("1 is a thread"));
        let kinds = [
            (180, EventKind::Trace(Record::Sample { values: vec![0.5, 1.0], enabled: 1 })),
            (215, EventKind::Trace(Record::Bit { bit, level: false, thread: Some(thread) })),
            (205, EventKind::Trace(Record::Slice { thread, end: us(230), interrupted_at: None })),
            (450, EventKind::ConsoleLine(b"a \"b\"".to_vec())),
            (540, EventKind::Trace(Record::Sample { values: vec![2.0, 0.0], enabled: 1 })),
            (560, EventKind::UartSent(b'x')),
        ];
        kinds.into_iter().map(|(at, kind)| Event { at: us(at), kind }).collect()
    }

    /// The file with this name after a run of seven ticks.
    pub(crate) fn file(name: &str) -> String {
        let folder = std::env::temp_dir().join(format!("cc67-trace-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        let is_bits = name.starts_with("bits");
        let arguments = TraceArguments {
            trace: if is_bits { Vec::new() } else { vec![path.clone()] },
            trace_bits: is_bits.then(|| path.clone()),
            trace_packets: None,
            plot: Vec::new(),
            trace_items: None,
            trace_every: 2,
        };
        let mut trace = Trace::begin(&arguments, &request(), false).expect("it can be written");
        events().iter().for_each(|event| trace.note(event));
        assert!(!path.exists(), "it has its name before it is complete");
        trace.finish(&arguments, Ticks::new(7), "").expect("it can be written");
        let text = std::fs::read_to_string(&path).expect("it is written");
        let left: Vec<_> = std::fs::read_dir(&folder).expect("it is there").collect();
        assert_eq!(left.len(), 1, "{left:?}");
        std::fs::remove_dir_all(&folder).expect("it is ours");
        text
    }

    /// The recording for plots.
    pub(crate) fn log() -> Log {
        let mut log = Log::new(&request());
        for event in events() {
            log.note(event.at, TraceEntry::of(&event).expect("it belongs to a trace"));
        }
        log
    }
}
