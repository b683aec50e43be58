//! Output of the console.
//!
//! At a terminal all output goes through the line editor, which keeps the line being typed below it. Otherwise lines of
//! the board go to stdout, and reports of the simulation to stderr.

use std::io::{self, Write};

use kmotiondef::{Bit, Cycles};
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind, Message, Remark};
use rustyline::ExternalPrinter;

use crate::cli::io::terminal;
use cc67_host::remark;

/// The printer of a line editor.
pub(super) type Printer = Box<dyn ExternalPrinter + Send>;

/// The destination of lines.
pub(super) struct Screen {
    time: bool,
    printer: Option<Printer>,
    error: Option<io::Error>,
    /// True if undriven inputs are reported together at the end; then the inputs that were read.
    groups: bool,
    undriven: Vec<(String, Bit, u8)>,
    /// Debug information of the loaded programs.
    pub(super) programs: Vec<DebugInfo>,
}

impl Screen {
    /// Creates a screen, with or without the board time before each line; it reports undriven inputs at the end, or as
    /// they are read.
    pub(super) const fn new(time: bool, groups: bool) -> Self {
        Self { time, printer: None, error: None, groups, undriven: Vec::new(), programs: Vec::new() }
    }

    /// From now on shows everything through a line editor.
    pub(super) fn print_through(&mut self, printer: Printer) {
        self.printer = Some(printer);
    }

    /// Returns whether nobody reads the output any more.
    pub(super) const fn is_closed(&self) -> bool {
        self.error.is_some()
    }

    /// Returns the first write error; a reader that closes early, such as `head`, is not an error.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        if !self.undriven.is_empty() {
            self.note(&remark::undriven(&self.undriven));
        }
        match self.error.take() {
            Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
            _ => Ok(()),
        }
    }

    /// Shows an event of the board.
    pub(super) fn show(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) | EventKind::Reply(line) => {
                let mut text = Vec::new();
                if self.time {
                    let seconds = event.at.get() as f64 / Cycles::PER_SECOND.get() as f64;
                    text.extend_from_slice(format!("{seconds:.6} ").as_bytes());
                }
                text.extend_from_slice(line);
                text.push(b'\n');
                self.bytes(&text);
            }
            EventKind::Remark(remark @ Remark { message: Message::UndrivenInput { bit, level }, .. })
                if self.groups =>
            {
                self.undriven.push((remark::subject_text(remark, &self.programs), *bit, *level));
            }
            _ => {
                if let Some(text) = remark::describe(event, &self.programs) {
                    let scene = remark::scene(event).map_or(String::new(), |scene| format!("\n{scene}"));
                    self.note(format!("{text}{scene}").trim_end());
                }
            }
        }
    }

    /// Shows a requested text.
    pub(super) fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    /// Shows a remark of the simulation.
    pub(super) fn note(&mut self, text: &str) {
        match &mut self.printer {
            Some(printer) => {
                let printed = printer.print(format!("cc67: {text}\n"));
                self.error = self.error.take().or(printed.err().map(io::Error::other));
            }
            None => terminal::note(text),
        }
    }

    fn bytes(&mut self, bytes: &[u8]) {
        if self.error.is_some() {
            return;
        }
        self.error = match &mut self.printer {
            Some(printer) => {
                printer.print(String::from_utf8_lossy(bytes).into_owned()).err().map(io::Error::other)
            }
            None => {
                let mut out = io::stdout().lock();
                out.write_all(bytes).and_then(|()| out.flush()).err()
            }
        };
    }
}
