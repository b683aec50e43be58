//! Loops translated a second time, with fewer tests, and the facts known inside them.
//!
//! An innermost loop without calls may run for several iterations as soon as the budget covers their maximum cost: no
//! charge in them could end the slice, so the charges are only added up, and the sum is subtracted where the fast
//! iterations are left. The budget is exact wherever it can be observed. An acyclic region is treated in the same way,
//! as one iteration.
//!
//! Such code accesses memory through a few registers that change by constants. The [`Plan`] follows them: the address
//! of an access is a [`Root`], some value that a register held, plus a constant. One check at the first access through
//! a root covers all accesses through it.
//!
//! For a case that the fast iterations cannot handle, an access outside plain RAM or a division by 0, the ordinary
//! translation continues from that instruction on.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use super::accesses::{RegisterAccess, Root, accessed};
use super::candidates::{MAX_WORDS, innermost_loops, regions, straight_segments};
use super::strides::{Strides, common_step};
use crate::kind::{Name, OpKind, Width};
use crate::meter;
use crate::op::Op;
use crate::operand::RegI32;
use crate::program::{Function, Program};

/// The limit of words in all fast iterations of a loop together.
const MAX_WORDS_OF_ITERATIONS: usize = 128;

/// The limit of iterations that run at once, and the higher limit for a loop so short that its test and its jump weigh
/// more.
///
/// With more iterations more values are live than there are registers.
const MAX_ITERATIONS: usize = 4;
const MAX_SMALL_ITERATIONS: usize = 8;
const SMALL: usize = 8;

/// The largest distance of an access from its root, in bytes, and the largest number of terms of a root.
const MAX_DISTANCE: u32 = 1 << 16;
const MAX_TERMS: usize = 12;

/// A position in the fast iterations: the iteration, and the word.
pub(super) type IterationWord = (usize, usize);

/// A register as a root and a distance from it.
type SymbolicValue = (Root, i32);

/// The properties that the accesses through one root share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Group {
    /// The first byte, as a distance from the root; aligned for the widest access if the root's accesses are.
    pub(super) first: i32,
    /// One past the last byte.
    pub(super) end: i32,
    /// Bytes of the widest access.
    pub(super) width: u32,
    /// True if one of them is a store.
    pub(super) has_store: bool,
}

/// An access through a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Access {
    /// The root.
    pub(super) root: Root,
    /// The address of the access, as a distance from the root.
    pub(super) at: i32,
    /// The value of its base register, as a distance from the root.
    pub(super) base: i32,
}

/// The plan of a loop in several iterations, or of words that are executed once.
#[derive(Debug)]
pub(super) struct Plan {
    /// The words of the loop.
    pub(super) words: RangeInclusive<usize>,
    /// The words in the order of an iteration.
    pub(super) order: Vec<usize>,
    /// Number of iterations; 0 for a region that is not a loop.
    pub(super) iterations: usize,
    /// The most cycles that they cost; 0 for a segment without charges.
    pub(super) cost: u32,
    /// True for a loop with one exit, as counted loops are: most of their iterations do not leave it.
    pub(super) is_counted: bool,
    /// The reachable blocks, with the cycles that were charged but not yet subtracted when they begin.
    pub(super) entries: BTreeMap<IterationWord, u32>,
    /// The accesses through registers.
    pub(super) accesses: BTreeMap<IterationWord, Access>,
    /// By root, its accesses that one check can cover.
    pub(super) groups: BTreeMap<Root, Group>,
    /// The roots at equal distances.
    pub(super) strides: Strides,
}

/// The loops of a function that are worth unrolling, by their first word.
///
/// `cost` is the cycles of an instruction in addition to its charge, `None` for one that such a loop cannot contain.
pub(super) fn plans(
    program: &Program,
    function: &Function,
    begins: &BTreeSet<usize>,
    waits: &dyn Fn(usize) -> bool,
    cost: &dyn Fn(&Op) -> Option<u32>,
) -> BTreeMap<usize, Plan> {
    let planner =
        |words, entry, is_loop| Planner::new(program, function, begins, words, cost)?.plan(entry, is_loop);
    let mut plans = BTreeMap::new();
    for (words, entry) in innermost_loops(program, function) {
        if words.clone().any(waits) {
            continue;
        }
        if let Some(plan) = planner(words.clone(), entry, true) {
            plans.insert(*words.start(), plan);
        }
    }
    for words in regions(program, function, &|at| waits(at) || is_planned(&plans, at), cost) {
        if let Some(plan) = planner(words.clone(), *words.start(), false) {
            plans.insert(*words.start(), plan);
        }
    }
    for words in straight_segments(program, function, begins, cost) {
        if is_planned(&plans, *words.start()) {
            continue;
        }
        let plan = planner(words.clone(), *words.start(), false);
        if let Some(plan) = plan.filter(Plan::shares_checks) {
            plans.insert(*words.start(), plan);
        }
    }
    plans
}

/// Reports whether the word `at` is in one of `plans`.
fn is_planned(plans: &BTreeMap<usize, Plan>, at: usize) -> bool {
    plans.range(..=at).next_back().is_some_and(|(_, plan)| plan.words.contains(&at))
}

/// The facts known at the beginning of a block or at an instruction.
#[derive(Clone, Debug)]
struct SymbolicState {
    spent: u32,
    symbols: Vec<SymbolicValue>,
}

/// The derivation of a root from others.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum RootDerivation {
    /// The sum of these roots in ascending order, none of which is a sum.
    Sum(Vec<Root>),
    Difference(Root, Root),
    Product(Root, i32),
}

/// Follows a loop through its iterations.
struct Planner<'a> {
    program: &'a Program,
    begins: &'a BTreeSet<usize>,
    cost: &'a dyn Fn(&Op) -> Option<u32>,
    roots: Root,
    known_roots: BTreeMap<RootDerivation, Root>,
    sums: BTreeMap<Root, Vec<Root>>,
    arriving: BTreeMap<IterationWord, SymbolicState>,
    plan: Plan,
    registers: usize,
}

impl<'a> Planner<'a> {
    fn new(
        program: &'a Program,
        function: &Function,
        begins: &'a BTreeSet<usize>,
        words: RangeInclusive<usize>,
        cost: &'a dyn Fn(&Op) -> Option<u32>,
    ) -> Option<Self> {
        if words.clone().count() > MAX_WORDS {
            return None;
        }
        let mut sum = 0_u32;
        for op in &program.ops()[words.clone()] {
            sum = sum.checked_add(cost(op)?)?;
            if let Op::Charge { cycles } = op {
                sum = sum.checked_add(cycles.0)?;
            }
        }
        let plan = Plan {
            order: Vec::new(),
            words,
            iterations: 0,
            cost: sum,
            is_counted: false,
            entries: BTreeMap::new(),
            accesses: BTreeMap::new(),
            groups: BTreeMap::new(),
            strides: Strides::default(),
        };
        let registers = function.classes.len();
        Some(Self {
            program,
            begins,
            cost,
            roots: 0,
            known_roots: BTreeMap::new(),
            sums: BTreeMap::new(),
            arriving: BTreeMap::new(),
            plan,
            registers,
        })
    }

    fn root(&mut self) -> SymbolicValue {
        self.roots += 1;
        (self.roots, 0)
    }

    /// Plans the iterations of a loop, each of which begins at `entry`, or a segment.
    fn plan(mut self, entry: usize, is_loop: bool) -> Option<Plan> {
        let (first, last) = (*self.plan.words.start(), *self.plan.words.end());
        self.plan.order = (entry..=last).chain(first..entry).collect();
        let words = self.plan.order.len();
        let most = if words <= SMALL { MAX_SMALL_ITERATIONS } else { MAX_ITERATIONS };
        self.plan.iterations = if is_loop { (MAX_WORDS_OF_ITERATIONS / words).clamp(1, most) } else { 0 };
        self.plan.cost = self.plan.cost.checked_mul(self.plan.iterations.max(1) as u32)?;
        self.plan.is_counted = is_loop && self.exits() == 1;
        let symbols = (0..self.registers).map(|_| self.root()).collect();
        self.arriving.insert((0, entry), SymbolicState { spent: 0, symbols });
        let mut known = None;
        for iteration in 0..self.plan.iterations.max(1) {
            for at in self.plan.order.clone() {
                if at == entry || self.begins.contains(&at) {
                    if let Some(known) = known.take() {
                        self.merge_at_join((iteration, at), known);
                    }
                    known = self.arriving.remove(&(iteration, at));
                    if let Some(known) = &known {
                        self.plan.entries.insert((iteration, at), known.spent);
                    }
                }
                known = known.and_then(|known| self.word(iteration, at, known));
            }
        }
        self.plan.strides = self.strides();
        Some(self.plan)
    }

    /// In how many places the words are left.
    fn exits(&self) -> usize {
        let words = &self.plan.words;
        let leaves = |to: usize| usize::from(!words.contains(&to));
        let of = |at: usize| {
            let op = &self.program.ops()[at];
            match meter::branch_target(op) {
                Some(to) if op.kind().ends_path() => leaves(to.0 as usize),
                Some(to) => leaves(to.0 as usize) + leaves(at + 1),
                None => usize::from(op.kind().ends_path()),
            }
        };
        words.clone().map(of).sum()
    }

    /// Follows one instruction; yields the facts known after it, if execution continues there.
    fn word(&mut self, iteration: usize, at: usize, mut known: SymbolicState) -> Option<SymbolicState> {
        let op = self.program.ops()[at];
        known.spent += (self.cost)(&op).unwrap_or(0);
        if let Some(access) = accessed(&op) {
            self.note(iteration, at, access, &known);
        }
        if let Op::Charge { cycles } = op {
            known.spent += cycles.0;
        }
        if let Some(to) = meter::branch_target(&op) {
            if op.kind() == OpKind::Branch {
                self.record_branch(iteration, at + 1, known.clone());
            }
            self.record_branch(iteration, to.0 as usize, known);
            return None;
        }
        if let Some(dst) = int_destination(&op) {
            known.symbols[dst] = self.result(&op, &known.symbols);
        }
        Some(known)
    }

    /// The symbolic result of an instruction, from the symbols of its operands.
    ///
    /// Equal sums and products of roots are the same root, and a constant in a factor is one in the product.
    fn result(&mut self, op: &Op, symbols: &[SymbolicValue]) -> SymbolicValue {
        let of = |register: RegI32| symbols[register.index()];
        #[expect(
            clippy::wildcard_enum_match_arm,
            reason = "a value of its own is right for every instruction"
        )]
        let (root, distance) = match *op {
            Op::MovI32 { src, .. } => of(src),
            Op::AddI32Imm { a, imm, .. } => (of(a).0, of(a).1.wrapping_add(imm.0.into())),
            Op::MulI32Imm { a, imm, .. } => self.product(of(a), imm.0.into()),
            Op::ShlI32Imm { a, imm, .. } if (0..16).contains(&imm.0) => self.product(of(a), 1 << imm.0),
            Op::AddI32 { a, b, .. } => {
                let ((a, from), (b, by)) = (of(a), of(b));
                (self.sum(a, b), from.wrapping_add(by))
            }
            Op::SubI32 { a, b, .. } => {
                let ((a, from), (b, by)) = (of(a), of(b));
                (self.made(RootDerivation::Difference(a, b)), from.wrapping_sub(by))
            }
            _ => self.root(),
        };
        if distance.unsigned_abs() < MAX_DISTANCE { (root, distance) } else { self.root() }
    }

    fn product(&mut self, (root, distance): SymbolicValue, factor: i32) -> SymbolicValue {
        (self.made(RootDerivation::Product(root, factor)), distance.wrapping_mul(factor))
    }

    /// The sum of two roots, each of which may itself be a sum.
    fn sum(&mut self, a: Root, b: Root) -> Root {
        let mut terms = [self.terms(a), self.terms(b)].concat();
        terms.sort_unstable();
        if terms.len() > MAX_TERMS { self.root().0 } else { self.made(RootDerivation::Sum(terms)) }
    }

    /// The roots whose sum is `root`; `root` itself if it is not a sum.
    fn terms(&self, root: Root) -> Vec<Root> {
        self.sums.get(&root).cloned().unwrap_or_else(|| vec![root])
    }

    /// Returns the root for a derivation.
    fn made(&mut self, made: RootDerivation) -> Root {
        if let Some(root) = self.known_roots.get(&made) {
            return *root;
        }
        let (root, _) = self.root();
        if let RootDerivation::Sum(terms) = &made {
            self.sums.insert(root, terms.clone());
        }
        self.known_roots.insert(made, root);
        root
    }

    /// The accesses that move by the same register in each iteration.
    fn strides(&self) -> Strides {
        let assigned: BTreeSet<usize> =
            self.plan.words.clone().filter_map(|at| int_destination(&self.program.ops()[at])).collect();
        let steps = |root: Root| {
            // The first roots are the values of the registers when the iterations begin.
            let register = (root as usize).checked_sub(1).filter(|register| *register < self.registers)?;
            (!assigned.contains(&register)).then_some(RegI32(register as u16))
        };
        let mut strides = Strides::default();
        for at in self.plan.order.iter().filter(|_| self.plan.iterations > 1) {
            let access = |iteration: usize| self.plan.accesses.get(&(iteration, *at));
            let Some(accesses) = (0..self.plan.iterations).map(access).collect::<Option<Vec<_>>>() else {
                continue;
            };
            let roots: Vec<Root> = accesses.iter().map(|access| access.root).collect();
            let terms: Vec<_> = roots.iter().map(|root| self.terms(*root)).collect();
            let group = self.plan.groups.get(&roots[0]);
            if accesses.iter().all(|access| access.at == accesses[0].at)
                && roots.iter().all(|root| self.plan.groups.get(root) == group)
                && let Some(step) = common_step(&terms).and_then(steps)
            {
                strides.insert(&roots, step);
            }
        }
        strides
    }

    /// A branch to `to`.
    fn record_branch(&mut self, iteration: usize, to: usize, known: SymbolicState) {
        if let Some(place) = self.plan.target(iteration, to) {
            self.merge_at_join(place, known);
        }
    }

    /// Merges facts at a join: those that hold on all paths remain.
    fn merge_at_join(&mut self, place: IterationWord, known: SymbolicState) {
        let Some(mut met) = self.arriving.remove(&place) else {
            self.arriving.insert(place, known);
            return;
        };
        met.spent = met.spent.min(known.spent);
        for (one, other) in met.symbols.iter_mut().zip(&known.symbols) {
            if *one != *other {
                *one = self.root();
            }
        }
        self.arriving.insert(place, met);
    }

    /// Notes an access and widens the group of its root, if their alignments agree.
    fn note(
        &mut self,
        iteration: usize,
        at: usize,
        (base, off, width, is_store): RegisterAccess,
        known: &SymbolicState,
    ) {
        let (root, base) = known.symbols[base.index()];
        let begin = base.wrapping_add(i32::from(off.0));
        self.plan.accesses.insert((iteration, at), Access { root, at: begin, base });
        let size = width.bytes();
        let end = begin + size.cast_signed();
        let group = self.plan.groups.entry(root).or_insert(Group {
            first: begin,
            end,
            width: size,
            has_store: is_store,
        });
        let narrow = size.min(group.width).cast_signed();
        if (begin - group.first) % narrow != 0 {
            return;
        }
        // The first byte stays where the widest access could be.
        let aligned = if size > group.width { begin } else { group.first };
        let wide = size.max(group.width).cast_signed();
        let first = group.first.min(begin);
        group.first = aligned - (aligned - first + wide - 1) / wide * wide;
        group.end = group.end.max(end);
        group.width = wide.cast_unsigned();
        group.has_store |= is_store;
    }
}

impl Plan {
    /// The word at which an iteration begins.
    pub(super) fn entry(&self) -> usize {
        self.order.first().copied().unwrap_or(*self.words.start())
    }

    /// Reports whether a root has several accesses.
    fn shares_checks(&self) -> bool {
        let mut seen = BTreeSet::new();
        self.accesses.values().any(|access| !seen.insert(access.root))
    }

    /// The position in the fast iterations at which a branch of `iteration` to the word `to` continues, if it is part
    /// of them.
    pub(super) fn target(&self, iteration: usize, to: usize) -> Option<IterationWord> {
        if to == self.entry() {
            return (iteration + 1 < self.iterations).then_some((iteration + 1, to));
        }
        self.words.contains(&to).then_some((iteration, to))
    }
}

impl Group {
    /// Reports whether the check of the group covers an access of `width` at `at`.
    pub(super) fn covers(&self, at: i32, width: Width, is_store: bool) -> bool {
        let size = width.bytes().cast_signed();
        self.first <= at
            && at + size <= self.end
            && size.cast_unsigned() <= self.width
            && (at - self.first) % size == 0
            && (self.has_store || !is_store)
    }
}

/// The integer register to which an instruction assigns.
fn int_destination(op: &Op) -> Option<usize> {
    op.operand(Name::Dst).map(RegI32::index)
}
