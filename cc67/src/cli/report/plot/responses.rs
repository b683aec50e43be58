//! Files of the vendor's PC program: a step response over seconds, a Bode plot over hertz on a logarithmic axis.
//!
//! Both have a header, and numbers separated by commas; exponents may have three digits. Later versions add columns.

use anyhow::{Result, bail};

use super::chart::{Chart, Line, Panel, Scale};
use super::csv::Table;

/// Names of the columns of a step response after `Sample` and `Time`, each with the title of its panel.
const STEP: [&str; 2] = ["Command", "Position"];

/// The points of one column over another one.
fn points(
    table: &Table,
    across: impl Fn(&[f64]) -> Option<f64>,
    up: impl Fn(&[f64]) -> Option<f64>,
) -> Vec<(f64, f64)> {
    table.rows.iter().filter_map(|row| Some((across(row)?, up(row)?))).collect()
}

fn panel(title: &str, unit: &str, lines: Vec<Line>) -> Panel {
    Panel { title: title.to_owned(), unit: unit.to_owned(), lines }
}

/// The chart of a step response file.
pub(super) fn step(title: &str, table: &Table) -> Result<Chart> {
    let of = |index: usize| move |row: &[f64]| row.get(index).copied();
    let column = |index: usize| points(table, of(1), of(index));
    let difference = |row: &[f64]| Some(row.get(2)? - row.get(3)?);
    let line = |name: &str, points| Line { name: name.to_owned(), points };
    let mut panels = vec![
        panel("Command and Position", "", vec![line(STEP[0], column(2)), line(STEP[1], column(3))]),
        panel("following error", "", vec![line("following error", points(table, of(1), difference))]),
    ];
    let more = table.names.iter().enumerate().skip(4);
    panels.extend(more.map(|(index, name)| panel(name, "", vec![line(name, column(index))])));
    let times = points(table, of(1), of(1));
    if let Some(index) = times.windows(2).position(|pair| pair[1].0 < pair[0].0) {
        bail!("the time goes back after row {} of the numbers", index + 1);
    }
    let ends = [times.first(), times.last()].map(|end| end.map_or(0.0, |(time, _)| *time));
    let (abscissa, range) = ("time (s)".to_owned(), (ends[0], ends[1]));
    Ok(Chart { title: title.to_owned(), abscissa, panels, range, ..Chart::default() })
}

/// Magnitude in decibels and phase in degrees of the open loop, computed from a row with the measured closed loop.
fn open_loop(row: &[f64]) -> Option<(f64, f64)> {
    let [_, a, b, c, d, ..] = row else { return None };
    let square = a * a + b * b;
    let (re, im) = ((c * a + d * b) / square, (d * a - c * b) / square);
    // L = G / (1 - G)
    let below = (1.0 - re) * (1.0 - re) + im * im;
    let (re, im) = ((re * (1.0 - re) - im * im) / below, im / below);
    Some((10.0 * libm::log10(re * re + im * im), libm::atan2(im, re).to_degrees()))
}

/// The chart of a Bode file; for older files without magnitude and phase, they are computed.
pub(super) fn bode(title: &str, table: &Table) -> Result<Chart> {
    // At 0 Hz nothing is measured, and a logarithmic axis has no position for it.
    let hertz = |row: &[f64]| row.first().copied().filter(|hertz| *hertz > 0.0).map(libm::log10);
    let of = |name: &str| table.names.iter().position(|known| known == name);
    let mut panels = Vec::new();
    for (title, unit, name, smooth) in
        [("magnitude", "dB", "Mag", "SmoothMag"), ("phase", "degrees", "Phase", "SmoothPhase")]
    {
        let value = |row: &[f64]| match of(name) {
            Some(index) => row.get(index).copied(),
            None => open_loop(row).map(|(magnitude, phase)| if name == "Mag" { magnitude } else { phase }),
        };
        let mut lines = vec![Line { name: title.to_owned(), points: points(table, hertz, value) }];
        if let Some(index) = of(smooth) {
            let points = points(table, hertz, |row| row.get(index).copied());
            lines.push(Line { name: "smoothed".to_owned(), points });
        }
        panels.push(panel(&format!("open loop: {title}"), unit, lines));
    }
    let first = panels.first().and_then(|panel| panel.lines.first()).map(|line| line.points.as_slice());
    let [(low, _), .., (high, _)] = first.unwrap_or_default() else {
        bail!("there are less than two frequencies above 0 in it")
    };
    if let Some(index) = first.unwrap_or_default().windows(2).position(|pair| pair[1].0 < pair[0].0) {
        bail!("the frequency goes back after row {} of the numbers", index + 1);
    }
    let range = (*low, *high);
    let (title, abscissa) = (title.to_owned(), "frequency (Hz)".to_owned());
    Ok(Chart { title, abscissa, panels, range, scale: Scale::Logarithmic, ..Chart::default() })
}

#[cfg(test)]
mod tests {
    use super::super::csv::chart;

    /// The example in the manual, with the comma that its printed version lacks.
    const BODE: &str = "Freq,InputRe,InputIm,OutputRe,OutputIm,Mag,Phase,SmoothMag,SmoothPhase
0,2.329706e+007,0,2.344316e+007,0,44.10739,-180,0,0
5.425347,1.968735e+007,0,1.98995e+007,-32055.19,39.34598,-171.5001,39.34598,-171.5001
10.85069,1.816919e+007,0,1.848909e+007,-713239.6,27.48402,-116.3662,29.58283,-139.1553
";

    #[test]
    fn a_bode_file_is_drawn_over_the_logarithm_of_its_frequencies() {
        let bode = chart("b.txt", BODE).expect("it is one");
        assert_eq!(bode.abscissa, "frequency (Hz)");
        let shown: Vec<_> =
            bode.panels[0].lines[0].points.iter().map(|point| bode.scale.number_at(point.0)).collect();
        assert_eq!(shown, [5.425347, 10.85069]);
        let titles: Vec<_> = bode.panels.iter().map(|panel| panel.heading()).collect();
        assert_eq!(titles, ["open loop: magnitude (dB)", "open loop: phase (degrees)"]);
        // Without these columns, magnitude and phase are computed from the measurements.
        let short: String =
            BODE.lines().map(|line| line.split(',').take(5).collect::<Vec<_>>().join(",") + "\n").collect();
        let computed = chart("b.txt", &short).expect("it is one");
        for (known, found) in bode.panels.iter().zip(&computed.panels) {
            for (known, found) in known.lines[0].points.iter().zip(&found.lines[0].points) {
                assert!((known.1 - found.1).abs() < 0.01, "{known:?} {found:?}");
            }
        }
    }

    #[test]
    fn a_step_response_is_drawn_over_its_seconds() {
        let text =
            "Sample,Time,Command,Position,Output\n0,0,5,5,-0.33\n1,9e-005,5,4.5,-0.34\n2,0.00018,6,5,0.5\n";
        let step = chart("s.txt", text).expect("it is one");
        assert_eq!((step.abscissa.as_str(), step.range), ("time (s)", (0.0, 0.00018)));
        let titles: Vec<_> = step.panels.iter().map(|panel| panel.title.as_str()).collect();
        assert_eq!(titles, ["Command and Position", "following error", "Output"]);
        assert_eq!(step.panels[1].lines[0].points, [(0.0, 0.0), (9e-5, 0.5), (0.00018, 1.0)]);
    }
}
