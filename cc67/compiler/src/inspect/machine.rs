//! The processor's code of a function as packets and blocks.
//!
//! A block begins at the target of a jump, at the return point of a call, and at the end of a branch's delay slots. Its
//! successors, and the cycles until each, are determined by the branches alone; a jump through a table leads to the
//! addresses that follow the code.

use std::collections::BTreeSet;
use std::ops::Range;

use c67x::{Branch, Inst, PARALLEL, Pred, Reg};

use super::{Inspection, symbols::EntryKind};
use crate::c67x::text::constant;

/// Cycles from the issue of a branch to the issue of its target.
const BRANCH: u32 = 6;

/// The register of the return address.
const LINK: Reg = c67x::convention::LINK;

/// Instructions that issue in the same cycle.
#[derive(Clone, Debug)]
pub(super) struct Packet {
    /// The address of the first.
    pub(super) at: u32,
    pub(super) insts: Vec<Inst>,
    /// Cycles since the beginning of the function, branches aside.
    pub(super) time: u32,
    pub(super) cycles: u32,
}

/// An edge from one block to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    /// The block's number.
    pub(super) to: usize,
    /// Cycles from the beginning of one block to the beginning of the other.
    pub(super) cycles: u32,
}

/// Packets that are executed one after another.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) packets: Range<usize>,
    /// Cycles from its beginning to its end.
    pub(super) cycles: u32,
    pub(super) edges: Vec<Edge>,
    /// The target of the call at its end.
    pub(super) call: Option<CallTarget>,
}

/// The target of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CallTarget {
    /// The function at an address.
    At(u32),
    /// The address in a register.
    Pointer,
}

/// The code of a function.
#[derive(Clone, Debug)]
pub(super) struct Routine {
    pub(super) name: String,
    pub(super) address: u32,
    /// Bytes, tables included.
    pub(super) bytes: u32,
    pub(super) packets: Vec<Packet>,
    pub(super) blocks: Vec<Block>,
}

/// The functions of an image for the processor, or the reason why they are unknown.
pub(super) fn functions(inspection: &Inspection) -> Result<Vec<Routine>, String> {
    let image = &inspection.image;
    if image.target != coff::Target::C6000 {
        return Err("the image holds no code for the controller's processor".to_owned());
    }
    let text = image.section(".text").ok_or("there is no section .text")?;
    let words: Vec<u32> =
        text.data().as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let end = text.address + words.len() as u32 * 4;
    let functions = inspection.symbols.iter().filter(|entry| entry.kind == EntryKind::Function);
    let functions = functions.filter(|entry| (text.address..end).contains(&entry.address));
    let mut all = Vec::new();
    for function in functions {
        let next = inspection
            .symbols
            .iter()
            .find(|other| other.kind == EntryKind::Function && other.address > function.address);
        let limit = next.map_or(end, |next| next.address).min(end);
        let limit = function.size.map_or(limit, |size| limit.min(function.address + size));
        let index = |address: u32| ((address - text.address) / 4) as usize;
        let own = words.get(index(function.address)..index(limit)).unwrap_or_default();
        all.push(Routine::new(&function.name, function.address, own)?);
    }
    Ok(all)
}

impl Routine {
    fn new(name: &str, address: u32, words: &[u32]) -> Result<Self, String> {
        let range = address..address + words.len() as u32 * 4;
        // Tables of addresses follow the code.
        let is_entry = |word: &u32| range.contains(word) && word.is_multiple_of(4);
        let table = words.iter().rev().take_while(|word| is_entry(word)).count();
        let code = &words[..words.len() - table];
        let packets = packets(address, code).map_err(|at| format!("{name}: no instruction at {at:08x}"))?;
        let mut own = Self {
            name: name.to_owned(),
            address,
            bytes: words.len() as u32 * 4,
            packets,
            blocks: Vec::new(),
        };
        own.find_blocks(&words[words.len() - table..]);
        Ok(own)
    }

    /// The packet that is issued at a time, or the first after it.
    fn at_time(&self, time: u32) -> usize {
        self.packets.partition_point(|packet| packet.time < time)
    }

    fn at_address(&self, address: u32) -> Option<usize> {
        self.packets.binary_search_by_key(&address, |packet| packet.at).ok()
    }

    /// The branches: the packet, the instruction, and the packet where the shadow ends.
    fn branches(&self) -> Vec<(usize, Inst, usize)> {
        let mut all = Vec::new();
        for (index, packet) in self.packets.iter().enumerate() {
            for inst in packet.insts.iter().filter(|inst| inst.branch().is_some()) {
                all.push((index, *inst, self.at_time(packet.time + BRANCH)));
            }
        }
        all
    }

    fn target(&self, packet: usize, inst: &Inst) -> Option<u32> {
        match inst.branch()? {
            Branch::Near { bytes } => Some(c67x::target(self.packets[packet].at, bytes)),
            Branch::Register(_) | Branch::Interrupt => None,
        }
    }

    fn find_blocks(&mut self, table: &[u32]) {
        let branches = self.branches();
        let mut starts: BTreeSet<usize> = std::iter::once(0).collect();
        starts.extend(table.iter().filter_map(|address| self.at_address(*address)));
        for (packet, inst, after) in &branches {
            starts.insert(*after);
            starts.extend(self.target(*packet, inst).and_then(|target| self.at_address(target)));
        }
        starts.retain(|start| *start < self.packets.len());
        let starts: Vec<usize> = starts.into_iter().collect();
        let ends = starts.iter().copied().skip(1).chain(std::iter::once(self.packets.len()));
        let mut blocks: Vec<Block> =
            starts.iter().copied().zip(ends).map(|(start, end)| self.block(start, end)).collect();
        let number = |packet: usize| starts.partition_point(|start| *start <= packet).saturating_sub(1);
        let mut ended = vec![false; blocks.len()];
        for (index, (packet, inst, after)) in branches.iter().enumerate() {
            let from = number(after.saturating_sub(1));
            let cycles = (self.packets[*packet].time + BRANCH)
                .saturating_sub(self.packets[blocks[from].packets.start].time);
            let others = branches[..index].iter().rev().take_while(|(.., end)| end + 1 >= *after);
            let is_certain = inst.pred() == Pred::Always
                || others.map(|(_, other, _)| other).any(|other| other.pred().excludes(inst.pred()));
            let targets: Vec<usize> = match (self.target(*packet, inst), inst.branch()) {
                (Some(target), _) => match self.at_address(target) {
                    Some(0) if self.sets_link(*packet) => {
                        blocks[from].call = Some(CallTarget::At(target));
                        continue;
                    }
                    Some(target) => vec![number(target)],
                    None if self.sets_link(*packet) => {
                        blocks[from].call = Some(CallTarget::At(target));
                        continue;
                    }
                    None => Vec::new(),
                },
                (None, Some(Branch::Register(reg))) if reg != LINK && !self.keeps_link(*packet, reg) => {
                    if self.sets_link(*packet) {
                        blocks[from].call =
                            Some(self.constant_at(*packet, reg).map_or(CallTarget::Pointer, CallTarget::At));
                        continue;
                    }
                    let mut targets: Vec<usize> =
                        table.iter().filter_map(|at| self.at_address(*at)).map(number).collect();
                    targets.sort_unstable();
                    targets.dedup();
                    targets
                }
                (None, _) => Vec::new(),
            };
            ended[from] |= is_certain;
            blocks[from].edges.extend(targets.into_iter().map(|to| Edge { to, cycles }));
        }
        let count = blocks.len();
        for (index, block) in blocks.iter_mut().enumerate() {
            if !ended[index] && index + 1 < count {
                block.edges.push(Edge { to: index + 1, cycles: block.cycles });
            }
        }
        self.blocks = blocks;
    }

    fn block(&self, start: usize, end: usize) -> Block {
        let cycles = self.packets[start..end].iter().map(|packet| packet.cycles).sum();
        Block { packets: start..end, cycles, edges: Vec::new(), call: None }
    }

    /// Reports whether the return address is set for the branch in a packet: in its delay slots or shortly before.
    fn sets_link(&self, packet: usize) -> bool {
        let time = self.packets[packet].time;
        let (from, to) = (self.at_time(time.saturating_sub(40)), self.at_time(time + BRANCH));
        let before = &self.packets[from..packet];
        // The return address of an earlier call does not count.
        let is_branch = |packet: &Packet| packet.insts.iter().any(|inst| inst.branch().is_some());
        let from = before.iter().rposition(is_branch).map_or(from, |at| from + at + 1);
        let sets = |inst: &Inst| inst.mem().is_none() && inst.writes().any(|write| write.reg == LINK);
        self.packets[from..to].iter().flat_map(|packet| &packet.insts).any(sets)
    }

    /// Reports whether a register holds the return address before a packet: it is copied from the link register, and
    /// restored at the ends of the function.
    fn keeps_link(&self, packet: usize, reg: Reg) -> bool {
        let before = self.packets[..packet].iter().flat_map(|packet| &packet.insts);
        let mut copies = 0;
        for inst in before.filter(|inst| inst.writes().any(|write| write.reg == reg)) {
            let is_restored =
                inst.is_load() && inst.mem().is_some_and(|mem| mem.base == c67x::convention::STACK);
            let mut reads = inst.reads().map(|read| read.reg);
            let is_copy = inst.mem().is_none() && reads.next() == Some(LINK) && reads.next().is_none();
            if !is_copy && !is_restored {
                return false;
            }
            copies += usize::from(is_copy);
        }
        copies > 0
    }

    /// The constant that a register holds at a packet: of an `MVK` and an `MVKH` before it.
    fn constant_at(&self, packet: usize, reg: Reg) -> Option<u32> {
        let mut high = None;
        for inst in self.packets[..packet].iter().rev().flat_map(|packet| packet.insts.iter().rev()) {
            if !inst.writes().any(|write| write.reg == reg) {
                continue;
            }
            let constant = constant(inst.encode(false));
            match (inst.op(), high) {
                (c67x::Op::Mvkh, None) => high = Some(constant << 16),
                (c67x::Op::Mvk, Some(high)) => return Some(high | constant),
                _ => return None,
            }
        }
        None
    }
}

/// The packets of words at an address; the address of a word that is not an instruction, if there is one.
fn packets(address: u32, words: &[u32]) -> Result<Vec<Packet>, u32> {
    let mut all: Vec<Packet> = Vec::new();
    let (mut time, mut joins) = (0, false);
    for (at, word) in (address..).step_by(4).zip(words) {
        let inst = Inst::decode(*word).map_err(|_| at)?;
        if !joins {
            time += all.last().map_or(0, |packet| packet.cycles);
            all.push(Packet { at, insts: Vec::new(), time, cycles: 1 });
        }
        if let Some(packet) = all.last_mut() {
            packet.cycles = packet.cycles.max(inst.cycles());
            packet.insts.push(inst);
        }
        joins = word & PARALLEL != 0;
    }
    Ok(all)
}

/// The target of a call of an address: functions out of reach are called through a jump after the program's code.
pub(super) fn resolve_trampoline(image: &coff::Image, address: u32) -> u32 {
    let far = || {
        let text = image.section(".text")?;
        let at = address.checked_sub(text.address)? as usize;
        let words = text.data().get(at..at + 12)?.as_chunks::<4>().0;
        let [low, high, jump] = [0, 1, 2].map(|index| words.get(index).map(|word| u32::from_le_bytes(*word)));
        let is = |word: u32, op: c67x::Op| Inst::decode(word).is_ok_and(|inst| inst.op() == op);
        let (low, high, jump) = (low?, high?, jump?);
        let is_far = is(low, c67x::Op::Mvk) && is(high, c67x::Op::Mvkh) && is(jump, c67x::Op::BReg);
        is_far.then(|| constant(high) << 16 | constant(low))
    };
    far().unwrap_or(address)
}
