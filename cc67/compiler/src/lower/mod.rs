//! Typed tree to IR.
//!
//! C's rules are already explicit in the typed tree; this stage decides the shape: the home of a local, the branches of
//! a condition, the form of a loop, the passing of a call's arguments.
//!
//! Everything is evaluated from left to right. A local in a register is read by naming its value, without a copy; if a
//! later operand of the same expression writes that local, a copy is inserted afterwards ([`Lowering::hold_operand`]).

mod calls;
mod conditions;
mod conversions;
mod cost;
mod cost_table;
mod expressions;
mod places;
mod statements;
mod switches;
mod types;

use cranelift_entity::packed_option::PackedOption;
use cranelift_entity::{PrimaryMap, SecondaryMap};
use kmotiondef::timing::Timing;

use crate::ir;
use crate::ir::builder::{Builder, Point};
use crate::ir::function::{Function, Signature, Signatures, SourceVariable};
use crate::ir::inst::{Address, Base, BlockId, Class, InstKind, Operand, SignatureId, SlotId, ValueId};
use crate::ir::operators::BinaryOp;
use crate::typed::{self, ExprId, LabelId, LocalId, SymbolId, Unit};
use cost::CostModel;

/// The signatures of the functions that a unit defines.
#[derive(Debug, Default)]
pub struct Definitions {
    signatures: SecondaryMap<SymbolId, PackedOption<SignatureId>>,
}

impl Definitions {
    /// Collects them.
    #[must_use]
    pub fn new(unit: &Unit, signatures: &mut Signatures) -> Self {
        let mut definitions = Self::default();
        for function in &unit.functions {
            let signature = signatures.intern(&signature_of(unit, function));
            definitions.signatures[function.symbol] = signature.into();
        }
        definitions
    }

    /// The signature of a function that the unit defines.
    #[must_use]
    pub fn get(&self, symbol: SymbolId) -> Option<SignatureId> {
        self.signatures[symbol].expand()
    }
}

/// Lowers one function of a unit; `timing` determines its charges.
#[must_use]
pub fn lower(
    unit: &Unit,
    function: &typed::Function,
    definitions: &Definitions,
    timing: Timing,
    signatures: &mut Signatures,
) -> Function {
    let signature = signatures.intern(&signature_of(unit, function));
    let builder = Builder::new(Function::new(function.symbol, signature, function.span, function.end));
    let mut lowering = Lowering {
        unit,
        function,
        definitions,
        signatures,
        builder,
        homes: PrimaryMap::with_capacity(function.locals.len()),
        writes: SecondaryMap::new(),
        jumps: JumpTargets::default(),
        outgoing: None,
        spine: Vec::new(),
        held: Vec::new(),
        cost_model: CostModel::new(function, timing),
    };
    lowering.cost(cost_table::ENTRY);
    lowering.enter_function();
    lowering.statements(&function.body);
    lowering.builder.set_span(function.end);
    lowering.return_zero();
    lowering.variables();
    lowering.builder.function
}

/// The classes of a function's parameters, including hidden ones, and of its result.
fn signature_of(unit: &Unit, function: &typed::Function) -> Signature {
    let class = |local: &LocalId| types::class(&unit.types, function.locals[*local].ty).unwrap_or(Class::I32);
    let params = (function.hidden.result_pointer.iter())
        .chain(&function.parameters)
        .chain(&function.hidden.variable_arguments)
        .map(class)
        .collect();
    Signature { params, result: types::class(&unit.types, function.ty.result) }
}

/// The alignment of every frame, in bytes.
const STACK_ALIGNMENT: u32 = 8;

/// The home of a local.
#[derive(Clone, Copy, Debug)]
enum Home {
    /// In a value.
    Value(ValueId),
    /// In the frame.
    Slot(SlotId),
    /// In memory, at the address in the value.
    Pointer(ValueId),
}

/// An operand that must still mean the same after other operands have been evaluated.
#[derive(Clone, Copy, Debug)]
struct HeldOperand {
    operand: Operand,
    writes: u32,
    point: Point,
}

/// A switch whose body is being lowered.
#[derive(Debug)]
struct Switch {
    cases: Vec<BlockId>,
    default: BlockId,
}

/// The jump targets of the statements being lowered; the innermost is last.
#[derive(Debug, Default)]
struct JumpTargets {
    labels: SecondaryMap<LabelId, PackedOption<BlockId>>,
    breaks: Vec<BlockId>,
    continues: Vec<BlockId>,
    switches: Vec<Switch>,
}

/// The state of lowering one function.
struct Lowering<'a> {
    unit: &'a Unit,
    function: &'a typed::Function,
    definitions: &'a Definitions,
    signatures: &'a mut Signatures,
    builder: Builder,
    homes: PrimaryMap<LocalId, Home>,
    /// Number of writes of a local's value so far.
    writes: SecondaryMap<ValueId, u32>,
    jumps: JumpTargets,
    /// The slot for the variable arguments of calls.
    outgoing: Option<SlotId>,
    /// Stack of operator nodes whose left operands are being lowered.
    spine: Vec<ExprId>,
    /// Stack of arguments that wait for their call.
    held: Vec<HeldOperand>,
    /// The state for charging, if the vendor's code is charged.
    cost_model: Option<CostModel>,
}

impl Lowering<'_> {
    /// Says where the source's locals are.
    fn variables(&mut self) {
        let mut writes: SecondaryMap<ValueId, u32> = SecondaryMap::new();
        let function = &mut self.builder.function;
        for block in function.layout.iter().map(|id| &function.blocks[*id]) {
            for dst in block.insts.iter().filter_map(|inst| inst.kind.dst()) {
                writes[dst] += 1;
            }
        }
        let named = self.homes.iter().filter(|(local, _)| !self.function.locals[*local].name.is_empty());
        let variables = named.map(|(local, home)| {
            let home = match *home {
                Home::Value(value) => ir::function::VariableHome::Value(value, writes[value]),
                Home::Slot(slot) => ir::function::VariableHome::Slot(slot),
                Home::Pointer(value) => ir::function::VariableHome::Pointer(value),
            };
            SourceVariable { local, home }
        });
        function.source.variables = variables.collect();
    }

    /// Gives every local its home and receives the arguments.
    fn enter_function(&mut self) {
        let function = self.function;
        for local in function.locals.values() {
            let home = if local.by_pointer {
                Home::Pointer(self.builder.value(Class::I32))
            } else if local.in_memory || local.align > STACK_ALIGNMENT {
                self.in_frame(local)
            } else {
                Home::Value(self.builder.value(self.class_or_int(local.ty)))
            };
            self.homes.push(home);
        }
        let hidden = function.hidden.result_pointer;
        for local in hidden.into_iter().chain(function.parameters.iter().copied()) {
            self.parameter(local);
        }
        if let Some(local) = function.hidden.variable_arguments {
            self.parameter(local);
        }
    }

    /// A home in the frame. A local that needs more alignment than the stack provides is placed inside a larger slot.
    fn in_frame(&mut self, local: &typed::Local) -> Home {
        let (size, align) = types::layout(&self.unit.types, local.ty);
        let align = align.max(local.align);
        if align <= STACK_ALIGNMENT {
            return Home::Slot(self.builder.slot(size, align));
        }
        let room = size.saturating_add(align - STACK_ALIGNMENT);
        let slot = self.builder.slot(room, STACK_ALIGNMENT);
        let start = self.builder.value(Class::I32);
        let offset = (align - STACK_ALIGNMENT).cast_signed();
        self.builder.push(InstKind::FrameAddress { dst: start, slot, offset });
        let aligned = self.builder.value(Class::I32);
        let mask = Operand::int(align.wrapping_neg().cast_signed());
        self.builder.binary(BinaryOp::And, aligned, start.into(), mask);
        Home::Pointer(aligned)
    }

    /// Receives one argument; an argument that needs memory is stored there.
    fn parameter(&mut self, local: LocalId) {
        let param = match self.homes[local] {
            Home::Value(value) | Home::Pointer(value) => value,
            Home::Slot(slot) => {
                let ty = self.function.locals[local].ty;
                let param = self.builder.value(self.class_or_int(ty));
                if let Some(width) = types::width(&self.unit.types, ty) {
                    self.builder.store(param.into(), width, Address::new(Base::Slot(slot)));
                }
                param
            }
        };
        self.builder.function.params.push(param);
    }

    /// The class of a type; `void` and structures have none, but it does not matter where this is called.
    fn class_or_int(&self, ty: crate::ty::TypeId) -> Class {
        types::class(&self.unit.types, ty).unwrap_or(Class::I32)
    }

    /// Records that a local's value is written.
    fn record_write(&mut self, value: ValueId) {
        self.writes[value] += 1;
    }

    /// Remembers an operand while others are evaluated.
    fn hold_operand(&self, operand: Operand) -> HeldOperand {
        let writes = operand.as_value().map_or(0, |value| self.writes[value]);
        HeldOperand { operand, writes, point: self.builder.point() }
    }

    /// The value of the operand when it was held. Operands that were held later must be released before.
    fn release(&mut self, held: HeldOperand) -> Operand {
        match held.operand {
            Operand::Value(value) if self.writes[value] != held.writes => {
                let class = self.builder.function.values[value];
                let saved = self.builder.value(class);
                self.builder.insert_copy(held.point, saved, held.operand);
                saved.into()
            }
            operand => operand,
        }
    }

    /// The block of a label.
    fn label(&mut self, label: LabelId) -> BlockId {
        if let Some(block) = self.jumps.labels[label].expand() {
            return block;
        }
        let block = self.builder.block();
        self.jumps.labels[label] = block.into();
        block
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
