//! The pool: constants of eight bytes, without duplicates.

use std::collections::BTreeMap;

use vm::operand::Pool;

/// Numbers the constants of a unit.
#[derive(Debug, Default)]
pub(super) struct ConstantPool {
    values: Vec<u64>,
    numbers: BTreeMap<u64, u32>,
}

impl ConstantPool {
    /// The number of a constant, which is added if it is new.
    pub(super) fn number(&mut self, bits: u64) -> Pool {
        let next = self.values.len() as u32;
        let number = *self.numbers.entry(bits).or_insert(next);
        if number == next {
            self.values.push(bits);
        }
        Pool(number)
    }

    /// The constants in the order of their numbers.
    pub(super) fn into_values(self) -> Vec<u64> {
        self.values
    }
}
