//! Computes an expression once where it occurs several times, within a block and into the block
//! after it if that has no other predecessor.
//!
//! Only expressions over values are reused: every load of the source remains a load. The last few expressions are
//! remembered until one of their operands is written.

use crate::ir::function::Function;
use crate::ir::inst::{InstKind, Operand, ValueId};

/// Number of expressions that are remembered.
const REMEMBERED: usize = 24;

/// Replaces expressions whose value is available by copies; returns whether there were any.
pub fn run(function: &mut Function) -> bool {
    let predecessors = function.predecessors();
    let mut known: Vec<InstKind> = Vec::with_capacity(REMEMBERED);
    let mut oldest = 0;
    let mut is_changed = false;
    let mut previous = None;
    for index in 0..function.layout.len() {
        let id = function.layout[index];
        if !function.is_only_way(previous, id, &predecessors) {
            known.clear();
        }
        previous = Some(id);
        for inst in &mut function.blocks[id].insts {
            let Some(dst) = inst.kind.dst() else { continue };
            let expression = is_expression(&inst.kind).then_some(inst.kind);
            let same = expression.and_then(|kind| known.iter().find(|other| with_dst(**other, dst) == kind));
            if let Some(src) = same.and_then(InstKind::dst) {
                inst.kind = InstKind::Copy { dst, src: src.into() };
                is_changed = true;
            }
            known.retain(|other| !uses_value(other, dst));
            if let Some(kind) = expression.filter(|kind| !reads(kind, dst)) {
                if known.len() < REMEMBERED {
                    known.push(kind);
                } else {
                    oldest = (oldest + 1) % REMEMBERED;
                    known[oldest] = kind;
                }
            }
        }
    }
    is_changed
}

/// Reports whether the instruction always gives the same result for the same values; one that traps has done so the
/// first time.
const fn is_expression(kind: &InstKind) -> bool {
    match kind {
        InstKind::Unary { .. }
        | InstKind::Binary { .. }
        | InstKind::Compare { .. }
        | InstKind::Convert { .. }
        | InstKind::FrameAddress { .. } => true,
        InstKind::Copy { .. }
        | InstKind::Load { .. }
        | InstKind::Store { .. }
        | InstKind::CopyMemory { .. }
        | InstKind::ClearMemory { .. }
        | InstKind::Call { .. }
        | InstKind::Cost { .. } => false,
    }
}

/// The expression, written to `dst`.
const fn with_dst(kind: InstKind, to: ValueId) -> InstKind {
    match kind {
        InstKind::Unary { op, src, .. } => InstKind::Unary { op, dst: to, src },
        InstKind::Binary { op, a, b, .. } => InstKind::Binary { op, dst: to, a, b },
        InstKind::Compare { op, a, b, .. } => InstKind::Compare { op, dst: to, a, b },
        InstKind::Convert { op, src, .. } => InstKind::Convert { op, dst: to, src },
        InstKind::FrameAddress { slot, offset, .. } => InstKind::FrameAddress { dst: to, slot, offset },
        InstKind::Copy { .. }
        | InstKind::Load { .. }
        | InstKind::Store { .. }
        | InstKind::CopyMemory { .. }
        | InstKind::ClearMemory { .. }
        | InstKind::Call { .. }
        | InstKind::Cost { .. } => kind,
    }
}

fn reads(kind: &InstKind, value: ValueId) -> bool {
    let mut is_read = false;
    let mut kind = *kind;
    kind.visit_operands(|operand| is_read |= *operand == Operand::Value(value));
    is_read
}

fn uses_value(kind: &InstKind, value: ValueId) -> bool {
    kind.dst() == Some(value) || reads(kind, value)
}
