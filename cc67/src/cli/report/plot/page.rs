//! A chart as one self-contained page for a browser, with zoom and cursor; it needs no network.

use anyhow::Result;
use serde::Serialize;

use super::chart::{Chart, Line, Scale};
use super::draw::COLORS;

/// The page, with a placeholder for the data.
const PAGE: &str = include_str!("page.html");
const MARK: &str = "@DATA@";

/// The maximum number of points of all lines, and of spans of all strips; larger numbers are thinned, so that a page
/// has at most 2 MB and opens quickly.
const POINTS: usize = 60_000;
const SPANS: usize = 20_000;
/// The maximum number of marks on a strip.
const MARKS: usize = 1_000;

#[derive(Serialize)]
struct PageData<'a> {
    title: &'a str,
    abscissa: &'a str,
    range: (f64, f64),
    /// True if positions on the horizontal axis are logarithms.
    #[serde(rename = "isLogarithmic")]
    is_logarithmic: bool,
    colors: Vec<String>,
    panels: Vec<PagePanel<'a>>,
    strips: Vec<PageStrip<'a>>,
    links: Vec<PageLink<'a>>,
}

#[derive(Serialize)]
struct PagePanel<'a> {
    title: &'a str,
    unit: &'a str,
    lines: Vec<PageLine<'a>>,
}

/// Times and values as separate lists, which take less space.
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
    marks: Vec<(f64, &'a str)>,
}

#[derive(Serialize)]
struct PageLink<'a> {
    at: f64,
    strips: [usize; 2],
    text: &'a str,
}

/// The page for a chart.
pub(super) fn html(chart: &Chart) -> Result<Vec<u8>> {
    let lines: usize = chart.panels.iter().map(|panel| panel.lines.len()).sum();
    let (points, spans) = (POINTS / lines.max(1), SPANS / chart.strips.len().max(1));
    let data = PageData {
        title: &chart.title,
        abscissa: &chart.abscissa,
        range: chart.range,
        is_logarithmic: chart.scale == Scale::Logarithmic,
        colors: COLORS.iter().map(|(red, green, blue)| format!("#{red:02x}{green:02x}{blue:02x}")).collect(),
        panels: chart
            .panels
            .iter()
            .map(|panel| PagePanel {
                title: &panel.title,
                unit: &panel.unit,
                lines: panel.lines.iter().map(|line| page_line(line, chart.range, points)).collect(),
            })
            .collect(),
        strips: chart
            .strips
            .iter()
            .map(|strip| PageStrip {
                name: &strip.name,
                spans: limit_spans(merge_spans(&strip.spans), chart.range, spans),
                marks: strip
                    .marks
                    .iter()
                    .take(MARKS)
                    .map(|mark| (round_to_nine_digits(mark.at), mark.text.as_str()))
                    .collect(),
            })
            .collect(),
        links: chart
            .links
            .iter()
            .map(|link| PageLink { at: round_to_nine_digits(link.at), strips: link.strips, text: &link.text })
            .collect(),
    };
    // A `</script>` in a name must not end the data.
    let json = serde_json::to_string(&data)?.replace("</", "<\\/");
    Ok(PAGE.replacen(MARK, &json, 1).into_bytes())
}

fn page_line(line: &Line, range: (f64, f64), most: usize) -> PageLine<'_> {
    // First the points without influence on the look of a line are removed, and only the rest is thinned.
    let line_of_corners = Line { name: String::new(), points: drop_redundant_points(line.points.clone()) };
    let points = line_of_corners.thinned(range, most / 4);
    let (t, v) = points
        .into_iter()
        .map(|(time, value)| (round_to_nine_digits(time), round_to_nine_digits(value)))
        .unzip();
    PageLine { name: &line.name, t, v }
}

/// The points except those within an interval of constant value, which do not change the line.
fn drop_redundant_points(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
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

/// Merges spans that touch.
fn merge_spans(spans: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (from, to) in spans {
        let (from, to) = (round_to_nine_digits(*from), round_to_nine_digits(*to));
        match joined.last_mut() {
            Some((_, end)) if *end == from => *end = to,
            _ => joined.push((from, to)),
        }
    }
    joined
}

/// At most about `most` spans: those that are too close to be distinguished are merged.
fn limit_spans(spans: Vec<(f64, f64)>, range: (f64, f64), most: usize) -> Vec<(f64, f64)> {
    if spans.len() <= most {
        return spans;
    }
    let gap = (range.1 - range.0) / most as f64;
    let mut bounded: Vec<(f64, f64)> = Vec::new();
    for (from, to) in spans {
        match bounded.last_mut() {
            Some((_, end)) if from - *end < gap => *end = to,
            _ => bounded.push((from, to)),
        }
    }
    bounded
}

/// Rounds a number to nine digits, more than a page can show; all digits would double its size.
fn round_to_nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_its_corners() {
        let points = [1.0, 1.0, 1.0, 2.0, 2.0, 3.0].into_iter().enumerate();
        let kept = drop_redundant_points(points.map(|(time, value)| (time as f64, value)).collect());
        assert_eq!(kept, [(0.0, 1.0), (2.0, 1.0), (3.0, 2.0), (4.0, 2.0), (5.0, 3.0)]);
    }

    #[test]
    fn a_page_is_bounded_whatever_it_shows() {
        let points =
            |seed: usize| (0..400_000).map(move |at| (at as f64 * 90e-6, ((at * seed) % 1009) as f64 / 7.0));
        let line = |seed| Line { name: format!("line {seed}"), points: points(seed).collect() };
        let panel = |seed| super::super::chart::Panel {
            title: "a".to_owned(),
            unit: String::new(),
            lines: vec![line(seed), line(seed + 1)],
        };
        let spans = (0..300_000).map(|at| (at as f64 * 120e-6, at as f64 * 120e-6 + 60e-6)).collect();
        let chart = Chart {
            panels: (1..12).map(panel).collect(),
            strips: vec![super::super::chart::Strip { name: "bit 46".to_owned(), spans, marks: Vec::new() }],
            range: (0.0, 36.0),
            ..Chart::default()
        };
        let page = html(&chart).expect("it is written");
        assert!((1_000_000..2_000_000).contains(&page.len()), "{}", page.len());
    }

    #[test]
    fn touching_spans_are_joined() {
        assert_eq!(merge_spans(&[(0.0, 1.0), (1.0, 2.0), (3.0, 4.0)]), [(0.0, 2.0), (3.0, 4.0)]);
    }

    #[test]
    fn numbers_have_no_more_digits_than_needed() {
        assert_eq!(
            [round_to_nine_digits(1.0 / 3.0), round_to_nine_digits(-1234.5), round_to_nine_digits(0.0)],
            [0.333_333_333, -1234.5, 0.0]
        );
    }
}
