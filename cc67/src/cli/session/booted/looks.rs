//! Who looks at the processor of a booted board while it runs: a profile, an operator who must know what programs do.
//!
//! What is executed, and when, is the same whoever looks.

use std::collections::{BTreeMap, BTreeSet};

use boot::{BootedBoard, Halted, Ran};
use kmotiondef::CodeAddr;
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use runtime::surroundings::ProgramCall;

use super::samples::Samples;
use crate::cli::session::around::Attached;

/// Who looks at the processor.
#[derive(Debug, Default)]
pub(crate) struct Looks {
    /// What a profile is made of, where one is wanted.
    pub(crate) samples: Option<Samples>,
    /// The functions of the firmware by address, where its calls are followed.
    functions: BTreeMap<u32, &'static str>,
    /// Where a debugger stops.
    stops: BTreeSet<u32>,
}

impl Looks {
    /// Looks what the processor does, from this cycle on.
    pub(crate) fn sample(&mut self, now: u64) {
        self.samples = Some(Samples::new(now));
    }

    /// Tells what is around the board every call of the firmware by a program, from now on.
    pub(super) fn follow_calls(&mut self, board: &mut BootedBoard) {
        let address = |name| board.file().address(name).map(|at| (at.get(), name));
        self.functions = FIRMWARE_FUNCTIONS.iter().filter_map(|function| address(function.name)).collect();
        self.hold(board);
    }

    /// Stops runs before these packets, and before no others.
    pub(crate) fn set_stops(&mut self, board: &mut BootedBoard, stops: impl IntoIterator<Item = u32>) {
        self.stops = stops.into_iter().collect();
        self.hold(board);
    }

    /// The stops of a board that has gone back to a snapshot are those of before.
    pub(crate) fn hold(&self, board: &mut BootedBoard) {
        board.set_stops(self.functions.keys().chain(&self.stops).copied());
    }

    /// Runs the board to a cycle, or to a stop.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(super) fn run(&mut self, board: &mut BootedBoard, end: u64) -> Result<Ran, Halted> {
        while let Some(next) = self.samples.as_ref().map(|samples| samples.next).filter(|next| *next < end) {
            if self.run_calls(board, next)? == Ran::ToStop {
                return Ok(Ran::ToStop);
            }
            if let Some(samples) = &mut self.samples {
                samples.note(board);
            }
        }
        self.run_calls(board, end)
    }

    /// The same; what is around the board hears of the calls that are followed.
    fn run_calls(&self, board: &mut BootedBoard, end: u64) -> Result<Ran, Halted> {
        while board.run_to_stop(end)? == Ran::ToStop {
            self.tell_call(board);
            if self.stops.contains(&board.doing().pc) {
                return Ok(Ran::ToStop);
            }
        }
        Ok(Ran::Through)
    }

    fn tell_call(&self, board: &mut BootedBoard) {
        let (call, now) = (board.program_call(), board.cycle());
        let (around, memory) = board.around_and_memory();
        let attached = around.and_then(|around| around.as_any().downcast_mut::<Attached>());
        if let (Some(attached), Some(call)) = (attached, call)
            && let Some(function) = self.functions.get(&call.function)
        {
            let boot::ProgramCall { argument, thread, at, .. } = call;
            let call = ProgramCall { function, argument, thread, at: CodeAddr::new(at) };
            let now = attached.since(now);
            attached.surroundings.called(call, memory, now);
        }
    }
}
