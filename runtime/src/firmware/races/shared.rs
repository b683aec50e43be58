//! Calls of the firmware that concern several threads: locks, words changed atomically, starts, outputs that share a
//! word.

use kmotiondef::firmware::Function;
use kmotiondef::{Cycles, GuestAddr, ThreadId};
use vm::firmware::{Caller, Outcome, Value};

use super::{Actor, SharedThing};
use crate::firmware::parts::Parts;

/// A call that orders accesses, before it is made.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SharedCall {
    Lock(GuestAddr),
    Unlock(GuestAddr),
    TestAndSet(GuestAddr),
    Change(GuestAddr),
    Other,
}

/// Examines a call that is about to be made.
pub(crate) fn examine_call(parts: &mut Parts, function: Function, caller: &Caller<'_>) -> SharedCall {
    let place = || GuestAddr::new(caller.arguments.get(0));
    let (Parts { races: Some(races), out, .. }, Some(actor)) = (parts, actor(caller)) else {
        return SharedCall::Other;
    };
    match function {
        Function::MutexLock => SharedCall::Lock(place()),
        Function::MutexUnlock => SharedCall::Unlock(place()),
        Function::TestAndSet => SharedCall::TestAndSet(place()),
        Function::AtomicSet | Function::AtomicClear => SharedCall::Change(place()),
        Function::StartThread => {
            if let Some(started) = ThreadId::new(caller.arguments.get(0)) {
                races.record_start(actor, started, caller.threads, out);
            }
            SharedCall::Other
        }
        Function::SetBit | Function::ClearBit | Function::SetStateBit => {
            races.record_output_switch(actor, caller.arguments.get(0), out);
            SharedCall::Other
        }
        Function::PauseThread => {
            if actor.thread.is_some() && ThreadId::new(caller.arguments.get(0)) == actor.thread {
                races.pauses(actor, out);
            }
            SharedCall::Other
        }
        Function::ResumeThread => {
            if let Some(resumed) = ThreadId::new(caller.arguments.get(0)) {
                races.record_resume(actor, resumed, out);
            }
            SharedCall::Other
        }
        Function::MoveXYZABC | Function::iOpenBuf | Function::iExecBuf => {
            races.uses(actor, SharedThing::CoordinateSystem, out);
            SharedCall::Other
        }
        Function::SetupGatherAllOnAxis | Function::TriggerGather => {
            races.uses(actor, SharedThing::Gather, out);
            SharedCall::Other
        }
        _ => SharedCall::Other,
    }
}

/// Processes the outcome of a call.
pub(crate) fn after(parts: &mut Parts, call: SharedCall, outcome: &Outcome<Value>, caller: &mut Caller<'_>) {
    let (Parts { races: Some(races), switches, out, .. }, Some(actor)) = (parts, actor(caller)) else {
        return;
    };
    let is_done = matches!(outcome, Outcome::Done(_));
    let is_taken = *outcome == Outcome::Done(Value::I32(0));
    let lock = match call {
        SharedCall::Lock(lock) => Some(lock).filter(|_| is_done),
        SharedCall::TestAndSet(lock) => Some(lock).filter(|_| is_taken),
        SharedCall::Unlock(_) | SharedCall::Change(_) | SharedCall::Other => None,
    };
    if let (Some(switches), Some(lock)) = (switches, lock)
        && switches.after_lock(actor, lock, out)
    {
        // The rest of the slice is used up.
        *caller.budget = (*caller.budget).min(Cycles::default());
    }
    match call {
        SharedCall::Lock(lock) => races.locks(actor, lock, is_done, out),
        SharedCall::Unlock(lock) => races.record_unlock(actor, lock),
        SharedCall::TestAndSet(lock) if is_taken => races.record_lock(actor, lock),
        SharedCall::Change(place) => {
            races.changed_at_once(actor, place, caller.memory.peek(place), out);
        }
        SharedCall::TestAndSet(_) | SharedCall::Other => {}
    }
}

/// Returns the context of a call; `None` if the code address is unknown.
fn actor(caller: &Caller<'_>) -> Option<Actor> {
    Some(Actor { thread: caller.thread, at: caller.at?, now: caller.now() })
}
