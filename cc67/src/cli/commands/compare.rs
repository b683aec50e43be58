//! `cc67 compare`: the modelled firmware and the user's own firmware file, or a connected controller, side by side.
//!
//! Each program runs on both boards from the same initial state, with its machine file, stimulus and options. These are
//! compared: console, replies and actions of the PC line by line, expectations, the board time of each line within a
//! tolerance, `persist.UserData`, the final positions of the axes, and the output pins. Instead of programs, random
//! scenarios can be compared, see [`random`].

mod outcome;
mod random;

use std::ffi::OsString;
use std::fmt::Write as _;

use anyhow::{Context, Result, bail};
use cc67_host::{BootedFirmware, BootedTarget, End, Session, Target};
use clap::{Args, Parser};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Event, EventKind};

use crate::cli::args::board::BoardArguments;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::sidecars::{SidecarArguments, Sidecars};
use crate::cli::args::time::{DEFAULT_LIMIT, seconds};
use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};
use crate::cli::report::numbers::Tolerance;
use crate::cli::session::{BoardSession, Setup, StartPlan, Work, boot, run_with_boxes};
use outcome::Outcome;
use random::RandomArguments;

/// Arguments of `cc67 compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Programs, each run separately on both boards; `1:A+2:B` is one run of two programs
    #[arg(required_unless_present = "random", value_name = "PROGRAM", conflicts_with = "random")]
    programs: Vec<OsString>,
    /// Stop each run after SECONDS of board time
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds, default_value = "10")]
    limit: f64,
    /// Ignore differences of board times up to SECONDS; larger ones are reported, but do not fail
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "0.001")]
    tolerance: f64,
    /// Allow printed numbers to differ by N; times, which have a unit, by --tolerance
    #[arg(long, value_name = "N", default_value = "0.001")]
    numbers: f64,
    /// Allow no difference in printed numbers
    #[arg(long, conflicts_with = "numbers")]
    exact: bool,
    /// Also fail on board times beyond the tolerance
    #[arg(long)]
    strict_times: bool,
    #[command(flatten)]
    random: RandomArguments,
    #[command(flatten)]
    sidecars: SidecarArguments,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
    /// All words of the command line.
    #[arg(skip)]
    pub(super) words: Vec<OsString>,
}

/// The number of ticks within which the firmware's axes come to rest after the end of the model's run.
const REST: u64 = 22;

/// The end of a run that the time limit stopped.
const STILL_RUNNING: &str = "still running";

/// The result of comparing a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Equal,
    Unequal,
    /// The time limit stopped both runs before anything could be compared.
    CutOff,
    /// Its source has errors.
    Broken,
}

/// Compares all programs; exit code 1 if one does not compile, 5 if any differs.
pub(super) fn compare(arguments: &CompareArguments) -> Result<Exit> {
    if arguments.board.boot.is_some() == arguments.board.controller.on.is_some() {
        bail!("`cc67 compare` needs `--boot FILE`, your firmware file, or `--on BOARD`, a controller");
    }
    arguments.refuse()?;
    let other = arguments.board.boot.as_deref().map(boot).transpose()?;
    if arguments.random.is_requested() {
        let Some(firmware) = other else {
            bail!(
                "`--random` does not work with `--on`: it needs a board that can be reset between two scenarios"
            );
        };
        return arguments.random.compare(&firmware);
    }
    let mut table = String::new();
    let mut verdicts = Vec::new();
    for program in &arguments.programs {
        let verdict = arguments.one(program, other.as_ref(), &mut table)?;
        if verdict == Verdict::Broken {
            writeln!(table, "{:40} {:>6} does not compile", program.to_string_lossy(), "-")?;
        }
        verdicts.push(verdict);
    }
    output::print(&format!("{:40} {:>6} {:16} {:>10}\n{table}", "program", "lines", "result", "times, s"))?;
    let count = |verdict| verdicts.iter().filter(|&&found| found == verdict).count();
    let (unequal, cut_off, broken) =
        (count(Verdict::Unequal), count(Verdict::CutOff), count(Verdict::Broken));
    let rows = [
        (unequal, "differ"),
        (cut_off, "are cut off by `--for` before their first line"),
        (broken, "do not compile"),
    ];
    for (number, what) in rows {
        if number > 0 {
            terminal::note(&format!("{number} of {} programs {what}", verdicts.len()));
        }
    }
    Ok(match (broken, unequal, cut_off) {
        (0, 0, 0) => Exit::Success,
        (0, 0, _) => Exit::StillRunning,
        (0, ..) => Exit::Unmet,
        _ => Exit::Failure,
    })
}

fn plural(count: usize) -> String {
    if count == 1 { "1 difference".to_owned() } else { format!("{count} differences") }
}

/// Splits `1:A+2:B` into two programs.
fn split_programs(program: &OsString) -> Result<Vec<OsString>> {
    let text = program.to_str().with_context(|| format!("{} is not text", program.display()))?;
    Ok(text.split('+').map(OsString::from).collect())
}

impl CompareArguments {
    /// Rejects options that one of the boards does not support, and a flash, which would belong to only one of them.
    fn refuse(&self) -> Result<()> {
        if self.board.pc.has_flash() {
            bail!("`--flash` does not work with `cc67 compare`: a flash file belongs to one board");
        }
        if self.board.controller.on.is_some() { Ok(()) } else { self.board.refuse_beside_boot() }
    }

    fn ticks(&self) -> Ticks {
        Ticks::new((self.limit.min(DEFAULT_LIMIT * 1000.0) / TIMEBASE).round() as u64)
    }

    /// The arguments with the files next to a program, and the programs of its run.
    fn of(&self, program: &OsString) -> Result<(Box<Self>, Vec<OsString>)> {
        let mut programs = split_programs(program)?;
        let at = self.words.iter().position(|word| word == "compare").map_or(0, |at| at + 1);
        let (before, given) = self.words.split_at(at);
        let given: Vec<OsString> =
            given.iter().filter(|word| !self.programs.contains(word)).cloned().collect();
        let mut options = Vec::new();
        if !self.sidecars.no_sidecar {
            let sidecars =
                Sidecars::of("compare", &programs, &given, |option| super::is_option_of("compare", option))?;
            options = sidecars.options;
            programs.extend(sidecars.also);
        }
        let words = [before, &options, &given, std::slice::from_ref(program)].concat();
        match super::Arguments::try_parse_from(words)?.command {
            Some(super::Command::Compare(mut own)) => {
                own.board.keeps_files = true;
                own.refuse()?;
                Ok((own.0, programs))
            }
            _ => bail!("the words of this command are not its own"),
        }
    }

    /// The allowed difference of printed numbers.
    fn allowed(&self) -> Option<Tolerance> {
        (!self.exact).then_some(Tolerance { seconds: self.tolerance, number: self.numbers })
    }

    /// Compares one of the programs, and adds its row to the table if it compiles.
    fn one(
        &self,
        program: &OsString,
        booted: Option<&BootedFirmware>,
        table: &mut String,
    ) -> Result<Verdict> {
        let (own, programs) = self.of(program)?;
        let Some(mut model) = own.model(&programs)? else { return Ok(Verdict::Broken) };
        let other = match booted {
            Some(firmware) => own.firmware(&programs, firmware, model.ticks)?,
            None => own.controller(&programs)?,
        };
        let Some(firmware) = other else { return Ok(Verdict::Broken) };
        if booted.is_none() {
            model.without_the_pc();
        }
        let (differences, near) = model.differences(&firmware, own.allowed());
        // Lines of a controller carry the time of their arrival.
        let late = if booted.is_some() { model.latest(&firmware) } else { 0.0 };
        let is_late = self.strict_times && late > self.tolerance;
        let board = if booted.is_some() { "firmware:" } else { "board:   " };
        let name = program.to_string_lossy();
        if let Some(first) = differences.first() {
            output::print(&format!(
                "{name}: {}\n  model:    {}\n  {board} {}\n  see {}\n",
                first.what, first.model, first.firmware, first.page
            ))?;
        }
        if let Some(near) = near.any() {
            output::print(&format!("{name}: {near}\n"))?;
        }
        let is_cut_off = [&model, &firmware].iter().all(|outcome| outcome.end == STILL_RUNNING);
        let is_unseen = is_cut_off && differences.is_empty() && firmware.lines.is_empty();
        let result = match differences.len() {
            0 if is_unseen => "not compared".to_owned(),
            0 if is_cut_off => format!("equal for {} s", self.limit),
            0 => "equal".to_owned(),
            count => plural(count),
        };
        let times = if late > self.tolerance { "  (times beyond the tolerance)" } else { "" };
        let lines = firmware.lines.len();
        writeln!(table, "{name:40} {lines:6} {result:16} {late:10.6}{times}")?;
        if is_unseen {
            return Ok(Verdict::CutOff);
        }
        let is_equal = differences.is_empty() && !is_late;
        Ok(if is_equal { Verdict::Equal } else { Verdict::Unequal })
    }

    fn start_plan<'a>(&'a self, programs: &'a [OsString]) -> StartPlan<'a> {
        StartPlan { programs, first: &self.sidecars.first }
    }

    /// The run on the modelled board; `None` if a source has errors.
    fn model(&self, programs: &[OsString]) -> Result<Option<Outcome>> {
        let setup = Setup::of_model(self.start_plan(programs), &self.board, &self.compiler)?;
        let Some(setup) = setup else { return Ok(None) };
        let mut outcome = Outcome::default();
        setup.on_its_target(Model { limit: self.ticks(), outcome: &mut outcome })?;
        Ok(Some(outcome))
    }

    /// The run on the connected controller; `None` if a source has errors.
    fn controller(&self, programs: &[OsString]) -> Result<Option<Outcome>> {
        let setup = Setup::new(self.start_plan(programs), &self.board, &self.compiler)?;
        let Some(setup) = setup else { return Ok(None) };
        let mut outcome = Outcome::default();
        setup.recorded().on_its_target(OnController { limit: self.ticks(), outcome: &mut outcome })?;
        Ok(Some(outcome))
    }

    /// The run on the firmware; `None` if a source has errors.
    ///
    /// Its axes are inspected in the tick in which the model's run ended, as an axis that nobody stops continues to
    /// move.
    fn firmware(
        &self,
        programs: &[OsString],
        firmware: &BootedFirmware,
        at: Ticks,
    ) -> Result<Option<Outcome>> {
        let setup = Setup::of_firmware(self.start_plan(programs), &self.board, &self.compiler, firmware)?;
        let Some(setup) = setup else { return Ok(None) };
        let mut board = setup.firmware_session(firmware)?;
        let mut outcome = Outcome::default();
        let mut crash = None;
        let mut note = |outcome: &mut Outcome, event: &Event| {
            if let EventKind::Halted(text) = &event.kind {
                crash = Some(text.clone());
            }
            outcome.note(event);
        };
        // The model's run ended before the tick that the firmware has just begun.
        let until = Ticks::new(at.get() + 1).min(self.ticks());
        let axes = |board: &BoardSession<BootedTarget>| board.session.target().axes();
        let mut before = axes(&board);
        while board.session.tick() < until {
            board.session.step_tick(&mut |event| note(&mut outcome, &event));
            before = std::mem::replace(&mut outcome.axes, axes(&board));
        }
        let ticks = self.tolerance / TIMEBASE;
        let step = |(now, before): (&(f64, f64), &(f64, f64))| (now.0 - before.0).abs() * ticks;
        outcome.reach = outcome.axes.iter().zip(&before).map(step).collect();
        let rest = Ticks::new(until.get() + REST).min(self.ticks());
        board.advance(rest, &mut |event| note(&mut outcome, &event));
        let end = board.run(self.ticks(), None, &mut |event| note(&mut outcome, &event));
        outcome.last_axes = axes(&board);
        board.finish(&mut |event| note(&mut outcome, &event))?;
        outcome.end = crash.unwrap_or_else(|| describe_end(&board.session, end).to_owned());
        outcome.look_at_firmware(&board.session);
        Ok(Some(outcome))
    }
}

/// Describes how the programs of a run ended. An axis that still creeps towards its target does not count as running:
/// after `MoveExp` the boards reach the target in different ticks.
fn describe_end<T: Target>(session: &Session<T>, end: End) -> &'static str {
    let is_active = |thread| session.target().thread(thread).is_active();
    match end {
        End::Limit if ThreadId::all().any(is_active) => STILL_RUNNING,
        End::Limit | End::AllEnded | End::Interrupted => "ended",
    }
}

/// Runs the connected controller and records the outcome.
struct OnController<'a> {
    limit: Ticks,
    outcome: &'a mut Outcome,
}

impl Work for OnController<'_> {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        let outcome = self.outcome;
        outcome.look_before(&board.session);
        let mut sink = |event: Event| {
            // Messages of cc67 about its own work do not belong to the program.
            if !matches!(event.kind, EventKind::Host(_)) {
                outcome.note(&event);
            }
        };
        let end = run_with_boxes(&mut board, self.limit, &mut sink)?;
        board.finish(&mut sink)?;
        outcome.end = describe_end(&board.session, end).to_owned();
        outcome.look_at_model(&board);
        if let Some(why) = board.session.target().loss_reason() {
            bail!("{why}");
        }
        Ok(Exit::Success)
    }
}

/// Runs the modelled board and records the outcome.
struct Model<'a> {
    limit: Ticks,
    outcome: &'a mut Outcome,
}

impl Work for Model<'_> {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        let outcome = self.outcome;
        let mut traps = Vec::new();
        let mut sink = |event: Event| {
            if let EventKind::Trap(trap) = &event.kind {
                traps.push(trap.to_string());
            }
            outcome.note(&event);
        };
        let end = board.run(self.limit, None, &mut sink);
        board.finish(&mut |event| {
            if matches!(event.kind, EventKind::Unmet(_)) {
                outcome.note(&event);
            }
        })?;
        outcome.end = match (traps.first(), end) {
            (Some(trap), _) => trap.clone(),
            (None, end) => describe_end(&board.session, end).to_owned(),
        };
        outcome.look_at_model(&board);
        Ok(Exit::Success)
    }
}
