//! The verdicts on tests.

use super::executor::Executor;
use super::golden::Shown;
use super::schedules::FailingSchedule;

/// The verdict on a test.
#[derive(Debug)]
pub(super) enum Verdict {
    /// Every engine showed what was expected.
    Passed,
    /// The expected text was rewritten.
    Blessed,
    /// The text would be written, but holds more than a console: the user is asked first.
    Asked(Shown),
    /// The text is not written: nothing was run, or not as it should.
    Refused(Shown),
    /// There is no expected text.
    Unknown,
    /// It needs what the firmware file does not have: what that is.
    Skipped(String),
    /// The engines agree on something else.
    Differs(Shown),
    /// It shows something else, or goes wrong, by a schedule.
    FailsBySchedule(FailingSchedule),
    /// An engine did not show what the first one did.
    Disagrees(Shown, Executor, Shown),
}

impl Verdict {
    /// Returns whether the test has failed.
    pub(super) fn is_bad(&self) -> bool {
        !self.is_good() && !matches!(self, Self::Skipped(_))
    }

    /// Returns whether the test was run and is as it should be.
    pub(super) fn is_good(&self) -> bool {
        matches!(self, Self::Passed | Self::Blessed)
    }
}
