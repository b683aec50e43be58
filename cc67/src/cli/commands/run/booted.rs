//! `cc67 run --boot FILE`: the programs on the user's own firmware file.

use std::ffi::OsStr;
use std::io::{self, BufWriter};
use std::path::Path;

use anyhow::{Result, bail};
use boot::Halted;
use cc67_host::{End, Ending};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::RunArguments;
use crate::cli::args::time::DEFAULT_LIMIT;
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::Pace;
use crate::cli::io::{interrupt, output, terminal};
use crate::cli::report::profile::{self, ProfileOutput, Sampled};
use crate::cli::report::screen::{Audience, Screen, no_run};
use crate::cli::report::seen::Seen;
use crate::cli::report::trace::Trace;
use crate::cli::session::booted::{Begun, Booted};

/// Compiles the programs for the real processor, starts the firmware, runs them.
pub(super) fn run(arguments: &RunArguments, file: &Path) -> Result<Exit> {
    if let Some(option) = arguments.board.left_out_by_boot() {
        bail!("`{option}` does not work with `--boot`");
    }
    let mut booted = Booted::new(file)?;
    let trace = Some(&arguments.trace);
    let begun = booted.begin(arguments.started(), &arguments.board, &arguments.compiler, trace)?;
    if let Some(begun) = begun {
        let target = arguments.profile.as_deref().map(profile::target).transpose()?;
        return execute(arguments, booted, &begun, target.as_ref());
    }
    if arguments.json {
        output::print(&no_run(Exit::Failure, "compile error"))?;
    }
    Ok(Exit::Failure)
}

/// Runs the board and shows what happens.
fn execute(
    arguments: &RunArguments,
    mut booted: Booted,
    begun: &Begun,
    profiled: Option<&ProfileOutput>,
) -> Result<Exit> {
    if profiled.is_some() {
        booted.looks.sample(booted.board.cycle());
    }
    let out = BufWriter::new(io::stdout().lock());
    let mut screen = Screen::new(out, arguments.style(), booted.debug(), Vec::new());
    let request = begun.request.as_ref();
    let mut trace = request.map(|request| Trace::begin(&arguments.trace, request)).transpose()?;
    booted.connect()?;
    let mut seen = Seen::default();
    let limit = Ticks::new((arguments.limit.unwrap_or(DEFAULT_LIMIT) / TIMEBASE).round() as u64);
    let pace = arguments.realtime.then(|| Pace::new(booted.tick()));
    let mut sink = |event| {
        if let Some(trace) = &mut trace {
            trace.note(&event);
        }
        seen.note(&event);
        screen.show(&event);
    };
    interrupt::ends(booted.interrupter())?;
    let end = booted.run(limit, pace.as_ref(), &mut sink);
    booted.finish(&mut sink)?;
    let (exit, why) = match &end {
        Ok(end) => seen.exit(*end, arguments.limit.is_some()),
        Err(Halted::Crashed(_)) => (Exit::Trapped, "trapped"),
    };
    let (active, state) = (booted.active(), booted.state());
    screen.end(exit, why, booted.tick(), &active, &Ending::default(), &state);
    if screen.finish().map_err(|error| output::lost_output(&error))? == Audience::Gone {
        return Ok(Exit::Success);
    }
    if let Some(trace) = trace {
        let title = arguments.programs.join(OsStr::new(", "));
        trace.finish(&arguments.trace, booted.tick(), &title.to_string_lossy())?;
    }
    if arguments.state {
        state.lines().iter().for_each(|line| terminal::note(line));
    }
    match end {
        Err(Halted::Crashed(crash)) => terminal::note(crash.to_string().trim_end()),
        Ok(End::Limit) if exit == Exit::StillRunning => terminal::note(&super::still_running(&active, &[])),
        Ok(_) => {}
    }
    if let Some((samples, target)) = booted.looks.samples.as_ref().zip(profiled) {
        let of = Sampled { programs: booted.programs(), file: booted.board.file(), end: booted.now() };
        terminal::aside(&of.report(samples.seen(), target)?);
    }
    Ok(exit)
}
