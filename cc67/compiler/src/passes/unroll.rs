//! Unrolling of loops with a known number of iterations, partly or completely.
//!
//! A loop is unrolled if only its last block jumps back, with the comparison of a counter with a constant; the counter
//! is incremented by a constant in that block only, and its initial value is known. Then the trip count is known, and
//! the copies need no test between them. Loads, stores and calls keep their number and order. The values written by an
//! iteration of a single block get new names, so that iterations can overlap on the processor; the last one writes the
//! old names, which the rest of the function reads.

use cranelift_entity::SecondaryMap;

use super::loops::{self, LoopRange};
use crate::ir::function::{Block, Function, table};
use crate::ir::inst::{ArgumentRange, BlockId, Inst, InstKind, Operand, Terminator, ValueId};
use crate::ir::operators::{BinaryOp, CompareOp};

/// The largest trip count that is determined.
const MAX_TRIP_COUNT: u32 = 1 << 16;
/// The most instructions of a fully unrolled loop.
const MAX_FULL_UNROLL_INSTS: u32 = 120;
/// The largest trip count of a fully unrolled loop.
const MAX_FULL_UNROLL_TRIPS: u32 = 32;
/// The most instructions of a partly unrolled loop.
const MAX_PARTIAL_UNROLL_INSTS: u32 = 96;
/// The limit of instructions in a partly unrolled single-block loop, whose iterations overlap anyway.
const MAX_PARTIAL_UNROLL_INSTS_OF_ONE_BLOCK: u32 = 40;
/// The most iterations that become one.
const MAX_UNROLL_FACTOR: u32 = 8;
/// The size limit of functions with unrolled loops, in instructions.
const MAX_FUNCTION_INSTS: usize = 3000;

/// Unrolls loops; returns whether anything changed.
pub fn run(function: &mut Function) -> bool {
    let mut is_changed = false;
    // Every loop is visited once; unrolled loops are not visited again.
    let mut done: Vec<BlockId> = Vec::new();
    loop {
        let size: usize = function.layout.iter().map(|id| function.blocks[*id].insts.len() + 1).sum();
        if size > MAX_FUNCTION_INSTS {
            return is_changed;
        }
        let places = loops::places(function);
        let mut found = loops::find_ranges(function, &places);
        found.sort_by_key(|range| range.last - range.first);
        let next = found.into_iter().find_map(|range| {
            let header = function.layout[range.first];
            let is_new = !done.contains(&header);
            is_new.then(|| (range, header, plan(function, &places, range)))
        });
        let Some((range, header, plan)) = next else { return is_changed };
        done.push(header);
        if let Some(plan) = plan {
            Unroller::new(function, range).run(plan);
            is_changed = true;
            if plan.is_whole {
                // The rest may turn an outer loop into a single block.
                super::jumps::run(function);
                super::fold::run(function);
                super::jumps::run(function);
            }
        }
    }
}

/// The unrolling of a loop.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// The number of iterations before the loop, or of all iterations.
    before: u32,
    /// Iterations of the old loop in one of the new loop.
    copies: u32,
    is_whole: bool,
}

fn plan(function: &Function, places: &SecondaryMap<BlockId, u32>, range: LoopRange) -> Option<Plan> {
    let trips = trip_count(function, places, range)?;
    let blocks = &function.layout[range.first..=range.last];
    let insts = blocks.iter().map(|id| &function.blocks[*id].insts);
    let has_call = insts.clone().flatten().any(|inst| matches!(inst.kind, InstKind::Call { .. }));
    let size: u32 = insts.map(|insts| insts.len() as u32 + 1).sum();
    if trips == 1 || trips <= MAX_FULL_UNROLL_TRIPS && trips * size <= MAX_FULL_UNROLL_INSTS && !has_call {
        return Some(Plan { before: trips, copies: 0, is_whole: true });
    }
    // A call costs more than the jump back.
    if has_call {
        return None;
    }
    let most =
        if blocks.len() == 1 { MAX_PARTIAL_UNROLL_INSTS_OF_ONE_BLOCK } else { MAX_PARTIAL_UNROLL_INSTS };
    let fits = |copies: &u32| (copies + trips % copies) * size <= most && trips >= 2 * copies;
    let copies = (2..=MAX_UNROLL_FACTOR).rev().filter(fits);
    // A divisor of the trip count is better, unless it is much smaller.
    let copies = copies.max_by_key(|copies| if trips % copies == 0 { 2 * copies } else { *copies })?;
    Some(Plan { before: trips % copies, copies, is_whole: false })
}

/// Returns the trip count of a loop, if it is known.
fn trip_count(function: &Function, places: &SecondaryMap<BlockId, u32>, range: LoopRange) -> Option<u32> {
    let (header, latch) = (function.layout[range.first], function.layout[range.last]);
    let preheader = preheader(function, places, range)?;
    let Terminator::Branch { condition: Operand::Value(condition), then, otherwise } =
        function.blocks[latch].terminator
    else {
        return None;
    };
    let goes_on = match (then == header, otherwise == header) {
        (true, false) => true,
        (false, true) => false,
        (true, true) | (false, false) => return None,
    };
    let outside = if goes_on { otherwise } else { then };
    if (range.first as u32..=range.last as u32).contains(&places[outside]) {
        return None;
    }
    let insts = &function.blocks[latch].insts;
    let compare = insts.iter().rposition(|inst| inst.kind.dst() == Some(condition))?;
    let InstKind::Compare { op, a: Operand::Value(counter), b, .. } = insts[compare].kind else {
        return None;
    };
    let limit = b.as_int()?;
    let writes = |id: &BlockId| {
        function.blocks[*id].insts.iter().filter(|inst| inst.kind.dst() == Some(counter)).count()
    };
    let inside = &function.layout[range.first..=range.last];
    if inside.iter().map(writes).sum::<usize>() != 1 || function.params.contains(&counter) {
        return None;
    }
    let step = insts[..compare].iter().find_map(|inst| {
        let InstKind::Binary { op, dst, a: Operand::Value(a), b } = inst.kind else { return None };
        let step = b.as_int().filter(|_| dst == counter && a == counter)?;
        if op == BinaryOp::Add {
            return Some(step);
        }
        (op == BinaryOp::Subtract).then(|| step.wrapping_neg())
    })?;
    let before = &function.blocks[preheader];
    if !matches!(before.terminator, Terminator::Jump(_)) {
        return None;
    }
    let start = before.insts.iter().rev().find(|inst| inst.kind.dst() == Some(counter))?;
    let InstKind::Copy { src, .. } = start.kind else { return None };
    let mut value = src.as_int()?;
    for trips in 1..=MAX_TRIP_COUNT {
        value = value.wrapping_add(step);
        if comparison_holds(op, value, limit) != goes_on {
            return Some(trips);
        }
    }
    None
}

/// The preheader of a loop, if the loop has one, and its last block is the only latch and exit.
fn preheader(function: &Function, places: &SecondaryMap<BlockId, u32>, range: LoopRange) -> Option<BlockId> {
    let (header, latch) = (function.layout[range.first], function.layout[range.last]);
    let is_inside = |id: BlockId| (range.first as u32..=range.last as u32).contains(&places[id]);
    for id in &function.layout[range.first..range.last] {
        let terminator = &function.blocks[*id].terminator;
        let leaves = matches!(terminator, Terminator::Return(_) | Terminator::Unreachable)
            || terminator.targets().any(|target| target == header || !is_inside(target));
        if leaves && *id != latch {
            return None;
        }
    }
    loops::preheader(function, places, range)
}

const fn comparison_holds(op: CompareOp, a: i32, b: i32) -> bool {
    match op {
        CompareOp::Equal => a == b,
        CompareOp::NotEqual => a != b,
        CompareOp::Less => a < b,
        CompareOp::LessEqual => a <= b,
        CompareOp::LessUnsigned => a.cast_unsigned() < b.cast_unsigned(),
        CompareOp::LessEqualUnsigned => a.cast_unsigned() <= b.cast_unsigned(),
    }
}

struct Unroller<'a> {
    function: &'a mut Function,
    range: LoopRange,
    /// The present name of each value that an iteration writes.
    names: SecondaryMap<ValueId, Option<ValueId>>,
    /// The only block that mentions a value, if it writes the value first.
    own: SecondaryMap<ValueId, Option<BlockId>>,
}

impl<'a> Unroller<'a> {
    fn new(function: &'a mut Function, range: LoopRange) -> Self {
        let mut names = SecondaryMap::new();
        names.resize(function.values.len());
        let own = find_sole_blocks(function);
        Self { function, range, names, own }
    }

    fn run(mut self, plan: Plan) {
        let blocks: Vec<BlockId> = self.function.layout[self.range.first..=self.range.last].to_vec();
        let (header, latch) = (blocks[0], blocks[blocks.len() - 1]);
        let outside = self.function.blocks[latch].terminator.targets().find(|target| *target != header);
        let Some(outside) = outside else { return };
        let bodies: Vec<Block> = blocks.iter().map(|id| self.function.blocks[*id].clone()).collect();
        if blocks.len() == 1 {
            self.one_block(plan, blocks[0], outside);
            return;
        }
        // The last iteration is in the old blocks; the others are in new ones in front of them.
        let mut layout = Vec::new();
        let mut iterations: Vec<Vec<BlockId>> = Vec::new();
        let count = if plan.is_whole { plan.before } else { plan.before + plan.copies };
        for _ in 1..count {
            let copies: Vec<BlockId> = bodies
                .iter()
                .map(|body| {
                    let empty =
                        Block { insts: Vec::new(), terminator: Terminator::Unreachable, origin: body.origin };
                    self.function.blocks.push(empty)
                })
                .collect();
            layout.extend(&copies);
            iterations.push(copies);
        }
        iterations.push(blocks.clone());
        let back = iterations[if plan.is_whole { 0 } else { plan.before as usize }][0];
        for (iteration, ids) in iterations.iter().enumerate() {
            let is_last = iteration + 1 == iterations.len();
            for (index, body) in bodies.iter().enumerate() {
                let mut body = body.clone();
                if !is_last {
                    self.rename_own(&mut body, blocks[index]);
                }
                body.terminator.visit_targets(|target| {
                    if let Some(place) = blocks.iter().position(|own| own == target) {
                        *target = ids[place];
                    }
                });
                if index + 1 == bodies.len() {
                    body.terminator = match iterations.get(iteration + 1) {
                        Some(next) => Terminator::Jump(next[0]),
                        None if plan.is_whole => Terminator::Jump(outside),
                        None => back_to(body.terminator, outside, back),
                    };
                }
                self.function.blocks[ids[index]] = body;
            }
        }
        self.redirect_entries(header, iterations[0][0]);
        self.function.layout.splice(self.range.first..self.range.first, layout);
    }

    /// Redirects jumps from outside to the first iteration.
    fn redirect_entries(&mut self, header: BlockId, first: BlockId) {
        let before = &self.function.layout[..self.range.first];
        let after = &self.function.layout[self.range.last + 1..];
        for id in before.iter().chain(after) {
            self.function.blocks[*id].terminator.visit_targets(|target| {
                if *target == header {
                    *target = first;
                }
            });
        }
    }

    /// A loop of one block.
    fn one_block(&mut self, plan: Plan, id: BlockId, outside: BlockId) {
        let body = self.function.blocks[id].clone();
        let iterations = |worker: &mut Self, count: u32| {
            let mut insts = Vec::with_capacity(body.insts.len() * count as usize);
            for iteration in 1..=count {
                worker.iteration(&body.insts, iteration == count, &mut insts);
            }
            insts
        };
        let before = iterations(self, plan.before);
        let origin = body.origin;
        if plan.is_whole {
            self.function.blocks[id] = Block { insts: before, terminator: Terminator::Jump(outside), origin };
            return;
        }
        self.function.blocks[id].insts = iterations(self, plan.copies);
        if plan.before > 0 {
            let block = Block { insts: before, terminator: Terminator::Jump(id), origin };
            let block = self.function.blocks.push(block);
            self.redirect_entries(id, block);
            self.function.layout.insert(self.range.first, block);
        }
    }

    /// Copies an iteration of a single-block loop; the last writes of the last iteration keep their old names.
    fn iteration(&mut self, body: &[Inst], is_last: bool, out: &mut Vec<Inst>) {
        for (index, inst) in body.iter().enumerate() {
            let mut inst = *inst;
            self.rename_reads(&mut inst);
            if let Some(dst) = inst.kind.dst() {
                let is_final = is_last && body[index + 1..].iter().all(|other| other.kind.dst() != Some(dst));
                self.names[dst] = if is_final { None } else { Some(self.name(dst)) };
                if let Some(name) = self.names[dst] {
                    set_dst(&mut inst.kind, name);
                }
            }
            out.push(inst);
        }
    }

    /// A new value like another.
    fn name(&mut self, like: ValueId) -> ValueId {
        let class = self.function.values[like];
        self.function.values.push(class)
    }

    fn renamed_operand(&self, operand: Operand) -> Operand {
        match operand {
            Operand::Value(value) => self.names[value].map_or(operand, Operand::Value),
            Operand::Constant(_) => operand,
        }
    }

    fn rename_reads(&mut self, inst: &mut Inst) {
        inst.kind.visit_operands(|operand| *operand = self.renamed_operand(*operand));
        if let InstKind::Call { arguments, .. } = &mut inst.kind {
            let start = self.function.arguments.len() as u32;
            for index in arguments.range() {
                let argument = self.renamed_operand(self.function.arguments[index]);
                self.function.arguments.push(argument);
            }
            *arguments = ArgumentRange { start, count: arguments.count };
        }
    }

    /// Renames the values that only the block uses.
    fn rename_own(&mut self, body: &mut Block, id: BlockId) {
        for inst in &mut body.insts {
            self.rename_reads(inst);
            let Some(dst) = inst.kind.dst() else { continue };
            if self.own[dst] == Some(id) {
                let name = self.name(dst);
                self.names[dst] = Some(name);
                set_dst(&mut inst.kind, name);
            }
        }
        if let Some(operand) = body.terminator.operand_mut() {
            *operand = self.renamed_operand(*operand);
        }
    }
}

/// The terminator of the last iteration: jumps back to the old header go to the first iteration.
fn back_to(mut terminator: Terminator, outside: BlockId, back: BlockId) -> Terminator {
    terminator.visit_targets(|target| {
        if *target != outside {
            *target = back;
        }
    });
    terminator
}

/// For each value, the only block that mentions it, if the block writes it before it reads it.
fn find_sole_blocks(function: &Function) -> SecondaryMap<ValueId, Option<BlockId>> {
    let mut own: SecondaryMap<ValueId, Option<BlockId>> = table(function.values.len());
    let mut shared: SecondaryMap<ValueId, bool> = table(function.values.len());
    for param in &function.params {
        shared[*param] = true;
    }
    for id in &function.layout {
        let block = &function.blocks[*id];
        let mut read = |operand: Operand, own: &SecondaryMap<ValueId, Option<BlockId>>| {
            if let Operand::Value(value) = operand
                && own[value] != Some(*id)
            {
                shared[value] = true;
            }
        };
        let mut written: Vec<ValueId> = Vec::new();
        for inst in &block.insts {
            let mut kind = inst.kind;
            kind.visit_operands(|operand| read(*operand, &own));
            if let Some(arguments) = kind.arguments() {
                function.arguments[arguments.range()].iter().for_each(|operand| read(*operand, &own));
            }
            if let Some(dst) = kind.dst() {
                written.push(dst);
                if own[dst].is_none() {
                    own[dst] = Some(*id);
                }
            }
        }
        if let Some(operand) = block.terminator.operand() {
            read(operand, &own);
        }
        for dst in written {
            if own[dst] != Some(*id) {
                shared[dst] = true;
            }
        }
    }
    for value in function.values.keys() {
        if shared[value] {
            own[value] = None;
        }
    }
    own
}

/// Makes an instruction write another value.
fn set_dst(kind: &mut InstKind, to: ValueId) {
    match kind {
        InstKind::Copy { dst, .. }
        | InstKind::Unary { dst, .. }
        | InstKind::Binary { dst, .. }
        | InstKind::Compare { dst, .. }
        | InstKind::Convert { dst, .. }
        | InstKind::Load { dst, .. }
        | InstKind::FrameAddress { dst, .. } => *dst = to,
        InstKind::Call { dst, .. } => *dst = Some(to).into(),
        InstKind::Store { .. }
        | InstKind::CopyMemory { .. }
        | InstKind::ClearMemory { .. }
        | InstKind::Cost { .. } => {}
    }
}
