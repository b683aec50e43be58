//! Unrolling of short loops with an unknown number of iterations.
//!
//! A jump back costs six cycles. So the second iteration follows the first under the first's condition, the third under
//! the conditions of both, and only the last one jumps. Instructions without observable effects are unconditional, in
//! separate registers, so that they need not wait for the condition; loads, stores and results that are read by the
//! next iteration or after the loop are conditional. So every access to memory is made exactly as in the source.

use cranelift_entity::SecondaryMap;

use super::code::{Arg, Base, Block, Code, Condition, Inst, Terminator, VReg, VRegInfo};
use super::forms::Kind;
use super::predicate::{self, UserBlocks};

/// The largest iteration that is unrolled, in instructions.
const LARGEST: usize = 20;
/// The limit of instructions in all iterations together.
const ALL: usize = 44;
/// The most iterations: each needs a register that is tested.
const MOST: usize = 4;
/// The most registers that are tested inside an iteration, for a loop to be unrolled.
const TESTED: usize = 2;

/// Rewrites the short single-block loops, except those with a bit in `skipped`; returns their number.
pub(super) fn run(code: &mut Code, skipped: u32) -> u32 {
    let mut count = 0;
    // Unrolled code uses the same registers as before, and new ones of its own.
    let homes = predicate::find_user_blocks(code);
    for number in 0..code.blocks.len() {
        let Some(back) = back_condition(&code.blocks[number], number as u32) else { continue };
        let Some(facts) = loop_facts(code, &homes, number, back) else { continue };
        let copies = MOST.min(ALL / code.blocks[number].insts.len().max(1)).min(MOST - facts.tested);
        if copies < 2 {
            continue;
        }
        count += 1;
        if skipped.checked_shr(count - 1).is_some_and(|bits| bits & 1 != 0) {
            continue;
        }
        let body = std::mem::take(&mut code.blocks[number].insts);
        let mut worker =
            Unroller { code, facts, out: body.clone(), names: SecondaryMap::new(), fresh: Vec::new() };
        let mut condition = back;
        for _ in 1..copies {
            condition = worker.iteration(&body, condition);
        }
        let out = worker.out;
        code.blocks[number].insts = out;
        code.blocks[number].unrolled = copies as u32;
        if let Some(read) = code.blocks[number].terminator.read_mut() {
            *read = condition.0;
        }
    }
    count
}

/// The condition under which a block jumps to itself.
fn back_condition(block: &Block, number: u32) -> Option<(VReg, bool)> {
    match block.terminator {
        Terminator::Branch { condition, negated, then, otherwise } if then != otherwise => {
            if then == number {
                Some((condition, negated))
            } else {
                (otherwise == number).then_some((condition, !negated))
            }
        }
        Terminator::Branch { .. }
        | Terminator::Jump(_)
        | Terminator::Table { .. }
        | Terminator::Return(_)
        | Terminator::Unreachable => None,
    }
}

/// The facts about a loop.
struct LoopFacts {
    /// The registers that an iteration writes and the next iteration, or the code after the loop, may read.
    carried: Vec<VReg>,
    /// The register of the jump back, and the instruction that writes it last.
    condition: VReg,
    last: usize,
    /// Number of registers that are tested inside an iteration.
    tested: usize,
}

/// Returns the facts for rewriting a loop; `None` if it cannot be rewritten.
fn loop_facts(
    code: &Code,
    homes: &SecondaryMap<VReg, UserBlocks>,
    number: usize,
    back: (VReg, bool),
) -> Option<LoopFacts> {
    let block = &code.blocks[number];
    let is_simple = |inst: &Inst| {
        !matches!(inst.kind, Kind::Call | Kind::FrameAddress)
            && inst.incremented_base().is_none()
            && (inst.kind.bytes().is_none() || inst.condition.is_none())
            && !matches!(inst.place, Some(place) if matches!(place.base, Base::Spill(_)))
    };
    if block.insts.is_empty() || block.insts.len() > LARGEST || !block.insts.iter().all(is_simple) {
        return None;
    }
    let is_outside = |reg: VReg| homes[reg].is_outside(number as u32);
    let mut written: Vec<VReg> = Vec::new();
    let mut carried: Vec<VReg> = Vec::new();
    let mut tested: Vec<VReg> = Vec::new();
    let mut last = None;
    for (index, inst) in block.insts.iter().enumerate() {
        inst.visit_reads(|reg| {
            if !written.contains(&reg) && !carried.contains(&reg) {
                carried.push(reg);
            }
        });
        if let Some((reg, _)) = inst.condition
            && !tested.contains(&reg)
        {
            tested.push(reg);
        }
        if let Some((reg, is_whole)) = inst.written_register() {
            // Half of a pair of which nothing is known yet counts as carried.
            if !is_whole && !written.contains(&reg) && !carried.contains(&reg) {
                carried.push(reg);
            }
            if !written.contains(&reg) {
                written.push(reg);
            }
            if reg == back.0 {
                last = Some((index, is_whole && matches!(inst.dst, Arg::Reg(_))));
            }
        }
    }
    let (last, is_whole) = last?;
    // The condition must not be used elsewhere.
    if !is_whole || is_outside(back.0) || carried.contains(&back.0) || tested.contains(&back.0) {
        return None;
    }
    if tested.len() > TESTED {
        return None;
    }
    carried.retain(|reg| written.contains(reg));
    for reg in written {
        if is_outside(reg) && !carried.contains(&reg) {
            carried.push(reg);
        }
    }
    Some(LoopFacts { carried, condition: back.0, last, tested: tested.len() })
}

struct Unroller<'a> {
    code: &'a mut Code,
    facts: LoopFacts,
    out: Vec<Inst>,
    /// The present name of each register that an iteration wrote.
    names: SecondaryMap<VReg, Option<VReg>>,
    /// The registers that have a name of this iteration.
    fresh: Vec<VReg>,
}

impl Unroller<'_> {
    /// Adds an iteration under a condition; returns the condition of the next one.
    fn iteration(&mut self, body: &[Inst], condition: (VReg, bool)) -> (VReg, bool) {
        self.fresh.clear();
        let next = self.reg_like(self.facts.condition);
        // If the iteration is not executed, neither is the next one.
        let never = i32::from(condition.1);
        let span = body.first().map_or(self.code.blocks[0].span, |inst| inst.span);
        self.out.push(Inst::new(Kind::Mvk, next.into(), Arg::number(never), Arg::None, span));
        for (index, inst) in body.iter().enumerate() {
            let mut inst = *inst;
            self.rename_reads(&mut inst);
            if index == self.facts.last {
                inst.dst = next.into();
                inst.condition = Some(condition);
                self.out.push(inst);
                self.names[self.facts.condition] = Some(next);
            } else {
                self.rename_written(&mut inst, Some(condition));
            }
        }
        for index in 0..self.facts.carried.len() {
            let reg = self.facts.carried[index];
            if let Some(name) = self.names[reg].filter(|_| self.fresh.contains(&reg)) {
                self.commit(reg, name, Some(condition), span);
            }
        }
        (next, condition.1)
    }

    fn reg_like(&mut self, reg: VReg) -> VReg {
        let info = self.code.regs[reg];
        self.code.reg(VRegInfo { side: None, hint: None, constant: None, ..info })
    }

    fn name(&self, reg: VReg) -> VReg {
        self.names[reg].unwrap_or(reg)
    }

    fn rename_reads(&self, inst: &mut Inst) {
        for arg in [&mut inst.src1, &mut inst.src2] {
            if let Arg::Reg(reg) | Arg::Low(reg) | Arg::High(reg) = arg {
                *reg = self.name(*reg);
            }
        }
        if let Some(place) = &mut inst.place {
            if let Base::Reg(reg) = &mut place.base {
                *reg = self.name(*reg);
            }
            if let Some(reg) = &mut place.index {
                *reg = self.name(*reg);
            }
        }
        if let Some((reg, _)) = &mut inst.condition {
            *reg = self.name(*reg);
        }
    }

    /// Renames the result for this iteration; a load or store gets the iteration's condition.
    fn rename_written(&mut self, inst: &mut Inst, condition: Condition) {
        let is_memory = inst.kind.bytes().is_some();
        let Some(reg) = inst.dst.reg() else {
            if is_memory {
                inst.condition = condition;
            }
            self.out.push(*inst);
            return;
        };
        let is_fresh = self.fresh.contains(&reg);
        let is_part = inst.keeps_destination() || matches!(inst.dst, Arg::Low(_) | Arg::High(_));
        if !(is_part && is_fresh) {
            let old = self.name(reg);
            let name = self.reg_like(reg);
            if is_part {
                self.commit(name, old, None, inst.span);
            }
            self.names[reg] = Some(name);
            if !is_fresh {
                self.fresh.push(reg);
            }
        }
        let name = self.name(reg);
        match &mut inst.dst {
            Arg::Reg(dst) | Arg::Low(dst) | Arg::High(dst) => *dst = name,
            Arg::None | Arg::Value(_) => {}
        }
        if is_memory {
            // Nobody reads the register if the iteration does not take place.
            self.out.push(Inst::new(Kind::Begin, name.into(), Arg::None, Arg::None, inst.span));
            inst.condition = condition;
        }
        self.out.push(*inst);
    }

    /// `to = from`, perhaps under a condition.
    fn commit(&mut self, to: VReg, from: VReg, condition: Condition, span: crate::source::Span) {
        let copy = |dst: Arg, src: Arg| {
            let mut inst = Inst::new(Kind::Move, dst, Arg::number(0), src, span);
            inst.condition = condition;
            inst
        };
        if self.code.regs[to].is_pair {
            if condition.is_none() {
                self.out.push(Inst::new(Kind::Begin, to.into(), Arg::None, Arg::None, span));
            }
            self.out.push(copy(Arg::Low(to), Arg::Low(from)));
            self.out.push(copy(Arg::High(to), Arg::High(from)));
        } else {
            self.out.push(copy(to.into(), from.into()));
        }
    }
}
