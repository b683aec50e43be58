//! Charges the cycles of the vendor's code while the typed tree is lowered.
//!
//! The vendor's compiler generates the same code for a construct everywhere, so the costs follow the source and not our
//! instructions: later optimisation does not change them. The rules are those of `spec/costs.md` section 6; a few minor
//! ones, marked here, follow from its recorded programs.

use cranelift_entity::SecondaryMap;
use kmotiondef::timing::{Timing, WaitStates};

use super::cost_table;
use super::{Lowering, types};
use crate::firmware::{BuiltIn, FirmwareSymbols};
use crate::ir::function::table;
use crate::ir::inst::{BlockId, Class};
use crate::operators::BinaryOp;
use crate::typed::{self, ExprId, ExprKind, LocalId, PlaceId, PlaceKind, SymbolId, UnaryOp};

/// The start of SDRAM: lower addresses are inside of the processor.
const SDRAM: u32 = 0x8000_0000;

/// The state for charging a function.
pub(super) struct CostModel {
    waits: WaitStates,
    /// True for each expression that calls or divides, which changes every register.
    calls: SecondaryMap<ExprId, bool>,
}

impl CostModel {
    /// Collects the facts for charging `function`; `None` if time is not the vendor's.
    pub(super) fn new(function: &typed::Function, timing: Timing) -> Option<Self> {
        let waits = timing.wait_states()?;
        let mut calls = table(function.exprs.len());
        // Operands have lower numbers than their parent expressions.
        for (id, expr) in &function.exprs {
            calls[id] = calls_itself(&expr.kind) || operands(function, id).any(|operand| calls[operand]);
        }
        Some(Self { waits, calls })
    }
}

/// Reports whether the expression itself calls, without its operands.
fn calls_itself(kind: &ExprKind) -> bool {
    let divides = |op: BinaryOp| matches!(op, BinaryOp::Divide | BinaryOp::Remainder);
    match kind {
        ExprKind::Call(_) | ExprKind::Copy { .. } | ExprKind::Clear(_) | ExprKind::Statements(..) => true,
        ExprKind::Binary(op, ..) => divides(*op),
        ExprKind::Update(update) => divides(update.op),
        ExprKind::Int(_)
        | ExprKind::Float(_)
        | ExprKind::Load(_)
        | ExprKind::Address(_)
        | ExprKind::Assign(..)
        | ExprKind::Unary(..)
        | ExprKind::Compare(..)
        | ExprKind::And(..)
        | ExprKind::Or(..)
        | ExprKind::Conditional(..)
        | ExprKind::Comma(..)
        | ExprKind::Convert(_)
        | ExprKind::VaArg(_) => false,
    }
}

/// The expressions that an expression evaluates directly; those of calls do not matter.
fn operands(function: &typed::Function, id: ExprId) -> impl Iterator<Item = ExprId> {
    let pointer = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Pointer(pointer, _) => Some(pointer),
        PlaceKind::Local(..) | PlaceKind::Symbol(..) | PlaceKind::Bits(..) => None,
    };
    let found: [Option<ExprId>; 3] = match function.exprs[id].kind {
        ExprKind::Load(place) | ExprKind::Address(place) | ExprKind::VaArg(place) => {
            [pointer(place), None, None]
        }
        ExprKind::Assign(place, value) => [pointer(place), Some(value), None],
        ExprKind::Update(ref update) => [pointer(update.place), Some(update.operand), None],
        ExprKind::Unary(_, a) | ExprKind::Convert(a) => [Some(a), None, None],
        ExprKind::Binary(_, a, b)
        | ExprKind::Compare(_, a, b)
        | ExprKind::And(a, b)
        | ExprKind::Or(a, b)
        | ExprKind::Comma(a, b) => [Some(a), Some(b), None],
        ExprKind::Conditional(a, b, c) => [Some(a), Some(b), Some(c)],
        ExprKind::Int(_)
        | ExprKind::Float(_)
        | ExprKind::Call(_)
        | ExprKind::Copy { .. }
        | ExprKind::Clear(_)
        | ExprKind::Statements(..) => [None; 3],
    };
    found.into_iter().flatten()
}

/// Reports whether multiplying by a number is a shift.
const fn is_power(factor: i64) -> bool {
    factor > 1 && factor & (factor - 1) == 0
}

/// The access of the vendor's code to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum VendorAccess {
    /// A local, or any place at a constant address.
    Local,
    /// A global, or an address that is a number; accesses may wait for memory.
    Global { waits: bool },
    /// Through an address that takes `fixed` cycles, in addition to the expressions in it.
    Through { fixed: i32, waits: bool },
}

/// The location of an operand in the vendor's code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum VendorOperand {
    /// A constant or a named variable, loaded when it is needed.
    Simple,
    /// A load through an address that is in a register.
    Element,
    /// The result of a call.
    Result,
    /// Any other value, which is in a register.
    Computed,
}

impl Lowering<'_> {
    /// Charges cycles.
    pub(super) fn cost(&mut self, cycles: i32) {
        if self.cost_model.is_some() {
            self.builder.cost(cycles);
        }
    }

    /// Charges the wait for words of SDRAM.
    fn wait(&mut self, words: i32) {
        let waits = self.cost_model.as_ref().map_or(0, |cost_model| cost_model.waits.sdram);
        self.cost(words.saturating_mul(waits.cast_signed()));
    }

    /// A block that charges `cycles` and continues at `to`; just `to` if there are no cycles.
    pub(super) fn costly_way(&mut self, to: BlockId, cycles: u32) -> Option<BlockId> {
        self.cost_model.as_ref()?;
        Some(self.builder.charge_block(to, cycles))
    }

    fn calls(&self, id: ExprId) -> bool {
        self.cost_model.as_ref().is_some_and(|cost_model| cost_model.calls[id])
    }

    fn class_of(&self, id: ExprId) -> Class {
        self.class_or_int(self.function.exprs[id].ty)
    }

    /// Charges a constant.
    pub(super) fn charge_constant(&mut self, class: Class) {
        self.cost(cost_table::constant(class));
        self.wait(cost_table::constant_words(class));
    }

    /// Reports whether accesses of a symbol wait for memory.
    fn symbol_waits(&self, symbol: SymbolId) -> bool {
        let symbol = &self.unit.symbols[symbol];
        !matches!(symbol.definition, typed::Definition::None)
            || BuiltIn.find(&symbol.name).is_none_or(|found| found.address.get() >= SDRAM)
    }

    fn reach_local(&self, local: LocalId, offset: u32, steps: i32) -> VendorAccess {
        let steps = cost_table::STEP * (steps + i32::from(offset != 0));
        if self.function.locals[local].by_pointer {
            let fixed = 7 + steps;
            return VendorAccess::Through { fixed, waits: false };
        }
        match steps {
            0 => VendorAccess::Local,
            _ => VendorAccess::Through { fixed: cost_table::LOCAL_ADDRESS + steps, waits: false },
        }
    }

    /// The access to a place; follows it as [`Lowering::address`] does.
    fn reach(&self, place: PlaceId) -> VendorAccess {
        let (mut place, mut steps) = (place, 0);
        loop {
            let pointer = match self.function.places[place].kind {
                PlaceKind::Local(local, offset) => return self.reach_local(local, offset, steps),
                PlaceKind::Symbol(symbol, _) => {
                    return VendorAccess::Global { waits: self.symbol_waits(symbol) };
                }
                PlaceKind::Bits(unit, _) => {
                    place = unit;
                    continue;
                }
                PlaceKind::Pointer(pointer, offset) => {
                    steps += i32::from(offset != 0);
                    pointer
                }
            };
            let (base, more) = self.without_steps(pointer);
            steps += more;
            match self.function.exprs[base].kind {
                ExprKind::Address(inner) => place = inner,
                ExprKind::Int(_) => return VendorAccess::Global { waits: false },
                _ => {
                    let fixed = cost_table::STEP * steps;
                    return VendorAccess::Through { fixed, waits: self.pointee_waits(base) };
                }
            }
        }
    }

    /// Returns a pointer without the constants added to it, and the number of these.
    fn without_steps(&self, pointer: ExprId) -> (ExprId, i32) {
        let (mut pointer, mut steps) = (pointer, 0);
        loop {
            match self.function.exprs[pointer].kind {
                ExprKind::Binary(BinaryOp::Add, base, step) if self.is_int(step) => {
                    pointer = base;
                    steps += 1;
                }
                ExprKind::Convert(inner) if self.is_same_word(self.function.exprs[inner].ty) => {
                    pointer = inner;
                }
                _ => return (pointer, steps),
            }
        }
    }

    fn is_int(&self, id: ExprId) -> bool {
        matches!(self.function.exprs[id].kind, ExprKind::Int(_))
    }

    /// Reports whether an access through a pointer waits for memory, as far as the expression shows.
    fn pointee_waits(&self, pointer: ExprId) -> bool {
        let mut pointer = pointer;
        loop {
            match self.function.exprs[pointer].kind {
                ExprKind::Binary(_, base, _) | ExprKind::Convert(base) => pointer = base,
                ExprKind::Address(place) if matches!(self.reach(place), VendorAccess::Local) => return false,
                ExprKind::Address(place) | ExprKind::Load(place) => {
                    return match self.function.places[place].kind {
                        PlaceKind::Symbol(symbol, _) => self.symbol_waits(symbol),
                        PlaceKind::Local(..) | PlaceKind::Pointer(..) | PlaceKind::Bits(..) => true,
                    };
                }
                _ => return true,
            }
        }
    }

    /// Charges a load of a place, without the expressions in its address.
    pub(super) fn charge_load(&mut self, place: PlaceId) {
        if self.cost_model.is_none() {
            return;
        }
        let class = self.class_or_int(self.function.places[place].ty);
        let waits = match self.reach(place) {
            VendorAccess::Local => {
                self.cost(cost_table::by_class(class, 7, 8));
                false
            }
            VendorAccess::Global { waits } => {
                self.cost(cost_table::by_class(class, 7, 8));
                waits
            }
            VendorAccess::Through { fixed, waits } => {
                self.cost(fixed + cost_table::by_class(class, 5, 6));
                waits
            }
        };
        self.wait(if waits { cost_table::memory_words(class) } else { 0 });
        if let PlaceKind::Bits(..) = self.function.places[place].kind {
            self.cost(2 * cost_table::STEP);
        }
    }

    /// Charges the address of a place that is accessed more than once, without the expressions in it.
    fn charge_reach(&mut self, place: PlaceId) {
        if let VendorAccess::Through { fixed, .. } = self.reach(place) {
            self.cost(fixed);
        }
    }

    /// Charges the address of a place as a value.
    pub(super) fn charge_address(&mut self, place: PlaceId) {
        if self.cost_model.is_none() {
            return;
        }
        self.cost(match self.reach(place) {
            VendorAccess::Local => cost_table::LOCAL_ADDRESS,
            VendorAccess::Global { .. } => cost_table::GLOBAL_ADDRESS,
            VendorAccess::Through { fixed, .. } => fixed,
        });
    }

    /// Charges the store to a place whose address has been charged.
    fn charge_store(&mut self, place: PlaceId) {
        let class = self.class_or_int(self.function.places[place].ty);
        let waits = match self.reach(place) {
            VendorAccess::Local => {
                self.cost(cost_table::by_class(class, 3, 5));
                false
            }
            VendorAccess::Global { waits } => {
                self.cost(cost_table::by_class(class, 3, 4));
                waits
            }
            VendorAccess::Through { waits, .. } => {
                self.cost(cost_table::by_class(class, 1, 2));
                waits
            }
        };
        self.wait(if waits { cost_table::memory_words(class) } else { 0 });
        if let PlaceKind::Bits(..) = self.function.places[place].kind {
            self.cost(7 + 5 * cost_table::STEP);
        }
    }

    fn is_through(&self, place: PlaceId) -> bool {
        matches!(self.reach(place), VendorAccess::Through { .. })
    }

    /// Charges an assignment, without its value.
    pub(super) fn charge_assignment(&mut self, place: PlaceId, value: ExprId) {
        if self.cost_model.is_none() {
            return;
        }
        if self.is_through(place) {
            self.charge_reach(place);
            let class = self.class_of(value);
            if self.calls(value) {
                self.cost(cost_table::SAVE_ADDRESS);
            } else if class == Class::F32 && self.nature(value) == VendorOperand::Computed {
                self.cost(cost_table::CROWDED_SINGLE);
            }
            // As recorded: `a[i] = 16 - i` into doubles takes one cycle more than `a[i] = i`.
            let is_converted = matches!(self.function.exprs[value].kind,
                ExprKind::Convert(inner) if class == Class::F64 && self.nature(inner) == VendorOperand::Computed);
            self.cost(i32::from(is_converted) * cost_table::MOVE);
        }
        self.charge_store(place);
    }

    /// Charges `place = place op operand`, without its operand.
    pub(super) fn charge_update(&mut self, update: &typed::Update) {
        if self.cost_model.is_none() {
            return;
        }
        let place = update.place;
        let ty = self.function.places[place].ty;
        let (stored, computed) = (self.class_or_int(ty), self.class_or_int(update.computed));
        self.charge_load(place);
        if self.is_through(place) && self.calls(update.operand) {
            self.cost(cost_table::SAVE_ADDRESS);
        }
        self.cost(cost_table::convert(stored, computed) + cost_table::convert(computed, stored));
        if update.result == typed::UpdateResult::Old {
            self.cost(cost_table::KEEP_OLD);
        }
        let is_element = self.nature(update.operand) == VendorOperand::Element;
        self.cost(match computed {
            Class::F64 if is_element => cost_table::CROWDED,
            Class::F32 if is_element => cost_table::CROWDED_SINGLE,
            Class::I32 | Class::I64 | Class::F32 | Class::F64 => 0,
        });
        self.charge_operator(update.op, computed, update.operand);
        self.charge_store(place);
    }

    /// Charges an operator with this right side, and takes back the cost of a constant that makes it a no-op.
    fn charge_operator(&mut self, op: BinaryOp, class: Class, b: ExprId) {
        let constant = match self.function.exprs[b].kind {
            ExprKind::Int(value) if class == Class::I32 => Some(value),
            _ => None,
        };
        let is_idle = match constant {
            Some(0) => matches!(
                op,
                BinaryOp::Add
                    | BinaryOp::Subtract
                    | BinaryOp::Or
                    | BinaryOp::Xor
                    | BinaryOp::ShiftLeft
                    | BinaryOp::ShiftRight
            ),
            Some(1) => matches!(op, BinaryOp::Multiply | BinaryOp::Divide),
            Some(_) | None => false,
        };
        let is_shift = op == BinaryOp::Multiply && constant.is_some_and(is_power);
        self.cost(if is_idle {
            -cost_table::constant(class)
        } else if is_shift {
            cost_table::binary(BinaryOp::ShiftLeft, class)
        } else {
            cost_table::binary(op, class)
        });
    }

    /// Charges for saving the left side while the right one is evaluated.
    pub(super) fn charge_kept(&mut self, a: ExprId, b: ExprId) {
        if !self.calls(b) {
            return;
        }
        self.cost(match self.nature(a) {
            VendorOperand::Simple => 0,
            VendorOperand::Element => cost_table::SAVE_ADDRESS,
            // A result is saved directly from its register, without being moved first.
            VendorOperand::Result => {
                cost_table::save(self.class_of(a)) - cost_table::result(self.class_of(a))
            }
            VendorOperand::Computed => cost_table::save(self.class_of(a)),
        });
    }

    /// Charges a binary operator, without its operands.
    pub(super) fn charge_binary(&mut self, id: ExprId) {
        if self.cost_model.is_none() {
            return;
        }
        let ExprKind::Binary(op, a, b) = self.function.exprs[id].kind else { return };
        let ty = self.function.exprs[id].ty;
        let class = self.class_or_int(ty);
        let (left, right) = (self.nature(a), self.nature(b));
        let both = left != VendorOperand::Simple
            && left != VendorOperand::Element
            && right == VendorOperand::Computed;
        self.cost(match class {
            Class::F64 if right == VendorOperand::Element => cost_table::CROWDED,
            Class::F64 if both && !self.calls(b) => cost_table::CROWDED,
            Class::F32 if right == VendorOperand::Element => cost_table::CROWDED_SINGLE,
            Class::I32 | Class::I64 | Class::F32 | Class::F64 => 0,
        });
        // As recorded: the dividend is moved to the argument register, an index to the register in which it is scaled.
        let divides = matches!(op, BinaryOp::Divide | BinaryOp::Remainder);
        let is_index = self.unit.types.is_pointer(ty) && self.is_shifted_sum(b);
        let is_moved =
            class == Class::I32 && if divides { left == VendorOperand::Computed } else { is_index };
        self.cost(i32::from(is_moved) * cost_table::MOVE);
        self.charge_operator(op, class, b);
    }

    /// Reports whether an index is computed and scaled by a shift.
    fn is_shifted_sum(&self, bytes: ExprId) -> bool {
        let ExprKind::Binary(BinaryOp::Multiply, index, scale) = self.function.exprs[bytes].kind else {
            return false;
        };
        matches!(self.function.exprs[scale].kind, ExprKind::Int(scale) if is_power(scale))
            && self.nature(index) == VendorOperand::Computed
    }

    /// Charges a unary operator except `!`, without its operand.
    pub(super) fn charge_unary(&mut self, operand: ExprId, op: UnaryOp) {
        let class = self.class_of(operand);
        match (op, class) {
            (UnaryOp::Negate | UnaryOp::Complement, Class::I32 | Class::I64) => self.cost(cost_table::STEP),
            // 0 minus the value.
            (UnaryOp::Negate | UnaryOp::Complement, Class::F32 | Class::F64) => {
                self.charge_constant(class);
                self.cost(cost_table::binary(BinaryOp::Subtract, class));
            }
            (UnaryOp::Not, _) => {
                let is_comparison = matches!(self.function.exprs[operand].kind, ExprKind::Compare(..));
                self.cost(if is_comparison { 0 } else { cost_table::BRANCH + cost_table::TRUTH[0] });
            }
        }
    }

    /// Charges a comparison, without its operands.
    pub(super) fn charge_compare(&mut self, a: ExprId, b: ExprId) {
        if self.cost_model.is_none() {
            return;
        }
        let class = self.class_of(a);
        let (left, right) = (self.nature(a), self.nature(b));
        let elements = [left, right].into_iter().filter(|nature| *nature == VendorOperand::Element).count();
        let both = left != VendorOperand::Simple && right == VendorOperand::Computed && elements == 0;
        self.cost(match class {
            Class::F64 if elements > 0 => cost_table::CROWDED_COMPARE[elements - 1],
            Class::F64 if both => cost_table::CROWDED,
            Class::I32 | Class::I64 | Class::F32 if both => cost_table::MOVE,
            Class::I32 | Class::I64 | Class::F32 | Class::F64 => 0,
        });
        self.cost(cost_table::compare(class));
    }

    /// Charges the test of a value that decides a branch.
    pub(super) fn charge_test(&mut self, condition: ExprId) {
        if self.cost_model.is_none() {
            return;
        }
        let class = self.class_of(condition);
        match &self.function.exprs[condition].kind {
            // The comparison itself decides; its value is not needed.
            ExprKind::Compare(..) => self.cost(-cost_table::MOVE),
            // As recorded: `while (i--)` takes a cycle more.
            ExprKind::Update(update) if update.result == typed::UpdateResult::Old => {
                self.cost(cost_table::MOVE);
            }
            _ => {}
        }
        if class != Class::I32 {
            self.charge_constant(class);
            self.cost(cost_table::compare(class));
        }
        self.cost(cost_table::BRANCH);
    }

    /// Charges the comparison with 0 before a test that is not a comparison.
    pub(super) fn charge_zero_test(&mut self) {
        self.cost(cost_table::constant(Class::I32) + cost_table::compare(Class::I32));
    }

    /// Charges a conversion.
    pub(super) fn charge_conversion(&mut self, operand: ExprId, to: Class) {
        if self.cost_model.is_none() {
            return;
        }
        let from = self.class_of(operand);
        if self.is_int(operand) && from == Class::I32 {
            // The constant is converted, not the value.
            self.cost(-cost_table::constant(from));
            self.charge_constant(to);
            return;
        }
        self.cost(cost_table::convert(from, to));
    }

    /// Charges passing the arguments of a call, without their values, and the branch of the call.
    pub(super) fn charge_call(&mut self, call: &typed::Call) {
        if self.cost_model.is_none() {
            return;
        }
        let is_firmware = match call.callee {
            typed::Callee::Symbol(symbol) => {
                let symbol = &self.unit.symbols[symbol];
                matches!(symbol.definition, typed::Definition::None) && BuiltIn.find(&symbol.name).is_some()
            }
            typed::Callee::Pointer(_) => {
                self.cost(cost_table::POINTER_BRANCH - cost_table::BRANCH);
                false
            }
        };
        self.cost(cost_table::BRANCH);
        let variable = call.variable.as_deref().unwrap_or(&[]);
        // A computed argument is saved during a call for a later argument.
        let all: Vec<ExprId> = call.arguments.iter().chain(variable).copied().collect();
        let last = all.iter().rposition(|argument| self.calls(*argument)).unwrap_or(0);
        for (position, argument) in all.into_iter().enumerate() {
            let class = self.class_of(argument);
            let is_kept = matches!(self.nature(argument), VendorOperand::Computed | VendorOperand::Result);
            self.cost(if is_kept && position < last { cost_table::save(class) } else { 0 });
            self.cost(cost_table::argument(class, is_firmware));
            self.charge_moved(argument);
        }
        if call.variable.is_some() {
            self.cost(cost_table::VARIABLE_ARGUMENTS + variable.len() as i32);
        }
    }

    /// Charges moving a value to the register of an argument or result.
    fn charge_moved(&mut self, value: ExprId) {
        let class = self.class_of(value);
        let is_comparison = matches!(self.function.exprs[value].kind, ExprKind::Compare(..));
        self.cost(match self.nature(value) {
            VendorOperand::Simple | VendorOperand::Element => 0,
            VendorOperand::Result => -cost_table::result(class),
            VendorOperand::Computed if is_comparison => 0,
            VendorOperand::Computed => cost_table::by_class(class, cost_table::MOVE, 2 * cost_table::MOVE),
        });
    }

    /// Charges taking the result of a call.
    pub(super) fn charge_result(&mut self, class: Option<Class>) {
        if let Some(class) = class {
            self.cost(cost_table::result(class));
        }
    }

    /// Charges a `return`, without its value.
    pub(super) fn charge_return(&mut self, value: Option<ExprId>) {
        if self.cost_model.is_none() {
            return;
        }
        if let Some(value) = value {
            self.charge_moved(value);
        }
        self.cost(cost_table::BRANCH);
    }

    /// Charges copying or clearing an object, without its addresses.
    pub(super) fn charge_block(&mut self, bytes: u32, is_copy: bool) {
        self.cost(if is_copy { cost_table::copy(bytes) } else { cost_table::clear(bytes) });
        let words = (bytes / 4).cast_signed();
        self.wait(if is_copy { 2 * words } else { words });
    }

    fn nature(&self, id: ExprId) -> VendorOperand {
        match self.function.exprs[id].kind {
            ExprKind::Int(_) | ExprKind::Float(_) => VendorOperand::Simple,
            ExprKind::Load(place) if self.is_through(place) => VendorOperand::Element,
            ExprKind::Load(_) => VendorOperand::Simple,
            ExprKind::Address(place) if self.is_through(place) => VendorOperand::Computed,
            ExprKind::Address(_) => VendorOperand::Simple,
            ExprKind::Convert(inner) if self.is_free(inner, id) => self.nature(inner),
            ExprKind::Call(_) => VendorOperand::Result,
            _ => VendorOperand::Computed,
        }
    }

    /// Reports whether a conversion costs nothing.
    fn is_free(&self, from: ExprId, to: ExprId) -> bool {
        types::class(&self.unit.types, self.function.exprs[to].ty).is_some()
            && (self.is_int(from) || self.class_of(from) == self.class_of(to))
    }
}
