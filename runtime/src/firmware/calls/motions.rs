//! The threads that move each axis, and the motions that they have waited for.
//!
//! Two threads that move the same axis at once, a wait for another axis than the one that moves, and an axis that is
//! disabled while a thread waits for it are mistakes that only several calls together show.

use kmotiondef::firmware::Function;
use kmotiondef::{Axes, AxisId, CodeAddr, Cycles, ThreadId};

/// A thread that asked about one axis while another one, which it moves itself, still moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WrongWait {
    /// The thread.
    pub(crate) thread: ThreadId,
    /// The axis that it asked about.
    pub(crate) asked: AxisId,
    /// The axis that it moves.
    pub(crate) moving: AxisId,
    /// The code address of the wait.
    pub(crate) at: Option<CodeAddr>,
}

/// A thread that zeroed an axis that it never moved, and not the one that it had moved to its switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WrongZero {
    pub(crate) thread: ThreadId,
    /// The axis that it zeroed.
    pub(crate) axis: AxisId,
    /// The axis that it had moved.
    pub(crate) homed: AxisId,
    /// The call that zeroed it.
    pub(crate) at: Option<CodeAddr>,
}

/// A thread that found an axis disabled while it waited for the end of its motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct EndedWait {
    /// The thread.
    pub(crate) thread: ThreadId,
    /// The axis; `None` for a path.
    pub(crate) axis: Option<AxisId>,
    /// The code address of the wait.
    pub(crate) at: Option<CodeAddr>,
}

/// A jog that a thread has begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JogRecord {
    pub(crate) thread: ThreadId,
    /// Dest at the call.
    pub(crate) dest: f64,
    /// Units per second.
    pub(crate) speed: f64,
    /// When the thread had last looked at anything.
    pub(crate) last_poll: Cycles,
}

/// A move of a few counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SmallMove {
    pub(crate) thread: ThreadId,
    pub(crate) at: Option<CodeAddr>,
    pub(crate) function: Function,
    /// Its distance.
    pub(crate) way: f64,
}

/// The place at which an axis was disabled in the middle of a move, and what became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DisabledMove {
    /// Dest then.
    At(f64),
    Shifted(PositionShift),
}

/// An axis was enabled as if it were at another place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PositionShift {
    /// Dest when it was disabled, and with which it was enabled.
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// The call that enabled it.
    pub(crate) thread: Option<ThreadId>,
    pub(crate) at: CodeAddr,
}

/// A motion that began while another axis moved, for which its thread had not waited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overlap {
    pub(crate) thread: ThreadId,
    pub(crate) function: Function,
    pub(crate) axis: AxisId,
    /// The axis that still moved.
    pub(crate) moving: AxisId,
    pub(crate) at: Option<CodeAddr>,
}

/// The history of one thread.
#[derive(Clone, Copy, Debug, Default)]
struct Thread {
    /// Axes that it has moved, and axes that it has found in motion; a bit for each.
    moved: u16,
    in_motion: u16,
    /// Axes that it has moved and that still moved when it had waited for another one; a bit for each.
    left_behind: u16,
    /// Axes that its last MoveXYZABC moves; a bit for each.
    together: u16,
    /// The axis for whose motion it has waited last.
    waited: Option<AxisId>,
    /// True if it has found a path under way.
    path_in_motion: bool,
    /// Axes that it has moved to their switches and not zeroed since; a bit for each.
    homed: u16,
    /// A call that zeroed another axis meanwhile.
    wrong_zero: Option<WrongZero>,
    wrong_wait: Option<WrongWait>,
    /// A wait that ended because the axis was disabled; a thread that looks into that asks again.
    ended_wait: Option<EndedWait>,
}

/// The history of all threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motions {
    /// The thread that last moved each axis.
    movers: [Option<ThreadId>; Axes::MAX],
    /// Mode and channels of each axis when a program enabled it.
    connections: [Option<[i32; 4]>; Axes::MAX],
    threads: [Thread; ThreadId::MAX as usize],
    /// The jog of each axis, and the length of its last move.
    jogged: [Option<JogRecord>; Axes::MAX],
    ways: [f64; Axes::MAX],
    /// Vel of each axis when its last move began.
    speeds: [f32; Axes::MAX],
    /// The first move of each axis if that and all others are of a few counts; nothing after any other motion.
    small: [SmallMoves; Axes::MAX],
    cut: [Option<DisabledMove>; Axes::MAX],
    /// The axes that any thread has asked about; a bit for each.
    asked: u16,
    /// The first motion that began while an axis still moved.
    overlaps: [Option<Overlap>; Axes::MAX],
}

/// The common property of the moves of an axis.
#[derive(Clone, Copy, Debug, Default)]
enum SmallMoves {
    #[default]
    Unmoved,
    All(SmallMove),
    Not,
}

const fn bit(axis: AxisId) -> u16 {
    1 << axis.get()
}

impl Motions {
    /// A program starts in a thread.
    pub(crate) fn start_thread(&mut self, thread: ThreadId) {
        self.threads[thread.index()] = Thread::default();
        for mover in &mut self.movers {
            mover.take_if(|mover| *mover == thread);
        }
    }

    /// Notes the length of a move of an axis; `small` if that is a few counts.
    pub(crate) fn record_move_length(&mut self, axis: AxisId, way: f64, small: Option<SmallMove>) {
        self.ways[axis.index()] = way;
        let all = &mut self.small[axis.index()];
        *all = match (*all, small) {
            (SmallMoves::Unmoved, Some(first)) => SmallMoves::All(first),
            (SmallMoves::All(first), Some(_)) => SmallMoves::All(first),
            (SmallMoves::Unmoved | SmallMoves::All(_), None) | (SmallMoves::Not, _) => SmallMoves::Not,
        };
    }

    /// An axis does something else than a move.
    pub(crate) fn goes_on(&mut self, axis: AxisId) {
        self.small[axis.index()] = SmallMoves::Not;
    }

    /// The first moves of the axes that have never moved by more than a few counts.
    pub(crate) fn small_moves(&self) -> impl Iterator<Item = (AxisId, SmallMove)> + '_ {
        AxisId::all().filter_map(|axis| match self.small[axis.index()] {
            SmallMoves::All(first) => Some((axis, first)),
            SmallMoves::Unmoved | SmallMoves::Not => None,
        })
    }

    /// A move of an axis begins with this Vel.
    pub(crate) fn begins_at(&mut self, axis: AxisId, speed: f32) {
        self.speeds[axis.index()] = speed;
    }

    /// Returns Vel of an axis when its last move began.
    pub(crate) fn speed(&self, axis: AxisId) -> f32 {
        self.speeds[axis.index()]
    }

    /// Returns the distance of the last move of an axis.
    pub(crate) fn last_distance(&self, axis: AxisId) -> f64 {
        self.ways[axis.index()]
    }

    /// An axis is disabled at a destination, in the middle of a move.
    pub(crate) fn record_disabled(&mut self, axis: AxisId, dest: f64) {
        self.cut[axis.index()] = Some(DisabledMove::At(dest));
    }

    /// An axis without a position of its own is enabled at a destination.
    pub(crate) fn goes_on_from(
        &mut self,
        axis: AxisId,
        to: f64,
        thread: Option<ThreadId>,
        at: Option<CodeAddr>,
    ) {
        const NEAR: f64 = 1.0;
        let Some(DisabledMove::At(from)) = self.cut[axis.index()] else { return };
        let at = at.filter(|_| (from - to).abs() > NEAR);
        self.cut[axis.index()] = at.map(|at| DisabledMove::Shifted(PositionShift { from, to, thread, at }));
    }

    /// An axis gets a new zero, or is on its way to one.
    pub(crate) fn is_found(&mut self, axis: AxisId) {
        self.cut[axis.index()] = None;
    }

    /// The shift of the zero of an axis, once.
    pub(crate) fn take_shift(&mut self, axis: AxisId) -> Option<PositionShift> {
        let cut = &mut self.cut[axis.index()];
        match *cut {
            Some(DisabledMove::Shifted(shift)) => {
                *cut = None;
                Some(shift)
            }
            Some(DisabledMove::At(_)) | None => None,
        }
    }

    /// A jog begins, or ends for `None`; the one before.
    pub(crate) fn jogs(&mut self, axis: AxisId, jog: Option<JogRecord>) -> Option<JogRecord> {
        std::mem::replace(&mut self.jogged[axis.index()], jog)
    }

    /// Returns whether a thread has found an axis in motion when it last asked.
    pub(crate) fn waits_for(&self, thread: ThreadId, axis: AxisId) -> bool {
        self.threads[thread.index()].in_motion & bit(axis) != 0
    }

    /// A program enables an axis with this mode and these channels.
    pub(crate) fn enabled(&mut self, axis: AxisId, connection: [i32; 4]) {
        self.connections[axis.index()] = Some(connection);
    }

    /// Mode and channels of an axis when a program enabled it.
    pub(crate) fn connection(&self, axis: AxisId) -> Option<[i32; 4]> {
        self.connections[axis.index()]
    }

    /// A thread moves an axis; the thread that moved it before, if that was another one.
    pub(crate) fn record_mover(&mut self, thread: ThreadId, axis: AxisId) -> Option<ThreadId> {
        let own = &mut self.threads[thread.index()];
        own.moved |= bit(axis);
        own.together &= !bit(axis);
        self.movers[axis.index()].replace(thread).filter(|before| *before != thread)
    }

    /// Notes that a thread has polled the motion of an axis, with the answer `done`. `is_moving` has the moving axes.
    pub(crate) fn record_poll(
        &mut self,
        thread: ThreadId,
        axis: AxisId,
        done: i32,
        at: Option<CodeAddr>,
        is_moving: impl Fn(AxisId) -> bool,
    ) {
        let mover = self.movers[axis.index()];
        self.asked |= bit(axis);
        let own = &mut self.threads[thread.index()];
        own.left_behind &= !bit(axis);
        if done != 0 && own.in_motion & bit(axis) != 0 {
            own.waited = Some(axis);
            let others = AxisId::all().filter(|other| own.moved & bit(*other) != 0 && is_moving(*other));
            own.left_behind = others.fold(own.left_behind, |all, other| all | bit(other));
        }
        own.wrong_wait.take_if(|wait| wait.moving == axis);
        own.ended_wait.take_if(|wait| wait.axis == Some(axis));
        let was_in_motion = own.in_motion & bit(axis) != 0;
        own.in_motion = if done == 0 { own.in_motion | bit(axis) } else { own.in_motion & !bit(axis) };
        let is_others = mover.is_some_and(|mover| mover != thread);
        if done != 0 && own.moved & bit(axis) == 0 && !is_others && own.wrong_wait.is_none() {
            let moving = AxisId::all().find(|other| own.moved & bit(*other) != 0 && is_moving(*other));
            own.wrong_wait = moving.map(|moving| WrongWait { thread, asked: axis, moving, at });
        }
        if was_in_motion && done < 0 {
            own.ended_wait = Some(EndedWait { thread, axis: Some(axis), at });
        }
    }

    /// A thread begins a motion of an axis; `is_on_its_way` says which axes are moving to a place.
    pub(crate) fn overlaps(&mut self, overlap: Overlap, is_on_its_way: impl Fn(AxisId) -> bool) {
        let own = &mut self.threads[overlap.thread.index()];
        own.left_behind &= !bit(overlap.axis);
        let left_behind = own.left_behind;
        for moving in AxisId::all().filter(|moving| left_behind & bit(*moving) != 0 && is_on_its_way(*moving))
        {
            self.overlaps[moving.index()].get_or_insert(Overlap { moving, ..overlap });
        }
    }

    /// A thread moves an axis to its place in the target of MoveXYZABC.
    pub(crate) fn moves_together(&mut self, thread: ThreadId, axis: AxisId) {
        self.threads[thread.index()].together |= bit(axis);
    }

    /// A thread acts after it has waited for an axis of its MoveXYZABC: that axis, and another one that `is_on_its_way`,
    /// once.
    pub(crate) fn part_left(
        &mut self,
        thread: ThreadId,
        is_on_its_way: impl Fn(AxisId) -> bool,
    ) -> Option<(AxisId, AxisId)> {
        let own = &mut self.threads[thread.index()];
        let left = own.left_behind & own.together;
        if left == 0 {
            return None;
        }
        let asked = own.waited.filter(|asked| own.together & bit(*asked) != 0)?;
        let moving = AxisId::all().find(|axis| left & bit(*axis) != 0 && is_on_its_way(*axis))?;
        own.together = 0;
        Some((asked, moving))
    }

    /// The motions that began while an axis still moved that nobody ever asks about.
    pub(crate) fn unasked_overlaps(&self) -> impl Iterator<Item = Overlap> + '_ {
        self.overlaps.iter().flatten().copied().filter(|overlap| self.asked & bit(overlap.moving) == 0)
    }

    /// A thread asks whether the path has ended, and is told `done`.
    pub(crate) fn asked_path(&mut self, thread: ThreadId, done: i32, at: Option<CodeAddr>) {
        let own = &mut self.threads[thread.index()];
        own.ended_wait = (own.path_in_motion && done < 0).then_some(EndedWait { thread, axis: None, at });
        own.path_in_motion = done == 0;
        own.left_behind &= !own.together;
        self.asked |= own.together;
    }

    /// A thread has moved an axis to its switch.
    pub(crate) fn record_homing(&mut self, thread: ThreadId, axis: AxisId) {
        self.threads[thread.index()].homed |= bit(axis);
    }

    /// A thread zeroes an axis; `is_away` says which axes are not at 0.
    pub(crate) fn record_zero(
        &mut self,
        thread: ThreadId,
        axis: AxisId,
        at: Option<CodeAddr>,
        is_away: impl Fn(AxisId) -> bool,
    ) {
        let own = &mut self.threads[thread.index()];
        own.homed &= !bit(axis);
        own.wrong_zero.take_if(|wrong| wrong.homed == axis);
        let homed = AxisId::all().find(|homed| own.homed & bit(*homed) != 0 && is_away(*homed));
        if let Some(homed) = homed.filter(|_| own.moved & bit(axis) == 0) {
            own.wrong_zero.get_or_insert(WrongZero { thread, axis, homed, at });
        }
    }

    /// The calls that zeroed another axis than the one that was moved, which no later call has made good.
    pub(crate) fn wrong_zeros(&self) -> impl Iterator<Item = WrongZero> + '_ {
        self.threads.iter().filter_map(|thread| thread.wrong_zero)
    }

    /// Returns the thread that last moved an axis.
    pub(crate) fn mover(&self, axis: AxisId) -> Option<ThreadId> {
        self.movers[axis.index()]
    }

    /// The wait of a thread that ended because its axis was disabled, unless it has looked into that.
    pub(crate) fn take_ended(&mut self, thread: ThreadId) -> Option<EndedWait> {
        self.threads[thread.index()].ended_wait.take()
    }

    /// The waits for another axis than the one that moved, which no later call has made good.
    pub(crate) fn wrong_waits(&self) -> impl Iterator<Item = WrongWait> + '_ {
        self.threads.iter().filter_map(|thread| thread.wrong_wait)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(number: i32) -> AxisId {
        AxisId::new(number).expect("an axis")
    }

    fn thread(number: i32) -> ThreadId {
        ThreadId::new(number).expect("a thread")
    }

    #[test]
    fn a_wait_for_the_wrong_axis_is_made_good_by_one_for_the_right_one() {
        let mut motions = Motions::default();
        motions.record_mover(thread(1), axis(1));
        let moves_1 = |other: AxisId| other == axis(1);
        motions.record_poll(thread(1), axis(0), 1, None, moves_1);
        assert_eq!(motions.wrong_waits().map(|wait| wait.moving).collect::<Vec<_>>(), [axis(1)]);
        motions.record_poll(thread(1), axis(1), 0, None, moves_1);
        assert_eq!(motions.wrong_waits().count(), 0);
    }

    #[test]
    fn another_threads_axis_may_be_waited_for() {
        let mut motions = Motions::default();
        motions.record_mover(thread(1), axis(1));
        assert_eq!(motions.record_mover(thread(2), axis(0)), None);
        motions.record_poll(thread(1), axis(0), 1, None, |_| true);
        assert_eq!(motions.wrong_waits().count(), 0);
        assert_eq!(motions.record_mover(thread(1), axis(0)), Some(thread(2)));
    }

    #[test]
    fn an_axis_that_stops_moving_by_being_disabled_is_noticed() {
        let mut motions = Motions::default();
        let mut ask = |done| {
            motions.record_poll(thread(1), axis(0), done, None, |_| false);
            motions.threads[thread(1).index()].ended_wait.and_then(|wait| wait.axis)
        };
        assert_eq!([-1, 0, -1].map(&mut ask), [None, None, Some(axis(0))]);
        assert_eq!(ask(-1), None, "a thread that asks again looks into it");
        assert_eq!([0, -1].map(&mut ask), [None, Some(axis(0))]);
        assert!(motions.take_ended(thread(1)).is_some() && motions.take_ended(thread(1)).is_none());
    }
}
