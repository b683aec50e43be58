//! A timeline: the past of a session, with access to any tick of it, backward and forward.
//!
//! Snapshots are taken at intervals measured in the computer's work; the time between two of them is executed again,
//! with the manual actions repeated at their ticks. Older snapshots are kept at larger intervals, so that their number
//! does not grow with the length of a session. A different action in the past begins a new line of history: the later
//! events are forgotten, or kept as a [branch](Timeline::keep_branches) to which the session can return.

use std::sync::Arc;

use kmotiondef::Ticks;
use runtime::Event;

use super::{Input, Session, Snapshot};
use crate::error::SnapshotError;
use crate::target::Target;

/// The work between two snapshots: some hundredths of a second on a typical computer.
const INTERVAL: u64 = 60_000_000;

/// The number of parts into which the snapshots of a replay divide an interval.
const PARTS: u64 = 8;

/// The maximum number of snapshots; each takes a few hundred KiB besides the memory pages that differ.
const MOST: usize = 256;

/// The reason for which a session cannot be taken to a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TimelineError {
    /// The timeline begins later.
    #[error("the timeline starts at tick {}", .0.get())]
    TooEarly(Ticks),
    /// The target does not support snapshots, or they belong to another session.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// The relation of the present to the recorded history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum History {
    /// The present follows the history.
    Same,
    /// A different action was made: a new line begins, and the history after this tick is forgotten.
    New(Ticks),
}

/// A snapshot, and its position: the work since the beginning of the line.
#[derive(Debug)]
struct Mark<T: Target> {
    snapshot: Arc<Snapshot<T>>,
    place: u64,
    /// True if the journal alone does not lead to it from an earlier snapshot.
    is_needed: bool,
}

impl<T: Target> Clone for Mark<T> {
    fn clone(&self) -> Self {
        Self { snapshot: Arc::clone(&self.snapshot), ..*self }
    }
}

/// Identifies a branch of a timeline.
pub type BranchId = u64;

/// A line of history that was left: it is kept complete, and shares snapshots with the others.
#[derive(Debug)]
pub struct Branch<T: Target> {
    /// The identifier.
    pub id: BranchId,
    /// The tick after which it was left.
    pub from: Ticks,
    /// Its last tick.
    pub end: Ticks,
    marks: Vec<Mark<T>>,
    journal: Vec<(Ticks, Input)>,
}

/// The past of one session.
///
/// ```
/// use cc67_host::{Setup, Timeline};
///
/// let mut session = Setup::default().session()?;
/// let mut timeline = Timeline::new(&mut session)?;
/// session.act(r#"command "EnableAxis0;Jog0=1000""#)?;
/// timeline.advance(&mut session, kmotiondef::Ticks::new(10_000), &mut |_| ());
/// let then = session.read("chan[0].Dest")?;
/// timeline.go_to(&mut session, kmotiondef::Ticks::new(2_000))?;
/// assert!(session.read("chan[0].Dest")? < then);
/// timeline.go_to(&mut session, kmotiondef::Ticks::new(10_000))?;
/// assert_eq!(session.read("chan[0].Dest")?, then);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Timeline<T: Target> {
    /// The snapshots in the order of time; there is at least one.
    marks: Vec<Mark<T>>,
    /// The inputs on this line.
    journal: Vec<(Ticks, Input)>,
    /// The number of journal entries that have been applied to the session.
    done: usize,
    end: Ticks,
    /// The session's work, and its position on the line, when the position was last set.
    base: (u64, u64),
    /// Work between two snapshots.
    interval: u64,
    /// Lines that were left, the oldest first, and the maximum number that is kept.
    branches: Vec<Branch<T>>,
    most_branches: usize,
    /// The number of branches created so far.
    branch_count: u64,
}

impl<T: Target> Timeline<T> {
    /// Creates a timeline that begins now.
    ///
    /// # Errors
    /// The target does not support snapshots.
    pub fn new(session: &mut Session<T>) -> Result<Self, SnapshotError> {
        let journal = session.journal().to_vec();
        let (work, end) = (session.work(), session.tick());
        let first = Mark { snapshot: Arc::new(session.snapshot()?), place: 0, is_needed: true };
        let (marks, done) = (vec![first], journal.len());
        let (base, interval, branches) = ((work, 0), INTERVAL, Vec::new());
        Ok(Self { marks, done, journal, end, base, interval, branches, most_branches: 0, branch_count: 0 })
    }

    /// Keeps up to this many of the lines that are left when a different action is made in the past; initially 0.
    pub fn keep_branches(&mut self, most: usize) {
        self.most_branches = most;
        self.drop_oldest_branches();
    }

    /// The branches that are kept, the oldest first.
    pub fn branches(&self) -> &[Branch<T>] {
        &self.branches
    }

    /// Forgets a branch; returns whether it existed.
    pub fn forget_branch(&mut self, id: BranchId) -> bool {
        let count = self.branches.len();
        self.branches.retain(|branch| branch.id != id);
        self.branches.len() < count
    }

    /// Takes the session to the end of a branch. The line that it was on becomes a branch itself. Returns the last tick
    /// that both lines have in common; `None` if there is no such branch.
    ///
    /// # Errors
    /// [`SnapshotError`].
    pub fn take_branch(
        &mut self,
        session: &mut Session<T>,
        id: BranchId,
    ) -> Result<Option<Ticks>, SnapshotError> {
        let _ = self.keep(session);
        let Some(index) = self.branches.iter().position(|branch| branch.id == id) else { return Ok(None) };
        let common = self.common(&self.branches[index]);
        let before = self.branches[index].marks.iter().rposition(|mark| mark.snapshot.tick() <= common);
        let taken = self.branches.remove(index);
        if self.end > common {
            self.leave(common);
        }
        (self.marks, self.journal, self.end) = (taken.marks, taken.journal, taken.end);
        self.restore(session, before.unwrap_or_default())?;
        // A change that is not in a journal was made at a needed snapshot: the line continues from there.
        let needed = self.marks.iter().filter(|mark| mark.is_needed && mark.snapshot.tick() > common);
        for place in needed.map(|mark| mark.place).collect::<Vec<_>>() {
            let tick = self.marks.iter().find(|mark| mark.place == place).map(|mark| mark.snapshot.tick());
            if let Some(tick) = tick {
                self.replay(session, tick);
                self.restore_place(session, place)?;
            }
        }
        self.replay(session, self.end);
        Ok(Some(common))
    }

    /// The last tick up to which this line and a branch are the same; `None` if there is no such branch.
    #[must_use]
    pub fn common_with(&self, id: BranchId) -> Option<Ticks> {
        self.branches.iter().find(|branch| branch.id == id).map(|branch| self.common(branch))
    }

    /// Returns the tick up to which a branch has the inputs of the present run.
    fn common(&self, branch: &Branch<T>) -> Ticks {
        let pairs = self.journal.iter().zip(&branch.journal);
        let same = pairs.take_while(|(one, other)| one == other).count();
        let next = [&self.journal, &branch.journal].map(|journal| journal.get(same).map(|(tick, _)| *tick));
        next.into_iter().flatten().fold(self.end.min(branch.end), Ticks::min)
    }

    /// Keeps the present line as a branch that was left after a tick.
    fn leave(&mut self, from: Ticks) {
        if self.most_branches == 0 {
            return;
        }
        self.branch_count += 1;
        let (marks, journal) = (self.marks.clone(), self.journal.clone());
        self.branches.push(Branch { id: self.branch_count, from, end: self.end, marks, journal });
        self.drop_oldest_branches();
    }

    fn drop_oldest_branches(&mut self) {
        let surplus = self.branches.len().saturating_sub(self.most_branches);
        self.branches.drain(..surplus);
    }

    /// Sets the work of the engine between two snapshots, roughly a number of instructions. More snapshots take more
    /// memory, and make going back faster.
    pub fn keep_every(&mut self, work: u64) {
        self.interval = work.max(1);
    }

    /// The first tick to which the timeline can go.
    #[must_use]
    pub fn begin(&self) -> Ticks {
        self.marks.first().map_or(self.end, |mark| mark.snapshot.tick())
    }

    /// The last tick of this line that the session has reached.
    #[must_use]
    pub const fn end(&self) -> Ticks {
        self.end
    }

    /// The ticks of the snapshots, ascending: they can be reached without execution.
    pub fn snapshots(&self) -> impl DoubleEndedIterator<Item = Ticks> + '_ {
        self.marks.iter().map(|mark| mark.snapshot.tick())
    }

    /// The bytes of guest memory held by the snapshots.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let pairs = self.marks.iter().zip(self.marks.iter().skip(1));
        pairs.map(|(one, next)| next.snapshot.bytes_beyond(&one.snapshot)).sum()
    }

    /// Lets time pass to the end of tick `limit`, even when everything has ended.
    pub fn advance(
        &mut self,
        session: &mut Session<T>,
        limit: Ticks,
        events: &mut dyn FnMut(Event),
    ) -> History {
        let mut history = self.keep(session);
        while session.tick() < limit {
            session.step(limit, events);
            if let new @ History::New(_) = self.keep(session) {
                history = new;
            }
        }
        history
    }

    /// Records the progress of the session since the last call: must be called after every call that lets time pass or
    /// acts, at least every few hundredths of a second. Takes a snapshot if one is due.
    pub fn keep(&mut self, session: &mut Session<T>) -> History {
        let history = self.note(session);
        self.end = self.end.max(session.tick());
        if session.held().is_none() {
            self.mark_after(session, self.interval);
        }
        history
    }

    /// Does the same after a change that is not in a journal, such as a new value of a register: always takes a
    /// snapshot, and forgets later history.
    pub fn branch(&mut self, session: &mut Session<T>) -> History {
        let noted = self.note(session);
        let place = self.place(session);
        let (tick, is_past) = (session.tick(), self.end > session.tick() || self.is_known(place));
        if self.end > tick {
            self.leave(tick);
        }
        self.drop_snapshot(place);
        self.journal.truncate(self.done);
        self.end = tick;
        // There was a snapshot at the beginning, so the target supports them.
        if let Ok(snapshot) = session.snapshot() {
            self.marks.push(Mark { snapshot: Arc::new(snapshot), place, is_needed: true });
        }
        if is_past || noted != History::Same { History::New(tick) } else { History::Same }
    }

    /// Takes the session to the end of a tick, back or forward, repeating the recorded actions.
    ///
    /// # Errors
    /// [`TimelineError::TooEarly`] for a tick before the first snapshot.
    pub fn go_to(&mut self, session: &mut Session<T>, tick: Ticks) -> Result<(), TimelineError> {
        let _ = self.keep(session);
        let index = self.marks.iter().rposition(|mark| mark.snapshot.tick() <= tick);
        let index = index.ok_or_else(|| TimelineError::TooEarly(self.begin()))?;
        self.restore(session, index)?;
        self.replay(session, tick);
        Ok(())
    }

    /// Restores a snapshot.
    ///
    /// # Errors
    /// [`SnapshotError`].
    pub fn restore(&mut self, session: &mut Session<T>, index: usize) -> Result<(), SnapshotError> {
        let Some(mark) = self.marks.get(index) else { return Ok(()) };
        session.restore(&mark.snapshot)?;
        self.base = (session.work(), mark.place);
        self.done = session.journal().len();
        Ok(())
    }

    /// The position of the last snapshot before a position, or of the last of all. Positions count the work since the
    /// beginning; unlike indexes, they remain valid while the past is executed again and snapshots come and go.
    #[must_use]
    pub fn before(&self, place: Option<u64>) -> Option<u64> {
        let count =
            place.map_or(self.marks.len(), |place| self.marks.partition_point(|mark| mark.place < place));
        self.marks.get(count.checked_sub(1)?).map(|mark| mark.place)
    }

    /// Restores the snapshot at a position, or the last one before it if that was dropped.
    ///
    /// # Errors
    /// [`SnapshotError`].
    pub fn restore_place(&mut self, session: &mut Session<T>, place: u64) -> Result<(), SnapshotError> {
        let count = self.marks.partition_point(|mark| mark.place <= place);
        self.restore(session, count.saturating_sub(1))
    }

    /// Runs the session to the end of a tick, repeating the recorded actions on the way.
    pub fn replay(&mut self, session: &mut Session<T>, tick: Ticks) {
        loop {
            self.redo(session);
            if session.tick() >= tick && session.held().is_none() {
                return;
            }
            let next = self.next_input().map_or(tick, |next| next.min(tick));
            session.step(next, &mut |_| ());
            if session.held().is_none() {
                self.mark_after(session, self.interval / PARTS);
            }
        }
    }

    /// The tick of the next recorded action; a session that continues stops there to repeat it.
    #[must_use]
    pub fn next_input(&self) -> Option<Ticks> {
        self.journal.get(self.done).map(|(tick, _)| *tick)
    }

    /// Repeats the actions recorded after the present tick; does nothing while a tick is held.
    pub fn redo(&mut self, session: &mut Session<T>) {
        if session.held().is_some() {
            return;
        }
        while let Some((_, input)) = self.journal.get(self.done).filter(|(tick, _)| *tick == session.tick()) {
            let done = session.redo(input);
            debug_assert!(done.is_ok(), "it could be done before: {done:?}");
            self.done += 1;
        }
    }

    /// Returns the number of snapshots.
    #[must_use]
    pub fn len(&self) -> usize {
        self.marks.len()
    }

    /// Returns false: there is always at least one snapshot.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// Compares new actions with the recorded ones.
    fn note(&mut self, session: &Session<T>) -> History {
        let mut history = History::Same;
        for entry in session.journal().get(self.done..).unwrap_or_default() {
            if self.journal.get(self.done) != Some(entry) {
                let is_past = self.done < self.journal.len() || self.end > entry.0;
                if is_past {
                    history = History::New(entry.0);
                    if self.end > entry.0 {
                        self.leave(entry.0);
                    }
                    self.journal.truncate(self.done);
                    self.marks.retain(|mark| mark.snapshot.tick() <= entry.0);
                    self.end = entry.0;
                }
                self.journal.push(entry.clone());
            }
            self.done += 1;
        }
        history
    }

    /// Returns the position of the session on the line.
    fn place(&self, session: &Session<T>) -> u64 {
        self.base.1 + (session.work() - self.base.0)
    }

    /// Returns whether the line extends beyond a position.
    fn is_known(&self, place: u64) -> bool {
        self.marks.last().is_some_and(|mark| mark.place > place)
    }

    fn drop_snapshot(&mut self, place: u64) {
        self.marks.retain(|mark| mark.place <= place);
    }

    /// Takes a snapshot if the previous one is at least this distance away.
    fn mark_after(&mut self, session: &mut Session<T>, distance: u64) {
        let place = self.place(session);
        if !self.marks.last().is_some_and(|last| (last.place..last.place + distance).contains(&place)) {
            self.mark_at(session, place, distance);
        }
    }

    /// Takes a snapshot if no other is near. A function of its own, because the test above runs every tick: a snapshot
    /// passed by value is so large that reserving its stack space takes longer than the test.
    #[inline(never)]
    fn mark_at(&mut self, session: &mut Session<T>, place: u64, distance: u64) {
        let next = self.marks.partition_point(|mark| mark.place <= place);
        let is_far = |mark: &Mark<T>| mark.place.abs_diff(place) >= distance;
        let before = next.checked_sub(1).and_then(|index| self.marks.get(index));
        if before.is_none_or(is_far) && self.marks.get(next).is_none_or(is_far) {
            let Ok(snapshot) = session.snapshot() else { return };
            self.marks.insert(next, Mark { snapshot: Arc::new(snapshot), place, is_needed: false });
            self.thin();
        }
    }

    /// Drops the least useful snapshot: the one that leaves the smallest gap relative to its age.
    fn thin(&mut self) {
        if self.marks.len() <= MOST {
            return;
        }
        let last = self.marks.last().map_or(0, |mark| mark.place);
        let cost = |index: usize| {
            let [before, mark, after] = [index - 1, index, index + 1].map(|index| self.marks[index].place);
            (after - before) as f64 / (last - mark + self.interval) as f64
        };
        let inner = (1..self.marks.len() - 1).filter(|index| !self.marks[*index].is_needed);
        let least = inner.min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
        if let Some(index) = least {
            self.marks.remove(index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Setup;

    /// A board on which manual actions are made for a while.
    fn played() -> (Session, Timeline<runtime::Board>, Vec<(u64, f64)>) {
        let mut session = Setup::default().session().expect("a board");
        let mut timeline = Timeline::new(&mut session).expect("it has snapshots");
        let mut known = Vec::new();
        for part in 0..8_u64 {
            let action = format!("command \"EnableAxis0;Jog0={}\"", 1000 * (part + 1));
            session.act(&action).expect("it is right");
            assert_eq!(
                timeline.advance(&mut session, Ticks::new(3000 * part + 1234), &mut |_| ()),
                History::Same
            );
            known.push((session.tick().get(), session.read("chan[0].Dest").expect("it is a variable")));
            assert!(session.set_user_data(5, part as i32));
        }
        let _ = timeline.keep(&mut session);
        (session, timeline, known)
    }

    #[test]
    fn past_states_are_the_same_in_whatever_order_they_are_visited() {
        let (mut session, mut timeline, known) = played();
        for index in [3, 1, 7, 0, 5, 6, 2, 4, 7] {
            let (tick, dest) = known[index];
            timeline.go_to(&mut session, Ticks::new(tick)).expect("it is of this session");
            assert_eq!((session.tick().get(), session.read("chan[0].Dest")), (tick, Ok(dest)));
            assert_eq!(session.user_data(5), Some(index as i32));
        }
        assert_eq!(timeline.go_to(&mut session, Ticks::new(0)), Ok(()));
    }

    #[test]
    fn an_action_in_the_past_starts_a_new_history() {
        let (mut session, mut timeline, known) = played();
        let (tick, _) = known[3];
        timeline.go_to(&mut session, Ticks::new(tick)).expect("it is of this session");
        assert_eq!(timeline.end().get(), known[7].0);
        session.act("command \"Jog0=-50\"").expect("it is right");
        assert_eq!(timeline.keep(&mut session), History::New(Ticks::new(tick)));
        assert_eq!(timeline.end().get(), tick);
        let _ = timeline.advance(&mut session, Ticks::new(tick + 5000), &mut |_| ());
        let dest = session.read("chan[0].Dest");
        timeline.go_to(&mut session, Ticks::new(known[1].0)).expect("it is of this session");
        timeline.go_to(&mut session, Ticks::new(tick + 5000)).expect("it is of this session");
        assert_eq!(session.read("chan[0].Dest"), dest);
    }

    #[test]
    fn a_line_that_was_left_is_taken_up_again_and_is_the_same() {
        let (mut session, mut timeline, known) = played();
        timeline.keep_branches(2);
        let (last, dest) = known[7];
        timeline.go_to(&mut session, Ticks::new(known[3].0)).expect("it is of this session");
        session.act("command \"Jog0=-50\"").expect("it is right");
        let _ = timeline.advance(&mut session, Ticks::new(known[3].0 + 5000), &mut |_| ());
        let other = session.read("chan[0].Dest");
        let [left] = timeline.branches() else { panic!("one line was left") };
        assert_eq!((left.from.get(), left.end.get()), (known[3].0, last));
        let first = left.id;

        // There and back again, also after the present line was left at another tick.
        assert_eq!(timeline.take_branch(&mut session, first), Ok(Some(Ticks::new(known[3].0))));
        assert_eq!((session.tick().get(), session.read("chan[0].Dest")), (last, Ok(dest)));
        let [left] = timeline.branches() else { panic!("the other line was left") };
        let second = left.id;
        timeline.go_to(&mut session, Ticks::new(known[1].0)).expect("it is of this session");
        assert_eq!(session.read("chan[0].Dest"), Ok(known[1].1));
        session.act("command \"Jog0=7\"").expect("it is right");
        let _ = timeline.keep(&mut session);
        assert!(timeline.take_branch(&mut session, second).expect("it is of this session").is_some());
        assert_eq!(session.read("chan[0].Dest"), other);

        assert_eq!(timeline.branches().len(), 1, "nothing was left of a line that is a part of another one");
        assert!(!timeline.forget_branch(first) && timeline.take_branch(&mut session, first) == Ok(None));
    }
}
