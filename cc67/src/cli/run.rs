//! `cc67 run`: compile, load, execute, print the console.

use std::ffi::{OsStr, OsString};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use kmotiondef::{AxisId, ThreadId, Ticks};
use runtime::loader::LoadError;
use runtime::stimulus::Stimulus;
use runtime::trace::Request;
use runtime::{Board, Config, EventKind, MachineFile, RunEnd};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;
use vm::machine::Config as MachineConfig;
use vm::profile::ProfilingEngine;

use super::options::CompilerOptions;
use super::pace::Pace;
use super::pc::PcOptions;
use super::program::{Program, assign};
use super::screen::{Offered, Reader, Screen, Style};
use super::setting::{self, Setting};
use super::uart::UartOptions;
use super::{Exit, output, pc, profile, stimulus, terminal, trace, units};
use compiler::diag::levels::Levels;
use compiler::files::reason;
use compiler::render::Format;
use compiler::{Options, files, image};

/// Seconds of board time after which a run without `--for` ends.
pub(super) const DEFAULT_LIMIT: f64 = 60.0;

/// Seconds in a tick.
pub(super) const TIMEBASE: f64 = 90e-6;

/// Arguments of `cc67 run`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The programs, sources or images: FILE for the lowest free thread, N:FILE for thread N
    #[arg(required_unless_present_any = ["explain", "flash"], value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Load a program without starting it, for another one to start
    #[arg(long, value_name = "N:FILE")]
    load: Vec<OsString>,
    /// End after so many seconds of board time, with success
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    /// Start value `persist.N=VALUE`, an integer, 0x… , f:1.5 a float, d:1.5 a double; or a key of the machine file
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// What is connected to the board: motors, switches, probes, encoders; a TOML file
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Folder of the files that programs open on the PC; `cc67-files` if neither this nor the machine file names one
    #[arg(long, value_name = "DIR")]
    files: Option<PathBuf>,
    /// What the world does and when: a file of statements, or statements such as "t=0.5 bit 136=1"
    #[arg(long, alias = "stimulus", value_name = "FILE|TEXT")]
    stim: Vec<String>,
    /// Play an operator: programs that only wait on inputs get the other level of one input after the other
    #[arg(long)]
    assist: bool,
    /// Show the board time in seconds before each console line
    #[arg(long)]
    time: bool,
    /// Keep pace with the clock; what happens is the same
    #[arg(long)]
    realtime: bool,
    /// Show all of it as JSON on stdout, an object a line; the last one sums it up
    #[arg(long, conflicts_with = "time")]
    json: bool,
    /// Show every remark of the board, also on what is probably as intended: unknown FPGA registers
    #[arg(long)]
    verbose: bool,
    /// Simulate every tick and every wait; the results are the same
    #[arg(long)]
    no_shortcuts: bool,
    /// Show where board time went; with =FILE.svg also draw it as a flame graph
    #[arg(long, value_name = "FILE.svg", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    profile: Option<String>,
    /// What executes the programs
    #[arg(long, value_enum, default_value_t)]
    engine: EngineName,
    #[command(flatten)]
    uart: UartOptions,
    #[command(flatten)]
    trace: trace::TraceOptions,
    #[command(flatten)]
    pc: PcOptions,
    #[command(flatten)]
    compiler: CompilerOptions,
}

/// Engines by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum EngineName {
    /// The interpreter
    Bytecode,
    /// Machine code of the host
    Native,
}

impl Default for EngineName {
    /// The fastest that this command is built with.
    fn default() -> Self {
        if cfg!(feature = "native") { Self::Native } else { Self::Bytecode }
    }
}

impl EngineName {
    /// Those that this command is built with.
    pub(super) fn available() -> Vec<Self> {
        let mut engines = vec![Self::Bytecode];
        if cfg!(feature = "native") {
            engines.push(Self::Native);
        }
        engines
    }

    /// The name that `--engine` takes.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Bytecode => "bytecode",
            Self::Native => "native",
        }
    }
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds >= 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("not a number of seconds".to_owned()),
    }
}

/// Compiles, loads and runs the programs.
pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    run_with(arguments, None)
}

/// The same, where the image of the first program may be at hand already.
pub(super) fn run_with(arguments: &Arguments, first: Option<&[u8]>) -> Result<Exit> {
    let mut all = arguments.programs.clone();
    all.extend_from_slice(&arguments.load);
    let programs = assign(&all)?;
    let mut machine_file = machine_file(arguments.machine.as_deref())?;
    let settings = [setting::all(&arguments.set, &mut machine_file)?, arguments.pc.mcode()?].concat();
    let (answers, flash_file) =
        (arguments.pc.answers(&machine_file)?, arguments.pc.flash_file(&machine_file));
    let flash = pc::flash(flash_file.as_deref())?;
    let stimulus = stimulus::read(&arguments.stim)?;
    let uart = arguments.uart.or_those_of(&machine_file);
    let offered = stimulus::programs(&[&machine_file.stimulus, &stimulus]);
    let all = [programs.clone(), offered].concat();
    let rest = &all[usize::from(first.is_some())..];
    let Some(rest) = images(rest, &arguments.compiler)? else { return Ok(Exit::Failure) };
    let images: Vec<_> = first.map(<[u8]>::to_vec).into_iter().chain(rest).collect();
    let watched: Vec<_> = all.iter().zip(&images).map(|(program, image)| program.watched(image)).collect();
    let trace = arguments.trace.request(&watched, &arguments.compiler.resolve()?)?;

    let files = pc::files(arguments.files.as_deref(), &machine_file);
    let machine = MachineConfig { shortcuts: !arguments.no_shortcuts, ..MachineConfig::default() };
    let session = Session {
        arguments,
        programs: all,
        loaded: programs.len(),
        images,
        settings,
        stimulus,
        trace,
        uart,
        flash_file,
    };
    let config = Config { machine, files, machine_file, answers, flash, ..Config::default() };
    if let Some(target) = &arguments.profile {
        return session.profile(config, &profile::target(target)?);
    }
    match arguments.engine {
        EngineName::Bytecode => Ok(session.run::<BytecodeEngine>(config)?.0),
        #[cfg(feature = "native")]
        EngineName::Native => Ok(session.run::<vm::native::NativeEngine>(config)?.0),
        #[cfg(not(feature = "native"))]
        EngineName::Native => anyhow::bail!("this cc67 is built without the native engine"),
    }
}

/// Reads what is connected to the board.
pub(super) fn machine_file(path: Option<&Path>) -> Result<MachineFile> {
    let Some(path) = path else { return Ok(MachineFile::default()) };
    let bytes = read(path)?;
    let Ok(text) = String::from_utf8(bytes) else { anyhow::bail!("{} is not text", path.display()) };
    let mut machine = MachineFile::parse(&text)
        .map_err(|error| anyhow::anyhow!("{}:{}:{}: {error}", path.display(), error.line, error.column))?;
    machine.beside(path.parent().unwrap_or(Path::new("")));
    Ok(machine)
}

/// Everything a run needs, whatever engine executes it.
struct Session<'a> {
    arguments: &'a Arguments,
    /// Those to load, and behind them those that a stimulus may load.
    programs: Vec<Program>,
    loaded: usize,
    images: Vec<Vec<u8>>,
    settings: Vec<Setting>,
    stimulus: Stimulus,
    trace: Option<Request>,
    uart: UartOptions,
    flash_file: Option<PathBuf>,
}

impl Session<'_> {
    /// Runs with an account of the time, which is shown at the end.
    fn profile(&self, config: Config, target: &profile::Target) -> Result<Exit> {
        let (exit, board) = self.run::<ProfilingEngine>(config)?;
        terminal::aside(&profile::report(&board, target)?);
        Ok(exit)
    }

    /// Loads, starts and executes; yields the board as it is at the end.
    fn run<E: Engine>(&self, config: Config) -> Result<(Exit, Board<E>)> {
        let flash = config.flash.clone();
        let mut board: Board<E> = Board::new(config);
        let mut offered = Vec::new();
        for (index, (program, image)) in self.programs.iter().zip(&self.images).enumerate() {
            let explain = |error| explain(program, image, error);
            if index < self.loaded {
                board.load(program.thread, image).map_err(explain)?;
            } else {
                let name = program.name().to_string();
                let debug = board.offer(program.thread, &name, image.clone()).map_err(explain)?;
                offered.push((program.thread, name, debug));
            }
        }
        for Setting { address, bytes } in &self.settings {
            board
                .memory_mut()
                .poke_bytes(*address, bytes)
                .with_context(|| format!("`--set` of {address}"))?;
        }
        if !self.stimulus.is_empty() {
            board.play(self.stimulus.clone());
        }
        for program in self.programs.iter().take(self.arguments.programs.len()) {
            board.start(program.thread).with_context(|| program.name().to_string())?;
        }
        if self.arguments.assist {
            board.assist();
        }
        if let Some(request) = &self.trace {
            board.record(request.clone());
        }
        let exit = self.execute(&mut board, offered)?;
        pc::keep_flash(self.flash_file.as_deref(), flash.as_deref(), board.flash())?;
        Ok((exit, board))
    }

    /// Runs the board and prints what happens.
    fn execute<E: Engine>(&self, board: &mut Board<E>, offered: Vec<Offered>) -> Result<Exit> {
        let arguments = self.arguments;
        let limit = Ticks::new((arguments.limit.unwrap_or(DEFAULT_LIMIT) / TIMEBASE).round() as u64);
        let style = Style {
            time: arguments.time,
            is_verbose: arguments.verbose,
            is_live: arguments.realtime,
            json: arguments.json,
        };
        let known = ThreadId::all().filter_map(|thread| Some((thread, board.debug(thread).cloned()?)));
        let mut screen = Screen::new(BufWriter::new(io::stdout().lock()), style, known.collect(), offered);
        let (mut trapped, mut unmet) = (false, false);
        let mut trace = self.trace.as_ref().map(|request| arguments.trace.begin(request)).transpose()?;
        let mut line = self.uart.connect(board)?;
        let pace = arguments.realtime.then(|| Pace::new(board.tick()));
        let end = line.run(board, limit, pace.as_ref(), &mut |event| {
            if let Some(trace) = &mut trace {
                trace.note(&event);
            }
            trapped |= matches!(event.kind, EventKind::Trap(_));
            unmet |= matches!(event.kind, EventKind::Unmet(_));
            screen.show(&event);
        })?;
        let (exit, why) = match end {
            _ if trapped => (Exit::Trapped, "trapped"),
            _ if unmet => (Exit::Unmet, "unmet"),
            RunEnd::Limit if arguments.limit.is_none() => (Exit::StillRunning, "still running"),
            RunEnd::Limit => (Exit::Success, "limit"),
            RunEnd::AllEnded => (Exit::Success, "ended"),
        };
        let is_active = |thread: &ThreadId| board.thread(*thread).is_active();
        let active: Vec<u8> = ThreadId::all().filter(is_active).map(ThreadId::get).collect();
        screen.end(exit, why, board.tick(), &active);
        if screen.finish().map_err(|error| output::lost_output(&error))? == Reader::Gone {
            return Ok(Exit::Success);
        }
        if let Some(trace) = trace {
            let title = arguments.programs.join(OsStr::new(", "));
            arguments.trace.finish(trace, board.tick(), &title.to_string_lossy())?;
        }
        if exit == Exit::StillRunning {
            terminal::note(&still_running(&active, &board.moving()));
        }
        Ok(exit)
    }
}

/// Why a run has not ended by the usual limit, and what can be done.
fn still_running(active: &[u8], moving: &[AxisId]) -> String {
    let after = format!("after {DEFAULT_LIMIT} s of board time");
    let (Some(first), []) = (moving.first(), active) else {
        return format!("still running {after}; `--for SECONDS` sets the limit");
    };
    let numbers = moving.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let (axes, verb) = if moving.len() == 1 { ("axis", "moves") } else { ("axes", "move") };
    format!(
        "the programs have ended, but {axes} {numbers} still {verb} {after}: what `Jog` begins, `Jog({first}, 0)` or \
         `DisableAxis({first})` ends; `--for SECONDS` ends the run at a time of your choice, with exit code 0"
    )
}

/// The image of every program; `None` if a source has errors, after all have been compiled.
pub(super) fn images(programs: &[Program], compiler: &CompilerOptions) -> Result<Option<Vec<Vec<u8>>>> {
    let options = compiler.resolve()?;
    options.firmware.check_version().context("`--firmware`")?;
    let levels = compiler.levels()?;
    let format = compiler.format();
    let mut images = Vec::new();
    let mut has_errors = false;
    for program in programs {
        let bytes = read(&program.path)?;
        if program.is_image() {
            images.push(bytes);
            continue;
        }
        match build(program, bytes, &options, &levels, format)? {
            Some(image) => images.push(image),
            None => has_errors = true,
        }
    }
    Ok((!has_errors).then_some(images))
}

/// Reads a whole file; a message names it.
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    files::read(path).map_err(|error| cannot_read(path, &error))
}

/// The message about a file that cannot be read.
pub(super) fn cannot_read(path: &Path, error: &io::Error) -> anyhow::Error {
    anyhow::anyhow!("cannot read {}: {}", path.display(), reason(error))
}

/// Compiles, links and reports; `None` after errors.
fn build(
    program: &Program,
    text: Vec<u8>,
    options: &Options,
    levels: &Levels,
    format: Format,
) -> Result<Option<Vec<u8>>> {
    let mut compilation = units::unit(&program.path, text, options)?;
    let linked = compilation.link(program.thread, options);
    if terminal::report(&compilation, levels, format) {
        return Ok(None);
    }
    let Some(linked) = linked else { return Ok(None) };
    Ok(Some(image::write(&linked).with_context(|| program.name().to_string())?))
}

/// Why an image is not loaded; of another tool's file, what it is.
pub(super) fn explain(program: &Program, image: &[u8], error: LoadError) -> anyhow::Error {
    match (&error, files::describe(image)) {
        (LoadError::NotAnImage(_), Some(what)) => {
            anyhow::anyhow!("{} is {what}, not an image of `cc67 build`", program.name())
        }
        _ => anyhow::Error::new(error).context(program.name().to_string()),
    }
}
