//! Several iterations of a loop at once: the budget is tested at their start, addresses at their first use.
//!
//! [`unroll`](super::unroll) selects the loops and collects the facts that hold in them. Here their words are translated
//! once for each iteration, by the same methods as elsewhere; the few methods that differ test `unroll.fast`.
//! After the fast iterations comes the ordinary loop, for the cases that they cannot handle and for the last iterations
//! of a slice.

use std::collections::BTreeMap;
use std::mem::{offset_of, take};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};
use kmotiondef::map::SDRAM;

use super::super::state::{State, Window};
use super::Translator;
use super::accesses::Root;
use super::strides::Stride;
use super::unroll::{Group, IterationWord, Plan};
use crate::kind::Width;
use crate::operand::RegI32;

/// The state of translating fast iterations.
pub(super) struct FastIterations {
    plan: Plan,
    iteration: usize,
    /// Cycles that have been charged but not yet subtracted from the budget.
    spent: u32,
    /// The roots that have been checked, with the address in the host of the first byte of their group.
    checked: BTreeMap<Root, Value>,
    /// The checked pointers on every path to a block that has been translated.
    arriving: BTreeMap<IterationWord, BTreeMap<Root, Value>>,
    blocks: BTreeMap<IterationWord, Block>,
    /// The words at which the ordinary loop takes over.
    bails: BTreeMap<usize, Block>,
}

/// An edge between two blocks on which the budget is made exact.
pub(super) struct BudgetEdge {
    block: Block,
    to: Block,
    cycles: u32,
    is_rare: bool,
}

impl Translator<'_, '_> {
    /// Translates a loop or a straight segment; its first block has been entered.
    pub(super) fn fast_iterations(&mut self, plan: Plan) {
        let (words, order, iterations) = (plan.words.clone(), plan.order.clone(), plan.iterations);
        let entry = plan.entry();
        let (fast, ordinary) = (self.builder.create_block(), self.builder.create_block());
        let is_tested = plan.cost > 0;
        if !is_tested {
            self.builder.ins().jump(fast, &[]);
        } else {
            let budget = self.builder.use_var(self.registers.budget);
            let covered =
                self.builder.ins().icmp_imm_s(IntCC::SignedGreaterThanOrEqual, budget, i64::from(plan.cost));
            self.builder.ins().brif(covered, fast, &[], ordinary, &[]);
        }
        self.reachable = false;
        self.unroll.fast = Some(self.fast_blocks(plan, fast));
        for iteration in 0..iterations.max(1) {
            for at in &order {
                self.fast_word(iteration, *at);
            }
        }
        if iterations > 0 && self.reachable {
            self.go_to(entry);
        }
        if self.reachable {
            self.settle_budget();
        }
        let bails = self.unroll.fast.take().map(|fast| fast.bails).unwrap_or_default();
        let behind = self.reachable.then(|| self.builder.create_block());
        if let Some(behind) = behind {
            self.builder.ins().jump(behind, &[]);
            self.reachable = false;
        }
        self.unroll.is_rare = true;
        for at in words {
            if at == entry && is_tested {
                if self.reachable {
                    self.go_to(entry);
                }
                self.builder.set_cold_block(ordinary);
                self.begin(ordinary);
            }
            let block = self.blocks.get(&at).filter(|_| at != entry);
            for block in block.into_iter().chain(bails.get(&at)).copied().collect::<Vec<_>>() {
                self.builder.set_cold_block(block);
                self.begin(block);
            }
            self.word(at);
        }
        self.unroll.is_rare = false;
        if let Some(behind) = behind {
            self.begin(behind);
        }
    }

    fn fast_blocks(&mut self, plan: Plan, first: Block) -> FastIterations {
        let mut blocks: BTreeMap<IterationWord, Block> =
            plan.entries.keys().map(|place| (*place, self.builder.create_block())).collect();
        blocks.insert((0, plan.entry()), first);
        FastIterations {
            plan,
            iteration: 0,
            spent: 0,
            checked: BTreeMap::new(),
            arriving: BTreeMap::new(),
            blocks,
            bails: BTreeMap::new(),
        }
    }

    /// Translates one word of one iteration.
    fn fast_word(&mut self, iteration: usize, at: usize) {
        let Some(fast) = &mut self.unroll.fast else { return };
        if let Some(block) = fast.blocks.get(&(iteration, at)).copied() {
            if self.reachable {
                self.go_to(at);
            }
            self.begin(block);
            if let Some(fast) = &mut self.unroll.fast {
                fast.spent = fast.plan.entries.get(&(iteration, at)).copied().unwrap_or(0);
                fast.checked = fast.arriving.remove(&(iteration, at)).unwrap_or_default();
                fast.iteration = iteration;
            }
        }
        self.word(at);
    }

    /// Defers a charge to the end of the fast iterations; `false` outside them, where it must be subtracted at once.
    pub(super) fn defer(&mut self, cycles: u32) -> bool {
        self.unroll.fast.as_mut().map(|fast| fast.spent += cycles).is_some()
    }

    /// Makes the budget exact at an exit of the fast iterations.
    pub(super) fn settle_budget(&mut self) {
        if let Some(fast) = &mut self.unroll.fast {
            let cycles = take(&mut fast.spent);
            self.spend(cycles);
        }
    }

    /// Goes to the word `to`.
    pub(super) fn go_to(&mut self, to: usize) {
        let block = self.edge(to);
        self.builder.ins().jump(block, &[]);
        self.finish_edges();
        self.reachable = false;
    }

    /// The block to branch to in order to get to the word `to`; [`finish_edges`](Self::finish_edges) must follow.
    pub(super) fn edge(&mut self, to: usize) -> Block {
        let Some(fast) = &mut self.unroll.fast else { return self.block_of(to) };
        let (block, kept, is_rare) = match fast.plan.target(fast.iteration, to) {
            Some(place) => {
                let checked = &fast.checked;
                let same = |root: &Root, value: &mut Value| checked.get(root) == Some(value);
                let met = fast.arriving.entry(place).or_insert_with(|| checked.clone());
                met.retain(same);
                (fast.blocks[&place], fast.plan.entries[&place], false)
            }
            None => (self.blocks[&to], 0, fast.plan.is_counted && to != fast.plan.entry()),
        };
        let cycles = fast.spent - kept;
        self.budget_edge(block, cycles, is_rare)
    }

    /// The block to branch to if the ordinary loop must execute the instruction; `None` outside fast iterations.
    ///
    /// [`finish_edges`](Self::finish_edges) must follow.
    pub(super) fn bail(&mut self) -> Option<Block> {
        let fast = self.unroll.fast.as_mut()?;
        let cycles = fast.spent;
        let block = *fast.bails.entry(self.at).or_insert_with(|| self.builder.create_block());
        Some(self.budget_edge(block, cycles, true))
    }

    fn budget_edge(&mut self, to: Block, cycles: u32, is_rare: bool) -> Block {
        if cycles == 0 {
            return to;
        }
        let block = self.builder.create_block();
        self.unroll.edges.push(BudgetEdge { block, to, cycles, is_rare });
        block
    }

    /// Translates the edges that the branch just written takes.
    pub(super) fn finish_edges(&mut self) {
        for BudgetEdge { block, to, cycles, is_rare } in take(&mut self.unroll.edges) {
            if is_rare {
                self.builder.set_cold_block(block);
            }
            self.enter(block);
            self.spend(cycles);
            self.builder.ins().jump(to, &[]);
        }
    }

    /// Leaves the fast iterations if `condition` is not 0.
    pub(super) fn bail_if(&mut self, condition: Value) {
        let Some(bail) = self.bail() else { return };
        let go_on = self.builder.create_block();
        self.builder.ins().brif(condition, bail, &[], go_on, &[]);
        self.finish_edges();
        self.enter(go_on);
    }

    /// The host address of the current access, as a pointer and a distance; `None` outside fast iterations.
    pub(super) fn checked_place(
        &mut self,
        base: RegI32,
        width: Width,
        is_store: bool,
    ) -> Option<(Value, i32)> {
        let fast = self.unroll.fast.as_ref()?;
        let access = *fast.plan.accesses.get(&(fast.iteration, self.at))?;
        let shared = fast.plan.groups.get(&access.root).copied();
        let shared = shared.filter(|group| group.covers(access.at, width, is_store));
        // Reported accesses are made elsewhere: the windows contain only the program's own memory.
        let in_windows = is_store || self.translation.observed.is_some();
        let shared = shared.map(|group| Group { has_store: group.has_store || in_windows, ..group });
        if let (Some(group), Some(pointer)) = (shared, fast.checked.get(&access.root)) {
            return Some((*pointer, access.at - group.first));
        }
        let stride = fast.plan.strides.get(access.root).filter(|_| shared.is_some());
        let before = stride.and_then(|stride| fast.checked.get(&stride.before?).copied());
        let end = access.at + width.bytes().cast_signed();
        let group =
            shared.unwrap_or(Group { first: access.at, end, width: width.bytes(), has_store: in_windows });
        let pointer = if let (Some(before), Some(stride)) = (before, stride) {
            let step = self.step(stride);
            self.builder.ins().iadd(before, step)
        } else {
            let base = self.get(base);
            let distance = (group.first - access.base).wrapping_sub(SDRAM.base.get().cast_signed());
            let place = self.builder.ins().iadd_imm_s(base, i64::from(distance));
            self.check(place, group, stride.filter(|stride| stride.later > 0));
            let place = self.builder.ins().uextend(types::I64, place);
            let sdram = self.load_pointer(offset_of!(State, ram.sdram));
            self.builder.ins().iadd(sdram, place)
        };
        if let (Some(_), Some(fast)) = (shared, &mut self.unroll.fast) {
            fast.checked.insert(access.root, pointer);
        }
        Some((pointer, access.at - group.first))
    }

    /// The distance of an access's address from one iteration to the next, as 64 bits; never negative.
    fn step(&mut self, stride: Stride) -> Value {
        let step = self.get(stride.step);
        self.builder.ins().uextend(types::I64, step)
    }

    /// Leaves the fast iterations unless all accesses of the group, whose first byte is at offset `place` in SDRAM, are
    /// allowed, including those of later iterations of a stride.
    fn check(&mut self, place: Value, group: Group, stride: Option<Stride>) {
        let span = (group.end - group.first).cast_unsigned();
        let Some(stride) = stride else { return self.check_group(place, group, span) };
        if group.width > 1 {
            let step = self.get(stride.step);
            let both = self.builder.ins().bor(place, step);
            let bits = self.builder.ins().band_imm_u(both, i64::from(group.width - 1));
            self.bail_if(bits);
        }
        let step = self.step(stride);
        let later = self.builder.ins().imul_imm_u(step, i64::from(stride.later));
        let span = self.builder.ins().iadd_imm_u(later, i64::from(span));
        if group.has_store {
            return self.check_window(place, span);
        }
        let place = self.builder.ins().uextend(types::I64, place);
        let end = self.builder.ins().iadd(place, span);
        let outside = self.builder.ins().icmp_imm_u(IntCC::UnsignedGreaterThan, end, i64::from(SDRAM.size));
        self.bail_if(outside);
    }

    /// Checks a group without a stride, of `span` bytes.
    fn check_group(&mut self, place: Value, group: Group, span: u32) {
        if group.has_store {
            let bits = self.builder.ins().band_imm_u(place, i64::from(group.width - 1));
            if group.width > 1 {
                self.bail_if(bits);
            }
            let span = self.builder.ins().iconst(types::I64, i64::from(span));
            return self.check_window(place, span);
        }
        if span == group.width {
            let never = !(SDRAM.size - 1) | (span - 1);
            let bits = self.builder.ins().band_imm_s(place, i64::from(never.cast_signed()));
            return self.bail_if(bits);
        }
        // A place that is not aligned becomes a large number.
        let shift = group.width.ilog2();
        let units = self.builder.ins().rotr_imm_u(place, i64::from(shift));
        let last = (SDRAM.size - span) >> shift;
        let outside = self.builder.ins().icmp_imm_u(IntCC::UnsignedGreaterThan, units, i64::from(last));
        self.bail_if(outside);
    }

    /// Leaves the fast iterations unless the `span` bytes at `place` are in one of the windows.
    fn check_window(&mut self, place: Value, span: Value) {
        let Some(bail) = self.bail() else { return };
        let (second, inside) = (self.builder.create_block(), self.builder.create_block());
        for (window, otherwise) in [(0, second), (1, bail)] {
            let field = offset_of!(State, ram.windows) + window * size_of::<Window>();
            let start = self.load_state(types::I32, field + offset_of!(Window, start));
            let length = self.load_state(types::I32, field + offset_of!(Window, length));
            let from = self.builder.ins().isub(place, start);
            let from = self.builder.ins().uextend(types::I64, from);
            let end = self.builder.ins().iadd(from, span);
            let length = self.builder.ins().uextend(types::I64, length);
            let outside = self.builder.ins().icmp(IntCC::UnsignedGreaterThan, end, length);
            self.builder.ins().brif(outside, otherwise, &[], inside, &[]);
            if window == 0 {
                self.enter_cold(second);
            }
        }
        self.finish_edges();
        self.enter(inside);
    }
}
