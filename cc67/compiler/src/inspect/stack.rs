//! How deep the guest stack can get: frames along chains of calls.
//!
//! A frame holds what has an address: arrays, structures, locals with `&`. Everything else
//! lives in registers of the machine and costs no stack. In code for the controller's processor a frame also holds
//! registers and arguments; what firmware functions take comes on top.

use std::fmt::Write as _;

use coff::Target;
use kmotiondef::map::{BOARD_STACK_SIZE, STACK_SIZE};

use super::Inspection;
use super::calls::Calls;

/// The most stack that a function and what it calls can need.
#[derive(Clone, Debug)]
enum Depth {
    /// This many bytes, and the function called next on the way there.
    Bytes(u32, Option<usize>),
    /// A call leads back to a function that is still at work.
    Recursive,
}

/// Frame and depth of each function, and the worst chain.
pub(super) fn render(inspection: &Inspection, calls: &Calls) -> String {
    let depths = depths(calls);
    let mut out = String::from("   frame    stack  function\n");
    for (node, depth) in calls.nodes.iter().zip(&depths) {
        let total = match depth {
            Depth::Bytes(bytes, _) => bytes.to_string(),
            Depth::Recursive => "recursive".to_owned(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{:8} {total:>9}  {}", node.frame, node.name);
    }
    let entry = inspection.main();
    let Some(main) = calls.nodes.iter().position(|node| Some(node.address) == entry) else { return out };
    let _ = match depths.get(main) {
        Some(Depth::Bytes(bytes, _)) => {
            let names = chain(calls, &depths, main);
            match inspection.image.target {
                Target::C6000 => writeln!(
                    out,
                    "worst chain: {names} = {bytes} of the board's {BOARD_STACK_SIZE} bytes, without what firmware functions \
                     and interrupts take"
                ),
                _ => writeln!(out, "worst chain: {names} = {bytes} of {STACK_SIZE} bytes"),
            }
        }
        _ => writeln!(out, "worst chain: unknown, the program is recursive"),
    };
    out
}

/// The depth of every function. Callees are done before their callers; the graph of calls is
/// walked with a stack of its own, because programs may nest deeper than our own stack.
fn depths(calls: &Calls) -> Vec<Depth> {
    let mut depths: Vec<Option<Depth>> = vec![None; calls.nodes.len()];
    let mut at_work = vec![false; calls.nodes.len()];
    for start in 0..calls.nodes.len() {
        let mut path = vec![start];
        while let Some(index) = path.last().copied() {
            let Some(node) = calls.nodes.get(index) else { break };
            let mut callees = node.calls.union(&node.through_pointers);
            at_work[index] = true;
            match callees.find(|callee| depths[**callee].is_none() && !at_work[**callee]) {
                Some(next) if depths[index].is_none() => path.push(*next),
                _ => {
                    path.pop();
                    at_work[index] = false;
                    if depths[index].is_none() {
                        depths[index] = Some(depth(calls, index, &depths));
                    }
                }
            }
        }
    }
    depths.into_iter().map(|depth| depth.unwrap_or(Depth::Recursive)).collect()
}

/// The depth of one function from those of its callees; one without depth is still at work.
fn depth(calls: &Calls, index: usize, depths: &[Option<Depth>]) -> Depth {
    let Some(node) = calls.nodes.get(index) else { return Depth::Recursive };
    let mut deepest = (0, None);
    for callee in node.calls.union(&node.through_pointers) {
        match depths.get(*callee) {
            Some(Some(Depth::Bytes(bytes, _))) if deepest.1.is_none() || *bytes > deepest.0 => {
                deepest = (*bytes, Some(*callee));
            }
            Some(Some(Depth::Bytes(..))) => {}
            _ => return Depth::Recursive,
        }
    }
    Depth::Bytes(node.frame.saturating_add(deepest.0), deepest.1)
}

/// The names along the deepest way, `main (16) → read (120)`.
fn chain(calls: &Calls, depths: &[Depth], start: usize) -> String {
    let mut names = Vec::new();
    let mut next = Some(start);
    while let Some(index) = next {
        let Some(node) = calls.nodes.get(index) else { break };
        names.push(format!("{} ({})", node.name, node.frame));
        next = match depths.get(index) {
            Some(Depth::Bytes(_, next)) => *next,
            _ => None,
        };
    }
    names.join(" → ")
}
