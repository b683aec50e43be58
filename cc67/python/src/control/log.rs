//! The output of a board since power-up: console lines, remarks, traps, expectations that were not met.

use cc67_host::remark;
use kmotiondef::Cycles;
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};

/// A line and its board time.
#[derive(Clone, Debug)]
pub(crate) struct LogLine {
    /// Seconds of board time since power-up.
    pub(crate) time: f64,
    /// The text, without its line end.
    pub(crate) text: String,
}

/// A fault that ends a run.
#[derive(Clone, Debug)]
pub(crate) enum Fault {
    /// A thread was stopped.
    Trap {
        /// The trap and its position in the source, in words.
        text: String,
        /// Seconds of board time.
        time: f64,
        /// The thread; `None` for the call-back.
        thread: Option<u8>,
        /// File, line and function, as far as known.
        place: Option<(String, Option<u32>, String)>,
    },
    /// An expectation of the stimulus is not met.
    Unmet {
        /// The expectation, in words.
        text: String,
    },
    /// The link to the controller is lost.
    Lost {
        /// The reason.
        text: String,
    },
}

/// The log of a board.
#[derive(Clone, Debug, Default)]
pub(crate) struct Log {
    /// Lines that programs printed.
    pub(crate) console: Vec<LogLine>,
    /// Lines of the reply to the present command.
    pub(crate) replies: Vec<String>,
    /// Remarks of the simulation.
    pub(crate) remarks: Vec<LogLine>,
    /// Characters that the serial port sent, if they are recorded.
    pub(crate) uart: Vec<u8>,
    /// Traps and expectations that were not met.
    pub(crate) faults: Vec<Fault>,
    /// Number of faults that were reported already.
    reported: usize,
}

impl Log {
    /// Takes up events; `programs` knows the places of the programs.
    pub(crate) fn take(&mut self, events: Vec<Event>, programs: impl FnOnce() -> Vec<DebugInfo>) {
        let mut programs = Some(programs);
        let mut known: Vec<DebugInfo> = Vec::new();
        for event in events {
            let time = event.at.get() as f64 / Cycles::PER_SECOND.get() as f64;
            match &event.kind {
                EventKind::ConsoleLine(line) => self.console.push(LogLine { time, text: text(line) }),
                EventKind::Reply(line) => self.replies.push(text(line)),
                EventKind::UartSent(byte) => self.uart.push(*byte),
                EventKind::Echo(_) | EventKind::Aborted | EventKind::Trace(_) | EventKind::Loaded(..) => {}
                EventKind::Unmet(what) => self.faults.push(Fault::Unmet { text: what.clone() }),
                EventKind::Trap(trap) => {
                    known = programs.take().map_or(known, |programs| programs());
                    let text = remark::describe(&event, &known).unwrap_or_default();
                    let place = known.iter().find_map(|debug| debug.place(trap.at));
                    let place =
                        place.map(|place| (place.file.to_string(), place.line, place.function.to_string()));
                    let thread = trap.thread.map(kmotiondef::ThreadId::get);
                    self.faults.push(Fault::Trap { text, time, thread, place });
                }
                // Whatever else happens is a remark, if it has words.
                _ => {
                    known = programs.take().map_or(known, |programs| programs());
                    let line = remark::describe(&event, &known).map(|text| LogLine { time, text });
                    self.remarks.extend(line);
                }
            }
        }
    }

    /// The next fault that was not reported.
    pub(crate) fn take_fault(&mut self) -> Option<Fault> {
        let fault = self.faults.get(self.reported)?.clone();
        self.reported += 1;
        Some(fault)
    }
}

fn text(line: &[u8]) -> String {
    String::from_utf8_lossy(line).into_owned()
}
