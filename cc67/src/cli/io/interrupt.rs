//! Ctrl-C: the first ends the run after the tick in progress, so that it is reported like any other; the second ends the
//! process.

use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use cc67_host::Interrupter;

use super::exit::Exit;

/// Lets Ctrl-C set a flag, which the running command takes; again before it is taken, it ends the process.
pub(crate) fn sets(flag: &Arc<AtomicBool>) -> Result<()> {
    let flag = Arc::clone(flag);
    set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            process::exit(Exit::Interrupted as i32);
        }
    })
}

/// Lets Ctrl-C, or a request to terminate, end a run.
pub(crate) fn ends(run: Interrupter) -> Result<()> {
    let was_pressed = AtomicBool::new(false);
    let end = move || match was_pressed.swap(true, Ordering::Relaxed) {
        true => process::exit(Exit::Interrupted as i32),
        false => run.interrupt(),
    };
    set_handler(end)
}

fn set_handler(handler: impl FnMut() + Send + 'static) -> Result<()> {
    match ctrlc::set_handler(handler) {
        // An earlier run of this process has set one.
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        Err(error) => Err(error).context("cannot take Ctrl-C"),
    }
}
