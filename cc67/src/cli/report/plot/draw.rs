//! Draws a chart as a picture; the same code is used for SVG and PNG.

use std::fmt::Write as _;

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::chart::{Chart, Line, Panel, Scale, Strip};
use super::letters::{self, Pixels};

/// Width of the picture in pixels.
const WIDTH: u32 = 1000;
/// Heights in pixels.
const TITLE: u32 = 54;
const PANEL: u32 = 190;
const STRIP: u32 = 26;
const FOOT: u32 = 48;
/// The minimum distance between marks on a strip, in pixels.
const MARK_GAP: i32 = 3;
/// Room for the numbers to the left of the panels.
const LEFT: u32 = 90;
const RIGHT: u32 = 24;
/// The height of a panel's heading with its legend.
const HEADING: u32 = 26;

/// Colours that can be distinguished by people with red-green blindness (Okabe and Ito).
pub(super) const COLORS: [(u8, u8, u8); 7] = [
    (0, 114, 178),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (230, 159, 0),
    (86, 180, 233),
    (90, 90, 90),
];

/// The chart as an SVG picture.
pub(super) fn svg(chart: &Chart) -> Result<Vec<u8>> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, (WIDTH, height(chart))).into_drawing_area();
    draw(chart, &area, Curves::LeftOut)?;
    drop(area);
    let end = text.rfind("</svg>").unwrap_or(text.len());
    text.insert_str(end, &curves(chart));
    Ok(text.into_bytes())
}

/// The way of drawing the lines of the panels.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Curves {
    /// By the common code, at whole pixels.
    Drawn,
    /// Not at all: another function draws them.
    LeftOut,
}

/// The lines of all panels, with a precision of a hundredth of a pixel.
fn curves(chart: &Chart) -> String {
    let mut text = String::new();
    for (panel, top) in chart.panels.iter().zip((TITLE..).step_by(PANEL as usize)) {
        for (index, line) in panel.lines.iter().enumerate() {
            let points = points(chart, panel, line);
            let width = thickness(&points);
            let (red, green, blue) = COLORS[index % COLORS.len()];
            let places: Vec<String> = points
                .iter()
                .map(|(x, y)| format!("{},{}", round_coordinate(*x), round_coordinate(y + f64::from(top))))
                .collect();
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "<polyline fill=\"none\" opacity=\"1\" stroke=\"#{red:02X}{green:02X}{blue:02X}\" stroke-width=\"{width}\" points=\"{}\"/>",
                places.join(" ")
            );
        }
    }
    text
}

/// Rounds a coordinate to a hundredth of a pixel.
fn round_coordinate(value: f64) -> f64 {
    libm::round(value * 100.0) / 100.0
}

/// The points of a line, in pixels of its panel.
fn points(chart: &Chart, panel: &Panel, line: &Line) -> Vec<(f64, f64)> {
    let (low, high) = panel.range();
    let (top, bottom) = (f64::from(HEADING), f64::from(PANEL) - 12.0);
    let up = |value: f64| bottom - (value - low) / (high - low) * (bottom - top);
    let shown = line.thinned(chart.range, (WIDTH - LEFT - RIGHT) as usize).into_iter();
    let shown = shown.filter(|(_, value)| value.is_finite());
    without_flat(shown.map(|(time, value)| (place(chart, time), up(value))).collect())
}

/// The maximum number of reversals within a pixel for a line that is drawn thick: some jolts cause few, noise causes
/// many.
const TURNS: usize = 40;

/// Returns the thickness of a line: a thick line has a spike at each reversal within a pixel, which noise has
/// everywhere.
fn thickness(points: &[(f64, f64)]) -> u32 {
    let turns = points.windows(3).filter(|three| {
        let (before, after) = (three[1].1 - three[0].1, three[2].1 - three[1].1);
        before * after < 0.0 && before.abs().min(after.abs()) > 1.0 && three[2].0 - three[0].0 < 2.0
    });
    if turns.count() > TURNS { 1 } else { 2 }
}

/// The chart as a PNG picture.
pub(super) fn png(chart: &Chart) -> Result<Vec<u8>> {
    let (width, height) = (WIDTH, height(chart));
    let mut pixels = vec![255; (width * height * 3) as usize];
    draw(
        chart,
        &Pixels(BitMapBackend::with_buffer(&mut pixels, (width, height))).into_drawing_area(),
        Curves::Drawn,
    )?;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(file)
}

fn height(chart: &Chart) -> u32 {
    let (panels, strips) = (chart.panels.len() as u32, chart.strips.len() as u32);
    TITLE + PANEL * panels + STRIP * strips + FOOT
}

type Area<B> = DrawingArea<B, Shift>;

fn draw<B: DrawingBackend>(chart: &Chart, area: &Area<B>, curves: Curves) -> Result<()> {
    letters::register();
    let drawn = (|| -> Result<(), String> {
        area.fill(&WHITE).map_err(text_of)?;
        let (title, mut rest) = area.split_vertically(TITLE);
        write(&title, &chart.title, (LEFT as i32, 8), 18, &BLACK)?;
        draw_marks(chart, &title, TITLE as i32 - 16)?;
        for panel in &chart.panels {
            let (part, below) = rest.split_vertically(PANEL);
            draw_panel(chart, panel, &part, curves)?;
            rest = below;
        }
        for (index, strip) in chart.strips.iter().enumerate() {
            let (part, below) = rest.split_vertically(STRIP);
            draw_strip(chart, strip, index, &part)?;
            rest = below;
        }
        draw_links(chart, area)?;
        draw_foot(chart, &rest)?;
        area.present().map_err(text_of)
    })();
    drawn.map_err(|error| anyhow!("cannot draw: {error}"))
}

fn text_of(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn color(index: usize) -> RGBColor {
    let (red, green, blue) = COLORS[index % COLORS.len()];
    RGBColor(red, green, blue)
}

fn write<B: DrawingBackend>(
    area: &Area<B>,
    text: &str,
    at: (i32, i32),
    size: i32,
    color: &RGBColor,
) -> Result<(), String> {
    let style = ("sans-serif", size).into_font().color(color);
    area.draw_text(text, &style, at).map_err(text_of)
}

/// The times at which the picture has vertical lines.
fn marks(chart: &Chart) -> Vec<f64> {
    match chart.scale {
        Scale::Linear => steps(chart.range, 10),
        Scale::Logarithmic => log_ticks(chart.range),
    }
}

/// The logarithms of 1, 2 and 5 in each decade of a range of logarithms.
fn log_ticks((low, high): (f64, f64)) -> Vec<f64> {
    let decades = libm::floor(low) as i32..=libm::ceil(high) as i32;
    let marks = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|part| f64::from(decade) + libm::log10(part)));
    marks.filter(|mark| (low - 1e-9..=high + 1e-9).contains(mark)).collect()
}

/// About `count` round numbers in a range.
fn steps((low, high): (f64, f64), count: u32) -> Vec<f64> {
    let rough = (high - low) / f64::from(count);
    if !(rough.is_finite() && rough > 0.0) {
        return vec![low];
    }
    let decade = libm::pow(10.0, libm::floor(libm::log10(rough)));
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * decade);
    let (first, last) = (libm::ceil(low / step) as i64, libm::floor(high / step + 1e-9) as i64);
    (first..=last).map(|index| index as f64 * step).collect()
}

/// Formats a number without insignificant digits.
pub(super) fn number(value: f64) -> String {
    // A remainder of a step that should be 0.
    let value = if value.abs() < 1e-12 { 0.0 } else { value };
    if value != 0.0 && !(1e-4..1e7).contains(&value.abs()) {
        return format!("{value:e}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the horizontal position of a time.
fn x_of_time(chart: &Chart, time: f64) -> i32 {
    place(chart, time) as i32
}

/// The horizontal position, as a fraction of pixels.
fn place(chart: &Chart, time: f64) -> f64 {
    let (low, high) = chart.range;
    let width = f64::from(WIDTH - LEFT - RIGHT);
    let part = if high > low { (time - low) / (high - low) } else { 0.0 };
    f64::from(LEFT) + part.clamp(0.0, 1.0) * width
}

fn draw_panel<B: DrawingBackend>(
    chart: &Chart,
    panel: &Panel,
    area: &Area<B>,
    curves: Curves,
) -> Result<(), String> {
    let (low, high) = panel.range();
    let (top, bottom) = (HEADING as i32, PANEL as i32 - 12);
    let up = |value: f64| bottom - ((value - low) / (high - low) * f64::from(bottom - top)) as i32;
    let left = LEFT as i32;
    let right = (WIDTH - RIGHT) as i32;
    let faint = RGBColor(225, 225, 225);
    let gray = RGBColor(70, 70, 70);
    let beside = Pos::new(HPos::Right, VPos::Center);
    let style = ("sans-serif", 13).into_font().color(&gray).pos(beside);
    let line = |from: (i32, i32), to: (i32, i32), color: RGBColor| {
        area.draw(&PathElement::new(vec![from, to], color)).map_err(text_of)
    };
    for time in marks(chart) {
        line((x_of_time(chart, time), top), (x_of_time(chart, time), bottom), faint)?;
    }
    for value in steps((low, high), 5) {
        line((left, up(value)), (right, up(value)), faint)?;
        area.draw_text(&number(value), &style, (left - 10, up(value))).map_err(text_of)?;
    }
    area.draw(&Rectangle::new([(left, top), (right, bottom)], RGBColor(150, 150, 150))).map_err(text_of)?;
    heading(panel, area)?;
    if curves == Curves::LeftOut {
        return Ok(());
    }
    for (index, shown) in panel.lines.iter().enumerate() {
        let points = points(chart, panel, shown);
        let width = thickness(&points);
        let points: Vec<(i32, i32)> = points.into_iter().map(|(x, y)| (x as i32, y as i32)).collect();
        area.draw(&PathElement::new(points, color(index).stroke_width(width))).map_err(text_of)?;
    }
    Ok(())
}

/// The title of a panel, followed by the names of its lines in their colours.
fn heading<B: DrawingBackend>(panel: &Panel, area: &Area<B>) -> Result<(), String> {
    let style = ("sans-serif", 15).into_font();
    let title = panel.heading();
    let mut at = LEFT as i32;
    write(area, &title, (at, 6), 15, &BLACK)?;
    at += style.box_size(&title).map_err(text_of)?.0 as i32 + 30;
    if panel.lines.len() < 2 {
        return Ok(());
    }
    for (index, line) in panel.lines.iter().enumerate() {
        let sample = vec![(at, 14), (at + 18, 14)];
        area.draw(&PathElement::new(sample, color(index).stroke_width(3))).map_err(text_of)?;
        write(area, &line.name, (at + 24, 6), 15, &RGBColor(70, 70, 70))?;
        at += style.box_size(&line.name).map_err(text_of)?.0 as i32 + 48;
    }
    Ok(())
}

fn draw_strip<B: DrawingBackend>(
    chart: &Chart,
    strip: &Strip,
    index: usize,
    area: &Area<B>,
) -> Result<(), String> {
    let (top, bottom) = (4, STRIP as i32 - 6);
    let style = ("sans-serif", 13).into_font();
    let width = style.box_size(&strip.name).map_err(text_of)?.0 as i32;
    write(area, &strip.name, (LEFT as i32 - 10 - width, 6), 13, &RGBColor(70, 70, 70))?;
    let ground = [(LEFT as i32, bottom), ((WIDTH - RIGHT) as i32, bottom)];
    area.draw(&PathElement::new(ground.to_vec(), RGBColor(200, 200, 200))).map_err(text_of)?;
    for (from, to) in strip_bars(chart, strip) {
        let corners = [(from, top), (to, bottom)];
        area.draw(&Rectangle::new(corners, color(index).filled())).map_err(text_of)?;
    }
    for at in spaced_marks(chart, strip) {
        area.draw(&PathElement::new([(at, top - 3), (at, bottom + 3)], BLACK)).map_err(text_of)?;
    }
    Ok(())
}

/// The marks of a strip in pixels, without those that would touch another one.
fn spaced_marks(chart: &Chart, strip: &Strip) -> Vec<i32> {
    let mut spaced: Vec<i32> = Vec::new();
    for mark in &strip.marks {
        let at = x_of_time(chart, mark.at);
        if spaced.last().is_none_or(|last| at - last >= MARK_GAP) {
            spaced.push(at);
        }
    }
    spaced
}

/// Draws the links between strips, across the whole picture.
fn draw_links<B: DrawingBackend>(chart: &Chart, area: &Area<B>) -> Result<(), String> {
    let first = TITLE + PANEL * chart.panels.len() as u32;
    let middle = |strip: usize| (first + STRIP * strip as u32 + STRIP / 2) as i32;
    for link in &chart.links {
        let ends = link.strips.map(|strip| (x_of_time(chart, link.at), middle(strip)));
        area.draw(&PathElement::new(ends, RED.stroke_width(2))).map_err(text_of)?;
        for end in ends {
            area.draw(&Circle::new(end, 4, RED.filled())).map_err(text_of)?;
        }
    }
    Ok(())
}

/// The spans of a strip in pixels; spans without a visible gap are merged.
fn strip_bars(chart: &Chart, strip: &Strip) -> Vec<(i32, i32)> {
    let mut bars: Vec<(i32, i32)> = Vec::new();
    for (from, to) in &strip.spans {
        let (from, to) = (x_of_time(chart, *from), x_of_time(chart, *to).max(x_of_time(chart, *from) + 1));
        match bars.last_mut() {
            Some((_, last)) if from <= *last => *last = to.max(*last),
            _ => bars.push((from, to)),
        }
    }
    bars
}

/// The points except those within a horizontal segment.
fn without_flat(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::with_capacity(points.len());
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

/// Draws the numbers of the horizontal axis, at a height of an area.
fn draw_marks<B: DrawingBackend>(chart: &Chart, area: &Area<B>, top: i32) -> Result<(), String> {
    let style = ("sans-serif", 13).into_font();
    for mark in marks(chart) {
        let label = number(chart.scale.number_at(mark));
        let width = style.box_size(&label).map_err(text_of)?.0 as i32;
        write(area, &label, (x_of_time(chart, mark) - width / 2, top), 13, &RGBColor(70, 70, 70))?;
    }
    Ok(())
}

/// Draws the horizontal axis below the panels, with its label.
fn draw_foot<B: DrawingBackend>(chart: &Chart, area: &Area<B>) -> Result<(), String> {
    draw_marks(chart, area, 2)?;
    let style = ("sans-serif", 13).into_font();
    let width = style.box_size(&chart.abscissa).map_err(text_of)?.0 as i32;
    let middle = (LEFT + WIDTH - RIGHT) as i32 / 2;
    write(area, &chart.abscissa, (middle - width / 2, 22), 14, &BLACK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_numbers() {
        let check = |range, expect: &[&str]| {
            let marks: Vec<_> = steps(range, 5).into_iter().map(number).collect();
            assert_eq!(marks, expect);
        };
        check((0.0, 1.0), &["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        check((-3.0, 12.0), &["0", "5", "10"]);
        check((0.0, 0.0), &["0"]);
        check((0.0, 3e9), &["0", "1e9", "2e9", "3e9"]);
    }

    #[test]
    fn noise_is_drawn_thin_and_a_long_move_is_not() {
        let wave = |period: usize| -> Vec<(f64, f64)> {
            (0..4000)
                .map(|i| (i as f64 / 4.0, if (i / period).is_multiple_of(2) { 10.0 } else { 90.0 }))
                .collect()
        };
        assert_eq!(thickness(&wave(1)), 1);
        assert_eq!(thickness(&wave(400)), 2);
    }
}
