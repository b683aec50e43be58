//! A trace as a value change dump: bits and threads as wires, items as real numbers, the console as a string.
//!
//! The head contains all variables and their initial values, which are known only at the end: so the changes are
//! written first and then copied after it. Numbers have their first sampled value from the beginning. The unit of time
//! is the nanosecond.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use anyhow::Result;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::trace::{Item, Quantity};

use super::columns::Columns;
use super::{Sink, TraceEntry, nanoseconds};
use crate::cli::io::output::{Draft, Scratch};

/// The signal of a variable; the head lists them in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Signal {
    Bit(Bit),
    Thread(ThreadId),
    /// An item, by its index in a sample.
    Item(usize),
    Console,
}

/// A variable: its identifier, and its initial value.
#[derive(Debug)]
struct Variable {
    id: String,
    start: String,
}

/// The dump being written.
pub(super) struct Dump {
    draft: Draft,
    body: Scratch,
    columns: Columns,
    variables: BTreeMap<Signal, Variable>,
    /// The time of the last changes written, in nanoseconds.
    now: i64,
    /// The thread that has the processor, and the end of its slice.
    slice: Option<(ThreadId, Cycles)>,
    /// The last values written for items, by their indices in a sample.
    shown: BTreeMap<usize, f64>,
}

impl Dump {
    /// Creates the dump.
    pub(super) fn new(path: &Path, columns: Columns) -> Result<Self> {
        let (draft, body) = (Draft::new(path)?, Scratch::beside(path)?);
        let (variables, shown) = (BTreeMap::new(), BTreeMap::new());
        let mut dump = Self { draft, body, columns, variables, now: 0, slice: None, shown };
        dump.declare(Signal::Console, "s\\x20 ");
        Ok(dump)
    }

    /// Declares a signal with its initial value, and returns its identifier.
    fn declare(&mut self, signal: Signal, start: &str) -> String {
        let number = self.variables.len() as u32;
        let variable = self.variables.entry(signal);
        variable.or_insert_with(|| Variable { id: id(number), start: start.to_owned() }).id.clone()
    }

    /// Writes a change, after the ends of slices that are over by then.
    fn change(&mut self, at: Cycles, value: &str, id: &str) -> io::Result<()> {
        self.end_slice(at)?;
        self.write(at, value, id)
    }

    fn write(&mut self, at: Cycles, value: &str, id: &str) -> io::Result<()> {
        let at = nanoseconds(at);
        if at != self.now {
            self.now = at;
            writeln!(self.body, "#{at}")?;
        }
        writeln!(self.body, "{value}{id}")
    }

    /// Ends the slice that is over at a given time.
    fn end_slice(&mut self, now: Cycles) -> io::Result<()> {
        let Some((thread, end)) = self.slice.take_if(|(_, end)| *end <= now) else { return Ok(()) };
        let id = self.declare(Signal::Thread(thread), "0");
        self.write(end, "0", &id)
    }

    /// Writes the items whose values have changed.
    fn sample(&mut self, at: Cycles, values: &[f64]) -> io::Result<()> {
        let columns: Vec<(usize, Option<Bit>)> = self
            .columns
            .table_columns()
            .map(|(index, quantity)| (index, quantity.item().and_then(Item::bit)))
            .collect();
        for (index, bit) in columns {
            // Readers differ in their notation for NaN and infinity.
            let value = values.get(index).copied().filter(|value| value.is_finite()).unwrap_or_default();
            // A bit is a wire, whose changes are recorded separately.
            if let Some(bit) = bit {
                self.declare(Signal::Bit(bit), if value == 0.0 { "0" } else { "1" });
                continue;
            }
            let id = self.declare(Signal::Item(index), &format!("r{value} "));
            if self.shown.insert(index, value).is_some_and(|before| before != value) {
                self.change(at, &format!("r{value} "), &id)?;
            }
        }
        Ok(())
    }

    /// The head: all variables, and their initial values.
    fn head(&self) -> String {
        let mut text = "$version cc67 $end\n$timescale 1 ns $end\n$scope module board $end\n".to_owned();
        for (signal, Variable { id, .. }) in &self.variables {
            let (kind, name) = match signal {
                Signal::Bit(bit) => ("wire 1", format!("bit{bit}")),
                Signal::Thread(thread) => ("wire 1", format!("thread{thread}")),
                Signal::Item(index) => {
                    let name = self.columns.all().get(*index).map_or(String::new(), Quantity::to_string);
                    // A name must not contain blanks.
                    ("real 64", name.split_whitespace().collect())
                }
                Signal::Console => ("string 1", "console".to_owned()),
            };
            let _ = writeln!(text, "$var {kind} {id} {name} $end");
        }
        text.push_str("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
        for Variable { id, start } in self.variables.values() {
            let _ = writeln!(text, "{start}{id}");
        }
        text.push_str("$end\n");
        text
    }
}

impl Sink for Dump {
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()> {
        match entry {
            TraceEntry::Bit { bit, level, .. } => {
                let id = self.declare(Signal::Bit(*bit), if *level { "0" } else { "1" });
                self.change(at, if *level { "1" } else { "0" }, &id)
            }
            TraceEntry::Slice { thread, end, .. } => {
                let id = self.declare(Signal::Thread(*thread), "0");
                self.change(at, "1", &id)?;
                self.slice = Some((*thread, *end));
                Ok(())
            }
            TraceEntry::Sample { values, enabled } => {
                self.columns.note(*enabled);
                self.sample(at, values)
            }
            TraceEntry::Line(line) => {
                let id = self.declare(Signal::Console, "");
                self.change(at, &format!("s{} ", escape(line)), &id)
            }
            TraceEntry::Sent(_) | TraceEntry::Packet { .. } | TraceEntry::Race(_) => Ok(()),
        }
    }

    fn finish(mut self: Box<Self>, _: Ticks) -> Result<()> {
        if let Some((_, end)) = self.slice {
            self.end_slice(end)?;
        }
        let head = self.head();
        let Self { mut draft, body, .. } = *self;
        draft.write_all(head.as_bytes())?;
        body.read(|mut changes| io::copy(&mut changes, &mut draft).map(|_| ()))?;
        draft.commit()
    }

    fn path(&self) -> &Path {
        self.draft.path()
    }
}

/// A short identifier for the variable with a number; only letters, as some readers take other characters for commands.
fn id(mut number: u32) -> String {
    const LETTERS: u32 = 26;
    let mut id = String::new();
    loop {
        id.extend(char::from_u32(u32::from(b'a') + number % LETTERS));
        number /= LETTERS;
        if number == 0 {
            return id;
        }
    }
}

/// Escapes a string value: spaces and non-printable characters are written in the notation of viewers, and an empty
/// string is replaced.
fn escape(line: &str) -> String {
    let line = if line.is_empty() { " " } else { line };
    line.bytes().fold(String::new(), |mut text, byte| {
        if byte.is_ascii_graphic() && byte != b'\\' {
            text.push(char::from(byte));
        } else {
            let _ = write!(text, "\\x{byte:02x}");
        }
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dump_contains_the_changes_of_a_run() {
        insta::assert_snapshot!(super::super::testing::file("run.vcd"), @r#"
        $version cc67 $end
        $timescale 1 ns $end
        $scope module board $end
        $var wire 1 c bit46 $end
        $var wire 1 d thread1 $end
        $var real 64 b dest0 $end
        $var string 1 a console $end
        $upscope $end
        $enddefinitions $end
        #0
        $dumpvars
        1c
        0d
        r0.5 b
        s\x20 a
        $end
        #205000
        1d
        #215000
        0c
        #230000
        0d
        #450000
        sa\x20"b" a
        #540000
        r2 b
        "#);
    }

    #[test]
    fn ids_are_short_and_differ() {
        assert_eq!([id(0), id(25), id(26)], ["a", "z", "ab"]);
    }
}
