//! Early stores of variable arguments: as soon as they are known, if other calls come in between, so that no register
//! has to hold them.
//!
//! The area of the frame that holds them belongs to one call until that call is made, unless an earlier call is
//! variadic, too, as a function called by its address may be. If a variadic function was inlined, other instructions
//! may read its arguments there; then nothing is moved.

use std::collections::{BTreeMap, BTreeSet};

use crate::c67x::Externs;
use crate::ir::function::{Block, Function};
use crate::ir::inst::{Base, Callee, InstKind, Operand, ValueId};

/// The numbers of a block's instructions in the order in which they are selected; unchanged if the area is shared.
pub(super) fn order(function: &Function, block: &Block, externs: &Externs, is_shared: bool) -> Vec<usize> {
    if is_shared || function.outgoing.is_none() {
        return (0..block.insts.len()).collect();
    }
    let uses = AreaUses::of(function, block, externs);
    let mut followers: Vec<Vec<usize>> = vec![Vec::new(); block.insts.len()];
    let mut is_moved = vec![false; block.insts.len()];
    for (index, is_moved) in is_moved.iter_mut().enumerate() {
        if let Some(maker) = maker(function, block, &uses, index) {
            followers[maker].push(index);
            *is_moved = true;
        }
    }
    let kept = (0..block.insts.len()).filter(|index| !is_moved[*index]);
    kept.flat_map(|index| std::iter::once(index).chain(followers[index].iter().copied())).collect()
}

/// The calls before each instruction of a block, and the last instruction before it that computes the value it stores.
struct AreaUses {
    /// Number of calls, and of users of the area: calls with variable arguments, and loads from it.
    counts: Vec<[usize; 2]>,
    makers: Vec<Option<usize>>,
    /// True for each instruction that is a call with variable arguments.
    has_variable: Vec<bool>,
}

impl AreaUses {
    fn of(function: &Function, block: &Block, externs: &Externs) -> Self {
        let mut last: BTreeMap<ValueId, usize> = BTreeMap::new();
        let (mut counts, mut makers, mut variable) = (vec![[0, 0]], Vec::new(), Vec::new());
        let mut count = [0, 0];
        for (index, inst) in block.insts.iter().enumerate() {
            let stored = if let InstKind::Store { src: Operand::Value(value), .. } = inst.kind {
                last.get(&value).copied()
            } else {
                None
            };
            makers.push(stored);
            let mut is_variable = false;
            if let InstKind::Call { callee, .. } = inst.kind {
                is_variable = has_variable(callee, externs);
                count[0] += 1;
            }
            let is_load = matches!(inst.kind, InstKind::Load { address, .. }
                if function.outgoing.is_some_and(|outgoing| address.base == Base::Slot(outgoing)));
            count[1] += usize::from(is_variable || is_load);
            variable.push(is_variable);
            counts.push(count);
            if let Some(value) = inst.kind.dst() {
                last.insert(value, index);
            }
        }
        Self { counts, makers, has_variable: variable }
    }
}

/// The instruction that computes the value of a variable-argument store, if the store can follow it directly and calls
/// are between them.
fn maker(function: &Function, block: &Block, uses: &AreaUses, index: usize) -> Option<usize> {
    let outgoing = function.outgoing?;
    let InstKind::Store { src: Operand::Value(_), address, .. } = block.insts[index].kind else {
        return None;
    };
    if address.base != Base::Slot(outgoing) {
        return None;
    }
    let maker = uses.makers[index]?;
    let [before, uses_before] = uses.counts[maker + 1];
    let [after, uses_after] = uses.counts[index];
    if uses_after > uses_before {
        return None;
    }
    // The result of such a call is stored at its position in the source.
    (after > before && !uses.has_variable[maker]).then_some(maker)
}

/// Reports whether the address of the variable-argument area is used by anything except variadic calls.
pub(super) fn is_area_shared(function: &Function, externs: &Externs) -> bool {
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

/// Reports whether a function may have variable arguments.
fn has_variable(callee: Callee, externs: &Externs) -> bool {
    match callee {
        Callee::Pointer(_) => true,
        Callee::Symbol(symbol) => externs.is_variadic(symbol),
    }
}
