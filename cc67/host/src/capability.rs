//! Capabilities of targets, and the message for a missing one.

use std::fmt;

/// An ability that only some targets have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Capability {
    /// Time passes only during calls.
    StopTime,
    /// The target can return to an earlier state.
    Snapshots,
    /// Programs can be stopped between two instructions, by breakpoints and steps.
    Breakpoints,
    /// Programs can be stopped when a variable changes.
    Watchpoints,
    /// Programs can be stopped when a variable is read.
    AccessWatchpoints,
    /// Expressions can call functions of programs.
    Calls,
    /// Programs that are code for the controller's processor can be stopped.
    ProcessorCode,
    /// A stimulus, a machine file and the serial port can be connected, and all events are recorded.
    Surroundings,
    /// Variables can be recorded.
    Recordings,
    /// The target itself can sample variables, faster than they could be read one by one.
    FastSamples,
    /// Single threads can be paused while the others run.
    Pauses,
    /// Received lines can be echoed to the client.
    Echoes,
    /// Boxes of programs are answered by calls instead of statements.
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

/// The error for something that a target cannot do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{target} cannot {capability}")]
pub struct Unsupported {
    /// The kind of target, for the message.
    pub target: &'static str,
    /// The missing capability.
    pub capability: Capability,
}
