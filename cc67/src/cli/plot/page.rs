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
    spans: &'a [(f64, f64)],
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
            .map(|strip| PageStrip { name: &strip.name, spans: &strip.spans })
            .collect(),
    };
    // A `</script>` in a name must not end the data.
    let json = serde_json::to_string(&data)?.replace("</", "<\\/");
    Ok(PAGE.replacen(MARK, &json, 1).into_bytes())
}

fn page_line(line: &Line, range: (f64, f64)) -> PageLine<'_> {
    let points = line.thinned(range, POINTS / 4);
    let (t, v) = points.into_iter().unzip();
    PageLine { name: &line.name, t, v }
}
