//! Exit codes.

use std::process::ExitCode;

/// The exit code of the command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The programs ended, or the requested time has passed.
    Success = 0,
    /// The source has errors; compared images differ; a test has failed.
    Failure = 1,
    /// Wrong usage or input.
    WrongInput = 2,
    /// A thread trapped.
    Trapped = 3,
    /// Programs were still running at the default time limit.
    StillRunning = 4,
    /// An expectation of the stimulus was not met.
    Unmet = 5,
    /// Ctrl-C ended the run; the code is a convention of shells.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
