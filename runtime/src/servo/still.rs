//! Standing still: a tick that would change nothing is not computed.
//!
//! A tick of the axes is a function of their data in guest memory and of the state of the servo. If one tick has
//! changed nothing, neither will the next, until other code writes there. So it is enough to compare the axis
//! structures, the words of the outputs, which an axis writes in each tick, and the analog inputs.

use kmotiondef::structs::Chan;
use kmotiondef::variables::{ADC_BUFFER_IN, CHAN, DAC_BUFFER, LAST_PWM};
use kmotiondef::{GuestAddr, GuestType};
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// Bytes of the amplifiers' words, the analog outputs and the analog inputs.
const PWM_SIZE: usize = 64;
const DAC_SIZE: usize = 16;
const ADC_SIZE: usize = 32;

/// The memory of the axes after the last computed tick.
#[derive(Clone, Debug)]
pub(crate) struct Stillness {
    chans: Vec<u8>,
    pwm: [u8; PWM_SIZE],
    dac: [u8; DAC_SIZE],
    adc: [u8; ADC_SIZE],
    /// True if the copy is valid.
    is_known: bool,
    /// True if that tick began with this state and changed nothing.
    is_still: bool,
    is_watching: bool,
}

impl Default for Stillness {
    fn default() -> Self {
        Self {
            chans: Vec::new(),
            pwm: [0; PWM_SIZE],
            dac: [0; DAC_SIZE],
            adc: [0; ADC_SIZE],
            is_known: false,
            is_still: false,
            is_watching: false,
        }
    }
}

impl Stillness {
    /// Returns whether the last tick changed nothing and nothing has been written since. If `is_touched` is false, the
    /// axis structures, which are most of the data, have not been written to.
    pub(super) fn is_still(&self, memory: &GuestMemory, is_touched: bool) -> bool {
        debug_assert!(
            is_touched || !self.is_still || self.has_seen_axes(memory),
            "an axis has changed unnoticed"
        );
        self.is_still
            && !self.is_watching
            && self.has_seen_outputs(memory)
            && (!is_touched || self.has_seen_axes(memory))
    }

    /// Notes whether a tick that is computed begins with the state left by the last one.
    pub(super) fn begin(&mut self, memory: &GuestMemory) {
        self.is_known = self.is_known && self.is_seen(memory);
        self.is_still = false;
        self.is_watching = false;
    }

    /// Something moves, or has been changed outside memory.
    pub(super) const fn interrupt(&mut self) {
        self.is_known = false;
        self.is_still = false;
    }

    /// An axis depends on inputs that are not compared: every tick is computed.
    pub(super) const fn watch(&mut self) {
        self.is_watching = true;
    }

    /// Ends a tick that has moved nothing; returns whether it has changed nothing at all.
    pub(super) fn end(&mut self, memory: &GuestMemory) -> bool {
        self.is_still = self.is_known && self.is_seen(memory);
        if !self.is_still {
            self.chans.clear();
            self.chans.extend_from_slice(structures(memory));
            copy(memory, memory.locate(LAST_PWM), &mut self.pwm);
            copy(memory, memory.locate(DAC_BUFFER), &mut self.dac);
            copy(memory, memory.locate(ADC_BUFFER_IN), &mut self.adc);
            self.is_known = true;
        }
        self.is_still
    }

    /// Returns whether memory is unchanged.
    fn is_seen(&self, memory: &GuestMemory) -> bool {
        self.has_seen_axes(memory) && self.has_seen_outputs(memory)
    }

    fn has_seen_axes(&self, memory: &GuestMemory) -> bool {
        *structures(memory) == *self.chans
    }

    /// Those of the words of the outputs and the analog inputs.
    fn has_seen_outputs(&self, memory: &GuestMemory) -> bool {
        memory.block(memory.locate(LAST_PWM)) == Some(&self.pwm)
            && memory.block(memory.locate(DAC_BUFFER)) == Some(&self.dac)
            && memory.block(memory.locate(ADC_BUFFER_IN)) == Some(&self.adc)
    }
}

/// The structures of all axes of the board.
fn structures(memory: &GuestMemory) -> &[u8] {
    let size = Chan::SIZE * memory.axes().count() as u32;
    memory.read_bytes(memory.locate(CHAN), size).unwrap_or_default()
}

fn copy<const N: usize>(memory: &GuestMemory, address: GuestAddr, to: &mut [u8; N]) {
    if let Some(bytes) = memory.block(address) {
        *to = *bytes;
    }
}
