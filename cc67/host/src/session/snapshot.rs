//! A session as it was at an instant, to continue from there as often as one likes.

use std::sync::Arc;

use kmotiondef::Ticks;

use super::journal::Journal;
use super::{Recording, Session, UserProgram};
use crate::error::SnapshotError;
use crate::target::{Target, TargetSnapshot};

/// The board of a session between two ticks or where a program [holds](Session::held) one, and what was done by hand until then.
#[derive(Debug)]
pub struct Snapshot<T: Target> {
    target: T::Snapshot,
    programs: Arc<Vec<UserProgram>>,
    recording: Recording,
    journal: Journal,
}

impl<T: Target> Snapshot<T> {
    /// Number of the last tick that is over.
    #[must_use]
    pub fn tick(&self) -> Ticks {
        self.target.tick()
    }

    /// Returns whether a program holds the tick in progress.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.target.is_held()
    }

    /// Bytes of guest memory that this snapshot has beside those that it shares with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        self.target.bytes_beyond(&other.target)
    }
}

impl<T: Target> Session<T> {
    /// The session as it is. What has changed in guest memory since the snapshot before is kept in pages of 4 KiB; all
    /// that a board holds beside its memory is a few hundred KiB.
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
    /// The target has no snapshots.
    pub fn snapshot(&mut self) -> Result<Snapshot<T>, SnapshotError> {
        Ok(Snapshot {
            target: self.target.snapshot()?,
            programs: Arc::clone(&self.programs),
            recording: self.recording.clone(),
            journal: self.journal.clone(),
        })
    }

    /// Makes the session what it was when `snapshot` was taken; with the same calls it continues from there exactly as it
    /// went on then. What was done by hand since is not in the [recording](Session::recording) any more.
    ///
    /// Subscriptions stay, and are sampled from there on. So do the options of the compiler, and files that the PC
    /// keeps in a directory. Snapshots may be restored in any order, each as often as one likes.
    ///
    /// # Errors
    /// [`SnapshotError`] for a snapshot of another session with native threads; nothing has changed then.
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
