//! A board that runs the user's own firmware file (`--boot FILE`): programs compiled for the real processor and linked
//! against that file, board time, and what the firmware sends as events.
//!
//! Time is counted from the moment in which the firmware has started and looks for the first byte of the PC.

mod looks;
mod samples;

pub(crate) use looks::Looks;

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use boot::{BootedBoard, BootedSnapshot, FirmwareFile, Halted, ProgramPacket, Ran, Sent, SentLine};
use cc67_host::session::{by_hand, quantities, resolve};
use cc67_host::{End, Interrupter, UserProgram};
use compiler::Options;
use compiler::firmware::{Firmware, FirmwareFile as Symbols};
use compiler::target::Target;
use kmotiondef::variables::{
    ADC_BUFFER_IN, CHAN, CURRENT_THREAD, DAC_BUFFER, HOST_STATUS, KSTEP_PRESENT, LAST_PWM, PERSIST,
    READ_DISK_BUFFER, VIRTUAL_BITS, VIRTUAL_BITS_EX,
};
use kmotiondef::{AxisId, Bit, CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::surroundings::{Asked, Surroundings};
use runtime::trace::{Item, TraceRequest};
use runtime::{Event, EventKind, MachineFile};
use vm::firmware::ExecutedPacket;

use super::around::Attached;
use super::flash::Flash;
use super::line::{PART, SerialLine};
use super::{Described, Started};
use crate::cli::args::board::BoardArguments;

use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::program::ProgramFile;
use crate::cli::args::trace::TraceArguments;
use crate::cli::args::uart::UartArguments;
use crate::cli::compile::images;
use crate::cli::io::input::read;
use crate::cli::io::pace::Pace;
use crate::cli::report::profile::program_names;
use crate::cli::report::state::FinalState;
use crate::cli::report::trace;

/// Cycles of a tick, and of a second.
const TICK: u64 = Cycles::PER_TICK.get() as u64;
const SECOND: u64 = Cycles::PER_SECOND.get() as u64;
/// Ticks without a byte and without motion after which nothing more is to come.
const QUIET: u32 = 22;
/// Longest time for which the firmware is waited for.
const ANSWER: u64 = 2 * SECOND;
/// Longest time that a command takes: `Flash` 6.4 s; one of many lines sends all the while.
const COMMAND: u64 = 10 * SECOND;

/// The board, and what programs for it are linked against.
#[derive(Debug)]
pub(crate) struct Booted {
    /// The board.
    pub(crate) board: BootedBoard,
    firmware: Firmware,
    origin: u64,
    /// Programs in the threads, and those that a stimulus may load.
    programs: Vec<UserProgram>,
    offered: Vec<UserProgram>,
    /// How programs were compiled.
    options: Options,
    uart: UartArguments,
    line: SerialLine,
    interrupter: Interrupter,
    flash: Flash,
    /// Lines that programs have sent which the flash has started, before time begins.
    early: Vec<SentLine>,
    /// Who looks at the processor while it runs.
    pub(crate) looks: Looks,
}

/// How long nothing has happened.
struct Silence {
    ticks: u32,
    /// How often the firmware had looked for the PC when it began.
    looks: u64,
}

impl Silence {
    const fn new(board: &BootedBoard) -> Self {
        Self { ticks: 0, looks: board.looks() }
    }

    /// One more tick.
    const fn note(&mut self, is_busy: bool, board: &BootedBoard) {
        self.ticks += 1;
        if is_busy {
            *self = Self::new(board);
        }
    }

    /// Whether nothing more is to come: nothing came for long, and the firmware obeys no command.
    const fn is_over(&self, board: &BootedBoard) -> bool {
        self.ticks >= QUIET && board.looks() > self.looks
    }
}

/// Programs that are about to run.
#[derive(Debug)]
pub(crate) struct Begun {
    /// What is recorded, if anything.
    pub(crate) request: Option<TraceRequest>,
}

/// A firmware that has started, to run programs on again and again from there.
#[derive(Debug)]
pub(crate) struct Ready {
    booted: Option<Booted>,
    snapshot: BootedSnapshot,
    firmware: Firmware,
}

impl Ready {
    /// The board as it was when the firmware was ready.
    pub(crate) fn fresh(&mut self) -> Booted {
        let origin = self.snapshot.cycle();
        let mut booted = self
            .booted
            .take()
            .unwrap_or_else(|| Booted::around(self.snapshot.board(), self.firmware.clone()));
        booted.board.restore(&self.snapshot);
        booted.origin = origin;
        booted
    }

    /// The board is free for the next run.
    pub(crate) fn take_back(&mut self, booted: Booted) {
        self.booted = Some(booted);
    }
}

impl Booted {
    /// Keeps the board as it is now.
    pub(crate) fn into_ready(mut self) -> Ready {
        let (snapshot, firmware) = (self.board.snapshot(), self.firmware.clone());
        Ready { booted: Some(self), snapshot, firmware }
    }

    /// Starts a firmware file.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let bytes = read(path)?;
        let shown = || format!("`--boot {}`", path.display());
        let file = FirmwareFile::read(&bytes).with_context(shown)?;
        let symbols = Symbols::read(&bytes).with_context(shown)?;
        let board = BootedBoard::booted(Arc::new(file)).with_context(shown)?;
        Ok(Self::around(board, Firmware::File(Arc::new(symbols))))
    }

    /// A board that is ready, without programs.
    fn around(board: BootedBoard, firmware: Firmware) -> Self {
        Self {
            origin: board.cycle(),
            board,
            firmware,
            programs: Vec::new(),
            offered: Vec::new(),
            options: Options::default(),
            uart: UartArguments::default(),
            line: SerialLine::default(),
            interrupter: Interrupter::default(),
            flash: Flash::default(),
            early: Vec::new(),
            looks: Looks::default(),
        }
    }

    /// What ends a run from elsewhere.
    pub(crate) fn interrupter(&self) -> Interrupter {
        self.interrupter.clone()
    }

    /// Connects the serial port; a peer that has to be there is waited for.
    pub(crate) fn connect(&mut self) -> Result<()> {
        self.line = SerialLine::connect(&self.uart)?;
        Ok(())
    }

    /// Compiles and loads programs, and starts the first of them; whether their sources have no errors.
    pub(crate) fn load(
        &mut self,
        files: &[ProgramFile],
        starts: usize,
        compiler: &CompilerArguments,
    ) -> Result<bool> {
        let options = self.options(compiler)?;
        let Some(programs) = images::programs_with(files, compiler, &options)? else { return Ok(false) };
        programs.iter().try_for_each(|program| self.take(program))?;
        programs.iter().take(starts).for_each(|program| self.board.execute(program.thread));
        self.programs.retain(|known| programs.iter().all(|program| program.thread != known.thread));
        self.programs.extend(programs);
        Ok(true)
    }

    /// How programs for this firmware are compiled.
    fn options(&self, compiler: &CompilerArguments) -> Result<Options> {
        Ok(Options { target: Target::C67x, firmware: self.firmware.clone(), ..compiler.resolve()? })
    }

    fn take(&mut self, program: &UserProgram) -> Result<()> {
        self.stop(program.thread)?;
        let loaded = self.board.load_program(program.thread, &program.image);
        loaded.with_context(|| program.path.display().to_string())
    }

    /// Stops a thread that is active: another program is to come into it.
    fn stop(&mut self, thread: ThreadId) -> Result<(), Halted> {
        let is_active = |board: &BootedBoard| board.is_active(thread).unwrap_or(false);
        if is_active(&self.board) {
            self.board.send_line(format!("Kill{thread}").as_bytes());
        }
        let end = self.board.cycle() + ANSWER;
        while is_active(&self.board) && self.board.cycle() < end {
            self.board.run_to(self.board.cycle() + TICK)?;
        }
        Ok(())
    }

    /// Connects what the arguments describe, loads their programs, and starts those that are to start, all in one
    /// slice: board time begins there. What is recorded from then on, nothing if the sources have errors.
    pub(crate) fn begin<'a>(
        &mut self,
        started: impl Into<Started<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
        traced: Option<&TraceArguments>,
    ) -> Result<Option<Begun>> {
        let options = self.options(compiler)?;
        let described = Described::read(started, board, compiler, options)?;
        let Some(Described { session, uart, flash }) = described else { return Ok(None) };
        // What a run that is compared changes stays in memory.
        if !board.keeps_files {
            self.start_from(flash)?;
        }
        let (programs, options) = (&session.programs, &session.options);
        let request =
            traced.map(|traced| trace::request_of_booted(traced, |list| quantities(list, programs, options)));
        let request = request.transpose()?.flatten();
        self.store(&session.values)?;
        programs.iter().try_for_each(|program| self.take(program))?;
        let starting = programs.iter().filter(|program| program.starts).map(|program| program.thread);
        self.settle(&starting.collect::<Vec<_>>())?;
        (self.programs, self.offered) = (session.programs.clone(), session.offered.clone());
        (self.options, self.uart) = (session.options.clone(), uart);
        self.surround(session, request.as_ref())?;
        Ok(Some(Begun { request }))
    }

    /// Connects the surroundings of the board, and starts the requested records.
    fn surround(&mut self, session: cc67_host::Setup, request: Option<&TraceRequest>) -> Result<()> {
        let cc67_host::Setup {
            mut config,
            options,
            programs,
            offered,
            values: _,
            mut stimulus,
            is_assisted,
            uart_input,
            hears_uart,
        } = session;
        let mut machine = std::mem::take(&mut config.machine_file);
        if !self.can_be_surrounded() {
            let is_plain = stimulus.is_empty() && machine == MachineFile::default();
            ensure!(
                is_plain && request.is_none() && !is_assisted,
                "nothing can be connected or recorded: this firmware keeps its variables in other places than 4.34"
            );
            return Ok(());
        }
        let known = [programs, offered].concat();
        for stimulus in [&mut machine.stimulus, &mut stimulus] {
            resolve(stimulus, &known, &options)?;
        }
        config.machine_file = machine.clone();
        let active = self.board.file().address("ThreadActive").unwrap_or_default();
        let mut surroundings = Surroundings::new(config, active);
        surroundings.begin(&machine, stimulus, self.board.memory_mut());
        surroundings.connect_uart(&uart_input, hears_uart);
        if let Some(request) = request {
            surroundings.record(request.clone(), self.board.memory());
            self.board.keep_packets(request.packets.is_some());
        }
        if is_assisted {
            surroundings.assist();
            self.looks.follow_calls(&mut self.board);
        }
        self.board.connect(Box::new(Attached { surroundings, origin: self.origin }));
        Ok(())
    }

    /// Restarts the firmware from what the flash holds, if there is a file of it.
    fn start_from(&mut self, mut flash: Flash) -> Result<()> {
        if let Some((path, bytes)) = flash.held() {
            let file = self.board.shared_file();
            self.board = BootedBoard::booted_from(file, bytes)
                .with_context(|| format!("the flash {} does not work with `--boot`", path.display()))?;
        }
        flash.begins_with(self.board.flash());
        self.flash = flash;
        Ok(())
    }

    /// Keeps what flash memory holds now in its file.
    pub(crate) fn keep_flash(&mut self) -> Result<()> {
        self.flash.keep(|| self.board.flash())
    }

    /// The programs in the threads.
    pub(crate) fn programs(&self) -> &[UserProgram] {
        &self.programs
    }

    /// Names and lines of the programs in the threads.
    pub(crate) fn debug(&self) -> Vec<(ThreadId, DebugInfo)> {
        self.programs.iter().map(|program| (program.thread, program_names(program))).collect()
    }

    /// Lets the firmware read what was sent, and start threads in the next tick; time is 0 a tick before.
    fn settle(&mut self, starting: &[ThreadId]) -> Result<()> {
        let end = self.board.cycle() + ANSWER;
        while !self.board.has_read_all() && self.board.cycle() < end {
            self.board.run_to(self.board.cycle() + TICK)?;
        }
        self.board.execute_together(starting)?;
        self.origin = self.board.next_tick() - TICK;
        let lines = self.board.take_lines();
        self.early = lines.into_iter().filter(|line| line.kind == Sent::Console).collect();
        Ok(())
    }

    /// Whether this firmware has its variables where the surroundings look for them.
    fn can_be_surrounded(&self) -> bool {
        let places = [
            ("chan", CHAN.address()),
            ("persist", PERSIST.address()),
            ("CurrentThread", CURRENT_THREAD.address()),
            ("HostStatus", HOST_STATUS.address()),
            ("KStepPresent", KSTEP_PRESENT.address()),
            ("VirtualBits", VIRTUAL_BITS.address()),
            ("VirtualBitsEx", VIRTUAL_BITS_EX.address()),
            ("ADC_BufferIn", ADC_BUFFER_IN.address()),
            ("DAC_Buffer", DAC_BUFFER.address()),
            ("LastPWM", LAST_PWM.address()),
            ("read_disk_buffer", READ_DISK_BUFFER.address()),
        ];
        let file = self.board.file();
        file.address("ThreadActive").is_some()
            && places.iter().all(|(name, address)| file.address(name) == Some(*address))
    }

    /// What is around the board, if anything.
    fn surroundings(&mut self) -> Option<&mut Surroundings> {
        let attached: &mut Attached = self.board.around()?.as_any().downcast_mut()?;
        Some(&mut attached.surroundings)
    }

    /// The state that the board is in; empty for a firmware with its variables in other places.
    pub(crate) fn state(&mut self) -> FinalState {
        let (around, memory) = self.board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        let Some(Attached { surroundings, .. }) = attached else { return FinalState::default() };
        FinalState::seen(memory, |item| surroundings.value(item, memory))
    }

    /// Does what the stimulus has requested.
    fn serve(&mut self) {
        let asked = self.surroundings().map(Surroundings::take_asked).unwrap_or_default();
        for one in asked {
            match one {
                Asked::Send(bytes) => self.board.send(&bytes),
                Asked::Run(thread, name) => {
                    let offered =
                        self.offered.iter().find(|known| known.thread == thread && *known.name() == *name);
                    if let Some(program) = offered.cloned()
                        && self.take(&program).is_ok()
                    {
                        self.board.execute(thread);
                    }
                }
            }
        }
    }

    /// Does what a statement of a stimulus says at the beginning of the next tick.
    ///
    /// # Errors
    /// What is wrong with it, or nothing is connected to this firmware.
    pub(crate) fn act(&mut self, action: &str) -> Result<()> {
        let stimulus = by_hand(self.tick(), action, &self.programs, &self.options)?;
        let now = self.now();
        let (around, memory) = self.board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        let Attached { surroundings, .. } = attached.context("nothing is connected to this firmware")?;
        surroundings.play(stimulus, memory, now);
        Ok(())
    }

    /// The value of an item of the board; 0 where nothing is connected to this firmware.
    pub(crate) fn item(&mut self, item: Item) -> f64 {
        let (around, memory) = self.board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        attached.map_or(0.0, |attached| attached.surroundings.value(item, memory))
    }

    /// How programs are compiled.
    pub(crate) const fn compile_options(&self) -> &Options {
        &self.options
    }

    /// The level of a bit; low where nothing is connected to this firmware.
    pub(crate) fn bit(&mut self, bit: Bit) -> bool {
        self.item(Item::of_bit(bit)) != 0.0
    }

    /// Gives the peer of the serial port what was sent, and takes what it sends.
    fn exchange_serial(&mut self) {
        let now = self.now();
        let backlog = self.surroundings().map_or(0, |surroundings| surroundings.uart_backlog());
        let came = self.line.take(backlog);
        if let Some(surroundings) = self.surroundings()
            && !came.is_empty()
        {
            surroundings.send_to_uart(&came, now);
        }
    }

    /// The run is over: what the stimulus expects then is checked, the file of the serial port is written.
    pub(crate) fn finish(&mut self, sink: &mut dyn FnMut(Event)) -> Result<()> {
        let now = self.now();
        let (around, memory) = self.board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        if let Some(Attached { surroundings, .. }) = attached {
            surroundings.finish(memory, now);
            surroundings.take_events().into_iter().for_each(sink);
        }
        self.line.finish()?;
        self.keep_flash()
    }

    /// Stores start values of `persist.UserData`, wherever this firmware has it.
    fn store(&mut self, values: &[(GuestAddr, Vec<u8>)]) -> Result<()> {
        if values.is_empty() {
            return Ok(());
        }
        let persist = self.board.file().address("persist").context("this firmware has no `persist`")?;
        for (address, bytes) in values {
            let place = persist.offset(address.get() - PERSIST.address().get());
            self.board.memory_mut().poke_bytes(place, bytes)?;
        }
        Ok(())
    }

    /// Board time since the firmware was ready.
    pub(crate) fn now(&self) -> Cycles {
        self.since_ready(self.board.cycle())
    }

    /// The same in ticks.
    pub(crate) fn tick(&self) -> Ticks {
        Ticks::new((self.board.cycle() - self.origin) / TICK)
    }

    fn since_ready(&self, cycle: u64) -> Cycles {
        Cycles::new(i64::try_from(cycle.saturating_sub(self.origin)).unwrap_or(i64::MAX))
    }

    /// The user threads that are active.
    pub(crate) fn active(&self) -> Vec<u8> {
        let is_active = |thread: &ThreadId| self.board.is_active(*thread).unwrap_or(false);
        ThreadId::all().filter(is_active).map(ThreadId::get).collect()
    }

    /// Runs until everything has ended, or for that long since the firmware was ready.
    ///
    /// # Errors
    /// The firmware ran away; what it has sent before was handed over.
    pub(crate) fn run(
        &mut self,
        limit: Ticks,
        pace: Option<&Pace>,
        sink: &mut dyn FnMut(Event),
    ) -> Result<End, Halted> {
        let mut silence = Silence::new(&self.board);
        let mut axes = self.commands();
        while self.tick() < limit {
            if self.interrupter.take() {
                return Ok(End::Interrupted);
            }
            let has_sent = self.advance(TICK, sink)?;
            if let Some(pace) = pace {
                pace.wait(self.tick());
            }
            let moved = std::mem::replace(&mut axes, self.commands());
            let is_awaited = self.is_awaited() || self.board.is_starting();
            let is_busy = has_sent
                || is_awaited
                || moved != axes
                || !self.board.has_read_all()
                || !self.active().is_empty();
            silence.note(is_busy, &self.board);
            if silence.is_over(&self.board) {
                return Ok(End::AllEnded);
            }
        }
        Ok(End::Limit)
    }

    /// Whether something is still to come from around the board.
    fn is_awaited(&mut self) -> bool {
        let (around, memory) = self.board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        attached.is_some_and(|attached| attached.surroundings.is_busy(memory))
    }

    /// Where the axes are commanded to be, as bits, to see whether they move.
    fn commands(&self) -> Vec<u64> {
        self.axes().iter().map(|(dest, _)| dest.to_bits()).collect()
    }

    /// Where the axes are commanded to be, and where they are.
    pub(crate) fn axes(&self) -> Vec<(f64, f64)> {
        AxisId::all().filter_map(|axis| self.board.axis(axis)).collect()
    }

    /// Runs to the next tick.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn advance_tick(&mut self, sink: &mut dyn FnMut(Event)) -> Result<bool, Halted> {
        let left = TICK - (self.board.cycle() - self.origin) % TICK;
        self.advance(left, sink)
    }

    /// Lets this many cycles pass; whether the firmware has sent lines.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn advance(&mut self, cycles: u64, sink: &mut dyn FnMut(Event)) -> Result<bool, Halted> {
        let (begin, end) = (self.tick(), self.board.cycle() + cycles);
        let result = loop {
            match self.looks.run(&mut self.board, end) {
                Ok(Ran::ToStop) => {}
                other => break other,
            }
        };
        let has_sent = self.complete(begin, sink);
        result.map(|_| has_sent)
    }

    /// Runs to one of the [stops](Looks::set_stops), or through a part of the run that began in a tick and ends in a cycle.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn advance_to_stop(
        &mut self,
        (begin, end): (Ticks, u64),
        sink: &mut dyn FnMut(Event),
    ) -> Result<Ran, Halted> {
        let result = self.looks.run(&mut self.board, end);
        if result != Ok(Ran::ToStop) {
            self.complete(begin, sink);
        }
        result
    }

    /// A part of the run that began in a tick is over: exchanges what is around the board; whether the firmware has sent lines.
    fn complete(&mut self, begin: Ticks, sink: &mut dyn FnMut(Event)) -> bool {
        self.note_packets();
        if begin.get() / PART != self.tick().get() / PART {
            self.exchange_serial();
        }
        let mut lines = std::mem::take(&mut self.early);
        lines.extend(self.board.take_lines());
        let has_sent = !lines.is_empty();
        for line in lines {
            let at = self.since_ready(line.cycle);
            match self.surroundings() {
                // The PC around it takes what is for files, and shows the rest.
                Some(surroundings) if line.kind != Sent::Reply => surroundings.hear(line.text, at),
                Some(_) => sink(Event { at, kind: EventKind::Reply(line.text) }),
                None => sink(Self::event(line, at)),
            }
            self.tell(sink);
        }
        self.tell(sink);
        self.serve();
        has_sent
    }

    /// Records the packets that programs have executed, where they are recorded.
    fn note_packets(&mut self) {
        for ProgramPacket { cycle, cycles, at, thread, text } in self.board.take_packets() {
            let (start, cycles) = (self.since_ready(cycle), Cycles::new(cycles));
            if let (Some(at), Some(surroundings)) = (CodeAddr::new(at), self.surroundings()) {
                surroundings.packet_ran(ExecutedPacket { thread, at, start, cycles, text });
            }
        }
    }

    /// Hands over what has happened around the board.
    fn tell(&mut self, sink: &mut dyn FnMut(Event)) {
        let events = self.surroundings().map(Surroundings::take_events).unwrap_or_default();
        for event in events {
            self.line.note(&event);
            sink(event);
        }
    }

    fn event(line: SentLine, at: Cycles) -> Event {
        let kind = match line.kind {
            Sent::Console => EventKind::ConsoleLine(line.text),
            Sent::Reply => EventKind::Reply(line.text),
            Sent::Request => {
                let text = String::from_utf8_lossy(line.text.get(1..).unwrap_or_default()).into_owned();
                EventKind::Host(format!(
                    "the program asks for the file `{text}`; files are not served with `--boot` yet"
                ))
            }
        };
        Event { at, kind }
    }

    /// Sends a line to the firmware, and lets pass the time until it has nothing more to say about it.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn exchange(&mut self, line: &str, sink: &mut dyn FnMut(Event)) -> Result<(), Halted> {
        self.board.send_line(line.as_bytes());
        let end = self.board.cycle() + COMMAND;
        let mut silence = Silence::new(&self.board);
        while !silence.is_over(&self.board) && self.board.cycle() < end {
            let has_sent = self.advance(TICK, sink)?;
            silence.note(has_sent || !self.board.has_read_all(), &self.board);
        }
        Ok(())
    }
}
