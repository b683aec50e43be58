//! Capabilities of targets, and the message that one is missing.

use std::fmt;

/// Something that not every target can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capability {
    /// Time passes only in calls.
    StopTime,
    /// It goes back to an earlier state.
    Snapshots,
    /// Programs stop between two instructions: breakpoints and steps.
    Breakpoints,
    /// Programs stop where a variable changes.
    Watchpoints,
    /// Programs stop where a variable is read.
    AccessWatchpoints,
    /// Functions of programs are called from expressions.
    Calls,
    /// Programs stop that are code of the controller's processor.
    ProcessorCode,
    /// A stimulus, a machine file and the serial port are connected to it, and all that happens is recorded.
    Surroundings,
    /// Variables are recorded.
    Recordings,
    /// Variables are sampled by the target itself, more often than they can be read one by one.
    FastSamples,
    /// Threads are paused one by one while the others run.
    Pauses,
    /// Received lines are echoed to the client.
    Echoes,
    /// Boxes of programs are answered by calls, not by statements.
    Answers,
}

impl fmt::Display for Capability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StopTime => "stop its time",
            Self::Snapshots => "go back to an earlier state",
            Self::Breakpoints => "stop at breakpoints",
            Self::Watchpoints => "stop where a variable changes",
            Self::AccessWatchpoints => "stop where a variable is read",
            Self::Calls => "call functions of a program from an expression",
            Self::ProcessorCode => "stop code of the controller's processor",
            Self::Pauses => "pause one thread while the others run",
            Self::Echoes => "echo the lines that it receives",
            Self::Answers => "be given answers by a call: a statement of a stimulus does",
            Self::Recordings => "be recorded",
            Self::FastSamples => "sample variables by itself",
            Self::Surroundings => "be connected to a stimulus, a machine file or a recorder",
        })
    }
}

/// A target cannot do what was requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{target} cannot {capability}")]
pub struct Unsupported {
    /// The target in words.
    pub target: &'static str,
    /// The missing capability.
    pub capability: Capability,
}
