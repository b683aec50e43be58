//! Loop-invariant code motion and strength reduction: invariants are computed before loops, and an expression that
//! grows evenly with a counter becomes a sum carried from iteration to iteration.
//!
//! A loop is the part of the layout from the target of a backward jump to the jump, with its first block as the only
//! entry. Only values are moved, never a load or an instruction that may trap. All arithmetic is modulo 2³², so a
//! carried sum stays exact.
//!
//! Small loops are processed first, so that code moved out of an inner loop can leave the outer one as well.
//!
//! Most functions have no loop, and most loops have nothing to move, so that test must be cheap: counts for the whole
//! function are made once and kept up to date.

use cranelift_entity::SecondaryMap;

use crate::ir::function::{Block, Function, table};
use crate::ir::inst::{BlockId, Inst, InstKind, Operand, Terminator, ValueId};

mod sums;

/// The size limits of a function, in instructions and blocks, and the limit of its loops.
const LARGEST: usize = 4000;
const MAX_LOOPS: usize = 64;

/// Optimises every loop; returns whether anything changed.
pub fn run(function: &mut Function) -> bool {
    let size: usize = function.layout.iter().map(|id| function.blocks[*id].insts.len() + 1).sum();
    if size > LARGEST {
        return false;
    }
    let places = places(function);
    let mut loops = find_ranges(function, &places);
    if loops.is_empty() {
        return false;
    }
    loops.sort_by_key(|range| range.last - range.first);
    loops.truncate(MAX_LOOPS);
    let mut worker = Worker::new(function, places);
    let mut is_changed = false;
    for index in 0..loops.len() {
        let range = loops[index];
        if worker.optimize_loop(range) {
            is_changed = true;
            loops[index..].iter_mut().for_each(|other| other.make_room(range.first));
        }
    }
    is_changed
}

/// The positions of a loop in the layout.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoopRange {
    pub(super) first: usize,
    pub(super) last: usize,
}

impl LoopRange {
    /// Follows the insertion of a block at `place`.
    fn make_room(&mut self, place: usize) {
        self.first += usize::from(self.first >= place);
        self.last += usize::from(self.last >= place);
    }
}

/// The position of each block in the layout.
pub(super) fn places(function: &Function) -> SecondaryMap<BlockId, u32> {
    let mut places = table(function.blocks.len());
    for (place, id) in (0..).zip(&function.layout) {
        places[*id] = place;
    }
    places
}

/// The ranges from each target of a backward jump to the last such jump.
pub(super) fn find_ranges(function: &Function, places: &SecondaryMap<BlockId, u32>) -> Vec<LoopRange> {
    let mut loops: Vec<LoopRange> = Vec::new();
    for (last, id) in function.layout.iter().enumerate() {
        for target in function.blocks[*id].terminator.targets() {
            let first = places[target] as usize;
            if first > last {
                continue;
            }
            match loops.iter_mut().find(|range| range.first == first) {
                Some(range) => range.last = last,
                None => loops.push(LoopRange { first, last }),
            }
        }
    }
    loops
}

/// Returns the preheader of a loop: the only block that leads into it, if it leads to the first block.
pub(super) fn preheader(
    function: &Function,
    places: &SecondaryMap<BlockId, u32>,
    range: LoopRange,
) -> Option<BlockId> {
    let header = function.layout[range.first];
    let is_inside = |id: BlockId| (range.first as u32..=range.last as u32).contains(&places[id]);
    let mut preheader = None;
    for id in function.layout.iter().filter(|id| !is_inside(**id)) {
        for target in function.blocks[*id].terminator.targets().filter(|target| is_inside(*target)) {
            if target != header || preheader.replace(*id).is_some() {
                return None;
            }
        }
    }
    preheader
}

/// The state for a function, and for the current loop.
struct Worker<'a> {
    function: &'a mut Function,
    places: SecondaryMap<BlockId, u32>,
    /// Number of writes of each value in the function.
    writes: SecondaryMap<ValueId, u32>,
    /// And in the loop; zero between two loops.
    writes_inside: SecondaryMap<ValueId, u32>,
    /// The instructions for the preheader.
    before: Vec<Inst>,
}

impl<'a> Worker<'a> {
    fn new(function: &'a mut Function, places: SecondaryMap<BlockId, u32>) -> Self {
        let mut writes: SecondaryMap<ValueId, u32> = table(function.values.len());
        let writes_inside = writes.clone();
        for param in &function.params {
            writes[*param] += 1;
        }
        for id in &function.layout {
            for dst in function.blocks[*id].insts.iter().filter_map(|inst| inst.kind.dst()) {
                writes[dst] += 1;
            }
        }
        Self { function, places, writes, writes_inside, before: Vec::new() }
    }

    /// Works on one loop; returns whether a block was put before it.
    fn optimize_loop(&mut self, range: LoopRange) -> bool {
        if !self.has_one_entry(range) {
            return false;
        }
        self.count_inside(range, |count| *count += 1);
        self.hoist(range);
        self.carry_sums(range);
        self.count_inside(range, |count| *count = 0);
        let is_changed = !self.before.is_empty();
        if is_changed {
            self.insert_before(range);
        }
        is_changed
    }

    fn has_one_entry(&self, range: LoopRange) -> bool {
        let inside = range.first as u32 + 1..=range.last as u32;
        let (before, behind) =
            (&self.function.layout[..range.first], &self.function.layout[range.last + 1..]);
        (before.iter().chain(behind))
            .flat_map(|id| self.function.blocks[*id].terminator.targets())
            .all(|target| !inside.contains(&self.places[target]))
    }

    /// Passes the count of every value that the loop writes to `change`, once for each write.
    fn count_inside(&mut self, range: LoopRange, change: impl Fn(&mut u32)) {
        for id in &self.function.layout[range.first..=range.last] {
            for dst in self.function.blocks[*id].insts.iter().filter_map(|inst| inst.kind.dst()) {
                change(&mut self.writes_inside[dst]);
            }
        }
    }

    /// Hoists loop invariants.
    fn hoist(&mut self, range: LoopRange) {
        for place in range.first..=range.last {
            let id = self.function.layout[place];
            let Function { blocks, values, .. } = &mut *self.function;
            let (writes, writes_inside) = (&self.writes, &mut self.writes_inside);
            let taken = blocks[id].insts.extract_if(.., |inst| {
                let Some(dst) = inst.kind.dst() else { return false };
                let is_fixed = writes[dst] == 1
                    && is_fixed(&inst.kind, writes_inside)
                    && !inst.kind.has_effect(values[dst]);
                if is_fixed {
                    writes_inside[dst] = 0;
                }
                is_fixed
            });
            self.before.extend(taken);
        }
    }

    fn is_invariant(&self, operand: Operand) -> bool {
        is_invariant(operand, &self.writes_inside)
    }

    /// Adds an instruction that runs before the loop and writes `kind`'s value.
    fn push_before(&mut self, inst: Inst) {
        if let Some(dst) = inst.kind.dst() {
            self.writes[dst] += 1;
        }
        self.before.push(inst);
    }

    /// Inserts a block with the hoisted instructions before the loop.
    fn insert_before(&mut self, range: LoopRange) {
        let insts = std::mem::take(&mut self.before);
        let function = &mut *self.function;
        let header = function.layout[range.first];
        let origin = function.blocks[header].origin;
        let block = function.blocks.push(Block { insts, terminator: Terminator::Jump(header), origin });
        for (place, id) in function.layout.iter().enumerate() {
            if !(range.first..=range.last).contains(&place) {
                function.blocks[*id].terminator.visit_targets(|target| {
                    if *target == header {
                        *target = block;
                    }
                });
            }
        }
        function.layout.insert(range.first, block);
        for (place, id) in function.layout.iter().enumerate().skip(range.first) {
            self.places[*id] = place as u32;
        }
    }
}

/// Reports whether an instruction without effect is loop-invariant.
fn is_fixed(kind: &InstKind, writes_inside: &SecondaryMap<ValueId, u32>) -> bool {
    // A constant costs nothing at its place.
    let mut is_fixed = !matches!(kind, InstKind::Copy { src: Operand::Constant(_), .. });
    let mut kind = *kind;
    kind.visit_operands(|operand| is_fixed &= is_invariant(*operand, writes_inside));
    is_fixed
}

fn is_invariant(operand: Operand, writes_inside: &SecondaryMap<ValueId, u32>) -> bool {
    operand.as_value().is_none_or(|value| writes_inside[value] == 0)
}
