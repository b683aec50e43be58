//! The state of each thread, its source line, and the event for which it waits.

use cc67_host::{Session, Target};
use kmotiondef::{Cycles, ThreadId};
use serde::Serialize;
use vm::machine::BOARD_STACK_USABLE;
use vm::thread::{Progress, ThreadState};
use vm::wake::Wake;

/// A thread, as shown on a page.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ThreadRow {
    thread: u8,
    /// Its state, in one word: `empty`, `ready`, `running`, `waiting`, `paused`, `trapped`.
    state: &'static str,
    /// The event for which it waits.
    waits: String,
    /// The maximum number of bytes of its stack used so far, and the size of the stack.
    stack_used: u32,
    stack_size: u32,
    /// The calls in progress, innermost first.
    stack: Vec<CallRow>,
}

/// A call.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct CallRow {
    function: String,
    file: String,
    line: Option<u32>,
}

/// The maximum number of calls shown for a thread.
const CALLS: usize = 16;

/// All threads.
pub(super) fn rows<T: Target>(session: &Session<T>) -> Vec<ThreadRow> {
    ThreadId::all().map(|thread| row(session, thread)).collect()
}

fn row<T: Target>(session: &Session<T>, thread: ThreadId) -> ThreadRow {
    let (state, waits) = match session.thread(thread) {
        ThreadState::Empty => ("empty", String::new()),
        ThreadState::Ready => ("ready", String::new()),
        ThreadState::Active(Progress::Waiting(wake)) => ("waiting", wait(*wake)),
        ThreadState::Active(Progress::Fresh) => ("running", "its first slice".to_owned()),
        ThreadState::Active(Progress::Going) => ("running", String::new()),
        ThreadState::Active(Progress::Idle) => {
            ("waiting", "nothing: it was resumed after its end".to_owned())
        }
        ThreadState::Paused(_) => ("paused", "another thread to resume it".to_owned()),
        ThreadState::Faulted(trap) => ("trapped", trap.kind.to_string()),
    };
    let places: Vec<_> = match session.thread(thread) {
        ThreadState::Faulted(trap) => vec![trap.at],
        ThreadState::Active(_) | ThreadState::Paused(_) => session.target().backtrace(thread),
        ThreadState::Empty | ThreadState::Ready => Vec::new(),
    };
    let call = |place: &_| {
        let place = session.source(*place)?;
        let (function, file) = (place.function.to_owned(), place.file.to_owned());
        Some(CallRow { function, file, line: place.line })
    };
    let stack = places.iter().take(CALLS).filter_map(call).collect();
    let stack_used = session.target().stack_used(thread).unwrap_or_default();
    ThreadRow { thread: thread.get(), state, waits, stack_used, stack_size: BOARD_STACK_USABLE, stack }
}

/// Describes the event that ends a wait.
fn wait(wake: Wake) -> String {
    match wake {
        Wake::At(at) => format!("{:.3} s", at.get() as f64 / Cycles::PER_SECOND.get() as f64),
        Wake::NextSlice => "its next slice".to_owned(),
        Wake::Retry => "the firmware".to_owned(),
    }
}
