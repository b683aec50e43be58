//! A recording of a run: levels, slices, values over time.

use kmotiondef::{Bit, CodeAddr, Cycles, ThreadId};

/// A recorded change; the event around it has the time.
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
        /// The instruction before which the servo interrupt has stopped it, where slices can end at any instruction.
        interrupted_at: Option<CodeAddr>,
    },
    /// Real code has executed a packet.
    Packet {
        /// The thread; `None` for the call-back.
        thread: Option<ThreadId>,
        /// The address of the packet.
        address: CodeAddr,
        /// Its duration.
        cycles: Cycles,
        /// Its instructions, separated by bars.
        text: String,
    },
    /// The quantities have these values, some of which are new.
    Sample {
        /// In the order of the request.
        values: Vec<f64>,
        /// The axes that are enabled, axis 0 lowest.
        enabled: u16,
    },
}
