//! `--plot`: a chart of the motion in a run, made from its trace.
//!
//! Sampled quantities become panels; bits and the slices of threads become strips.

use std::collections::BTreeMap;

use cc67_host::remark;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::trace::{Item, Quantity};
use runtime::{Remark, Speaker};

use super::log::{Interruption, Log};
use super::unit;
use crate::cli::report::plot::chart::{Chart, Link, Mark, Strip};
use crate::cli::report::plot::samples::{Column, PlottedAxis, Samples};

/// The maximum number of strips in a plot; for programs that change more bits there is `--trace`.
const STRIPS: usize = 16;

/// The chart of a run of these programs up to a tick; `axes` contains the names and units of the axes.
pub(super) fn chart(
    log: &Log,
    title: String,
    end: Ticks,
    axes: &BTreeMap<usize, PlottedAxis>,
    programs: &[DebugInfo],
) -> Chart {
    let end = Cycles::new((end.get() as i64).saturating_mul(Cycles::PER_TICK.get()));
    let columns = log.columns(|axis| axes.get(&axis).is_none_or(|known| known.is_measured));
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
        step: seconds(log.step),
        end: seconds(end),
        axes: axes.clone(),
    };
    let panels = samples.panels();
    let mut strips = bits(log, end);
    strips.truncate(STRIPS);
    // The slices of threads are shown in addition to the motion; alone they are not a plot of a motion.
    let mut links = Vec::new();
    if !(panels.is_empty() && strips.is_empty() && log.races.is_empty()) {
        let first = strips.len();
        let (ran, ran_strips): (Vec<_>, Vec<_>) = threads(log, programs).into_iter().unzip();
        strips.extend(ran_strips);
        let index = |thread: ThreadId| Some(first + ran.iter().position(|other| *other == thread)?);
        links.extend(log.races.iter().filter_map(|(at, remark)| link(*at, remark, programs, index)));
    }
    let chart = Chart {
        title,
        abscissa: "time (s)".to_owned(),
        panels,
        strips,
        links,
        range: (0.0, seconds(end)),
        ..Chart::default()
    };
    in_readable_units(chart)
}

/// Converts a chart of a very short run to milliseconds or microseconds, so that its times have few digits.
fn in_readable_units(mut chart: Chart) -> Chart {
    let (factor, unit) = match chart.range.1 {
        end if end < 1e-3 => (1e6, "µs"),
        end if end < 0.1 => (1e3, "ms"),
        _ => return chart,
    };
    chart.abscissa = format!("time ({unit})");
    chart.range.1 *= factor;
    let lines = chart.panels.iter_mut().flat_map(|panel| &mut panel.lines);
    lines.flat_map(|line| &mut line.points).for_each(|(time, _)| *time *= factor);
    let spans = chart.strips.iter_mut().flat_map(|strip| &mut strip.spans);
    spans.for_each(|(from, to)| (*from, *to) = (*from * factor, *to * factor));
    chart.strips.iter_mut().flat_map(|strip| &mut strip.marks).for_each(|mark| mark.at *= factor);
    chart.links.iter_mut().for_each(|link| link.at *= factor);
    chart
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}

/// The intervals in which each bit was high: the watched bits, or otherwise those that changed.
fn bits(log: &Log, end: Cycles) -> Vec<Strip> {
    let columns = log.columns(|_| true);
    let watched: Vec<(usize, Bit)> =
        columns.iter().filter_map(|(column, quantity)| Some((*column, bit(quantity)?))).collect();
    if watched.is_empty() {
        return log.changed_bits().map(|bit| strip(format!("bit {bit}"), log.spans_of(bit, end))).collect();
    }
    let first = |column: usize| {
        log.samples.first().and_then(|(_, values)| values.get(column)).is_some_and(|value| *value != 0.0)
    };
    let spans = |column, bit| match log.has_changed(bit) {
        true => log.spans_of(bit, end),
        false => first(column).then_some((Cycles::default(), end)).into_iter().collect(),
    };
    watched.into_iter().map(|(column, bit)| strip(format!("bit {bit}"), spans(column, bit))).collect()
}

fn bit(quantity: &Quantity) -> Option<Bit> {
    quantity.item().and_then(Item::bit)
}

fn strip(name: String, spans: impl IntoIterator<Item = (Cycles, Cycles)>) -> Strip {
    let spans = spans.into_iter().map(|(from, to)| (seconds(from), seconds(to))).collect();
    Strip { name, spans, marks: Vec::new() }
}

/// The intervals in which each thread had the processor, with marks for slices that ended within a statement.
fn threads(log: &Log, programs: &[DebugInfo]) -> Vec<(ThreadId, Strip)> {
    let strip = |thread| {
        let interruptions = log.interruptions.iter().filter(|interruption| interruption.thread == thread);
        let marks = interruptions.filter_map(|interruption| split(interruption, programs)).collect();
        (thread, Strip { marks, ..strip(format!("thread {thread}"), log.threads.of(thread)) })
    };
    ThreadId::all().map(strip).filter(|(_, strip)| !strip.spans.is_empty()).collect()
}

/// The mark for a slice that ended within a statement.
fn split(interruption: &Interruption, programs: &[DebugInfo]) -> Option<Mark> {
    let place = programs.iter().find_map(|debug| debug.statement_around(interruption.before))?;
    let text = format!("interrupted inside the statement at {}:{}", place.file, place.line?);
    Some(Mark { at: seconds(interruption.at), text })
}

/// The link between the strips of the two threads in a remark.
fn link(
    at: Cycles,
    about: &Remark,
    programs: &[DebugInfo],
    strip: impl Fn(ThreadId) -> Option<usize>,
) -> Option<Link> {
    let Speaker::Thread(one) = about.speaker else { return None };
    let other = about.other_thread()?.thread?;
    Some(Link {
        at: seconds(at),
        strips: [strip(one)?, strip(other)?],
        text: remark::remark_text(about, programs),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_holds_between_its_samples() {
        let log = super::super::testing::log();
        let chart = chart(&log, String::new(), Ticks::new(7), &BTreeMap::new(), &[]);
        let lines: Vec<_> = chart.panels.iter().flat_map(|panel| &panel.lines).collect();
        assert_eq!(lines[0].name, "Dest 0");
        assert_eq!(chart.abscissa, "time (µs)");
        let times: Vec<_> = lines[0].points.iter().map(|point| point.0.round() as i64).collect();
        assert_eq!(times, [180, 360, 540, 630]);
        let values: Vec<_> = lines[0].points.iter().map(|point| point.1).collect();
        assert_eq!(values, [0.5, 0.5, 2.0, 2.0]);
        assert_eq!(chart.strips[0].name, "bit 46");
        assert_eq!(chart.strips[0].spans.len(), 1);
        assert_eq!(chart.strips[1].name, "thread 1");
    }
}
