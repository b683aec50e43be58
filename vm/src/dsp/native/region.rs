//! A region: packets that are reached from one address, as one function of the host.
//!
//! Each block begins at a packet with a list of the effects in flight there; the same packet with another list is
//! another block. It follows the packets in their order, and ends where a branch arrives. Effects in flight are passed
//! from block to block as parameters, the words of a pair as one parameter; the processor's registers are variables,
//! and each new value is also stored, so that the registers are right wherever the function ends.
//!
//! The function ends before a packet, never within one: everything that can go wrong is tested before any effect of the
//! packet is stored. The interpreter executes the rest: accesses of devices, stores among code, control registers,
//! faults. The function also ends where less time is left than a block may take, so that no packet begins too late.

use std::collections::BTreeMap;
use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    Block, BlockArg, Endianness, Function, InstBuilder, MemFlagsData, Type, Value, types,
};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Variable};
use cranelift_module::Module;

use super::super::decode::{MicroOp, Packet};
use super::flying::{EffectKind, InFlightEffect};
use crate::native::{CompileError, Handover, Piece, Places, VALUES};

/// Cycles that must be left where a block begins: no block takes more.
pub(super) const LONGEST: u32 = 128;
/// Cycles after which a block ends before its next packet.
const ENOUGH: u32 = LONGEST - 32;
/// Most packets, most blocks of a region.
const MOST_PACKETS: u32 = 160;
const MOST_BLOCKS: usize = 64;
/// Registers of the processor.
const REGISTERS: u8 = 64;

/// Finds the packet at an address, and its instructions.
pub(super) type PacketFinder<'a> = dyn FnMut(u32) -> Option<(Packet, Vec<MicroOp>)> + 'a;

/// A region, ready to run.
#[derive(Debug)]
pub(super) struct Region {
    /// The effects in flight at its entry.
    pub(super) entry: Vec<InFlightEffect>,
    /// Its code, which returns the number of an exit.
    pub(super) piece: Piece,
    /// Its exits.
    pub(super) exits: Vec<Exit>,
}

/// An exit of a region.
#[derive(Debug)]
pub(super) struct Exit {
    /// The next packet; `None` if the code computes it.
    pub(super) pc: Option<u32>,
    /// The effects in flight at the exit.
    pub(super) flying: Vec<InFlightEffect>,
    /// True if another region may begin at the exit.
    pub(super) is_end: bool,
}

/// The reason why there is no region.
#[derive(Debug)]
pub(super) enum NoRegion {
    /// Cranelift has refused it.
    Compile,
    /// It needs an operation that only the interpreter has.
    Unusual,
}

impl From<CompileError> for NoRegion {
    fn from(_: CompileError) -> Self {
        Self::Compile
    }
}

/// Translates the packets that are reached from `pc` with the effects `entry` in flight.
pub(super) fn translate(
    pc: u32,
    entry: Vec<InFlightEffect>,
    find: &mut PacketFinder<'_>,
) -> Result<Region, NoRegion> {
    let mut exits = Vec::new();
    let piece = Piece::compile(|function, context, module| {
        let mut translator = Translator::new(function, context, find);
        let is_written = translator.region(pc, &entry).is_ok();
        exits = std::mem::take(&mut translator.exits);
        if is_written {
            translator.finish(module);
        }
        is_written
    })?;
    Ok(Region { entry, piece: piece.ok_or(NoRegion::Unusual)?, exits })
}

/// The error that a region or a packet needs the interpreter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NeedsInterpreter;

/// An effect in flight, with its values.
#[derive(Clone, Debug)]
pub(super) struct EffectValues {
    pub(super) flying: InFlightEffect,
    pub(super) condition: Option<Value>,
    pub(super) values: Vec<Value>,
}

/// A place between two packets of a block.
#[derive(Clone, Debug)]
pub(super) struct Border {
    /// The next packet.
    pub(super) pc: u32,
    /// Cycles and packets since the block began.
    pub(super) cycles: u32,
    pub(super) packets: u32,
    /// The effects in flight, in their order.
    pub(super) flights: Vec<EffectValues>,
}

/// A block of the region.
#[derive(Clone)]
struct Node {
    pc: u32,
    flying: Vec<InFlightEffect>,
    /// Words in flight that form one value, by their numbers among all values.
    pairs: Vec<[usize; 2]>,
    block: Block,
}

/// Variables of the function besides registers.
#[derive(Clone, Copy)]
pub(super) struct Counters {
    pub(super) cycle: Variable,
    pub(super) packets: Variable,
    pub(super) shadow: Variable,
    pub(super) branched_at: [Variable; 2],
}

/// One of the two words of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(super) enum PairWord {
    /// Bits 31..0.
    Low,
    /// Bits 63..32.
    High,
}

/// Pointers that the function holds.
#[derive(Clone, Copy)]
pub(super) struct Pointers {
    pub(super) handover: Value,
    pub(super) regs: Value,
    pub(super) sdram: Value,
    pub(super) iram: Value,
    pub(super) marks: Value,
}

/// Writes the function.
pub(super) struct Translator<'a, 'f> {
    pub(super) builder: FunctionBuilder<'a>,
    pub(super) find: &'a mut PacketFinder<'f>,
    pub(super) regs: Vec<Variable>,
    pub(super) counters: Counters,
    pub(super) pointers: Pointers,
    /// Flags of the function's own memory accesses: always mapped, little endian.
    pub(super) own: MemFlagsData,
    pub(super) guest: MemFlagsData,
    /// Words that are known to be halves of a 64-bit value.
    pub(super) halves: BTreeMap<Value, (Value, PairWord)>,
    nodes: Vec<Node>,
    translated: u32,
    exits: Vec<Exit>,
    /// Blocks that are exits, still to be written, each of a border.
    pub(super) sides: Vec<(Block, Border)>,
}

/// The offset of a field of the handover.
pub(super) fn offset(field: usize) -> i32 {
    i32::try_from(field).expect("it is small")
}

impl<'a, 'f> Translator<'a, 'f> {
    fn new(
        function: &'a mut Function,
        context: &'a mut FunctionBuilderContext,
        find: &'a mut PacketFinder<'f>,
    ) -> Self {
        let mut builder = FunctionBuilder::new(function, context);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        let (handover, places) = (builder.block_params(entry)[0], builder.block_params(entry)[1]);
        let own = MemFlagsData::trusted();
        let constant = own.with_readonly().with_can_move();
        let mut pointer = |field| builder.ins().load(types::I64, constant, places, offset(field));
        let pointers = Pointers {
            handover,
            regs: pointer(offset_of!(Places, regs)),
            sdram: pointer(offset_of!(Places, sdram)),
            iram: pointer(offset_of!(Places, iram)),
            marks: pointer(offset_of!(Places, marks)),
        };
        let mut variable = |ty: Type, base: Value, field: i32| {
            let variable = builder.declare_var(ty);
            let value = builder.ins().load(ty, own, base, field);
            builder.def_var(variable, value);
            variable
        };
        let counters = Counters {
            cycle: variable(types::I64, handover, offset(offset_of!(Handover, time.cycle))),
            packets: variable(types::I64, handover, offset(offset_of!(Handover, time.packets))),
            shadow: variable(types::I64, handover, offset(offset_of!(Handover, time.shadow))),
            branched_at: [0, 4].map(|place| {
                variable(types::I32, handover, offset(offset_of!(Handover, branched_at)) + place)
            }),
        };
        let regs =
            (0..REGISTERS).map(|reg| variable(types::I32, pointers.regs, 4 * i32::from(reg))).collect();
        let guest = own.with_endianness(Endianness::Little);
        Self {
            builder,
            find,
            regs,
            counters,
            pointers,
            own,
            guest,
            halves: BTreeMap::new(),
            nodes: Vec::new(),
            translated: 0,
            exits: Vec::new(),
            sides: Vec::new(),
        }
    }

    /// Ends the function.
    fn finish(mut self, module: &dyn Module) {
        self.builder.seal_all_blocks();
        self.builder.finalize(module.target_config());
    }

    /// Translates the whole region.
    fn region(&mut self, pc: u32, entry: &[InFlightEffect]) -> Result<(), NeedsInterpreter> {
        let mut values = Vec::new();
        let first = offset(offset_of!(Handover, values));
        let count: usize = entry.iter().map(|flying| flying.kind.values()).sum();
        if count > VALUES {
            return Err(NeedsInterpreter);
        }
        for place in (first..).step_by(4).take(count) {
            values.push(self.builder.ins().load(types::I32, self.own, self.pointers.handover, place));
        }
        let node = self.node(pc, entry);
        let flights = effects_with_values(entry, &mut values.into_iter());
        self.jump(node, &flights);
        let mut next = 0;
        while next < self.nodes.len() {
            self.block(next)?;
            for (side, border) in std::mem::take(&mut self.sides) {
                self.builder.switch_to_block(side);
                self.exit(&border, None, false);
            }
            next += 1;
        }
        Ok(())
    }

    /// Returns the block of a packet with these effects in flight.
    fn node(&mut self, pc: u32, flying: &[InFlightEffect]) -> usize {
        if let Some(known) = self.nodes.iter().position(|node| node.pc == pc && node.flying == flying) {
            return known;
        }
        let (block, pairs) = (self.builder.create_block(), pairs(flying));
        for _ in &pairs {
            self.builder.append_block_param(block, types::I64);
        }
        for _ in flying.iter().filter(|one| one.is_conditional) {
            self.builder.append_block_param(block, types::I8);
        }
        let words = flying.iter().map(|one| one.kind.values()).sum::<usize>() - 2 * pairs.len();
        for _ in 0..words {
            self.builder.append_block_param(block, types::I32);
        }
        self.nodes.push(Node { pc, flying: flying.to_vec(), pairs, block });
        self.nodes.len() - 1
    }

    /// Jumps to a block with the effects in flight.
    fn jump(&mut self, node: usize, flights: &[EffectValues]) {
        let Node { pairs, block, .. } = self.nodes[node].clone();
        let values: Vec<Value> = flights.iter().flat_map(|flight| flight.values.iter().copied()).collect();
        let mut arguments = Vec::new();
        for [low, high] in &pairs {
            arguments.push(BlockArg::from(self.join(values[*low], values[*high])));
        }
        arguments.extend(flights.iter().filter_map(|flight| flight.condition).map(BlockArg::from));
        let single = |index: &usize| pairs.iter().all(|pair| !pair.contains(index));
        arguments.extend((0..values.len()).filter(single).map(|index| BlockArg::from(values[index])));
        self.builder.ins().jump(block, &arguments);
    }

    /// Translates a block: packets until a branch arrives, or enough of them.
    fn block(&mut self, index: usize) -> Result<(), NeedsInterpreter> {
        let node = self.nodes[index].clone();
        self.builder.switch_to_block(node.block);
        let mut border = Border { pc: node.pc, cycles: 0, packets: 0, flights: self.arrived(&node) };
        self.leave_if_late(&border);
        loop {
            let is_known = border.packets > 0 && {
                let flying = shape(&border.flights);
                self.nodes.iter().any(|node| node.pc == border.pc && node.flying == flying)
            };
            if is_known || border.cycles >= ENOUGH || self.translated >= MOST_PACKETS {
                if border.packets == 0 {
                    self.exit(&border, None, true);
                } else {
                    self.go_to(&border);
                }
                return Ok(());
            }
            self.translated += 1;
            match self.packet(&mut border) {
                Ok(true) => {}
                Ok(false) => return Ok(()),
                Err(NoNextPacket::PacketInterpreted) => {
                    self.exit(&border, None, false);
                    return Ok(());
                }
                Err(NoNextPacket::RegionInterpreted) => return Err(NeedsInterpreter),
            }
        }
    }

    /// The effects in flight at the beginning of a block.
    fn arrived(&mut self, node: &Node) -> Vec<EffectValues> {
        let mut parameters = self.builder.block_params(node.block).to_vec().into_iter();
        let wholes: Vec<Value> = parameters.by_ref().take(node.pairs.len()).collect();
        let mut words = BTreeMap::new();
        for ([low, high], whole) in node.pairs.iter().zip(wholes) {
            let halves = self.split(whole);
            words.extend([(*low, halves.0), (*high, halves.1)]);
        }
        let conditional = node.flying.iter().filter(|one| one.is_conditional).count();
        let mut conditions = parameters.by_ref().take(conditional).collect::<Vec<_>>().into_iter();
        let count = node.flying.iter().map(|one| one.kind.values()).sum();
        let values: Vec<Value> =
            (0..count).filter_map(|index| words.get(&index).copied().or_else(|| parameters.next())).collect();
        let mut flights = effects_with_values(&node.flying, &mut values.into_iter());
        for flight in flights.iter_mut().filter(|flight| flight.flying.is_conditional) {
            flight.condition = conditions.next();
        }
        flights
    }

    /// Ends the function where less time is left than a block may take.
    fn leave_if_late(&mut self, border: &Border) {
        let cycle = self.builder.use_var(self.counters.cycle);
        let place = offset(offset_of!(Handover, time.deadline));
        let deadline = self.builder.ins().load(types::I64, self.own, self.pointers.handover, place);
        let left = self.builder.ins().isub(deadline, cycle);
        let is_late = self.builder.ins().icmp_imm_s(IntCC::SignedLessThan, left, i64::from(LONGEST));
        let (late, inside) = (self.cold(), self.builder.create_block());
        self.builder.ins().brif(is_late, late, &[], inside, &[]);
        self.continue_in(late);
        self.exit(border, None, false);
        self.continue_in(inside);
    }

    /// A block that is seldom reached.
    pub(super) fn cold(&mut self) -> Block {
        let block = self.builder.create_block();
        self.builder.set_cold_block(block);
        block
    }

    /// Continues in a block all of whose predecessors have been written.
    ///
    /// So a register that no path has changed keeps its value, and the words of a pair are still known to be a pair.
    pub(super) fn continue_in(&mut self, block: Block) {
        self.builder.seal_block(block);
        self.builder.switch_to_block(block);
    }

    /// Continues at a border in its own block, or ends the function there if there are too many.
    pub(super) fn go_to(&mut self, border: &Border) {
        let flying = shape(&border.flights);
        let is_known = self.nodes.iter().any(|node| node.pc == border.pc && node.flying == flying);
        if !is_known && (self.nodes.len() >= MOST_BLOCKS || self.translated >= MOST_PACKETS) {
            return self.exit(border, None, true);
        }
        let node = self.node(border.pc, &flying);
        let (cycle, packets) = self.counts(border);
        self.builder.def_var(self.counters.cycle, cycle);
        self.builder.def_var(self.counters.packets, packets);
        self.jump(node, &border.flights);
    }

    /// Cycle and packets at a border.
    fn counts(&mut self, border: &Border) -> (Value, Value) {
        let cycle = self.cycle(border.cycles);
        let packets = self.builder.use_var(self.counters.packets);
        (cycle, self.builder.ins().iadd_imm_s(packets, i64::from(border.packets)))
    }

    /// The cycle `after` cycles after the beginning of the block.
    pub(super) fn cycle(&mut self, after: u32) -> Value {
        let cycle = self.builder.use_var(self.counters.cycle);
        self.builder.ins().iadd_imm_s(cycle, i64::from(after))
    }

    /// Ends the function at a border; at the packet at `target`, if that is a value.
    pub(super) fn exit(&mut self, border: &Border, target: Option<Value>, is_end: bool) {
        let (cycle, packets) = self.counts(border);
        self.hand_back(cycle, offset_of!(Handover, time.cycle));
        self.hand_back(packets, offset_of!(Handover, time.packets));
        let shadow = self.builder.use_var(self.counters.shadow);
        self.hand_back(shadow, offset_of!(Handover, time.shadow));
        for (index, variable) in self.counters.branched_at.into_iter().enumerate() {
            let at = self.builder.use_var(variable);
            self.hand_back(at, offset_of!(Handover, branched_at) + 4 * index);
        }
        if let Some(target) = target {
            self.hand_back(target, offset_of!(Handover, target));
        }
        let mut place = offset_of!(Handover, values);
        for flight in &border.flights {
            if let Some(condition) = flight.condition {
                let condition = self.builder.ins().uextend(types::I32, condition);
                self.hand_back(condition, place);
                place += 4;
            }
            for value in &flight.values {
                self.hand_back(*value, place);
                place += 4;
            }
        }
        let number = self.builder.ins().iconst(types::I32, self.exits.len() as i64);
        self.builder.ins().return_(&[number]);
        let pc = target.is_none().then_some(border.pc);
        self.exits.push(Exit { pc, flying: shape(&border.flights), is_end });
    }

    fn hand_back(&mut self, value: Value, field: usize) {
        self.builder.ins().store(self.own, value, self.pointers.handover, offset(field));
    }
}

/// The reason why no packet follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoNextPacket {
    /// The packet is the interpreter's.
    PacketInterpreted,
    /// The region is.
    RegionInterpreted,
}

/// The effects in flight, without their values.
fn shape(flights: &[EffectValues]) -> Vec<InFlightEffect> {
    flights.iter().map(|flight| flight.flying).collect()
}

/// The effects in flight with their values, without conditions.
fn effects_with_values(
    flying: &[InFlightEffect],
    values: &mut impl Iterator<Item = Value>,
) -> Vec<EffectValues> {
    let with_values = |flying: &InFlightEffect| EffectValues {
        flying: *flying,
        condition: None,
        values: values.by_ref().take(flying.kind.values()).collect(),
    };
    flying.iter().map(with_values).collect()
}

/// The results that are likely to be the two words of one value, by the numbers of their values: results for an even
/// register and the next one that land in the same cycle, or the second a cycle later.
fn pairs(flying: &[InFlightEffect]) -> Vec<[usize; 2]> {
    let mut values = 0;
    let mut results = Vec::new();
    for one in flying {
        if let (EffectKind::Result(reg), false) = (one.kind, one.is_conditional) {
            results.push((one.due, reg, values));
        }
        values += one.kind.values();
    }
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (due, reg, low) in results.iter().filter(|(_, reg, _)| reg & 1 == 0) {
        let high = [*due, *due + 1].into_iter().find_map(|due| {
            results.iter().find(|other| other.0 == due && other.1 == reg | 1).map(|other| other.2)
        });
        if let Some(high) = high.filter(|high| pairs.iter().all(|pair| !pair.contains(high))) {
            pairs.push([*low, high]);
        }
    }
    pairs
}

/// Sorts the effects in flight.
pub(super) fn sort(flights: &mut [EffectValues]) {
    flights.sort_by_key(|flight| (flight.flying.due, flight.flying.kind.rank()));
}

/// A result for a register.
pub(super) const fn result(due: u8, reg: u8) -> InFlightEffect {
    InFlightEffect { due, is_conditional: false, kind: EffectKind::Result(reg) }
}
