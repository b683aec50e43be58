//! The verdicts on tests.

use super::executor::Executor;
use super::golden::Shown;
use super::schedules::FailingSchedule;

#[derive(Debug)]
pub(super) enum Verdict {
    /// Every engine produced the expected output.
    Passed,
    /// The expected text was rewritten.
    Blessed,
    /// The text would be written, but contains more than a console: the user is asked first.
    Asked(Shown),
    /// The text is not written: nothing was run, or the run was not as required.
    Refused(Shown),
    /// There is no expected text.
    Unknown,
    /// It needs something that the firmware file lacks; the text names it.
    Skipped(String),
    /// The engines agree on a different output.
    Differs(Shown),
    /// With some schedule it produces a different output, or fails.
    FailsBySchedule(FailingSchedule),
    /// An engine's output differs from the first engine's.
    Disagrees(Shown, Executor, Shown),
}

impl Verdict {
    /// Returns whether the test has failed.
    pub(super) fn is_bad(&self) -> bool {
        !self.is_good() && !matches!(self, Self::Skipped(_))
    }

    /// Returns whether the test was run and has passed.
    pub(super) fn is_good(&self) -> bool {
        matches!(self, Self::Passed | Self::Blessed)
    }
}
