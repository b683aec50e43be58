//! The packets of a loop with their registers renamed: one copy for each renaming with which a packet is reached.
//!
//! A loop is left before a packet that cannot be renamed, and the interpreter of single packets continues. Such a
//! packet has a conditional result that lands after the first stage, a branch to the address in a register, or a double
//! instruction whose high words are not in flight yet.

use std::collections::{BTreeMap, VecDeque};
use std::ops::RangeInclusive;

use c67x::Inst;

use super::super::decode::{DEFERRED, FORESEEN, MicroOp, Packet, STACK, STEADY, TRUE, UPDATES, ZERO};
use super::super::pipeline::BRANCH;
use super::super::work::Work;
use super::renaming::{BranchCondition, EffectShape, PendingBranch, PendingResult, Renaming, Spares, Width};

/// The limit of packets in a loop, counted once for each renaming.
const MOST: usize = 512;
/// Bytes from a backward branch to the end of the packets that are executed before it arrives.
const SHADOW: u32 = 6 * 32;

/// A packet with its registers renamed, or a place where the loop is left.
#[derive(Debug)]
pub(super) struct RenamedPacket {
    pub(super) pc: u32,
    /// Its instructions, in the order in which they are executed.
    pub(super) micros: Box<[MicroOp]>,
    pub(super) cycles: u8,
    /// True if the loop is left before it.
    pub(super) is_exit: bool,
    /// True if it needs more work than continuing with the next packet.
    pub(super) is_special: bool,
    /// The location of the stack pointer, if the packet writes it.
    pub(super) stack: Option<u8>,
    /// The packet that follows if no branch arrives.
    pub(super) next: u32,
    /// The branch that arrives at its end.
    pub(super) arrival: Option<Arrival>,
}

/// A branch that arrives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// The condition; `None` for a branch that is always taken.
    pub(super) decider: Option<BranchCondition>,
    pub(super) to: u32,
    /// The packet of the branch, if it should be noted.
    pub(super) from: Option<u32>,
    /// Cycles that pass after it if the branch is not taken.
    pub(super) rest: u8,
}

/// The locations of registers at a packet.
#[derive(Debug)]
pub(super) struct Borders {
    /// Before the packet.
    pub(super) before: Renaming,
    /// In the cycle of the packet, with the effects that it has issued.
    issued: Renaming,
    /// Number of landings that are issued before each instruction.
    counts: Vec<usize>,
    /// The number of the instruction that is a branch.
    branch: Option<usize>,
}

/// A loop as planned.
#[derive(Debug, Default)]
pub(super) struct LoopPlan {
    pub(super) packets: Vec<RenamedPacket>,
    pub(super) borders: Vec<Borders>,
}

/// A packet, and its instructions in the order in which they are executed.
pub(super) type FoundPacket = Option<(Packet, Vec<(Inst, MicroOp)>)>;

/// Finds the packet at an address.
pub(super) type PacketFinder<'a> = dyn FnMut(u32) -> FoundPacket + 'a;

struct Planner<'a, 'f> {
    find: &'a mut PacketFinder<'f>,
    /// The addresses of the packets of the loop.
    range: RangeInclusive<u32>,
    found: BTreeMap<u32, FoundPacket>,
    spares: Spares,
    planned: LoopPlan,
    known: BTreeMap<(u32, Renaming), u32>,
    open: VecDeque<u32>,
}

/// Plans the loop that is entered at `pc` with these effects in flight and ends with the branch in the packet at
/// `last`; `None` if its first packet cannot be part of a loop.
pub(super) fn plan(
    pc: u32,
    last: u32,
    flying: &[EffectShape],
    find: &mut PacketFinder<'_>,
) -> Option<LoopPlan> {
    let mut spares = Spares::new();
    let entry = Renaming::at_entry(flying, &mut spares)?;
    let mut planner = Planner {
        find,
        range: pc..=last.saturating_add(SHADOW),
        found: BTreeMap::new(),
        spares,
        planned: LoopPlan::default(),
        known: BTreeMap::new(),
        open: VecDeque::new(),
    };
    planner.packet_at(pc, entry);
    while let Some(index) = planner.open.pop_front() {
        if planner.planned.packets.len() < MOST {
            planner.fill(index as usize);
        }
    }
    let mut planned = planner.planned;
    for index in 0..planned.packets.len() {
        let next = planned.packets[index].next as usize;
        planned.packets[index].is_special |= planned.packets[next].is_exit;
    }
    planned.packets.first().is_some_and(|packet| !packet.is_exit).then_some(planned)
}

impl Borders {
    /// The locations of registers before the packet's instruction with this number, including the results that earlier
    /// instructions of the packet have issued.
    pub(super) fn before_instruction(&self, number: usize) -> Renaming {
        let mut renaming = self.issued.clone();
        renaming.landings.truncate(self.counts.get(number).copied().unwrap_or(usize::MAX));
        if self.branch.is_some_and(|branch| branch >= number) {
            renaming.jumps.retain(|jump| u64::from(jump.due) != BRANCH);
        }
        renaming
    }
}

impl Planner<'_, '_> {
    /// The index of a packet with a renaming, which is filled in later.
    fn packet_at(&mut self, pc: u32, renaming: Renaming) -> u32 {
        let LoopPlan { packets, borders, .. } = &mut self.planned;
        *self.known.entry((pc, renaming)).or_insert_with_key(|(pc, renaming)| {
            let index = packets.len() as u32;
            packets.push(RenamedPacket {
                pc: *pc,
                micros: Box::default(),
                cycles: 0,
                is_exit: true,
                is_special: false,
                stack: None,
                next: index,
                arrival: None,
            });
            borders.push(Borders {
                before: renaming.clone(),
                issued: renaming.clone(),
                counts: Vec::new(),
                branch: None,
            });
            self.open.push_back(index);
            index
        })
    }

    /// Fills in a packet if it belongs to the loop.
    fn fill(&mut self, index: usize) -> Option<()> {
        let pc = self.planned.packets[index].pc;
        if !self.range.contains(&pc) {
            return None;
        }
        let (packet, insts) = self.found.entry(pc).or_insert_with(|| (self.find)(pc)).clone()?;
        if packet.is_idle {
            return None;
        }
        let before = self.planned.borders[index].before.clone();
        let mut issued = before.clone();
        let (mut micros, mut counts) = (Vec::new(), Vec::new());
        for (inst, micro) in &insts {
            counts.push(issued.landings.len());
            micros.push(self.instruction(pc, &before, &mut issued, *inst, *micro)?);
        }
        if packet.has_branch {
            issued.hold_interrupts();
        }
        let (cycles, next, arrival) = self.follow(&packet, issued.clone())?;
        let has_store = insts.iter().any(|(inst, _)| inst.is_store());
        self.planned.packets[index] = RenamedPacket {
            pc,
            micros: micros.into_boxed_slice(),
            cycles,
            is_exit: false,
            is_special: has_store || packet.moves_stack || arrival.is_some(),
            stack: packet.moves_stack.then(|| before.place(STACK)),
            next,
            arrival,
        };
        let branch = insts.iter().position(|(inst, _)| inst.branch().is_some());
        self.planned.borders[index] = Borders { before, issued, counts, branch };
        Some(())
    }

    /// The cycles that pass after a packet, the packet that follows, and the branch that arrives.
    fn follow(&mut self, packet: &Packet, mut renaming: Renaming) -> Option<(u8, u32, Option<Arrival>)> {
        renaming.sort();
        for cycle in 1..=packet.cycles {
            let Some(PendingBranch { target: pc, decider, from, .. }) = renaming.pass() else { continue };
            let to = self.packet_at(pc, renaming.clone());
            if decider.is_none() {
                return Some((cycle, to, Some(Arrival { decider, to, from, rest: 0 })));
            }
            let rest = packet.cycles - cycle;
            // Another branch within the same packet is rare.
            let is_through = (0..rest).all(|_| renaming.pass().is_none());
            let next = is_through.then(|| self.packet_at(packet.end, renaming))?;
            return Some((cycle, next, Some(Arrival { decider, to, from, rest })));
        }
        Some((packet.cycles, self.packet_at(packet.end, renaming), None))
    }

    /// Renames the registers of an instruction; its results are added to `issued`.
    fn instruction(
        &mut self,
        pc: u32,
        before: &Renaming,
        issued: &mut Renaming,
        inst: Inst,
        micro: MicroOp,
    ) -> Option<MicroOp> {
        if inst.branch().is_some() {
            return self.branch(pc, before, issued, micro);
        }
        let mut renamed = micro;
        for reg in [&mut renamed.pred, &mut renamed.a, &mut renamed.b, &mut renamed.dst] {
            *reg = before.place(*reg);
        }
        let [cycles1, cycles2] = later_reads(before, inst, micro)?;
        renamed.a_high = before.after(cycles1, micro.a_high);
        renamed.b_high = before.after(cycles2, micro.b_high);
        let base = (micro.flags & UPDATES != 0).then_some(micro.a);
        let mut results: Vec<(u8, u8)> =
            inst.writes().map(|write| (write.reg.index() as u8, write.stage)).collect();
        let is_deferred = micro.flags & DEFERRED != 0;
        if let Some(base) = base {
            // The address is written to the register's own place, as every result of one word of the first stage.
            results.retain(|result| *result != (base, 1));
            if is_deferred || issued.has_result(1, base) {
                return None;
            }
        }
        match results[..] {
            [] => return Some(renamed),
            [(reg, 1)] if !is_deferred => return (!issued.has_result(1, reg)).then_some(renamed),
            _ => {}
        }
        // `MVKH` reads its destination.
        if micro.pred != TRUE || micro.work == Work::Mvkh {
            return None;
        }
        let width = if results.len() == 1 { Width::Word } else { Width::Pair };
        renamed.dst = self.spares.find(issued, micro.dst, width)?;
        for (reg, due) in results {
            if reg & !1 != micro.dst & !1 || issued.has_result(due, reg) {
                return None;
            }
            issued.landings.push(PendingResult { due, reg, place: renamed.dst & !1 | reg & 1 });
        }
        Some(renamed)
    }

    /// Adds a branch; its executor keeps the value of the condition until the branch arrives.
    fn branch(
        &mut self,
        pc: u32,
        before: &Renaming,
        issued: &mut Renaming,
        micro: MicroOp,
    ) -> Option<MicroOp> {
        let due = BRANCH as u8;
        if micro.work != Work::BranchTo || issued.has_branch(due) {
            return None;
        }
        let constant = MicroOp { pred: TRUE, inverted: false, a: ZERO, b: ZERO, dst: ZERO, imm: 0, ..micro };
        let (decider, renamed) = if micro.pred == TRUE {
            (None, MicroOp { work: Work::Nop, ..constant })
        } else {
            let place = self.spares.find_decider(issued)?;
            let copied = MicroOp { work: Work::Add, a: before.place(micro.pred), dst: place, ..constant };
            (Some(BranchCondition { place, inverted: micro.inverted }), copied)
        };
        issued.jumps.insert(0, PendingBranch { due, target: micro.imm, decider, from: Some(pc) });
        Some(renamed)
    }
}

/// The delays with which an instruction reads the high words of s1 and of s2; `None` if they may differ from the words
/// in flight before its packet.
fn later_reads(before: &Renaming, inst: Inst, micro: MicroOp) -> Option<[u8; 2]> {
    if inst.reads().all(|read| read.first == 1) {
        return Some([0, 0]);
    }
    let is_product = micro.work == Work::Mpydp;
    let is_foreseen = !is_product || micro.extra & FORESEEN != 0 && !before.has_branch(1);
    let is_known = micro.flags & STEADY != 0 && is_foreseen;
    is_known.then_some(if is_product { [2, 1] } else { [1, 1] })
}
