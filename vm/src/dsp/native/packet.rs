//! One packet: the effects of its instructions, and the passing of its cycles.
//!
//! Results of the first stage and stores are kept apart until all instructions of the packet are translated: a case
//! that only the interpreter can execute leads to an exit at which no effect of the packet has happened.

use std::collections::BTreeMap;
use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, InstBuilder, Value, types};

use super::super::decode::{DEFERRED, MicroOp, STACK, TRUE, ZERO};
use super::super::work::Work;
use super::flying::{EffectKind, InFlightEffect};
use super::region::{Border, EffectValues, NoNextPacket, Translator, offset, result, sort};
use crate::native::Handover;

/// Cycles from a branch to its target.
const BRANCH: u8 = 6;

/// The state of translating one packet.
#[derive(Default)]
pub(super) struct PacketState {
    /// Registers that have their new values at the end of this cycle.
    pub(super) now: BTreeMap<u8, Value>,
    /// The effects in flight, from before and from this packet.
    pub(super) flights: Vec<EffectValues>,
    /// Stores that wait for the end: pointer, value, bytes.
    pub(super) stores: Vec<(Value, Value, u32)>,
    /// Branches that were taken: their conditions.
    branches: Vec<Option<Value>>,
    /// The condition of the instruction.
    pub(super) condition: Option<Value>,
    /// The block for cases that the interpreter handles.
    side: Option<Block>,
}

impl Translator<'_, '_> {
    /// Translates the packet at the border and advances the border; `false` if no packet follows in this block.
    pub(super) fn packet(&mut self, border: &mut Border) -> Result<bool, NoNextPacket> {
        if border.pc & 3 != 0 {
            return Err(NoNextPacket::PacketInterpreted);
        }
        let (packet, micros) = (self.find)(border.pc).ok_or(NoNextPacket::PacketInterpreted)?;
        if packet.is_idle {
            return Err(NoNextPacket::PacketInterpreted);
        }
        let mut packet_state = PacketState { flights: border.flights.clone(), ..PacketState::default() };
        let done = micros.iter().try_for_each(|micro| {
            packet_state.condition = self.condition(&packet_state, micro);
            self.micro(&mut packet_state, micro)
        });
        if done.is_ok() && packet.moves_stack {
            self.check_stack(&mut packet_state);
        }
        if let Some(side) = packet_state.side {
            self.builder.seal_block(side);
            self.sides.push((side, border.clone()));
        }
        done?;
        self.commit(&packet_state, border, packet.has_branch);
        border.packets += 1;
        border.flights = packet_state.flights;
        let goes_on = self.advance(border, packet.cycles)?;
        border.pc = packet.end;
        Ok(goes_on)
    }

    /// The block of the exit for everything that the interpreter must execute.
    pub(super) fn side(&mut self, packet_state: &mut PacketState) -> Block {
        *packet_state.side.get_or_insert_with(|| self.cold())
    }

    /// Leaves the packet to the interpreter if `is_wrong`.
    pub(super) fn refuse_if(&mut self, packet_state: &mut PacketState, is_wrong: Value) {
        let (side, inside) = (self.side(packet_state), self.builder.create_block());
        self.builder.ins().brif(is_wrong, side, &[], inside, &[]);
        self.continue_in(inside);
    }

    /// The value that decides whether an instruction is executed; `None` if it always is.
    fn condition(&mut self, packet_state: &PacketState, micro: &MicroOp) -> Option<Value> {
        if micro.pred == TRUE {
            return None;
        }
        let value = self.read(packet_state, micro.pred);
        let condition = if micro.inverted { IntCC::Equal } else { IntCC::NotEqual };
        Some(self.builder.ins().icmp_imm_u(condition, value, 0))
    }

    /// A register as the instruction sees it.
    pub(super) fn read(&mut self, packet_state: &PacketState, reg: u8) -> Value {
        match reg {
            ZERO => self.builder.ins().iconst(types::I32, 0),
            TRUE => self.builder.ins().iconst(types::I32, 1),
            _ => {
                let known = packet_state.now.get(&reg).copied();
                known.unwrap_or_else(|| self.builder.use_var(self.regs[usize::from(reg & 63)]))
            }
        }
    }

    /// A result of the first stage.
    pub(super) fn write_result(
        &mut self,
        packet_state: &mut PacketState,
        micro: &MicroOp,
        reg: u8,
        value: Value,
    ) -> Result<(), NoNextPacket> {
        if micro.flags & DEFERRED != 0 {
            return self.push(packet_state, 1, reg, value);
        }
        let arriving =
            packet_state.flights.iter().find(|flight| flight.flying == strip(flight.flying, 1, reg));
        if let Some(other) = arriving.map(|flight| flight.condition) {
            self.refuse_both(packet_state, other)?;
        }
        let new = match packet_state.condition {
            Some(condition) => {
                let old = self.read(packet_state, reg);
                self.builder.ins().select(condition, value, old)
            }
            None => value,
        };
        packet_state.now.insert(reg, new);
        Ok(())
    }

    /// Two results for one register: certain, or only if both conditions hold.
    fn refuse_both(
        &mut self,
        packet_state: &mut PacketState,
        other: Option<Value>,
    ) -> Result<(), NoNextPacket> {
        let both = match (packet_state.condition, other) {
            (None, None) => return Err(NoNextPacket::PacketInterpreted),
            (Some(one), None) | (None, Some(one)) => one,
            (Some(one), Some(two)) => self.builder.ins().band(one, two),
        };
        self.refuse_if(packet_state, both);
        Ok(())
    }

    /// Adds a result that lands in `due` cycles.
    pub(super) fn push(
        &mut self,
        packet_state: &mut PacketState,
        due: u8,
        reg: u8,
        value: Value,
    ) -> Result<(), NoNextPacket> {
        let index =
            packet_state.flights.iter().position(|flight| flight.flying == strip(flight.flying, due, reg));
        let Some(index) = index else {
            let condition = packet_state.condition;
            packet_state.flights.push(effect_values(result(due, reg), condition, vec![value]));
            return Ok(());
        };
        let (other, old) = (packet_state.flights[index].condition, packet_state.flights[index].values[0]);
        self.refuse_both(packet_state, other)?;
        // Not both hold: with two conditions, the result is that of the condition that holds.
        let (condition, value) = match (packet_state.condition, other) {
            (Some(one), Some(two)) => {
                (Some(self.builder.ins().bor(one, two)), self.builder.ins().select(one, value, old))
            }
            (Some(_) | None, None) => (None, old),
            (None, Some(_)) => (None, value),
        };
        packet_state.flights[index] = effect_values(result(due, reg), condition, vec![value]);
        Ok(())
    }

    /// A branch, to an address or to a value.
    pub(super) fn branch(
        &mut self,
        packet_state: &mut PacketState,
        target: Result<u32, Value>,
    ) -> Result<(), NoNextPacket> {
        let (known, values) = match target {
            Ok(address) => (Some(address), Vec::new()),
            Err(value) => (None, vec![value]),
        };
        let others: Vec<Option<Value>> = packet_state
            .flights
            .iter()
            .filter(|flight| {
                flight.flying.due == BRANCH && matches!(flight.flying.kind, EffectKind::Branch(_))
            })
            .map(|flight| flight.condition)
            .collect();
        for other in others {
            self.refuse_both(packet_state, other)?;
        }
        let flying = InFlightEffect { due: BRANCH, is_conditional: false, kind: EffectKind::Branch(known) };
        packet_state.flights.push(effect_values(flying, packet_state.condition, values));
        packet_state.branches.push(packet_state.condition);
        Ok(())
    }

    /// A double instruction that reads its high words later.
    pub(super) fn start_double(&mut self, packet_state: &mut PacketState, micro: &MicroOp, low: [Value; 2]) {
        let flying = InFlightEffect { due: 1, is_conditional: false, kind: EffectKind::Start(*micro) };
        packet_state.flights.push(effect_values(flying, packet_state.condition, low.to_vec()));
    }

    /// Leaves the packet to the interpreter where the stack pointer leaves its bounds.
    fn check_stack(&mut self, packet_state: &mut PacketState) {
        let pointer = self.read(packet_state, STACK);
        let handover = self.pointers.handover;
        let mut bound = |field| self.builder.ins().load(types::I32, self.own, handover, offset(field));
        let limit = bound(offset_of!(Handover, stack.limit));
        let top = bound(offset_of!(Handover, stack.top));
        let under = self.builder.ins().icmp(IntCC::UnsignedLessThan, pointer, limit);
        let over = self.builder.ins().icmp(IntCC::UnsignedGreaterThan, pointer, top);
        let outside = self.builder.ins().bor(under, over);
        self.refuse_if(packet_state, outside);
        let field = offset(offset_of!(Handover, stack.lowest));
        let lowest = self.builder.ins().load(types::I32, self.own, handover, field);
        let lowest = self.builder.ins().umin(lowest, pointer);
        self.builder.ins().store(self.own, lowest, handover, field);
    }

    /// Applies all effects of the packet in its first cycle.
    fn commit(&mut self, packet_state: &PacketState, border: &Border, has_branch: bool) {
        for (pointer, value, bytes) in &packet_state.stores {
            match bytes {
                1 => self.builder.ins().istore8(self.guest, *value, *pointer, 0),
                2 => self.builder.ins().istore16(self.guest, *value, *pointer, 0),
                _ => self.builder.ins().store(self.guest, *value, *pointer, 0),
            };
        }
        for (reg, value) in &packet_state.now {
            self.set(*reg, *value);
        }
        if has_branch {
            let shadow = self.cycle(border.cycles + u32::from(BRANCH));
            self.builder.def_var(self.counters.shadow, shadow);
        }
        for condition in &packet_state.branches {
            let [last, before] = self.counters.branched_at;
            let at = self.builder.ins().iconst(types::I32, i64::from(border.pc));
            let (old, older) = (self.builder.use_var(last), self.builder.use_var(before));
            let (new, second) = match condition {
                Some(condition) => (
                    self.builder.ins().select(*condition, at, old),
                    self.builder.ins().select(*condition, old, older),
                ),
                None => (at, old),
            };
            self.builder.def_var(last, new);
            self.builder.def_var(before, second);
        }
    }

    /// Gives a register its value.
    fn set(&mut self, reg: u8, value: Value) {
        let reg = reg & 63;
        self.builder.def_var(self.regs[usize::from(reg)], value);
        self.builder.ins().store(self.own, value, self.pointers.regs, 4 * i32::from(reg));
    }

    /// Lets the cycles of a packet pass; `false` where a branch has certainly arrived.
    fn advance(&mut self, border: &mut Border, cycles: u8) -> Result<bool, NoNextPacket> {
        for _ in 0..cycles {
            border.cycles += 1;
            border.flights.iter_mut().for_each(|flight| flight.flying.due -= 1);
            let flights = std::mem::take(&mut border.flights);
            let (arrived, mut rest): (Vec<_>, Vec<_>) =
                flights.into_iter().partition(|flight| flight.flying.due == 0);
            for flight in &arrived {
                if let EffectKind::Result(reg) = flight.flying.kind {
                    self.land_result(reg, flight.condition, flight.values[0]);
                }
            }
            let mut packet_state =
                PacketState { flights: std::mem::take(&mut rest), ..PacketState::default() };
            for flight in &arrived {
                // A second result for the same register is reported by the interpreter, at the next packet, not here.
                self.read_late(&mut packet_state, flight).map_err(|_| NoNextPacket::RegionInterpreted)?;
            }
            if packet_state.side.is_some() {
                return Err(NoNextPacket::RegionInterpreted);
            }
            border.flights = packet_state.flights;
            sort(&mut border.flights);
            for flight in &arrived {
                if self.arrive(border, flight) {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    fn land_result(&mut self, reg: u8, condition: Option<Value>, value: Value) {
        let value = match condition {
            Some(condition) => {
                let old = self.builder.use_var(self.regs[usize::from(reg & 63)]);
                self.builder.ins().select(condition, value, old)
            }
            None => value,
        };
        self.set(reg, value);
    }

    /// The next read of a double instruction.
    fn read_late(
        &mut self,
        packet_state: &mut PacketState,
        flight: &EffectValues,
    ) -> Result<(), NoNextPacket> {
        packet_state.condition = flight.condition;
        let (micro, high2) = match flight.flying.kind {
            EffectKind::Start(micro) => (micro, None),
            EffectKind::Product(micro) => (micro, Some(flight.values[2])),
            EffectKind::Result(_) | EffectKind::Branch(_) => return Ok(()),
        };
        let [low1, low2] = [flight.values[0], flight.values[1]];
        let high1 = self.read(packet_state, micro.a | 1);
        let own2 = self.read(packet_state, micro.b | 1);
        if micro.work == Work::Mpydp && high2.is_none() {
            let flying = InFlightEffect { due: 1, is_conditional: false, kind: EffectKind::Product(micro) };
            packet_state.flights.push(effect_values(flying, flight.condition, vec![low1, low2, own2]));
            return Ok(());
        }
        self.finish_double(packet_state, &micro, [low1, high1], [low2, high2.unwrap_or(own2)])
    }

    /// Emits a branch that arrives; reports whether it is certainly taken.
    fn arrive(&mut self, border: &Border, flight: &EffectValues) -> bool {
        let EffectKind::Branch(known) = flight.flying.kind else { return false };
        let rest = flight.condition.map(|condition| {
            let (taken, rest) = (self.builder.create_block(), self.builder.create_block());
            self.builder.ins().brif(condition, taken, &[], rest, &[]);
            self.continue_in(taken);
            rest
        });
        match known {
            Some(pc) => self.go_to(&Border { pc, ..border.clone() }),
            None => self.exit(border, Some(flight.values[0]), true),
        }
        if let Some(rest) = rest {
            self.continue_in(rest);
        }
        rest.is_none()
    }
}

/// `flying` if it is a result for `reg` due in `due` cycles; otherwise a placeholder that matches nothing.
fn strip(flying: InFlightEffect, due: u8, reg: u8) -> InFlightEffect {
    InFlightEffect { is_conditional: flying.is_conditional, ..result(due, reg) }
}

/// An effect in flight with its condition.
fn effect_values(flying: InFlightEffect, condition: Option<Value>, values: Vec<Value>) -> EffectValues {
    EffectValues {
        flying: InFlightEffect { is_conditional: condition.is_some(), ..flying },
        condition,
        values,
    }
}
