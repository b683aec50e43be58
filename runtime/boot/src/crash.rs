//! The report of a firmware crash.

use std::fmt;

use vm::trap::Scene;

/// The processor has stopped for good: why, when and where, its registers, and the code around the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crash {
    /// The fault.
    pub reason: String,
    /// Board time in cycles of 5 ns since power-up.
    pub cycle: u64,
    /// The packet that did it, or that should have been next.
    pub pc: u32,
    /// The function of the firmware or of a program that it belongs to, and how far into it; if that is known.
    pub function: Option<(String, u32)>,
    /// The thread that was running, 0 for the firmware's own; `None` if the firmware has no such variable.
    pub thread: Option<u32>,
    /// Registers and code around the place.
    pub scene: Scene,
}

impl fmt::Display for Crash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the firmware stopped at 0x{:08X}", self.pc)?;
        if let Some((name, offset)) = &self.function {
            write!(f, " ({name}+0x{offset:X})")?;
        }
        match self.thread {
            Some(0) => f.write_str(", thread 0 (the firmware's own)")?,
            Some(thread) => write!(f, ", thread {thread}")?,
            None => {}
        }
        writeln!(f, ", board time {:.6} s: {}", self.cycle as f64 * 5e-9, self.reason)?;
        self.scene.fmt(f)
    }
}
