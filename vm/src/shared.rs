//! Memory that threads can share, and what a program does to it as far as its text says.

use std::collections::BTreeSet;

use kmotiondef::map::{
    CALLBACK_STACK_BASE, IRAM, PROGRAM_BASE, PROGRAM_LIMIT, SDRAM, STACK_BASE, STACK_SIZE,
};
use kmotiondef::{CodeAddr, GuestAddr};

use crate::for_each_op;
use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, OperandType};
use crate::program::Program;

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

impl Program {
    /// The shared cells of constant address that the program changes by a load and a store: what another thread stores
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

/// The loads in the function of the store `word` from which its value is made, as the instructions before it are
/// written.
pub(crate) fn loads_of(program: &Program, word: usize) -> Vec<CodeAddr> {
    let (Some(op), Some(function)) = (program.ops().get(word), program.function_around(word)) else {
        return Vec::new();
    };
    let mut wanted: BTreeSet<u16> = registers(op).sources.first().copied().into_iter().collect();
    let mut loads = Vec::new();
    for at in (function.body.start..word).rev().take(REACH) {
        let op = &program.ops()[at];
        let found = registers(op);
        if !found.assigned.is_some_and(|register| wanted.remove(&register)) {
            continue;
        }
        if matches!(op.kind(), OpKind::Load(_)) {
            loads.push(program.address_of(at));
        } else {
            wanted.extend(found.sources);
        }
    }
    loads
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
}
