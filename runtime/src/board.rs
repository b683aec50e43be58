//! The board as a program that embeds it sees it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use kmotiondef::map::{FLASH, PROGRAM_SIZE, program_base};
use kmotiondef::structs::Persist;
use kmotiondef::variables::{HOST_STATUS, PERSIST, USER_CALL_BACK};
use kmotiondef::{Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::machine::{Config as MachineConfig, Machine};
use vm::memory::GuestMemory;
use vm::program::Program;
use vm::thread::{NotLoaded, ThreadState};
use vm::verify::{VerifyError, verify};

use crate::commands::FLASH_COMPLETE;
use crate::debug::{DebugInfo, SourcePlace};
use crate::event::{Event, EventKind};
use crate::files::{HostFiles, NoFiles};
use crate::flash::{self, FLASH_SIZE};
use crate::host::Answers;
use crate::kernel::{Kernel, Request};
use crate::loader::{Fill, LoadError, Placed, prepare};
use crate::machine_file::{MachineFile, NS_PER_INSTRUCTION};
use crate::plant;
use crate::power_up::{self, Before};
use crate::stimulus::Stimulus;
use crate::trace;
use crate::views::Typed;

/// Settings of a board.
#[derive(Debug)]
pub struct Config {
    /// Settings of the machine: servo time, shortcuts, stacks.
    pub machine: MachineConfig,
    /// Whether the built-in PC polls and answers.
    pub host: bool,
    /// What it answers to programs; `None` for what the machine file says.
    pub answers: Option<Answers>,
    /// Where the PC keeps its files.
    pub files: Box<dyn HostFiles>,
    /// Byte put into uninitialised data at a load.
    pub bss_fill: u8,
    /// What is connected to the board.
    pub machine_file: MachineFile,
    /// What flash memory holds, [`FLASH_SIZE`] bytes; `None` for a board whose flash was never written.
    pub flash: Option<Vec<u8>>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            machine: MachineConfig::default(),
            host: true,
            answers: None,
            files: Box::new(NoFiles),
            bss_fill: 0,
            machine_file: MachineFile::default(),
            flash: None,
        }
    }
}

/// Cycles of a microsecond.
const CYCLES_PER_US: f64 = Cycles::PER_SECOND.get() as f64 / 1e6;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// No thread is active, and nothing moves, records, prints or waits for the PC.
    AllEnded,
    /// The limit is reached.
    Limit,
}

/// What the board knows of a loaded image.
#[derive(Debug)]
struct Loaded {
    debug: DebugInfo,
    /// Addresses from its first to behind its last byte.
    extent: Range<u32>,
}

/// A simulated board.
#[derive(Debug)]
pub struct Board<E = BytecodeEngine> {
    machine: Machine<Kernel, E>,
    loaded: [Option<Loaded>; ThreadId::MAX as usize],
    /// What is known of the programs in flash.
    flashed: [Option<DebugInfo>; ThreadId::MAX as usize],
    /// Images that a stimulus may load, by the thread they are linked for and what it calls them.
    offered: BTreeMap<(ThreadId, Arc<str>), Vec<u8>>,
    bss_fill: u8,
    /// What an instruction takes, in units of what it takes on the board.
    price: f64,
}

impl<E: Engine> Board<E> {
    /// A board at power-up.
    #[must_use]
    pub fn new(config: Config) -> Self {
        let connected = &config.machine_file;
        let mut kernel = Kernel::new(config.files);
        kernel.host.connect(config.host && connected.host);
        kernel.host.answer_with(config.answers.unwrap_or_else(|| connected.answers.clone()));
        plant::install(&mut kernel, connected);
        let servo = connected.servo_us.map(|time| Cycles::new((time * CYCLES_PER_US) as i64));
        let settings = MachineConfig {
            servo: config.machine.servo.or(servo),
            strict_stack: config.machine.strict_stack || connected.strict_stack,
            ..config.machine
        };
        let machine = Machine::new(kernel, settings);
        let bss_fill = if config.bss_fill == 0 { connected.bss_fill } else { config.bss_fill };
        let (loaded, flashed, offered) = Default::default();
        let price = connected.ns_per_instruction / NS_PER_INSTRUCTION;
        let mut board = Self { machine, loaded, flashed, offered, bss_fill, price };
        if let Some(flash) = config.flash {
            let stored = board.machine.memory_mut().poke_bytes(FLASH.base, &flash);
            debug_assert!(stored.is_ok() && flash.len() == FLASH_SIZE, "flash has its size");
        }
        board.power_up();
        let (kernel, context) = board.machine.firmware_mut();
        plant::play(kernel, connected, context.memory);
        board
    }

    /// Fills memory from flash, or as it is when nothing was ever flashed, and starts the programs that start by
    /// themselves.
    fn power_up(&mut self) {
        let memory = self.machine.memory_mut();
        let before = if flash::is_saved(memory) { Before::Flashed } else { Before::Zero };
        if before == Before::Flashed {
            flash::restore(memory);
        }
        power_up::fill(memory, before);
        if before == Before::Flashed {
            ThreadId::all().for_each(|thread| self.load_flashed(thread));
            let starts = self.memory().get(PERSIST.field(Persist::RUN_ON_START_UP));
            for thread in ThreadId::all().filter(|thread| starts & 1 << thread.get() != 0) {
                // A thread without a program has nothing to start.
                let _ = self.machine.start(thread);
            }
        }
        let (kernel, context) = self.machine.firmware_mut();
        let status = i32::from(kernel.host.has_job());
        context.memory.set(HOST_STATUS, status);
    }

    /// Makes a program of what flash has brought back for a thread.
    fn load_flashed(&mut self, thread: ThreadId) {
        let Some(text) = flash::text(self.memory(), thread) else { return };
        let length = text.end.get() - text.start.get();
        let bytes = self.memory().read_bytes(text.start, length).unwrap_or_default();
        match verify(bytes, text.start) {
            Ok(program) => {
                let entry = self.memory().get(PERSIST.field(Persist::ENTRY_POINTS).element(thread.index()));
                self.hand_over(thread, program, GuestAddr::new(entry));
                let extent = text.start.get()..text.end.get();
                let debug = self.flashed[thread.index()].clone().unwrap_or_default();
                self.loaded[thread.index()] = Some(Loaded { debug, extent });
            }
            Err(error) => {
                let (kernel, context) = self.machine.firmware_mut();
                let text = format!("what was flashed for thread {thread} is no program: {error}");
                kernel.tell(context.now, EventKind::Diagnostic(text));
            }
        }
    }

    /// Saves programs and settings in flash.
    fn save(&mut self) {
        let texts: Vec<_> =
            ThreadId::all().map(|thread| self.machine.program(thread).map(Program::text)).collect();
        flash::save(self.machine.memory_mut(), |thread| texts.get(thread.index()).cloned().flatten());
        self.flashed =
            std::array::from_fn(|index| self.loaded[index].as_ref().map(|loaded| loaded.debug.clone()));
        let (kernel, _) = self.machine.firmware_mut();
        kernel.console.message(FLASH_COMPLETE);
    }

    /// Starts anew from flash. Time goes on: it counts from the first power-up.
    fn reboot(&mut self) {
        ThreadId::all().for_each(|thread| self.machine.unload_program(thread));
        self.loaded = Default::default();
        let flash = self.flash().to_vec();
        let memory = self.machine.memory_mut();
        *memory = GuestMemory::new();
        let stored = memory.poke_bytes(FLASH.base, &flash);
        debug_assert!(stored.is_ok(), "flash is mapped");
        self.machine.firmware_mut().0.restart();
        self.power_up();
    }

    /// What flash memory holds.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        self.memory().read_bytes(FLASH.base, FLASH.size).unwrap_or_default()
    }

    /// Loads an image into `thread`, which is stopped first.
    ///
    /// # Errors
    /// Why the image is refused; nothing has changed then.
    pub fn load(&mut self, thread: ThreadId, image: &[u8]) -> Result<(), LoadError> {
        let prepared = prepare(image, thread, |other| self.is_taken(other, thread))?;
        self.machine.unload_program(thread);
        self.machine.firmware_mut().0.downloads.forget(thread);
        self.machine.firmware_mut().0.globals.forget(thread);
        for section in &prepared.sections {
            self.place(thread, section, &prepared.program);
        }
        self.drop_callback(thread);
        self.drop_konnects(thread);
        let start = program_base(thread).get();
        let ends = prepared.sections.iter().map(|section| section.address.get() + section.size());
        let extent = start..ends.max().unwrap_or(start);
        self.load_program(thread, prepared.program, prepared.entry);
        self.loaded[thread.index()] = Some(Loaded { debug: prepared.debug, extent });
        Ok(())
    }

    /// Whether a program other than that of `except` lies in the space of `thread`.
    fn is_taken(&self, thread: ThreadId, except: ThreadId) -> bool {
        let start = program_base(thread).get();
        let others = ThreadId::all().filter(|&other| other != except);
        let mut extents = others.filter_map(|other| self.loaded[other.index()].as_ref());
        extents.any(|loaded| loaded.extent.start < start + PROGRAM_SIZE && loaded.extent.end > start)
    }

    /// Puts a section into memory; the loader has checked that it fits.
    fn place(&mut self, thread: ThreadId, section: &Placed, program: &Program) {
        let bytes = match &section.contents {
            Fill::Bytes(bytes) => bytes.clone(),
            Fill::Uninitialised(size) => vec![self.bss_fill; *size as usize],
        };
        let placed = self.machine.memory_mut().poke_bytes(section.address, &bytes);
        debug_assert!(placed.is_ok(), "the loader checks that sections lie in memory");
        if !program.text().contains(&section.address) {
            self.machine.firmware_mut().0.globals.note(thread, section.address, &bytes);
        }
    }

    /// Takes out a call-back whose code a load has replaced; the board would run what is there now.
    fn drop_callback(&mut self, thread: ThreadId) {
        let start = program_base(thread).get();
        let callback = self.memory().get(USER_CALL_BACK);
        if (start..start + PROGRAM_SIZE).contains(&callback.get()) {
            let (kernel, context) = self.machine.firmware_mut();
            context.memory.set(USER_CALL_BACK, GuestAddr::NULL);
            let text = format!(
                "the call-back in the space of thread {thread} is taken out: its program is replaced"
            );
            kernel.tell(context.now, EventKind::Diagnostic(text));
        }
    }

    /// Ends the service of Konnect boards whose words a load has replaced.
    fn drop_konnects(&mut self, thread: ThreadId) {
        let start = program_base(thread).get();
        let (kernel, context) = self.machine.firmware_mut();
        if kernel.konnects.drop_within(&(start..start + PROGRAM_SIZE)) {
            let text = format!("Konnect service with words of thread {thread} ends: its program is replaced");
            kernel.tell(context.now, EventKind::Diagnostic(text));
        }
    }

    /// What is known of the image in `thread`.
    #[must_use]
    pub fn debug(&self, thread: ThreadId) -> Option<&DebugInfo> {
        self.loaded[thread.index()].as_ref().map(|loaded| &loaded.debug)
    }

    /// The source of a code address, in whatever thread's program it lies.
    #[must_use]
    pub fn source(&self, address: CodeAddr) -> Option<SourcePlace<'_>> {
        self.loaded.iter().flatten().find_map(|loaded| loaded.debug.place(address))
    }

    /// Makes `thread` ready to run a program whose bytes are in guest memory.
    pub fn load_program(&mut self, thread: ThreadId, program: Program, entry: GuestAddr) {
        let entry_points = PERSIST.field(Persist::ENTRY_POINTS);
        self.machine.memory_mut().set(entry_points.element(thread.index()), entry.get());
        self.hand_over(thread, program, entry);
    }

    /// Gives the machine a program, at the price of instructions that the machine file says.
    fn hand_over(&mut self, thread: ThreadId, program: Program, entry: GuestAddr) {
        let program = if self.price == 1.0 { program } else { program.priced(self.price) };
        self.machine.load_program(thread, program, entry);
    }

    /// Starts `thread` at its entry point.
    ///
    /// # Errors
    /// [`NotLoaded`] for an empty thread.
    pub fn start(&mut self, thread: ThreadId) -> Result<(), NotLoaded> {
        self.machine.start(thread)
    }

    /// Runs to the end of tick `limit` or until everything has ended; `sink` receives what happens.
    ///
    /// At the end the console text still held is sent, and the expectations of the stimulus are checked.
    pub fn run(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) -> RunEnd {
        let end = self.run_part(limit, sink);
        self.finish(sink);
        end
    }

    /// Like [`run`](Self::run), for a run that goes on afterwards or is [finished](Self::finish).
    pub fn run_part(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) -> RunEnd {
        loop {
            if self.has_ended() {
                return RunEnd::AllEnded;
            }
            if self.machine.tick() >= limit {
                return RunEnd::Limit;
            }
            self.step(limit);
            self.deliver(sink);
        }
    }

    /// The run is over: sends the console text still held and checks the expectations of the stimulus.
    pub fn finish(&mut self, sink: &mut dyn FnMut(Event)) {
        self.flush(sink);
        let (kernel, mut context) = self.machine.firmware_mut();
        kernel.finish(&mut context);
        self.deliver(sink);
    }

    /// Runs to the end of the next tick in which something can happen, and does what was asked for there.
    fn step(&mut self, limit: Ticks) {
        self.machine.step(limit);
        for request in self.machine.firmware_mut().0.take_requests() {
            match request {
                Request::Load(thread) => self.adopt(thread),
                Request::Flash => self.save(),
                Request::Reboot => self.reboot(),
                Request::Run(thread, name) => self.run_offered(thread, &name),
            }
        }
    }

    /// Keeps an image that a stimulus may load into `thread` under this name; what is known of its program.
    ///
    /// # Errors
    /// Why the image would be refused.
    pub fn offer(&mut self, thread: ThreadId, name: &str, image: Vec<u8>) -> Result<DebugInfo, LoadError> {
        let debug = prepare(&image, thread, |_| false)?.debug;
        self.offered.insert((thread, name.into()), image);
        Ok(debug)
    }

    /// Loads an image that was offered and starts it.
    fn run_offered(&mut self, thread: ThreadId, name: &Arc<str>) {
        let result = match self.offered.get(&(thread, name.clone())).cloned() {
            Some(image) => self.load(thread, &image).map_err(|error| error.to_string()),
            None => Err("nobody has compiled it".to_owned()),
        };
        let started = result.and_then(|()| self.start(thread).map_err(|error| error.to_string()));
        let (kernel, context) = self.machine.firmware_mut();
        kernel.tell(
            context.now,
            match started {
                Ok(()) => EventKind::Loaded(thread, name.clone()),
                Err(error) => EventKind::Diagnostic(format!("{name} is not run in thread {thread}: {error}")),
            },
        );
    }

    /// Makes a program of what was downloaded into a thread that was started.
    fn adopt(&mut self, thread: ThreadId) {
        let entry = self.machine.threads().entry(thread);
        let (kernel, _) = self.machine.firmware_mut();
        let ends = kernel.downloads.ends(thread);
        kernel.downloads.forget(thread);
        let error = match self.downloaded(thread, &ends) {
            Ok(Some(program)) => {
                self.loaded[thread.index()] = None;
                self.machine.firmware_mut().0.globals.forget(thread);
                self.hand_over(thread, program, entry);
                let started = self.machine.start(thread);
                debug_assert!(started.is_ok(), "a program was loaded");
                return;
            }
            // Only the entry point is new.
            Ok(None) if self.machine.program(thread).is_some() => return,
            Ok(None) => "nothing was downloaded to the beginning of its space".to_owned(),
            Err(error) => error.to_string(),
        };
        self.machine.unload_program(thread);
        let (kernel, context) = self.machine.firmware_mut();
        let text = format!("thread {thread} is not started: {error}");
        kernel.tell(context.now, EventKind::Diagnostic(text));
    }

    /// The program whose text ends at one of some places; `None` if nothing was downloaded.
    fn downloaded(&self, thread: ThreadId, ends: &[GuestAddr]) -> Result<Option<Program>, VerifyError> {
        let base = program_base(thread);
        let mut error = None;
        for end in ends {
            let text = self.memory().read_bytes(base, end.get() - base.get()).unwrap_or_default();
            match verify(text, base) {
                Ok(program) => return Ok(Some(program)),
                // What the longest stretch lacks is what the text lacks.
                Err(wrong) => error = Some(wrong),
            }
        }
        error.map_or(Ok(None), Err)
    }

    /// Bytes from the PC arrive on the USB link: command lines, ended by CR. A line that begins with 0x1B and a byte
    /// that is thrown away is not echoed; 0x03 drops what is under way.
    pub fn receive(&mut self, bytes: &[u8]) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.usb.receive(bytes);
        kernel.disturb();
    }

    /// Whether bytes from the PC wait to be taken.
    #[must_use]
    pub fn is_receiving(&self) -> bool {
        self.machine.firmware().usb.is_busy()
    }

    /// Says whether the PC takes console lines. If not, they wait in the board's queue, and once that is full, so do
    /// the programs that print.
    pub fn listen(&mut self, listens: bool) {
        let (kernel, _) = self.machine.firmware_mut();
        kernel.is_heard = listens;
    }

    /// Runs to the end of the next tick in which something can happen, or of tick `limit`, whichever comes first.
    pub fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        if self.machine.tick() < limit {
            self.step(limit);
        }
        self.deliver(sink);
    }

    /// Whether a command waits for its data lines, so that the next line is one.
    #[must_use]
    pub fn is_in_command(&self) -> bool {
        self.machine.firmware().usb.is_in_command()
    }

    /// Sends the console text that waits, the unfinished line included.
    pub fn flush(&mut self, sink: &mut dyn FnMut(Event)) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.flush_console(context.now);
        self.deliver(sink);
    }

    /// Stops the user threads.
    pub fn kill(&mut self, threads: impl IntoIterator<Item = ThreadId>) {
        for thread in threads {
            self.machine.threads_mut().pause(thread);
        }
    }

    /// Runs until `is_over` says so of the events of a tick, or to the end of tick `limit`; whether it said so.
    ///
    /// Unlike [`run`](Self::run) it goes on when all threads have ended, and leaves unfinished console lines alone.
    pub fn run_until(&mut self, limit: Ticks, is_over: &mut dyn FnMut(Event) -> bool) -> bool {
        while self.machine.tick() < limit {
            self.step(limit);
            let mut over = false;
            self.deliver(&mut |event| over |= is_over(event));
            if over {
                return true;
            }
        }
        false
    }

    /// Whether no thread is active and nothing is under way that a program has begun.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        let is_active = ThreadId::all().any(|thread| self.machine.threads().state(thread).is_active());
        !is_active && !self.machine.firmware().is_busy(self.machine.memory())
    }

    /// Hands over the events since the last time, with the program's place where that is known.
    fn deliver(&mut self, sink: &mut dyn FnMut(Event)) {
        for mut event in self.machine.firmware_mut().0.take_events() {
            if let EventKind::UndrivenInput { thread: Some(thread), place, .. }
            | EventKind::Assisted { thread: Some(thread), place, .. } = &mut event.kind
            {
                *place = self.machine.backtrace(*thread).first().copied();
            }
            sink(event);
        }
    }

    /// The present time: the end of the last tick.
    #[must_use]
    pub fn now(&self) -> Cycles {
        let tick = i64::try_from(self.machine.tick().get()).unwrap_or(i64::MAX);
        Cycles::new(tick.saturating_add(1).saturating_mul(Cycles::PER_TICK.get()))
    }

    /// Number of servo interrupts since power-up.
    #[must_use]
    pub const fn tick(&self) -> Ticks {
        self.machine.tick()
    }

    /// Guest memory.
    #[must_use]
    pub const fn memory(&self) -> &GuestMemory {
        self.machine.memory()
    }

    /// Guest memory, to change it from outside.
    pub fn memory_mut(&mut self) -> &mut GuestMemory {
        self.machine.firmware_mut().0.disturb();
        self.machine.memory_mut()
    }

    /// The machine.
    #[must_use]
    pub const fn machine(&self) -> &Machine<Kernel, E> {
        &self.machine
    }

    /// The machine, to load programs and to watch it.
    pub fn machine_mut(&mut self) -> &mut Machine<Kernel, E> {
        self.machine.firmware_mut().0.disturb();
        &mut self.machine
    }

    /// The state of a thread.
    #[must_use]
    pub fn thread(&self, thread: ThreadId) -> &ThreadState {
        self.machine.threads().state(thread)
    }

    /// An element of `persist.UserData`; `None` beyond the last.
    #[must_use]
    pub fn user_data(&self, index: usize) -> Option<i32> {
        let data = PERSIST.field(Persist::USER_DATA);
        (index < kmotiondef::limits::N_USER_DATA_VARS).then(|| self.memory().get(data.element(index)))
    }

    /// Stores an element of `persist.UserData`; `false` beyond the last.
    pub fn set_user_data(&mut self, index: usize, value: i32) -> bool {
        let is_inside = index < kmotiondef::limits::N_USER_DATA_VARS;
        if is_inside {
            self.memory_mut().set(PERSIST.field(Persist::USER_DATA).element(index), value);
        }
        is_inside
    }

    /// Lets the world around the board act as a stimulus says, from now on.
    pub fn play(&mut self, stimulus: Stimulus) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.play(stimulus, context.memory);
    }

    /// Plays an operator for programs that wait on inputs nobody drives.
    pub fn assist(&mut self) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.assist(context.now);
    }

    /// Records from now on what is asked for; the records come as events.
    pub fn record(&mut self, request: trace::Request) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.record(request, context.memory);
    }

    /// Drives an input from outside.
    pub fn drive_input(&mut self, bit: Bit, level: bool) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.pins.drive(bit, level, context.now);
        kernel.settle(context.now);
        kernel.disturb();
    }

    /// Puts characters on the UART's line; they arrive one after the other at its rate.
    pub fn send_to_uart(&mut self, bytes: &[u8]) {
        let (kernel, context) = self.machine.firmware_mut();
        kernel.uart.arrive(bytes, context.now);
        kernel.disturb();
    }

    /// Tells every character that the UART sends from now on, as an event.
    pub fn hear_uart(&mut self) {
        self.machine.firmware_mut().0.hear_uart();
    }

    /// The present value of something that can be recorded.
    #[must_use]
    pub fn value(&self, item: trace::Item) -> f64 {
        item.read(self.machine.firmware(), self.memory())
    }

    /// The level of a bit.
    #[must_use]
    pub fn bit(&self, bit: Bit) -> bool {
        crate::firmware::io::bit_state(self.machine.firmware(), self.memory(), bit).0
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
    use kmotiondef::structs::Chan;
    use vm::text::assemble;

    use super::*;

    /// `sig0` is `()`, `sig1` `(i32, f64)`, `sig2` `(f64)`, `sig3` `(i32) -> i32`; the pool holds 0, 100 and 0.5.
    const HEAD: &str = "program 1, 3\nword 0x0\nword 0x4059000000000000\nword 0x3fe0000000000000
sig 0, 0\nsig 2, 0\ntypes 0xc\nsig 1, 0\ntypes 3\nsig 1, 1\ntypes 0\n";
    /// First word behind it.
    const MAIN: usize = 11;
    /// Where the text to print stands, in the thread's own space.
    const TEXT: u32 = 0x8005_F000;

    fn call(name: &str, signature: usize, loads: &str, arguments: &str) -> String {
        let address = FIRMWARE_FUNCTIONS[function_named(name).expect(name)].address.get();
        format!("charge 20\n{loads}\n{arguments}\ncall_fw sig{signature}, {address:#x}\n")
    }

    /// Enables axis 0, moves it by 100, waits half a second, prints a line and ends.
    fn program() -> String {
        let axis_and = |pool: usize| format!("const_i32 r0, 0\nconst_f64 d1, pool[{pool}]");
        let calls = [
            call("EnableAxisDest", 1, &axis_and(0), "arg_i32 r0, 0\narg_f64 d1, 1"),
            call("Move", 1, &axis_and(1), "arg_i32 r0, 0\narg_f64 d1, 1"),
            call("Delay_sec", 2, &axis_and(2), "arg_f64 d1, 0"),
            call("Print", 3, &format!("const_i32 r0, {}", TEXT.cast_signed()), "arg_i32 r0, 0"),
        ];
        format!("{HEAD}@main: func sig0, 2, 0\ntypes 0xc\n{}charge 2\nret", calls.concat())
    }

    fn run(shortcuts: bool, limit: u64) -> (RunEnd, Vec<Event>, Board) {
        let machine = MachineConfig { shortcuts, ..MachineConfig::default() };
        let mut board: Board = Board::new(Config { machine, ..Config::default() });
        let thread = ThreadId::new(1).expect("1 is a thread");
        let text = assemble(&program()).unwrap_or_else(|error| panic!("{error}"));
        let program = verify(&text, program_base(thread)).unwrap_or_else(|error| panic!("{error}"));
        board.memory_mut().poke_bytes(program_base(thread), &text).expect("mapped");
        board.memory_mut().poke_bytes(GuestAddr::new(TEXT), b"moved\n\0").expect("mapped");
        let entry = program.address_of(MAIN).as_guest_addr();
        board.load_program(thread, program, entry);
        board.start(thread).expect("loaded");
        let mut events = Vec::new();
        let end = board.run(Ticks::new(limit), &mut |event| events.push(event));
        (end, events, board)
    }

    #[test]
    fn a_program_runs_to_its_end() {
        let (end, events, board) = run(true, 100_000);
        assert_eq!(end, RunEnd::AllEnded);
        let lines: Vec<_> = events.iter().map(|event| event.kind.clone()).collect();
        assert_eq!(lines, [EventKind::ConsoleLine(b"moved".to_vec())]);
        let seconds = events[0].at.get() as f64 / Cycles::PER_SECOND.get() as f64;
        assert!((0.5..0.501).contains(&seconds), "{seconds}");
        let axis = kmotiondef::AxisId::new(0).expect("0 is an axis");
        assert_eq!(board.memory().axis(axis, Chan::DEST), 100.0);
    }

    #[test]
    fn shortcuts_change_nothing() {
        let limit = 8_000;
        let (slow, fast) = (run(false, limit), run(true, limit));
        assert_eq!(slow.0, fast.0);
        assert_eq!(slow.1, fast.1);
        assert!(slow.2.memory() == fast.2.memory(), "memory differs");
    }
}
