//! Metering: where a `charge` belongs and what it must cover.
//!
//! The compiler's last pass inserts charges with this, the verifier checks them with it.
//!
//! The rule. The words of a function fall into **segments** that are executed from their
//! beginning to their end. A segment begins
//! - at the function's first executable word;
//! - at every branch target;
//! - behind every branch (`br`, `br_if`, `br_unless`, `br_table` with its `br` words), return and `unreachable`;
//! - behind every call with its result word, if it has one.
//!
//! It ends before the next beginning. The cost of a segment is the sum of the costs of its
//! words; the `br` words of a `br_table` cost nothing, its own cost includes the jump. The first
//! word of every segment whose cost is not 0 is a `charge` of that cost. There is one such charge
//! a segment and no other.
//!
//! A segment that begins behind a call is charged when the callee has returned, so a firmware
//! call that overdraws the budget loses the processor directly behind itself.

use std::ops::Range;

use crate::op::Op;
use crate::operand::Label;

/// The charges that `body` needs: the word before which each stands, and its cycles, ascending.
///
/// `body` holds the executable words of one function, without the `func` and `types` words;
/// labels are indices into `ops`. Charges that are there already count as free, and then the
/// word named is the charge itself.
#[must_use]
pub fn charge_points(ops: &[Op], body: Range<usize>) -> Vec<(usize, u32)> {
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
            *cost = cost.saturating_add(op.cost());
        }
    }
    points.retain(|(_, cost)| *cost != 0);
    points
}

/// Whether `op` is a call, behind which a segment ends.
#[must_use]
pub const fn is_call(op: &Op) -> bool {
    matches!(op, Op::Call { .. } | Op::CallPtr { .. } | Op::CallFw { .. })
}

/// Whether `op` takes the result of a call.
#[must_use]
pub const fn is_result(op: &Op) -> bool {
    matches!(op, Op::ResultI32 { .. } | Op::ResultI64 { .. } | Op::ResultF32 { .. } | Op::ResultF64 { .. })
}

/// Whether `op` never goes on with the next word.
#[must_use]
pub const fn ends_path(op: &Op) -> bool {
    matches!(
        op,
        Op::Br { .. }
            | Op::Ret {}
            | Op::RetI32 { .. }
            | Op::RetI64 { .. }
            | Op::RetF32 { .. }
            | Op::RetF64 { .. }
            | Op::Unreachable {}
    )
}

/// Where the branch `op` goes, if it is one with a label.
#[must_use]
pub const fn branch_target(op: &Op) -> Option<Label> {
    match op {
        Op::Br { to } | Op::BrIf { to, .. } | Op::BrUnless { to, .. } => Some(*to),
        _ => None,
    }
}

/// What each word of a body is to the metering rule.
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
            if ends_path(op) || branch_target(op).is_some() || is_call(op) || matches!(op, Op::BrTable { .. })
            {
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

/// Number of words that belong to the one at `offset`: the branches of a table, the result of a call.
fn group_length(words: &[Op], offset: usize) -> usize {
    match words.get(offset) {
        Some(Op::BrTable { n, .. }) => {
            let branches = words.iter().skip(offset + 1).take(usize::from(n.0) + 1);
            1 + branches.take_while(|op| matches!(op, Op::Br { .. })).count()
        }
        Some(op) if is_call(op) => 1 + usize::from(words.get(offset + 1).is_some_and(is_result)),
        _ => 1,
    }
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
    fn a_loop_head_and_what_follows_a_branch_begin_segments() {
        check(&[ADD, ADD, br_if(1), RET], &[(0, 1), (1, 2), (3, 2)]);
    }

    #[test]
    fn a_segment_ends_behind_a_call_with_its_result() {
        check(&[ADD, CALL, RESULT, ADD, CALL, RET], &[(0, 6), (3, 5), (5, 2)]);
    }

    #[test]
    fn a_table_is_charged_as_one_word() {
        let table = Op::BrTable { index: RegI32(0), n: Count(1) };
        check(&[table, br(3), br(4), ADD, RET], &[(0, 3), (3, 1), (4, 2)]);
    }

    #[test]
    fn charges_that_are_there_do_not_change_the_points() {
        let charge = |cycles| Op::Charge { cycles: Count32(cycles) };
        check(&[charge(1), ADD, charge(2), ADD, br_if(2), charge(2), RET], &[(0, 1), (2, 2), (5, 2)]);
    }

    #[test]
    fn labels_count_from_the_beginning_of_the_slice() {
        let ops = [RET, RET, ADD, br(2)];
        assert_eq!(charge_points(&ops, 2..4), [(2, 2)]);
    }
}
