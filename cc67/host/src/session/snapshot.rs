//! Snapshots: the state of a session at a time, from which it can be continued any number of times.

use std::sync::Arc;

use kmotiondef::Ticks;

use super::journal::Journal;
use super::{Recording, Session, UserProgram};
use crate::error::SnapshotError;
use crate::target::{Target, TargetSnapshot};

/// The board of a session between two ticks or while a program [holds](Session::held) one, with the manual actions
/// until then.
#[derive(Debug)]
pub struct Snapshot<T: Target> {
    target: T::Snapshot,
    programs: Arc<Vec<UserProgram>>,
    recording: Recording,
    journal: Journal,
}

impl<T: Target> Snapshot<T> {
    /// The number of the last completed tick.
    #[must_use]
    pub fn tick(&self) -> Ticks {
        self.target.tick()
    }

    /// Returns whether a program holds the tick in progress.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.target.is_held()
    }

    /// The bytes of guest memory in this snapshot that it does not share with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        self.target.bytes_beyond(&other.target)
    }
}

impl<T: Target> Session<T> {
    /// Takes a snapshot of the session. Guest memory that has changed since the previous snapshot is kept in pages of 4
    /// KiB; the rest of a board's state is a few hundred KiB.
    ///
    /// ```
    /// use cc67_host::Setup;
    ///
    /// let mut session = Setup::default().session()?;
    /// session.act(r#"command "EnableAxis0;Jog0=1000""#)?;
    /// session.advance(session.tick_after(0.1), &mut |_| ());
    /// let then = session.snapshot()?;
    /// let ways = [0, 1].map(|_| {
    ///     session.restore(&then).expect("it is of this board");
    ///     session.advance(session.tick_after(0.1), &mut |_| ());
    ///     session.read("chan[0].Dest")
    /// });
    /// assert_eq!(ways[0], ways[1]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The target does not support snapshots.
    pub fn snapshot(&mut self) -> Result<Snapshot<T>, SnapshotError> {
        Ok(Snapshot {
            target: self.target.snapshot()?,
            programs: Arc::clone(&self.programs),
            recording: self.recording.clone(),
            journal: self.journal.clone(),
        })
    }

    /// Returns the session to the state in which `snapshot` was taken; with the same calls it continues exactly as it
    /// did then. Manual actions since then are removed from the [recording](Session::recording).
    ///
    /// Subscriptions remain, and are sampled from there on. The options of the compiler and files that the PC keeps in
    /// a directory remain, too. Snapshots may be restored in any order, any number of times.
    ///
    /// # Errors
    /// [`SnapshotError`] for a snapshot of another session with native threads; nothing has changed in that case.
    pub fn restore(&mut self, snapshot: &Snapshot<T>) -> Result<(), SnapshotError> {
        let Snapshot { target, programs, recording, journal } = snapshot;
        self.target.restore(target)?;
        self.programs.clone_from(programs);
        self.recording.clone_from(recording);
        self.journal.clone_from(journal);
        self.signals.went_to(self.target.tick());
        Ok(())
    }
}
