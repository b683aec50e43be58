//! A debugger for a running board.

use anyhow::{Context, Result};
use cc67_debug::dap::AttachPoint;
use clap::Args;

use crate::cli::io::terminal;

/// Options for attaching an editor's debugger.
#[derive(Debug, Args)]
pub(crate) struct AttachArguments {
    /// Let an editor attach its debugger on this port (0: a free one); programs are then interpreted
    #[arg(long, value_name = "PORT")]
    pub(crate) debug: Option<u16>,
}

impl AttachArguments {
    /// Opens the port to which editors can attach, if one is requested, and prints it.
    pub(crate) fn open(&self) -> Result<Option<AttachPoint>> {
        let Some(port) = self.debug else { return Ok(None) };
        let point =
            AttachPoint::listen(port).with_context(|| format!("`--debug`: cannot listen on port {port}"))?;
        terminal::note(&format!("debugger: an editor can attach at {}", point.address()));
        Ok(Some(point))
    }
}
