//! The 48 pins in groups of eight: latches, directions, what drives inputs (`dsp-board.md` 7.1).

/// Groups.
const GROUPS: usize = 6;

/// The pins.
#[derive(Clone, Debug, Default)]
pub(super) struct Pins {
    latch: [u8; GROUPS],
    direction: [u8; GROUPS],
    driven: [u8; GROUPS],
    /// Changes of outputs since the last time: cycle, pin, level.
    changes: Vec<(u64, u8, bool)>,
}

impl Pins {
    /// Sets bits of a latch.
    pub(super) fn set(&mut self, group: usize, bits: u16, now: u64) {
        self.change(group, now, |latch, _| *latch |= bits as u8);
    }

    /// Keeps only these bits of a latch.
    pub(super) fn keep(&mut self, group: usize, bits: u16, now: u64) {
        self.change(group, now, |latch, _| *latch &= bits as u8);
    }

    /// Which pins are outputs.
    pub(super) fn direct(&mut self, group: usize, bits: u16, now: u64) {
        self.change(group, now, |_, direction| *direction = bits as u8);
    }

    fn change(&mut self, group: usize, now: u64, how: impl FnOnce(&mut u8, &mut u8)) {
        let (Some(latch), Some(direction)) = (self.latch.get_mut(group), self.direction.get_mut(group))
        else {
            return;
        };
        let before = *latch & *direction;
        how(latch, direction);
        let after = *latch & *direction;
        for bit in (0..8).filter(|bit| (before ^ after) >> bit & 1 != 0) {
            self.changes.push((now, group as u8 * 8 + bit, after >> bit & 1 != 0));
        }
    }

    /// What the firmware reads.
    pub(super) fn read(&self, group: usize) -> u16 {
        let (Some(latch), Some(direction), Some(driven)) =
            (self.latch.get(group), self.direction.get(group), self.driven.get(group))
        else {
            return 0;
        };
        u16::from(driven & !direction | latch & direction)
    }

    /// Drives an input from outside.
    pub(super) fn drive(&mut self, pin: usize, level: bool) {
        if let Some(driven) = self.driven.get_mut(pin / 8) {
            let mask = 1 << (pin % 8);
            *driven = if level { *driven | mask } else { *driven & !mask };
        }
    }

    /// Whether a pin is high, as an output or as it is driven.
    pub(super) fn is_high(&self, pin: usize) -> bool {
        self.read(pin / 8) >> (pin % 8) & 1 != 0
    }

    /// Which pins of a group are outputs.
    pub(super) fn directions(&self, group: usize) -> u8 {
        self.direction.get(group).copied().unwrap_or(0)
    }

    /// The latches of a group.
    pub(super) fn latch(&self, group: usize) -> u8 {
        self.latch.get(group).copied().unwrap_or(0)
    }

    /// Changes of outputs since the last time.
    pub(super) fn take_changes(&mut self) -> Vec<(u64, u8, bool)> {
        std::mem::take(&mut self.changes)
    }
}
