//! The cycles by which a servo interrupt comes late, where threads lose the processor as on the board.
//!
//! The processor takes an interrupt when the branches before it have been made. What it waits for that, the interrupted
//! thread has and the next one lacks: so it is the code before a slice that decides where in its own code a thread is
//! interrupted next. Bytecode has no shadows of branches; its slices are uneven by a number of their own.

use kmotiondef::{Cycles, Ticks};

use super::Machine;
use crate::engine::{Engine, Preemption, Stop};
use crate::firmware::Firmware;
use crate::loaded::Loaded;
use crate::scheduler::Turn;

/// The cycles by which servo interrupts differ for bytecode.
const UNEVENNESS: u64 = 64;

/// The most cycles for which the shadow of a branch holds off an interrupt; what is beyond is a function of the firmware.
const LONGEST_SHADOW: Cycles = Cycles::new(8);

/// The lateness of the interrupt in the system's thread of the released firmware, each value about as often as in 102 slices
/// between two counting threads.
const IN_SYSTEM_THREAD: [i64; 32] =
    [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 4, 5, 5, 9, 10, 12, 12, 13];

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// The cycles by which the present slice begins later than the interrupt takes, and forgets what they follow from.
    pub(super) fn take_lateness(&mut self) -> Cycles {
        let shadow = self.shadow.take();
        if self.config.preemption == Preemption::Segments {
            return Cycles::default();
        }
        let bits = mixed(self.tick);
        if !self.is_image(self.turn) {
            return Cycles::new((bits % UNEVENNESS).cast_signed());
        }
        let number = bits as usize % IN_SYSTEM_THREAD.len();
        shadow.unwrap_or(Cycles::new(IN_SYSTEM_THREAD[number]))
    }

    /// Notes how far the slice of a thread has gone beyond its end; returns what that thread's next slice lacks for it.
    pub(super) fn overdrawn(&mut self, stop: &Stop, overdraft: Cycles) -> Cycles {
        let is_shadow = *stop == Stop::Preempted && overdraft <= LONGEST_SHADOW && self.is_image(self.turn);
        if !is_shadow || self.config.preemption == Preemption::Segments {
            return overdraft;
        }
        self.shadow = Some(overdraft);
        Cycles::default()
    }

    /// Returns whether the code of a thread is the processor's.
    fn is_image(&self, turn: Turn) -> bool {
        let Turn::User(thread) = turn else { return false };
        matches!(self.loaded[thread.index()], Some(Loaded::Image(_)))
    }
}

/// A number that is as good as random and a function of the tick alone (the mixer of SplitMix64).
///
/// The firmware's interrupt is not always equally long. Slices that were would end in the same place of a loop each
/// time, or never there.
fn mixed(tick: Ticks) -> u64 {
    let mut bits = tick.get().wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}
