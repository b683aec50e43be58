//! TIMER0: a free-running counter, of 50 MHz on a KFLOP.

use kmotiondef::Cycles;
use kmotiondef::map::MemoryMap;

/// Cycles per microsecond.
const CYCLES_PER_US: i64 = Cycles::PER_SECOND.get() / 1_000_000;

/// The counter at a given time on a KFLOP; it wraps every 85.9 s.
#[inline]
pub(crate) const fn count(now: Cycles) -> u32 {
    (now.get() / 4) as u32
}

/// The counter at a given time in 64 bits, with the rate in a map.
pub(crate) fn count_of(map: &MemoryMap, now: Cycles) -> u64 {
    (i128::from(now.get()) * i128::from(map.counter) / i128::from(CYCLES_PER_US)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_count_the_same_on_a_kflop() {
        for now in [0, 3, 4, 18_000, 17_179_869_184, i64::MAX].map(Cycles::new) {
            assert_eq!(count(now), count_of(&MemoryMap::KFLOP, now) as u32);
        }
    }
}
