//! The session: a board under control.
//!
//! A [`Setup`] describes a board and its programs; a [`Session`] is that board under the control of an owner. The owner
//! lets time pass ([`advance`](Session::advance), [`run`](Session::run), [`run_until`](Session::run_until),
//! [`step_thread`](Session::step_thread)), reads and changes the board by the names in its programs
//! ([`read`](Session::read), [`write`](Session::write)), follows signals ([`subscribe`](Session::subscribe)), acts as
//! the world around the board ([`act`](Session::act)), and returns to an earlier time ([`snapshot`](Session::snapshot),
//! [`restore`](Session::restore)).
//!
//! ```
//! use cc67_host::{Until, Session, Setup, UserProgram};
//! use kmotiondef::{ThreadId, Ticks};
//!
//! // A program that counts a switch, and when it is pressed for the third time, says so.
//! let file = std::env::temp_dir().join("cc67-example-session.c");
//! std::fs::write(&file, r#"
//!     #include "KMotionDef.h"
//!     int count;
//!     main()
//!     {
//!         int now, last = 0;
//!         while (count < 3)
//!         {
//!             now = ReadBit(136);
//!             if (now && !last) ++count;
//!             last = now;
//!             WaitNextTimeSlice();
//!         }
//!         printf("three\n");
//!     }
//! "#)?;
//!
//! let thread = ThreadId::new(1).expect("there are 7");
//! let mut setup = Setup::default();
//! setup.programs.push(UserProgram::compile(&file, thread, &setup.options)?.started());
//! let mut session = setup.session()?;
//!
//! // Whatever the board says comes as events; here only console lines are kept.
//! let mut lines = Vec::new();
//! let mut hear = |event: runtime::Event| {
//!     if let runtime::EventKind::ConsoleLine(line) = event.kind {
//!         lines.push(String::from_utf8_lossy(&line).into_owned());
//!     }
//! };
//!
//! // Press the switch, and wait until the program has seen it: at most a second of board time.
//! session.act("bit 136 = 1")?;
//! let second = |session: &Session| session.tick_after(1.0);
//! let seen = Until::True(session.watch("count == 1")?);
//! assert!(session.run_until(&seen, second(&session), &mut hear));
//!
//! // Spare the program one of three, and press again.
//! session.write("count", 2.0)?;
//! session.act("bit 136 = 0")?;
//! session.advance(Ticks::new(session.tick().get() + 5), &mut hear);
//! session.act("bit 136 = 1")?;
//! session.run(second(&session), &mut hear);
//! assert_eq!(session.read("count")?, 3.0);
//! assert_eq!(lines, ["three"]);
//!
//! // What was done by hand is a stimulus, with which `cc67 run --stim` does it again.
//! assert!(session.recording().text().starts_with("at 90us bit 136 = 1\n"));
//! # std::fs::remove_file(&file)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Time is board time, and passes only in calls that are documented to let it pass. An event carries its time; by the
//! time a call returns, the board may have moved on. A session is deterministic: the same setup and the same calls at
//! the same ticks give the same events and the same memory, on any engine.

mod attendant;
mod by_hand;
mod condition;
mod control;
mod debug;
mod ending;
mod expression;
mod journal;
mod setup;
mod signals;
mod snapshot;
mod timeline;
mod until;

pub use crate::setup::Setup;
pub use crate::target::EXCHANGE;
pub use crate::user_program::UserProgram;
pub use attendant::{Attendant, IdleWork};
pub use by_hand::{Recording, by_hand};
pub use control::{End, Interrupter};
pub use ending::{AxisReport, EndReport, ThreadReport};
pub use expression::{Watch, WatchError, expressions, quantities, with_user_data};
pub use journal::Input;
pub use setup::resolve;
pub use signals::SubscriptionId;
pub use snapshot::Snapshot;
pub use timeline::{Branch, BranchId, History, Timeline, TimelineError};
pub use until::Until;

use std::sync::Arc;

use compiler::Options;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::Board;
use runtime::debug::{DebugInfo, SourcePlace};
use vm::memory::Scalar;
use vm::thread::ThreadState;

use crate::HostError;
use crate::capability::{Capability, Unsupported};
use crate::target::{AnyTarget, BootedTarget, ConnectedTarget, Target};
use journal::Journal;
use signals::Signals;

/// A board under control, see the [module](self).
#[derive(Debug)]
pub struct Session<T = Board> {
    target: T,
    /// The options with which programs and expressions are compiled.
    options: Options,
    /// The programs in the threads: expressions use their declarations.
    programs: Arc<Vec<UserProgram>>,
    /// The programs that a stimulus may load, with their debug information.
    offered: Vec<(UserProgram, DebugInfo)>,
    signals: Signals,
    recording: Recording,
    journal: Journal,
    interrupter: Interrupter,
}

/// The session, and the present state of its board.
impl<T: Target> Session<T> {
    /// Creates a session with a target whose programs are loaded.
    #[must_use]
    pub fn on_target(
        target: T,
        options: Options,
        programs: Vec<UserProgram>,
        offered: Vec<UserProgram>,
    ) -> Self {
        let offered = offered.into_iter().map(|program| (program.clone(), program.debug_info())).collect();
        Self::new(target, options, programs, offered)
    }

    pub(crate) fn new(
        target: T,
        options: Options,
        programs: Vec<UserProgram>,
        offered: Vec<(UserProgram, DebugInfo)>,
    ) -> Self {
        Self {
            target,
            options,
            programs: programs.into(),
            offered,
            signals: Signals::default(),
            recording: Recording::default(),
            journal: Journal::default(),
            interrupter: Interrupter::default(),
        }
    }

    /// Converts the target to another type.
    pub(crate) fn map_target<U: Target>(self, map: impl FnOnce(T) -> U) -> Session<U> {
        let Self { target, options, programs, offered, signals, recording, journal, interrupter } = self;
        Session { target: map(target), options, programs, offered, signals, recording, journal, interrupter }
    }

    /// The target, for reading.
    #[must_use]
    pub const fn target(&self) -> &T {
        &self.target
    }

    /// Returns whether the target has a capability.
    #[must_use]
    pub fn can(&self, capability: Capability) -> bool {
        self.target.can(capability)
    }

    /// Returns an error if the target lacks a capability.
    ///
    /// # Errors
    /// [`Unsupported`].
    pub fn require(&self, capability: Capability) -> Result<(), Unsupported> {
        self.target.require(capability)
    }

    /// Reads the status record of a connected target, so that the values read next are up to date.
    pub fn refresh(&mut self) {
        self.target.refresh();
    }

    /// A value in memory; 0 if there is no memory, or if the target does not answer.
    #[must_use]
    pub fn peek<S: Scalar>(&self, address: GuestAddr) -> S {
        let mut bytes = [0; 8];
        let read = bytes.get_mut(..S::SIZE as usize).map(|bytes| self.target.read(address, bytes));
        match read {
            Some(Ok(())) => S::get(&bytes, 0).unwrap_or_default(),
            Some(Err(_)) | None => S::default(),
        }
    }

    /// A value in an object of the board's tables, at the target's own address for it.
    #[must_use]
    pub fn peek_object<S: Scalar>(&self, address: GuestAddr) -> S {
        self.peek(self.target.place_of(address))
    }

    /// A value in an object of the board's tables, if it is known [without an exchange](Target::peek).
    #[must_use]
    pub fn glance_at_object<S: Scalar>(&self, address: GuestAddr) -> Option<S> {
        let mut bytes = [0; 8];
        let wanted = bytes.get_mut(..S::SIZE as usize)?;
        self.target.peek(self.target.place_of(address), wanted)?;
        S::get(&bytes, 0)
    }

    /// The number of the last completed tick.
    #[must_use]
    pub fn tick(&self) -> Ticks {
        self.target.tick()
    }

    /// The present time: the end of that tick.
    #[must_use]
    pub fn now(&self) -> Cycles {
        self.target.now()
    }

    /// The tick `seconds` of board time from now.
    ///
    /// ```
    /// let session = cc67_host::Setup::default().session()?;
    /// assert_eq!(session.tick_after(0.9).get(), 10_000);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    #[must_use]
    pub fn tick_after(&self, seconds: f64) -> Ticks {
        Ticks::new(self.tick().get().saturating_add(ticks(seconds)))
    }

    /// The state of a thread.
    #[must_use]
    pub fn thread(&self, thread: ThreadId) -> &ThreadState {
        self.target.thread(thread)
    }

    /// Returns whether no thread is active and everything that programs began is complete.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.target.has_ended()
    }

    /// The level of a bit.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> bool {
        self.target.bit(bit)
    }

    /// An element of `persist.UserData`; `None` if there is no such element.
    #[must_use]
    pub fn user_data(&self, index: usize) -> Option<i32> {
        let data = PERSIST.field(Persist::USER_DATA);
        (index < N_USER_DATA_VARS)
            .then(|| self.peek_object::<u32>(data.element(index).address()).cast_signed())
    }

    /// Returns the debug information of the loaded programs, each with its thread.
    #[must_use]
    pub fn debug(&self) -> Vec<(ThreadId, DebugInfo)> {
        let known = |thread| Some((thread, self.target.debug(thread).cloned()?));
        ThreadId::all().filter_map(known).collect()
    }

    /// Returns the debug information of the programs that a stimulus may load, each with its thread and its name.
    #[must_use]
    pub fn offered(&self) -> Vec<(ThreadId, String, DebugInfo)> {
        let row =
            |(program, debug): &(UserProgram, DebugInfo)| (program.thread, program.name(), debug.clone());
        self.offered.iter().map(row).collect()
    }

    /// The source position of a code address, in the program of any thread.
    #[must_use]
    pub fn source(&self, address: CodeAddr) -> Option<SourcePlace<'_>> {
        ThreadId::all().find_map(|thread| self.target.debug(thread)?.place(address))
    }

    /// The statement within which the servo interrupt stopped a thread.
    #[must_use]
    pub fn split_statement(&self, thread: ThreadId) -> Option<SourcePlace<'_>> {
        let at = self.target.interrupted_at(thread)?;
        self.target.debug(thread)?.statement_around(at)
    }

    /// Sets the options with which programs and expressions are compiled from now on.
    pub fn set_options(&mut self, options: Options) {
        self.options = options;
    }

    /// Returns the options with which programs and expressions are compiled.
    #[must_use]
    pub const fn options(&self) -> &Options {
        &self.options
    }

    /// Loads a program into its thread, which is stopped first, and starts it if it is marked as
    /// [started](UserProgram::started).
    ///
    /// # Errors
    /// The program is rejected; the program in the thread stays and continues.
    pub fn load(&mut self, program: UserProgram) -> Result<(), HostError> {
        self.target.load(&program)?;
        let (thread, starts) = (program.thread, program.starts);
        self.recording
            .record_unsupported(self.target.tick(), &format!("load {} into thread {thread}", program.name()));
        self.note(Input::Load(Box::new(UserProgram { starts: false, ..program.clone() })));
        self.note_program(program);
        if starts { self.start(thread) } else { Ok(()) }
    }

    /// Notes that a thread has another program, whose declarations expressions use.
    fn note_program(&mut self, program: UserProgram) {
        let programs = Arc::make_mut(&mut self.programs);
        programs.retain(|other| other.thread != program.thread);
        programs.push(program);
        programs.sort_by_key(|program| program.thread);
    }
}

/// The number of ticks in a time in seconds.
pub(crate) fn ticks(seconds: f64) -> u64 {
    (seconds / kmotiondef::limits::TIMEBASE).round() as u64
}

impl<T: ConnectedTarget + 'static> Session<T> {
    /// Converts a session of a connected controller to one of any target.
    #[must_use]
    pub fn on_any(self) -> Session<AnyTarget> {
        self.map_target(|target| AnyTarget::Connected(Box::new(target)))
    }
}

impl Session<BootedTarget> {
    /// From now on samples the states of the processor; the [target](Self::target) has the samples.
    pub fn sample_processor(&mut self) {
        self.target.sample_processor();
    }
}
