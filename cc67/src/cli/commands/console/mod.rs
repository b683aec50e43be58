//! `cc67 console`: a simulated board that takes commands, by hand or from a script.
//!
//! A line contains script commands for the board, or begins with one of the console's own words ([`words`]). In
//! interactive use the board keeps pace with the clock; with a script it runs as fast as it can, and time passes only
//! as the script requires: each line takes as long as on the wire, `wait` takes the given time.

mod input;
mod screen;
mod words;

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::io::{self, BufRead, IsTerminal};
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use cc67_host::{End, Target};
use clap::Args;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{Bit, ThreadId, Ticks};
use runtime::Event;

use input::{Input, Lines};
use screen::Screen;
pub(super) use words::ACTIONS;
use words::Word;

use super::serve::ServeTerms;
use crate::cli::args::attach::AttachArguments;
use crate::cli::args::board::BoardArguments;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::program::{ProgramFile, assign};
use crate::cli::args::time::{DEFAULT_LIMIT, seconds};
use crate::cli::args::trace::TraceArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::Pace;
use crate::cli::report::seen::Failures;
use crate::cli::report::trace::{self, Trace};
use crate::cli::session::{BoardSession, Setup, Work};

/// The interval at which the board is run when it keeps pace with the clock.
const BEAT: Duration = Duration::from_millis(10);
/// The number of ticks after which the keyboard is polled again when the board runs at full speed.
const TICKS_PER_POLL: u64 = 1111;

/// Arguments of `cc67 console`.
#[derive(Debug, Args)]
pub(super) struct ConsoleArguments {
    /// Programs to load and start: FILE runs in the lowest free thread, N:FILE in thread N
    #[arg(value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Run in real time; the default at a terminal
    #[arg(long, overrides_with = "fast")]
    realtime: bool,
    /// Run as fast as possible; the default from a script
    #[arg(long, overrides_with = "realtime")]
    fast: bool,
    /// Serve PC programs instead of a person, like `cc67 serve --listen ADDRESS`
    #[arg(long, value_name = "ADDRESS", conflicts_with = "time")]
    serve: Option<String>,
    /// With --serve, let an editor attach its debugger on this port (0: a free one)
    #[arg(long, value_name = "PORT", requires = "serve")]
    debug: Option<u16>,
    /// After the last line, run at most SECONDS more of board time
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    /// Show the board time in seconds before each line from the board
    #[arg(long)]
    time: bool,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    trace: TraceArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
}

/// Runs the console until the input ends.
pub(super) fn console(arguments: &ConsoleArguments) -> Result<Exit> {
    if arguments.serve.is_some() {
        arguments.board.controller.refuse_in("console --serve")?;
    }
    let setup = Setup::new(&arguments.programs, &arguments.board, &arguments.compiler)?;
    let Some(setup) = setup else { return Ok(Exit::Failure) };
    match &arguments.serve {
        Some(address) => {
            let debugger = AttachArguments { debug: arguments.debug }.open()?;
            arguments.terms(address).serve(setup, debugger)
        }
        None if arguments.trace.is_unwritten() => setup.on_its_target(arguments),
        None => setup.recorded().on_its_target(arguments),
    }
}

impl ConsoleArguments {
    /// Returns the terms for serving the board to programs of the PC.
    fn terms(&self, address: &str) -> ServeTerms<'_> {
        ServeTerms {
            addresses: vec![address.to_owned()],
            option: "--serve",
            pace: (!self.fast).then_some(1.0),
            once: false,
            limit: self.limit,
            log: None,
            trace: &self.trace,
            title: self.programs.join(OsStr::new(", ")).to_string_lossy().into_owned(),
            #[cfg(feature = "live")]
            page: None,
        }
    }
}

impl Work for &ConsoleArguments {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        board.connect()?;
        Console::new(self, board)?.run()
    }
}

/// The control flow after a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
enum Flow {
    Continue,
    Leave,
}

/// A board, and the user or script that controls it.
struct Console<'a, T: Target> {
    arguments: &'a ConsoleArguments,
    board: BoardSession<T>,
    shown: EventDestinations<'a>,
    /// Pressed inputs, each with its previous level.
    pressed: BTreeMap<Bit, bool>,
}

impl<'a, T: Target> Console<'a, T> {
    fn new(arguments: &'a ConsoleArguments, board: BoardSession<T>) -> Result<Self> {
        let request = trace::request(&arguments.trace, &board.session)?;
        let mut board = board;
        if let Some(request) = &request {
            board.session.record(request.clone());
        }
        let is_late = arguments.board.controller.on.is_some();
        let begin = |request| Trace::begin(&arguments.trace, request, is_late);
        let trace = request.as_ref().map(begin).transpose()?;
        let is_script = !(io::stdin().is_terminal() && io::stdout().is_terminal());
        let screen = Screen::new(arguments.time, is_script && !arguments.realtime);
        let shown = EventDestinations { screen, failures: Failures::default(), trace, arguments };
        let mut console = Self { arguments, board, shown, pressed: BTreeMap::new() };
        console.know_programs();
        Ok(console)
    }

    /// Informs the screen about the loaded programs.
    fn know_programs(&mut self) {
        self.shown.screen.programs = self.board.session.debug().into_iter().map(|(_, debug)| debug).collect();
    }

    fn run(mut self) -> Result<Exit> {
        if io::stdin().is_terminal() && io::stdout().is_terminal() {
            let (input, printer) = input::keyboard()?;
            self.shown.screen.print_through(printer);
            if self.arguments.fast { self.run_at_full_speed(&input) } else { self.keep_pace(&input) }
        } else if self.arguments.realtime {
            self.keep_pace(&input::script_beside())
        } else {
            self.script()
        }
    }

    /// Executes the lines of a script one after another; then the programs continue to their end.
    fn script(&mut self) -> Result<Exit> {
        for line in io::stdin().lock().split(b'\n') {
            let line = line.context("cannot read the script")?;
            let flow = match str::from_utf8(&line) {
                Ok(text) => self.line(text.trim_end_matches('\r')),
                // Bytes that are not UTF-8 are sent to the board.
                Err(_) => {
                    self.send(&line);
                    Flow::Continue
                }
            };
            if flow == Flow::Leave {
                return self.leave();
            }
            if self.shown.screen.is_closed() {
                return Ok(Exit::Success);
            }
        }
        let is_connected = self.arguments.board.controller.on.is_some();
        let usual = match (is_connected, self.arguments.programs.is_empty()) {
            (false, _) => DEFAULT_LIMIT,
            // Programs on a controller continue without this command; it waits only for those named on the command
            // line.
            (true, true) => 0.0,
            (true, false) => f64::INFINITY,
        };
        let limit = self.after(self.arguments.limit.unwrap_or(usual));
        let shown = &mut self.shown;
        let end = self.board.run(limit, None, &mut |event| shown.note(&event));
        let exit = self.leave()?;
        if end == End::Limit && self.arguments.limit.is_none() && !is_connected && exit == Exit::Success {
            self.shown
                .screen
                .note(&format!("still running {DEFAULT_LIMIT} s of board time after the last line"));
            return Ok(Exit::StillRunning);
        }
        Ok(exit)
    }

    /// Executes lines as they come while the board keeps pace with the clock.
    fn keep_pace(&mut self, input: &Lines) -> Result<Exit> {
        self.board.is_paced();
        let pace = Pace::new(self.board.session.tick());
        let mut interrupted = false;
        loop {
            if self.take(input, input.within(BEAT), &mut interrupted) == Flow::Leave {
                return self.leave();
            }
            // A board that falls behind still leaves time for the keyboard.
            self.advance(pace.due().min(Ticks::new(self.board.session.tick().get() + TICKS_PER_POLL)));
        }
    }

    /// Executes lines as they come; while programs run, the board runs as fast as it can.
    fn run_at_full_speed(&mut self, input: &Lines) -> Result<Exit> {
        let mut interrupted = false;
        loop {
            let next =
                if self.board.session.has_ended() { input.next() } else { input.within(Duration::ZERO) };
            if self.take(input, next, &mut interrupted) == Flow::Leave {
                return self.leave();
            }
            self.advance(Ticks::new(self.board.session.tick().get() + TICKS_PER_POLL));
        }
    }

    /// Ends the console, and shows output that is still held.
    fn leave(&mut self) -> Result<Exit> {
        let shown = &mut self.shown;
        self.board.finish(&mut |event| shown.note(&event))?;
        if let Some(trace) = &mut self.shown.trace {
            trace.know_board(&self.board.session);
        }
        self.shown.finish(self.board.session.tick())?;
        if let Some(why) = self.board.session.target().loss_reason() {
            bail!("{why}");
        }
        Ok(self.shown.failures.exit(End::AllEnded, true).0)
    }

    /// Handles a line, or an interruption: the first one stops the programs, the second one ends the console.
    fn take(&mut self, lines: &Lines, next: Result<Input, RecvTimeoutError>, interrupted: &mut bool) -> Flow {
        let flow = match next {
            Ok(Input::Line(line)) => {
                *interrupted = false;
                self.line(&line)
            }
            Ok(Input::Interrupt) if *interrupted => Flow::Leave,
            Ok(Input::Interrupt) => {
                *interrupted = true;
                self.stop(|_| true);
                self.shown.screen.note("all threads are stopped; Ctrl-C again leaves");
                Flow::Continue
            }
            Err(RecvTimeoutError::Timeout) if self.shown.screen.is_closed() => return Flow::Leave,
            Err(RecvTimeoutError::Timeout) => return Flow::Continue,
            Err(RecvTimeoutError::Disconnected) => Flow::Leave,
        };
        if flow == Flow::Continue {
            lines.ready();
        }
        flow
    }

    /// Executes one line.
    fn line(&mut self, line: &str) -> Flow {
        if self.board.session.target().is_in_command() {
            self.send(line.as_bytes());
            return Flow::Continue;
        }
        let text = line.trim();
        if text.is_empty() || text.starts_with('#') {
            return Flow::Continue;
        }
        match words::parse(text) {
            Some(Ok(Word::Quit)) => return Flow::Leave,
            Some(Ok(word)) => {
                if let Err(error) = self.execute_word(&word) {
                    self.shown.screen.note(&format!("{error:#}"));
                }
            }
            Some(Err(error)) => self.shown.screen.note(&error.to_string()),
            // Trailing blanks are sent to the board, which echoes them in error messages.
            None => self.send(line.trim_start().as_bytes()),
        }
        Flow::Continue
    }

    /// Executes one of the console's own commands.
    fn execute_word(&mut self, word: &Word) -> Result<()> {
        match word {
            Word::Help(name) => self.shown.screen.text(&words::help(name.as_deref())),
            Word::Kill { except } => {
                self.stop(|thread| Some(thread) != *except);
            }
            Word::Load(file) | Word::Run(file) => {
                let starts = usize::from(matches!(word, Word::Run(_)));
                self.load(&assign(std::slice::from_ref(file))?, starts)?;
            }
            Word::Time => {
                let text = format!("{:.6}\n", self.board.session.tick().get() as f64 * TIMEBASE);
                self.shown.screen.text(&text);
            }
            Word::Wait(seconds) => self.advance(self.after(*seconds)),
            Word::Press(bit) => {
                let level = self.board.session.bit(*bit);
                self.pressed.entry(*bit).or_insert(level);
                self.board.session.act(&format!("bit {bit} = {}", u8::from(!level)))?;
            }
            Word::Release(bit) => {
                let level = self.pressed.remove(bit).unwrap_or(false);
                self.board.session.act(&format!("bit {bit} = {}", u8::from(level)))?;
            }
            Word::Act(statement) => self.board.session.act(statement)?,
            Word::Quit => {}
        }
        Ok(())
    }

    /// Compiles and loads programs, and starts the first of them.
    fn load(&mut self, programs: &[ProgramFile], starts: usize) -> Result<()> {
        let loaded = self.board.load(programs, starts, &self.arguments.compiler);
        self.know_programs();
        loaded.map(drop)
    }

    /// Stops threads.
    fn stop(&mut self, is_invoked: impl Fn(ThreadId) -> bool) {
        ThreadId::all()
            .filter(|thread| is_invoked(*thread))
            .for_each(|thread| self.board.session.stop(thread));
    }

    /// Sends a line to the board, and lets the time pass that it takes.
    fn send(&mut self, line: &[u8]) {
        let shown = &mut self.shown;
        self.board.exchange(line, &mut |event| shown.note(&event));
    }

    /// The tick after this many seconds.
    fn after(&self, seconds: f64) -> Ticks {
        self.board.session.tick_after(seconds)
    }

    /// Runs to the end of a tick.
    fn advance(&mut self, limit: Ticks) {
        let shown = &mut self.shown;
        self.board.advance(limit, &mut |event| shown.note(&event));
    }
}

/// The destinations of the board's events.
struct EventDestinations<'a> {
    screen: Screen,
    /// The events that determine the exit code.
    failures: Failures,
    trace: Option<Trace>,
    arguments: &'a ConsoleArguments,
}

impl EventDestinations<'_> {
    /// Shows an event, and records it for the traces and the exit code.
    fn note(&mut self, event: &Event) {
        if let Some(trace) = &mut self.trace {
            trace.note(event);
        }
        self.failures.note(event);
        self.screen.show(event);
    }

    /// Prints the remaining lines, and completes the files.
    fn finish(&mut self, end: Ticks) -> Result<()> {
        self.screen.finish().context("cannot write to standard output")?;
        let Some(trace) = self.trace.take() else { return Ok(()) };
        let title = self.arguments.programs.join(OsStr::new(", "));
        trace.finish(&self.arguments.trace, end, &title.to_string_lossy())
    }
}
