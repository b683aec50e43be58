//! Following the processor: to stops, from one call of a program to the next, packet by packet.
//!
//! Following changes neither the execution nor its timing.

use c67x::Control;
use c67x::convention::{ARGUMENTS, LINK, STACK};
use kmotiondef::ThreadId;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT};
use vm::dsp::{Halt, State, packet_text};

use super::{BootedBoard, GIE, HaltError, ProcessorState};
use crate::bus::Hardware;
use crate::external::ExternalHardware;

/// The maximum distance from a call to its return address: six packets.
const LONGEST_CALL: u32 = 6 * 32;

/// The end of a run to a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum RunOutcome {
    /// At the requested cycle.
    Through,
    /// At a stop, whose packet is executed next.
    ToStop,
}

/// An executed packet of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramPacket {
    /// The cycle in which it began, since power-up.
    pub cycle: u64,
    /// Its duration in cycles.
    pub cycles: i64,
    /// Its address.
    pub at: u32,
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// Its instructions, with bars between them.
    pub text: String,
}

/// The position of the processor, and the preceding packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StopPosition {
    /// The next packet.
    pub pc: u32,
    /// The user thread that has the processor, even while it is interrupted.
    pub thread: Option<ThreadId>,
    /// True if interrupts are disabled, as they are during an interrupt, and therefore in the call-back.
    pub is_masked: bool,
    /// The packet of the call, if the last branch, apart from jumps inserted by the linker, was a call.
    pub call: Option<u32>,
    /// B3, which contains the return address at the beginning of a function.
    pub return_address: u32,
    /// The stack pointer.
    pub stack: u32,
}

/// A call of the firmware by a program: the processor is before the first packet of the function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramCall {
    /// The function.
    pub function: u32,
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// The packet of the call.
    pub at: u32,
    /// Its first argument, if it is an integer.
    pub argument: i32,
}

impl<A: ExternalHardware> BootedBoard<A> {
    /// Stops [`run_to_stop`](Self::run_to_stop) before the packets at these addresses, and before no others.
    pub fn set_stops(&mut self, addresses: impl IntoIterator<Item = u32>) {
        self.core.set_stops(addresses);
    }

    /// Runs to the first packet at or after this cycle, or to a stop; a run that begins at a stop executes its packet.
    ///
    /// # Errors
    /// The firmware crashed; the board no longer runs.
    pub fn run_to_stop(&mut self, cycle: u64) -> Result<RunOutcome, HaltError> {
        while self.cycle() < cycle {
            if self.run_events(cycle)? == RunOutcome::ToStop {
                return Ok(RunOutcome::ToStop);
            }
        }
        Ok(RunOutcome::Through)
    }

    /// Returns the position of the processor, and the preceding packets.
    #[must_use]
    pub fn stop_position(&self) -> StopPosition {
        let state = &self.core.state;
        let back = state.reg(LINK);
        let [last, before] = state.branched_at();
        let is_call = |at: &u32| back.wrapping_sub(*at) <= LONGEST_CALL;
        let ProcessorState { pc, thread, is_masked } = self.processor_state();
        StopPosition {
            pc,
            thread: thread.and_then(user_thread),
            is_masked,
            // If the linker inserted a jump, the previous branch was the call.
            call: [before, last].into_iter().find(is_call),
            return_address: back,
            stack: state.reg(STACK),
        }
    }

    /// The firmware call that a program is just making; `None` if the processor is not before the first packet of a
    /// function called by a program.
    #[must_use]
    pub fn program_call(&self) -> Option<ProgramCall> {
        let StopPosition { pc, thread, is_masked, call, .. } = self.stop_position();
        let at = call.filter(|at| is_of_program(*at) && !is_of_program(pc))?;
        let argument = self.core.state.reg(ARGUMENTS[0]).cast_signed();
        Some(ProgramCall { function: pc, thread: thread.filter(|_| !is_masked), at, argument })
    }

    /// Sets whether packets of programs are recorded; those of the firmware itself are never recorded.
    pub fn keep_packets(&mut self, whether: bool) {
        self.packets = whether.then(Vec::new);
    }

    /// The packets executed by programs since the last call, if they are recorded.
    pub fn take_packets(&mut self) -> Vec<ProgramPacket> {
        self.packets.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Executes packets up to the first one at or after this cycle or up to a stop; if the timer's interrupt is
    /// pending, only up to the position where it can be taken.
    pub(super) fn execute_to(&mut self, until: u64) -> Halt {
        let timer_waits = self.core.state.has_timer_flag();
        let Self { core, hardware, packets, file, .. } = self;
        let Some(packets) = packets else {
            return if timer_waits {
                core.run_to_interrupt(hardware, until)
            } else {
                core.run_until(hardware, until)
            };
        };
        let current = file.address("CurrentThread");
        let mut note = |hardware: &Hardware<A>, at: u32, cycles: i64, state: &State| {
            if is_of_program(at) {
                let is_masked = state.control(Control::Csr) & GIE == 0;
                let thread = current.filter(|_| !is_masked);
                packets.push(ProgramPacket {
                    cycle: state.cycle().wrapping_add_signed(-cycles),
                    cycles,
                    at,
                    thread: thread.and_then(|place| user_thread(hardware.memory.peek(place))),
                    text: packet_text(at, |word| hardware.word(word)),
                });
            }
        };
        if timer_waits {
            core.count_to_interrupt(hardware, until, &mut note)
        } else {
            core.count_until(hardware, until, &mut note)
        }
    }
}

/// The user thread for the firmware's number of it.
fn user_thread(number: u32) -> Option<ThreadId> {
    i32::try_from(number).ok().and_then(ThreadId::new)
}

/// Returns whether an address is in the part of memory for which programs are linked.
fn is_of_program(at: u32) -> bool {
    (PROGRAM_BASE..PROGRAM_LIMIT).contains(&at)
}
