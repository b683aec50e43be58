//! Machine code shared by several engines: a program that many boards run one after another is compiled once.

use std::sync::{Arc, Mutex, PoisonError};

use super::code::MachineCode;
use crate::engine::Preemption;
use crate::program::Program;

/// The number of programs that are kept; the least recently used one is dropped first.
const MOST: usize = 32;

/// A program, where its machine code loses the processor, and that code; `None` where it cannot be compiled.
type CacheEntry = (Program, Preemption, Option<Arc<MachineCode>>);

/// Machine code of the most recently compiled programs, for engines whose boards have the same firmware.
///
/// A program is identified by its contents, not by its address, so boards that are made from one image share its code.
#[derive(Clone, Debug, Default)]
pub struct SharedCode(Arc<Mutex<Vec<CacheEntry>>>);

impl SharedCode {
    /// Returns the code of `program`. Compilation does not block others; two simultaneous requests for one program both
    /// compile it.
    pub(super) fn get(
        &self,
        program: &Program,
        preemption: Preemption,
        compile: impl FnOnce(&Program) -> Option<Arc<MachineCode>>,
    ) -> Option<Arc<MachineCode>> {
        if let Some(code) = self.find(program, preemption) {
            return code;
        }
        let code = compile(program);
        if self.find(program, preemption).is_none() {
            let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            known.truncate(MOST - 1);
            known.insert(0, (program.clone(), preemption, code.clone()));
        }
        code
    }

    fn find(&self, program: &Program, preemption: Preemption) -> Option<Option<Arc<MachineCode>>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |(other, kind, _): &CacheEntry| *kind == preemption && other == program;
        let index = known.iter().position(is_same)?;
        let found = known.remove(index);
        let code = found.2.clone();
        known.insert(0, found);
        Some(code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::program;

    #[test]
    fn a_program_is_compiled_once_and_the_oldest_is_forgotten() {
        let shared = SharedCode::default();
        let of = |number: i32| {
            program(
                1,
                &format!("@main: func sig0, 1, 0\ntypes 0\ncharge 9\nadd_i32_imm r0, r0, {number}\nret"),
            )
        };
        let mut compiled = Vec::new();
        let mut ask = |number| {
            let found = shared.clone().get(&of(number), Preemption::Segments, |_| {
                compiled.push(number);
                None
            });
            assert!(found.is_none());
        };
        (2..2 + MOST as i32).for_each(&mut ask);
        ask(2);
        ask(100);
        ask(2);
        ask(3);
        assert_eq!(compiled.split_off(MOST), [100, 3]);
    }
}
