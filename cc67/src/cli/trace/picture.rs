//! `--plot`: a chart of what moved, made of what was traced.
//!
//! What was sampled becomes panels; bits and the slices of the threads become strips.

use kmotiondef::{Bit, Cycles, Ticks};
use runtime::trace::{Item, Quantity};

use super::log::Log;
use super::unit;
use crate::cli::plot::chart::{Chart, Strip};
use crate::cli::plot::samples::{Column, Samples};

/// Strips in a picture; a program that moves more bits than that is looked at with `--trace`.
const STRIPS: usize = 16;

/// The chart of a run up to a tick.
pub(super) fn chart(log: &Log, title: String, every: u64, end: Ticks) -> Chart {
    let end = Cycles::new((end.get() as i64).saturating_mul(Cycles::PER_TICK.get()));
    let columns = log.columns();
    let column = |(_, quantity): &(usize, &Quantity)| Column {
        name: quantity.to_string(),
        unit: unit::of(quantity).to_owned(),
    };
    let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or_default();
    let row = |(at, values): &(Cycles, Vec<f64>)| {
        (seconds(*at), columns.iter().map(|(index, _)| value(values, *index)).collect())
    };
    let samples = Samples {
        columns: columns.iter().map(column).collect(),
        rows: log.samples.iter().map(row).collect(),
        step: seconds(Cycles::PER_TICK) * every as f64,
        end: seconds(end),
    };
    let panels = samples.panels();
    let mut strips = bits(log, seconds(end));
    strips.truncate(STRIPS);
    strips.extend(threads(log));
    Chart { title, abscissa: "time (s)".to_owned(), panels, strips, range: (0.0, seconds(end)) }
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}

/// When each bit was high: those that are watched, else those that changed.
fn bits(log: &Log, end: f64) -> Vec<Strip> {
    let columns = log.columns();
    let watched: Vec<(usize, Bit)> =
        columns.iter().filter_map(|(column, quantity)| Some((*column, bit(quantity)?))).collect();
    let changed = log.bits();
    if watched.is_empty() {
        return changed.into_iter().map(|(bit, before)| strip(log, bit, before, end)).collect();
    }
    let first = |column: usize| {
        log.samples.first().and_then(|(_, values)| values.get(column)).is_some_and(|value| *value != 0.0)
    };
    let before = |column, bit| {
        changed.iter().find(|(other, _)| *other == bit).map_or_else(|| first(column), |(_, before)| *before)
    };
    watched.into_iter().map(|(column, bit)| strip(log, bit, before(column, bit), end)).collect()
}

fn bit(quantity: &Quantity) -> Option<Bit> {
    quantity.item().and_then(Item::bit)
}

/// When a bit was high that had a level before all changes.
fn strip(log: &Log, bit: Bit, before: bool, end: f64) -> Strip {
    let mut spans = Vec::new();
    let mut high_since = before.then_some(0.0);
    for change in log.changes.iter().filter(|change| change.bit == bit) {
        match (high_since, change.level) {
            (None, true) => high_since = Some(seconds(change.at)),
            (Some(since), false) => {
                spans.push((since, seconds(change.at)));
                high_since = None;
            }
            _ => {}
        }
    }
    spans.extend(high_since.map(|since| (since, end)));
    Strip { name: format!("bit {bit}"), spans }
}

/// When each thread had the processor.
fn threads(log: &Log) -> Vec<Strip> {
    let strip = |thread| {
        let slices = log.slices.iter().filter(|(other, _, _)| *other == thread);
        let spans: Vec<_> = slices.map(|(_, from, to)| (seconds(*from), seconds(*to))).collect();
        Strip { name: format!("thread {thread}"), spans }
    };
    kmotiondef::ThreadId::all().map(strip).filter(|strip| !strip.spans.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_holds_between_its_samples() {
        let log = super::super::testing::log();
        let chart = chart(&log, String::new(), 2, Ticks::new(7));
        let lines: Vec<_> = chart.panels.iter().flat_map(|panel| &panel.lines).collect();
        assert_eq!(lines[0].name, "Dest 0");
        let times: Vec<_> = lines[0].points.iter().map(|point| (point.0 * 1e6).round() as i64).collect();
        assert_eq!(times, [180, 360, 540, 630]);
        let values: Vec<_> = lines[0].points.iter().map(|point| point.1).collect();
        assert_eq!(values, [0.5, 0.5, 2.0, 2.0]);
        assert_eq!(chart.strips[0].name, "bit 46");
        assert_eq!(chart.strips[0].spans.len(), 1);
        assert_eq!(chart.strips[1].name, "thread 1");
    }
}
