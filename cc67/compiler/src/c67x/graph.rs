//! The dependence graph of a region.
//!
//! An edge gives the minimum number of cycles from the issue of one step to that of another. Registers: a result is
//! read after it has landed, never while it is in flight, because an interrupt would make it land early (`c67x.md`
//! 2.5); results of one register land in order. Memory: accesses that can be observed elsewhere keep their order; loads
//! may share a cycle.

use std::collections::BTreeMap;

use c67x::{Inst, Pred, Reg};

use super::abi;
use super::step::{Access, Step};

/// An edge to a step, with its cycles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) to: u32,
    pub(super) cycles: u8,
    /// The minimum distance in cycles where interrupts are disabled between `from` and `to`: less than `cycles` if the
    /// result of `to` may still be in flight when `from` reads the register.
    pub(super) sheltered: i8,
}

/// The edges of a region; branches are the last nodes.
#[derive(Debug)]
pub(super) struct Graph {
    pub(super) after: Vec<Vec<Edge>>,
    /// Number of edges that lead to each step.
    pub(super) before: Vec<u32>,
    /// The minimum number of cycles from the issue of each step to the end of the region.
    pub(super) height: Vec<u32>,
}

/// Cycles from a step's issue until all its results have landed; at least 1.
pub(super) fn landing_cycles(inst: &Inst) -> u32 {
    inst.writes().map(|write| u32::from(write.stage)).max().unwrap_or(1).max(1)
}

/// Builds the graph of a region.
pub(super) fn build(steps: &[Step], branches: &[Step]) -> Graph {
    let count = steps.len() + branches.len();
    let mut builder = Builder {
        graph: Graph { after: vec![Vec::new(); count], before: vec![0; count], height: vec![0; count] },
        writers: vec![Vec::new(); Reg::COUNT],
        readers: vec![Vec::new(); Reg::COUNT],
        shared_store: None,
        is_joined: false,
        shared_loads: Vec::new(),
        own: BTreeMap::new(),
        versions: [0; Reg::COUNT],
        accesses: Vec::new(),
    };
    for (index, step) in steps.iter().chain(branches).enumerate() {
        let Some(inst) = step.forms.first() else { continue };
        builder.registers(index as u32, inst);
        builder.memory(index as u32, step);
        builder.stack(index as u32, inst);
        for write in inst.writes() {
            builder.versions[write.reg.index()] += 1;
        }
    }
    let mut graph = builder.graph;
    for index in (0..count).rev() {
        let own = match steps.get(index) {
            Some(step) => step.forms.first().map_or(1, landing_cycles),
            None => BRANCH,
        };
        let below = graph.after[index]
            .iter()
            .map(|edge| u32::from(edge.cycles) + graph.height[edge.to as usize])
            .max();
        graph.height[index] = own.max(below.unwrap_or(0));
    }
    graph
}

/// Bytes of a word of the frame.
const WORD: i32 = 4;

/// Cycles from a branch to its target.
pub(super) const BRANCH: u32 = 6;

/// A step that reads a register, and the last stage in which it does.
#[derive(Clone, Copy)]
struct RegisterReader {
    step: u32,
    last: u8,
}

/// A step that writes a register, and the stage.
#[derive(Clone, Copy)]
struct RegisterWriter {
    step: u32,
    stage: u8,
    /// Its condition, and the number of writes of the condition register before it.
    pred: (Pred, u32),
}

/// Reports whether at most one of two steps is executed: they have opposite conditions on the same value.
fn are_exclusive((one, version): (Pred, u32), (other, own): (Pred, u32)) -> bool {
    version == own && one.excludes(other)
}

struct Builder {
    graph: Graph,
    /// Since the last result that replaced all others.
    writers: Vec<Vec<RegisterWriter>>,
    readers: Vec<Vec<RegisterReader>>,
    shared_store: Option<u32>,
    /// True if the last such store may issue in the same cycle as the previous one.
    is_joined: bool,
    shared_loads: Vec<u32>,
    /// The accesses of each word of the frame since the last store of it.
    own: BTreeMap<i32, Vec<(u32, Access)>>,
    /// Number of writes of each register so far.
    versions: [u32; Reg::COUNT],
    /// The accesses so far: the step, the kind of access, and the version of its base.
    accesses: Vec<(u32, Access, u32)>,
}

impl Builder {
    fn add_edge(&mut self, from: u32, to: u32, cycles: u8) {
        self.edge_sheltered(from, to, cycles.cast_signed());
    }

    /// Adds an edge; the number of cycles must be at least 0 only where an interrupt is possible.
    fn edge_sheltered(&mut self, from: u32, to: u32, sheltered: i8) {
        if from == to {
            return;
        }
        let cycles = sheltered.max(0).cast_unsigned();
        let edges = &mut self.graph.after[from as usize];
        // Steps are added in order, so an edge to this step was added last.
        if let Some(known) = edges.last_mut().filter(|edge| edge.to == to) {
            known.cycles = known.cycles.max(cycles);
            known.sheltered = known.sheltered.max(sheltered);
            return;
        }
        edges.push(Edge { to, cycles, sheltered });
        self.graph.before[to as usize] += 1;
    }

    fn registers(&mut self, step: u32, inst: &Inst) {
        let condition = inst.pred().reg();
        let pred = (inst.pred(), condition.map_or(0, |reg| self.versions[reg.index()]));
        let reads = inst.reads().map(|read| (read.reg, read.first, read.last));
        for (reg, first, last) in reads.chain(condition.map(|reg| (reg, 1, 1))) {
            for index in 0..self.writers[reg.index()].len() {
                let RegisterWriter { step: writer, stage, pred: other } = self.writers[reg.index()][index];
                if are_exclusive(other, pred) && Some(reg) != condition {
                    continue;
                }
                self.add_edge(writer, step, (stage + 1).saturating_sub(first).max(1));
            }
            self.readers[reg.index()].push(RegisterReader { step, last });
        }
        for write in inst.writes() {
            let at = write.reg.index();
            for index in 0..self.readers[at].len() {
                let RegisterReader { step: reader, last } = self.readers[at][index];
                self.edge_sheltered(reader, step, last.cast_signed() - write.stage.cast_signed());
            }
            for index in 0..self.writers[at].len() {
                let RegisterWriter { step: writer, stage, pred: other } = self.writers[at][index];
                if stage == write.stage && are_exclusive(other, pred) {
                    continue;
                }
                self.add_edge(writer, step, (stage + 1).saturating_sub(write.stage));
            }
            if condition.is_none() {
                self.writers[at].clear();
                self.readers[at].clear();
            }
            self.writers[at].push(RegisterWriter { step, stage: write.stage, pred });
        }
    }

    /// Adds edges between accesses whose order can be observed.
    fn memory(&mut self, step: u32, what: &Step) {
        let version = match what.access {
            Access::None => return,
            Access::Own { .. } => 0,
            Access::Shared { base, .. } => self.versions[base.index()],
        };
        match what.access {
            Access::None => {}
            Access::Own { is_store, .. } => {
                for word in frame_words(what.access) {
                    self.own_word(step, what.access, word, is_store);
                }
            }
            Access::Shared { is_store, .. } => self.order_shared_access(step, what.access, version, is_store),
        }
        self.accesses.push((step, what.access, version));
    }

    /// Adds edges from the earlier accesses to a word of the frame, and records this one.
    fn own_word(&mut self, step: u32, access: Access, word: i32, is_store: bool) {
        let mut before = self.own.remove(&word).unwrap_or_default();
        for (from, other) in &before {
            let was_store = matches!(other, Access::Own { is_store: true, .. });
            if overlaps(*other, access) && (was_store || is_store) {
                self.add_edge(*from, step, 1);
            }
        }
        // Accesses after a store of the whole word are ordered after all accesses before it.
        let is_whole = matches!(access, Access::Own { at, size, .. }
            if at <= WORD * word && at + size.cast_signed() >= WORD * (word + 1));
        if is_store && is_whole {
            before.clear();
        }
        before.push((step, access));
        self.own.insert(word, before);
    }

    fn order_shared_access(&mut self, step: u32, access: Access, version: u32, is_store: bool) {
        let number = self.accesses.len() as u32;
        if let Some(store) = self.shared_store {
            let (from, other, at) = self.accesses[store as usize];
            // Two stores may share a cycle; a third could meet the first.
            let joins = is_store && !self.is_joined && are_apart((other, at), (access, version));
            self.is_joined = joins;
            self.add_edge(from, step, u8::from(!joins));
        }
        if is_store {
            for load in std::mem::take(&mut self.shared_loads) {
                let (from, other, at) = self.accesses[load as usize];
                self.add_edge(from, step, u8::from(!are_apart((other, at), (access, version))));
            }
            self.shared_store = Some(number);
        } else {
            if let Some(load) = self.shared_loads.last() {
                let from = self.accesses[*load as usize].0;
                self.add_edge(from, step, 0);
            }
            self.shared_loads.push(number);
        }
    }

    /// Adds edges for the stack pointer: the frame belongs to the function only until the pointer is raised.
    fn stack(&mut self, step: u32, inst: &Inst) {
        if inst.writes().any(|write| write.reg == abi::STACK) {
            for index in 0..self.accesses.len() {
                let from = self.accesses[index].0;
                self.add_edge(from, step, 0);
            }
        }
    }
}

/// The words of the frame that an access touches.
fn frame_words(access: Access) -> std::ops::Range<i32> {
    match access {
        Access::Own { at, size, .. } => {
            at.div_euclid(WORD)..(at + size.cast_signed() - 1).div_euclid(WORD) + 1
        }
        Access::None | Access::Shared { .. } => 0..0,
    }
}

/// Reports whether two accesses of the frame touch the same bytes.
fn overlaps(a: Access, b: Access) -> bool {
    match (a, b) {
        (Access::Own { at: a, size: x, .. }, Access::Own { at: b, size: y, .. }) => {
            a < b + y.cast_signed() && b < a + x.cast_signed()
        }
        _ => false,
    }
}

/// Reports whether two accesses, each with the version of its base, certainly touch different bytes.
fn are_apart(a: (Access, u32), b: (Access, u32)) -> bool {
    match (a, b) {
        (
            (Access::Shared { base: a, at: Some(x), size: m, .. }, v),
            (Access::Shared { base: b, at: Some(y), size: n, .. }, w),
        ) => a == b && v == w && (x + m.cast_signed() <= y || y + n.cast_signed() <= x),
        _ => false,
    }
}
