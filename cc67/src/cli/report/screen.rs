//! Output of a run: console lines on stdout and everything else on stderr, or all of it as JSON on stdout.
//!
//! With `--json` each line is an object with a `type`, and the last one, of type `end`, summarises the run. Invalid
//! UTF-8 in texts is replaced by the replacement character.

use std::collections::BTreeMap;
use std::io::{self, Write};

use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind, Message, Remark, Severity};
use serde::Serialize;
use vm::trap::Scene;

use super::repeats::RemarkCounts;
use super::state::FinalState;
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use cc67_host::{AxisReport, EndReport, SourceCall, ThreadReport, remark};

/// The style for showing a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Style {
    /// True to show the board time before each console line.
    pub(crate) time: bool,
    /// True to show details.
    pub(crate) is_verbose: bool,
    /// True to write every line at once, not only when the buffer is full.
    pub(crate) is_live: bool,
    /// True for JSON.
    pub(crate) json: bool,
}

/// A line of output with `--json`.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
enum JsonLine<'a> {
    /// A line of the console.
    Console { seconds: f64, text: &'a str },
    /// A thread or the call-back was stopped.
    Trap {
        seconds: f64,
        thread: Option<u8>,
        text: &'a str,
        /// Registers and code, for code of the real processor.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        scene: Option<SceneJson<'a>>,
    },
    /// The PC has acted for a program.
    Pc { seconds: f64, text: &'a str },
    /// An expectation of the stimulus was not met.
    Unmet { seconds: f64, text: &'a str },
    /// A remark of the simulation; it has a code if it is in the table of remarks.
    Remark {
        seconds: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        code: Option<&'static str>,
        /// The location of the call, if a program made it.
        #[serde(flatten)]
        place: Option<CallJson<'a>>,
        text: &'a str,
    },
    /// The run is over.
    End(Summary<'a>),
}

/// Registers and code around the position of a trap.
#[derive(Clone, Debug, Serialize)]
struct SceneJson<'a> {
    /// The address of the instruction.
    at: u32,
    /// Values by the names of the registers.
    registers: BTreeMap<&'a str, u32>,
    /// The words around the position.
    code: Vec<CodeJson<'a>>,
}

/// A word of code.
#[derive(Clone, Debug, Serialize)]
struct CodeJson<'a> {
    at: u32,
    /// The word with its instruction.
    text: &'a str,
}

impl<'a> From<&'a Scene> for SceneJson<'a> {
    fn from(scene: &'a Scene) -> Self {
        let registers = scene.registers.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let code = scene.code.iter().map(|(at, text)| CodeJson { at: *at, text }).collect();
        Self { at: scene.at, registers, code }
    }
}

/// The summary of a run.
#[derive(Clone, Debug, Serialize)]
struct Summary<'a> {
    /// `ended`, `limit`, `still running`, `trapped` or `unmet`.
    reason: &'a str,
    /// The corresponding exit code.
    exit: u8,
    /// The board time.
    seconds: f64,
    ticks: u64,
    /// The number of lines, traps and remarks.
    console_lines: u64,
    traps: u64,
    remarks: u64,
    /// Threads that have not ended, and the axes that programs have used.
    threads: Vec<ThreadJson<'a>>,
    used_axes: Vec<AxisJson<'a>>,
    /// The threads that are still active.
    active: &'a [u8],
    /// The final state of the board.
    #[serde(flatten)]
    state: &'a FinalState,
}

/// The last line of `--json` for a run that could not be started.
pub(crate) fn no_run(exit: Exit, reason: &str) -> String {
    let line = JsonLine::End(Summary {
        reason,
        exit: exit as u8,
        seconds: 0.0,
        ticks: 0,
        console_lines: 0,
        traps: 0,
        remarks: 0,
        threads: Vec::new(),
        used_axes: Vec::new(),
        active: &[],
        state: &FinalState::default(),
    });
    serde_json::to_string(&line).unwrap_or_default() + "\n"
}

/// A thread that has not ended.
#[derive(Clone, Debug, Serialize)]
struct ThreadJson<'a> {
    thread: u8,
    state: &'a str,
    #[serde(flatten)]
    place: Option<CallJson<'a>>,
    /// The calls that led there, innermost first.
    calls: Vec<CallJson<'a>>,
    waits_for: &'a [String],
    since: f64,
}

/// A position in a source.
#[derive(Clone, Copy, Debug, Serialize)]
struct CallJson<'a> {
    file: &'a str,
    line: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<u32>,
    function: &'a str,
}

/// An axis that programs have used.
#[derive(Clone, Debug, Serialize)]
struct AxisJson<'a> {
    axis: u8,
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    enabled: bool,
    dest: f64,
    position: f64,
    velocity: f64,
    why: &'a [String],
}

impl<'a> From<&'a ThreadReport> for ThreadJson<'a> {
    fn from(ending: &'a ThreadReport) -> Self {
        let ThreadReport { thread, state, calls, waits_for, since } = ending;
        let mut places = calls.iter().map(CallJson::from);
        let (place, calls) = (places.next(), places.collect());
        Self { thread: thread.get(), state, place, calls, waits_for, since: *since }
    }
}

impl<'a> From<&'a SourceCall> for CallJson<'a> {
    fn from(call: &'a SourceCall) -> Self {
        Self { file: &call.file, line: call.line, column: call.column, function: &call.function }
    }
}

impl<'a> From<&'a AxisReport> for AxisJson<'a> {
    fn from(ending: &'a AxisReport) -> Self {
        let AxisReport { axis, name, enabled, dest, position, velocity, why } = ending;
        let (axis, enabled) = (axis.get(), *enabled);
        Self { axis, name, enabled, dest: *dest, position: *position, velocity: *velocity, why }
    }
}

/// A program that a stimulus may load: its thread, its name, and its debug information.
pub(crate) type OfferedProgram = (ThreadId, String, DebugInfo);

/// The destination of events.
pub(crate) struct Screen<W: Write> {
    out: W,
    style: Style,
    /// Debug information of the programs, and the thread of each.
    programs: Vec<DebugInfo>,
    threads: Vec<ThreadId>,
    offered: Vec<OfferedProgram>,
    console_lines: u64,
    traps: u64,
    remarks: u64,
    repeats: RemarkCounts,
    /// Undriven inputs with their readers: reported together at the end of the run.
    undriven: Vec<(String, Bit, u8)>,
    /// Traps that are shown after the lines that the thread printed before.
    traps_held: Vec<Event>,
    error: Option<io::Error>,
}

/// The time within which the board sends the lines that a thread printed before its trap.
const PRINTED: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 20);

impl<W: Write> Screen<W> {
    /// Creates a screen for a run of these programs, and of those that a stimulus may load.
    pub(crate) fn new(
        out: W,
        style: Style,
        programs: Vec<(ThreadId, DebugInfo)>,
        offered: Vec<OfferedProgram>,
    ) -> Self {
        let (threads, programs) = programs.into_iter().unzip();
        let (console_lines, traps, remarks, repeats, undriven) = Default::default();
        let error = None;
        Self {
            out,
            style,
            programs,
            threads,
            offered,
            console_lines,
            traps,
            remarks,
            repeats,
            undriven,
            traps_held: Vec::new(),
            error,
        }
    }

    /// Notes that another program has been loaded.
    fn replace(&mut self, thread: ThreadId, name: &str) {
        let offered = self.offered.iter().find(|(other, known, _)| *other == thread && known == name);
        let Some((_, _, debug)) = offered else { return };
        match self.threads.iter().position(|other| *other == thread) {
            Some(index) => self.programs[index] = debug.clone(),
            None => {
                self.threads.push(thread);
                self.programs.push(debug.clone());
            }
        }
    }

    /// Shows an event; a trap is shown after the lines printed before it, which the board sends later.
    pub(crate) fn show(&mut self, event: &Event) {
        if !matches!(event.kind, EventKind::ConsoleLine(_)) {
            self.show_traps(event.at);
        }
        if matches!(event.kind, EventKind::Trap(_)) && !self.style.json && !self.style.is_live {
            return self.traps_held.push(event.clone());
        }
        self.show_traps(event.at - PRINTED);
        self.show_now(event);
    }

    /// Shows the pending traps up to a time.
    fn show_traps(&mut self, until: Cycles) {
        let (due, later) = std::mem::take(&mut self.traps_held).into_iter().partition(|trap| trap.at < until);
        self.traps_held = later;
        let due: Vec<Event> = due;
        due.iter().for_each(|trap| self.show_now(trap));
    }

    fn show_now(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) => {
                self.console_lines += 1;
                let written = self.write_line(line, event.at);
                self.keep(written);
            }
            EventKind::Trace(_) | EventKind::UartSent(_) => {}
            EventKind::Loaded(thread, name) => self.replace(*thread, name),
            EventKind::Remark(remark) if remark.message.severity() == Severity::Detail => {
                if self.style.is_verbose {
                    self.print_text(event, &remark::remark_text(remark, &self.programs));
                }
            }
            EventKind::Remark(remark @ Remark { message: Message::UndrivenInput { bit, level }, .. })
                if !self.style.json && !self.style.is_live =>
            {
                self.undriven.push((remark::subject_text(remark, &self.programs), *bit, *level));
            }
            _ => {
                if let Some(text) = remark::describe(event, &self.programs) {
                    self.print_text(event, &text);
                }
            }
        }
    }

    fn write_line(&mut self, line: &[u8], at: Cycles) -> io::Result<()> {
        if self.style.json {
            let text = String::from_utf8_lossy(line);
            return self.write_json(&JsonLine::Console { seconds: seconds(at), text: &text });
        }
        if self.style.time {
            write!(self.out, "{:.6} ", seconds(at))?;
        }
        self.out.write_all(line)?;
        self.out.write_all(b"\n")?;
        if self.style.is_live { self.out.flush() } else { Ok(()) }
    }

    /// Shows a text that is not program output.
    fn print_text(&mut self, event: &Event, text: &str) {
        let is_trap = matches!(event.kind, EventKind::Trap(_) | EventKind::Halted(_));
        *(if is_trap { &mut self.traps } else { &mut self.remarks }) += 1;
        if !self.style.json {
            let may_repeat = matches!(&event.kind, EventKind::Remark(remark) if remark.message.severity() > Severity::Detail);
            if may_repeat && !self.repeats.is_shown(text) {
                return;
            }
            // On a terminal that shows both, output printed before should appear before.
            let flushed = self.out.flush();
            self.keep(flushed);
            terminal::note(text);
            if let Some(scene) = remark::scene(event) {
                terminal::print_separated(&scene.to_string());
            }
            return;
        }
        let seconds = seconds(event.at);
        let call;
        let line = match &event.kind {
            EventKind::Trap(trap) => {
                let scene = trap.scene.as_deref().map(SceneJson::from);
                JsonLine::Trap { seconds, thread: trap.thread.map(ThreadId::get), text, scene }
            }
            EventKind::Halted(_) => JsonLine::Trap { seconds, thread: None, text, scene: None },
            EventKind::Host(_) => JsonLine::Pc { seconds, text },
            EventKind::Unmet(_) => JsonLine::Unmet { seconds, text },
            EventKind::Remark(remark) => {
                call = remark.place.and_then(|at| remark::place(at, &self.programs));
                let place = call.as_ref().map(CallJson::from);
                JsonLine::Remark { seconds, code: Some(remark.message.code()), place, text }
            }
            _ => JsonLine::Remark { seconds, code: None, place: None, text },
        };
        let written = self.write_json(&line);
        self.keep(written);
    }

    fn write_json(&mut self, line: &JsonLine<'_>) -> io::Result<()> {
        if self.error.is_some() {
            return Ok(());
        }
        serde_json::to_writer(&mut self.out, line)?;
        self.out.write_all(b"\n")?;
        if self.style.is_live { self.out.flush() } else { Ok(()) }
    }

    /// Keeps the first error of all writes.
    fn keep(&mut self, written: io::Result<()>) {
        self.error = self.error.take().or(written.err());
    }

    /// Reports the end of the run.
    pub(crate) fn end(
        &mut self,
        exit: Exit,
        reason: &str,
        at: Ticks,
        active: &[u8],
        ending: &EndReport,
        state: &FinalState,
    ) {
        self.show_traps(Cycles::new(i64::MAX));
        let mut last = self.repeats.summary();
        if !self.undriven.is_empty() {
            last.push(remark::undriven(&self.undriven));
        }
        if !last.is_empty() {
            let flushed = self.out.flush();
            self.keep(flushed);
        }
        last.iter().for_each(|text| terminal::note(text));
        if !self.style.json {
            return;
        }
        let line = JsonLine::End(Summary {
            reason,
            exit: exit as u8,
            seconds: seconds(Cycles::new((at.get() as i64).saturating_mul(Cycles::PER_TICK.get()))),
            ticks: at.get(),
            console_lines: self.console_lines,
            traps: self.traps,
            remarks: self.remarks,
            threads: ending.threads.iter().map(ThreadJson::from).collect(),
            used_axes: ending.axes.iter().map(AxisJson::from).collect(),
            active,
            state,
        });
        let written = self.write_json(&line);
        self.keep(written);
    }

    /// Writes the remaining output; returns whether anybody reads it.
    ///
    /// # Errors
    /// The first error of all writes; a reader that closes early, such as `head`, is not an error.
    pub(crate) fn finish(&mut self) -> io::Result<Audience> {
        let flushed = self.out.flush();
        self.keep(flushed);
        match self.error.take() {
            Some(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(Audience::Gone),
            Some(error) => Err(error),
            None => Ok(Audience::Present),
        }
    }
}

/// The presence of a reader for the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub(crate) enum Audience {
    Present,
    Gone,
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}
