//! The resources that a process has used, as Linux reports them: for tests that limit a run.

use std::fs;
use std::time::Duration;

/// Processor time and memory of a process so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Usage {
    /// The processor time, to a hundredth of a second.
    pub cpu: Duration,
    /// The present memory in kilobytes.
    pub memory: u64,
    /// The peak memory in kilobytes.
    pub peak: u64,
}

impl Usage {
    /// The usage of the process with this id.
    ///
    /// # Panics
    /// There is no such process.
    #[must_use]
    pub fn of(process: u32) -> Self {
        Self::of_running(process).expect("the process runs")
    }

    /// The usage of the process with this id, while it runs.
    #[must_use]
    pub fn of_running(process: u32) -> Option<Self> {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        // The name of the program, in parentheses, may contain any characters; the times are two words after the 12th.
        let words = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        let hundredths: u64 = words.skip(11).take(2).filter_map(|word| word.parse::<u64>().ok()).sum();
        let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
        // A process that has ended no longer has memory.
        let kilobytes = |name: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(name))?;
            line.trim().trim_end_matches(" kB").parse().ok()
        };
        let (memory, peak) = (kilobytes("VmRSS:")?, kilobytes("VmHWM:")?);
        Some(Self { cpu: Duration::from_millis(10 * hundredths), memory, peak })
    }
}
