//! What a run shows, and where: console lines on stdout and everything else on stderr, or all of it as JSON on stdout.
//!
//! With `--json` each line is an object with a `type`, and the last one, of type `end`, sums the run up. Texts that are
//! not UTF-8 have the replacement character where they are not.

use std::io::{self, Write};

use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};
use serde::Serialize;

use super::repeats::Repeats;
use super::run::TIMEBASE;
use super::{Exit, terminal};
use cc67_host::remark;

/// How a run is shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Style {
    /// The board time stands before each console line.
    pub(super) time: bool,
    /// Details are shown, too.
    pub(super) is_verbose: bool,
    /// Every line is written at once, not only when the buffer is full.
    pub(super) is_live: bool,
    /// As JSON.
    pub(super) json: bool,
}

/// A line of `--json`.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
enum Line<'a> {
    /// A line of the console.
    Console { seconds: f64, text: &'a str },
    /// A thread or the call-back was stopped.
    Trap { seconds: f64, thread: Option<u8>, text: &'a str },
    /// The PC did something for a program.
    Pc { seconds: f64, text: &'a str },
    /// An expectation of the stimulus was not met.
    Unmet { seconds: f64, text: &'a str },
    /// The simulation has something to say.
    Remark { seconds: f64, text: &'a str },
    /// The run is over.
    End(Summary<'a>),
}

/// What a run came to.
#[derive(Clone, Copy, Debug, Serialize)]
struct Summary<'a> {
    /// `ended`, `limit`, `still running`, `trapped` or `unmet`.
    reason: &'a str,
    /// The exit code that goes with it.
    exit: u8,
    /// Board time.
    seconds: f64,
    ticks: u64,
    /// How many lines, traps and remarks there were.
    console_lines: u64,
    traps: u64,
    remarks: u64,
    /// Threads that are active still.
    active: &'a [u8],
}

/// A program that a stimulus may load: its thread, its name, and what is known of it.
pub(super) type Offered = (ThreadId, String, DebugInfo);

/// Where events go.
pub(super) struct Screen<W: Write> {
    out: W,
    style: Style,
    /// What is known of the programs, and the thread of each.
    programs: Vec<DebugInfo>,
    threads: Vec<ThreadId>,
    offered: Vec<Offered>,
    console_lines: u64,
    traps: u64,
    remarks: u64,
    repeats: Repeats,
    /// Who has read which inputs that nothing drives: told together when the run is over.
    undriven: Vec<(String, Bit)>,
    error: Option<io::Error>,
}

impl<W: Write> Screen<W> {
    /// A screen for a run of these programs, and of those that a stimulus may load.
    pub(super) fn new(
        out: W,
        style: Style,
        programs: Vec<(ThreadId, DebugInfo)>,
        offered: Vec<Offered>,
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
            error,
        }
    }

    /// Another program has been loaded.
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

    /// Shows an event.
    pub(super) fn show(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) => {
                self.console_lines += 1;
                let written = self.write_line(line, event.at);
                self.keep(written);
            }
            EventKind::Trace(_) | EventKind::UartSent(_) => {}
            EventKind::Loaded(thread, name) => self.replace(*thread, name),
            EventKind::Detail(text) if self.style.is_verbose => self.say(event, text),
            EventKind::UndrivenInput { bit, thread, place } if !self.style.json && !self.style.is_live => {
                self.undriven.push((remark::reader(*thread, *place, &self.programs), *bit));
            }
            _ => {
                if let Some(text) = remark::describe(event, &self.programs) {
                    self.say(event, &text);
                }
            }
        }
    }

    fn write_line(&mut self, line: &[u8], at: Cycles) -> io::Result<()> {
        if self.style.json {
            let text = String::from_utf8_lossy(line);
            return self.write_json(&Line::Console { seconds: seconds(at), text: &text });
        }
        if self.style.time {
            write!(self.out, "{:.6} ", seconds(at))?;
        }
        self.out.write_all(line)?;
        self.out.write_all(b"\n")?;
        if self.style.is_live { self.out.flush() } else { Ok(()) }
    }

    /// Shows a text that is not the programs'.
    fn say(&mut self, event: &Event, text: &str) {
        let is_trap = matches!(event.kind, EventKind::Trap(_));
        *(if is_trap { &mut self.traps } else { &mut self.remarks }) += 1;
        if !self.style.json {
            if matches!(event.kind, EventKind::Diagnostic(_)) && !self.repeats.is_shown(text) {
                return;
            }
            // What was printed before stands before it on a terminal that shows both.
            let flushed = self.out.flush();
            self.keep(flushed);
            return terminal::note(text);
        }
        let seconds = seconds(event.at);
        let line = match &event.kind {
            EventKind::Trap(trap) => Line::Trap { seconds, thread: trap.thread.map(ThreadId::get), text },
            EventKind::Host(_) => Line::Pc { seconds, text },
            EventKind::Unmet(_) => Line::Unmet { seconds, text },
            _ => Line::Remark { seconds, text },
        };
        let written = self.write_json(&line);
        self.keep(written);
    }

    fn write_json(&mut self, line: &Line<'_>) -> io::Result<()> {
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

    /// Says how the run has ended.
    pub(super) fn end(&mut self, exit: Exit, reason: &str, at: Ticks, active: &[u8]) {
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
        let line = Line::End(Summary {
            reason,
            exit: exit as u8,
            seconds: at.get() as f64 * TIMEBASE,
            ticks: at.get(),
            console_lines: self.console_lines,
            traps: self.traps,
            remarks: self.remarks,
            active,
        });
        let written = self.write_json(&line);
        self.keep(written);
    }

    /// Writes what is left; whether anybody reads it, and the first error of all writes.
    ///
    /// # Errors
    /// Why stdout cannot be written; a reader that has seen enough, as `head` has, is no failure.
    pub(super) fn finish(&mut self) -> io::Result<Reader> {
        let flushed = self.out.flush();
        self.keep(flushed);
        match self.error.take() {
            Some(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(Reader::Gone),
            Some(error) => Err(error),
            None => Ok(Reader::There),
        }
    }
}

/// Whether somebody reads what is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub(super) enum Reader {
    There,
    Gone,
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}
