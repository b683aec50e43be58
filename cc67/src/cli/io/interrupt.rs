//! Ctrl-C: the first one ends the run after the tick in progress, so that it is reported like any other run; the second
//! one ends the process.

use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use cc67_host::Interrupter;

use super::exit::Exit;

/// Makes Ctrl-C set a flag, which the running command takes; a second Ctrl-C before that ends the process.
pub(crate) fn sets(flag: &Arc<AtomicBool>) -> Result<()> {
    let flag = Arc::clone(flag);
    set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            process::exit(Exit::Interrupted as i32);
        }
    })
}

/// Makes Ctrl-C, or a request to terminate, end a run.
pub(crate) fn end_on_interrupt(run: Interrupter) -> Result<()> {
    let was_pressed = AtomicBool::new(false);
    let end = move || match was_pressed.swap(true, Ordering::Relaxed) {
        true => process::exit(Exit::Interrupted as i32),
        false => run.interrupt(),
    };
    set_handler(end)
}

fn set_handler(handler: impl FnMut() + Send + 'static) -> Result<()> {
    match ctrlc::set_handler(handler) {
        // An earlier run of this process has installed a handler.
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        Err(error) => Err(error).context("cannot take Ctrl-C"),
    }
}
