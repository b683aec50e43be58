//! Output of commands: the screen of a run, diagnostics, traces, plots, profiles.

pub(crate) mod diagnostics;
pub(crate) mod numbers;
pub(crate) mod plot;
pub(crate) mod profile;
mod repeats;
pub(crate) mod screen;
pub(crate) mod seen;
pub(crate) mod state;
pub(crate) mod trace;

pub(crate) use repeats::MOST as SHOWN_REMARKS;
