//! Variable arguments go to memory as soon as they are known, if calls come between: then no register has to keep them.
//!
//! The area of the frame that they are in is nobody else's until the call, unless a call before has variable arguments
//! too. A function that is called by its address may have some. Where a function with variable arguments was put in place
//! of its call, others may read its arguments there; then all stays as it is.

use std::collections::BTreeSet;

use crate::c67x::Externs;
use crate::ir::function::{Block, Function};
use crate::ir::inst::{Base, Callee, InstKind, Operand, ValueId};

/// The numbers of a block's instructions in the order in which they are selected.
pub(super) fn order(function: &Function, block: &Block, externs: &Externs) -> Vec<usize> {
    if is_area_shared(function, externs) {
        return (0..block.insts.len()).collect();
    }
    let mut followers: Vec<Vec<usize>> = vec![Vec::new(); block.insts.len()];
    let mut is_moved = vec![false; block.insts.len()];
    for (index, is_moved) in is_moved.iter_mut().enumerate() {
        if let Some(maker) = maker(function, block, externs, index) {
            followers[maker].push(index);
            *is_moved = true;
        }
    }
    let kept = (0..block.insts.len()).filter(|index| !is_moved[*index]);
    kept.flat_map(|index| std::iter::once(index).chain(followers[index].iter().copied())).collect()
}

/// The instruction that makes what a store of a variable argument stores, if it can follow that one and calls are
/// between them.
fn maker(function: &Function, block: &Block, externs: &Externs, index: usize) -> Option<usize> {
    let outgoing = function.outgoing?;
    let InstKind::Store { src: Operand::Value(value), address, .. } = block.insts[index].kind else {
        return None;
    };
    if address.base != Base::Slot(outgoing) {
        return None;
    }
    let maker = block.insts[..index].iter().rposition(|inst| inst.kind.dst() == Some(value))?;
    let mut calls = 0;
    for inst in &block.insts[maker + 1..index] {
        if let InstKind::Call { callee, .. } = inst.kind {
            if has_variable(callee, externs) {
                return None;
            }
            calls += 1;
        } else if matches!(inst.kind, InstKind::Load { address, .. } if address.base == Base::Slot(outgoing))
        {
            return None;
        }
    }
    // The result of such a call is stored where the source says.
    let is_own =
        matches!(block.insts[maker].kind, InstKind::Call { callee, .. } if has_variable(callee, externs));
    (calls > 0 && !is_own).then_some(maker)
}

/// Whether anything but calls with variable arguments has the address of their area.
fn is_area_shared(function: &Function, externs: &Externs) -> bool {
    let insts = || function.layout.iter().flat_map(|block| &function.blocks[*block].insts);
    let addresses: BTreeSet<ValueId> = insts()
        .filter_map(|inst| {
            let InstKind::FrameAddress { dst, slot, .. } = inst.kind else { return None };
            (Some(slot) == function.outgoing).then_some(dst)
        })
        .collect();
    let is_address = |operand| matches!(operand, Operand::Value(value) if addresses.contains(&value));
    insts().any(|inst| {
        let (mut kind, mut is_found) = (inst.kind, false);
        kind.visit_operands(|operand| is_found |= is_address(*operand));
        let takes_variable =
            matches!(inst.kind, InstKind::Call { callee, .. } if has_variable(callee, externs));
        let passed = kind.arguments().filter(|_| !takes_variable);
        let mut passed = passed.into_iter().flat_map(|arguments| &function.arguments[arguments.range()]);
        is_found || passed.any(|operand| is_address(*operand))
    })
}

/// Whether a function may have variable arguments.
fn has_variable(callee: Callee, externs: &Externs) -> bool {
    match callee {
        Callee::Pointer(_) => true,
        Callee::Symbol(symbol) => externs.is_variadic(symbol),
    }
}
