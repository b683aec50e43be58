//! The target: a connected controller.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use cc67_host::target::Target;
use cc67_host::{
    Capability, EventSink, HostError, Session, Setup, SnapshotError, TargetSnapshot, Unsupported, UserProgram,
};
use cc67_wire::{Address, Client, Progress, Status, WireError};
use compiler::firmware::{Firmware, FirmwareNames};
use kmotiondef::boards::TargetBoard;
use kmotiondef::limits::{N_CHANNELS, N_USER_DATA_VARS};
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{CHAN, PERSIST};
use kmotiondef::{AxisId, Bit, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::trace::Item;
use runtime::{Event, EventKind, OpenBox, RemoteBoard, RequestServer};
use vm::scheduler::Turn;
use vm::thread::{Progress as ThreadProgress, ThreadState};

use crate::clock::now;
use crate::files::{FileRemarks, Files};
use crate::image;
use crate::seen::SeenMemory;

/// Nanoseconds of a tick: 90 µs.
const TICK_NANOSECONDS: u128 = 90_000;
/// The pause between two readings of the status record: 20 a second.
const STATUS_EVERY: Duration = Duration::from_millis(50);
/// The longest time that a call waits for the console before it looks at something else.
const LONGEST_WAIT: Duration = Duration::from_millis(10);
/// Console lines that a program has printed before its end come within this time.
const SILENCE: Duration = Duration::from_millis(200);
/// The longest time that the last lines are waited for.
const LAST_LINES: Duration = Duration::from_secs(5);

/// A controller that answers, before it is given programs.
#[derive(Debug)]
pub struct ControllerLink(Client);

impl ControllerLink {
    /// Connects to the controller at an address.
    ///
    /// # Errors
    /// There is none, it may not be opened, or it does not answer.
    pub fn open(address: &Address) -> Result<Self, WireError> {
        Client::connect(address).map(Self)
    }

    /// Returns the controller's own words for its firmware.
    #[must_use]
    pub fn version(&self) -> &str {
        self.0.version()
    }

    /// Returns the place of the controller, for messages.
    #[must_use]
    pub fn place(&self) -> &str {
        self.0.place()
    }

    /// Returns the board whose firmware this is; `None` for a version that is not known.
    #[must_use]
    pub fn board(&self) -> Option<&'static TargetBoard> {
        TargetBoard::of_version(self.version().trim_end())
    }

    /// Loads the programs of a setup and starts those that should be started.
    ///
    /// Of the setup the controller takes the programs, the values of `persist.UserData`, and the PC's files. `is_forced`
    /// loads programs also where they were linked for another firmware. `progress` is called after each piece.
    ///
    /// # Errors
    /// A program is refused, a value is not in `persist.UserData`, or the link fails.
    pub fn session(
        self,
        setup: Setup,
        is_forced: bool,
        progress: impl FnMut(ThreadId, Progress) + Send + 'static,
    ) -> Result<Session<Controller>, HostError> {
        let Setup { config, options, programs, offered, values, .. } = setup;
        let mut target = Controller::new(self.0, &options.firmware, is_forced, Box::new(progress));
        let files = Files::new(config.files, target.remarks.clone());
        target.client.get_mut().serve_files(Box::new(files));
        target.requests = RequestServer::new(config.answers);
        target.requests.leave_boxes_open();
        target.begin(&programs, &values)?;
        Ok(Session::on_target(target, options, programs, offered))
    }
}

/// A receiver of the progress after each piece of a download.
type ProgressSink = Box<dyn FnMut(ThreadId, Progress) + Send>;

/// The terms of a load.
struct Loading {
    /// The version of the firmware that sources are linked for.
    linked_for: String,
    is_forced: bool,
    progress: ProgressSink,
}

/// Board time, which passes by itself.
#[derive(Debug)]
struct PassingTime {
    /// The moment of tick 0.
    origin: Instant,
    /// The last tick that was over at the end of the last call.
    tick: Ticks,
    /// The moment at which the status record is due.
    next_status: Instant,
    /// The moment of the last console line.
    heard: Instant,
}

impl PassingTime {
    fn new() -> Self {
        let now = now();
        Self { origin: now, tick: Ticks::new(0), next_status: now, heard: now }
    }

    /// The moment at which a tick is over.
    fn moment_of(&self, tick: Ticks) -> Option<Instant> {
        let nanoseconds = u128::from(tick.get()) * TICK_NANOSECONDS;
        self.origin.checked_add(Duration::from_nanos(u64::try_from(nanoseconds).ok()?))
    }

    /// Time has passed by itself.
    fn note(&mut self) {
        let ticks = now().duration_since(self.origin).as_nanos() / TICK_NANOSECONDS;
        self.tick = Ticks::new(u64::try_from(ticks).unwrap_or(u64::MAX));
    }
}

/// A connected controller, see the [crate](crate).
pub struct Controller {
    client: RefCell<Client>,
    loading: Loading,
    time: PassingTime,
    /// The last status record.
    status: Option<Status>,
    /// Memory as far as it is known.
    seen: SeenMemory,
    threads: [ThreadState; ThreadId::MAX as usize],
    programs: [Option<Arc<DebugInfo>>; ThreadId::MAX as usize],
    /// Threads that were active before the connection.
    before: Vec<ThreadId>,
    requests: RequestServer,
    /// Events that wait for the next step.
    pending: Vec<EventKind>,
    remarks: FileRemarks,
    /// The reason why the controller cannot be reached any more.
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
    fn new(client: Client, firmware: &Firmware, is_forced: bool, progress: ProgressSink) -> Self {
        let linked_for = firmware.version().unwrap_or(FirmwareNames::board(firmware).version).to_owned();
        let board = TargetBoard::of_version(client.version().trim_end());
        Self {
            client: RefCell::new(client),
            seen: SeenMemory::new(board),
            loading: Loading { linked_for, is_forced, progress },
            time: PassingTime::new(),
            status: None,
            threads: std::array::from_fn(|_| ThreadState::Empty),
            programs: std::array::from_fn(|_| None),
            before: Vec::new(),
            requests: RequestServer::new(None),
            pending: Vec::new(),
            remarks: FileRemarks::default(),
            lost: None,
        }
    }

    /// Returns the last status record.
    #[must_use]
    pub const fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// Returns the board's own words for its firmware.
    #[must_use]
    pub fn version(&self) -> String {
        self.client.borrow().version().to_owned()
    }

    /// Notes what runs already, stores the values, loads the programs, and starts those that should be started.
    fn begin(&mut self, programs: &[UserProgram], values: &[(GuestAddr, Vec<u8>)]) -> Result<(), HostError> {
        let status = self.client.get_mut().status().map_err(link)?;
        self.before = ThreadId::all().filter(|thread| status.is_active(*thread)).collect();
        self.note_status(status);
        for (address, bytes) in values {
            self.write(self.seen.place_of(*address), bytes)?;
        }
        for program in programs {
            self.load(program)?;
        }
        self.time.origin = now();
        for program in programs.iter().filter(|program| program.starts) {
            self.start(program.thread)?;
        }
        Ok(())
    }

    /// Takes up a status record.
    fn note_status(&mut self, status: Status) {
        for thread in ThreadId::all() {
            self.note_thread(thread, status.is_active(thread));
        }
        self.seen.note_status(&status);
        self.status = Some(status);
    }

    fn note_thread(&mut self, thread: ThreadId, is_active: bool) {
        let is_loaded = self.programs[thread.index()].is_some();
        let state = &mut self.threads[thread.index()];
        *state = match is_active {
            true => ThreadState::Active(ThreadProgress::Going),
            false if is_loaded => ThreadState::Ready,
            false => ThreadState::Empty,
        };
        if !is_active {
            self.before.retain(|other| *other != thread);
        }
    }

    /// Takes up a failure: of the link for good, of anything else as an event.
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

    /// Reads the status record if it is due.
    fn poll(&mut self) {
        if self.lost.is_some() || now() < self.time.next_status {
            return;
        }
        match self.client.get_mut().status() {
            Ok(status) => {
                let words = std::array::from_fn(|index| status.request(index));
                self.note_status(status);
                self.answer(words);
                if self.seen.take_look() {
                    self.read_elements();
                }
            }
            Err(error) => self.note_error(&error),
        }
        // As many a second, whatever an exchange takes.
        self.time.next_status = (self.time.next_status + STATUS_EVERY).max(now());
    }

    /// Reads the velocities of the axes, for jog buttons.
    fn read_velocities(&mut self) {
        let command = AxisId::all().map(|axis| format!("Vel{axis}")).collect::<Vec<_>>().join(";");
        match self.client.get_mut().ask_lines(&command, N_CHANNELS) {
            Ok(answers) => {
                for (axis, answer) in AxisId::all().zip(answers) {
                    if let Ok(velocity) = answer.trim().parse::<f32>() {
                        let place = CHAN.element(axis.index()).field(Chan::VEL).address();
                        self.seen.note(self.seen.place_of(place), &velocity.to_le_bytes());
                    }
                }
            }
            Err(error) => self.note_error(&error),
        }
    }

    /// Reads the next elements of `persist.UserData`, for whoever looks at known memory.
    fn read_elements(&mut self) {
        let elements = self.seen.next_elements();
        if elements.start == 0 {
            self.read_velocities();
        }
        match Commands(self.client.get_mut()).user_data(elements.start, elements.len()) {
            Ok(words) => {
                for (index, word) in elements.zip(words) {
                    self.seen.note(self.element_address(index), &word.to_le_bytes());
                }
            }
            Err(error) => self.note_error(&error),
        }
    }

    /// The address of an element of `persist.UserData` in the controller's firmware.
    fn element_address(&self, index: usize) -> GuestAddr {
        self.seen.place_of(PERSIST.field(Persist::USER_DATA).element(index).address())
    }

    /// The elements of `persist.UserData` in the bytes from an address on; `None` where there are others.
    fn elements(&self, address: GuestAddr, length: usize) -> Option<Range<usize>> {
        let offset = address.get().checked_sub(self.element_address(0).get())? as usize;
        let (first, end) = (offset / 4, offset / 4 + length / 4);
        let is_whole = offset.is_multiple_of(4) && length.is_multiple_of(4);
        (is_whole && end <= N_USER_DATA_VARS).then_some(first..end)
    }

    /// Answers the request to the PC in these elements of `persist.UserData`, if there is one.
    fn answer(&mut self, words: [u32; 8]) {
        match self.requests.serve(&mut Commands(self.client.get_mut()), words) {
            Ok(said) => self.pending.extend(said.into_iter().map(EventKind::Host)),
            Err(error) => self.note_error(&error),
        }
    }

    /// Waits for the console until a moment.
    fn wait(&mut self, until: Instant) {
        let pause = until.saturating_duration_since(now());
        if self.lost.is_some() {
            std::thread::sleep(pause);
        } else if let Err(error) = self.client.get_mut().service(pause) {
            self.note_error(&error);
        }
    }

    /// Hands over what has come.
    fn deliver(&mut self, events: EventSink<'_>) {
        let at = self.now();
        let lines = self.client.get_mut().take_console();
        if !lines.is_empty() {
            self.time.heard = now();
        }
        let remarks = self.remarks.take().into_iter().map(EventKind::Host);
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
            // The board's own words come as a line of its console.
            Err(WireError::Refused { message, .. }) => {
                self.pending.push(EventKind::ConsoleLine(message.into_bytes()));
            }
            Err(error) => self.note_error(&error),
        }
        self.time.next_status = now();
    }
}

/// The error of a link, for sessions.
fn link(error: WireError) -> HostError {
    HostError::Link(error.to_string())
}

/// A controller for the PC that answers its requests.
struct Commands<'a>(&'a mut Client);

impl RemoteBoard for Commands<'_> {
    type Error = WireError;

    fn user_data(&mut self, first: usize, count: usize) -> Result<Vec<u32>, WireError> {
        let commands = (first..first + count).map(|index| format!("GetPersistHex {index}"));
        let command = commands.collect::<Vec<_>>().join(";");
        let answers = self.0.ask_lines(&command, count)?;
        let words = answers.iter().map(|answer| u32::from_str_radix(answer.trim(), 16).ok());
        let words: Option<Vec<u32>> = words.collect();
        words.ok_or_else(|| self.0.unexpected(&command, &answers.join(" / ")))
    }

    fn set_user_data(&mut self, index: usize, word: u32) -> Result<(), WireError> {
        self.0.command(&format!("SetPersistHex {index} {word:X}"))
    }

    fn gather(&mut self, offset: u32, count: u32) -> Result<Vec<u32>, WireError> {
        self.0.gather(offset, count)
    }

    fn set_gather(&mut self, offset: u32, words: &[u32]) -> Result<(), WireError> {
        self.0.set_gather(offset, words)
    }

    fn command(&mut self, line: &str) -> Result<(), WireError> {
        self.0.command(line)
    }
}

/// A controller has no snapshots.
#[derive(Debug)]
pub enum NoSnapshot {}

impl TargetSnapshot for NoSnapshot {
    fn tick(&self) -> Ticks {
        match *self {}
    }

    fn is_held(&self) -> bool {
        match *self {}
    }

    fn bytes_beyond(&self, _: &Self) -> usize {
        match *self {}
    }
}

impl Target for Controller {
    type Snapshot = NoSnapshot;

    fn name(&self) -> &'static str {
        "a connected controller"
    }

    fn can(&self, capability: Capability) -> bool {
        capability == Capability::Answers
    }

    fn open_box(&self) -> Option<OpenBox> {
        self.requests.open_box()
    }

    fn answer(&mut self, setting: &str) -> Result<(), HostError> {
        self.requests.answer(setting).map_err(|error| HostError::Link(error.to_string()))?;
        self.time.next_status = now();
        Ok(())
    }

    fn lost(&self) -> Option<&str> {
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
        let end = self.time.moment_of(limit).unwrap_or_else(|| now() + LONGEST_WAIT);
        if now() < end {
            self.wait(end.min(now() + LONGEST_WAIT));
        }
        self.poll();
        self.time.note();
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
    }

    fn has_ended(&self) -> bool {
        let is_ours = |thread: &ThreadId| !self.before.contains(thread);
        let is_active = ThreadId::all().filter(is_ours).any(|thread| self.thread(thread).is_active());
        self.lost.is_some()
            || !is_active && self.pending.is_empty() && now().duration_since(self.time.heard) >= SILENCE
    }

    fn turn(&self) -> Turn {
        Turn::Primary
    }

    fn load(&mut self, program: &UserProgram) -> Result<(), HostError> {
        let client = self.client.get_mut();
        let board = client.version().trim_end().to_owned();
        let image = image::of_program(program, &self.loading.linked_for, &board)?;
        let progress = &mut self.loading.progress;
        let loaded =
            client.load(&image, self.loading.is_forced, &mut |piece| progress(program.thread, piece));
        loaded.map_err(link)?;
        self.programs[program.thread.index()] = Some(Arc::new(program.debug_info()));
        self.note_thread(program.thread, false);
        Ok(())
    }

    fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.programs[thread.index()].as_deref()
    }

    fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.client.get_mut().execute(thread).map_err(link)?;
        self.before.retain(|other| *other != thread);
        self.threads[thread.index()] = ThreadState::Active(ThreadProgress::Going);
        self.time.next_status = now();
        Ok(())
    }

    fn stop(&mut self, thread: ThreadId) {
        match self.client.get_mut().kill(thread) {
            Ok(()) => self.note_thread(thread, false),
            Err(error) => self.note_error(&error),
        }
    }

    fn thread(&self, thread: ThreadId) -> &ThreadState {
        &self.threads[thread.index()]
    }

    fn runs_processor_code(&self, thread: ThreadId) -> Option<bool> {
        self.programs[thread.index()].as_ref().map(|_| true)
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
        self.seen.read(address, bytes).ok_or_else(|| {
            HostError::Link(
                "no command of the controller reads this: only persist.UserData, and what its status record has of \
                 axes, bits and analog channels"
                    .to_owned(),
            )
        })
    }

    fn refresh(&mut self) {
        self.time.next_status = now();
        self.poll();
    }

    fn glance(&self, address: GuestAddr, bytes: &mut [u8]) -> Option<()> {
        self.seen.look(address, bytes)
    }

    fn write(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError> {
        let Some(elements) = self.elements(address, bytes.len()) else {
            return Err(HostError::Link(
                "no command of the controller writes memory besides persist.UserData and programs".to_owned(),
            ));
        };
        let mut board = Commands(self.client.get_mut());
        for (index, word) in elements.zip(bytes.as_chunks().0) {
            board.set_user_data(index, u32::from_le_bytes(*word)).map_err(link)?;
        }
        self.seen.note(address, bytes);
        Ok(())
    }

    fn knows(&self, item: Item) -> bool {
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
            // The beginning of a line that is not echoed.
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
        // Commands of several lines are refused by the client.
        false
    }

    fn listen(&mut self, _: bool) {
        // The client keeps the lines until they are read.
    }

    fn tap_wire(&mut self) {
        // The link is that of this connection: nothing is there for another.
    }

    fn take_wire(&mut self) -> Vec<u8> {
        Vec::new()
    }

    fn snapshot(&mut self) -> Result<NoSnapshot, SnapshotError> {
        Err(self.unsupported().into())
    }

    fn restore(&mut self, snapshot: &NoSnapshot) -> Result<(), SnapshotError> {
        match *snapshot {}
    }
}

impl Controller {
    fn unsupported(&self) -> Unsupported {
        Unsupported { target: self.name(), capability: Capability::Snapshots }
    }
}
