//! Gives every virtual register one of the processor's, by linear scan.
//!
//! Intervals are allocated in the order of their beginnings. A register that is live across a call must be
//! callee-saved. If none is free, the interval with the fewest uses for its length is spilled, and allocation starts
//! over. Of the free registers, the one that has been free longest is taken, so that few instructions have to wait only
//! because of a register.

use c67x::Reg;
use cranelift_entity::SecondaryMap;

use super::abi;
use super::code::{Code, VReg};
use super::live::{self, Interval, Liveness};
use super::{sides, spill};
use crate::passes::Level;

/// The registers of a function.
#[derive(Clone, Debug)]
pub(super) struct Assignment {
    regs: SecondaryMap<VReg, u8>,
    /// The callee-saved registers that the function uses.
    pub(super) kept: u64,
    is_used: SecondaryMap<VReg, bool>,
}

impl Assignment {
    /// The register; of a pair the even one.
    pub(super) fn register_of(&self, reg: VReg) -> Reg {
        Reg::from_index(usize::from(self.regs[reg])).unwrap_or(abi::RESULT)
    }

    /// Reports whether it has a register: unused ones have none.
    pub(super) fn is_used(&self, reg: VReg) -> bool {
        self.is_used[reg]
    }
}

/// The limit of rounds of spilling and allocating again.
const ROUNDS: usize = 24;

/// Allocates; `None` if the function does not fit the processor.
pub(super) fn allocate(code: &mut Code, level: Level) -> Option<Assignment> {
    for _ in 0..ROUNDS {
        let liveness = live::analyze(code);
        let mut scan = Scan::new(code, &liveness);
        scan.is_wide = level == Level::Fast;
        scan.run(&live::in_order(code, &liveness))?;
        if scan.moved.is_empty() {
            // Arguments from the seventh on are in callee-saved registers.
            let kept = code.calls.iter().fold(scan.used, |set, call| set | call.changes) & abi::KEPT;
            let mut is_used = SecondaryMap::with_capacity(code.regs.len());
            for reg in code.regs.keys() {
                is_used[reg] = liveness.intervals[reg].is_used;
            }
            return Some(Assignment { regs: scan.regs, kept, is_used });
        }
        let moved = scan.moved;
        spill::to_memory(code, &moved);
    }
    None
}

struct Scan<'a> {
    code: &'a Code,
    liveness: &'a Liveness,
    regs: SecondaryMap<VReg, u8>,
    /// The last position at which each register is taken.
    taken: [u32; Reg::COUNT],
    holder: [Option<VReg>; Reg::COUNT],
    used: u64,
    moved: Vec<VReg>,
    is_moved: SecondaryMap<VReg, bool>,
    /// The registers that some call changes.
    changed_anywhere: u64,
    /// True if loops use as many registers as there are, so that their iterations can overlap.
    is_wide: bool,
}

impl<'a> Scan<'a> {
    fn new(code: &'a Code, liveness: &'a Liveness) -> Self {
        let mut regs = SecondaryMap::with_default(abi::RESULT.index() as u8);
        regs.resize(code.regs.len());
        Self {
            code,
            liveness,
            regs,
            taken: [0; Reg::COUNT],
            holder: [None; Reg::COUNT],
            used: 0,
            moved: Vec::new(),
            is_moved: SecondaryMap::new(),
            changed_anywhere: code.calls.iter().fold(0, |set, call| set | call.changes),
            is_wide: false,
        }
    }

    fn run(&mut self, order: &[VReg]) -> Option<()> {
        for reg in order {
            let interval = self.liveness.intervals[*reg];
            let allowed = sides::allowed_registers(&self.code.regs[*reg]) & !self.call_clobbers(interval);
            match self.free(*reg, allowed, interval.start) {
                Some(found) => self.occupy(*reg, found, interval.end),
                None => self.evict(*reg, interval, allowed)?,
            }
        }
        Some(())
    }

    /// The registers that calls inside an interval change.
    fn call_clobbers(&self, interval: Interval) -> u64 {
        let calls = &self.liveness.calls;
        let first = calls.partition_point(|(at, _)| *at < interval.start);
        let mut changed = 0;
        for (_, number) in calls[first..].iter().take_while(|(at, _)| *at < interval.end) {
            changed |= self.code.calls[*number as usize].changes;
            // Most calls change the same registers, so calls after the first add nothing.
            if changed == self.changed_anywhere {
                break;
            }
        }
        changed
    }

    /// The physical registers occupied by a virtual register that is assigned to `reg`.
    fn occupied_registers(&self, reg: VReg, at: Reg) -> u64 {
        if self.code.regs[reg].is_pair { abi::bit(at) | abi::bit(at.pair().high()) } else { abi::bit(at) }
    }

    /// The best free register.
    fn free(&self, reg: VReg, allowed: u64, start: u32) -> Option<Reg> {
        let info = &self.code.regs[reg];
        let is_free = |at: Reg| {
            let whole = self.occupied_registers(reg, at);
            (!info.is_pair || at.number().is_multiple_of(2))
                && whole & !allowed == 0
                && abi::registers(whole).all(|one| self.taken[one.index()] < start)
        };
        if let Some(hint) = info.hint.filter(|hint| is_free(*hint)) {
            return Some(hint);
        }
        let around = self.loop_at(start).filter(|_| self.is_wide);
        let is_long = self.is_wide && !info.is_pair && self.lives_through_loop(reg);
        let key = |at: &Reg| {
            let whole = self.occupied_registers(reg, *at);
            let is_new = around.is_none() && whole & abi::KEPT & !self.used != 0;
            let is_rare = !info.is_condition && whole & abi::CONDITIONS != 0;
            let is_shared = info.is_pair && around.is_some_and(|first| self.conflicts_in_loop(whole, first));
            let breaks = is_long && self.breaks_pair(reg, *at, start);
            (is_new, is_shared, is_rare, breaks, self.taken[at.index()], at.index())
        };
        abi::registers(allowed).filter(|at| is_free(*at)).min_by_key(key)
    }

    /// Reports whether a pair in a loop that begins at `first` would share its registers with another value of an
    /// iteration, or leave no register of its side for conditions: results of the same register limit the overlap of
    /// iterations.
    fn conflicts_in_loop(&self, whole: u64, first: u32) -> bool {
        let is_taken = |one: Reg| self.taken[one.index()] >= first;
        let side = abi::registers(whole).next().map_or(0, |one| abi::file(one.side()));
        let tested = side & abi::CONDITIONS;
        abi::registers(whole).any(is_taken)
            || whole & tested != 0 && abi::registers(tested & !whole).all(is_taken)
    }

    /// The beginning of the loop at a position, if there is one.
    fn loop_at(&self, position: u32) -> Option<u32> {
        let next = self.liveness.loops.partition_point(|(_, end)| *end < position);
        self.liveness.loops.get(next).map(|(first, _)| *first).filter(|first| *first <= position)
    }

    /// Reports whether a register is live through a whole loop.
    fn lives_through_loop(&self, reg: VReg) -> bool {
        let interval = self.liveness.intervals[reg];
        let next = self.liveness.loops.partition_point(|(first, _)| *first < interval.start);
        self.liveness.loops.get(next).is_some_and(|(_, end)| *end <= interval.end)
    }

    /// Reports whether a word in `at` would take half of a free pair.
    fn breaks_pair(&self, reg: VReg, at: Reg, start: u32) -> bool {
        let pair = at.pair();
        let other = if pair.low() == at { pair.high() } else { pair.low() };
        !self.code.regs[reg].is_pair && self.taken[other.index()] < start
    }

    fn occupy(&mut self, reg: VReg, at: Reg, end: u32) {
        self.regs[reg] = at.index() as u8;
        for one in abi::registers(self.occupied_registers(reg, at)) {
            self.taken[one.index()] = end;
            self.holder[one.index()] = Some(reg);
            self.used |= abi::bit(one);
        }
    }

    /// Makes room, or moves the register itself to memory.
    fn evict(&mut self, reg: VReg, interval: Interval, allowed: u64) -> Option<()> {
        let info = &self.code.regs[reg];
        let own = if info.is_short { f32::INFINITY } else { self.cost(reg) };
        let mut best: Option<(f32, Reg)> = None;
        for at in abi::registers(allowed).filter(|at| !info.is_pair || at.number().is_multiple_of(2)) {
            let whole = self.occupied_registers(reg, at);
            if whole & !allowed != 0 {
                continue;
            }
            let holders = abi::registers(whole).filter(|one| self.taken[one.index()] >= interval.start);
            let cost = holders.fold(0.0, |cost, one| {
                cost + self.holder[one.index()].map_or(f32::INFINITY, |holder| self.cost(holder))
            });
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, at));
            }
        }
        match best {
            Some((cost, at)) if cost < own => {
                for one in abi::registers(self.occupied_registers(reg, at)) {
                    if self.taken[one.index()] >= interval.start
                        && let Some(holder) = self.holder[one.index()]
                        && !std::mem::replace(&mut self.is_moved[holder], true)
                    {
                        self.moved.push(holder);
                        // The other half of an evicted pair is free too.
                        for half in
                            abi::registers(self.occupied_registers(holder, self.assigned_register(holder)))
                        {
                            self.taken[half.index()] = interval.start - 1;
                        }
                    }
                }
                self.occupy(reg, at, interval.end);
                Some(())
            }
            _ if !info.is_short => {
                self.moved.push(reg);
                Some(())
            }
            _ => None,
        }
    }

    fn assigned_register(&self, reg: VReg) -> Reg {
        Reg::from_index(usize::from(self.regs[reg])).unwrap_or(abi::RESULT)
    }

    /// The cost of keeping a register in memory, per length of its interval.
    fn cost(&self, reg: VReg) -> f32 {
        let info = &self.code.regs[reg];
        if info.is_short {
            return f32::INFINITY;
        }
        let interval = self.liveness.intervals[reg];
        let length = (interval.end - interval.start + 1) as f32;
        let factor = if info.constant.is_some() { 0.4 } else { 1.0 };
        factor * interval.weight / length
    }
}
