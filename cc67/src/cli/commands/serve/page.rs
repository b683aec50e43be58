//! `--live`: the page of a served board.

use anyhow::{Context, Result};
use cc67_host::{Session, Target};
use cc67_live::{LiveView, Server, Show, TimeControl};
use clap::Args;

use super::super::live;
use super::ServeArguments;

/// Options for a page in the browser.
#[derive(Debug, Args)]
pub(super) struct PageArguments {
    /// Also show the board on a page in the browser
    #[arg(long)]
    pub(super) live: bool,
    /// Port of the page; 0 picks a free one [default: 8067, or a free one if that is taken]
    #[arg(long, value_name = "PORT", requires = "live")]
    port: Option<u16>,
    /// Do not open a browser
    #[arg(long, requires = "live")]
    no_open: bool,
}

/// A requested page.
#[derive(Debug)]
pub(in crate::cli::commands) struct PagePlan<'a> {
    arguments: &'a ServeArguments,
    /// Seconds of board time per second; `None` if it passes only in exchanges.
    speed: Option<f64>,
}

impl<'a> PagePlan<'a> {
    /// The page requested by the arguments.
    pub(super) fn wanted(arguments: &'a ServeArguments, speed: Option<f64>) -> Option<Self> {
        arguments.page.live.then_some(Self { arguments, speed })
    }

    /// Opens the page.
    pub(super) fn open<T: Target>(&self, session: &mut Session<T>) -> Result<LiveView<T>> {
        let ServeArguments { programs, board, compiler, trace, page, .. } = self.arguments;
        let show = Show {
            watch: trace.trace_items.clone().unwrap_or_default(),
            speed: self.speed.unwrap_or(1.0),
            time: if self.speed.is_some() { TimeControl::Forward } else { TimeControl::Foreign },
            ..live::show(programs, board, compiler)?
        };
        let server: Server = live::listen(page.port, board)?;
        live::announce(&server, board, !page.no_open).context("--live")?;
        Ok(server.view(session, show))
    }
}
