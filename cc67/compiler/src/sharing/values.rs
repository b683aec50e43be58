//! The constants and loads from which the values of a function are computed.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::firmware::Function as FirmwareCall;
use kmotiondef::variables::variable_named;

use super::Cell;
use crate::ir::function::Function;
use crate::ir::inst::{Address, Base, Callee, Constant, Inst, InstKind, Operand, ValueId};
use crate::ir::operators::BinaryOp;
use crate::typed::{Definition, StaticData, SymbolId, Unit};

/// The pointers of a unit that keep their initial value.
#[derive(Debug, Default)]
pub(super) struct Pointers(BTreeMap<SymbolId, Constant>);

impl Pointers {
    /// Finds the pointers to which no function stores.
    pub(super) fn new<'a>(unit: &Unit, functions: impl Iterator<Item = &'a Function>) -> Self {
        let initialised = unit.symbols.iter().filter_map(|(symbol, declared)| {
            let Definition::Data(StaticData { bytes, addresses }) = &declared.definition else { return None };
            let word = i32::from_le_bytes(bytes.as_slice().try_into().ok()?);
            let of_symbol = addresses.first().map(|word| Constant::Symbol(word.symbol, word.addend));
            Some((symbol, of_symbol.unwrap_or(Constant::I32(word))))
        });
        let mut pointers: BTreeMap<_, _> = initialised.collect();
        for function in functions {
            for inst in function.layout.iter().flat_map(|block| &function.blocks[*block].insts) {
                if let InstKind::Store { address: Address { base: Base::Symbol(symbol), .. }, .. } = inst.kind
                {
                    pointers.remove(&symbol);
                }
            }
        }
        Self(pointers)
    }
}

/// The instructions that write each value of a function.
#[derive(Debug)]
pub(super) struct Values<'a> {
    unit: &'a Unit,
    pointers: &'a Pointers,
    writes: BTreeMap<ValueId, Vec<InstKind>>,
    /// The constants passed by the caller.
    passed: BTreeMap<ValueId, Constant>,
}

impl<'a> Values<'a> {
    /// Collects them.
    pub(super) fn new(unit: &'a Unit, pointers: &'a Pointers, function: &Function) -> Self {
        let mut writes: BTreeMap<ValueId, Vec<InstKind>> = BTreeMap::new();
        for inst in function.layout.iter().flat_map(|block| &function.blocks[*block].insts) {
            if let Some(value) = inst.kind.dst() {
                writes.entry(value).or_default().push(inst.kind);
            }
        }
        Self { unit, pointers, writes, passed: BTreeMap::new() }
    }

    /// The values if the caller passes these arguments.
    pub(super) fn with_arguments(mut self, function: &Function, arguments: &[Option<Constant>]) -> Self {
        let passed = function.params.iter().zip(arguments);
        let passed = passed.filter_map(|(value, constant)| Some((*value, (*constant)?)));
        self.passed = passed.filter(|(value, _)| !self.writes.contains_key(value)).collect();
        self
    }

    /// The only instruction that writes a value.
    pub(super) fn only_write(&self, value: ValueId) -> Option<InstKind> {
        let [kind] = self.writes.get(&value)?.as_slice() else { return None };
        Some(*kind)
    }

    /// Returns whether an instruction ends the thread.
    pub(super) fn ends_thread(&self, inst: &Inst) -> bool {
        let InstKind::Call { callee: Callee::Symbol(callee), .. } = inst.kind else { return false };
        self.unit.symbols[callee].name == FirmwareCall::ThreadDone.name()
    }

    /// The constant that an operand always is.
    pub(super) fn constant(&self, operand: Operand) -> Option<Constant> {
        self.constant_within(operand, 8)
    }

    fn constant_within(&self, operand: Operand, depth: u32) -> Option<Constant> {
        let depth = depth.checked_sub(1)?;
        let value = match operand {
            Operand::Constant(constant) => return Some(constant),
            Operand::Value(value) => value,
        };
        if let Some(constant) = self.passed.get(&value) {
            return Some(*constant);
        }
        match self.only_write(value)? {
            InstKind::Copy { src, .. } => self.constant_within(src, depth),
            InstKind::Load { address: Address { base: Base::Symbol(symbol), offset: 0 }, .. } => {
                self.pointers.0.get(&symbol).copied()
            }
            InstKind::Binary { op: BinaryOp::Add, a, b, .. } => {
                match (self.constant_within(a, depth)?, self.constant_within(b, depth)?) {
                    (Constant::I32(a), Constant::I32(b)) => Some(Constant::I32(a.wrapping_add(b))),
                    (Constant::Symbol(symbol, offset), Constant::I32(more))
                    | (Constant::I32(more), Constant::Symbol(symbol, offset)) => {
                        Some(Constant::Symbol(symbol, offset.wrapping_add(more)))
                    }
                    _ => None,
                }
            }
            InstKind::Unary { .. }
            | InstKind::Binary { .. }
            | InstKind::Compare { .. }
            | InstKind::Convert { .. }
            | InstKind::Load { .. }
            | InstKind::Store { .. }
            | InstKind::FrameAddress { .. }
            | InstKind::CopyMemory { .. }
            | InstKind::ClearMemory { .. }
            | InstKind::Call { .. }
            | InstKind::Cost { .. } => None,
        }
    }

    /// The cell at an address, if it is constant.
    pub(super) fn cell(&self, address: Address) -> Option<Cell> {
        let place = match address.base {
            Base::Absolute => Constant::I32(address.offset),
            Base::Symbol(symbol) => Constant::Symbol(symbol, address.offset),
            Base::Value(value) => match self.constant(value.into())? {
                Constant::I32(base) => Constant::I32(base.wrapping_add(address.offset)),
                Constant::Symbol(symbol, offset) => {
                    Constant::Symbol(symbol, offset.wrapping_add(address.offset))
                }
                Constant::I64(_) | Constant::F32(_) | Constant::F64(_) => return None,
            },
            Base::Slot(_) => return None,
        };
        self.cell_of(place)
    }

    /// The cell whose address is a constant.
    pub(super) fn cell_of(&self, constant: Constant) -> Option<Cell> {
        let (symbol, offset) = match constant {
            Constant::I32(address) => return Some(Cell::Board(address.cast_unsigned())),
            Constant::Symbol(symbol, offset) => (symbol, offset),
            Constant::I64(_) | Constant::F32(_) | Constant::F64(_) => return None,
        };
        let declared = &self.unit.symbols[symbol];
        match declared.definition {
            Definition::None => {
                let variable = variable_named(&declared.name)?;
                Some(Cell::Board(variable.address.get().wrapping_add_signed(offset)))
            }
            Definition::Tentative | Definition::Data(_) => Some(Cell::Variable(symbol, offset)),
            Definition::Function => None,
        }
    }

    /// The cells from whose loads an operand is computed.
    pub(super) fn loads(&self, operand: Operand) -> BTreeSet<Cell> {
        let mut found = BTreeSet::new();
        let mut seen = BTreeSet::new();
        let mut open: Vec<ValueId> = operand.as_value().into_iter().collect();
        while let Some(value) = open.pop() {
            if !seen.insert(value) {
                continue;
            }
            for kind in self.writes.get(&value).into_iter().flatten() {
                if let InstKind::Load { address, .. } = kind {
                    found.extend(self.cell(*address));
                    continue;
                }
                let mut kind = *kind;
                kind.visit_operands(|operand| open.extend(operand.as_value()));
            }
        }
        found
    }
}
