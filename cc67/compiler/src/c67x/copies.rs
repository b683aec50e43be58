//! Copy propagation, and removal of unused results.
//!
//! Instruction selection joins the halves of pairs and splits them again, shifts by whole words, and combines values
//! with words that are 0. Block by block, a source that is a copy is replaced by the original, as long as neither
//! changes; an instruction that becomes a copy in this way is treated as one, too. Unused results are removed, except
//! loads.

use cranelift_entity::SecondaryMap;

use super::code::{Arg, Base, Code, Inst, VReg};
use super::forms::Kind;

/// Rewrites all blocks.
pub(super) fn run(code: &mut Code) {
    let mut known = Copies { pairs: SecondaryMap::with_capacity(code.regs.len()), list: Vec::new() };
    known.pairs.resize(code.regs.len());
    for (reg, info) in &code.regs {
        known.pairs[reg] = info.is_pair;
    }
    for block in &mut code.blocks {
        known.list.clear();
        for inst in &mut block.insts {
            known.inst(inst);
        }
    }
    remove_unread(code);
}

/// The limit of copies known at the same time.
const MOST: usize = 256;

/// The copies that hold at a position in a block.
struct Copies {
    pairs: SecondaryMap<VReg, bool>,
    /// A word, and the word or the number 0 of which it is a copy.
    list: Vec<(Arg, Arg)>,
}

const ZERO: Arg = Arg::number(0);

impl Copies {
    fn inst(&mut self, inst: &mut Inst) {
        if matches!(inst.kind, Kind::Begin | Kind::Call | Kind::FrameAddress) {
            if let Some((reg, _)) = inst.written_register() {
                self.invalidate(Arg::Reg(reg));
            }
            return;
        }
        inst.src1 = self.source(inst.src1);
        inst.src2 = self.source(inst.src2);
        if let Some(place) = &mut inst.place {
            if let Base::Reg(base) = place.base
                && place.step == 0
                && let Some(Arg::Reg(reg)) = self.source_of(Arg::Reg(base))
            {
                place.base = Base::Reg(reg);
            }
            if let Some(Arg::Reg(reg)) = place.index.and_then(|index| self.source_of(Arg::Reg(index))) {
                place.index = Some(reg);
            }
        }
        self.simplify(inst);
        if let Some(reg) = inst.incremented_base() {
            self.invalidate(Arg::Reg(reg));
        }
        if inst.dst.reg().is_some() {
            self.invalidate(inst.dst);
        }
        let is_word = inst.dst.reg().is_some_and(|reg| !matches!(inst.dst, Arg::Reg(_)) || !self.pairs[reg]);
        if inst.condition.is_some() || !is_word {
            return;
        }
        let from = if inst.kind == Kind::Move { inst.src2 } else { inst.src1 };
        let is_copy = inst.kind == Kind::Move || inst.kind == Kind::Mvk && from == ZERO;
        if is_copy && from != inst.dst && self.list.len() < MOST {
            self.list.push((inst.dst, from));
        }
    }

    /// The word of which a word is a copy.
    fn source_of(&self, arg: Arg) -> Option<Arg> {
        self.list.iter().find(|(copy, _)| *copy == arg).map(|(_, from)| *from)
    }

    /// The source to read in place of another.
    fn source(&self, arg: Arg) -> Arg {
        let Some(reg) = arg.reg() else { return arg };
        if matches!(arg, Arg::Reg(_)) && self.pairs[reg] {
            let halves = (self.source_of(Arg::Low(reg)), self.source_of(Arg::High(reg)));
            return match halves {
                (Some(Arg::Low(low)), Some(Arg::High(high))) if low == high => Arg::Reg(low),
                _ => arg,
            };
        }
        self.source_of(arg).filter(|from| from.reg().is_some()).unwrap_or(arg)
    }

    /// Turns shifts by 0 and combinations with 0 into copies.
    fn simplify(&self, inst: &mut Inst) {
        let is_zero = |arg: Arg| arg == ZERO || self.source_of(arg) == Some(ZERO);
        let is_shift = matches!(inst.kind, Kind::Shl | Kind::Shr | Kind::Shru);
        let is_sum = matches!(inst.kind, Kind::Or | Kind::Add | Kind::Xor);
        if is_shift && inst.src1 == ZERO || is_sum && is_zero(inst.src1) {
            self.copy(inst, inst.src2);
        } else if is_sum && is_zero(inst.src2) {
            self.copy(inst, inst.src1);
        } else if (is_shift || inst.kind == Kind::Move) && is_zero(inst.src2) {
            (inst.kind, inst.src1, inst.src2) = (Kind::Mvk, ZERO, Arg::None);
        }
    }

    fn copy(&self, inst: &mut Inst, from: Arg) {
        if let Arg::Value(_) = from {
            (inst.kind, inst.src1, inst.src2) = (Kind::Mvk, from, Arg::None);
        } else if self.source_of(from) == Some(ZERO) {
            (inst.kind, inst.src1, inst.src2) = (Kind::Mvk, ZERO, Arg::None);
        } else {
            (inst.kind, inst.src1, inst.src2) = (Kind::Move, ZERO, from);
        }
    }

    /// Forgets the copies of a register that changes: of a word of it, or of all.
    fn invalidate(&mut self, changed: Arg) {
        let touches = |arg: Arg| {
            let is_other_half =
                matches!((arg, changed), (Arg::Low(_), Arg::High(_)) | (Arg::High(_), Arg::Low(_)));
            arg.reg().is_some() && arg.reg() == changed.reg() && !is_other_half
        };
        self.list.retain(|(copy, from)| !touches(*copy) && !touches(*from));
    }
}

/// Removes instructions without effect whose result is not read.
fn remove_unread(code: &mut Code) {
    loop {
        let mut is_read: SecondaryMap<VReg, bool> = SecondaryMap::with_capacity(code.regs.len());
        is_read.resize(code.regs.len());
        for block in &code.blocks {
            for inst in &block.insts {
                visit_sources(inst, |reg| is_read[reg] = true);
            }
            if let Some(reg) = block.terminator.read() {
                is_read[reg] = true;
            }
        }
        for (reg, _) in code.calls.iter().flat_map(|call| &call.arguments) {
            is_read[*reg] = true;
        }
        let mut is_changed = false;
        for block in &mut code.blocks {
            block.insts.retain(|inst| {
                let is_kept = inst.kind == Kind::Call
                    || inst.kind.bytes().is_some()
                    || inst.written_register().is_none_or(|(reg, _)| is_read[reg]);
                is_changed |= !is_kept;
                is_kept
            });
        }
        if !is_changed {
            return;
        }
    }
}

/// The registers read by an instruction, except a register that it merely updates.
fn visit_sources(inst: &Inst, mut visit: impl FnMut(VReg)) {
    let own = inst.dst.reg().filter(|_| inst.kind.bytes().is_none());
    inst.visit_reads(|reg| {
        if Some(reg) != own {
            visit(reg);
        }
    });
}
