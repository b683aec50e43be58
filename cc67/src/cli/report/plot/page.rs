//! A chart as one page for a browser, with zoom and cursor; it needs nothing else, no network either.

use anyhow::Result;
use serde::Serialize;

use super::chart::{Chart, Line};
use super::draw::COLORS;

/// The page, with a mark where the data goes.
const PAGE: &str = include_str!("page.html");
const MARK: &str = "@DATA@";

/// Most points of a line; more are thinned so that a page stays quick to open.
const POINTS: usize = 100_000;

#[derive(Serialize)]
struct PageData<'a> {
    title: &'a str,
    abscissa: &'a str,
    range: (f64, f64),
    colors: Vec<String>,
    panels: Vec<PagePanel<'a>>,
    strips: Vec<PageStrip<'a>>,
}

#[derive(Serialize)]
struct PagePanel<'a> {
    title: &'a str,
    unit: &'a str,
    lines: Vec<PageLine<'a>>,
}

/// Times and values as two lists, which browsers keep small.
#[derive(Serialize)]
struct PageLine<'a> {
    name: &'a str,
    t: Vec<f64>,
    v: Vec<f64>,
}

#[derive(Serialize)]
struct PageStrip<'a> {
    name: &'a str,
    spans: Vec<(f64, f64)>,
}

/// The page of a chart.
pub(super) fn html(chart: &Chart) -> Result<Vec<u8>> {
    let data = PageData {
        title: &chart.title,
        abscissa: &chart.abscissa,
        range: chart.range,
        colors: COLORS.iter().map(|(red, green, blue)| format!("#{red:02x}{green:02x}{blue:02x}")).collect(),
        panels: chart
            .panels
            .iter()
            .map(|panel| PagePanel {
                title: &panel.title,
                unit: &panel.unit,
                lines: panel.lines.iter().map(|line| page_line(line, chart.range)).collect(),
            })
            .collect(),
        strips: chart
            .strips
            .iter()
            .map(|strip| PageStrip { name: &strip.name, spans: joined(&strip.spans) })
            .collect(),
    };
    // A `</script>` in a name must not end the data.
    let json = serde_json::to_string(&data)?.replace("</", "<\\/");
    Ok(PAGE.replacen(MARK, &json, 1).into_bytes())
}

fn page_line(line: &Line, range: (f64, f64)) -> PageLine<'_> {
    let points = corners(line.thinned(range, POINTS / 4));
    let (t, v) = points.into_iter().map(|(time, value)| (short(time), short(value))).unzip();
    PageLine { name: &line.name, t, v }
}

/// The points without those within a stretch where the value stays the same: the line is the same without them.
fn corners(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if let [.., before, last] = kept.as_mut_slice()
            && before.1 == last.1
            && last.1 == point.1
        {
            *last = point;
        } else {
            kept.push(point);
        }
    }
    kept
}

/// The spans, those that touch as one.
fn joined(spans: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (from, to) in spans {
        let (from, to) = (short(*from), short(*to));
        match joined.last_mut() {
            Some((_, end)) if *end == from => *end = to,
            _ => joined.push((from, to)),
        }
    }
    joined
}

/// The number with nine digits, which is more than a page can show; all of them would double its size.
fn short(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_its_corners() {
        let points = [1.0, 1.0, 1.0, 2.0, 2.0, 3.0].into_iter().enumerate();
        let kept = corners(points.map(|(time, value)| (time as f64, value)).collect());
        assert_eq!(kept, [(0.0, 1.0), (2.0, 1.0), (3.0, 2.0), (4.0, 2.0), (5.0, 3.0)]);
    }

    #[test]
    fn touching_spans_are_joined() {
        assert_eq!(joined(&[(0.0, 1.0), (1.0, 2.0), (3.0, 4.0)]), [(0.0, 2.0), (3.0, 4.0)]);
    }

    #[test]
    fn numbers_have_no_more_digits_than_needed() {
        assert_eq!([short(1.0 / 3.0), short(-1234.5), short(0.0)], [0.333_333_333, -1234.5, 0.0]);
    }
}
