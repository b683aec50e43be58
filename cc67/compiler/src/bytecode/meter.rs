//! Inserts the charges in the last stage: nothing after it adds, moves or removes a word.
//!
//! The position and the amount of each charge follow the machine's rule, [`vm::meter`].

use vm::meter;
use vm::op::Op;
use vm::operand::Count32;
use vm::patch;

use super::select::Code;

/// Puts a `charge` at the head of every segment and corrects labels, relocations and lines.
///
/// Charges that come from the source are replaced by their sum at the head.
pub(super) fn insert_charges(code: &mut Code) {
    let all = 0..code.ops.len();
    let points = if code.is_priced {
        meter::stated_points(&code.ops, all)
    } else {
        meter::charge_points(&code.ops, all)
    };
    let ops = std::mem::take(&mut code.ops);
    code.ops.reserve_exact(ops.len() + points.len());
    // The new position of each word, and the beginning of the words written for it, which is the charge before it.
    let (mut words, mut heads) = (Vec::with_capacity(ops.len()), Vec::with_capacity(ops.len() + 1));
    let mut points = points.into_iter().peekable();
    for (index, op) in ops.into_iter().enumerate() {
        heads.push(code.ops.len() as u32);
        if let Some((_, cycles)) = points.next_if(|(at, _)| *at == index) {
            code.ops.push(Op::Charge { cycles: Count32(cycles) });
        }
        words.push(code.ops.len() as u32);
        if !matches!(op, Op::Charge { .. }) {
            code.ops.push(op);
        }
    }
    heads.push(code.ops.len() as u32);
    let end = code.ops.len() as u32;
    let head = |at: u32| heads.get(at as usize).copied().unwrap_or(end);
    code.ops.iter_mut().for_each(|op| patch::labels(op, head));
    for relocation in &mut code.relocations {
        relocation.word = words.get(relocation.word as usize).copied().unwrap_or(end);
    }
    for (word, _) in &mut code.spans {
        *word = head(*word);
    }
    for (word, _) in &mut code.calls {
        *word = head(*word);
    }
    for word in &mut code.insts {
        *word = head(*word);
    }
}
