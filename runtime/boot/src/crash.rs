//! What is reported of a firmware that went where no firmware goes.

use std::fmt;

/// The processor has stopped for good: why, when and where, its registers, and the code around the place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crash {
    /// What went wrong.
    pub reason: String,
    /// Board time in cycles of 5 ns since power-up.
    pub cycle: u64,
    /// The packet that did it, or that was to be next.
    pub pc: u32,
    /// The function of the firmware or of a program that it belongs to, and how far into it; if that is known.
    pub function: Option<(String, u32)>,
    /// The thread that was running, 0 for the firmware's own; `None` if the firmware has no such variable.
    pub thread: Option<u32>,
    /// Registers by name.
    pub registers: Vec<(String, u32)>,
    /// Words around the place as text.
    pub listing: Vec<(u32, String)>,
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
        for row in self.registers.chunks(8) {
            let cells = row.iter().map(|(name, value)| format!("{name:>4}={value:08X}"));
            writeln!(f, "  {}", cells.collect::<Vec<_>>().join(" "))?;
        }
        for (at, text) in &self.listing {
            let mark = if *at == self.pc { '>' } else { ' ' };
            writeln!(f, "{mark} {at:08X}  {text}")?;
        }
        Ok(())
    }
}
