//! Accesses whose address moves by a loop-invariant register in each iteration.
//!
//! One check covers them all: the step must be small enough for the last iteration's access to be inside.

use std::collections::BTreeMap;

use super::accesses::Root;
use crate::operand::RegI32;

/// One of several roots at equal distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stride {
    /// The register that is added in each iteration.
    pub(super) step: RegI32,
    /// The root in the previous iteration, unless this is the first one.
    pub(super) before: Option<Root>,
    /// Number of iterations that follow.
    pub(super) later: u32,
}

/// The roots of such accesses.
#[derive(Debug, Default)]
pub(super) struct Strides(BTreeMap<Root, Stride>);

impl Strides {
    /// Records the roots of an access in all iterations.
    pub(super) fn insert(&mut self, roots: &[Root], step: RegI32) {
        if roots.iter().any(|root| self.0.contains_key(root)) {
            return;
        }
        let mut before = None;
        for (later, root) in (0..roots.len() as u32).rev().zip(roots) {
            self.0.insert(*root, Stride { step, before, later });
            before = Some(*root);
        }
    }

    /// The stride of `root`, if it has one.
    pub(super) fn get(&self, root: Root) -> Option<Stride> {
        self.0.get(&root).copied()
    }
}

/// The root that each element of `iterations`, as sorted sums, has in addition to the previous one; `None` if they are not
/// such a series.
pub(super) fn common_step(iterations: &[Vec<Root>]) -> Option<Root> {
    let (first, second) = (iterations.first()?, iterations.get(1)?);
    let step = *second.iter().find(|root| count(second, **root) > count(first, **root))?;
    let mut expected = first.clone();
    let is_row = iterations.iter().all(|terms| {
        let is_next = *terms == expected;
        expected.push(step);
        expected.sort_unstable();
        is_next
    });
    is_row.then_some(step)
}

fn count(terms: &[Root], root: Root) -> usize {
    terms.iter().filter(|term| **term == root).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_iteration_adds_the_same_root() {
        assert_eq!(common_step(&[vec![1, 4], vec![1, 2, 4], vec![1, 2, 2, 4]]), Some(2));
        assert_eq!(common_step(&[vec![2], vec![2, 2], vec![2, 2, 2]]), Some(2));
        assert_eq!(common_step(&[vec![1], vec![1, 2], vec![1, 2, 3]]), None);
        assert_eq!(common_step(&[vec![1], vec![1], vec![1]]), None);
        assert_eq!(common_step(&[vec![1]]), None);
    }
}
