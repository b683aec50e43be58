//! Calls of functions by a debugger that evaluates an expression.
//!
//! The function runs on the stack of the selected context, below its calls, while the board is stopped: no tick passes,
//! and no other thread runs. Stores and firmware calls of the function take effect.

use kmotiondef::{Cycles, GuestAddr};

use super::{Machine, end_of};
use crate::call::CallArguments;
use crate::engine::{CallEnd, CallStack, ContextId, Engine, Polling, Slice};
use crate::firmware::{Caller, Firmware, Outcome};
use crate::loaded::LoadedCode;
use crate::thread::{Progress, ThreadState};
use crate::trap::Trap;

/// The limit of cycles after which a function counts as endless: one second.
const CALL_LIMIT: Cycles = Cycles::PER_SECOND;

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Calls a function of a loaded program or of the firmware with the arguments, each as a slot, in a context.
    ///
    /// The time, the threads and the context are then as before. If the call does not end with [`CallEnd::Returned`],
    /// its changes up to that point remain.
    pub fn call_function(&mut self, id: ContextId, function: GuestAddr, arguments: &[u64]) -> CallEnd {
        let start = self.held().map_or_else(|| end_of(self.tick), |(_, at)| at);
        let whole = id.stack_in(self.memory.map(), self.config.strict_stack);
        let stack = CallStack { whole, is_in_use: self.is_in_progress(id) };
        let mut slice = Slice {
            memory: &mut self.memory,
            threads: &mut self.threads,
            firmware: &mut self.firmware,
            tick: self.tick,
            start,
            length: CALL_LIMIT,
            budget: CALL_LIMIT,
            woken: None,
            is_long: false,
            polling: Polling::OFF,
        };
        let running = slice.threads.running();
        slice.threads.set_running(id.thread());
        let end = match self.loaded.iter().flatten().find(|loaded| loaded.has_function(function)) {
            Some(LoadedCode::Program(program)) => {
                self.engines.programs.call(id, program, function, arguments, stack, &mut slice)
            }
            Some(LoadedCode::Image(_)) => CallEnd::Unsupported,
            None => call_firmware(function, arguments, &mut slice),
        };
        self.threads.set_running(running);
        end
    }

    /// Reports whether a context has calls in progress.
    fn is_in_progress(&self, id: ContextId) -> bool {
        match id.thread().map(|thread| self.threads.state(thread)) {
            Some(ThreadState::Active(progress) | ThreadState::Paused(progress)) => {
                !matches!(progress, Progress::Fresh | Progress::Idle)
            }
            Some(ThreadState::Faulted(_)) => true,
            Some(ThreadState::Empty | ThreadState::Ready) => false,
            None => self.held().is_some_and(|(held, _)| held == id),
        }
    }
}

/// Calls a function of the firmware, not on behalf of any thread, so that no thread waits for it.
fn call_firmware<F: Firmware + ?Sized>(
    function: GuestAddr,
    arguments: &[u64],
    slice: &mut Slice<'_, F>,
) -> CallEnd {
    let known = slice.firmware.signature(function).is_some_and(|known| known.params.len() == arguments.len());
    if !known {
        return CallEnd::NoFunction;
    }
    let mut caller = Caller {
        thread: None,
        memory: slice.memory,
        threads: slice.threads,
        tick: slice.tick,
        slice_start: slice.start,
        slice: slice.length,
        budget: &mut slice.budget,
        woken: None,
        arguments: CallArguments::from_slots(arguments),
        at: None,
    };
    match slice.firmware.call(function, &mut caller) {
        Ok(Outcome::Done(value)) => CallEnd::Returned(value.into_slot()),
        Ok(Outcome::Wait(_)) => CallEnd::Waits(super::code_at(function)),
        Ok(Outcome::End) => CallEnd::EndsThread,
        Err(kind) => CallEnd::Trapped(Trap::new(kind, super::code_at(function), None)),
    }
}
