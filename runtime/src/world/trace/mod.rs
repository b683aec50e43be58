//! The recordings of a run: levels, slices, values over time.
//!
//! Records travel as events, so they are in order with the console. Nothing is recorded unless it is requested, and
//! recordings do not depend on shortcuts: values are sampled when they change, at ticks that are multiples of the
//! interval, including skipped ticks.

mod item;
mod quantity;
mod recorder;

pub use item::{Item, UnknownItem};
pub use quantity::{Formula, Quantity, RecordedCell, View};
pub(crate) use recorder::Recorder;

pub use crate::out::Record;

use kmotiondef::ThreadId;

/// A request to record values.
#[derive(Clone, Debug)]
pub struct TraceRequest {
    /// Values to sample.
    pub quantities: Vec<Quantity>,
    /// Ticks from one sample to the next.
    pub every: u64,
    /// True if levels and slices are recorded as well.
    pub changes: bool,
    /// The contexts whose packets of real code are recorded as well.
    pub packets: Option<Packets>,
}

/// Whose packets are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packets {
    /// Those of all threads, and of the call-back.
    All,
    /// Those of a thread.
    Of(ThreadId),
}
