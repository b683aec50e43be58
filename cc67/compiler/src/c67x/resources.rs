//! The resources of each cycle of a region (`c67x.md` 2.3, 2.4).

use std::collections::BTreeMap;

use c67x::{Inst, Mnemonic, Reg, Side, UnitKind};

/// One cycle.
#[derive(Clone, Copy, Debug, Default)]
struct Cycle {
    /// Units in use, one bit each.
    units: u8,
    /// Cross paths, a bit a side.
    crosses: u8,
    /// Data paths.
    paths: u8,
    /// Units that write a result.
    ports: u8,
    /// Instructions.
    count: u8,
}

/// The resources of each cycle of a region, or of one iteration of a loop, whose cycles repeat.
///
/// Resources are exclusive: each is taken only if it is free, so it can be released individually.
#[derive(Debug, Default)]
pub(super) struct Resources {
    cycles: Vec<Cycle>,
    /// The long products of each cycle: unit and name.
    products: BTreeMap<u32, Vec<(u8, Mnemonic)>>,
    /// The operands that are read in each cycle.
    reads: Vec<Vec<Reg>>,
    /// The period in cycles after which everything repeats; 0 for never.
    period: u32,
}

/// Cycles that must lie between long products of different kinds on one unit.
const PRODUCTS: u32 = 8;

/// The most operands that may read one register in one cycle.
const READS: usize = 4;

impl Resources {
    /// The cycles of an iteration, where the next one begins `period` cycles later.
    pub(super) fn periodic(period: u32) -> Self {
        Self { period, ..Self::default() }
    }

    /// The cycle modulo the period.
    const fn cycle_in_period(&self, cycle: u32) -> u32 {
        if self.period == 0 { cycle } else { cycle % self.period }
    }

    fn cycle_mut(&mut self, cycle: u32) -> &mut Cycle {
        let index = self.cycle_in_period(cycle) as usize;
        if index >= self.cycles.len() {
            self.cycles.resize(index + 12, Cycle::default());
        }
        &mut self.cycles[index]
    }

    /// Reports whether an instruction can issue in a cycle.
    pub(super) fn can_issue(&mut self, inst: &Inst, cycle: u32) -> bool {
        let Some(unit) = inst.unit() else { return true };
        let bit = 1 << unit.index();
        let own = *self.cycle_mut(cycle);
        if own.count >= 8 || inst.data_path().is_some_and(|side| own.paths & path(side) != 0) {
            return false;
        }
        let cross = inst.cross_path().map_or(0, path);
        for held in 0..u32::from(inst.unit_cycles()) {
            let later = self.cycle_mut(cycle + held);
            if later.units & bit != 0 || later.crosses & cross != 0 {
                return false;
            }
        }
        if unit.kind != UnitKind::D {
            for write in inst.writes() {
                if self.cycle_mut(cycle + u32::from(write.stage)).ports & bit != 0 {
                    return false;
                }
            }
        }
        self.products_fit(inst, cycle) && self.reads_fit(inst, cycle)
    }

    fn products_fit(&self, inst: &Inst, cycle: u32) -> bool {
        let name = inst.mnemonic();
        if !is_product(name) {
            return true;
        }
        let Some(unit) = inst.unit() else { return true };
        // In the firmware, a single-precision product comes seven cycles after one of doubles, and the reverse order
        // one cycle apart.
        let near = |at: &u32, (on, other): &(u8, Mnemonic)| {
            if self.period > 0 {
                let after = (cycle + self.period - at % self.period) % self.period;
                let before = (self.period - after) % self.period;
                let is_near = *other != Mnemonic::Mpysp && after < PRODUCTS
                    || name != Mnemonic::Mpysp && before < PRODUCTS;
                return *on == unit.index() as u8 && *other != name && is_near;
            }
            let (first, apart) = if *at <= cycle { (*other, cycle - at) } else { (name, at - cycle) };
            *on == unit.index() as u8 && *other != name && first != Mnemonic::Mpysp && apart < PRODUCTS
        };
        // Without repetition, only nearby cycles can conflict.
        let around =
            if self.period > 0 { 0..=u32::MAX } else { cycle.saturating_sub(PRODUCTS)..=cycle + PRODUCTS };
        !self.products.range(around).any(|(at, all)| all.iter().any(|product| near(at, product)))
    }

    fn reads_fit(&self, inst: &Inst, cycle: u32) -> bool {
        let Some(others) =
            self.reads.get(self.cycle_in_period(cycle) as usize).filter(|others| !others.is_empty())
        else {
            return inst.reads().all(|read| inst.reads().filter(|own| own.reg == read.reg).count() <= READS);
        };
        inst.reads().all(|read| {
            let own = inst.reads().filter(|other| other.reg == read.reg).count();
            others.iter().filter(|reg| **reg == read.reg).count() + own <= READS
        })
    }

    /// Takes the resources of an instruction.
    pub(super) fn reserve(&mut self, inst: &Inst, cycle: u32) {
        let Some(unit) = inst.unit() else { return };
        let bit = 1 << unit.index();
        self.cycle_mut(cycle).count += 1;
        self.cycle_mut(cycle).paths |= inst.data_path().map_or(0, path);
        let cross = inst.cross_path().map_or(0, path);
        for held in 0..u32::from(inst.unit_cycles()) {
            let later = self.cycle_mut(cycle + held);
            later.units |= bit;
            later.crosses |= cross;
        }
        if unit.kind != UnitKind::D {
            for write in inst.writes() {
                self.cycle_mut(cycle + u32::from(write.stage)).ports |= bit;
            }
        }
        if is_product(inst.mnemonic()) {
            self.products.entry(cycle).or_default().push((unit.index() as u8, inst.mnemonic()));
        }
        let index = self.cycle_in_period(cycle) as usize;
        if index >= self.reads.len() {
            self.reads.resize(index + 12, Vec::new());
        }
        self.reads[index].extend(inst.reads().map(|read| read.reg));
    }

    /// Releases the resources that an instruction took in a cycle.
    pub(super) fn release(&mut self, inst: &Inst, cycle: u32) {
        let Some(unit) = inst.unit() else { return };
        let bit = 1 << unit.index();
        self.cycle_mut(cycle).count -= 1;
        self.cycle_mut(cycle).paths &= !inst.data_path().map_or(0, path);
        let cross = inst.cross_path().map_or(0, path);
        for held in 0..u32::from(inst.unit_cycles()) {
            let later = self.cycle_mut(cycle + held);
            later.units &= !bit;
            later.crosses &= !cross;
        }
        if unit.kind != UnitKind::D {
            for write in inst.writes() {
                self.cycle_mut(cycle + u32::from(write.stage)).ports &= !bit;
            }
        }
        if is_product(inst.mnemonic()) {
            let own = (unit.index() as u8, inst.mnemonic());
            let here = self.products.entry(cycle).or_default();
            if let Some(index) = here.iter().position(|product| *product == own) {
                here.swap_remove(index);
            }
        }
        let index = self.cycle_in_period(cycle) as usize;
        for read in inst.reads() {
            let reads = &mut self.reads[index];
            if let Some(index) = reads.iter().position(|reg| *reg == read.reg) {
                reads.swap_remove(index);
            }
        }
    }
}

const fn path(side: Side) -> u8 {
    1 << side.bit()
}

const fn is_product(name: Mnemonic) -> bool {
    matches!(name, Mnemonic::Mpyi | Mnemonic::Mpyid | Mnemonic::Mpydp | Mnemonic::Mpysp)
}
