//! A segment that is executed in steps because the slice ends, or has ended, within it.

use std::sync::Arc;

use kmotiondef::Cycles;

use crate::access::HighWord;
use crate::meter;
use crate::program::Program;

/// The rest of a segment that the budget did not cover.
#[derive(Clone, Debug)]
pub(super) struct SegmentRest {
    /// The instructions, and the cycles of each.
    pub(super) steps: Arc<[(usize, u32)]>,
    /// The index of the next step.
    pub(super) next: usize,
    /// The high word that the present instruction still has to store.
    pub(super) high_word: Option<HighWord>,
}

impl SegmentRest {
    /// The steps of the segment whose charge has just overdrawn the budget; `None` if there are none. The charge is
    /// refunded, except for the cycles before the first step.
    pub(super) fn begin(program: &Program, charge: usize, budget: &mut Cycles) -> Option<Self> {
        let meter::Steps { head, steps } = meter::steps(program.ops(), charge);
        let all = head + steps.iter().map(|(_, cycles)| cycles).sum::<u32>();
        *budget += Cycles::new(i64::from(all - head));
        (!steps.is_empty()).then(|| Self { steps: steps.into(), next: 0, high_word: None })
    }
}
