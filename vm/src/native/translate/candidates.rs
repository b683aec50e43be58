//! The words that may be translated a second time: loops, regions and straight segments.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::{Range, RangeInclusive};

use super::accesses::accessed;
use crate::kind::OpKind;
use crate::meter::{self, branch_target};
use crate::op::Op;
use crate::program::{Function, Program};

/// The most words that are translated twice at once.
pub(super) const MAX_WORDS: usize = 160;

/// The innermost loops, each with the word at which it is entered.
///
/// A loop is the words from the target of a backward branch to the branch. It must have a single entry, which is often
/// its condition.
pub(super) fn innermost_loops(program: &Program, function: &Function) -> Vec<(RangeInclusive<usize>, usize)> {
    let branches: Vec<(usize, usize)> = (function.body.clone())
        .filter_map(|at| branch_target(&program.ops()[at]).map(|to| (at, to.0 as usize)))
        .collect();
    let mut ends = BTreeMap::new();
    for (at, to) in branches.iter().filter(|(at, to)| to <= at) {
        ends.insert(*to, *at);
    }
    let entered = |words: RangeInclusive<usize>| {
        let falls_in = function.body.contains(&(words.start() - 1))
            && !program.ops()[words.start() - 1].kind().ends_path();
        let inside = ends.range(words.clone()).count();
        let jumps = branches.iter().filter(|(at, to)| !words.contains(at) && words.contains(to));
        let mut entries = jumps.map(|(_, to)| *to).chain(falls_in.then_some(*words.start()));
        let entry = entries.next()?;
        let is_only_one = inside == 1 && entries.all(|other| other == entry);
        let is_charged = matches!(program.ops()[entry], Op::Charge { .. });
        (is_only_one && is_charged).then_some((words, entry))
    };
    ends.iter().filter_map(|(first, last)| entered(*first..=*last)).collect()
}

/// The words that are entered by branches, each with the first and the last branch to it.
struct Entries(BTreeMap<usize, RangeInclusive<usize>>);

impl Entries {
    fn of(program: &Program, function: &Function) -> Self {
        let mut entries: BTreeMap<usize, RangeInclusive<usize>> = BTreeMap::new();
        for at in function.body.clone() {
            if let Some(to) = branch_target(&program.ops()[at]) {
                let from = entries.entry(to.0 as usize).or_insert(at..=at);
                *from = *from.start()..=at;
            }
        }
        Self(entries)
    }

    /// Reports whether `at` is the target of a branch from before the word `first`, or from a later word.
    fn is_entered(&self, at: usize, first: usize) -> bool {
        self.0.get(&at).is_some_and(|from| *from.start() < first || *from.end() >= at)
    }
}

/// The regions: words without backward branches, with the first word as their only entry, that contain more than one
/// charge.
///
/// One test of the budget at the entry of a region replaces the tests of its charges. Words that `is_taken` accepts are
/// left out.
pub(super) fn regions(
    program: &Program,
    function: &Function,
    is_taken: &dyn Fn(usize) -> bool,
    cost: &dyn Fn(&Op) -> Option<u32>,
) -> Vec<RangeInclusive<usize>> {
    let entries = Entries::of(program, function);
    let is_charge = |at: &usize| matches!(program.ops()[*at], Op::Charge { .. });
    let mut regions = Vec::new();
    let mut first = function.body.start;
    while first < function.body.end {
        let may_go_on = |at: &usize| {
            let is_entered = *at > first && entries.is_entered(*at, first);
            !is_taken(*at) && !is_entered && cost(&program.ops()[*at]).is_some()
        };
        let most = function.body.end.min(first + MAX_WORDS);
        let end = (first..most).take_while(may_go_on).last().map_or(first, |last| last + 1);
        let end = without_arguments(program, first..end);
        if (first..end).filter(is_charge).count() > 1 {
            regions.push(first..=end - 1);
        }
        let next = end.max(first + 1);
        first = (next..function.body.end).find(is_charge).unwrap_or(function.body.end);
    }
    regions
}

/// The end of `words`, before the arguments of the call after them, which belong to the call.
fn without_arguments(program: &Program, words: Range<usize>) -> usize {
    let mut argument = None;
    for at in words.clone() {
        let op = &program.ops()[at];
        if is_argument(op) {
            argument.get_or_insert(at);
        } else if meter::is_call(op) {
            argument = None;
        }
    }
    argument.unwrap_or(words.end)
}

/// The segments of a block, between charges, calls and branches, that make several accesses.
pub(super) fn straight_segments(
    program: &Program,
    function: &Function,
    begins: &BTreeSet<usize>,
    cost: &dyn Fn(&Op) -> Option<u32>,
) -> Vec<RangeInclusive<usize>> {
    let mut segments = Vec::new();
    let (mut first, mut last, mut accesses) = (function.body.start, 0, 0);
    for at in function.body.clone() {
        let op = program.ops()[at];
        let ends = !op.kind().is_straight() || cost(&op) != Some(0);
        if ends || begins.contains(&at) {
            // The words after the last access are not translated twice.
            if accesses > 1 {
                segments.push(first..=last);
            }
            (first, accesses) = (at + usize::from(ends), 0);
        }
        if accessed(&op).is_some() {
            (last, accesses) = (at, accesses + 1);
        }
    }
    segments
}

/// Reports whether an instruction passes an argument to the call after it.
const fn is_argument(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Argument(_))
}
