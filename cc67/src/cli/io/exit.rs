//! Exit codes.

use std::process::ExitCode;

/// What the command's exit code says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The programs ended, or the asked-for time is over.
    Success = 0,
    /// The source has errors; images that are compared differ; a test is not as expected.
    Failure = 1,
    /// Wrong usage or input.
    WrongInput = 2,
    /// A thread trapped.
    Trapped = 3,
    /// Programs were still running at the default time limit.
    StillRunning = 4,
    /// Something that the stimulus expects was not so.
    Unmet = 5,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
