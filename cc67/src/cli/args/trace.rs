//! Options for recording a run: the values and the files.

use std::path::PathBuf;

use clap::Args;
use kmotiondef::ThreadId;

use super::heading;

/// Options for recording a run.
#[derive(Debug, Args)]
#[command(next_help_heading = heading::TRACES)]
pub(crate) struct TraceArguments {
    /// Write a trace to FILE: .vcd for waveform viewers, .json or .json.gz for Perfetto, otherwise CSV
    #[arg(long, value_name = "FILE")]
    pub(crate) trace: Vec<PathBuf>,
    /// Write every bit change with its time in nanoseconds and its thread to FILE (CSV)
    #[arg(long, value_name = "FILE")]
    pub(crate) trace_bits: Option<PathBuf>,
    /// Write every packet of processor code with its cycle, address and instructions to FILE (CSV), for thread N or all
    #[arg(long, value_name = "[N:]FILE", value_parser = PacketFile::parse)]
    pub(crate) trace_packets: Option<PacketFile>,
    /// Plot the motion: .svg, .png, or .html for a page with zoom and cursor
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Vec<PathBuf>,
    /// Trace and plot these: axis0,bit46,persist.5,adc2, variables, and expressions such as "ch0->Dest - home"
    /// [default: all enabled axes]
    #[arg(long, visible_alias = "watch", value_name = "LIST")]
    pub(crate) trace_items: Option<String>,
    /// Sample every N servo ticks
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) trace_every: u64,
}

/// The file for packets, and the thread whose packets are recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PacketFile {
    /// The thread; `None` for all.
    pub(crate) thread: Option<ThreadId>,
    pub(crate) path: PathBuf,
}

impl PacketFile {
    fn parse(text: &str) -> Result<Self, String> {
        let Some((number, path)) = text.split_once(':').filter(|(number, _)| is_number(number)) else {
            return Ok(Self { thread: None, path: text.into() });
        };
        let thread = number.parse().ok().and_then(ThreadId::new);
        let thread = thread.ok_or_else(|| format!("no such thread {number} (1-7)"))?;
        Ok(Self { thread: Some(thread), path: path.into() })
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

impl TraceArguments {
    /// Returns whether no file is requested.
    pub(crate) const fn is_unwritten(&self) -> bool {
        self.trace.is_empty() && self.trace_bits.is_none() && self.plot.is_empty()
    }
}
