//! The target: a connected controller.

mod acting;
mod attending;
mod reading;
mod sampling;

use std::cell::RefCell;
use std::fmt;
use std::time::{Duration, Instant};

use cc67_host::target::Target;
use cc67_host::{Capability, EventSink, HostError, NoSnapshot, SnapshotError, Unsupported, UserProgram};
use cc67_wire::{Client, Progress, Status, WireError};
use compiler::Options;
use compiler::firmware::FirmwareNames;
use kmotiondef::boards::TargetBoard;
use kmotiondef::{Axes, AxisId, Bit, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::stimulus::Stimulus;
use runtime::trace::{Item, Quantity, TraceRequest};
use runtime::{Answers, Event, EventKind, HostFiles, OpenBox, RemoteBoard as _, RequestServer};
use vm::scheduler::SliceOwner;
use vm::thread::ThreadState;

use crate::bench::Bench;
use crate::clock::{PassingTime, now};
use crate::commands::Commands;
use crate::controller::sampling::ActiveSampling;
use crate::files::{FileRemarks, Files};
use crate::image;
use crate::monitor::{self, Monitor};
use crate::recording::BoardRecording;
use crate::seen::SeenMemory;
use crate::terms::{LoadTerms, ProgramStart};
use crate::threads::BoardThreads;

/// The longest time that a call waits for the console before it does other work.
const LONGEST_WAIT: Duration = Duration::from_millis(10);
/// The time within which the last console lines of a program come after its end.
const SILENCE: Duration = Duration::from_millis(200);
/// The longest time to wait for the last lines.
const LAST_LINES: Duration = Duration::from_secs(5);

/// A receiver of the progress after each block of a download.
type ProgressSink = Box<dyn FnMut(ThreadId, Progress) + Send>;

/// The terms of a load.
struct LoadSettings {
    /// The version of the firmware for which sources are linked.
    linked_for: String,
    terms: LoadTerms,
    progress: ProgressSink,
}

/// A connected controller, see the [crate](crate).
pub struct Controller {
    client: RefCell<Client>,
    monitor: RefCell<Monitor>,
    loading: LoadSettings,
    time: PassingTime,
    /// The last status record.
    status: Option<Status>,
    /// The known contents of memory.
    seen: SeenMemory,
    threads: BoardThreads,
    requests: RequestServer,
    /// Events for the next step.
    pending: Vec<EventKind>,
    remarks: FileRemarks,
    recording: Option<BoardRecording>,
    sampling: Option<ActiveSampling>,
    /// The stimulus, performed by a person and the PC.
    bench: Bench,
    /// True if the status record has been read since the bench last checked it.
    is_fresh: bool,
    /// The reason why the controller can no longer be reached.
    lost: Option<String>,
}

impl fmt::Debug for Controller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Controller")
            .field("client", &self.client)
            .field("time", &self.time)
            .field("threads", &self.threads)
            .field("lost", &self.lost)
            .finish_non_exhaustive()
    }
}

impl Controller {
    pub(crate) fn new(client: Client, options: &Options, terms: LoadTerms, progress: ProgressSink) -> Self {
        let firmware = &options.firmware;
        let linked_for = firmware.version().unwrap_or(FirmwareNames::board(firmware).version).to_owned();
        let board = TargetBoard::of_version(client.version().trim_end());
        let mut monitor = Monitor::new(options.clone(), linked_for.clone());
        if terms.has_monitor || terms.verifies {
            monitor.allow();
        }
        Self {
            client: RefCell::new(client),
            monitor: RefCell::new(monitor),
            seen: SeenMemory::new(board),
            loading: LoadSettings { linked_for, terms, progress },
            time: PassingTime::new(),
            status: None,
            threads: BoardThreads::new(),
            requests: RequestServer::new(None),
            pending: Vec::new(),
            remarks: FileRemarks::default(),
            recording: None,
            sampling: None,
            bench: Bench::default(),
            is_fresh: false,
            lost: None,
        }
    }

    /// Provides the files and answers of a PC for programs on the board; boxes without an answer stay open.
    pub(crate) fn serve(&mut self, files: Box<dyn HostFiles>, answers: Option<Answers>) {
        let files = Files::new(files, self.remarks.clone());
        self.client.get_mut().serve_files(Box::new(files));
        self.requests = RequestServer::new(answers);
        self.requests.leave_boxes_open();
    }

    /// Starts a stimulus, whose actions are performed by a person and the PC.
    ///
    /// # Errors
    /// A statement needs a model of the machine.
    pub(crate) fn start_stimulus(&mut self, stimulus: Stimulus) -> Result<(), HostError> {
        self.bench = Bench::new(stimulus)?;
        Ok(())
    }

    /// Returns the last status record.
    #[must_use]
    pub const fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// Returns the version text of the board's firmware.
    #[must_use]
    pub fn version(&self) -> String {
        self.client.borrow().version().to_owned()
    }

    /// Notes the threads that already run, stores the values, loads the programs, and starts those marked as started.
    ///
    /// # Errors
    /// A program is rejected, a value is not in `persist.UserData`, or the link fails.
    pub(crate) fn begin(
        &mut self,
        programs: &[UserProgram],
        values: &[(GuestAddr, Vec<u8>)],
    ) -> Result<(), HostError> {
        let status = self.client.get_mut().status().map_err(link)?;
        self.note_status(status);
        self.threads.note_foreign();
        for (address, bytes) in values {
            self.write(self.seen.place_of(*address), bytes)?;
        }
        for program in programs {
            self.load(program)?;
        }
        self.time.origin = now();
        let starting = programs.iter().filter(|program| program.starts);
        let starting: Vec<_> = starting.map(|program| program.thread).collect();
        match self.loading.terms.start {
            ProgramStart::AtOnce => self.start_together(&starting)?,
            ProgramStart::WithTime => self.threads.keep_waiting(starting),
            ProgramStart::ByCall => {}
        }
        Ok(())
    }

    /// Records a failure: a lost link permanently, any other as an event.
    fn note_error(&mut self, error: &WireError) {
        let text = error.to_string();
        if error.is_disconnected() || matches!(error, WireError::Silent { .. }) {
            self.lost.get_or_insert(text);
            self.status = None;
            self.seen.clear();
        } else {
            self.pending.push(EventKind::Host(text));
        }
    }

    /// Answers a request to the PC in these elements of `persist.UserData`, if there is one.
    fn answer(&mut self, words: [u32; 8]) {
        match self.requests.serve(&mut Commands(self.client.get_mut()), words) {
            Ok(said) => self.pending.extend(said.into_iter().map(EventKind::Host)),
            Err(error) => self.note_error(&error),
        }
    }

    /// Waits for the console until a given time.
    fn wait(&mut self, until: Instant) {
        let pause = until.saturating_duration_since(now());
        if self.lost.is_some() {
            std::thread::sleep(pause);
        } else if let Err(error) = self.client.get_mut().service(pause) {
            self.note_error(&error);
        }
    }

    /// Passes on the received events.
    fn deliver(&mut self, events: EventSink<'_>) {
        let at = self.now();
        let lines = self.client.get_mut().take_console();
        if !lines.is_empty() {
            self.time.heard = now();
        }
        if let Some(thread) = self.monitor.get_mut().take_announced() {
            self.pending.push(EventKind::Host(format!(
                "thread {thread} holds cc67's monitor now, which reads memory and pauses threads"
            )));
        }
        let remarks = self.remarks.take().into_iter().map(EventKind::Host);
        lines.iter().for_each(|line| self.bench.note_line(line));
        let lines = lines.into_iter().map(EventKind::ConsoleLine);
        let all: Vec<_> = lines.chain(remarks).chain(self.pending.drain(..)).collect();
        all.into_iter().for_each(|kind| events(Event { at, kind }));
    }

    /// Executes a command line, and keeps its reply for the next step.
    fn send_line(&mut self, line: &[u8]) {
        let line = String::from_utf8_lossy(line).into_owned();
        match self.client.get_mut().send_line(&line) {
            Ok(lines) => {
                self.pending.extend(lines.into_iter().map(|line| EventKind::Reply(line.into_bytes())));
            }
            // The board's message arrives as a console line.
            Err(WireError::Refused { message, .. }) => {
                self.pending.push(EventKind::ConsoleLine(message.into_bytes()));
            }
            Err(error) => self.note_error(&error),
        }
        self.time.next_status = now();
    }
}

/// The error of a link, for sessions.
pub(crate) fn link(error: WireError) -> HostError {
    HostError::Link(error.to_string())
}

impl Target for Controller {
    type Snapshot = NoSnapshot;

    fn name(&self) -> &'static str {
        "a connected controller"
    }

    fn axes(&self) -> Axes {
        self.seen.axes()
    }

    fn can(&self, capability: Capability) -> bool {
        matches!(
            capability,
            Capability::Answers | Capability::Pauses | Capability::Recordings | Capability::FastSamples
        )
    }

    fn open_box(&self) -> Option<OpenBox> {
        self.requests.open_box()
    }

    fn answer(&mut self, setting: &str) -> Result<(), HostError> {
        self.requests.answer(setting).map_err(|error| HostError::Link(error.to_string()))?;
        self.time.next_status = now();
        Ok(())
    }

    fn loss_reason(&self) -> Option<&str> {
        self.lost.as_deref()
    }

    fn tick(&self) -> Ticks {
        self.time.tick
    }

    fn now(&self) -> Cycles {
        let tick = i64::try_from(self.tick().get()).unwrap_or(i64::MAX);
        Cycles::new(tick.saturating_mul(Cycles::PER_TICK.get()))
    }

    fn step(&mut self, limit: Ticks, events: EventSink<'_>) {
        self.start_waiting();
        let end = self.time.moment_of(limit).unwrap_or_else(|| now() + LONGEST_WAIT);
        if now() < end {
            self.wait(end.min(now() + LONGEST_WAIT));
        }
        self.poll();
        self.time.note();
        self.attend();
        self.deliver(events);
    }

    fn finish(&mut self, events: EventSink<'_>) {
        if self.lost.is_none()
            && let Err(error) = self.client.get_mut().settle(SILENCE, LAST_LINES)
        {
            self.note_error(&error);
        }
        self.time.note();
        self.deliver(events);
        self.end_attending();
        self.end_sampling();
        self.deliver(events);
        self.end_recording(events);
    }

    fn record(&mut self, request: TraceRequest) {
        if let Err(error) = self.begin_recording(&request) {
            self.pending.push(EventKind::Host(format!("nothing is recorded: {error}")));
        }
    }

    fn sample(&mut self, quantities: Vec<Quantity>) -> Result<f64, HostError> {
        self.begin_sampling(&quantities)
    }

    fn take_samples(&mut self) -> Option<Vec<(Ticks, Vec<f64>)>> {
        self.sampling.as_mut().map(ActiveSampling::take)
    }

    fn has_ended(&self) -> bool {
        self.lost.is_some()
            || !self.threads.has_own_active()
                && !self.bench.has_plans()
                && self.pending.is_empty()
                && now().duration_since(self.time.heard) >= SILENCE
    }

    fn turn(&self) -> SliceOwner {
        SliceOwner::Primary
    }

    fn load(&mut self, program: &UserProgram) -> Result<(), HostError> {
        let client = self.client.get_mut();
        let board = client.version().trim_end().to_owned();
        let image = image::of_program(program, &self.loading.linked_for, &board)?;
        let progress = &mut self.loading.progress;
        let is_forced = self.loading.terms.is_forced;
        let loaded = client.load(&image, is_forced, &mut |piece| progress(program.thread, piece));
        loaded.map_err(link)?;
        self.monitor.get_mut().invalidate(program.thread);
        self.sampling = self.sampling.take().filter(|sampling| sampling.thread() != program.thread);
        self.monitor.get_mut().note_change();
        self.threads.note_loaded(program.thread, program.debug_info());
        if self.loading.terms.verifies {
            self.verify(&image)?;
        }
        Ok(())
    }

    fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.threads.program(thread)
    }

    fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.start_together(&[thread])
    }

    fn stop(&mut self, thread: ThreadId) {
        match self.client.get_mut().stop_thread(thread) {
            Ok(()) => self.threads.note_stopped(thread),
            Err(error) => self.note_error(&error),
        }
    }

    fn thread(&self, thread: ThreadId) -> &ThreadState {
        self.threads.state(thread)
    }

    fn runs_processor_code(&self, thread: ThreadId) -> Option<bool> {
        self.threads.program(thread).map(|_| true)
    }

    fn place_of(&self, address: GuestAddr) -> GuestAddr {
        self.seen.place_of(address)
    }

    fn read(&self, address: GuestAddr, bytes: &mut [u8]) -> Result<(), HostError> {
        if let Some(reason) = &self.lost {
            return Err(HostError::Link(reason.clone()));
        }
        if let Some(elements) = self.elements(address, bytes.len()) {
            let mut client = self.client.borrow_mut();
            let words = Commands(&mut client).user_data(elements.start, elements.len()).map_err(link)?;
            bytes
                .chunks_mut(4)
                .zip(words)
                .for_each(|(place, word)| place.copy_from_slice(&word.to_le_bytes()));
            return Ok(());
        }
        if self.seen.read(address, bytes).is_some() {
            return Ok(());
        }
        let mut monitor = self.monitor.borrow_mut();
        if !monitor.is_allowed() {
            return Err(HostError::Link(
                "no command of the controller reads this: only persist.UserData, and what its status record has of \
                 axes, bits and analog channels; cc67's monitor, which does, is not allowed here"
                    .to_owned(),
            ));
        }
        monitor.read(&mut self.client.borrow_mut(), &self.threads.free(), address, bytes)
    }

    fn is_mapped(&self, address: GuestAddr) -> bool {
        monitor::is_memory(address)
    }

    fn refresh(&mut self) {
        self.time.next_status = now();
        self.poll();
    }

    fn peek(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()> {
        self.seen.look(address, bytes)
    }

    fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError> {
        self.monitor.get_mut().note_change();
        if let Some(elements) = self.elements(address, bytes.len()) {
            let mut board = Commands(self.client.get_mut());
            for (index, word) in elements.zip(bytes.as_chunks().0) {
                board.set_user_data(index, u32::from_le_bytes(*word)).map_err(link)?;
            }
            self.seen.note(address, bytes);
        } else if monitor::is_memory(address) {
            self.client.get_mut().store(address.get(), bytes).map_err(link)?;
        } else {
            return Err(HostError::Unmapped(address));
        }
        Ok(())
    }

    fn pause(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.set_paused(thread, true)?;
        self.threads.note_paused(thread, true);
        Ok(())
    }

    fn resume(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.set_paused(thread, false)?;
        self.threads.note_paused(thread, false);
        self.refresh();
        Ok(())
    }

    fn has_item(&self, item: Item) -> bool {
        match item.kind() {
            "dest" | "pos" | "adc" => true,
            "bit" => item
                .bit()
                .is_some_and(|bit| self.status.as_ref().is_none_or(|status| status.bit(bit).is_some())),
            _ => false,
        }
    }

    fn value(&self, item: Item) -> f64 {
        let Some(status) = &self.status else { return f64::NAN };
        let axis = i32::try_from(item.index()).ok().and_then(AxisId::new);
        match (item.kind(), axis) {
            ("dest", Some(axis)) => status.dest(axis),
            ("pos", Some(axis)) => status.position(axis),
            ("adc", _) => f64::from(status.adc(item.index())),
            ("bit", _) => match item.bit() {
                Some(bit) => status.bit(bit).map_or(f64::NAN, |level| f64::from(u8::from(level))),
                None => f64::NAN,
            },
            _ => f64::NAN,
        }
    }

    fn bit(&self, bit: Bit) -> bool {
        self.value(Item::of_bit(bit)) == 1.0
    }

    fn receive(&mut self, bytes: &[u8]) {
        let bytes = match bytes {
            // The prefix of a line that is not echoed.
            [0x1b, 1, line @ ..] => line,
            line => line,
        };
        for line in bytes.split(|byte| *byte == b'\r').filter(|line| !line.is_empty()) {
            self.send_line(line);
        }
    }

    fn is_receiving(&self) -> bool {
        false
    }

    fn is_answering(&self) -> bool {
        !self.pending.is_empty() && self.lost.is_none()
    }

    fn exchange_ticks(&self) -> u64 {
        0
    }

    fn is_in_command(&self) -> bool {
        // The client rejects commands of several lines.
        false
    }

    fn listen(&mut self, _: bool) {
        // The client keeps the lines until they are read.
    }

    fn tap_wire(&mut self) {
        // The link belongs to this connection: there is none for another PC.
    }

    fn take_wire(&mut self) -> Vec<u8> {
        Vec::new()
    }

    fn snapshot(&mut self) -> Result<NoSnapshot, SnapshotError> {
        Err(Unsupported { target: self.name(), capability: Capability::Snapshots }.into())
    }

    fn restore(&mut self, snapshot: &NoSnapshot) -> Result<(), SnapshotError> {
        match *snapshot {}
    }
}
