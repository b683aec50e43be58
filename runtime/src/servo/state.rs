//! The servo's state outside guest memory, and the data of a servo tick.

use kmotiondef::modes::LastMotion;
use kmotiondef::variables::COORD_SYSTEM0;
use kmotiondef::{Axes, AxisId, CodeAddr, Cycles, ThreadId};
use vm::memory::GuestMemory;

use super::cache::Cache;
use super::coordinated::{CoordinatedMotion, path, system};
use super::moves::Planner;
use super::stop::StopRequest;
use super::trajectory::TICKS_PER_SECOND;
use super::{independent, recorder};
use crate::io::Io;
use crate::machine::Machine;
use crate::out::{Message, Out};
use crate::views::TypedAccess;

/// The servo's state of an axis in addition to its structure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisMemory {
    /// Destination at the end of the last tick.
    pub(crate) dest: f64,
    /// True if the axis has been enabled since, so that another destination is one that a program has written.
    pub(super) knows_dest: bool,
    /// The velocity in the last tick, for the feed forward.
    pub(super) velocity: f32,
    /// Sum of output times motion since the axis was enabled: above 0 if the output moves the position in its own
    /// direction.
    pub(super) response: f64,
    /// The distance covered by the destination since the axis was enabled, and the distance of the position in the same
    /// direction.
    pub(super) commanded: f64,
    pub(super) followed: f64,
    /// Magnitude of the position's speed in units per tick, over some ticks.
    pub(super) speed: f64,
    /// True if a remark has told the cause of its following error since it was enabled: a hard stop, a written position.
    pub(super) is_explained: bool,
    /// The farthest distance of the position ahead of a moving destination.
    pub(super) ahead: f64,
    /// Changes of the output from one half of its range to the other, in one tick each.
    pub(super) flips: u32,
    /// Change of the position in this tick.
    pub(super) moved: f64,
    /// True if the servo has run the axis since it was enabled.
    pub(super) has_run: bool,
    /// The velocity in the previous tick.
    pub(super) last_velocity: f32,
    /// The analog output that the axis wrote in the last tick, and the word.
    pub(super) analog: Option<(usize, i16)>,
    /// The kind of motion that a feedhold interrupted.
    pub(crate) held: Option<LastMotion>,
}

impl AxisMemory {
    /// Rests at `dest`, so that no velocity is seen.
    pub(crate) fn rest(dest: f64) -> Self {
        Self { dest, knows_dest: true, ..Self::default() }
    }

    /// The position has moved in this tick.
    #[inline(always)]
    pub(super) fn note_way(&mut self, moved: f64) {
        /// The part of a tick in the average of the speed.
        const WEIGHT: f64 = 1.0 / 64.0;
        self.moved = moved;
        if self.velocity != 0.0 {
            self.commanded += f64::from(self.velocity.abs()) / TICKS_PER_SECOND;
            self.followed += moved * f64::from(self.velocity.signum());
        }
        self.speed += (moved.abs() - self.speed) * WEIGHT;
    }

    /// Returns whether a position at the distance `rest` from its destination is approaching it, fast enough to cover
    /// that distance in a second.
    pub(crate) fn is_settling(&self, rest: f64) -> bool {
        self.speed * TICKS_PER_SECOND > rest
    }
}

/// The place of a call: its thread, `None` for the call-back, and its instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CallPlace {
    pub(crate) thread: Option<ThreadId>,
    pub(crate) at: Option<CodeAddr>,
}

/// The servo's state in addition to guest memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Servo {
    /// The last call of a program, and the last call that commanded each axis, which later events of the axis are
    /// attributed to.
    pub(crate) last_call: Option<CallPlace>,
    pub(crate) commands: [Option<CallPlace>; Axes::MAX],
    pub(crate) axes: [AxisMemory; Axes::MAX],
    /// The values derived from guest memory.
    pub(crate) cache: Cache,
    pub(super) coordinated: CoordinatedMotion,
    pub(super) stop_request: StopRequest,
    /// The planner of the firmware for moves of single axes.
    pub(crate) planner: Planner,
}

impl Servo {
    /// Moves an axis to its destination in a single step, without a visible velocity.
    pub(crate) fn jump(&mut self, axis: AxisId, dest: f64) {
        self.axes[axis.index()] = AxisMemory::rest(dest);
    }

    /// Returns whether a path or a single axis moves, or a recording is in progress.
    pub(crate) fn is_busy(memory: &GuestMemory) -> bool {
        recorder::is_recording(memory)
            || path::is_under_way(memory)
            || memory.axes().iter().any(|axis| independent::is_moving(memory, axis))
    }
}

/// The parts of the board on which a tick of the servo works, in addition to guest memory.
#[derive(Debug)]
pub(crate) struct Tick<'a> {
    pub(crate) servo: &'a mut Servo,
    pub(crate) machine: &'a mut Machine,
    pub(crate) io: &'a mut Io,
    pub(crate) out: &'a mut Out,
    /// When the tick began.
    pub(crate) now: Cycles,
}

impl Tick<'_> {
    /// Makes a remark about an axis, attributed to the call that has commanded it; a path is the result of many calls.
    pub(crate) fn remark_on_axis(&mut self, memory: &GuestMemory, axis: AxisId, message: Message) {
        let is_on_path = system::is_member(memory, axis) && !memory.get(COORD_SYSTEM0).is_null();
        let command = self.servo.commands[axis.index()].filter(|_| !is_on_path);
        self.remark_at(command, message);
    }

    /// Makes a remark about a value that a program has stored, attributed to its last call.
    pub(crate) fn remark_near(&mut self, message: Message) {
        self.remark_at(self.servo.last_call, message);
    }

    fn remark_at(&mut self, place: Option<CallPlace>, message: Message) {
        match place {
            Some(CallPlace { thread, at }) => self.out.remark_of(self.now, thread.into(), at, message),
            None => self.out.remark(self.now, message),
        }
    }
}
