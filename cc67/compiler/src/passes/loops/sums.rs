//! Strength reduction: expressions that grow evenly with a counter become sums carried from iteration to iteration.

use std::collections::BTreeMap;

use cranelift_entity::EntitySet;

use super::{LoopRange, Worker};
use crate::ir::inst::{Class, Inst, InstKind, Operand, ValueId};
use crate::ir::operators::BinaryOp;

/// The most sums that one loop carries.
const MAX_SUMS: usize = 6;

/// The cost of an expression, in additions, from which a sum is cheaper.
const WORTH: u32 = 2;

/// An expression that grows by the same amount in each iteration.
#[derive(Clone, Copy, Debug)]
struct LinearExpression {
    /// The counter it follows.
    counter: ValueId,
    /// By how much it grows when the counter grows by 1.
    scale: i32,
    /// The cost of computing it, in additions.
    cost: u32,
    /// Its instruction.
    kind: InstKind,
}

impl Worker<'_> {
    /// Replaces expressions that grow evenly by sums.
    pub(super) fn carry_sums(&mut self, range: LoopRange) {
        let counters = self.counters(range);
        if counters.is_empty() {
            return;
        }
        let linear = self.linear_values(range, &counters);
        if linear.values().all(|sum| sum.cost < WORTH) {
            return;
        }
        let wanted = self.read_as_such(&linear);
        let header = self.function.layout[range.first];
        let mut steps: BTreeMap<ValueId, Vec<(ValueId, i32)>> = BTreeMap::new();
        let mut insts = std::mem::take(&mut self.function.blocks[header].insts);
        let mut count = 0;
        for inst in &mut insts {
            let Some(dst) = inst.kind.dst() else { continue };
            let Some(sum) = linear.get(&dst).filter(|sum| sum.cost >= WORTH && wanted.contains(dst)) else {
                continue;
            };
            if count == MAX_SUMS {
                break;
            }
            count += 1;
            let start = self.start(&linear, Operand::Value(dst), inst);
            let carried = self.function.values.push(Class::I32);
            self.push_before(Inst { kind: InstKind::Copy { dst: carried, src: start }, origin: inst.origin });
            let step = counters[&sum.counter].wrapping_mul(sum.scale);
            steps.entry(sum.counter).or_default().push((carried, step));
            inst.kind = InstKind::Copy { dst, src: carried.into() };
        }
        self.function.blocks[header].insts = insts;
        if count > 0 {
            self.insert_steps(range, &steps);
        }
    }

    /// The values that are written once in the loop, by adding a constant.
    fn counters(&self, range: LoopRange) -> BTreeMap<ValueId, i32> {
        let blocks = &self.function.layout[range.first..=range.last];
        (blocks.iter().flat_map(|id| &self.function.blocks[*id].insts))
            .filter_map(|inst| {
                let InstKind::Binary { op, dst, a: Operand::Value(a), b } = inst.kind else { return None };
                let step = match op {
                    BinaryOp::Add => b.as_int()?,
                    BinaryOp::Subtract => b.as_int()?.wrapping_neg(),
                    BinaryOp::Multiply
                    | BinaryOp::Divide
                    | BinaryOp::DivideUnsigned
                    | BinaryOp::Remainder
                    | BinaryOp::RemainderUnsigned
                    | BinaryOp::And
                    | BinaryOp::Or
                    | BinaryOp::Xor
                    | BinaryOp::ShiftLeft
                    | BinaryOp::ShiftRight
                    | BinaryOp::ShiftRightUnsigned => return None,
                };
                (a == dst && self.writes_inside[dst] == 1).then_some((dst, step))
            })
            .collect()
    }

    /// The values, each written once, that are linear in a counter.
    fn linear_values(
        &self,
        range: LoopRange,
        counters: &BTreeMap<ValueId, i32>,
    ) -> BTreeMap<ValueId, LinearExpression> {
        let mut linear: BTreeMap<ValueId, LinearExpression> = BTreeMap::new();
        for id in &self.function.layout[range.first..=range.last] {
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
                let (grows, other) = match (known(a), known(b)) {
                    (Some(grows), None) => (grows, b),
                    (None, Some(grows)) if op == BinaryOp::Add => (grows, a),
                    (None | Some(_), None | Some(_)) => continue,
                };
                if let Some((counter, scale, cost)) = self.combined(op, grows, other) {
                    linear.insert(dst, LinearExpression { counter, scale, cost, kind: inst.kind });
                }
            }
        }
        linear
    }

    /// A linear value, given by its counter, scale and cost, combined with another operand.
    fn combined(
        &self,
        op: BinaryOp,
        (counter, scale, cost): (ValueId, i32, u32),
        other: Operand,
    ) -> Option<(ValueId, i32, u32)> {
        match op {
            BinaryOp::Multiply => {
                other.as_int().map(|factor| (counter, scale.wrapping_mul(factor), cost + 2))
            }
            BinaryOp::ShiftLeft => {
                let count = other.as_int().filter(|count| (0..32).contains(count));
                count.map(|count| (counter, scale.wrapping_shl(count.cast_unsigned()), cost + 1))
            }
            BinaryOp::Add | BinaryOp::Subtract => {
                self.is_invariant(other).then_some((counter, scale, cost + 1))
            }
            BinaryOp::Divide
            | BinaryOp::DivideUnsigned
            | BinaryOp::Remainder
            | BinaryOp::RemainderUnsigned
            | BinaryOp::And
            | BinaryOp::Or
            | BinaryOp::Xor
            | BinaryOp::ShiftRight
            | BinaryOp::ShiftRightUnsigned => None,
        }
    }

    /// The linear values that are read by anything except another linear value.
    fn read_as_such(&self, linear: &BTreeMap<ValueId, LinearExpression>) -> EntitySet<ValueId> {
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

    /// The value of `operand` at the start of the loop, computed before it.
    fn start(
        &mut self,
        linear: &BTreeMap<ValueId, LinearExpression>,
        operand: Operand,
        inst: &Inst,
    ) -> Operand {
        let Some(sum) = operand.as_value().and_then(|value| linear.get(&value)).copied() else {
            return operand;
        };
        let InstKind::Binary { op, a, b, .. } = sum.kind else { return operand };
        let (a, b) = (self.start(linear, a, inst), self.start(linear, b, inst));
        let dst = self.function.values.push(Class::I32);
        self.push_before(Inst { kind: InstKind::Binary { op, dst, a, b }, origin: inst.origin });
        dst.into()
    }

    /// Lets each sum grow where its counter does.
    fn insert_steps(&mut self, range: LoopRange, steps: &BTreeMap<ValueId, Vec<(ValueId, i32)>>) {
        for place in range.first..=range.last {
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
                    self.writes[*sum] += 1;
                    out.push(Inst { kind, origin: inst.origin });
                }
            }
            self.function.blocks[id].insts = out;
        }
    }
}
