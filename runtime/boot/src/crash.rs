//! The report of a firmware crash.

use std::fmt;

use vm::trap::Scene;

/// The processor has stopped permanently: the reason, the time and position, its registers, and the code around the
/// position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crash {
    /// The reason.
    pub reason: String,
    /// Board time in cycles of 5 ns since power-up.
    pub cycle: u64,
    /// The faulting packet, or the one that would have been next.
    pub pc: u32,
    /// The function of the firmware or of a program that contains the packet, and the offset in it, if known.
    pub function: Option<(String, u32)>,
    /// The number of the running thread, 0 for the firmware's own; `None` if the firmware has no such variable.
    pub thread: Option<u32>,
    /// Registers and code around the position.
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
