//! `cc67 run --boot FILE`: the programs on the user's own firmware file.

use cc67_host::Ending;
use std::io::{self, BufWriter};
use std::path::Path;

use anyhow::{Result, bail};
use boot::Halted;
use cc67_host::End;
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::RunArguments;
use crate::cli::args::time::DEFAULT_LIMIT;
use crate::cli::io::exit::Exit;
use crate::cli::io::{output, terminal};
use crate::cli::report::screen::{Audience, Screen};
use crate::cli::report::seen::Seen;
use crate::cli::report::state::FinalState;
use crate::cli::session::booted::Booted;

/// Compiles the programs for the real processor, starts the firmware, runs them.
pub(super) fn run(arguments: &RunArguments, file: &Path) -> Result<Exit> {
    if let Some(option) = left_out(arguments) {
        bail!("`{option}` does not work with `--boot` yet");
    }
    let mut booted = Booted::new(file)?;
    let request = None;
    if !booted.begin(arguments.started(), &arguments.board, &arguments.compiler, request)? {
        return Ok(Exit::Failure);
    }
    let out = BufWriter::new(io::stdout().lock());
    let mut screen = Screen::new(out, arguments.style(), Vec::new(), Vec::new());
    let mut seen = Seen::default();
    let limit = Ticks::new((arguments.limit.unwrap_or(DEFAULT_LIMIT) / TIMEBASE).round() as u64);
    let mut sink = |event| {
        seen.note(&event);
        screen.show(&event);
    };
    let end = booted.run(limit, &mut sink);
    booted.finish(&mut sink);
    let active = booted.active();
    let (exit, why) = match &end {
        Ok(end) => seen.exit(*end, arguments.limit.is_some()),
        Err(Halted::Crashed(_)) => (Exit::Trapped, "trapped"),
    };
    screen.end(exit, why, booted.tick(), &active, &Ending::default(), &FinalState::default());
    if screen.finish().map_err(|error| output::lost_output(&error))? == Audience::Gone {
        return Ok(Exit::Success);
    }
    match end {
        Err(Halted::Crashed(crash)) => terminal::note(crash.to_string().trim_end()),
        Ok(End::Limit) if exit == Exit::StillRunning => terminal::note(&super::still_running(&active, &[])),
        Ok(_) => {}
    }
    Ok(exit)
}

/// The first option given that a booted board does not know.
fn left_out(arguments: &RunArguments) -> Option<&'static str> {
    let RunArguments { realtime, profile, trace, .. } = arguments;
    let own = [(*realtime, "--realtime"), (profile.is_some(), "--profile")];
    let given = own.into_iter().find(|(is_given, _)| *is_given).map(|(_, name)| name);
    given.or_else(|| trace.first_given()).or_else(|| arguments.board.left_out_by_boot())
}
