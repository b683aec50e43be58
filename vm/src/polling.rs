//! Waiting loops: loops that may only wait.
//!
//! An iteration of such a loop stores nothing, calls only functions that yield a state of the board, and begins with
//! the same registers each time: it assigns no register that it reads before the assignment. So an iteration that
//! returns to its first word is followed by equal ones until something happens outside the thread, at the earliest when
//! its slice is over. An engine that has executed one iteration skips those that follow
//! ([`Slice::pass_iterations`](crate::engine::Slice::pass_iterations)).
//!
//! The time is a state that changes within a slice. It may be read once in an iteration, to be compared ([`clock`]):
//! iterations are equal until the result of a comparison changes.
//!
//! A loop is found by its backward branches. It need not have a single entry, and it may contain other loops: an engine
//! counts an iteration only if it has executed only words of the loop.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

mod clock;

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::GuestAddr;

pub(crate) use self::clock::TimeTests;
use crate::firmware::ReadState;
use crate::kind::{Name, OpKind};
use crate::meter::branch_target;
use crate::op::Op;
use crate::operand::{Addr, Count, FuncRef};
use crate::program::{Function, Program};
use crate::shared::registers;

/// The most words that are searched for one loop, and the most of an iteration.
const MAX_SEARCHED: usize = 400;
const MAX_WORDS: usize = 150;

/// A loop that may only wait.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PollingLoop {
    /// The word with which an iteration begins.
    pub(crate) first: usize,
    /// The branches with which an iteration ends: back to the first word.
    pub(crate) branches: Vec<usize>,
    /// The words of an iteration.
    pub(crate) words: BTreeSet<usize>,
    /// The time comparisons of an iteration, if it reads the time.
    pub(crate) clock: Option<TimeTests>,
}

/// Tells the functions of the firmware that only yield a state ([`Firmware::reads`](crate::firmware::Firmware::reads)).
pub(crate) type Readers<'a> = &'a dyn Fn(GuestAddr) -> Option<ReadState>;

/// The loops of all functions of `program` that may only wait.
pub(crate) fn polling_loops(program: &Program, readers: Readers<'_>) -> Vec<PollingLoop> {
    let mut search = LoopSearch { program, readers, quiet: BTreeMap::new() };
    program.functions().iter().flat_map(|function| search.loops(function)).collect()
}

struct LoopSearch<'a> {
    program: &'a Program,
    readers: Readers<'a>,
    /// The functions that have no effect except their result; false for a function whose search is in progress.
    quiet: BTreeMap<FuncRef, bool>,
}

impl LoopSearch<'_> {
    fn loops(&mut self, function: &Function) -> Vec<PollingLoop> {
        let mut branches: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for at in function.body.clone() {
            let target = branch_target(&self.program.ops()[at]).map(|to| to.0 as usize);
            if let Some(first) = target.filter(|to| *to <= at) {
                branches.entry(first).or_default().push(at);
            }
        }
        let found = branches.into_iter().filter_map(|(first, branches)| {
            self.polling_loop(first, branches).filter(|polling| !self.carries_registers(function, polling))
        });
        found.collect()
    }

    /// The loop of quiet words from `first` back to it by some of `branches`, if there is one.
    fn polling_loop(&mut self, first: usize, mut branches: Vec<usize>) -> Option<PollingLoop> {
        let mut before: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut reached = BTreeSet::from([first]);
        let mut open = vec![first];
        while let Some(at) = open.pop() {
            if !self.is_quiet(at) {
                reached.remove(&at);
                continue;
            }
            for next in successors(self.program, at) {
                before.entry(next).or_default().push(at);
                if reached.insert(next) {
                    open.push(next);
                }
            }
            if before.len() > MAX_SEARCHED {
                return None;
            }
        }
        branches.retain(|branch| reached.contains(branch));
        if branches.is_empty() {
            return None;
        }
        let mut words: BTreeSet<usize> = branches.iter().copied().collect();
        let mut open = branches.clone();
        while let Some(at) = open.pop() {
            if at == first {
                continue;
            }
            for previous in before.get(&at).into_iter().flatten() {
                if words.insert(*previous) {
                    open.push(*previous);
                }
            }
        }
        if words.len() > MAX_WORDS {
            return None;
        }
        let mut calls = words.iter().filter(|at| self.reading(**at) == Some(ReadState::Time));
        let clock = match (calls.next(), calls.next()) {
            (None, _) => None,
            (Some(call), None) => Some(TimeTests::of(self.program, &words, *call)?),
            (Some(_), Some(_)) => return None,
        };
        Some(PollingLoop { first, branches, words, clock })
    }

    /// The state that an instruction yields by a call of the firmware, if it only does that.
    fn reading(&self, at: usize) -> Option<ReadState> {
        let address = self.program.ops()[at].operand(Name::Addr).filter(|_| self.is_call(at));
        address.and_then(|Addr(address)| (self.readers)(GuestAddr::new(address)))
    }

    fn is_call(&self, at: usize) -> bool {
        matches!(self.program.ops()[at].kind(), OpKind::Call)
    }

    /// Reports whether an instruction affects only registers of its call, and depends on nothing that changes within a
    /// slice except the time.
    fn is_quiet(&mut self, at: usize) -> bool {
        let op = self.program.ops()[at];
        match op.kind() {
            OpKind::Charge
            | OpKind::Constant
            | OpKind::Move
            | OpKind::Address
            | OpKind::Arithmetic
            | OpKind::Negation
            | OpKind::Conversion
            | OpKind::Load(_)
            | OpKind::Jump
            | OpKind::Branch
            | OpKind::Argument(_)
            | OpKind::Result(_) => true,
            OpKind::Call => match op.operand(Name::Func) {
                Some(function) => self.is_quiet_function(function),
                None => self.reading(at).is_some(),
            },
            OpKind::Structure
            | OpKind::Store(_)
            | OpKind::Block
            | OpKind::Table
            | OpKind::Return(_)
            | OpKind::Stop => false,
        }
    }

    /// Reports whether a call of a function has no effect but its result, which does not depend on the time. One that
    /// calls itself does not count.
    fn is_quiet_function(&mut self, function: FuncRef) -> bool {
        if let Some(quiet) = self.quiet.get(&function) {
            return *quiet;
        }
        self.quiet.insert(function, false);
        let Some(index) = self.program.index_of(function) else { return false };
        let body = self.program.functions()[index].body.clone();
        let program = self.program;
        let is_return = |at: usize| matches!(program.ops()[at].kind(), OpKind::Return(_));
        let is_quiet =
            |at: usize| is_return(at) || self.is_quiet(at) && self.reading(at) != Some(ReadState::Time);
        let quiet = body.len() <= MAX_SEARCHED && body.into_iter().all(is_quiet);
        self.quiet.insert(function, quiet);
        quiet
    }

    /// Reports whether an iteration reads a register that the previous iteration has assigned.
    fn carries_registers(&self, function: &Function, polling: &PollingLoop) -> bool {
        let assigned = |at: &usize| registers(&self.program.ops()[*at]).assigned;
        let assigned: BTreeSet<u16> = polling.words.iter().filter_map(assigned).collect();
        let is_here = |at| function.body.contains(&at);
        assigned.into_iter().any(|register| is_live(self.program, vec![polling.first], register, &is_here))
    }
}

/// Reports whether a register may be read from the words `open` on before it is assigned, along words that `are_meant`.
fn is_live(
    program: &Program,
    mut open: Vec<usize>,
    register: u16,
    are_meant: &dyn Fn(usize) -> bool,
) -> bool {
    let mut seen: BTreeSet<usize> = open.iter().copied().collect();
    while let Some(at) = open.pop() {
        if !are_meant(at) {
            continue;
        }
        let used = registers(&program.ops()[at]);
        if used.sources.contains(&register) {
            return true;
        }
        if used.assigned != Some(register) {
            open.extend(successors(program, at).into_iter().filter(|next| seen.insert(*next)));
        }
    }
    false
}

/// The words at which execution may continue after the word `at`, in its function.
fn successors(program: &Program, at: usize) -> Vec<usize> {
    let op = program.ops()[at];
    let target = branch_target(&op).map(|to| to.0 as usize);
    let last = if let Op::BrTable { n: Count(n), .. } = op { at + 1 + usize::from(n) } else { at + 1 };
    let next = (at + 1..=last).filter(|_| !op.kind().ends_path());
    next.chain(target).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{HEAD_WORDS, program};

    /// Checks at which instructions, counted from the first, the iterations of the loops of `body` begin; `0x10008000`
    /// only reads.
    fn check(body: &str, expected: &[usize]) {
        let program = program(1, &format!("@main: func sig0, 7, 0\ntypes 0x3f00\n{body}"));
        let found = polling_loops(&program, &|address| match address.get() {
            0x1000_8000 => Some(ReadState::Steady),
            0x1000_8020 => Some(ReadState::Time),
            _ => None,
        });
        let firsts: Vec<usize> = found.iter().map(|polling| polling.first - HEAD_WORDS - 2).collect();
        assert_eq!(firsts, expected, "{body}");
    }

    #[test]
    fn a_loop_that_reads_and_compares_may_only_wait() {
        check("@a: charge 9\nload_i32_at r0, 0x10000000\nbr_if r0, @a\nret", &[0]);
        check("@a: charge 9\narg_i32 r1, 0\ncall_fw sig1, 0x10008000\ncharge 9\nbr_if r0, @a\nret", &[0]);
        // Entered at its condition.
        check(
            "charge 9\nbr @b\n@a: charge 9\n@b: charge 9\nload_i32_at r0, 0x10000000\nbr_if r0, @a\nret",
            &[2],
        );
        // Two conditions.
        check(
            "@a: charge 9\nload_i32_at r0, 0x10000000\nbr_if r0, @a\ncharge 9\nload_i32_at r1, 0x10000004\n\
             br_if r1, @a\nret",
            &[0],
        );
    }

    #[test]
    fn a_loop_with_an_effect_does_not() {
        check(
            "@a: charge 9\nload_i32_at r0, 0x10000000\nstore_i32_at r0, 0x10000008\nbr_if r0, @a\nret",
            &[],
        );
        check("@a: charge 9\narg_i32 r1, 0\ncall_fw sig1, 0x10008008\ncharge 9\nbr_if r0, @a\nret", &[]);
        check("@a: charge 9\nadd_i32_imm r1, r1, 1\nload_i32_at r0, 0x10000000\nbr_if r0, @a\nret", &[]);
        // The new value is the old one of the next iteration.
        check(
            "@a: charge 9\nmov_i32 r1, r0\nload_i32_at r0, 0x10000000\neq_i32 r2, r0, r1\nbr_if r2, @a\nret",
            &[],
        );
        // Read after the loop, and assigned on only one of two paths.
        check(
            "@a: charge 9\nload_i32_at r0, 0x10000000\nbr_if r0, @b\ncharge 9\nconst_i32 r1, 3\n@b: charge 9\n\
             load_i32_at r0, 0x10000004\nbr_if r0, @a\nstore_i32_at r1, 0x10000008\nret",
            &[],
        );
    }

    #[test]
    fn the_loop_around_one_that_counts_may_only_wait() {
        check(
            "@a: charge 9\nconst_i32 r1, 0\n@b: charge 9\nadd_i32_imm r1, r1, 1\nload_i32 r0, r1, +0\nbr_if r0, @b\n\
             charge 9\nbr_if r1, @a\nret",
            &[0],
        );
        // Iterations that store, of a loop around one that waits.
        check(
            "@a: charge 9\nstore_i32_at r1, 0x10000008\n@b: charge 9\nload_i32_at r0, 0x10000000\nbr_if r0, @b\n\
             charge 9\nbr @a\nret",
            &[2],
        );
    }

    #[test]
    fn the_time_may_be_compared_with_what_stays_the_same() {
        let timed = |uses: &str, expected: &[usize]| {
            let call = "arg_i32 r1, 0\narg_f64 d6, 1\ncall_fw sig4, 0x10008020";
            let head = format!("@a: charge 9\n{call}\nresult_f64 d4\ncharge 9");
            check(&format!("{head}\n{uses}\nbr_if r0, @a\nret"), expected);
        };
        timed("lt_f64 r0, d4, d5", &[0]);
        timed("load_f64_at d5, 0x10000008\nle_f64 r0, d5, d4", &[0]);
        timed("sub_f64 d4, d4, d5\nlt_f64 r0, d4, d5", &[0]);
        timed("lt_f64 r0, d4, d5\nbr_if r0, @b\ncharge 9\nload_i32_at r0, 0x10000000\n@b: charge 9", &[]);
        timed("lt_f64 r0, d4, d5\nbr_if r0, @a\ncharge 9\nload_i32_at r0, 0x10000000", &[0]);
        timed("eq_f64 r0, d4, d5", &[]);
        timed("add_f64 d4, d4, d4\nlt_f64 r0, d4, d5", &[]);
        timed("i32_from_f64_s r0, d4", &[]);
        timed("lt_f64 r1, d4, d5\nadd_i32_imm r0, r1, 1", &[]);
        timed(
            "arg_i32 r1, 0\narg_f64 d6, 1\ncall_fw sig4, 0x10008020\nresult_f64 d5\ncharge 9\nlt_f64 r0, d4, d5",
            &[],
        );
    }

    #[test]
    fn functions_of_the_program_may_be_called_that_only_read() {
        let calls = |body: &str| {
            let main = "@main: func sig0, 6, 0\ntypes 0x300\n@a: charge 9\ncall fn@f\nresult_i32 r0\ncharge 9\n\
                        br_if r0, @a\nret";
            let program = program(1, &format!("{main}\n@f: func sig2, 1, 0\ntypes 0\n{body}"));
            polling_loops(&program, &|_| None).len()
        };
        assert_eq!(calls("charge 9\nload_i32_at r0, 0x10000000\nret_i32 r0"), 1);
        assert_eq!(calls("charge 9\nstore_i32_at r0, 0x10000000\nret_i32 r0"), 0);
        assert_eq!(calls("charge 9\ncall fn@f\nresult_i32 r0\nret_i32 r0"), 0);
    }
}
