//! `--plot`: a chart of what moved, made of what was traced.
//!
//! An axis gets panels for where it was sent and where it was, its velocity, its following error and its output, as far
//! as they ever change. Bits that changed and the slices of the threads become strips. Samples are recorded when they
//! change; in between the last one holds.

use kmotiondef::{Bit, Cycles, Ticks};
use runtime::trace::{Item, Quantity};

use super::Log;
use crate::cli::plot::chart::{Chart, Line, Panel, Strip};

/// Strips in a picture; a program that moves more bits than that is looked at with `--trace`.
const STRIPS: usize = 16;

/// A jump within one sample that is so much faster than what surrounds it is no movement: the axis was given another
/// position, by `Zero` or `EnableAxisDest`.
const JUMP: f64 = 20.0;

/// Points of a line.
type Points = Vec<(f64, f64)>;

/// The chart of a run up to a tick.
pub(super) fn chart(log: &Log, title: String, every: u64, end: Ticks) -> Chart {
    let end = Cycles::new((end.get() as i64).saturating_mul(Cycles::PER_TICK.get()));
    let step = seconds(Cycles::PER_TICK) * every as f64;
    let series = Series { log, step, end: seconds(end) };
    let mut panels = Vec::new();
    for axis in 0..8 {
        panels.extend(of_axis(&series, axis));
    }
    panels.extend(of_others(&series));
    let mut strips = bits(log, seconds(end));
    strips.truncate(STRIPS);
    strips.extend(threads(log));
    Chart { title, abscissa: "time (s)".to_owned(), panels, strips, range: (0.0, seconds(end)) }
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}

/// The samples as lines.
struct Series<'a> {
    log: &'a Log,
    /// Seconds between two samples while values change.
    step: f64,
    end: f64,
}

impl Series<'_> {
    /// The values of an item; `None` if it was not sampled.
    fn of(&self, kind: &str, index: usize) -> Option<Points> {
        let is_it = |item: Item| item.kind() == kind && item.index() == index;
        let columns = self.log.columns();
        let (column, _) = columns.iter().find(|(_, quantity)| quantity.item().is_some_and(is_it))?;
        Some(self.column(*column))
    }

    /// The values at a place in the samples.
    fn column(&self, column: usize) -> Points {
        let mut points: Points = Vec::new();
        for (at, values) in &self.log.samples {
            let (time, value) = (seconds(*at), values.get(column).copied().unwrap_or_default());
            match points.last() {
                Some((last, held)) if time - last > 1.5 * self.step => {
                    let held = *held;
                    points.push((time - self.step, held));
                }
                _ => {}
            }
            points.push((time, value));
        }
        if let Some((last, held)) = points.last().copied()
            && self.end > last
        {
            points.push((self.end, held));
        }
        points
    }
}

/// The panels of an axis.
fn of_axis(series: &Series<'_>, axis: usize) -> Vec<Panel> {
    let (dest, position) = (series.of("dest", axis), series.of("pos", axis));
    let panel = |title: &str, unit: &str, lines: Vec<(&str, Points)>| Panel {
        title: format!("axis {axis}: {title}"),
        unit: unit.to_owned(),
        lines: lines
            .into_iter()
            .map(|(name, points)| Line { name: format!("{name} {axis}"), points })
            .collect(),
    };
    let mut panels = Vec::new();
    let velocity = dest.as_ref().or(position.as_ref()).map(slope);
    let error = dest.as_ref().zip(position.as_ref()).map(|(dest, position)| difference(dest, position));
    let path: Vec<_> = [("Dest", dest), ("Position", position)]
        .into_iter()
        .filter_map(|(name, p)| Some((name, p?)))
        .collect();
    if !path.is_empty() {
        let names: Vec<_> = path.iter().map(|(name, _)| *name).collect();
        panels.push(panel(&names.join(" and "), "units", path));
    }
    for (title, unit, points) in [
        ("velocity", "units/s", velocity),
        ("following error", "units", error),
        ("output", "", series.of("out", axis)),
    ] {
        let Some(points) = points.filter(changes) else { continue };
        panels.push(panel(title, unit, vec![(title, points)]));
    }
    panels
}

/// A panel for everything else, bits apart.
fn of_others(series: &Series<'_>) -> Vec<Panel> {
    let is_other = |item: Option<Item>| item.is_none_or(|item| item.axis().is_none() && item.kind() != "bit");
    let columns = series.log.columns().into_iter().filter(|(_, quantity)| is_other(quantity.item()));
    let panel = |(column, quantity): (usize, &Quantity)| {
        let (name, unit) = (quantity.to_string(), quantity.item().map_or("", Item::unit));
        let lines = vec![Line { name: name.clone(), points: series.column(column) }];
        Panel { title: name, unit: unit.to_owned(), lines }
    };
    columns.map(panel).collect()
}

fn changes(points: &Points) -> bool {
    points.windows(2).any(|pair| pair[0].1 != pair[1].1)
}

/// The change per second from point to point.
fn slope(points: &Points) -> Points {
    let mut slopes: Points = points
        .windows(2)
        .filter(|pair| pair[1].0 > pair[0].0)
        .map(|pair| (pair[1].0, (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)))
        .collect();
    for index in 0..slopes.len() {
        let before = index.checked_sub(1).and_then(|before| slopes.get(before)).map_or(0.0, |point| point.1);
        let after = slopes.get(index + 1).map_or(0.0, |point| point.1);
        let around = before.abs().max(after.abs()).max(1.0);
        if slopes[index].1.abs() > JUMP * around {
            slopes[index].1 = before;
        }
    }
    slopes
}

/// One line minus another with the same instants.
fn difference(a: &Points, b: &Points) -> Points {
    a.iter().zip(b).map(|(a, b)| (a.0, a.1 - b.1)).collect()
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
    let item = quantity.item().filter(|item| item.kind() == "bit")?;
    Bit::new(item.index() as i32)
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

    #[test]
    fn another_position_given_is_no_movement() {
        let points = [0.0, 1.0, 2.0, 1002.0, 1003.0].into_iter().enumerate();
        let slopes = slope(&points.map(|(at, value)| (at as f64, value)).collect());
        assert_eq!(slopes.iter().map(|point| point.1).collect::<Vec<_>>(), [1.0, 1.0, 1.0, 1.0]);
    }
}
