//! Gives every value a register: a slot of the function's frame in the machine.
//!
//! Linear scan over intervals of instruction positions. An interval reaches from the first to the last mention of a
//! value. This is enough for a value that is mentioned in a single block, and written first. Any other value may be
//! carried around a loop, so its interval is extended over each loop that it overlaps. Every backward jump counts as a
//! loop, and overlapping loops as one, which is correct for any shape of code and needs no data flow.
//!
//! A register has one class for the whole function, as the machine requires, so each class has its own supply. The
//! parameters are the first registers.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use cranelift_entity::SecondaryMap;
use cranelift_entity::packed_option::PackedOption;
use vm::operand::Class as RegisterClass;
use vm::verify::MAX_REGISTERS;

use crate::ir::function::{Function, VariableHome, table};
use crate::ir::inst::{BlockId, Class, Inst, Operand, ValueId};

/// The registers of a function.
#[derive(Debug)]
pub(super) struct Registers {
    numbers: SecondaryMap<ValueId, u16>,
    /// The class of each register.
    pub(super) classes: Vec<RegisterClass>,
    /// The positions from and to which a value has its register to itself; both 0 if it has none.
    spans: SecondaryMap<ValueId, (u32, u32)>,
}

impl Registers {
    /// The register of a value.
    pub(super) fn register_of(&self, value: ValueId) -> u16 {
        self.numbers[value]
    }

    /// The positions of the first and last instruction between which a value has its register to itself. An instruction
    /// has an even position, counted from 2 in steps of 2, and its result the odd position after it.
    pub(super) fn span(&self, value: ValueId) -> Option<(u32, u32)> {
        Some(self.spans[value]).filter(|(_, end)| *end != 0)
    }
}

/// The class of a register that holds a value of class `class`.
pub(super) const fn register_class(class: Class) -> RegisterClass {
    match class {
        Class::I32 => RegisterClass::I32,
        Class::I64 => RegisterClass::I64,
        Class::F32 => RegisterClass::F32,
        Class::F64 => RegisterClass::F64,
    }
}

/// The live interval of a value.
#[derive(Clone, Copy, Debug, Default)]
struct Interval {
    /// Position of the first mention; a read has an even position, a write the odd one after.
    start: u32,
    end: u32,
    /// The block of the first mention.
    block: PackedOption<BlockId>,
    /// True if it is mentioned in several blocks, or read before it is written.
    is_global: bool,
}

/// Gives every value of a legal function a register; values of `prologue` are written before the first block. `None` if
/// there are more than the machine can number.
///
/// If variables are kept, variables of the source have their registers in the whole function.
pub(super) fn assign(function: &Function, prologue: &[Inst], keeps_variables: bool) -> Option<Registers> {
    let mut scan = Scan {
        intervals: table(function.values.len()),
        order: Vec::with_capacity(function.values.len()),
        position: 0,
    };
    let entry = function.layout.first().copied();
    let before = function.params.iter().copied().chain(prologue.iter().filter_map(|inst| inst.kind.dst()));
    for value in before {
        // The first block may be the head of a loop, and these values are not written again in it.
        scan.record_use(value, 0, entry.into(), Mention::Read);
    }
    let kept = || {
        function.source.variables.iter().filter(|_| keeps_variables).filter_map(|variable| {
            match variable.home {
                VariableHome::Value(value, _) | VariableHome::Pointer(value) => Some(value),
                VariableHome::Slot(_) | VariableHome::Constant(_) => None,
            }
        })
    };
    for value in kept() {
        scan.record_use(value, 0, entry.into(), Mention::Read);
    }
    let loops = scan.function(function);
    for value in kept() {
        scan.record_use(value, scan.position, entry.into(), Mention::Read);
    }
    scan.extend(&loops);
    scan.allocate(function)
}

/// A use of a value by an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mention {
    Read,
    Write,
}

/// The state of the scan.
struct Scan {
    intervals: SecondaryMap<ValueId, Interval>,
    /// The values that are mentioned, by first mention.
    order: Vec<ValueId>,
    position: u32,
}

impl Scan {
    fn record_use(&mut self, value: ValueId, position: u32, block: PackedOption<BlockId>, how: Mention) {
        let interval = &mut self.intervals[value];
        if interval.block.is_none() {
            // A value that is read first keeps the 0 that the machine puts into fresh registers.
            let (start, is_global) = if how == Mention::Read { (0, true) } else { (position, false) };
            *interval = Interval { start, end: position, block, is_global };
            self.order.push(value);
        } else {
            interval.end = position;
            interval.is_global |= interval.block != block;
        }
    }

    fn read(&mut self, operand: Operand, block: BlockId) {
        if let Operand::Value(value) = operand {
            self.record_use(value, self.position, block.into(), Mention::Read);
        }
    }

    /// Walks the code; returns the loops, in the order of their ends.
    fn function(&mut self, function: &Function) -> Vec<(u32, u32)> {
        let mut starts: SecondaryMap<BlockId, u32> = table(function.blocks.len());
        let mut loops = Vec::new();
        // Position 0 belongs to the parameters, and no block starts at 0: so 0 means that it was not reached yet.
        self.position = 2;
        for &id in &function.layout {
            let block = &function.blocks[id];
            starts[id] = self.position;
            for inst in &block.insts {
                let mut kind = inst.kind;
                kind.visit_operands(|operand| self.read(*operand, id));
                if let Some(arguments) = inst.kind.arguments() {
                    for argument in &function.arguments[arguments.range()] {
                        self.read(*argument, id);
                    }
                }
                if let Some(dst) = inst.kind.dst() {
                    self.record_use(dst, self.position + 1, id.into(), Mention::Write);
                }
                self.position += 2;
            }
            if let Some(operand) = block.terminator.operand() {
                self.read(operand, id);
            }
            loops.extend(
                (block.terminator.targets())
                    .filter(|to| starts[*to] != 0)
                    .map(|to| (starts[to], self.position + 1)),
            );
            self.position += 2;
        }
        loops
    }

    /// Extends global intervals over the loops they touch.
    fn extend(&mut self, loops: &[(u32, u32)]) {
        let merged = merge(loops);
        if merged.is_empty() {
            return;
        }
        for value in &self.order {
            let interval = &mut self.intervals[*value];
            if !interval.is_global {
                continue;
            }
            if let Some((start, _)) = enclosing_range(&merged, interval.start) {
                interval.start = interval.start.min(start);
            }
            if let Some((_, end)) = enclosing_range(&merged, interval.end) {
                interval.end = interval.end.max(end);
            }
        }
    }

    /// Hands out registers in the order in which intervals begin.
    fn allocate(mut self, function: &Function) -> Option<Registers> {
        let mut registers = Registers {
            numbers: table(function.values.len()),
            classes: Vec::new(),
            spans: SecondaryMap::new(),
        };
        let is_wanted = !function.source.variables.is_empty() || !function.source.inlined.is_empty();
        for value in self.order.iter().filter(|_| is_wanted) {
            let Interval { start, end, .. } = self.intervals[*value];
            registers.spans[*value] = (start, end);
        }
        let mut active: [BinaryHeap<Reverse<(u32, u16)>>; 4] = Default::default();
        for param in &function.params {
            let class = function.values[*param];
            let number = u16::try_from(registers.classes.len()).ok()?;
            registers.numbers[*param] = number;
            registers.classes.push(register_class(class));
            active[class as usize].push(Reverse((self.intervals[*param].end, number)));
        }
        let intervals = &self.intervals;
        self.order.drain(..function.params.len());
        self.order.sort_by_key(|value| intervals[*value].start);
        for value in &self.order {
            let interval = &intervals[*value];
            let class = function.values[*value];
            let supply = &mut active[class as usize];
            let number = match supply.peek() {
                Some(Reverse((end, number))) if *end < interval.start => {
                    let number = *number;
                    supply.pop();
                    number
                }
                _ => {
                    let number = u16::try_from(registers.classes.len()).ok()?;
                    registers.classes.push(register_class(class));
                    number
                }
            };
            registers.numbers[*value] = number;
            supply.push(Reverse((interval.end, number)));
        }
        (registers.classes.len() <= MAX_REGISTERS).then_some(registers)
    }
}

/// The loops as disjoint ranges in ascending order.
fn merge(loops: &[(u32, u32)]) -> Vec<(u32, u32)> {
    let mut sorted = loops.to_vec();
    sorted.sort_unstable();
    let mut merged: Vec<(u32, u32)> = Vec::new();
    for (start, end) in sorted {
        match merged.last_mut() {
            Some(last) if start <= last.1 => last.1 = last.1.max(end),
            _ => merged.push((start, end)),
        }
    }
    merged
}

/// The range that holds a position.
fn enclosing_range(ranges: &[(u32, u32)], position: u32) -> Option<(u32, u32)> {
    let index = ranges.partition_point(|(_, end)| *end < position);
    ranges.get(index).copied().filter(|(start, _)| *start <= position)
}
