//! The resources that a process has used, as Linux reports them: for tests that limit a run.

use std::fs;
use std::time::Duration;

/// Processor time and memory of a process so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Usage {
    /// Time that it had a processor, to a hundredth of a second.
    pub cpu: Duration,
    /// Memory that it has now, in kilobytes.
    pub memory: u64,
    /// The most that it ever had, in kilobytes.
    pub peak: u64,
}

impl Usage {
    /// That of the process with this id.
    ///
    /// # Panics
    /// If there is no such process.
    #[must_use]
    pub fn of(process: u32) -> Self {
        Self::of_running(process).expect("the process runs")
    }

    /// That of the process with this id, as long as it runs.
    #[must_use]
    pub fn of_running(process: u32) -> Option<Self> {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        // The name of the program, in parentheses, may hold anything; two words behind the 12th are times.
        let words = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        let hundredths: u64 = words.skip(11).take(2).filter_map(|word| word.parse::<u64>().ok()).sum();
        let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
        // A process that has ended has no memory any more.
        let kilobytes = |name: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(name))?;
            line.trim().trim_end_matches(" kB").parse().ok()
        };
        let (memory, peak) = (kilobytes("VmRSS:")?, kilobytes("VmHWM:")?);
        Some(Self { cpu: Duration::from_millis(10 * hundredths), memory, peak })
    }
}
