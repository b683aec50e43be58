//! Inserts the charges, last of all: nothing behind this stage adds, moves or removes a word.
//!
//! Where a charge belongs and what it covers is the machine's rule, [`vm::meter`].

use vm::meter;
use vm::op::Op;
use vm::operand::Count32;

use super::select::Code;

/// Puts a `charge` at the head of every segment and corrects labels, relocations and lines.
pub(super) fn insert_charges(code: &mut Code) {
    let points = meter::charge_points(&code.ops, 0..code.ops.len());
    let ops = std::mem::take(&mut code.ops);
    // How many charges stand before each word, its own excluded.
    let mut before = vec![0_u32; ops.len() + 1];
    code.ops.reserve_exact(ops.len() + points.len());
    let mut points = points.into_iter().peekable();
    let mut inserted = 0;
    for (index, op) in ops.into_iter().enumerate() {
        before[index] = inserted;
        if let Some((_, cycles)) = points.next_if(|(at, _)| *at == index) {
            code.ops.push(Op::Charge { cycles: Count32(cycles) });
            inserted += 1;
        }
        code.ops.push(op);
    }
    if let Some(last) = before.last_mut() {
        *last = inserted;
    }
    // A label names the charge in front of its word, a relocation the word behind its charge.
    let label = |at: u32| at + before.get(at as usize).copied().unwrap_or(inserted);
    for op in &mut code.ops {
        if let Op::Br { to } | Op::BrIf { to, .. } | Op::BrUnless { to, .. } = op {
            to.0 = label(to.0);
        }
    }
    for relocation in &mut code.relocations {
        let at = relocation.word as usize;
        relocation.word += before.get(at + 1).copied().unwrap_or(inserted);
    }
    for (word, _) in &mut code.spans {
        *word = label(*word);
    }
}
