//! The latency of servo interrupts, where threads lose the processor as on the board.
//!
//! The processor takes an interrupt only after the delay slots of branches. The interrupted thread gains these cycles
//! and the next thread loses them: so the code before a slice decides where the next thread is interrupted. Bytecode
//! has no delay slots; a pseudo-random number makes its slices uneven instead.

use kmotiondef::{Cycles, Ticks};

use super::Machine;
use crate::engine::{Engine, Preemption, Stop};
use crate::firmware::Firmware;
use crate::loaded::LoadedCode;
use crate::scheduler::SliceOwner;

/// The cycles by which servo interrupts differ for bytecode.
const UNEVENNESS: u64 = 64;

/// The most cycles for which the delay slots of a branch hold off an interrupt; longer delays come from firmware
/// functions.
const LONGEST_SHADOW: Cycles = Cycles::new(8);

/// The lateness of the interrupt in the system's thread of the released firmware, each value about as often as in 102 slices
/// between two counting threads.
const IN_SYSTEM_THREAD: [i64; 32] =
    [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 4, 5, 5, 9, 10, 12, 12, 13];

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Returns the cycles by which the slice begins late, in addition to the time of the interrupt, and clears their
    /// cause.
    pub(super) fn take_lateness(&mut self) -> Cycles {
        let shadow = self.shadow.take();
        if self.config.preemption == Preemption::Segments {
            return Cycles::default();
        }
        let bits = mix_tick(self.tick);
        if !self.is_image(self.turn) {
            return Cycles::new((bits % UNEVENNESS).cast_signed());
        }
        let number = bits as usize % IN_SYSTEM_THREAD.len();
        shadow.unwrap_or(Cycles::new(IN_SYSTEM_THREAD[number]))
    }

    /// Notes how far the slice of a thread has run beyond its end; returns the cycles that the thread's next slice
    /// loses for it.
    pub(super) fn overdrawn(&mut self, stop: &Stop, overdraft: Cycles) -> Cycles {
        let is_shadow = *stop == Stop::Preempted && overdraft <= LONGEST_SHADOW && self.is_image(self.turn);
        if !is_shadow || self.config.preemption == Preemption::Segments {
            return overdraft;
        }
        self.shadow = Some(overdraft);
        Cycles::default()
    }

    /// Returns whether the code of a thread is the processor's.
    fn is_image(&self, turn: SliceOwner) -> bool {
        let SliceOwner::User(thread) = turn else { return false };
        matches!(self.loaded[thread.index()], Some(LoadedCode::Image(_)))
    }
}

/// A pseudo-random number that depends only on the tick (the mixer of SplitMix64).
///
/// The length of the firmware's interrupt varies. Slices of equal length would end at the same point of a loop every
/// time, or never at that point.
fn mix_tick(tick: Ticks) -> u64 {
    let mut bits = tick.get().wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}
