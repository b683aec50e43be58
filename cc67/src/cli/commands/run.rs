//! `cc67 run`: compile, load, execute, print the console.

pub(crate) mod schedules;

use std::ffi::{OsStr, OsString};
use std::io::{self, BufWriter};

use anyhow::Result;
use cc67_host::{End, EndReport, Session, Target};
use clap::Args;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{AxisId, ThreadId, Ticks};
use vm::profile::ProfilingEngine;

use crate::cli::args::board::{BoardArguments, RunForm};
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::sidecars::SidecarArguments;
use crate::cli::args::time::{DEFAULT_LIMIT, seconds};
use crate::cli::args::trace::TraceArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::Pace;
use crate::cli::io::{interrupt, output, terminal};
use crate::cli::report::profile::{self, SampledBoard};
use crate::cli::report::screen::{Audience, Screen, Style, no_run};
use crate::cli::report::seen::Failures;
use crate::cli::report::state::FinalState;
use crate::cli::report::trace::{self, Trace};
use crate::cli::session::{BoardSession, Setup, StartPlan, Work, controller, run_with_boxes};
use schedules::ExploreArguments;

/// Arguments of `cc67 run`.
#[derive(Debug, Args)]
pub(super) struct RunArguments {
    /// Sources or images: FILE runs in the lowest free thread, N:FILE in thread N
    #[arg(required_unless_present_any = ["explain", "flash"], value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Stop after SECONDS of board time and exit 0
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    /// Show the board time in seconds before each console line
    #[arg(long)]
    time: bool,
    /// Run in real time; the results are the same
    #[arg(long)]
    realtime: bool,
    /// Print everything as JSON on stdout, one object per line; the last one is a summary
    #[arg(long, conflicts_with = "time")]
    json: bool,
    /// Show the final state of the board: axes, bits, elements of persist
    #[arg(long)]
    state: bool,
    /// Show all remarks, also on probably intended actions such as writes to unknown FPGA registers
    #[arg(long)]
    verbose: bool,
    /// Show where board time went; with =FILE.svg also draw it as a flame graph
    #[arg(long, value_name = "FILE.svg", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    profile: Option<String>,
    #[command(flatten)]
    sidecars: SidecarArguments,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    trace: TraceArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
    #[command(flatten)]
    explore: ExploreArguments,
}

/// Compiles, loads and runs the programs.
pub(super) fn run(arguments: &RunArguments) -> Result<Exit> {
    if arguments.explore.is_requested() {
        let make = || Setup::new(arguments.start_plan(), &arguments.board, &arguments.compiler);
        return arguments.explore.explore(arguments.ticks(), arguments.limit.is_some(), make);
    }
    let setup = Setup::new(arguments.start_plan(), &arguments.board, &arguments.compiler)?;
    match setup {
        Some(setup) => run_setup(arguments, setup),
        None => {
            if arguments.json {
                output::print(&no_run(Exit::Failure, "compile error"))?;
            }
            Ok(Exit::Failure)
        }
    }
}

fn run_setup(arguments: &RunArguments, setup: Setup) -> Result<Exit> {
    let is_connected = arguments.board.controller.on.is_some();
    for (option, is_given) in [("--profile", arguments.profile.is_some()), ("--state", arguments.state)] {
        anyhow::ensure!(!(is_connected && is_given), "`{option}` does not work with `--on` yet");
    }
    match &arguments.profile {
        Some(target) => run_profiled(arguments, setup, target),
        None if arguments.trace.is_unwritten() => setup.on_its_target(arguments),
        None => setup.recorded().on_its_target(arguments),
    }
}

fn run_profiled(arguments: &RunArguments, setup: Setup, target: &str) -> Result<Exit> {
    anyhow::ensure!(
        arguments.board.form() == RunForm::Fast,
        "`--profile` accounts for whole statements, which `--as board` splits: leave one out"
    );
    let target = profile::target(target)?;
    let (exit, report) = match setup.firmware() {
        Some(firmware) => {
            let mut board = setup.firmware_session(&firmware)?;
            board.session.sample_processor();
            let exit = arguments.execute(&mut board)?;
            (exit, SampledBoard::of(&board.session).report(&target)?)
        }
        None => {
            let mut board = setup.modelled_session(ProfilingEngine::default())?;
            let exit = arguments.execute(&mut board)?;
            (exit, profile::report(board.session.target(), &target)?)
        }
    };
    terminal::print_separated(&report);
    Ok(exit)
}

impl Work for &RunArguments {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        self.execute(&mut board)
    }
}

impl RunArguments {
    /// The programs, if the files next to them should be used.
    pub(super) fn with_sidecars(&self) -> Option<&[OsString]> {
        (!self.sidecars.no_sidecar && self.board.controller.on.is_none()).then_some(&self.programs)
    }

    /// The programs and the order in which they start.
    fn start_plan(&self) -> StartPlan<'_> {
        StartPlan { programs: &self.programs, first: &self.sidecars.first }
    }

    /// The limit of the run.
    fn ticks(&self) -> Ticks {
        // On a controller, a program has no default limit; the user ends it.
        let usual = if self.board.controller.on.is_some() { f64::INFINITY } else { DEFAULT_LIMIT };
        Ticks::new((self.limit.unwrap_or(usual) / TIMEBASE).round() as u64)
    }

    /// Runs the board and shows the events.
    fn execute<T: Target>(&self, board: &mut BoardSession<T>) -> Result<Exit> {
        let request = trace::request(&self.trace, &board.session)?;
        let (programs, offered) = (board.session.debug(), board.session.offered());
        let mut screen = Screen::new(BufWriter::new(io::stdout().lock()), self.style(), programs, offered);
        if let Some(request) = &request {
            board.session.record(request.clone());
        }
        let is_connected = self.board.controller.on.is_some();
        let begin = |request| Trace::begin(&self.trace, request, is_connected);
        let mut trace = request.as_ref().map(begin).transpose()?;
        board.connect()?;
        let mut seen = Failures::default();
        let limit = self.ticks();
        let pace = self.realtime.then(|| Pace::new(board.session.tick()));
        let mut sink = |event| {
            if let Some(trace) = &mut trace {
                trace.note(&event);
            }
            seen.note(&event);
            screen.show(&event);
        };
        interrupt::end_on_interrupt(board.session.interrupter())?;
        let end = match is_connected {
            true => run_with_boxes(board, limit, &mut sink)?,
            false => board.run(limit, pace.as_ref(), &mut sink),
        };
        if is_connected && end == End::Interrupted {
            controller::stop(&mut board.session, &mut sink);
        }
        board.finish(&mut sink)?;
        let (session, ending) = (&board.session, board.session.ending());
        let (exit, why) = seen.exit(end, self.limit.is_some());
        let active = active(session);
        // The 2,000 bits are read only if the result is shown.
        let state = if (self.json || self.state) && !is_connected {
            FinalState::of(session)
        } else {
            FinalState::default()
        };
        screen.end(exit, why, session.tick(), &active, &ending, &state);
        if screen.finish().map_err(|error| output::lost_output(&error))? == Audience::Gone {
            return Ok(Exit::Success);
        }
        if let Some(mut trace) = trace {
            trace.know_board(session);
            let title = self.programs.join(OsStr::new(", "));
            trace.finish(&self.trace, session.tick(), &title.to_string_lossy())?;
        }
        if self.state {
            state.lines().iter().for_each(|line| terminal::note(line));
        }
        self.say_what_was_not_split(session);
        if let Some(why) = session.target().loss_reason() {
            anyhow::bail!("{why}");
        }
        if let Some(how) = how_it_ended(exit, session, &ending) {
            terminal::note(&how);
        }
        Ok(exit)
    }

    /// Reports after a run of several threads in fast mode that their statements were not split.
    fn say_what_was_not_split<T: Target>(&self, session: &Session<T>) {
        if self.board.form() != RunForm::Fast || self.board.races {
            return;
        }
        let ran = session.target().threads_that_ran().len();
        let who = match session.target().contended_cell() {
            Some((one, other, cell)) => {
                format!("threads {one} and {other} both change {cell} by a load and a store")
            }
            // Programs that share nothing behave the same on the board.
            None if self.state && ran > 1 => format!("{ran} threads ran"),
            None => return,
        };
        // The message concerns the run; it is not a remark of the board.
        terminal::print_separated(&format!(
            "note: {who}. Statements were not split; `--as board` splits them as the board does, `--races` names the \
             lines that can go wrong\n"
        ));
    }

    /// Returns the style for showing the run.
    fn style(&self) -> Style {
        // The console of a controller is shown without delay.
        let is_live = self.realtime || self.board.controller.on.is_some();
        Style { time: self.time, is_verbose: self.verbose, is_live, json: self.json }
    }
}

/// The numbers of the active threads.
fn active<T: Target>(session: &Session<T>) -> Vec<u8> {
    let is_active = |thread: &ThreadId| session.thread(*thread).is_active();
    ThreadId::all().filter(is_active).map(ThreadId::get).collect()
}

/// Describes the end of an incomplete run: the threads that are still active and the events for which they wait.
fn how_it_ended<T: Target>(exit: Exit, session: &Session<T>, ending: &EndReport) -> Option<String> {
    let moving = session.target().moving();
    let is_over = ending.has_all_ended() && moving.is_empty();
    let head = match exit {
        Exit::StillRunning => still_running(&active(session), &moving),
        Exit::Interrupted => format!("interrupted after {:.3} s of board time", seconds_of(session)),
        _ if is_over => return None,
        _ => format!("at the end, after {:.3} s of board time", seconds_of(session)),
    };
    let lines = ending.to_string();
    let colon = if exit == Exit::StillRunning { "" } else { ":" };
    Some(if lines.is_empty() { head } else { format!("{head}{colon}\n{lines}") })
}

/// The board time.
fn seconds_of<T: Target>(session: &Session<T>) -> f64 {
    session.tick().get() as f64 * TIMEBASE
}

/// Explains that a run has not ended by the default limit, and the remedies.
fn still_running(active: &[u8], moving: &[AxisId]) -> String {
    let after = format!("after {DEFAULT_LIMIT} s of board time");
    let (Some(first), []) = (moving.first(), active) else {
        return format!("still running {after}; `--for SECONDS` sets the limit");
    };
    let numbers = moving.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let (axes, verb) = if moving.len() == 1 { ("axis", "moves") } else { ("axes", "move") };
    format!(
        "the programs have ended, but {axes} {numbers} still {verb} {after}: `Jog({first}, 0)` or `DisableAxis({first})` \
         ends a motion; `--for SECONDS` ends the run at a time of your choice, with exit code 0"
    )
}
