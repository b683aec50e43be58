//! The debugger: a session, its programs, breakpoints, and the present stop.

mod breakpoints;
mod calls;
mod hits;
mod judge;
mod run;
mod travel;
mod values;

pub use breakpoints::{Breakpoint, BreakpointKind, WatchedAccess};
pub(crate) use calls::TypeDetail;
pub use hits::HitCondition;
pub(crate) use run::{Goal, StepKind};
pub(crate) use travel::ONLY_FORWARD;
pub use values::ShownVariable;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cc67_host::{
    AnyTarget, Capability, History, HostError, Session, Setup, Snapshot, SnapshotError, Target, Timeline,
    Unsupported,
};
use compiler::target::Target as CodeTarget;
use kmotiondef::{CodeAddr, Cycles, ThreadId, Ticks};
use runtime::{Board, Event};
use vm::engine::{ContextId, FrameView};

use crate::programs::{Activation, Programs};

/// The error of a rejected request.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DebugError(pub(crate) String);

impl From<String> for DebugError {
    fn from(text: String) -> Self {
        Self(text)
    }
}

impl From<Unsupported> for DebugError {
    fn from(error: Unsupported) -> Self {
        Self(error.to_string())
    }
}

impl From<HostError> for DebugError {
    fn from(error: HostError) -> Self {
        Self(error.to_string())
    }
}

impl From<&str> for DebugError {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

/// A position in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodePlace {
    /// The thread of the program.
    pub thread: ThreadId,
    /// The name of the function.
    pub function: String,
    /// The path of the file.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// True if it is in an inlined call.
    pub is_inlined: bool,
}

/// A call in progress.
#[derive(Clone, Debug)]
pub struct StackFrame {
    /// The next instruction to be executed; in a caller, the call.
    pub address: CodeAddr,
    /// Its position in the source, if known.
    pub place: Option<CodePlace>,
    pub(crate) view: FrameView,
    /// The index of the machine call that contains it, counted from the innermost.
    pub(crate) real: usize,
    /// The index of its function in that call, counted from the innermost; all but the last are inlined.
    pub(crate) level: usize,
}

/// The reason for which the board is stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// It has not run yet.
    Begin,
    /// It is at breakpoints with these numbers.
    Breakpoint(Vec<u32>),
    /// The value of a watched expression changed.
    Changed {
        /// Number of the breakpoint.
        id: u32,
        /// The expression.
        expression: String,
        /// Its value before.
        old: String,
        /// Its value now.
        new: String,
        /// The context that changed it.
        by: String,
    },
    /// The memory of an expression was accessed.
    Accessed {
        /// Number of the breakpoint.
        id: u32,
        /// The expression.
        expression: String,
        /// The accesses at which it stops.
        access: WatchedAccess,
        /// Its value before, if the access has changed it.
        old: Option<String>,
        /// Its value now.
        value: String,
        /// The thread or part of the board that accessed it.
        by: String,
    },
    /// An expression became true.
    When {
        /// Number of the breakpoint.
        id: u32,
        /// The expression.
        expression: String,
    },
    /// A step is complete.
    Step,
    /// A thread was stopped by a trap.
    Trap(String),
    /// The board made a remark.
    Remark(String),
    /// A thread started.
    Started(ThreadId),
    /// A thread ended.
    Ended(ThreadId),
    /// A console line contains an awaited text.
    Console(String),
    /// The level of an input or output changed.
    Bit(String),
    /// The requested time was reached.
    Time,
    /// All threads have ended.
    AllEnded,
    /// The run was interrupted.
    Interrupted,
    /// The connection to the target was lost.
    LinkLost(String),
    /// The beginning of the recorded past.
    BeginOfHistory,
}

/// The position at which the board is stopped, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stop {
    /// The reason.
    pub reason: Reason,
    /// The context whose program is about to continue, if there is one.
    pub context: Option<ContextId>,
    /// Board time.
    pub at: Cycles,
    /// True if the breakpoint at which the board is stopped was temporary, and has been deleted.
    pub is_temporary: bool,
}

/// A unique position in time, between two instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    pub(crate) tick: Ticks,
    pub(crate) held: Option<(ContextId, Cycles, CodeAddr)>,
}

/// The events that stop the board.
#[derive(Clone, Debug, Default)]
pub struct Catchpoints {
    /// True if traps do not stop.
    pub no_traps: bool,
    /// True if remarks stop.
    pub remarks: bool,
    /// True if starts of threads stop.
    pub starts: bool,
    /// True if ends of threads stop.
    pub ends: bool,
    /// Console lines that contain one of these texts stop.
    pub texts: Vec<String>,
    /// Changes of these inputs and outputs stop.
    pub bits: Vec<i32>,
}

/// A debugger of one board.
#[derive(Debug)]
pub struct Debugger<T: Target = Board> {
    session: Session<T>,
    /// The past; `None` for a board that is run elsewhere.
    timeline: Option<Timeline<T>>,
    programs: Programs,
    breakpoints: Vec<Breakpoint>,
    next_id: u32,
    /// The events that stop the board.
    pub catches: Catchpoints,
    /// The tick at which a run ends.
    pub limit: Ticks,
    thread: ThreadId,
    frame: usize,
    stop: Stop,
    /// Messages of log points and the like that have not been taken yet.
    messages: VecDeque<String>,
    /// A flag that ends a run from elsewhere.
    interrupt: Arc<AtomicBool>,
}

impl<T: Target> Debugger<T> {
    /// A debugger for a board in its present state.
    #[must_use]
    pub fn new(mut session: Session<T>, limit: Ticks) -> Self {
        session.prepare_to_hold();
        // A target without snapshots cannot go back.
        let timeline = Timeline::new(&mut session).ok();
        Self::with(session, timeline, limit)
    }

    fn with(session: Session<T>, timeline: Option<Timeline<T>>, limit: Ticks) -> Self {
        let mut programs = Programs::default();
        programs.update(&session);
        let first = session.programs().iter().find(|program| program.starts).map(|program| program.thread);
        let thread = first.or_else(|| ThreadId::all().next()).expect("there are threads");
        let stop = Stop { reason: Reason::Begin, context: None, at: session.now(), is_temporary: false };
        Self {
            session,
            timeline,
            programs,
            breakpoints: Vec::new(),
            next_id: 1,
            catches: Catchpoints::default(),
            limit,
            thread,
            frame: 0,
            stop,
            messages: VecDeque::new(),
            interrupt: Arc::default(),
        }
    }

    /// Returns whether the board is run elsewhere, without a past.
    pub(crate) fn is_lent(&self) -> bool {
        self.timeline.is_none() && self.session.can(Capability::Snapshots)
    }

    /// Returns an error if programs of this target cannot be held.
    pub(crate) fn must_hold(&self) -> Result<(), DebugError> {
        self.session.require(Capability::Breakpoints)?;
        if self.session.options().target == CodeTarget::C67x {
            self.session.require(Capability::ProcessorCode)?;
        }
        Ok(())
    }

    /// Starts a thread at the beginning of its program.
    ///
    /// # Errors
    /// The thread has no program, or the target does not answer.
    pub fn start(&mut self, thread: ThreadId) -> Result<(), DebugError> {
        self.session.start(thread)?;
        self.changed();
        Ok(())
    }

    /// Starts the programs that are marked as started.
    ///
    /// # Errors
    /// The target does not answer.
    pub fn start_all(&mut self) -> Result<(), DebugError> {
        let starting: Vec<_> = self.session.programs().iter().filter(|program| program.starts).collect();
        let threads: Vec<_> = starting.into_iter().map(|program| program.thread).collect();
        threads.into_iter().try_for_each(|thread| self.start(thread))
    }

    /// Starts the programs again: on a simulated board from its beginning, on a controller in its present state.
    ///
    /// # Errors
    /// The beginning of the board cannot be restored, or the target does not answer.
    pub fn start_again(&mut self) -> Result<(), DebugError> {
        if self.session.can(Capability::StopTime) { self.restart().map(drop) } else { self.start_all() }
    }

    /// Stops a thread.
    pub fn stop_thread(&mut self, thread: ThreadId) {
        self.session.stop(thread);
        self.changed();
    }

    /// Pauses a thread while the others run, or resumes it.
    ///
    /// # Errors
    /// The target cannot pause threads, or does not answer.
    pub fn pause(&mut self, thread: ThreadId, is_paused: bool) -> Result<(), DebugError> {
        let done = if is_paused { self.session.pause(thread) } else { self.session.resume(thread) };
        Ok(done?)
    }

    /// Processes the events since the last call, for a target whose time passes by itself.
    pub(crate) fn catch_up(&mut self, events: Events<'_>) {
        self.session.refresh();
        let tick = self.session.tick();
        self.session.step(tick, &mut |event| events(&event));
    }

    /// The board under control, for reading.
    #[must_use]
    pub const fn session(&self) -> &Session<T> {
        &self.session
    }

    /// Exchanges its board with `session`: lends it a board, or takes the board back.
    pub fn swap(&mut self, session: &mut Session<T>) {
        std::mem::swap(&mut self.session, session);
    }

    /// The board under control, for changes.
    pub(crate) const fn session_mut(&mut self) -> &mut Session<T> {
        &mut self.session
    }

    /// Updates the information about the loaded programs, and selects a thread that has a program.
    pub(crate) fn look_around(&mut self) {
        self.programs.update(&self.session);
        if self.programs.of(self.thread).is_err()
            && let Some((thread, _)) = self.programs.all().next()
        {
            self.thread = thread;
        }
    }

    /// A snapshot of the board, for comparison with another one.
    ///
    /// # Errors
    /// The target does not support snapshots.
    pub fn snapshot(&mut self) -> Result<Snapshot<T>, SnapshotError> {
        self.session.snapshot()
    }

    /// Returns the debug information of the programs.
    #[must_use]
    pub const fn programs(&self) -> &Programs {
        &self.programs
    }

    /// Returns the position at which the board is stopped, and the reason.
    #[must_use]
    pub const fn stop(&self) -> &Stop {
        &self.stop
    }

    /// The selected thread.
    #[must_use]
    pub const fn thread(&self) -> ThreadId {
        self.thread
    }

    /// Returns the index of the selected call, counted from the innermost.
    #[must_use]
    pub const fn frame(&self) -> usize {
        self.frame
    }

    /// The breakpoints.
    #[must_use]
    pub fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints
    }

    /// Sets a flag that ends a run when it becomes true.
    pub fn interrupted_by(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = flag;
    }

    /// Takes the oldest message.
    pub fn take_message(&mut self) -> Option<String> {
        self.messages.pop_front()
    }

    /// The bytes of memory that the recorded past takes in addition to the board, and the number of snapshots.
    #[must_use]
    pub fn history(&self) -> (usize, usize) {
        self.timeline.as_ref().map_or((0, 0), |timeline| (timeline.bytes(), timeline.len()))
    }

    /// Sets the work between two snapshots of the past; see [`Timeline::keep_every`].
    pub fn keep_every(&mut self, work: u64) {
        if let Some(timeline) = &mut self.timeline {
            timeline.keep_every(work);
        }
    }

    /// Selects a thread and a call.
    ///
    /// # Errors
    /// There is no such call.
    pub fn select(&mut self, thread: ThreadId, frame: usize) -> Result<(), DebugError> {
        if frame > 0 && frame >= self.frames(ContextId::of(thread)).len() {
            return Err(format!("thread {thread} has no frame {frame}").into());
        }
        (self.thread, self.frame) = (thread, frame);
        Ok(())
    }

    /// The calls in progress of a context, innermost first.
    #[must_use]
    pub fn frames(&self, context: ContextId) -> Vec<StackFrame> {
        let is_live = context.thread().is_none_or(|thread| {
            !matches!(
                self.session.thread(thread),
                vm::thread::ThreadState::Empty
                    | vm::thread::ThreadState::Ready
                    | vm::thread::ThreadState::Active(vm::thread::Progress::Fresh)
            )
        });
        let is_live = is_live
            && (context.thread().is_some() || self.session.held().is_some_and(|(held, _)| held == context));
        if !is_live {
            return Vec::new();
        }
        let mut frames = Vec::new();
        for (real, view) in self.session.frames(context).into_iter().enumerate() {
            let address = view.at;
            let places: Vec<_> = self.programs.activations(address.get()).iter().map(place_of).collect();
            if places.is_empty() {
                frames.push(StackFrame { address, place: None, view, real, level: 0 });
                continue;
            }
            frames.extend(places.into_iter().enumerate().map(|(level, place)| StackFrame {
                address,
                place: Some(place),
                view: view.clone(),
                real,
                level,
            }));
        }
        frames
    }

    /// Returns the number of source calls in progress.
    pub(crate) fn depth(&self, context: ContextId) -> usize {
        let frames = self.session.frames(context);
        frames.iter().map(|view| self.programs.depth(view.at.get())).sum()
    }

    /// Returns the source position of an instruction.
    #[must_use]
    pub fn place(&self, address: u32) -> Option<CodePlace> {
        self.programs.activations(address).first().map(place_of)
    }

    /// Returns the source position of the selected call.
    #[must_use]
    pub fn present(&self) -> Option<CodePlace> {
        self.frames(self.context()).into_iter().nth(self.frame)?.place
    }

    /// The selected context: the selected thread, or the call-back if the board is stopped there.
    #[must_use]
    pub fn context(&self) -> ContextId {
        match self.stop.context {
            Some(context) if context == ContextId::CALLBACK => context,
            _ => ContextId::of(self.thread),
        }
    }

    pub(crate) fn position(&self) -> Position {
        let held = self
            .session
            .held()
            .and_then(|(context, at)| Some((context, at, self.session.frames(context).first()?.at)));
        Position { tick: self.session.tick(), held }
    }

    /// Board time.
    #[must_use]
    pub fn now(&self) -> Cycles {
        self.session.held().map_or_else(|| self.session.now(), |(_, at)| at)
    }

    fn stopped(&mut self, reason: Reason, context: Option<ContextId>) -> Stop {
        self.programs.update(&self.session);
        let context = context.or_else(|| self.session.held().map(|(context, _)| context));
        if let Some(thread) = context.and_then(ContextId::thread) {
            self.thread = thread;
        }
        self.frame = 0;
        let met = if let Reason::Breakpoint(ids) = &reason { ids.clone() } else { Vec::new() };
        let is_met = |breakpoint: &Breakpoint| breakpoint.is_temporary && met.contains(&breakpoint.id);
        let is_temporary = self.breakpoints.iter().any(is_met);
        self.stop = Stop { reason, context, at: self.now(), is_temporary };
        self.frame = self.frame_of_breakpoint();
        self.breakpoints.retain(|breakpoint| !is_met(breakpoint));
        self.stop.clone()
    }

    /// The frame of a breakpoint at the beginning of an inlined function: the one at the breakpoint's line.
    fn frame_of_breakpoint(&self) -> usize {
        let Reason::Breakpoint(ids) = &self.stop.reason else { return 0 };
        let met = self.breakpoints.iter().find(|breakpoint| ids.contains(&breakpoint.id));
        let Some(line) = met.map(|breakpoint| breakpoint.line) else { return 0 };
        let has_line = |frame: &StackFrame| {
            frame.real == 0 && frame.place.as_ref().is_some_and(|place| place.line == line)
        };
        self.frames(self.context()).iter().position(has_line).unwrap_or(0)
    }

    /// Informs the timeline about a change by the user; reports it if it begins another history.
    pub(crate) fn changed(&mut self) {
        if self.session.held().is_some() {
            return self.changed_beyond_journal();
        }
        let history = self.timeline.as_mut().map(|timeline| timeline.keep(&mut self.session));
        self.tell_history(history.unwrap_or(History::Same));
    }

    /// Does the same for a change that is not in the journal.
    pub(crate) fn changed_beyond_journal(&mut self) {
        let history = self.timeline.as_mut().map(|timeline| timeline.branch(&mut self.session));
        self.tell_history(history.unwrap_or(History::Same));
    }

    fn tell_history(&mut self, history: History) {
        if history != History::Same {
            let seconds = self.now().get() as f64 / Cycles::PER_SECOND.get() as f64;
            self.messages.push_back(format!(
                "A new line of history begins here, at {seconds:.6} s; what came later is forgotten."
            ));
        }
        self.refresh_watches();
    }
}

impl Debugger<AnyTarget> {
    /// A debugger for a board that is run elsewhere and [lent](Self::swap) to it; it cannot go back in time.
    ///
    /// # Errors
    /// The board that takes the place of the lent one cannot be created.
    pub fn of_lent() -> Result<Self, HostError> {
        Ok(Self::with(Setup::default().session_on_any(None)?, None, Ticks::new(u64::MAX)))
    }
}

/// Returns the present source position of a function.
fn place_of(activation: &Activation<'_>) -> CodePlace {
    let Activation { thread, model, around, scope, is_inlined } = *activation;
    let same = std::path::Path::new(&around.file).file_name() == model.path.file_name();
    let file = if same {
        model.path.clone()
    } else {
        model.path.parent().unwrap_or(std::path::Path::new("")).join(&around.file)
    };
    CodePlace {
        thread,
        function: scope.function.to_owned(),
        file: file.to_string_lossy().into_owned(),
        line: scope.line,
        is_inlined,
    }
}

/// The last part of a path.
pub(crate) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// The receiver of events while the board runs.
pub(crate) type Events<'a> = &'a mut dyn FnMut(&Event);
