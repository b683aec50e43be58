//! A debugger for a board that runs.

use anyhow::{Context, Result, ensure};
use cc67_debug::dap::AttachPoint;
use clap::Args;

use super::board::BoardArguments;
use crate::cli::io::terminal;

/// Whether editors may attach a debugger.
#[derive(Debug, Args)]
pub(crate) struct AttachArguments {
    /// Let an editor attach its debugger at this port (0: a free one); programs are then interpreted
    #[arg(long, value_name = "PORT")]
    pub(crate) debug: Option<u16>,
}

impl AttachArguments {
    /// Where editors attach, if they may, which is printed.
    pub(crate) fn open(&self, board: &BoardArguments) -> Result<Option<AttachPoint>> {
        let Some(port) = self.debug else { return Ok(None) };
        ensure!(board.boot.is_none(), "`--debug` does not work with `--boot` yet");
        let point =
            AttachPoint::listen(port).with_context(|| format!("`--debug`: cannot listen on port {port}"))?;
        terminal::note(&format!("debugger: an editor can attach at {}", point.address()));
        Ok(Some(point))
    }
}
