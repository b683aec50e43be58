//! State that firmware functions keep from call to call.

mod globals;
mod heap;
mod locks;
mod motions;
mod notices;
mod reading;
mod serial;
mod waits;

use kmotiondef::{Axes, AxisId, GuestAddr, ThreadId};
use vm::firmware::Caller;

use super::motion::PlanningStage;
use crate::io::kanalog::Group;

pub(crate) use globals::Globals;
pub(crate) use heap::Heap;
pub(crate) use locks::{HeldLock, Locks};
pub(crate) use motions::{
    EndedWait, JogRecord, Motions, Overlap, PositionShift, SmallMove, WrongWait, WrongZero,
};
pub(crate) use notices::{CommandedMotion, MotionCall, NamedObject, Notices};
pub(crate) use reading::FileState;
pub(crate) use serial::SerialService;
pub(crate) use waits::{RepeatedCall, Wait, Waits};

/// The state of a waiting call until it is repeated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Continuation {
    /// The text for which the console queue had no room, and the result of the call.
    Print {
        /// The text.
        rest: Vec<u8>,
        /// The result.
        result: i32,
    },
    /// The target or velocity of a motion when the call began, and the progress of the call.
    Motion(f64, PlanningStage),
    /// The axes that `MoveXYZABC` has yet to move, with their targets, the first axis last; and the progress of that
    /// one.
    Moves(Vec<(AxisId, f64)>, PlanningStage),
    /// A stop that has begun, with the axes that are still to be stopped once they are known.
    Stop(Option<Vec<AxisId>>),
    /// The axes that are still to continue after a feedhold, the first axis last; and the progress of that one.
    Resume(Vec<AxisId>, PlanningStage),
    /// The levels of Kanalog's outputs that the call has computed, and the progress of the call.
    Output(Group, OutputStage),
}

/// The progress of a call that switches one of Kanalog's outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OutputStage {
    /// It has read the last written value.
    Read,
    /// It has stored the new levels, and read them again to put them out.
    Stored,
}

/// The state of firmware functions.
#[derive(Clone, Debug)]
pub(crate) struct Calls {
    continuations: [Option<Continuation>; ThreadId::MAX as usize + 1],
    pub(crate) serial: SerialService,
    pub(crate) heap: Heap,
    /// The state of files on the PC.
    pub(crate) reading: FileState,
    pub(crate) globals: Globals,
    /// State of `rand`.
    pub(crate) seed: u32,
    /// The address at which `strtok` continues.
    pub(crate) token: GuestAddr,
    /// Ticks that a motion call plans before its motion begins.
    pub(crate) plan_ticks: u32,
    /// True if slices can end between any two memory accesses, even within a call.
    pub(crate) are_split: bool,
    /// For each axis, the number of consecutive motion calls that came while the previous one was still being planned.
    pub(crate) hurried_calls: [u8; Axes::MAX],
    /// The calls for which threads wait.
    pub(crate) waits: Waits,
    /// Observations that may become remarks later.
    pub(crate) notices: Notices,
    /// The threads that move each axis.
    pub(crate) motions: Motions,
    /// The threads that programs have started, one bit each.
    pub(crate) started: u8,
    /// The locks that threads hold.
    pub(crate) locks: Locks,
}

impl Default for Calls {
    fn default() -> Self {
        Self {
            continuations: Default::default(),
            serial: SerialService::default(),
            heap: Heap::default(),
            reading: FileState::default(),
            globals: Globals::default(),
            seed: 1,
            token: GuestAddr::NULL,
            plan_ticks: 0,
            are_split: false,
            hurried_calls: [0; Axes::MAX],
            waits: Waits::default(),
            notices: Notices::default(),
            motions: Motions::default(),
            started: 0,
            locks: Locks::default(),
        }
    }
}

impl Calls {
    /// The next number of `rand`, 0 to 32767: the generator of the C standard's example, as measured.
    pub(crate) const fn random(&mut self) -> i32 {
        self.seed = self.seed.wrapping_mul(1_103_515_245).wrapping_add(12_345);
        (self.seed >> 16 & 0x7fff).cast_signed()
    }

    /// Keeps state for the repetition of the call after its wake event.
    pub(crate) fn store(&mut self, caller: &Caller<'_>, continuation: Continuation) {
        self.continuations[slot(caller.thread)] = Some(continuation);
    }

    /// Takes the state that the call left.
    pub(crate) fn take(&mut self, caller: &Caller<'_>) -> Option<Continuation> {
        self.continuations[slot(caller.thread)].take()
    }

    /// Restarts the board: all state of the firmware is as at power-up.
    pub(crate) fn restart(&mut self) {
        self.continuations = Default::default();
        self.reading = FileState::default();
        self.serial = SerialService::default();
        self.heap = Heap::default();
        self.waits = Waits::default();
        self.seed = 1;
        self.token = GuestAddr::NULL;
    }
}

fn slot(thread: Option<ThreadId>) -> usize {
    thread.map_or(0, |thread| usize::from(thread.get()))
}
