//! The depth of the stack: frames along chains of calls.
//!
//! In bytecode a frame holds the objects that have an address: arrays, structures, locals with `&`. Everything else is
//! in registers of the machine and needs no stack. In code for the controller's processor, the frame size is the amount
//! subtracted from the stack pointer; servo interrupts and firmware functions use the same stack.

use std::fmt::Write as _;

use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::map::{INTERRUPT_STACK, STACK_SIZE, THREAD_STACK};

use super::Inspection;
use super::calls::{Calls, Node};

/// The maximum stack that a function needs, including its callees.
#[derive(Clone, Debug)]
enum Depth {
    /// This many bytes, and the next function on the deepest path.
    Bytes(u32, DeepestCallee),
    /// A call leads to a function that is still being analysed, or whose depth is unknown.
    Unknown,
}

/// The callee at the deepest point.
#[derive(Clone, Copy, Debug)]
enum DeepestCallee {
    Nothing,
    Function(usize),
    Firmware(&'static str, u32),
}

/// Frame and depth of each function, and the worst chain.
pub(super) fn render(inspection: &Inspection, calls: &Calls) -> String {
    let is_real = inspection.image.target == coff::Target::C6000;
    let depths = Depths { calls, is_real }.all();
    let mut out = String::from("   frame    stack  function\n");
    for (node, depth) in calls.nodes.iter().zip(&depths) {
        let total = match depth {
            Depth::Bytes(bytes, _) => bytes.to_string(),
            Depth::Unknown => "unknown".to_owned(),
        };
        let frame = node.frame.map_or_else(|| "unknown".to_owned(), |frame| frame.to_string());
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{frame:>8} {total:>9}  {}", node.name);
    }
    let entry = inspection.main();
    let Some(main) = calls.nodes.iter().position(|node| Some(node.address) == entry) else { return out };
    let limit = if is_real { THREAD_STACK } else { STACK_SIZE };
    let _ = match depths.get(main) {
        Some(Depth::Bytes(bytes, _)) => {
            let much = if *bytes > limit { ": too much" } else { "" };
            writeln!(
                out,
                "worst chain: {} = {bytes} of {limit} bytes{much}",
                deepest_path(calls, &depths, main)
            )
        }
        _ => writeln!(out, "worst chain: unknown: {}", reason(calls, main)),
    };
    if is_real {
        let _ = writeln!(
            out,
            "of a thread's 2048 bytes, {INTERRUPT_STACK} are kept for the interrupts of the servo"
        );
    }
    for node in calls.nodes.iter().filter(|node| node.calls_pointers && node.through_pointers.is_empty()) {
        let _ = writeln!(out, "not counted: what `{}` calls through a pointer", node.name);
    }
    out
}

struct Depths<'a> {
    calls: &'a Calls,
    /// True for code of the processor, where the firmware's functions are on the same stack.
    is_real: bool,
}

impl Depths<'_> {
    /// The depth of every function. Callees are analysed before their callers; the call graph is walked with an
    /// explicit stack, because programs may nest deeper than our own stack.
    fn all(&self) -> Vec<Depth> {
        let calls = self.calls;
        let mut depths: Vec<Option<Depth>> = vec![None; calls.nodes.len()];
        let mut at_work = vec![false; calls.nodes.len()];
        for start in 0..calls.nodes.len() {
            let mut path = vec![start];
            while let Some(index) = path.last().copied() {
                let Some(node) = calls.nodes.get(index) else { break };
                let mut callees = callees(node);
                at_work[index] = true;
                match callees.find(|callee| depths[*callee].is_none() && !at_work[*callee]) {
                    Some(next) if depths[index].is_none() => path.push(next),
                    _ => {
                        path.pop();
                        at_work[index] = false;
                        if depths[index].is_none() {
                            depths[index] = Some(self.node_depth(node, &depths));
                        }
                    }
                }
            }
        }
        depths.into_iter().map(|depth| depth.unwrap_or(Depth::Unknown)).collect()
    }

    /// The depth of one function from the depths of its callees; a callee without a depth is still being analysed.
    fn node_depth(&self, node: &Node, depths: &[Option<Depth>]) -> Depth {
        let Some(frame) = node.frame else { return Depth::Unknown };
        let mut deepest = (0, DeepestCallee::Nothing);
        let known = FIRMWARE_FUNCTIONS.iter().filter_map(|row| Some((row.name, row.attributes.stack?)));
        for (name, bytes) in known.filter(|(name, _)| self.is_real && node.firmware.contains(*name)) {
            if bytes > deepest.0 {
                deepest = (bytes, DeepestCallee::Firmware(name, bytes));
            }
        }
        for callee in callees(node) {
            let Some(Some(Depth::Bytes(bytes, _))) = depths.get(callee) else { return Depth::Unknown };
            if matches!(deepest.1, DeepestCallee::Nothing) || *bytes > deepest.0 {
                deepest = (*bytes, DeepestCallee::Function(callee));
            }
        }
        Depth::Bytes(frame.saturating_add(deepest.0), deepest.1)
    }
}

/// The functions that one can call, by number.
fn callees(node: &Node) -> impl Iterator<Item = usize> {
    node.calls.union(&node.through_pointers).copied()
}

/// The names along the deepest path, `main (16) → read (120)`.
fn deepest_path(calls: &Calls, depths: &[Depth], start: usize) -> String {
    let mut names = Vec::new();
    let mut next = DeepestCallee::Function(start);
    loop {
        match next {
            DeepestCallee::Nothing => break,
            DeepestCallee::Firmware(name, bytes) => {
                names.push(format!("{name} (up to {bytes})"));
                break;
            }
            DeepestCallee::Function(index) => {
                let Some(node) = calls.nodes.get(index) else { break };
                names.push(format!("{} ({})", node.name, node.frame.unwrap_or_default()));
                next = match depths.get(index) {
                    Some(Depth::Bytes(_, next)) => *next,
                    _ => DeepestCallee::Nothing,
                };
            }
        }
    }
    names.join(" → ")
}

/// The reason why the depth of a function is unknown: the first call cycle that it reaches, or a frame of unknown size.
fn reason(calls: &Calls, start: usize) -> String {
    let mut path =
        vec![(start, calls.nodes.get(start).map(|node| callees(node).collect()).unwrap_or_default())];
    let mut seen = vec![false; calls.nodes.len()];
    while let Some((index, open)) = path.last_mut() {
        let open: &mut Vec<usize> = open;
        let Some(node) = calls.nodes.get(*index) else { break };
        if node.frame.is_none() {
            return format!("`{}` moves the stack pointer by an amount that is not constant", node.name);
        }
        let Some(next) = open.pop() else {
            path.pop();
            continue;
        };
        if let Some(from) = path.iter().position(|(index, _)| *index == next) {
            let circle = path[from..].iter().map(|(index, _)| *index).chain([next]);
            let names = circle.filter_map(|index| Some(format!("`{}`", calls.nodes.get(index)?.name)));
            return format!("{} is recursive", names.collect::<Vec<_>>().join(" → "));
        }
        if !std::mem::replace(&mut seen[next], true) {
            path.push((next, calls.nodes.get(next).map(|node| callees(node).collect()).unwrap_or_default()));
        }
    }
    "the program is recursive".to_owned()
}
