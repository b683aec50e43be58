//! TIMER0: a free-running counter of 50 MHz.

use kmotiondef::Cycles;

/// Cycles of the processor for each count.
const CYCLES_PER_COUNT: i64 = 4;

/// The counter at an instant; it wraps every 85.9 s.
pub(crate) fn count(now: Cycles) -> u32 {
    (now.get() / CYCLES_PER_COUNT) as u32
}
