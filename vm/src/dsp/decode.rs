//! Packets, decoded once: operands resolved, order chosen, and all checks made that do not depend on values.
//!
//! The instructions of a packet read all their sources before any of them writes. They are nevertheless executed one
//! after another, in an order in which no instruction reads a register that an earlier one of the packet has written;
//! where there is no such order (two moves that exchange registers), a result is [deferred](DEFERRED) to the beginning
//! of the next cycle.

use c67x::{Branch, Field, Inst, Kind, Offset, Operand, PARALLEL, Reg, Update, target};

use super::memory::Memory;
use super::pipeline::BRANCH;
use super::work::{Work, WorkPlan, plan};
use crate::trap::Fault;

/// The register that always holds 1: the condition of unconditional instructions.
pub(super) const TRUE: u8 = 64;
/// The register that always holds 0, to which constants are added.
pub(super) const ZERO: u8 = 65;
/// B15.
pub(super) const STACK: u8 = 47;

/// The E1 result lands at the beginning of the next cycle.
pub(super) const DEFERRED: u8 = 1;
/// s1 is a pair.
pub(super) const LONG1: u8 = 2;
/// s2 is a pair.
pub(super) const LONG2: u8 = 4;
/// 32-bit sources of 40-bit arithmetic are zero-extended.
pub(super) const UNSIGNED: u8 = 8;
/// The offset register is subtracted.
pub(super) const NEGATIVE: u8 = 16;
/// The base changes.
pub(super) const UPDATES: u8 = 32;
/// The address is the base as it was.
pub(super) const AFTER: u8 = 64;

/// No instruction of the packet changes a high word that a double instruction reads a cycle later; of a product, two.
pub(super) const STEADY: u8 = 128;

/// In `extra` of a [steady](STEADY) product: the next packet in memory does not change its words either.
pub(super) const FORESEEN: u8 = 1;

/// Most instructions of a packet.
const MOST: usize = 8;

/// An instruction with its operands resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MicroOp {
    /// The operation.
    pub(super) work: Work,
    /// The register tested.
    pub(super) pred: u8,
    /// True if it executes when that register is 0.
    pub(super) inverted: bool,
    /// s1, to which `imm` is added; the base of an address.
    pub(super) a: u8,
    /// s2; the offset register of an address.
    pub(super) b: u8,
    /// The high word of s1, if that is a pair.
    pub(super) a_high: u8,
    /// The high word of s2, if that is a pair.
    pub(super) b_high: u8,
    /// The destination; the register that is stored; a control register.
    pub(super) dst: u8,
    /// Shift of a scaled source or offset, halves of a product.
    pub(super) extra: u8,
    /// Bits, see the constants of this file.
    pub(super) flags: u8,
    /// A constant, added to s1 or to an address; the target of a branch.
    pub(super) imm: u32,
}

/// A packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Packet {
    /// The index of its first instruction that has an effect, among all instructions of the cache.
    pub(super) first: u32,
    /// Number of instructions that have an effect.
    pub(super) count: u8,
    /// The delays after which an effect that it issues may occur, as bits.
    pub(super) delays: u16,
    /// Cycles it lasts, if no branch ends it.
    pub(super) cycles: u8,
    /// True if it writes the stack pointer.
    pub(super) moves_stack: bool,
    /// True if it holds a branch, taken or not.
    pub(super) has_branch: bool,
    /// True if it waits for an interrupt.
    pub(super) is_idle: bool,
    /// True if the packet after it in memory is the next one of the cache.
    pub(super) is_linked: bool,
    /// The address after it.
    pub(super) end: u32,
}

/// A decoded packet, with the properties that the packet before it needs.
pub(super) struct DecodedPacket {
    pub(super) packet: Packet,
    /// The registers that it writes in E1, as bits.
    pub(super) writes: u64,
}

/// Reports whether bytes look like code of this processor, judging by their first words.
#[must_use]
pub fn is_code(bytes: &[u8]) -> bool {
    let words = bytes.as_chunks::<4>().0;
    !words.is_empty() && words.iter().take(MOST).all(|word| Inst::decode(u32::from_le_bytes(*word)).is_ok())
}

/// The reason why there is no packet.
pub(super) enum NoPacket {
    /// The address does not hold code of this context.
    Outside,
    /// The words are wrong.
    Fault(Fault),
}

/// The addresses of the instructions of the packet at `at`, in the order in which they are executed.
pub(super) fn places<M: Memory>(memory: &M, at: u32) -> Vec<u32> {
    fetch(memory, at)
        .and_then(|(insts, _)| order(&insts).map_err(NoPacket::Fault))
        .map_or_else(|_| Vec::new(), |ordered| ordered.into_iter().map(|(at, _)| at).collect())
}

/// The instructions of the packet at `at` that have an effect, in execution order.
pub(super) fn instructions<M: Memory>(memory: &M, at: u32) -> Vec<Inst> {
    let words = places(memory, at).into_iter().filter_map(|at| memory.fetch(at));
    words.filter_map(|word| Inst::decode(word).ok()).collect()
}

/// Decodes the packet at `at`; its instructions are appended to `micros`.
pub(super) fn decode<M: Memory>(
    memory: &M,
    at: u32,
    micros: &mut Vec<MicroOp>,
) -> Result<DecodedPacket, NoPacket> {
    let (insts, end) = fetch(memory, at)?;
    let cycles = insts.iter().map(|(_, inst)| inst.cycles()).max().unwrap_or(1);
    let first = micros.len() as u32;
    micros.extend(order(&insts).map_err(NoPacket::Fault)?.into_iter().map(|(_, micro)| micro));
    let writes = insts.iter().fold(0, |writes, (_, inst)| writes | written(*inst, 1));
    let packet = Packet {
        delays: delays(&insts, &micros[first as usize..]),
        first,
        count: (micros.len() as u32 - first) as u8,
        cycles: cycles as u8,
        moves_stack: insts
            .iter()
            .any(|(_, inst)| inst.writes().any(|write| write.reg.index() == usize::from(STACK))),
        has_branch: insts.iter().any(|(_, inst)| inst.branch().is_some()),
        is_linked: false,
        is_idle: insts.iter().any(|(_, inst)| plan(*inst).work == Work::Idle),
        end,
    };
    Ok(DecodedPacket { packet, writes })
}

/// The delays after which results, branches and later reads of a packet may happen, as bits.
fn delays(insts: &[(u32, Inst)], micros: &[MicroOp]) -> u16 {
    let results = insts.iter().flat_map(|(_, inst)| inst.writes()).map(|write| u32::from(write.stage));
    let results = results.filter(|stage| *stage > 1).fold(0, |bits, stage| bits | 1 << stage);
    let has_branch = insts.iter().any(|(_, inst)| inst.branch().is_some());
    let reads_later = insts.iter().any(|(_, inst)| inst.reads().any(|read| read.first > 1));
    let is_deferred = micros.iter().any(|micro| micro.flags & DEFERRED != 0);
    results | u16::from(has_branch) << BRANCH | u16::from(reads_later || is_deferred) << 1
}

/// The instructions of the packet at `at` with their addresses, and the address after it.
fn fetch<M: Memory>(memory: &M, at: u32) -> Result<(Vec<(u32, Inst)>, u32), NoPacket> {
    let mut insts = Vec::with_capacity(MOST);
    let mut end = at;
    loop {
        let Some(word) = memory.fetch(end) else { return Err(NoPacket::Outside) };
        let inst = Inst::decode(word).map_err(|_| NoPacket::Fault(Fault::BadWord { at: end, word }))?;
        insts.push((end, inst));
        end = end.wrapping_add(4);
        if word & PARALLEL == 0 {
            break;
        }
        if insts.len() == MOST {
            return Err(NoPacket::Fault(Fault::LongPacket { at }));
        }
    }
    Ok((insts, end))
}

/// An instruction with the facts that determine the order.
struct OrderedInst {
    at: u32,
    micro: MicroOp,
    inst: Inst,
    /// Registers read in E1, as bits.
    reads: u64,
    /// Registers written in E1, as bits.
    writes: u64,
}

/// The instructions with their addresses, in an order in which each may write at once, or defers.
fn order(insts: &[(u32, Inst)]) -> Result<Vec<(u32, MicroOp)>, Fault> {
    let mut open: Vec<OrderedInst> = insts
        .iter()
        .filter(|(_, inst)| plan(*inst).work != Work::Nop)
        .map(|(at, inst)| OrderedInst {
            at: *at,
            micro: resolve(*at, *inst),
            inst: *inst,
            reads: reads(*inst),
            writes: written(*inst, 1),
        })
        .collect();
    // A load sees memory before the packet's stores.
    open.sort_by_key(|one| one.inst.is_store());
    defer_shared(&mut open)?;
    for index in 0..open.len() {
        let later = bits(open[index].inst.reads().filter(|read| read.first > 1).map(|read| read.reg));
        let until = if open[index].micro.work == Work::Mpydp { 2 } else { 1 };
        if open.iter().all(|other| written(other.inst, until) & later == 0) {
            open[index].micro.flags |= STEADY;
        }
    }
    let mut ordered = Vec::with_capacity(open.len());
    while !open.is_empty() {
        let is_free = |index: &usize| {
            let one = &open[*index];
            let others = open.iter().enumerate().filter(|(other, _)| other != index);
            let is_read = others.clone().any(|(_, other)| other.reads & one.writes != 0);
            let store_too_soon =
                one.inst.is_store() && others.clone().any(|(_, other)| !other.inst.is_store());
            !store_too_soon && (!is_read || one.micro.flags & DEFERRED != 0)
        };
        let free = (0..open.len()).find(is_free);
        let mut next = open.remove(free.unwrap_or(0));
        if free.is_none() {
            next.micro.flags |= DEFERRED;
        }
        ordered.push((next.at, next.micro));
    }
    Ok(ordered)
}

/// Handles results of E1 for the same register: a certain conflict is a fault, a possible one is detected when the
/// results land.
fn defer_shared(open: &mut [OrderedInst]) -> Result<(), Fault> {
    for index in 0..open.len() {
        for other in index + 1..open.len() {
            let shared = open[index].writes & open[other].writes;
            if shared == 0 {
                continue;
            }
            let (one, two) = (open[index].inst.pred(), open[other].inst.pred());
            if one == two {
                let reg = Reg::from_index(shared.trailing_zeros() as usize).unwrap_or(Reg::a(0));
                return Err(Fault::TwoWriters { reg });
            }
            open[index].micro.flags |= DEFERRED;
            open[other].micro.flags |= DEFERRED;
        }
    }
    Ok(())
}

fn bits(regs: impl Iterator<Item = Reg>) -> u64 {
    regs.fold(0, |bits, reg| bits | 1 << reg.index())
}

/// The registers that an instruction writes up to a stage, as bits.
fn written(inst: Inst, until: u8) -> u64 {
    bits(inst.writes().filter(|write| write.stage <= until).map(|write| write.reg))
}

/// Everything an instruction may read in the cycle of its issue, its condition included.
fn reads(inst: Inst) -> u64 {
    // High halves that are read later than E1 see the packet's own results.
    bits(inst.reads().filter(|read| read.first == 1).map(|read| read.reg))
        | bits(inst.pred().reg().into_iter())
}

fn resolve(at: u32, inst: Inst) -> MicroOp {
    let WorkPlan { work, extra, swaps, is_unsigned } = plan(inst);
    let mut micro = MicroOp {
        work,
        pred: inst.pred().reg().map_or(TRUE, |reg| reg.index() as u8),
        inverted: matches!(inst.pred(), c67x::Pred::Unless(_)),
        a: ZERO,
        b: ZERO,
        a_high: ZERO,
        b_high: ZERO,
        dst: ZERO,
        extra,
        flags: if is_unsigned { UNSIGNED } else { 0 },
        imm: 0,
    };
    for (field, kind) in inst.op().row().operands {
        if let Some(operand) = inst.field(*field) {
            micro.set(*field, *kind, operand, inst);
        }
    }
    if let Some(Branch::Near { bytes }) = inst.branch() {
        micro.imm = target(at, bytes);
    }
    if inst.reads_destination() {
        micro.a = micro.dst;
    }
    if swaps {
        std::mem::swap(&mut micro.a, &mut micro.b);
    }
    (micro.a_high, micro.b_high) = (micro.a | 1, micro.b | 1);
    micro
}

impl MicroOp {
    /// Reports whether its condition holds.
    #[inline(always)]
    pub(super) fn is_executed(&self, regs: &[u32; 256]) -> bool {
        self.pred == TRUE || (regs[usize::from(self.pred)] == 0) == self.inverted
    }

    fn set(&mut self, field: Field, kind: Kind, operand: Operand, inst: Inst) {
        match (field, operand) {
            (Field::Src1, Operand::Reg(reg)) => self.a = reg.index() as u8,
            (Field::Src1, Operand::Pair(pair)) => {
                self.a = pair.low().index() as u8;
                self.flags |= if kind == Kind::L { LONG1 } else { 0 };
            }
            (Field::Src2, Operand::Reg(reg)) => self.b = reg.index() as u8,
            (Field::Src2, Operand::Pair(pair)) => {
                self.b = pair.low().index() as u8;
                self.flags |= if kind == Kind::L { LONG2 } else { 0 };
            }
            (Field::Src2, Operand::Control(control)) => self.extra = control.number() as u8,
            (Field::Dst, Operand::Control(control)) => self.extra = control.number() as u8,
            (Field::Dst | Field::Src, Operand::Reg(reg)) => self.dst = reg.index() as u8,
            (Field::Dst | Field::Src, Operand::Pair(pair)) => self.dst = pair.low().index() as u8,
            (Field::Csta, Operand::Const(value)) => self.imm |= value.cast_unsigned() << 5,
            (Field::Cstb, Operand::Const(value)) => self.imm |= value.cast_unsigned(),
            (Field::Cst, Operand::Const(value)) if kind == Kind::H16 => {
                self.imm = value.cast_unsigned() << 16;
            }
            (Field::Src1 | Field::Cst, Operand::Const(value)) => self.imm = value.cast_unsigned(),
            (Field::Mem, Operand::Mem(mem)) => {
                let shift = inst.mnemonic().bytes().unwrap_or(1).trailing_zeros();
                self.a = mem.base.index() as u8;
                self.extra = shift as u8;
                match mem.offset {
                    Offset::Const(offset) => {
                        let bytes = u32::from(offset) << shift;
                        self.imm = if mem.negative { bytes.wrapping_neg() } else { bytes };
                    }
                    Offset::Reg(reg) => {
                        self.b = reg.index() as u8;
                        self.flags |= if mem.negative { NEGATIVE } else { 0 };
                    }
                }
                self.flags |= match mem.update {
                    Update::None => 0,
                    Update::Before => UPDATES,
                    Update::After => UPDATES | AFTER,
                };
            }
            // Cycles of a NOP, targets and return addresses of branches: not among the sources.
            (_, Operand::Const(_) | Operand::Target(_) | Operand::Irp | Operand::Nrp) => {}
            (_, Operand::Reg(_) | Operand::Pair(_) | Operand::Mem(_) | Operand::Control(_)) => {}
        }
    }
}
