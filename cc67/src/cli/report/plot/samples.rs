//! Values that were sampled together, and the panels for them.
//!
//! An axis gets panels for its commanded and measured position, its velocity, its following error and its output, if
//! these change. Every other quantity except bits gets its own panel. Values are recorded when they change; between two
//! samples the last value holds.

use std::collections::BTreeMap;

use super::chart::{Line, Panel, Strip};

/// The number of axes.
const AXES: usize = 8;

/// The factor by which a jump within one sample exceeds the surrounding speed if it is not a movement: the axis was
/// given another position, by `Zero` or `EnableAxisDest`.
const JUMP: f64 = 20.0;

type Points = Vec<(f64, f64)>;

/// A sampled quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::cli) struct Column {
    /// Its name: names for axes begin with `dest`, `pos` and `out`, those of bits with `bit`.
    pub(in crate::cli) name: String,
    /// The unit; empty for numbers without a unit.
    pub(in crate::cli) unit: String,
}

/// Samples of several quantities.
#[derive(Clone, Debug, Default)]
pub(in crate::cli) struct Samples {
    /// The quantities.
    pub(in crate::cli) columns: Vec<Column>,
    /// The time in seconds, and a value for each quantity.
    pub(in crate::cli) rows: Vec<(f64, Vec<f64>)>,
    /// The interval between samples while values change, in seconds.
    pub(in crate::cli) step: f64,
    /// The time until which the last values hold, in seconds.
    pub(in crate::cli) end: f64,
    /// The axes by number: name, unit, and whether their position is measured.
    pub(in crate::cli) axes: BTreeMap<usize, PlottedAxis>,
}

/// The labels of an axis in plots.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::cli) struct PlottedAxis {
    /// Its name; empty for its number.
    pub(in crate::cli) name: String,
    /// The name of its unit; empty for `units`.
    pub(in crate::cli) units: String,
    /// True if its position is measured; otherwise the position of its load is shown.
    pub(in crate::cli) is_measured: bool,
}

impl Samples {
    /// The panels of all quantities except bits.
    pub(in crate::cli) fn panels(&self) -> Vec<Panel> {
        let mut panels: Vec<Panel> = (0..AXES).flat_map(|axis| self.of_axis(axis)).collect();
        let is_other = |name: &str| is_numbered(name, &["dest", "pos", "load", "out", "bit"]).is_none();
        panels.extend(self.plain(is_other));
        panels
    }

    /// A panel for each quantity, whatever its name.
    pub(in crate::cli::report) fn plain_panels(&self) -> Vec<Panel> {
        self.plain(|_| true)
    }

    fn plain(&self, is_shown: fn(&str) -> bool) -> Vec<Panel> {
        let columns = self.columns.iter().enumerate().filter(|(_, column)| is_shown(&column.name));
        let panel = |(index, column): (usize, &Column)| {
            let lines = vec![Line { name: column.name.clone(), points: self.points(index) }];
            Panel { title: column.name.clone(), unit: column.unit.clone(), lines }
        };
        columns.map(panel).collect()
    }

    /// The bits among the quantities, as strips.
    pub(in crate::cli::report) fn strips(&self) -> Vec<Strip> {
        let bits = self.columns.iter().enumerate();
        let bits = bits.filter_map(|(index, column)| Some((index, is_numbered(&column.name, &["bit"])?)));
        bits.map(|(index, bit)| Strip {
            name: format!("bit {bit}"),
            spans: spans(&self.points(index)),
            marks: Vec::new(),
        })
        .collect()
    }

    /// The values of a quantity.
    fn points(&self, column: usize) -> Points {
        let mut points: Points = Vec::new();
        for (time, values) in &self.rows {
            match points.last() {
                Some((last, held)) if time - last > 1.5 * self.step => {
                    let held = *held;
                    points.push((time - self.step, held));
                }
                _ => {}
            }
            points.push((*time, values.get(column).copied().unwrap_or_default()));
        }
        if let Some((last, held)) = points.last().copied()
            && self.end > last
        {
            points.push((self.end, held));
        }
        points
    }

    fn named(&self, name: &str) -> Option<Points> {
        Some(self.points(self.columns.iter().position(|column| column.name == name)?))
    }

    /// The panels of an axis.
    fn of_axis(&self, axis: usize) -> Vec<Panel> {
        let of = |kind: &str| self.named(&format!("{kind}{axis}"));
        let (dest, position, load) = (of("dest"), of("pos"), of("load"));
        let PlottedAxis { name, units, .. } = self.axes.get(&axis).cloned().unwrap_or_default();
        let units = if units.is_empty() { "units".to_owned() } else { units };
        let [label, whole] = match name.as_str() {
            "" => [axis.to_string(), format!("axis {axis}")],
            name => [name.to_owned(), format!("axis {axis} ({name})")],
        };
        let panel = |title: &str, unit: &str, lines: Vec<(&str, Points)>| Panel {
            title: format!("{whole}: {title}"),
            unit: unit.to_owned(),
            lines: lines
                .into_iter()
                .map(|(name, points)| Line { name: format!("{name} {label}"), points })
                .collect(),
        };
        let mut panels = Vec::new();
        let velocity = dest.as_ref().or(position.as_ref()).or(load.as_ref()).map(slope);
        let error = dest.as_ref().zip(position.as_ref()).map(|(dest, position)| difference(dest, position));
        let path: Vec<_> = [("Dest", dest), ("Position", position), ("load", load)]
            .into_iter()
            .filter_map(|(name, points)| Some((name, points?)))
            .collect();
        if !path.is_empty() {
            let names: Vec<_> = path.iter().map(|(name, _)| *name).collect();
            panels.push(panel(&in_words(&names), &units, path));
        }
        for (title, unit, points) in [
            ("velocity", format!("{units}/s"), velocity),
            ("following error", units.clone(), error),
            ("output", String::new(), of("out")),
        ] {
            let Some(points) = points.filter(changes) else { continue };
            panels.push(panel(title, &unit, vec![(title, points)]));
        }
        panels
    }
}

/// `Dest, Position and load`.
fn in_words(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [name] => (*name).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// The number after one of these words, if a name consists of nothing else.
fn is_numbered<'a>(name: &'a str, words: &[&str]) -> Option<&'a str> {
    let number = words.iter().find_map(|word| name.strip_prefix(word))?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(number)
}

fn changes(points: &Points) -> bool {
    points.windows(2).any(|pair| pair[0].1 != pair[1].1)
}

/// The intervals in which a value was not 0.
fn spans(points: &Points) -> Vec<(f64, f64)> {
    let mut spans = Vec::new();
    for pair in points.windows(2).filter(|pair| pair[0].1 != 0.0) {
        match spans.last_mut() {
            Some((_, end)) if *end == pair[0].0 => *end = pair[1].0,
            _ => spans.push((pair[0].0, pair[1].0)),
        }
    }
    spans
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

/// The difference of two lines with the same times.
fn difference(a: &Points, b: &Points) -> Points {
    a.iter().zip(b).map(|(a, b)| (a.0, a.1 - b.1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn setting_a_new_position_is_not_movement() {
        let points = [0.0, 1.0, 2.0, 1002.0, 1003.0].into_iter().enumerate();
        let slopes = slope(&points.map(|(at, value)| (at as f64, value)).collect());
        assert_eq!(slopes.iter().map(|point| point.1).collect::<Vec<_>>(), [1.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn axes_and_bits_are_known_by_their_names() {
        let column = |name: &str| Column { name: name.to_owned(), unit: String::new() };
        let samples = Samples {
            columns: ["speed", "dest2", "bit7", "bitter", "out2"].map(column).to_vec(),
            rows: vec![(0.0, vec![1.0, 2.0, 0.0, 3.0, 4.0]), (1.0, vec![1.0, 3.0, 1.0, 3.0, 4.0])],
            step: 1.0,
            end: 2.0,
            axes: BTreeMap::from([(
                2,
                PlottedAxis { name: "Z".to_owned(), units: "mm".to_owned(), is_measured: true },
            )]),
        };
        let titles: Vec<_> = samples.panels().into_iter().map(|panel| panel.heading()).collect();
        assert_eq!(titles, ["axis 2 (Z): Dest (mm)", "axis 2 (Z): velocity (mm/s)", "speed", "bitter"]);
        assert_eq!(
            samples.strips(),
            [Strip { name: "bit 7".to_owned(), spans: vec![(1.0, 2.0)], marks: Vec::new() }]
        );
    }
}
