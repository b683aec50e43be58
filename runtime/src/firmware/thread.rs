//! Starting and stopping threads. Source: threads-and-time.md section 2.

use kmotiondef::ThreadId;
use vm::firmware::{Caller, Outcome};

use crate::commands;
use crate::kernel::Kernel;

/// Starts the program of a thread; the caller's own number has no effect.
pub(crate) fn start_thread(kernel: &mut Kernel, caller: &mut Caller<'_>, thread: i32) {
    match ThreadId::new(thread) {
        // The caller's number needs no start, which would look for a download there.
        Some(id)
            if caller.thread != Some(id) && !commands::start(kernel, caller.memory, caller.threads, id) =>
        {
            kernel.diagnose(caller, format!("StartThread({id}): no program is loaded in thread {id}"));
        }
        Some(_) => {}
        None => invalid(kernel, caller, "StartThread", thread),
    }
}

/// Stops a thread where it is; a thread may name itself.
pub(crate) fn pause_thread(kernel: &mut Kernel, caller: &mut Caller<'_>, thread: i32) -> Outcome<()> {
    match ThreadId::new(thread) {
        Some(id) if caller.thread == Some(id) => return Outcome::Pause,
        Some(id) => caller.threads.pause(id),
        None => invalid(kernel, caller, "PauseThread", thread),
    }
    Outcome::Done(())
}

/// Lets a paused thread continue: 0, or 1 when no program is loaded there.
pub(crate) fn resume_thread(kernel: &mut Kernel, caller: &mut Caller<'_>, thread: i32) -> i32 {
    match ThreadId::new(thread) {
        Some(id) => i32::from(caller.threads.resume(id).is_err()),
        None => {
            invalid(kernel, caller, "ResumeThread", thread);
            1
        }
    }
}

/// Ends the calling thread.
pub(crate) fn thread_done(_: &mut Kernel, _: &mut Caller<'_>) -> Outcome<()> {
    Outcome::End
}

fn invalid(kernel: &mut Kernel, caller: &Caller<'_>, function: &str, thread: i32) {
    kernel.diagnose(caller, format!("{function}({thread}): there are threads 1 to 7"));
}
