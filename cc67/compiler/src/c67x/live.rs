//! The live intervals of virtual registers.
//!
//! Positions count instructions in the order of the code: instruction i reads at 2i and writes at 2i + 1; the
//! parameters are written at 1. An interval reaches from the first write to the last read, and over every block in
//! which the register is live throughout. Only registers that are used by several blocks take part in the data flow.

use cranelift_entity::{EntityRef, SecondaryMap};

use super::code::{Code, VReg};
use super::forms::Kind;

/// The live interval of a register.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Interval {
    pub(super) start: u32,
    pub(super) end: u32,
    /// Its number of uses, weighted by loop depth.
    pub(super) weight: f32,
    pub(super) is_used: bool,
}

/// The live intervals of all registers.
#[derive(Debug)]
pub(super) struct Liveness {
    pub(super) intervals: SecondaryMap<VReg, Interval>,
    /// Positions of the beginning and end of each block that jumps to itself.
    pub(super) loops: Vec<(u32, u32)>,
    /// Position and number of each call.
    pub(super) calls: Vec<(u32, u32)>,
}

/// Finds out.
pub(super) fn analyze(code: &Code) -> Liveness {
    let mut scan = Scan {
        intervals: SecondaryMap::with_capacity(code.regs.len()),
        block: SecondaryMap::with_capacity(code.regs.len()),
        globals: Vec::new(),
        number: SecondaryMap::with_capacity(code.regs.len()),
    };
    scan.intervals.resize(code.regs.len());
    scan.block.resize(code.regs.len());
    scan.number.resize(code.regs.len());
    let (bounds, calls) = scan.scan_code(code);
    scan.flow(code, &bounds);
    let loops = (0..).zip(&code.blocks).zip(&bounds);
    let loops = loops.filter(|((number, block), _)| block.terminator.targets().any(|to| to == *number));
    let loops = loops.map(|(_, bounds)| *bounds).collect();
    Liveness { intervals: scan.intervals, loops, calls }
}

/// Positions, two and two.
type PositionPairs = Vec<(u32, u32)>;

struct Scan {
    intervals: SecondaryMap<VReg, Interval>,
    /// One more than the block that mentions a register.
    block: SecondaryMap<VReg, u32>,
    /// The registers that are used in several blocks, or read before they are written.
    globals: Vec<VReg>,
    /// One more than the place of a register in `globals`.
    number: SecondaryMap<VReg, u32>,
}

/// The registers that a block reads before it writes them, and those that it writes first.
struct UseDefSets {
    read: Vec<u64>,
    written: Vec<u64>,
}

impl Scan {
    fn record_use(&mut self, reg: VReg, position: u32, block: u32, weight: f32, is_read: bool) {
        let interval = &mut self.intervals[reg];
        interval.weight += weight;
        if interval.is_used {
            interval.end = interval.end.max(position);
            interval.start = interval.start.min(position);
        } else {
            *interval = Interval { start: position, end: position, weight, is_used: true };
            self.block[reg] = block + 1;
        }
        let is_first_read = is_read && interval.start == position;
        if (self.block[reg] != block + 1 || is_first_read) && self.number[reg] == 0 {
            self.globals.push(reg);
            self.number[reg] = self.globals.len() as u32;
        }
    }

    /// Walks the code; the positions of each block's beginning and end, and of the calls.
    fn scan_code(&mut self, code: &Code) -> (PositionPairs, PositionPairs) {
        let mut bounds = Vec::with_capacity(code.blocks.len());
        let mut calls = Vec::new();
        for (reg, _) in &code.params {
            self.record_use(*reg, 1, 0, 1.0, false);
        }
        let mut at = 2;
        for (number, block) in (0..).zip(&code.blocks) {
            let start = at;
            let weight = 8_f32.powi(block.depth.min(5).cast_signed());
            for inst in &block.insts {
                inst.visit_reads(|reg| self.record_use(reg, at, number, weight, true));
                if inst.kind == Kind::Call {
                    calls.push((at, inst.number));
                    for (reg, _) in &code.calls[inst.number as usize].arguments {
                        self.record_use(*reg, at, number, weight, true);
                    }
                }
                if let Some((reg, _)) = inst.written_register() {
                    self.record_use(reg, at + 1, number, weight, false);
                }
                if let Some(reg) = inst.incremented_base() {
                    self.record_use(reg, at + 1, number, weight, false);
                }
                at += 2;
            }
            if let Some(reg) = block.terminator.read() {
                self.record_use(reg, at, number, weight, true);
            }
            at += 2;
            bounds.push((start, at - 1));
        }
        (bounds, calls)
    }

    /// Extends intervals over the blocks in which their registers are live throughout.
    fn flow(&mut self, code: &Code, bounds: &[(u32, u32)]) {
        if self.globals.is_empty() || code.blocks.len() < 2 && !loops_to_itself(code) {
            return;
        }
        let words = self.globals.len().div_ceil(64);
        let sets: Vec<UseDefSets> = code.blocks.iter().map(|block| self.sets(code, block, words)).collect();
        let mut entering = vec![0_u64; words * code.blocks.len()];
        let mut leaving = vec![0_u64; words];
        let mut is_changed = true;
        while is_changed {
            is_changed = false;
            for (number, block) in code.blocks.iter().enumerate().rev() {
                compute_live_out(&mut leaving, &entering, block, words);
                let own = &mut entering[number * words..(number + 1) * words];
                for (index, own) in own.iter_mut().enumerate() {
                    let new = sets[number].read[index] | leaving[index] & !sets[number].written[index];
                    is_changed |= *own != new;
                    *own = new;
                }
            }
        }
        for (number, (block, (start, end))) in code.blocks.iter().zip(bounds).enumerate() {
            self.extend_intervals(&entering[number * words..(number + 1) * words], *start - 1);
            compute_live_out(&mut leaving, &entering, block, words);
            self.extend_intervals(&leaving, *end);
        }
    }

    fn extend_intervals(&mut self, set: &[u64], position: u32) {
        for (word, bits) in set.iter().enumerate() {
            let mut bits = *bits;
            while bits != 0 {
                let index = word * 64 + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let interval = &mut self.intervals[self.globals[index]];
                interval.start = interval.start.min(position);
                interval.end = interval.end.max(position);
            }
        }
    }

    fn sets(&self, code: &Code, block: &super::code::Block, words: usize) -> UseDefSets {
        let mut sets = UseDefSets { read: vec![0; words], written: vec![0; words] };
        let read = |sets: &mut UseDefSets, reg: VReg| {
            if let Some((word, bit)) = self.bit(reg)
                && sets.written[word] & bit == 0
            {
                sets.read[word] |= bit;
            }
        };
        for inst in &block.insts {
            inst.visit_reads(|reg| read(&mut sets, reg));
            if inst.kind == Kind::Call {
                for (reg, _) in &code.calls[inst.number as usize].arguments {
                    read(&mut sets, *reg);
                }
            }
            if let Some((reg, true)) = inst.written_register()
                && let Some((word, bit)) = self.bit(reg)
            {
                sets.written[word] |= bit;
            }
        }
        if let Some(reg) = block.terminator.read() {
            read(&mut sets, reg);
        }
        sets
    }

    fn bit(&self, reg: VReg) -> Option<(usize, u64)> {
        let index = (self.number[reg] as usize).checked_sub(1)?;
        Some((index / 64, 1 << (index % 64)))
    }
}

/// Computes the registers that are live at the end of a block.
fn compute_live_out(leaving: &mut [u64], entering: &[u64], block: &super::code::Block, words: usize) {
    leaving.fill(0);
    for target in block.terminator.targets() {
        let start = target as usize * words;
        for (own, next) in leaving.iter_mut().zip(&entering[start..start + words]) {
            *own |= next;
        }
    }
}

fn loops_to_itself(code: &Code) -> bool {
    code.blocks.iter().any(|block| block.terminator.targets().next().is_some())
}

/// The registers in the order in which their intervals begin.
pub(super) fn in_order(code: &Code, liveness: &Liveness) -> Vec<VReg> {
    let mut order: Vec<VReg> = code.regs.keys().filter(|reg| liveness.intervals[*reg].is_used).collect();
    order.sort_by_key(|reg| (liveness.intervals[*reg].start, reg.index()));
    order
}
