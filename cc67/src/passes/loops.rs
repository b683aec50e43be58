//! Takes work out of loops: what does not change is computed in front of them, and an expression
//! that grows evenly with a counter is a sum carried from turn to turn.
//!
//! A loop is a stretch of the layout from the target of a jump backwards to the jump; it counts
//! only if its first block is its only entrance. Only values are moved, never a load or what may
//! trap. All arithmetic is modulo 2³², so a sum carried along is exact however far it goes.
//!
//! Small loops come first, so what leaves an inner loop can leave the outer one as well.

use std::collections::BTreeMap;

use cranelift_entity::{EntitySet, SecondaryMap};

use crate::ir::function::{Block, Function};
use crate::ir::inst::{BlockId, Class, Inst, InstKind, Operand, Terminator, ValueId};
use crate::ir::operators::BinaryOp;

/// The largest function that is worked on, in instructions and blocks, and the most loops of one.
const LARGEST: usize = 4000;
const MAX_LOOPS: usize = 64;

/// The most sums that one loop carries.
const MAX_SUMS: usize = 6;

/// Works on every loop; returns whether anything changed.
pub fn run(function: &mut Function) -> bool {
    let size: usize = function.layout.iter().map(|id| function.blocks[*id].insts.len() + 1).sum();
    let mut is_changed = false;
    if size > LARGEST {
        return is_changed;
    }
    let mut done = EntitySet::new();
    for _ in 0..MAX_LOOPS {
        let Some(stretch) = smallest_loop(function, &done) else { break };
        done.insert(stretch.header(function));
        if stretch.has_one_entrance(function) {
            is_changed |= Loop::new(function, stretch).improve();
        }
    }
    is_changed
}

/// A stretch of the layout.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    first: usize,
    last: usize,
}

impl Stretch {
    fn header(self, function: &Function) -> BlockId {
        function.layout[self.first]
    }

    fn blocks(self, function: &Function) -> &[BlockId] {
        &function.layout[self.first..=self.last]
    }

    fn has_one_entrance(self, function: &Function) -> bool {
        let header = self.header(function);
        let mut inside: EntitySet<BlockId> = EntitySet::with_capacity(function.blocks.len());
        self.blocks(function).iter().for_each(|id| {
            inside.insert(*id);
        });
        (function.layout.iter().filter(|id| !inside.contains(**id)))
            .flat_map(|id| function.blocks[*id].terminator.targets())
            .all(|target| target == header || !inside.contains(target))
    }
}

/// The smallest loop whose first block is not in `done`.
fn smallest_loop(function: &Function, done: &EntitySet<BlockId>) -> Option<Stretch> {
    let mut places: SecondaryMap<BlockId, u32> = SecondaryMap::with_capacity(function.blocks.len());
    for (place, id) in (0..).zip(&function.layout) {
        places[*id] = place;
    }
    let mut ends: BTreeMap<usize, usize> = BTreeMap::new();
    for (last, id) in function.layout.iter().enumerate() {
        for target in function.blocks[*id].terminator.targets() {
            let first = places[target] as usize;
            if first <= last && !done.contains(target) {
                ends.insert(first, last);
            }
        }
    }
    let loops = ends.into_iter().map(|(first, last)| Stretch { first, last });
    loops.min_by_key(|stretch| stretch.last - stretch.first)
}

/// An expression that grows by the same amount in each turn.
#[derive(Clone, Copy, Debug)]
struct Linear {
    /// The counter it follows.
    counter: ValueId,
    /// By how much it grows when the counter grows by 1.
    scale: i32,
    /// What computing it takes.
    cost: u32,
    /// Its instruction.
    kind: InstKind,
}

struct Loop<'a> {
    function: &'a mut Function,
    stretch: Stretch,
    /// How often each value is written in the function, and in the loop.
    writes: SecondaryMap<ValueId, u32>,
    writes_inside: SecondaryMap<ValueId, u32>,
    /// What goes in front of the loop.
    before: Vec<Inst>,
}

impl<'a> Loop<'a> {
    fn new(function: &'a mut Function, stretch: Stretch) -> Self {
        let mut writes: SecondaryMap<ValueId, u32> = SecondaryMap::with_capacity(function.values.len());
        let mut writes_inside = writes.clone();
        for param in &function.params {
            writes[*param] += 1;
        }
        for (place, id) in function.layout.iter().enumerate() {
            for dst in function.blocks[*id].insts.iter().filter_map(|inst| inst.kind.dst()) {
                writes[dst] += 1;
                writes_inside[dst] += u32::from((stretch.first..=stretch.last).contains(&place));
            }
        }
        Self { function, stretch, writes, writes_inside, before: Vec::new() }
    }

    /// Returns whether there was anything to improve.
    fn improve(mut self) -> bool {
        self.hoist();
        self.carry_sums();
        let is_changed = !self.before.is_empty();
        if is_changed {
            self.insert_before();
        }
        is_changed
    }

    /// Takes out what does not change.
    fn hoist(&mut self) {
        for place in self.stretch.first..=self.stretch.last {
            let id = self.function.layout[place];
            let insts = std::mem::take(&mut self.function.blocks[id].insts);
            let mut kept = Vec::with_capacity(insts.len());
            for inst in insts {
                match inst.kind.dst().filter(|dst| self.is_fixed(&inst.kind, *dst)) {
                    Some(dst) => {
                        self.writes_inside[dst] = 0;
                        self.before.push(inst);
                    }
                    None => kept.push(inst),
                }
            }
            self.function.blocks[id].insts = kept;
        }
    }

    /// Whether the instruction, the only one that writes `dst`, does the same in each turn.
    fn is_fixed(&self, kind: &InstKind, dst: ValueId) -> bool {
        let is_constant = matches!(kind, InstKind::Copy { src: Operand::Constant(_), .. });
        let mut is_fixed =
            self.writes[dst] == 1 && !is_constant && !kind.has_effect(self.function.values[dst]);
        let mut kind = *kind;
        kind.visit_operands(|operand| is_fixed &= self.is_invariant(*operand));
        is_fixed
    }

    fn is_invariant(&self, operand: Operand) -> bool {
        operand.as_value().is_none_or(|value| self.writes_inside[value] == 0)
    }

    /// Replaces expressions that grow evenly by sums.
    fn carry_sums(&mut self) {
        let counters = self.counters();
        if counters.is_empty() {
            return;
        }
        let linear = self.linear_values(&counters);
        let wanted = self.read_as_such(&linear);
        let header = self.stretch.header(self.function);
        let mut steps: BTreeMap<ValueId, Vec<(ValueId, i32)>> = BTreeMap::new();
        let mut insts = std::mem::take(&mut self.function.blocks[header].insts);
        let mut count = 0;
        for inst in &mut insts {
            let Some(dst) = inst.kind.dst() else { continue };
            let Some(sum) = linear.get(&dst).filter(|sum| sum.cost >= 2 && wanted.contains(dst)) else {
                continue;
            };
            if count == MAX_SUMS {
                break;
            }
            count += 1;
            let start = self.start(&linear, Operand::Value(dst), inst);
            let carried = self.function.values.push(Class::I32);
            self.before.push(Inst { kind: InstKind::Copy { dst: carried, src: start }, span: inst.span });
            let step = counters[&sum.counter].wrapping_mul(sum.scale);
            steps.entry(sum.counter).or_default().push((carried, step));
            inst.kind = InstKind::Copy { dst, src: carried.into() };
        }
        self.function.blocks[header].insts = insts;
        if count > 0 {
            self.insert_steps(&steps);
        }
    }

    /// The values that are written once in the loop, by adding a constant to them.
    fn counters(&self) -> BTreeMap<ValueId, i32> {
        let insts = self.stretch.blocks(self.function).iter().flat_map(|id| &self.function.blocks[*id].insts);
        insts
            .filter_map(|inst| match inst.kind {
                InstKind::Binary { op, dst, a: Operand::Value(a), b }
                    if a == dst && self.writes_inside[dst] == 1 =>
                {
                    match op {
                        BinaryOp::Add => Some((dst, b.as_int()?)),
                        BinaryOp::Subtract => Some((dst, b.as_int()?.wrapping_neg())),
                        _ => None,
                    }
                }
                _ => None,
            })
            .collect()
    }

    /// The values, each written once, that grow evenly with a counter.
    fn linear_values(&self, counters: &BTreeMap<ValueId, i32>) -> BTreeMap<ValueId, Linear> {
        let mut linear: BTreeMap<ValueId, Linear> = BTreeMap::new();
        for id in self.stretch.blocks(self.function) {
            for inst in &self.function.blocks[*id].insts {
                let InstKind::Binary { op, dst, a, b } = inst.kind else { continue };
                if self.writes[dst] != 1 || self.function.values[dst] != Class::I32 {
                    continue;
                }
                let known = |operand: Operand| {
                    let value = operand.as_value()?;
                    let counter = counters.contains_key(&value).then_some((value, 1, 0));
                    counter.or_else(|| linear.get(&value).map(|sum| (sum.counter, sum.scale, sum.cost)))
                };
                let found = match (op, known(a), known(b)) {
                    (BinaryOp::Multiply, Some((counter, scale, cost)), None) => {
                        b.as_int().map(|factor| (counter, scale.wrapping_mul(factor), cost + 2))
                    }
                    (BinaryOp::ShiftLeft, Some((counter, scale, cost)), None) => {
                        let count = b.as_int().filter(|count| (0..32).contains(count));
                        count.map(|count| (counter, scale.wrapping_shl(count.cast_unsigned()), cost + 1))
                    }
                    (BinaryOp::Add | BinaryOp::Subtract, Some((counter, scale, cost)), None)
                        if self.is_invariant(b) =>
                    {
                        Some((counter, scale, cost + 1))
                    }
                    (BinaryOp::Add, None, Some((counter, scale, cost))) if self.is_invariant(a) => {
                        Some((counter, scale, cost + 1))
                    }
                    _ => None,
                };
                if let Some((counter, scale, cost)) = found {
                    linear.insert(dst, Linear { counter, scale, cost, kind: inst.kind });
                }
            }
        }
        linear
    }

    /// The linear values that something else than another linear value reads.
    fn read_as_such(&self, linear: &BTreeMap<ValueId, Linear>) -> EntitySet<ValueId> {
        let mut read = EntitySet::with_capacity(self.function.values.len());
        let mut note = |operand: Operand| {
            if let Some(value) = operand.as_value() {
                read.insert(value);
            }
        };
        for id in &self.function.layout {
            let block = &self.function.blocks[*id];
            for inst in &block.insts {
                if inst.kind.dst().is_some_and(|dst| linear.contains_key(&dst)) {
                    continue;
                }
                let mut kind = inst.kind;
                kind.visit_operands(|operand| note(*operand));
                if let Some(arguments) = kind.arguments() {
                    self.function.arguments[arguments.range()].iter().for_each(|operand| note(*operand));
                }
            }
            block.terminator.operand().into_iter().for_each(&mut note);
        }
        read
    }

    /// What `operand` is when the loop begins, computed in front of it.
    fn start(&mut self, linear: &BTreeMap<ValueId, Linear>, operand: Operand, inst: &Inst) -> Operand {
        let Some(sum) = operand.as_value().and_then(|value| linear.get(&value)).copied() else {
            return operand;
        };
        let InstKind::Binary { op, a, b, .. } = sum.kind else { return operand };
        let (a, b) = (self.start(linear, a, inst), self.start(linear, b, inst));
        let dst = self.function.values.push(Class::I32);
        self.before.push(Inst { kind: InstKind::Binary { op, dst, a, b }, span: inst.span });
        dst.into()
    }

    /// Lets each sum grow where its counter does.
    fn insert_steps(&mut self, steps: &BTreeMap<ValueId, Vec<(ValueId, i32)>>) {
        for place in self.stretch.first..=self.stretch.last {
            let id = self.function.layout[place];
            let insts = std::mem::take(&mut self.function.blocks[id].insts);
            let mut out = Vec::with_capacity(insts.len() + steps.len());
            for inst in insts {
                out.push(inst);
                let sums = inst.kind.dst().and_then(|dst| steps.get(&dst));
                for (sum, step) in sums.into_iter().flatten() {
                    let kind = InstKind::Binary {
                        op: BinaryOp::Add,
                        dst: *sum,
                        a: (*sum).into(),
                        b: Operand::int(*step),
                    };
                    out.push(Inst { kind, span: inst.span });
                }
            }
            self.function.blocks[id].insts = out;
        }
    }

    /// Puts a block with what was taken out in front of the loop.
    fn insert_before(self) {
        let Self { function, stretch, before, .. } = self;
        let header = stretch.header(function);
        let span = function.blocks[header].span;
        let block = function.blocks.push(Block { insts: before, terminator: Terminator::Jump(header), span });
        for (place, id) in function.layout.iter().enumerate() {
            if !(stretch.first..=stretch.last).contains(&place) {
                function.blocks[*id].terminator.visit_targets(|target| {
                    if *target == header {
                        *target = block;
                    }
                });
            }
        }
        function.layout.insert(stretch.first, block);
    }
}
