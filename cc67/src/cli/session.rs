//! From arguments to a board under control: what the options say becomes a configuration, files become programs, and
//! both become a [session](cc67_host::Session) on the engine that is requested.
//!
//! Every command that has a board takes this way, so an option of a board reaches all of them.

mod around;
pub(crate) mod booted;
mod flash;
mod line;

use std::ffi::OsString;
use std::ops::ControlFlow;

use anyhow::{Context, Result};
use cc67_debug::dap::AttachPoint;
use cc67_host::{Attendant, End, Idle, Session, UserProgram};
use compiler::Options;
use kmotiondef::Ticks;
use runtime::stimulus::Stimulus;
use runtime::{Config, Event};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::machine::Config as MachineConfig;
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
use flash::Flash;
use line::SerialLine;

/// Everything that the arguments ask for, read and compiled.
#[derive(Debug)]
pub(crate) struct Setup {
    session: cc67_host::Setup,
    engine: EngineName,
    uart: UartArguments,
    flash: Flash,
}

/// What a command does with a board, whichever engine executes the programs.
pub(crate) trait Work {
    /// Does it.
    fn on<E: Engine>(self, rig: Rig<E>) -> Result<Exit>;
}

impl Setup {
    /// Reads what the arguments name and compiles the programs; `None` if one has errors, which have been reported.
    pub(crate) fn new<'a>(
        started: impl Into<Started<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
    ) -> Result<Option<Self>> {
        anyhow::ensure!(board.boot.is_none(), "`--boot` does not work with this command yet");
        Self::of_model(started, board, compiler)
    }

    /// The same for the modelled firmware, also where a firmware file is named.
    pub(crate) fn of_model<'a>(
        started: impl Into<Started<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
    ) -> Result<Option<Self>> {
        let options = board.engine.options(compiler)?;
        options.firmware.check_version().context("`--firmware`")?;
        let described = Described::read(started, board, compiler, options)?;
        let Some(Described { session, uart, flash }) = described else { return Ok(None) };
        Ok(Some(Self { session, engine: board.engine, uart, flash }))
    }

    /// Does the work of a command on the engine that was requested.
    pub(crate) fn on_its_engine(self, work: impl Work) -> Result<Exit> {
        // Beside real images there may be bytecode, which the usual engine executes.
        let engine = if self.engine == EngineName::Dsp { EngineName::default() } else { self.engine };
        match engine {
            EngineName::Bytecode | EngineName::Dsp => work.on(self.rig(BytecodeEngine::default())?),
            #[cfg(feature = "native")]
            EngineName::Native => work.on(self.rig(NativeEngine::default())?),
            #[cfg(not(feature = "native"))]
            EngineName::Native => anyhow::bail!("this cc67 is built without the native engine"),
        }
    }

    /// The same on the engine that a debugger can hold, if editors may attach one.
    pub(crate) fn debugged(self, debugger: Option<AttachPoint>, work: impl Work) -> Result<Exit> {
        let Some(debugger) = debugger else { return self.on_its_engine(work) };
        let mut rig = self.rig(BytecodeEngine::default())?;
        rig.attendant = Some(Box::new(debugger));
        work.on(rig)
    }

    /// A board as the arguments want it, on an engine of the caller's choice.
    pub(crate) fn rig<E: Engine>(self, engine: E) -> Result<Rig<E>> {
        let session = self.session.session_on(engine)?;
        Ok(Rig {
            session,
            engine: self.engine,
            uart: self.uart,
            line: SerialLine::default(),
            flash: self.flash,
            attendant: None,
        })
    }

    /// The board for a debugger, on the engine that it can hold.
    pub(crate) fn for_debugger(self) -> Result<Session> {
        if self.uart.uart.is_some() || self.uart.uart_output.is_some() {
            anyhow::bail!(
                "a debugged board has no peer at its serial port, which could not go back in time: `--uart-input`"
            );
        }
        Ok(self.session.session()?)
    }
}

/// What the options of a board and its programs come to, whatever the programs are compiled for.
#[derive(Debug)]
pub(crate) struct Described {
    /// The board and its programs.
    pub(crate) session: cc67_host::Setup,
    /// What its serial port is connected to.
    pub(crate) uart: UartArguments,
    /// Its flash.
    pub(crate) flash: Flash,
}

impl Described {
    /// Reads what the arguments name and compiles the programs; `None` if one has errors, which have been reported.
    pub(crate) fn read<'a>(
        started: impl Into<Started<'a>>,
        board: &BoardArguments,
        compiler: &CompilerArguments,
        options: Options,
    ) -> Result<Option<Self>> {
        let Started { programs, first: before } = started.into();
        let files = assign(&[programs, before, &board.load].concat())?;
        let before = files.get(programs.len()..programs.len() + before.len()).unwrap_or_default();
        let mut machine_file = board.machine_file()?;
        let settings = [setting::all(&board.set, &mut machine_file)?, board.pc.mcode()?].concat();
        let answers = board.pc.answers(&machine_file)?;
        let flash = Flash::read(board.pc.flash_file(&machine_file))?;
        let mut stimulus = stimulus::read(&board.stim)?;
        stimulus.extend(one_after_the_other(before, files.get(..programs.len()).unwrap_or_default())?);
        let uart = board.uart.or_those_of(&machine_file);
        let offered = stimulus::programs(&[&machine_file.stimulus, &stimulus]);
        let Some((mut loaded, offered)) = compile(&files, offered, compiler, &options)? else {
            return Ok(None);
        };
        let starting = if before.is_empty() { 0..programs.len() } else { programs.len()..programs.len() + 1 };
        loaded.iter_mut().enumerate().for_each(|(index, program)| program.starts = starting.contains(&index));

        machine_file.cpu.board_faults |= board.board_faults;
        let machine = MachineConfig { shortcuts: !board.no_shortcuts, ..MachineConfig::default() };
        let disk = board.files(&machine_file);
        let flashed = flash.contents();
        let config =
            Config { machine, files: disk, machine_file, answers, flash: flashed, ..Config::default() };
        let session = cc67_host::Setup {
            config,
            options,
            programs: loaded,
            offered,
            values: settings.into_iter().map(|Setting { address, bytes }| (address, bytes)).collect(),
            stimulus,
            is_assisted: board.assist,
            uart_input: uart.uart_input.as_deref().map(read).transpose()?.unwrap_or_default(),
            hears_uart: uart.uart.is_some() || uart.uart_output.is_some(),
        };
        Ok(Some(Self { session, uart, flash }))
    }
}

/// Programs that start, and those that run to their end before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Started<'a> {
    /// Programs that start together.
    pub(crate) programs: &'a [OsString],
    /// Programs that run to their end before, in turn.
    pub(crate) first: &'a [OsString],
}

impl<'a> From<&'a [OsString]> for Started<'a> {
    fn from(programs: &'a [OsString]) -> Self {
        Self { programs, first: &[] }
    }
}

impl<'a> From<&'a Vec<OsString>> for Started<'a> {
    fn from(programs: &'a Vec<OsString>) -> Self {
        Self { programs, first: &[] }
    }
}

/// What starts each program after the one before it has ended, and the others after the last.
fn one_after_the_other(before: &[ProgramFile], others: &[ProgramFile]) -> Result<Stimulus> {
    let mut text = String::new();
    for (index, program) in before.iter().enumerate() {
        let next = before.get(index + 1).map_or(others, std::slice::from_ref);
        for other in next {
            text.push_str(&format!("once thread {} ends start thread {}\n", program.thread, other.thread));
        }
    }
    Ok(Stimulus::parse(&text, "--first")?)
}

/// The programs of files to load and of those that a stimulus may load; `None` if one has errors.
fn compile(
    files: &[ProgramFile],
    offered: Vec<ProgramFile>,
    compiler: &CompilerArguments,
    options: &Options,
) -> Result<Option<(Vec<UserProgram>, Vec<UserProgram>)>> {
    let all = [files, &offered].concat();
    let Some(mut programs) = images::programs_with(&all, compiler, options)? else { return Ok(None) };
    let offered = programs.split_off(files.len());
    Ok(Some((programs, offered)))
}

/// A session as the arguments want it, with what they connect to its board: the serial port, the file of the flash.
#[derive(Debug)]
pub(crate) struct Rig<E: Engine> {
    /// The board under control.
    pub(crate) session: Session<E>,
    engine: EngineName,
    uart: UartArguments,
    line: SerialLine,
    flash: Flash,
    /// Who may stop the board.
    pub(crate) attendant: Option<Box<dyn Attendant<E>>>,
}

impl<E: Engine> Rig<E> {
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
        let Some(programs) = images::programs(files, compiler, &self.engine.options(compiler)?)? else {
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
        self.line.run(&mut self.session, limit, pace, sink)
    }

    /// Runs to the end of a tick, also when everything has ended.
    pub(crate) fn advance(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) {
        self.advance_attended(limit, sink, &mut |_| ControlFlow::Continue(()));
    }

    /// The same with somebody who may stop the board; `idle` is what is done meanwhile.
    pub(crate) fn advance_attended(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event), idle: Idle<'_, E>) {
        let attendant = &mut self.attendant;
        self.line.advance(&mut self.session, limit, sink, &mut |session, part, sink| match attendant {
            Some(attendant) => attendant.advance(session, part, sink, idle),
            None => session.advance(part, sink),
        });
    }

    /// Sends a line to the board, and lets pass the time it takes.
    pub(crate) fn exchange(&mut self, bytes: &[u8], sink: &mut dyn FnMut(Event)) {
        let line = &mut self.line;
        self.session.exchange(bytes, &mut |event| {
            line.note(&event);
            sink(event);
        });
    }

    /// Keeps what flash memory holds now in its file.
    pub(crate) fn keep_flash(&mut self) -> Result<()> {
        self.flash.keep(|| self.session.board().flash())
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
