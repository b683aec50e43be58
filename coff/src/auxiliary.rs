//! The meaning of a symbol's first auxiliary entry.
//!
//! The entry itself does not state its meaning; it follows from the storage class, the type and the name of its symbol.

use crate::image::Symbol;
use crate::names::{Derivation, StorageClass};
use crate::raw;

/// An auxiliary entry with its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Auxiliary {
    /// For a function: its size and its lines.
    Function(raw::FunctionAux),
    /// For `.bf`, `.ef`, `.bb` or `.eb`: the line where a function or block begins or ends.
    Boundary(raw::BoundaryAux),
    /// For a symbol that names a section.
    Section(raw::SectionAux),
    /// For a structure, union or enumeration tag.
    Tag(raw::TagAux),
    /// For an array.
    Array(raw::ArrayAux),
    /// For other symbols with a size.
    Object(raw::ObjectAux),
}

impl Symbol {
    /// The symbol's first auxiliary entry; `None` if it has none.
    #[must_use]
    pub fn auxiliary(&self) -> Option<Auxiliary> {
        let aux = self.aux.first()?;
        Some(match (self.class, self.ty.outermost()) {
            (StorageClass::FUNCTION | StorageClass::BLOCK, _) => Auxiliary::Boundary(aux.as_boundary()),
            (StorageClass::STRUCT_TAG | StorageClass::UNION_TAG | StorageClass::ENUM_TAG, _) => {
                Auxiliary::Tag(aux.as_tag())
            }
            (StorageClass::STATIC, None) if self.ty.0 == 0 => Auxiliary::Section(aux.as_section()),
            (_, Some(Derivation::Function)) => Auxiliary::Function(aux.as_function()),
            (_, Some(Derivation::Array)) => Auxiliary::Array(aux.as_array()),
            _ => Auxiliary::Object(aux.as_object()),
        })
    }

    /// The size in bytes of the object or type that the symbol names, if an entry states it.
    #[must_use]
    pub fn size(&self) -> Option<u32> {
        match self.auxiliary()? {
            Auxiliary::Function(aux) => Some(aux.size.get()),
            Auxiliary::Section(aux) => Some(aux.size.get()),
            Auxiliary::Tag(aux) => Some(aux.size.get()),
            Auxiliary::Array(aux) => Some(aux.size.get()),
            Auxiliary::Object(aux) => Some(aux.size.get()),
            Auxiliary::Boundary(_) => None,
        }
    }
}
