//! The processor followed: to stops, from one call of a program to the next, packet by packet.
//!
//! What is executed, and when, is the same as in a run that nobody follows.

use c67x::Control;
use c67x::convention::{ARGUMENTS, LINK, STACK};
use kmotiondef::ThreadId;
use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT};
use vm::dsp::{Halt, State, packet_text};

use super::{BootedBoard, GIE, Halted, ProcessorState};
use crate::bus::Hardware;
use crate::external::ExternalHardware;

/// Bytes from a call to its return address at most: six packets.
const LONGEST_CALL: u32 = 6 * 32;

/// The end of a run to a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Ran {
    /// To the requested cycle.
    Through,
    /// To one of the stops, which is executed next.
    ToStop,
}

/// A packet of a program that was executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramPacket {
    /// The cycle in which it began, since power-up.
    pub cycle: u64,
    /// Cycles that it took.
    pub cycles: i64,
    /// Its address.
    pub at: u32,
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// Its instructions, bars between them.
    pub text: String,
}

/// The position of the processor, and the packets that led there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reached {
    /// The next packet.
    pub pc: u32,
    /// The user thread that has the processor, also while it is interrupted.
    pub thread: Option<ThreadId>,
    /// Interrupts are switched off, as they are in an interrupt and so in the call-back.
    pub is_masked: bool,
    /// The packet that has called, if the last branch but jumps of the linker was a call.
    pub call: Option<u32>,
    /// B3: the return address, where a function begins.
    pub back: u32,
    /// The stack pointer.
    pub stack: u32,
}

/// A program calls the firmware: the processor is before the first packet of the function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramCall {
    /// The function.
    pub function: u32,
    /// The thread; `None` for the call-back.
    pub thread: Option<ThreadId>,
    /// The packet that calls.
    pub at: u32,
    /// Its first argument, if it is an integer.
    pub argument: i32,
}

impl<A: ExternalHardware> BootedBoard<A> {
    /// Stops [`run_to_stop`](Self::run_to_stop) before the packets at these addresses, and before no others.
    pub fn set_stops(&mut self, addresses: impl IntoIterator<Item = u32>) {
        self.core.set_stops(addresses);
    }

    /// Runs to the first packet from this cycle on, or to a stop; a run from a stop executes it.
    ///
    /// # Errors
    /// The firmware ran away; it stays so.
    pub fn run_to_stop(&mut self, cycle: u64) -> Result<Ran, Halted> {
        while self.cycle() < cycle {
            if self.run_events(cycle)? == Ran::ToStop {
                return Ok(Ran::ToStop);
            }
        }
        Ok(Ran::Through)
    }

    /// Returns the position of the processor, and the packets that led there.
    #[must_use]
    pub fn reached(&self) -> Reached {
        let state = &self.core.state;
        let back = state.reg(LINK);
        let [last, before] = state.branched_at();
        let is_call = |at: &u32| back.wrapping_sub(*at) <= LONGEST_CALL;
        let ProcessorState { pc, thread, is_masked } = self.processor_state();
        Reached {
            pc,
            thread: thread.and_then(user_thread),
            is_masked,
            // Where the linker put a jump in between, the branch before led to it.
            call: [before, last].into_iter().find(is_call),
            back,
            stack: state.reg(STACK),
        }
    }

    /// The call that a program makes just now; `None` if the processor is not before the first packet of a function that a
    /// program has called.
    #[must_use]
    pub fn program_call(&self) -> Option<ProgramCall> {
        let Reached { pc, thread, is_masked, call, .. } = self.reached();
        let at = call.filter(|at| is_of_program(*at) && !is_of_program(pc))?;
        let argument = self.core.state.reg(ARGUMENTS[0]).cast_signed();
        Some(ProgramCall { function: pc, thread: thread.filter(|_| !is_masked), at, argument })
    }

    /// Keeps the packets of programs from now on, or does not any more; those of the firmware itself are never kept.
    pub fn keep_packets(&mut self, whether: bool) {
        self.packets = whether.then(Vec::new);
    }

    /// The packets that programs have executed since the last call, if they are kept.
    pub fn take_packets(&mut self) -> Vec<ProgramPacket> {
        self.packets.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Executes packets up to the first from this cycle on or to a stop; where the timer waits to interrupt, no further than
    /// to where that is possible.
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

/// A user thread by the number that the firmware has for it.
fn user_thread(number: u32) -> Option<ThreadId> {
    i32::try_from(number).ok().and_then(ThreadId::new)
}

/// Returns whether an address is in the part of memory that programs are linked for.
fn is_of_program(at: u32) -> bool {
    (PROGRAM_BASE..PROGRAM_LIMIT).contains(&at)
}
