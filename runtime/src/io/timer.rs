//! TIMER0: a free-running counter, of 50 MHz on a KFLOP.

use kmotiondef::Cycles;
use kmotiondef::map::MemoryMap;

/// Cycles of a microsecond.
const CYCLES_PER_US: i64 = Cycles::PER_SECOND.get() / 1_000_000;

/// The counter at an instant; on a KFLOP it wraps every 85.9 s.
pub(crate) fn count(map: &MemoryMap, now: Cycles) -> u32 {
    now.get().wrapping_mul(i64::from(map.counter)).wrapping_div(CYCLES_PER_US) as u32
}
