//! Exit codes.

use std::process::ExitCode;

/// The exit code of the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The programs ended, or the given time has passed.
    Success = 0,
    /// The source has errors; images that are compared differ; a test is not as expected.
    Failure = 1,
    /// Wrong usage or input.
    WrongInput = 2,
    /// A thread trapped.
    Trapped = 3,
    /// Programs were still running at the default time limit.
    StillRunning = 4,
    /// An expectation of the stimulus was not met.
    Unmet = 5,
    /// Ctrl-C ended the run, as shells count it.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
