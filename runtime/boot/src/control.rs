//! Control registers without side effects: memory controller, PLL, serial ports as pins, cache (`dsp-board.md` 3.1).

use std::collections::BTreeMap;

/// The registers of port 0 that carry the serial configuration: written a million times during a start.
const PORT: u32 = 0x4400_0018;
/// The register with the number of words still to be removed from the code cache: always 0.
const CACHE_LEFT: u32 = 0x2000_0004;

/// The written values.
#[derive(Clone, Debug, Default)]
pub(super) struct Control {
    port: u32,
    words: BTreeMap<u32, u32>,
}

impl Control {
    /// Returns whether a control register is at an address.
    pub(super) const fn has(addr: u32) -> bool {
        matches!(addr >> 12, 0x20000 | 0x41000 | 0x44000 | 0x45000 | 0xF0000)
    }

    pub(super) fn read(&self, addr: u32) -> u32 {
        match addr {
            PORT => self.port,
            CACHE_LEFT => 0,
            _ => self.words.get(&addr).copied().unwrap_or(0),
        }
    }

    pub(super) fn write(&mut self, addr: u32, value: u32) {
        if addr == PORT {
            self.port = value;
        } else {
            self.words.insert(addr, value);
        }
    }
}
