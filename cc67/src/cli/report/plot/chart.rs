//! The contents of a plot: panels of lines over time, with strips of levels below them.

/// Values over time; each holds until the next.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Line {
    /// Its name in the legend.
    pub(in crate::cli) name: String,
    /// Seconds and values, ascending in time.
    pub(in crate::cli) points: Vec<(f64, f64)>,
}

/// Lines that share a vertical axis.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Panel {
    /// The title.
    pub(in crate::cli) title: String,
    /// The unit of the values; empty for numbers without a unit.
    pub(in crate::cli) unit: String,
    /// The lines.
    pub(in crate::cli) lines: Vec<Line>,
}

/// Intervals in which a state holds: a bit is high, a thread has the processor.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Strip {
    /// The name of the level.
    pub(in crate::cli) name: String,
    /// The beginnings and ends in seconds, ascending.
    pub(in crate::cli) spans: Vec<(f64, f64)>,
    /// Marked times, ascending.
    pub(in crate::cli) marks: Vec<Mark>,
}

/// A marked time on a strip.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Mark {
    /// The time in seconds.
    pub(in crate::cli) at: f64,
    /// The event.
    pub(in crate::cli) text: String,
}

/// An event between two strips.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Link {
    /// The time in seconds.
    pub(in crate::cli) at: f64,
    /// The indices of the strips.
    pub(in crate::cli) strips: [usize; 2],
    /// The event.
    pub(in crate::cli) text: String,
}

/// A whole plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::cli) struct Chart {
    /// The headline.
    pub(in crate::cli) title: String,
    /// The label of the horizontal axis, with its unit.
    pub(in crate::cli) abscissa: String,
    /// Panels from top to bottom.
    pub(in crate::cli) panels: Vec<Panel>,
    /// Strips below them.
    pub(in crate::cli) strips: Vec<Strip>,
    /// Links between strips, ascending in time.
    pub(in crate::cli) links: Vec<Link>,
    /// The first and the last time.
    pub(in crate::cli) range: (f64, f64),
    /// The scale of the horizontal axis.
    pub(in crate::cli) scale: Scale,
}

/// The scale of a horizontal axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::cli) enum Scale {
    /// Positions are the numbers.
    #[default]
    Linear,
    /// Positions are the logarithms of the numbers, to base 10.
    Logarithmic,
}

impl Scale {
    /// The number at a position.
    pub(in crate::cli::report) fn number_at(self, position: f64) -> f64 {
        match self {
            Self::Linear => position,
            // Rounded, because the logarithm and its inverse have changed the last digits.
            Self::Logarithmic => format!("{:.9e}", libm::pow(10.0, position)).parse().unwrap_or(position),
        }
    }
}

impl Line {
    /// The smallest and the largest value; `None` without points.
    pub(in crate::cli::report) fn extent(&self) -> Option<(f64, f64)> {
        let values = self.points.iter().map(|(_, value)| *value).filter(|value| value.is_finite());
        values.fold(None, |extent, value| match extent {
            None => Some((value, value)),
            Some((low, high)) => Some((value.min(low), value.max(high))),
        })
    }

    /// At most about four points per column that look the same: the first, the lowest, the highest and the last point
    /// of each column.
    pub(in crate::cli::report) fn thinned(&self, range: (f64, f64), columns: usize) -> Vec<(f64, f64)> {
        if self.points.len() <= 4 * columns {
            return self.points.clone();
        }
        let width = (range.1 - range.0) / columns as f64;
        let column = |time: f64| ((time - range.0) / width) as i64;
        let mut thin = Vec::new();
        for group in self.points.chunk_by(|a, b| column(a.0) == column(b.0)) {
            let by_value = |a: &usize, b: &usize| group[*a].1.total_cmp(&group[*b].1);
            let lowest = (0..group.len()).min_by(by_value).unwrap_or_default();
            let highest = (0..group.len()).max_by(by_value).unwrap_or_default();
            let mut kept = vec![0, lowest, highest, group.len() - 1];
            kept.sort_unstable();
            kept.dedup();
            thin.extend(kept.into_iter().map(|index| group[index]));
        }
        thin
    }
}

impl Panel {
    /// The range of values to show: the extent of the lines, with a small margin.
    pub(in crate::cli::report) fn range(&self) -> (f64, f64) {
        let extents: Vec<_> = self.lines.iter().filter_map(Line::extent).collect();
        let low = extents.iter().map(|extent| extent.0).fold(f64::INFINITY, f64::min);
        let high = extents.iter().map(|extent| extent.1).fold(f64::NEG_INFINITY, f64::max);
        if !(low.is_finite() && high.is_finite()) {
            return (-1.0, 1.0);
        }
        // A constant line gets a margin around its value, whatever its size.
        let room = if high > low { (high - low) * 0.06 } else { (low.abs() * 0.1).max(1.0) };
        (low - room, high + room)
    }

    /// The title with the unit.
    pub(in crate::cli::report) fn heading(&self) -> String {
        match self.unit.as_str() {
            "" => self.title.clone(),
            unit => format!("{} ({unit})", self.title),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_extremes_of_each_column() {
        let points =
            (0..10_000).map(|i| (f64::from(i), if i == 5_555 { 9.0 } else { f64::from(i % 2) })).collect();
        let line = Line { name: String::new(), points };
        let thin = line.thinned((0.0, 9_999.0), 100);
        assert!(thin.len() <= 410, "{}", thin.len());
        assert!(thin.contains(&(5_555.0, 9.0)));
        assert_eq!((thin.first(), thin.last()), (Some(&(0.0, 0.0)), Some(&(9_999.0, 1.0))));
        assert!(thin.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_constant_has_room_around_it() {
        let panel = |value| Panel {
            title: String::new(),
            unit: String::new(),
            lines: vec![Line { name: String::new(), points: vec![(0.0, value), (1.0, value)] }],
        };
        assert_eq!(panel(0.0).range(), (-1.0, 1.0));
        assert_eq!(panel(1000.0).range(), (900.0, 1100.0));
        assert_eq!(panel(f64::NAN).range(), (-1.0, 1.0));
    }
}
