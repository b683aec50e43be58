//! The rules for a single packet.

use super::{Packet, Rule};
use crate::inst::Inst;
use crate::kind::{Field, Update};
use crate::operand::Operand;
use crate::register::{Reg, Side, Unit};
use crate::spelling::FETCH_PACKET;

/// The maximum number of operands that may read one register in one cycle.
const READS: usize = 4;

/// All rules that the packet at `at` violates.
pub(super) fn rules(at: u32, packet: &Packet) -> Vec<Rule> {
    let insts = &packet.insts;
    let mut found = Vec::new();
    if insts.len() > 8 {
        found.push(Rule::TooMany);
    } else if at / FETCH_PACKET != (at + packet.bytes().max(4) - 4) / FETCH_PACKET {
        found.push(Rule::CrossesFetchPacket);
    }
    units(insts, &mut found);
    for side in [Side::A, Side::B] {
        paths(insts, side, &mut found);
    }
    reads(insts, &mut found);
    memory(insts, &mut found);
    if count(insts, |inst| inst.cycles() > 1) > 1 {
        found.push(Rule::NopTwice);
    }
    if is_any_pair(insts, |a, b| a.branch().is_some() && b.branch().is_some() && !a.pred().excludes(b.pred()))
    {
        found.push(Rule::TwoBranches);
    }
    found
}

fn count(insts: &[Inst], which: impl Fn(&Inst) -> bool) -> usize {
    insts.iter().filter(|inst| which(inst)).count()
}

fn is_any_pair(insts: &[Inst], which: impl Fn(&Inst, &Inst) -> bool) -> bool {
    insts.iter().enumerate().any(|(index, one)| insts[index + 1..].iter().any(|other| which(one, other)))
}

fn units(insts: &[Inst], found: &mut Vec<Rule>) {
    let twice = Unit::ALL.into_iter().filter(|unit| count(insts, |inst| inst.unit() == Some(*unit)) > 1);
    found.extend(twice.map(Rule::UnitTwice));
}

fn paths(insts: &[Inst], side: Side, found: &mut Vec<Rule>) {
    if count(insts, |inst| inst.cross_path() == Some(side)) > 1 {
        found.push(Rule::CrossPathTwice(side));
    }
    if count(insts, |inst| inst.data_path() == Some(side)) > 1 {
        found.push(Rule::DataPathTwice(side));
    }
    let on_side = |inst: &Inst| inst.unit().is_some_and(|unit| unit.side == side);
    let sources = count(insts, |inst| on_side(inst) && inst.reads_long());
    let results = count(insts, |inst| on_side(inst) && inst.writes_long());
    if sources > 1 || results > 1 {
        found.push(Rule::LongTwice(side));
    }
    if sources > 0 && count(insts, |inst| inst.is_store() && inst.data_path() == Some(side)) > 0 {
        found.push(Rule::LongWithStore(side));
    }
}

fn reads(insts: &[Inst], found: &mut Vec<Rule>) {
    let operands =
        |reg: Reg| insts.iter().flat_map(|inst| inst.reads()).filter(|read| read.reg == reg).count();
    let regs = (0..Reg::COUNT).filter_map(Reg::from_index);
    found.extend(regs.filter(|reg| operands(*reg) > READS).map(Rule::TooManyReads));
}

fn memory(insts: &[Inst], found: &mut Vec<Rule>) {
    let meets = |load: &Inst, store: &Inst| {
        load.is_load() && store.is_store() && load.mem() == store.mem() && !load.pred().excludes(store.pred())
    };
    if is_any_pair(insts, |a, b| meets(a, b) || meets(b, a)) {
        found.push(Rule::LoadMeetsStore);
    }
    let stores_base = |inst: &Inst| match (inst.mem(), inst.field(Field::Src)) {
        (Some(mem), Some(Operand::Reg(data))) => mem.update != Update::None && mem.base == data,
        _ => false,
    };
    if insts.iter().any(stores_base) {
        found.push(Rule::StoresItsBase);
    }
}
