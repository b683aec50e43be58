//! Waiting loops: recognised by their effects, and skipped in one step.
//!
//! If an iteration ends with the registers, the results in flight and every byte that it stored as they were before,
//! and no device was accessed, then every further iteration does the same until something outside changes. So as many
//! iterations are skipped as fit into the remaining time. Only the computer's clock shows the difference. Source:
//! `dsp-board.md` 9, "Skipping idle loops".

use super::pipeline::Picture;

/// Number of visits of a packet after which its loop is watched.
const ENOUGH: u8 = 8;
/// The longest iteration that is watched, in cycles.
const LONGEST: u64 = 4000;
/// The most stores of an iteration that are remembered.
const MOST_STORES: usize = 64;
/// Places that are counted, a power of two.
const PLACES: usize = 64;

/// A word that was stored to: its address, and its value before.
type OverwrittenWord = (u32, u32);

/// An iteration that is being watched.
#[derive(Clone, Debug)]
struct Iteration {
    picture: Picture,
    packets: u64,
    touches: u64,
    stores: Vec<OverwrittenWord>,
}

/// The number of visits to an address since the last event.
#[derive(Clone, Copy, Debug, Default)]
struct Visits {
    pc: u32,
    count: u8,
    /// The number of the last event before the first of these visits.
    since: u32,
}

/// The knowledge about loops since the last event.
#[derive(Clone, Debug)]
pub(super) struct IdleDetector {
    visits: [Visits; PLACES],
    /// Counts events. A program that polls a firmware function calls it millions of times, and each call is an event;
    /// so earlier visits become invalid by their number instead of being cleared.
    happened: u32,
    iteration: Option<Box<Iteration>>,
    /// True while stores are noted.
    pub(super) is_watching: bool,
    /// Cycles skipped so far.
    pub(super) skipped: u64,
}

impl Default for IdleDetector {
    fn default() -> Self {
        Self {
            visits: [Visits::default(); PLACES],
            happened: 0,
            iteration: None,
            is_watching: false,
            skipped: 0,
        }
    }
}

/// The action at the target of a backward branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BranchAction {
    /// Nothing.
    Pass,
    /// The address has been visited often enough to take a picture.
    TakePicture,
    /// The address of the picture is reached again.
    PictureReached,
}

impl IdleDetector {
    /// Drops all observations, because of an event.
    pub(super) fn clear(&mut self) {
        self.happened = self.happened.wrapping_add(1);
        if self.happened == 0 {
            self.visits = [Visits::default(); PLACES];
        }
        self.iteration = None;
        self.is_watching = false;
    }

    /// Called when a branch has gone back to `pc` in this cycle.
    #[inline(always)]
    pub(super) fn record_branch(&mut self, pc: u32, cycle: u64) -> BranchAction {
        if let Some(iteration) = &self.iteration {
            if iteration.picture.pc == pc {
                return BranchAction::PictureReached;
            }
            if cycle - iteration.picture.cycle > LONGEST {
                self.iteration = None;
                self.is_watching = false;
            }
            return BranchAction::Pass;
        }
        let place = &mut self.visits[pc as usize / 4 % PLACES];
        if (place.pc, place.since) != (pc, self.happened) {
            *place = Visits { pc, count: 0, since: self.happened };
        }
        place.count = place.count.saturating_add(1);
        if place.count == ENOUGH { BranchAction::TakePicture } else { BranchAction::Pass }
    }

    /// Starts to observe the iteration that begins here.
    pub(super) fn start_iteration(&mut self, picture: Picture, packets: u64, touches: u64) {
        self.iteration = Some(Box::new(Iteration { picture, packets, touches, stores: Vec::new() }));
        self.is_watching = true;
    }

    /// A word is stored to that holds `old`.
    #[cold]
    pub(super) fn store(&mut self, addr: u32, old: Option<u32>) {
        let Some(iteration) = &mut self.iteration else { return };
        let is_noted = iteration.stores.iter().any(|(known, _)| *known == addr);
        match old {
            Some(old) if iteration.stores.len() < MOST_STORES || is_noted => {
                if !is_noted {
                    iteration.stores.push((addr, old));
                }
            }
            // A device, or too many.
            _ => {
                self.iteration = None;
                self.is_watching = false;
            }
        }
    }

    /// Returns cycles and packets of the iteration that ends here, if it has changed nothing.
    pub(super) fn end(
        &mut self,
        now: &Picture,
        packets: u64,
        touches: u64,
        word: impl Fn(u32) -> Option<u32>,
    ) -> Option<(u64, u64)> {
        self.is_watching = false;
        let iteration = self.iteration.take()?;
        let is_same = touches == iteration.touches
            && iteration.picture.is_like(now)
            && iteration.stores.iter().all(|(addr, old)| word(*addr) == Some(*old));
        is_same.then(|| (now.cycle - iteration.picture.cycle, packets - iteration.packets))
    }
}
