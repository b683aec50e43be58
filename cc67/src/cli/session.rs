//! From arguments to a board under control: options become a configuration, files become programs, and both become a
//! [session](cc67_host::Session) on the engine that is requested.
//!
//! Every command that has a board takes this way, so an option of a board reaches all of them.

mod boxes;
pub(crate) mod controller;
mod flash;
mod line;

use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use cc67_controller::{ControllerLink, LoadTerms, ProgramStart};
use cc67_debug::dap::AttachPoint;
use cc67_host::{
    AnyTarget, Attendant, BootedFirmware, BootedTarget, End, HostError, IdleWork, Schedule, Session, Target,
    UserProgram,
};
use compiler::firmware::Firmware;
use compiler::target::Target as CodeTarget;
use compiler::{Division, Options};
use kmotiondef::Ticks;
use kmotiondef::boards::boards;
use runtime::stimulus::Stimulus;
use runtime::{Board, Config, Event, ModelledBoard};
use vm::engine::Engine;
#[cfg(feature = "native")]
use vm::native::NativeEngine;

use super::args::board::BoardArguments;
use super::args::compiler::CompilerArguments;
use super::args::engine::EngineName;
use super::args::program::{ProgramFile, assign};
use super::args::setting::{self, Setting};
use super::args::stimulus;
use super::args::uart::UartArguments;
use super::compile::images;
use super::io::exit::Exit;
use super::io::input::read;
use super::io::pace::Pace;
pub(crate) use boxes::run_with_boxes;
use flash::{Flash, HeldEvents};
use line::SerialLine;

/// Everything that the arguments ask for, read and compiled.
#[derive(Debug)]
pub(crate) struct Setup {
    session: cc67_host::Setup,
    code: CodeFor,
    uart: UartArguments,
    flash: Flash,
    controller: Option<ConnectedController>,
}

/// A controller that answers, and the terms on which it takes programs.
#[derive(Debug)]
struct ConnectedController {
    connection: ControllerLink,
    terms: LoadTerms,
}

/// The target that programs are compiled for: an engine of the modelled board, a firmware file, or a connected controller.
#[derive(Clone, Debug)]
enum CodeFor {
    Engine(EngineName),
    Firmware(BootedFirmware),
    Controller(Firmware),
}

impl CodeFor {
    /// Returns the options with which sources are compiled.
    fn options(&self, compiler: &CompilerArguments) -> Result<Options> {
        match self {
            Self::Engine(engine) => engine.options(compiler),
            Self::Firmware(firmware) => compiler.for_firmware(firmware),
            Self::Controller(firmware) => {
                let options = compiler.resolve()?;
                Ok(Options { target: CodeTarget::C67x, firmware: firmware.clone(), ..options })
            }
        }
    }
}

/// Starts a firmware file.
pub(crate) fn boot(file: &Path) -> Result<BootedFirmware> {
    let bytes = read(file)?;
    BootedFirmware::new(&bytes).with_context(|| format!("`--boot {}`", file.display()))
}

/// The work of a command on a board of any target.
pub(crate) trait Work {
    /// Does it.
    fn on<T: Target>(self, board: BoardSession<T>) -> Result<Exit>;
}

impl Setup {
    /// Reads what the arguments name and compiles the programs; `None` if one has errors, which have been reported.
    pub(crate) fn new<'a>(
        started: impl Into<StartPlan<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
    ) -> Result<Option<Self>> {
        if let Some(address) = &board.controller.on {
            board.refuse_with_controller()?;
            compiler.refuse_with_controller()?;
            let connection = controller::connect(address, board.controller.yes)?;
            let firmware = controller::firmware(&connection, compiler.resolve()?.firmware, compiler)?;
            let setup = Self::compiled(started, board, compiler, CodeFor::Controller(firmware))?;
            let connected = ConnectedController { connection, terms: board.controller.terms() };
            return Ok(setup.map(|setup| Self { controller: Some(connected), ..setup }));
        }
        let Some(file) = &board.boot else { return Self::of_model(started, board, compiler) };
        board.refuse_with_boot()?;
        compiler.refuse_with("--boot")?;
        Self::of_firmware(started, board, compiler, &boot(file)?)
    }

    /// Reads and compiles for the modelled firmware, also where a firmware file is named.
    pub(crate) fn of_model<'a>(
        started: impl Into<StartPlan<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
    ) -> Result<Option<Self>> {
        Self::compiled(started, board, compiler, CodeFor::Engine(board.engine()))
    }

    /// Reads and compiles for a firmware that has started.
    pub(crate) fn of_firmware<'a>(
        started: impl Into<StartPlan<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
        firmware: &BootedFirmware,
    ) -> Result<Option<Self>> {
        Self::compiled(started, board, compiler, CodeFor::Firmware(firmware.clone()))
    }

    fn compiled<'a>(
        started: impl Into<StartPlan<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
        code: CodeFor,
    ) -> Result<Option<Self>> {
        let options = code.options(compiler)?;
        if matches!(code, CodeFor::Engine(_)) {
            options.firmware.check_version()?;
            modelled(&options)?;
        }
        let prepared = PreparedBoard::read(started, board, compiler, options)?;
        let Some(PreparedBoard { session, uart, flash }) = prepared else { return Ok(None) };
        Ok(Some(Self { session, code, uart, flash, controller: None }))
    }

    /// The firmware file that was requested, if one was.
    pub(crate) fn firmware(&self) -> Option<BootedFirmware> {
        match &self.code {
            CodeFor::Engine(_) | CodeFor::Controller(_) => None,
            CodeFor::Firmware(firmware) => Some(firmware.clone()),
        }
    }

    /// Returns whether the board is a connected controller.
    #[cfg(feature = "live")]
    pub(crate) const fn is_of_controller(&self) -> bool {
        self.controller.is_some()
    }

    /// Takes the programs out: they are not loaded.
    #[cfg(feature = "live")]
    pub(crate) fn take_programs(&mut self) -> Vec<UserProgram> {
        std::mem::take(&mut self.session.programs)
    }

    /// Has the PC of the board at the other end of its link.
    pub(crate) fn with_pc_elsewhere(mut self) -> Self {
        let config = &mut self.session.config;
        config.host = false;
        // It is not missing, and takes its time.
        let known = config.machine_file.want_remark("no-pc", false);
        debug_assert!(known.is_some(), "there is this remark");
        self
    }

    /// Has the programs run by a schedule.
    pub(crate) fn with_schedule(mut self, schedule: &Schedule) -> Result<Self> {
        self.session.schedule(schedule)?;
        Ok(self)
    }

    /// Does the work of a command on the target that was requested.
    pub(crate) fn on_its_target(self, work: impl Work) -> Result<Exit> {
        match self.code {
            #[cfg(feature = "native")]
            // Beside real images there may be bytecode, which the usual engine executes.
            CodeFor::Engine(EngineName::Native | EngineName::Dsp) => {
                work.on(self.modelled_session(NativeEngine::default())?)
            }
            #[cfg(not(feature = "native"))]
            CodeFor::Engine(EngineName::Native) => {
                anyhow::bail!("this cc67 is built without the native engine")
            }
            CodeFor::Engine(_) | CodeFor::Firmware(_) | CodeFor::Controller(_) => {
                work.on(self.target_session()?)
            }
        }
    }

    /// Does the work on the engine that a debugger can hold, if editors may attach one.
    pub(crate) fn debugged(self, debugger: Option<AttachPoint>, work: impl Work) -> Result<Exit> {
        let Some(debugger) = debugger else { return self.on_its_target(work) };
        let mut board = self.target_session()?;
        board.attendant = Some(Box::new(debugger));
        work.on(board)
    }

    /// A modelled board as the arguments want it, on an engine of the caller's choice.
    pub(crate) fn modelled_session<E: Engine>(self, engine: E) -> Result<BoardSession<Board<E>>> {
        self.rig_with(|session, _| session.session_on(engine))
    }

    /// A firmware file as the arguments want it.
    pub(crate) fn firmware_session(self, firmware: &BootedFirmware) -> Result<BoardSession<BootedTarget>> {
        self.rig_with(|session, _| session.session_on_firmware(firmware))
    }

    /// The target that was requested; the modelled board on the interpreter.
    pub(crate) fn target_session(mut self) -> Result<BoardSession<AnyTarget>> {
        let controller = self.controller.take();
        self.rig_with(|session, code| match (code, controller) {
            (_, Some(ConnectedController { connection, terms })) => {
                Ok(connection.session(session, terms, controller::progress())?.on_any())
            }
            (CodeFor::Firmware(firmware), None) => session.session_on_any(Some(firmware)),
            (CodeFor::Engine(_) | CodeFor::Controller(_), None) => session.session_on_any(None),
        })
    }

    fn rig_with<T: Target>(
        self,
        make: impl FnOnce(cc67_host::Setup, &CodeFor) -> Result<Session<T>, HostError>,
    ) -> Result<BoardSession<T>> {
        let Self { session, code, uart, mut flash, controller: _ } = self;
        let division = session.options.division;
        let session = make(session, &code).map_err(|error| match (&error, flash.file()) {
            (HostError::Flash(why), Some((path, _))) => {
                anyhow::anyhow!("the flash {} does not work with `--boot`: {why}", path.display())
            }
            _ => error.into(),
        })?;
        // To read the flash of a modelled board fills two megabytes; only a firmware file writes to it as it starts.
        if let CodeFor::Firmware(_) = code
            && let Some(now) = session.target().flash()
        {
            flash.begins_with(now);
        }
        let line = SerialLine::default();
        Ok(BoardSession { session, code, division, uart, line, flash, attendant: None })
    }

    /// The board for a debugger, on the engine that it can hold; on a connected controller the programs are loaded and
    /// not started.
    pub(crate) fn for_debugger(mut self) -> Result<Session<AnyTarget>> {
        if let Some(ConnectedController { terms, .. }) = &mut self.controller {
            (terms.start, terms.has_monitor) = (ProgramStart::ByCall, true);
        }
        if self.uart.uart.is_some() || self.uart.uart_output.is_some() {
            anyhow::bail!(
                "a debugged board has no peer at its serial port, which could not go back in time: `--uart-input`"
            );
        }
        Ok(self.target_session()?.session)
    }

    /// Prepares for a recording: on a connected controller programs start when it has begun.
    pub(crate) fn recorded(mut self) -> Self {
        if let Some(ConnectedController { terms, .. }) = &mut self.controller {
            (terms.start, terms.has_monitor) = (ProgramStart::WithTime, true);
        }
        self
    }
}

/// The board and its programs as the options describe them, for any code.
#[derive(Debug)]
pub(crate) struct PreparedBoard {
    /// The board and its programs.
    pub(crate) session: cc67_host::Setup,
    /// The connection of its serial port.
    pub(crate) uart: UartArguments,
    /// Its flash.
    pub(crate) flash: Flash,
}

impl PreparedBoard {
    /// Reads what the arguments name and compiles the programs; `None` if one has errors, which have been reported.
    pub(crate) fn read<'a>(
        started: impl Into<StartPlan<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
        mut options: Options,
    ) -> Result<Option<Self>> {
        let StartPlan { programs, first: before } = started.into();
        let files = assign(&[programs, before, &board.load].concat())?;
        let before = files.get(programs.len()..programs.len() + before.len()).unwrap_or_default();
        let mut machine_file = board.machine_file(options.firmware.board())?;
        let settings = [setting::all(&board.set, &mut machine_file)?, board.pc.mcode()?].concat();
        options.float_elements = settings.iter().filter_map(|setting| setting.single).collect();
        machine_file.cpu.board_faults |= board.board_faults;
        if machine_file.cpu.board_faults {
            options.division = Division::Firmware;
        }
        let answers = board.pc.answers(&machine_file)?;
        // What a run that is compared changes stays in memory.
        let is_kept = !(board.keeps_files && options.target == CodeTarget::C67x);
        let flash = board.pc.flash_file(&machine_file).filter(|_| is_kept);
        if flash.is_some() && options.firmware.board().map().flash.is_none() {
            bail!("`--flash`: the flash memory of {} is not simulated", options.firmware.board().name);
        }
        if board.races && !options.firmware.board().is_proven {
            bail!("`--races`: accesses of threads are not followed on {}", options.firmware.board().name);
        }
        let flash = Flash::read(flash)?;
        let mut stimulus = stimulus::read(&board.stim)?;
        stimulus.extend(one_after_the_other(before, files.get(..programs.len()).unwrap_or_default())?);
        let uart = board.uart.or_those_of(&machine_file);
        let offered = stimulus::programs(&[&machine_file.stimulus, &stimulus]);
        let Some((mut loaded, offered)) = compile(&files, offered, compiler, &options)? else {
            return Ok(None);
        };
        let starting = if before.is_empty() { 0..programs.len() } else { programs.len()..programs.len() + 1 };
        loaded.iter_mut().enumerate().for_each(|(index, program)| program.starts = starting.contains(&index));

        let machine = board.machine_config();
        let disk = board.files(&machine_file);
        let flashed = flash.contents();
        // A booted firmware is its own board.
        let modelled = modelled(&options).unwrap_or_default();
        let config = Config {
            board: modelled,
            machine,
            files: disk,
            machine_file,
            answers,
            flash: flashed,
            ..Config::default()
        };
        let mut session = cc67_host::Setup {
            config,
            options,
            programs: loaded,
            offered,
            values: settings.into_iter().map(|Setting { address, bytes, .. }| (address, bytes)).collect(),
            stimulus,
            is_assisted: board.assist,
            uart_input: uart.uart_input.as_deref().map(read).transpose()?.unwrap_or_default(),
            hears_uart: uart.uart.is_some() || uart.uart_output.is_some(),
        };
        if let Some(schedule) = &board.schedule {
            session.schedule(schedule)?;
        }
        Ok(Some(Self { session, uart, flash }))
    }
}

/// The model of the board that programs are compiled for.
fn modelled(options: &Options) -> Result<ModelledBoard> {
    let board = options.firmware.board();
    let unknown = || {
        let known = boards().filter(|board| ModelledBoard::of(board).is_some()).map(|board| board.name);
        let known = known.collect::<Vec<_>>().join(", ");
        anyhow!(
            "`--board`: {} is not simulated; programs can be built for it, and run on {known}",
            board.name
        )
    };
    ModelledBoard::of(board).ok_or_else(unknown)
}

/// Programs that start, and those that run to their end before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartPlan<'a> {
    /// Programs that start together.
    pub(crate) programs: &'a [OsString],
    /// Programs that run to their end before, in turn.
    pub(crate) first: &'a [OsString],
}

impl<'a> From<&'a [OsString]> for StartPlan<'a> {
    fn from(programs: &'a [OsString]) -> Self {
        Self { programs, first: &[] }
    }
}

impl<'a> From<&'a Vec<OsString>> for StartPlan<'a> {
    fn from(programs: &'a Vec<OsString>) -> Self {
        Self { programs, first: &[] }
    }
}

/// Returns a stimulus that starts each program after the one before it has ended, and the others after the last.
fn one_after_the_other(before: &[ProgramFile], others: &[ProgramFile]) -> Result<Stimulus> {
    let mut all = Stimulus::default();
    for (index, program) in before.iter().enumerate() {
        let next = before.get(index + 1).map_or(others, std::slice::from_ref);
        let start = |other: &ProgramFile| {
            format!("once thread {} ends start thread {}\n", program.thread, other.thread)
        };
        let text: String = next.iter().map(start).collect();
        all.extend(Stimulus::parse(&text, &program.path.to_string_lossy())?);
    }
    Ok(all)
}

/// The programs of files to load and of those that a stimulus may load; `None` if one has errors.
fn compile(
    files: &[ProgramFile],
    offered: Vec<ProgramFile>,
    compiler: &CompilerArguments,
    options: &Options,
) -> Result<Option<(Vec<UserProgram>, Vec<UserProgram>)>> {
    let all = [files, &offered].concat();
    let Some(mut programs) = images::programs(&all, compiler, options)? else { return Ok(None) };
    let offered = programs.split_off(files.len());
    Ok(Some((programs, offered)))
}

/// A session that the arguments describe, with the serial port and the file of the flash of its board.
#[derive(Debug)]
pub(crate) struct BoardSession<T: Target> {
    /// The board under control.
    pub(crate) session: Session<T>,
    code: CodeFor,
    division: Division,
    uart: UartArguments,
    line: SerialLine,
    flash: Flash,
    /// The debugger or client that may stop the board.
    pub(crate) attendant: Option<Box<dyn Attendant<T>>>,
}

impl<T: Target> BoardSession<T> {
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
        let options = Options { division: self.division, ..self.code.options(compiler)? };
        let Some(programs) = images::programs(files, compiler, &options)? else {
            return Ok(false);
        };
        let load = |(index, program): (usize, UserProgram)| {
            self.session.load(UserProgram { starts: index < starts, ..program })
        };
        programs.into_iter().enumerate().try_for_each(load)?;
        Ok(true)
    }

    /// The command keeps the board at the pace of a clock.
    pub(crate) fn is_paced(&mut self) {
        self.line.is_paced_elsewhere();
    }

    /// Runs until everything has ended, or to the limit; at the pace of a clock, if there is one.
    pub(crate) fn run(&mut self, limit: Ticks, pace: Option<&Pace>, sink: &mut dyn FnMut(Event)) -> End {
        let mut held = self.flash.held();
        let end = self.line.run(&mut self.session, limit, pace, &mut |event| held.pass(event, sink));
        self.acknowledge(held, sink);
        end
    }

    /// Runs to the end of a tick, also when everything has ended.
    pub(crate) fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        self.advance_attended(limit, sink, &mut |_| ControlFlow::Continue(()));
    }

    /// Advances the board with an attendant that may stop it; `idle` is called meanwhile.
    pub(crate) fn advance_attended(
        &mut self,
        limit: Ticks,
        sink: &mut dyn FnMut(Event),
        idle: IdleWork<'_, T>,
    ) {
        let attendant = &mut self.attendant;
        let mut held = self.flash.held();
        let pass = &mut |event| held.pass(event, sink);
        self.line.advance(&mut self.session, limit, pass, &mut |session, part, sink| match attendant {
            Some(attendant) => attendant.advance(session, part, sink, idle),
            None => session.advance(part, sink),
        });
        self.acknowledge(held, sink);
    }

    /// Writes flash to its file and hands on what waits for that.
    fn acknowledge(&mut self, held: HeldEvents, sink: &mut dyn FnMut(Event)) {
        self.flash.acknowledge(held, || self.session.target().flash().unwrap_or_default(), sink);
    }

    /// Returns a keeper of the flash for a session that is run elsewhere.
    #[cfg(feature = "live")]
    pub(crate) fn flash_keeper(&self) -> Flash {
        self.flash.clone()
    }

    /// Sends a line to the board, and lets pass the time it takes.
    pub(crate) fn exchange(&mut self, bytes: &[u8], sink: &mut dyn FnMut(Event)) {
        let (line, mut held) = (&mut self.line, self.flash.held());
        self.session.exchange(bytes, &mut |event| {
            line.note(&event);
            held.pass(event, sink);
        });
        self.acknowledge(held, sink);
    }

    /// Keeps what flash memory holds now in its file.
    pub(crate) fn keep_flash(&mut self) -> Result<()> {
        self.flash.keep(|| self.session.target().flash().unwrap_or_default())
    }

    /// The run is over: what is held comes out, the files of the serial port and of the flash are written.
    pub(crate) fn finish(&mut self, sink: &mut dyn FnMut(Event)) -> Result<()> {
        let line = &mut self.line;
        self.session.finish(&mut |event| {
            line.note(&event);
            sink(event);
        });
        line.finish()?;
        self.keep_flash()
    }
}
