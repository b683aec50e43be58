//! The bytes by which a function of the processor's code lowers the stack pointer: the sum of additions to B15, on
//! every path through its blocks.

use c67x::convention::STACK;
use c67x::{Inst, Mem, Mnemonic, Offset, Operand, Pred, Update};

use super::machine::{Block, Routine};

/// The most bytes below the stack pointer of the caller that a function takes for itself; `None` where it moves the
/// pointer by an amount that the code does not show.
pub(super) fn max_frame_depth(code: &Routine) -> Option<u32> {
    let mut entered: Vec<Option<i64>> = vec![None; code.blocks.len()];
    let mut open = vec![(0, 0)];
    let (mut deepest, mut steps) = (0, 0);
    while let Some((index, depth)) = open.pop() {
        // A loop that uses more stack in every iteration has no bound.
        steps += 1;
        if steps > 16 * code.blocks.len() {
            return None;
        }
        let Some(block) = code.blocks.get(index) else { continue };
        if entered[index].is_some_and(|known| known >= depth) {
            continue;
        }
        entered[index] = Some(depth);
        let (below, end) = depth_through_block(code, block, depth)?;
        deepest = deepest.max(below);
        open.extend(block.edges.iter().map(|edge| (edge.to, end)));
    }
    u32::try_from(deepest).ok()
}

/// The deepest place in a block that begins at a depth, and the depth at its end.
fn depth_through_block(code: &Routine, block: &Block, start: i64) -> Option<(i64, i64)> {
    let (mut deepest, mut depth) = (start, start);
    for inst in code.packets[block.packets.clone()].iter().flat_map(|packet| &packet.insts) {
        let taken = stack_bytes(inst)?;
        // A conditional release is assumed not to happen.
        if inst.pred() == Pred::Always || taken > 0 {
            depth += taken;
        }
        deepest = deepest.max(depth);
    }
    Some((deepest, depth))
}

/// The bytes that an instruction takes from the stack; negative if it gives them back.
fn stack_bytes(inst: &Inst) -> Option<i64> {
    if let Some(mem) = inst.mem().filter(|mem| mem.base == STACK && mem.update != Update::None) {
        return base_increment(inst, mem).map(|bytes| -bytes);
    }
    if !inst.writes().any(|write| write.reg == STACK) {
        return Some(0);
    }
    let constant = inst.operands().find_map(|operand| match operand {
        Operand::Const(value) => Some(i64::from(value)),
        _ => None,
    })?;
    match inst.mnemonic() {
        Mnemonic::Addk | Mnemonic::Add => Some(-constant),
        Mnemonic::Sub => Some(constant),
        Mnemonic::Addaw => Some(-4 * constant),
        Mnemonic::Subaw => Some(4 * constant),
        _ => None,
    }
}

/// The bytes that an access adds to its base.
fn base_increment(inst: &Inst, mem: Mem) -> Option<i64> {
    let Offset::Const(count) = mem.offset else { return None };
    let bytes = i64::from(inst.mnemonic().bytes()?) * i64::from(count);
    Some(if mem.negative { -bytes } else { bytes })
}
