//! The session under the clock: it goes as far as the clock says, does what pages ask for, and shows itself to them.
//!
//! A beat is: take what has come, run to the tick that is due, say what was said, send a frame to each page that is due
//! one. All of it happens on one thread, so what pages ask for falls between two ticks.

mod clock;
mod frame;
mod hello;
mod keep;
mod log;
mod programs;
mod samples;
mod saved;
mod threads;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use cc67_host::session::Input;
use cc67_host::{History, Session, Timeline, UserProgram};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::Event;
use serde_json::{Value, json};
use vm::engine::Engine;

use crate::Show;
use crate::desk::{Desk, Incoming, Mailbox, PageId};
use crate::request::PageRequest;
use clock::{Clock, now};
use frame::Moment;
use keep::{Kept, Run};
use log::{Log, Voice};
use programs::Programs;
use samples::Samples;
use threads::ThreadRow;

/// How often the board is brought up to the clock.
const BEAT: Duration = Duration::from_millis(8);
/// How long it may run in one beat, so that it still listens when it cannot keep up.
const STRETCH: Duration = Duration::from_millis(25);
/// Ticks between two looks at how long it has run.
const TICKS_AT_ONCE: u64 = 500;
/// Requests in one beat.
const REQUESTS_AT_ONCE: usize = 256;
/// Most frames a second.
const FRAMES: f64 = 60.0;
/// How often pages receive what threads do.
const THREADS: Duration = Duration::from_millis(100);
/// Signals that are followed where nobody asks for others.
const SIGNALS: &str = "dest0,dest1,dest2";
/// Ticks within which a thread has a slice, if one is active: all seven, and the primary thread in between.
const ROTATION: u64 = 30;

/// Runs a session and shows it until its time has passed.
pub(crate) fn run<E: Engine>(
    session: &mut Session<E>,
    show: Show,
    desk: &Arc<Desk>,
    requests: &Receiver<Incoming>,
) {
    let limit = show.limit.map(|seconds| session.tick_after(seconds));
    let programs = Programs::watched(&show, session.options(), desk);
    let mut stage = Stage::new(session, show, programs);
    while limit.is_none_or(|limit| stage.session.tick() < limit) {
        stage.take(requests);
        stage.advance(limit);
        stage.tell();
    }
    stage.pages.values().for_each(|page| page.mailbox.close());
}

/// A page that looks.
#[derive(Debug)]
struct Page {
    mailbox: Arc<Mailbox>,
    /// The time from one frame to the next; `None` for no frames.
    every: Option<Duration>,
    last: Instant,
    /// The row of samples that it needs next, and of which list.
    next_row: u64,
    generation: u32,
}

/// A session and what belongs to showing it.
struct Stage<'a, E: Engine> {
    session: &'a mut Session<E>,
    show: Show,
    programs: Programs,
    clock: Clock,
    timeline: Timeline<E>,
    samples: Samples,
    log: Log,
    pages: BTreeMap<PageId, Page>,
    /// What pages know of threads, and when.
    told: (Vec<ThreadRow>, Instant),
}

impl<'a, E: Engine> Stage<'a, E> {
    fn new(session: &'a mut Session<E>, show: Show, programs: Programs) -> Self {
        let clock = Clock::new(session.tick(), show.speed, !show.is_paused);
        let mut samples = Samples::default();
        let list = if show.watch.is_empty() { SIGNALS } else { &show.watch };
        let mut log = Log::default();
        if let Err(error) = samples.follow(session, list, clock.speed()) {
            log.say(session.tick(), Voice::Remark, format!("the scope: {error}"));
        }
        let timeline = Timeline::new(session);
        Self {
            session,
            show,
            programs,
            clock,
            timeline,
            samples,
            log,
            pages: BTreeMap::new(),
            told: (Vec::new(), now()),
        }
    }

    /// Waits for a beat, and takes what comes.
    fn take(&mut self, requests: &Receiver<Incoming>) {
        let begin = now();
        for _ in 0..REQUESTS_AT_ONCE {
            let rest = BEAT.saturating_sub(begin.elapsed());
            match requests.recv_timeout(rest) {
                Ok(incoming) => self.receive(incoming),
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return,
            }
            if rest.is_zero() {
                return;
            }
        }
    }

    fn receive(&mut self, incoming: Incoming) {
        match incoming {
            Incoming::Join(id, mailbox) => self.join(id, mailbox),
            Incoming::Leave(id) => {
                self.pages.remove(&id);
            }
            Incoming::Ask(id, request) => {
                if let Err(problem) = self.obey(id, request) {
                    self.answer(id, &json!({ "kind": "problem", "text": problem }));
                }
            }
            Incoming::Saved(compiled) => {
                let programs = self.programs.saved(*compiled);
                self.load(programs);
                self.broadcast(&hello::hello(&self.show));
                self.broadcast(&hello::sources(&self.show));
                self.broadcast(&self.programs.message());
            }
        }
    }

    /// A page has connected: it receives everything.
    fn join(&mut self, id: PageId, mailbox: Arc<Mailbox>) {
        let page = Page { mailbox, every: None, last: now(), next_row: 0, generation: 0 };
        self.pages.insert(id, page);
        self.answer(id, &hello::hello(&self.show));
        self.answer(id, &hello::sources(&self.show));
        self.answer(id, &self.programs.message());
        self.answer(id, &self.signals());
        self.answer(id, &json!({ "kind": "log", "entries": self.log.all() }));
        self.answer(id, &json!({ "kind": "threads", "threads": threads::rows(self.session) }));
    }

    fn signals(&self) -> Value {
        let (names, list) = (self.samples.names(), self.samples.list());
        json!({ "kind": "signals", "generation": self.samples.generation, "names": names, "list": list })
    }

    /// Does what a page asks for.
    fn obey(&mut self, id: PageId, request: PageRequest) -> Result<(), String> {
        match request {
            PageRequest::Rate { frames } => {
                if let Some(page) = self.pages.get_mut(&id) {
                    let is_any = frames.is_finite() && frames > 0.0;
                    page.every = is_any.then(|| Duration::from_secs_f64(1.0 / frames.clamp(0.1, FRAMES)));
                }
            }
            PageRequest::Run { speed } => {
                self.go_on();
                self.clock.run(self.session.tick(), speed);
                self.samples.at_speed(self.session, self.clock.speed());
            }
            PageRequest::Pause {} => self.clock.pause(),
            PageRequest::Tick {} => {
                self.clock.pause();
                let next = self.session.tick().next();
                // What has happened is shown again; nothing is dropped by looking.
                if next <= self.timeline.end() {
                    self.go_to(next)?;
                } else {
                    self.run_to(next);
                }
            }
            PageRequest::Slice {} => {
                self.clock.pause();
                self.go_on();
                self.slice();
            }
            PageRequest::Act { text } => self.act(&text)?,
            PageRequest::Command { line } => self.command(&line)?,
            PageRequest::Start { thread } => self.act(&format!("start thread {}", checked(thread)?))?,
            PageRequest::Stop { thread } => self.act(&format!("stop thread {}", checked(thread)?))?,
            PageRequest::Reload {} => {
                let programs = self.programs.reload();
                self.load(programs);
                self.broadcast(&self.programs.message());
            }
            PageRequest::Watch { list } => {
                let followed = self.samples.follow(self.session, &list, self.clock.speed());
                followed.map_err(|error| error.to_string())?;
                self.broadcast(&self.signals());
            }
            PageRequest::Goto { tick } => {
                self.clock.pause();
                self.go_to(Ticks::new(tick))?;
            }
            PageRequest::Restart {} => self.restart()?,
            PageRequest::Save { name } => self.save(id, &name)?,
            PageRequest::Write { expression, value } => {
                self.session.write(&expression, value).map_err(|error| error.to_string())?;
                self.keep();
            }
        }
        Ok(())
    }

    /// Does what a statement of a stimulus says.
    fn act(&mut self, text: &str) -> Result<(), String> {
        if text.contains(char::is_control) {
            return Err("a statement is one line".to_owned());
        }
        self.session.act(text).map_err(|error| error.to_string())?;
        self.keep();
        Ok(())
    }

    /// The timeline takes up what was done; in the past, the run continues from there.
    fn keep(&mut self) {
        if let History::New(_) = self.timeline.keep(self.session) {
            self.cut();
        }
    }

    /// Whether the board is shown as it was, and continued from there.
    fn is_past(&self) -> bool {
        self.session.tick() < self.timeline.end()
    }

    /// Shows the board as it was at a tick.
    fn go_to(&mut self, tick: Ticks) -> Result<(), String> {
        let tick = tick.min(self.timeline.end());
        self.timeline.go_to(self.session, tick).map_err(|error| error.to_string())
    }

    /// The run continues from the moment that is shown.
    fn go_on(&mut self) {
        if self.is_past()
            && let History::New(_) = self.timeline.branch(self.session)
        {
            self.cut();
        }
    }

    /// What was later than the present moment is gone.
    fn cut(&mut self) {
        let tick = self.session.tick();
        self.log.cut(tick);
        let rows = self.samples.cut(tick);
        self.pages.values_mut().for_each(|page| page.next_row = page.next_row.min(rows));
        self.broadcast(&json!({ "kind": "cut", "tick": tick.get() }));
    }

    /// Begins again, with the programs as they are now.
    fn restart(&mut self) -> Result<(), String> {
        self.timeline.restore(self.session, 0).map_err(|error| error.to_string())?;
        self.go_on();
        for program in self.programs.loaded() {
            self.session.load(program).map_err(|error| error.to_string())?;
        }
        self.keep();
        self.clock.run(self.session.tick(), None);
        Ok(())
    }

    /// Why a run with what was done by hand alone would not be the same; `None` if it would.
    fn obstacle(&self) -> Option<String> {
        let loads = self.session.journal().iter().filter_map(|(tick, input)| match input {
            Input::Load(program) => Some((tick.get(), program.name())),
            _ => None,
        });
        let loads: Vec<_> = loads.collect();
        if let Some((tick, name)) = loads.iter().find(|(tick, _)| *tick > 0) {
            let seconds = *tick as f64 * TIMEBASE;
            return Some(format!("{name} was loaded at {seconds:.3} s: begin again with Restart"));
        }
        let is_whole = self.session.recording().is_complete() || !loads.is_empty();
        (!is_whole).then(|| "a variable was written, which no stimulus does".to_owned())
    }

    /// Saves what was done by hand as a test.
    fn save(&mut self, id: PageId, name: &str) -> Result<(), String> {
        if let Some(obstacle) = self.obstacle() {
            return Err(obstacle);
        }
        let tick = self.session.tick();
        let seconds = tick.get() as f64 * TIMEBASE;
        let console = self.log.console(tick);
        let run = Run { stimulus: self.session.recording().text(), seconds, console };
        let kept = Kept::new(name, &self.show, run)?;
        if let Some(page) = self.pages.get(&id) {
            kept.write(Arc::clone(&page.mailbox));
        }
        Ok(())
    }

    /// Sends script commands, as the PC does.
    fn command(&mut self, line: &str) -> Result<(), String> {
        self.log.say(self.session.tick(), Voice::Command, line.to_owned());
        let quoted = line.replace('\\', "\\\\").replace('"', "\\\"");
        self.act(&format!("command \"{quoted}\""))
    }

    /// Loads and starts programs, and says so.
    fn load(&mut self, programs: Vec<UserProgram>) {
        for program in programs {
            let (name, thread) = (program.name(), program.thread);
            let said = match self.session.load(program) {
                Ok(()) => format!("{name} is loaded into thread {thread} and started"),
                Err(error) => error.to_string(),
            };
            self.keep();
            self.log.say(self.session.tick(), Voice::Remark, said);
        }
    }

    /// Runs to the tick that is due, or as far as there is time for.
    fn advance(&mut self, limit: Option<Ticks>) {
        let begin = now();
        let due = self.clock.due(self.session.tick());
        let due = limit.map_or(due, |limit| due.min(limit));
        while self.session.tick() < due && begin.elapsed() < STRETCH {
            self.run_to(due.min(Ticks::new(self.session.tick().get() + TICKS_AT_ONCE)));
        }
    }

    /// Runs to a tick and takes note of what happens.
    fn run_to(&mut self, tick: Ticks) {
        let mut events = Vec::new();
        self.session.advance(tick, &mut |event| events.push(event));
        self.note(&events);
    }

    /// Runs to the end of the next slice of a user thread.
    fn slice(&mut self) {
        let limit = Ticks::new(self.session.tick().get() + ROTATION);
        let mut events = Vec::new();
        // That nobody has one is seen in the frame.
        let _ = self.session.step_slice(limit, &mut |event| events.push(event));
        self.note(&events);
    }

    /// Takes note of what happened while the board ran.
    fn note(&mut self, events: &[Event]) {
        events.iter().for_each(|event| self.log.note(self.session, event));
        self.keep();
    }

    /// Tells pages what is new.
    fn tell(&mut self) {
        let fresh = self.log.take_fresh();
        let entries = (!fresh.is_empty()).then(|| json!({ "kind": "log", "entries": fresh }));
        if let Some(entries) = entries {
            self.broadcast(&entries);
        }
        if !self.pages.is_empty() && self.told.1.elapsed() >= THREADS {
            let rows = threads::rows(self.session);
            if rows != self.told.0 {
                self.broadcast(&json!({ "kind": "threads", "threads": rows }));
            }
            self.told = (rows, now());
        }
        self.send_frames();
    }

    /// Sends a frame to each page that is due one and has taken the last.
    fn send_frames(&mut self) {
        let tick = self.session.tick();
        let moment = Moment {
            is_running: self.clock.is_running(),
            is_past: self.is_past(),
            end: self.timeline.end(),
            speed: [self.clock.speed(), self.clock.measured(tick)],
        };
        for page in self.pages.values_mut() {
            let is_due = page.every.is_some_and(|every| page.last.elapsed() + BEAT / 2 >= every);
            if !is_due || !page.mailbox.wants_frame() {
                continue;
            }
            if page.generation != self.samples.generation {
                (page.generation, page.next_row) = (self.samples.generation, 0);
            }
            let (bytes, next) = frame::frame(self.session, moment, &self.samples, page.next_row);
            page.next_row = next;
            page.last = now();
            page.mailbox.show(bytes);
        }
    }

    fn answer(&self, id: PageId, message: &Value) {
        if let Some(page) = self.pages.get(&id) {
            page.mailbox.post(&message.to_string().into());
        }
    }

    fn broadcast(&self, message: &Value) {
        let text: Arc<str> = message.to_string().into();
        self.pages.values().for_each(|page| page.mailbox.post(&text));
    }
}

fn checked(thread: i32) -> Result<ThreadId, String> {
    ThreadId::new(thread).ok_or_else(|| format!("there is no thread {thread}; there are 1 to 7"))
}
