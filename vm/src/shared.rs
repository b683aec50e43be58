//! Memory that threads can share, and its accesses by a program, as far as its text shows.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::map::{
    CALLBACK_STACK_BASE, IRAM, PROGRAM_BASE, PROGRAM_LIMIT, SDRAM, STACK_BASE, STACK_SIZE,
};
use kmotiondef::variables::USER_CALL_BACK;
use kmotiondef::{CodeAddr, GuestAddr};

use crate::for_each_op;
use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, OperandType};
use crate::program::{Function, Program};

/// Number of instructions before a store that are searched for the loads of its value.
const REACH: usize = 400;

/// Reports whether an address is in RAM that is neither a stack nor the space of programs.
#[inline(always)]
pub(crate) const fn is_shared(address: u32) -> bool {
    let is_stack = address >= STACK_BASE && address < CALLBACK_STACK_BASE + STACK_SIZE;
    let is_program = address >= PROGRAM_BASE && address < PROGRAM_LIMIT;
    let in_sdram = address.wrapping_sub(SDRAM.base.get()) < SDRAM.size;
    let in_iram = address.wrapping_sub(IRAM.base.get()) < IRAM.size;
    (in_sdram && !is_stack && !is_program) || in_iram
}

/// Returns whether an address is in the space of programs, where a call-back can access the data of the interrupted
/// thread.
#[inline(always)]
pub(crate) const fn is_of_program(address: u32) -> bool {
    address >= PROGRAM_BASE && address < PROGRAM_LIMIT
}

/// Returns whether accesses to an address are reported, of a program that sets the call-back or does not.
#[inline(always)]
pub(crate) const fn is_noticed(address: u32, has_call_back: bool) -> bool {
    is_shared(address) || has_call_back && is_of_program(address)
}

impl Program {
    /// Returns whether the program sets the call-back.
    pub(crate) fn has_call_back(&self) -> bool {
        let cell = USER_CALL_BACK.address().get();
        self.ops().iter().any(|op| op.operand::<Addr>(Name::Addr).is_some_and(|Addr(at)| at == cell))
    }

    /// The firmware functions that the program calls by address.
    pub fn firmware_calls(&self) -> impl Iterator<Item = GuestAddr> {
        self.ops().iter().filter_map(|op| match op {
            Op::CallFw { addr, .. } => Some(GuestAddr::new(addr.0)),
            _ => None,
        })
    }

    /// The shared cells at constant addresses that the program updates by a load and a store: a store by another thread
    /// in between is lost.
    #[must_use]
    pub fn updated_cells(&self) -> BTreeSet<GuestAddr> {
        let address = |word: usize| self.ops().get(word)?.operand::<Addr>(Name::Addr);
        let is_update = |word: usize, cell: Addr| {
            let loads = loads_of(self, word).into_iter().filter_map(|load| self.word_at(load));
            loads.into_iter().any(|load| address(load) == Some(cell))
        };
        let stores =
            (0..self.ops().len()).filter(|word| matches!(self.ops()[*word].kind(), OpKind::Store(_)));
        let cells = stores.filter_map(|word| Some((word, address(word)?)));
        let cells = cells.filter(|(word, cell)| is_shared(cell.0) && is_update(*word, *cell));
        cells.map(|(_, cell)| GuestAddr::new(cell.0)).collect()
    }
}

/// The registers of an instruction.
#[derive(Debug, Default)]
pub(crate) struct OpRegisters {
    /// The one that it assigns.
    pub(crate) assigned: Option<u16>,
    /// The registers that it reads.
    pub(crate) sources: Vec<u16>,
}

macro_rules! define_registers {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// The registers that an instruction assigns and reads, in the order of its operands.
        pub(crate) fn registers(op: &Op) -> OpRegisters {
            let mut found = OpRegisters::default();
            match *op {
                $(Op::$variant { $($field),* } => {
                    $(found.note(stringify!($field) == Name::Dst.text(), $field);)*
                })*
            }
            found
        }
    };
}
for_each_op!(define_registers);

impl OpRegisters {
    fn note<O: OperandType>(&mut self, is_assigned: bool, operand: O) {
        let register = operand.to_bits() as u16;
        match (O::CLASS.is_some(), is_assigned) {
            (false, _) => {}
            (true, true) => self.assigned = Some(register),
            (true, false) => self.sources.push(register),
        }
    }
}

/// The loads in the function of the store `word` on which the stored value depends, following the instructions before
/// it.
pub(crate) fn loads_of(program: &Program, word: usize) -> Vec<CodeAddr> {
    let (Some(op), Some(function)) = (program.ops().get(word), program.function_around(word)) else {
        return Vec::new();
    };
    registers(op).sources.first().map_or(Vec::new(), |value| origin(program, function, word, *value).loads)
}

/// The origin of the value of a register.
#[derive(Debug, Default)]
struct Origin {
    /// The loads on which it depends.
    loads: Vec<CodeAddr>,
    /// The registers with which it is computed, including itself.
    registers: BTreeSet<u16>,
}

/// Returns the origin of the value of `register` at `word`, as the instructions before it are written.
fn origin(program: &Program, function: &Function, word: usize, register: u16) -> Origin {
    let mut wanted = BTreeSet::from([register]);
    let mut found = Origin { loads: Vec::new(), registers: wanted.clone() };
    for at in (function.body.start..word).rev().take(REACH) {
        if wanted.is_empty() {
            break;
        }
        let op = &program.ops()[at];
        let used = registers(op);
        if !used.assigned.is_some_and(|register| wanted.remove(&register)) {
            continue;
        }
        if matches!(op.kind(), OpKind::Load(_)) {
            found.loads.push(program.address_of(at));
        } else {
            found.registers.extend(&used.sources);
            wanted.extend(used.sources);
        }
    }
    found
}

/// The loads of a function whose values it uses together: for each load the others, and the load itself if a loop
/// accumulates its values. The limit of a loop belongs to the loads of the loop.
pub(crate) fn loads_together(
    program: &Program,
    function: &Function,
) -> BTreeMap<CodeAddr, BTreeSet<CodeAddr>> {
    let mut together: BTreeMap<CodeAddr, BTreeSet<CodeAddr>> = BTreeMap::new();
    let mut join = |one: &[CodeAddr], other: &[CodeAddr]| {
        for (one, other) in one.iter().flat_map(|one| other.iter().map(move |other| (*one, *other))) {
            together.entry(one).or_default().insert(other);
            together.entry(other).or_default().insert(one);
        }
    };
    let mut pointers = Vec::new();
    for word in function.body.clone() {
        let op = &program.ops()[word];
        if let (OpKind::Load(_), Some(base)) = (op.kind(), registers(op).sources.first()) {
            pointers.push((program.address_of(word), origin(program, function, word, *base).registers));
        }
    }
    for word in function.body.clone() {
        let op = &program.ops()[word];
        if op.kind() != OpKind::Arithmetic {
            continue;
        }
        let OpRegisters { assigned, sources } = registers(op);
        let is_test = assigned.is_some_and(|result| is_tested(program, word, result));
        let [left, right] = sources[..] else { continue };
        let origins = [left, right].map(|register| origin(program, function, word, register));
        let [one, other] = &origins;
        join(&one.loads, &other.loads);
        for (sum, (loads, index)) in [(left, (&other.loads, one)), (right, (&one.loads, other))] {
            if assigned == Some(sum) {
                join(loads, loads);
            }
            if index.loads.is_empty() && is_test {
                let indexed = pointers.iter().filter(|(_, used)| used.contains(&sum));
                let indexed: Vec<_> = indexed.map(|(load, _)| *load).collect();
                join(loads, &indexed);
            }
        }
    }
    together
}

/// Returns whether a branch soon after `word` depends on `result`.
fn is_tested(program: &Program, word: usize, result: u16) -> bool {
    let next = program.ops().iter().skip(word + 1).take(4);
    let mut branches = next.filter(|op| op.kind() == OpKind::Branch);
    branches.any(|op| registers(op).sources.contains(&result))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::program;

    #[test]
    fn cells_that_a_program_updates_are_found() {
        let updated = |body: &str| {
            let text = format!("@main: func sig0, 2, 0\ntypes 0\ncharge 99\n{body}\nret");
            program(1, &text).updated_cells().into_iter().map(GuestAddr::get).collect::<Vec<_>>()
        };
        let load = "load_i32_at r0, 0x10000040\nadd_i32_imm r1, r0, 1\n";
        assert_eq!(updated(&format!("{load}store_i32_at r1, 0x10000040")), [0x1000_0040]);
        assert!(updated(&format!("{load}store_i32_at r1, 0x10000044")).is_empty());
        assert!(updated(&format!("{load}const_i32 r1, 3\nstore_i32_at r1, 0x10000040")).is_empty());
        let own = load.replace("0x1000", "0x8006").replace("r0, 1", "r0, 1\nstore_i32_at r1, 0x80060040");
        assert!(updated(&own).is_empty());
    }

    #[test]
    fn loads_that_are_used_together_are_found() {
        let together = |body: &str| {
            let text = format!("@main: func sig0, 4, 0\ntypes 0\ncharge 99\n{body}\nret");
            let program = program(1, &text);
            let found = loads_together(&program, &program.functions()[0]);
            let word =
                |load: &CodeAddr| program.word_at(*load).unwrap_or(0) - program.functions()[0].body.start;
            let words = |loads: &BTreeSet<CodeAddr>| loads.iter().map(word).collect::<Vec<_>>();
            found.iter().map(|(load, others)| (word(load), words(others))).collect::<Vec<_>>()
        };
        let loads = "load_i32_at r0, 0x10000040\nload_i32_at r1, 0x10000044\n";
        let none: Vec<(usize, Vec<usize>)> = Vec::new();
        assert_eq!(together(&format!("{loads}add_i32 r2, r0, r1")), [(1, vec![2]), (2, vec![1])]);
        assert_eq!(together(&format!("{loads}add_i32_imm r2, r0, 1\nadd_i32_imm r3, r1, 1")), none);
        assert_eq!(together("load_i32_at r0, 0x10000040\nadd_i32 r1, r1, r0"), [(1, vec![1])]);
    }
}
