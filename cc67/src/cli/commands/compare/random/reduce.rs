//! The smallest scenario that still shows a difference.

use super::observation::Difference;
use super::scenario::{Part, PartKind, RecordTimes, Scenario};

/// The maximum number of scenarios that are tried for one reduction.
const MOST_TRIALS: usize = 120;

/// Reduces a scenario that differs to parts that are all necessary, in as few slices as possible.
///
/// `differs` plays a scenario on both boards; it returns the position at which the same difference first shows, or
/// `None` if it does not show.
pub(super) fn reduced(
    scenario: &Scenario,
    differs: &mut dyn FnMut(&Scenario) -> Option<Difference>,
) -> Scenario {
    let mut reduction = Reduction { smallest: scenario.clone(), differs, trials: MOST_TRIALS };
    let mut size = scenario.parts.len().div_ceil(2);
    while size > 0 && reduction.trials > 0 {
        let is_smaller = reduction.leave_out(size);
        // Single parts are tried again, as one may have been necessary only for another that is now removed.
        if size > 1 || !is_smaller {
            size /= 2;
        }
    }
    reduction.shorten();
    reduction.smallest
}

struct Reduction<'d> {
    smallest: Scenario,
    differs: &'d mut dyn FnMut(&Scenario) -> Option<Difference>,
    trials: usize,
}

impl Reduction<'_> {
    /// Keeps a scenario if it still differs.
    fn accept(&mut self, scenario: Scenario) -> bool {
        if self.trials == 0 {
            return false;
        }
        self.trials -= 1;
        let is_different = (self.differs)(&scenario).is_some();
        if is_different {
            self.smallest = scenario;
        }
        is_different
    }

    /// Removes groups of parts that are not necessary; returns whether there were any.
    fn leave_out(&mut self, size: usize) -> bool {
        let mut has_changed = false;
        let mut end = self.smallest.parts.len();
        while end > 0 {
            let begin = end.saturating_sub(size);
            let mut scenario = self.smallest.clone();
            // Functions used by other parts stay.
            let removed: Vec<Part> = scenario.parts.drain(begin..end).collect();
            let is_needed = removed.iter().any(|part| part.kind == PartKind::Head);
            has_changed |= !is_needed && self.accept(scenario);
            end = begin;
        }
        has_changed
    }

    /// Ends the program soon after the first sample that differs, and moves its statements closer to the beginning.
    fn shorten(&mut self) {
        if self.smallest.is_session() {
            return;
        }
        let sample = (self.differs)(&self.smallest).and_then(|difference| difference.at);
        let slice = match (self.smallest.observed, sample) {
            (RecordTimes::Slices(every), Some(sample)) => Some(sample as u32 * every),
            (RecordTimes::Ticks, Some(sample)) => Some(4 + sample as u32 / 2),
            (RecordTimes::Printed, _) | (_, None) => None,
        };
        if let Some(slices) = slice.map(|slice| slice + 2).filter(|slices| *slices < self.smallest.slices) {
            self.accept(Scenario { slices, ..self.smallest.clone() });
        }
        let first = self.smallest.parts.iter().filter_map(|part| match part.kind {
            PartKind::Slice { slice, .. } => Some(slice),
            PartKind::Line | PartKind::Head | PartKind::Start | PartKind::Tick => None,
        });
        let Some(early) = first.min().map(|first| first.saturating_sub(4)).filter(|early| *early > 0) else {
            return;
        };
        let mut scenario = self.smallest.clone();
        scenario.slices -= early.min(scenario.slices - 1);
        for part in &mut scenario.parts {
            if let PartKind::Slice { slice, .. } = &mut part.kind {
                *slice -= early;
            }
        }
        self.accept(scenario);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(at: usize) -> Difference {
        Difference { what: "text".to_owned(), at: Some(at), model: "1".to_owned(), firmware: "2".to_owned() }
    }

    fn scenario(texts: &[&str]) -> Scenario {
        let part = |(slice, text): (u32, &&str)| Part {
            kind: PartKind::Slice { thread: 1, slice: 10 + slice },
            text: (*text).to_owned(),
        };
        Scenario {
            name: "moves 1".to_owned(),
            parts: (0..).zip(texts).map(part).collect(),
            slices: 100,
            observed: RecordTimes::Slices(5),
            columns: Vec::new(),
        }
    }

    #[test]
    fn only_parts_that_a_difference_needs_are_left() {
        let whole = scenario(&["a", "b", "c", "d", "e", "f", "g"]);
        let mut differs = |scenario: &Scenario| {
            let has = |text| scenario.parts.iter().any(|part| part.text == text);
            (has("b") && has("f")).then(|| sample(8))
        };
        let small = reduced(&whole, &mut differs);
        let texts: Vec<_> = small.parts.iter().map(|part| part.text.as_str()).collect();
        assert_eq!(texts, ["b", "f"]);
        assert_eq!(small.slices, 8 * 5 + 2 - 7, "it ends soon, and begins early");
        assert_eq!(small.parts[0].kind, PartKind::Slice { thread: 1, slice: 4 });
    }

    #[test]
    fn a_scenario_that_needs_all_of_its_parts_stays() {
        let whole = scenario(&["a", "b", "c"]);
        let mut differs =
            |other: &Scenario| (other.parts.len() == 3 && other.slices == 100).then(|| sample(0));
        assert_eq!(reduced(&whole, &mut differs), whole);
    }
}
