//! Metering: the position and the amount of each `charge`.
//!
//! The compiler's last pass uses this module to insert charges. The verifier requires less: it does not check the
//! amounts, as an image's charges may state the cycles of the vendor's code instead of these words; but every function
//! and every iteration of a loop must have a charge, so that every program reaches one ([`find_uncharged`]).
//!
//! The rule. The words of a function fall into **segments** that are executed from their
//! beginning to their end. A segment begins
//! - at the function's first executable word;
//! - at every branch target;
//! - after every branch (`br`, `br_if`, `br_unless`, `br_table` with its `br` words), return and `unreachable`;
//! - after every call with its result word, if it has one.
//!
//! It ends before the beginning of the next segment. The cost of a segment is the sum of the costs of its words; the
//! `br` words of a `br_table` cost nothing, its own cost includes the jump. The first word of every segment whose cost
//! is not 0 is a `charge` of that cost. A segment has only this charge.
//!
//! A segment that begins after a call is charged when the callee has returned, so a firmware
//! call that overdraws the budget loses the processor directly after itself.
//!
//! Where threads lose the processor as on the board ([`Preemption::Instructions`](crate::engine::Preemption)), a
//! segment that the budget does not cover is executed in [steps] up to the cycle in which the slice ends.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

use std::ops::Range;

use crate::kind::{Name, OpKind};
use crate::op::Op;
use crate::operand::{Addr, Label};

/// The charges that `body` needs: the word before which each is inserted, and its cycles, in ascending order.
///
/// `body` holds the executable words of one function, without the `func` and `types` words; labels are indices into
/// `ops`. Existing charges are taken as free, and the word is then the charge itself.
#[must_use]
pub fn charge_points(ops: &[Op], body: Range<usize>) -> Vec<(usize, u32)> {
    segment_sums(ops, body, Op::cost)
}

/// As [`charge_points`], for a body whose charges were placed where its source states costs: each segment gets the sum
/// of its own charges.
#[must_use]
pub fn stated_points(ops: &[Op], body: Range<usize>) -> Vec<(usize, u32)> {
    segment_sums(ops, body, charged_cycles)
}

/// The cycles that an instruction charges.
pub(crate) const fn charged_cycles(op: &Op) -> u32 {
    if let Op::Charge { cycles } = op { cycles.0 } else { 0 }
}

/// The segments with a cost, and the cost of each.
fn segment_sums(ops: &[Op], body: Range<usize>, cost_of: impl Fn(&Op) -> u32) -> Vec<(usize, u32)> {
    let words = ops.get(body.clone()).unwrap_or_default();
    let roles = Roles::of(words, body.start);
    let mut points: Vec<(usize, u32)> = Vec::new();
    for (offset, op) in words.iter().enumerate() {
        if roles.begins[offset] {
            points.push((body.start + offset, 0));
        }
        if let Some((_, cost)) = points.last_mut()
            && !roles.in_table[offset]
        {
            *cost = cost.saturating_add(cost_of(op));
        }
    }
    points.retain(|(_, cost)| *cost != 0);
    points
}

/// A word of `body` that execution can start from, or return to, without meeting a charge.
#[must_use]
pub fn find_uncharged(ops: &[Op], body: Range<usize>) -> Option<usize> {
    let words = ops.get(body.clone()).unwrap_or_default();
    if words.first().is_none_or(|op| charged_cycles(op) == 0) {
        return Some(body.start);
    }
    let begins = Roles::of(words, body.start).begins;
    // A segment that is reached again while it is on the current path belongs to a cycle.
    let (mut on_way, mut done) = (vec![false; words.len()], vec![false; words.len()]);
    for root in (0..words.len()).filter(|root| begins[*root]) {
        if done[root] {
            continue;
        }
        let mut way = vec![(root, successors(words, &begins, root, body.start))];
        while let Some((segment, rest)) = way.last_mut() {
            let segment = *segment;
            on_way[segment] = true;
            let Some(next) = rest.pop() else {
                on_way[segment] = false;
                done[segment] = true;
                way.pop();
                continue;
            };
            if on_way.get(next).copied().unwrap_or(false) {
                return Some(body.start + next);
            }
            if done.get(next) == Some(&false) {
                way.push((next, successors(words, &begins, next, body.start)));
            }
        }
    }
    None
}

/// The successors of the segment at `first`; none if it is charged.
fn successors(words: &[Op], begins: &[bool], first: usize, start: usize) -> Vec<usize> {
    let mut found = Vec::new();
    if charged_cycles(&words[first]) != 0 {
        return found;
    }
    let behind = (first + 1..words.len()).find(|at| begins[*at]).unwrap_or(words.len());
    for op in &words[first..behind] {
        found.extend(branch_target(op).and_then(|to| (to.0 as usize).checked_sub(start)));
    }
    if words.get(behind - 1).is_some_and(|op| !op.kind().ends_path()) {
        found.push(behind);
    }
    found.retain(|at| *at < words.len());
    found
}

/// The cycles of a segment, put down to its instructions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// The cycles before the first instruction takes effect.
    pub head: u32,
    /// The instructions in order, and the cycles from the effect of each to the effect of the next; for the last one,
    /// to the end of the segment.
    pub steps: Vec<(usize, u32)>,
}

/// The steps paid by the charge at `charge`: everything up to the next charge, or up to the first instruction that may
/// continue elsewhere. The result of a call belongs to the call.
///
/// Each instruction takes at least the cycles that the vendor's code takes for it; the rest of the charge, for locals
/// in memory for instance, passes before the first step. A smaller charge is divided in proportion.
#[must_use]
pub fn steps(ops: &[Op], charge: usize) -> Steps {
    let total = ops.get(charge).map_or(0, charged_cycles);
    let mut effects: Vec<(usize, u32)> = Vec::new();
    let mut sum = 0_u32;
    for (word, op) in ops.iter().enumerate().skip(charge + 1) {
        if matches!(op.kind(), OpKind::Charge | OpKind::Structure) {
            break;
        }
        let (lead, work) = shape(op);
        effects.push((word, sum.saturating_add(lead)));
        sum = sum.saturating_add(lead).saturating_add(work);
        if ends_segment(op.kind()) {
            break;
        }
    }
    let place = |effect: u32| match total.checked_sub(sum) {
        Some(rest) => rest + effect,
        None => (u64::from(effect) * u64::from(total) / u64::from(sum)) as u32,
    };
    let mut ends = effects.iter().skip(1).map(|(_, effect)| place(*effect)).chain([total]);
    let head = effects.first().map_or(total, |(_, effect)| place(*effect));
    let lasting = |(word, effect): &(usize, u32)| (*word, ends.next().unwrap_or(total) - place(*effect));
    Steps { head, steps: effects.iter().map(lasting).collect() }
}

/// The cycles that the vendor's code takes before an instruction takes effect, and after it (`spec/costs.md` section
/// 6): a constant address takes two, a load four until its value is available.
fn shape(op: &Op) -> (u32, u32) {
    let address = if op.operand::<Addr>(Name::Addr).is_some() { 2 } else { 0 };
    match op.kind() {
        OpKind::Structure | OpKind::Charge | OpKind::Result(_) => (0, 0),
        OpKind::Constant => (0, 2),
        OpKind::Move | OpKind::Argument(_) | OpKind::Stop => (0, 1),
        OpKind::Address | OpKind::Negation => (0, 3),
        OpKind::Conversion => (0, 4),
        // With the constant on its right side.
        OpKind::Arithmetic => (0, 2 + op.cost()),
        OpKind::Load(_) => (address, 5),
        OpKind::Store(width) => (address, width.bytes().div_ceil(4)),
        OpKind::Block => (0, op.cost()),
        OpKind::Jump | OpKind::Branch | OpKind::Call | OpKind::Return(_) => (0, 6),
        OpKind::Table => (0, 9),
    }
}

/// Reports whether `op` is a call, after which a segment ends.
#[must_use]
pub const fn is_call(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Call)
}

/// Reports whether `op` takes the result of a call.
#[must_use]
pub const fn is_result(op: &Op) -> bool {
    matches!(op.kind(), OpKind::Result(_))
}

/// The target of the branch `op`, if it has a label.
#[must_use]
pub fn branch_target(op: &Op) -> Option<Label> {
    op.operand(Name::To)
}

/// The role of each word of a body in the metering rule.
struct Roles {
    begins: Vec<bool>,
    in_table: Vec<bool>,
}

impl Roles {
    fn of(words: &[Op], start: usize) -> Self {
        let mut roles = Self { begins: vec![false; words.len()], in_table: vec![false; words.len()] };
        roles.begin(Some(0));
        let mut offset = 0;
        while let Some(op) = words.get(offset) {
            roles.begin(branch_target(op).and_then(|to| (to.0 as usize).checked_sub(start)));
            let next = offset + group_length(words, offset);
            if let Op::BrTable { .. } = op {
                for (behind, branch) in words.iter().enumerate().take(next).skip(offset + 1) {
                    roles.in_table[behind] = true;
                    roles.begin(branch_target(branch).and_then(|to| (to.0 as usize).checked_sub(start)));
                }
            }
            if ends_segment(op.kind()) {
                roles.begin(Some(next));
            }
            offset = next;
        }
        roles
    }

    fn begin(&mut self, offset: Option<usize>) {
        if let Some(begins) = offset.and_then(|offset| self.begins.get_mut(offset)) {
            *begins = true;
        }
    }
}

/// Reports whether a segment begins after an instruction of this kind and the words that belong to it.
const fn ends_segment(kind: OpKind) -> bool {
    kind.ends_path() || matches!(kind, OpKind::Branch | OpKind::Table | OpKind::Call)
}

/// Number of words in the group at `offset`: an instruction with the branches of its table, or with the result of its
/// call.
fn group_length(words: &[Op], offset: usize) -> usize {
    let Some(op) = words.get(offset) else { return 1 };
    if let Op::BrTable { n, .. } = op {
        let branches = words.iter().skip(offset + 1).take(usize::from(n.0) + 1);
        return 1 + branches.take_while(|op| op.kind() == OpKind::Jump).count();
    }
    1 + usize::from(is_call(op) && words.get(offset + 1).is_some_and(is_result))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operand::{Addr, Count, Count32, Imm16, RegI32, SigRef};

    const ADD: Op = Op::AddI32Imm { dst: RegI32(0), a: RegI32(0), imm: Imm16(1) };
    const CALL: Op = Op::CallFw { sig: SigRef(0), addr: Addr(0) };
    const RESULT: Op = Op::ResultI32 { dst: RegI32(0) };
    const RET: Op = Op::Ret {};

    const fn br(to: u32) -> Op {
        Op::Br { to: Label(to) }
    }

    const fn br_if(to: u32) -> Op {
        Op::BrIf { cond: RegI32(0), to: Label(to) }
    }

    fn check(ops: &[Op], expected: &[(usize, u32)]) {
        assert_eq!(charge_points(ops, 0..ops.len()), expected);
    }

    #[test]
    fn straight_code_is_one_segment() {
        check(&[ADD, ADD, RET], &[(0, 4)]);
    }

    #[test]
    fn loop_heads_and_code_after_a_branch_begin_segments() {
        check(&[ADD, ADD, br_if(1), RET], &[(0, 1), (1, 2), (3, 2)]);
    }

    #[test]
    fn a_segment_ends_after_a_call_with_its_result() {
        check(&[ADD, CALL, RESULT, ADD, CALL, RET], &[(0, 6), (3, 5), (5, 2)]);
    }

    #[test]
    fn a_table_is_charged_as_one_word() {
        let table = Op::BrTable { index: RegI32(0), n: Count(1) };
        check(&[table, br(3), br(4), ADD, RET], &[(0, 3), (3, 1), (4, 2)]);
    }

    #[test]
    fn existing_charges_do_not_change_the_charge_points() {
        let charge = |cycles| Op::Charge { cycles: Count32(cycles) };
        check(&[charge(1), ADD, charge(2), ADD, br_if(2), charge(2), RET], &[(0, 1), (2, 2), (5, 2)]);
    }

    #[test]
    fn the_steps_of_a_segment_take_what_its_charge_pays() {
        let charge = |cycles| Op::Charge { cycles: Count32(cycles) };
        let load = Op::LoadI32At { dst: RegI32(0), addr: Addr(0x8000_0000) };
        let store = Op::StoreI32At { src: RegI32(0), addr: Addr(0x8000_0000) };
        let update = |cycles| [charge(cycles), load, ADD, store, br(0), RET];
        let check = |ops: &[Op], head, expected: &[(usize, u32)]| {
            assert_eq!(steps(ops, 0), Steps { head, steps: expected.to_vec() });
        };
        // The words take at least 19 cycles; the value is loaded in cycle 2 and stored in cycle 12.
        check(&update(19), 2, &[(1, 5), (2, 5), (3, 1), (4, 6)]);
        check(&update(44), 27, &[(1, 5), (2, 5), (3, 1), (4, 6)]);
        check(&update(4), 0, &[(1, 1), (2, 1), (3, 0), (4, 2)]);
        check(&[charge(7), CALL, RESULT, ADD], 1, &[(1, 6)]);
        check(&[charge(7), charge(2), RET], 7, &[]);
        check(&[charge(7), ADD, charge(2), RET], 4, &[(1, 3)]);
    }

    #[test]
    fn labels_count_from_the_beginning_of_the_slice() {
        let ops = [RET, RET, ADD, br(2)];
        assert_eq!(charge_points(&ops, 2..4), [(2, 2)]);
    }
}
