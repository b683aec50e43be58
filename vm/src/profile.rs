//! The profiling engine: the bytecode engine, with an account of where the time went.
//!
//! Nothing is sampled. The interpreter gets an empty budget, so that every `charge` returns to this engine: its cycles
//! are added to the segment that begins there, then the program continues with its real budget. By [the rule of
//! metering](crate::meter) a segment is executed as a whole, and a call ends it, so the account is exact. Firmware
//! functions and devices see the real budget, and the run is the same, cycle by cycle, as without a profile.

use std::collections::BTreeMap;
use std::sync::Arc;

use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use crate::bus::Bus;
use crate::engine::{
    ContextId, Executor, ForeignSnapshot, ObservedAccesses, Polling, Preemption, Slice, Stack, Stop,
};
use crate::firmware::{
    Caller, Firmware, NextAccess, Outcome, RepeatPolicy, SharedAccess, Signature, SwitchPoint, TickContext,
    Value,
};
use crate::interp::{BytecodeEngine, BytecodeSnapshot};
use crate::memory::GuestMemory;
use crate::op::Op;
use crate::program::Program;
use crate::scheduler::SliceOwner;
use crate::trap::{Trap, TrapKind};
use kmotiondef::AccessSize;

const NOTHING: Cycles = Cycles::new(0);

/// A place of a program, with the calls that led to it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Site {
    /// The thread or the call-back.
    pub context: ContextId,
    /// The first instruction of a segment, then the calls that led to it, innermost first.
    pub calls: Vec<CodeAddr>,
    /// The firmware function called at the end of the segment, if the time was spent in it.
    pub firmware: Option<GuestAddr>,
}

/// The time spent at a site, in cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpentTime {
    /// Processor time.
    pub computing: Cycles,
    /// Time in which a firmware function made the thread wait.
    pub waiting: Cycles,
}

/// The time of a run, by site.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    spent: BTreeMap<Site, SpentTime>,
}

impl Profile {
    /// The sites in order, and the time spent at each.
    pub fn sites(&self) -> impl Iterator<Item = (&Site, SpentTime)> {
        self.spent.iter().map(|(site, spent)| (site, *spent))
    }

    fn add(&mut self, site: Site, computing: Cycles, waiting: Cycles) {
        if computing != NOTHING || waiting != NOTHING {
            let spent = self.spent.entry(site).or_default();
            spent.computing += computing;
            spent.waiting += waiting;
        }
    }
}

/// The instructions of the segment that begins at `head`, and the cost of each.
pub fn segment(program: &Program, head: CodeAddr) -> impl Iterator<Item = (CodeAddr, u32)> {
    let first = program.word_at(head).unwrap_or(usize::MAX);
    let ops = program.ops().iter().enumerate().skip(first);
    ops.take_while(|(_, op)| !matches!(op, Op::Charge { .. } | Op::Func { .. }))
        .map(|(word, op)| (program.address_of(word), op.cost()))
}

/// Interprets programs and keeps a profile.
#[derive(Debug, Default)]
pub struct ProfilingEngine {
    inner: BytecodeEngine,
    profile: Profile,
    /// The site at which each waiting context waits, and the start of the wait.
    waits: [Option<(Site, Cycles)>; ContextId::COUNT],
}

impl ProfilingEngine {
    /// The profile so far.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    fn site(&self, context: ContextId) -> Site {
        Site { context, calls: self.inner.backtrace(context), firmware: None }
    }

    /// Runs up to the next charge, or to an earlier stop of the program.
    fn run_segment<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        let site = self.site(id);
        let left = slice.budget;
        let mut metered =
            MeteredFirmware { firmware: slice.firmware, length: slice.length, left, called: None };
        let mut part = Slice {
            memory: slice.memory,
            threads: slice.threads,
            firmware: &mut metered,
            tick: slice.tick,
            start: slice.start,
            length: slice.length - left,
            budget: NOTHING,
            woken: slice.woken.take(),
            is_long: false,
            polling: Polling::OFF,
        };
        let stop = self.inner.resume(id, &mut part);
        let spent = NOTHING - part.budget;
        slice.budget = left - spent;
        let (function, in_firmware) = metered.called.unzip();
        let in_firmware = in_firmware.unwrap_or_default();
        let charged = self.charged(id, &stop);
        // Accesses to device registers take time, too; it belongs to the segment that makes them.
        self.profile.add(site.clone(), spent - in_firmware - charged, NOTHING);
        let call = Site { firmware: function, ..site };
        if let Stop::Waiting(_) = stop {
            self.waits[id.index()] = Some((call.clone(), slice.now()));
        }
        self.profile.add(call, in_firmware, NOTHING);
        self.profile.add(self.site(id), charged, NOTHING);
        stop
    }

    /// The cycles of the charge that stopped a context.
    fn charged(&self, id: ContextId, stop: &Stop) -> Cycles {
        let Some(program) = self.inner.program(id).filter(|_| matches!(stop, Stop::Preempted)) else {
            return NOTHING;
        };
        let next = self.inner.backtrace(id).first().and_then(|next| program.word_at(*next));
        let before = next.and_then(|next| program.ops().get(next.checked_sub(1)?));
        if let Some(Op::Charge { cycles }) = before { Cycles::new(i64::from(cycles.0)) } else { NOTHING }
    }
}

/// A profiling engine as it was at an instant.
#[derive(Debug)]
pub struct ProfilingSnapshot {
    inner: BytecodeSnapshot,
    profile: Profile,
    waits: [Option<(Site, Cycles)>; ContextId::COUNT],
}

impl Executor for ProfilingEngine {
    const KEEPS_ACCOUNT: bool = true;

    type Code = Program;
    type Snapshot = ProfilingSnapshot;

    /// Always [`Preemption::Segments`]: the account is of whole segments.
    fn set_preemption(&mut self, _: Preemption) {}

    fn observe(&mut self, observed: ObservedAccesses) {
        self.inner.observe(observed);
    }

    fn start<F: Firmware + ?Sized>(
        &mut self,
        id: ContextId,
        program: &Arc<Program>,
        entry: GuestAddr,
        stack: Stack,
        firmware: &F,
    ) -> Result<(), TrapKind> {
        self.waits[id.index()] = None;
        self.inner.start(id, program, entry, stack, firmware)
    }

    fn resume<F: Firmware + ?Sized>(&mut self, id: ContextId, slice: &mut Slice<'_, F>) -> Stop {
        if let Some((site, since)) = self.waits[id.index()].take() {
            self.profile.add(site, NOTHING, slice.now() - since);
        }
        loop {
            let stop = self.run_segment(id, slice);
            if !matches!(stop, Stop::Preempted) || slice.budget < NOTHING {
                return stop;
            }
        }
    }

    fn snapshot(&self) -> ProfilingSnapshot {
        let (inner, profile, waits) = (self.inner.snapshot(), self.profile.clone(), self.waits.clone());
        ProfilingSnapshot { inner, profile, waits }
    }

    fn restore(&mut self, snapshot: &ProfilingSnapshot) -> Result<(), ForeignSnapshot> {
        self.inner.restore(&snapshot.inner)?;
        self.profile.clone_from(&snapshot.profile);
        self.waits.clone_from(&snapshot.waits);
        Ok(())
    }

    fn stack_used(&self, id: ContextId) -> u32 {
        self.inner.stack_used(id)
    }

    fn backtrace(&self, id: ContextId) -> Vec<CodeAddr> {
        self.inner.backtrace(id)
    }
}

/// The firmware, with the real budget and a record of the cycles spent by its calls.
#[derive(Debug)]
struct MeteredFirmware<'a, F: ?Sized> {
    firmware: &'a mut F,
    /// The budget of the whole slice, in cycles.
    length: Cycles,
    /// The budget left at the start of the part that the engine has been given.
    left: Cycles,
    /// The function that was called, and the cycles it spent.
    called: Option<(GuestAddr, Cycles)>,
}

impl<F: Firmware + ?Sized> Bus for MeteredFirmware<'_, F> {
    fn read(&mut self, addr: GuestAddr, size: AccessSize, now: Cycles) -> u32 {
        self.firmware.read(addr, size, now)
    }

    fn write(&mut self, addr: GuestAddr, size: AccessSize, value: u32, now: Cycles) {
        self.firmware.write(addr, size, value, now);
    }

    fn access_cycles(&self, addr: GuestAddr) -> Cycles {
        self.firmware.access_cycles(addr)
    }
}

impl<F: Firmware + ?Sized> Firmware for MeteredFirmware<'_, F> {
    fn signature(&self, address: GuestAddr) -> Option<&Signature> {
        self.firmware.signature(address)
    }

    fn call(&mut self, address: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        let mut budget = self.left + *caller.budget;
        let before = budget;
        let mut true_caller = Caller {
            thread: caller.thread,
            memory: caller.memory,
            threads: caller.threads,
            tick: caller.tick,
            slice_start: caller.slice_start,
            slice: self.length,
            budget: &mut budget,
            woken: caller.woken,
            arguments: caller.arguments,
            at: caller.at,
        };
        let outcome = self.firmware.call(address, &mut true_caller);
        caller.woken = true_caller.woken;
        *caller.budget = budget - self.left;
        self.called = Some((address, before - budget));
        outcome
    }

    fn accessed(&mut self, access: &SharedAccess<'_>, memory: &GuestMemory) -> RepeatPolicy {
        self.firmware.accessed(access, memory)
    }

    fn take_ordering(&mut self) -> bool {
        self.firmware.take_ordering()
    }

    fn switch_at(&mut self, access: &NextAccess) -> Option<SwitchPoint> {
        self.firmware.switch_at(access)
    }

    fn callback(&self, memory: &GuestMemory) -> GuestAddr {
        self.firmware.callback(memory)
    }

    fn callback_returned(&mut self, context: &mut TickContext<'_>, spent: Cycles) {
        self.firmware.callback_returned(context, spent);
    }

    fn tick(&mut self, context: &mut TickContext<'_>) {
        self.firmware.tick(context);
    }

    fn servo_time(&self, memory: &GuestMemory) -> Cycles {
        self.firmware.servo_time(memory)
    }

    fn switch_to(&mut self, turn: SliceOwner, context: &mut TickContext<'_>) {
        self.firmware.switch_to(turn, context);
    }

    fn primary_slice(&mut self, context: &mut TickContext<'_>) {
        self.firmware.primary_slice(context);
    }

    fn trapped(&mut self, trap: &Trap, context: &mut TickContext<'_>) {
        self.firmware.trapped(trap, context);
    }

    fn stack_exceeded(&mut self, thread: kmotiondef::ThreadId, used: u32) {
        self.firmware.stack_exceeded(thread, used);
    }

    fn quiet_ticks(&self, memory: &GuestMemory) -> u64 {
        self.firmware.quiet_ticks(memory)
    }

    fn skip_ticks(&mut self, count: u64, context: &mut TickContext<'_>) {
        self.firmware.skip_ticks(count, context);
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::Ticks;

    use super::*;
    use crate::machine::Config;
    use crate::testing::{machine_on, thread};

    /// Counts to 3 with a function, then delays for 50,000 cycles.
    const PROGRAM: &str = "@main: func sig0, 2, 0
types 0
charge 2
const_i32 r0, 3
const_i32 r1, 50000
@again: charge 6
arg_i32 r0, 0
call fn@down
result_i32 r0
charge 1
br_if r0, @again
charge 6
arg_i32 r1, 0
call_fw sig1, 0x10008008
charge 2
ret
@down: func sig3, 1, 0
types 0
charge 3
add_i32_imm r0, r0, -1
ret_i32 r0";

    #[test]
    fn every_cycle_is_attributed_to_where_it_was_spent() {
        let mut machine = machine_on::<ProfilingEngine>(Config::default(), &[(1, PROGRAM)]);
        machine.run_until(Ticks::new(20));
        let program = machine.program(thread(1)).expect("it is loaded");
        let offset =
            |at: &CodeAddr| (at.get() - program.base().get()) / 8 - crate::testing::HEAD_WORDS as u32;
        let lines: Vec<String> = machine
            .engine()
            .profile()
            .sites()
            .map(|(site, spent)| {
                let calls: Vec<_> = site.calls.iter().map(|at| offset(at).to_string()).collect();
                let call = site.firmware.map_or_else(String::new, |address| format!(" {address}"));
                let (computing, waiting) = (spent.computing.get(), spent.waiting.get());
                format!("{}{call}: {computing} + {waiting}", calls.join("<"))
            })
            .collect();
        // The delay of 50,000 cycles ends between two slices, so the thread continues with the next slice: at 98,000.
        let expect =
            ["3: 2 + 0", "6: 18 + 0", "10: 3 + 0", "12: 6 + 0", "12 0x10008008: 0 + 71962", "15: 2 + 0"];
        assert_eq!(lines[..6], expect);
        assert_eq!(lines[6..], ["19<7: 9 + 0"]);
    }
}
