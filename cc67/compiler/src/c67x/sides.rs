//! Assigns every virtual register to one of the two register files, and copies operands that an instruction cannot
//! access.
//!
//! An instruction executes on the side of its result, a load or store on the side of its base. One source may come from
//! the other side over the cross path, if the form has one. Registers are assigned in the order of the code, such that
//! few operands cross and both sides have about the same load.

use c67x::Side;
use cranelift_entity::SecondaryMap;
use cranelift_entity::packed_option::PackedOption;

use super::abi;
use super::code::{Arg, Base, Code, Inst, MemoryPlace, VReg, VRegInfo};
use super::forms::{Crossing, Kind};

/// The cost of a source on the other side, in instructions of imbalance.
const CROSS: i32 = 3;
/// The most that imbalance counts: less than a source on the other side, of which only one can be reached in a cycle.
const IMBALANCE: i32 = 2;
/// The cost of a source on the other side that needs a copy, in instructions of imbalance.
const COPY: i32 = 6;
/// The cost of a side that differs from a register's hint.
const HINT: i32 = 4;
/// The cost of a side from which the reader of the result must fetch it.
const READER: i32 = 2;
/// The most that imbalance counts where a register is loaded.
const LOADS: i32 = 4;

/// The costs in single-block loops other than the number of instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Policy {
    /// For how many cycles an instruction has its unit for itself.
    weighs_units: bool,
    /// True if the side of a reader of the result counts, where that is decided.
    follows_readers: bool,
    /// True if the number of registers that each side loads counts.
    counts_loads: bool,
}

impl Policy {
    /// The policy that is best most often.
    pub(super) const USUAL: Self = Self { weighs_units: true, follows_readers: true, counts_loads: false };
    /// Alternative policies that may be better.
    pub(super) const OTHERS: [Self; 3] = [
        Self { counts_loads: true, ..Self::USUAL },
        Self { weighs_units: false, ..Self::USUAL },
        Self { weighs_units: false, follows_readers: false, counts_loads: false },
    ];
}

/// Places all registers and inserts copies.
pub(super) fn assign(code: &mut Code, policy: Policy) {
    for (reg, at) in &code.params {
        code.regs[*reg].side = Some(at.side());
    }
    spread_bases(code);
    let (indexes, readers) = (indexes(code), readers(code));
    for (number, block) in (0..).zip(&code.blocks) {
        let policy = block.terminator.targets().any(|to| to == number).then_some(policy);
        let (indexes, readers) = (&indexes, &readers);
        let mut load = SideLoad { indexes, readers, policy, insts: [0; 2], pairs: [0; 2], loads: [0; 2] };
        for inst in &block.insts {
            place(&mut code.regs, inst, &mut load);
        }
    }
    for info in code.regs.values_mut() {
        info.side.get_or_insert(Side::A);
    }
    let mut copier = Copier { regs: &mut code.regs, copies: Vec::new(), out: Vec::new() };
    for block in &mut code.blocks {
        copier.copies.clear();
        for inst in std::mem::take(&mut block.insts) {
            copier.inst(inst);
        }
        block.insts = std::mem::take(&mut copier.out);
    }
}

/// Distributes the accesses of a short loop over both sides: an access uses a unit on the side of its base.
fn spread_bases(code: &mut Code) {
    for (number, block) in (0..).zip(&code.blocks) {
        if !block.terminator.targets().any(|to| to == number) {
            continue;
        }
        let mut bases: Vec<(VReg, i32)> = Vec::new();
        for inst in block.insts.iter().filter(|inst| inst.kind.bytes().is_some()) {
            let Some(MemoryPlace { base: Base::Reg(base), index: None, .. }) = inst.place else { continue };
            match bases.iter_mut().find(|(known, _)| *known == base) {
                Some((_, count)) => *count += 1,
                None => bases.push((base, 1)),
            }
        }
        if bases.len() < 2 {
            continue;
        }
        let mut accesses = [0; 2];
        for (base, count) in &bases {
            if let Some(side) = code.regs[*base].side {
                accesses[side.bit() as usize] += count;
            }
        }
        bases.sort_by_key(|(_, count)| -count);
        for (base, count) in bases {
            let info = &mut code.regs[base];
            if info.side.is_none() && info.hint.is_none() {
                let side = less_loaded_side(&accesses);
                info.side = Some(side);
                accesses[side.bit() as usize] += count;
            }
        }
    }
}

type Regs = cranelift_entity::PrimaryMap<VReg, VRegInfo>;

/// Chooses the side of an instruction's result if it has none yet.
fn place(regs: &mut Regs, inst: &Inst, load: &mut SideLoad<'_>) {
    let is_nothing = matches!(inst.kind, Kind::Begin | Kind::Call);
    let side = match (inst.dst.reg(), inst.place) {
        (_, Some(place)) if inst.kind.bytes().is_some() => {
            if let Some(dst) = inst.dst.reg() {
                let wanted = load.side_for_load(regs, dst);
                let side = *regs[dst].side.get_or_insert(wanted);
                load.loads[side.bit() as usize] += 1;
            }
            match place.base {
                Base::Reg(base) => *regs[base].side.get_or_insert(Side::A),
                Base::Slot(_) | Base::Spill(_) | Base::Stack => Side::B,
            }
        }
        (Some(dst), _) => match regs[dst].side {
            Some(side) => side,
            None => {
                let side = best_side(regs, inst, dst, load);
                regs[dst].side = Some(side);
                side
            }
        },
        (None, _) => Side::A,
    };
    if !is_nothing {
        load.insts[side.bit() as usize] += load.weight(inst.kind);
    }
    if let Some(dst) = inst.dst.reg()
        && regs[dst].is_pair
        && let Some(side) = regs[dst].side
    {
        load.pairs[side.bit() as usize] += 1;
    }
}

/// The load of each side in a block so far.
#[derive(Debug)]
struct SideLoad<'a> {
    /// The index used with each constant base of an access.
    indexes: &'a SecondaryMap<VReg, PackedOption<VReg>>,
    /// The result of an instruction that reads each register.
    readers: &'a SecondaryMap<VReg, PackedOption<VReg>>,
    /// The policy, if the block jumps to itself.
    policy: Option<Policy>,
    insts: [i32; 2],
    /// Results that are pairs, for which there are few registers.
    pairs: [i32; 2],
    /// Registers that were loaded.
    loads: [i32; 2],
}

impl SideLoad<'_> {
    /// The best side for loading a register.
    fn side_for_load(&self, regs: &Regs, dst: VReg) -> Side {
        let info = &regs[dst];
        if let Some(hint) = info.hint {
            return hint.side();
        }
        let load = match self.policy {
            Some(Policy { counts_loads: true, .. }) => &self.loads,
            Some(_) | None if info.is_pair => &self.pairs,
            Some(_) | None => &self.insts,
        };
        let ahead = (load[1] - load[0]).clamp(-LOADS, LOADS);
        let on_b = ahead + self.reader(regs, dst, Side::B);
        if on_b < self.reader(regs, dst, Side::A) { Side::B } else { Side::A }
    }

    /// The cost for the reader of a result on a side.
    fn reader(&self, regs: &Regs, dst: VReg, side: Side) -> i32 {
        if !self.policy.is_some_and(|policy| policy.follows_readers) {
            return 0;
        }
        let reader = self.readers[dst].expand().and_then(|reader| regs[reader].side);
        if reader.is_some_and(|reader| reader != side) { READER } else { 0 }
    }

    /// The weight of an instruction in the load of a side.
    fn weight(&self, kind: Kind) -> i32 {
        let forms = kind.forms().iter().filter(|_| self.policy.is_some_and(|policy| policy.weighs_units));
        forms.map(|form| form.op.row().timing.stages().unit.into()).next().unwrap_or(1)
    }
}

/// The result of an instruction that reads each register, if one does and has its place from elsewhere.
fn readers(code: &Code) -> SecondaryMap<VReg, PackedOption<VReg>> {
    let mut readers = SecondaryMap::new();
    for inst in code.blocks.iter().flat_map(|block| &block.insts) {
        let Some(dst) = inst.dst.reg() else { continue };
        for source in [inst.src1, inst.src2].into_iter().filter_map(Arg::reg).filter(|reg| *reg != dst) {
            readers[source] = dst.into();
        }
    }
    readers
}

fn less_loaded_side(load: &[i32; 2]) -> Side {
    if load[1] < load[0] { Side::B } else { Side::A }
}

/// The index used with each constant base of an access: both must be on the same side.
fn indexes(code: &Code) -> SecondaryMap<VReg, PackedOption<VReg>> {
    let mut indexes = SecondaryMap::new();
    for place in code.blocks.iter().flat_map(|block| &block.insts).filter_map(|inst| inst.place) {
        if let (Base::Reg(base), Some(index)) = (place.base, place.index)
            && code.regs[base].constant.is_some()
        {
            indexes[base] = index.into();
        }
    }
    indexes
}

fn best_side(regs: &Regs, inst: &Inst, dst: VReg, load: &SideLoad<'_>) -> Side {
    let cost = |side: Side| {
        let own = load.insts[side.bit() as usize];
        let other = load.insts[side.other().bit() as usize];
        let mut cost = (own - other).clamp(-IMBALANCE, IMBALANCE);
        for arg in [inst.src1, inst.src2] {
            let Some(source) = arg.reg() else { continue };
            if regs[source].side.is_some_and(|source| source != side) {
                cost += if inst.kind.crossing() == Crossing::Neither { COPY } else { CROSS };
            }
        }
        let index = load.indexes[dst].expand().and_then(|index| regs[index].side);
        if index.is_some_and(|index| index != side) {
            cost += COPY;
        }
        if regs[dst].hint.is_some_and(|reg| reg.side() != side) {
            cost += HINT;
        }
        cost + load.reader(regs, dst, side)
    };
    if cost(Side::B) < cost(Side::A) { Side::B } else { Side::A }
}

/// Inserts copies.
struct Copier<'a> {
    regs: &'a mut Regs,
    /// Copies that are valid in this block: original and copy.
    copies: Vec<(Arg, VReg)>,
    out: Vec<Inst>,
}

impl Copier<'_> {
    fn side(&self, reg: VReg) -> Side {
        self.regs[reg].side.unwrap_or(Side::A)
    }

    fn crosses(&self, arg: Arg, side: Side) -> bool {
        arg.reg().is_some_and(|reg| self.side(reg) != side)
    }

    fn inst(&mut self, mut inst: Inst) {
        if inst.kind.bytes().is_some() {
            if let Some(place) = &mut inst.place
                && let (Base::Reg(base), Some(index)) = (place.base, place.index)
            {
                let side = self.side(base);
                if let Some(copy) = self.reach(Arg::Reg(index), side, inst.span).reg() {
                    place.index = Some(copy);
                }
            }
        } else if let Some(dst) = inst.dst.reg().filter(|_| !matches!(inst.kind, Kind::Begin | Kind::Call)) {
            let side = self.side(dst);
            let both = self.crosses(inst.src1, side) && self.crosses(inst.src2, side);
            match inst.kind.crossing() {
                Crossing::One if !both => {}
                Crossing::One | Crossing::Second => inst.src1 = self.reach(inst.src1, side, inst.span),
                Crossing::Neither => {
                    inst.src1 = self.reach(inst.src1, side, inst.span);
                    inst.src2 = self.reach(inst.src2, side, inst.span);
                }
            }
        }
        for written in
            [inst.written_register().map(|(reg, _)| reg), inst.incremented_base()].into_iter().flatten()
        {
            self.copies.retain(|(of, copy)| of.reg() != Some(written) && *copy != written);
        }
        self.out.push(inst);
    }

    /// The operand on this side.
    fn reach(&mut self, arg: Arg, side: Side, span: crate::source::Span) -> Arg {
        let Some(reg) = arg.reg().filter(|reg| self.side(*reg) != side) else { return arg };
        let known = self.copies.iter().find(|(of, copy)| *of == arg && self.side(*copy) == side);
        if let Some((_, copy)) = known {
            return Arg::Reg(*copy);
        }
        let is_pair = matches!(arg, Arg::Reg(_)) && self.regs[reg].is_pair;
        let copy = self.regs.push(VRegInfo { is_pair, side: Some(side), ..VRegInfo::default() });
        let copy_word = |dst, src| Inst::new(Kind::Move, dst, Arg::number(0), src, span);
        if is_pair {
            self.out.push(Inst::new(Kind::Begin, copy.into(), Arg::None, Arg::None, span));
            self.out.push(copy_word(Arg::Low(copy), Arg::Low(reg)));
            self.out.push(copy_word(Arg::High(copy), Arg::High(reg)));
        } else {
            self.out.push(copy_word(copy.into(), arg));
        }
        self.copies.push((arg, copy));
        Arg::Reg(copy)
    }
}

/// Returns the set of registers available for a value.
pub(super) fn allowed_registers(info: &VRegInfo) -> u64 {
    let side = info.side.unwrap_or(Side::A);
    let file = abi::file(side) & abi::USABLE;
    if info.is_condition { file & abi::CONDITIONS } else { file }
}
