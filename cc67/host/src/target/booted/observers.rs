//! Observers of the processor while it runs: a profile, an operator who must know the calls of programs, a debugger.
//!
//! Observers change neither execution nor timing.

use std::collections::{BTreeMap, BTreeSet};

use boot::{BootedBoard, HaltError, ProcessorState, RunOutcome};
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::{CodeAddr, Cycles};
use runtime::surroundings::ProgramCall;

use super::attached::DelayedSurroundings;

/// Cycles between two samples: a prime, so that the samples do not stay in phase with a loop or the tick.
const PERIOD: u64 = 997;

/// The number of samples of each state of the processor.
#[derive(Debug)]
struct Samples {
    /// The cycle of the next sample.
    next: u64,
    seen: BTreeMap<ProcessorState, i64>,
}

/// Observers of the processor.
#[derive(Debug, Default)]
pub(super) struct Observers {
    samples: Option<Samples>,
    /// The functions of the firmware by address, if calls are reported to the surroundings.
    functions: BTreeMap<u32, &'static str>,
    /// The addresses at which a debugger stops.
    stops: BTreeSet<u32>,
}

impl Observers {
    /// From this cycle on, samples the states of the processor.
    pub(super) fn sample(&mut self, now: u64) {
        self.samples = Some(Samples { next: now + PERIOD, seen: BTreeMap::new() });
    }

    /// Returns the sampled states of the processor, each with the time that its samples represent.
    pub(super) fn sampled(&self) -> impl Iterator<Item = (&ProcessorState, Cycles)> {
        let seen = self.samples.iter().flat_map(|samples| &samples.seen);
        seen.map(|(state, count)| (state, Cycles::new(count * PERIOD as i64)))
    }

    /// From now on, reports every call of the firmware by a program to the surroundings.
    pub(super) fn follow_calls(&mut self, board: &mut BootedBoard<DelayedSurroundings>) {
        let address = |name| board.file().address(name).map(|at| (at.get(), name));
        self.functions = FIRMWARE_FUNCTIONS.iter().filter_map(|function| address(function.name)).collect();
        self.arm(board);
    }

    /// Stops runs before these packets, and before no others.
    pub(super) fn set_stops(&mut self, board: &mut BootedBoard<DelayedSurroundings>, stops: BTreeSet<u32>) {
        self.stops = stops;
        self.arm(board);
    }

    /// Gives the board its stops; a board restored from a snapshot has the stops of that time.
    pub(super) fn arm(&self, board: &mut BootedBoard<DelayedSurroundings>) {
        board.set_stops(self.functions.keys().chain(&self.stops).copied());
    }

    /// Runs the board to a cycle, or to a stop of a debugger.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(super) fn run(
        &mut self,
        board: &mut BootedBoard<DelayedSurroundings>,
        end: u64,
    ) -> Result<RunOutcome, HaltError> {
        while let Some(next) = self.samples.as_ref().map(|samples| samples.next).filter(|next| *next < end) {
            if self.run_calls(board, next)? == RunOutcome::ToStop {
                return Ok(RunOutcome::ToStop);
            }
            if let Some(samples) = &mut self.samples {
                *samples.seen.entry(board.processor_state()).or_default() += 1;
                samples.next += PERIOD;
            }
        }
        self.run_calls(board, end)
    }

    fn run_calls(
        &self,
        board: &mut BootedBoard<DelayedSurroundings>,
        end: u64,
    ) -> Result<RunOutcome, HaltError> {
        while board.run_to_stop(end)? == RunOutcome::ToStop {
            self.report_call(board);
            if self.stops.contains(&board.processor_state().pc) {
                return Ok(RunOutcome::ToStop);
            }
        }
        Ok(RunOutcome::Through)
    }

    fn report_call(&self, board: &mut BootedBoard<DelayedSurroundings>) {
        let (call, now) = (board.program_call(), board.cycle());
        let (Some(attached), memory) = board.external_and_memory() else { return };
        if let Some(call) = call
            && let Some(function) = self.functions.get(&call.function)
        {
            let boot::ProgramCall { argument, thread, at, .. } = call;
            let call = ProgramCall { function, argument, thread, at: CodeAddr::new(at) };
            let now = attached.since(now);
            attached.surroundings.note_call(call, memory, now);
        }
    }
}
