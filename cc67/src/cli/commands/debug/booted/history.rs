//! The past of a booted board: snapshots, from which it is executed again.
//!
//! A place in the past is the number of packets executed since power-up: no two instants have it in common.

use boot::BootedSnapshot;
use kmotiondef::Ticks;

use super::calls::OpenCalls;

/// Snapshots kept; with more, every second is dropped and they are taken half as often.
const MOST: usize = 48;
/// Ticks between two snapshots at first: 20 ms.
const INTERVAL: u64 = 222;

/// The board at an instant, and what the debugger knew then.
#[derive(Debug)]
pub(super) struct Mark {
    /// The board.
    pub(super) board: BootedSnapshot,
    /// The calls in progress.
    pub(super) calls: OpenCalls,
    /// The part of the run that is under way: the tick of its begin, the cycle of its end.
    pub(super) part: (Ticks, u64),
    /// Where it is.
    pub(super) packets: u64,
}

/// The snapshots, oldest first.
#[derive(Debug)]
pub(super) struct History {
    marks: Vec<Mark>,
    interval: u64,
}

impl History {
    /// A past that begins here.
    pub(super) fn new(begin: Mark) -> Self {
        Self { marks: vec![begin], interval: INTERVAL }
    }

    /// The snapshots, oldest first; there is one at least.
    pub(super) fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// Whether a snapshot is due after a tick, at a place.
    pub(super) fn is_due(&self, tick: Ticks, packets: u64) -> bool {
        self.marks
            .last()
            .is_none_or(|last| packets > last.packets && tick.get() >= last.part.0.get() + self.interval)
    }

    /// One more.
    pub(super) fn add(&mut self, mark: Mark) {
        self.marks.push(mark);
        if self.marks.len() > MOST {
            let mut number = 0;
            self.marks.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.interval *= 2;
        }
    }
}
