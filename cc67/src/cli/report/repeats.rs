//! Remarks that a program causes repeatedly: each is shown once, and counted from then on.

use std::collections::BTreeMap;

/// The maximum number of different remarks that are shown.
pub(crate) const MOST: usize = 1000;

/// The remarks so far.
#[derive(Debug, Default)]
pub(crate) struct RemarkCounts {
    /// The number of repetitions of each.
    repetitions: BTreeMap<String, u64>,
    /// The number of further different remarks after the maximum was reached.
    left_out: u64,
}

impl RemarkCounts {
    /// Counts a remark; returns whether it should be shown.
    pub(crate) fn is_shown(&mut self, text: &str) -> bool {
        if let Some(again) = self.repetitions.get_mut(text) {
            *again += 1;
            return false;
        }
        if self.repetitions.len() >= MOST {
            self.left_out += 1;
            return false;
        }
        self.repetitions.insert(text.to_owned(), 0);
        true
    }

    /// Returns lines about the remarks that were not shown.
    pub(crate) fn summary(&self) -> Vec<String> {
        let repeated = self.repetitions.iter().filter(|(_, again)| **again > 0);
        let mut lines: Vec<_> = repeated
            .map(|(text, again)| match again {
                1 => format!("repeated once: {text}"),
                again => format!("repeated {again} times: {text}"),
            })
            .collect();
        if self.left_out > 0 {
            lines.push(format!("{} further remarks are not shown; --json shows all", self.left_out));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remark_is_shown_once_and_counted_from_then_on() {
        let mut repeats = RemarkCounts::default();
        let shown: Vec<_> = ["a", "b", "a", "a", "b"].map(|text| repeats.is_shown(text)).into();
        assert_eq!(shown, [true, true, false, false, false]);
        assert_eq!(repeats.summary(), ["repeated 2 times: a", "repeated once: b"]);
    }

    #[test]
    fn the_number_of_different_remarks_shown_is_limited() {
        let mut repeats = RemarkCounts::default();
        assert_eq!((0..1500).filter(|number| repeats.is_shown(&number.to_string())).count(), MOST);
        assert_eq!(repeats.summary(), ["500 further remarks are not shown; --json shows all"]);
    }
}
