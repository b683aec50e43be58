//! The RTI: two counters, and the comparator whose match interrupts the processor (`dsp-board.md` 4.1).
//!
//! A counter is not incremented: its value follows from the cycle in which it was started.

/// Offsets of the registers.
const GLOBAL: u32 = 0x00;
const COMPARE_CONTROL: u32 = 0x0C;
const COUNTERS: [u32; 2] = [0x10, 0x30];
const COMPARE: u32 = 0x50;
const UPDATE: u32 = 0x54;
const ENABLE: u32 = 0x80;
const DISABLE: u32 = 0x84;
const FLAGS: u32 = 0x88;
/// Offsets of a counter's registers from its first.
const COUNT: u32 = 0;
const PRESCALER: u32 = 4;
const PRESCALE: u32 = 8;
/// The size of the registers in bytes.
const SIZE: usize = 0x100;

/// A counter: its value at a cycle, and whether it runs from there on.
#[derive(Clone, Copy, Debug, Default)]
struct Counter {
    value: u32,
    since: u64,
    runs: bool,
    /// The number of cycles per count.
    period: u64,
}

impl Counter {
    fn value_at(&self, cycle: u64) -> u32 {
        if !self.runs {
            return self.value;
        }
        self.value.wrapping_add((cycle.saturating_sub(self.since) / self.period) as u32)
    }

    /// Keeps the count, but restarts from this cycle; the prescaler's partial count is lost.
    fn rebase(&mut self, cycle: u64) {
        self.value = self.value_at(cycle);
        self.since = cycle;
    }

    /// The first cycle at or after `now` in which it reaches `count`.
    fn next_match(&self, count: u32, now: u64) -> Option<u64> {
        if !self.runs {
            return None;
        }
        let ahead = u64::from(count.wrapping_sub(self.value_at(now)));
        let begun = (now - self.since) / self.period * self.period + self.since;
        let wait = if ahead == 0 { 1 << 32 } else { ahead };
        Some(begun + wait * self.period)
    }
}

/// The timer.
#[derive(Clone, Debug)]
pub(super) struct Timer {
    counters: [Counter; 2],
    compare: u32,
    update: u32,
    uses_second: bool,
    is_enabled: bool,
    flag: bool,
    /// The values of registers that only store.
    stored: [u32; SIZE / 4],
    /// The cycle of the next match; never reached while the counter is stopped.
    next: u64,
}

impl Default for Timer {
    fn default() -> Self {
        let counter = Counter { period: 4, ..Counter::default() };
        Self {
            counters: [counter; 2],
            compare: 0,
            update: 0,
            uses_second: false,
            is_enabled: false,
            flag: false,
            stored: [0; SIZE / 4],
            next: u64::MAX,
        }
    }
}

impl Timer {
    /// The cycle of the next match.
    pub(super) const fn next_match(&self) -> u64 {
        self.next
    }

    /// Handles a match; returns whether it interrupts.
    pub(super) fn take_match(&mut self) -> bool {
        let now = self.next;
        self.flag = true;
        self.compare = self.compare.wrapping_add(self.update);
        self.schedule_match(now);
        self.is_enabled
    }

    fn schedule_match(&mut self, now: u64) {
        let counter = &self.counters[usize::from(self.uses_second)];
        self.next = counter.next_match(self.compare, now).unwrap_or(u64::MAX);
    }

    pub(super) fn read(&self, offset: u32, now: u64) -> u32 {
        for (first, counter) in COUNTERS.iter().zip(&self.counters) {
            if offset == first + COUNT {
                return counter.value_at(now);
            }
        }
        match offset {
            COMPARE => self.compare,
            FLAGS => u32::from(self.flag),
            _ => self.stored.get(offset as usize / 4).copied().unwrap_or(0),
        }
    }

    pub(super) fn write(&mut self, offset: u32, value: u32, now: u64) {
        if let Some(stored) = self.stored.get_mut(offset as usize / 4) {
            *stored = value;
        }
        for (first, counter) in COUNTERS.iter().zip(&mut self.counters) {
            match offset.wrapping_sub(*first) {
                COUNT => (counter.value, counter.since) = (value, now),
                PRESCALER => counter.rebase(now),
                PRESCALE => {
                    counter.rebase(now);
                    counter.period = (u64::from(value) + 1) * 2;
                }
                _ => {}
            }
        }
        match offset {
            GLOBAL => self.start(value, now),
            COMPARE_CONTROL => self.uses_second = value & 1 != 0,
            COMPARE => self.compare = value,
            UPDATE => self.update = value,
            ENABLE => self.is_enabled |= value & 1 != 0,
            DISABLE => self.is_enabled &= value & 1 == 0,
            FLAGS => self.flag &= value & 1 == 0,
            _ => {}
        }
        if offset != FLAGS {
            self.schedule_match(now);
        }
    }

    fn start(&mut self, value: u32, now: u64) {
        for (number, counter) in self.counters.iter_mut().enumerate() {
            let runs = value >> number & 1 != 0;
            if runs != counter.runs {
                counter.rebase(now);
                counter.runs = runs;
            }
        }
    }
}
