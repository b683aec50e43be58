//! Encodings that objects and images share: kinds of symbols, lines, numbers of 16 bits.

use std::num::NonZeroU16;

use coff::{BaseType, Derivation, Line, StorageClass, SymbolType};

use super::SymbolKind;
use crate::typed::Linkage;

/// A line entry. The format has 16 bits for a line; later lines cannot be recorded.
pub(crate) fn statement(address: u32, line: u32) -> Option<Line> {
    let line = u16::try_from(line).ok().and_then(NonZeroU16::new)?;
    Some(Line::Statement { address, line })
}

/// The type that the format records for every function.
pub(crate) const fn function_type() -> SymbolType {
    SymbolType::new(BaseType::INT).derived(Derivation::Function)
}

pub(crate) const fn class(linkage: Linkage) -> StorageClass {
    match linkage {
        Linkage::External => StorageClass::EXTERNAL,
        Linkage::Internal => StorageClass::STATIC,
    }
}

/// The type that the format records for a kind of symbol.
pub(crate) const fn base_type(kind: SymbolKind) -> SymbolType {
    SymbolType::new(match kind {
        SymbolKind::Function => return function_type(),
        SymbolKind::Char => BaseType::CHAR,
        SymbolKind::Short => BaseType::SHORT,
        SymbolKind::Float => BaseType::FLOAT,
        SymbolKind::Double => BaseType::DOUBLE,
        SymbolKind::Int | SymbolKind::Other => BaseType::INT,
    })
}

/// The kind of symbol of a type: the reverse, as far as the format distinguishes them.
#[must_use]
pub fn kind_of(ty: SymbolType) -> SymbolKind {
    match ty.base() {
        _ if ty == function_type() => SymbolKind::Function,
        BaseType::CHAR => SymbolKind::Char,
        BaseType::SHORT => SymbolKind::Short,
        BaseType::FLOAT => SymbolKind::Float,
        BaseType::DOUBLE => SymbolKind::Double,
        _ => SymbolKind::Int,
    }
}

/// Converts to 16 bits, saturating.
pub(crate) fn to_u16(number: u32) -> u16 {
    u16::try_from(number).unwrap_or(u16::MAX)
}
