//! Starting and stopping threads. Source: threads-and-time.md section 2.

use kmotiondef::firmware::Function;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{GuestAddr, ThreadId};
use vm::firmware::{Caller, Outcome};
use vm::memory::GuestMemory;
use vm::thread::Threads;

use super::parts::Parts;
use crate::out::{Message, Request};
use crate::views::TypedAccess;

/// The entry point at which a thread is started.
fn entry(memory: &GuestMemory, thread: ThreadId) -> GuestAddr {
    GuestAddr::new(memory.get(PERSIST.field(Persist::ENTRY_POINTS).element(thread.index())))
}

/// Starts a thread at its entry point; the board first checks for a download. `false` if there is no program.
pub(crate) fn start(
    parts: &mut Parts,
    memory: &GuestMemory,
    threads: &mut Threads,
    thread: ThreadId,
) -> bool {
    let (base, entry) = (memory.map().programs.start(thread), entry(memory, thread));
    let is_new = parts.pc.downloads.has(thread) || threads.entry(thread) != entry;
    if is_new && memory.peek::<u32>(base) == 0 {
        return false;
    }
    if is_new {
        threads.set_entry(thread, entry);
        parts.out.ask(Request::Load(thread));
    }
    threads.start(thread).is_ok()
}

/// Stops the board as the released firmware stops here: no thread runs any more, and no command is answered.
fn stop_board(parts: &mut Parts, caller: &mut Caller<'_>, function: Function) {
    parts.out.diagnose(caller, Message::FirmwareStops { command: function.name() });
    ThreadId::all().for_each(|thread| caller.threads.pause(thread));
    parts.out.console.die();
    parts.pc.usb.die();
    parts.pc.uart.die();
}

/// Tells a program that starts a thread again which it has started before and which has not ended. (`--races` watches
/// that itself.)
fn notice_restart(parts: &mut Parts, caller: &Caller<'_>, thread: ThreadId) {
    let bit = 1 << thread.index();
    let was_started = parts.calls.started & bit != 0;
    parts.calls.started |= bit;
    if was_started && parts.races.is_none() && caller.threads.state(thread).is_active() {
        parts.out.diagnose(caller, Message::ThreadRestarted { thread });
    }
}

/// Starts the program of a thread; the caller's own number has no effect.
pub(crate) fn start_thread(parts: &mut Parts, caller: &mut Caller<'_>, thread: i32) -> Outcome<()> {
    if let Some(id) = ThreadId::new(thread).filter(|id| caller.thread != Some(*id)) {
        notice_restart(parts, caller, id);
    }
    match ThreadId::new(thread) {
        // For the caller itself nothing is started, which would check for a download.
        Some(id) if caller.thread != Some(id) && !start(parts, caller.memory, caller.threads, id) => {
            parts.out.diagnose(caller, Message::ThreadEmpty { thread: id });
        }
        Some(id) if caller.thread == Some(id) => {
            parts.out.diagnose(caller, Message::StartsItself { thread: id });
        }
        Some(_) => {}
        None => {
            print_invalid_thread(parts, caller, Function::StartThread, thread);
            stop_board(parts, caller, Function::StartThread);
            return Outcome::End;
        }
    }
    Outcome::Done(())
}

/// Pauses a thread at its current position. A thread that names itself continues to the end of its slice.
pub(crate) fn pause_thread(parts: &mut Parts, caller: &mut Caller<'_>, thread: i32) {
    let Some(id) = ThreadId::new(thread) else {
        return print_invalid_thread(parts, caller, Function::PauseThread, thread);
    };
    if caller.thread == Some(id) {
        parts.out.diagnose(caller, Message::PausesItself { thread: id });
    }
    caller.threads.pause(id);
}

/// Lets a paused thread continue: 0, or 1 if no program is loaded there. A thread that has never run has no position to
/// continue from: the board stops.
pub(crate) fn resume_thread(parts: &mut Parts, caller: &mut Caller<'_>, thread: i32) -> i32 {
    match ThreadId::new(thread) {
        Some(id) if caller.threads.state(id).is_ready() && !caller.threads.has_run(id) => {
            stop_board(parts, caller, Function::ResumeThread);
            0
        }
        Some(id) => i32::from(caller.threads.resume(id).is_err()),
        None => {
            print_invalid_thread(parts, caller, Function::ResumeThread, thread);
            1
        }
    }
}

/// Ends the calling thread.
pub(crate) fn thread_done(_: &mut Parts, _: &mut Caller<'_>) -> Outcome<()> {
    Outcome::End
}

fn print_invalid_thread(parts: &mut Parts, caller: &Caller<'_>, function: Function, thread: i32) {
    parts.out.diagnose(caller, Message::NoSuchThread { function, thread });
}
