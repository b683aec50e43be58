//! Registers, and the results in flight to them.
//!
//! Results wait in sixteen slots, the slot of a cycle being its number modulo 16: no instruction takes longer. A slot
//! has a value for every register and a mask of the registers that get one, so two results for one register in one
//! cycle are detected at no cost.

use c67x::Reg;

use super::decode::TRUE;
use super::flight::{ANY, InFlightEffects, PendingDouble, SLOTS};
use super::memory::Clock;
use crate::trap::Fault;

/// Cycles from a branch to its target.
pub(super) const BRANCH: u64 = 6;

/// Bits of CSR and IER.
const GIE: u32 = 1;
const PGIE: u32 = 2;
const TIMER: u32 = 1 << 4;
const CSR: usize = 1;
const IFR: usize = 2;
const ICR: usize = 3;
const IER: usize = 4;
const ISTP: usize = 5;
/// The bits of ISTP that say where the vectors are, and the bytes of a vector.
const VECTORS: u32 = !0x3FF;
const VECTOR_BYTES: u32 = 32;
const IRP: usize = 6;
const NRP: usize = 7;

/// Registers, control registers and everything in flight.
#[derive(Clone, Debug)]
pub struct State {
    /// A0..=A31, B0..=B31, then the constants 1 and 0.
    pub(super) regs: [u32; 256],
    control: [u32; 32],
    /// Address of the next packet.
    pub(super) pc: u32,
    /// Cycles passed and left.
    pub clock: Clock,
    pub(super) flight: InFlightEffects,
    undefined: UndefinedEffects,
    /// The packets of the last branch and of the one before it.
    pub(super) branched_at: [u32; 2],
    /// The first cycle before which an interrupt is possible again.
    pub(super) shadow: u64,
    /// True while an `IDLE` waits.
    pub(super) is_idle: bool,
}

/// Effects of a packet whose outcome the processor leaves undefined.
#[derive(Clone, Debug, Default)]
struct UndefinedEffects {
    /// Registers with two results in one cycle; not 0 either if two branches arrive in one.
    conflicts: u64,
    two_branches: Option<(u32, u32)>,
}

/// The part of the state that decides how a processor continues, apart from memory.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    /// The cycle of it.
    pub(super) cycle: u64,
    /// The next packet.
    pub(super) pc: u32,
    regs: [u32; 64],
    control: [u32; 32],
    /// Cycles until an interrupt is possible.
    shadow: u64,
    /// Results in flight: when, which registers, their values, and the target of a branch.
    flight: Vec<(u64, u64, [u32; 64], Option<u32>)>,
    /// True if `flight` holds all effects in flight.
    is_whole: bool,
}

impl Picture {
    /// Reports whether two processors continue in the same way.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.is_whole
            && other.is_whole
            && self.pc == other.pc
            && self.regs == other.regs
            && self.control == other.control
            && self.shadow == other.shadow
            && self.flight == other.flight
    }

    /// Reports whether results are in flight: their slots are those of cycles modulo 16.
    pub(super) const fn has_flight(&self) -> bool {
        !self.flight.is_empty()
    }
}

impl Default for State {
    fn default() -> Self {
        let mut regs = [0; 256];
        regs[usize::from(TRUE)] = 1;
        let mut control = [0; 32];
        control[CSR] = 0x100 | PGIE | GIE;
        control[IER] = TIMER | 3;
        Self {
            regs,
            control,
            pc: 0,
            clock: Clock::default(),
            flight: InFlightEffects::default(),
            undefined: UndefinedEffects::default(),
            branched_at: [0; 2],
            shadow: 0,
            is_idle: false,
        }
    }
}

impl State {
    /// The value of a register as the next packet sees it.
    #[must_use]
    pub const fn reg(&self, reg: Reg) -> u32 {
        self.regs[reg.index()]
    }

    /// Sets a register immediately.
    pub const fn set_reg(&mut self, reg: Reg, value: u32) {
        self.regs[reg.index()] = value;
    }

    /// A control register.
    #[must_use]
    pub const fn control(&self, control: c67x::Control) -> u32 {
        self.control[control.number() as usize & 31]
    }

    /// Sets all bits of a control register immediately.
    pub const fn set_control(&mut self, control: c67x::Control, value: u32) {
        self.control[control.number() as usize & 31] = value;
    }

    /// Address of the next packet.
    #[must_use]
    pub const fn pc(&self) -> u32 {
        self.pc
    }

    /// Addresses of the packets of the last two taken branches, the latest first.
    #[must_use]
    pub const fn branched_at(&self) -> [u32; 2] {
        self.branched_at
    }

    /// Continues at an address, with nothing in flight.
    pub fn set_pc(&mut self, pc: u32) {
        self.land_all();
        self.pc = pc;
    }

    /// Cycles since the start.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.clock.cycle()
    }

    /// Reports whether the processor would take an interrupt before the next packet.
    #[must_use]
    pub const fn is_interruptible(&self) -> bool {
        self.clock.cycle >= self.shadow && self.control[CSR] & GIE != 0 && self.control[IER] & TIMER != 0
    }

    /// Copies the state that decides how it continues.
    pub(super) fn picture(&self) -> Picture {
        let mut regs = [0; 64];
        regs.copy_from_slice(&self.regs[..64]);
        let delays = (1..=SLOTS as u64).filter(|delay| {
            let slot = self.slot(*delay);
            self.flight.masks[slot] != 0 || self.flight.branches >> slot & 1 != 0
        });
        let flight = delays.map(|delay| {
            let slot = self.slot(delay);
            let mut values = self.flight.values[slot];
            let mask = self.flight.masks[slot];
            values
                .iter_mut()
                .enumerate()
                .filter(|(reg, _)| mask >> reg & 1 == 0)
                .for_each(|(_, value)| *value = 0);
            let target = (self.flight.branches >> slot & 1 != 0).then(|| self.flight.targets[slot]);
            (delay, mask, values, target)
        });
        Picture {
            cycle: self.cycle(),
            pc: self.pc,
            regs,
            control: self.control,
            shadow: self.shadow.saturating_sub(self.clock.cycle),
            flight: flight.collect(),
            is_whole: self.flight.late.is_empty(),
        }
    }

    /// Lets cycles pass in which nothing changes; with results in flight, their number is a multiple of 16.
    pub(super) const fn skip(&mut self, cycles: u64) {
        self.clock.cycle += cycles;
        self.shadow += cycles;
    }

    /// Sets the flag of interrupt 4, the timer interrupt.
    pub const fn raise_timer(&mut self) {
        self.control[IFR] |= TIMER;
    }

    /// Reports whether the timer interrupt is pending.
    #[must_use]
    pub const fn has_timer_flag(&self) -> bool {
        self.control[IFR] & TIMER != 0
    }

    /// Takes the timer interrupt: everything in flight lands, and the handler begins `overhead` cycles later.
    ///
    /// Source: `dsp-board.md` 4.2. The caller has tested [`is_interruptible`](Self::is_interruptible).
    pub fn take_timer_interrupt(&mut self, overhead: u64) {
        self.land_all();
        self.clock.cycle += overhead;
        self.control[IFR] &= !TIMER;
        self.control[IRP] = self.pc;
        let enabled = if self.control[CSR] & GIE != 0 { PGIE } else { 0 };
        self.control[CSR] = self.control[CSR] & !(GIE | PGIE) | enabled;
        self.pc = (self.control[ISTP] & VECTORS) + VECTOR_BYTES * TIMER.trailing_zeros();
    }

    /// Lets everything in flight land, and then cycles pass in which nothing is executed.
    pub fn wait(&mut self, cycles: u64) {
        self.land_all();
        self.clock.cycle += cycles;
    }

    /// Lets everything in flight land, as the processor does before it handles an interrupt.
    ///
    /// Branches in flight are lost; where an interrupt is possible there are none.
    pub fn land_all(&mut self) {
        if self.flight.is_empty() {
            return;
        }
        self.flight.branches = 0;
        let now = self.clock.cycle;
        for _ in 0..SLOTS {
            let _ = self.pass();
        }
        self.clock.cycle = now;
        self.flight.due = 0;
    }

    /// Writes a result of E1.
    #[inline(always)]
    pub(super) fn write(&mut self, reg: u8, value: u32) {
        self.regs[usize::from(reg)] = value;
        self.refuse_second(self.flight.masks[self.slot(1)] & bit(reg));
    }

    /// Schedules a result that lands `delay` cycles from now, at a delay that is [expected](super::flight::InFlightEffects::expect).
    #[inline(always)]
    pub(super) fn push(&mut self, delay: u64, reg: u8, value: u32) {
        let slot = self.slot(delay);
        let mask = self.flight.masks[slot];
        self.flight.masks[slot] = mask | bit(reg);
        self.flight.values[slot][usize::from(reg & 63)] = value;
        self.refuse_second(mask & bit(reg));
    }

    /// Notes registers that have two results in one cycle.
    #[inline(always)]
    fn refuse_second(&mut self, regs: u64) {
        if regs != 0 {
            self.note_second(regs);
        }
    }

    #[cold]
    #[inline(never)]
    const fn note_second(&mut self, regs: u64) {
        self.undefined.conflicts |= regs;
    }

    /// Reports whether a result for one of two registers arrives within `cycles` cycles, one or two.
    #[inline(always)]
    pub(super) fn arrives_within(&self, cycles: u64, reg1: u8, reg2: u8) -> bool {
        let masks = (1..=cycles).fold(0, |masks, delay| masks | self.flight.masks[self.slot(delay)]);
        masks & (bit(reg1) | bit(reg2)) != 0
    }

    /// The value of a register in `cycles` cycles, if only the results in flight change it.
    #[inline(always)]
    pub(super) fn after(&self, cycles: u64, reg: u8) -> u32 {
        let landing = (1..=cycles).rev().map(|delay| self.slot(delay));
        let slot = landing.into_iter().find(|slot| self.flight.masks[*slot] & bit(reg) != 0);
        slot.map_or(self.regs[usize::from(reg)], |slot| self.flight.values[slot][usize::from(reg & 63)])
    }

    /// Lets both words of a result land in the same cycle.
    #[inline(always)]
    pub(super) fn push_both(&mut self, delay: u64, reg: u8, value: u64) {
        let slot = self.slot(delay);
        let (low, high) = (usize::from(reg & 62), usize::from(reg & 62) | 1);
        let mask = self.flight.masks[slot];
        self.flight.masks[slot] = mask | 3 << low;
        self.flight.values[slot][low] = value as u32;
        self.flight.values[slot][high] = (value >> 32) as u32;
        self.refuse_second(mask & 3 << low);
    }

    /// Reports whether a branch arrives in the next cycle.
    #[inline(always)]
    pub(super) const fn branches_next(&self) -> bool {
        self.flight.branches >> self.slot(1) & 1 != 0
    }

    /// Remembers a double instruction whose high words are read later.
    pub(super) fn push_late(&mut self, late: PendingDouble) {
        self.flight.late.push(late);
    }

    /// Holds off interrupts because of a branch, taken or not.
    #[inline(always)]
    pub(super) const fn hold_interrupts(&mut self) {
        self.shadow = self.clock.cycle + BRANCH;
    }

    /// Lets a branch arrive in six cycles.
    #[inline(always)]
    pub(super) const fn branch(&mut self, target: u32) {
        let slot = (self.clock.cycle + BRANCH) as usize % SLOTS;
        if self.flight.branches & 1 << slot != 0 {
            self.undefined.two_branches = Some((self.flight.targets[slot], target));
            self.undefined.conflicts |= 1;
        }
        self.flight.branches |= 1 << slot;
        self.flight.targets[slot] = target;
        self.note_branch(self.pc);
    }

    /// Notes that the packet at `from` has taken a branch.
    #[inline(always)]
    pub(super) const fn note_branch(&mut self, from: u32) {
        self.branched_at = [from, self.branched_at[0]];
    }

    /// Schedules the arrival of a branch that was issued earlier.
    pub(super) const fn set_branch(&mut self, due: u64, target: u32) {
        let slot = self.slot(due);
        self.flight.branches |= 1 << slot;
        self.flight.targets[slot] = target;
    }

    /// Returns from an interrupt; yields the return address.
    pub(super) const fn return_from_interrupt(&mut self) -> u32 {
        let previous = if self.control[CSR] & PGIE != 0 { GIE } else { 0 };
        self.control[CSR] = self.control[CSR] & !GIE | previous;
        self.control[IRP]
    }

    /// Returns from the non-maskable interrupt; yields the return address.
    pub(super) const fn return_from_nmi(&mut self) -> u32 {
        self.control[IER] |= 2;
        self.control[NRP]
    }

    /// A control register as `MVC` reads it.
    pub(super) const fn read_control(&self, number: u8) -> u32 {
        self.control[number as usize & 31]
    }

    /// A control register as `MVC` writes it: ISR sets, ICR clears pending interrupts.
    pub(super) const fn write_control(&mut self, number: u8, value: u32) {
        match number as usize {
            IFR => self.control[IFR] |= value & 0xFFF0,
            ICR => self.control[IFR] &= !(value & 0xFFF0),
            other => self.control[other & 31] = value,
        }
    }

    /// Reports the fault of a packet whose outcome the processor leaves undefined.
    #[inline(always)]
    pub(super) fn refuse_undefined(&self) -> Result<(), Fault> {
        if self.undefined.conflicts != 0 { Err(self.undefined()) } else { Ok(()) }
    }

    /// Lets up to `cycles` cycles pass; they end where a branch arrives.
    #[inline(always)]
    pub(super) fn advance(&mut self, cycles: u8) -> CyclesEnd {
        if cycles == 1 { self.pass() } else { self.advance_far(u32::from(cycles)) }
    }

    /// Lets several cycles pass.
    fn advance_far(&mut self, mut cycles: u32) -> CyclesEnd {
        loop {
            let next = (self.flight.due >> 1).trailing_zeros() + 1;
            let passed = next.min(cycles);
            self.clock.cycle += u64::from(passed);
            self.flight.due >>= passed;
            if next == passed && self.land_due() == CyclesEnd::Branched {
                return CyclesEnd::Branched;
            }
            cycles -= passed;
            if cycles == 0 {
                return CyclesEnd::Through;
            }
        }
    }

    /// Lets a cycle pass.
    #[inline(always)]
    fn pass(&mut self) -> CyclesEnd {
        self.clock.cycle += 1;
        self.flight.due >>= 1;
        if self.flight.due & 1 == 0 { CyclesEnd::Through } else { self.land_due() }
    }

    /// Applies the effects that are due in this cycle.
    #[inline(always)]
    fn land_due(&mut self) -> CyclesEnd {
        let slot = self.slot(0);
        let mut mask = std::mem::take(&mut self.flight.masks[slot]);
        let values = &self.flight.values[slot];
        while mask != 0 {
            let reg = mask.trailing_zeros() as usize;
            self.regs[reg] = values[reg & 63];
            mask &= mask - 1;
        }
        if !self.flight.late.is_empty() {
            self.read_late();
        }
        if self.flight.branches >> slot & 1 == 0 {
            return CyclesEnd::Through;
        }
        self.flight.branches &= !(1 << slot);
        self.pc = self.flight.targets[slot];
        CyclesEnd::Branched
    }

    #[cold]
    fn read_late(&mut self) {
        let mut index = 0;
        while let Some(late) = self.flight.late.get(index).copied() {
            if late.due == self.clock.cycle {
                self.flight.late.swap_remove(index);
                self.flight.expect(ANY);
                self.continue_late(late);
            } else {
                index += 1;
            }
        }
    }

    #[cold]
    fn undefined(&self) -> Fault {
        if let Some((first, second)) = self.undefined.two_branches {
            return Fault::TwoBranches { first, second };
        }
        let reg = Reg::from_index(self.undefined.conflicts.trailing_zeros() as usize).unwrap_or(Reg::a(0));
        Fault::TwoWriters { reg }
    }

    #[inline(always)]
    pub(super) const fn slot(&self, delay: u64) -> usize {
        (self.clock.cycle + delay) as usize % SLOTS
    }
}

/// The end of a packet's cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CyclesEnd {
    /// The next packet follows.
    Through,
    /// A branch has arrived.
    Branched,
}

#[inline(always)]
const fn bit(reg: u8) -> u64 {
    1 << (reg & 63)
}
