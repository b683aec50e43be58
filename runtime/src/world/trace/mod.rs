//! What a run records for those who look at it afterwards: levels, slices, values over time.
//!
//! Records travel as events, so they are in order with the console. Nothing is recorded unless somebody asks, and what
//! is recorded does not depend on shortcuts: values are sampled when they change, at ticks that are multiples of the
//! interval, the skipped ones among them.

mod item;
mod quantity;
mod recorder;

pub use item::{Item, UnknownItem};
pub use quantity::{Formula, Quantity, View};
pub(crate) use recorder::Recorder;

use kmotiondef::{Bit, Cycles, ThreadId};

/// What is to be recorded.
#[derive(Clone, Debug)]
pub struct Request {
    /// Values to sample.
    pub quantities: Vec<Quantity>,
    /// Ticks from one sample to the next.
    pub every: u64,
    /// Whether levels and slices are recorded as well.
    pub changes: bool,
}

/// One thing that was recorded; the event around it says when.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// A bit has changed.
    Bit {
        /// The bit.
        bit: Bit,
        /// Its level since.
        level: bool,
        /// The thread that changed it; `None` for the world, the board and the call-back.
        thread: Option<ThreadId>,
    },
    /// A thread had the processor.
    Slice {
        /// The thread.
        thread: ThreadId,
        /// Until when.
        end: Cycles,
    },
    /// The quantities have these values, some of which are new.
    Sample {
        /// In the order of the request.
        values: Vec<f64>,
        /// The axes that are enabled, axis 0 lowest.
        enabled: u8,
    },
}
