//! The comparisons of a waiting loop with the time.
//!
//! A loop may only add to the time, subtract from it, and compare it with values that do not change. Each such value is
//! monotonic in the time. So a comparison changes its result at most once, and if two iterations have the same result,
//! so have those between.

use std::collections::{BTreeMap, BTreeSet};

use crate::kind::OpKind;
use crate::op::Op;
use crate::operand::RegF64;
use crate::program::Program;
use crate::shared::registers;

use super::{is_live, successors};

/// A value computed from the time and from registers that do not change.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Term {
    Now,
    Register(u16),
    Sum(Box<Self>, u16),
    Difference(Box<Self>, u16),
    Rest(u16, Box<Self>),
}

impl Term {
    fn value(&self, now: f64, register: &dyn Fn(u16) -> f64) -> f64 {
        match self {
            Self::Now => now,
            Self::Register(number) => register(*number),
            Self::Sum(term, number) => term.value(now, register) + register(*number),
            Self::Difference(term, number) => term.value(now, register) - register(*number),
            Self::Rest(number, term) => register(*number) - term.value(now, register),
        }
    }

    /// Adds the registers of the term to `found`.
    fn registers(&self, found: &mut BTreeSet<u16>) {
        match self {
            Self::Now => {}
            Self::Register(number) => drop(found.insert(*number)),
            Self::Sum(term, number) | Self::Difference(term, number) | Self::Rest(number, term) => {
                found.insert(*number);
                term.registers(found);
            }
        }
    }
}

/// The relation of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Relation {
    Less,
    LessOrEqual,
}

/// A comparison of the time with a value.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Comparison {
    left: Term,
    relation: Relation,
    right: Term,
}

/// The time comparisons in the iterations of a loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TimeTests {
    /// The call that yields the time.
    pub(crate) call: usize,
    comparisons: Vec<Comparison>,
}

impl TimeTests {
    /// The comparisons that an iteration of `words` makes with the time yielded by the call `call` among them; `None`
    /// if it uses the time in any other way than described above, or not entirely in the straight-line code after the
    /// call.
    pub(super) fn of(program: &Program, words: &BTreeSet<usize>, call: usize) -> Option<Self> {
        let ops = program.ops();
        let mut uses = Uses::default();
        let mut at = call + 1;
        if let Some(Op::ResultF64 { dst }) = ops.get(at) {
            uses.terms.insert(dst.0, Term::Now);
            at += 1;
        }
        while words.contains(&at) && (ops[at].kind().is_straight() || ops[at].kind() == OpKind::Charge) {
            uses.note(&ops[at])?;
            at += 1;
        }
        let clock = Self { call, comparisons: uses.comparisons };
        // The code after that may branch on the result of a comparison, but use no other value derived from the time.
        let is_branch = words.contains(&at) && ops[at].kind() == OpKind::Branch;
        let after = if is_branch { successors(program, at) } else { vec![at] };
        let special = uses.terms.keys().chain(&uses.results);
        let is_used = |register: &u16| is_live(program, after.clone(), *register, &|at| words.contains(&at));
        let assigned = |at: &usize| registers(&ops[*at]).assigned;
        let is_steady =
            |register: &u16| words.iter().filter(|at| assigned(at) == Some(*register)).count() < 2;
        (!special.into_iter().any(is_used) && clock.registers().iter().all(is_steady)).then_some(clock)
    }

    /// The registers with which the time is compared; each holds the same at the end of an iteration as in it.
    pub(crate) fn registers(&self) -> BTreeSet<u16> {
        let mut found = BTreeSet::new();
        for Comparison { left, right, .. } in &self.comparisons {
            left.registers(&mut found);
            right.registers(&mut found);
        }
        found
    }

    /// Reports whether all comparisons have the same results at two times.
    pub(crate) fn is_same(&self, times: [f64; 2], register: &dyn Fn(u16) -> f64) -> bool {
        self.comparisons.iter().all(|Comparison { left, relation, right }| {
            let [before, after] = times.map(|now| {
                let (left, right) = (left.value(now, register), right.value(now, register));
                match relation {
                    Relation::Less => left < right,
                    Relation::LessOrEqual => left <= right,
                }
            });
            before == after
        })
    }
}

/// The values computed from the time so far.
#[derive(Default)]
struct Uses {
    /// The registers that hold a term.
    terms: BTreeMap<u16, Term>,
    /// The registers that hold the result of a comparison.
    results: BTreeSet<u16>,
    comparisons: Vec<Comparison>,
}

impl Uses {
    /// Follows an instruction; `None` if it uses the time in a way not described above.
    fn note(&mut self, op: &Op) -> Option<()> {
        let used = registers(op);
        if used.sources.iter().any(|register| self.results.contains(register)) {
            return None;
        }
        let made = self.made(op, used.sources.iter().any(|register| self.terms.contains_key(register)))?;
        let Some(assigned) = used.assigned else { return Some(()) };
        self.terms.remove(&assigned);
        self.results.remove(&assigned);
        match made {
            InstResult::Other => {}
            InstResult::Term(term) => drop(self.terms.insert(assigned, term)),
            InstResult::Comparison(comparison) => {
                self.results.insert(assigned);
                self.comparisons.push(comparison);
            }
        }
        Some(())
    }

    /// The result of an instruction, which `is_timed` if it uses the time.
    fn made(&self, op: &Op, is_timed: bool) -> Option<InstResult> {
        if !is_timed {
            return Some(InstResult::Other);
        }
        let term = |register: RegF64| self.terms.get(&register.0).cloned();
        let compare = |a: RegF64, relation, b: RegF64| {
            let (left, right) = match (term(a), term(b)) {
                (Some(left), None) => (left, Term::Register(b.0)),
                (None, Some(right)) => (Term::Register(a.0), right),
                (Some(_), Some(_)) | (None, None) => return None,
            };
            Some(InstResult::Comparison(Comparison { left, relation, right }))
        };
        if let Op::MovF64 { src, .. } = *op {
            return term(src).map(InstResult::Term);
        }
        if let Op::AddF64 { a, b, .. } = *op {
            return match (term(a), term(b)) {
                (Some(term), None) => Some(InstResult::Term(Term::Sum(Box::new(term), b.0))),
                (None, Some(term)) => Some(InstResult::Term(Term::Sum(Box::new(term), a.0))),
                (Some(_), Some(_)) | (None, None) => None,
            };
        }
        if let Op::SubF64 { a, b, .. } = *op {
            return match (term(a), term(b)) {
                (Some(term), None) => Some(InstResult::Term(Term::Difference(Box::new(term), b.0))),
                (None, Some(term)) => Some(InstResult::Term(Term::Rest(a.0, Box::new(term)))),
                (Some(_), Some(_)) | (None, None) => None,
            };
        }
        if let Op::LtF64 { a, b, .. } = *op {
            return compare(a, Relation::Less, b);
        }
        if let Op::LeF64 { a, b, .. } = *op {
            return compare(a, Relation::LessOrEqual, b);
        }
        None
    }
}

/// The result of an instruction.
enum InstResult {
    /// A value that does not depend on the time.
    Other,
    Term(Term),
    Comparison(Comparison),
}
