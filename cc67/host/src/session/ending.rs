//! The end of a run: threads that have not ended, with place and reason of their wait; the axes.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use crate::target::Target;
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, ThreadId};
use runtime::standing::{
    AwaitedState, Owner, OwnerState, Source, ThreadActivity, UnfinishedThread, UsedAxis,
};

use super::Session;
use super::condition::WaitCondition;
use crate::remark::SourceCall;

/// Threads that have not ended, and the axes that programs have used.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EndReport {
    /// The threads.
    pub threads: Vec<ThreadReport>,
    /// The axes.
    pub axes: Vec<AxisReport>,
}

/// A thread that has not ended.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreadReport {
    /// Its number.
    pub thread: ThreadId,
    /// `computing`, `waiting`, `paused` or `idle`.
    pub state: &'static str,
    /// The source position, then those of the calls that led there, innermost first.
    pub calls: Vec<SourceCall>,
    /// The reasons for which it waits, one text each.
    pub waits_for: Vec<String>,
    /// When it last did anything but look and wait, in seconds of board time.
    pub since: f64,
}

/// An axis that programs have used.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisReport {
    /// Its number.
    pub axis: AxisId,
    /// Its name in the machine file; empty if it has none.
    pub name: String,
    /// True if it is enabled.
    pub enabled: bool,
    /// Its commanded position.
    pub dest: f64,
    /// Its measured position.
    pub position: f64,
    /// The commanded velocity, in units a second.
    pub velocity: f64,
    /// The reasons for which it does not move, or its movements.
    pub why: Vec<String>,
}

impl EndReport {
    /// Returns whether no thread is left but those that were paused.
    #[must_use]
    pub fn has_all_ended(&self) -> bool {
        self.threads.iter().all(|thread| thread.state == "paused")
    }
}

impl fmt::Display for EndReport {
    /// A line for each thread and for each axis, indented.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, line) in self.lines().iter().enumerate() {
            write!(f, "{}  {line}", if index == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl EndReport {
    /// The states at the end, as lines.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let threads = self.threads.iter().map(ToString::to_string);
        threads.chain(self.axes.iter().map(ToString::to_string)).collect()
    }
}

impl fmt::Display for ThreadReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "thread {}", self.thread)?;
        for (index, call) in self.calls.iter().enumerate() {
            write!(f, "{}{call}", if index == 0 { " at " } else { ", called at " })?;
        }
        match &*self.waits_for {
            [] => write!(f, " is {}", self.state)?,
            all if self.state == "paused" => write!(f, " is paused; it waited for {}", all.join(", "))?,
            all if self.state == "waiting" => {
                write!(f, " has waited since {:.3} s for {}", self.since, all.join(", "))?;
            }
            all => write!(f, " waits for {}", all.join(", "))?,
        }
        Ok(())
    }
}

impl fmt::Display for AxisReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "axis {}", self.axis)?;
        if !self.name.is_empty() {
            write!(f, " ({})", self.name)?;
        }
        let state = if self.enabled { "enabled" } else { "disabled" };
        write!(f, ": {state}, Dest {}, Position {}", number(self.dest), number(self.position))?;
        if self.velocity != 0.0 {
            write!(f, ", moves at {} units/s", number(self.velocity))?;
        }
        // Its state has been shown.
        let why = self.why.iter().map(String::as_str).skip(usize::from(!self.enabled));
        let why: Vec<_> = why.collect();
        if why.is_empty() { Ok(()) } else { write!(f, ": {}", why.join(", ")) }
    }
}

/// A number with at most three decimals.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

impl<T: Target> Session<T> {
    /// Returns the present state: the threads that have not ended with the reasons for which they wait, and the axes.
    #[must_use]
    pub fn ending(&self) -> EndReport {
        let threads = self.target.standing_threads().into_iter().map(|thread| self.ending_thread(thread));
        EndReport {
            threads: threads.collect(),
            axes: self.target.standing_axes().into_iter().map(ending_axis).collect(),
        }
    }

    fn ending_thread(&self, standing: UnfinishedThread) -> ThreadReport {
        let UnfinishedThread { thread, state, calls, since, awaited } = standing;
        let calls: Vec<_> = calls.into_iter().flat_map(|at| self.source_calls(at)).collect();
        // An endless loop that looks at its own output does not wait for it.
        let is_endless = calls.first().is_some_and(|call| self.is_in_endless_loop(thread, call));
        let is_awaited =
            |one: &&AwaitedState| !(is_endless && matches!(one, AwaitedState::Bit(_, _, Source::Output)));
        let mut waits_for: Vec<_> =
            awaited.iter().filter(is_awaited).map(|one| self.awaited_words(one)).collect();
        if waits_for.is_empty() && matches!(state, ThreadActivity::Slice | ThreadActivity::Computing) {
            waits_for.extend(calls.first().and_then(|call| self.condition(thread, call)));
        }
        let state_word = match state {
            ThreadActivity::Paused => "paused",
            ThreadActivity::Idle => "idle: it was resumed before it was started",
            ThreadActivity::Computing if waits_for.is_empty() => "computing",
            ThreadActivity::Computing
            | ThreadActivity::Until(_)
            | ThreadActivity::Slice
            | ThreadActivity::Call(..) => "waiting",
        };
        if waits_for.is_empty() {
            waits_for.extend(plain_wait(state));
        }
        ThreadReport { thread, state: state_word, calls, waits_for, since: seconds(since) }
    }

    fn awaited_words(&self, awaited: &AwaitedState) -> String {
        match awaited {
            AwaitedState::Bit(bit, level, source) => bit_words(*bit, u8::from(*level), source),
            AwaitedState::Motion(axis, -1) => {
                format!("axis {axis}, which is disabled: CheckDone({axis}) is -1")
            }
            AwaitedState::Motion(axis, 0) => format!("the end of the motion of axis {axis}"),
            AwaitedState::Motion(axis, _) => format!("axis {axis}, which has ended its motion"),
            AwaitedState::Path => "the end of the path".to_owned(),
            AwaitedState::Recording => "the end of the recording".to_owned(),
            AwaitedState::Lock(owner) => self.lock_words(*owner),
        }
    }

    fn lock_words(&self, owner: Option<Owner>) -> String {
        let Some(Owner { thread, state, at }) = owner else { return "a lock".to_owned() };
        let taken = at.and_then(|at| self.source_calls(at).next());
        let taken = taken.map_or(String::new(), |call| format!(", taken at {call}"));
        match state {
            OwnerState::Active => format!("a lock that thread {thread} has{taken}"),
            OwnerState::Paused => format!("a lock that thread {thread} has{taken}, which is paused"),
            OwnerState::Ended => {
                format!("a lock that thread {thread} has{taken}, which has ended without MutexUnlock")
            }
        }
    }

    /// The source of an instruction; then the function that has it in place of a call, if there is one.
    fn source_calls(&self, at: CodeAddr) -> impl Iterator<Item = SourceCall> {
        let place = self.source(at);
        let around = place.and_then(|place| {
            let (file, function) = (place.file.to_owned(), place.around?.to_owned());
            Some(SourceCall { file, line: None, column: None, function })
        });
        place.map(SourceCall::from).into_iter().chain(around)
    }

    /// Reports whether a program has configured a spindle.
    fn measures_spindle(&self, thread: ThreadId) -> bool {
        self.read(&format!("{thread}:Spindle.Type")).is_ok_and(|kind| kind != 0.0)
    }

    /// Reports whether the innermost loop at a place is one without an end, as far as the sources show it.
    fn is_in_endless_loop(&self, thread: ThreadId, call: &SourceCall) -> bool {
        let program = self.programs.iter().find(|program| program.thread == thread);
        let text = program.and_then(|program| source_text(&program.path, &call.file));
        text.zip(call.line).is_some_and(|(text, line)| WaitCondition::is_endless_at(&text, line))
    }

    /// The condition of the loop at a place, as far as the sources show one.
    fn condition(&self, thread: ThreadId, call: &SourceCall) -> Option<String> {
        let program = self.programs.iter().find(|program| program.thread == thread)?;
        let text = source_text(&program.path, &call.file)?;
        let condition = WaitCondition::around(&text, call.line?)?;
        let Some(name) = condition.operand() else { return Some(format!("`{}`", condition.text())) };
        let value_of = |expression: &str| {
            let watch = self.watch(&format!("{thread}:{expression}")).ok()?;
            Some(number(self.value(&watch)))
        };
        let unit = if name == TRUE_SPEED { " turns a second" } else { "" };
        let value = value_of(name).map_or(String::new(), |value| format!(" (now {value}{unit})"));
        let right = condition.right_side().and_then(value_of);
        let right = right.map_or(String::new(), |value| format!(", where the right side is {value}"));
        let main = source_text(&program.path, &program.name()).unwrap_or_default();
        let is_written = [&text, &main].iter().any(|text| WaitCondition::writes(text, name));
        let unwritten = match () {
            () if name.starts_with(SPINDLE) && !self.measures_spindle(thread) => {
                ", which stays so until a program calls ConfigureSpindle,"
            }
            () if is_written => "",
            () => ", which nothing writes,",
        };
        let setter = self.other_setter(thread, name).unwrap_or_default();
        Some(format!("`{name}`{value}{unwritten} in `{}`{right}{setter}", condition.text()))
    }

    /// Describes the store of another thread in an element of `persist.UserData` in which the program of a thread that waits
    /// for it stores nothing; nothing if several threads do.
    fn other_setter(&self, thread: ThreadId, name: &str) -> Option<String> {
        if !name.starts_with(SHARED) {
            return None;
        }
        let stores = self.programs.iter().filter_map(|program| {
            let text = source_text(&program.path, &program.name())?;
            Some((program, WaitCondition::stored_at(&text, name)?))
        });
        let stores: Vec<_> = stores.collect();
        let [(program, line)] = *stores else { return None };
        if program.thread == thread {
            return None;
        }
        let standing = self.target.standing_threads();
        let other = standing.into_iter().find(|standing| standing.thread == program.thread)?;
        let wait = other.calls.first().and_then(|at| self.source(*at));
        let is_after = wait.is_some_and(|wait| {
            Path::new(wait.file).file_name() == program.path.file_name()
                && wait.line.is_some_and(|waits| waits < line)
        });
        let after = if is_after { ", after its own wait" } else { "" };
        Some(format!(", which thread {} sets at {}:{line}{after}", program.thread, program.name()))
    }
}

/// The elements that all threads share.
const SHARED: &str = "persist.UserData[";
/// The variable in which the firmware measures a spindle.
const SPINDLE: &str = "Spindle.";
const TRUE_SPEED: &str = "Spindle.TrueSpeedRPS";

/// The text of a source file that an image names, which may be relative to the program.
fn source_text(program: &Path, file: &str) -> Option<String> {
    let beside = program.parent().unwrap_or(Path::new("")).join(file);
    let candidates = [PathBuf::from(file), beside, program.to_owned()];
    let same_name = |path: &PathBuf| path.file_name() == Path::new(file).file_name();
    let bytes = candidates.iter().filter(|path| same_name(path)).find_map(|path| fs::read(path).ok())?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

/// Describes the wait of a thread that polls nothing.
fn plain_wait(state: ThreadActivity) -> Option<String> {
    match state {
        ThreadActivity::Until(time) => Some(format!("the time {:.3} s", seconds(time))),
        ThreadActivity::Slice => Some("its next slice".to_owned()),
        ThreadActivity::Call(function, waits) => Some(format!("{function}, which waits {waits}")),
        ThreadActivity::Computing | ThreadActivity::Paused | ThreadActivity::Idle => None,
    }
}

fn bit_words(bit: Bit, level: u8, source: &Source) -> String {
    match source {
        Source::Nothing => format!("bit {bit}, an input that nothing drives (now {level})"),
        Source::Contact(axis, place, active, load) => {
            let (load, active) = (number(*load), u8::from(*active));
            format!("bit {bit} (now {level}): its switch is {active} {place}, and axis {axis} is at {load}")
        }
        Source::Outside(None) => format!("bit {bit} (now {level})"),
        Source::Outside(Some((begin, end))) => {
            let (begin, end) = (seconds(*begin), seconds(*end));
            format!(
                "bit {bit} (now {level}), which had a pulse from {begin:.3} s to {end:.3} s, before the wait"
            )
        }
        Source::Output => format!("bit {bit}, an output of the board (now {level})"),
        Source::Memory => format!("bit {bit}, which only programs set (now {level})"),
        Source::NoKstep => format!("bit {bit} of a KStep, which reads 0 until KStepPresent is set"),
    }
}

fn ending_axis(standing: UsedAxis) -> AxisReport {
    let UsedAxis { axis, name, is_enabled: enabled, dest, position, velocity, reasons, .. } = standing;
    let why = reasons.iter().map(ToString::to_string).collect();
    AxisReport { axis, name, enabled, dest, position, velocity, why }
}

fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}
