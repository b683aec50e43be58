//! Samples as a table: the time in seconds, then the items; one line for each sampled tick.
//!
//! The columns to show are known only at the end, so all columns are written first and then copied.

use std::io::{self, BufRead, Write};
use std::path::Path;

use anyhow::Result;
use kmotiondef::{Cycles, Ticks};

use super::columns::Columns;
use super::{Sink, TraceEntry};
use crate::cli::io::output::{Draft, Scratch};

/// The table being written. Samples are recorded when they change; between two samples the last value holds.
pub(super) struct Table {
    draft: Draft,
    body: Scratch,
    columns: Columns,
    every: u64,
    /// The next tick that gets a line.
    tick: u64,
    values: Option<Vec<f64>>,
}

fn instant(tick: u64) -> Cycles {
    Cycles::new((tick as i64).saturating_mul(Cycles::PER_TICK.get()))
}

impl Table {
    /// Creates the table, with a line every few ticks.
    pub(super) fn new(path: &Path, columns: Columns, every: u64) -> Result<Self> {
        let (draft, body) = (Draft::new(path)?, Scratch::beside(path)?);
        Ok(Self { draft, body, columns, every, tick: every, values: None })
    }

    /// Writes the line of the next tick.
    fn line(&mut self) -> io::Result<()> {
        if let Some(values) = &self.values {
            let seconds = instant(self.tick).get() as f64 / Cycles::PER_SECOND.get() as f64;
            write!(self.body, "{seconds:.6}")?;
            for index in 0..self.columns.all().len() {
                write!(self.body, ",{}", values.get(index).copied().unwrap_or_default())?;
            }
            writeln!(self.body)?;
        }
        self.tick += self.every;
        Ok(())
    }
}

impl Sink for Table {
    fn note(&mut self, at: Cycles, entry: &TraceEntry) -> io::Result<()> {
        let TraceEntry::Sample { values, enabled } = entry else { return Ok(()) };
        while instant(self.tick) < at {
            self.line()?;
        }
        self.columns.note(*enabled);
        self.values = Some(values.clone());
        Ok(())
    }

    fn finish(mut self: Box<Self>, end: Ticks) -> Result<()> {
        while self.tick <= end.get() {
            self.line()?;
        }
        let Self { mut draft, body, columns, .. } = *self;
        let shown: Vec<_> = columns.table_columns().collect();
        write!(draft, "time")?;
        for (_, quantity) in &shown {
            write!(draft, ",{}", field(&quantity.to_string()))?;
        }
        writeln!(draft)?;
        body.read(|lines| {
            for line in lines.lines() {
                let line = line?;
                let cells: Vec<&str> = line.split(',').collect();
                write!(draft, "{}", cells.first().unwrap_or(&""))?;
                for (index, _) in &shown {
                    write!(draft, ",{}", cells.get(index + 1).unwrap_or(&""))?;
                }
                writeln!(draft)?;
            }
            Ok(())
        })?;
        draft.commit()
    }

    fn path(&self) -> &Path {
        self.draft.path()
    }
}

/// A name as a field of the table: in quotes if it contains a comma or quotes.
fn field(name: &str) -> String {
    if name.contains([',', '"']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_sample_holds_until_the_next() {
        let text = super::super::testing::file("table.csv");
        assert_eq!(text, "time,dest0,bit46\n0.000180,0.5,1\n0.000360,0.5,1\n0.000540,2,0\n");
    }
}
