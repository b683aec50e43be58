//! Static data: leaves of an initialiser as bytes and addresses.

use std::collections::BTreeMap;

use super::Sema;
use super::constants::Constant;
use super::declarators::MAX_SEARCH;
use super::initializers::{Leaf, LeafValue};
use crate::diag::Diagnostic;
use crate::operators::BinaryOp;
use crate::source::Span;
use crate::ty::layout::MAX_OBJECT_SIZE;
use crate::ty::{BitRange, TypeId, Types};
use crate::typed::{AddressWord, ExprId, ExprKind, PlaceKind, StaticData, SymbolId};

/// A value that is known at link time.
#[derive(Clone, Copy, Debug)]
enum StaticValue {
    Constant(Constant),
    /// The address of a symbol plus bytes.
    Address(SymbolId, i32),
}

/// The bytes of an object while they are being filled in.
struct Image {
    bytes: Vec<u8>,
    addresses: BTreeMap<u32, (SymbolId, i32)>,
}

impl Sema<'_> {
    /// The bytes of an object of type `ty`; a flexible array may make it longer.
    pub(super) fn static_data(&mut self, ty: TypeId, leaves: &[Leaf], span: Span) -> Option<StaticData> {
        let end =
            leaves.iter().filter_map(|leaf| leaf.offset.checked_add(self.types.size_of(leaf.ty)?)).max();
        let size = self.types.size_of(ty)?.max(end.unwrap_or(0));
        if size > MAX_OBJECT_SIZE {
            let message = format!("an object of {size} bytes is too large");
            self.report(
                Diagnostic::error(span, message).note(format!("the limit is {MAX_OBJECT_SIZE} bytes")),
            );
            return None;
        }
        let mut image = Image { bytes: vec![0; size as usize], addresses: BTreeMap::new() };
        let mut is_sound = true;
        for leaf in leaves {
            is_sound &= self.static_leaf(&mut image, leaf).is_some();
        }
        is_sound.then_some(())?;
        let addresses = image
            .addresses
            .into_iter()
            .map(|(offset, (symbol, addend))| AddressWord { offset, symbol, addend })
            .collect();
        Some(StaticData { bytes: image.bytes, addresses })
    }

    fn static_leaf(&mut self, image: &mut Image, leaf: &Leaf) -> Option<()> {
        match &leaf.value {
            LeafValue::Text(bytes) => image.write(leaf.offset, bytes),
            LeafValue::Record(_) => {
                self.not_constant(leaf.span, "a structure variable");
                return None;
            }
            LeafValue::Scalar(value) => match self.static_value(*value, MAX_SEARCH) {
                Ok(StaticValue::Constant(constant)) => {
                    let size = self.types.size_of(leaf.ty)?;
                    match leaf.bits {
                        None => image.write(leaf.offset, &bytes_of(constant, leaf.ty, size)),
                        Some(bits) => image.write_bits(leaf.offset, size, bits, constant),
                    }
                }
                Ok(StaticValue::Address(symbol, addend))
                    if self.types.size_of(leaf.ty) == Some(4) && leaf.bits.is_none() =>
                {
                    image.write(leaf.offset, &[0; 4]);
                    image.addresses.insert(leaf.offset, (symbol, addend));
                }
                Ok(StaticValue::Address(..)) => {
                    self.not_constant(leaf.span, "an address in less than 32 bits");
                    return None;
                }
                Err(culprit) => {
                    let (span, what) = (self.body.span(culprit), self.describe_non_constant(culprit));
                    self.not_constant(span, what);
                    return None;
                }
            },
        }
        Some(())
    }

    /// The value of an expression before the program runs, or the part that has none.
    fn static_value(&self, value: ExprId, depth: u32) -> Result<StaticValue, ExprId> {
        let depth = depth.checked_sub(1).ok_or(value)?;
        let expr = &self.body.exprs[value];
        match expr.kind {
            ExprKind::Int(constant) => Ok(StaticValue::Constant(Constant::Int(constant))),
            ExprKind::Float(constant) => Ok(StaticValue::Constant(Constant::Float(constant))),
            ExprKind::Address(place) => match self.body.places[place].kind {
                PlaceKind::Symbol(symbol, offset) => Ok(StaticValue::Address(symbol, offset)),
                _ => Err(value),
            },
            // An address has the same value in any type of its size.
            ExprKind::Convert(inner) if self.types.size_of(expr.ty) == Some(4) && !expr.ty.is_floating() => {
                self.static_value(inner, depth)
            }
            ExprKind::Binary(op, a, b) if [BinaryOp::Add, BinaryOp::Subtract].contains(&op) => {
                use StaticValue::{Address, Constant as Known};
                let is_sum = op == BinaryOp::Add;
                match (self.static_value(a, depth)?, self.static_value(b, depth)?) {
                    (Address(symbol, addend), Known(Constant::Int(by)))
                    | (Known(Constant::Int(by)), Address(symbol, addend))
                        if is_sum =>
                    {
                        Ok(Address(symbol, addend.wrapping_add(by as i32)))
                    }
                    (Address(symbol, addend), Known(Constant::Int(by))) => {
                        Ok(Address(symbol, addend.wrapping_sub(by as i32)))
                    }
                    _ => Err(value),
                }
            }
            _ => Err(value),
        }
    }

    /// A description of the part because of which an expression is not constant.
    fn describe_non_constant(&self, value: ExprId) -> &'static str {
        match &self.body.exprs[value].kind {
            ExprKind::Load(_) => "the value of a variable",
            ExprKind::Call(_) => "a call",
            ExprKind::Address(_) => "the address of a local variable",
            _ if self.divides_by_zero(value, MAX_SEARCH) => "a division by zero",
            _ => "computed at run time",
        }
    }

    fn not_constant(&mut self, span: Span, what: &str) {
        self.report(
            Diagnostic::error(span, "the initialiser of a static object must be constant")
                .at(format!("this is {what}"))
                .help("assign it at the start of `main`"),
        );
    }
}

impl Image {
    /// A later value replaces an earlier one.
    fn write(&mut self, offset: u32, bytes: &[u8]) {
        let end = offset + bytes.len() as u32;
        let covered: Vec<_> =
            self.addresses.range(offset.saturating_sub(3)..end).map(|(at, _)| *at).collect();
        for at in covered {
            self.addresses.remove(&at);
        }
        if let Some(target) = self.bytes.get_mut(offset as usize..end as usize) {
            target.copy_from_slice(bytes);
        }
    }

    fn write_bits(&mut self, offset: u32, size: u32, bits: BitRange, constant: Constant) {
        let Constant::Int(value) = constant else { return };
        let Some(unit) = self.bytes.get_mut(offset as usize..(offset + size) as usize) else { return };
        let mut word = unit.iter().rev().fold(0_u64, |word, byte| word << 8 | u64::from(*byte));
        let mask = u64::MAX.checked_shr(64 - u32::from(bits.width)).unwrap_or(0) << bits.shift;
        word = word & !mask | (value.cast_unsigned() << bits.shift) & mask;
        unit.copy_from_slice(&word.to_le_bytes()[..size as usize]);
    }
}

/// The bytes of a constant in memory.
fn bytes_of(constant: Constant, ty: TypeId, size: u32) -> Vec<u8> {
    match constant {
        Constant::Float(value) if ty == Types::FLOAT => (value as f32).to_le_bytes().to_vec(),
        Constant::Float(value) => value.to_le_bytes().to_vec(),
        Constant::Int(value) => value.to_le_bytes()[..size as usize].to_vec(),
    }
}
