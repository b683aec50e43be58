//! `cc67 console`: a simulated board to talk to, by hand or from a script.
//!
//! A line is script commands for the board, or begins with one of the console's own words ([`words`]). By hand the
//! board keeps pace with the clock; from a script it runs as fast as it can, and time passes only where the script
//! lets it: each line takes as long as on the wire, `wait` as long as it says.

mod input;
mod screen;
mod serve;
mod words;

use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

use anyhow::{Context, Result};
use clap::Args;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Config, Event, EventKind, RunEnd};
use vm::engine::Engine;
use vm::interp::BytecodeEngine;

use input::{Input, Lines};
use screen::Screen;
use words::Word;

use super::Exit;
use super::options::CompilerOptions;
use super::pace::Pace;
use super::pc::{self, PcOptions};
use super::program::{Program, assign};
use super::run::{self, DEFAULT_LIMIT, EngineName, TIMEBASE};
use super::setting::{self, Setting};

/// Ticks that a line and its answer take on the wire, as recorded.
const EXCHANGE: u64 = 28;
/// How often a board that keeps pace with the clock is brought up to it.
const BEAT: Duration = Duration::from_millis(10);
/// Ticks that a board which does not keep pace runs before the next look at the keyboard.
const STRETCH: u64 = 1111;

/// Arguments of `cc67 console`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Programs to load and start: FILE for the lowest free thread, N:FILE for thread N
    #[arg(value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Load a program without starting it
    #[arg(long, value_name = "N:FILE")]
    load: Vec<OsString>,
    /// Keep pace with the clock; the default at a terminal
    #[arg(long, overrides_with = "fast")]
    realtime: bool,
    /// Run as fast as possible; the default from a script
    #[arg(long, overrides_with = "realtime")]
    fast: bool,
    /// Serve programs of the PC instead of a person: the socket of the vendor's server, /tmp/kmotionsocket, or tcp:PORT
    #[arg(long, value_name = "ADDRESS", conflicts_with = "time")]
    serve: Option<String>,
    /// Behind the last line, go on for so many seconds of board time at most
    #[arg(long = "for", value_name = "SECONDS", value_parser = run::seconds)]
    limit: Option<f64>,
    /// What is connected to the board: motors, switches, probes, encoders; a TOML file
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Start value `persist.N=VALUE`, an integer, 0x… , f:1.5 a float, d:1.5 a double; or a key of the machine file
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Folder of the files that programs open on the PC; `cc67-files` if neither this nor the machine file names one
    #[arg(long, value_name = "DIR")]
    files: Option<PathBuf>,
    /// Show the board time in seconds before each line of the board
    #[arg(long)]
    time: bool,
    /// What executes the programs
    #[arg(long, value_enum, default_value_t)]
    engine: EngineName,
    #[command(flatten)]
    pc: PcOptions,
    #[command(flatten)]
    compiler: CompilerOptions,
}

/// Talks to a board until the input ends.
pub(super) fn console(arguments: &Arguments) -> Result<Exit> {
    let mut machine_file = run::machine_file(arguments.machine.as_deref())?;
    let settings = [setting::all(&arguments.set, &mut machine_file)?, arguments.pc.mcode()?].concat();
    let answers = arguments.pc.answers(&machine_file)?;
    let flash_file = arguments.pc.flash_file(&machine_file);
    let flash = pc::flash(flash_file.as_deref())?;
    let files = pc::files(arguments.files.as_deref(), &machine_file);
    let config = Config { files, machine_file, answers, flash, ..Config::default() };
    if let Some(address) = &arguments.serve {
        return serve::serve(arguments, config, &settings, flash_file.as_deref(), address);
    }
    match arguments.engine {
        EngineName::Bytecode => Console::<BytecodeEngine>::new(arguments, config, settings, flash_file).run(),
        #[cfg(feature = "native")]
        EngineName::Native => {
            Console::<vm::native::NativeEngine>::new(arguments, config, settings, flash_file).run()
        }
        #[cfg(not(feature = "native"))]
        EngineName::Native => anyhow::bail!("this cc67 is built without the native engine"),
    }
}

/// Whether there is more to come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
enum Flow {
    Continue,
    Leave,
}

/// A board, and the person or script that talks to it.
struct Console<'a, E> {
    arguments: &'a Arguments,
    settings: Vec<Setting>,
    board: Board<E>,
    screen: Screen,
    trapped: bool,
    /// What the file of the flash holds.
    flash: Option<Vec<u8>>,
    flash_file: Option<PathBuf>,
}

impl<'a, E: Engine> Console<'a, E> {
    fn new(
        arguments: &'a Arguments,
        config: Config,
        settings: Vec<Setting>,
        flash_file: Option<PathBuf>,
    ) -> Self {
        let screen = Screen::new(arguments.time);
        let flash = config.flash.clone();
        Self { arguments, settings, board: Board::new(config), screen, trapped: false, flash, flash_file }
    }

    fn run(mut self) -> Result<Exit> {
        for setting in &self.settings {
            let stored = self.board.memory_mut().poke_bytes(setting.address, &setting.bytes);
            stored.with_context(|| format!("`--set` of {}", setting.address))?;
        }
        let mut all = self.arguments.programs.clone();
        all.extend_from_slice(&self.arguments.load);
        if !self.load(&assign(&all)?, self.arguments.programs.len())? {
            return Ok(Exit::Failure);
        }
        if io::stdin().is_terminal() && io::stdout().is_terminal() {
            let (input, printer) = input::keyboard()?;
            self.screen.print_through(printer);
            if self.arguments.fast { self.hurry(&input) } else { self.keep_pace(&input) }
        } else if self.arguments.realtime {
            self.keep_pace(&input::script_beside())
        } else {
            self.script()
        }
    }

    /// Takes the lines of a script one after the other; then the programs go on to their end.
    fn script(&mut self) -> Result<Exit> {
        for line in io::stdin().lines() {
            let line = line.context("cannot read the script")?;
            if self.line(&line) == Flow::Leave {
                return self.leave();
            }
            if self.screen.is_closed() {
                return Ok(Exit::Success);
            }
        }
        let limit = self.after(self.arguments.limit.unwrap_or(DEFAULT_LIMIT));
        let (screen, trapped) = (&mut self.screen, &mut self.trapped);
        let end = self.board.run(limit, &mut |event| note(screen, trapped, &event));
        let exit = self.leave()?;
        if end == RunEnd::Limit && self.arguments.limit.is_none() && exit == Exit::Success {
            self.screen.note(&format!("still running {DEFAULT_LIMIT} s of board time after the last line"));
            return Ok(Exit::StillRunning);
        }
        Ok(exit)
    }

    /// Takes lines as they come while the board keeps pace with the clock.
    fn keep_pace(&mut self, input: &Lines) -> Result<Exit> {
        let pace = Pace::new(self.board.tick());
        let mut interrupted = false;
        loop {
            if self.take(input, input.within(BEAT), &mut interrupted) == Flow::Leave {
                return self.leave();
            }
            self.advance(pace.due());
        }
    }

    /// Takes lines as they come; as long as programs run, so does the board, as fast as it can.
    fn hurry(&mut self, input: &Lines) -> Result<Exit> {
        let mut interrupted = false;
        loop {
            let next = if self.board.has_ended() { input.next() } else { input.within(Duration::ZERO) };
            if self.take(input, next, &mut interrupted) == Flow::Leave {
                return self.leave();
            }
            self.advance(Ticks::new(self.board.tick().get() + STRETCH));
        }
    }

    /// Says good-bye with what is still held.
    fn leave(&mut self) -> Result<Exit> {
        let (screen, trapped) = (&mut self.screen, &mut self.trapped);
        self.board.flush(&mut |event| note(screen, trapped, &event));
        self.screen.finish().context("cannot write to standard output")?;
        pc::keep_flash(self.flash_file.as_deref(), self.flash.as_deref(), self.board.flash())?;
        Ok(if self.trapped { Exit::Trapped } else { Exit::Success })
    }

    /// A line, or an interruption: the first one stops the programs, the second one leaves.
    fn take(&mut self, lines: &Lines, next: Result<Input, RecvTimeoutError>, interrupted: &mut bool) -> Flow {
        let flow = match next {
            Ok(Input::Line(line)) => {
                *interrupted = false;
                self.line(&line)
            }
            Ok(Input::Interrupt) if *interrupted => Flow::Leave,
            Ok(Input::Interrupt) => {
                *interrupted = true;
                self.board.kill(ThreadId::all());
                self.screen.note("all threads are stopped; Ctrl-C once more leaves");
                Flow::Continue
            }
            Err(RecvTimeoutError::Timeout) if self.screen.is_closed() => return Flow::Leave,
            Err(RecvTimeoutError::Timeout) => return Flow::Continue,
            Err(RecvTimeoutError::Disconnected) => Flow::Leave,
        };
        if flow == Flow::Continue {
            lines.ready();
        }
        flow
    }

    /// One line of the person or script.
    fn line(&mut self, line: &str) -> Flow {
        if self.board.is_in_command() {
            self.send(line);
            return Flow::Continue;
        }
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            return Flow::Continue;
        }
        match words::parse(line) {
            Some(Ok(Word::Quit)) => return Flow::Leave,
            Some(Ok(word)) => {
                if let Err(error) = self.obey(&word) {
                    self.screen.note(&format!("{error:#}"));
                }
            }
            Some(Err(error)) => self.screen.note(&error.to_string()),
            None => self.send(line),
        }
        Flow::Continue
    }

    /// Does what one of the console's own words says.
    fn obey(&mut self, word: &Word) -> Result<()> {
        match word {
            Word::Help(name) => self.screen.text(&words::help(name.as_deref())),
            Word::Kill { except } => {
                self.board.kill(ThreadId::all().filter(|thread| Some(*thread) != *except));
            }
            Word::Load(file) | Word::Run(file) => {
                let starts = usize::from(matches!(word, Word::Run(_)));
                self.load(&assign(std::slice::from_ref(file))?, starts)?;
            }
            Word::Time => {
                let text = format!("{:.6}\n", self.board.tick().get() as f64 * TIMEBASE);
                self.screen.text(&text);
            }
            Word::Wait(seconds) => self.advance(self.after(*seconds)),
            Word::Quit => {}
        }
        Ok(())
    }

    /// Compiles and loads programs, and starts the first so many; whether their sources have no errors.
    fn load(&mut self, programs: &[Program], starts: usize) -> Result<bool> {
        let Some(images) = run::images(programs, &self.arguments.compiler)? else { return Ok(false) };
        for (program, image) in programs.iter().zip(&images) {
            let loaded = self.board.load(program.thread, image);
            loaded.map_err(|error| run::explain(program, image, error))?;
        }
        self.screen.programs =
            ThreadId::all().filter_map(|thread| self.board.debug(thread).cloned()).collect();
        for program in programs.iter().take(starts) {
            self.board.start(program.thread).with_context(|| program.name().to_string())?;
        }
        Ok(true)
    }

    /// Sends a line to the board, and lets pass the time it takes.
    fn send(&mut self, line: &str) {
        let is_data = self.board.is_in_command();
        let text: Vec<u8> = line.bytes().filter(|byte| *byte != b'\r').collect();
        self.board.receive(&[b"\x1b\x01", &text[..], b"\r"].concat());
        let begin = self.board.tick().get();
        while self.board.is_receiving() {
            self.advance(self.board.tick().next());
        }
        if !is_data && !self.board.is_in_command() {
            self.advance(Ticks::new(begin + EXCHANGE));
        }
    }

    /// The tick so many seconds from now.
    fn after(&self, seconds: f64) -> Ticks {
        Ticks::new(self.board.tick().get().saturating_add((seconds / TIMEBASE).round() as u64))
    }

    /// Runs to the end of a tick.
    fn advance(&mut self, limit: Ticks) {
        let (screen, trapped) = (&mut self.screen, &mut self.trapped);
        self.board.run_until(limit, &mut |event| {
            note(screen, trapped, &event);
            false
        });
    }
}

/// Shows an event and remembers whether it was a trap.
fn note(screen: &mut Screen, trapped: &mut bool, event: &Event) {
    *trapped |= matches!(event.kind, EventKind::Trap(_));
    screen.show(event);
}
