//! Waiting loops: one iteration is executed instruction by instruction, then equal iterations are skipped.

use std::sync::Arc;

use super::code::{Word, Words};
use super::context::Context;
use super::steps::{SingleText, StepState};
use crate::engine::{ContextId, Iteration, Slice, Stop};
use crate::firmware::Firmware;
use crate::polling::PollingLoop;
use crate::program::Program;
use crate::slot::Slot;
use crate::trap::TrapKind;

/// The most instructions of an iteration that is executed one by one, which takes ten times as long.
const MOST: usize = 2000;

/// The loop that ends an iteration with the branch `at`.
fn ended_by(loops: &[PollingLoop], at: usize) -> Option<&PollingLoop> {
    loops.iter().find(|polling| polling.branches.contains(&at))
}

/// Returns to the beginning of the waiting loop whose branch the context has reached, executes an iteration and skips
/// the equal iterations that follow. Returns the reason if the context has stopped.
pub(super) fn wait<F: Firmware + ?Sized>(
    id: ContextId,
    program: &Program,
    words: &Words,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
    steps: &mut StepState,
) -> Result<Option<Stop>, TrapKind> {
    let loops = Arc::clone(&steps.loops);
    let Some(polling) = ended_by(&loops, context.calls.pc) else { return Err(TrapKind::Unreachable) };
    context.calls.pc = polling.first;
    if !slice.polling.is_on() {
        return Ok(None);
    }
    let mut text = std::mem::take(&mut steps.waiting);
    let stop = WaitingContext { id, program, words, loops: &loops }.execute(context, slice, steps, &mut text);
    steps.waiting = text;
    stop
}

/// A context that executes iterations of waiting loops one by one.
struct WaitingContext<'a> {
    id: ContextId,
    program: &'a Program,
    words: &'a Words,
    loops: &'a [PollingLoop],
}

impl WaitingContext<'_> {
    fn execute<F: Firmware + ?Sized>(
        &self,
        context: &mut Context,
        slice: &mut Slice<'_, F>,
        steps: &mut StepState,
        text: &mut SingleText,
    ) -> Result<Option<Stop>, TrapKind> {
        let depth = context.calls.depth();
        let at_first = |pc| self.loops.iter().find(|polling| polling.first == pc);
        let Some(mut polling) = at_first(context.calls.pc) else { return Ok(None) };
        let (mut start, mut called) = (slice.budget, slice.budget);
        for _ in 0..MOST {
            let at = context.calls.pc;
            if self.words.get(at).is_none_or(Word::is_held) {
                return Ok(None);
            }
            let is_observed = steps.observer.is_some();
            let run = |word: &Words| super::run(self.id, self.program, word, context, slice, steps);
            let stop = text.with_observed((self.program, self.words), at, is_observed, run);
            let stop = stop.unwrap_or(Err(TrapKind::Unreachable))?;
            if stop != Stop::Held {
                return Ok(Some(stop));
            }
            let next = context.calls.pc;
            if context.calls.depth() != depth {
                continue;
            }
            if polling.clock.as_ref().is_some_and(|clock| clock.call == at) {
                called = slice.budget;
            }
            match ended_by(self.loops, at).filter(|ended| ended.first == next) {
                Some(ended) if ended == polling => {
                    let register = |number| f64::from_slot(context.get(number));
                    let clock = polling.clock.as_ref();
                    slice.pass_iterations(&Iteration { start, clock, called, register: &register });
                    return Ok(None);
                }
                // A loop within this one, or around it.
                Some(ended) => (polling, start, called) = (ended, slice.budget, slice.budget),
                None if !polling.words.contains(&next) => return Ok(None),
                None => {}
            }
        }
        Ok(None)
    }
}
