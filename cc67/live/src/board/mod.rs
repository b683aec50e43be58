//! The session under the clock: runs as far as the clock requires, executes requests of pages, and sends its state to
//! them.
//!
//! Each beat handles the incoming requests, runs to the tick that is due, reports new messages, and sends a frame to
//! each page for which one is due. All of it happens on one thread, so requests of pages take effect between two ticks.
//! A session run by other code has the same beat without the run: a [`LiveView`].

mod branches;
mod clock;
mod connected;
mod frame;
mod gather;
mod hello;
mod history;
mod jogs;
mod keep;
mod log;
mod machine;
mod programs;
mod samples;
mod saved;
mod sending;
mod threads;
mod turns;
mod view;

pub use view::{LiveView, OwnerRequests};

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use cc67_host::{Attendant, Capability, Session, Target, Timeline, UserProgram};
use kmotiondef::{ThreadId, Ticks};
use runtime::{Event, OpenBox};
use serde_json::{Value, json};
use vm::scheduler::SliceOwner;

use crate::hub::{Hub, Incoming, Mailbox, PageId};
use crate::request::PageRequest;
use crate::{Keeper, Show, TimeControl};
use clock::{Clock, now};
use connected::PageAccess;
use log::{EntrySource, Log, LogEntry};
use programs::Programs;
use samples::Samples;
use threads::ThreadRow;
use turns::SliceHistory;

/// The interval at which the board is run up to the clock's time.
const BEAT: Duration = Duration::from_millis(8);
/// The maximum time for a run in one beat, so that the board still responds when it cannot keep up.
const MAX_RUN: Duration = Duration::from_millis(25);
/// The number of ticks between checks of that time.
const TICKS_AT_ONCE: u64 = 500;
/// The maximum number of requests in one beat.
const REQUESTS_AT_ONCE: usize = 256;
/// The maximum number of frames per second.
const FRAMES: f64 = 60.0;
/// The interval at which pages receive the state of the threads.
const THREADS: Duration = Duration::from_millis(100);
/// The default signals of the scope.
const SIGNALS: &str = "dest0,dest1,dest2";
/// The number of ticks within which every active thread has a slice: all seven, and the primary thread in between.
const ROTATION: u64 = 30;

/// The reason why a board is no longer shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum ShowEnd {
    /// Its time limit was reached.
    TimeOver,
    /// A page requested a board made from the saved machine file.
    NewMachine,
}

/// Runs and shows a session until its time limit, or until another machine is requested; `check` reports whether a
/// board can be made from it.
pub(crate) fn run<T: Target>(
    session: &mut Session<T>,
    show: Show,
    company: BoardUsers<T>,
    check: &mut dyn FnMut() -> Result<(), String>,
    (hub, requests): (&Arc<Hub>, &Receiver<Incoming>),
) -> ShowEnd {
    let limit = show.limit.map(|seconds| session.tick_after(seconds));
    let mut state = ViewState::new(session, show, hub);
    state.company = company;
    state.watch_machine(hub);
    while limit.is_none_or(|limit| session.tick() < limit) {
        state.take(session, requests, BEAT);
        state.stop_silent_jogs(session);
        state.advance(session, limit);
        state.send_updates(session);
        if state.is_rebuild_wanted() {
            match check() {
                Ok(()) => {
                    state.close();
                    return ShowEnd::NewMachine;
                }
                Err(text) => state.refuse_rebuild(&text),
            }
        }
    }
    state.close();
    ShowEnd::TimeOver
}

/// Creates a view of a session run by other code.
pub(crate) fn view<T: Target>(
    session: &mut Session<T>,
    show: Show,
    hub: &Arc<Hub>,
    requests: Receiver<Incoming>,
) -> LiveView<T> {
    LiveView::new(ViewState::new(session, show, hub), requests)
}

/// Executes the requests in a page's messages, and reports the results to it.
pub(crate) fn execute_messages<T: Target>(
    session: &mut Session<T>,
    show: Show,
    messages: &[&str],
) -> Vec<Option<String>> {
    let (hub, _requests) = Hub::new();
    let mut state = ViewState::new(session, show, &hub);
    let id = hub.number();
    state.join(session, id, Arc::default());
    let obeyed = messages.iter().map(|text| {
        let request = PageRequest::parse(text).map_err(|error| error.to_string());
        let refused = request.and_then(|request| state.execute(session, id, request)).err();
        state.send_updates(session);
        refused
    });
    obeyed.collect()
}

/// A connected page.
#[derive(Debug)]
struct Page {
    mailbox: Arc<Mailbox>,
    /// The interval between frames; `None` for no frames.
    every: Option<Duration>,
    /// The time at which the last frame was due.
    last: Instant,
    /// The next row of samples that it needs, and the list to which the row belongs.
    next_row: u64,
    generation: u32,
}

/// The last messages to pages.
#[derive(Debug)]
struct LastMessages {
    /// The threads, and the time of the message.
    threads: Vec<ThreadRow>,
    at: Instant,
    /// The box that waits for an answer.
    open_box: Option<OpenBox>,
}

/// The state of a shown session, besides the session.
#[derive(Debug)]
struct ViewState<T: Target> {
    show: Show,
    programs: Programs,
    clock: Clock,
    /// The past, if going back is possible.
    timeline: Option<Timeline<T>>,
    samples: Samples,
    log: Log,
    pages: BTreeMap<PageId, Page>,
    /// The last messages to pages.
    told: LastMessages,
    /// The thread that had the processor in each of the last ticks.
    turns: SliceHistory,
    /// Requests to the owner of the session.
    owner_requests: OwnerRequests,
    /// The other users of the board.
    company: BoardUsers<T>,
    /// The jogs of pages, and their rights over a connected controller.
    access: PageAccess,
}

/// The users of a board besides its pages.
#[derive(Debug)]
pub struct BoardUsers<T: Target> {
    /// A debugger or similar, which can stop the board.
    pub attendant: Option<Box<dyn Attendant<T>>>,
    /// The keeper of its flash, which sees events before pages do.
    pub keeper: Option<Box<dyn Keeper<T>>>,
}

impl<T: Target> ViewState<T> {
    fn new(session: &mut Session<T>, show: Show, hub: &Arc<Hub>) -> Self {
        let programs = Programs::watched(&show, session.options(), hub);
        let clock = Clock::new(session.tick(), show.speed, !show.is_paused);
        let mut samples = Samples::new(show.time == TimeControl::Real);
        let list = if show.watch.is_empty() { SIGNALS } else { &show.watch };
        let mut log = Log::default();
        samples.follow(session, list, clock.speed());
        for wrong in samples.invalid_signals() {
            log.add_message(
                session.tick(),
                EntrySource::Remark,
                format!("the scope: {}: {}", wrong.name, wrong.text),
            );
        }
        if show.time == TimeControl::Full && session.can(Capability::Surroundings) {
            // Boxes are answered by pages; the statement is recorded, so that a test waits as well.
            let waits = session.act("answer \"boxes=wait\"");
            debug_assert!(waits.is_ok(), "it is a statement: {waits:?}");
        }
        // A target without snapshots is shown without the ability to go back.
        let mut timeline = (show.time == TimeControl::Full).then(|| Timeline::new(session).ok()).flatten();
        if let Some(timeline) = &mut timeline {
            timeline.keep_branches(branches::MOST);
        }
        Self {
            show,
            programs,
            clock,
            timeline,
            samples,
            log,
            pages: BTreeMap::new(),
            told: LastMessages { threads: Vec::new(), at: now(), open_box: None },
            turns: SliceHistory::default(),
            owner_requests: OwnerRequests::default(),
            company: BoardUsers { attendant: None, keeper: None },
            access: PageAccess::default(),
        }
    }

    /// Handles incoming items for some time.
    fn take(&mut self, session: &mut Session<T>, requests: &Receiver<Incoming>, patience: Duration) {
        let begin = now();
        for _ in 0..REQUESTS_AT_ONCE {
            let rest = patience.saturating_sub(begin.elapsed());
            match requests.recv_timeout(rest) {
                Ok(incoming) => self.receive(session, incoming),
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return,
            }
            if rest.is_zero() && !patience.is_zero() {
                return;
            }
        }
    }

    fn receive(&mut self, session: &mut Session<T>, incoming: Incoming) {
        match incoming {
            Incoming::Join(id, mailbox) => self.join(session, id, mailbox),
            Incoming::Leave(id) => {
                self.pages.remove(&id);
                self.stop_jogs_of(session, id);
            }
            Incoming::Ask(id, request) => {
                if let Err(problem) = self.execute(session, id, request) {
                    self.answer(id, &json!({ "kind": "problem", "text": problem }));
                }
            }
            Incoming::Machine(checked) => self.machine_saved(session, checked),
            Incoming::Saved(compiled) => {
                let programs = self.programs.saved(*compiled, self.may_load());
                self.load(session, programs);
                self.broadcast(&hello::hello(&self.show, session.target().axes()));
                self.broadcast(&hello::sources(&self.show));
                self.broadcast(&self.programs.message());
            }
        }
    }

    /// Connects a page, which receives the complete state.
    fn join(&mut self, session: &mut Session<T>, id: PageId, mailbox: Arc<Mailbox>) {
        let page = Page { mailbox, every: None, last: now(), next_row: 0, generation: 0 };
        self.pages.insert(id, page);
        self.answer(id, &hello::hello(&self.show, session.target().axes()));
        self.answer(id, &hello::sources(&self.show));
        if self.is_real() {
            self.answer(id, &self.access.message());
        }
        self.answer(id, &self.programs.message());
        self.answer(id, &self.signals());
        self.answer(id, &self.branches());
        self.answer(id, &self.machine());
        self.answer(id, &log_message(&self.log.all()));
        self.answer(id, &json!({ "kind": "threads", "threads": threads::rows(session), "turns": [] }));
        self.answer(id, &box_message(self.told.open_box.as_ref()));
    }

    fn signals(&self) -> Value {
        let (names, list) = (self.samples.names(), self.samples.list());
        let (generation, wrong) = (self.samples.generation, self.samples.invalid_signals());
        json!({ "kind": "signals", "generation": generation, "names": names, "list": list, "wrong": wrong })
    }

    /// Executes a request of a page.
    fn execute(&mut self, session: &mut Session<T>, id: PageId, request: PageRequest) -> Result<(), String> {
        self.allows(&request)?;
        match request {
            PageRequest::Rate { frames } => {
                if let Some(page) = self.pages.get_mut(&id) {
                    let is_any = frames.is_finite() && frames > 0.0;
                    page.every = is_any.then(|| Duration::from_secs_f64(1.0 / frames.clamp(0.1, FRAMES)));
                }
            }
            PageRequest::Run { speed } => {
                self.go_on(session);
                self.clock.run(session.tick(), speed);
                self.samples.at_speed(session, self.clock.speed());
            }
            PageRequest::Pause {} => self.clock.pause(),
            PageRequest::Tick {} => {
                self.clock.pause();
                let next = session.tick().next();
                // Past ticks are shown again; merely looking at them drops nothing.
                if next <= self.end(session) {
                    self.go_to(session, next)?;
                } else {
                    self.run_to(session, next);
                }
            }
            PageRequest::Slice {} => {
                self.clock.pause();
                self.go_on(session);
                self.slice(session);
            }
            PageRequest::Act { text } => self.act(session, &text)?,
            PageRequest::Answer { setting } => self.answer_box(session, &setting)?,
            PageRequest::Command { line } => self.command(session, &line)?,
            PageRequest::Jog { axis, velocity } => self.jog(session, id, axis, velocity)?,
            PageRequest::Halt {} => self.halt(session)?,
            PageRequest::Control { on } => self.control(session, on),
            PageRequest::Start { thread } => self.start(session, checked(thread)?)?,
            PageRequest::Stop { thread } => self.stop(session, checked(thread)?)?,
            PageRequest::Reload {} => {
                let programs = self.programs.reload();
                self.load(session, programs);
                self.broadcast(&self.programs.message());
                if let Some(refusal) = self.programs.refusal() {
                    self.log.add_message(session.tick(), EntrySource::Remark, refusal.clone());
                    return Err(refusal);
                }
            }
            PageRequest::Watch { list } => {
                self.samples.follow(session, &list, self.clock.speed());
                self.broadcast(&self.signals());
                if self.may_load() {
                    self.sample_on_controller(session);
                }
                if let Some(wrong) = self.samples.invalid_signals().first() {
                    return Err(format!("{}: {}", wrong.name, wrong.text));
                }
            }
            PageRequest::Goto { tick } => {
                self.clock.pause();
                self.go_to(session, Ticks::new(tick))?;
            }
            PageRequest::Branch { id } => self.take_branch(session, id)?,
            PageRequest::Forget { id } => self.forget_branch(id)?,
            PageRequest::Restart {} => self.restart(session)?,
            PageRequest::Save { name } => self.save(session, id, &name)?,
            PageRequest::Gather { from, count, kind } => {
                self.answer(id, &gather::numbers(session, from, count, &kind)?);
            }
            PageRequest::Write { expression, value } => {
                session.write(&expression, value).map_err(|error| error.to_string())?;
                self.keep(session);
            }
        }
        Ok(())
    }

    /// Executes a statement of a stimulus.
    fn act(&mut self, session: &mut Session<T>, text: &str) -> Result<(), String> {
        if text.contains(char::is_control) {
            return Err("a statement is one line".to_owned());
        }
        session.act(text).map_err(|error| error.to_string())?;
        if self.is_guest() {
            self.owner_requests.acts.push(text.to_owned());
        }
        self.keep(session);
        Ok(())
    }

    /// Sends script commands, as the PC does.
    fn command(&mut self, session: &mut Session<T>, line: &str) -> Result<(), String> {
        self.log.add_message(session.tick(), EntrySource::Command, line.to_owned());
        if self.is_real() {
            let mut events = Vec::new();
            session.exchange(line.as_bytes(), &mut |event| events.push(event));
            self.note(session, events);
            return Ok(());
        }
        if self.is_guest() {
            self.owner_requests.commands.push(line.to_owned());
            return Ok(());
        }
        let quoted = line.replace('\\', "\\\\").replace('"', "\\\"");
        self.act(session, &format!("command \"{quoted}\""))
    }

    /// Answers the box that a program has opened.
    fn answer_box(&mut self, session: &mut Session<T>, setting: &str) -> Result<(), String> {
        match self.is_real() {
            true => session.answer(setting).map_err(|error| error.to_string()),
            false => self.act(session, &format!("answer \"{setting}\"")),
        }
    }

    /// Starts a thread.
    fn start(&mut self, session: &mut Session<T>, thread: ThreadId) -> Result<(), String> {
        match self.is_real() {
            true => session.start(thread).map_err(|error| error.to_string()),
            false => self.act(session, &format!("start thread {thread}")),
        }
    }

    /// Stops a thread.
    fn stop(&mut self, session: &mut Session<T>, thread: ThreadId) -> Result<(), String> {
        match self.is_real() {
            true => {
                session.stop(thread);
                Ok(())
            }
            false => self.act(session, &format!("stop thread {thread}")),
        }
    }

    /// Loads and starts programs, and reports it.
    fn load(&mut self, session: &mut Session<T>, programs: Vec<UserProgram>) {
        for program in programs {
            let (name, thread) = (program.name(), program.thread);
            let said = match session.load(program) {
                Ok(()) => format!("{name} is loaded into thread {thread} and started"),
                Err(error) => error.to_string(),
            };
            self.keep(session);
            self.log.add_message(session.tick(), EntrySource::Remark, said);
        }
    }

    /// Runs to the tick that is due, or as far as time allows.
    fn advance(&mut self, session: &mut Session<T>, limit: Option<Ticks>) {
        if self.company.attendant.is_some() {
            self.run_to(session, session.tick());
        }
        if self.is_real() {
            // Meanwhile that time has passed.
            return self.run_to(session, session.tick().next());
        }
        let begin = now();
        let due = self.clock.due(session.tick());
        let due = limit.map_or(due, |limit| due.min(limit));
        while session.tick() < due && begin.elapsed() < MAX_RUN {
            self.run_to(session, due.min(Ticks::new(session.tick().get() + TICKS_AT_ONCE)));
        }
    }

    /// Runs to a tick, and handles the events.
    fn run_to(&mut self, session: &mut Session<T>, tick: Ticks) {
        let mut events = Vec::new();
        let looks = !self.pages.is_empty() && self.told.at.elapsed() >= THREADS;
        if let Some(mut attendant) = self.company.attendant.take() {
            attendant.advance(session, tick, &mut |event| events.push(event), &mut |session| {
                self.send_updates(session);
                ControlFlow::Continue(())
            });
            self.company.attendant = Some(attendant);
        } else {
            self.turns.advance(session, tick, looks, &mut |event| events.push(event));
        }
        let events = match &mut self.company.keeper {
            Some(keeper) => keeper.keep(session, events),
            None => events,
        };
        self.note(session, events);
    }

    /// Runs to the end of the next slice of a user thread.
    fn slice(&mut self, session: &mut Session<T>) {
        for _ in 0..ROTATION {
            self.run_to(session, session.tick().next());
            if let SliceOwner::User(_) = session.target().turn() {
                return;
            }
        }
        // If no thread has one, the frame shows it.
    }

    /// Handles the events of a run.
    fn note(&mut self, session: &mut Session<T>, events: Vec<Event>) {
        events.iter().for_each(|event| self.log.note(session, event));
        self.keep(session);
        if self.is_guest() {
            self.owner_requests.events.extend(events);
        }
    }

    /// Returns whether the session is run by other code.
    fn is_guest(&self) -> bool {
        match self.show.time {
            TimeControl::Full | TimeControl::Real => false,
            TimeControl::Forward | TimeControl::Foreign => true,
        }
    }
}

/// Entries of the log, as a message to pages.
fn log_message(entries: &[&LogEntry]) -> Value {
    json!({ "kind": "log", "entries": entries })
}

/// The box that waits for an answer, as a message to pages.
fn box_message(open_box: Option<&OpenBox>) -> Value {
    let shown = open_box.map(|open_box| match open_box {
        OpenBox::Message { text, buttons } => json!({ "text": text, "buttons": buttons }),
        OpenBox::Input { text } => json!({ "text": text }),
    });
    json!({ "kind": "asks", "box": shown })
}

fn checked(thread: i32) -> Result<ThreadId, String> {
    ThreadId::new(thread).ok_or_else(|| format!("no such thread {thread} (1-7)"))
}
