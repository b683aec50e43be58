//! Jumps: threads them through empty blocks, drops unreachable blocks, joins a block with its only successor if it is
//! the only predecessor.

use cranelift_entity::packed_option::PackedOption;
use cranelift_entity::{EntitySet, SecondaryMap};

use crate::ir::function::{Function, table};
use crate::ir::inst::{BlockId, Terminator};

/// Simplifies the graph of blocks.
pub fn run(function: &mut Function) {
    thread(function);
    remove_unreachable(function);
    join(function);
}

/// Makes every jump to a block that only jumps on go to the last of such blocks.
fn thread(function: &mut Function) {
    let mut forwards: SecondaryMap<BlockId, PackedOption<BlockId>> = table(function.blocks.len());
    let mut is_any = false;
    for &id in &function.layout {
        let block = &function.blocks[id];
        if let (true, Terminator::Jump(to)) = (block.insts.is_empty(), &block.terminator) {
            forwards[id] = (*to).into();
            is_any = true;
        }
    }
    for &id in &function.layout {
        let terminator = &mut function.blocks[id].terminator;
        if is_any {
            terminator.visit_targets(|target| *target = resolve(&mut forwards, *target));
        }
        if let Terminator::Branch { then, otherwise, .. } = *terminator
            && then == otherwise
        {
            *terminator = Terminator::Jump(then);
        }
        // A jump to a mere return is a return.
        if let Terminator::Jump(to) = function.blocks[id].terminator
            && function.blocks[to].insts.is_empty()
            && let Terminator::Return(value) = function.blocks[to].terminator
        {
            let origin = function.blocks[to].origin;
            let block = &mut function.blocks[id];
            block.terminator = Terminator::Return(value);
            block.origin = origin;
        }
    }
}

/// Follows jumps from block to block; the path is shortened on the way, so that all look-ups together are linear. An
/// endless loop of empty blocks ends at one of its blocks.
fn resolve(forwards: &mut SecondaryMap<BlockId, PackedOption<BlockId>>, start: BlockId) -> BlockId {
    let mut end = start;
    let mut steps = 0;
    while let Some(next) = forwards[end].expand() {
        // Path halving.
        if let Some(after) = forwards[next].expand() {
            forwards[end] = after.into();
        }
        end = next;
        steps += 1;
        if end == start || steps > 64 {
            break;
        }
    }
    end
}

/// Takes blocks out of the layout that no path from the entry reaches.
pub fn remove_unreachable(function: &mut Function) {
    let Some(&entry) = function.layout.first() else { return };
    let mut reached: EntitySet<BlockId> = EntitySet::with_capacity(function.blocks.len());
    let mut pending = vec![entry];
    reached.insert(entry);
    while let Some(id) = pending.pop() {
        for target in function.blocks[id].terminator.targets() {
            if reached.insert(target) {
                pending.push(target);
            }
        }
    }
    function.layout.retain(|id| reached.contains(*id));
}

/// Appends to each block the blocks that only it jumps to.
fn join(function: &mut Function) {
    let predecessors = function.predecessors();
    let Some(&entry) = function.layout.first() else { return };
    // A block that will be appended to another is not a head; only heads are processed, so every instruction is moved
    // once.
    let mut appended: EntitySet<BlockId> = EntitySet::with_capacity(function.blocks.len());
    for &id in &function.layout {
        if let Terminator::Jump(to) = function.blocks[id].terminator
            && predecessors[to] == 1
            && to != entry
        {
            appended.insert(to);
        }
    }
    for index in 0..function.layout.len() {
        let head = function.layout[index];
        if appended.contains(head) {
            continue;
        }
        while let Terminator::Jump(to) = function.blocks[head].terminator {
            if !appended.contains(to) {
                break;
            }
            let mut insts = std::mem::take(&mut function.blocks[to].insts);
            let terminator = std::mem::replace(&mut function.blocks[to].terminator, Terminator::Unreachable);
            let origin = function.blocks[to].origin;
            let block = &mut function.blocks[head];
            block.insts.append(&mut insts);
            block.terminator = terminator;
            block.origin = origin;
        }
    }
    function.layout.retain(|id| !appended.contains(*id));
}
