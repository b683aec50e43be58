//! The debugger: a session, its programs, breakpoints, and where it is.

mod hits;
mod run;
mod travel;
mod values;

pub use hits::HitCondition;
pub(crate) use run::{Goal, Way};
pub(crate) use travel::ONLY_FORWARD;
pub use values::ShownVariable;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cc67_host::{
    AnyTarget, Capability, History, HostError, Session, Setup, Snapshot, SnapshotError, Target, Timeline,
};
use compiler::firmware::FirmwareSymbols as _;
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::{Board, Event};
use values::Prepared;
use vm::engine::{ContextId, FrameView};

use crate::programs::{Activation, Programs, Statement};

/// Why a request is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DebugError(pub(crate) String);

impl From<String> for DebugError {
    fn from(text: String) -> Self {
        Self(text)
    }
}

impl From<&str> for DebugError {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

/// Where something is in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodePlace {
    /// The thread whose program it is of.
    pub thread: ThreadId,
    /// The function.
    pub function: String,
    /// The path of the file.
    pub file: String,
    /// The line.
    pub line: u32,
    /// The call is inlined.
    pub is_inlined: bool,
}

/// A call in progress.
#[derive(Clone, Debug)]
pub struct StackFrame {
    /// The instruction that is executed next; in a caller, the call.
    pub address: CodeAddr,
    /// Where that is in the source, if that is known.
    pub place: Option<CodePlace>,
    pub(crate) view: FrameView,
    /// Which call of the machine it is part of, counted from the innermost.
    pub(crate) real: usize,
    /// Which of the functions in it, counted from the innermost; all but the last are inlined.
    pub(crate) level: usize,
}

/// What a breakpoint is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BreakpointKind {
    /// Instructions: where to stop in words, and their addresses.
    Code(String, Vec<u32>),
    /// A change of an expression's value.
    Watch(String),
    /// An expression that becomes true, looked at after every tick.
    When(String),
}

/// A breakpoint.
#[derive(Debug)]
pub struct Breakpoint {
    /// Its number, counted from 1.
    pub id: u32,
    /// What it is about.
    pub kind: BreakpointKind,
    /// Stops only where this is not 0, an expression of the program.
    pub condition: Option<String>,
    /// Passes so often before it stops.
    pub ignore: u64,
    /// Prints this in place of stopping; `{expression}` is its value.
    pub log: Option<String>,
    /// It is deleted when it stops.
    pub is_temporary: bool,
    /// It is in effect.
    pub is_enabled: bool,
    /// How often it was met.
    pub hits: u64,
    /// At which of these times it stops; `None` at each.
    pub stops_at: Option<HitCondition>,
    /// The condition, compiled for each of its instructions; for a watched expression once.
    conditions: Vec<(u32, Prepared)>,
    /// The line that was requested.
    line: u32,
    subject: Subject,
}

/// The subject of a breakpoint.
#[derive(Debug)]
enum Subject {
    /// The positions of programs.
    Instructions,
    /// A watched expression.
    Change(WatchedExpression),
    /// An expression that becomes true, and whether it was at the last tick.
    Truth(Prepared, bool),
}

impl Subject {
    const fn watched(&self) -> Option<&WatchedExpression> {
        if let Self::Change(watched) = self { Some(watched) } else { None }
    }

    const fn watched_mut(&mut self) -> Option<&mut WatchedExpression> {
        if let Self::Change(watched) = self { Some(watched) } else { None }
    }

    const fn was_true_mut(&mut self) -> Option<&mut bool> {
        if let Self::Truth(_, was_true) = self { Some(was_true) } else { None }
    }

    /// Reports whether it is looked at after every tick.
    const fn is_polled(&self) -> bool {
        match self {
            Self::Instructions => false,
            Self::Change(watched) => watched.is_polled,
            Self::Truth(..) => true,
        }
    }
}

impl Breakpoint {
    /// Reports whether it is looked at after every tick.
    fn is_polled(&self) -> bool {
        self.is_enabled && self.subject.is_polled()
    }
}

/// A watched expression.
#[derive(Debug)]
struct WatchedExpression {
    prepared: Prepared,
    /// The memory that it is read from.
    ranges: Vec<(GuestAddr, u32)>,
    /// Registers are among what it is read from: it is looked at before every line.
    has_registers: bool,
    /// Items of the board are: it is looked at after every tick.
    is_polled: bool,
    last: String,
}

/// Why the board stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// It was not run yet.
    Begin,
    /// At breakpoints, by their numbers.
    Breakpoint(Vec<u32>),
    /// A watched expression has another value.
    Changed {
        /// Number of the breakpoint.
        id: u32,
        /// The expression.
        expression: String,
        /// Its value before.
        old: String,
        /// Its value now.
        new: String,
        /// Who did it.
        by: String,
    },
    /// An expression has become true.
    When {
        /// Number of the breakpoint.
        id: u32,
        /// The expression.
        expression: String,
    },
    /// A step is over.
    Step,
    /// A thread was stopped by a trap.
    Trap(String),
    /// The board has made a remark.
    Remark(String),
    /// A thread begins.
    Started(ThreadId),
    /// A thread has ended.
    Ended(ThreadId),
    /// A console line contains the text that was waited for.
    Console(String),
    /// An input or output has another level.
    Bit(String),
    /// The time that was requested.
    Time,
    /// All threads have ended.
    AllEnded,
    /// Somebody interrupted it.
    Interrupted,
    /// The beginning of the recorded past.
    BeginOfHistory,
}

/// Where the board stands, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stop {
    /// Why.
    pub reason: Reason,
    /// Whose program is about to continue, if it is one's.
    pub context: Option<ContextId>,
    /// Board time.
    pub at: Cycles,
}

/// An instant between two instructions, which no other has in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    pub(crate) tick: Ticks,
    pub(crate) held: Option<(ContextId, Cycles, CodeAddr)>,
}

/// What else stops the board.
#[derive(Clone, Debug, Default)]
pub struct Catches {
    /// Traps; they stop unless this says otherwise.
    pub no_traps: bool,
    /// Remarks.
    pub remarks: bool,
    /// Begins and ends of threads.
    pub starts: bool,
    /// The same for ends.
    pub ends: bool,
    /// Console lines that contain one of these.
    pub texts: Vec<String>,
    /// Inputs and outputs, by number.
    pub bits: Vec<i32>,
}

/// A debugger of one board.
#[derive(Debug)]
pub struct Debugger<T: Target = Board> {
    session: Session<T>,
    /// The past; none of a board that somebody else runs.
    timeline: Option<Timeline<T>>,
    programs: Programs,
    breakpoints: Vec<Breakpoint>,
    next_id: u32,
    /// What else stops.
    pub catches: Catches,
    /// Where a run ends.
    pub limit: Ticks,
    thread: ThreadId,
    frame: usize,
    stop: Stop,
    /// Messages of log points and the like that nobody has taken yet.
    messages: VecDeque<String>,
    /// Ends a run from elsewhere.
    interrupt: Arc<AtomicBool>,
}

impl<T: Target> Debugger<T> {
    /// A debugger of a board in its present state.
    ///
    /// # Errors
    /// The target cannot hold programs.
    pub fn new(mut session: Session<T>, limit: Ticks) -> Result<Self, DebugError> {
        session.require(Capability::Breakpoints).map_err(|error| error.to_string())?;
        session.prepare_to_hold();
        // A target without snapshots does not go back.
        let timeline = Timeline::new(&mut session).ok();
        Ok(Self::with(session, timeline, limit))
    }

    fn with(session: Session<T>, timeline: Option<Timeline<T>>, limit: Ticks) -> Self {
        let mut programs = Programs::default();
        programs.update(&session);
        let first = session.programs().iter().find(|program| program.starts).map(|program| program.thread);
        let thread = first.or_else(|| ThreadId::all().next()).expect("there are threads");
        let stop = Stop { reason: Reason::Begin, context: None, at: session.now() };
        Self {
            session,
            timeline,
            programs,
            breakpoints: Vec::new(),
            next_id: 1,
            catches: Catches::default(),
            limit,
            thread,
            frame: 0,
            stop,
            messages: VecDeque::new(),
            interrupt: Arc::default(),
        }
    }

    /// The board under control, to look at.
    #[must_use]
    pub const fn session(&self) -> &Session<T> {
        &self.session
    }

    /// Lends it a board, or takes it back: what it had until then is in `session` afterwards.
    pub fn swap(&mut self, session: &mut Session<T>) {
        std::mem::swap(&mut self.session, session);
    }

    /// The board under control, for whoever has lent it.
    pub(crate) const fn session_mut(&mut self) -> &mut Session<T> {
        &mut self.session
    }

    /// Looks at what is loaded now, and at a thread that has a program.
    pub(crate) fn look_around(&mut self) {
        self.programs.update(&self.session);
        if self.programs.of(self.thread).is_err()
            && let Some((thread, _)) = self.programs.all().next()
        {
            self.thread = thread;
        }
    }

    /// The board as it is at this instant, to compare it with another instant.
    ///
    /// # Errors
    /// The target has no snapshots.
    pub fn snapshot(&mut self) -> Result<Snapshot<T>, SnapshotError> {
        self.session.snapshot()
    }

    /// What is known about the programs.
    #[must_use]
    pub const fn programs(&self) -> &Programs {
        &self.programs
    }

    /// Where the board stands, and why.
    #[must_use]
    pub const fn stop(&self) -> &Stop {
        &self.stop
    }

    /// The thread that is looked at.
    #[must_use]
    pub const fn thread(&self) -> ThreadId {
        self.thread
    }

    /// Which of its calls is looked at, counted from the innermost.
    #[must_use]
    pub const fn frame(&self) -> usize {
        self.frame
    }

    /// The breakpoints.
    #[must_use]
    pub fn breakpoints(&self) -> &[Breakpoint] {
        &self.breakpoints
    }

    /// Ends a run whenever this is set.
    pub fn interrupted_by(&mut self, flag: Arc<AtomicBool>) {
        self.interrupt = flag;
    }

    /// A message that nobody has taken yet.
    pub fn take_message(&mut self) -> Option<String> {
        self.messages.pop_front()
    }

    /// Bytes of memory that the recorded past takes beside the board, and how many snapshots it has.
    #[must_use]
    pub fn history(&self) -> (usize, usize) {
        self.timeline.as_ref().map_or((0, 0), |timeline| (timeline.bytes(), timeline.len()))
    }

    /// Records the past with a snapshot after so much work; see [`Timeline::keep_every`].
    pub fn keep_every(&mut self, work: u64) {
        if let Some(timeline) = &mut self.timeline {
            timeline.keep_every(work);
        }
    }

    /// Looks at a thread, or at another call.
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

    /// How many calls of the source are in progress.
    pub(crate) fn depth(&self, context: ContextId) -> usize {
        let frames = self.session.frames(context);
        frames.iter().map(|view| self.programs.depth(view.at.get())).sum()
    }

    /// Where an instruction is in its source.
    #[must_use]
    pub fn place(&self, address: u32) -> Option<CodePlace> {
        self.programs.activations(address).first().map(place_of)
    }

    /// Sets a breakpoint at `FILE:LINE`, `LINE`, `FUNCTION` or `*ADDRESS`, of the program in one thread or of all that have it;
    /// its number, and what there is to say.
    ///
    /// # Errors
    /// There is no code, or the condition does not compile.
    pub fn break_at(
        &mut self,
        place: &str,
        thread: Option<ThreadId>,
        condition: Option<&str>,
    ) -> Result<(u32, String), DebugError> {
        let (found, note) = self.resolve(place.trim(), thread)?;
        let first = &found[0];
        let where_ = if first.line == 0 {
            format!("{:#010x}", first.address)
        } else {
            let activations = self.programs.activations(first.address);
            let with_line = activations.iter().find(|activation| activation.scope.line == first.line);
            let place = with_line.or(activations.first()).map(place_of);
            place.map_or_else(
                || format!("{:#010x}", first.address),
                |place| format!("{}, {}:{}", place.function, file_name(&place.file), first.line),
            )
        };
        let addresses = found.iter().map(|one| one.address).collect();
        let line = first.line;
        let kind = BreakpointKind::Code(where_.clone(), addresses);
        let conditions = self.conditions(&kind, condition)?;
        let id = self.add(kind, condition, conditions);
        if let Some(added) = self.breakpoints.last_mut() {
            added.line = line;
        }
        let mut threads: Vec<_> = found.iter().map(|one| one.thread.to_string()).collect();
        threads.dedup();
        let text = format!("Breakpoint {id} at {where_} (thread {}){note}", threads.join(", "));
        Ok((id, text))
    }

    /// Stops when the value of an expression changes; its number, and what there is to say.
    ///
    /// # Errors
    /// The expression is wrong.
    pub fn watch(&mut self, expression: &str, condition: Option<&str>) -> Result<(u32, String), DebugError> {
        let watched = self.watched(expression)?;
        let kind = BreakpointKind::Watch(expression.to_owned());
        let conditions = self.conditions(&kind, condition)?;
        let id = self.add(kind, condition, conditions);
        if let Some(added) = self.breakpoints.last_mut() {
            added.subject = Subject::Change(watched);
        }
        Ok((id, format!("Watchpoint {id}: {expression}")))
    }

    /// Stops at the end of the tick in which an expression becomes true, that is, is not 0; its number, and what there is
    /// to say.
    ///
    /// # Errors
    /// The expression is wrong.
    pub fn catch_when(&mut self, expression: &str) -> Result<(u32, String), DebugError> {
        let prepared = self.prepare(expression)?;
        let id = self.add(BreakpointKind::When(expression.to_owned()), None, Vec::new());
        if let Some(added) = self.breakpoints.last_mut() {
            added.subject = Subject::Truth(prepared, false);
        }
        Ok((id, format!("Catchpoint {id} (when {expression})")))
    }

    /// Deletes a breakpoint; whether there was one of that number.
    pub fn delete(&mut self, id: u32) -> bool {
        let count = self.breakpoints.len();
        self.breakpoints.retain(|breakpoint| breakpoint.id != id);
        self.breakpoints.len() < count
    }

    /// A breakpoint, to change it.
    pub fn breakpoint_mut(&mut self, id: u32) -> Option<&mut Breakpoint> {
        self.breakpoints.iter_mut().find(|breakpoint| breakpoint.id == id)
    }

    /// Gives a breakpoint a condition, or takes it away.
    ///
    /// # Errors
    /// There is no such breakpoint, or the condition does not compile.
    pub fn set_condition(&mut self, id: u32, condition: Option<&str>) -> Result<(), DebugError> {
        let found = self.breakpoints.iter().find(|breakpoint| breakpoint.id == id);
        let kind = found
            .map(|breakpoint| breakpoint.kind.clone())
            .ok_or_else(|| format!("No breakpoint number {id}."))?;
        let conditions = self.conditions(&kind, condition)?;
        if let Some(breakpoint) = self.breakpoint_mut(id) {
            breakpoint.condition = condition.map(str::to_owned);
            breakpoint.conditions = conditions;
        }
        Ok(())
    }

    /// A condition, compiled for where a breakpoint is.
    fn conditions(
        &self,
        kind: &BreakpointKind,
        condition: Option<&str>,
    ) -> Result<Vec<(u32, Prepared)>, DebugError> {
        let Some(condition) = condition else { return Ok(Vec::new()) };
        match kind {
            BreakpointKind::Code(_, addresses) => {
                addresses.iter().map(|at| Ok((*at, self.prepare_at(*at, condition)?))).collect()
            }
            BreakpointKind::Watch(_) | BreakpointKind::When(_) => Ok(vec![(0, self.prepare(condition)?)]),
        }
    }

    /// Other programs are loaded: what was compiled for them is compiled again.
    fn compile_conditions(&mut self) {
        for index in 0..self.breakpoints.len() {
            let Breakpoint { id, kind, condition, .. } = &self.breakpoints[index];
            let id = *id;
            match self.conditions(kind, condition.as_deref()) {
                Ok(conditions) => self.breakpoints[index].conditions = conditions,
                Err(error) => {
                    self.messages.push_back(format!("condition of breakpoint {id}: {error}"));
                }
            }
        }
    }

    fn add(
        &mut self,
        kind: BreakpointKind,
        condition: Option<&str>,
        conditions: Vec<(u32, Prepared)>,
    ) -> u32 {
        let id = self.next_id;
        self.next_id += 1;
        self.breakpoints.push(Breakpoint {
            id,
            kind,
            condition: condition.map(str::to_owned),
            ignore: 0,
            log: None,
            is_temporary: false,
            is_enabled: true,
            hits: 0,
            stops_at: None,
            conditions,
            line: 0,
            subject: Subject::Instructions,
        });
        id
    }

    /// What a person means by a place, and what there is to say of it.
    pub(crate) fn resolve(
        &self,
        place: &str,
        thread: Option<ThreadId>,
    ) -> Result<(Vec<Statement>, String), DebugError> {
        if let Some(address) = place.strip_prefix('*') {
            let value = self.number(address)?;
            let address = value as u32 & !7;
            let found = self.programs.at(address);
            let (thread, _, function) = found.ok_or_else(|| format!("no code at {address:#x}"))?;
            let line = self.place(address).map_or(0, |place| place.line);
            return Ok((
                vec![Statement { thread, address, line, function: function.name.clone(), call: None }],
                String::new(),
            ));
        }
        let (file, rest) = place.rsplit_once(':').map_or((None, place), |(file, rest)| (Some(file), rest));
        if let Ok(line) = rest.parse::<u32>() {
            let present = || self.present().map(|place| place.file).filter(|_| file.is_none());
            let own = present();
            let file = file.or(own.as_deref());
            let thread = thread.or_else(|| file.is_none().then_some(self.thread));
            let (found, taken) = self.programs.at_line(file, line, thread);
            if found.is_empty() {
                let why = self.programs.unknown().next();
                let text = format!(
                    "No code at line {line} or below{}",
                    why.map_or_else(String::new, |why| format!("; {why}"))
                );
                return Err(text.into());
            }
            let note = if taken == line {
                String::new()
            } else {
                format!("; line {line} has no code, {taken} is the next with some")
            };
            return Ok((found, note));
        }
        let mut found = self.programs.at_function(rest, thread);
        if found.is_empty() && file.is_none() {
            found = self.calls_of(rest, thread);
            if !found.is_empty() {
                return Ok((found, format!("; before each call of {rest}")));
            }
            if self.session.options().firmware.find(rest).is_some() {
                return Err(format!("No program calls {rest}, which is the firmware's.").into());
            }
        }
        if found.is_empty() {
            let why = self.programs.unknown().next();
            return Err(why.unwrap_or_else(|| format!("Function \"{rest}\" not defined.")).into());
        }
        Ok((found, String::new()))
    }

    /// The instructions of the programs that call a function of the firmware.
    fn calls_of(&self, name: &str, thread: Option<ThreadId>) -> Vec<Statement> {
        let Some(symbol) = self.session.options().firmware.find(name) else { return Vec::new() };
        let target = format!(", {:#010x}", symbol.address.get());
        let mut found = Vec::new();
        for (number, model) in
            self.programs.all().filter(|(number, _)| thread.is_none_or(|one| one == *number))
        {
            for function in &model.functions {
                let mut at = function.addresses.start;
                while at < function.addresses.end
                    && let Some((text, size)) = self.session.target().disassemble(at)
                {
                    if text.starts_with("call_fw ") && text.ends_with(&target) {
                        let line = model.line_at(at).unwrap_or(0);
                        let function = function.name.clone();
                        found.push(Statement { thread: number, address: at, line, function, call: None });
                    }
                    at = at.saturating_add(size);
                }
            }
        }
        found
    }

    /// Where the call that is looked at stands.
    #[must_use]
    pub fn present(&self) -> Option<CodePlace> {
        self.frames(self.context()).into_iter().nth(self.frame)?.place
    }

    /// The context that is looked at: the thread's, or the call-back's if the board is there.
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
        self.stop = Stop { reason, context, at: self.now() };
        self.frame = self.frame_of_breakpoint();
        self.stop.clone()
    }

    /// The call that a breakpoint is about where an inlined function begins: the one with its line.
    fn frame_of_breakpoint(&self) -> usize {
        let Reason::Breakpoint(ids) = &self.stop.reason else { return 0 };
        let met = self.breakpoints.iter().find(|breakpoint| ids.contains(&breakpoint.id));
        let Some(line) = met.map(|breakpoint| breakpoint.line) else { return 0 };
        let has_line = |frame: &StackFrame| {
            frame.real == 0 && frame.place.as_ref().is_some_and(|place| place.line == line)
        };
        self.frames(self.context()).iter().position(has_line).unwrap_or(0)
    }

    /// Tells the timeline that a person has changed something; says so if that makes another history.
    pub(crate) fn changed(&mut self) {
        let history = match &mut self.timeline {
            Some(timeline) if self.session.held().is_some() => timeline.branch(&mut self.session),
            Some(timeline) => timeline.keep(&mut self.session),
            None => History::Same,
        };
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
    /// A debugger of a board that somebody else runs and [lends](Self::swap) it; such a board does not go back.
    ///
    /// # Errors
    /// There is no board to keep the place of the other one.
    pub fn of_lent() -> Result<Self, HostError> {
        Ok(Self::with(Setup::default().session_on_any(None)?, None, Ticks::new(u64::MAX)))
    }
}

/// Where a function is at present.
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

/// What receives events while the board runs.
pub(crate) type Events<'a> = &'a mut dyn FnMut(&Event);
