//! A session on any engine with one set of calls, and the messages of its board so far.

mod fields;
mod log;

use std::collections::BTreeMap;

use cc67_host::{
    Capability, HostError, Session, Snapshot, SnapshotError, Target, Until, UserProgram, Watch, WatchError,
};
use kmotiondef::{Bit, ThreadId, Ticks};
use runtime::trace::Item;
use runtime::{Event, EventKind};

pub(crate) use fields::{AxisField, field, fields, stored};
pub(crate) use log::{Fault, Log, LogLine};

use crate::trace::{Columns, Recorder};

/// Steps of a board in a portion of a run: at most some milliseconds, after which the clock is read.
const STEPS: usize = 4000;

/// Ticks of a portion in which a condition is tested.
const TICKS: u64 = 4000;

/// The result of a portion of a run.
pub(crate) struct PortionResult {
    /// True if the run is over.
    pub(crate) is_over: bool,
    /// True if the run's condition is met, or all programs have ended.
    pub(crate) is_met: bool,
    /// The fault that stopped it.
    pub(crate) fault: Option<Fault>,
}

/// The reason why a value is not stored.
pub(crate) enum StoreError {
    /// The expression is wrong.
    Wrong(WatchError),
    /// The value does not fit in its type.
    TooLarge(String),
    /// The board does not store it.
    Refused(String),
}

impl From<WatchError> for StoreError {
    fn from(error: WatchError) -> Self {
        Self::Wrong(error)
    }
}

/// A board under control, whichever engine it has.
pub(crate) trait Control: 'static {
    /// Number of the last tick that is over.
    fn tick(&mut self) -> u64;
    /// A portion of a run to the end of a tick.
    fn advance(&mut self, limit: u64) -> PortionResult;
    /// A portion of a run until all has ended.
    fn run(&mut self, limit: u64) -> PortionResult;
    /// A portion of a run until a condition is met.
    fn run_until(&mut self, condition: &Until, limit: u64) -> PortionResult;
    /// Ends the run: held output is flushed, expectations are evaluated.
    fn finish(&mut self) -> PortionResult;
    /// Runs to the end of the next slice of a thread.
    fn step_thread(&mut self, thread: ThreadId, limit: u64) -> PortionResult;
    /// Reports whether nothing is active and nothing is under way.
    fn has_ended(&mut self) -> bool;
    /// Sends a line, lets pass the time that it takes, and returns the lines of the reply.
    fn exchange(&mut self, line: &[u8]) -> (Vec<String>, Option<Fault>);
    /// Does what a statement of a stimulus says.
    fn act(&mut self, action: &str) -> Result<(), HostError>;
    /// Drives an input.
    fn drive(&mut self, bit: Bit, level: bool) -> Result<(), HostError>;
    /// The level of a bit.
    fn bit(&mut self, bit: Bit) -> Result<bool, HostError>;
    /// Parses an item or expression to be watched.
    fn watch(&mut self, text: &str) -> Result<Watch, WatchError>;
    /// Reports whether the board is a controller, of whose memory not everything can be read.
    fn is_connected(&self) -> bool;
    /// The value of an item or an expression.
    fn read(&mut self, text: &str) -> Result<f64, WatchError>;
    /// Stores a value.
    fn write(&mut self, text: &str, value: f64) -> Result<(), StoreError>;
    /// A field of an axis, by its name in C.
    fn field(&mut self, axis: usize, name: &str) -> Result<Option<f64>, HostError>;
    /// Stores a value in a field of an axis; `false` for another name.
    fn set_field(&mut self, axis: usize, name: &str, value: f64) -> Result<bool, StoreError>;
    /// An element of `persist.UserData`.
    fn user_data(&mut self, index: usize) -> Option<i32>;
    /// Stores an element of `persist.UserData`.
    fn set_user_data(&mut self, index: usize, value: i32) -> bool;
    /// Reports whether a thread is active.
    fn is_active(&mut self, thread: ThreadId) -> bool;
    /// Loads a program.
    fn load(&mut self, program: UserProgram) -> Result<(), HostError>;
    /// Starts a thread.
    fn start(&mut self, thread: ThreadId) -> Result<(), HostError>;
    /// Stops a thread.
    fn stop(&mut self, thread: ThreadId);
    /// Sends characters to the serial port.
    fn send_to_uart(&mut self, bytes: &[u8]);
    /// Keeps the present instant under a number.
    fn snapshot(&mut self, number: u64) -> Result<(), SnapshotError>;
    /// Goes back to an instant; `false` for an unknown number.
    fn restore(&mut self, number: u64) -> bool;
    /// Forgets an instant.
    fn forget(&mut self, number: u64);
    /// Begins a trace.
    fn begin_trace(&mut self, items: &[String], every: u64, samples: usize) -> Result<(), WatchError>;
    /// A portion of the trace.
    fn trace(&mut self) -> PortionResult;
    /// The trace as far as it is.
    fn end_trace(&mut self) -> Option<Columns>;
    /// The output of the board since power-up.
    fn log(&self) -> &Log;
    /// Sets whether a trap or an expectation that is not met ends a run.
    fn stop_at_faults(&mut self, stops: bool);
    /// Returns the actions by hand as a stimulus, and whether it holds all of them.
    fn recording(&self) -> (String, bool);
}

/// A session with the log of its board.
pub(crate) struct LoggedSession<T: Target> {
    session: Session<T>,
    log: Log,
    stops_at_faults: bool,
    recorder: Option<Recorder>,
    snapshots: BTreeMap<u64, (Snapshot<T>, Log)>,
    /// Expressions that were read before, with the programs that are loaded now.
    watches: WatchCache,
    /// Places that were written before, with these programs.
    places: WatchCache,
}

/// Expressions that were compiled before, by their text.
#[derive(Default)]
struct WatchCache(BTreeMap<String, Watch>);

impl WatchCache {
    /// Most expressions that are kept.
    const MOST: usize = 1000;

    /// The expression with a text, compiled now if it is new.
    fn find(
        &mut self,
        text: &str,
        compile: impl FnOnce() -> Result<Watch, WatchError>,
    ) -> Result<Watch, WatchError> {
        if let Some(watch) = self.0.get(text) {
            return Ok(watch.clone());
        }
        let watch = compile()?;
        if self.0.len() == Self::MOST {
            self.0.clear();
        }
        self.0.insert(text.to_owned(), watch.clone());
        Ok(watch)
    }
}

/// Most bytes of the recording of what is done by hand.
const RECORDING: usize = 1 << 20;

impl<T: Target> LoggedSession<T> {
    /// A session whose board has said nothing yet.
    pub(crate) fn new(mut session: Session<T>) -> Self {
        session.limit_recording(RECORDING);
        Self {
            session,
            log: Log::default(),
            stops_at_faults: true,
            recorder: None,
            snapshots: BTreeMap::new(),
            watches: WatchCache::default(),
            places: WatchCache::default(),
        }
    }

    /// Forgets what was compiled in the words of other programs.
    fn forget_expressions(&mut self) {
        self.watches = WatchCache::default();
        self.places = WatchCache::default();
    }

    /// Lets time pass, and takes up what the board says.
    fn pass<R>(&mut self, work: impl FnOnce(&mut Session<T>, &mut dyn FnMut(Event)) -> R) -> R {
        let mut events = Vec::new();
        let result = work(&mut self.session, &mut |event| events.push(event));
        if !events.is_empty() {
            self.hear(events);
        }
        result
    }

    fn hear(&mut self, events: Vec<Event>) {
        let is_load = |event: &Event| matches!(event.kind, EventKind::Loaded(..));
        if events.iter().any(is_load) {
            self.forget_expressions();
        }
        let session = &self.session;
        self.log.take(events, || session.debug().into_iter().map(|(_, debug)| debug).collect());
    }

    /// Returns the fault that stops a run now, if there is one.
    fn fault(&mut self) -> Option<Fault> {
        if let Some(reason) = self.session.target().loss_reason() {
            return Some(Fault::Lost { text: reason.to_owned() });
        }
        if self.stops_at_faults { self.log.take_fault() } else { None }
    }

    /// Takes up what a controller has sent: its time passes by itself.
    fn refresh(&mut self) {
        if !self.session.can(Capability::StopTime) {
            self.session.refresh();
            self.pass(|session, events| session.step(session.tick().next(), events));
        }
    }

    /// Steps of a portion; those of a controller wait for it.
    fn steps(&self) -> usize {
        if self.session.can(Capability::StopTime) { STEPS } else { 1 }
    }

    /// Steps until `is_over` returns true or the portion is used up.
    fn portion(&mut self, limit: Ticks, is_over: impl Fn(&Session<T>) -> bool) -> PortionResult {
        let mut events = Vec::new();
        for _ in 0..self.steps() {
            let is_met = is_over(&self.session);
            if is_met || self.session.tick() >= limit {
                return PortionResult { is_over: true, is_met, fault: None };
            }
            self.session.step(limit, &mut |event| events.push(event));
            // Most steps have no message.
            if !events.is_empty() || self.session.target().loss_reason().is_some() {
                self.hear(std::mem::take(&mut events));
                if let Some(fault) = self.fault() {
                    return PortionResult { is_over: true, is_met: false, fault: Some(fault) };
                }
            }
        }
        PortionResult { is_over: false, is_met: false, fault: None }
    }

    fn over(&mut self, is_met: bool) -> PortionResult {
        PortionResult { is_over: true, is_met, fault: self.fault() }
    }
}

impl<T: Target + 'static> Control for LoggedSession<T> {
    fn tick(&mut self) -> u64 {
        self.refresh();
        self.session.tick().get()
    }

    fn advance(&mut self, limit: u64) -> PortionResult {
        self.portion(Ticks::new(limit), |_| false)
    }

    fn run(&mut self, limit: u64) -> PortionResult {
        self.portion(Ticks::new(limit), Session::has_ended)
    }

    fn run_until(&mut self, condition: &Until, limit: u64) -> PortionResult {
        let stops = self.stops_at_faults;
        let either =
            Until::Any(if stops { vec![condition.clone(), Until::Trapped] } else { vec![condition.clone()] });
        let end = self.session.tick().get().saturating_add(TICKS).min(limit);
        let is_met = self.pass(|session, events| session.run_until(&either, Ticks::new(end), events));
        let fault = self.fault();
        PortionResult {
            is_over: is_met || fault.is_some() || end >= limit,
            is_met: is_met && fault.is_none(),
            fault,
        }
    }

    fn finish(&mut self) -> PortionResult {
        self.pass(|session, events| session.finish(events));
        self.over(true)
    }

    fn step_thread(&mut self, thread: ThreadId, limit: u64) -> PortionResult {
        let end = self.session.tick().get().saturating_add(TICKS).min(limit);
        let is_met = self.pass(|session, events| session.step_thread(thread, Ticks::new(end), events));
        let fault = self.fault();
        PortionResult { is_over: is_met || fault.is_some() || end >= limit, is_met, fault }
    }

    fn has_ended(&mut self) -> bool {
        self.refresh();
        self.session.has_ended()
    }

    fn exchange(&mut self, line: &[u8]) -> (Vec<String>, Option<Fault>) {
        self.log.replies.clear();
        self.pass(|session, events| session.exchange(line, events));
        (std::mem::take(&mut self.log.replies), self.fault())
    }

    fn act(&mut self, action: &str) -> Result<(), HostError> {
        self.session.act(action)
    }

    fn drive(&mut self, bit: Bit, level: bool) -> Result<(), HostError> {
        self.session.drive_input(bit, level)
    }

    fn bit(&mut self, bit: Bit) -> Result<bool, HostError> {
        self.refresh();
        if self.session.can(Capability::StopTime) {
            return Ok(self.session.bit(bit));
        }
        let level = self.session.target().value(Item::of_bit(bit));
        let unknown =
            || HostError::Link(format!("the status record of a controller does not have bit {bit}"));
        if level.is_nan() { Err(unknown()) } else { Ok(level != 0.0) }
    }

    fn watch(&mut self, text: &str) -> Result<Watch, WatchError> {
        self.watches.find(text, || self.session.watch(text))
    }

    fn read(&mut self, text: &str) -> Result<f64, WatchError> {
        self.refresh();
        let watch = self.watch(text)?;
        Ok(self.session.value(&watch))
    }

    fn is_connected(&self) -> bool {
        !self.session.can(Capability::StopTime)
    }

    fn write(&mut self, text: &str, value: f64) -> Result<(), StoreError> {
        let place = self.places.find(text, || self.session.place(text))?;
        if let Some((least, greatest)) = place.limits()
            && !(least..=greatest).contains(&value.trunc())
        {
            return Err(StoreError::TooLarge(format!(
                "{value} does not fit in `{text}`: {least} to {greatest}"
            )));
        }
        Ok(self.session.write_to(&place, value)?)
    }

    fn field(&mut self, axis: usize, name: &str) -> Result<Option<f64>, HostError> {
        self.refresh();
        field(&self.session, axis, name)
    }

    fn set_field(&mut self, axis: usize, name: &str, value: f64) -> Result<bool, StoreError> {
        let Some(stored) = stored(axis, name, value) else { return Ok(false) };
        let (address, bytes) = stored.map_err(StoreError::TooLarge)?;
        let address = self.session.target().place_of(address);
        let is_stored = self.session.store(address, &bytes);
        is_stored.map(|()| true).map_err(|error| StoreError::Refused(error.to_string()))
    }

    fn user_data(&mut self, index: usize) -> Option<i32> {
        self.refresh();
        self.session.user_data(index)
    }

    fn set_user_data(&mut self, index: usize, value: i32) -> bool {
        self.session.set_user_data(index, value)
    }

    fn is_active(&mut self, thread: ThreadId) -> bool {
        self.refresh();
        self.session.thread(thread).is_active()
    }

    fn load(&mut self, program: UserProgram) -> Result<(), HostError> {
        self.forget_expressions();
        self.session.load(program)
    }

    fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.session.start(thread)
    }

    fn stop(&mut self, thread: ThreadId) {
        self.session.stop(thread);
    }

    fn send_to_uart(&mut self, bytes: &[u8]) {
        self.session.send_to_uart(bytes);
    }

    fn snapshot(&mut self, number: u64) -> Result<(), SnapshotError> {
        let snapshot = self.session.snapshot()?;
        self.snapshots.insert(number, (snapshot, self.log.clone()));
        Ok(())
    }

    fn restore(&mut self, number: u64) -> bool {
        let Some((snapshot, log)) = self.snapshots.get(&number) else { return false };
        let is_done = self.session.restore(snapshot).is_ok();
        if is_done {
            self.log.clone_from(log);
            self.forget_expressions();
        }
        is_done
    }

    fn forget(&mut self, number: u64) {
        self.snapshots.remove(&number);
    }

    fn begin_trace(&mut self, items: &[String], every: u64, samples: usize) -> Result<(), WatchError> {
        self.recorder = Some(Recorder::new(&self.session, items, every, samples)?);
        Ok(())
    }

    fn trace(&mut self) -> PortionResult {
        let Some(mut recorder) = self.recorder.take() else { return self.over(false) };
        let mut portion = PortionResult { is_over: false, is_met: false, fault: None };
        let mut events = Vec::new();
        for _ in 0..self.steps() {
            let Some(next) = recorder.next(self.session.tick()) else {
                portion.is_over = true;
                break;
            };
            self.session.step(next, &mut |event| events.push(event));
            // The time of a controller may be past it.
            if self.session.tick() >= next {
                recorder.sample(&self.session);
            }
            if !events.is_empty() {
                self.hear(std::mem::take(&mut events));
                portion.fault = self.fault();
                if portion.fault.is_some() {
                    portion.is_over = true;
                    break;
                }
            }
        }
        self.recorder = Some(recorder);
        portion
    }

    fn end_trace(&mut self) -> Option<Columns> {
        self.recorder.take().map(Recorder::finish)
    }

    fn log(&self) -> &Log {
        &self.log
    }

    fn stop_at_faults(&mut self, stops: bool) {
        self.stops_at_faults = stops;
    }

    fn recording(&self) -> (String, bool) {
        let recording = self.session.recording();
        (recording.text().to_owned(), recording.is_complete())
    }
}
