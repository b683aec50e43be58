//! The options of a connected controller.

use anyhow::{Result, ensure};
use cc67_controller::{Address, LoadTerms};
use clap::Args;

use super::heading;

/// The commands that work with a controller, for the messages of the others.
pub(crate) const WORK_WITH_CONTROLLER: &str = "run, console, live, test, debug and compare";

/// The controller that takes the place of the simulated board, and the risks that its user accepts.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = heading::CONTROLLER)]
pub(crate) struct ControllerArguments {
    /// Use a connected controller in place of a simulated board (run, console, live, test, debug, compare): usb[:LOCATION], serial:PATH, server[:PATH|:HOST:PORT],
    /// kogna[:SERIAL], tcp:HOST:PORT; `cc67 boards` lists what is connected
    #[arg(long, value_name = "BOARD")]
    pub(crate) on: Option<Address>,
    /// With --on, load programs even if they were linked for a different firmware; their calls may
    /// then jump anywhere
    #[arg(long, requires = "on")]
    pub(crate) force: bool,
    /// With --on, compare the controller's memory with each program after its load; a small program in a free thread computes its checksum
    #[arg(long, requires = "on")]
    pub(crate) verify: bool,
    /// With --on, connect without asking for confirmation the first time; for scripts
    #[arg(long, requires = "on")]
    pub(crate) yes: bool,
}

impl ControllerArguments {
    /// Returns the terms on which programs are loaded.
    pub(crate) fn terms(&self) -> LoadTerms {
        LoadTerms { is_forced: self.force, verifies: self.verify, ..LoadTerms::default() }
    }

    /// Rejects a controller in a command that has only simulated boards.
    pub(crate) fn refuse_in(&self, command: &str) -> Result<()> {
        ensure!(
            self.on.is_none(),
            "`cc67 {command}` does not work with `--on` yet: {WORK_WITH_CONTROLLER} do"
        );
        Ok(())
    }
}
